//! The ways of the wire as a neutral program: as they are, or as points.

use geom::{Vec2, Vec3};
use program::{ArcTo, Feed, Op, Pose, Program};
use wire::points::Points;
use wire::{Contour, Element, Path};

/// A way of the wire without a break.
pub struct Leg {
    /// Where the wire goes.
    pub path: Path,
    /// The same as points, where the control takes those.
    pub points: Option<Points>,
}

/// Which end of the wire.
#[derive(Clone, Copy, Debug)]
pub enum End {
    Lower,
    Upper,
}

impl Leg {
    /// The line of the source where it begins.
    pub fn line(&self) -> u32 {
        self.path.lower().elements().first().map_or(0, |element| element.line)
    }

    /// Whether the wire leans anywhere.
    pub fn leans(&self) -> bool {
        self.path.upper().is_some()
    }

    /// The contour that one end follows.
    pub fn contour(&self, end: End) -> &Contour {
        match end {
            End::Lower => self.path.lower(),
            End::Upper => self.path.upper().unwrap_or(self.path.lower()),
        }
    }
}

/// The program of `legs`, each an opening of its own: as points where they have them, else with
/// their arcs. Leaning wires reach the upper contour at `height` mm.
pub fn program(name: &str, legs: &[Leg], height: f64, feed: Option<f64>) -> Program {
    let each = |leg: &Leg, program: &mut Program| match &leg.points {
        Some(points) => divided(program, points, leg.line(), height),
        None => exact(program, leg.path.lower()),
    };
    assemble(name, legs, feed, each)
}

/// The same with every arc, as one end of the wire goes.
pub fn end(name: &str, legs: &[Leg], end: End, feed: Option<f64>) -> Program {
    assemble(name, legs, feed, |leg, program| exact(program, leg.contour(end)))
}

fn assemble(
    name: &str,
    legs: &[Leg],
    feed: Option<f64>,
    each: impl Fn(&Leg, &mut Program),
) -> Program {
    let mut program = Program::new(name);
    if let Some(feed) = feed {
        program.push(0, Op::Feed(Feed::PerMinute(feed)));
    }
    for leg in legs {
        each(leg, &mut program);
        let last = program.records.last().map_or(0, |record| record.line);
        program.push(last, Op::CutWire);
    }
    let last = program.records.last().map_or(0, |record| record.line);
    program.push(last, Op::End);
    program
}

fn begin(program: &mut Program, line: u32, start: Pose) {
    program.push(line, Op::Rapid(start));
    program.push(line, Op::ThreadWire);
}

fn exact(program: &mut Program, contour: &Contour) {
    let line = contour.elements().first().map_or(0, |element| element.line);
    begin(program, line, upright(contour.start()));
    for element in contour.elements() {
        program.push(element.line, op(element));
    }
}

fn op(element: &Element) -> Op {
    let end = upright(element.end);
    match element.turn {
        None => Op::Line(end),
        Some(turn) => {
            let normal = Vec3::Z * turn.sweep.signum();
            Op::Arc(Box::new(ArcTo { end, center: turn.center.extend(0.0), normal, turns: 0 }))
        }
    }
}

fn divided(program: &mut Program, points: &Points, first: u32, height: f64) {
    let pose = |i: usize, lower: Vec2| {
        let lean = points.upper.get(i).map_or(Vec2::ZERO, |upper| *upper - lower);
        match lean == Vec2::ZERO {
            true => upright(lower),
            false => Pose::new(lower.extend(0.0), lean.extend(height).normalize()),
        }
    };
    let mut poses = points.lower.iter().enumerate().map(|(i, lower)| pose(i, *lower));
    if let Some(start) = poses.next() {
        begin(program, first, start);
    }
    for (i, pose) in (1..).zip(poses) {
        program.push(points.line_of(i).unwrap_or(first), Op::Line(pose));
    }
}

fn upright(point: Vec2) -> Pose {
    Pose::new(point.extend(0.0), Vec3::Z)
}
