//! A program as straight segments with what draws them, in the order of the program.

use geom::Vec3;
use program::{ArcTo, Course, Cycle, Op, Program, Tool};
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
/// before it calls one. No move leads to the first pose.
pub fn walk(program: &Program, tolerance: f64, draw: &mut dyn FnMut(Segment)) -> Vec<String> {
    let mut names = vec![String::from("TOOL WITHOUT A CALL")];
    let mut calls = BTreeMap::new();
    let mut here: Option<Vec3> = None;
    let mut cycle: Option<Cycle> = None;
    let mut tool = 0;
    for record in program.each() {
        let before = here;
        let mut step = |cuts: bool, hole: bool, to: Vec3, axis: Vec3| {
            if let Some(from) = here {
                draw(Segment { cuts, tool, from, to, axis, length: from.distance(to), hole });
            }
            here = Some(to);
        };
        match &record.op {
            Op::Rapid(pose) => step(false, false, pose.point(), pose.axis()),
            Op::Line(pose) => step(true, false, pose.point(), pose.axis()),
            Op::Thread(thread) => step(true, false, thread.end.point(), thread.end.axis()),
            Op::Probe(probe) => {
                step(false, false, probe.end.point(), probe.end.axis());
                here = None;
            }
            Op::Hole(pose) => {
                if let Some(cycle) = cycle {
                    let axis = pose.axis();
                    let at = |height: f64| pose.point() + axis * height;
                    // Across at the height of the tool, then down.
                    let height = before.map_or(f64::NAN, |here| (here - pose.point()).dot(axis));
                    if height > cycle.clearance {
                        step(false, false, at(height), axis);
                    }
                    step(false, false, at(cycle.clearance), axis);
                    step(true, true, at(-cycle.depth), axis);
                    step(false, false, at(cycle.retract), axis);
                }
            }
            Op::Arc(to) => {
                curve(here, to, tolerance, tool, draw);
                here = Some(to.end.point());
            }
            Op::Oriented(to) => {
                let end = *to.end.pose();
                match to.course {
                    Course::Rapid => step(false, false, end.point(), end.axis()),
                    Course::Line => step(true, false, end.point(), end.axis()),
                    Course::Arc(circle) => {
                        curve(here, &ArcTo { end, circle }, tolerance, tool, draw);
                        here = Some(end.point());
                    }
                }
            }
            // The move to it is not known.
            Op::Joints(_) | Op::MachineMove(_) => here = None,
            Op::Cycle(c) => cycle = Some(**c),
            Op::CycleOff => cycle = None,
            Op::Tool(called) => {
                let name = name(called);
                tool = *calls.entry(name.clone()).or_insert(names.len());
                if tool == names.len() {
                    names.push(name);
                }
            }
            // These draw nothing.
            Op::Home
            | Op::Feed(_)
            | Op::PathMode(_)
            | Op::Spindle(_)
            | Op::SurfaceSpeed(_)
            | Op::Coolant(_)
            | Op::Beam(_)
            | Op::Pulses(_)
            | Op::Preselect(_)
            | Op::Compensation(_)
            | Op::Frame(_)
            | Op::WorkOffset(_)
            | Op::WorkOffsetData(_)
            | Op::Surface(_)
            | Op::Clamp(_)
            | Op::Output(_)
            | Op::Input(_)
            | Op::Auxiliary(_)
            | Op::ThreadWire
            | Op::CutWire
            | Op::Taper(_)
            | Op::Dwell(_)
            | Op::Stop
            | Op::OptionalStop
            | Op::Operation(_)
            | Op::EndOfOperation
            | Op::Comment(_)
            | Op::Message(_)
            | Op::End => {}
        }
    }
    names
}

/// Hands the chords of an arc from `here` to `draw`; none where no arc leads from there.
fn curve(
    here: Option<Vec3>,
    to: &ArcTo,
    tolerance: f64,
    tool: usize,
    draw: &mut dyn FnMut(Segment),
) {
    let end = to.end.point();
    let arc = here.and_then(|from| to.circle.arc(from, end, f64::MAX).ok());
    let Some(arc) = arc else { return };
    let (axis, length) = (to.end.axis(), arc.length() / arc.chords(tolerance) as f64);
    let mut from = arc.start;
    for to in arc.flatten(tolerance) {
        draw(Segment { cuts: true, tool, from, to, axis, length, hole: false });
        from = to;
    }
}
