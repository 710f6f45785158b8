//! A program as straight segments with what draws them, in the order of the program.

use geom::{Arc, Vec3};
use program::{Cycle, Op, Pose, Program, Tool};
use std::collections::BTreeMap;

/// A straight piece of the path.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Whether material is cut; otherwise it is a rapid.
    pub cuts: bool,
    /// Index of the tool in the answer of [`walk`].
    pub tool: usize,
    /// Where it begins, mm.
    pub from: Vec3,
    /// Where it ends, mm.
    pub to: Vec3,
    /// Tool axis at the end.
    pub axis: Vec3,
    /// Length of the path it stands for, mm; for a chord its share of the arc.
    pub length: f64,
    /// Whether it is the feed into a hole.
    pub hole: bool,
}

/// What a tool is called: `T3 Ø10 BALL MILL`.
fn name(tool: &Tool) -> String {
    let number = (tool.number > 0).then(|| format!("T{}", tool.number));
    let diameter = tool.diameter.map(|d| format!("Ø{}", round(d)));
    let name = (!tool.name.is_empty()).then(|| tool.name.clone());
    let words: Vec<String> = [number, diameter, name].into_iter().flatten().collect();
    words.join(" ")
}

/// Three decimals at most.
fn round(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

/// Hands every segment of `program` to `draw`, arcs as chords within `tolerance` mm, and answers the
/// names of the tools in the order of their first calls; the first is that of a program that cuts
/// before it calls one. A coordinate that is not a number breaks the path; the first pose has no way
/// to it.
pub fn walk(program: &Program, tolerance: f64, draw: &mut dyn FnMut(Segment)) -> Vec<String> {
    let mut names = vec![String::from("TOOL WITHOUT A CALL")];
    let mut calls = BTreeMap::new();
    let mut here: Option<Vec3> = None;
    let mut cycle: Option<Cycle> = None;
    let mut tool = 0;
    for record in &program.records {
        let before = here;
        let mut step = |cuts: bool, hole: bool, pose: &Pose| {
            let to = pose.point;
            let axis = pose.axis().unwrap_or(Vec3::Z);
            if let Some(from) = here.filter(|from| from.is_finite() && to.is_finite()) {
                draw(Segment { cuts, tool, from, to, axis, length: from.distance(to), hole });
            }
            here = Some(to);
        };
        match &record.op {
            Op::Rapid(pose) => step(false, false, pose),
            Op::Line(pose) => step(true, false, pose),
            Op::Thread(thread) => step(true, false, &thread.end),
            Op::Probe(probe) => {
                step(false, false, &probe.end);
                here = None;
            }
            Op::Hole(pose) => {
                if let (Some(cycle), Some(axis)) = (cycle, pose.axis()) {
                    let at = |height: f64| Pose::new(pose.point + axis * height, axis);
                    // Across at the height of the tool, then down.
                    let height = before.map_or(f64::NAN, |here| (here - pose.point).dot(axis));
                    if height > cycle.clearance {
                        step(false, false, &at(height));
                    }
                    step(false, false, &at(cycle.clearance));
                    step(true, true, &at(-cycle.depth));
                    step(false, false, &at(cycle.retract));
                }
            }
            Op::Arc(to) => {
                let axis = to.end.axis().unwrap_or(Vec3::Z);
                let arc = here.and_then(|from| {
                    Arc::new(from, to.end.point, to.center, to.normal, to.turns, f64::MAX).ok()
                });
                if let Some(arc) = arc {
                    let length = arc.length() / arc.chords(tolerance) as f64;
                    let mut from = arc.start;
                    for to in arc.flatten(tolerance) {
                        draw(Segment { cuts: true, tool, from, to, axis, length, hole: false });
                        from = to;
                    }
                }
                here = Some(to.end.point);
            }
            Op::Cycle(c) => cycle = Some(**c),
            Op::CycleOff => cycle = None,
            Op::Tool(called) => {
                let name = name(called);
                tool = *calls.entry(name.clone()).or_insert(names.len());
                if tool == names.len() {
                    names.push(name);
                }
            }
            _ => {}
        }
    }
    names
}
