//! Jobs: what is posted and proven, and what is asked of it.

use crate::client::{Said, Studio, root};
use serde_json::{Value, json};
use toolpost_studio::ask::Command;
use toolpost_studio::message::{Array, Values};
use toolpost_studio::server::More;
use toolpost_studio::{Options, Settings};

fn f32s(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks().0.iter().map(|chunk| f32::from_le_bytes(*chunk)).collect()
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

#[test]
fn a_source_is_posted_and_every_place_of_it_is_one() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let job = page.post("dome.cls", "fanuc-table-bc");
    assert_eq!(job["verdict"], "done", "{job}");
    let revision = &job["revision"];
    let moves = job["walk"]["moves"].as_u64().unwrap();
    assert!(moves > 100, "{}", job["walk"]);
    assert_eq!(job["machine"]["axes"].as_array().unwrap().len(), 5);
    assert_eq!(job["program"]["file"], "dome.nc");

    // By its number, its time, its block and its line of the source a move is at the same place.
    let mut place = |by: &str, value: &Value| {
        page.done("place", json!({ "revision": revision, "by": by, "value": value }))
    };
    // The last moves are those of the end, which no record of the source makes.
    for number in [1, 17, moves / 2, moves - 20] {
        let by_move = place("move", &json!(number));
        assert_eq!(by_move["move"], number);
        let by_block = place("block", &by_move["block"]["line"]);
        assert_eq!(by_block["block"], by_move["block"]);
        let by_source = place("source", &by_move["source"]["line"]);
        assert_eq!(by_source["source"], by_move["source"]);
        assert!(!by_move["block"]["text"].as_str().unwrap().is_empty());
        assert!(!by_move["template"]["name"].as_str().unwrap().is_empty(), "{by_move}");
    }
    let whole = job["walk"]["time_s"].as_f64().unwrap();
    let mut last = 0;
    for step in 0..=20 {
        let place = place("time", &json!(whole * f64::from(step) / 20.0));
        let number = place["move"].as_u64().unwrap();
        assert!(number >= last, "{place}");
        last = number;
    }
    assert_eq!(last, moves - 1);
    // Out of range is the nearest there is.
    assert_eq!(place("move", &json!(1e12))["move"], moves - 1);
    assert_eq!(place("time", &json!(-5))["time_s"], 0.0);
}

/// The server begins what it is started with; what has changed since, or is another work, is done by itself.
#[test]
fn the_first_work_is_joined_by_who_asks_for_the_same_and_nobody_else() {
    let start = || {
        let (source, machine) = (Some("dome.cls".into()), Some("fanuc-table-bc".into()));
        let studio = Studio::started(Settings { source, machine, ..Settings::default() }, |_| {});
        // The system's clock for files goes by steps of some milliseconds.
        std::thread::sleep(std::time::Duration::from_millis(50));
        studio
    };
    let studio = start();
    let job = studio.socket().post("dome.cls", "fanuc-table-bc");
    let other = Studio::new();
    let expected = other.socket().post("dome.cls", "fanuc-table-bc");
    for key in ["verdict", "rows", "findings", "program", "walk"] {
        assert_eq!(job[key], expected[key], "{key}");
    }
    let studio = start();
    let job = studio.socket().post("dome.cls", "sinumerik-840d-table-ac");
    assert_eq!(job["machine"]["name"], "sinumerik-840d-table-ac");
    let studio = start();
    std::fs::copy(root().join("examples/lean.cls"), studio.own().join("dome.cls")).unwrap();
    let job = studio.socket().post("dome.cls", "fanuc-table-bc");
    let expected = other.socket().post("lean.cls", "fanuc-table-bc");
    assert_eq!(job["walk"]["moves"], expected["walk"]["moves"]);
    // Why there is no job is said as to everybody, also where the file has gone meanwhile.
    let studio = start();
    std::fs::remove_file(studio.own().join("dome.cls")).unwrap();
    let params = json!({ "source": { "file": "dome.cls" }, "machine": "fanuc-table-bc" });
    assert_eq!(studio.socket().refused("post", params), "unreadable");
}

/// HEIDENHAIN: a circle takes two blocks, its centre and its end (Klartext, `CC` and `C`).
#[test]
fn a_place_has_all_blocks_of_its_record_and_all_moves_of_both() {
    let studio = Studio::new();
    let text = "UNITS/MM\nLOADTL/1\nSPINDL/900,CLW\nRAPID\nGOTO/30,0,10\nFEDRAT/90\nGOTO/30,0,-1\nCIRCLE/0,0,-1,0,0,1,30,0.03,0.5,16,0\nGOTO/0,30,-1\nGOTO/-5,30,-1\nRAPID\nGOTO/0,30,10\n";
    std::fs::write(studio.own().join("arc.cls"), text).unwrap();
    let mut page = studio.socket();
    let job = page.post("arc.cls", "generic-3axis-heidenhain");
    assert_eq!(job["verdict"], "done", "{job}");
    let revision = &job["revision"];
    let mut place = |by: &str, value: &Value| {
        page.done("place", json!({ "revision": revision, "by": by, "value": value }))
    };
    let arc = place("source", &json!(9));
    assert_eq!((&arc["kind"], &arc["source"]["line"]), (&json!("arc"), &json!(9)), "{arc}");
    let line = arc["block"]["line"].as_u64().unwrap();
    assert!(arc["block"]["text"].as_str().unwrap().contains(" C X+0 Y+30"), "{arc}");
    // The centre stands in the block before.
    assert_eq!(arc["blocks"], json!([{ "file": null, "ranges": [[line - 1, line + 1]] }]));
    let at = arc["move"].as_u64().unwrap();
    assert_eq!(arc["block_moves"], json!([[at, at + 1]]));
    assert_eq!(arc["source_moves"], json!([[at, at + 1]]));
    let next = place("source", &json!(10));
    assert_eq!(next["blocks"], json!([{ "file": null, "ranges": [[line + 1, line + 2]] }]));
    // Of a source there is one text, called by its name or not at all.
    let mut text = |of: &str, file: &Value| {
        page.answer(
            "text",
            json!({ "revision": revision, "of": of, "file": file, "from": 1, "to": 2 }),
            &[],
        )
    };
    text("source", &json!("arc.cls")).unwrap();
    let stop = text("source", &json!("/etc/passwd")).unwrap_err();
    assert_eq!(stop["findings"][0]["rule"], "studio-ask", "{stop}");
    let mut place = |by: &str, value: &Value| {
        page.done("place", json!({ "revision": revision, "by": by, "value": value }))
    };
    // Lines count from 1: there is nothing on line 0.
    assert_eq!(place("source", &json!(0)), Value::Null);
    assert_eq!(place("block", &json!(0)), Value::Null);
    assert_eq!(place("block", &json!(1))["move"], 0);
}

/// The axes of a place, through the forward chain of the machine, are its tip.
#[test]
fn between_the_ends_of_a_cut_the_axes_lead_the_tip() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let job = page.post("dome.cls", "sinumerik-840d-table-ac");
    let machine = machine::load("sinumerik-840d-table-ac").unwrap();
    let whole = job["walk"]["time_s"].as_f64().unwrap();
    let numbers = |value: &Value| -> Option<Vec<f64>> {
        value.as_array().unwrap().iter().map(Value::as_f64).collect()
    };
    let (mut checked, mut turned) = (0, 0);
    for step in 0..400 {
        let time = whole * f64::from(step) / 400.0;
        let params = json!({ "revision": job["revision"], "by": "time", "value": time });
        let place = page.done("place", params);
        let (Some(tip), Some(axes)) = (numbers(&place["tip"]), numbers(&place["axes"])) else {
            continue;
        };
        if place["kind"] == "rapid" {
            continue;
        }
        let mut degrees = [0.0; 3];
        for (axis, position) in machine.rotary.iter().zip(&axes[3..]) {
            degrees[axis.index()] = *position;
        }
        let zero = machine.work_zero.unwrap().to_array();
        let linear = [0, 1, 2].map(|axis| axes[axis] - zero[axis]);
        let (at, _) = machine.forward(linear.into(), degrees, 0.0);
        let off = at.distance([tip[0], tip[1], tip[2]].into());
        assert!(off < 1e-9, "{off} mm: {place}");
        checked += 1;
        turned += u32::from(degrees.iter().any(|degrees| *degrees != 0.0));
    }
    assert!(checked > 100 && turned > 50, "{checked} {turned}");
}

#[test]
fn the_geometry_is_that_of_the_moves() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let job = page.post("dome.cls", "fanuc-table-bc");
    let (revision, walk) = (&job["revision"], &job["walk"]);
    let index = studio.get(&format!("/geometry/{revision}/index"));
    assert_eq!(index.len(), 64 * walk["chunks"].as_u64().unwrap() as usize);
    let vertices = studio.get(&format!("/geometry/{revision}/0/0"));
    assert_eq!(vertices.len() / 16, u32_at(&index, 48) as usize);
    let rows = studio.get(&format!("/moves/{revision}/0"));
    let row = walk["row"].as_u64().unwrap() as usize;
    assert_eq!(row, 40);
    assert_eq!(rows.len(), row * walk["moves"].as_u64().unwrap() as usize);
    // The last vertex of a move is its tip, its row has its block and its line.
    for number in [3u32, 40, 200] {
        let params = json!({ "revision": revision, "by": "move", "value": number });
        let place = page.done("place", params);
        let of_move = |vertex: &&[u8]| u32_at(vertex, 12) & 4095 == number;
        let vertex = vertices.chunks(16).rfind(of_move).unwrap();
        let origin =
            |axis: usize| f64::from_le_bytes(index[8 * axis..8 * axis + 8].try_into().unwrap());
        for (axis, value) in f32s(&vertex[..12]).into_iter().enumerate() {
            let tip = place["tip"][axis].as_f64().unwrap();
            assert!((f64::from(value) + origin(axis) - tip).abs() < 1e-4, "{place}");
        }
        let at = row * number as usize;
        assert_eq!(place["block"]["line"], u32_at(&rows, at + 4));
        assert_eq!(place["source"]["line"], u32_at(&rows, at + 8));
    }
    // The rows end with the deviations: the largest of them is that of the walk, and within the tolerance.
    let deviations = rows.chunks(row).map(|row| f64::from(f32s(&row[36..])[0]));
    let largest = deviations.filter(|mm| mm.is_finite()).fold(0.0, f64::max);
    assert!(
        (walk["deviation"].as_f64().unwrap() - largest).abs() < 1e-7 && largest > 0.0,
        "{largest}"
    );
    // From above, a pixel a millimetre, with the zero point in the middle of the window.
    let view = "400,300/1,0,0,0,-1,0,0,0,-1,200,150,0/0/all";
    let sight = studio.get(&format!("/geometry/{revision}/sight/{view}"));
    assert_eq!((&sight[..4], &sight[4..8]), (&[1, 0, 0, 0][..], &[0; 4][..]));
    assert!(sight.len() > 12 + 32, "{}", sight.len());
    for path in [
        "fine/0",
        "sight/400,300",
        "0/99",
        "9/0",
        "x/0",
        "0/-1",
        "0/0/0",
        "index/0",
        "0/1-9",
        "0/0-0",
        "0/1-0",
        "0/-1-1",
        "0/0-",
        "0/0-1-2",
        "9/0-1",
    ] {
        let (status, ..) = studio.request(&format!("GET /geometry/{revision}/{path}"), "", b"");
        assert_eq!(status, 404, "{path}");
    }
}

#[test]
fn an_edit_is_proven_and_one_that_cuts_otherwise_is_refused_and_not_saved() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let job = page.post("dome.cls", "fanuc-table-bc");
    let lines = job["program"]["lines"].as_u64().unwrap();
    let params =
        json!({ "revision": job["revision"], "of": "program", "from": 1, "to": lines + 1 });
    let mut frame = page.answer("text", params, &[]).unwrap();
    let text = String::from_utf8(frame.take_text("text").unwrap()).unwrap();
    assert_eq!(text.lines().count() as u64, lines);
    let prove = |page: &mut crate::client::Socket, text: &str| {
        let params = json!({ "source": { "file": "dome.cls" }, "machine": "fanuc-table-bc", "file": "dome.nc" });
        let frame = page.answer("prove", params, &[Array::text("text", text)]).unwrap();
        frame.head["done"].clone()
    };
    let same = prove(&mut page, &text);
    assert_eq!((&same["verdict"], &same["walk"]["moves"]), (&json!("done"), &job["walk"]["moves"]));
    // One coordinate is off by a millimetre.
    let (at, line) =
        text.lines().enumerate().filter(|(_, line)| line.contains(" X")).nth(40).unwrap();
    let edited = line.replacen(" X", " X1", 1);
    let edited: Vec<&str> =
        text.lines().enumerate().map(|(i, line)| if i == at { &edited } else { line }).collect();
    let failed = prove(&mut page, &(edited.join("\n") + "\n"));
    assert_eq!(failed["verdict"], "failed");
    assert_eq!(failed["mismatch"]["program"], at + 1, "{}", failed["mismatch"]);
    assert_eq!(failed["findings"][0]["of"], "program");
    let mismatch = failed["walk"]["mismatch"].as_u64().unwrap();
    assert!(mismatch > 0 && mismatch < job["walk"]["moves"].as_u64().unwrap());
    let save = |revision: &Value, path: &str, replace: bool| json!({ "revision": revision, "path": path, "replace": replace });
    assert_eq!(page.refused("save", save(&failed["revision"], "dome.nc", true)), "output-file");
    assert!(!studio.own().join("dome.nc").exists());
    // What is proven is saved, with its report, and not over what is there unless that is said.
    let saved = page.done("save", save(&job["revision"], "dome.nc", false));
    assert_eq!(saved["files"], json!(["dome.nc", "dome.nc.report.json"]));
    assert_eq!(std::fs::read_to_string(studio.own().join("dome.nc")).unwrap(), text);
    assert_eq!(page.refused("save", save(&job["revision"], "dome.nc", false)), "output-file");
    page.done("save", save(&job["revision"], "dome.nc", true));
    assert_eq!(page.refused("save", save(&job["revision"], "../dome.nc", true)), "folder-reach");
    assert_eq!(page.refused("save", save(&job["revision"], "dome.cls", true)), "output-file");
    // A machine file of the folder, of this program or of another, is no place for a program.
    std::fs::write(studio.own().join("mine.toml"), "extends = \"iso\"\n").unwrap();
    for name in ["mine.toml", "new.TOML"] {
        assert_eq!(
            page.refused("save", save(&job["revision"], name, true)),
            "output-file",
            "{name}"
        );
    }
    assert!(
        std::fs::read_to_string(studio.own().join("mine.toml")).unwrap().starts_with("extends")
    );
    for name in [".toolpost/dome.nc", ".toolpost/drafts/dome.nc", "a\nb.nc", " ", "dome.nc/", ""] {
        assert_eq!(
            page.refused("save", save(&job["revision"], name, true)),
            "output-file",
            "{name:?}"
        );
    }
    // An edit that is proven replaces the report too: it belongs to what is saved.
    let spaced = text.replacen("G90 ", "G90  ", 1);
    assert_ne!(spaced, text);
    let edited = prove(&mut page, &spaced);
    let saved = page.done("save", save(&edited["revision"], "dome.nc", true));
    assert_eq!(saved["files"], json!(["dome.nc", "dome.nc.report.json"]));
    let report = std::fs::read(studio.own().join("dome.nc.report.json")).unwrap();
    let report: Value = serde_json::from_slice(&report).unwrap();
    let own = program::Digest::of([spaced.as_bytes()]);
    assert_eq!(report["sha256"]["program"], json!(own));
    assert_eq!(report["proof"]["proven"], true);
    assert_eq!(report["program"]["file"], "dome.nc");
}

/// The report says the name of the file that is saved, for what is found in the program too; of a source that was called as the program
/// was before it keeps the name.
#[test]
fn a_report_names_the_file_that_is_saved() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let source = "UNITS/MM\nLOADTL/1\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/90\nNOSUCHWORD/1\nGOTO/9,0,-1\nRAPID\nGOTO/9,0,10\n";
    for name in ["part.cls", "part.nc"] {
        std::fs::write(studio.own().join(name), source).unwrap();
        let params = |file: &str| json!({ "source": { "file": name }, "machine": "generic-3axis-haas", "file": file });
        let posted = page.done("post", params("part.nc"));
        let text = json!({ "revision": posted["revision"], "of": "program", "from": 1, "to": 99 });
        let mut frame = page.answer("text", text, &[]).unwrap();
        let text = String::from_utf8(frame.take_text("text").unwrap()).unwrap();
        // All axes go home together: a warning of the proof.
        let edited = text.replacen("G91 G28 Z0", "G91 G28", 1);
        let frame = page.answer("prove", params("part.nc"), &[Array::text("text", edited)]);
        let edited = frame.unwrap().head["done"].clone();
        for (job, homes) in [(&posted, 0), (&edited, 1)] {
            assert_eq!(job["verdict"], "done", "{job}");
            for saved in ["other.nc", "under/third.nc"] {
                std::fs::create_dir_all(studio.own().join("under")).unwrap();
                let save = json!({ "revision": job["revision"], "path": saved, "replace": true });
                page.done("save", save);
                let report =
                    std::fs::read(studio.own().join(format!("{saved}.report.json"))).unwrap();
                let report: Value = serde_json::from_slice(&report).unwrap();
                let saved = saved.rsplit('/').next().unwrap();
                assert_eq!(
                    (&report["program"]["file"], &report["source"]["file"]),
                    (&json!(saved), &json!(name))
                );
                let files = |list: &Value, rule: &str| -> Vec<Value> {
                    let list = list.as_array().unwrap().iter();
                    list.filter(|found| found["rule"] == rule)
                        .map(|found| found["file"].clone())
                        .collect()
                };
                assert_eq!(files(&report["warnings"], "home"), vec![json!(saved); homes]);
                assert_eq!(files(&report["proof"]["warnings"], "home"), vec![json!(saved); homes]);
                let of_source: Vec<Value> = report["warnings"]
                    .as_array()
                    .unwrap()
                    .iter()
                    .filter(|found| found["message"].as_str().unwrap().contains("NOSUCHWORD"))
                    .map(|found| found["file"].clone())
                    .collect();
                assert_eq!(of_source, [name], "{report:#}");
            }
        }
    }
}

#[test]
fn a_plot_has_the_least_and_the_most_of_each_pixel() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let job = page.post("dome.cls", "fanuc-table-bc");
    let whole = &job["walk"]["time_s"];
    let mut plot = |what: &str, pixels: u32| {
        let params = json!({ "revision": job["revision"], "what": what, "from": 0, "to": whole, "pixels": pixels });
        let frame = page.answer("plot", params, &[])?;
        let values = |name: &str| {
            let array = frame.arrays.iter().find(|array| array.name == name).unwrap();
            let Values::F32(values) = &array.values else { panic!() };
            values.clone()
        };
        Ok::<_, Value>((values("least"), values("most")))
    };
    let (one_least, one_most) = plot("X", 1).unwrap();
    let (least, most) = plot("X", 640).unwrap();
    assert_eq!((least.len(), most.len()), (640, 640));
    let fold =
        |values: &[f32], with: fn(f32, f32) -> f32| values.iter().copied().fold(f32::NAN, with);
    assert_eq!(fold(&least, f32::min), one_least[0]);
    assert_eq!(fold(&most, f32::max), one_most[0]);
    assert!(least.iter().zip(&most).all(|(least, most)| least <= most || least.is_nan()));
    let (deviation, _) = plot("deviation", 1).unwrap();
    assert!(deviation[0] >= 0.0, "{deviation:?}");
    assert_eq!(plot("Q", 10).unwrap_err()["findings"][0]["rule"], "studio-ask");
    assert_eq!(plot("feed", 1_000_000).unwrap().0.len(), 10_000);
}

#[test]
fn a_newer_ask_ends_the_older_and_a_page_can_end_its_own() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let params = json!({ "source": { "file": "dome.cls" }, "machine": "sinumerik-840d-table-ac" });
    let first = page.ask("post", params.clone(), &[]);
    let second = page.ask("post", params.clone(), &[]);
    let stop = page.answer_of(first).unwrap_err();
    assert_eq!(
        (&stop["verdict"], &stop["findings"][0]["rule"]),
        (&json!("cancelled"), &json!("cancelled"))
    );
    assert_eq!(page.answer_of(second).unwrap().head["done"]["verdict"], "done");
    let third = page.ask("post", params, &[]);
    page.send(&json!({ "cancel": third }), &[]);
    assert_eq!(page.answer_of(third).unwrap_err()["verdict"], "cancelled");
    page.send(&json!({ "cancel": 12345 }), &[]);
    assert_eq!(page.done("folder", json!({ "path": "" }))["entries"].as_array().unwrap().len(), 2);
}

#[test]
fn a_job_tells_its_steps() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let params = json!({ "source": { "file": "dome.cls" }, "machine": "fanuc-table-bc" });
    page.ask("post", params, &[]);
    let mut steps = Vec::new();
    loop {
        let Said::Frame(frame) = page.next() else { panic!() };
        match frame.head.get("step") {
            Some(step) if frame.head["part"].is_null() => {
                steps.push(step.as_str().unwrap().to_owned())
            }
            Some(_) => assert!((0.0..=1.0).contains(&frame.head["part"].as_f64().unwrap())),
            None if frame.head.contains_key("event") => {}
            None => break,
        }
    }
    assert_eq!(steps, ["reading", "writing", "proving", "drawing"]);
}

/// A page draws what the proof has walked before it ends: chunk after chunk, each once.
#[test]
fn what_a_proof_has_walked_is_shown_while_it_runs() {
    let studio = Studio::new();
    let mut source =
        String::from("UNITS/MM\nLOADTL/1\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/90\n");
    for i in 0..60_000 {
        source += &format!("GOTO/{}.{:03},{},-1\n", i / 1000, i % 1000, i % 7);
    }
    std::fs::write(studio.own().join("long.cls"), source + "RAPID\nGOTO/0,0,10\n").unwrap();
    let mut page = studio.socket();
    let params = json!({ "source": { "file": "long.cls" }, "machine": "generic-3axis-linuxcnc" });
    page.ask("post", params, &[]);
    let (mut chunks, mut events, mut moves) = (0u64, 0, 0);
    let job = loop {
        let Said::Frame(frame) = page.next() else { panic!() };
        if let Some(done) = frame.head.get("done") {
            break done.clone();
        }
        if frame.head["event"] != "walked" {
            continue;
        }
        events += 1;
        assert_eq!(
            (&frame.head["file"], &frame.head["chunk"]),
            (&json!("long.ngc"), &json!(chunks))
        );
        let bytes = |name: &str| {
            let array = frame.arrays.iter().find(|array| array.name == name).unwrap();
            let Values::U8(bytes) = &array.values else { panic!() };
            bytes.clone()
        };
        let (index, vertices) = (bytes("index"), bytes("vertices"));
        let entries = index.chunks(64);
        let counts: usize = entries.clone().map(|entry| u32_at(entry, 48) as usize).sum();
        assert_eq!(vertices.len(), 16 * counts);
        assert_eq!(u32_at(&index, 36), chunks as u32 * 4096);
        chunks += entries.len() as u64;
        moves = frame.head["moves"].as_u64().unwrap();
        assert!((chunks - 1) * 4096 < moves && moves <= chunks * 4096, "{moves}");
        assert!(frame.head["time_s"].as_f64().unwrap() > 0.0);
    };
    assert!(events > 0, "{chunks}");
    // With the answer all of it was shown.
    assert_eq!((&job["walk"]["chunks"], &job["walk"]["moves"]), (&json!(chunks), &json!(moves)));
    // What is drawn behind the verdict is what the whole walk gives.
    assert_eq!(job["verdict"], "done", "{job}");
    let index = studio.get(&format!("/geometry/{}/index", job["revision"]));
    let counts: u64 = index.chunks(64).map(|entry| u64::from(u32_at(entry, 48))).sum();
    assert_eq!(job["walk"]["levels"][0]["vertices"], counts);
    // Several chunks in one answer are those that are asked for one by one.
    let path = |chunks: &str| format!("/geometry/{}/0/{chunks}", job["revision"]);
    let each: Vec<Vec<u8>> =
        (0..chunks).map(|chunk| studio.get(&path(&chunk.to_string()))).collect();
    for (range, of) in [("0-99", &each[..]), ("2-5", &each[2..5]), ("14-15", &each[14..])] {
        let several = studio.get(&path(range));
        let (heads, rest) = several.split_at(4 + 4 * of.len());
        let (heads, _) = heads.as_chunks();
        let heads: Vec<usize> =
            heads.iter().map(|head| u32::from_le_bytes(*head) as usize).collect();
        let lengths: Vec<usize> = of.iter().map(|chunk| chunk.len() / 16).collect();
        assert_eq!((heads[0], &heads[1..]), (of.len(), &lengths[..]), "{range}");
        assert_eq!(rest, of.concat(), "{range}");
    }
}

#[test]
fn uploads_are_posted_and_the_oldest_job_goes() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let bytes = std::fs::read(studio.own().join("dome.cls")).unwrap();
    let (status, _, body) = studio.request("PUT /upload/a%20dome.cls", "", &bytes);
    let upload: Value = serde_json::from_slice(&body).unwrap();
    assert_eq!((status, upload["bytes"].as_u64()), (200, Some(bytes.len() as u64)));
    let params = json!({ "source": { "upload": upload["upload"] }, "machine": "linuxcnc-xyzbc" });
    let job = match page.answer("post", params, &[]) {
        Ok(frame) => frame.head["done"].clone(),
        Err(stop) => panic!("{stop}"),
    };
    assert_eq!(job["source"]["file"], "a dome.cls");
    assert_eq!(upload["name"], "a dome.cls");
    // The id is of this file alone: the next server has the same for it, and another file has another.
    let own = program::Digest::of([&b"a dome.cls"[..], &bytes]);
    assert_eq!(upload["upload"], json!(own));
    assert_eq!(
        page.refused("post", json!({ "source": { "upload": "99" }, "machine": "x" })),
        "studio-limit"
    );
    for _ in 0..8 {
        page.post("lean.cls", "fanuc-table-bc");
    }
    let place = json!({ "revision": job["revision"], "by": "move", "value": 1 });
    assert_eq!(page.refused("place", place), "studio-limit");
}

#[test]
fn a_wire_is_posted_by_the_options_of_its_own_command() {
    use app::wire::{Settings, Sync};
    fn options(
        command: Command,
        given: &[(String, String)],
        _: Option<&More>,
    ) -> Result<Options, app::Stop> {
        assert_eq!(command, Command::Wire);
        let cutting = wire::cutting::Cutting {
            side: Some(wire::cutting::Side::Inside),
            wire: 0.25,
            gap: 0.02,
            thread: vec![[15.0, 15.0].into()],
            round_corners: true,
            feeds: vec![0.1],
            ..wire::cutting::Cutting::default()
        };
        let settings = Settings {
            layers: Vec::new(),
            close: 0.01,
            upper: None,
            sync: Sync::Block,
            pairs: Vec::new(),
            height: None,
            uv_height: None,
            cutting,
            step: None,
            memory: None,
            select: None,
        };
        let from = given.first().map(|(_, from)| from.clone());
        let origin = app::Origin { from, ..app::Origin::default() };
        Ok(Options { origin, wire: Some(settings), ..Options::default() })
    }
    let studio = Studio::with(Some(options));
    std::fs::copy(root().join("examples/sector.nc"), studio.own().join("sector.nc")).unwrap();
    let mut page = studio.socket();
    let params = json!({ "source": { "file": "sector.nc" }, "machine": "fanuc-wire", "options": [["from", "fanuc-31i"]] });
    let job = match page.answer("post", params.clone(), &[]) {
        Ok(frame) => frame.head["done"].clone(),
        Err(stop) => panic!("{stop}"),
    };
    assert_eq!(
        (&job["verdict"], &job["machine"]["kind"]),
        (&json!("done"), &json!("wire")),
        "{job}"
    );
    // `N20` goes to where the wire is threaded, for the rapid of the source; the cuts are of their own lines.
    let mut place = |by: &str, line: u32| {
        page.done("place", json!({ "revision": job["revision"], "by": by, "value": line }))
    };
    for place in [place("block", 4), place("source", 5)] {
        let found = (&place["block"]["text"], &place["source"]["line"]);
        assert_eq!(found, (&json!("N20 G0 X15. Y15."), &json!(5)), "{place}");
    }
    for (source, kind) in [(6, "feed"), (7, "arc"), (8, "feed")] {
        let place = place("source", source);
        assert_eq!((&place["source"]["line"], &place["kind"]), (&json!(source), &json!(kind)));
    }
    let place =
        page.done("place", json!({ "revision": job["revision"], "by": "move", "value": 3 }));
    assert_eq!(place["axes"].as_array().unwrap().len(), 5);
    assert!(!place["template"]["name"].as_str().unwrap().is_empty(), "{place}");
    let saved =
        page.done("save", json!({ "revision": job["revision"], "path": "w.nc", "replace": false }));
    assert_eq!(saved["files"], json!(["w.nc", "w.nc.report.json"]));
    let report = |name: &str| -> Value {
        let report = studio.own().join(format!("{name}.report.json"));
        serde_json::from_slice(&std::fs::read(report).unwrap()).unwrap()
    };
    assert_eq!(report("w.nc")["program"]["file"], "w.nc");
    assert!(report("w.nc")["instructions"].is_array());
    // An edit is proven against the contour: a blank more is the same program, a place that is off by a tenth is not.
    let lines = job["program"]["lines"].as_u64().unwrap();
    let text = json!({ "revision": job["revision"], "of": "program", "from": 1, "to": lines + 1 });
    let mut frame = page.answer("text", text, &[]).unwrap();
    let text = String::from_utf8(frame.take_text("text").unwrap()).unwrap();
    let mut prove = |text: &str| {
        let frame = page.answer("prove", params.clone(), &[Array::text("text", text)]).unwrap();
        frame.head["done"].clone()
    };
    let spaced = prove(&text.replacen(" X", "  X", 1));
    assert_eq!(
        (&spaced["verdict"], &spaced["walk"]["moves"]),
        (&json!("done"), &job["walk"]["moves"]),
        "{spaced}"
    );
    // The last block that says X goes back to where the wire is threaded.
    let cut = text.lines().rfind(|line| line.contains(" X")).unwrap();
    let word = cut.split(' ').find(|word| word.starts_with('X')).unwrap();
    let x: f64 = word[1..].parse().unwrap();
    let moved = cut.replacen(word, &format!("X{:.3}", x + 0.1), 1);
    let failed = prove(&text.replacen(cut, &moved, 1));
    assert_eq!(failed["verdict"], "failed", "{failed}");
    let line = text.lines().position(|line| line == cut).unwrap() + 1;
    assert_eq!(failed["mismatch"]["program"], line);
    let save = json!({ "revision": spaced["revision"], "path": "edited.nc", "replace": false });
    let saved = page.done("save", save);
    assert_eq!(saved["files"], json!(["edited.nc", "edited.nc.report.json"]));
    assert_eq!(report("edited.nc")["program"]["file"], "edited.nc");
}

#[test]
fn a_finding_that_stands_for_many_leads_to_all_of_them() {
    let studio = Studio::new();
    let mut source =
        String::from("UNITS/MM\nLOADTL/1\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/90\n");
    for i in 0..30 {
        // A word of the CAM system that says nothing to a machine: a warning each.
        source += &format!("PAINT/COLOR,{i}\nGOTO/{i},0,-1\nNOSUCHWORD/{i}\n");
    }
    source += "RAPID\nGOTO/0,0,10\n";
    std::fs::write(studio.own().join("many.cls"), source).unwrap();
    let job = studio.socket().post("many.cls", "generic-3axis-linuxcnc");
    let findings = job["findings"].as_array().unwrap();
    let many =
        findings.iter().find(|found| found["count"] == 30).unwrap_or_else(|| panic!("{job}"));
    let lines: Vec<u64> = (0..30).map(|i| 9 + 3 * i).collect();
    assert_eq!(many["line"], lines[0]);
    assert_eq!(many["places"], json!(lines[1..]));
    assert_eq!(many["of"], "source");
}

/// Files of a divided program that a shorter one in its place does not call stay on the controller too: they are named, as `toolpost post` names them.
#[test]
fn parts_of_a_longer_program_are_named_where_a_shorter_one_takes_its_place() {
    let studio = Studio::new();
    let rows = |count: usize| {
        let row = |i: usize| {
            let (y, cut) = (30.0 + i as f64, "GOTO/80,{},0\nGOTO/100,{},0\nGOTO/120,{},0\n");
            let cut = cut.replace("{}", &y.to_string());
            format!("RAPID\nGOTO/80,{y},20\nFEDRAT/MMPM,600\n{cut}RAPID\nGOTO/120,{y},20\n")
        };
        let rows: String = (0..count).map(row).collect();
        format!(
            "PARTNO/JOB\nUNITS/MM\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\n{rows}SPINDL/OFF\nFINI\n"
        )
    };
    let own = "extends = \"fanuc-lrmate-200id-mill\"\n\n[capabilities]\nprogram_lines = 60\n";
    for (name, text) in [("mine.toml", own), ("long.cls", &rows(30)), ("short.cls", &rows(2))] {
        std::fs::write(studio.own().join(name), text).unwrap();
    }
    let mut page = studio.socket();
    let save =
        |job: &Value| json!({ "revision": job["revision"], "path": "job.ls", "replace": true });
    let post = |source: &str| json!({ "source": { "file": source }, "machine": "mine.toml", "options": [], "file": "job.ls" });
    let long = page.done("post", post("long.cls"));
    assert!(long["parts"].as_array().unwrap().len() > 1, "{}", long["parts"]);
    assert_eq!(page.done("save", save(&long))["findings"], json!([]));
    let short = page.done("post", post("short.cls"));
    assert_eq!(short["parts"], json!([]));
    let found = &page.done("save", save(&short))["findings"][0];
    assert_eq!((&found["rule"], &found["file"]), (&json!("output-file"), &json!("job.ls")));
    let message = found["message"].as_str().unwrap();
    assert!(message.starts_with("job_1.ls, job_2.ls"), "{message}");
}

/// The shape of a tool is that of the toolpath: the control knows its number, or its name, alone, and that of a robot not even that.
#[test]
fn tools_have_the_shape_that_the_toolpath_gives_them() {
    let studio = Studio::new();
    std::fs::copy(root().join("examples/plate.cls"), studio.own().join("plate.cls")).unwrap();
    let mut page = studio.socket();
    let tools = |job: &Value| -> Vec<Value> {
        let tools = job["walk"]["tools"].as_array().unwrap().iter();
        let shape = |tool: &Value| {
            json!([tool["number"], tool["diameter"], tool["corner"], tool["length"]])
        };
        tools.map(shape).collect()
    };
    // By `LOADTL` and `CUTTER`.
    let plate = json!([
        [1, 40.0, 0.0, null],
        [2, 10.0, 0.5, null],
        [3, 6.0, 3.0, null],
        [4, 8.0, 0.0, null],
        [5, 6.8, 0.0, null],
        [6, 8.0, 0.0, null]
    ]);
    let mills = [
        "generic-3axis-fanuc",
        "generic-3axis-haas",
        "generic-3axis-linuxcnc",
        "generic-3axis-heidenhain",
        "generic-3axis-sinumerik",
    ];
    let mut program = String::new();
    for mill in mills {
        let job = page.post("plate.cls", mill);
        assert_eq!(json!(tools(&job)), plate, "{mill}: {}", job["walk"]["tools"]);
        // Each begins where its first move does, behind the one before.
        let starts = job["walk"]["tools"].as_array().unwrap().iter();
        let starts: Vec<u64> = starts.map(|tool| tool["move"].as_u64().unwrap()).collect();
        assert!(starts.is_sorted_by(|a, b| a < b), "{mill}: {starts:?}");
        if mill == mills[0] {
            let text =
                json!({ "revision": job["revision"], "of": "program", "from": 1, "to": 100_000 });
            let mut frame = page.answer("text", text, &[]).unwrap();
            program = String::from_utf8(frame.take_text("text").unwrap()).unwrap();
        }
    }
    // A program beside the toolpath.
    let params = json!({ "source": { "file": "plate.cls" }, "machine": mills[0] });
    let mut prove = |text: &str| {
        let frame = page.answer("prove", params.clone(), &[Array::text("text", text)]).unwrap();
        frame.head["done"].clone()
    };
    assert_eq!(json!(tools(&prove(&program))), plate);
    // Another tool than that of the toolpath is none whose shape is known.
    assert!(program.contains("T1 M6"), "{program}");
    let other = prove(&program.replacen("T1 M6", "T9 M6", 1));
    let (first, others) = (json!([9, null, null, null]), &plate.as_array().unwrap()[1..]);
    assert_eq!(other["verdict"], "failed");
    assert_eq!(tools(&other), [&[first], others].concat(), "{}", other["walk"]);
    // By name on a control that calls tools so; from `TLDATA`, whose length is none from the gauge line.
    let dome = json!([[1, 16.0, 0.0, null], [2, 8.0, 4.0, null], [3, 6.8, 0.0, null]]);
    for mill in ["fanuc-table-bc", "sinumerik-840d-traori"] {
        let job = page.post("dome.cls", mill);
        assert_eq!(json!(tools(&job)), dome, "{mill}: {}", job["walk"]["tools"]);
    }
    assert_eq!(
        page.post("dome.cls", "sinumerik-840d-traori")["walk"]["tools"][1]["name"],
        "BALL_8"
    );
    // A robot, whose tools are changed by hand.
    let robot = "PARTNO/JOB\nUNITS/MM\nTLDATA/MILL,8,1,50,0,0\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/80,30,20\nFEDRAT/MMPM,600\nGOTO/80,30,0\nGOTO/100,30,0\nRAPID\nGOTO/100,30,20\nFINI\n";
    std::fs::write(studio.own().join("robot.cls"), robot).unwrap();
    for robot in ["kuka-kr6-r900", "fanuc-lrmate-200id-mill", "abb-irb120-mill", "universal-ur5e"] {
        let job = page.post("robot.cls", robot);
        assert_eq!(json!(tools(&job)), json!([[1, 8.0, 1.0, 50.0]]), "{robot}: {job}");
    }
}

/// The tool is drawn back where a rotary axis has to be turned back in the cut, and comes back to the same place.
#[test]
fn each_excursion_begins_with_the_move_that_leaves_the_cut() {
    let studio = Studio::new();
    let mut page = studio.socket();
    let job = page.post("dome.cls", "sinumerik-840d-traori");
    let (walk, revision) = (&job["walk"], job["revision"].as_u64().unwrap());
    let listed = walk["excursions"].as_array().unwrap();
    let turned_back = |found: &&Value| found["rule"] == "rewind";
    let finding = job["findings"].as_array().unwrap().iter().find(turned_back).unwrap();
    assert_eq!(
        (json!(listed.len()), &walk["excursions_in_all"]),
        (finding["count"].clone(), &json!(listed.len()))
    );
    let mut at = |by: &str, value: &Value| {
        page.done("place", json!({ "revision": revision, "by": by, "value": value }))
    };
    for excursion in listed {
        let first = at("move", &excursion["move"]);
        assert_eq!(first["kind"], "rapid", "{first}");
        let before = at("move", &json!(excursion["move"].as_u64().unwrap() - 1));
        assert_eq!(before["kind"], "feed", "{before}");
        let lift = excursion["lift_mm"].as_f64().unwrap();
        assert!(lift > 0.0, "{excursion}");
    }
}

/// A machine that cannot do what the source asks for: the source is shown, its path is drawn, and the findings lead into it.
#[test]
fn a_source_that_the_machine_cannot_cut_is_shown_without_a_program() {
    let studio = Studio::new();
    let far = "UNITS/MM\nLOADTL/1\nCUTTER/10,1\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/90\nGOTO/0,0,-1\nGOTO/99000,0,-1\nCIRCLE/99000,5,-1,0,0,1,5\nGOTO/99000,10,-1\nRAPID\nGOTO/99000,10,10\nFINI\n";
    std::fs::write(studio.own().join("far.cls"), far).unwrap();
    let mut page = studio.socket();
    let job = page.post("far.cls", "linuxcnc-mill");
    assert_eq!((&job["verdict"], &job["program"]), (&json!("failed"), &Value::Null), "{job}");
    let finding = job["findings"]
        .as_array()
        .unwrap()
        .iter()
        .find(|found| found["severity"] == "error")
        .unwrap();
    assert_eq!(
        (&finding["rule"], &finding["of"], &finding["line"]),
        (&json!("axis-limit"), &json!("source"), &json!(9)),
        "{job}"
    );
    assert_eq!((&job["source"]["lines"], &job["walk"]["moves"]), (&json!(14), &json!(5)));
    assert_eq!(job["walk"]["tools"][0]["diameter"], 10.0);
    // By hand: 11 mm down, from where nobody knows at first, 99 m along and half a circle of 5 mm, at 90 mm/min.
    let cuts = (11.0 + 99_000.0 + 5.0 * std::f64::consts::PI) / 90.0 * 60.0;
    assert!((job["walk"]["time_s"].as_f64().unwrap() - cuts).abs() < 0.01, "{}", job["walk"]);
    let place =
        page.done("place", json!({ "revision": job["revision"], "by": "source", "value": 9 }));
    assert_eq!(
        (&place["tip"], &place["source"]["line"]),
        (&json!([99_000.0, 0.0, -1.0]), &json!(9)),
        "{place}"
    );
    assert_eq!(
        (&place["axes"], &place["block_moves"]),
        (&json!([null, null, null]), &json!([[2, 3]]))
    );
    let middle = page
        .done("place", json!({ "revision": job["revision"], "by": "time", "value": cuts - 1.0 }));
    assert_eq!((&middle["kind"], &middle["template"]), (&json!("arc"), &Value::Null), "{middle}");
    assert_eq!(
        page.refused(
            "save",
            json!({ "revision": job["revision"], "path": "far.ngc", "replace": true })
        ),
        "output-file"
    );
    assert!(!studio.own().join("far.ngc").exists());
    // A lean on three axes, and a robot that does not reach.
    for (source, machine, rule) in [
        ("lean.cls", "generic-3axis-fanuc", "unreachable-orientation"),
        ("far.cls", "universal-ur5e", "arm-path"),
        ("far.cls", "kuka-kr120-rail", "arm-path"),
    ] {
        let job = page.post(source, machine);
        let rules: Vec<&Value> =
            job["findings"].as_array().unwrap().iter().map(|found| &found["rule"]).collect();
        assert!(rules.contains(&&json!(rule)), "{machine}: {rules:?}");
        assert_eq!(
            (&job["verdict"], &job["program"]),
            (&json!("failed"), &Value::Null),
            "{machine}"
        );
        let place =
            page.done("place", json!({ "revision": job["revision"], "by": "move", "value": 3 }));
        assert_eq!(
            place["axes"].as_array().unwrap().len(),
            job["machine"]["axes"].as_array().unwrap().len(),
            "{machine}: {place}"
        );
        for chunk in ["index", "0/0", "sight/400,300/1,0,0,0,-1,0,0,0,-1,200,150,0/0/all"] {
            assert!(!studio.get(&format!("/geometry/{}/{chunk}", job["revision"])).is_empty());
        }
        studio.get(&format!("/moves/{}/0", job["revision"]));
    }
}

/// A file of a job, in each of the ways in which it is read.
#[test]
fn what_a_job_was_made_of_is_watched_and_no_program_of_other_files_is_saved() {
    let studio = Studio::started(Settings::default(), |own| {
        std::fs::create_dir(own.join("shop")).unwrap();
        std::fs::write(own.join("shop/base.toml"), "extends = \"generic-3axis-linuxcnc\"\n")
            .unwrap();
        std::fs::write(own.join("mill.toml"), "extends = \"shop/base.toml\"\n").unwrap();
        std::fs::copy(root().join("examples/plate.cls"), own.join("plate.cls")).unwrap();
    });
    let own = studio.own();
    let mut page = studio.socket();
    let listed = page.done("machines", json!({}));
    let names: Vec<&str> =
        listed.as_array().unwrap().iter().filter_map(|entry| entry["name"].as_str()).collect();
    assert!(names.ends_with(&["mill.toml", "shop/base.toml"]), "{names:?}");
    let none = json!({ "files": [], "state": "" });
    assert_eq!(page.done("changes", json!({ "revision": null })), none);
    for (path, of, more) in [
        ("plate.cls", "source", "$$ another\n"),
        ("mill.toml", "machine", "title = \"Other\"\n"),
        ("shop/base.toml", "machine", "title = \"Base\"\n"),
    ] {
        let job = page.post("plate.cls", "mill.toml");
        assert_eq!(job["machine"]["files"][2]["file"], "mill.toml");
        let revision = job["revision"].clone();
        let asked = json!({ "revision": revision });
        assert_eq!(page.done("changes", asked.clone()), none, "{path}");
        let before = std::fs::read(own.join(path)).unwrap();
        let after = [more.as_bytes(), &before].concat();
        let save = json!({ "revision": revision, "path": "out.ngc", "replace": true });
        std::fs::write(own.join(path), &after).unwrap();
        let changes = page.done("changes", asked.clone());
        let files = json!([{ "path": path, "of": of, "is_gone": false }]);
        assert_eq!(changes["files"], files);
        // As long as it stays so, it is the same; and no program of what it was is saved.
        assert_eq!(page.done("changes", asked.clone()), changes);
        assert_eq!(page.refused("save", save.clone()), "studio-changed");
        std::fs::remove_file(own.join(path)).unwrap();
        let gone = page.done("changes", asked.clone());
        assert_eq!(gone["files"][0]["is_gone"], true);
        assert_ne!(gone["state"], changes["state"]);
        assert_eq!(page.refused("save", save.clone()), "studio-changed");
        assert!(!own.join("out.ngc").exists());
        std::fs::write(own.join(path), &before).unwrap();
        assert_eq!(page.done("changes", asked), none, "{path}");
        page.done("save", save);
        std::fs::remove_file(own.join("out.ngc")).unwrap();
    }
    // What gave no job is watched too, by the page that has asked for it.
    std::fs::write(own.join("shop/base.toml"), "extends = \"generic-3axis-linuxcnc\"\nspeed = 1\n")
        .unwrap();
    let params = json!({ "source": { "file": "plate.cls" }, "machine": "mill.toml" });
    let stop = page.answer("post", params, &[]).unwrap_err();
    // A file is called as the page calls it.
    assert_eq!(stop["findings"][0]["file"], "shop/base.toml", "{stop}");
    assert_eq!(page.done("changes", json!({ "revision": null })), none);
    std::fs::write(own.join("shop/base.toml"), "extends = \"generic-3axis-linuxcnc\"\n").unwrap();
    let changes = page.done("changes", json!({ "revision": null }));
    assert_eq!(changes["files"][0]["path"], "shop/base.toml");
    assert_eq!(studio.socket().done("changes", json!({ "revision": null })), none);
}

/// The proof of an edit reads the new files: what has changed behind the posting was taken for seen.
#[test]
fn what_has_changed_behind_a_posting_has_changed_for_an_edit_of_it() {
    let studio = Studio::started(Settings::default(), |own| {
        std::fs::write(own.join("mill.toml"), "extends = \"generic-3axis-linuxcnc\"\n").unwrap();
        std::fs::copy(root().join("examples/plate.cls"), own.join("plate.cls")).unwrap();
    });
    let mut page = studio.socket();
    let posted = page.post("plate.cls", "mill.toml");
    let text = crate::boards::text_of(&mut page, &posted) + "(by hand)\n";
    let path = studio.own().join("mill.toml");
    let before = std::fs::read(&path).unwrap();
    std::fs::write(&path, [&before[..], b"title = \"Other\"\n"].concat()).unwrap();
    let mut revision = posted["revision"].clone();
    let changed = json!([{ "path": "mill.toml", "of": "machine", "is_gone": false }]);
    // More keys do not make it old.
    for _ in 0..2 {
        let params = json!({
            "source": { "file": "plate.cls" }, "machine": "mill.toml", "file": "plate.ngc", "revision": revision,
        });
        let frame = page.answer("prove", params, &[Array::text("text", &*text)]).unwrap();
        revision = frame.head["done"]["revision"].clone();
        assert_eq!(page.done("changes", json!({ "revision": revision }))["files"], changed);
        let save = json!({ "revision": revision, "path": "out.ngc", "replace": true });
        assert_eq!(page.refused("save", save), "studio-changed");
    }
    std::fs::write(&path, &before).unwrap();
    assert_eq!(page.done("changes", json!({ "revision": revision }))["files"], json!([]));
}

/// LinuxCNC: a program of a file of its own, called by its name (`O<sub> CALL`), in the folder that is named.
#[test]
fn a_called_program_that_is_broken_or_yet_to_come_is_watched() {
    let studio = Studio::with(Some(crate::closed::naming));
    let own = studio.own();
    let program = "G21 G90 G17 G94 G40\nT1 M6\nS900 M3\nG0 X0 Y0 Z10\no<sub> call\nG0 Z20\nM2\n";
    std::fs::write(own.join("main.ngc"), program).unwrap();
    std::fs::create_dir(own.join("subs")).unwrap();
    let good = "o<sub> sub\nG1 X7 F100\no<sub> endsub\nM2\n";
    let whole = own.join("subs").display().to_string();
    // The folder of the studio itself is one, too.
    for (folder, path) in [("subs", "subs/sub.ngc"), (&whole, "subs/sub.ngc"), (".", "sub.ngc")] {
        for bad in [None, Some("o<sub> sub\nG1 X7 F100 G77.7\no<sub> endsub\nM2\n"), Some("")] {
            match bad {
                Some(text) => std::fs::write(own.join(path), text).unwrap(),
                None => assert!(!own.join(path).exists()),
            }
            let mut page = studio.socket();
            let params = json!({
                "source": { "file": "main.ngc" }, "machine": "linuxcnc-mill", "options": [["folders", folder]],
            });
            page.answer("post", params.clone(), &[]).unwrap_err();
            std::fs::write(own.join(path), good).unwrap();
            let changes = page.done("changes", json!({ "revision": null }));
            assert_ne!(changes["files"], json!([]), "{folder} {bad:?}");
            assert_eq!(page.done("post", params)["verdict"], "done", "{folder} {bad:?}");
        }
        std::fs::remove_file(own.join(path)).unwrap();
    }
}
