//! Rapids, lines and arcs: what is accepted and what is refused.

use crate::common::*;
use control::Action;
use geom::Vec3;
use program::*;

fn square() -> Vec<Op> {
    vec![
        Op::Rapid(at(0.0, 0.0, 50.0)),
        Op::Rapid(at(0.0, 0.0, 2.0)),
        Op::Line(at(0.0, 0.0, -1.0)),
        Op::Line(at(30.0, 0.0, -1.0)),
        Op::Line(at(30.0, 20.0, -1.0)),
        Op::Rapid(at(30.0, 20.0, 50.0)),
    ]
}

fn square_nc() -> Vec<Action> {
    vec![
        Action::Rapid(block(0.0, 0.0, 50.0)),
        Action::Rapid(block(0.0, 0.0, 2.0)),
        Action::Line(block(0.0, 0.0, -1.0)),
        Action::Line(block(30.0, 0.0, -1.0)),
        Action::Line(block(30.0, 20.0, -1.0)),
        Action::Rapid(block(30.0, 20.0, 50.0)),
    ]
}

/// Judges the square with one event of the program replaced by these.
fn with(index: usize, instead: Vec<Action>) -> Vec<&'static str> {
    let mut all = square_nc();
    all.splice(index..=index, instead);
    rules(&judge(&mill(), &source(square()), all))
}

#[test]
fn the_same_motion_is_proven() {
    let report = judge(&mill(), &source(square()), square_nc());
    proven(&report);
    assert_eq!((report.compared.rapids, report.compared.lines), (3, 3));
    assert_eq!(report.program.cutting_length_mm, 53.0);
    assert_eq!(report.program.rapid_length_mm, 48.0 + 51.0);
    assert_eq!(report.program.linear_extents_mm[2].min, Some(-1.0));
    assert_eq!(report.program.linear_extents_mm[0].max, Some(30.0));
    assert_eq!(report.program.tools, ["1"]);
}

#[test]
fn half_a_step_on_each_axis_is_rounding_and_more_is_a_mismatch() {
    let off = 0.000_49;
    assert!(with(3, vec![Action::Line(block(30.0 + off, off, -1.0 + off))]).is_empty());
    assert_eq!(with(3, vec![Action::Line(block(30.0, 0.0, -1.001))]), ["path"]);
    assert_eq!(with(3, vec![Action::Line(block(30.002, 0.0, -1.0))]), ["path"]);
}

#[test]
fn a_tool_axis_of_five_decimals_may_lean_by_its_last_on_a_machine_without_rotary_axes() {
    // The third cut of the square, with a tool axis that leans by so many radians.
    let leaning = |lean: f64| {
        let mut ops = square();
        let axis = Vec3::new(0.0, lean, 1.0);
        ops[3] = Op::Line(Pose::new(Vec3::new(30.0, 0.0, -1.0), axis).unwrap());
        rules(&judge(&mill(), &source(ops), square_nc()))
    };
    assert!(leaning(0.9e-5).is_empty());
    assert_eq!(leaning(1.1e-5), ["path"]);
}

#[test]
fn a_deviation_is_reported_with_both_lines() {
    let mut nc = square_nc();
    nc[3] = Action::Line(block(30.000_4, 0.0, -1.0));
    let report = judge(&mill(), &source(square()), nc);
    proven(&report);
    let worst = report.deviations.tip_mm;
    assert!((worst.value - 0.000_4).abs() < 1e-9);
    assert_eq!((worst.source_line, worst.program_line), (8, 10));
}

#[test]
fn a_coordinate_that_is_not_known_is_never_equal() {
    assert_eq!(with(3, vec![Action::Line(block(30.0, f64::NAN, -1.0))]), ["path"]);
    assert_eq!(with(0, vec![Action::Rapid(block(0.0, f64::NAN, 50.0))]), ["end-point"]);
    assert_eq!(with(5, vec![Action::Rapid(block(30.0, f64::NAN, 50.0))]), ["end-point"]);
}

#[test]
fn a_line_may_be_split_but_not_bent_or_run_back() {
    let go = |x: f64, y: f64| Action::Line(block(x, y, -1.0));
    assert!(with(3, vec![go(10.0, 0.0), go(20.0, 0.0), go(30.0, 0.0)]).is_empty());
    assert_eq!(with(3, vec![go(10.0, 0.01), go(30.0, 0.0)]), ["path"]);
    assert_eq!(with(3, vec![go(20.0, 0.0), go(10.0, 0.0), go(30.0, 0.0)]), ["path"]);
    assert_eq!(with(3, vec![go(31.0, 0.0), go(30.0, 0.0)]), ["path"]);
}

#[test]
fn a_missing_an_extra_and_a_swapped_move_are_found() {
    assert_eq!(with(3, vec![]), ["path"]);
    assert_eq!(with(5, vec![]), ["missing"]);
    let line = |x, y| Action::Line(block(x, y, -1.0));
    assert_eq!(with(3, vec![line(30.0, 0.0), line(40.0, 0.0)]), ["path"]);
    assert_eq!(with(3, vec![line(30.0, 20.0), line(30.0, 0.0)]), ["path"]);
}

#[test]
fn rapid_and_feed_are_not_the_same() {
    assert_eq!(with(3, vec![Action::Rapid(block(30.0, 0.0, -1.0))]), ["rapid-feed"]);
    assert_eq!(with(2, vec![Action::Rapid(block(0.0, 0.0, -1.0))]), ["rapid-feed"]);
    assert_eq!(with(1, vec![Action::Line(block(0.0, 0.0, 2.0))]), ["rapid-feed"]);
    assert_eq!(with(5, vec![Action::Line(block(30.0, 20.0, 50.0))]), ["rapid-feed"]);
}

#[test]
fn a_feed_retract_written_as_rapid_is_refused_although_it_leaves_along_the_axis() {
    let up = source(vec![
        Op::Rapid(at(0.0, 0.0, 5.0)),
        Op::Line(at(0.0, 0.0, -1.0)),
        Op::Line(at(0.0, 0.0, 5.0)),
    ]);
    let nc = vec![
        Action::Rapid(block(0.0, 0.0, 5.0)),
        Action::Line(block(0.0, 0.0, -1.0)),
        Action::Rapid(block(0.0, 0.0, 5.0)),
    ];
    assert_eq!(rules(&judge(&mill(), &up, nc)), ["rapid-feed"]);
}

#[test]
fn a_rapid_may_go_axis_by_axis_and_nowhere_else() {
    let nan = f64::NAN;
    let rapid = |x, y, z| Action::Rapid(block(x, y, z));
    let first = |instead: Vec<Action>| with(0, instead);
    let from_home = [rapid(0.0, nan, nan), rapid(0.0, 0.0, nan), rapid(0.0, 0.0, 50.0)];
    assert!(first(from_home.to_vec()).is_empty());
    assert_eq!(first(vec![rapid(7.0, nan, nan), rapid(0.0, 0.0, 50.0)]), ["rapid-stop"]);
    let two = source(vec![Op::Rapid(at(0.0, 0.0, 5.0)), Op::Rapid(at(9.0, 8.0, 7.0))]);
    let judged = |stop| {
        let nc = vec![rapid(0.0, 0.0, 5.0), stop, rapid(9.0, 8.0, 7.0)];
        rules(&judge(&mill(), &two, nc))
    };
    assert!(judged(rapid(9.0, 0.0, 7.0)).is_empty());
    assert!(judged(rapid(9.0, 8.0, 5.0)).is_empty());
    assert_eq!(judged(rapid(9.0, 4.0, 7.0)), ["rapid-stop"]);
    // It is below the zero of the part besides, where there may be a pocket.
    assert_eq!(judged(rapid(9.0, 8.0, -7.0)), ["rapid-path", "rapid-stop"]);
}

#[test]
fn a_wrong_rapid_is_named_at_its_own_block() {
    let mut nc = square_nc();
    nc[1] = Action::Rapid(block(0.0, 0.0, -2.0));
    let report = judge(&mill(), &source(square()), nc);
    // It goes below the way, and does not come to its end.
    assert_eq!(rules(&report), ["rapid-path", "end-point"]);
    let first = report.first_mismatch.unwrap();
    assert_eq!((first.source_line, first.program_line), (6, 8));
}

#[test]
fn moves_below_the_resolution_may_be_left_out_or_written() {
    let mut tiny = square();
    tiny.insert(4, Op::Line(at(30.0, 0.000_4, -1.0)));
    tiny.insert(4, Op::Line(at(30.0, 0.000_2, -1.0)));
    proven(&judge(&mill(), &source(tiny.clone()), square_nc()));
    tiny[5] = Op::Line(at(30.0, 0.000_6, -1.0));
    let mut nc = square_nc();
    nc.insert(4, Action::Line(block(30.0, 0.001, -1.0)));
    proven(&judge(&mill(), &source(tiny), nc));
}

fn round() -> Vec<Op> {
    vec![
        Op::Rapid(at(10.0, 0.0, 0.0)),
        Op::Arc(arc(at(0.0, 10.0, 0.0), (0.0, 0.0, 0.0), Vec3::Z)),
        Op::Arc(arc(at(0.0, 10.0, -2.0), (0.0, 0.0, 0.0), Vec3::NEG_Z)),
    ]
}

fn round_nc(first: Vec<Action>, second: Vec<Action>) -> Vec<&'static str> {
    let start = vec![Action::Rapid(block(10.0, 0.0, 0.0))];
    rules(&judge(&mill(), &source(round()), [start, first, second].concat()))
}

fn quarter() -> Vec<Action> {
    vec![Action::Arc(arc_block(block(0.0, 10.0, 0.0), (0.0, 0.0, 0.0), Vec3::Z))]
}

fn turn() -> Vec<Action> {
    vec![Action::Arc(arc_block(block(0.0, 10.0, -2.0), (0.0, 0.0, 0.0), Vec3::NEG_Z))]
}

#[test]
fn arcs_and_helices_are_proven_whole_split_and_as_chords() {
    assert!(round_nc(quarter(), turn()).is_empty());
    let half = vec![
        Action::Arc(arc_block(block(0.0, -10.0, -1.0), (0.0, 0.0, 0.0), Vec3::NEG_Z)),
        Action::Arc(arc_block(block(0.0, 10.0, -2.0), (0.0, 0.0, 0.0), Vec3::NEG_Z)),
    ];
    assert!(round_nc(quarter(), half).is_empty());
    let chords = |n: u32| -> Vec<Action> {
        let point = |i: u32| {
            let angle = std::f64::consts::FRAC_PI_2 * f64::from(i) / f64::from(n);
            Action::Line(block(10.0 * angle.cos(), 10.0 * angle.sin(), 0.0))
        };
        (1..=n).map(point).collect()
    };
    // 10 mm · (1 − cos(90°/n/2)): 0.0086 mm with 19 chords, 0.019 mm with 12; 0.01 mm is allowed.
    assert!(round_nc(chords(19), turn()).is_empty());
    assert_eq!(round_nc(chords(12), turn()), ["path"]);
}

#[test]
fn an_arc_the_other_way_the_long_way_or_round_another_centre_is_refused() {
    let end = block(0.0, 10.0, 0.0);
    let wrong =
        |center, normal| round_nc(vec![Action::Arc(arc_block(end, center, normal))], turn());
    assert_eq!(wrong((0.0, 0.0, 0.0), Vec3::NEG_Z), ["path"]);
    assert_eq!(wrong((10.0, 10.0, 0.0), Vec3::Z), ["path"]);
    assert_eq!(wrong((-0.05, -0.05, 0.0), Vec3::Z), ["path"]);
    assert_eq!(wrong((0.0, 0.0, 0.0), Vec3::Y), ["arc"]);
    assert_eq!(wrong((0.0, 0.0, 0.0), Vec3::new(0.1, 0.1, 1.0)), ["path"]);
    assert_eq!(round_nc(vec![Action::Line(end)], turn()), ["path"]);
    assert_eq!(round_nc(quarter(), vec![Action::Line(block(0.0, 10.0, -2.0))]), ["path"]);
}

#[test]
fn a_turn_too_many_or_too_few_is_refused() {
    let twice = Action::Arc(Box::new(control::ArcTo {
        end: block(0.0, 10.0, -2.0),
        center: Vec3::ZERO,
        normal: Vec3::NEG_Z,
        turns: 1,
    }));
    assert_eq!(round_nc(quarter(), vec![twice]), ["path"]);
    assert_eq!(round_nc(quarter(), vec![]), ["missing"]);
}

#[test]
fn an_arc_where_the_source_has_a_line_is_refused() {
    let over = arc_block(block(30.0, 0.0, -1.0), (15.0, 0.0, -1.0), Vec3::Z);
    assert_eq!(with(3, vec![Action::Arc(over)]), ["path"]);
}
