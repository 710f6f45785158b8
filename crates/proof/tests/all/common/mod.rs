//! A machine, a source and faithful events to disturb.

use control::{Action, Event, Orientation, Position};
use geom::Vec3;
use machine::Machine;
use program::*;
use toolpost_proof::{Prover, Report, Tolerances};

/// Three axes, three decimals, `G43 H` with the tool's number.
const MILL: &str = r#"
reader = "fanuc"
[capabilities]
length_offset = "tool-number"
compensation = true
lowering_tolerance = 0.01
[settings]
rapid_path = "linear"
[words]
X = { decimals = 3 }
A = { decimals = 3 }
C = { decimals = 3 }
F = { decimals = 0 }
S = { decimals = 0 }
[orientation]
tolerance = 0.01
"#;

/// A table that turns by C on A, the centre 50 mm below the work zero.
const TABLE: &str = r#"
[[rotary]]
letter = "A"
on = "table"
axis = [1, 0, 0]
point = [0, 0, -50]
sign = -1
rapid = 1e4
acceleration = 100
[[rotary]]
letter = "C"
on = "table"
axis = [0, 0, 1]
point = [0, 0, -50]
sign = -1
rapid = 1e4
acceleration = 100
"#;

pub fn mill() -> Machine {
    machine::load_text("mill.toml", MILL).unwrap()
}

/// The mill with the table.
pub fn five_axes() -> Machine {
    let mill = MILL.replace("[orientation]", "[orientation]\nsimultaneous = \"machine-angles\"");
    machine::load_text("five.toml", &format!("work_zero = [0, 0, 0]\n{mill}{TABLE}")).unwrap()
}

/// The same with these keys at the top, these lines below `[axes]`, and this much travel of A.
pub fn five_axes_within(top: &str, axes: &str, travel: [f64; 2]) -> Machine {
    let mill = MILL.replace("[orientation]", "[orientation]\nsimultaneous = \"machine-angles\"");
    let range = format!("letter = \"A\"\nmin = {}\nmax = {}", travel[0], travel[1]);
    let table = TABLE.replace("letter = \"A\"", &range);
    machine::load_text("five.toml", &format!("{top}\n{mill}\n[axes]\n{axes}\n{table}")).unwrap()
}

pub fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, z)).unwrap()
}

/// What a block of a three-axis program says.
pub fn block(x: f64, y: f64, z: f64) -> Position {
    let orientation = Orientation::Rotary { degrees: [0.0; 3], tool_center: false };
    Position { point: Vec3::new(x, y, z), orientation }
}

/// What a block of a three-axis program says where the source says this.
pub fn action(op: &Op) -> Action {
    let says = |pose: &Pose| {
        assert_eq!(pose.axis(), Vec3::Z, "no pose of three axes");
        let point = pose.point();
        block(point.x, point.y, point.z)
    };
    match op {
        Op::Rapid(pose) => Action::Rapid(says(pose)),
        Op::Line(pose) => Action::Line(says(pose)),
        Op::Hole(pose) => Action::Hole(says(pose)),
        Op::Arc(to) => {
            let (center, normal, turns) =
                (to.circle.center(), to.circle.normal(), to.circle.turns());
            Action::Arc(Box::new(control::ArcTo { end: says(&to.end), center, normal, turns }))
        }
        Op::Cycle(cycle) => Action::Cycle(cycle.clone()),
        Op::Feed(feed) => Action::Feed(*feed),
        Op::Spindle(spindle) => Action::Spindle(*spindle),
        Op::Coolant(coolant) => Action::Coolant(*coolant),
        Op::Compensation(side) => Action::Compensation(*side),
        Op::Tool(tool) => Action::Tool(tool.clone()),
        Op::Dwell(seconds) => Action::Dwell(*seconds),
        Op::Stop => Action::Stop,
        op => panic!("no test has {op:?} on both sides"),
    }
}

/// The same of several.
pub fn actions(ops: &[Op]) -> Vec<Action> {
    ops.iter().map(action).collect()
}

pub fn arc(end: Pose, center: (f64, f64, f64), normal: Vec3) -> Box<ArcTo> {
    Box::new(ArcTo { end, circle: Circle::new(center.into(), normal, 0).unwrap() })
}

/// The same as a control reports it.
pub fn arc_block(end: Position, center: (f64, f64, f64), normal: Vec3) -> Box<control::ArcTo> {
    Box::new(control::ArcTo { end, center: center.into(), normal, turns: 0 })
}

pub fn tool(number: u32) -> Box<Tool> {
    Box::new(Tool { number, ..Tool::default() })
}

pub fn drill() -> Cycle {
    Cycle {
        kind: CycleKind::Drill,
        depth: 10.0,
        clearance: 2.0,
        retract: 20.0,
        feed: Some(Feed::PerMinute(120.0)),
        dwell: 0.0,
        first_peck: None,
        peck: None,
    }
}

pub fn cycle(cycle: Cycle) -> Action {
    Action::Cycle(Box::new(cycle))
}

pub fn program(ops: Vec<Op>) -> Program {
    let mut program = Program::new("test");
    for (line, op) in (1..).zip(ops) {
        program.push(line, op);
    }
    program
}

/// Tool 1 at 1000 1/min with flood and 300 mm/min.
pub fn start() -> Vec<Op> {
    vec![
        Op::Tool(tool(1)),
        Op::Spindle(Spindle::Clockwise(1000.0)),
        Op::Coolant(Coolant::Flood),
        Op::Feed(Feed::PerMinute(300.0)),
    ]
}

/// The same in a program, with what only a program says.
pub fn nc_start() -> Vec<Action> {
    let mut does = vec![Action::WorkOffset(WorkOffset::FIRST)];
    does.extend(actions(&start()));
    does.push(Action::LengthOffset(Some(1)));
    does
}

/// What the end of a program switches on a control that switches off by itself.
pub fn end() -> Vec<Action> {
    vec![Action::Spindle(Spindle::Off), Action::Coolant(Coolant::Off), Action::End]
}

/// A source of these motions, after the start.
pub fn source(motions: Vec<Op>) -> Program {
    program([start(), motions].concat())
}

/// The report on a program that begins and ends well and does this between.
pub fn judge(machine: &Machine, source: &Program, between: Vec<Action>) -> Report {
    run(machine, source, [nc_start(), between, vec![Action::Home(Axes::Z)], end()].concat())
}

/// The report on a control that does this, on line 1, 2 ...
pub fn run(machine: &Machine, source: &Program, does: Vec<Action>) -> Report {
    let mut prover = Prover::new(source, machine, &Tolerances::default());
    for (line, action) in (1..).zip(does) {
        if prover.event(&Event { line, action }).is_err() {
            break;
        }
    }
    prover.finish()
}

/// The rules that a report names.
pub fn rules(report: &Report) -> Vec<&'static str> {
    assert_eq!(report.proven, report.mismatches.is_empty());
    report.mismatches.iter().map(|found| found.rule.name()).collect()
}

#[track_caller]
pub fn proven(report: &Report) {
    let found: Vec<String> = report.mismatches.iter().map(ToString::to_string).collect();
    assert!(report.proven, "{found:#?}");
}
