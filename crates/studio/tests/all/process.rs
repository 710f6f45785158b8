//! A server in a process of its own: what becomes of its work when the page goes, and of its files when it is killed.

use crate::client::{Said, Studio};
use serde_json::json;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use toolpost_studio::message::Array;
use toolpost_studio::{Server, Settings};

/// Names the folder of the child.
const FOLDER: &str = "TOOLPOST_STUDIO_TEST_FOLDER";

/// Names the source that it begins with, where there is one.
const SOURCE: &str = "TOOLPOST_STUDIO_TEST_SOURCE";

/// Set where it opens a browser.
const SHOWN: &str = "TOOLPOST_STUDIO_TEST_SHOWN";

/// A machine of the library.
const MACHINE: &str = "generic-3axis-linuxcnc";

/// The server, where this process was started as one; otherwise nothing.
#[test]
fn serves_as_a_child() {
    let Some(folder) = std::env::var_os(FOLDER) else { return };
    let source = std::env::var(SOURCE).ok();
    let machine = source.is_some().then(|| MACHINE.to_owned());
    let settings = Settings { folder: folder.into(), source, machine, ..Settings::default() };
    let server = Server::bind(&settings).unwrap();
    eprintln!("link {}", server.link());
    if std::env::var_os(SHOWN).is_some() {
        server.show().unwrap();
    }
    server.run();
}

/// A server that is killed when it is dropped.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Process {
    fn start(outside: tempfile::TempDir) -> (Process, Studio) {
        Process::by(Command::new(std::env::current_exe().unwrap()), outside)
    }

    /// Starts it by a command, which is given the arguments of this program.
    fn by(mut command: Command, outside: tempfile::TempDir) -> (Process, Studio) {
        let mut child = command
            .args(["--exact", "process::serves_as_a_child", "--nocapture"])
            .env(FOLDER, outside.path().join("own"))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let link = lines.map_while(Result::ok).find_map(|line| {
            let (port, token) = line.strip_prefix("link http://127.0.0.1:")?.split_once("/#")?;
            Some((port.parse().unwrap(), token.to_owned()))
        });
        let (port, token) = link.unwrap();
        (Process(child), Studio { outside, port, token })
    }
}

fn folder() -> tempfile::TempDir {
    let outside = tempfile::tempdir().unwrap();
    std::fs::create_dir(outside.path().join("own")).unwrap();
    outside
}

/// Processor time of a process, s, of which there are a hundred ticks.
#[cfg(target_os = "linux")]
fn processor_time(process: &Process) -> f64 {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", process.0.id())).unwrap();
    let fields: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
    (fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()) / 100.0
}

/// A folder with a toolpath of so many moves.
fn folder_with_long(moves: u32) -> tempfile::TempDir {
    let outside = folder();
    let mut source =
        String::from("UNITS/MM\nLOADTL/1\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/90\n");
    for i in 0..moves {
        let _ = writeln!(source, "GOTO/{}.{:03},{},-1", i / 1000, i % 1000, i % 7);
    }
    std::fs::write(outside.path().join("own/long.cls"), source).unwrap();
    outside
}

/// The work that is named at the start is done whether or not a page asks yet; the one that asks does not do it again.
#[cfg(target_os = "linux")]
#[test]
fn the_first_work_begins_with_the_server() {
    let outside = folder_with_long(100_000);
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.env(SOURCE, "long.cls");
    let (process, studio) = Process::by(command, outside);
    let begun = Instant::now();
    let mut before = 0.0;
    loop {
        std::thread::sleep(Duration::from_millis(300));
        let now = processor_time(&process);
        if now > 0.1 && now - before < 0.02 {
            break;
        }
        before = now;
        assert!(begun.elapsed() < Duration::from_secs(60), "{now} s of the processor");
    }
    let alone = processor_time(&process);
    // Another file of the folder does not matter to it.
    std::fs::write(studio.own().join("other.cls"), "FINI\n").unwrap();
    let mut page = studio.socket();
    let params = json!({ "source": { "file": "long.cls" }, "machine": MACHINE });
    let id = page.ask("post", params.clone(), &[]);
    let (mut steps, mut moves) = (Vec::new(), 0);
    let job = loop {
        let Said::Frame(frame) = page.next() else { panic!() };
        match frame.head.get("event").and_then(|event| event.as_str()) {
            Some("progress") => steps.extend(frame.head["step"].as_str().map(str::to_owned)),
            Some("walked") => moves = frame.head["moves"].as_u64().unwrap(),
            _ => break frame.head,
        }
    };
    // What was reported before somebody was there is reported to him.
    steps.dedup();
    assert_eq!(steps, ["reading", "writing", "proving", "drawing"]);
    assert!(moves > 0 && job["id"] == id, "{moves}");
    assert_eq!(job["done"]["verdict"], "done");
    let asked = processor_time(&process) - alone;
    assert!(asked < 0.3 * alone, "{alone} s of the processor, and {asked} s when it was asked for");
    // Who asks again has it done again.
    assert_eq!(page.done("post", params)["verdict"], "done");
    assert!(processor_time(&process) - alone > 0.3 * alone);
}

/// How much memory a process has, and how much it had at the most, kB.
#[cfg(target_os = "linux")]
fn memory(process: &Process) -> [u64; 2] {
    let status = std::fs::read_to_string(format!("/proc/{}/status", process.0.id())).unwrap();
    ["VmRSS:", "VmHWM:"].map(|key| {
        let line = status.lines().find_map(|line| line.strip_prefix(key)).unwrap();
        line.trim().trim_end_matches(" kB").parse().unwrap()
    })
}

/// A board of which nothing is kept leaves no memory with the server.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[test]
fn memory_of_work_that_is_over_is_given_back() {
    let outside = folder();
    std::fs::create_dir(outside.path().join("own/tangle")).unwrap();
    let layer = outside.path().join("own/tangle/b-F_Cu.gbr");
    std::fs::write(layer, crate::boards::tangle()).unwrap();
    let (process, studio) = Process::start(outside);
    let mut page = studio.socket();
    let params = json!({ "source": { "folder": "tangle" }, "machine": "grbl-3018" });
    assert_eq!(page.refused("post", params), "layer");
    let begun = Instant::now();
    loop {
        let [now, most] = memory(&process);
        assert!(most > 100_000, "too small for this test: {most} kB");
        if now < most / 3 {
            break;
        }
        assert!(begun.elapsed() < Duration::from_secs(30), "{now} kB of {most}");
        std::thread::sleep(Duration::from_millis(200));
    }
}

/// A stand-in for the browser notes what it is started with, and who may read that file.
#[cfg(target_os = "linux")]
#[test]
fn the_link_is_no_argument_of_the_browser() {
    use std::os::unix::fs::PermissionsExt;
    let outside = folder();
    let browser = outside.path().join("xdg-open");
    let noted = outside.path().join("noted");
    let script = format!(
        "#!/bin/sh\necho \"$@\" > {noted}.new\nstat -c %a \"$1\" >> {noted}.new\ncat \"$1\" >> {noted}.new\nmv {noted}.new {noted}\n",
        noted = noted.display()
    );
    std::fs::write(&browser, script).unwrap();
    std::fs::set_permissions(&browser, std::fs::Permissions::from_mode(0o755)).unwrap();
    let mut command = Command::new(std::env::current_exe().unwrap());
    let path = format!("{}:{}", outside.path().display(), std::env::var("PATH").unwrap());
    command.env(SHOWN, "").env("PATH", path);
    let (_process, studio) = Process::by(command, outside);
    let begun = Instant::now();
    while !noted.is_file() {
        assert!(begun.elapsed() < Duration::from_secs(60), "no browser");
        std::thread::sleep(Duration::from_millis(10));
    }
    let noted = std::fs::read_to_string(noted).unwrap();
    let (file, rest) = noted.split_once('\n').unwrap();
    let (rights, page) = rest.split_once('\n').unwrap();
    assert!(!file.contains(&studio.token), "{file}");
    assert_eq!(rights, "600");
    let link = format!("http://127.0.0.1:{}/#{}", studio.port, studio.token);
    assert!(page.contains(&format!("http-equiv=\"refresh\" content=\"0; url={link}\"")), "{page}");
    assert!(!page.contains("<script"), "{page}");
    let file = std::path::Path::new(file);
    assert_eq!(file.parent(), Some(&*studio.own().canonicalize().unwrap().join(".toolpost")));
    // Whoever has no token has not come.
    let mut foreign = studio.silent_socket();
    foreign.send(&json!({ "token": "0".repeat(64) }), &[]);
    assert!(matches!(foreign.next(), Said::Closed(_)) && file.is_file());
    studio.socket().done("open", json!({}));
    assert!(!file.exists());
}

/// Work that takes long goes on for nobody.
#[cfg(target_os = "linux")]
#[test]
fn work_ends_when_the_page_goes() {
    let (process, studio) = Process::start(folder_with_long(400_000));
    let mut page = studio.socket();
    let params = json!({ "source": { "file": "long.cls" }, "machine": MACHINE });
    page.ask("post", params, &[]);
    loop {
        let Said::Frame(frame) = page.next() else { panic!() };
        let step = frame.head.get("step").unwrap_or_else(|| panic!("too fast for this test"));
        if step == "proving" {
            break;
        }
    }
    drop(page);
    // While it works a second of the clock is at least a tenth of a second of the processor, however busy the machine is.
    let begun = Instant::now();
    loop {
        let before = processor_time(&process);
        std::thread::sleep(Duration::from_millis(300));
        if processor_time(&process) - before < 0.02 {
            break;
        }
        assert!(begun.elapsed() < Duration::from_secs(5), "it works on");
    }
    assert!(studio.socket().done("open", json!({}))["version"].is_string());
}

/// Looking for all crossings of a layer takes seconds, and knows nothing of a page.
#[cfg(target_os = "linux")]
#[test]
fn a_long_step_below_ends_with_the_work_that_it_is_of() {
    let outside = folder();
    std::fs::create_dir(outside.path().join("own/tangle")).unwrap();
    std::fs::write(outside.path().join("own/tangle/b-F_Cu.gbr"), crate::boards::tangle()).unwrap();
    let (process, studio) = Process::start(outside);
    let mut page = studio.socket();
    let params = json!({ "source": { "folder": "tangle" }, "machine": "grbl-3018" });
    let id = page.ask("post", params, &[]);
    while processor_time(&process) < 0.6 {
        std::thread::sleep(Duration::from_millis(10));
    }
    page.send(&json!({ "cancel": id }), &[]);
    assert_eq!(page.answer_of(id).unwrap_err()["verdict"], "cancelled");
    let answered = processor_time(&process);
    loop {
        let before = processor_time(&process);
        std::thread::sleep(Duration::from_millis(500));
        let now = processor_time(&process);
        assert!(now - answered < 0.4, "it works on: {} s of the processor", now - answered);
        if now - before < 0.02 {
            break;
        }
    }
}

/// Drafts and programs are there whole, as before, or not at all, whenever the server is killed.
#[test]
fn a_killed_server_leaves_no_half_file() {
    for delay in [15, 40, 90] {
        let outside = folder();
        let source = std::fs::read(crate::client::root().join("examples/dome.cls")).unwrap();
        std::fs::write(outside.path().join("own/dome.cls"), source).unwrap();
        let (mut process, studio) = Process::start(outside);
        let mut page = studio.socket();
        let job = page.post("dome.cls", "fanuc-table-bc");
        let bytes = job["program"]["bytes"].as_u64().unwrap();
        let texts = [b'a', b'b'].map(|letter| vec![letter; 4 << 20]);
        for (text, number) in texts.iter().cycle().zip(0..12) {
            page.ask(
                "draft",
                json!({ "name": "d", "of": {} }),
                &[Array::text("text", text.clone())],
            );
            let path = format!("{number}.nc");
            page.ask(
                "save",
                json!({ "revision": job["revision"], "path": path, "replace": true }),
                &[],
            );
        }
        std::thread::sleep(Duration::from_millis(delay));
        process.0.kill().unwrap();
        process.0.wait().unwrap();
        let own = studio.own();
        if let Ok(draft) = std::fs::read(own.join(".toolpost/drafts/d.text")) {
            assert!(texts.contains(&draft), "a draft of {} bytes", draft.len());
        }
        for entry in std::fs::read_dir(&own).unwrap() {
            let entry = entry.unwrap();
            let name = entry.file_name().into_string().unwrap();
            if name.ends_with(".nc") {
                assert_eq!(entry.metadata().unwrap().len(), bytes, "{name}");
            }
        }
        // What was begun is gone once the next server is there, which goes on with the rest.
        std::fs::write(own.join(".toolpost-abc123.tmp"), "begun").unwrap();
        let (_process, studio) = Process::start(studio.outside);
        let names =
            std::fs::read_dir(studio.own()).unwrap().map(|entry| entry.unwrap().file_name());
        let begun = names.filter(|name| name.to_string_lossy().ends_with(".tmp")).count();
        assert_eq!(begun, 0);
        let mut page = studio.socket();
        page.done("drafts", json!({}));
        page.answer("draft", json!({ "name": "d", "of": {} }), &[Array::text("text", "x")])
            .unwrap();
        assert_eq!(page.done("drafts", json!({}))[0]["bytes"], 1);
    }
}

/// A program or a draft for which there is no room: the page is told, nothing is half-written, and the server goes on.
fn no_room_for(studio: &Studio, page: &mut crate::client::Socket, job: &serde_json::Value) {
    let names = || {
        let names = std::fs::read_dir(studio.own()).unwrap();
        let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.filter(|name| name != ".toolpost").collect();
        names.sort();
        names
    };
    let before = names();
    let save = json!({ "revision": job["revision"], "path": "dome.nc", "replace": false });
    let stop = page.answer("save", save, &[]).unwrap_err();
    assert_eq!(stop["findings"][0]["rule"], "output-file", "{stop}");
    assert!(stop["findings"][0]["help"].as_str().unwrap().contains("make room"), "{stop}");
    assert_eq!(names(), before);
    let draft = json!({ "name": "d", "of": {} });
    let stop =
        page.answer("draft", draft, &[Array::text("text", vec![b'x'; 300_000])]).unwrap_err();
    assert_eq!(stop["findings"][0]["rule"], "output-file", "{stop}");
    assert_eq!(page.done("drafts", json!({})), json!([]));
    let drafts = std::fs::read_dir(studio.own().join(".toolpost/drafts"));
    assert_eq!(drafts.into_iter().flatten().count(), 0);
}

/// The largest file of the shell: less than the program.
#[cfg(unix)]
#[test]
fn a_file_that_the_system_does_not_let_be_written_is_not_begun() {
    let outside = folder();
    let source = std::fs::read(crate::client::root().join("examples/dome.cls")).unwrap();
    std::fs::write(outside.path().join("own/dome.cls"), source).unwrap();
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -f 40; exec \"$0\" \"$@\""]).arg(std::env::current_exe().unwrap());
    let (_process, studio) = Process::by(command, outside);
    let mut page = studio.socket();
    let job = page.post("dome.cls", "fanuc-table-bc");
    no_room_for(&studio, &mut page, &job);
    page.answer("draft", json!({ "name": "d", "of": {} }), &[Array::text("text", "x")]).unwrap();
}

/// A disk of 400 kB, of which 40 are free: where this process may make one.
#[cfg(target_os = "linux")]
#[test]
fn on_a_full_disk_nothing_is_half_written() {
    struct Disk(std::path::PathBuf);
    impl Drop for Disk {
        fn drop(&mut self) {
            let _ = Command::new("umount").arg("--lazy").arg(&self.0).status();
        }
    }
    let outside = folder();
    let own = outside.path().join("own");
    let mut mount = Command::new("mount");
    mount.args(["-t", "tmpfs", "-o", "size=400k", "none"]).arg(&own).stderr(Stdio::null());
    if !mount.status().is_ok_and(|status| status.success()) {
        eprintln!("nothing is judged: no disk can be made here");
        return;
    }
    let _disk = Disk(own.clone());
    let source = std::fs::read(crate::client::root().join("examples/dome.cls")).unwrap();
    std::fs::write(own.join("dome.cls"), &source).unwrap();
    let (_process, studio) = Process::start(outside);
    let mut page = studio.socket();
    let job = page.post("dome.cls", "fanuc-table-bc");
    let free = 400 * 1024 - source.len().next_multiple_of(4096) - 40 * 1024;
    std::fs::write(own.join("filler"), vec![0; free]).unwrap();
    no_room_for(&studio, &mut page, &job);
    std::fs::remove_file(own.join("filler")).unwrap();
    page.done("save", json!({ "revision": job["revision"], "path": "dome.nc", "replace": false }));
}

/// A folder in which nobody may write: the page is told, and the rest works.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_cannot_be_written_is_read_all_the_same() {
    let server =
        Server::bind(&Settings { folder: "/proc/self".into(), ..Settings::default() }).unwrap();
    let (port, link) = (server.port(), server.link());
    std::thread::spawn(move || server.run());
    let token = link.split_once('#').unwrap().1.to_owned();
    let studio = Studio { outside: tempfile::tempdir().unwrap(), port, token };
    let mut page = studio.socket();
    let stop = page
        .answer("draft", json!({ "name": "d", "of": {} }), &[Array::text("text", "x")])
        .unwrap_err();
    assert_eq!(stop["findings"][0]["rule"], "output-file");
    assert_eq!(page.done("drafts", json!({})), json!([]));
    assert!(!page.done("folder", json!({ "path": "" }))["entries"].as_array().unwrap().is_empty());
}

/// What a tab keeps of an edit is found again at the same origin only; while a server has the port, another one gets another.
#[test]
fn a_folder_has_the_same_port_each_time() {
    let folder = tempfile::tempdir().unwrap();
    let bind =
        || Server::bind(&Settings { folder: folder.path().into(), ..Settings::default() }).unwrap();
    let first = bind();
    let port = first.port();
    assert!((20_000..32_000).contains(&port), "{port}");
    let second = bind();
    assert_ne!(second.port(), port);
    drop((first, second));
    assert_eq!(bind().port(), port);
}
