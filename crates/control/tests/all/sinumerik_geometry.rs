//! Scaled and mirrored frames, polar coordinates, tangential arcs, diameters and threads of the SINUMERIK
//! virtual control, against hand calculation.

use crate::common::sinumerik::{arcs, blocks, holes, near, points, poses, v};
use program::{Compensation, Spindle};
use toolpost_control::Action;

#[test]
fn a_scale_multiplies_from_the_zero_point_and_is_deleted_by_the_next_frame() {
    let found =
        points("G0 X1 Y1\nSCALE X2 Y3\nX10 Y10\nASCALE X2\nX10 Y10\nTRANS X5\nX10\nSCALE\nX10 Y1");
    let expected =
        [v(1.0, 1.0, 100.0), v(20.0, 30.0, 100.0), v(40.0, 30.0, 100.0), v(15.0, 30.0, 100.0)];
    for (found, expected) in found.iter().zip(expected) {
        near(*found, expected);
    }
    near(found[4], v(10.0, 1.0, 100.0));
    // TRANS X10, then twice as large from there.
    near(points("TRANS X10\nASCALE X2\nG0 X5")[0], v(20.0, 0.0, 100.0));
}

#[test]
fn an_arc_in_an_even_scale_is_a_larger_arc() {
    let arc = arcs("SCALE X2 Y2 Z2\nG0 X0 Y0 Z50\nG2 X10 Y0 I5 J0")[0];
    near(arc.end.point, v(20.0, 0.0, 100.0));
    near(arc.center, v(10.0, 0.0, 100.0));
    near(arc.normal, v(0.0, 0.0, -1.0));
    // Scaled along Z only, an arc in the plane stays what it is.
    near(arcs("SCALE Z2\nG0 X0 Y0 Z50\nG3 X10 Y0 I5 J0")[0].normal, v(0.0, 0.0, 1.0));
}

#[test]
fn a_mirror_turns_arcs_and_compensation_round() {
    let ops = blocks("MIRROR X0\nG0 X5 Y0\nG1 G41 X10 Y0\nG2 X20 Y0 I5 J0\nG40 G1 X30");
    assert_eq!(poses(&ops)[1].point, v(-10.0, 0.0, 100.0));
    assert!(ops.contains(&Action::Compensation(Compensation::Right(Some(1)))), "{ops:?}");
    let arc = arcs("MIRROR X0\nG0 X10 Y0\nG2 X20 Y0 I5 J0")[0];
    near(arc.center, v(-15.0, 0.0, 100.0));
    near(arc.normal, v(0.0, 0.0, 1.0));
    // Twice is not at all; both axes are half a turn.
    near(points("MIRROR X0\nAMIRROR X0\nG0 X5")[0], v(5.0, 0.0, 100.0));
    let turned = arcs("MIRROR X0 Y0\nG0 X10 Y0\nG2 X20 Y0 I5 J0")[0];
    near(turned.normal, v(0.0, 0.0, -1.0));
    let drilled = holes(&blocks("MIRROR X0\nMCALL CYCLE81(10,0,2,-15)\nG0 X5 Y6\nMCALL"));
    near(drilled[0].0.point, v(-5.0, 6.0, 0.0));
}

#[test]
fn single_axes_are_offset_as_in_the_example_of_the_manual() {
    // Programming Manual 12/2019, p. 315: 15 15 10, then 25 15 10, then 30 20 10.
    let program = |more: &str| format!("TRANS X10 Y10 Z10\nATRANS X5 Y5\n{more}G0 X0 Y0 Z0");
    near(points(&program(""))[0], v(15.0, 15.0, 10.0));
    near(points(&program("G58 X20\n"))[0], v(25.0, 15.0, 10.0));
    near(points(&program("G58 X20\nG59 X10 Y10\n"))[0], v(30.0, 20.0, 10.0));
}

#[test]
fn polar_coordinates_count_from_their_pole() {
    let h = 0.75f64.sqrt();
    for (text, x, y) in [
        ("G0 RP=10 AP=30", 10.0 * h, 5.0),
        ("G111 X20 Y30\nG0 RP=10 AP=90", 20.0, 40.0),
        ("G0 X5 Y5\nG110 X1 Y2\nG0 RP=10 AP=0", 16.0, 7.0),
        ("G111 X20\nG112 Y5\nG0 RP=10 AP=180", 10.0, 5.0),
        ("G0 RP=10 AP=30\nAP=IC(60)", 0.0, 10.0),
        ("G0 RP=10 AP=90\nRP=20", 0.0, 20.0),
        ("G0 RP=10 AP=30\nG91 AP=AC(0)", 10.0, 0.0),
    ] {
        near(*points(text).last().unwrap(), v(x, y, 100.0));
    }
    // G18: the angle is from Z to X.
    near(points("G18\nG0 RP=10 AP=90 Y7")[0], v(10.0, 7.0, 0.0));
    let arc = arcs("G111 X0 Y0\nG0 RP=10 AP=0\nG3 AP=90 RP=10 Z90")[0];
    near(arc.center, v(0.0, 0.0, 100.0));
    near(arc.end.point, v(0.0, 10.0, 90.0));
}

#[test]
fn an_angle_gives_the_other_coordinate() {
    near(points("G1 X10 ANG=45")[0], v(10.0, 10.0, 100.0));
    near(points("G1 Y10 ANG=135")[0], v(-10.0, 10.0, 100.0));
    near(points("G1 X-3 ANG=180")[0], v(-3.0, 0.0, 100.0));
}

#[test]
fn a_tangential_arc_goes_on_in_the_direction_of_the_last_move() {
    // Along X, then to (20, 10): a quarter about (10, 10). Then half a turn more, back to (10, 20) - the
    // heading is +Y there.
    let found = arcs("G1 X10\nCT X20 Y10\nCT X10 Y10");
    near(found[0].center, v(10.0, 10.0, 100.0));
    near(found[0].normal, v(0.0, 0.0, 1.0));
    near(found[1].center, v(15.0, 10.0, 100.0));
    near(found[1].normal, v(0.0, 0.0, 1.0));
    let right = arcs("G1 X10\nG1 Z50\nCT X20 Y-10")[0];
    near(right.center, v(10.0, -10.0, 50.0));
    near(right.normal, v(0.0, 0.0, -1.0));
}

#[test]
fn diameters_are_halved() {
    let expected = [v(10.0, 0.0, 100.0), v(15.0, 0.0, 100.0), v(18.0, 0.0, 100.0)];
    assert_eq!(points("DIAMON\nG0 X20\nG91 X10\nX=IC(6)"), expected);
    let expected = [v(10.0, 0.0, 100.0), v(20.0, 0.0, 100.0), v(5.0, 0.0, 100.0)];
    assert_eq!(points("DIAM90\nG0 X20\nX=IC(10)\nDIAMOF\nX5"), expected);
}

#[test]
fn threads_go_in_step_with_the_spindle() {
    let ops =
        blocks("S500 M3\nG33 Z50 K2\nZ40\nG0 Z60\nG331 Z50 K-1.5 S200\nG332 Z60 K-1.5\nM3\nG63 Z5");
    let threads: Vec<_> = ops
        .iter()
        .filter_map(|op| match op {
            Action::Thread(thread) => Some((thread.end.point.z, thread.pitch)),
            _ => None,
        })
        .collect();
    assert_eq!(threads, [(50.0, 2.0), (40.0, 2.0), (50.0, 1.5), (60.0, 1.5)]);
    let spindles: Vec<_> = ops.iter().filter(|op| matches!(op, Action::Spindle(_))).collect();
    let expected = [
        Action::Spindle(Spindle::Clockwise(500.0)),
        Action::Spindle(Spindle::Clockwise(200.0)),
        Action::Spindle(Spindle::CounterClockwise(200.0)),
        Action::Spindle(Spindle::Clockwise(200.0)),
        Action::Spindle(Spindle::Off),
        Action::Spindle(Spindle::Clockwise(200.0)),
        // M30 stops it.
        Action::Spindle(Spindle::Off),
    ];
    assert_eq!(spindles, expected.iter().collect::<Vec<_>>());
}

#[test]
fn spindle_and_axes_are_positioned() {
    let ops = blocks("S500 M3\nSPOS=90\nM3\nM19\nPOS[X]=5 POS[C]=DC(90)\nY3\nM3");
    let off = ops.iter().filter(|op| **op == Action::Spindle(Spindle::Off)).count();
    // SPOS, M19, and M30.
    assert_eq!(off, 3);
    let moves: Vec<_> =
        ops.iter().filter(|op| matches!(op, Action::Rapid(_) | Action::Line(_))).collect();
    assert!(matches!(moves[..], [Action::Rapid(first), Action::Rapid(_)] if first.point.x == 5.0));
}
