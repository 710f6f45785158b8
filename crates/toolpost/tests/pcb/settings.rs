//! What a call asks for: settings files, units, several widths, tabs by hand and the rest, as the control reads the programs.

use crate::board::{CALL, EDGE, Made, call, edge, front, refused, small};
use crate::folder::Folder;
use std::f64::consts::TAU;

/// The cut is `wide` mm, and so much of it is around both pads of 2 mm, at these distances from their edges.
#[track_caller]
fn around(made: &Made, rings: &[f64]) {
    let right: f64 = rings.iter().map(|away| 2.0 * TAU * (1.0 + away)).sum();
    let length = made.length("front");
    // Links between the rings of a pad are gone along twice at most.
    let most = right + 2.0 * 2.0 * rings.last().unwrap();
    assert!((right - 0.02..most).contains(&length), "{length} mm, not {right}");
}

#[test]
fn a_settings_file_beside_the_board_is_typed_for_the_user() {
    let folder = small();
    folder.write(
        "board/toolpost.toml",
        "# ours\ntool = \"16mil\"\ndepth = 0.15\npicture = \"none\"\nonly = [\"front\", \"drill\"]\nsplit_tools = false\n",
    );
    let run = |more: &[&str]| {
        let said = folder.run(&[&["pcb", "board", "-o", "out", "-m", "grbl-3018"], more].concat());
        assert_eq!(said.code, 0, "{said:?}");
        said
    };
    // 16 mil are 0.4064 mm; the file is none of the board's.
    let said = run(&[]);
    assert!(
        said.out.contains("end mill 0.4064 mm") && !said.err.contains("toolpost.toml"),
        "{said:?}"
    );
    assert!(folder.read("out/front.gcode").contains("Z-0.15"));
    assert!(!folder.path().join("out/outline.gcode").exists());
    assert!(!folder.path().join("out/front.svg").exists());
    // What is typed counts more, and a V-bit leaves the file's mill no meaning.
    assert!(run(&["--tool", "0.3"]).out.contains("end mill 0.3 mm"));
    assert!(run(&["--vee", "30"]).out.contains("V-bit 30 degrees"));
    // Elsewhere it is named.
    folder.write("other.toml", "tool = [0.5]\nmachine = \"grbl-3018\"\noutput = \"there\"\n");
    let said = folder.run(&["pcb", "board", "--settings", "other.toml"]);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(
        folder.read("there/front.gcode").contains("MILL_0.5")
            || said.out.contains("end mill 0.5 mm")
    );
}

#[test]
fn keys_and_values_of_a_settings_file_that_are_wrong() {
    let folder = small();
    for (text, words) in [
        (
            "tool = 0.4\npassess = 2\n",
            &["toolpost.toml:2", "settings-key", "`passess`", "passes"][..],
        ),
        ("tool = \"wide\"\n", &["toolpost.toml:1", "settings-key", "wide", "--tool"]),
        ("tool = 0.4\n\npasses = [\"a\", \"b\"]\n", &["toolpost.toml:3", "settings-key"]),
        ("tool = { a = 1 }\n", &["toolpost.toml:1", "`tool`"]),
        ("tool = \n", &["toolpost.toml:1", "settings-key"]),
        ("json = true\n", &["toolpost.toml:1", "`json`"]),
        ("narrow = \"midle\"\n", &["toolpost.toml:1", "midle"]),
    ] {
        folder.write("board/toolpost.toml", text);
        refused(&folder, &["pcb", "board", "-o", "out", "-m", "grbl-3018"], 2, words);
    }
    // Three faults are three errors.
    folder.write("board/toolpost.toml", "a1 = 1\nb2 = 2\nc3 = 3\n");
    let said =
        refused(&folder, &["pcb", "board", "-o", "out", "-m", "grbl-3018"], 2, &[":1", ":2", ":3"]);
    assert_eq!(said.err.matches("error[").count(), 3);
}

/// Inches but where `metric` or a unit says otherwise, as pcb2gcode reads them.
#[test]
fn a_millproject_is_imported() {
    let folder = small();
    folder.write(
        "board/millproject",
        "# of pcb2gcode\nfront=front.gbr\ndrill=holes.drl\nmill-diameters=0.4mm\nzwork=-0.002\nextra-passes=1 # twice\n\
         mill-feed=20\nmill-speed=9000\ndrill-feed=50mm/min\ndrill-speed=8000\nzsafe=3mm\nzdrill=-1.8mm\nzchange=1\n\
         zero-start=true\nmetricoutput=true\noptimise=1\nspinup-time=3s\nfrobnicate=7\n",
    );
    let file = "board/millproject";
    let said = folder.run(&[
        "pcb",
        "--settings",
        file,
        "-o",
        "out",
        "-m",
        "grbl-3018",
        "--picture",
        "none",
    ]);
    assert_eq!(said.code, 0, "{said:?}");
    for word in [
        "warning[project-key]",
        "drill-speed=8000",
        "zchange",
        "optimise",
        "frobnicate",
        "metricoutput",
        "no key that is known",
    ] {
        assert!(said.err.contains(word), "{word}: {}", said.err);
    }
    let text = folder.read("out/front.gcode");
    // 0.002 inch deep, 20 inch/min, from 3 mm above the board; the second time around half a tool farther out.
    for block in ["Z-0.051", "F508", "Z3", "G4 P3", "S9000"] {
        assert!(text.contains(block), "{block}\n{text}");
    }
    assert!(
        said.out.contains("front.gbr: front copper") && !said.out.contains("back copper"),
        "{}",
        said.out
    );
    let report: serde_json::Value = serde_json::from_str(&folder.read("out/report.json")).unwrap();
    assert_eq!(report["programs"][0]["operations"][0], "isolation, end mill 0.4 mm");
    let drill = folder.read("out/drill.gcode");
    assert!(drill.contains("Z-1.8") && drill.contains("F50"), "{drill}");
    // Beside the board it is not used unasked, and a warning says how it would be.
    let beside =
        ["pcb", "board", "--tool", "0.4", "-o", "other", "-m", "grbl-3018", "--picture", "none"];
    let said = folder.run(&beside);
    assert!(said.code == 0 && folder.read("other/front.gcode").contains("S10000"), "{said:?}");
    for word in ["warning[file-unused]", "--settings board/millproject"] {
        assert!(said.err.contains(word), "{word}: {}", said.err);
    }
    for (line, word) in [
        ("zwork\n", "key=value"),
        ("zwork=deep\n", "`zwork=deep`"),
        ("extra-passes=x\n", "extra-passes"),
    ] {
        folder.write("board/millproject", format!("front=front.gbr\n{line}"));
        let call = ["pcb", "--settings", file, "-o", "new", "-m", "grbl-3018", "--tool", "0.4"];
        refused(&folder, &call, 2, &["millproject:2", "settings-key", word]);
    }
}

#[test]
fn lengths_have_units() {
    let folder = small();
    for (tool, name) in
        [("0.4mm", "0.4 mm"), ("16mil", "0.4064 mm"), ("0.02in", "0.508 mm"), ("400um", "0.4 mm")]
    {
        let said = folder.run(&[
            "pcb",
            "board",
            "-o",
            "out",
            "-m",
            "grbl-3018",
            "--only",
            "front",
            "--tool",
            tool,
        ]);
        assert!(said.code == 0 && said.out.contains(&format!("end mill {name}")), "{said:?}");
    }
    for wrong in ["0.4 feet", "mm", "0mm", "1e9in", "nan"] {
        let said = folder.run(&["pcb", "board", "-o", "new", "-m", "grbl-3018", "--tool", wrong]);
        assert!(said.code == 2 && said.err.contains("8mil"), "{said:?}");
    }
    // A drill file that says neither unit nor zeros, with a drill that may be one of 1/8 inch.
    folder.write("board/holes.drl", "M48\nT1C0.125\n%\nT1\nX0.4Y0.2\nM30\n");
    refused(&folder, &CALL, 2, &["error[no-unit]", "--unit"]);
    let said = call(&folder, &["--unit", "inch", "--only", "drill", "--as-drawn"]);
    assert!(said.code == 0 && said.out.contains("drill 3.175 mm"), "{said:?}");
    let said = call(&folder, &["--unit", "mm", "--only", "drill"]);
    assert!(said.code == 0 && said.out.contains("drill 0.125 mm"), "{said:?}");
}

#[test]
fn an_isolation_is_as_wide_as_is_asked_for() {
    let folder = small();
    let more =
        |width: &'static str| ["--tool", "0.4", "--isolation-width", width, "--only", "front"];
    // Passes of 0.4 mm, 0.3 mm apart: 0.4, 0.7 and 1 mm wide.
    around(&Made::of(&folder, "board", "grbl-3018", &more("0.3")), &[0.2]);
    around(&Made::of(&folder, "board", "grbl-3018", &more("0.4")), &[0.2]);
    around(&Made::of(&folder, "board", "grbl-3018", &more("0.41")), &[0.2, 0.5]);
    around(&Made::of(&folder, "board", "grbl-3018", &more("1")), &[0.2, 0.5, 0.8]);
    refused(
        &folder,
        &[&CALL[..], &["--isolation-width", "50"]].concat(),
        2,
        &["error[passes]", "0.400 mm"],
    );
    refused(
        &folder,
        &[&CALL[..], &["--isolation-width", "1", "--passes", "2"]].concat(),
        2,
        &["`passes`"],
    );
}

/// Two pads of 2 mm, 0.3 mm apart. A mill of 0.8 mm goes around both, one of 0.2 mm into the gap, and not again all around.
#[test]
fn a_narrow_tool_cuts_what_a_wide_one_leaves() {
    let folder = small();
    front(&folder, "D10*\nX4000Y5000D03*\nX6300Y5000D03*\n");
    let made = Made::of(&folder, "board", "grbl-3018", &["--tool", "0.8,0.2", "--only", "front"]);
    let operations = made.operations("front");
    assert_eq!(operations, ["isolation, end mill 0.8 mm", "isolation, end mill 0.2 mm"]);
    assert!(!made.said.err.contains("narrow-gap"), "{}", made.said.err);
    let cuts = made.cuts("front");
    let of = |tool: usize| {
        cuts.iter().filter(move |cut| cut.tool == tool).map(|cut| cut.length).sum::<f64>()
    };
    let (wide, narrow) = (of(1), of(2));
    // Around each pad at 1.4 mm, but where these two circles overlap: 2 acos(1.15 / 1.4) of each.
    let right = 2.0 * 1.4 * (TAU - 2.0 * (1.15f64 / 1.4).acos());
    assert!((wide - right).abs() < 0.05, "{wide}, not {right}");
    // The narrow one goes around each at 1.1 mm where a disc of 0.1 mm there is not within what the wide one took: that is
    // up to where the wide one touches the pad in the corner between the two, and what 0.02 mm more of its disc ask for.
    let touched = (1.15f64 / 1.4).acos();
    let least = 2.0 * 1.1 * 2.0 * touched;
    assert!((least..1.35 * least).contains(&narrow), "{narrow}, not {least}");
    // It ends where it began: each net is apart from the other.
    let gap = |cut: &&drawing::Segment| {
        (cut.from.x - 5.15).abs() < 0.06 && (cut.from.y - 5.0).abs() < 0.3
    };
    assert!(cuts.iter().filter(|cut| cut.tool == 2).any(|cut| gap(&cut)));
    // Pads 10 mm apart leave nothing for the narrow one: it is not called, and that is said.
    front(&folder, "D10*\nX4000Y5000D03*\nX14000Y5000D03*\n");
    let made =
        Made::of(&folder, "board", "linuxcnc-mill", &["--tool", "0.8,0.2", "--only", "front"]);
    assert_eq!(made.operations("front"), ["isolation, end mill 0.8 mm"]);
    assert!(
        made.said.err.contains("nothing is left that end mill 0.2 mm reaches"),
        "{}",
        made.said.err
    );
    let call = [&CALL[..6], &["--tool", "0.2,0.8"]].concat();
    refused(&folder, &call, 2, &["error[tool-width]", "widest first"]);
}

/// Inverted, the pads are cut away from inside, 0.2 mm from their edges.
#[test]
fn what_is_drawn_can_be_cut_away_and_lines_along_their_middle() {
    let folder = small();
    let made =
        Made::of(&folder, "board", "grbl-3018", &["--tool", "0.4", "--only", "front", "--invert"]);
    made.circles("front", &[[4.0, 5.0], [14.0, 5.0]], 0.8, 0.1);
    front(&folder, "D10*\nX4000Y5000D02*\nX14000D01*\nY8000D01*\n");
    let lines = ["--tool", "0.4", "--only", "front", "--isolate", "lines"];
    let made = Made::of(&folder, "board", "grbl-3018", &lines);
    assert!((made.length("front") - 13.0).abs() < 1e-3, "{}", made.length("front"));
    assert!(made.said.err.contains("warning[lines-only]"), "{}", made.said.err);
    refused(
        &folder,
        &[&CALL[..], &["--isolate", "lines", "--only", "back", "--strict"]].concat(),
        2,
        &["no lines"],
    );
}

#[test]
fn holes_over_a_size_are_milled() {
    let folder = small();
    folder.write(
        "board/holes.drl",
        "M48\nMETRIC\nT1C0.8\nT2C3.0\n%\nT1\nX4.0Y5.0\nT2\nX14.0Y5.0\nM30\n",
    );
    let more = ["--only", "drill", "--hole-mill", "2", "--mill-holes-over", "2"];
    let made = Made::of(&folder, "board", "grbl-3018", &more);
    assert_eq!(made.operations("drill"), ["drill 0.8 mm", "mill holes"]);
    let ends = made.cuts("drill").into_iter().flat_map(|cut| [cut.from, cut.to]);
    let off = |end: geom::Vec3| (end.truncate().distance(geom::Vec2::new(14.0, 5.0)) - 0.5).abs();
    assert!(ends.into_iter().all(|end| off(end) < 1e-3));
    refused(&folder, &[&CALL[..], &["--mill-holes-over", "2"]].concat(), 2, &["`hole_mill`"]);
}

/// The mill of 2 mm goes around at 1 mm from the edge. A tab of 2 mm is under 4 mm of its path.
#[test]
fn tabs_are_put_by_hand() {
    let folder = small();
    let more = ["--only", "outline", "--tab-at", "5,-3", "--tab-at", "21,5"];
    let made = Made::of(&folder, "board", "grbl-3018", &more);
    let above: Vec<_> = made
        .cuts("outline")
        .into_iter()
        .filter(|cut| (cut.from.z + 1.0).abs() < 1e-6 && (cut.to.z + 1.0).abs() < 1e-6)
        .collect();
    // At the two levels below the tabs' top each is gone over once: thickness 1.6, tabs 0.6 high.
    let places: std::collections::BTreeSet<_> = above
        .iter()
        .map(|cut| cut.from.midpoint(cut.to).truncate().round().as_ivec2().to_array())
        .collect();
    assert_eq!(places.into_iter().collect::<Vec<_>>(), [[5, -1], [21, 5]]);
    let length: f64 = above.iter().map(|cut| cut.length).sum();
    assert!((length / 4.0).fract().abs() < 1e-3 || (length / 4.0).fract() > 0.999, "{length}");
}

#[test]
fn a_board_is_cut_as_a_rectangle_and_turned() {
    let folder = small();
    // A corner is cut off.
    edge(&folder, "D11*\nX0Y0D02*\nX20000D01*\nY5000D01*\nX15000Y10000D01*\nX0D01*\nY0D01*\n");
    let whole = Made::of(
        &folder,
        "board",
        "grbl-3018",
        &["--only", "outline", "--tabs", "0", "--rectangular", "--board-margin", "1"],
    );
    // 22 by 12 mm, a mill of 2 mm around it, four times down: sides, and corners of 1 mm.
    let around = 2.0 * (22.0 + 12.0) + TAU;
    let length = whole.length("outline");
    assert!((length - 4.0 * around).abs() < 0.05, "{length}, not {}", 4.0 * around);
    assert_eq!(whole.report()["board"]["high_mm"][0], 22.0);
    edge(&folder, EDGE);
    let turned = Made::of(&folder, "board", "grbl-3018", &["--only", "drill", "--rotate", "90"]);
    // Counter-clockwise about the lower left corner: 4, 5 goes to -5, 4, and the corner of the box is at -10, 0.
    assert_eq!(turned.holes("drill"), [[5.0, 4.0, -1.8], [5.0, 14.0, -1.8]]);
    assert_eq!(turned.report()["board"]["high_mm"], serde_json::json!([10.0, 20.0]));
}

#[test]
fn a_spindle_is_waited_for_and_text_is_the_users() {
    let folder = small();
    let more = [
        "--tool",
        "0.4",
        "--only",
        "front",
        "--spin-up",
        "7",
        "--text-before",
        "(OURS)@G4 P0",
        "--text-after",
        "(BYE)",
    ];
    let made = Made::of(&folder, "board", "grbl-3018", &more);
    let text = made.text("front");
    assert!(text.contains("M3\nG4 P7\n") && !text.contains("G4 P2"), "{text}");
    let lines: Vec<&str> = text.lines().collect();
    let at = |line: &str| lines.iter().position(|other| *other == line).unwrap();
    assert!(at("(OURS)") < at("T1") && at("(BYE)") < at("M30") && at("(BYE)") > at("T1"), "{text}");
    // It is proven as everything is: what moves or switches is refused.
    for wrong in ["G1 X9 F100", "G0 Z-1", "Q7"] {
        let said = folder.run(&[&CALL[..], &["--only", "front", "--text-after", wrong]].concat());
        assert_eq!(said.code, 1, "{wrong}: {said:?}");
    }
}

/// A program that was edited is compared with its board again.
#[test]
fn programs_of_a_board_are_proven_again() {
    let folder = small();
    let made = Made::of(
        &folder,
        "board",
        "grbl-3018",
        &["--tool", "0.4", "--passes", "2", "--probe", "3x3"],
    );
    let _ = made;
    let prove = |file: &str| folder.run(&["prove", file, "-m", "grbl-3018", "--against", "board"]);
    for part in ["front", "back", "drill", "outline", "probe"] {
        let said = prove(&format!("out/{part}.gcode"));
        assert_eq!(said.code, 0, "{part}: {said:?}");
        assert!(said.out.contains("match the toolpath"), "{}", said.out);
    }
    let text = folder.read("out/front.gcode");
    folder.write("out/front.gcode", text.replacen("Z-0.1", "Z-0.3", 1));
    let said = prove("out/front.gcode");
    assert!(said.code == 1 && said.err.contains("front.gcode"), "{said:?}");
    folder.write("out/other.gcode", &text);
    let said = prove("out/other.gcode");
    assert!(
        said.code == 2 && said.err.contains("error[no-such-part]") && said.err.contains("outline"),
        "{said:?}"
    );
    let alone = Folder::empty();
    alone.write("front.gcode", &text);
    let board = folder.path().join("board");
    let said = alone.run(&[
        "prove",
        "front.gcode",
        "-m",
        "grbl-3018",
        "--against",
        &board.to_string_lossy(),
    ]);
    assert!(said.code == 2 && said.err.contains("report.json"), "{said:?}");
}

/// Two keys of a millproject for the one option that says where the cuts are: the first counts, and the other is named.
/// A feed or speed that the machine does not have is reported where it stands, by the name of its option, before anything is cut;
/// programs that are not asked for ask for none.
#[test]
fn a_feed_beyond_the_machine_is_reported_where_it_stands() {
    let folder = small();
    let project = "mill-diameters=0.4mm\nmill-speed=20000\nmill-feed=100\nmill-vertfeed=2\ncut-feed=200mm\nzero-start=1\n";
    folder.write("board/millproject", project);
    folder.write("own.toml", "extends = \"grbl-3018\"\nfeed_max = 2000\n[spindle]\nmax = 10000\n");
    let call = ["pcb", "board", "-o", "out", "-m", "own.toml"];
    let said = folder.run(&[&call[..], &["--settings", "board/millproject"]].concat());
    assert_eq!(said.code, 1, "{said:?}");
    // Inches each minute.
    for line in [
        "board/millproject:3:1: error[feed-range]: `feed` is 2540 mm/min\n    | mill-feed=100\n",
        "= the machine feeds at most 2000 mm/min (feed_max)",
        "board/millproject:2:1: error[spindle-range]: `speed` is 20000 1/min\n    | mill-speed=20000\n",
    ] {
        assert!(said.err.contains(line), "{line} {said:?}");
    }
    assert!(!folder.path().join("out").exists(), "{said:?}");
    // Typed, it stands in no file.
    let typed = ["--tool", "0.4", "--drill-feed", "2001", "--outline-feed", "3000"];
    let said = folder.run(&[&call[..], &typed].concat());
    assert_eq!(said.code, 1, "{said:?}");
    for line in
        ["error[feed-range]: `drill_feed` is 2001", "\nerror[feed-range]: `outline_feed` is 3000"]
    {
        assert!(said.err.contains(line), "{line} {said:?}");
    }
    let said = folder.run(&[&call[..], &typed, &["--only", "front"]].concat());
    assert_eq!(said.code, 0, "{said:?}");
}

#[test]
fn a_millproject_that_says_two_places_of_the_cuts_gets_the_first() {
    let folder = small();
    folder.write(
        "board/millproject",
        "mill-diameters=0.4mm\nvoronoi=1\ndraw-gerber-lines=1\nzero-start=1\n",
    );
    let call = ["pcb", "board", "--settings", "board/millproject", "-o", "out", "-m", "grbl-3018"];
    let said = folder.run(&call);
    assert_eq!(said.code, 0, "{said:?}");
    let why = "draw-gerber-lines (--isolate is one: middle)";
    assert!(said.err.contains(why), "{said:?}");
}

/// Each further tool sets Z 0 on a touch plate; the proof refuses whatever would set another zero, break the tool or hit the plate.
#[test]
fn tools_are_touched_off_on_a_plate() {
    let folder = small();
    folder.write(
        "router.toml",
        "extends = \"grbl-3018\"\n[options]\ntouch_travel = 15\ntouch_height = 1.6\ntouch_x = -3\ntouch_y = 2\n",
    );
    let machine = ["-m", "router.toml"];
    let call = ["pcb", "board", "--only", "drill", "--alignment", "3", "-o", "out"];
    let said = folder.run(&[&call[..], &machine[..]].concat());
    assert_eq!(said.code, 0, "{said:?}");
    let text = folder.read("out/drill.gcode");
    // Home, the spindle off, over the plate, the tool, a stop, down to 15 mm below the plate, Z, home, a stop.
    let change = "G0 Z20\nM5\nG0 X-3 Y2\nT2\n(drill 3 mm)\n(change the tool by hand, and put the touch plate below it)\nM0\n\
        G38.2 Z-13.4 F30\nG10 L20 P0 Z1.6\nG0 Z20\n(take the touch plate away)\nM0\n";
    assert!(text.contains(change), "{text}");
    // The operator sets up the first one.
    assert_eq!(text.matches("G38.2").count(), 1, "{text}");
    let prove = |text: &str| {
        folder.write("out/drill.gcode", text);
        let words = ["prove", "out/drill.gcode", "--against", "board"];
        folder.run(&[&words[..], &machine[..]].concat())
    };
    let said = prove(&text);
    assert_eq!(said.code, 0, "{said:?}");
    for (from, to, why) in [
        ("P0 Z1.6\n", "P0 Z1.5\n", "stands at Z1.5"),
        ("P0 Z1.6\nG0 Z20\n", "P0 Z1.6\n", "straight up"),
        ("P0 Z1.6\nG0 Z20\n", "P0 Z1.6\nG0 Z3\n", "straight up"),
        ("G38.2 Z-13.4", "G38.2 Z2", "down to Z2"),
        ("G38.2 Z-13.4", "G38.2 Z-30", "down to Z-30"),
        ("G38.2 Z-13.4", "G38.3 Z-13.4", "touches nothing"),
        ("G38.2 Z-13.4", "M3 S1000\nG38.2 Z-13.4", "not been touched off"),
        ("G38.2 Z-13.4 F30", "G38.2 Z-13.4 F1000", "faster than 30"),
        ("G38.2 Z-13.4 F30", "G93\nG38.2 Z-13.4 F30\nG94", "faster than 30"),
        ("G38.2 Z-13.4 F30", "G38.2 Z-13.4", "faster than 30"),
        ("G0 X-3 Y2\n", "G0 X-3 Y3\n", "Y3"),
        ("G0 X-3 Y2\n", "", "the plate is at X-3 Y2"),
        ("(take the touch plate away)\nM0\n", "", "taken away"),
        ("G38.2 Z-13.4 F30\nG10 L20 P0 Z1.6\n", "", "not been touched off"),
        ("G10 L20 P0 Z1.6\n", "", "does not set Z"),
        // Z 0 has been set with the tool: the first tool would go across the board at that height.
        ("M0\nG0 Z20\n", "M0\n", "wherever Z stands"),
    ] {
        assert!(text.contains(from), "{from}");
        let said = prove(&text.replacen(from, to, 1));
        assert!(said.code == 1 && said.err.contains(why), "{from} {to} {said:?}");
    }
    // No line of a source is named where there is none.
    assert!(!said.err.contains("source line 0") && !said.out.contains("board-drill:0"), "{said:?}");
    // A plate as high as the tool goes up, and a depth that is no binary fraction.
    let at = |height: &str| {
        folder.run(
            &[&call[..], &machine[..], &["--option", &format!("touch_height={height}")]].concat(),
        )
    };
    let said = at("19.9");
    assert!(said.code == 1 && said.err.contains("mm of room are needed"), "{said:?}");
    assert_eq!(at("18.6").code, 0);
    assert!(folder.read("out/drill.gcode").contains("G38.2 Z3.6 F30\n"));
    for (wrong, need) in [
        ("touch_travel=0.0001", "0, or a number from 0.5 to 1000 mm"),
        ("touch_feed=601", "0, or a number from 1 to 100 mm/min"),
    ] {
        let said = folder.run(&[&call[..], &machine[..], &["--option", wrong]].concat());
        assert!(said.code == 2 && said.err.contains(need), "{wrong} {said:?}");
    }
    // A machine without a plate takes none of it, and stops with a message.
    folder.write("out/drill.gcode", &text);
    let words = ["prove", "out/drill.gcode", "--against", "board", "-m", "grbl-3018"];
    assert_eq!(folder.run(&words).code, 1);
    let said = folder.run(&[&call[..], &["-m", "grbl-3018"]].concat());
    let text = folder.read("out/drill.gcode");
    assert!(
        said.code == 0
            && !text.contains("G38.2")
            && text.contains("change the tool by hand; its tip")
    );
}

/// On LinuxCNC a further tool gets its length in the tool table; the proof refuses whatever would give it another one, break it or
/// hit the plate.
#[test]
fn tools_get_their_lengths_on_a_plate() {
    let folder = small();
    folder.write(
        "mill.toml",
        "extends = \"linuxcnc-mill\"\n[options]\ntouch_travel = 15\ntouch_height = 1.6\ntouch_x = -3\ntouch_y = 2\n",
    );
    let machine = ["-m", "mill.toml"];
    let call = ["pcb", "board", "--only", "drill", "--alignment", "3", "-o", "out"];
    let said = folder.run(&[&call[..], &machine[..]].concat());
    assert_eq!(said.code, 0, "{said:?}");
    let text = folder.read("out/drill.ngc");
    // Home, the spindle off, the tool, over the plate, a stop, down to 15 mm below the plate, the length, home, a stop.
    let change = "G53 G0 Z0\nM5\n(drill 3 mm)\nT2 M6\nG0 X-3 Y2\n(MSG, put the touch plate below the tool)\nM0\n\
        G38.2 Z-13.4 F30\nG10 L10 P2 Z1.6\nG53 G0 Z0\n(MSG, take the touch plate away)\nM0\n";
    assert!(text.contains(change), "{text}");
    // The operator sets up the first one.
    assert_eq!(text.matches("G38.2").count(), 1, "{text}");
    let prove = |text: &str| {
        folder.write("out/drill.ngc", text);
        let words = ["prove", "out/drill.ngc", "--against", "board"];
        folder.run(&[&words[..], &machine[..]].concat())
    };
    let said = prove(&text);
    assert_eq!(said.code, 0, "{said:?}");
    for (from, to, why) in [
        ("P2 Z1.6\n", "P2 Z1.5\n", "stands at Z1.5"),
        ("G10 L10 P2 Z1.6\nG53 G0 Z0\n", "G10 L10 P2 Z1.6\n", "straight up"),
        ("G10 L10 P2 Z1.6\nG53 G0 Z0\n", "G10 L10 P2 Z1.6\nG43 H2 G0 Z3\n", "straight up"),
        ("G10 L10 P2", "G10 L10 P1", "while it is in use"),
        ("G10 L10 P2", "G10 L10 P3", "operator-data"),
        ("G10 L10 P2", "G10 L1 P2", "operator-data"),
        ("G10 L10 P2", "G10 L11 P2", "operator-data"),
        ("G10 L10 P2", "G10 L20 P0", "unknown-shift"),
        ("G10 L10 P2 Z1.6", "G10 L10 P2 Z1.6\nG10 L1 P2 Z50", "operator-data"),
        ("G10 L10 P2 Z1.6", "G92 Z1.6", "unknown-shift"),
        ("G10 L10 P2 Z1.6", "G43.1 Z1.6", "operator-data"),
        ("G38.2 Z-13.4", "G38.2 Z2", "down to Z2"),
        ("G38.2 Z-13.4", "G38.2 Z-30", "down to Z-30"),
        ("G38.2 Z-13.4", "G38.3 Z-13.4", "touches nothing"),
        ("G38.2 Z-13.4", "M3 S1000\nG38.2 Z-13.4", "not been touched off"),
        ("G38.2 Z-13.4 F30", "G38.2 Z-13.4 F1000", "faster than 30"),
        ("G38.2 Z-13.4 F30", "G38.2 Z-13.4", "faster than 30"),
        ("G38.2 Z-13.4 F30", "G1 Z-13.4 F30", "not been touched off"),
        ("G0 X-3 Y2\n", "G0 X-3 Y3\n", "Y3"),
        ("G0 X-3 Y2\n", "", "the plate is at X-3 Y2"),
        ("(MSG, put the touch plate below the tool)\nM0\n", "", "put below the tool"),
        ("(MSG, put the touch plate below the tool)\nM0\n", "M1\n", "put below the tool"),
        ("(MSG, take the touch plate away)\nM0\n", "", "taken away"),
        ("G38.2 Z-13.4 F30\nG10 L10 P2 Z1.6\n", "", "not been touched off"),
        ("G10 L10 P2 Z1.6\n", "", "does not set Z"),
        ("H2\n", "H1\n", "length"),
        // The heights of plate and tool count from another zero, or by another length.
        ("G10 L10 P2 Z1.6", "G55\nG10 L10 P2 Z1.6\nG54", "another work offset"),
        ("G10 L10 P2 Z1.6", "G55 G10 L10 P2 Z1.6\nG54", "another work offset"),
        ("G38.2 Z-13.4", "G55\nG38.2 Z-13.4", "the plate is at X-3 Y2"),
        ("G38.2 Z-13.4", "G49\nG38.2 Z-13.4", "another length offset"),
        ("G38.2 Z-13.4", "G43 H4\nG38.2 Z-13.4", "another length offset"),
    ] {
        assert!(text.contains(from), "{from}");
        let said = prove(&text.replacen(from, to, 1));
        assert!(said.code == 1 && said.err.contains(why), "{from} {to} {said:?}");
    }
    // The first tool is not touched off: the program stops for the operator to know that Z 0 is to be set with it.
    let set_up = "T1 M6\n(MSG, Z 0 counts from T1: go on if it was set with T1 and its length on, by G43)\nM0\n";
    assert_eq!(text.matches(set_up).count(), 1, "{text}");
    for (wrong, code) in [("T1 M6\n", 1), ("T1 M6\nM1\n", 1), ("M0\nT1 M6\n", 0)] {
        let said = prove(&text.replacen(set_up, wrong, 1));
        assert_eq!(said.code, code, "{wrong:?} {said:?}");
        assert_eq!(said.err.contains("stopped for the operator"), code == 1, "{said:?}");
    }
    judged_by_linuxcnc(&folder, &text);
    // A machine without a plate takes none of it, nor does one whose table could be turned below it.
    folder.write("out/drill.ngc", &text);
    folder.write("xyzac.toml", folder.read("mill.toml").replace("linuxcnc-mill", "linuxcnc-xyzac"));
    for (other, code) in [("linuxcnc-mill", 1), ("linuxcnc-xyzac", 1), ("xyzac.toml", 2)] {
        let said = folder.run(&["prove", "out/drill.ngc", "--against", "board", "-m", other]);
        assert_eq!(said.code, code, "{other} {said:?}");
    }
    let said = folder.run(&[&call[..], &["-m", "linuxcnc-mill"]].concat());
    assert!(said.code == 0 && !folder.read("out/drill.ngc").contains("G38.2"), "{said:?}");
}

/// LinuxCNC's own interpreter gives tool 2 the length by which its spindle stands over the work zero, less the height of the plate.
/// It says that the tool has touched at the end of the probing move, and leaves it 0.01 inch before that.
fn judged_by_linuxcnc(folder: &Folder, text: &str) {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    std::fs::create_dir(folder.path().join("judge")).unwrap();
    // Tool 1 is 30 mm long, and the work zero 250 mm below machine zero.
    folder.write("judge/tools.tbl", "T1 P1 D0 Z30\nT2 P2 D0 Z0\n");
    let table = "G10 L1 P1 Z30\nG10 L2 P1 Z-250\n";
    folder.write("judge/drill.ngc", text.replacen("G53 G0", &format!("{table}G53 G0"), 1));
    let run = std::process::Command::new("rs274")
        .args(["-t", "tools.tbl", "-g", "drill.ngc"])
        .current_dir(folder.path().join("judge"))
        .env("HOME", folder.path().join("judge"))
        .stdin(std::process::Stdio::null())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.success(), "{said}");
    let lengths: Vec<f64> = said
        .lines()
        .filter_map(|line| line.split_once("USE_TOOL_LENGTH_OFFSET(")?.1.split_whitespace().nth(2))
        .map(|length| length.trim_end_matches(',').parse().unwrap())
        .collect();
    // G49, tool 1, tool 2: -13.4 + 30 - 1.6, 0.254 mm higher, since there the tool has stopped.
    let [none, first, second] = lengths[..] else { panic!("{said}") };
    assert_eq!([none, first], [0.0, 30.0], "{said}");
    assert!((second - (30.0 - 13.4 - 1.6)).abs() < 0.26, "{second}");
}

/// A machine without switches does not know where its zero is until the operator has set it: a program that moves before a stop is
/// refused.
#[test]
fn a_machine_without_switches_stops_before_its_first_move() {
    let folder = small();
    let own = |option: &str| format!("extends = \"generic-3axis-grbl\"\n[options]\n{option}\n");
    folder.write("own.toml", own("retract_height = 20"));
    // One with switches whose tools nobody has measured stops before it leaves home.
    folder.write("plate.toml", own("touch_travel = 15"));
    for machine in ["grbl-3018", "own.toml", "plate.toml"] {
        let call = ["pcb", "board", "--tool", "0.4", "--only", "front", "-o", "out", "-m", machine];
        let said = folder.run(&call);
        assert_eq!(said.code, 0, "{said:?}");
        let text = folder.read("out/front.gcode");
        let stop = match machine {
            "plate.toml" => "(fit the tool, and set Z 0 with it)\nM0\n",
            _ => "(Z goes up next: see that there is room)\nM0\n",
        };
        assert_eq!(text.matches(stop).count(), 1, "{text}");
        for wrong in ["", "M5\n", "M1\n", "G4 P1\n", "G0 Z20\nM0\n"] {
            folder.write("out/front.gcode", text.replacen(stop, wrong, 1));
            let said =
                folder.run(&["prove", "out/front.gcode", "-m", machine, "--against", "board"]);
            assert!(
                said.code == 1 && said.err.contains("stopped for the operator"),
                "{machine} {wrong:?} {said:?}"
            );
        }
    }
}
