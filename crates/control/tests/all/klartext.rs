//! The Klartext control against examples of the HEIDENHAIN manuals and calculations by hand.

use crate::common::klartext::*;
use geom::Vec3;
use program::{
    Axes, Compensation, Coolant, Cycle, CycleKind, Diagnostic, Feed, MachineMove, PathMode,
    Spindle, WorkOffset,
};
use toolpost_control::{Action, Orientation, Position, Setup, TiltChoice};

#[test]
fn an_ordinary_program_runs_block_by_block() {
    let ops = run("BLK FORM 0.1 Z X+0 Y+0 Z-20
BLK FORM 0.2 X+100 Y+100 Z+0
; FACE MILL
TOOL CALL 5 Z S3000
L Z+50 R0 FMAX M13
L X-10 Y+5.5 FMAX
L Z-1 F200
L X+110 F500
L IY+3 M9
M30");
    let mut expected = vec![
        Action::Comment("FACE MILL".into()),
        Action::Tool(Box::new(program::Tool { number: 5, ..program::Tool::default() })),
        Action::Spindle(Spindle::Clockwise(3000.0)),
        Action::Coolant(Coolant::Flood),
    ];
    // Nothing is known of X and Y before the block that gives them.
    let Action::Rapid(first) = &ops[4] else { panic!("{:?}", ops[4]) };
    assert!(first.point.x.is_nan() && first.point.y.is_nan() && first.point.z == 50.0);
    expected.extend([
        ops[4].clone(),
        Action::Rapid(upright(-10.0, 5.5, 50.0)),
        Action::Feed(Feed::PerMinute(200.0)),
        Action::Line(upright(-10.0, 5.5, -1.0)),
        Action::Feed(Feed::PerMinute(500.0)),
        Action::Line(upright(110.0, 5.5, -1.0)),
        Action::Line(upright(110.0, 8.5, -1.0)),
        Action::Coolant(Coolant::Off),
        Action::Spindle(Spindle::Off),
        Action::End,
    ]);
    assert_eq!(ops[..4], expected[..4]);
    assert_eq!(ops[5..], expected[5..]);
}

#[test]
fn a_record_names_its_line_and_lines_may_end_in_any_way() {
    let text = b"0 BEGIN PGM A MM\r\n1 TOOL CALL 1 Z S100\r2 L X+1 FMAX\n3 END PGM A MM\r\n\r\n";
    let records = read_on([false; 3], text).unwrap();
    let lines: Vec<u32> = records.iter().map(|record| record.line).collect();
    assert_eq!(lines, [2, 3, 4]);
}

#[test]
fn fmax_holds_for_one_block_and_f_for_all_that_follow() {
    let ops = run(&format!("{START}L X+1\nL X+2 FMAX\nL X+3"));
    let kinds: Vec<bool> = ops[4..].iter().map(|op| matches!(op, Action::Rapid(_))).collect();
    assert_eq!(kinds[..3], [false, true, false]);
}

#[test]
fn the_feed_of_an_inch_program_is_tenths_of_an_inch() {
    let records = run_on([false; 3], "INCH", "TOOL CALL 1 Z S10\nL X+1 Y+2 Z-0.5 F100").unwrap();
    let ops: Vec<Action> = records.into_iter().map(|record| record.action).collect();
    assert!(ops.contains(&Action::Feed(Feed::PerMinute(254.0))));
    let [x, y, z] = points(&ops)[0];
    assert!((x - 25.4).abs() < 1e-12 && (y - 50.8).abs() < 1e-12 && (z + 12.7).abs() < 1e-12);
}

#[test]
fn the_full_circle_of_the_manual_turns_counter_clockwise_about_the_pole() {
    // TNC 320 manual, "Circular path C around circle center CC", blocks 5 to 7.
    let ops =
        run(&format!("{START}L Z-5 F100\nCC X+25 Y+25\nL X+45 Y+25 RR F200 M3\nC X+45 Y+25 DR+"));
    let arc = arcs(&ops)[0];
    assert_eq!(arc.center, Vec3::new(25.0, 25.0, -5.0));
    assert_eq!((arc.normal, arc.turns), (Vec3::Z, 0));
    assert_eq!(arc.end.point, Vec3::new(45.0, 25.0, -5.0));
    assert!(ops.contains(&Action::Compensation(Compensation::Right(None))));
}

#[test]
fn a_radius_makes_four_arcs_between_two_points() {
    // iTNC 530 manual, "CR": X40 Y40 to X70 Y40 with R20; half the chord is 15, so the center lies
    // sqrt(400 - 225) = 13.2288 from it. Clockwise over the top for DR-; the short arc has R+.
    let h = 175f64.sqrt();
    for (radius, turn, y) in [
        ("+20", "-", 40.0 - h),
        ("+20", "+", 40.0 + h),
        ("-20", "-", 40.0 + h),
        ("-20", "+", 40.0 - h),
    ] {
        let ops = run(&format!("{START}L X+40 Y+40 Z+0 F100\nCR X+70 Y+40 R{radius} DR{turn}"));
        let arc = arcs(&ops)[0];
        assert!(arc.center.distance(Vec3::new(55.0, y, 0.0)) < 1e-9, "{radius} {turn}");
        assert_eq!(arc.normal, if turn == "+" { Vec3::Z } else { Vec3::NEG_Z });
    }
}

#[test]
fn a_helix_counts_its_turns_by_the_angle() {
    for (angle, turns, end) in [
        ("+360", 0, [10.0, 0.0]),
        ("+720", 1, [10.0, 0.0]),
        ("+450", 1, [0.0, 10.0]),
        ("+90", 0, [0.0, 10.0]),
        ("-1080", 2, [10.0, 0.0]),
        ("-270", 0, [0.0, 10.0]),
    ] {
        let turn = &angle[..1];
        let ops =
            run(&format!("{START}L X+10 Y+0 Z+0 F100\nCC X+0 Y+0\nCP IPA{angle} IZ-2 DR{turn}"));
        let arc = arcs(&ops)[0];
        assert_eq!(arc.turns, turns, "{angle}");
        assert!(arc.end.point.distance(Vec3::new(end[0], end[1], -2.0)) < 1e-9, "{angle}");
    }
}

#[test]
fn the_thread_of_the_manual_has_five_turns() {
    // TNC 426/430 manual, "Programming a helix": M6 x 1, five revolutions, blocks 12 to 15.
    let ops = run("TOOL CALL 1 Z S100\nL X+0 Y+0 Z+20 FMAX\nCC X+40 Y+25\nL Z+0 F100 M3
LP PR+3 PA+270 RL F50\nCP IPA-1800 IZ+5 DR-");
    let arc = arcs(&ops)[0];
    assert!(arc.end.point.distance(Vec3::new(40.0, 22.0, 5.0)) < 1e-12);
    assert_eq!((arc.turns, arc.normal), (4, Vec3::NEG_Z));
}

#[test]
fn polar_coordinates_count_from_the_pole_and_the_x_axis() {
    let ops = run(&format!("{START}CC X+45 Y+25\nLP PR+30 PA+60 F100\nCP PA+180 DR+"));
    let end = points(&ops)[1];
    assert!((end[0] - 60.0).abs() < 1e-9 && (end[1] - 25.0 - 30.0 * 0.75f64.sqrt()).abs() < 1e-9);
    let arc = arcs(&ops)[0];
    assert!(arc.end.point.distance(Vec3::new(15.0, 25.0, 50.0)) < 1e-9);
}

/// Cycle 200 of the manual's example, with a peck.
const DRILLING: &str = "CYCL DEF 200 DRILLING ~
  Q200=+2 ;SET-UP CLEARANCE ~
  Q201=-15 ;DEPTH ~
  Q206=+250 ;FEED RATE FOR PLNGNG ~
  Q202=+5 ;PLUNGING DEPTH ~
  Q210=+0 ;DWELL TIME AT TOP ~
  Q203=+20 ;SURFACE COORDINATE ~
  Q204=+100 ;2ND SET-UP CLEARANCE ~
  Q211=+0.1 ;DWELL TIME AT DEPTH
";

#[test]
fn drilling_starts_at_the_surface_and_ends_at_the_second_clearance() {
    let ops = run(&format!(
        "{START}{DRILLING}L X+30 Y+20 FMAX M3\nCYCL CALL\nL X+80 Y+50 FMAX M99\nL Z+200 FMAX M30"
    ));
    let cycle = Cycle {
        kind: CycleKind::Deep,
        depth: 15.0,
        clearance: 2.0,
        retract: 100.0,
        feed: Some(Feed::PerMinute(250.0)),
        dwell: 0.1,
        first_peck: Some(5.0),
        peck: Some(5.0),
    };
    assert_eq!(
        ops[4..11],
        [
            Action::Rapid(upright(30.0, 20.0, 50.0)),
            Action::Cycle(Box::new(cycle)),
            Action::Hole(upright(30.0, 20.0, 20.0)),
            // From the second clearance above the surface.
            Action::Rapid(upright(80.0, 50.0, 120.0)),
            Action::Hole(upright(80.0, 50.0, 20.0)),
            Action::Rapid(upright(80.0, 50.0, 200.0)),
            Action::Spindle(Spindle::Off),
        ]
    );
}

fn define(number: u32, parameters: &str) -> Result<Cycle, Box<Diagnostic>> {
    let lines: Vec<String> =
        parameters.split_whitespace().map(|parameter| format!("  {parameter}")).collect();
    let blocks = format!("{START}CYCL DEF {number} NAME ~\n{}\nCYCL CALL", lines.join(" ~\n"));
    let records = run_on([false; 3], "MM", &blocks)?;
    let ops: Vec<Action> = records.into_iter().map(|record| record.action).collect();
    Ok(cycles(&ops)[0])
}

/// A cycle and its parameters; its kind, first peck, further pecks and dwell.
type Case<'a> = (u32, &'a str, CycleKind, Option<f64>, Option<f64>, f64);

#[test]
fn each_cycle_is_what_the_manual_says() {
    use CycleKind::*;
    let levels = "Q200=2 Q203=0 Q204=1";
    let q200 = "Q201=-10 Q206=100 Q210=0";
    let table: &[Case] = &[
        (200, &format!("{q200} Q202=10"), Drill, None, None, 0.0),
        (200, &format!("{q200} Q202=4 Q211=1 Q395=0"), Deep, Some(4.0), Some(4.0), 1.0),
        (201, "Q201=-10 Q206=100 Q211=0 Q208=0", Ream, None, None, 0.0),
        (201, "Q201=-10 Q206=100 Q211=0 Q208=MAX", Drill, None, None, 0.0),
        (202, "Q201=-10 Q206=100 Q211=0.5 Q208=MAX Q214=0 Q336=0", Bore, None, None, 0.5),
        (
            203,
            &format!("{q200} Q202=5 Q212=2 Q213=0 Q205=3 Q211=0 Q208=MAX Q256=0.2"),
            Deep,
            Some(5.0),
            Some(3.0),
            0.0,
        ),
        (
            203,
            &format!("{q200} Q202=3 Q212=0 Q213=3 Q205=0 Q211=0 Q208=99999 Q256=0.2"),
            BreakChip,
            Some(3.0),
            Some(3.0),
            0.0,
        ),
        (
            205,
            "Q201=-10 Q206=100 Q202=4 Q212=0 Q205=0 Q258=0.2 Q259=0.2 Q257=0 Q256=0.2 Q211=0 Q379=0 \
             Q253=750",
            Deep,
            Some(4.0),
            Some(4.0),
            0.0,
        ),
        (
            205,
            "Q201=-10 Q206=100 Q202=10 Q212=0 Q205=0 Q258=0.2 Q259=0.2 Q257=3 Q256=0.2 Q211=0 Q379=0 \
             Q253=750",
            BreakChip,
            Some(3.0),
            Some(3.0),
            0.0,
        ),
        // 4500 mm/min at 3000 1/min.
        (206, "Q201=-10 Q206=4500 Q211=0", Tap { pitch: 1.5, left: false }, None, None, 0.0),
        (207, "Q201=-10 Q239=+1", Tap { pitch: 1.0, left: false }, None, None, 0.0),
        (207, "Q201=-10 Q239=-1", Tap { pitch: 1.0, left: true }, None, None, 0.0),
        (
            209,
            "Q201=-10 Q239=+1 Q257=4 Q256=0.5 Q336=0",
            Tap { pitch: 1.0, left: false },
            Some(4.0),
            Some(4.0),
            0.0,
        ),
    ];
    for (number, parameters, kind, first_peck, peck, dwell) in table {
        let cycle = define(*number, &format!("{levels} {parameters}")).unwrap();
        let expected = Cycle {
            kind: *kind,
            depth: 10.0,
            clearance: 2.0,
            // Q204 counts only where it is above Q200.
            retract: 2.0,
            feed: cycle.feed,
            dwell: *dwell,
            first_peck: *first_peck,
            peck: *peck,
        };
        assert_eq!(cycle, expected, "{number} {parameters}");
    }
}

#[test]
fn what_a_cycle_cannot_say_in_the_neutral_vocabulary_is_refused() {
    let levels = "Q200=2 Q203=0 Q204=50";
    for (number, parameters, message) in [
        (200, "Q201=+10 Q206=100 Q202=5 Q210=0", "negative"),
        (200, "Q201=-10 Q206=100 Q202=0 Q210=0", "Q202"),
        (200, "Q201=-10 Q206=100 Q202=5 Q210=1", "Q210"),
        (200, "Q201=-10 Q206=100 Q202=5", "lacks its parameter Q210"),
        (200, "Q201=-10 Q206=100 Q202=5 Q210=0 Q257=1", "no parameter Q257"),
        (200, "Q201=-10 Q206=100 Q202=5 Q210=0 Q395=1", "Q395"),
        (200, "Q201=-10 Q206=100 Q206=100 Q202=5 Q210=0", "twice"),
        (201, "Q201=-10 Q206=100 Q211=0 Q208=500", "Q208"),
        (202, "Q201=-10 Q206=100 Q211=0 Q208=MAX Q214=5 Q336=0", "Q214"),
        (
            203,
            "Q201=-10 Q206=100 Q202=2 Q210=0 Q212=0 Q213=2 Q205=0 Q211=0 Q208=MAX Q256=0.2",
            "breaks",
        ),
        (
            203,
            "Q201=-10 Q206=100 Q202=4 Q210=0 Q212=1 Q213=0 Q205=1 Q211=0 Q208=MAX Q256=0.2",
            "Q212",
        ),
        (207, "Q201=-10 Q239=0", "Q239"),
        (208, "Q201=-10", "208"),
    ] {
        let error = define(number, &format!("{levels} {parameters}")).unwrap_err();
        assert!(error.message.contains(message), "{number} {parameters}: {}", error.message);
        assert!(error.line > 3 && error.column > 0);
    }
}

#[test]
fn a_call_at_a_position_adds_its_z_to_the_surface() {
    let ops = run(&format!("{START}{DRILLING}CYCL CALL POS X+5 Y+6 Z-3 FMAX"));
    assert_eq!(points(&ops)[1..], [[5.0, 6.0, 50.0], [5.0, 6.0, 17.0]]);
}

#[test]
fn a_modal_call_drills_at_every_position_until_m99() {
    let ops =
        run(&format!("{START}{DRILLING}L X+1 FMAX M89\nL X+2 FMAX\nL X+3 FMAX M99\nL X+4 FMAX"));
    let holes: Vec<f64> = ops
        .iter()
        .filter_map(|op| match op {
            Action::Hole(pose) => Some(pose.point.x),
            _ => None,
        })
        .collect();
    assert_eq!(holes, [1.0, 2.0, 3.0]);
}

#[test]
fn the_datum_shift_is_absolute_or_incremental_and_moves_the_count() {
    let ops = run(&format!(
        "{START}CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+60\nCYCL DEF 7.2 IY-5\nL X+1 FMAX\nL IX+1 FMAX"
    ));
    assert_eq!(points(&ops)[1..], [[61.0, 0.0, 50.0], [62.0, 0.0, 50.0]]);
}

#[test]
fn a_dwell_is_in_seconds_and_a_tolerance_says_how_far_the_path_may_be_left() {
    let ops = run(&format!(
        "{START}CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1.5
CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.05\nCYCL DEF 32.2 HSC-MODE:1 TA5\nM30"
    ));
    assert_eq!(ops[4], Action::Dwell(1.5));
    assert_eq!(ops[5], Action::PathMode(PathMode::Blend(0.05)));
    assert_eq!(ops.len(), 8);
    // An empty cycle ends it: the control is as its parameters set it up.
    let ended = run(&format!("{START}CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1"));
    assert_eq!(ended[4], Action::PathMode(PathMode::AsSetUp));
}

#[test]
fn a_preset_becomes_the_work_offset() {
    let ops = run("CYCL DEF 247 DATUM SETTING ~\n  Q339=+1 ;DATUM NUMBER");
    assert_eq!(ops[0], Action::WorkOffset(WorkOffset::FIRST));
}

#[test]
fn machine_positions_and_retractions_leave_the_place_unknown() {
    let ops = run(&format!("{START}L Z+0 R0 FMAX M91\nL X+5 FMAX\nL M140 MB MAX\nL Z+1 F10"));
    let to = MachineMove { linear: [None, None, Some(0.0)], ..MachineMove::default() };
    assert_eq!(ops[4], Action::MachineMove(Box::new(to)));
    // Where the datum of M92 is, only the builder knows.
    let ops_of_m92 = run(&format!("{START}L Z-5 R0 FMAX M92"));
    let Action::MachineMove(to) = &ops_of_m92[4] else { panic!("{ops_of_m92:?}") };
    assert!(to.linear[2].is_some_and(f64::is_nan), "{to:?}");
    let Action::Rapid(pose) = &ops[5] else { panic!() };
    assert!(pose.point.z.is_nan() && pose.point.x == 5.0);
    assert_eq!(ops[6], Action::Home(Axes::Z));
    assert_eq!(points(&ops).last(), Some(&[5.0, 0.0, 1.0]));
    let ops = run(&format!("{START}L X+1 F125 M140 MB 50 F750"));
    assert_eq!(points(&ops)[1..], [[0.0, 0.0, 100.0], [1.0, 0.0, 100.0]]);
}

#[test]
fn rotary_words_keep_the_tip_only_under_m128() {
    let ops = run_five(
        "TOOL CALL 1 Z S100
L B+30 C-90 R0 FMAX
L X+1 Y+2 Z+3 FMAX
M128
L X+1 Y+2 Z+3 F100
L IB+10
M129
L X+1 Y+2 Z+3",
    );
    let poses = poses(&ops);
    let rotary = |b, c, tool_center| Orientation::Rotary { degrees: [0.0, b, c], tool_center };
    assert_eq!(poses[1].orientation, rotary(30.0, -90.0, false));
    assert_eq!(poses[2].orientation, rotary(30.0, -90.0, true));
    assert_eq!(poses[3], Position { orientation: rotary(40.0, -90.0, true), ..poses[2] });
    assert_eq!(poses[4].orientation, rotary(40.0, -90.0, false));
    // The same numbers are another place, so a single word does not make the others known.
    let error = refused_five("L X+1 Y+2 Z+3 B+30 C+0 R0 FMAX\nM128\nL X+1 F100");
    assert!(error.message.contains("Y, Z"), "{error}");
}

#[test]
fn the_seeds_of_the_fuzz_target_are_legal_programs() {
    let seeds = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/klartext");
    for (name, rotary) in [
        ("milling.h", [false; 3]),
        ("drilling.h", [false; 3]),
        ("flow.h", [false; 3]),
        ("contour.h", [false; 3]),
        ("frames.h", [false; 3]),
        ("tilted.h", FIVE_AXES),
    ] {
        let text = std::fs::read(seeds.join(name)).unwrap();
        let records = read_on(rotary, &text).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(records.last().unwrap().action, Action::End);
    }
}

#[test]
fn nothing_cuts_where_the_axes_are_not_known() {
    assert!(refused_five("L X+1 Y+2 Z+3 FMAX\nL X+2 F100").message.contains("B, C"));
    assert!(refused("L X+1 Y+2 FMAX\nL X+2 F100").message.contains("Z"));
    let error = refused_five(&format!(
        "TOOL CALL 1 Z S1 F1\nL X+1 Y+2 Z+3 B+30 C+0 FMAX\nM128\nL X+1 Y+2 FMAX\n{DRILLING}CYCL CALL"
    ));
    assert_eq!(error.rule.name(), "cycle");
}

#[test]
fn vectors_give_the_tool_axis() {
    let ops = run_five(
        "FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR
LN X+1 Y+2 Z+3 NX+0 NY+0 NZ+1 TX+0 TY-0.6 TZ+0.8 F1000
L X+5",
    );
    let poses = poses(&ops);
    assert_eq!(poses[0], Position::new(Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.0, -0.6, 0.8)));
    assert_eq!(poses[1].orientation, poses[0].orientation);
    // The block format of the TNC 640 manual has M128 in the same block.
    let ops = run_five(
        "LN X+31.737 Y+21.954 Z+33.165 NX+0.2637581 NY+0.0078922 NZ-0.8764339 TX+0.0078922 \
         TY-0.8764339 TZ+0.2590319 F1000 M128",
    );
    let axis = ops.iter().find_map(Action::position).unwrap().axis().unwrap();
    assert!((axis.y / axis.x + 0.8764339 / 0.0078922).abs() < 1e-9 && axis.is_normalized());
    assert_eq!(refused_five("LN X+1 Y+2 Z+3 TX+0 TY+0 TZ+1 F10").rule.name(), "tool-center");
    assert_eq!(refused_five("M128\nLN X+1 Y+2 Z+3 TX+0 TY+0 TZ+0 F10").rule.name(), "zero-vector");
}

/// 530 p. 472, 620 p. 556: `SEQ` names the sign of the main rotary axis, and without it the control takes the shorter way.
#[test]
fn a_plane_says_which_solution_the_control_takes() {
    for (says, expected) in [
        ("TURN FMAX", Some(TiltChoice::ShorterWithin)),
        ("TURN FMAX SEQ+", Some(TiltChoice::Sequence(true))),
        ("SEQ- TURN MB MAX FMAX", Some(TiltChoice::Sequence(false))),
        ("MOVE DIST50 F1000 SYM- TABLE ROT", Some(TiltChoice::Symmetry)),
        ("STAY", None),
    ] {
        let ops = run_five(&format!("PLANE SPATIAL SPA+45 SPB+0 SPC+0 {says}"));
        let chosen = ops.iter().find_map(|op| match op {
            Action::Swivel(choice) => Some(*choice),
            _ => None,
        });
        assert_eq!(chosen, expected, "{says}");
    }
    let twice = refused_five("PLANE SPATIAL SPA+45 SPB+0 SPC+0 TURN FMAX SEQ+ SEQ-");
    assert_eq!(twice.rule.name(), "unknown-word");
}

#[test]
fn spatial_angles_turn_about_the_fixed_axes_a_then_b_then_c() {
    // By hand. SPA+45 SPC+90 (the manual's own example): A tips Z to (0, -sin 45, cos 45), C turns that
    // to (sin 45, 0, cos 45); X goes to Y, and Y to (-cos 45, 0, sin 45).
    let s = 0.5f64.sqrt();
    let tilted = "L X+0 Y+0 Z+10 R0 FMAX";
    let ops = run_five(&format!(
        "PLANE SPATIAL SPA+45 SPB+0 SPC+90 TURN FMAX SEQ- TABLE ROT\n{tilted}
L X+1 F100\nL Y+1\n"
    ));
    let poses = poses(&ops);
    let axis = Vec3::new(s, 0.0, s);
    assert!(poses[0].point.is_nan());
    for (pose, point) in poses[1..].iter().zip([
        axis * 10.0,
        axis * 10.0 + Vec3::Y,
        axis * 10.0 + Vec3::Y + Vec3::new(-s, 0.0, s),
    ]) {
        assert!(pose.point.distance(point) < 1e-12, "{pose:?}");
        assert!(pose.axis().unwrap().distance(axis) < 1e-12);
    }
    // SPB+45 alone tips the tool to +X; all three: Z by A 30, B 60, C 90 is
    // (sinA sinC + cosA sinB cosC, -sinA cosC + cosA sinB sinC, cosA cosB) = (0.5, 0.75, 0.4330).
    for (angles, axis) in [
        ("SPA+0 SPB+45 SPC+0", Vec3::new(s, 0.0, s)),
        ("SPA+30 SPB+60 SPC+90", Vec3::new(0.5, 0.75, 0.1875f64.sqrt())),
    ] {
        let ops = run_five(&format!("PLANE SPATIAL {angles} TURN FMAX\n{tilted}"));
        let pose = *ops.iter().filter_map(Action::position).next_back().unwrap();
        assert!(pose.axis().unwrap().distance(axis) < 1e-12, "{angles}");
    }
}

#[test]
fn x_and_y_of_a_turned_plane_are_known_before_its_z_is() {
    let ops = run_five("PLANE SPATIAL SPA+0 SPB+90 SPC+0 TURN FMAX\nL X+1 Y+2 R0 FMAX\nL Z+3 FMAX");
    // Z of the plane is X of the work, its X is -Z.
    let Some(Action::Across(over)) = ops.iter().find(|op| matches!(op, Action::Across(_))) else {
        panic!("{ops:?}")
    };
    assert!(over.point.distance(Vec3::new(0.0, 2.0, -1.0)) < 1e-12, "{over:?}");
    assert!(over.axis().unwrap().distance(Vec3::X) < 1e-12);
    let pose = ops.iter().filter_map(Action::position).next_back().unwrap();
    assert!(pose.point.distance(Vec3::new(3.0, 2.0, -1.0)) < 1e-12, "{pose:?}");
}

#[test]
fn a_plane_by_vectors_has_its_x_along_the_base() {
    let ops = run_five(
        "PLANE VECTOR BX+0 BY+1 BZ+0 NX+1 NY+0 NZ+1 TURN FMAX
L X+2 Y+0 Z+0 R0 FMAX\nPLANE RESET TURN FMAX\nL X+1 Y+1 Z+1 FMAX",
    );
    let poses = poses(&ops);
    assert!(poses[1].point.distance(Vec3::new(0.0, 2.0, 0.0)) < 1e-12);
    assert_eq!(poses.last(), Some(&upright(1.0, 1.0, 1.0)));
    // The vectors of the manual's example are not at right angles.
    let error = refused_five("PLANE VECTOR BX0.8 BY-0.4 BZ-0.42 NX0.2 NY0.2 NZ0.92 TURN FMAX");
    assert_eq!(error.rule.name(), "tilted-plane");
}

#[test]
fn a_datum_shift_before_the_plane_moves_its_origin_and_holes_follow() {
    let ops = run_five(&format!(
        "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+100
TOOL CALL 1 Z S1000 F100
PLANE SPATIAL SPA+0 SPB+90 SPC+0 TURN MB MAX FMAX
{DRILLING}L X+1 Y+2 Z+50 R0 FMAX M99"
    ));
    let hole =
        ops.iter().rfind(|op| matches!(op, Action::Hole(_))).unwrap().position().copied().unwrap();
    // B+90: X goes to -Z, Z to X. The surface is 20 along the axis from the shifted datum.
    assert!(hole.point.distance(Vec3::new(120.0, 2.0, -1.0)) < 1e-12);
    assert!(hole.axis().unwrap().distance(Vec3::X) < 1e-12);
    assert!(ops.contains(&Action::Home(Axes::Z)));
}

#[test]
fn in_a_plane_that_stays_the_words_turn_the_axes() {
    let ops =
        run_five("PLANE SPATIAL SPA+0 SPB+30 SPC+0 STAY\nL B+30 C+0 R0 FMAX\nL X+0 Y+0 Z+10 FMAX");
    let last = *ops.iter().filter_map(Action::position).next_back().unwrap();
    let degrees = [0.0, 30.0, 0.0];
    assert_eq!(last.orientation, Orientation::Rotary { degrees, tool_center: true });
    assert!(last.point.distance(Vec3::new(5.0, 0.0, 75f64.sqrt())) < 1e-12);
    let error = refused_five("PLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX\nL B+30 R0 FMAX");
    assert_eq!(error.rule.name(), "tilted-plane");
}

#[test]
fn in_a_tilted_plane_nothing_goes_down_at_an_unknown_place() {
    let plane = "PLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX\nL ";
    assert_eq!(refused_five(&format!("{plane}Y+0 Z+9 FMAX")).rule.name(), "unknown-position");
    run_five(&format!("{plane}X+0 Y+0 FMAX\nL Z+9 FMAX"));
}

#[test]
fn nothing_happens_after_the_end() {
    assert_eq!(run("L X+1 FMAX M30\n; TOOL LIST").last(), Some(&Action::End));
    assert_eq!(refused("L X+1 FMAX M30 M9").rule.name(), "program-frame");
    let error = refused(&format!("{START}{DRILLING}L X+1 FMAX M89\nL X+2 FMAX M30"));
    assert_eq!(error.rule.name(), "cycle");
}

/// TNC 155, 360: M2 and M30 stop spindle and coolant. Of END PGM no manual says so.
#[test]
fn end_pgm_alone_stops_neither_spindle_nor_coolant() {
    let off = [Action::Spindle(Spindle::Off), Action::Coolant(Coolant::Off), Action::End];
    for end in ["M30", "M2"] {
        assert!(run(&format!("TOOL CALL 1 Z S100\nM13\n{end}")).ends_with(&off));
    }
    let ops = run("TOOL CALL 1 Z S100\nM13\nM90");
    assert_eq!(ops[ops.len() - 2..], [Action::Coolant(Coolant::Flood), Action::End]);
    assert!(run("TOOL CALL 1 Z S100\nM13\nM5\nM9").ends_with(&off));
}

#[test]
fn a_stop_and_a_tool_change_stop_spindle_and_coolant() {
    let mut ops = run(&format!("{START}M8\nM0\nM13\nTOOL CALL 6 Z S10"));
    ops.retain(|action| !matches!(action, Action::Risk(_)));
    let off = [Action::Spindle(Spindle::Off), Action::Coolant(Coolant::Off)];
    assert_eq!(ops[5], Action::Stop);
    assert_eq!(ops[6..8], off);
    assert_eq!(ops[10..12], off);
    assert!(matches!(ops[12], Action::Tool(_)));
}

#[test]
fn the_functions_of_the_builder_move_nothing() {
    let ops = run("L X+1 FMAX M60");
    assert_eq!(ops.len(), 3);
    assert_eq!(ops[0], Action::Auxiliary(program::Auxiliary::of(60)));
    assert_eq!(refused("L X+1 FMAX M61").rule.name(), "m-function");
}

#[test]
fn what_is_not_understood_is_refused_with_its_place() {
    for (blocks, line, column, rule) in [
        ("L X+1 Q5 FMAX", 2, 9, "unknown-word"),
        ("L X+1 X+2 FMAX", 2, 9, "repeated-word"),
        ("L X+1.5,5 FMAX", 2, 5, "unknown-word"),
        ("L X+1,5.5 FMAX", 2, 5, "unknown-word"),
        ("L X+1Y+2 FMAX", 2, 5, "unknown-word"),
        ("L X+1e3 FMAX", 2, 5, "unknown-word"),
        ("L X FMAX", 2, 5, "unknown-word"),
        ("L B+1 FMAX", 2, 3, "unknown-axis"),
        ("L X+1", 2, 3, "feed"),
        ("L X+1 F0", 2, 9, "feed"),
        ("L X+1 FAUTO", 2, 9, "feed"),
        ("L IX+1 FMAX", 2, 3, "unknown-position"),
        ("L X+1 FMAX M77", 2, 14, "m-function"),
        ("L X+1 FMAX M3", 2, 3, "spindle"),
        ("L X+1 FMAX M8 M9 M5", 2, 20, "m-function"),
        ("l X+1 FMAX", 2, 3, "unknown-block"),
        ("RND R5", 2, 3, "contour"),
        ("LBL", 2, 6, "syntax"),
        ("LBL 1\nLBL 1", 3, 3, "label"),
        ("CALL LBL 7", 2, 12, "label"),
        ("CALL LBL 0", 2, 12, "label"),
        ("Q5 = 3 +", 2, 11, "syntax"),
        ("Q5 = Q6", 2, 8, "parameter"),
        ("Q108 = 6", 2, 3, "parameter"),
        ("QX5 = 6", 2, 3, "unknown-word"),
        ("FN 16: F-PRINT A", 2, 6, "unsupported"),
        ("FL X+1", 2, 3, "unsupported"),
        ("CYCL DEF 7.1 X+1", 2, 12, "cycle-parameter"),
        ("CYCL DEF 18.0 THREAD CUTTING", 2, 12, "unsupported"),
        ("CYCL DEF 200 DRILLING", 2, 3, "cycle-parameter"),
        ("CYCL CALL", 2, 3, "cycle"),
        ("TOOL CALL 1 S100", 2, 3, "missing-word"),
        ("TOOL CALL 1 Z DL+0.1", 2, 17, "unsupported"),
        ("TOOL CALL 1 Z DR2-0.1", 2, 17, "unsupported"),
        ("PLANE SPATIAL SPA+0 SPB+0 SPC+0 TURN FMAX", 2, 3, "tilted-plane"),
        ("M128", 2, 3, "tool-center"),
        ("CC X+1", 2, 3, "missing-word"),
    ] {
        let error = refused(blocks);
        assert_eq!(
            (error.line, error.column, error.rule.name()),
            (line, column, rule),
            "{blocks}: {error}"
        );
        assert_eq!(error.file, "t.h");
    }
}

#[test]
fn an_arc_must_be_one() {
    let at = "L X+10 Y+0 Z+0 F100\nCC X+0 Y+0\n";
    for (block, rule) in [
        ("C X+0 Y+10.017 DR+", "arc"),
        ("C X+0 Y+10", "missing-word"),
        ("CR X+40 Y+0 R+10 DR+", "arc"),
        ("CR X+10 Y+0 R+10 DR+", "arc"),
        ("CP IPA+90 DR-", "arc"),
        ("CP IPA+100000 DR+", "arc"),
        ("C X+0 Y+10 RL DR+", "compensation"),
        ("C X+0 Y+10 DR+ FMAX", "unsupported"),
    ] {
        let error = refused(&format!("{START}{at}{block}"));
        assert_eq!(error.rule.name(), rule, "{block}: {error}");
    }
    let error = refused(&format!("{START}{at}C X+0 Y+10.017 DR+"));
    assert!(error.message.contains("10.0000") && error.message.contains("10.0170"), "{error}");
    assert_eq!(arcs(&run(&format!("{START}{at}C X+0 Y+10.015 DR+"))).len(), 1);
}

#[test]
fn a_program_has_a_beginning_an_end_and_ascending_blocks() {
    for (text, line, rule) in [
        ("", 1, "program-frame"),
        ("0 BEGIN PGM A MM\n0 L X+1 FMAX\n", 2, "block-number"),
        ("3 BEGIN PGM A MM\n5 L X+1 FMAX\n4 END PGM A MM\n", 3, "block-number"),
        ("( SET-UP\n0 BEGIN PGM A MM\n", 1, "program-frame"),
        ("0 BEGIN PGM A CM\n", 1, "program-frame"),
        ("0 BEGIN PGM A MM\nL X+1 FMAX\n", 2, "block-number"),
        ("0 BEGIN PGM A MM\n1 END PGM B MM\n", 2, "program-frame"),
        ("0 BEGIN PGM A MM\n1 END PGM A INCH\n", 2, "syntax"),
        ("0 BEGIN PGM A MM\n1 L X+1 FMAX\n", 2, "program-frame"),
        ("0 BEGIN PGM A MM\n1 L X+1 FMAX ~\n", 2, "unsupported"),
        ("0 BEGIN PGM A MM\n1 END PGM A MM\n2 L X+1 FMAX\n", 3, "program-frame"),
        ("0 BEGIN PGM A MM\n1 M30\n2 L X+1 FMAX\n3 END PGM A MM\n", 3, "program-frame"),
        ("0 BEGIN PGM A MM\n1 CYCL DEF 9.0 DWELL\n2 END PGM A MM\n", 3, "cycle-parameter"),
    ] {
        let error = read_on([false; 3], text.as_bytes()).unwrap_err();
        assert_eq!((error.line, error.rule.name()), (line, rule), "{text}: {error}");
    }
}

#[test]
fn block_numbers_ascend_from_any_on_and_lines_may_be_blank() {
    let text = b"01 BEGIN PGM A MM\n  \n05 L X+1 Y+0 Z+0 FMAX\n\n007 L X+2 FMAX\n10 END PGM A MM\n";
    let records = read_on([false; 3], text).unwrap();
    let lines: Vec<u32> = records.iter().map(|record| record.line).collect();
    assert_eq!(lines, [3, 5, 6]);
}

#[test]
fn a_block_with_a_slash_is_skipped_where_the_operator_says_so() {
    let text = b"0 BEGIN PGM A MM
/1 L X+1 FMAX
/2 CYCL DEF 247 ~
    Q339=+2
/3 TOOL DEF 5 L+0 R+4
4 L X+2 FMAX
/5 M30
6 LBL 1
7 LBL 0
8 END PGM A MM\n";
    let ops = |block_delete| {
        let setup = Setup { block_delete, ..Setup::default() };
        let records = read_with(setup, [false; 3], text).unwrap();
        records.into_iter().map(|record| record.action).collect::<Vec<_>>()
    };
    let kinds = |ops: &[Action]| {
        let rapids = ops.iter().filter(|op| matches!(op, Action::Rapid(_))).count();
        let offsets = ops.iter().filter(|op| matches!(op, Action::WorkOffset(_))).count();
        (rapids, offsets, ops.iter().filter(|op| **op == Action::End).count())
    };
    assert_eq!(kinds(&ops(false)), (2, 1, 1));
    assert_eq!(kinds(&ops(true)), (1, 0, 1));
}

#[test]
fn blanks_stand_where_they_leave_no_doubt() {
    let compact =
        "Q5 = 2\nFN 0: Q6 = 7\nL X+1 Y-2 Z+2 FMAX\nCYCL DEF 9.0 DWELL\nCYCL DEF 9.1 DWELL 1.5";
    let apart =
        "Q5 = 2\nFN0: Q6 = 7\nL X + 1 Y - Q5 Z +Q5 FMAX\nCYCL DEF9 .0 DWELL\nCYCL DEF9.1 D.WELL1.5";
    let ops = run(apart);
    assert_eq!(format!("{:?}", ops), format!("{:?}", run(compact)));
    assert!(ops.contains(&Action::Dwell(1.5)), "{ops:?}");
    assert_eq!(refused("L X - -1 FMAX").rule.name(), "unknown-word");
    assert_eq!(refused("CYCL DEF 9. DWELL").rule.name(), "syntax");
}
