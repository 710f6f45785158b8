//! Cutter radius compensation on the controls that have no outside judge here: paths calculated by hand
//! from what `docs/controls/compensation.md` says of each. A tool 1 (`MILL`) has a radius of 5 mm.

use geom::Vec3;
use program::Compensation;
use toolpost_control::{Action, Dialect, Settings, ToolData, read};

/// The moves of a program, one a line: what, the end, of an arc the way it turns and its centre. What
/// else happens is named.
fn path(dialect: Dialect, program: &str) -> Result<String, (&'static str, u32)> {
    let mut settings = Settings::new(dialect, [false; 3]);
    let tool = |number, radius| ToolData { number, name: "MILL".into(), radius, length: 50.0 };
    settings.setup.tools = vec![tool(1, 5.0), ToolData { name: String::new(), ..tool(2, -5.0) }];
    let mut found = String::new();
    read(&settings, "p.nc", program.as_bytes(), &mut |record| {
        found += &match record.action {
            Action::Rapid(pose) => format!("rapid {}\n", shown(pose.point)),
            Action::Line(pose) => format!("line {}\n", shown(pose.point)),
            Action::Arc(arc) => {
                let way = if arc.normal.element_sum() > 0.0 { "ccw" } else { "cw" };
                let turns = if arc.turns > 0 { format!(" +{}", arc.turns) } else { String::new() };
                let (end, center) = (shown(arc.end.point), shown(arc.center));
                format!("{way} {end} about {center}{turns}\n")
            }
            Action::Dwell(_) => "dwell\n".into(),
            Action::Coolant(coolant) => format!("{coolant:?}\n"),
            Action::Compensation(side) => format!("{side:?}\n"),
            _ => String::new(),
        };
        Ok(())
    })
    .map_err(|error| {
        assert!(error.column > 0, "{error}");
        (error.rule.name(), error.line)
    })?;
    Ok(found)
}

/// Three decimals, as short as they go.
fn shown(p: Vec3) -> String {
    let number = |value: f64| format!("{}", (value * 1000.0).round() / 1000.0 + 0.0);
    p.to_array().map(number).join(" ")
}

/// FANUC: from X-20 Y0 Z0 these blocks make this path.
fn fanuc(blocks: &str) -> Result<String, (&'static str, u32)> {
    let path = path(Dialect::Fanuc, &format!("G21 G90\nG0 X-20. Y0 Z0 F100\n{blocks}\nM30\n"))?;
    Ok(path.trim_start_matches("rapid -20 0 0\n").to_owned())
}

fn sinumerik(blocks: &str) -> Result<String, (&'static str, u32)> {
    let start = "T=\"MILL\" M6 D1\nG0 X-20 Y0 Z0 F100\n";
    let path = path(Dialect::Sinumerik, &format!("{start}{blocks}\nM30\n"))?;
    Ok(path.trim_start_matches("rapid -20 0 0\n").to_owned())
}

fn klartext(blocks: &str) -> Result<String, (&'static str, u32)> {
    let start = "TOOL CALL 1 Z S1000\nL X-20 Y+0 Z+0 R0 FMAX\n";
    let mut program = "0 BEGIN PGM P MM\n".to_owned();
    let body = format!("{start}{blocks}\nL Z+99 FMAX M30\nEND PGM P MM\n");
    for (number, block) in body.lines().enumerate() {
        program += &format!("{} {block}\n", number + 1);
    }
    let path = path(Dialect::Klartext, &program)?;
    let path = path.lines().filter(|line| !line.ends_with(" 99"));
    let path: String = path.map(|line| format!("{line}\n")).collect();
    Ok(path.trim_start_matches("rapid -20 0 0\n").to_owned())
}

#[track_caller]
fn same(path: Result<String, (&'static str, u32)>, expected: &str) {
    let trimmed = expected.lines().map(str::trim).filter(|line| !line.is_empty());
    let expected: String = trimmed.map(|line| format!("{line}\n")).collect();
    assert_eq!(path.as_deref(), Ok(expected.as_str()));
}

/// A square of 50 mm, clockwise with the tool outside: on the left.
const SQUARE: &str = "G1 G41 D1 X0 Y0\nY50.\nX50.\nY0\nX0\nG40 X-20. Y-20.";

#[test]
fn fanuc_goes_to_the_corners_of_the_parallels() {
    // In across the first side (type A), around by their intersections, out across the last side.
    same(
        fanuc(SQUARE),
        "line -5 0 0\nline -5 55 0\nline 55 55 0\nline 55 -5 0\nline 0 -5 0\nline -20 -20 0",
    );
}

#[test]
fn fanuc_goes_around_an_acute_corner_on_two_extended_sides() {
    // At (0, 50) the way turns by 135°. On by 5 mm to (-5, 55); the parallel of the next side goes from
    // (3.536, 53.536), and 5 mm before that is (0, 57.071).
    same(
        fanuc("G1 G41 D1 X0 Y0\nY50.\nX50. Y0\nG40 X60."),
        "line -5 0 0\nline -5 55 0\nline 0 57.071 0\nline 53.536 3.536 0\nline 60 0 0",
    );
    // Back on the same line: 10 mm across.
    same(
        fanuc("G1 G41 D1 X0 Y0\nY50.\nY10.\nG40 X20."),
        "line -5 0 0\nline -5 55 0\nline 5 55 0\nline 5 10 0\nline 20 10 0",
    );
}

#[test]
fn fanuc_meets_arcs_by_tangents() {
    // From the line up to an arc to the right whose centre is level with its start: tangent. At its end
    // (20, 50), downwards, the way turns by 90° to the right.
    same(
        fanuc("G1 G41 D1 X0 Y0\nY50.\nG2 X20. Y50. I10.\nG1 X0\nG40 Y30."),
        "line -5 0 0\nline -5 50 0\ncw 25 50 0 about 10 50 0\nline 25 45 0\nline 0 45 0\nline 0 30 0",
    );
}

#[test]
fn inner_corners_end_where_the_parallels_cross() {
    // On the right of the same square the tool is inside. The first side is reached across it.
    let inside = SQUARE.replace("G41", "G42").replace("G40 X-20. Y-20.", "G40 X10. Y20.");
    let path = "line 5 0 0\nline 5 45 0\nline 45 45 0\nline 45 5 0\nline 0 5 0\nline 10 20 0";
    same(fanuc(&inside), path);
    let points_dropped = inside.replace(" D1", "").replace('.', "");
    same(sinumerik(&points_dropped), path);
    // Down a wall and on along an arc of 20 mm about (16, 42), the tool inside: 15 mm from there and
    // 5 mm from the wall it is at Y 42 - √(15² - 11²).
    same(
        fanuc("G0 X30. Y60.\nG1 G41 D1 X0\nY30.\nG3 X16. Y22. I16. J12.\nG40 G1 X16. Y40."),
        "rapid 30 60 0\nline 5 60 0\nline 5 31.802 0\nccw 16 27 0 about 16 42 0\nline 16 40 0",
    );
}

#[test]
fn other_controls_go_around_corners_on_arcs() {
    let path = "line -5 0 0\nline -5 50 0\ncw 0 55 0 about 0 50 0\nline 50 55 0\n\
                cw 55 50 0 about 50 50 0\nline 55 0 0\ncw 50 -5 0 about 50 0 0\nline 0 -5 0\n\
                line -20 -20 0";
    same(sinumerik(&SQUARE.replace(" D1", "").replace('.', "")), path);
    same(klartext("L X+0 Y+0 RL F100\nL Y+50\nL X+50\nL Y+0\nL X+0\nL X-20 Y-20 R0"), path);
}

#[test]
fn sinumerik_takes_the_intersection_where_the_program_says_so() {
    // G451 up to a turn of 100°; the last corner turns by 135° and stays an arc.
    same(
        sinumerik("G451 G1 G41 X0 Y0\nY50\nX50\nX0 Y0\nG40 X-20 Y-20"),
        "line -5 0 0\nline -5 55 0\nline 50 55 0\ncw 53.536 46.464 0 about 50 50 0\n\
         line 3.536 -3.536 0\nline -20 -20 0",
    );
    assert_eq!(
        sinumerik("G451 G1 G41 X0 Y0\nY50\nG2 X10 Y40 I0 J-10\nG40 G1 X30"),
        Err(("compensation-unsupported", 5))
    );
    // What the last block before the contour says is what counts.
    same(
        sinumerik("KONT G451 DISC=50\nNORM G450 DISC=0 G1 G41 X0 Y0\nY50\nX50\nG40 Y70"),
        "line -5 0 0\nline -5 50 0\ncw 0 55 0 about 0 50 0\nline 50 55 0\nline 50 70 0",
    );
    let kinds = ["KONT G1 G41 X0 Y0", "DISC=50 G1 G41 X0 Y0", "KONTT G1 G42 X0 Y0"];
    for first in kinds {
        let found = sinumerik(&format!("{first}\nY50\nG40 X-30"));
        assert_eq!(found, Err(("compensation-unsupported", 3)), "{first}");
    }
    for change in ["G451", "KONT", "DISC=10"] {
        let found = sinumerik(&format!("G1 G41 X0 Y0\nY50\n{change} X50\nG40 Y70"));
        assert_eq!(found, Err(("compensation", 5)), "{change}");
    }
}

#[test]
fn what_lies_between_two_elements_happens_at_the_end_of_the_first() {
    same(
        fanuc("G1 G41 D1 X0 Y0\nY50.\nZ-3.\nX50.\nM8\nY0 Z-1.\nG40 X60."),
        "line -5 0 0\nline -5 55 0\nline -5 55 -3\nline 55 55 -3\nFlood\nline 55 0 -1\nline 60 0 -1",
    );
    same(
        sinumerik("G1 G41 X0 Y0\nG4 F1\nY50\nZ-3\nX50\nG40 Y60"),
        "line -5 0 0\ndwell\nline -5 50 0\nline -5 50 -3\ncw 0 55 -3 about 0 50 -3\nline 50 55 -3\n\
         line 50 60 -3",
    );
    // Before the contour begins the tool is not offset yet.
    same(
        fanuc("G1 G41 D1\nZ-3.\nX0 Y0\nY50.\nG40\nZ9.\nX-20."),
        "line -20 0 -3\nline -5 0 -3\nline -5 50 -3\nline -5 50 9\nline -20 50 9",
    );
}

#[test]
fn a_tool_change_or_a_cycle_ends_what_g40_has_cancelled() {
    for next in ["T2 M6", "S9. M3\nG98 G81 X-9. Y60. Z-5. R-1."] {
        let path = fanuc(&format!("G1 G41 D1 X0 Y0\nY50.\nG40\n{next}\nG80")).unwrap();
        assert!(path.starts_with("line -5 0 0\nline -5 50 0\n"), "{next}: {path}");
        let on = fanuc(&format!("G1 G41 D1 X0 Y0\nY50.\n{next}"));
        assert_eq!(on.unwrap_err().0, "compensation");
    }
}

#[test]
fn a_control_sees_past_so_many_blocks() {
    // FANUC reads three blocks: one of them may move nothing.
    let two = "G1 G41 D1 X0 Y0\nY50.\nM8\nM9\nX50.\nG40 Y60.";
    assert_eq!(fanuc(two), Err(("compensation-look-ahead", 7)));
    assert!(fanuc(&two.replace("M9\n", "(only words)\n")).is_ok());
    // Straight on there is no corner to lose.
    assert!(fanuc(&two.replace("X50.\nG40 Y60.", "Y70.\nG40 Y90.")).is_ok());
    let four = "G1 G41 X0 Y0\nY50\nM8\nM9\nG4 F1\nZ-1\nX50\nG40 Y60";
    assert_eq!(sinumerik(four), Err(("compensation-look-ahead", 9)));
    assert!(sinumerik(&four.replace("M9\n", "")).is_ok());
}

#[test]
fn arcs_keep_their_centre_and_helices_their_end() {
    // One and a half turns up by 3 mm, the tool inside; a full circle with the tool outside.
    same(
        sinumerik("G1 G41 X0 Y0\nG3 X40 Y0 Z3 I20 J0 TURN=1\nG40 G1 X20"),
        "line 5 0 0\nccw 35 0 3 about 20 0 0 +1\nline 20 0 3",
    );
    same(
        fanuc("G1 G42 D1 X0 Y0\nG3 I20.\nG40 G1 X-20."),
        "line -5 0 0\nccw -5 0 0 about 20 0 0\nline -20 0 0",
    );
    same(
        klartext("L X+0 Y+0 RR F100\nCC X+20 Y+0\nC X+0 Y+0 DR+\nL X-20 R0"),
        "line -5 0 0\nccw -5 0 0 about 20 0 0\nline -20 0 0",
    );
}

#[test]
fn a_radius_below_0_is_the_other_side_and_register_0_none() {
    let right = SQUARE.replace("G41 D1", "G42 D2");
    assert_eq!(fanuc(&right), fanuc(SQUARE));
    let none = SQUARE.replace("D1", "D0");
    same(
        fanuc(&none),
        "line 0 0 0\nline 0 50 0\nline 50 50 0\nline 50 0 0\nline 0 0 0\nline -20 -20 0",
    );
}

#[test]
fn a_tool_that_is_not_in_the_table_leaves_the_contour_as_it_is() {
    let unknown = SQUARE.replace("D1", "D7");
    let state = fanuc(&unknown).unwrap();
    assert!(state.starts_with("Left(Some(7))\nline 0 0 0\nline 0 50 0\n"), "{state}");
    assert!(state.ends_with("Off\nline -20 -20 0\n"), "{state}");
    // The table has the first edge of a tool.
    let edge = sinumerik("D2\nG1 G41 X0 Y0\nY50\nG40 X-20").unwrap();
    let side = format!("{:?}", Compensation::Left(Some(2)));
    assert!(edge.starts_with(&side), "{edge}");
}

#[test]
fn the_plane_may_be_another_one() {
    // G18: seen from +Y, Z is to the right and X up. From Z 0 to Z 50 the left is +X.
    same(
        fanuc("G18 G1 G41 D1 X0 Z0\nZ50.\nX50.\nG40 Z0"),
        "line 5 0 0\nline 5 0 45\nline 50 0 45\nline 50 0 0",
    );
    // A plane turned by 90° about X: its Y is the Z of the work frame, its Z the other way of Y, about
    // which the corner is gone around clockwise.
    same(
        sinumerik("ROT X90\nG1 G42 X0 Y0\nX50\nY30\nG40 X80"),
        "line 0 0 -5\nline 50 0 -5\ncw 55 0 0 about 50 0 0\nline 55 0 30\nline 80 0 30",
    );
}

#[test]
fn in_a_mirror_the_tool_is_on_the_other_side() {
    let path = "rapid 20 0 0\nline 5 0 0\nline 5 50 0\nccw 0 55 0 about 0 50 0\nline -50 55 0\n\
                line -50 60 0";
    same(sinumerik("MIRROR X0\nG0 X-20 Y0\nG1 G41 X0\nY50\nX50\nG40 Y60"), path);
    same(
        klartext(
            "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X\nL X-20 Y+0 R0 FMAX\nL X+0 RL F100\n\
             L Y+50\nL X+50\nL Y+60 R0",
        ),
        path,
    );
    same(
        fanuc("G51.1 X0\nG0 X-20.\nG1 G41 D1 X0\nY50.\nX50.\nG40 Y60."),
        "rapid 20 0 0\nline 5 0 0\nline 5 55 0\nline -50 55 0\nline -50 60 0",
    );
}

#[test]
fn what_would_spoil_the_part_is_refused() {
    for (blocks, rule, line) in [
        // The tool does not fit into the arc, nor between two walls.
        ("G1 G42 D1 X0 Y0\nY20.\nG2 X10. Y20. I5.\nG40 G1 X10. Y0", "compensation-arc-radius", 5),
        ("G1 G42 D1 X0 Y0\nY50.\nX9.\nY0\nG40 X0", "compensation-inner-corner", 6),
        // From in front of the first side, and back over the last one.
        ("G1 G41 D1 X0 Y0\nX-60.\nG40 Y-30.", "compensation-gouge", 3),
        ("G1 G41 D1 X0 Y0\nY50.\nX50.\nG40 X20. Y40.", "compensation-gouge", 6),
        ("G1 G41 D1 X0 Y0\nG40 X-20.", "compensation-entry", 3),
        ("G41 D1 G1 X0 Y0\nY50.\nG42 D1 X50.", "compensation-change", 5),
        ("G93 G41 D1 G1 X0 Y0 F1.\nY50. F1.", "compensation-feed", 3),
        ("G41 D1 G1 X0 Y0\nY50.\nG93 X50. F1.", "compensation-feed", 5),
    ] {
        assert_eq!(fanuc(blocks), Err((rule, line)), "{blocks}");
    }
    let unknown = path(Dialect::Fanuc, "G21 G90\nG0 Z0 F100\nG41 D1 G1 X0 Y0\nY9.\n");
    assert_eq!(unknown, Err(("compensation-unknown-position", 3)));
    // R0 in the block of a move out of the plane: does the tool go to the contour?
    assert_eq!(
        klartext("L X+0 Y+0 RL F100\nL Y+50\nL Z+9 R0\nL X-9"),
        Err(("compensation-exit", 6))
    );
}
