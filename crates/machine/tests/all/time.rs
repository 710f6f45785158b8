//! Machining times against times worked out by hand.

use crate::clock::times_of;
use crate::common::{machine, table_ac};
use geom::Vec3;
use program::{ArcTo, Circle, Cycle, CycleKind, Feed, Op, Pose, Program, Spindle, Tool};
use toolpost_machine::time::{TOOL_CHANGE, Times};
use toolpost_machine::{Machine, OrientationMode};

/// 30 m/min and 5 m/s²: at speed after 0.1 s and 25 mm.
fn times(ops: impl IntoIterator<Item = Op>) -> Times {
    let mut program = Program::new("t");
    ops.into_iter().for_each(|op| program.push(1, op));
    times_of(&program, &machine(Vec::new()))
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, z)).unwrap()
}

fn assert_near(found: f64, wanted: f64) {
    assert!((found - wanted).abs() < 1e-9, "{found}, not {wanted}");
}

#[test]
fn a_long_rapid_runs_at_speed_and_a_short_one_never_gets_there() {
    let start = Op::Rapid(at(0.0, 0.0, 0.0));
    // 500 mm at 500 mm/s, and 0.1 s for starting and stopping.
    assert_near(times([start.clone(), Op::Rapid(at(500.0, 100.0, 0.0))]).rapid, 1.1);
    // 12.5 mm: half of it at 5 m/s² takes 0.05 s.
    assert_near(times([start, Op::Rapid(at(0.0, 12.5, 0.0))]).rapid, 0.1);
}

#[test]
fn a_robot_has_the_rapid_of_its_cell_and_no_axes_of_a_mill() {
    let robot = toolpost_machine::load("kuka-kr6-r900").unwrap();
    let mut program = Program::new("t");
    let feed = Op::Feed(Feed::PerMinute(30_000.0));
    let ops = [
        Op::Tool(Box::new(Tool { number: 1, ..Tool::default() })),
        Op::Rapid(at(0.0, 0.0, 0.0)),
        Op::Rapid(at(300.0, 400.0, 0.0)),
        feed,
        Op::Line(at(0.0, 0.0, 0.0)),
    ];
    ops.into_iter().for_each(|op| program.push(1, op));
    let times = times_of(&program, &robot);
    // 500 mm at 6000 mm/min from rest to rest of nothing, and at 30 m/min; the tool is put in by a person.
    assert_near(times.rapid, 5.0);
    assert_near(times.cutting, 1.0);
    assert_near(times.tool_change, 0.0);
}

#[test]
fn a_cut_takes_its_length_at_its_feed_in_every_unit() {
    let cut = |feed: Feed| {
        times([
            Op::Spindle(Spindle::Clockwise(1000.0)),
            Op::Feed(feed),
            Op::Line(at(0.0, 0.0, 0.0)),
            Op::Line(at(30.0, 40.0, 0.0)),
        ])
        .cutting
    };
    assert_near(cut(Feed::PerMinute(100.0)), 30.0);
    assert_near(cut(Feed::PerTurn(0.1)), 30.0);
    // Faster than the axes can: the 40 mm of Y at 30 m/min.
    assert_near(cut(Feed::PerMinute(1e6)), 0.08);
    // Two moves of half a second each.
    assert_near(cut(Feed::InverseTime(120.0)), 1.0);
    assert_near(cut(Feed::PerMinute(0.0)), 0.08);
}

#[test]
fn an_arc_is_as_long_as_it_is() {
    let to =
        ArcTo { end: at(-10.0, 0.0, 0.0), circle: Circle::new(Vec3::ZERO, Vec3::Z, 0).unwrap() };
    let ops =
        [Op::Feed(Feed::PerMinute(60.0)), Op::Rapid(at(10.0, 0.0, 0.0)), Op::Arc(Box::new(to))];
    assert_near(times(ops).cutting, 10.0 * std::f64::consts::PI);
}

#[test]
fn tool_changes_and_dwells_count() {
    let ops = [Op::Tool(Box::default()), Op::Dwell(1.5), Op::Tool(Box::<Tool>::default())];
    let times = times(ops);
    assert_near(times.tool_change, 2.0 * TOOL_CHANGE);
    assert_near(times.dwell, 1.5);
    assert_near(times.total(), 2.0 * TOOL_CHANGE + 1.5);
}

#[test]
fn a_hole_is_fed_in_and_left_by_rapid_and_a_thread_is_left_in_step() {
    let cycle = |kind| Cycle {
        kind,
        depth: 10.0,
        clearance: 2.5,
        retract: 2.5,
        feed: Some(Feed::PerMinute(60.0)),
        dwell: 0.5,
        first_peck: None,
        peck: None,
    };
    let hole = |kind| {
        times([
            Op::Spindle(Spindle::Clockwise(60.0)),
            Op::Rapid(at(0.0, 0.0, 2.5)),
            Op::Cycle(Box::new(cycle(kind))),
            Op::Hole(at(0.0, 0.0, 0.0)),
        ])
    };
    let drilled = hole(CycleKind::Drill);
    assert_near(drilled.cutting, 12.5);
    assert_near(drilled.rapid, 0.1);
    assert_near(drilled.dwell, 0.5);
    // 12.5 mm in and out at a turn a second of 1.25 mm.
    assert_near(hole(CycleKind::Tap { pitch: 1.25, left: false }).cutting, 20.0);
}

#[test]
fn a_rotary_axis_may_be_the_slowest() {
    // A at 10 800°/min and 500°/s²: 90° takes 90/180 + 180/500 s.
    let mut program = Program::new("t");
    program.push(1, Op::Rapid(at(0.0, 0.0, 0.0)));
    program.push(2, Op::Rapid(Pose::new(Vec3::X, Vec3::Y).unwrap()));
    assert_near(times_of(&program, &table_ac()).rapid, 0.86);
    program.push(3, Op::Feed(Feed::PerMinute(1000.0)));
    program.push(4, Op::Line(Pose::upright(Vec3::X * 2.0).unwrap()));
    assert_near(times_of(&program, &table_ac()).cutting, 0.5);
}

/// The table of the test above on a control without inverse time.
fn by_angles(feed_max: f64) -> Machine {
    let mut mill = Machine { feed_max, ..table_ac() };
    mill.capabilities.inverse_time = false;
    mill
}

/// A cut from `from`, with the tool along Z, to `to`, with the tool along Y: A turns by 90°.
fn leaning(mill: &Machine, from: Vec3, to: Vec3) -> f64 {
    let mut program = Program::new("t");
    program.push(1, Op::Feed(Feed::PerMinute(1000.0)));
    program.push(2, Op::Rapid(Pose::upright(from).unwrap()));
    program.push(3, Op::Line(Pose::new(to, Vec3::Y).unwrap()));
    times_of(&program, mill).cutting
}

#[test]
fn a_cut_takes_what_the_linear_axes_need_to_carry_the_tip() {
    // The table carries a tip at Y 300 to Z: 300 mm at 30 m/min, where A alone takes 0.5 s.
    let from = Vec3::new(0.0, 300.0, 0.0);
    assert_near(leaning(&by_angles(f64::INFINITY), from, from + Vec3::X * 0.01), 0.6);
    // Nobody knows how far it is where the file does not say where the work stands.
    let unsaid = Machine { work_zero: None, ..by_angles(f64::INFINITY) };
    assert_near(leaning(&unsaid, from, from + Vec3::X * 0.01), 0.5);
}

#[test]
fn f_counts_degrees_where_the_control_does_not_follow_the_tip() {
    // 90 counts at F1000, in a turn about a tip that stands on the axis.
    assert_near(leaning(&by_angles(f64::INFINITY), Vec3::ZERO, Vec3::ZERO), 5.4);
    let mut follows = by_angles(f64::INFINITY);
    follows.orientation.simultaneous = OrientationMode::ToolCenterAngles;
    assert_near(leaning(&follows, Vec3::ZERO, Vec3::ZERO), 0.5);
    // 20 mm of the tip at F1000; with F of no more than 2000 √(20² + 90²) counts take longer.
    let to = Vec3::X * 20.0;
    assert_near(leaning(&by_angles(f64::INFINITY), Vec3::ZERO, to), 1.2);
    assert_near(leaning(&by_angles(2000.0), Vec3::ZERO, to), 8500f64.sqrt() * 0.03);
}

#[test]
fn along_the_tool_above_a_turned_table_z_goes_alone() {
    // A turns by 45°: from rest to rest, half of it at 500°/s², 0.6 s. Then 12.5 mm along the tool, half of it at 5 m/s².
    let axis = Vec3::new(0.0, 1.0, 1.0).normalize();
    let mut program = Program::new("t");
    program.push(1, Op::Rapid(Pose::new(Vec3::ZERO, axis).unwrap()));
    program.push(2, Op::Rapid(Pose::new(axis * 12.5, axis).unwrap()));
    assert_near(times_of(&program, &table_ac()).rapid, 0.7);
}
