//! `toolpost wire`: contours to points, what it says of them, and what it refuses.

use crate::folder::{Folder, Said};
use serde_json::Value;

/// The sector of the examples, which is that of the specification.
const SECTOR: &str = include_str!("../../../../examples/sector.nc");

const CALL: [&str; 8] =
    ["wire", "sector.nc", "--from", "fanuc-31i", "-m", "bp-95d", "-o", "part.pts"];

fn sector() -> Folder {
    let folder = Folder::new();
    folder.write("sector.nc", SECTOR);
    folder
}

fn wire(folder: &Folder, more: &[&str]) -> Said {
    folder.run(&[&CALL, more].concat())
}

fn report(folder: &Folder) -> Value {
    serde_json::from_str(&folder.read("part.pts.report.json")).unwrap()
}

/// Refused with this code and in these words, and nothing is written.
#[track_caller]
fn refused(folder: &Folder, more: &[&str], code: i32, words: &[&str]) {
    let before = folder.names();
    let said = wire(folder, more);
    assert_eq!(said.code, code, "{said:?}");
    for word in words {
        assert!(said.err.contains(word), "`{word}` is missing in\n{}", said.err);
    }
    assert_eq!(folder.names(), before);
}

/// The table of the specification: points on the arc with its end, chord error, e/R; and the cutting
/// time at 0.11 mm/s.
#[test]
fn the_sector_has_the_points_errors_and_time_of_the_specification() {
    let folder = sector();
    for (step, points, error, relative) in [
        ("0.1", 629, 3.125e-5, 7.8e-7),
        ("0.5", 126, 7.812e-4, 1.95e-5),
        ("1", 63, 3.125e-3, 7.8e-5),
    ] {
        let said = wire(&folder, &["--step", step, "--feed", "0.11", "--select", "7"]);
        assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
        // The start, the end of each radius, and the arc.
        assert_eq!(folder.read("part.pts").lines().count(), points + 3);
        let report = report(&folder);
        let wire = &report["wire"];
        let arc = &wire["segments"][0]["arcs"][0];
        assert_eq!((&arc["line"], &arc["chord_error"]["points"]), (&7.into(), &points.into()));
        let largest = arc["chord_error"]["largest_mm"].as_f64().unwrap();
        assert!((largest / error - 1.0).abs() < 2e-4, "{largest}");
        assert!((largest / 40.0 / relative - 1.0).abs() < 4e-3, "{largest}");
        let minutes = wire["cutting_time_s"].as_f64().unwrap() / 60.0;
        assert!((minutes - 21.6).abs() < 0.05, "{minutes}");
        let selected = &wire["selected"]["points"][0];
        assert_eq!((&selected["first"], &selected["last"]), (&3.into(), &(points + 2).into()));
        let last = report["instructions"].as_array().unwrap().last().unwrap();
        assert_eq!((&last["line"], &last["first_point"]), (&8.into(), &(points + 3).into()));
        assert_eq!(report["proof"]["proven"], true);
        assert!(said.out.contains("time           21 min 38 s"), "{}", said.out);
    }
    assert!(folder.read("part.pts").starts_with("0.000 0.000\n40.000 0.000\n39.988 1.000\n"));
}

#[test]
fn a_step_that_does_not_fit_is_refused_with_the_one_that_does() {
    let folder = sector();
    let said = wire(&folder, &["--step", "0.1", "--memory", "500"]);
    assert_eq!(said.code, 1);
    let offer = said.err.split("--step ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    // 497 points remain for the arc: 20π/497 mm.
    assert_eq!(offer, "0.126423", "{}", said.err);
    assert_eq!(folder.names(), ["part.cls", "sector.nc"]);
    assert_eq!(wire(&folder, &["--step", offer, "--memory", "500"]).code, 0);
    assert_eq!(folder.read("part.pts").lines().count(), 500);
    assert_eq!(wire(&folder, &["--fit", "--memory", "500"]).code, 0);
    assert_eq!(folder.read("part.pts").lines().count(), 500);
    refused(&folder, &["--step", "1", "--memory", "4"], 1, &["error[memory]"]);
    refused(&folder, &["--fit"], 2, &["error[fit-without-memory]"]);
}

/// Of 500,000 lines that touch nothing (34 MB) the program needs 0.71 GB; while segments were JSON values it was 3.92 GB. Both
/// grow with the lines: 60,000 may take 0.25 GB, where the old way took 0.47 GB.
#[cfg(target_os = "linux")]
#[test]
fn a_drawing_of_very_many_lines_takes_memory_in_proportion() {
    let line = |i: usize| format!("0\nLINE\n8\n0\n10\n{i}\n20\n0\n11\n{i}\n21\n5\n");
    let entities: String = (0..60_000).map(line).collect();
    let folder = Folder::new();
    folder.write("comb.dxf", format!("0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"));
    let (code, megabytes) =
        folder.most_memory(&["wire", "comb.dxf", "-m", "fanuc-wire", "-o", "comb.nc", "--json"]);
    assert_eq!(code, 0);
    assert!((1.0..250.0).contains(&megabytes), "{megabytes} MB");
}

/// As JSON values the segments of 500,000 lines that touch nothing took 3.9 GB.
#[test]
fn of_very_many_openings_the_answer_lists_the_first_thousand_and_the_report_all() {
    let line = |i: usize| format!("0\nLINE\n8\n0\n10\n{i}\n20\n0\n11\n{i}\n21\n5\n");
    let entities: String = (0..1003).map(line).collect();
    let folder = Folder::new();
    folder.write("comb.dxf", format!("0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"));
    let said = folder.run(&["wire", "comb.dxf", "-m", "fanuc-wire", "-o", "comb.nc", "--json"]);
    assert_eq!(said.code, 0, "{}", said.err);
    let answer: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let listed = answer["wire"]["segments"].as_array().unwrap();
    assert_eq!((listed.len(), &answer["wire"]["segments_left_out"]), (1000, &3.into()));
    let report: serde_json::Value =
        serde_json::from_str(&folder.read("comb.nc.report.json")).unwrap();
    let all = report["wire"]["segments"].as_array().unwrap();
    assert_eq!((all.len(), &report["wire"]["segments_left_out"]), (1003, &serde_json::Value::Null));
    assert_eq!((&all[..1000], &report["proof"]), (&listed[..], &answer["proof"]));
}

/// A square of 20 mm below and one that is 2 mm larger on each side above, 40 mm up; U and V count 80 mm up.
#[test]
fn of_a_wire_that_leans_along_lines_the_summary_has_u_and_v_and_no_chords() {
    let folder = Folder::new();
    let square = |low: f64, high: f64| {
        format!(
            "G21 G90\nG0 X{low:.1} Y{low:.1}\nG1 X{high:.1}\nY{high:.1}\nX{low:.1}\nY{low:.1}\nM30\n"
        )
    };
    folder.write("lower.nc", square(0.0, 20.0));
    folder.write("upper.nc", square(-2.0, 22.0));
    let call = "wire lower.nc --upper upper.nc --from fanuc-wire --height 40 --uv-height 80 -m fanuc-wire -o a.nc";
    let said = folder.run(&call.split(' ').collect::<Vec<_>>());
    assert_eq!(said.code, 0, "{}", said.err);
    for line in [
        "points         5, the ends of straight moves",
        "U              -4 ... 4 mm (8)",
        "V              -4 ... 4 mm (8)",
    ] {
        assert!(said.out.contains(line), "`{line}` is missing in\n{}", said.out);
    }
    assert!(!said.out.contains("chord") && !said.out.contains("area error"), "{}", said.out);
    // An upright wire has none to print.
    let upright =
        folder.run(&["wire", "lower.nc", "--from", "fanuc-wire", "-m", "fanuc-wire", "-o", "b.nc"]);
    assert!(upright.code == 0 && !upright.out.contains("\nU "), "{upright:?}");
}

#[test]
fn steps_that_are_none_are_refused() {
    let folder = sector();
    for step in ["0", "-1", "nan", "inf", "143"] {
        refused(&folder, &["--step", step], 2, &["error[step]"]);
        refused(&folder, &["--chord-error", step], 2, &["error[step]"]);
    }
}

#[test]
fn mills_and_wires_have_their_own_commands() {
    let folder = sector();
    let mill =
        ["wire", "sector.nc", "--from", "fanuc-31i", "-m", "generic-3axis-fanuc", "-o", "x.nc"];
    let said = folder.run(&mill);
    assert_eq!(said.code, 2);
    assert!(
        said.err.contains("error[machine-kind]") && said.err.contains("toolpost post"),
        "{said:?}"
    );
    let said = folder.run(&["post", "part.cls", "-m", "bp-95d", "-o", "x.pts"]);
    assert_eq!(said.code, 2);
    assert!(
        said.err.contains("error[machine-kind]") && said.err.contains("toolpost wire"),
        "{said:?}"
    );
    assert_eq!(folder.names(), ["part.cls", "sector.nc"]);
}

#[test]
fn a_bad_source_is_reported_with_its_line_and_writes_nothing() {
    let folder = sector();
    let bad = |from: &str, to: &str, words: &[&str]| {
        folder.write("sector.nc", SECTOR.replace(from, to));
        refused(&folder, &[], 2, words);
    };
    // Half the chord is 20·√2 = 28.2843 mm.
    bad("R40.", "R28.27", &["sector.nc:7:"]);
    bad("X0. Y40. R40.", "X40. Y0. R40.", &["sector.nc:7:"]);
    bad("R40.", "I-40.1 J0.", &["sector.nc:7:"]);
    bad("N30 G1 X40. Y0. F6.6", "N30 G1 X40. Y0. Q6.6", &["sector.nc:6:"]);
    let offsets = "N45 G55 G0 X0. Y90. Z0.\nN50 G1 X0.";
    let two = SECTOR.replace("N20 G0", "N20 G54 G0");
    bad(SECTOR, &two.replace("N50 G1 X0.", offsets), &["error[work-offset]", "sector.nc:8:"]);
    bad("N20 G0 X0. Y0. Z0.", "N20 G0 X0. Z0.", &["sector.nc:6:", "--start"]);
    bad("N30 G1 X40. Y0. F6.6\nN40 G3 X0. Y40. R40.\nN50 G1 X0. Y0.\n", "", &["empty-contour"]);
}

#[test]
fn contours_that_cannot_be_offset_are_refused_with_their_line() {
    let folder = sector();
    let inside = ["--side", "inside", "--wire", "0.2", "--thread", "10,10", "--round-corners"];
    let bad = |from: &str, to: &str, more: &[&str], words: &[&str]| {
        folder.write("sector.nc", SECTOR.replace(from, to));
        refused(&folder, &[&inside, more].concat(), 2, words);
    };
    bad("N50 G1 X0. Y0.\n", "", &[], &["error[open-contour]"]);
    bad(
        "N50 G1 X0. Y0.",
        "N50 G1 X30. Y-10.\nG1 X0. Y0.",
        &[],
        &["error[self-crossing]", "sector.nc:"],
    );
    bad("", "", &["--feed", "0.1,0.2"], &["error[feed]"]);
    bad("", "", &["--thread", "1,1"], &["error[no-thread]"]);
    bad("", "", &["--taper", "5"], &["error[wire-height]"]);
    bad("", "", &["--taper", "70", "--height", "10"], &["error[taper-angle]"]);
    bad("", "", &["--gap", "40"], &["error[offset-vanishes]"]);
}

/// A square of 10 mm, and one of 14 mm about the same centre, each as a program.
fn frustum() -> Folder {
    let folder = Folder::new();
    let square = |low: f64, high: f64| {
        format!(
            "G21\nG17 G90\nG0 X{low:.1} Y{low:.1} Z0.\nG1 X{high:.1} F5.\nY{high:.1}\nX{low:.1}\nY{low:.1}\nM30\n"
        )
    };
    folder.write("sector.nc", square(0.0, 10.0));
    folder.write("upper.nc", square(-2.0, 12.0));
    folder
}

#[test]
fn two_contours_make_a_wire_that_leans() {
    let folder = frustum();
    let call =
        ["--upper", "upper.nc", "--height", "40", "--uv-height", "40", "--picture", "part.svg"];
    let said = wire(&folder, &call);
    assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
    let expected = "0.000 0.000 -2.000 -2.000\n10.000 0.000 2.000 -2.000\n10.000 10.000 2.000 2.000\n\
                    0.000 10.000 -2.000 2.000\n0.000 0.000 -2.000 -2.000\n";
    assert_eq!(folder.read("part.pts"), expected);
    assert!(folder.read("part.svg").contains("LOWER AND UPPER CONTOUR, 5 POINTS"));
    refused(&folder, &["--upper", "upper.nc"], 2, &["error[wire-height]", "--height"]);

    let upper = folder.read("upper.nc").replace("Y12.0\n", "Y5.0\nY12.0\n");
    folder.write("upper.nc", upper);
    refused(&folder, &call, 2, &["error[sync-blocks]"]);
    let said = wire(&folder, &[&call[..], &["--sync", "length"]].concat());
    assert_eq!(said.code, 0, "{said:?}");
    assert_eq!(folder.read("part.pts").lines().count(), 6);
}

#[test]
fn given_points_say_what_belongs_together() {
    let folder = frustum();
    let upper = folder.read("upper.nc").replace("Y12.0\n", "Y5.0\nY12.0\n");
    folder.write("upper.nc", upper);
    let call =
        ["--upper", "upper.nc", "--height", "40", "--uv-height", "40", "--pair", "10,10,12,5"];
    let said = wire(&folder, &call);
    assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
    assert!(folder.read("part.pts").contains("\n10.000 10.000 2.000 -5.000\n"));
    let off = ["--pair", "10,9,12,5", "--pair", "10,8,12,6"];
    refused(&folder, &[&call[..4], &off].concat(), 2, &["error[sync-point]", "Y8.0000"]);
    refused(&folder, &[&call[..], &["--sync", "length"]].concat(), 2, &["`pair`", "`sync`"]);
}

#[test]
fn a_wire_that_leans_too_far_is_the_machines_affair() {
    let folder = frustum();
    folder.write("shop.toml", "extends = \"bp-95d\"\n[wire]\nheight = 40\ntaper_max = 3\n");
    let mut call = CALL;
    call[5] = "shop.toml";
    let said = folder.run(&[&call[..], &["--upper", "upper.nc", "--height", "40"]].concat());
    // atan(√8/40) = 4.04°.
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.err.contains("error[taper-limit]") && said.err.contains("4.0447°"), "{said:?}");
}

/// U and V count in the machine's own plane, however high the part is: by the theorem on intersecting lines the wire is
/// 2 mm aside 40 mm up and 4 mm aside 80 mm up.
#[test]
fn the_height_of_the_part_is_not_that_of_the_machines_plane() {
    let folder = frustum();
    let on = |plane: &str, more: &[&str]| {
        let file = format!("extends = \"bp-95d\"\n[wire]\n{plane}\n");
        folder.write("shop.toml", file);
        let mut call = CALL;
        call[5] = "shop.toml";
        folder.run(&[&call[..], more].concat())
    };
    let part = ["--upper", "upper.nc", "--height", "40"];
    let said = on("height = 80", &part);
    assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
    let expected = "0.000 0.000 -4.000 -4.000\n10.000 0.000 4.000 -4.000\n10.000 10.000 4.000 4.000\n\
                    0.000 10.000 -4.000 4.000\n0.000 0.000 -4.000 -4.000\n";
    assert_eq!(folder.read("part.pts"), expected);
    assert_eq!(report(&folder)["wire"]["height_mm"], 40.0);
    let list = folder.read("part.pts");
    let said = on("", &[&part[..], &["--uv-height", "80"]].concat());
    assert_eq!((said.code, folder.read("part.pts")), (0, list), "{said:?}");

    for (plane, more, words) in [
        ("", &[][..], ["wire-height", "`height` in the [wire] table"]),
        ("height = 80", &["--uv-height", "40"], ["wire-height", "80 mm up"]),
    ] {
        let said = on(plane, &[&part[..], more].concat());
        assert!(said.code > 0 && words.iter().all(|word| said.err.contains(word)), "{said:?}");
    }
    let said = on("height = 80", &part[..2]);
    assert!(said.code == 2 && said.err.contains("height of the part"), "{said:?}");

    // A taper of 10° through 20 mm is one of 10° in the machine's plane 40 mm up: 40 mm · tan 10° = 7.053 mm.
    let taper = ["--side", "inside", "--taper", "-10", "--height", "20", "--thread", "5,5"];
    let said = on("height = 40", &taper);
    assert_eq!(said.code, 0, "{said:?}");
    let most = folder
        .read("part.pts")
        .lines()
        .flat_map(|line| {
            let words: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
            [words[2].abs(), words[3].abs()]
        })
        .fold(0.0, f64::max);
    assert!((most - 7.053).abs() < 5e-4, "{most}");
}

/// A source that says U and V in a plane 60 mm up, cut in a part of 30 mm: half as far aside.
#[test]
fn a_source_with_u_and_v_is_read_in_its_own_plane() {
    let folder = sector();
    folder.write("old.toml", "extends = \"fanuc-wire\"\n[wire]\nheight = 60\n");
    folder.write("new.toml", "extends = \"bp-95d\"\n[wire]\nheight = 90\n");
    folder.write(
        "sector.nc",
        "G21 G90\nG0 X0. Y0. U0. V0.\nM60\nG1 X10. U2. V0. F6.\nY10.\nX0. Y0. U0.\nM50\nM30\n",
    );
    let call = ["wire", "sector.nc", "--from", "old.toml", "-m", "new.toml", "-o", "part.pts"];
    for more in [&["--height", "30"][..], &[]] {
        let said = folder.run(&[&call[..], more].concat());
        assert_eq!(said.code, 0, "{said:?}");
        // 90 mm up the wire is half as far again aside.
        assert!(
            folder.read("part.pts").contains("\n10.000 10.000 3.000 0.000\n"),
            "{}",
            folder.read("part.pts")
        );
        let height = if more.is_empty() { 60.0 } else { 30.0 };
        assert_eq!(report(&folder)["wire"]["height_mm"], height);
    }
}

#[test]
fn a_list_says_one_opening_only() {
    let folder = sector();
    let second = "G0 X100. Y0.\nG1 X110.\nY10.\nX100. Y0.\nN60 M30";
    folder.write("sector.nc", SECTOR.replace("N60 M30", second));
    // It begins with the rapid to where it is threaded.
    refused(&folder, &[], 1, &["error[one-opening]", "sector.nc:9:", "| G0 X100. Y0."]);
}

#[test]
fn the_picture_is_the_same_each_time_and_in_both_formats() {
    let folder = sector();
    let picture = |name: &str| {
        let said = wire(&folder, &["--step", "1", "--picture", name, "--select", "6"]);
        assert_eq!(said.code, 0, "{said:?}");
        std::fs::read(folder.path().join(name)).unwrap()
    };
    let svg = picture("a.svg");
    assert_eq!(svg, picture("b.svg"));
    let text = String::from_utf8(svg).unwrap();
    for word in ["CONTOUR, 66 POINTS", "START", "LINE 6", "3.125e-3 MM AT MOST", "HEIGHT NOT GIVEN"]
    {
        assert!(text.contains(word), "{word}");
    }
    assert!(picture("a.png").starts_with(b"\x89PNG"));
    refused(&folder, &["--picture", "a.pdf"], 2, &["error[drawing]"]);
    refused(&folder, &["--picture", "sector.nc"], 2, &["error[output-file]"]);
}

/// The opening of a die in two passes, as everyone may read it next to its machine.
const DIE: [&str; 15] = [
    "--from",
    "fanuc-31i",
    "--side",
    "inside",
    "--wire",
    "0.25",
    "--gap",
    "0.02",
    "--leave",
    "0.03",
    "--thread",
    "15,15",
    "--round-corners",
    "--feed",
    "0.1,0.2",
];

/// The samples were read by a person, as those of the mills: `make samples` writes them anew.
#[test]
fn the_sample_program_of_each_wire_machine_is_as_it_was_read() {
    let folder = sector();
    let samples = concat!(env!("CARGO_MANIFEST_DIR"), "/../../machines/samples");
    let machines = machine::library::names(machine::library::MACHINES);
    for machine in machines.map(|name| machine::load(name).unwrap()).filter(|m| m.wire.is_some()) {
        let file = format!("{}.{}", machine.name, machine.extension);
        let call = ["wire", "sector.nc", "-m", &machine.name, "-o", &file];
        let said = folder.run(&[&call[..], &DIE].concat());
        assert_eq!(said.code, 0, "{said:?}");
        let expected = std::fs::read_to_string(format!("{samples}/{file}")).unwrap_or_default();
        assert_eq!(folder.read(&file), expected, "{file}");
        // Read back as a source, it is the same way of the wire again.
        let again = ["wire", &file, "--from", &machine.name, "-m", &machine.name, "-o", "again"];
        if machine.name != "bp-95d" {
            assert_eq!(folder.run(&[&again[..], &["--feed", "0.1"]].concat()).code, 0);
            let moves = |text: &str| text.lines().filter(|line| line.contains(" G1 ")).count();
            assert_eq!(moves(&folder.read("again")), moves(&expected), "{file}");
        }
    }
}

#[test]
fn the_control_offsets_and_leans_the_wire_where_it_can() {
    let folder = sector();
    let call = |machine: &'static str, more: &[&str]| {
        let call = ["wire", "sector.nc", "--by-control", "-m", machine, "-o", "die.nc"];
        folder.run(&[&call[..], &DIE, more].concat())
    };
    let says = |blocks: &[&str]| {
        let text = folder.read("die.nc");
        let found = blocks.iter().try_fold(text.as_str(), |rest, block| {
            rest.split_once(&format!(" {block}\n")).map(|(_, rest)| rest)
        });
        assert!(found.is_some(), "not in this order: {blocks:?}\n{text}");
    };
    assert_eq!(call("fanuc-wire", &[]).code, 0);
    // Counter-clockwise inside: the wire on the left; back the other way on the right.
    says(&["G1 G41 D1 Y0. F6.", "X40.", "G3 X0. Y40. I-40. J0.", "G40 Y15."]);
    says(&["G42 D2 Y0. F12.", "G2 X40. Y0. I0. J-40.", "G40 Y15.", "M50"]);
    // Larger at the top, so the upper end is outside: on the right of that way, and on the left of the
    // way back.
    let taper = ["--taper", "5", "--height", "20"];
    assert_eq!(call("fanuc-wire", &taper).code, 0);
    says(&[
        "G1 G41 D1 G52 T5. Y0. F6.",
        "X40.",
        "G40 G50 Y15.",
        "G42 D2 G51 T5. Y0. F12.",
        "G40 G50 Y15.",
    ]);
    assert_eq!(call("sodick-iso", &["--taper", "-5", "--height", "20"]).code, 0);
    says(&["G1 G41 H001 G51 A5. Y0. F6.", "G42 H002 G52 A5. Y0. F12."]);
    let refused = |machine, more: &[&str], code, rule: &str| {
        let said = call(machine, more);
        assert!(said.code == code && said.err.contains(rule), "{said:?}");
    };
    refused("agie-iso", &taper, 1, "error[taper]");
    refused("bp-95d", &[], 2, "error[by-control]");
}

/// A plate of 30 mm with a hole, in which a slug of 2 mm stays.
#[test]
fn a_part_is_cut_round_its_outside_and_within_its_openings() {
    let folder = Folder::new();
    let circle = |radius: f64| format!("0\nCIRCLE\n8\n0\n10\n0.0\n20\n0.0\n40\n{radius}\n");
    let circles = [15.0, 8.0, 2.0].map(circle).concat();
    folder.write("plate.dxf", format!("0\nSECTION\n2\nENTITIES\n{circles}0\nENDSEC\n0\nEOF\n"));
    let call = ["wire", "plate.dxf", "-m", "fanuc-wire", "-o", "part.nc", "--side", "part"];
    let said = folder.run(&[&call[..], &["--wire", "0.2", "--lead", "1"]].concat());
    assert_eq!(said.code, 0, "{said:?}");
    // Inner ones first; the wire goes 0.1 mm outside, inside, outside.
    let text = folder.read("part.nc");
    let ways = text.lines().filter_map(|line| line.split_once("G1 ").map(|(_, words)| words));
    assert_eq!(ways.collect::<Vec<_>>(), ["X2.1", "X3.", "X7.9", "X7.", "X15.1", "X16."]);
}

/// A bore of 20 mm as a wire's program has it: the contour, and the offset a matter of the control.
const BORE: &str = "%\nO2\nG21 G90 G40\nG92 X0. Y0.\nM60\nG41 D1 G1 X10. Y0.\nG3 X-10. Y0. I-10. J0.\n\
                    G3 X10. Y0. I10. J0.\nG40 G1 X0. Y0.\nM50\nM30\n%\n";

#[test]
fn the_offset_of_a_source_is_worked_out_here_or_left_to_the_new_control() {
    let folder = Folder::new();
    folder.write("bore.nc", BORE);
    let call = |more: &[&str]| {
        folder.run(&[&["wire", "bore.nc", "--from", "fanuc-wire", "-o", "part.nc"], more].concat())
    };
    let said = call(&["-m", "bp-95d"]);
    assert!(said.code == 2 && said.err.contains("bore.nc:6") && said.err.contains("--side"));
    let said = call(&["-m", "bp-95d", "--side", "inside", "--wire", "0.25", "--gap", "0.02"]);
    assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
    // 10 − 0.125 − 0.02 mm.
    let text = folder.read("part.nc");
    assert!(text.starts_with("0.000 0.000\n9.855 0.000\n") && text.ends_with("\n0.000 0.000\n"));
    let said = call(&["-m", "sodick-iso", "--side", "left", "--by-control"]);
    assert_eq!(said.code, 0, "{said:?}");
    let text = folder.read("part.nc");
    assert!(text.contains("G1 G41 H001 X10.\n") && text.contains("G1 G40 X0.\n"), "{text}");
    let said = call(&["-m", "sodick-iso", "--side", "outside", "--by-control"]);
    assert!(said.code == 2 && said.err.contains("error[side]"), "{said:?}");
}

#[test]
fn drawings_are_read_by_layer() {
    let folder = Folder::new();
    let circle =
        |layer: &str, x: f64| format!("0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n0.0\n40\n5.0\n");
    let text = format!(
        "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{}{}0\nENDSEC\n0\nEOF\n",
        circle("CUT", 0.0),
        circle("NOTE", 50.0)
    );
    folder.write("plate.dxf", &text);
    let call = ["wire", "plate.dxf", "-m", "bp-95d", "-o", "part.pts", "--layer"];
    let said = folder.run(&[&call[..], &["CUT", "--chord-error", "0.01"]].concat());
    assert_eq!(said.code, 0, "{said:?}");
    // Chords of 0.01 mm on R 5 turn by 4·asin(√0.001) = 7.25°: 50 of them make a circle.
    assert_eq!(folder.read("part.pts").lines().count(), 51);
    let said = folder.run(&[&call[..], &["NONE"]].concat());
    assert_eq!((said.code, folder.names().len()), (2, 4), "{said:?}");
}

/// Cuts `source` round its outside.
fn round(folder: &Folder, control: &str, source: &str) -> Said {
    folder.write("flat.nc", source);
    let call = ["wire", "flat.nc", "--from", control, "-m", "fanuc-wire", "--side", "outside"];
    let cut = ["--wire", "0.25", "--gap", "0.02", "--thread", "50,-10", "-o", "part.nc"];
    folder.run(&[&call[..], &cut].concat())
}

#[test]
fn a_contour_of_which_no_block_says_z_is_flat() {
    let folder = Folder::empty();
    let contour = "G1 X40. F100.\nG3 X40. Y20. I0. J10.\nG1 X0.\nG1 Y0.\n";
    // A SINUMERIK knows no coordinate behind the word of a work offset until it is said.
    let heads = |control| if control == "sinumerik-840d" { &[""][..] } else { &["G54\n", ""] };
    for control in ["fanuc-31i", "sinumerik-840d", "linuxcnc", "haas"] {
        for head in heads(control) {
            let source = format!("G21\nG90 G17\n{head}G0 X0. Y0. Z0.\n{contour}M30\n");
            let source =
                if control.starts_with("sin") { source.replace("G21", "G71") } else { source };
            let said = round(&folder, control, &source);
            assert_eq!(said.code, 0, "{control}: {said:?}");
            assert!(!said.err.contains("flat-contour"), "{control}: {said:?}");
            let with_z = folder.read("part.nc");
            let source = source.replace("Y0. Z0.", "Y0.");
            let said = round(&folder, control, &source);
            assert_eq!(said.code, 0, "{control} {head}: {said:?}");
            assert!(said.err.contains("warning[flat-contour]"), "{control}: {said:?}");
            assert_eq!(folder.read("part.nc"), with_z);
            // A Z that is said, and differs.
            let said = round(&folder, control, &source.replace("M30", "G1 Z-5.\nG1 X40.\nM30"));
            assert_eq!(said.code, 2, "{control}: {said:?}");
            assert_eq!(folder.read("part.nc"), with_z);
        }
    }
}

/// A square of 10 mm for a wire machine, and what comes in it behind its fifth corner, 1 mm before it closes.
fn wire_source(first: &str, before_it_closes: &str, rest: &str) -> Folder {
    let folder = Folder::new();
    let square = format!(
        "%\nO0001\nG21 G90 G40\nG92 X5. Y-5.\nM60\nG1 X5. Y0.{first}\nX10.\nY10.\nX0.\nY0.\nX4.\n{before_it_closes}X5.\nY-5.\nM50\n{rest}M2\n%\n"
    );
    folder.write("sector.nc", square);
    folder.write("high.toml", "extends = \"fanuc-wire\"\n[wire]\nheight = 50\n");
    folder
}

const ONTO_WIRE: [&str; 8] =
    ["wire", "sector.nc", "--from", "fanuc-wire", "-m", "fanuc-wire", "-o", "part.nc"];

/// U 1 in a plane 50 mm up is U 1 there, however high the part is; in a plane that nobody knows it is nothing.
#[test]
fn u_and_v_of_a_source_never_count_at_the_height_of_the_part() {
    let folder = wire_source(" U1. V0.5", "U0. V0.\n", "");
    let on = |from: &str, onto: &str, more: &[&str]| {
        let mut call = ONTO_WIRE;
        (call[3], call[5]) = (from, onto);
        folder.run(&[&call[..], more].concat())
    };
    for (from, onto, more) in [
        ("fanuc-wire", "fanuc-wire", &["--height", "20", "--uv-height", "50"][..]),
        ("high.toml", "high.toml", &["--height", "20"]),
        ("high.toml", "fanuc-wire", &["--height", "20", "--uv-height", "50"]),
        ("fanuc-wire", "fanuc-wire", &["--uv-height", "50"]),
    ] {
        let said = on(from, onto, more);
        assert_eq!(said.code, 0, "{said:?}");
        let text = folder.read("part.nc");
        assert!(text.contains("U1. V0.5") || text.contains("V0.5 U1."), "{from} {onto}: {text}");
    }
    for (from, onto, more) in [
        ("fanuc-wire", "high.toml", &["--height", "20"][..]),
        ("fanuc-wire", "fanuc-wire", &["--height", "20"]),
    ] {
        let said = on(from, onto, more);
        let words = ["error[upper-plane]", "--uv-height"];
        assert!(said.code == 2 && words.iter().all(|word| said.err.contains(word)), "{said:?}");
    }
}

/// What a source of a wire machine says besides its contour: where it stops before the contour closes, a slug is held, which would fall on the wire.
#[test]
fn stops_and_ends_of_the_wire_within_a_contour_are_refused_and_what_else_is_left_out_is_told() {
    let said = |first: &str, before_it_closes: &str, rest: &str| {
        wire_source(first, before_it_closes, rest).run(&ONTO_WIRE)
    };
    for (stops, line) in [("M0\n", 12), ("M1\n", 12), ("M50\nM0\nM60\n", 12), ("M50\nM60\n", 12)] {
        let said = said("", stops, "");
        let words = ["error[stop-in-cut]".to_owned(), format!("sector.nc:{line}"), "--tab".into()];
        assert!(
            said.code == 2 && words.iter().all(|word| said.err.contains(word)),
            "{stops} {said:?}"
        );
    }
    let found = said("", "", "");
    assert_eq!((found.code, found.err.as_str()), (0, ""), "{found:?}");
    let found = said(" F2.", "F1.\n", "");
    assert!(found.code == 0 && found.err.contains("warning[feed]"), "{found:?}");
    assert!(found.err.contains("2 times"), "{found:?}");
    let second = "M0\nG0 X25. Y-5.\nM60\nG1 X25. Y0.\nX30.\nY10.\nX25.\nY-5.\nM50\n";
    let found = said("", "", second);
    assert!(found.code == 0 && found.err.contains("M0 of the source is left out"), "{found:?}");
}
