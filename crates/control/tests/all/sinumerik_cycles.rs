//! The drilling cycles of the SINUMERIK virtual control, against the manuals' description of each.

use crate::common::sinumerik::{blocks, error, holes, near, poses, v};
use program::{Cycle, CycleKind, Feed, Spindle};
use toolpost_control::{Action, Orientation};

/// The hole that one call makes at X5 Y6.
fn hole(call: &str) -> Cycle {
    let ops = blocks(&format!("S1000 M3\nG0 X5 Y6\n{call}"));
    let holes = holes(&ops);
    assert_eq!(holes.len(), 1, "{ops:?}");
    assert_eq!((holes[0].0.point.x, holes[0].0.point.y), (5.0, 6.0));
    holes[0].1
}

fn drill(depth: f64, clearance: f64, retract: f64) -> Cycle {
    Cycle {
        kind: CycleKind::Drill,
        depth,
        clearance,
        retract,
        feed: None,
        dwell: 0.0,
        first_peck: None,
        peck: None,
    }
}

#[test]
fn cycle81_drills_from_the_safety_distance_to_the_depth_and_goes_back_to_the_retraction_plane() {
    assert_eq!(hole("CYCLE81(10,0,2,,15)"), drill(15.0, 2.0, 10.0));
    assert_eq!(hole("CYCLE81(110,100,2,35)"), drill(65.0, 2.0, 10.0));
    assert_eq!(hole("CYCLE81(10,-5,2,-20,15)"), drill(15.0, 2.0, 15.0));
    // A relative depth of 0 is none.
    assert_eq!(hole("CYCLE81(10,0,2,-15,0)"), drill(15.0, 2.0, 10.0));
    assert_eq!(hole("CYCLE81(10,0,,-15)"), drill(15.0, 0.0, 10.0));
}

#[test]
fn a_call_alone_drills_once_and_leaves_the_tool_at_the_retraction_plane() {
    let ops = blocks("CYCLE81(10,0,2,-15)\nG0 X1");
    assert!(matches!(
        &ops[..4],
        [Action::Cycle(_), Action::Hole(_), Action::CycleOff, Action::Rapid(_)]
    ));
    near(poses(&ops)[0].point, v(0.0, 0.0, 0.0));
    near(poses(&ops)[1].point, v(1.0, 0.0, 10.0));
}

#[test]
fn cycle82_dwells_in_seconds_or_in_turns() {
    assert_eq!(hole("CYCLE82(10,0,2,-15,,0.5)"), Cycle { dwell: 0.5, ..drill(15.0, 2.0, 10.0) });
    // 5 turns at 1000 a minute.
    let turns = hole("CYCLE82(10,0,2,-15,,-5)");
    assert!((turns.dwell - 0.3).abs() < 1e-12);
}

#[test]
fn cycle83_pecks_with_and_without_clearing_the_hole() {
    let pecked =
        |kind| Cycle { kind, first_peck: Some(5.0), peck: Some(5.0), ..drill(25.0, 1.0, 50.0) };
    let clearing = hole("CYCLE83(50,0,1,-25,,,5,0,0,0,1,1)");
    assert_eq!(clearing, pecked(CycleKind::Deep));
    let breaking = hole("CYCLE83(50,0,1,-25,,-5,,0,0,0,1,0,0,0,1)");
    assert_eq!(breaking, pecked(CycleKind::BreakChip));
    // The dwell at the bottom is DTB, or _DTD where that is given.
    assert_eq!(hole("CYCLE83(50,0,1,-25,,-5,,0,0.2,0,1,1)").dwell, 0.2);
    assert_eq!(hole("CYCLE83(50,0,1,-25,,-5,,0,0.2,0,1,1,,,,0.7)").dwell, 0.7);
}

#[test]
fn cycle84_turns_the_spindle_itself_and_takes_the_hand_from_the_sign_of_the_pitch() {
    let ops = blocks("S1000 M3\nG0 X5\nCYCLE84(10,0,2,-20,,0.3,3,,1.25,0,400,600)");
    let (_, cycle) = holes(&ops)[0];
    let right = CycleKind::Tap { pitch: 1.25, left: false };
    assert_eq!(cycle, Cycle { kind: right, dwell: 0.3, ..drill(20.0, 2.0, 10.0) });
    let spindles: Vec<_> = ops.iter().filter(|op| matches!(op, Action::Spindle(_))).collect();
    let clockwise = |speed| Action::Spindle(Spindle::Clockwise(speed));
    // M30 stops it.
    let off = Action::Spindle(Spindle::Off);
    assert_eq!(spindles, [&clockwise(1000.0), &clockwise(400.0), &clockwise(1000.0), &off]);
    let left = hole("CYCLE84(10,0,2,-20,,0,5,,-2,0,400)");
    assert_eq!(left.kind, CycleKind::Tap { pitch: 2.0, left: true });
    // M10 has a coarse pitch of 1.5 mm.
    assert_eq!(
        hole("CYCLE84(10,0,2,-20,,0,3,10,,0,400)").kind,
        CycleKind::Tap { pitch: 1.5, left: false }
    );
}

#[test]
fn cycle840_takes_the_hand_from_the_running_spindle() {
    assert_eq!(
        hole("CYCLE840(10,0,2,-20,,0,0,3,0,,1.5)").kind,
        CycleKind::Tap { pitch: 1.5, left: false }
    );
    let ops = blocks("S500 M4\nCYCLE840(10,0,2,-20,,0,0,4,0,8)");
    assert_eq!(holes(&ops)[0].1.kind, CycleKind::Tap { pitch: 1.25, left: true });
}

#[test]
fn cycle85_and_89_feed_in_and_out() {
    let reamed = Cycle { kind: CycleKind::Ream, ..drill(15.0, 2.0, 10.0) };
    let feed = Some(Feed::PerMinute(120.0));
    let cycle85 = hole("CYCLE85(10,0,2,-15,,0.4,120,120)");
    assert_eq!(cycle85, Cycle { feed, dwell: 0.4, ..reamed });
    assert_eq!(hole("CYCLE89(10,0,2,-15,,1)"), Cycle { dwell: 1.0, ..reamed });
}

#[test]
fn cycle86_leaves_the_spindle_standing() {
    let ops = blocks("S1000 M3\nCYCLE86(10,0,2,-15,,0.4,3,0,0,0,45)\nG0 X5");
    let (_, cycle) = holes(&ops)[0];
    assert_eq!(cycle, Cycle { kind: CycleKind::Bore, dwell: 0.4, ..drill(15.0, 2.0, 10.0) });
    // In front of the move behind it, and so not by M30.
    let last = ops.iter().rposition(|op| matches!(op, Action::Rapid(_))).unwrap();
    let off = ops.iter().rposition(|op| *op == Action::Spindle(Spindle::Off)).unwrap();
    assert!(off < last, "{ops:?}");
}

#[test]
fn a_modal_call_drills_after_every_block_with_a_position_until_it_ends() {
    let ops = blocks("MCALL CYCLE81(10,0,2,-15)\nG0 X1 Y1\nM8\nX2\nY2\nMCALL\nX3");
    let points: Vec<_> = holes(&ops).iter().map(|(pose, _)| pose.point).collect();
    assert_eq!(points, [v(1.0, 1.0, 0.0), v(2.0, 1.0, 0.0), v(2.0, 2.0, 0.0)]);
    let cycles = ops.iter().filter(|op| matches!(op, Action::Cycle(_))).count();
    let rapids = ops.iter().filter(|op| matches!(op, Action::Rapid(_))).count();
    assert_eq!((cycles, rapids), (1, 4));
    let off = ops.iter().position(|op| *op == Action::CycleOff).unwrap();
    assert!(matches!(ops[off + 1], Action::Rapid(_)));
}

#[test]
fn a_second_modal_call_replaces_the_first() {
    let ops = blocks("MCALL CYCLE81(10,0,2,-15)\nG0 X1\nMCALL CYCLE81(10,0,2,-9)\nX2\nMCALL");
    let depths: Vec<_> = holes(&ops).iter().map(|(_, cycle)| cycle.depth).collect();
    assert_eq!(depths, [15.0, 9.0]);
}

#[test]
fn a_hole_in_a_swivelled_plane_points_along_its_axis() {
    let ops =
        blocks("CYCLE800(1,\"\",0,57,0,0,0,90,0,0,0,0,0,1)\nG0 X5 Y6\nZ50\nCYCLE81(10,1,2,-15)");
    let (pose, cycle) = holes(&ops)[0];
    // Y of the plane is Z of the work frame, Z of the plane is -Y.
    near(pose.point, v(5.0, -1.0, 6.0));
    assert_eq!(pose.orientation, Orientation::Axis(v(0.0, -1.0, 0.0)));
    assert_eq!((cycle.depth, cycle.retract), (16.0, 9.0));
}

#[test]
fn heights_in_inches_are_converted() {
    let ops = blocks("G70\nCYCLE81(1,0,0.1,-0.5)");
    let (_, cycle) = holes(&ops)[0];
    assert!((cycle.depth - 12.7).abs() < 1e-12 && (cycle.clearance - 2.54).abs() < 1e-12);
    assert_eq!(cycle.retract, 25.4);
}

#[test]
fn a_cycle_that_cannot_be_right_is_refused() {
    for (text, rule) in [
        ("CYCLE81(10,0,2)", "cycle-depth"),
        ("CYCLE81(10,0,2,,0)", "cycle-depth"),
        ("CYCLE81(10,0,2,5)", "cycle-depth"),
        ("CYCLE81(10,0,2,-15,14)", "cycle-depth"),
        ("CYCLE81(-1,0,2,-15)", "reference-plane"),
        ("CYCLE81(0,0,2,,15)", "reference-plane"),
        ("CYCLE81(,0,2,-15)", "cycle-parameter"),
        ("CYCLE81(10,0,-2,-15)", "cycle-parameter"),
        ("CYCLE81(10,0,2,-15,,,,,,1)", "cycle-parameter"),
        ("CYCLE81(10,0,2,\"x\")", "cycle-parameter"),
        ("CYCLE81(10,0,2,-15,,,1)", "unsupported"),
        ("CYCLE83(50,0,1,-25,,,,0,0,0,1,1)", "cycle-depth"),
        ("CYCLE83(50,0,1,-25,,-30,,0,0,0,1,1)", "cycle-depth"),
        ("CYCLE83(50,0,1,-25,,,5,2,0,0,1,1)", "unsupported"),
        ("CYCLE83(50,0,1,-25,,,5,0,0,0,0.5,1)", "unsupported"),
        ("CYCLE83(50,0,1,-25,,,5,0,0,0,1,2)", "cycle-parameter"),
        ("CYCLE84(10,0,2,-20,,0,0,,1,0,400)", "cycle-parameter"),
        ("CYCLE84(10,0,2,-20,,0,3,,,0,400)", "cycle-parameter"),
        ("CYCLE84(10,0,2,-20,,0,3,7,,0,400)", "cycle-parameter"),
        ("CYCLE84(10,0,2,-20,,0,3,,1,0)", "cycle-parameter"),
        ("CYCLE840(10,0,2,-20,,0,0,3,1,,1.5)", "unsupported"),
        ("CYCLE840(10,0,2,-20,,0,0,3,0,,1.5)", "cycle-parameter"),
        ("CYCLE85(10,0,2,-15,,0,100,200)", "unsupported"),
        ("CYCLE87(10,0,2,-15,,3)", "unsupported"),
        ("CYCLE82(10,0,2,-15,,-5)", "dwell"),
        ("MCALL CYCLE81(10,0,2,-15)\nF100", "cycle"),
        ("MCALL CYCLE81(10,0,2,-15)\nG0", "cycle"),
        ("MCALL CYCLE81(10,0,2,-15)\nSUPA G0 Z0", "cycle"),
        ("MCALL CYCLE81(10,0,2,-15)\nCYCLE81(10,0,2,-15)", "cycle"),
        ("MCALL TRAORI", "unsupported"),
        ("G18\nCYCLE81(10,0,2,-15)", "unsupported"),
        ("G75 X0\nCYCLE81(10,0,2,-15)", "unknown-position"),
        ("G93\nCYCLE81(10,0,2,-15)", "no-feed"),
        ("G1 X5 CYCLE81(10,0,2,-15)", "syntax"),
    ] {
        assert_eq!(error(text).rule, rule, "{text}");
    }
}

#[test]
fn patterns_are_drilled_by_the_modal_cycle() {
    let places = |pattern: &str| -> Vec<(f64, f64)> {
        let text = format!("MCALL CYCLE81(10,0,2,-15)\n{pattern}\nMCALL");
        let holes = holes(&blocks(&text));
        holes.iter().map(|(pose, _)| (pose.point.x, pose.point.y)).collect()
    };
    let near = |found: Vec<(f64, f64)>, expected: &[(f64, f64)]| {
        assert_eq!(found.len(), expected.len());
        for (a, b) in found.iter().zip(expected) {
            assert!((a.0 - b.0).hypot(a.1 - b.1) < 1e-9, "{found:?} is not {expected:?}");
        }
    };
    // From (0, 0) the first hole of the row is nearer, from (100, 0) the last.
    near(places("HOLES1(10,5,90,5,20,3)"), &[(10.0, 10.0), (10.0, 30.0), (10.0, 50.0)]);
    near(places("HOLES1(-50,0,180,0,-20,3)"), &[(-10.0, 0.0), (-30.0, 0.0), (-50.0, 0.0)]);
    let quarter = [(20.0, 0.0), (10.0, 10.0), (0.0, 0.0), (10.0, -10.0)];
    near(places("HOLES2(10,0,10,0,0,4)"), &quarter);
    near(places("HOLES2(10,0,10,0,90,2)"), &quarter[..2]);
    near(
        places("CYCLE801(10,10,0,5,7,3,2)"),
        &[(10.0, 10.0), (15.0, 10.0), (20.0, 10.0), (20.0, 17.0), (15.0, 17.0), (10.0, 17.0)],
    );
    for (text, rule) in [
        ("HOLES1(10,5,90,5,20,3)", "cycle"),
        ("MCALL CYCLE81(10,0,2,-15)\nHOLES1(10,5,90,5,20,0)", "cycle-parameter"),
        ("MCALL CYCLE81(10,0,2,-15)\nHOLES2(0,0,0,0,0,4)", "cycle-parameter"),
        ("MCALL CYCLE81(10,0,2,-15)\nCYCLE801(0,0,0,5,5,999,999)", "cycle-parameter"),
        ("MCALL CYCLE81(10,0,2,-15)\nHOLES1(10,5,90,5,20,3,1)", "unsupported"),
    ] {
        assert_eq!(error(text).rule, rule, "{text}");
    }
}
