//! Runs SINUMERIK programs for the tests.

use super::records;
use geom::Vec3;
use program::{Cycle, Diagnostic};
use toolpost_control::{
    Action, ArcTo, Dialect, Event, Orientation, Position, Settings, StartModes,
};

/// A machine with A and C and clamps.
pub fn settings() -> Settings {
    let auxiliary = vec![26, 27, 28, 29];
    let rotary = [true, false, true];
    Settings {
        auxiliary,
        operator_parameters: vec![24],
        path_tolerance: 0.1,
        // Start modes have tests of their own.
        start_modes: StartModes::SURE,
        ..Settings::new(Dialect::Sinumerik, rotary)
    }
}

/// What a program does.
pub fn run(text: &str) -> Result<Vec<Event>, Box<Diagnostic>> {
    records(&settings(), "p.mpf", text)
}

/// What these blocks do, with a start that gives feed, tool and place, and an end.
pub fn blocks(text: &str) -> Vec<Action> {
    let program = format!("T1 M6\nG0 X0 Y0 Z100 A0 C0 F500\n{text}\nM30\n");
    let records = run(&program).unwrap_or_else(|error| panic!("{error}\n{program}"));
    records.into_iter().filter(|record| record.line > 2).map(|record| record.action).collect()
}

/// The error that these blocks make, with their first line as line 1.
pub fn error(text: &str) -> Diagnostic {
    let program = format!("T1 M6\nG0 X0 Y0 Z100 A0 C0 F500\n{text}\nM30\n");
    match run(&program) {
        Ok(_) => panic!("no error in\n{text}"),
        Err(error) => Diagnostic { line: error.line.saturating_sub(2), ..*error },
    }
}

/// The poses that blocks move to.
pub fn poses(ops: &[Action]) -> Vec<Position> {
    ops.iter().filter_map(|op| op.position().copied()).collect()
}

/// The points that blocks move to.
pub fn points(text: &str) -> Vec<Vec3> {
    poses(&blocks(text)).iter().map(|pose| pose.point).collect()
}

/// The arcs among the records.
pub fn arcs(text: &str) -> Vec<ArcTo> {
    let arc = |op| if let Action::Arc(arc) = op { Some(*arc) } else { None };
    blocks(text).into_iter().filter_map(arc).collect()
}

/// The holes with the cycle that makes each.
pub fn holes(ops: &[Action]) -> Vec<(Position, Cycle)> {
    let mut active = None;
    let mut holes = Vec::new();
    for op in ops {
        match op {
            Action::Cycle(cycle) => active = Some(**cycle),
            Action::CycleOff => active = None,
            Action::Hole(pose) => holes.push((*pose, active.expect("a cycle is active"))),
            _ => {}
        }
    }
    holes
}

/// Rotary positions of a pose.
pub fn degrees(pose: &Position) -> ([f64; 3], bool) {
    match pose.orientation {
        Orientation::Rotary { degrees, tool_center } => (degrees, tool_center),
        Orientation::Axis(axis) => panic!("an axis {axis}, not rotary positions"),
    }
}

/// Asserts that two points are the same but for rounding.
#[track_caller]
pub fn near(a: Vec3, b: Vec3) {
    assert!(a.distance(b) < 1e-9, "{a} is not {b}");
}

/// A point.
pub fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}
