//! Boards: several programs of one source.

use crate::client::{Said, Socket, Studio, root};
use app::pcb::Job;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};
use toolpost_studio::ask::Command;
use toolpost_studio::board::Settings as BoardSettings;
use toolpost_studio::message::{Array, Values};
use toolpost_studio::server::More;
use toolpost_studio::{Options, Settings};

const MACHINE: &str = "grbl-3018";

fn plan() -> app::pcb::Settings {
    let mut plan = app::pcb::Settings::default();
    plan.isolation.tool = Some(0.3);
    plan
}

fn options(
    command: Command,
    given: &[(String, String)],
    beside: Option<&More>,
) -> Result<Options, app::Stop> {
    assert_eq!(command, Command::Pcb);
    let heights = given.first().map(|(_, file)| app::Source::File(file.into()));
    // Of the file beside a board these tests take its size.
    let size = |More { file, .. }: &More| format!("{} {}", file.name(), file.read().unwrap().len());
    let stated = beside.map(size);
    let typed = stated.clone().into_iter().collect();
    let board = BoardSettings { plan: plan(), heights, typed, stated, ..BoardSettings::default() };
    Ok(Options { board: Some(Box::new(board)), ..Options::default() })
}

/// A studio whose folder has the board of the examples in a folder of its own.
fn studio() -> Studio {
    let studio = Studio::with(Some(options));
    fs::create_dir(studio.own().join("lamp")).unwrap();
    fs::copy(root().join("examples/lamp.toml"), studio.own().join("lamp/lamp.toml")).unwrap();
    studio
}

fn params(source: Value) -> Value {
    json!({ "source": source, "machine": MACHINE })
}

fn post(page: &mut Socket, source: Value) -> Value {
    match page.answer("post", params(source), &[]) {
        Ok(frame) => frame.head["done"].clone(),
        Err(stop) => panic!("{stop}"),
    }
}

/// Why a board is not made.
fn refused(page: &mut Socket, source: Value) -> Value {
    page.answer("post", params(source), &[]).map(|frame| frame.head).unwrap_err()
}

fn names(list: &Value) -> Vec<&str> {
    list.as_array().unwrap().iter().map(|entry| entry["name"].as_str().unwrap()).collect()
}

pub(crate) fn text_of(page: &mut Socket, job: &Value) -> String {
    let params =
        json!({ "revision": job["revision"], "of": "program", "from": 1, "to": 1_000_000 });
    let mut frame = page.answer("text", params, &[]).unwrap();
    String::from_utf8(frame.take_text("text").unwrap()).unwrap()
}

const HEAD: &str = "%FSLAX46Y46*%\n%MOMM*%\n";

/// A track 6 mm long, on a layer of its own, and a board of 10 x 5 mm around it.
fn track() -> String {
    format!("{HEAD}%ADD10C,1.0*%\nD10*\nX2000000Y2000000D02*\nX8000000Y2000000D01*\nM02*\n")
}

fn edge(last: &str) -> String {
    format!(
        "{HEAD}%ADD10C,0.1*%\nD10*\nX0Y0D02*\nX10000000Y0D01*\nX10000000Y5000000D01*\nX0Y5000000D01*\n{last}M02*\n"
    )
}

const CLOSED: &str = "X0Y0D01*\n";

/// Writes the files of a board into a folder.
fn plots(folder: &Path, files: &[(&str, &str)]) {
    fs::create_dir_all(folder).unwrap();
    for (name, text) in files {
        fs::write(folder.join(name), text).unwrap();
    }
}

#[test]
fn a_board_is_several_programs_each_a_job_of_its_own() {
    let studio = studio();
    let mut page = studio.socket();
    let front = post(&mut page, json!({ "folder": "lamp" }));
    let board = &front["board"];
    assert_eq!((&board["name"], &board["verdict"]), (&json!("lamp"), &json!("done")), "{board}");
    assert_eq!(names(&board["programs"]), ["front", "drill", "back", "outline"]);
    assert_eq!(board["programs"][0]["revision"], front["revision"]);
    assert_eq!(board["left_out"], json!([]));
    // The same as the command writes.
    let machine = app::toolpath::machine(MACHINE).unwrap();
    let (settings, tolerances) = (plan(), proof::Tolerances::default());
    let job = Job::new(&machine, &settings, &tolerances).unwrap();
    let file = app::Source::File(studio.own().join("lamp"));
    let made = job.make(&[file], &()).unwrap();
    let mut revisions = Vec::new();
    for (program, known) in made.programs.iter().zip(board["programs"].as_array().unwrap()) {
        let job = page.done("job", json!({ "revision": known["revision"] }));
        assert_eq!(job["verdict"], "done", "{job}");
        assert_eq!(job["program"]["file"], program.file);
        assert_eq!(job["board"], *board);
        assert_eq!(text_of(&mut page, &job).as_bytes(), program.posted.text);
        let moves = job["walk"]["moves"].as_u64().unwrap();
        let params = json!({ "revision": job["revision"], "by": "move", "value": moves / 2 });
        let place = page.done("place", params);
        let again =
            json!({ "revision": job["revision"], "by": "block", "value": place["block"]["line"] });
        assert_eq!(page.done("place", again)["block"], place["block"]);
        // No line of a file makes the moves of a board: the blocks of a move are those of its own record.
        let ranges = place["blocks"][0]["ranges"].as_array().unwrap();
        let line = place["block"]["line"].as_u64().unwrap();
        let of = |range: &Value| range[0].as_u64().unwrap()..range[1].as_u64().unwrap();
        assert!(ranges.iter().any(|range| of(range).contains(&line)), "{place}");
        let blocks: u64 = ranges.iter().map(|range| of(range).end - of(range).start).sum();
        assert!(blocks <= 4, "{blocks}: {place}");
        assert!(!place["template"]["name"].as_str().unwrap().is_empty(), "{place}");
        assert!(!studio.get(&format!("/geometry/{}/index", job["revision"])).is_empty());
        revisions.push(job["revision"].clone());
    }
    let width = |revision: &Value, page: &mut Socket| {
        let job = page.done("job", json!({ "revision": revision }));
        let tool = &job["walk"]["tools"][0];
        assert_ne!(tool["name"], "");
        tool["width"].as_f64()
    };
    assert_eq!(width(&revisions[0], &mut page), Some(0.3));
    // The mill that cuts boards out is 2 mm wide where nothing else is said.
    assert_eq!(width(&revisions[3], &mut page), Some(2.0));
    // A source that is no board is of none.
    assert_eq!(page.refused("job", json!({ "revision": 1 })), "studio-limit");
}

#[test]
fn all_programs_of_a_board_are_saved_together_as_the_command_saves_them() {
    let studio = studio();
    let mut page = studio.socket();
    let front = post(&mut page, json!({ "file": "lamp/lamp.toml" }));
    let drill = front["board"]["programs"][1]["revision"].clone();
    let save =
        |path: &str, replace: bool| json!({ "revision": drill, "path": path, "replace": replace });
    // Not among the files of the board, not outside of the folder.
    assert_eq!(page.refused("save", save("lamp", true)), "output-folder");
    assert_eq!(page.refused("save", save("../out", true)), "folder-reach");
    assert_eq!(fs::read_dir(studio.own().join("lamp")).unwrap().count(), 1);
    let saved = page.done("save", save("out", false));
    let files = ["front", "drill", "back", "outline"].map(|name| format!("out/{name}.gcode"));
    let mut expected: Vec<String> = files.to_vec();
    expected.push(String::from("out/report.json"));
    assert_eq!(saved["files"], json!(expected));
    let machine = app::toolpath::machine(MACHINE).unwrap();
    let (settings, tolerances) = (plan(), proof::Tolerances::default());
    let job = Job::new(&machine, &settings, &tolerances).unwrap();
    let made = job.make(&[app::Source::File(studio.own().join("lamp/lamp.toml"))], &()).unwrap();
    let report = format!("{:#}\n", made.account(&job, Vec::new()).data);
    for (name, bytes) in made.contents(&job, &report) {
        assert!(fs::read(studio.own().join("out").join(&name)).unwrap() == bytes, "{name}");
    }
    assert_eq!(page.refused("save", save("out", false)), "output-folder");
    page.done("save", save("out", true));
    // What an earlier call has left there is named.
    fs::write(studio.own().join("out/front-mask.gcode"), "").unwrap();
    let found = &page.done("save", save("out", true))["findings"][0];
    assert_eq!((&found["rule"], &found["file"]), (&json!("file-older"), &json!("out")));
    assert!(found["message"].as_str().unwrap().contains("front-mask.gcode"), "{found}");
}

/// All real boards: KiCad's own files, and what KiCad and others have plotted.
#[test]
fn the_programs_of_real_boards_are_those_of_the_command() {
    let Some(data) = judge::data("gerber") else { return };
    let listed = |folder: &str| fs::read_dir(data.join(folder)).unwrap();
    let mut boards: Vec<_> = listed("kicad").map(|entry| entry.unwrap().path()).collect();
    boards.push(data.join("a64"));
    boards.sort();
    assert!(boards.len() >= 12, "{boards:?}");
    let studio = studio();
    let mut page = studio.socket();
    let machine = app::toolpath::machine(MACHINE).unwrap();
    let (settings, tolerances) = (plan(), proof::Tolerances::default());
    for board in boards {
        let mut job = Job::new(&machine, &settings, &tolerances).unwrap();
        // As `options` states it.
        let beside = fs::metadata(board.join("millproject"));
        job.options = beside.iter().map(|file| format!("millproject {}", file.len())).collect();
        let name = board.file_name().unwrap().to_str().unwrap();
        let own = studio.own().join(name);
        let source = if board.is_dir() {
            fs::create_dir(&own).unwrap();
            for file in fs::read_dir(&board).unwrap() {
                let file = file.unwrap();
                fs::copy(file.path(), own.join(file.file_name())).unwrap();
            }
            json!({ "folder": name })
        } else {
            fs::copy(&board, &own).unwrap();
            json!({ "file": name })
        };
        let made = job.make(&[app::Source::File(own)], &()).unwrap();
        let report = format!("{:#}\n", made.account(&job, Vec::new()).data);
        let posted = post(&mut page, source);
        let revision = &posted["board"]["programs"][0]["revision"];
        let out = format!("{name}-out");
        page.done("save", json!({ "revision": revision, "path": out, "replace": false }));
        let mut contents = made.contents(&job, &report);
        let mut saved: Vec<_> = fs::read_dir(studio.own().join(&out))
            .unwrap()
            .map(|file| file.unwrap().file_name().into_string().unwrap())
            .collect();
        contents.sort();
        saved.sort();
        assert_eq!(saved, contents.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>());
        for (file, bytes) in contents {
            let saved = fs::read(studio.own().join(&out).join(&file)).unwrap();
            assert!(saved == bytes, "{name}: {file}");
        }
    }
}

#[test]
fn a_board_is_drawn_by_its_nets_as_it_lies_for_each_program() {
    let studio = studio();
    let mut page = studio.socket();
    let front = post(&mut page, json!({ "folder": "lamp" }));
    let mut picture = |number: usize| {
        let revision = &front["board"]["programs"][number]["revision"];
        let frame = page.answer("board", json!({ "revision": revision }), &[]).unwrap();
        let array = |name: &str| {
            let array = frame.arrays.iter().find(|array| array.name == name).unwrap();
            let Values::F32(values) = &array.values else { panic!() };
            values.clone()
        };
        (frame.head["done"].clone(), array("areas"), array("holes"), array("tabs"))
    };
    let (about, areas, holes, tabs) = picture(0);
    let listed = about["areas"].as_array().unwrap();
    let count: u64 = listed.iter().map(|area| area["count"].as_u64().unwrap()).sum();
    assert_eq!(areas.len() as u64, 6 * count);
    assert_eq!((&listed[0]["kind"], &about["width"]), (&json!("board"), &json!(0.3)));
    assert!(listed.iter().any(|area| area["kind"] == "copper" && area["net"].is_string()));
    assert_eq!((holes.len() % 5, tabs.len()), (0, 0));
    assert!(!holes.is_empty());
    let (back, other, ..) = picture(2);
    assert!(other != areas);
    assert_eq!(back["turning"]["along"], "Y");
    let (.., tabs) = picture(3);
    // Four tabs, as where nothing else is said.
    assert_eq!(tabs.len(), 16);
    assert_eq!(page.refused("board", json!({ "revision": 0 })), "studio-limit");
}

#[test]
fn layers_are_posted_from_a_folder_and_from_uploads_and_nothing_else_is_read() {
    let studio = studio();
    let (track, edge) = (track(), edge(CLOSED));
    let folder = studio.own().join("plots");
    plots(&folder, &[("b.gtl", &track), ("b.gko", &edge)]);
    let mut page = studio.socket();
    // What leads out is not read, and not left out in silence.
    #[cfg(unix)]
    for (name, secret) in [("b.gbl", "secret.gbl"), ("toolpost.toml", "secret.toml")] {
        fs::write(studio.outside.path().join(secret), &track).unwrap();
        std::os::unix::fs::symlink(format!("../../{secret}"), folder.join(name)).unwrap();
        for source in [json!({ "folder": "plots" }), json!({ "file": "plots/b.gtl" })] {
            if name == "b.gbl" && source["file"].is_string() {
                continue;
            }
            let stop = refused(&mut page, source);
            assert_eq!(stop["findings"][0]["rule"], "folder-reach", "{name}: {stop}");
        }
        fs::remove_file(folder.join(name)).unwrap();
    }
    let of_folder = post(&mut page, json!({ "folder": "plots" }));
    assert_eq!(names(&of_folder["board"]["programs"]), ["front", "outline"]);
    assert_eq!(of_folder["board"]["name"], "plots");
    let upload = |name: &str, text: &str| {
        let (_, _, body) = studio.request(&format!("PUT /upload/{name}"), "", text.as_bytes());
        serde_json::from_slice::<Value>(&body).unwrap()["upload"].clone()
    };
    let ids = [upload("b.gtl", &track), upload("b.gko", &edge)];
    let of_uploads = post(&mut page, json!({ "uploads": ids }));
    // A file with options is no layer, and none that is left out.
    let more = [ids[0].clone(), ids[1].clone(), upload("toolpost.toml", "passes = 2\n")];
    let with_options = post(&mut page, json!({ "uploads": more }));
    assert_eq!(with_options["findings"], of_uploads["findings"]);
    assert_eq!(names(&of_uploads["board"]["programs"]), ["front", "outline"]);
    let cuts = |text: String| {
        let cuts = text.lines().filter(|line| line.starts_with(['G', 'X', 'Y', 'Z']));
        cuts.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(cuts(text_of(&mut page, &of_folder)), cuts(text_of(&mut page, &of_uploads)));
    assert_eq!(
        refused(&mut page, json!({ "folder": ".." }))["findings"][0]["rule"],
        "folder-reach"
    );
    assert_eq!(refused(&mut page, json!({ "folder": "no" }))["verdict"], "invalid");
    // Files that the options name are those of the folder.
    let named = json!({ "source": { "folder": "plots" }, "machine": MACHINE, "options": [["heights", "../secret.gbl"]] });
    assert_eq!(page.refused("post", named), "folder-reach");
}

/// A track, the holes and the edge: each move leads to the line of the file that draws what it cuts, and back.
#[test]
fn moves_of_a_board_and_lines_of_its_files_lead_to_each_other() {
    let studio = Studio::with(Some(options));
    let (track, edge) = (track(), edge(CLOSED));
    let holes = "M48\nMETRIC,TZ\nT1C0.800\n%\nT1\nX2.0Y2.0\nX8.0Y2.0\nM30\n";
    let files = [("b.gtl", &*track), ("b.gko", &*edge), ("b.drl", holes)];
    plots(&studio.own().join("board"), &files);
    let mut page = studio.socket();
    let front = post(&mut page, json!({ "folder": "board" }));
    assert_eq!(front["source"]["file"], "board");
    let listed: Vec<&str> = front["sources"]
        .as_array()
        .unwrap()
        .iter()
        .map(|text| text["file"].as_str().unwrap())
        .collect();
    assert_eq!(listed, ["b.drl", "b.gko", "b.gtl"]);
    for (program, file, lines) in [
        ("front", "b.gtl", &[6][..]),
        ("drill", "b.drl", &[6, 7]),
        ("outline", "b.gko", &[6, 7, 8, 9]),
    ] {
        let programs = front["board"]["programs"].as_array().unwrap();
        let own = programs.iter().find(|own| own["name"] == program).unwrap();
        let revision = &own["revision"];
        let mut seen = Vec::new();
        let job = page.done("job", json!({ "revision": revision }));
        for number in 0..job["walk"]["moves"].as_u64().unwrap() {
            let by = json!({ "revision": revision, "by": "move", "value": number });
            let place = page.done("place", by);
            let source = &place["source"];
            if source.is_null() {
                assert_ne!(place["kind"], "feed", "{program}: {place}");
                continue;
            }
            assert_eq!(source["file"], file, "{program}: {place}");
            let line = source["line"].as_u64().unwrap();
            let (_, text) = files.iter().find(|(name, _)| *name == file).unwrap();
            assert_eq!(source["text"], text.lines().nth(line as usize - 1).unwrap());
            let back = json!({ "revision": revision, "by": "source", "value": line, "file": file });
            assert_eq!(page.done("place", back)["source"], *source, "{program}");
            let ranges = place["source_moves"].as_array().unwrap();
            let of = |range: &Value| range[0].as_u64().unwrap()..range[1].as_u64().unwrap();
            assert!(ranges.iter().any(|range| of(range).contains(&number)), "{place}");
            seen.push(line);
        }
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen, lines, "{program}");
        // A line of a file that this program cuts nothing of leads nowhere, and so does one of the list of files.
        let other = if file == "b.gtl" { json!("b.drl") } else { json!("b.gtl") };
        for file in [other, Value::Null] {
            let by = json!({ "revision": revision, "by": "source", "value": 1, "file": file });
            assert!(page.done("place", by).is_null());
        }
    }
    // The text of each is there, and is searched.
    let revision = &front["revision"];
    let find =
        json!({ "revision": revision, "of": "source", "file": "b.drl", "text": "t1c", "from": 1 });
    assert_eq!(page.done("search", find)["line"], 3);
    // An edited program has them too.
    let job = edited(&mut page, json!({ "folder": "board" }), &front);
    let by = json!({ "revision": job["revision"], "by": "source", "value": 6, "file": "b.gtl" });
    assert_eq!(page.done("place", by)["source"]["file"], "b.gtl", "{job}");
}

#[test]
fn a_program_of_a_board_is_edited_proven_and_saved_by_itself() {
    let studio = studio();
    let mut page = studio.socket();
    let front = post(&mut page, json!({ "folder": "lamp" }));
    let drill = page.done("job", json!({ "revision": front["board"]["programs"][1]["revision"] }));
    let text = text_of(&mut page, &drill);
    let mut prove = |file: &str, text: &str| {
        let mut params = params(json!({ "folder": "lamp" }));
        params["file"] = json!(file);
        page.answer("prove", params, &[Array::text("text", text)])
            .map(|frame| frame.head["done"].clone())
    };
    let spaced = prove("drill.gcode", &text.replacen("G0 ", "G0  ", 1)).unwrap();
    assert_eq!((&spaced["verdict"], &spaced["board"]), (&json!("done"), &json!(null)), "{spaced}");
    assert_eq!(spaced["walk"]["moves"], drill["walk"]["moves"]);
    assert_eq!(spaced["walk"]["tools"][0]["width"], drill["walk"]["tools"][0]["width"]);
    // The first hole is not drilled as deep as it was.
    let (at, deep) = text.lines().enumerate().find(|(_, line)| line.contains("Z-")).unwrap();
    let shallow = text.replacen(deep, &deep.replacen("Z-", "Z-0.", 1).replacen(".1.", ".1", 1), 1);
    let failed = prove("drill.gcode", &shallow).unwrap();
    assert_eq!(failed["verdict"], "failed", "{failed}");
    // How deep a hole is is known when the tool comes up, in the next block.
    assert_eq!(failed["mismatch"]["program"], at + 2);
    // A name of none of its programs.
    for other in ["other.gcode", "drill.ngc"] {
        let stop = prove(other, &text).unwrap_err();
        assert_eq!(stop["findings"][0]["rule"], "no-such-part", "{other}");
    }
    // Beside the others it is said that their report is not of it, and the other way round; under no other name.
    let save = |of: &Value, path: &str| json!({ "revision": of["revision"], "path": path, "replace": true });
    page.done("save", save(&front, "out"));
    let saved = page.done("save", save(&spaced, "out/drill.gcode"));
    assert_eq!(saved["files"], json!(["out/drill.gcode", "out/drill.gcode.report.json"]));
    let found = |saved: &Value| {
        let found = &saved["findings"][0];
        (found["rule"].clone(), found["file"].clone())
    };
    assert_eq!(found(&saved), (json!("report-pair"), json!("out/report.json")));
    let whole = page.done("save", save(&front, "out"));
    assert_eq!(found(&whole), (json!("report-pair"), json!("out/drill.gcode.report.json")));
    assert_eq!(page.refused("save", save(&spaced, "out/front.gcode")), "output-file");
    assert_eq!(page.done("save", save(&spaced, "drill.gcode"))["findings"], json!([]));
}

#[test]
fn the_options_in_a_file_beside_a_board_are_taken() {
    let studio = studio();
    let mut page = studio.socket();
    let beside = studio.own().join("lamp/toolpost.toml");
    let mut saved = |source: Value| {
        let job = post(&mut page, source);
        let params = json!({ "revision": job["revision"], "path": "out", "replace": true });
        page.done("save", params);
        let report = fs::read(studio.own().join("out/report.json")).unwrap();
        let report = serde_json::from_slice::<Value>(&report).unwrap()["options"].clone();
        (report, told(&job["board"]))
    };
    assert_eq!(saved(json!({ "folder": "lamp" })), (json!([]), None));
    fs::write(beside, "passes = 2\n").unwrap();
    // The page says that they count.
    let row = Some(String::from("toolpost.toml 11"));
    for source in [json!({ "folder": "lamp" }), json!({ "file": "lamp/lamp.toml" })] {
        assert_eq!(saved(source), (json!(["toolpost.toml 11"]), row.clone()));
    }
    let front = post(&mut page, json!({ "folder": "lamp" }));
    assert_eq!(told(&edited(&mut page, json!({ "folder": "lamp" }), &front)), row);
}

/// A board that the server was started with is what its folder is when a page comes.
#[test]
fn what_comes_to_a_board_after_the_start_counts() {
    for (kind, path, comes) in [
        ("folder", "lamp", false),
        ("folder", "lamp", true),
        ("file", "lamp/lamp.toml", false),
        ("file", "lamp/lamp.toml", true),
    ] {
        let (source, machine) = (Some(path.into()), Some(MACHINE.into()));
        let settings = Settings { source, machine, options: Some(options), ..Settings::default() };
        let studio = Studio::started(settings, |own| {
            fs::create_dir(own.join("lamp")).unwrap();
            fs::copy(root().join("examples/lamp.toml"), own.join("lamp/lamp.toml")).unwrap();
        });
        // The system's clock for files goes by steps of some milliseconds.
        std::thread::sleep(Duration::from_millis(50));
        if comes {
            fs::write(studio.own().join("lamp/toolpost.toml"), "passes = 2\n").unwrap();
        }
        let job = post(&mut studio.socket(), json!({ kind: path }));
        assert_eq!(told(&job["board"]).is_some(), comes, "{path}");
    }
}

/// Options beside a board, and a file that they name, are files of it like those that it is drawn in.
#[test]
fn what_comes_to_a_board_while_it_is_open_is_noticed_and_what_it_made_before_is_not_saved() {
    let settings = Settings { options: Some(options), ..Settings::default() };
    let studio = Studio::started(settings, |own| {
        fs::create_dir(own.join("lamp")).unwrap();
        fs::copy(root().join("examples/lamp.toml"), own.join("lamp/lamp.toml")).unwrap();
    });
    let own = studio.own();
    let mut page = studio.socket();
    for (source, expected) in [
        (json!({ "file": "lamp/lamp.toml" }), &["lamp/toolpost.toml"][..]),
        (json!({ "folder": "lamp" }), &["lamp", "lamp/toolpost.toml"]),
    ] {
        let job = post(&mut page, source.clone());
        let programs = job["board"]["programs"].as_array().unwrap();
        fs::write(own.join("lamp/toolpost.toml"), "passes = 2\n").unwrap();
        // All programs of a board are of the same files.
        for program in programs {
            let changes = page.done("changes", json!({ "revision": program["revision"] }));
            let files = changes["files"].as_array().unwrap().iter();
            let paths: Vec<&str> = files.map(|file| file["path"].as_str().unwrap()).collect();
            assert_eq!(paths, expected, "{source}");
        }
        let save = json!({ "revision": job["revision"], "path": "out", "replace": true });
        assert_eq!(page.refused("save", save.clone()), "studio-changed");
        assert!(!own.join("out").exists());
        fs::remove_file(own.join("lamp/toolpost.toml")).unwrap();
        page.done("save", save);
        fs::remove_dir_all(own.join("out")).unwrap();
    }
}

/// What is said of options that stand in a file.
fn told(of: &Value) -> Option<String> {
    let mut rows = of["rows"].as_array().unwrap().iter();
    rows.find(|row| row[0] == "options").map(|row| row[1].as_str().unwrap().to_owned())
}

/// A program of a board, edited by one blank.
fn edited(page: &mut Socket, source: Value, job: &Value) -> Value {
    let text = text_of(page, job).replacen("G0 ", "G0  ", 1);
    let mut params = params(source);
    params["file"] = job["program"]["file"].clone();
    let frame = page.answer("prove", params, &[Array::text("text", text)]).unwrap();
    frame.head["done"].clone()
}

#[test]
fn beside_an_edited_program_stands_the_same_source() {
    let studio = studio();
    plots(&studio.own().join("plots"), &[("b.gtl", &track()), ("b.gko", &edge(CLOSED))]);
    let mut page = studio.socket();
    for folder in ["plots", "lamp"] {
        let front = post(&mut page, json!({ "folder": folder }));
        let edit = edited(&mut page, json!({ "folder": folder }), &front);
        assert_eq!((&edit["verdict"], &edit["source"]), (&json!("done"), &front["source"]));
        let mut source = |job: &Value| {
            let params =
                json!({ "revision": job["revision"], "of": "source", "from": 1, "to": 99 });
            page.answer("text", params, &[]).unwrap().take_text("text")
        };
        assert_eq!(source(&edit), source(&front), "{folder}");
    }
}

#[test]
fn what_cannot_be_made_is_left_out_and_the_rest_is_saved() {
    let studio = studio();
    plots(&studio.own().join("open"), &[("b.gtl", &track()), ("b.gko", &edge(""))]);
    let mut page = studio.socket();
    let job = post(&mut page, json!({ "folder": "open" }));
    let board = &job["board"];
    assert_eq!((&job["verdict"], &board["verdict"]), (&json!("done"), &json!("partly")), "{board}");
    assert_eq!(names(&board["programs"]), ["front"]);
    assert_eq!(board["left_out"][0]["file"], "outline.gcode");
    assert_eq!(board["left_out"][0]["findings"][0]["rule"], "outline-open");
    let findings = job["findings"].as_array().unwrap();
    assert!(findings.iter().any(|found| found["rule"] == "outline-open"), "{findings:?}");
    let params = json!({ "revision": job["revision"], "path": "out", "replace": false });
    assert_eq!(page.done("save", params)["files"], json!(["out/front.gcode", "out/report.json"]));
}

#[test]
fn what_is_no_board_is_refused_with_the_way_out() {
    let studio = studio();
    let own = studio.own();
    let board = "(kicad_pcb (version 20221018))";
    plots(&own.join("two"), &[("a.kicad_pcb", board), ("b.kicad_pcb", board)]);
    plots(&own.join("none"), &[("readme.md", "nothing")]);
    plots(&own.join("empty"), &[]);
    let mut page = studio.socket();
    for (folder, rule) in [("two", "board"), ("none", "no-board"), ("empty", "folder")] {
        let stop = refused(&mut page, json!({ "folder": folder }));
        assert_eq!(
            (&stop["verdict"], &stop["findings"][0]["rule"]),
            (&json!("invalid"), &json!(rule))
        );
        assert_ne!(stop["findings"][0]["help"], "", "{stop}");
    }
    let on_wire = json!({ "source": { "folder": "lamp" }, "machine": "bp-95d" });
    assert_eq!(page.refused("post", on_wire), "machine-kind");
    for uploads in [json!([]), json!(["99"])] {
        refused(&mut page, json!({ "uploads": uploads }));
    }
}

#[test]
fn the_server_says_which_command_makes_a_source() {
    let studio = studio();
    fs::write(studio.own().join("board.json"), r#"{ "nodes": {}, "tracks": [] }"#).unwrap();
    fs::copy(root().join("examples/bracket.json"), studio.own().join("bracket.json")).unwrap();
    let mut page = studio.socket();
    for (source, machine, command) in [
        // The name of JSON does not say what it is.
        (json!({ "file": "board.json" }), json!(null), "pcb"),
        (json!({ "file": "bracket.json" }), json!(null), "post"),
        (json!({ "file": "dome.cls" }), json!(null), "post"),
        (json!({ "file": "dome.cls" }), json!("bp-95d"), "wire"),
        (json!({ "file": "lamp/lamp.toml" }), json!(null), "pcb"),
        (json!({ "folder": "lamp" }), json!("bp-95d"), "pcb"),
    ] {
        let params = json!({ "source": source, "machine": machine });
        assert_eq!(page.done("command", params), command, "{source}");
    }
    let mut kinds = |source: Value| page.done("kinds", json!({ "source": source }));
    fs::write(studio.own().join("plate.DXF"), "0\nEOF\n").unwrap();
    fs::write(studio.own().join("points.txt"), "1 2 3\n").unwrap();
    for (file, machines) in [
        ("board.json", json!(["mill", "robot"])),
        ("lamp/lamp.toml", json!(["mill", "robot"])),
        ("bracket.json", json!(["mill", "robot", "wire"])),
        ("dome.cls", json!(["mill", "robot", "wire"])),
        ("plate.DXF", json!(["wire", "glass"])),
    ] {
        assert_eq!(kinds(json!({ "file": file })), machines, "{file}");
    }
    assert_eq!(kinds(json!({ "folder": "lamp" })), json!(["mill", "robot", "glass"]));
    for (file, rule) in [
        ("none.cls", "unreadable"),
        ("none.json", "unreadable"),
        ("lamp", "unreadable"),
        ("../x.cls", "folder-reach"),
    ] {
        let source = json!({ "file": file });
        assert_eq!(page.refused("kinds", json!({ "source": source })), rule, "{file}");
        let params = json!({ "source": source, "machine": null });
        assert_eq!(page.refused("command", params), rule, "{file}");
    }
}

#[test]
fn a_board_tells_its_steps_and_is_ended_in_the_midst_of_them() {
    let studio = studio();
    let mut page = studio.socket();
    let id = page.ask("post", params(json!({ "folder": "lamp" })), &[]);
    let mut steps = Vec::new();
    loop {
        let Said::Frame(frame) = page.next() else { panic!() };
        if frame.head["id"] != id {
            continue;
        }
        match frame.head.get("step") {
            Some(step) if frame.head["part"].is_null() => {
                steps.push(step.as_str().unwrap().to_owned());
            }
            None if frame.head.contains_key("done") => break,
            _ => {}
        }
    }
    steps.dedup();
    assert_eq!(steps, ["reading", "planning", "writing and proving", "drawing"]);
    let id = page.ask("post", params(json!({ "folder": "lamp" })), &[]);
    loop {
        let Said::Frame(frame) = page.next() else { panic!() };
        if frame.head.get("step").is_some_and(|step| step == "planning") {
            break;
        }
    }
    page.send(&json!({ "cancel": id }), &[]);
    assert_eq!(page.answer_of(id).unwrap_err()["verdict"], "cancelled");
}

/// A layer of many tracks across each other: uniting them is one long step, which is asked in between by nobody, and is refused at its end.
pub fn tangle() -> String {
    let mut layer = format!("{HEAD}%ADD10C,0.05*%\nD10*\n");
    for i in 1..60_000_u64 {
        let (x, y) = (i * 7919 % 99_000_000, i * 104_729 % 99_000_000);
        let (to_x, to_y) = ((x + 3_000_000) % 99_000_000, (y + 1_000_000) % 99_000_000);
        layer += &format!("X{x}Y{y}D02*\nX{to_x}Y{to_y}D01*\n");
    }
    layer + "M02*\n"
}

/// The page goes on at once, and a newer work is done beside the step that is left; no third one meanwhile.
#[test]
fn work_that_is_ended_in_a_long_step_is_left_at_once() {
    let studio = studio();
    fs::create_dir(studio.own().join("tangle")).unwrap();
    fs::write(studio.own().join("tangle/b-F_Cu.gbr"), tangle()).unwrap();
    let mut page = studio.socket();
    let mut cancelled = || {
        let id = page.ask("post", params(json!({ "folder": "tangle" })), &[]);
        std::thread::sleep(Duration::from_millis(500));
        let begun = Instant::now();
        page.send(&json!({ "cancel": id }), &[]);
        let stop = page.answer_of(id).unwrap_err();
        assert_eq!(stop["verdict"], "cancelled", "{stop}");
        begun.elapsed()
    };
    let soon = Duration::from_millis(300);
    let took = cancelled();
    assert!(took < soon, "{took:?}");
    let took = cancelled();
    assert!(took < soon, "{took:?}");
    let job = post(&mut page, json!({ "file": "lamp/lamp.toml" }));
    assert_eq!(job["verdict"], "done", "{job}");
}
