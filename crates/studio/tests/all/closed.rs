//! Who is not answered, and what is not taken: by raw sockets, as no browser sends it.

use crate::client::{Said, Studio, answer};
use serde_json::json;
use std::io::Write;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};
use toolpost_studio::Options;
use toolpost_studio::ask::Command;
use toolpost_studio::message::Array;
use toolpost_studio::server::More;

#[test]
fn a_request_names_this_server_and_comes_from_no_other_page() {
    let studio = Studio::new();
    let port = studio.port;
    let get = |host: &str, headers: &str| {
        let request = format!(
            "GET /moves/1/0 HTTP/1.1\r\nHost: {host}\r\nx-toolpost-token: {}\r\nConnection: close\r\n{headers}\r\n",
            studio.token
        );
        studio.raw(request.as_bytes()).0
    };
    let own = format!("127.0.0.1:{port}");
    // With the token and a good name: there is no such job.
    for host in [own.clone(), format!("localhost:{port}")] {
        assert_eq!(get(&host, ""), 404);
        assert_eq!(
            get(
                &host,
                &format!("Origin: http://127.0.0.1:{port}\r\nSec-Fetch-Site: same-origin\r\n")
            ),
            404
        );
    }
    // Names that a foreign page can have led here (rebinding), other ports, several names.
    for host in ["127.0.0.1", "evil.example", "localhost", "127.0.0.1:1", "[::1]:80", ""] {
        assert_eq!(get(host, ""), 421, "{host}");
    }
    assert_eq!(get(&format!("evil.example:{port}"), ""), 421);
    assert_eq!(get(&format!("127.0.0.1:{port}.evil.example"), ""), 421);
    assert_eq!(
        get(&format!("evil.example:{port}"), &format!("Origin: http://evil.example:{port}\r\n")),
        421
    );
    assert_eq!(get(&own, &format!("Host: evil.example:{port}\r\n")), 421);
    // Another name in the target, which counts before that of the header.
    let target =
        format!("GET http://evil.example/ HTTP/1.1\r\nHost: {own}\r\nConnection: close\r\n\r\n");
    assert_eq!(studio.raw(target.as_bytes()).0, 421);
    // HTTP/1.0 without a name.
    let (status, ..) = studio.raw(b"GET / HTTP/1.0\r\n\r\n");
    assert_eq!(status, 421);
    let origins =
        ["null", "http://evil.example", "https://127.0.0.1", "http://127.0.0.1", "file://", ""];
    for origin in origins.map(str::to_owned).into_iter().chain([
        format!("https://127.0.0.1:{port}"),
        format!("http://127.0.0.1:{port}/"),
        format!("http://127.0.0.1:{port}0"),
        format!("http://localhost:{port}\r\nOrigin: http://evil.example"),
    ]) {
        assert_eq!(get(&own, &format!("Origin: {origin}\r\n")), 403, "{origin}");
        let upgrade = studio.upgrade(&format!("Origin: {origin}\r\n"));
        let upgrade = upgrade.replace("Upgrade\r\nUpgrade", "Upgrade, close\r\nUpgrade");
        assert_eq!(studio.raw(upgrade.as_bytes()).0, 403, "{origin}");
    }
    for site in ["cross-site", "same-site", "x"] {
        assert_eq!(get(&own, &format!("Sec-Fetch-Site: {site}\r\n")), 403, "{site}");
    }
}

/// A window of the browser, and no frame of another page nor its script.
#[test]
fn a_window_may_be_led_to_the_page_from_elsewhere_and_to_nothing_else() {
    let studio = Studio::new();
    let led = |line: &str, mode: &str, dest: &str, more: &str| {
        let headers = format!(
            "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: {mode}\r\nSec-Fetch-Dest: {dest}\r\n{more}"
        );
        studio.request(line, &headers, b"").0
    };
    // The page, or where none is built that there is none.
    assert_eq!(led("GET /", "navigate", "document", ""), studio.request("GET /", "", b"").0);
    for (line, mode, dest, more) in [
        ("GET /", "navigate", "iframe", ""),
        ("GET /", "no-cors", "script", ""),
        ("GET /", "cors", "empty", ""),
        ("GET /", "navigate", "", ""),
        ("GET /", "navigate", "document", "Origin: null\r\n"),
        ("GET /", "navigate", "document", "Sec-Fetch-Dest: iframe\r\n"),
        ("POST /", "navigate", "document", ""),
        ("GET /index.html", "navigate", "document", ""),
        ("GET //", "navigate", "document", ""),
        ("GET /moves/1/0", "navigate", "document", ""),
        ("GET /socket", "navigate", "document", ""),
        ("PUT /upload/a", "navigate", "document", ""),
    ] {
        assert_eq!(led(line, mode, dest, more), 403, "{line} {mode} {dest} {more}");
    }
}

#[test]
fn nothing_but_the_page_is_answered_without_the_token() {
    let studio = Studio::new();
    let wrong = "0".repeat(64);
    for path in [
        "/geometry/1/index",
        "/moves/1/0",
        "/upload/a",
        "/x",
        "/assets/../../../etc/passwd",
        "/..%2f..%2fetc%2fpasswd",
    ] {
        for token in ["", &wrong, &studio.token[..63], &studio.token.to_uppercase()] {
            for method in ["GET", "PUT", "POST", "DELETE", "OPTIONS", "TRACE"] {
                let request = format!(
                    "{method} {path}?token={} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nCookie: token={}\r\nx-toolpost-token: {token}\r\nConnection: close\r\n\r\n",
                    studio.token, studio.port, studio.token
                );
                let (status, head, body) = studio.raw(request.as_bytes());
                // A token whose letters are all digits would be the same in capitals.
                assert_eq!(status, 401, "{method} {path}: {}", String::from_utf8_lossy(&body));
                assert!(!head.to_lowercase().contains("access-control"), "{head}");
            }
        }
    }
}

#[test]
fn every_answer_says_what_a_browser_may_do_with_it() {
    let studio = Studio::new();
    let good = studio.request("GET /moves/1/0", "", b"");
    let foreign = studio.request("GET /", "Origin: http://evil.example\r\n", b"");
    let page = studio.request("GET /", "", b"");
    for (status, head, _) in [good, foreign, page] {
        let head = head.to_lowercase();
        for line in [
            "content-security-policy: default-src 'none'; script-src 'self'; style-src 'self';",
            "x-content-type-options: nosniff",
            "referrer-policy: no-referrer",
            "cross-origin-opener-policy: same-origin",
            "cross-origin-resource-policy: same-origin",
            "cache-control: no-store",
        ] {
            assert!(head.contains(line), "{status} {line}: {head}");
        }
        assert!(!head.contains("unsafe-inline") && !head.contains("unsafe-eval"));
        for word in ["set-cookie", &studio.token] {
            assert!(!head.contains(word), "{head}");
        }
    }
}

#[test]
fn a_socket_brings_the_token_first_and_soon() {
    let studio = Studio::new();
    for first in [
        json!({ "token": "0".repeat(64) }),
        json!({ "token": "" }),
        json!({ "token": 1 }),
        json!({ "id": 1, "ask": "open", "params": {}, "token": studio.token }),
        json!({ "id": 1, "ask": "open" }),
        json!({}),
    ] {
        let mut socket = studio.silent_socket();
        socket.send(&first, &[]);
        assert!(matches!(socket.next(), Said::Closed(4401)), "{first}");
    }
    let mut socket = studio.silent_socket();
    socket.send_bytes(1, format!("{{\"token\":\"{}\"}}", studio.token).as_bytes());
    assert!(matches!(socket.next(), Said::Closed(4401)));
    let (mut silent, begun) = (studio.silent_socket(), Instant::now());
    assert!(matches!(silent.next(), Said::Closed(4401)));
    assert!((2..10).contains(&begun.elapsed().as_secs()), "{:?}", begun.elapsed());
    // One that sends more than a token is: some kB of it are taken, and what the system has under way.
    let mut large = studio.silent_socket();
    large.send_piece(0x82, 60 << 20, &[]);
    let piece = vec![0; 1 << 20];
    let sent = (0..60).take_while(|_| large.stream.write_all(&piece).is_ok()).count();
    assert!(sent < 30, "{sent} MB were taken");
    // One that stops in the middle of its first frame.
    let (mut stuck, begun) = (studio.silent_socket(), Instant::now());
    stuck.send_piece(0x82, 1000, b"begun");
    assert!(matches!(stuck.next(), Said::Closed(4401) | Said::Gone));
    assert!(begun.elapsed() < Duration::from_secs(10));
}

#[test]
fn broken_frames_close_the_socket_and_wrong_asks_do_not() {
    let studio = Studio::new();
    let mut page = studio.socket();
    for (ask, params) in [
        ("no-such-ask", json!({})),
        ("open", json!({ "x": 1 })),
        ("folder", json!({})),
        ("folder", json!({ "path": 7 })),
        ("post", json!({ "source": { "file": "dome.cls", "upload": "1" }, "machine": "iso" })),
        ("place", json!({ "revision": -1, "by": "time", "value": 0 })),
        ("place", json!({ "revision": 1, "by": "magic", "value": 0 })),
        ("prove", json!({ "source": { "file": "dome.cls" }, "machine": "iso" })),
    ] {
        assert_eq!(page.refused(ask, params.clone()), "studio-ask", "{ask} {params}");
    }
    page.send(&json!({ "id": 1.5, "ask": "open" }), &[]);
    page.send(&json!({ "cancel": "x" }), &[]);
    page.send(&json!({ "id": 1_000, "ask": "open", "params": [] }), &[]);
    assert_eq!(page.done("open", json!({}))["folder"], "own");
    for (kind, bytes) in
        [(2, &b"\xff\xff\xff\xff"[..]), (2, b""), (1, b"text"), (2, b"\x02\0\0\0{}\0\0more")]
    {
        let mut page = studio.socket();
        page.send_bytes(kind, bytes);
        assert!(matches!(page.next(), Said::Closed(4400)), "{bytes:?}");
    }
    // A message that says that it has a gigabyte, one that has no end, and bytes that are no frames.
    let mut page = studio.socket();
    page.send_piece(0x82, 1 << 30, b"x");
    assert!(matches!(page.next(), Said::Gone | Said::Closed(_)));
    let mut page = studio.socket();
    let piece = vec![0; 1 << 20];
    page.send_piece(0x02, piece.len() as u64, &piece);
    for _ in 0..80 {
        page.send_piece(0x00, piece.len() as u64, &piece);
    }
    assert!(matches!(page.next(), Said::Gone | Said::Closed(_)));
    let mut page = studio.socket();
    let _ = page.stream.write_all(&[0xff; 4096]);
    assert!(matches!(page.next(), Said::Gone | Said::Closed(_)));
}

#[test]
fn no_more_sockets_and_no_more_asks_than_there_are_places() {
    let studio = Studio::new();
    let sockets: Vec<_> = (0..16).map(|_| studio.socket()).collect();
    let mut refused = studio.stream();
    refused
        .write_all(
            studio
                .upgrade("")
                .replace("Connection: Upgrade", "Connection: Upgrade, close")
                .as_bytes(),
        )
        .unwrap();
    assert_eq!(answer(&mut refused).0, 503);
    drop(sockets);
    let begun = Instant::now();
    let mut page = loop {
        assert!(begun.elapsed() < Duration::from_secs(10));
        let mut stream = studio.stream();
        stream
            .write_all(
                studio
                    .upgrade("")
                    .replace("Connection: Upgrade", "Connection: Upgrade, close")
                    .as_bytes(),
            )
            .unwrap();
        stream.set_read_timeout(Some(Duration::from_millis(300))).unwrap();
        if answer(&mut stream).0 == 101 {
            break studio.socket();
        }
    };
    // An ask of an id that waits is refused, whatever it is; the others are answered all the same.
    for _ in 0..200 {
        page.send(&json!({ "id": 7, "ask": "machines", "params": {} }), &[]);
    }
    assert!(page.done("open", json!({}))["version"].is_string());
}

/// Options that name a tool table (`tools`) and folders of called programs (`folders`).
pub(crate) fn naming(
    _: Command,
    given: &[(String, String)],
    _: Option<&More>,
) -> Result<Options, app::Stop> {
    let mut options = Options::default();
    options.origin.from = Some(String::from("linuxcnc-mill"));
    for (name, value) in given {
        match &**name {
            "tools" => options.origin.tools = Some(app::Source::File(value.into())),
            _ => options.origin.folders.push(value.into()),
        }
    }
    Ok(options)
}

/// LinuxCNC: a program of a file of its own, called by its name (`O<sub> CALL`), and the table of tools.
#[cfg(unix)]
#[test]
fn no_tool_table_and_no_called_program_lies_outside() {
    let studio = Studio::with(Some(naming));
    let (own, outside) = (studio.own(), studio.outside.path());
    let sub = "o<sub> sub\nG1 X7 F100\no<sub> endsub\nM2\n";
    for folder in [outside.join("subs"), own.join("subs")] {
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(folder.join("sub.ngc"), sub).unwrap();
    }
    std::fs::create_dir(own.join("led")).unwrap();
    std::fs::create_dir(own.join("empty")).unwrap();
    std::os::unix::fs::symlink(outside.join("subs/sub.ngc"), own.join("led/sub.ngc")).unwrap();
    std::os::unix::fs::symlink(outside.join("subs"), own.join("out")).unwrap();
    std::fs::write(outside.join("tool.tbl"), "T1 P1 D6\n").unwrap();
    std::fs::write(own.join("tool.tbl"), "T1 P1 D6\n").unwrap();
    std::os::unix::fs::symlink("../tool.tbl", own.join("link.tbl")).unwrap();
    let program = "G21 G90 G17 G94 G40\nT1 M6\nS900 M3\nG0 X0 Y0 Z10\no<sub> call\nG0 Z20\nM2\n";
    std::fs::write(own.join("main.ngc"), program).unwrap();
    let mut page = studio.socket();
    let mut post = |name: &str, value: &str| {
        let params = json!({ "source": { "file": "main.ngc" }, "machine": "linuxcnc-mill", "options": [[name, value]] });
        match page.answer("post", params, &[]) {
            Ok(frame) => frame.head["done"]["verdict"].as_str().unwrap().to_owned(),
            Err(stop) => stop["findings"][0]["rule"].as_str().unwrap().to_owned(),
        }
    };
    assert_eq!(post("folders", "subs"), "done");
    for path in ["../subs", "out", "/etc", &outside.join("subs").display().to_string()] {
        assert_eq!(post("folders", path), "folder-reach", "{path}");
    }
    // A link in a folder that is named: there is no such program.
    assert_eq!([post("folders", "led"), post("folders", "empty")], ["o-word", "o-word"]);
    // Which table there is does not matter to a program without compensation; that one is read does.
    assert_ne!(post("tools", "tool.tbl"), "folder-reach");
    for path in ["../tool.tbl", "link.tbl", "/etc/passwd"] {
        assert_eq!(post("tools", path), "folder-reach", "{path}");
    }
}

#[test]
fn bodies_over_the_limit_are_refused() {
    let studio = Studio::new();
    let head = format!(
        "PUT /upload/a HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nx-toolpost-token: {}\r\nConnection: close\r\n",
        studio.port, studio.token
    );
    let begun = Instant::now();
    let (status, ..) = studio.raw(format!("{head}Content-Length: 300000000\r\n\r\nx").as_bytes());
    assert_eq!(status, 413);
    assert!(begun.elapsed() < Duration::from_secs(5));
    // One that does not say how long it is.
    let mut stream = studio.stream();
    stream.write_all(format!("{head}Transfer-Encoding: chunked\r\n\r\n").as_bytes()).unwrap();
    let piece = [format!("{:x}\r\n", 1 << 20).as_bytes(), &vec![b'x'; 1 << 20], b"\r\n"].concat();
    let sent = (0..300).take_while(|_| stream.write_all(&piece).is_ok()).count();
    assert!(sent < 300, "all was taken");
    for head in ["X-A: a\r\n".repeat(1000), format!("X-A: {}\r\n", "a".repeat(300_000))] {
        let (status, ..) = studio.request("GET /", &head, b"");
        assert!([431, 0].contains(&status), "{status}");
    }
    let (status, ..) = studio.request(&format!("GET /{}", "a".repeat(300_000)), "", b"");
    assert!([414, 431, 0].contains(&status), "{status}");
    assert_eq!(studio.request("PUT /upload/..%2Fa", "", b"x").0, 400);
    assert_eq!(studio.request("POST /upload/a", "", b"x").0, 405);
    assert_eq!(studio.request("PUT /upload/a", "", b"x").0, 200);
}

#[test]
fn ten_thousand_requests_at_once_are_answered_and_a_page_is_too() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let idle: Vec<_> = (0..60).map(|_| studio.stream()).collect();
    let refused = AtomicU32::new(0);
    let begun = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..100 {
            scope.spawn(|| {
                for _ in 0..100 {
                    let request = format!("GET /geometry/1/index HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\n\r\n", studio.port);
                    refused.fetch_add(u32::from(studio.raw(request.as_bytes()).0 == 401), Ordering::Relaxed);
                }
            });
        }
        for _ in 0..10 {
            let asked = Instant::now();
            page.done("folder", json!({ "path": "" }));
            assert!(asked.elapsed() < Duration::from_secs(5), "{:?}", asked.elapsed());
        }
    });
    assert_eq!(refused.into_inner(), 10_000);
    assert!(begun.elapsed() < Duration::from_secs(60), "{:?}", begun.elapsed());
    drop(idle);
}

#[test]
fn connections_that_say_nothing_are_closed() {
    let studio = Studio::new();
    let begun = Instant::now();
    let mut half = studio.stream();
    half.write_all(b"GET / HTTP/1.1\r\nHost: ").unwrap();
    let (status, ..) = answer(&mut half);
    assert!([408, 0].contains(&status), "{status}");
    assert!(begun.elapsed() < Duration::from_secs(30), "{:?}", begun.elapsed());
}

/// Heads that are never ended hold no place for longer than others need it.
#[test]
fn half_heads_hold_no_place_that_a_page_needs() {
    let studio = Studio::new();
    let halves: Vec<_> = (0..300)
        .map(|_| {
            let mut half = studio.stream();
            half.write_all(b"GET / HTTP/1.1\r\n").unwrap();
            half
        })
        .collect();
    let begun = Instant::now();
    assert_eq!(studio.socket().done("open", json!({}))["folder"], "own");
    assert!(begun.elapsed() < Duration::from_secs(2), "{:?}", begun.elapsed());
    drop(halves);
}

#[test]
fn nothing_outside_the_folder_is_read_or_written() {
    let studio = Studio::new();
    let own = studio.own();
    let mut page = studio.socket();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../secret.cls", own.join("link.cls")).unwrap();
        std::os::unix::fs::symlink("..", own.join("up")).unwrap();
        std::os::unix::fs::symlink("../written.nc", own.join("out.nc")).unwrap();
        assert!(
            std::process::Command::new("mkfifo")
                .arg(own.join("pipe.cls"))
                .status()
                .unwrap()
                .success()
        );
    }
    std::fs::write(own.join("mine.toml"), "extends = \"../other.toml\"\n").unwrap();
    std::fs::write(studio.outside.path().join("other.toml"), "extends = \"iso\"\n").unwrap();
    let outside = studio.outside.path().display().to_string();
    for path in [
        "../secret.cls",
        "link.cls",
        "up/secret.cls",
        &format!("{outside}/secret.cls"),
        "/etc/passwd",
        "own/../../secret.cls",
    ] {
        let source = json!({ "source": { "file": path }, "machine": "fanuc-table-bc" });
        let rule = page.refused("post", source);
        assert!(["folder-reach", "unreadable"].contains(&&*rule), "{path}: {rule}");
        let params = json!({ "source": { "file": "dome.cls" }, "machine": "fanuc-table-bc", "program": { "file": path } });
        assert!(
            ["folder-reach", "unreadable"].contains(&&*page.refused("prove", params)),
            "{path}"
        );
    }
    for path in ["..", "up", "/", &outside] {
        assert_eq!(page.refused("folder", json!({ "path": path })), "folder-reach", "{path}");
    }
    for machine in ["mine.toml", "../other.toml", "up/other.toml", &format!("{outside}/other.toml")]
    {
        let stop = page
            .answer("post", json!({ "source": { "file": "dome.cls" }, "machine": machine }), &[])
            .unwrap_err();
        let text = stop.to_string();
        assert!(
            text.contains("folder-reach") || text.contains("may not be read here"),
            "{machine}: {text}"
        );
    }
    // Nobody waits for a pipe or a device.
    assert_eq!(
        page.refused("post", json!({ "source": { "file": "pipe.cls" }, "machine": "iso" })),
        "unreadable"
    );
    assert_eq!(
        page.refused("post", json!({ "source": { "file": "/dev/zero" }, "machine": "iso" })),
        "folder-reach"
    );
    let job = page.post("dome.cls", "fanuc-table-bc");
    for path in ["../written.nc", "up/written.nc", "out.nc", "/tmp/written.nc"] {
        let params = json!({ "revision": job["revision"], "path": path, "replace": true });
        assert_eq!(page.refused("save", params), "folder-reach", "{path}");
    }
    for name in ["../a", "a/b", ".", ""] {
        let params = json!({ "name": name, "of": {} });
        let stop = page.answer("draft", params, &[Array::text("text", "x")]).unwrap_err();
        assert!(stop.to_string().contains("studio-ask"), "{name}: {stop}");
    }
    assert!(!studio.outside.path().join("written.nc").exists());
    assert_eq!(
        std::fs::read_to_string(studio.outside.path().join("secret.cls")).unwrap(),
        "secret"
    );
}

#[test]
fn files_that_change_or_vanish_do_not_matter_to_a_job_that_is_open() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let job = page.post("dome.cls", "fanuc-table-bc");
    std::fs::write(studio.own().join("dome.cls"), "GOTO/1,2,3\n").unwrap();
    let params = json!({ "revision": job["revision"], "by": "move", "value": 40 });
    let place = page.done("place", params.clone());
    assert!(place["source"]["text"].as_str().unwrap().contains("GOTO"), "{place}");
    std::fs::remove_file(studio.own().join("dome.cls")).unwrap();
    assert_eq!(page.done("place", params), place);
    let params = json!({ "source": { "file": "dome.cls" }, "machine": "fanuc-table-bc" });
    assert_eq!(page.refused("post", params), "unreadable");
}

#[test]
fn the_same_file_in_two_tabs_is_two_jobs() {
    let studio = Studio::new();
    let (mut one, mut other) = (studio.socket(), studio.socket());
    let params = json!({ "source": { "file": "dome.cls" }, "machine": "fanuc-table-bc" });
    let (first, second) = (one.ask("post", params.clone(), &[]), other.ask("post", params, &[]));
    let first = one.answer_of(first).unwrap().head["done"].clone();
    let second = other.answer_of(second).unwrap().head["done"].clone();
    assert_ne!(first["revision"], second["revision"]);
    assert_eq!((&first["verdict"], &first["walk"]), (&second["verdict"], &second["walk"]));
    // Each keeps its own edit: under the name of the other's nothing is kept or dropped.
    let draft = |text: &str| [Array::text("text", text)];
    one.answer("draft", json!({ "name": "d", "of": { "tab": 1 } }), &draft("one")).unwrap();
    let of = json!({ "name": "d", "of": { "tab": 2 } });
    let stop = other.answer("draft", of.clone(), &draft("two")).unwrap_err();
    assert_eq!(stop["findings"][0]["rule"], "studio-draft", "{stop}");
    assert_eq!(other.refused("drop_draft", json!({ "name": "d" })), "studio-draft");
    let mut kept = one.answer("draft_text", json!({ "name": "d" }), &[]).unwrap();
    assert_eq!(kept.take_text("text").unwrap(), b"one");
    other.answer("draft", json!({ "name": "d-2", "of": {} }), &draft("two")).unwrap();
    // What a page that has gone has kept is for whoever goes on with it.
    drop(one);
    let begun = Instant::now();
    while let Err(stop) = other.answer("draft", of.clone(), &draft("three")) {
        assert!(begun.elapsed() < Duration::from_secs(10), "{stop}");
    }
    other.done("drop_draft", json!({ "name": "d" }));
    assert_eq!(other.done("drafts", json!({}))[0]["name"], "d-2");
}
