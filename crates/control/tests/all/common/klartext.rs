//! Runs Klartext programs for the tests.

use super::records;
use geom::Vec3;
use program::{Cycle, Diagnostic};
use std::path::Path;
use toolpost_control::{
    Action, ArcTo, Dialect, Event, Orientation, Position, Settings, Setup, ToolData,
};

pub const FIVE_AXES: [bool; 3] = [false, true, true];

pub fn run_on(rotary: [bool; 3], unit: &str, blocks: &str) -> Result<Vec<Event>, Box<Diagnostic>> {
    read_on(rotary, program("T", unit, blocks).as_bytes())
}

/// A program of these blocks, which are numbered here; a line that begins with a blank goes on with
/// the block before it.
pub fn program(name: &str, unit: &str, blocks: &str) -> String {
    let mut text = format!("0 BEGIN PGM {name} {unit}\n");
    let mut number = 1;
    for block in blocks.lines().filter(|block| !block.is_empty()) {
        if block.starts_with(' ') {
            text += &format!("{block}\n");
        } else {
            text += &format!("{number} {block}\n");
            number += 1;
        }
    }
    text + &format!("{number} END PGM {name} {unit}\n")
}

/// Runs blocks where tool 5 has this radius.
pub fn run_with_radius(radius: f64, blocks: &str) -> Vec<Action> {
    let tool = ToolData { number: 5, name: "MILL".into(), radius, length: 100.0 };
    let setup = Setup { tools: vec![tool], ..Setup::default() };
    let text = program("T", "MM", blocks);
    let records = read_with(setup, [false; 3], text.as_bytes());
    records
        .unwrap_or_else(|error| panic!("{error}"))
        .into_iter()
        .map(|record| record.action)
        .collect()
}

/// Runs a program that may call those of a folder.
pub fn run_in(folder: &Path, blocks: &str) -> Result<Vec<Event>, Box<Diagnostic>> {
    let setup = Setup { folders: vec![folder.into()].into(), ..Setup::default() };
    read_with(setup, [false; 3], program("T", "MM", blocks).as_bytes())
}

pub fn assert_near(found: &[[f64; 3]], expected: &[[f64; 3]]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!(Vec3::from(*a).distance(Vec3::from(*b)) < 1e-6, "{found:?} {expected:?}");
    }
}

pub fn read_on(rotary: [bool; 3], text: &[u8]) -> Result<Vec<Event>, Box<Diagnostic>> {
    read_with(Setup::default(), rotary, text)
}

pub fn read_with(
    setup: Setup,
    rotary: [bool; 3],
    text: &[u8],
) -> Result<Vec<Event>, Box<Diagnostic>> {
    let auxiliary = vec![60];
    let settings = Settings { auxiliary, setup, ..Settings::new(Dialect::Klartext, rotary) };
    records(&settings, "t.h", text)
}

pub fn run(blocks: &str) -> Vec<Action> {
    run_on([false; 3], "MM", blocks).unwrap().into_iter().map(|record| record.action).collect()
}

pub fn run_five(blocks: &str) -> Vec<Action> {
    run_on(FIVE_AXES, "MM", blocks).unwrap().into_iter().map(|record| record.action).collect()
}

pub fn refused(blocks: &str) -> Box<Diagnostic> {
    run_on([false; 3], "MM", blocks).unwrap_err()
}

pub fn refused_five(blocks: &str) -> Box<Diagnostic> {
    run_on(FIVE_AXES, "MM", blocks).unwrap_err()
}

pub fn upright(x: f64, y: f64, z: f64) -> Position {
    let orientation = Orientation::Rotary { degrees: [0.0; 3], tool_center: false };
    Position { point: Vec3::new(x, y, z), orientation }
}

pub fn poses(ops: &[Action]) -> Vec<Position> {
    ops.iter().filter_map(|op| op.position().copied()).collect()
}

pub fn points(ops: &[Action]) -> Vec<[f64; 3]> {
    poses(ops).iter().map(|pose| pose.point.to_array()).collect()
}

pub fn arcs(ops: &[Action]) -> Vec<ArcTo> {
    ops.iter()
        .filter_map(|op| match op {
            Action::Arc(arc) => Some(**arc),
            _ => None,
        })
        .collect()
}

pub fn cycles(ops: &[Action]) -> Vec<Cycle> {
    ops.iter()
        .filter_map(|op| match op {
            Action::Cycle(cycle) => Some(**cycle),
            _ => None,
        })
        .collect()
}

/// To a known place, with the spindle turning.
pub const START: &str = "TOOL CALL 5 Z S3000 F500\nL X+0 Y+0 Z+50 R0 FMAX M3\n";
