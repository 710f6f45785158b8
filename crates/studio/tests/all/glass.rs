//! Jobs inside glass.

use crate::client::{Said, Socket, Studio};
use app::glass::job::{Order, Placing, Settings};
use glass::curve::Layers;
use glass::fill::{Fill, Filling, Shells, direction};
use glass::list::Columns;
use glass::optics::Ray;
use glass::order::Effort;
use glass::picture::{Manner, Plane, Setting};
use glass::scenario::Scenario;
use serde_json::{Value, json};
use std::fs;
use toolpost_studio::Options;
use toolpost_studio::ask::Command;
use toolpost_studio::message::{Array, Values};
use toolpost_studio::server::More;

const MACHINE: &str = "glass-xyz-100hz";

/// A block of 20 x 20 x 30 mm of K9 under the lens of 70 mm. The words are those of the command that these tests need.
fn settings(given: &[(String, String)]) -> app::glass::Settings {
    let of = |name: &str| given.iter().find(|(own, _)| own == name).map(|(_, value)| &**value);
    let placing = Placing {
        block: if of("block") == Some("large") {
            [1700.0, 1700.0, 30.0]
        } else {
            [20.0, 20.0, 30.0]
        },
        margin: 2.0,
        scale: None,
        fit: false,
        turn: [0.0; 3],
        mirror: [false; 3],
        shift: [0.0; 3],
    };
    let job = Settings {
        placing,
        alone: Vec::new(),
        blocks: of("blocks").map_or(1, |blocks| blocks.parse().unwrap()),
        focal: 70.0,
        spacing: None,
        filling: Filling {
            fill: if of("fill") == Some("shaded") { Fill::Shaded(false) } else { Fill::Surface },
            step: None,
            direction: direction(2, [0.0; 3]),
        },
        shells: Shells { count: 1, distance: None },
        layers: Layers::default(),
        ray: Ray::Marginal,
        order: match of("order") {
            Some("arcs") => Order::Scenario(Scenario::Arcs),
            Some("kdz") => Order::Kdz(0.1, 0.1),
            _ => Order::Fastest,
        },
        effort: Effort { rounds: 1, tries: 10, until: None },
        seed: 1,
        accept_shadowed: false,
    };
    let picture = Setting {
        plane: Plane::Xz,
        width: None,
        manner: Manner::Dither,
        invert: false,
        sheets: (1, None),
    };
    let (material, columns) = (String::from("k9"), Columns::default());
    app::glass::Settings { material, materials: None, columns, picture, job }
}

fn options(
    command: Command,
    given: &[(String, String)],
    _: Option<&More>,
) -> Result<Options, app::Stop> {
    let glass = (command == Command::Glass).then(|| Box::new(settings(given)));
    Ok(Options { glass, ..Options::default() })
}

/// A sphere of a radius, mm, as a text STL.
fn sphere(radius: f64) -> String {
    let at = |i: i32, j: i32| {
        let (a, b) = (f64::from(i) * 0.2617993878, f64::from(j) * 0.2617993878);
        let [x, y, z] = [a.sin() * b.cos(), a.sin() * b.sin(), a.cos()];
        format!("vertex {:.6} {:.6} {:.6}\n", radius * x, radius * y, radius * z)
    };
    let mut text = String::from("solid s\n");
    for (i, j) in (0..12).flat_map(|i| (0..24).map(move |j| (i, j))) {
        for corners in [[(i, j), (i + 1, j), (i, j + 1)], [(i, j + 1), (i + 1, j), (i + 1, j + 1)]]
        {
            text.push_str("facet normal 0 0 0\nouter loop\n");
            corners.iter().for_each(|(i, j)| text.push_str(&at(*i, *j)));
            text.push_str("endloop\nendfacet\n");
        }
    }
    text + "endsolid s\n"
}

const DOTS: &str = "0 0 0\n1 0 0\n0 0 2\n";

/// A studio whose folder has a list of three points, a ball and a machine whose programs are binary.
fn studio() -> Studio {
    let studio = Studio::with(Some(options));
    fs::write(studio.own().join("dots.xyz"), DOTS).unwrap();
    fs::write(studio.own().join("ball.stl"), sphere(3.0)).unwrap();
    let machine = app::glass::library(MACHINE).unwrap();
    let binary = machine.replace("\"numbered\"", "\"binary\"");
    fs::write(studio.own().join("binary.toml"), binary).unwrap();
    studio
}

fn params(source: &str, machine: &str, options: &[(&str, &str)]) -> Value {
    json!({ "source": { "file": source }, "machine": machine, "options": options })
}

fn post(page: &mut Socket, source: &str, machine: &str, options: &[(&str, &str)]) -> Value {
    match page.answer("post", params(source, machine, options), &[]) {
        Ok(frame) => frame.head["done"].clone(),
        Err(stop) => panic!("{stop}"),
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect()
}

fn is_near(found: &Value, expected: &[f64], most: f64) {
    let found = numbers(found);
    let far = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(found.len() == expected.len() && far <= most, "{found:?} {expected:?}");
}

fn f32s(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks().0.iter().map(|chunk| f32::from_le_bytes(*chunk)).collect()
}

/// By hand: the list is centred in the block, so that its points lie at 9.5 10 14, 10.5 10 14 and 9.5 10 16. At 7.5 m/s² and 0.1 m/s a
/// millimetre takes 2 √(0.001 / 7.5) s = 23.1 ms, which are three ticks of 10 ms; so do 2 mm of depth, for which the lens is driven
/// 2 / 1.52007 mm (26.5 ms): tan 2.0454° / tan 1.3459°, by the outermost ray of a beam of 5 mm at f = 70 mm and Snell's law for 1.5195.
#[test]
fn each_pulse_is_a_move_with_its_place_its_block_and_its_time() {
    let studio = studio();
    let mut page = studio.socket();
    let job = post(&mut page, "dots.xyz", MACHINE, &[]);
    assert_eq!((&job["verdict"], &job["walk"]["moves"]), (&json!("done"), &json!(3)), "{job}");
    assert_eq!(job["program"]["file"], "dots.prg");
    assert_eq!(job["machine"]["kind"], "glass");
    let axes: Vec<_> = job["machine"]["axes"].as_array().unwrap().iter().collect();
    assert_eq!((axes.len(), &axes[2]["low"], &axes[2]["high"]), (3, &json!(-100.0), &json!(10.0)));
    assert_eq!(job["walk"]["time_s"], 0.07);
    let rows = job["rows"].as_array().unwrap();
    assert!(rows.iter().any(|row| row[1].as_str().unwrap().starts_with("0.07 s, 7 ticks")));
    let block = json!([{ "corner": [0.0, 0.0, 0.0],
        "sides": [[20.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 30.0]] }]);
    assert_eq!(job["blocks"], block);
    let revision = &job["revision"];
    let mut place = |by: &str, value: f64| {
        page.done("place", json!({ "revision": revision, "by": by, "value": value }))
    };
    let tips = [[9.5, 10.0, 14.0], [10.5, 10.0, 14.0], [9.5, 10.0, 16.0]];
    let mut made = Vec::new();
    for number in 0..3 {
        let by_move = place("move", f64::from(number));
        assert_eq!(by_move["kind"], "pulse");
        assert!(
            (by_move["time_s"].as_f64().unwrap() - [0.01, 0.04, 0.07][number as usize]).abs()
                < 1e-9
        );
        // Whole µm of the drive are 1.52 µm of depth.
        let tip = numbers(&by_move["tip"]);
        let near = |at: &[f64; 3]| (0..3).all(|axis| (tip[axis] - at[axis]).abs() < 1.6e-3);
        made.push(tips.iter().position(near).unwrap());
        let drive = [tip[0], tip[1], (tip[2] - 30.0) / 1.52007];
        is_near(&by_move["axes"], &drive, 1e-3);
        // BEGIN stands before the pulses.
        assert_eq!(by_move["block"]["line"], number + 2);
        let text = by_move["block"]["text"].as_str().unwrap();
        assert!(text.starts_with(&format!("N{} PULSE X{:.3}", number + 2, tip[0])), "{text}");
        let by_block = place("block", f64::from(number + 2));
        assert_eq!(by_block["move"], number);
        // The list has a point on each of its lines.
        let line = made[number as usize] + 1;
        assert_eq!(
            (&by_block["source"]["file"], &by_block["source"]["line"]),
            (&Value::Null, &json!(line))
        );
    }
    made.sort_unstable();
    assert_eq!(made, [0, 1, 2]);
    // From pulse to pulse every axis goes evenly; where the axes come from nobody knows.
    let (before, behind) = (place("move", 1.0), place("move", 2.0));
    let half = place("time", 0.055);
    assert_eq!(half["move"], 2);
    let middle = |of: &str| -> Vec<f64> {
        numbers(&before[of]).iter().zip(numbers(&behind[of])).map(|(a, b)| 0.5 * (a + b)).collect()
    };
    is_near(&half["axes"], &middle("axes"), 1e-9);
    is_near(&half["tip"], &middle("tip"), 1e-9);
    assert_eq!(place("time", 0.005)["axes"], json!([null, null, null]));

    // The geometry: a vertex that begins, and one for each pulse.
    let get = |path: &str| studio.get(&format!("/geometry/{revision}/{path}"));
    let index = get("index");
    let origin =
        |axis: usize| f64::from_le_bytes(index[8 * axis..8 * axis + 8].try_into().unwrap());
    let vertices = f32s(&get("0/0"));
    assert_eq!(vertices.len(), 4 * 4);
    for (number, vertex) in vertices.as_chunks::<4>().0.iter().skip(1).enumerate() {
        let at = [0, 1, 2].map(|axis| origin(axis) + f64::from(vertex[axis]));
        is_near(&place("move", number as f64)["tip"], &at, 1e-5);
        assert_eq!(vertex[3].to_bits(), number as u32 | 5 << 12 | 255 << 16);
    }
}

#[test]
fn what_is_saved_is_what_the_command_makes() {
    let studio = studio();
    let mut page = studio.socket();
    let job = post(&mut page, "ball.stl", MACHINE, &[]);
    assert_eq!(job["verdict"], "done", "{job}");
    let save = json!({ "revision": job["revision"], "path": "ball.prg", "replace": false });
    let saved = page.done("save", save.clone());
    assert_eq!(saved["files"], json!(["ball.prg", "ball.prg.report.json"]));
    let read = |name: &str| fs::read(studio.own().join(name)).unwrap();
    let (settings, body) = (settings(&[]), app::Source::memory("ball.stl", read("ball.stl")));
    let machine = app::glass::machine(MACHINE).unwrap();
    let made = app::glass::Job::read(&[body], machine, &settings, &mut app::glass::beside);
    let made = made.unwrap().make(&()).unwrap();
    assert_eq!(read("ball.prg"), made.made.text);
    assert_eq!(String::from_utf8(read("ball.prg.report.json")).unwrap(), made.account.report());
    // Not over what is there, nor over what it is made of.
    assert_eq!(page.refused("save", save), "output-file");
    let over = json!({ "revision": job["revision"], "path": "ball.stl", "replace": true });
    assert_eq!(page.refused("save", over), "output-file");
    assert_eq!(read("ball.stl"), sphere(3.0).into_bytes());
}

#[test]
fn an_edit_is_proven_against_the_body_and_one_that_fires_elsewhere_is_refused() {
    let studio = studio();
    let mut page = studio.socket();
    let job = post(&mut page, "dots.xyz", MACHINE, &[]);
    let text = |page: &mut Socket, job: &Value| {
        let all = json!({ "revision": job["revision"], "of": "program", "from": 1, "to": 99 });
        let mut frame = page.answer("text", all, &[]).unwrap();
        String::from_utf8(frame.take_text("text").unwrap()).unwrap()
    };
    let posted = text(&mut page, &job);
    let prove = |page: &mut Socket, text: &str| {
        let array = Array::new("text", Values::U8(text.as_bytes().to_vec()));
        let params = params("dots.xyz", MACHINE, &[]);
        page.answer("prove", params, &[array]).map(|mut frame| frame.head.remove("done").unwrap())
    };
    let again = prove(&mut page, &posted).unwrap();
    assert_eq!((&again["verdict"], &again["walk"]["moves"]), (&json!("done"), &json!(3)));
    let lines: Vec<&str> = posted.lines().collect();
    let elsewhere = posted.replace(lines[2], "N3 PULSE X5.000 Y5.000 Z-5.000");
    let job = prove(&mut page, &elsewhere).unwrap();
    assert_eq!(job["verdict"], "failed");
    let found = job["findings"].as_array().unwrap().iter().find(|found| found["rule"] == "stray");
    let found = found.unwrap();
    assert_eq!((&found["of"], &found["line"]), (&json!("program"), &json!(3)), "{found}");
    let save = json!({ "revision": job["revision"], "path": "x.prg", "replace": false });
    assert_eq!(page.refused("save", save), "output-file");
    // That pulse is marked, and no other.
    assert_eq!(job["walk"]["mismatch"], 1);
    let marks = [0, 1, 2].map(|number| {
        let place = json!({ "revision": job["revision"], "by": "move", "value": number });
        page.done("place", place)["marks"].clone()
    });
    assert_eq!(marks, [0, 4, 0]);
    // What the machine would not take has its line.
    let stop = prove(&mut page, &posted.replace("N3 PULSE", "N3 PULSES")).unwrap_err();
    let found = &stop["findings"][0];
    assert_eq!((&found["rule"], &found["line"]), (&json!("glass-program"), &json!(3)), "{stop}");
    // Points that are moved to where a motion passes are not those of the body.
    let array = Array::new("text", Values::U8(posted.into_bytes()));
    let moved = params("dots.xyz", "glass-polar-100hz", &[("order", "arcs")]);
    let stop = page.answer("prove", moved, &[array]).map(|frame| frame.head).unwrap_err();
    assert!(stop["findings"][0]["help"].as_str().unwrap().contains("--order"), "{stop}");
}

#[test]
fn a_binary_program_is_shown_as_its_control_reads_it_and_saved_as_it_is() {
    let studio = studio();
    let mut page = studio.socket();
    let job = post(&mut page, "dots.xyz", "binary.toml", &[]);
    assert_eq!((&job["verdict"], &job["program"]["lines"]), (&json!("done"), &json!(3)), "{job}");
    let said = job["findings"].as_array().unwrap();
    assert!(said.iter().any(|found| found["message"].as_str().unwrap().contains("binary")));
    let place = json!({ "revision": job["revision"], "by": "block", "value": 2 });
    let place = page.done("place", place);
    assert_eq!(place["move"], 1);
    let line: Vec<f64> = place["block"]["text"]
        .as_str()
        .unwrap()
        .split(' ')
        .map(|word| word.parse().unwrap())
        .collect();
    is_near(&place["axes"], &line, 1e-9);
    let save = json!({ "revision": job["revision"], "path": "dots.bin", "replace": false });
    page.done("save", save);
    assert!(fs::read(studio.own().join("dots.bin")).unwrap().starts_with(b"TPGLASS1"));
}

/// On the table of `glass-polar-100hz` (four places, 70 mm to the near side) the second block lies a quarter turn on: by hand its corner is
/// that of the first, (-10, 70) from the table's axis, turned to (70, 10).
#[test]
fn blocks_on_a_table_lie_round_it_and_so_do_their_pulses() {
    let studio = studio();
    let mut page = studio.socket();
    let job = post(&mut page, "dots.xyz", "glass-polar-100hz", &[("blocks", "4")]);
    assert_eq!((&job["verdict"], &job["walk"]["moves"]), (&json!("done"), &json!(12)), "{job}");
    let blocks = job["blocks"].as_array().unwrap();
    assert_eq!(blocks.len(), 4);
    is_near(&blocks[0]["corner"], &[0.0; 3], 1e-9);
    is_near(&blocks[1]["corner"], &[10.0 + 70.0, -70.0 + 10.0, 0.0], 1e-9);
    is_near(&blocks[1]["sides"][0], &[0.0, -20.0, 0.0], 1e-9);
    is_near(&blocks[1]["sides"][1], &[20.0, 0.0, 0.0], 1e-9);
    let names: Vec<_> = job["walk"]["operations"].as_array().unwrap().iter().collect();
    let expected = ["block 1", "block 2", "block 3", "block 4"];
    assert_eq!(
        names.iter().map(|name| name["name"].as_str().unwrap()).collect::<Vec<_>>(),
        expected
    );
    for number in 0..12 {
        let place = json!({ "revision": job["revision"], "by": "move", "value": number });
        let tip = numbers(&page.done("place", place)["tip"]);
        let block = &blocks[number / 3];
        let way: Vec<f64> = tip.iter().zip(numbers(&block["corner"])).map(|(a, b)| a - b).collect();
        // In its own block each point lies where it lies in the first.
        let own = |side: usize| -> f64 {
            let side = numbers(&block["sides"][side]);
            let length = side.iter().map(|part| part * part).sum::<f64>().sqrt();
            way.iter().zip(&side).map(|(a, b)| a * b).sum::<f64>() / length
        };
        let own = [own(0), own(1), own(2)];
        let points = [[9.5, 10.0, 14.0], [10.5, 10.0, 14.0], [9.5, 10.0, 16.0]];
        let near = |at: &[f64; 3]| (0..3).all(|axis| (own[axis] - at[axis]).abs() < 5e-3);
        assert!(points.iter().any(near), "{number}: {own:?}");
    }
}

#[test]
fn a_body_has_the_options_of_its_own_command_and_its_own_machines() {
    let studio = studio();
    let mut page = studio.socket();
    let mut command = |source: Value, machine: Option<&str>| {
        page.done("command", json!({ "source": source, "machine": machine }))
    };
    assert_eq!(command(json!({ "file": "ball.stl" }), None), "glass");
    assert_eq!(command(json!({ "file": "ball.stl" }), Some("linuxcnc-mill")), "glass");
    assert_eq!(command(json!({ "file": "dome.cls" }), None), "post");
    assert_eq!(command(json!({ "file": "dome.cls" }), Some(MACHINE)), "glass");
    let machines = page.done("machines", json!({}));
    let glass: Vec<&str> = machines
        .as_array()
        .unwrap()
        .iter()
        .filter(|entry| entry["kind"] == "glass")
        .map(|entry| entry["name"].as_str().unwrap())
        .collect();
    assert_eq!(glass.len(), 7);
    assert!(glass.contains(&"binary.toml") && glass.contains(&"glass-galvo-1000hz"), "{glass:?}");
}

#[test]
fn what_is_no_job_of_glass_is_refused_with_the_way_out() {
    let studio = studio();
    fs::create_dir(studio.own().join("two")).unwrap();
    fs::write(studio.own().join("two/a.stl"), sphere(2.0)).unwrap();
    fs::write(studio.own().join("bad.toml"), "[laser] # and no more\nrate = 100\n").unwrap();
    let mut page = studio.socket();
    let mut refused = |source: Value, machine: &str, options: &[(&str, &str)]| {
        let params = json!({ "source": source, "machine": machine, "options": options });
        let stop = page.answer("post", params, &[]).map(|frame| frame.head).unwrap_err();
        let found = stop["findings"][0].clone();
        assert!(!found["help"].as_str().unwrap().is_empty(), "{found}");
        (found["rule"].as_str().unwrap().to_owned(), found["help"].as_str().unwrap().to_owned())
    };
    let file = |name: &str| json!({ "file": name });
    let (rule, help) = refused(file("ball.stl"), "linuxcnc-mill", &[]);
    assert!(rule == "studio-ask" && help.contains("glass-"), "{help}");
    assert_eq!(refused(file("dome.cls"), MACHINE, &[]).0, "form");
    assert_eq!(refused(json!({ "folder": "two" }), MACHINE, &[]).0, "studio-ask");
    // Before anything is asked that it would need.
    let plain = Studio::new();
    assert_eq!(plain.socket().refused("post", params("dome.cls", MACHINE, &[])), "form");
    assert_eq!(refused(file("ball.stl"), "bad.toml", &[]).0, "machine-file");
    assert_eq!(refused(file("ball.stl"), "glass-xyz-300hz", &[]).0, "machine-unknown");
    assert_eq!(refused(file("../secret.stl"), MACHINE, &[]).0, "folder-reach");
    // A square of 1.6 m would be 100 million points: that is said before they are made.
    let square = "v 0 0 0\nv 1600 0 0\nv 1600 1600 0\nv 0 1600 0\nf 1 2 3\nf 1 3 4\n";
    fs::write(studio.own().join("square.obj"), square).unwrap();
    let (rule, help) = refused(file("square.obj"), MACHINE, &[("block", "large")]);
    assert!(rule == "points" && help.contains("toolpost glass"), "{rule}: {help}");
}

/// An OBJ names its colours by `mtllib`: they are read from its own folder, and never from without.
#[test]
fn what_a_body_names_is_read_from_its_folder_alone() {
    let studio = studio();
    let body =
        |library: &str| format!("mtllib {library}\nv 0 0 0\nv 4 0 0\nv 0 4 0\nusemtl a\nf 1 2 3\n");
    fs::create_dir(studio.own().join("deep")).unwrap();
    fs::write(studio.own().join("deep/in.obj"), body("own.mtl")).unwrap();
    fs::write(studio.own().join("deep/own.mtl"), "newmtl a\nKd 1 1 1\n").unwrap();
    fs::write(studio.own().join("out.obj"), body("../out.mtl")).unwrap();
    fs::write(studio.outside.path().join("out.mtl"), "newmtl a\nKd 1 1 1\n").unwrap();
    fs::write(studio.own().join("own.mtl"), "newmtl a\nKd 1 1 1\n").unwrap();
    let mut page = studio.socket();
    let shaded = [("fill", "shaded")];
    assert_eq!(post(&mut page, "deep/in.obj", MACHINE, &shaded)["verdict"], "done");
    let stop = page.answer("post", params("out.obj", MACHINE, &shaded), &[]);
    let stop = stop.map(|frame| frame.head).unwrap_err();
    assert!(stop["findings"][0]["message"].as_str().unwrap().contains("does not lie in"), "{stop}");
    // Saved over neither the body nor what it names.
    let job = post(&mut page, "deep/in.obj", MACHINE, &shaded);
    let over = json!({ "revision": job["revision"], "path": "deep/own.mtl", "replace": true });
    assert_eq!(page.refused("save", over), "output-file");
    // A dropped body lies in no folder.
    let (_, _, answer) = studio.request("PUT /upload/drop.obj", "", body("own.mtl").as_bytes());
    let upload: Value = serde_json::from_slice(&answer).unwrap();
    let dropped =
        json!({ "source": { "upload": upload["upload"] }, "machine": MACHINE, "options": shaded });
    let stop = page.answer("post", dropped, &[]).map(|frame| frame.head).unwrap_err();
    assert!(stop["findings"][0]["message"].as_str().unwrap().contains("dropped body"), "{stop}");
}

#[test]
fn several_bodies_that_are_dropped_lie_in_one_block() {
    let studio = studio();
    let upload = |name: &str, text: &str| {
        let (_, _, answer) = studio.request(&format!("PUT /upload/{name}"), "", text.as_bytes());
        serde_json::from_slice::<Value>(&answer).unwrap()["upload"].clone()
    };
    let ids = [upload("a.xyz", DOTS), upload("b.xyz", "5 5 0\n")];
    let mut page = studio.socket();
    let params = json!({ "source": { "uploads": ids }, "machine": MACHINE });
    let job = page.done("post", params);
    assert_eq!((&job["verdict"], &job["walk"]["moves"]), (&json!("done"), &json!(4)), "{job}");
    assert_eq!(job["source"]["file"], "a.xyz, b.xyz");
}

/// By hand: points and triangle reach from 0 to 8 in X and Y and to 2 in Z, so that they lie 6 6 14 mm farther on in the middle of the block.
#[test]
fn a_pulse_leads_to_the_line_of_its_list_or_to_its_body_and_back() {
    let studio = studio();
    let upload = |name: &str, text: &str| {
        let (_, _, answer) = studio.request(&format!("PUT /upload/{name}"), "", text.as_bytes());
        serde_json::from_slice::<Value>(&answer).unwrap()["upload"].clone()
    };
    let list = "x y z\n# a comment\n0 0 0\n\n1 0 0\n0 0 2\n";
    let (points, shift) =
        ([(3, [0.0; 3]), (5, [1.0, 0.0, 0.0]), (6, [0.0, 0.0, 2.0])], [6.0, 6.0, 14.0]);
    let triangle = "solid t\nfacet normal 0 0 1\nouter loop\nvertex 6 6 0\nvertex 8 6 0\nvertex 6 8 0\nendloop\nendfacet\nendsolid t\n";
    let ids = [upload("t.stl", triangle), upload("dots.xyz", list)];
    let mut page = studio.socket();
    let job = page.done("post", json!({ "source": { "uploads": ids }, "machine": MACHINE }));
    assert_eq!(job["sources"][0]["file"], "dots.xyz", "{job}");
    let revision = &job["revision"];
    let (mut seen, mut of_body) = (Vec::new(), 0);
    for number in 0..job["walk"]["moves"].as_u64().unwrap() {
        let by = json!({ "revision": revision, "by": "move", "value": number });
        let place = page.done("place", by);
        let source = &place["source"];
        let tip = numbers(&place["tip"]);
        let own =
            points.iter().find(|(_, at)| (0..3).all(|i| (tip[i] - at[i] - shift[i]).abs() < 2e-3));
        let Some((line, _)) = own else {
            assert_eq!((&source["file"], &source["line"]), (&Value::Null, &json!(1)), "{place}");
            of_body += 1;
            continue;
        };
        assert_eq!(
            (&source["file"], &source["line"]),
            (&json!("dots.xyz"), &json!(line)),
            "{place}"
        );
        let back =
            json!({ "revision": revision, "by": "source", "value": line, "file": "dots.xyz" });
        assert_eq!(page.done("place", back)["move"], number);
        seen.push(*line);
    }
    seen.sort_unstable();
    assert_eq!((seen, of_body > 3), (vec![3, 5, 6], true));
    // A list alone is the source itself; a body alone has no lines.
    let job = post(&mut page, "dots.xyz", MACHINE, &[]);
    let place =
        page.done("place", json!({ "revision": job["revision"], "by": "source", "value": 2 }));
    assert_eq!(
        (&place["source"]["file"], &place["source"]["text"]),
        (&Value::Null, &json!("1 0 0"))
    );
    let job = post(&mut page, "ball.stl", MACHINE, &[]);
    let by = json!({ "revision": job["revision"], "by": "move", "value": 1 });
    assert_eq!(page.done("place", by)["source"], Value::Null);
}

#[test]
fn a_job_of_glass_tells_its_steps_and_is_ended_in_the_midst_of_them() {
    let studio = studio();
    fs::write(studio.own().join("large.stl"), sphere(7.9)).unwrap();
    let mut page = studio.socket();
    let id = page.ask("post", params("ball.stl", MACHINE, &[]), &[]);
    let mut steps = Vec::new();
    loop {
        let Said::Frame(frame) = page.next() else { panic!() };
        match frame.head.get("step") {
            _ if frame.head["id"] != id => {}
            Some(step) if frame.head["part"].is_null() => {
                steps.push(step.as_str().unwrap().to_owned());
            }
            Some(_) => {}
            None => break,
        }
    }
    assert_eq!(steps, ["reading", "engraving", "ordering", "proving", "drawing"]);
    let id = page.ask("post", params("large.stl", MACHINE, &[]), &[]);
    loop {
        let Said::Frame(frame) = page.next() else { panic!() };
        if frame.head.get("step").is_some_and(|step| step == "ordering") {
            break;
        }
    }
    page.send(&json!({ "cancel": id }), &[]);
    assert_eq!(page.answer_of(id).unwrap_err()["verdict"], "cancelled");
}
