//! Programs as they are asked for: what is cut where, worked out by hand for a small board.

use crate::board::{DRILL, EDGE, FRONT, Made, NEAR, call, edge, front, gerber, small};
use crate::folder::Folder;
use control::{Action, Setup};
use geom::{Vec2, Vec3};
use program::Op;
use serde_json::Value;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

/// The small board on the small router, cut with 0.4 mm.
#[track_caller]
fn made<'a>(folder: &'a Folder, more: &[&str]) -> Made<'a> {
    Made::of(folder, "board", "grbl-3018", &[&["--tool", "0.4"], more].concat())
}

/// The length of the middle of a tool of 2 mm around the small board, mm.
const AROUND: f64 = 60.0 + TAU;

#[test]
fn a_board_is_isolated_drilled_and_cut_out() {
    let folder = small();
    let made = made(&folder, &[]);
    made.circles("front", &[[4.0, 5.0], [14.0, 5.0]], 1.2, 0.1);
    // Turned over about the line in its middle: X becomes 20 - X.
    made.circles("back", &[[16.0, 3.0], [6.0, 8.0]], 0.7, 0.1);
    assert_eq!(made.holes("drill"), [[4.0, 5.0, -1.8], [14.0, 5.0, -1.8]]);
    let report = made.report();
    assert_eq!(report["board"]["low_mm"], serde_json::json!([0.0, 0.0]));
    assert_eq!(report["board"]["high_mm"], serde_json::json!([20.0, 10.0]));
    assert_eq!(made.operations("front"), ["isolation, end mill 0.4 mm"]);
    assert_eq!(made.operations("drill"), ["drill 0.8 mm"]);
    for part in ["front", "back", "drill", "outline"] {
        assert_eq!(made.report_of(part)["proof"]["proven"], true);
    }
}

#[test]
fn a_board_is_turned_over_about_either_line() {
    let folder = small();
    let made = made(&folder, &["--turn", "x", "--only", "back"]);
    made.circles("back", &[[4.0, 7.0], [14.0, 2.0]], 0.7, 0.1);
}

#[test]
fn pins_are_where_they_were_when_the_board_is_turned() {
    let folder = small();
    // Next to the cut of the mill that cuts the board out, which is 2 mm wide: 1 mm is left between them.
    for (turn, pins, holes) in [
        ("y", [[-4.5, 5.0], [24.5, 5.0]], [[6.0, 5.0], [16.0, 5.0]]),
        ("x", [[10.0, -4.5], [10.0, 14.5]], [[4.0, 5.0], [14.0, 5.0]]),
    ] {
        for (from, holes) in [("front", [[4.0, 5.0], [14.0, 5.0]]), ("back", holes)] {
            let more = ["--alignment", "3", "--turn", turn, "--from", from, "--only", "drill"];
            let made = made(&folder, &more);
            assert_eq!(made.operations("drill"), ["drill 0.8 mm", "drill 3 mm"]);
            let mut right: Vec<_> =
                pins.into_iter().chain(holes).map(|[x, y]| [x, y, -1.8]).collect();
            right.sort_by(|a, b| a.partial_cmp(b).unwrap());
            assert_eq!(made.holes("drill"), right, "{turn}, {from}");
        }
    }
}

#[test]
fn it_is_reported_when_the_board_is_turned() {
    let folder = small();
    let turns = |more: &[&str]| -> Vec<String> {
        let made = made(&folder, more);
        let up = |part: &Value| part["up"].as_str().unwrap().to_owned();
        let reported: Vec<_> =
            made.report()["programs"].as_array().unwrap().iter().map(up).collect();
        let rows = made.said.out.lines().filter(|line| line.starts_with("turn "));
        assert_eq!(rows.count(), reported.windows(2).filter(|two| two[0] != two[1]).count());
        reported
    };
    // Front, holes, back, outline; front, back, holes, outline.
    assert_eq!(turns(&[]), ["front", "front", "back", "front"]);
    assert_eq!(turns(&["--from", "back", "--turn", "x"]), ["front", "back", "back", "back"]);
}

#[test]
fn pins_that_come_when_the_board_is_turned_are_reported() {
    let folder = small();
    for (from, more, late) in [
        ("back", &[][..], true),
        ("front", &[][..], false),
        // The user has said in which order.
        ("back", &["--only", "drill,back"][..], false),
    ] {
        let made = made(&folder, &[&["--alignment", "3", "--from", from], more].concat());
        assert_eq!(made.said.err.contains("pins-late"), late, "{from} {more:?}");
    }
}

#[test]
fn a_board_lies_where_it_is_put() {
    let folder = small();
    front(&folder, &FRONT.replace("X4000Y", "X24000Y").replace("X14000Y", "X34000Y"));
    edge(&folder, "D11*\nX20000Y0D02*\nX40000D01*\nY10000D01*\nX20000D01*\nY0D01*\n");
    std::fs::remove_file(folder.path().join("board/back.gbr")).unwrap();
    std::fs::remove_file(folder.path().join("board/holes.drl")).unwrap();
    for (more, x, y) in [
        (&[][..], 0.0, 0.0),
        (&["--as-drawn"][..], 20.0, 0.0),
        (&["--corner", "100,50"][..], 100.0, 50.0),
        (&["--corner", "-7.5,-0.5"][..], -7.5, -0.5),
    ] {
        let made = made(&folder, more);
        made.circles("front", &[[x + 4.0, y + 5.0], [x + 14.0, y + 5.0]], 1.2, 0.1);
        assert_eq!(made.report()["board"]["low_mm"], serde_json::json!([x, y]));
    }
}

#[test]
fn what_is_outside_the_outline_moves_nothing() {
    let folder = small();
    let parts = ["front", "back", "drill", "outline"];
    let plain = made(&folder, &[]);
    let right = parts.map(|part| plain.text(part));
    // A text below the board, and a hole in it.
    front(&folder, &format!("{FRONT}D11*\nX-30000Y-20000D02*\nX50000D01*\nD10*\nX4000Y5000D03*\n"));
    let with = made(&folder, &[]);
    assert_eq!(parts.map(|part| with.text(part)), right);
    assert!(with.said.err.contains("warning[copper-outside]"), "{:?}", with.said);
    let report = with.report();
    assert_eq!(report["board"]["high_mm"], serde_json::json!([20.0, 10.0]));
    // The middle of the outline.
    assert_eq!(report["board"]["turning_line"], serde_json::json!({ "along": "Y", "at_mm": 10.0 }));
    assert!(
        with.said.out.contains("about the line X 10 (along Y): its back is up"),
        "{:?}",
        with.said
    );
}

#[test]
fn somebody_may_say_what_a_file_holds() {
    let folder = small();
    let parts = ["front", "back", "drill", "outline"];
    let plain = made(&folder, &[]);
    let right = parts.map(|part| plain.text(part).replace("board", "one"));
    for (name, new) in [("front", "one"), ("back", "two"), ("edge", "three")] {
        let text = folder.read(&format!("board/{name}.gbr"));
        let text = text.lines().filter(|line| !line.contains("FileFunction")).collect::<Vec<_>>();
        folder.write(&format!("{new}.gbr"), text.join("\n") + "\n");
    }
    folder.write("four.txt", DRILL);
    let named = [
        "--front",
        "one.gbr",
        "--back",
        "two.gbr",
        "--outline",
        "three.gbr",
        "--drill",
        "four.txt",
    ];
    let call = ["pcb", "-o", "named", "-m", "grbl-3018", "--tool", "0.4", "--picture", "none"];
    let said = folder.run(&[&call[..], &named].concat());
    assert_eq!((said.code, said.err.as_str()), (0, ""), "{said:?}");
    assert_eq!(parts.map(|part| folder.read(&format!("named/{part}.gcode"))), right);
}

#[test]
fn a_gap_of_the_edge_is_closed_and_said() {
    let folder = small();
    let whole = made(&folder, &[]).text("outline");
    edge(&folder, &EDGE.replace("\nY0D01*", "\nY200D01*"));
    let closed = made(&folder, &[]);
    assert_eq!(closed.text("outline"), whole);
    assert!(closed.said.err.contains("a gap of 0.2000 mm at X 0.0000 Y"), "{:?}", closed.said);
    // A thin pen: the ink of that of 1 mm joins the ends whatever is asked for.
    edge(&folder, &EDGE.replace("\nY0D01*", "\nY200D01*").replace("D11*", "%ADD13C,0.1*%D13*"));
    let said = call(&folder, &["--close-gaps", "0.1"]);
    assert_eq!(said.code, 3, "{said:?}");
    assert!(
        said.err.contains("error[outline-open]") && said.err.contains("--close-gaps"),
        "{said:?}"
    );
}

#[test]
fn a_board_without_an_edge_is_a_rectangle_with_a_margin() {
    let folder = small();
    std::fs::remove_file(folder.path().join("board/edge.gbr")).unwrap();
    let none = made(&folder, &[]);
    assert!(
        none.said.out.contains("missing  the outline") && none.said.out.contains("--board-margin")
    );
    // Copper from 3,2.5 to 15,8.5.
    for more in [&[][..], &["--clear", "1"], &["--isolate", "middle"]] {
        let made = made(&folder, &[&["--board-margin", "2"], more].concat());
        assert_eq!(made.report()["board"]["high_mm"], serde_json::json!([16.0, 10.0]));
        assert!(made.said.err.contains("warning[no-outline]"), "{:?}", made.said);
        made.text("outline");
    }
}

#[test]
fn cut_outs_are_drilled_milled_or_marked() {
    let folder = small();
    // A round cut-out of 0.75 mm around a hole of 0.8 mm, one of 1.5 mm elsewhere, and a square of 4 mm.
    let circle = |x: i64, radius: i64| {
        format!("G75*\nX{}Y5000D02*\nG03X{}Y5000I-{radius}J0D01*\nG01*\n", x + radius, x + radius)
    };
    let square = "X7000Y3000D02*\nX11000D01*\nY7000D01*\nX7000D01*\nY3000D01*\n";
    edge(&folder, &format!("{EDGE}{}{}{square}", circle(4000, 375), circle(17000, 750)));
    let plain = made(&folder, &[]);
    let said = &plain.said.err;
    assert!(
        said.contains("1 of the outline's cut-outs are holes in the drill files too, and left to drill.nc, the first at X 4.000"),
        "{said}"
    );
    assert!(said.contains("1 cut-out not cut: an end mill of 2 mm does not go in, the first of 1.500 x 1.500 mm at X 17.000 Y 5.000"), "{said}");
    assert!(said.contains("--hole-mill 1:"), "{said}");
    assert!(!said.contains("-outside]"), "{said}");
    assert_eq!(plain.operations("outline"), ["outline, end mill 2 mm"]);
    assert_eq!(plain.report_of("outline")["places"][0]["x"], 17.0);
    let milled = made(&folder, &["--hole-mill", "1"]);
    let operations = ["small cut-outs, end mill 1 mm", "outline, end mill 2 mm"];
    assert_eq!(milled.operations("outline"), operations);
    assert!(!milled.said.err.contains("cutout-too-small"), "{:?}", milled.said);
}

#[test]
fn a_panel_is_many_boards() {
    let folder = small();
    let made = made(&folder, &["--panel", "2x2", "--spacing", "4"]);
    // From board to board: 20 + 4 and 10 + 4 mm.
    let places = |pads: [[f64; 2]; 2]| -> Vec<[f64; 2]> {
        let corners = [[0.0, 0.0], [24.0, 0.0], [0.0, 14.0], [24.0, 14.0]];
        corners.iter().flat_map(|[x, y]| pads.map(|pad| [x + pad[0], y + pad[1]])).collect()
    };
    made.circles("front", &places([[4.0, 5.0], [14.0, 5.0]]), 1.2, 0.1);
    // X becomes 44 - X.
    made.circles("back", &places([[16.0, 3.0], [6.0, 8.0]]), 0.7, 0.1);
    let holes: BTreeSet<_> =
        made.holes("drill").iter().map(|[x, y, _]| (*x as i32, *y as i32)).collect();
    let right: Vec<_> = places([[4.0, 5.0], [14.0, 5.0]]);
    assert_eq!(holes, right.iter().map(|[x, y]| (*x as i32, *y as i32)).collect());
    let report = made.report();
    assert_eq!(report["board"]["high_mm"], serde_json::json!([44.0, 24.0]));
    assert_eq!(report["board"]["holes"], 8);
}

#[test]
fn copper_that_is_of_no_net_is_taken_away_by_the_widest_tool_first() {
    let folder = small();
    let made = made(&folder, &["--clear", "0.8,0.4", "--only", "front"]);
    let operations = made.operations("front");
    assert_eq!(operations[..2], ["isolation, end mill 0.4 mm", "surplus copper, end mill 0.8 mm"]);
    let cuts: Vec<_> = made.cuts("front");
    let width = |tool: usize| if operations[tool - 1].contains("0.8") { 0.8 } else { 0.4 };
    let pads = [Vec2::new(4.0, 5.0), Vec2::new(14.0, 5.0)];
    let from_pads = |at: Vec2| at.distance(pads[0]).min(at.distance(pads[1])) - 1.0;
    for (x, y) in (0..=100).flat_map(|x| (0..=50).map(move |y| (x, y))) {
        // Tools stay on the board: a little is left in its corners.
        if (x == 0 || x == 100) && (y == 0 || y == 50) {
            continue;
        }
        let at = Vec2::new(f64::from(x), f64::from(y)) / 5.0;
        let cut = cuts.iter().map(|cut| {
            let (from, to) = (cut.from.truncate(), cut.to.truncate());
            let along = ((at - from).dot(to - from) / from.distance_squared(to)).clamp(0.0, 1.0);
            at.distance(from.lerp(to, along)) - width(cut.tool) / 2.0
        });
        let off = cut.fold(f64::INFINITY, f64::min);
        if from_pads(at) > NEAR {
            assert!(off < NEAR, "{at} stays, {off} mm from what is cut");
        } else if from_pads(at) < -NEAR {
            assert!(off > -from_pads(at) - NEAR, "{at} of a pad is cut");
        }
    }
}

#[test]
fn conductors_are_parted_in_the_middle_between_them() {
    let folder = small();
    let made = made(&folder, &["--isolate", "middle", "--only", "front"]);
    let cuts = made.cuts("front");
    for end in cuts.iter().flat_map(|cut| [cut.from, cut.to]) {
        assert!((end.x - 9.0).abs() < NEAR && end.z == -0.1, "{end}");
    }
    let ends = || cuts.iter().flat_map(|cut| [cut.from.y, cut.to.y]);
    let (low, high) = (ends().fold(5.0, f64::min), ends().fold(5.0, f64::max));
    // All through the board of 10 mm, and not farther than the tool is wide.
    let reaches = |end: f64| (-NEAR..=0.4).contains(&end);
    assert!(reaches(-low) && reaches(high - 10.0), "{low} {high}");
}

#[test]
fn a_narrow_gap_is_left_out_or_cut_down_its_middle() {
    let folder = small();
    // Squares of 2 mm with 0.3 mm between them, and one far away.
    front(&folder, "D12*\nX4000Y5000D03*\nX6300Y5000D03*\nX14000Y5000D03*\n");
    let between = |made: &Made| -> f64 {
        let cuts = made.cuts("front");
        let within = cuts.iter().filter(|cut| {
            let middle = cut.from.midpoint(cut.to);
            (middle.x - 5.15).abs() < 0.01 && (middle.y - 5.0).abs() < 1.13
        });
        within.map(|cut| cut.length).sum()
    };
    let left = made(&folder, &["--only", "front"]);
    assert_eq!(between(&left), 0.0);
    assert!(
        left.said
            .err
            .contains("warning[narrow-gap]: 1 gap narrower than the cut of 0.400 mm: left out"),
        "{}",
        left.said.err
    );
    let reported = left.report_of("front");
    let place = &reported["places"][0];
    // Between the corners, 0.3 mm apart, the path is 0.2 mm from both 0.132 mm farther out: √(0.2² - 0.15²).
    let what = place["what"].as_str().unwrap();
    assert!(what.contains("0.300 mm apart over 2.26 mm") && what.contains("left out"), "{what}");
    let (x, y) = (place["x"].as_f64().unwrap(), place["y"].as_f64().unwrap());
    assert!((x - 5.15).abs() < NEAR && (y - 5.0).abs() <= 1.133, "{x} {y}");
    let cut = made(&folder, &["--only", "front", "--narrow", "middle"]);
    let length = between(&cut);
    assert!((length - 2.265).abs() < 0.01, "{length}");
    let reported = cut.report_of("front");
    // Half of what the tool is wider than the gap.
    assert!(
        reported["places"][0]["what"].as_str().unwrap().contains("0.050 mm thinner"),
        "{reported}"
    );
    // A tenth of 2 mm is more than 0.03 mm; a cut of 0.35 mm takes 0.025 mm from both.
    let bite = Made::of(&folder, "board", "grbl-3018", &["--tool", "0.35", "--only", "front"]);
    // As long as the squares, and at both ends to where it fits or is cut from there.
    assert!((2.0..2.2).contains(&between(&bite)), "{}", between(&bite));
    assert!(
        bite.said.err.contains(
            "warning[narrow-gap]: 1 gap narrower than the cut of 0.350 mm: cut down the middle, 2."
        ) && bite.said.err.contains("which takes at most 0.025 mm from either side")
            && !bite.said.err.contains("left out"),
        "{}",
        bite.said.err
    );
    let reported = bite.report_of("front");
    assert_eq!(reported["places"][0]["kind"], "bitten");
    let left = ["--tool", "0.35", "--narrow", "leave-out", "--only", "front"];
    // But for where the paths around both come together.
    assert!(between(&Made::of(&folder, "board", "grbl-3018", &left)) < 0.1);
}

#[test]
fn contours_near_each_other_are_cut_without_lifting_the_tool() {
    let folder = small();
    // Squares of 2 mm, 0.5 mm apart, and one 5.5 mm away.
    front(&folder, "D12*\nX2000Y5000D03*\nX4500Y5000D03*\nX7000Y5000D03*\nX14500Y5000D03*\n");
    let tool = ["--tool", "0.2", "--only", "front"];
    let made = Made::of(&folder, "board", "grbl-3018", &tool);
    assert_eq!(made.holes("front").len(), 2);
    // Around each 8 mm and a circle of 0.1 mm; the 0.3 mm between two paths forth and back.
    let right = 4.0 * (8.0 + 0.1 * TAU) + 2.0 * 2.0 * 0.3;
    assert!((made.length("front") - right).abs() < 0.02, "{} for {right}", made.length("front"));
    // In two depths too, and between nets in the middle: four lines that meet nowhere.
    let deep = Made::of(&folder, "board", "grbl-3018", &[&tool[..], &["--step", "0.05"]].concat());
    assert!((deep.length("front") - 2.0 * right).abs() < 0.04, "{}", deep.length("front"));
}

#[test]
fn slots_within_a_net_and_a_tool_that_one_can_buy_are_named() {
    let folder = small();
    // A plane of 8 x 6 mm with a slot of 0.3 mm, 5 mm long, and a pad far away.
    let plane = "G36*\nX1000Y1000D02*\nX9000D01*\nY7000D01*\nX5150D01*\nY2000D01*\nX4850D01*\nY7000D01*\nX1000D01*\nY1000D01*\n\
                 G37*\nD10*\nX14000Y5000D03*\n";
    front(&folder, plane);
    let made = made(&folder, &["--only", "front"]);
    let said = &made.said.err;
    assert!(
        said.contains("warning[narrow-slot]: 1 slot within nets narrower than the cut"),
        "{said}"
    );
    assert!(said.contains("is 0.300 mm wide"), "{said}");
    assert!(said.contains("an end mill of 0.3 mm (--tool 0.3)"), "{said}");
    let reported = made.report_of("front");
    let place = &reported["places"][0];
    assert_eq!(place["kind"], "slot");
    let (x, y) = (place["x"].as_f64().unwrap(), place["y"].as_f64().unwrap());
    assert!((x - 5.0).abs() <= 0.151 && (1.9..7.1).contains(&y), "{x} {y}");
}

#[test]
fn a_bit_is_as_wide_as_it_is_deep() {
    let folder = small();
    let bit = ["--vee", "30", "--tip", "0.1", "--depth", "0.08", "--only", "front"];
    let made = Made::of(&folder, "board", "grbl-3018", &bit);
    // Width: 0.1 + 2 · 0.08 · tan 15°.
    let width: f64 = 0.1 + 2.0 * 0.08 * 0.267_949_192;
    made.circles("front", &[[4.0, 5.0], [14.0, 5.0]], 1.0 + width / 2.0, 0.08);
    assert_eq!(made.operations("front"), ["isolation, V-bit 30 degrees"]);
}

#[test]
fn a_depth_is_cut_in_steps() {
    let folder = small();
    let made = made(&folder, &["--depth", "0.1", "--step", "0.05", "--only", "front"]);
    for (depth, count) in [(-0.05, 2), (-0.1, 2)] {
        let cuts = made.cuts("front").into_iter().filter(|cut| cut.to.z == depth);
        let length: f64 = cuts.map(|cut| cut.length).sum();
        let right = f64::from(count) * TAU * 1.2;
        assert!((length / right - 1.0).abs() < 1e-3, "{depth}: {length}");
    }
}

#[test]
fn solder_mask_is_opened() {
    let folder = small();
    folder.write("board/mask.gbr", gerber("Soldermask,Top", "D10*\nX4000Y5000D03*\n"));
    let made = made(&folder, &["--mask-tool", "0.4", "--only", "front-mask"]);
    assert_eq!(made.operations("front-mask"), ["solder mask, end mill 0.4 mm"]);
    let cuts = made.cuts("front-mask");
    let from = |end: geom::Vec3| end.truncate().distance(Vec2::new(4.0, 5.0));
    let ends = || cuts.iter().flat_map(|cut| [cut.from, cut.to]);
    let farthest = ends().map(from).fold(0.0, f64::max);
    let nearest = ends().map(from).fold(9.0, f64::min);
    assert!((farthest - 0.8).abs() < NEAR && nearest < 0.2 + NEAR, "{nearest} to {farthest}");
    assert!(ends().all(|end| end.z == -0.05));
    // Where a tool is given, it is among the programs that are made without being asked for.
    let made = self::made(&folder, &["--mask-tool", "0.4"]);
    assert_eq!(made.report_of("front-mask")["proof"]["proven"], true);
    assert_eq!(made.report()["programs"].as_array().unwrap().len(), 5);
}

/// A layer that no program of the call cuts changes nothing, whatever is wrong with it; one that is cut is read.
#[test]
fn a_mask_or_legend_that_no_program_cuts_is_not_read() {
    let folder = small();
    let copper = made(&folder, &[]).text("front");
    let lost = "D77*\nX0Y0D03*\n";
    let far = "D10*\nX900000Y900000D03*\n";
    for (function, part) in [("Legend,Top", "front-legend"), ("Soldermask,Top", "front-mask")] {
        for body in [lost, far] {
            let folder = small();
            folder.write("board/more.gbr", gerber(function, body));
            folder.write("board/same.gbr", gerber(function, body));
            assert_eq!(made(&folder, &[]).text("front"), copper);
            let asked =
                call(&folder, &["--only", part, "--mask-tool", "0.4", "--legend-tool", "0.4"]);
            assert!(asked.code == 2 && asked.err.contains("error[layer-twice]"), "{asked:?}");
        }
    }
    // A tool for a mask is no question about it, where other programs are asked for.
    assert_eq!(made(&small(), &["--mask-tool", "0.4", "--only", "front"]).text("front"), copper);
}

#[test]
fn a_legend_is_engraved_around_its_strokes() {
    let folder = small();
    let line = "D11*\nX8000Y5000D02*\nX10000D01*\n";
    folder.write("board/legend.gbr", gerber("Legend,Top", line));
    let made = made(&folder, &["--legend-tool", "0.1", "--only", "front-legend"]);
    // Within the line of 1 mm: two pieces of 2 mm, two half circles of 0.45 mm.
    let (length, right) = (made.length("front-legend"), 4.0 + TAU * 0.45);
    assert!((length / right - 1.0).abs() < 1e-3, "{length} mm, not {right} mm");
    assert!(made.cuts("front-legend").iter().all(|cut| cut.to.z == -0.05));
}

#[test]
fn holes_are_made_by_the_drills_that_there_are() {
    let folder = small();
    folder.write(
        "board/holes.drl",
        "M48\nMETRIC\nT1C0.8\nT2C0.82\n%\nT1\nX4.0Y5.0\nT2\nX14.0Y5.0\nM30\n",
    );
    let all = made(&folder, &["--only", "drill"]);
    assert_eq!(all.operations("drill"), ["drill 0.8 mm", "drill 0.82 mm"]);
    let one = made(&folder, &["--only", "drill", "--drills", "0.8,3"]);
    assert_eq!(one.operations("drill"), ["drill 0.8 mm"]);
    assert_eq!(one.holes("drill"), [[4.0, 5.0, -1.8], [14.0, 5.0, -1.8]]);
    let differs =
        "warning[drill-differs]: a hole of 0.82 mm at X 14.000 Y 5.000 is drilled with 0.8 mm";
    assert!(one.said.err.contains(differs), "{}", one.said.err);
}

#[test]
fn holes_of_nearly_one_width_have_one_drill() {
    let folder = small();
    let drill = "M48\nMETRIC\nT1C0.8\nT2C0.813\nT3C0.85\n%\nT1\nX4.0Y5.0\nX6.0Y5.0\nT2\nX14.0Y5.0\nT3\nX16.0Y5.0\nM30\n";
    folder.write("board/holes.drl", drill);
    let near = made(&folder, &[]);
    assert_eq!(near.operations("drill"), ["drill 0.8 mm", "drill 0.85 mm"]);
    assert!(
        near.said.err.contains("a hole of 0.813 mm at X 14.000 Y 5.000 is drilled with 0.8 mm")
    );
    let each = made(&folder, &["--drill-tolerance", "0"]);
    assert_eq!(each.operations("drill"), ["drill 0.8 mm", "drill 0.813 mm", "drill 0.85 mm"]);
    // 0.85 - 0.8 is a little more than 0.05 in numbers of the machine.
    let given = made(&folder, &["--drills", "0.8"]);
    assert_eq!(given.operations("drill"), ["drill 0.8 mm"]);
}

#[test]
fn each_tool_may_have_a_program_of_its_own() {
    let folder = small();
    let drill = "M48\nMETRIC\nT1C0.8\nT2C1.2\n%\nT1\nX4.0Y5.0\nT2\nX14.0Y5.0\nM30\n";
    folder.write("board/holes.drl", drill);
    let split = made(&folder, &["--split-tools"]);
    let names = split.report();
    let names: Vec<_> =
        names["programs"].as_array().unwrap().iter().map(|one| one["name"].clone()).collect();
    assert_eq!(names, ["front", "drill-1-0.8mm", "drill-2-1.2mm", "back", "outline"]);
    assert_eq!(split.holes("drill-1-0.8mm").len(), 1);
    assert_eq!(split.holes("drill-2-1.2mm").len(), 1);
    // Each is fitted, and Z 0 set with it, before the first move; nothing is changed in between.
    let text = split.text("drill-2-1.2mm");
    assert_eq!(
        (text.matches("M0\n").count(), text.contains("(change the tool")),
        (1, false),
        "{text}"
    );
    assert!(!split.said.out.contains("missing"), "{:?}", split.said);
}

#[test]
fn holes_without_a_drill_and_slots_are_milled() {
    let folder = small();
    folder.write(
        "board/holes.drl",
        "M48\nMETRIC\nT1C0.8\nT2C3.0\nT3C1.5\n%\nT1\nX4.0Y5.0\nT2\nX14.0Y5.0\nT3\n\
         X8.0Y5.0G85X10.0Y5.0\nM30\n",
    );
    let made = made(&folder, &["--only", "drill", "--drills", "0.8", "--hole-mill", "1"]);
    assert_eq!(made.operations("drill"), ["drill 0.8 mm", "mill holes"]);
    let mut deepest = [0.0, 0.0];
    for cut in made.cuts("drill") {
        for end in [cut.from, cut.to] {
            let at = end.truncate();
            let slot = at.distance(Vec2::new(at.x.clamp(8.0, 10.0), 5.0));
            // The edge of the mill, 0.5 mm away, reaches the wall and no farther.
            assert!(slot < 0.25 + NEAR || at.distance(Vec2::new(14.0, 5.0)) < 1.0 + NEAR, "{at}");
        }
        if cut.from.z == -1.8 && cut.to.z == -1.8 {
            deepest[usize::from(cut.to.x > 12.0)] += cut.length;
        }
    }
    let right = [4.0 + TAU * 0.25, TAU];
    for (length, right) in deepest.iter().zip(right) {
        assert!(length / right > 0.999, "{length} mm, not {right} mm");
    }
    // Without a mill a slot is a chain of holes from end to end.
    let only = DRILL.replace("X4.0Y5.0", "X4.0Y5.0G85X6.0Y5.0");
    folder.write("board/holes.drl", only);
    let chain = self::made(&folder, &["--only", "drill"]).holes("drill");
    assert!(chain.len() > 4 && chain.contains(&[4.0, 5.0, -1.8]), "{chain:?}");
    assert!(chain.contains(&[6.0, 5.0, -1.8]) && chain.iter().all(|hole| hole[1] == 5.0));
}

#[test]
fn drills_peck() {
    let folder = small();
    let more = ["--peck", "0.5", "--only", "drill"];
    // GRBL has no cycles: each peck is written out.
    let depths: Vec<f64> =
        made(&folder, &more).holes("drill").iter().filter(|h| h[0] == 4.0).map(|h| h[2]).collect();
    assert_eq!(depths, [-1.8, -1.5, -1.0, -0.5]);
    let text = Made::of(&folder, "board", "linuxcnc-mill", &more).text("drill");
    let cycle = text.lines().find(|line| line.contains("G83")).unwrap();
    assert!(cycle.contains("Z-1.8") && cycle.contains("Q0.5"), "{cycle}");
}

#[test]
fn tabs_hold_the_board() {
    let folder = small();
    let at = |made: &Made, depth: f64| -> f64 {
        let cuts = made.cuts("outline").into_iter();
        let there = cuts.filter(|cut| cut.from.z == depth && cut.to.z == depth);
        there.map(|cut| cut.length).sum()
    };
    let near = |length: f64, right: f64| {
        assert!((length / right - 1.0).abs() < 1e-3, "{length} mm, not {right} mm");
    };
    let none = made(&folder, &["--tabs", "0", "--only", "outline"]);
    near(at(&none, -1.8), AROUND);
    // A tab of 2 mm is 4 mm of the path of a tool of 2 mm.
    let two = ["--tabs", "2", "--tab-width", "2", "--tab-height", "0.6", "--only", "outline"];
    let two = made(&folder, &two);
    near(at(&two, -1.8), AROUND - 8.0);
    let low = two.cuts("outline").iter().map(|cut| cut.from.z.min(cut.to.z)).fold(0.0, f64::min);
    assert_eq!(low, -1.8);
}

/// The places that a program probes, µm.
fn probed(made: &Made) -> BTreeSet<(i64, i64)> {
    let program = made.program("probe");
    let probes = program.records.iter().filter_map(|record| match &record.op {
        Op::Probe(probe) => Some(probe.end.point()),
        _ => None,
    });
    probes.map(|at| ((at.x * 1e3).round() as i64, (at.y * 1e3).round() as i64)).collect()
}

/// The outermost places are 1 mm inside the edge; of a board of 2 mm a quarter.
#[test]
fn the_height_of_a_board_is_probed() {
    let more = ["--tool", "0.4", "--probe", "4x3", "--only", "front"];
    let right = |rows: [i64; 3]| -> BTreeSet<(i64, i64)> {
        [1000, 7000, 13000, 19000].iter().flat_map(|x| rows.map(|y| (*x, y))).collect()
    };
    let folder = small();
    for machine in ["grbl-3018", "linuxcnc-mill"] {
        let made = Made::of(&folder, "board", machine, &more);
        assert_eq!(made.text("probe").matches("G38.2").count(), 12);
        assert_eq!(probed(&made), right([1000, 5000, 9000]), "{machine}");
    }
    edge(&folder, &EDGE.replace("Y10000", "Y2000"));
    front(&folder, "D11*\nX4000Y1000D03*\n");
    std::fs::remove_file(folder.path().join("board/back.gbr")).unwrap();
    std::fs::remove_file(folder.path().join("board/holes.drl")).unwrap();
    let narrow = Made::of(&folder, "board", "grbl-3018", &more);
    assert_eq!(probed(&narrow), right([500, 1000, 1500]));
}

#[test]
fn programs_follow_the_surface_that_was_measured() {
    // A board that rises along X and falls along Y, as LinuxCNC and GRBL answer.
    let plane = |x: f64, y: f64| -0.1 + 0.01 * x - 0.02 * y;
    let places = [0.0, 10.0, 20.0].map(|x| [0.0, 5.0, 10.0].map(|y| (x, y))).concat();
    let table: String = places
        .iter()
        .map(|(x, y)| format!("{x:.6} {y:.6} {:.6} 0.0 0.0 0.0 0.0 0.0 0.0\n", plane(*x, *y)))
        .collect();
    // The zero of the work is at -100 -80 -20 of the machine.
    let answer = |(x, y): &(f64, f64)| {
        format!("[PRB:{:.3},{:.3},{:.3}:1]\nok\n", x - 100.0, y - 80.0, plane(*x, *y) - 20.0)
    };
    let answers: String = places.iter().map(answer).collect();
    let answers = format!("[G54:-100.000,-80.000,-20.000]\nok\n{answers}");
    for (machine, heights) in [("linuxcnc-mill", table), ("grbl-3018", answers)] {
        let folder = small();
        let file = folder.write("heights.txt", heights);
        let more = ["--tool", "0.4", "--only", "front,drill,outline", "--tabs", "0", "--heights"];
        let made =
            Made::of(&folder, "board", machine, &[&more[..], &[file.to_str().unwrap()]].concat());
        let mut length = 0.0;
        for cut in made.cuts("front") {
            for end in [cut.from, cut.to] {
                let off = end.z - plane(end.x, end.y) + 0.1;
                assert!(off.abs() < 0.006, "{machine}: {end} is {off} mm off");
            }
            length += cut.length;
        }
        assert!((length / (2.0 * TAU * 1.2) - 1.0).abs() < 1e-3, "{length}");
        // The surface is at -0.1 + 0.04 - 0.1 and at -0.1 + 0.14 - 0.1.
        let holes = made.holes("drill");
        assert_eq!(holes, [[4.0, 5.0, -1.96], [14.0, 5.0, -1.86]], "{machine}");
        let low = made.cuts("outline").into_iter().filter(|cut| {
            let off = cut.to.z - plane(cut.to.x.clamp(0.0, 20.0), cut.to.y.clamp(0.0, 10.0)) + 1.8;
            off.abs() < 0.006
        });
        let around: f64 = low.map(|cut| cut.length).sum();
        assert!((around / AROUND - 1.0).abs() < 0.01, "{machine}: {around}");
    }
}

/// The ends of the cuts of a program, as a control makes them on this surface.
fn cuts_on(text: &str, machine: &str, surface: Vec<Vec3>) -> Vec<Vec3> {
    let machine = machine::load(machine).unwrap();
    let settings = nc::settings(&machine, Setup { surface, ..Setup::default() }).unwrap();
    let mut ends = Vec::new();
    let read = control::read(&settings, "front.nc", text.as_bytes(), &mut |event| {
        if let Action::Line(_) | Action::Arc(_) = event.action {
            ends.extend(event.action.position().map(|position| position.point));
        }
        Ok(())
    });
    read.unwrap();
    ends
}

#[test]
fn programs_that_cut_copper_measure_its_height_themselves() {
    let folder = small();
    let more = ["--tool", "0.4", "--probe", "3x3", "--on-control"];
    let made = Made::of(&folder, "board", "linuxcnc-mill", &more);
    assert!(!folder.path().join("out/probe.ngc").exists());
    let plane = |x: f64, y: f64| -0.1 + 0.01 * x - 0.02 * y;
    // Unlike a plane, the heights of one place bend the surface about it.
    let bent = |x: f64, y: f64| plane(x, y) + if (x, y) == (10.0, 5.0) { 0.3 } else { 0.0 };
    let places = [1.0, 10.0, 19.0].map(|x| [1.0, 5.0, 9.0].map(|y| (x, y))).concat();
    let surface = |height: &dyn Fn(f64, f64) -> f64| -> Vec<Vec3> {
        places.iter().map(|&(x, y)| Vec3::new(x, y, height(x, y))).collect()
    };
    for part in ["front", "back"] {
        assert_eq!(made.report_of(part)["proof"]["proven"], true);
        let reported = &made.report_of(part)["measures_heights"];
        assert_eq!(*reported, serde_json::json!({ "columns": 3, "rows": 3 }));
        let text = made.text(part);
        assert_eq!((text.matches("G38.2").count(), text.matches("\nM0").count()), (9, 2), "{text}");
        let cuts = cuts_on(&text, "linuxcnc-mill", surface(&plane));
        // Circles of 1.2 and of 0.7 mm, in 7 and in 5 pieces at least.
        assert!(cuts.len() >= 2 * (1 + if part == "front" { 7 } else { 5 }));
        for end in &cuts {
            let off = end.z - plane(end.x, end.y) + 0.1;
            assert!(off.abs() < 1e-4, "{end} is {off} mm off");
        }
        // Each cut is raised by as much of the middle place as it is near to it, by hand: a pyramid along both axes.
        for (bent, end) in cuts_on(&text, "linuxcnc-mill", surface(&bent)).iter().zip(&cuts) {
            let near = |off: f64, side: f64| (1.0 - off.abs() / side).max(0.0);
            let right = end.z + 0.3 * near(end.x - 10.0, 9.0) * near(end.y - 5.0, 4.0);
            assert!((bent.z - right).abs() < 1e-4 && bent.x == end.x, "{bent} and {right}");
        }
    }
    // A drill goes through, and an outline too: they know no surface.
    for part in ["drill", "outline"] {
        assert!(!made.text(part).contains('#'));
    }
}

/// On the back there is one net, and nothing in the middle between nets.
#[test]
fn a_program_that_cuts_nothing_measures_nothing() {
    let folder = small();
    folder.write("board/back.gbr", gerber("Copper,L2,Bot", "D11*\nX4000Y3000D03*\n"));
    let more = ["--tool", "0.4", "--isolate", "middle", "--probe", "3x3", "--on-control"];
    let made = Made::of(&folder, "board", "linuxcnc-mill", &more);
    for (part, probes) in [("front", 9), ("back", 0)] {
        assert_eq!(made.report_of(part)["measures_heights"].is_null(), probes == 0);
        let text = made.text(part);
        assert_eq!(text.matches("G38.2").count(), probes, "{text}");
        assert_eq!(text.contains("M0"), probes > 0, "{text}");
    }
}

/// The path of the centre of a tool as points 0.05 mm apart, and by squares of 0.1 mm.
struct ToolPath {
    points: Vec<Vec2>,
    squares: BTreeSet<(i64, i64)>,
}

impl ToolPath {
    fn of(made: &Made, part: &str) -> ToolPath {
        let mut points = Vec::new();
        for cut in made.cuts(part) {
            let steps = (cut.length / 0.05).ceil().max(1.0);
            for step in 0..=steps as u32 {
                points.push(cut.from.lerp(cut.to, f64::from(step) / steps).truncate());
            }
        }
        let squares = points.iter().map(|at| ToolPath::square(*at)).collect();
        ToolPath { points, squares }
    }

    fn square(at: Vec2) -> (i64, i64) {
        ((at.x * 10.0).floor() as i64, (at.y * 10.0).floor() as i64)
    }

    /// How many of its points are not in a square of the other path, or next to one.
    fn off(&self, other: &ToolPath) -> usize {
        let near = |at: &&Vec2| {
            let (x, y) = ToolPath::square(**at);
            (-1..=1).all(|dx| (-1..=1).all(|dy| !other.squares.contains(&(x + dx, y + dy))))
        };
        self.points.iter().filter(near).count()
    }
}

#[test]
fn a_board_of_kicad_and_its_plots_are_the_same_programs() {
    let Some(data) = judge::data("gerber/kicad") else { return };
    let (plots, board) = (Folder::empty(), Folder::empty());
    let path = |name: &str| data.join(name).display().to_string();
    let more = ["--tool", "0.2"];
    let plots = Made::of(&plots, &path("ecc83-pp"), "linuxcnc-mill", &more);
    let board = Made::of(&board, &path("ecc83-pp.kicad_pcb"), "linuxcnc-mill", &more);
    // From the edge: 52.07 by 46.355 mm.
    for made in [&plots, &board] {
        let [low, high] = ["low_mm", "high_mm"].map(|end| made.report()["board"][end].clone());
        let size = |i: usize| high[i].as_f64().unwrap() - low[i].as_f64().unwrap();
        assert!((size(0) - 52.07).abs() < 1e-6 && (size(1) - 46.355).abs() < 1e-6, "{high}");
    }
    assert_eq!(plots.holes("drill"), board.holes("drill"));
    assert_eq!(plots.operations("drill"), board.operations("drill"));
    for part in ["front", "back", "outline"] {
        let (one, other) = (plots.length(part), board.length(part));
        assert!((one / other - 1.0).abs() < 2e-3, "{part}: {one} mm and {other} mm");
        let (one, other) = (ToolPath::of(&plots, part), ToolPath::of(&board, part));
        assert_eq!((one.off(&other), other.off(&one)), (0, 0), "{part}");
    }
}

#[test]
fn a_model_is_a_board() {
    let folder = Folder::empty();
    folder.write("lamp.toml", include_str!("../../../../examples/lamp.toml"));
    let made = Made::of(&folder, "lamp.toml", "linuxcnc-mill", &["--tool", "0.2"]);
    assert_eq!(made.report()["board"]["high_mm"], serde_json::json!([30.0, 20.0]));
    assert_eq!(made.operations("drill"), ["drill 0.8 mm", "drill 1 mm"]);
    // R1 stands at 14,14, D1 at 24,8 and turned by 90 degrees.
    let mut right =
        [[4.0, 14.0], [4.0, 6.0], [8.92, 14.0], [19.08, 14.0], [24.0, 9.27], [24.0, 6.73]]
            .map(|[x, y]| [x, y, -1.8]);
    right.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(made.holes("drill"), right);
    // Turned over: around the pads and the track from 26,6 to 6,6.73.
    let lowest = made.cuts("back").iter().map(|cut| cut.from.x.min(cut.to.x)).fold(30.0, f64::min);
    // The left edge of the square of 1.8 mm at 30 - 24, and half of the tool.
    assert!((lowest - (6.0 - 0.9 - 0.1)).abs() < NEAR, "{lowest}");
    assert!(made.length("front") > 2.0 * PI);
}

#[test]
fn the_same_board_is_the_same_programs_to_the_last_byte() {
    let folder = small();
    let read = || -> Vec<(String, Vec<u8>)> {
        let said =
            crate::board::call(&folder, &["--clear", "0.8", "--probe", "2x2", "--passes", "2"]);
        assert_eq!(said.code, 0, "{said:?}");
        let out = folder.path().join("out");
        let files = std::fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().path());
        let mut files: Vec<_> =
            files.map(|file| (file.display().to_string(), std::fs::read(&file).unwrap())).collect();
        files.sort();
        std::fs::remove_dir_all(out).unwrap();
        files
    };
    let first = read();
    // Five programs, four pictures, a sheet with both sides, a report.
    assert_eq!(first.len(), 11);
    assert!(first == read());
}

#[test]
fn what_is_said_and_to_whom() {
    let folder = small();
    let call = ["pcb", "board", "-o", "out", "-m", "grbl-3018", "--tool", "0.4"];
    let said = folder.run(&[&["--quiet"], &call[..]].concat());
    assert_eq!((said.code, said.out.as_str(), said.err.as_str()), (0, "", ""));
    let said = folder.run(&[&["--json"], &call[..]].concat());
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    let answer = said.json();
    assert_eq!(answer["status"], "done");
    assert_eq!(answer["board"]["holes"], 2);
    assert_eq!(answer["programs"].as_array().unwrap().len(), 4);
    let narrow = ["--drills", "0.6"];
    let said = folder.run(&[&["--json"], &call[..], &narrow].concat());
    let answer = said.json();
    assert_eq!((said.code, &answer["status"]), (3, &"partly".into()));
    assert_eq!(answer["left_out"][0]["name"], "drill");
    assert_eq!(answer["errors"][0]["rule"], "no-drill");
    let said = folder.run(&[&["--json"], &call[..], &narrow, &["--strict"]].concat());
    assert_eq!((said.code, &said.json()["status"]), (2, &"invalid".into()));
    let said = folder.run(&call);
    let saved = "in out: report.json, sheet.svg, front.svg, drill.svg, back.svg, outline.svg, front.gcode, drill.gcode, back.gcode, outline.gcode";
    assert!(said.out.contains(saved), "{}", said.out);
    // Both sides to print, with the blank: 2 mm around 20 by 10 mm, 1:1 on A4.
    let sheet = folder.read("out/sheet.svg");
    for word in
        ["width=\"210mm\"", "24.0 X 14.0 MM BLANK, SCALE 1:1", "FRONT UP", "BACK UP", "2 OF 0.8 MM"]
    {
        assert!(sheet.contains(word), "{word}");
    }
}

#[test]
fn a_tool_has_one_number_in_all_programs() {
    let folder = small();
    let more = ["--tool", "0.4", "--outline-tool", "2", "--probe", "2x2"];
    let call = ["pcb", "board", "-o", "out", "-m", "linuxcnc-mill", "--quiet"];
    assert_eq!(folder.run(&[&call[..], &more].concat()).code, 0);
    let calls = |name: &str| -> Vec<String> {
        let text = std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
        let calls = text.split_whitespace().filter(|word| word.starts_with('T'));
        calls.map(str::to_owned).collect()
    };
    // The mill for copper, the drill, the mill for the edge, and last the probe.
    assert_eq!((calls("front.ngc"), calls("back.ngc")), (vec!["T1".into()], vec!["T1".into()]));
    assert_eq!((calls("drill.ngc"), calls("outline.ngc")), (vec!["T2".into()], vec!["T3".into()]));
    assert_eq!(calls("probe.ngc"), ["T4"]);
}

/// Programs of one number replace each other in the memory of a FANUC or Haas. Each kind has its own place, whichever of
/// them a call makes.
#[test]
fn the_programs_of_a_board_have_a_number_each() {
    let folder = small();
    let numbers = |machine: &str, more: &[&str]| -> Vec<String> {
        let call = ["pcb", "board", "-o", "out", "-m", machine, "--tool", "0.4", "--quiet"];
        let said = folder.run(&[&call[..], more].concat());
        assert_eq!(said.code, 0, "{}", said.err);
        let number = |name: &&str| {
            let text = folder.read(&format!("out/{name}.nc"));
            text.lines().nth(1).unwrap().split(' ').next().unwrap().to_owned()
        };
        let made = ["front", "drill", "back", "outline", "probe"];
        let made = made.iter().filter(|name| folder.path().join(format!("out/{name}.nc")).exists());
        let numbers = made.map(number).collect();
        std::fs::remove_dir_all(folder.path().join("out")).unwrap();
        numbers
    };
    let all = ["O0001", "O0004", "O0005", "O0008"];
    assert_eq!(numbers("generic-3axis-fanuc", &[]), all);
    assert_eq!(numbers("generic-3axis-fanuc", &["--only", "drill,back"]), all[1..3]);
    let haas = numbers("generic-3axis-haas", &["--option", "program_number=O00101"]);
    assert_eq!(haas, ["O00101", "O00104", "O00105", "O00108"]);
    // 7999 is the last that everybody may use.
    let call = ["pcb", "board", "-o", "out", "-m", "generic-3axis-haas", "--tool", "0.4"];
    let said = folder.run(&[&call[..], &["--option", "program_number=7998"]].concat());
    assert!(said.code == 3 && said.err.contains("8001"), "{said:?}");
}

#[test]
fn what_a_board_lacks_is_in_the_summary() {
    let folder = small();
    std::fs::remove_file(folder.path().join("board/edge.gbr")).unwrap();
    std::fs::remove_file(folder.path().join("board/holes.drl")).unwrap();
    let said = call(&folder, &[]);
    assert_eq!(said.code, 0, "{}", said.err);
    for line in ["missing  holes: no file has any", "missing  the outline: no file has the edge"] {
        assert!(said.out.contains(line), "{}", said.out);
    }
    let report: Value = serde_json::from_str(&folder.read("out/report.json")).unwrap();
    assert_eq!(report["board"]["missing"].as_array().unwrap().len(), 2);
    assert!(!call(&folder, &["--only", "front"]).out.contains("missing"));
    assert!(!call(&small(), &[]).out.contains("missing"));
}

#[test]
fn programs_of_an_earlier_call_are_reported() {
    let folder = small();
    let call = ["pcb", "board", "-o", "out", "-m", "grbl-3018", "--tool", "0.4"];
    assert_eq!(folder.run(&call).code, 0);
    let said = folder.run(&[&call[..], &["--only", "front"]].concat());
    let reported = "there are still drill.gcode, back.gcode, outline.gcode";
    assert!(said.code == 0 && said.err.contains(reported), "{}", said.err);
}

#[test]
fn every_mill_of_the_library_makes_the_board() {
    let folder = small();
    let names = machine::library::names(machine::library::MACHINES);
    let mills = names.filter(|name| machine::load(name).unwrap().wire.is_none());
    for mill in mills {
        let call = ["pcb", "board", "-o", "out", "-m", mill, "--tool", "0.4", "--peck", "0.5"];
        let said = folder.run(&[&call[..], &["--picture", "none", "--quiet"]].concat());
        assert_eq!(said.code, 0, "{mill}: {}", said.err);
    }
}

/// A robot of each language: every program is proven, and its file is called as the controller wants it, by the name that the program has.
#[test]
fn a_board_is_cut_by_a_robot() {
    let folder = small();
    for (robot, front, head) in [
        ("kuka-kr6-r900", "front.src", "DEF front ( )"),
        ("universal-ur5e", "front.script", "def job_front():"),
        ("fanuc-lrmate-200id-mill", "front.ls", "/PROG FRONT"),
        ("abb-irb120-mill", "front.mod", "MODULE MOD_front"),
    ] {
        let words = [
            "pcb",
            "board",
            "--machine",
            robot,
            "--tool",
            "0.4",
            "--drills",
            "0.8",
            "--outline-tool",
            "2",
            "--thickness",
            "1.6",
            "-o",
            robot,
        ];
        let said = folder.run(&words);
        assert_eq!(said.code, 0, "{robot}: {said:?}");
        let report: Value =
            serde_json::from_str(&folder.read(&format!("{robot}/report.json"))).unwrap();
        let programs = report["programs"].as_array().unwrap();
        assert_eq!(programs.len(), 4, "{robot}");
        assert!(programs.iter().all(|program| program["proof"]["proven"] == true));
        let text = folder.read(&format!("{robot}/{front}"));
        assert!(text.contains(head), "{robot}: {text}");
    }
}
