//! Tool axes: a table that turns under the tool, and controls that keep the tool tip.

use crate::common::*;
use control::{Action, Orientation, Position};
use geom::Vec3;
use machine::Machine;
use program::*;

/// A tip and the positions of A and C.
type Point = (Vec3, f64, f64);

fn degrees(point: Point) -> [f64; 3] {
    [point.1, 0.0, point.2]
}

/// What the source says of a point.
fn wanted(machine: &Machine, point: Point) -> Pose {
    Pose::new(point.0, machine.axis_at(degrees(point))).unwrap()
}

/// What a block without tool-center control says.
fn axes(machine: &Machine, point: Point) -> Position {
    let degrees = degrees(point);
    let linear = machine.linear_for(point.0, degrees, 0.0);
    Position { point: linear, orientation: Orientation::Rotary { degrees, tool_center: false } }
}

/// What a block with tool-center control says.
fn centered(_: &Machine, point: Point) -> Position {
    let orientation = Orientation::Rotary { degrees: degrees(point), tool_center: true };
    Position { point: point.0, orientation }
}

/// What a block in a tilted plane, or with a vector, says.
fn vector(machine: &Machine, point: Point) -> Position {
    Position::new(point.0, machine.axis_at(degrees(point)))
}

type Notation = fn(&Machine, Point) -> Position;

const NOTATIONS: [Notation; 3] = [axes, centered, vector];

fn at_point(x: f64, y: f64, z: f64, a: f64, c: f64) -> Point {
    (Vec3::new(x, y, z), a, c)
}

/// A cut along X in steps of `step` degrees of A and C.
fn path(step: f64) -> Vec<Point> {
    (0..8).map(f64::from).map(|i| at_point(10.0 + i, 5.0, 2.0, 20.0 + i * step, i * step)).collect()
}

/// What the source says of a cut along these points, behind a rapid to the first.
fn along(machine: &Machine, points: &[Point]) -> Vec<Op> {
    let line = |point: &Point| Op::Line(wanted(machine, *point));
    let mut ops: Vec<Op> = points.iter().map(line).collect();
    ops[0] = Op::Rapid(wanted(machine, points[0]));
    ops
}

/// What a program says of it in this notation. Without tool-centre control F would count degrees: it says the time of each
/// block, at 300 mm/min.
fn along_nc(machine: &Machine, points: &[Point], notation: Notation) -> Vec<Action> {
    let mut does = vec![Action::Rapid(notation(machine, points[0]))];
    for pair in points.windows(2) {
        let block = notation(machine, pair[1]);
        if matches!(block.orientation, Orientation::Rotary { tool_center: false, .. }) {
            does.push(timed(pair[0].0.distance(pair[1].0)));
        }
        does.push(Action::Line(block));
    }
    does
}

/// The time of a block along which the tip goes so many mm at 300 mm/min.
fn timed(way: f64) -> Action {
    Action::Feed(Feed::InverseTime(300.0 / way))
}

fn judged(notation: Notation, own: &[Point], nc: &[Point]) -> Vec<&'static str> {
    let machine = five_axes();
    let own = source(along(&machine, own));
    rules(&judge(&machine, &own, along_nc(&machine, nc, notation)))
}

#[test]
fn the_same_tip_and_axis_are_proven_in_every_notation() {
    for notation in NOTATIONS {
        assert!(judged(notation, &path(0.5), &path(0.5)).is_empty());
    }
}

#[test]
fn another_tip_or_another_axis_is_refused_in_every_notation() {
    for notation in NOTATIONS {
        let off = |alter: fn(&mut Point)| {
            let mut nc = path(0.5);
            alter(&mut nc[4]);
            judged(notation, &path(0.5), &nc)
        };
        assert_eq!(off(|point| point.0.y += 0.01), ["path"]);
        assert_eq!(off(|point| point.1 += 5.0), ["path"]);
        assert_eq!(off(|point| point.2 -= 10.0), ["path"]);
        assert_eq!(off(|point| point.1 = f64::NAN), ["path"]);
    }
    // One step more than rounding, at the end of the cut.
    let mut nc = path(0.5);
    nc[7].1 += 0.002;
    assert_eq!(judged(centered, &path(0.5), &nc), ["missing"]);
}

#[test]
fn a_block_that_swings_the_tip_off_the_line_is_refused_unless_it_is_split() {
    let (from, to) = (at_point(10.0, 5.0, 2.0, 20.0, 0.0), at_point(60.0, 5.0, 2.0, 30.0, 8.0));
    let split = |n: u32| -> Vec<Point> {
        let lerp = |a: f64, b: f64, i: u32| a + (b - a) * f64::from(i) / f64::from(n);
        (0..=n)
            .map(|i| {
                (from.0.lerp(to.0, lerp(0.0, 1.0, i)), lerp(from.1, to.1, i), lerp(from.2, to.2, i))
            })
            .collect()
    };
    assert_eq!(judged(axes, &[from, to], &split(1)), ["path"]);
    assert!(judged(axes, &[from, to], &split(64)).is_empty());
    // The control itself keeps the tip on the line.
    assert!(judged(centered, &[from, to], &split(1)).is_empty());
}

#[test]
fn a_whole_turn_of_the_table_in_a_cut_is_refused() {
    let (from, to) = (at_point(10.0, 5.0, 2.0, 20.0, 0.0), at_point(11.0, 5.0, 2.0, 20.0, 0.0));
    let around = at_point(11.0, 5.0, 2.0, 20.0, 360.0);
    for notation in [axes, centered] {
        assert!(judged(notation, &[from, to], &[from, to]).is_empty());
        assert_eq!(judged(notation, &[from, to], &[from, around]), ["path"]);
    }
}

#[test]
fn the_length_of_the_tool_counts_where_a_head_swings_it() {
    let text = r#"
        reader = "fanuc"
        tools.turns_upright = true
        [orientation]
        simultaneous = "machine-angles"
        [[rotary]]
        letter = "B"
        on = "head"
        axis = [0, 1, 0]
        point = [0, 0, 0]
        rapid = 1e4
        acceleration = 100
    "#;
    let machine = machine::load_text("head.toml", text).unwrap();
    let posed = |length: f64| {
        let degrees = [0.0, 30.0, 0.0];
        let point = machine.linear_for(Vec3::new(1.0, 2.0, 3.0), degrees, length);
        Position { point, orientation: Orientation::Rotary { degrees, tool_center: false } }
    };
    let call = Tool { number: 1, length: Some(100.0), ..Tool::default() };
    let to = Pose::new(Vec3::new(1.0, 2.0, 3.0), machine.axis_at([0.0, 30.0, 0.0])).unwrap();
    let [_, switched @ ..] = &start()[..] else { unreachable!() };
    let own = program([&[Op::Tool(Box::new(call))], switched, &[Op::Rapid(to)]].concat());
    let judged = |length| rules(&judge(&machine, &own, vec![Action::Rapid(posed(length))]));
    assert!(judged(100.0).is_empty());
    // It is lower, too, than the source ever goes, where it comes from home with all axes together.
    assert_eq!(judged(101.0), ["rapid-path", "end-point"]);
}

/// From one set-up to another: a source rapid that turns the tool, and the program's way.
fn set_up(way: impl Fn(&Machine) -> Vec<Action>) -> Report {
    let machine = five_axes();
    let (a, b) = (at_point(5.0, 6.0, 1.0, 0.0, 0.0), at_point(7.0, -9.0, 40.0, 90.0, 45.0));
    let to = |point| wanted(&machine, point);
    let own = source(vec![Op::Rapid(to(a)), Op::Line(to(a)), Op::Rapid(to(b))]);
    judge(&machine, &own, [vec![Action::Rapid(axes(&machine, a))], way(&machine)].concat())
}

use toolpost_proof::Report;

#[test]
fn between_set_ups_the_machine_may_go_home_and_turn_then_approach() {
    let b = at_point(7.0, -9.0, 40.0, 90.0, 45.0);
    let stop = |x: f64, y: f64, z: f64, a: f64, c: f64| {
        let orientation = Orientation::Rotary { degrees: [a, 0.0, c], tool_center: false };
        Action::Rapid(Position { point: Vec3::new(x, y, z), orientation })
    };
    let end = |machine: &Machine| axes(machine, b).point;
    let approach = |machine: &Machine| {
        let to = end(machine);
        vec![
            Action::Home(Axes::Z),
            stop(5.0, 6.0, f64::NAN, 90.0, 45.0),
            stop(to.x, 6.0, f64::NAN, 90.0, 45.0),
            stop(to.x, to.y, f64::NAN, 90.0, 45.0),
            Action::Rapid(axes(machine, b)),
        ]
    };
    proven(&set_up(approach));
    // All axes together swing the part through the tool.
    let at_once = |machine: &Machine| vec![Action::Rapid(axes(machine, b))];
    assert_eq!(rules(&set_up(at_once)), ["rapid-path"]);
    let astray =
        |machine: &Machine| vec![stop(90.0, 6.0, 1.0, 0.0, 0.0), Action::Rapid(axes(machine, b))];
    assert_eq!(rules(&set_up(astray)), ["rapid-path", "rapid-stop"]);
    // Up first, and over there; but a way that begins at home comes down by
    // the coordinates of its end only.
    let over = |machine: &Machine| {
        let to = end(machine);
        vec![
            stop(5.0, 6.0, 120.0, 0.0, 0.0),
            stop(5.0, 6.0, 120.0, 90.0, 45.0),
            stop(to.x, to.y, 90.0, 90.0, 45.0),
            Action::Rapid(axes(machine, b)),
        ]
    };
    proven(&set_up(over));
    let down_again = set_up(|machine| [vec![Action::Home(Axes::Z)], over(machine)].concat());
    assert_eq!(rules(&down_again), ["rapid-stop"]);
    let half_turned =
        |machine: &Machine| vec![stop(5.0, 6.0, 1.0, 45.0, 0.0), Action::Rapid(axes(machine, b))];
    assert_eq!(rules(&set_up(half_turned)), ["rapid-path", "rapid-stop"]);
}

#[test]
fn a_stop_at_a_place_half_known_has_the_coordinates_of_an_end() {
    let machine = five_axes();
    let (a, b) = (at_point(5.0, 6.0, 60.0, 20.0, 0.0), at_point(7.0, -9.0, 70.0, 0.0, 0.0));
    let to = |point| wanted(&machine, point);
    let own = source(vec![Op::Rapid(to(a)), Op::Rapid(to(b))]);
    let stop = |x: f64, z: f64, a: f64| {
        let orientation = Orientation::Rotary { degrees: [a, 0.0, 0.0], tool_center: false };
        Action::Rapid(Position { point: Vec3::new(x, f64::NAN, z), orientation })
    };
    let by = |stop: Action| {
        let (start, end) = (Action::Rapid(centered(&machine, a)), Action::Rapid(axes(&machine, b)));
        rules(&judge(&machine, &own, vec![start, stop, end]))
    };
    let unknown = f64::NAN;
    assert!(by(stop(unknown, unknown, 20.0)).is_empty());
    assert!(by(stop(7.0, 70.0, 0.0)).is_empty());
    assert_eq!(by(stop(7.0, 69.0, 0.0)), ["rapid-stop"]);
    // Z0 of the turned machine is somewhere in the part.
    assert_eq!(by(stop(unknown, 0.0, 20.0)), ["rapid-stop"]);
}

#[test]
fn a_rotary_axis_is_rewound_above_the_part_and_the_tool_comes_back() {
    let machine = five_axes();
    let (from, to) = (at_point(10.0, 5.0, 2.0, 20.0, 350.0), at_point(12.0, 5.0, 2.0, 20.0, 351.0));
    let lifted = |point: Point| {
        let pose = wanted(&machine, point);
        (pose.point() + machine.axis_at(degrees(point)) * 80.0, point.1, point.2)
    };
    let unwound = |point: Point| (point.0, point.1, point.2 - 360.0);
    let own = source(along(&machine, &[from, to]));
    let rewind = |turned: fn(Point) -> Point| {
        let block = |point| axes(&machine, point);
        let nc = vec![
            Action::Rapid(block(from)),
            Action::Rapid(block(lifted(from))),
            Action::Rapid(block(turned(lifted(from)))),
            Action::Line(block(turned(from))),
            timed(2.0),
            Action::Line(block(turned(to))),
        ];
        judge(&machine, &own, nc)
    };
    let report = rewind(unwound);
    proven(&report);
    assert_eq!(report.compared.excursions, 1);
    assert!((report.excursions[0].lift_mm - 80.0).abs() < 1e-6);
    assert_eq!(report.program.rotary_extents_degrees[2].min, Some(-10.0));
    // The other side of the part is not where it left.
    assert!(!rewind(|point| (point.0, -point.1, point.2)).proven);
}

#[test]
fn a_canned_cycle_in_a_tilted_plane_drills_along_the_tool() {
    let machine = five_axes();
    let point = at_point(10.0, 5.0, 2.0, 30.0, 40.0);
    let above = (point.0 + machine.axis_at(degrees(point)) * 20.0, point.1, point.2);
    let own = source(vec![
        Op::Rapid(wanted(&machine, above)),
        Op::Cycle(Box::new(drill())),
        Op::Hole(wanted(&machine, point)),
    ]);
    for notation in NOTATIONS {
        let nc = vec![
            Action::Rapid(notation(&machine, above)),
            cycle(drill()),
            Action::Hole(notation(&machine, point)),
        ];
        proven(&judge(&machine, &own, nc));
    }
    let straight = vec![
        Action::Rapid(centered(&machine, above)),
        cycle(drill()),
        Action::Hole(Position::new(point.0, Vec3::Z)),
    ];
    assert_eq!(rules(&judge(&machine, &own, straight)), ["hole"]);
}

/// A table that nutates by 45°, with tool-center control.
fn nutating() -> Machine {
    let text = r#"
        reader = "fanuc"
        [words]
        X = { decimals = 3 }
        B = { decimals = 3 }
        C = { decimals = 3 }
        [orientation]
        simultaneous = "tool-center-angles"
        [[rotary]]
        letter = "B"
        on = "table"
        axis = [0, 1, 1]
        rapid = 1e4
        acceleration = 100
        [[rotary]]
        letter = "C"
        on = "table"
        axis = [0, 0, 1]
        sign = -1
        rapid = 1e4
        acceleration = 100
    "#;
    machine::load_text("nutating.toml", text).unwrap()
}

/// With B at 180° the tool lies flat, and B and C turn it the same way: a step of B by sin 45° of it, a step of C by all of
/// it. Half a step of each is off by 0.00085°, and no more than rounding.
#[test]
fn half_a_step_of_two_words_that_turn_the_tool_the_same_way_is_rounding() {
    let machine = nutating();
    let tip = Vec3::new(10.0, 5.0, 2.0);
    let own = source(vec![Op::Rapid(Pose::new(tip, machine.axis_at([0.0, 180.0, 20.0])).unwrap())]);
    let off_by = |b: f64, c: f64| {
        let orientation =
            Orientation::Rotary { degrees: [0.0, 180.0 + b, 20.0 + c], tool_center: true };
        rules(&judge(&machine, &own, vec![Action::Rapid(Position { point: tip, orientation })]))
    };
    let half = 0.0005;
    for (b, c) in [(half, half), (half, -half), (-half, half), (-half, -half)] {
        assert!(off_by(b, c).is_empty(), "{b} {c}");
    }
    // A whole step of each is more, where they turn it the same way.
    let refused = [1.0, -1.0].map(|sign| !off_by(2.0 * half, sign * 2.0 * half).is_empty());
    assert_eq!(refused.iter().filter(|refused| **refused).count(), 1);
}

/// A fork head with C turned and A at 0 hangs along Z: Z home is away from the part in any orientation of C.
#[test]
fn a_head_that_is_turned_about_its_tool_goes_home_by_z() {
    let text = r#"
        reader = "fanuc"
        tools.turns_upright = true
        [orientation]
        simultaneous = "tool-center-angles"
        [[rotary]]
        letter = "C"
        on = "head"
        axis = [0, 0, 1]
        rapid = 1e4
        acceleration = 100
        [[rotary]]
        letter = "A"
        on = "head"
        axis = [1, 0, 0]
        point = [0, 0, 200]
        rapid = 1e4
        acceleration = 100
    "#;
    let machine = machine::load_text("fork.toml", text).unwrap();
    let (low, far) = (Vec3::new(0.0, 0.0, 5.0), Vec3::new(40.0, 0.0, 80.0));
    let home = |a: f64| {
        let axis = machine.axis_at([a, 0.0, 30.0]);
        let [low, far] = [low, far].map(|tip| Op::Rapid(Pose::new(tip, axis).unwrap()));
        let at = |point: Vec3| {
            let orientation = Orientation::Rotary { degrees: [a, 0.0, 30.0], tool_center: true };
            Action::Rapid(Position { point, orientation })
        };
        let corner = at(Vec3::new(40.0, 0.0, f64::NAN));
        let nc = vec![at(Vec3::new(0.0, 0.0, 5.0)), Action::Home(Axes::Z), corner];
        let end = at(Vec3::new(40.0, 0.0, 80.0));
        rules(&judge(&machine, &source(vec![low, far]), [nc, vec![end]].concat()))
    };
    assert!(home(0.0).is_empty(), "{:?}", home(0.0));
    assert_eq!(home(30.0), ["home"]);
}
