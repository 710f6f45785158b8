//! Boards and calls that nothing can be made of: a clear error with its file, line and rule, and nothing is
//! written.

use crate::board::{CALL, DRILL, EDGE, FRONT, call, edge, front, gerber, refused, small};
use crate::folder::Folder;
use std::fs::{self, File};
use std::io::Write;
use std::time::Instant;

/// Refused as input with [`CALL`].
#[track_caller]
fn bad(folder: &Folder, words: &[&str]) {
    refused(folder, &CALL, 2, words);
}

/// Refused as input with [`CALL`] and more.
#[track_caller]
fn bad_call(folder: &Folder, more: &[&str], words: &[&str]) {
    refused(folder, &[&CALL, more].concat(), 2, words);
}

/// The report's warnings of a board that is made all the same.
#[track_caller]
fn odd(folder: &Folder, words: &[&str]) {
    let said = call(folder, &[]);
    assert_eq!(said.code, 0, "{said:?}");
    for word in words {
        assert!(said.err.contains(word), "`{word}` is missing in\n{}", said.err);
    }
    let reported = folder.read("out/report.json");
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    let rule = words[0].trim_start_matches("warning[").trim_end_matches(']');
    assert!(reported.contains(&format!("\"rule\": \"{rule}\"")), "{rule}");
    bad_call(folder, &["--strict", "--only", "outline"], &[&format!("error[{rule}]")]);
}

#[test]
fn faults_of_a_gerber_file_have_their_file_line_and_rule() {
    let folder = small();
    let repeat = format!("%SRX1000000000Y1I1J1*%{FRONT}%SR*%\n");
    for (body, place, rule, word) in [
        ("D77*\n", "front.gbr:8:1", "missing-aperture", "D77"),
        ("%AMM*\n1,1,1/($1-1),0,0*%\n%ADD20M,1*%\n", "front.gbr:9:1", "macro-division", "M"),
        ("G36*\nX0Y0D02*\nX2000D01*\nY2000D01*\nG37*\n", "front.gbr:12:", "region-open", "2.828"),
        (
            "G36*\nX0Y0D02*\nX2000Y2000D01*\nX2000Y0D01*\nX0Y2000D01*\nX0Y0D01*\nG37*\n",
            "front.gbr:14:",
            "region-crosses-itself",
            "X 1",
        ),
        (
            "D10*\nG75*\nG03*\nX0Y0D02*\nX5000I1000J0D01*\n",
            "front.gbr:12:",
            "arc-center",
            "4.000000 mm",
        ),
        (&repeat, "front.gbr:11:", "too-large", "5000000"),
    ] {
        front(&folder, body);
        bad(&folder, &[place, &format!("error[{rule}]"), word]);
    }
}

#[test]
fn a_gerber_file_without_its_format() {
    let folder = small();
    let text = gerber("Copper,L1,Top", FRONT);
    folder.write("board/front.gbr", text.replace("%FSLAX33Y33*%\n", ""));
    bad(&folder, &["front.gbr:8:", "error[no-format]"]);
}

#[test]
fn a_drill_file_without_its_unit() {
    let folder = small();
    // Drills of 0.8 may have that in mm or inches; zeros are not said either.
    folder.write("board/holes.drl", "M48\nT1C0.125\n%\nT1\nX4.0Y5.0\nM30\n");
    bad(&folder, &["holes.drl:", "error[no-unit]"]);
}

#[test]
fn blocks_a_thousand_deep_are_a_pad() {
    let folder = small();
    let open: String = (1000..2000).map(|i| format!("%ABD{i}*%\n")).collect();
    let close: String = (1000..2000).rev().map(|i| format!("X0Y0D03*\n%AB*%\nD{i}*\n")).collect();
    front(&folder, &format!("{open}D10*\n{close}X4000Y5000D03*\nX14000Y5000D03*\n"));
    let said = call(&folder, &[]);
    assert_eq!(said.code, 0, "{said:?}");
    let deep = folder.read("out/front.gcode");
    front(&folder, FRONT);
    assert_eq!(call(&folder, &[]).code, 0);
    assert_eq!(folder.read("out/front.gcode"), deep);
}

#[test]
fn layers_of_different_origins() {
    let folder = small();
    front(&folder, "D10*\nX104000Y5000D03*\nX114000Y5000D03*\n");
    bad(
        &folder,
        &["error[layers-apart]", "front copper", "X 103.000 to 115.000", "X 0.000 to 20.000"],
    );
}

#[test]
fn an_outline_that_is_not_closed() {
    let folder = small();
    let said = call(&folder, &[]);
    assert_eq!(said.code, 0, "{said:?}");
    let programs = ["front.gcode", "back.gcode", "drill.gcode"];
    let whole = programs.map(|name| folder.read(&format!("out/{name}")));
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    edge(&folder, &EDGE.replace("\nY0D01*", "\nY1000D01*"));
    let words =
        ["edge.gbr:10:", "error[outline-open]", "1.0000 mm", "X 0.0000 Y 1.0000", "0.05 mm"];
    bad_call(&folder, &["--strict"], &words);
    bad_call(&folder, &["--only", "outline"], &words);
    // The rest of the board is made, and lies where it lies with a closed outline.
    let said = call(&folder, &[]);
    assert_eq!(said.code, 3, "{said:?}");
    for word in words.iter().chain(&["left out", "outline.gcode: the outline is not closed"]) {
        assert!(said.err.contains(word) || said.out.contains(word), "`{word}`: {said:?}");
    }
    assert_eq!(programs.map(|name| folder.read(&format!("out/{name}"))), whole);
    assert!(!folder.path().join("out/outline.gcode").exists());
    let report = folder.read("out/report.json");
    let left_out = report.split("\"left_out\": [").nth(1).unwrap();
    for word in ["\"name\": \"outline\"", "\"rule\": \"outline-open\""] {
        assert!(left_out.contains(word), "{left_out}");
    }
    let said = call(&folder, &["--only", "front,back,drill"]);
    assert_eq!((said.code, said.err.contains("outline-open")), (0, false), "{said:?}");
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    // The tolerance closes it.
    edge(&folder, &EDGE.replace("\nY0D01*", "\nY40D01*"));
    odd(&folder, &["warning[outline-gap]", "0.0400 mm"]);
}

#[test]
fn copper_outside_of_the_outline() {
    let folder = small();
    // Half of a pad.
    front(&folder, &FRONT.replace("X14000", "X20000"));
    odd(&folder, &["warning[copper-outside]", "1.571 mm²", "front", "in 1 place"]);
}

#[test]
fn a_layer_with_nothing_on_it() {
    let folder = small();
    front(&folder, "");
    bad_call(&folder, &["--only", "front"], &["error[no-such-part]", "copper of the front"]);
    odd(&folder, &["warning[layer-empty]", "front.gbr", "front copper"]);
    let said = call(&folder, &["--picture", "none"]);
    assert_eq!(said.code, 0, "{said:?}");
    let names = fs::read_dir(folder.path().join("out")).unwrap();
    let mut names: Vec<_> = names.map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["back.gcode", "drill.gcode", "outline.gcode", "report.json"]);
}

#[test]
fn a_hundred_megabytes_that_say_nothing() {
    let folder = small();
    for filling in ["G04 nothing to see here, go on*\n", " \n"] {
        let head = gerber("Copper,L1,Top", "");
        let mut file = File::create(folder.path().join("board/front.gbr")).unwrap();
        file.write_all(head.strip_suffix("M02*\n").unwrap().as_bytes()).unwrap();
        file.write_all(filling.repeat(100_000_000 / filling.len()).as_bytes()).unwrap();
        let start = Instant::now();
        bad(&folder, &["front.gbr:", "error[no-end]"]);
        writeln!(file, "{FRONT}M02*").unwrap();
        assert_eq!(call(&folder, &["--only", "front"]).code, 0);
        fs::remove_dir_all(folder.path().join("out")).unwrap();
        assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
    }
}

#[test]
fn a_board_of_a_kicad_that_is_not_known() {
    let folder = small();
    folder.write("new.kicad_pcb", "(kicad_pcb\n (version 20990101)\n (generator pcbnew))\n");
    let arguments = ["pcb", "new.kicad_pcb", "-o", "out", "-m", "grbl-3018", "--tool", "0.4"];
    refused(&folder, &arguments, 2, &["new.kicad_pcb:2:", "error[version]", "20990101", "KiCad 9"]);
}

#[test]
fn what_is_no_board() {
    let folder = small();
    let with = |board: &str, words: &[&str]| {
        let arguments = ["pcb", board, "-o", "out", "-m", "grbl-3018", "--tool", "0.4"];
        refused(&folder, &arguments, 2, words);
    };
    with("missing", &["missing: error[unreadable]"]);
    fs::create_dir(folder.path().join("empty")).unwrap();
    with("empty", &["empty: error[folder]"]);
    folder.write("empty/README", "no board");
    with("empty", &["error[no-board]"]);
    folder.write("whole.kicad_pcb", "(kicad_pcb (version 20221018))");
    with("whole.kicad_pcb", &["error["]);
}

#[test]
fn a_tool_wider_than_every_gap() {
    let folder = small();
    // Squares with 0.3 mm between them; a tool needs 2 µm of room.
    front(&folder, "D12*\nX4000Y5000D03*\nX6300Y5000D03*\n");
    bad_call(
        &folder,
        &["--only", "front"],
        &["error[tool-too-wide]", "0.400 mm", "0.298 mm", "--narrow"],
    );
}

/// A board has no lines: what is said of its holes points to none.
#[test]
fn holes_written_as_moves_name_no_line() {
    let folder = small();
    let said = folder.run(&["pcb", "board", "--only", "drill", "-o", "out", "-m", "grbl-3018"]);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.out.contains("lines, tolerance 0.005 mm\n"), "{said:?}");
    assert!(!said.out.contains("first here"), "{said:?}");
}

#[test]
fn tools_that_are_none() {
    let folder = small();
    for tool in ["0", "-0.2", "nan", "inf", "wide"] {
        let tool = format!("--tool={tool}");
        let arguments = ["pcb", "board", "-o", "out", "-m", "grbl-3018", &tool];
        refused(&folder, &arguments, 2, &["--tool", "greater than 0"]);
    }
    let none = ["pcb", "board", "-o", "out", "-m", "grbl-3018"];
    refused(&folder, &[&none[..], &["--tool", "-0.2"]].concat(), 2, &["--tool", "greater than 0"]);
    // Both sides lack it, and it is said once.
    let said = refused(&folder, &none, 2, &["error[no-tool]", "--tool", "--vee", "--only"]);
    assert_eq!(said.err.matches("error[no-tool]").count(), 1, "{said:?}");
    for angle in ["0", "180", "-30"] {
        let angle = format!("--vee={angle}");
        refused(&folder, &[&none[..], &[&angle]].concat(), 2, &["--vee", "below 180 degrees"]);
    }
    refused(&folder, &[&none[..], &["--tip", "0.2"]].concat(), 2, &["`tip`", "`vee`"]);
    bad_call(&folder, &["--vee", "30"], &["`tool`", "`vee`"]);
}

#[test]
fn steps_that_no_machine_makes_and_heights_that_cross() {
    let folder = small();
    for step in ["--step", "--outline-step", "--peck"] {
        for length in ["0", "1e-9", "0.0009"] {
            bad_call(&folder, &[step, length], &[step, "0.001 or more"]);
        }
    }
    bad_call(
        &folder,
        &["--travel", "0.3"],
        &["error[travel-height]", "0.3 mm", "0.5 mm", "--travel", "--approach"],
    );
}

#[test]
fn drills_and_mills_that_do_not_fit() {
    let folder = small();
    bad_call(
        &folder,
        &["--strict", "--drills", "0.6,1.2"],
        &["error[no-drill]", "0.8 mm at X 4.000 Y 5.000", "0.6 mm", "0.05 mm", "2 times"],
    );
    // A slot of 0.8 mm.
    folder.write("board/holes.drl", DRILL.replace("X4.0Y5.0", "X4.0Y5.0G85X6.0Y5.0"));
    bad_call(
        &folder,
        &["--strict", "--hole-mill", "1"],
        &["error[no-cutter]", "slot of 0.8 mm at X 4.000 Y 5.000", "1 mm", "at most 0.8 mm"],
    );
}

#[test]
fn a_folder_that_nothing_can_be_saved_in() {
    let folder = small();
    folder.write("file", "");
    let into = |output: &str, words: &[&str]| {
        let arguments = ["pcb", "board", "-o", output, "-m", "grbl-3018", "--tool", "0.4"];
        refused(&folder, &arguments, 2, words);
    };
    into("file", &["file: error[output-folder]", "not a folder"]);
    into("missing/out", &["missing/out: error[output-folder]", "no folder missing"]);
    // Nobody can write there, whoever runs the tests.
    if cfg!(target_os = "linux") {
        into("/proc", &["/proc", "error[output-file]"]);
        into("/proc/out", &["/proc/out: error[output-folder]"]);
    }
}

#[test]
fn sides_that_are_not_there() {
    let folder = small();
    fs::remove_file(folder.path().join("board/back.gbr")).unwrap();
    bad_call(&folder, &["--only", "back"], &["error[no-such-part]", "copper of the back"]);
    fs::remove_file(folder.path().join("board/edge.gbr")).unwrap();
    bad_call(&folder, &["--only", "outline"], &["error[no-such-part]", "outline"]);
    bad_call(&folder, &["--clear", "0.8", "--only", "front"], &["error[no-outline]"]);
    bad_call(&folder, &["--only", "left"], &["left", "front"]);
}

#[test]
fn heights_of_another_side_or_another_place() {
    let folder = small();
    folder.write("heights.txt", "0 0 0\n20 0 0\n0 10 0\n20 10 0\n");
    bad_call(&folder, &["--heights", "heights.txt"], &["error[heights]", "--only"]);
    let front = ["--only", "front", "--heights", "heights.txt"];
    // The board is from 0 to 20: heights of a part, and of another board.
    for (x, y) in [(0, 20), (100, 0)] {
        let corner = |dx: i32, dy: i32| format!("{} {} 0\n", x + dx, y + dy);
        let text = corner(0, 0) + &corner(20, 0) + &corner(0, 10) + &corner(20, 10);
        folder.write("heights.txt", text);
        bad_call(&folder, &front, &["error[", "mm"]);
    }
    folder.write("heights.txt", "0 0 0\n20 0 high\n");
    bad_call(&folder, &front, &["heights.txt:2", "error[height-map]"]);
    bad_call(&folder, &["--heights", "none", "--only", "front"], &["none", "error[unreadable]"]);
}

#[test]
fn heights_that_nothing_measures() {
    let folder = small();
    let on_control = ["--probe", "3x3", "--on-control"];
    bad_call(&folder, &on_control, &["error[on-control]", "`grbl-3018`", "--heights"]);
    bad_call(&folder, &["--on-control"], &["`probe`"]);
    bad_call(&folder, &[&on_control[..], &["--heights", "h.txt"]].concat(), &["`heights`"]);
    folder.write("board/mask.gbr", gerber("Soldermask,Top", FRONT));
    for (more, word) in [
        (&["--only", "drill,outline"][..], "no program cuts copper"),
        (&["--mask-tool", "0.4"][..], "the solder mask of the front conducts nothing"),
    ] {
        let call = ["pcb", "board", "-o", "out", "-m", "linuxcnc-mill", "--tool", "0.4"];
        refused(&folder, &[&call[..], &on_control, more].concat(), 2, &["error[on-control]", word]);
    }
    // 4000 of its parameters are free.
    let call = ["pcb", "board", "-o", "out", "-m", "linuxcnc-mill", "--tool", "0.4"];
    let many = ["--probe", "64x63", "--on-control"];
    refused(&folder, &[&call[..], &many].concat(), 2, &["error[on-control]", "64", "4000"]);
}

/// Where a program probes.
fn probed(text: &str) -> Vec<[f64; 2]> {
    let mut at = [f64::NAN; 2];
    let mut places = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('(')) {
        for word in line.split(' ') {
            let value = || word[1..].parse().unwrap();
            match word.as_bytes() {
                [b'X', ..] => at[0] = value(),
                [b'Y', ..] => at[1] = value(),
                _ => {}
            }
        }
        if line.contains("G38.2") {
            places.push(at);
        }
    }
    places
}

/// Seen from the back the holes of 0.8 mm are at 6 and 16 of Y 5. Four columns are at 1, 7, 13 and 19, nineteen 1 mm apart. A mill of
/// 0.4 mm is at the rim of a hole from 0.6 mm on, a V-bit of 90 degrees, which is wide by 2.1 mm when it is 1 mm deep, from 1.45 mm on.
#[test]
fn heights_are_not_measured_in_holes() {
    let folder = small();
    let call = ["pcb", "board", "-o", "out", "-m", "linuxcnc-mill", "--on-control", "--probe"];
    // Rows and columns are 1 mm apart, and none is moved by more than 0.4 mm.
    let dense = ["19x9", "--tool", "0.4"];
    let words = [
        "error[probe-in-hole]",
        "back.ngc",
        "X6.000 Y5.000, in the hole of 0.8 mm at X6.000 Y5.000",
        "--from back",
    ];
    refused(&folder, &[&call[..], &dense, &["--strict"]].concat(), 2, &words);
    // Three rows are 4 mm apart: the one in the middle goes out of the holes. Of the four columns one does.
    let inside = ["19x3", "--tool", "0.4"];
    for (more, away) in [(&inside[..], 0.6), (&["4x3", "--vee", "90"], 1.45)] {
        let said = folder.run(&[&call[..], more].concat());
        assert_eq!(said.code, 0, "{said:?}");
        let places = probed(&folder.read("out/back.ngc"));
        let count = if more[0] == "19x3" { 57 } else { 12 };
        assert_eq!(places.len(), count, "{more:?}");
        for [x, y] in places {
            let distance = (x - 6.0).hypot(y - 5.0).min((x - 16.0).hypot(y - 5.0));
            assert!(distance >= away - 1e-3, "{more:?}: X{x} Y{y}");
            assert!((1.0..=19.0).contains(&x) && (1.0..=9.0).contains(&y), "X{x} Y{y}");
        }
    }
    // The probe of `probe.nc` is run for both sides: from the front the holes are at 4 and 14.
    let call_off = [&["pcb", "board", "-o", "off", "-m", "grbl-3018", "--probe"][..], &inside[..]];
    assert_eq!(folder.run(&call_off.concat()).code, 0);
    let places = probed(&folder.read("off/probe.gcode"));
    let nearest = |[x, y]: &[f64; 2]| {
        [4.0, 6.0, 14.0, 16.0].map(|hole| (x - hole).hypot(y - 5.0)).into_iter().fold(9.0, f64::min)
    };
    assert!(places.len() == 57 && places.iter().all(|place| nearest(place) >= 0.9 - 1e-3));
    for (good, run) in [
        (&["4x3", "--tool", "0.4"][..], &["front", "drill", "back", "outline"][..]),
        (&[&inside[..], &["--from", "back"]].concat(), &["front", "back", "drill", "outline"]),
        (&[&inside[..], &["--only", "front,drill"]].concat(), &["front", "drill"]),
    ] {
        let said = folder.run(&[&call[..], good].concat());
        assert_eq!(said.code, 0, "{said:?}");
        let report: serde_json::Value =
            serde_json::from_str(&folder.read("out/report.json")).unwrap();
        let names: Vec<_> = report["programs"]
            .as_array()
            .unwrap()
            .iter()
            .map(|made| made["name"].as_str().unwrap())
            .collect();
        assert_eq!(names, run);
    }
}

#[test]
fn numbers_that_are_no_panel() {
    let folder = small();
    for panel in ["0x2", "2x0", "2", "-1x2", "1001x1", "axb"] {
        let panel = format!("--panel={panel}");
        bad_call(&folder, &[&panel], &["--panel", "columns and rows"]);
    }
    let call = ["--panel", "2x1", "--spacing", "0"];
    bad_call(&folder, &call, &["error[panel]", "0 and 0 mm"]);
    bad_call(&folder, &["--panel", "200x200"], &["error[panel]", "200 by 200"]);
}

#[test]
fn machines_that_cannot_do_it() {
    let folder = small();
    let wire = ["pcb", "board", "-o", "out", "-m", "bp-95d", "--tool", "0.4"];
    refused(&folder, &wire, 2, &["error[machine-kind]", "bp-95d"]);
    let missing = ["pcb", "board", "-o", "out", "-m", "mill-of-nobody", "--tool", "0.4"];
    refused(&folder, &missing, 2, &["mill-of-nobody"]);
    // 480 holes from 4 to 29 · 24 + 14 mm are one finding.
    let long = ["--only", "drill", "--panel", "30x8", "--spacing", "4"];
    let found =
        ["error[axis-limit]: X moves from 4.0000 mm to 710.0000 mm: 406.0000 mm more", "300 mm"];
    let said = refused(&folder, &[&CALL[..], &long].concat(), 1, &found);
    assert_eq!(said.err.matches("error[").count(), 1, "{}", said.err);
    // Where the work zero is known each position is checked against the travel: one finding for each axis. X is
    // beyond it from 14 + 4 · 24 mm on, in 51 holes of a row; of the others only the last row is, in 9.
    let machine = "extends = \"grbl-3018\"\nwork_zero = [-100, -100, -20]\n";
    folder.write("mine.toml", machine);
    let mine = ["pcb", "board", "-o", "out", "-m", "mine.toml", "--tool", "0.4"];
    let said = refused(
        &folder,
        &[&mine[..], &long].concat(),
        1,
        &[
            "error[axis-limit]: X at 10.0000 mm is 10.0000 mm beyond its limit of 0 mm (408 times",
            "error[axis-limit]: Y at 3.0000 mm is 3.0000 mm beyond its limit of 0 mm (9 times",
        ],
    );
    assert_eq!(said.err.matches("error[").count(), 2, "{}", said.err);
}

/// A hundred thousand holes of 0.1 mm, 0.25 mm apart.
#[test]
fn a_board_of_a_hundred_thousand_holes() {
    let folder = small();
    let holes = (0..316).flat_map(|row| (0..317).map(move |column| (column, row)));
    let holes: String = holes
        .map(|(x, y)| {
            format!("X{:.2}Y{:.2}\n", 1.0 + 0.25 * f64::from(x), 1.0 + 0.25 * f64::from(y))
        })
        .collect();
    folder.write("board/holes.drl", format!("M48\nMETRIC\nT1C0.1\n%\nT1\n{holes}M30\n"));
    edge(&folder, "D11*\nX0Y0D02*\nX82000D01*\nY82000D01*\nX0D01*\nY0D01*\n");
    let begun = Instant::now();
    let call = ["pcb", "board", "-o", "out", "-m", "linuxcnc-mill", "--only", "drill", "-q"];
    let said = folder.run(&[&call[..], &["--picture", "none"]].concat());
    assert_eq!(said.code, 0, "{said:?}");
    let report: serde_json::Value = serde_json::from_str(&folder.read("out/report.json")).unwrap();
    assert_eq!(report["board"]["holes"], 100_172);
    assert!(begun.elapsed().as_secs() < 300, "{:?}", begun.elapsed());
}

/// 200 squares of 1 mm, 0.01 mm apart: nothing that one can buy goes between any two, and a bite of 0.03 mm does not either.
#[test]
fn gaps_of_ten_micrometres_everywhere() {
    let folder = small();
    let squares: String = (0..200)
        .map(|i| format!("X{}Y{}D03*\n", 500 + 1010 * (i % 20), 500 + 1010 * (i / 20)))
        .collect();
    front(&folder, &format!("%ADD13R,1X1*%\nD13*\n{squares}"));
    edge(&folder, "D11*\nX0Y0D02*\nX21000D01*\nY11000D01*\nX0D01*\nY0D01*\n");
    let words = ["error[tool-too-wide]", "0.400 mm", "nothing would be isolated"];
    let only = ["--only", "front"];
    bad_call(&folder, &only, &words);
    // All others are made.
    let said = call(&folder, &["--picture", "none"]);
    assert_eq!(said.code, 3, "{said:?}");
    assert!(said.err.contains("tool-too-wide") && folder.path().join("out/drill.gcode").exists());
}

/// A second closed contour next to the first is a second piece, which is cut out as well.
#[test]
fn two_outlines() {
    let folder = small();
    edge(&folder, &format!("{EDGE}X30000Y0D02*\nX40000D01*\nY10000D01*\nX30000D01*\nY0D01*\n"));
    let said = call(&folder, &["--only", "outline", "--tabs", "0", "--picture", "none"]);
    assert_eq!(said.code, 0, "{said:?}");
    let report: serde_json::Value = serde_json::from_str(&folder.read("out/report.json")).unwrap();
    assert_eq!(report["board"]["high_mm"][0], 40.0);
    // Around 20 by 10 and 10 by 10 mm with a mill of 2 mm, four times: sides, and corners of 1 mm.
    let right = 4.0 * (60.0 + 40.0 + 2.0 * std::f64::consts::TAU);
    let cut = report["programs"][0]["source"]["measures"]["cutting_length"].as_f64().unwrap();
    assert!((right..right + 10.0).contains(&cut), "{cut}, not {right}");
}

#[test]
fn a_folder_with_two_boards() {
    let folder = small();
    std::fs::create_dir(folder.path().join("boards")).unwrap();
    for name in ["a.kicad_pcb", "b.kicad_pcb"] {
        folder.write(&format!("boards/{name}"), "(kicad_pcb)");
    }
    let call = ["pcb", "boards", "-o", "out", "-m", "grbl-3018"];
    let said = folder.run(&call);
    assert_eq!(said.code, 2);
    for part in ["error[board]", "a.kicad_pcb, b.kicad_pcb", "the file of the one"] {
        assert!(said.err.contains(part), "{part}: {}", said.err);
    }
    // What KiCad keeps while a board is edited is not one of them.
    std::fs::rename(
        folder.path().join("boards/a.kicad_pcb"),
        folder.path().join("boards/_autosave-b.kicad_pcb"),
    )
    .unwrap();
    let said = folder.run(&call);
    assert!(said.err.contains("b.kicad_pcb:") && !said.err.contains("_autosave"), "{}", said.err);
}

#[test]
fn an_output_among_the_files_of_the_board() {
    let folder = small();
    std::fs::create_dir(folder.path().join("own")).unwrap();
    std::fs::write(folder.path().join("own/lamp.toml"), "").unwrap();
    std::fs::write(folder.path().join("own/report.json"), "mine").unwrap();
    for (board, output) in
        [("board", "board"), ("own/lamp.toml", "own"), ("own/lamp.toml", "board/../own")]
    {
        let said = folder.run(&["pcb", board, "-o", output, "-m", "grbl-3018", "--tool", "0.4"]);
        assert_eq!(said.code, 2);
        assert!(said.err.contains("error[output-folder]"), "{}", said.err);
    }
    assert_eq!(std::fs::read_to_string(folder.path().join("own/report.json")).unwrap(), "mine");
}

/// Copper is some hundredths of a millimetre thick: 2 mm are through a board of 1.6 mm, and cuts of 0.9 mm from both sides meet.
#[test]
fn an_isolation_through_the_board_is_refused_and_a_deep_one_is_warned_of() {
    let folder = small();
    let through = ["error[deep-cut]", "--depth 2", "1.6 mm thick", "--thickness"];
    bad_call(&folder, &["--depth", "2"], &through);
    bad_call(&folder, &["--depth", "1.6"], &["error[deep-cut]", "--depth 1.6"]);
    let found = |more: &[&str]| {
        let said = call(&folder, more);
        assert_eq!(said.code, 0, "{said:?}");
        fs::remove_dir_all(folder.path().join("out")).unwrap();
        said.err.matches("warning[deep-cut]").count()
    };
    assert_eq!(found(&["--depth", "0.9"]), 1);
    assert_eq!(found(&["--depth", "0.8"]), 0);
    assert_eq!(found(&["--depth", "2", "--thickness", "5"]), 0);
    // Nothing is isolated.
    assert_eq!(found(&["--depth", "2", "--only", "outline"]), 0);
}

/// A tool of 10^300 mm took minutes and gigabytes; one of 10^-300 mm was written out with all its noughts.
#[test]
fn numbers_beyond_every_machine_are_refused_at_once() {
    let folder = small();
    for name in [
        "depth",
        "step",
        "clear",
        "mask-tool",
        "legend-tool",
        "engrave",
        "drills",
        "hole-mill",
        "peck",
        "outline-tool",
        "outline-step",
        "tab-width",
        "tab-height",
        "thickness",
        "through",
        "alignment",
        "feed",
        "plunge",
        "drill-feed",
        "outline-feed",
        "speed",
        "travel",
        "approach",
    ] {
        let option = format!("--{name}");
        for number in ["1e300", "100001"] {
            bad_call(&folder, &[&option, number], &[&option, "100000"]);
        }
    }
    for [option, number] in
        [["--tool", "1e300"], ["--tool", "1e-300"], ["--vee", "1e-300"], ["--vee", "179.99"]]
    {
        let call = ["pcb", "board", "-o", "out", "-m", "grbl-3018", option, number];
        refused(&folder, &call, 2, &[option]);
    }
    bad_call(&folder, &["--corner", "1e300,0"], &["--corner"]);
}
