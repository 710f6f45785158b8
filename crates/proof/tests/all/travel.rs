//! The travel of the axes, in machine space: at the end of each block and on its way, in every kind of coordinates.
//!
//! The table of these tests turns by C on A, about points 50 mm below the work zero. A work zero that stands 50 mm above
//! the axis of A stands, with A at 90°, 50 mm from it along +Y, at the height of the axis: Y +50, Z -50.

use crate::common::*;
use control::{Action, Orientation, Position, TiltChoice};
use geom::Vec3;
use machine::Machine;
use machine::limits::Travel;
use program::*;

const ZERO: &str = "work_zero = [0, 0, 0]";
const WIDE: [f64; 2] = [-110.0, 110.0];

fn axes(letter: char, min: f64, max: f64) -> String {
    format!("{letter} = {{ min = {min}, max = {max}, rapid = 9000, acceleration = 3 }}")
}

/// Positions of the axes, tool-centre control, and the tool axis alone: a vector, or a tilted plane.
fn notations(machine: &Machine, tip: Vec3, a: f64, c: f64) -> [Position; 3] {
    let degrees = [a, 0.0, c];
    let says = |point, tool_center| Position {
        point,
        orientation: Orientation::Rotary { degrees, tool_center },
    };
    let linear = machine.linear_for(tip, degrees, 0.0);
    [says(linear, false), says(tip, true), Position::new(tip, machine.axis_at(degrees))]
}

/// The rules for a program that turns to A and C by words and goes to a tip in one notation, the tool 100 mm long where
/// it is `measured`.
fn judged(machine: &Machine, tip: Vec3, a: f64, c: f64, notation: usize) -> Vec<&'static str> {
    let pose = Pose::new(tip, machine.axis_at([a, 0.0, c])).unwrap();
    let home = Position {
        point: Vec3::NAN,
        orientation: Orientation::Rotary { degrees: [a, 0.0, c], tool_center: false },
    };
    let does = vec![
        Action::Home(Axes::Z),
        Action::Rapid(home),
        Action::Rapid(notations(machine, tip, a, c)[notation]),
    ];
    rules(&judge(machine, &source(vec![Op::Rapid(pose)]), does))
}

#[test]
fn a_slide_that_a_turned_table_takes_beyond_its_travel_is_refused_in_every_notation() {
    for notation in 0..3 {
        for (most, expected) in [(50.1, &[][..]), (49.9, &["axis-limit"])] {
            let machine = five_axes_within(ZERO, &axes('Y', -400.0, most), WIDE);
            let found = judged(&machine, Vec3::ZERO, 90.0, 0.0, notation);
            assert_eq!(found, expected, "notation {notation}, Y to {most}");
        }
        // The tool is not measured: nobody knows how low the slide of Z is, and how high it is at least.
        let low = five_axes_within(ZERO, &axes('Z', -49.0, 400.0), WIDE);
        assert!(judged(&low, Vec3::ZERO, 90.0, 0.0, notation).is_empty());
        let high = five_axes_within(ZERO, &axes('Z', -400.0, -51.0), WIDE);
        assert_eq!(judged(&high, Vec3::ZERO, 90.0, 0.0, notation), ["axis-limit"]);
    }
}

#[test]
fn the_length_of_the_tool_lifts_the_slide_of_z() {
    let machine = five_axes_within(ZERO, &axes('Z', -400.0, 49.0), WIDE);
    let tool = |length| Op::Tool(Box::new(Tool { number: 1, length, ..Tool::default() }));
    for (length, expected) in [(Some(98.9), &[][..]), (Some(99.1), &["axis-limit"])] {
        let pose = Pose::new(Vec3::ZERO, machine.axis_at([90.0, 0.0, 0.0])).unwrap();
        let mut all = start();
        all[0] = tool(length);
        all.push(Op::Rapid(pose));
        let [own, ..] = notations(&machine, Vec3::ZERO, 90.0, 0.0);
        let turned = Action::Rapid(Position { point: Vec3::NAN, ..own });
        let does = vec![Action::Home(Axes::Z), turned, Action::Rapid(own)];
        let report = judge(&machine, &program(all), does);
        assert_eq!(rules(&report), expected);
        assert!(report.travel.unsaid.is_empty());
    }
}

#[test]
fn a_rotary_axis_beyond_its_travel_is_refused_in_every_notation() {
    let machine = five_axes_within(ZERO, "", [-110.0, 80.0]);
    for notation in 0..2 {
        assert_eq!(judged(&machine, Vec3::ZERO, 90.0, 0.0, notation), ["axis-limit"; 1]);
        assert!(judged(&machine, Vec3::ZERO, -90.0, 0.0, notation).is_empty());
    }
}

/// A plane that is turned over, on a table that tilts by 110° (issue 14: `J180.`).
#[test]
fn a_tilted_plane_that_no_solution_reaches_is_refused() {
    let machine = five_axes_within(ZERO, "", WIDE);
    for (a, expected) in [(100.0, &[][..]), (120.0, &["axis-limit"]), (180.0, &["axis-limit"])] {
        let (tip, axis) = (Vec3::ZERO, machine.axis_at([a, 0.0, 30.0]));
        let source = source(vec![Op::Rapid(Pose::new(tip, axis).unwrap())]);
        let does = vec![
            Action::Home(Axes::Z),
            Action::Swivel(TiltChoice::ShorterWithin),
            Action::Rapid(Position::new(tip, axis)),
        ];
        assert_eq!(rules(&judge(&machine, &source, does)), expected, "A {a}");
    }
}

/// With A at -90° (and C half a turn on) the slide of Y stands at -50, where it stands at +50 with A at 90°.
#[test]
fn every_solution_of_a_tilted_plane_has_to_be_within_the_travel_of_the_slides() {
    let (tip, a) = (Vec3::ZERO, 90.0);
    let judged = |y: [f64; 2], travel: [f64; 2]| {
        let machine = five_axes_within(ZERO, &axes('Y', y[0], y[1]), travel);
        let axis = machine.axis_at([a, 0.0, 0.0]);
        let source = source(vec![Op::Rapid(Pose::new(tip, axis).unwrap())]);
        let does = vec![
            Action::Home(Axes::Z),
            Action::Swivel(TiltChoice::ShorterWithin),
            Action::Rapid(Position::new(tip, axis)),
        ];
        rules(&judge(&machine, &source, does))
    };
    assert!(judged([-51.0, 51.0], WIDE).is_empty());
    assert_eq!(judged([-49.0, 51.0], WIDE), ["axis-limit"]);
    assert_eq!(judged([-51.0, 49.0], WIDE), ["axis-limit"]);
    // A table that tilts one way alone leaves the control no choice.
    assert!(judged([-49.0, 51.0], [-30.0, 110.0]).is_empty());
}

/// C turns a tip on +X by half a turn, in blocks of tool-centre control and of vectors: the slides go round by ±Y 80.
#[test]
fn a_way_that_leaves_the_travel_between_its_ends_is_refused() {
    let judged = |y: f64| {
        let machine = five_axes_within(ZERO, &axes('Y', -y, y), WIDE);
        let (from, to) = (Vec3::new(80.0, 0.0, 0.0), Vec3::new(80.0, 0.0, 10.0));
        let pose = |tip| Pose::new(tip, Vec3::Z).unwrap();
        let source = source(vec![Op::Rapid(pose(from)), Op::Line(pose(to))]);
        let says = |point, c| Position {
            point,
            orientation: Orientation::Rotary { degrees: [0.0, 0.0, c], tool_center: true },
        };
        let does = vec![Action::Rapid(says(from, 0.0)), Action::Line(says(to, 170.0))];
        rules(&judge(&machine, &source, does))
    };
    assert!(judged(81.0).is_empty());
    assert_eq!(judged(79.0), ["axis-limit"]);
}

/// The fork head of the library under `TRAORI`: C travels from -225° to 225°. The axes follow each vector from where they
/// stand: round a cone by 60° at a time to C 180, 240; and past the pole at 1°, from C 170 by half a turn either way, as the
/// pole lies to the left or to the right.
#[test]
fn a_rotary_axis_follows_vectors_on_and_on_to_the_end_of_its_travel() {
    let file = "extends = \"sinumerik-840d-traori\"\ntools.turns_upright = true\n";
    let machine = machine::load_text("own.toml", file).unwrap();
    let judged = |start: f64, vectors: &[[f64; 2]]| {
        let axis = |[a, c]: [f64; 2]| machine.axis_at([a, 0.0, c]);
        let tip = |i: usize| Vec3::new(10.0 * i as f64, 0.0, 0.0);
        let leaning = axis([20.0, start]);
        // From home to far above all cuts, and down along the tool.
        let above = tip(0) + leaning * 200.0;
        let places = [above, tip(0)];
        let mut ops = places.map(|tip| Op::Rapid(Pose::new(tip, leaning).unwrap())).to_vec();
        let home = Position {
            point: Vec3::NAN,
            orientation: Orientation::Rotary { degrees: [20.0, 0.0, start], tool_center: false },
        };
        let mut does = vec![Action::Home(Axes::Z), Action::Rapid(home)];
        does.extend(places.map(|tip| Action::Rapid(Position::new(tip, leaning))));
        for (i, at) in (1..).zip(vectors) {
            ops.push(Op::Line(Pose::new(tip(i), axis(*at)).unwrap()));
            does.push(Action::Line(Position::new(tip(i), axis(*at))));
        }
        // Out along the tool before Z goes home.
        let last = vectors.last().map_or(leaning, |at| axis(*at));
        does.push(Action::Rapid(Position::new(tip(vectors.len()) + last * 200.0, last)));
        rules(&judge(&machine, &source(ops), does))
    };
    let round: Vec<[f64; 2]> = (1..=7).map(|i| [20.0, 60.0 * f64::from(i)]).collect();
    assert!(judged(0.0, &round[..3]).is_empty());
    assert_eq!(judged(0.0, &round[..4]), ["axis-limit"]);
    assert!(judged(-210.0, &[[20.0, -150.0], [20.0, -90.0], [20.0, 210.0]]).is_empty());
    // 20° before the pole and 20° behind it, 5.3° aside of the diameter: on the great circle 0.95° from the pole.
    // So near that the control leads it through the pole.
    assert_eq!(judged(170.0, &[[20.0, 344.7]]), ["pole-way", "axis-limit"]);
    assert_eq!(judged(170.0, &[[20.0, -4.7]]), ["pole-way"]);
    // 12° aside of the diameter it passes at 2.1°, and the axes follow; straight through, C stands.
    assert_eq!(judged(170.0, &[[20.0, 338.0]]), ["axis-limit"]);
    assert!(judged(170.0, &[[20.0, 2.0]]).is_empty());
    assert!(judged(170.0, &[[20.0, 350.0]]).is_empty());
}

/// From A 60 and C -60 to C 60 with the tip near the work zero, 50 mm above the axis of A: by positions of the axes A keeps
/// its 60 degrees, and Y stands near 50 sin 60° = 43.3; along a vector A goes down to atan(tan 60° cos 60°) = 40.9°, and Y to
/// 50 sin 40.9° = 32.7.
#[test]
fn the_slides_follow_the_great_circle_of_a_vector_within_their_travel() {
    let judged = |least: f64, notation: usize| {
        let machine = five_axes_within(ZERO, &axes('Y', least, 400.0), WIDE);
        let tips = [Vec3::ZERO, Vec3::new(0.0, 0.0, -1.0)];
        let turns = [-60.0, 60.0];
        let home = Position {
            point: Vec3::NAN,
            orientation: Orientation::Rotary { degrees: [60.0, 0.0, -60.0], tool_center: false },
        };
        let places = [0, 1].map(|i| notations(&machine, tips[i], 60.0, turns[i])[notation]);
        let axis = |i: usize| machine.axis_at([60.0, 0.0, turns[i]]);
        let poses = [0, 1].map(|i| Pose::new(tips[i], axis(i)).unwrap());
        let does = vec![
            Action::Home(Axes::Z),
            Action::Rapid(home),
            Action::Rapid(places[0]),
            Action::Rapid(places[1]),
        ];
        let found = rules(&judge(&machine, &source(poses.map(Op::Rapid).to_vec()), does));
        found.contains(&"axis-limit")
    };
    for (notation, least, expected) in
        [(1, 40.0, false), (1, 43.0, true), (2, 40.0, true), (2, 32.0, false)]
    {
        assert_eq!(judged(least, notation), expected, "notation {notation}, Y from {least}");
    }
}

#[test]
fn an_arc_and_a_hole_are_within_the_travel_where_their_ends_are_not_all() {
    let arcs = |x: f64| {
        let mut machine = mill();
        machine.work_zero = Some(Vec3::ZERO);
        machine.linear[0].max = x;
        let (from, to) = (at(0.0, -10.0, 0.0), at(0.0, 10.0, 0.0));
        let source = source(vec![Op::Rapid(from), Op::Arc(arc(to, (0.0, 0.0, 0.0), Vec3::Z))]);
        let to = block(0.0, 10.0, 0.0);
        let does = vec![
            Action::Rapid(block(0.0, -10.0, 0.0)),
            Action::Arc(arc_block(to, (0.0, 0.0, 0.0), Vec3::Z)),
        ];
        rules(&judge(&machine, &source, does))
    };
    assert!(arcs(10.0).is_empty());
    assert_eq!(arcs(9.9), ["axis-limit"]);
    let holes = |z: f64| {
        let mut machine = mill();
        machine.work_zero = Some(Vec3::ZERO);
        machine.linear[2].min = z;
        let mut all = start();
        all[0] = Op::Tool(Box::new(Tool { number: 1, length: Some(100.0), ..Tool::default() }));
        all.extend([
            Op::Rapid(at(0.0, 0.0, 20.0)),
            Op::Cycle(Box::new(drill())),
            Op::Hole(at(5.0, 0.0, 0.0)),
        ]);
        let does = vec![
            Action::Rapid(block(0.0, 0.0, 20.0)),
            cycle(drill()),
            Action::Hole(block(5.0, 0.0, 0.0)),
            Action::CycleOff,
        ];
        rules(&judge(&machine, &program(all), does))
    };
    assert!(holes(90.0).is_empty());
    assert_eq!(holes(90.1), ["axis-limit"]);
}

#[test]
fn without_a_work_zero_the_length_of_each_travel_is_checked_and_the_report_says_so() {
    let judged = |most: f64| {
        let mut machine = mill();
        machine.linear[0] = machine::LinearAxis { min: 0.0, max: most, ..machine.linear[0] };
        let source = source(vec![Op::Rapid(at(-30.0, 0.0, 0.0)), Op::Line(at(30.0, 0.0, 0.0))]);
        let does = vec![Action::Rapid(block(-30.0, 0.0, 0.0)), Action::Line(block(30.0, 0.0, 0.0))];
        judge(&machine, &source, does)
    };
    let report = judged(60.0);
    assert!(report.proven, "{:?}", report.mismatches);
    assert_eq!(report.travel.linear, Travel::Lengths);
    assert_eq!(rules(&judged(59.9)), ["axis-limit"]);
    // Of a turned table without a work zero no position is known.
    let machine = five_axes_within("", &axes('Y', -49.0, 49.0), WIDE);
    let pose = Pose::new(Vec3::ZERO, machine.axis_at([90.0, 0.0, 0.0])).unwrap();
    let [_, centre, _] = notations(&machine, Vec3::ZERO, 90.0, 0.0);
    let report = judge(&machine, &source(vec![Op::Rapid(pose)]), vec![Action::Rapid(centre)]);
    assert!(report.proven, "{:?}", report.mismatches);
    assert_eq!(report.travel.unsaid, [machine::Unsaid::WorkZero]);
}
