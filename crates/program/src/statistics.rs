//! What a program amounts to: lengths, extents, tools, counts.

use crate::{ArcTo, Course, Cycle, Op, Pose, Program};
use geom::Vec3;
use serde::Serialize;

/// Totals of a program whose poses are in the work frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Statistics {
    /// Records in all.
    pub records: usize,
    /// Rapid moves.
    pub rapids: usize,
    /// Straight cutting moves.
    pub lines: usize,
    /// Arcs and helices.
    pub arcs: usize,
    /// Holes of cycles.
    pub holes: usize,
    /// Tool numbers in the order of their first use.
    pub tools: Vec<u32>,
    /// Length of the cutting moves, holes included, mm.
    pub cutting_length: f64,
    /// Length of the rapid moves, as straight lines, mm.
    pub rapid_length: f64,
    /// Smallest coordinates of the tool tip, mm; all zero where nothing moves.
    pub low: [f64; 3],
    /// Largest coordinates of the tool tip, mm.
    pub high: [f64; 3],
    /// Whether the tool axis ever differs from +Z of the work frame.
    pub tilted: bool,
}

impl Statistics {
    /// Counts `program`.
    pub fn of(program: &Program) -> Statistics {
        let mut s = Statistics { records: program.records.len(), ..Statistics::default() };
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let mut here: Option<Vec3> = None;
        let mut cycle: Option<Cycle> = None;
        for record in program.each() {
            let from = here;
            if let Some(pose) = record.op.pose() {
                low = low.min(pose.point());
                high = high.max(pose.point());
                here = Some(pose.point());
                s.tilted |= pose.axis().distance_squared(Vec3::Z) > 1e-12;
            }
            let step = |to: &Pose| from.map_or(0.0, |from| from.distance(to.point()));
            let mut arc = |s: &mut Statistics, to: &ArcTo| {
                s.arcs += 1;
                let arc = from.and_then(|from| to.circle.arc(from, to.end.point(), f64::MAX).ok());
                if let Some(arc) = arc {
                    s.cutting_length += arc.length();
                    let (a, b) = arc.extents();
                    low = low.min(a);
                    high = high.max(b);
                }
            };
            match &record.op {
                Op::Rapid(pose) => {
                    s.rapids += 1;
                    s.rapid_length += step(pose);
                }
                Op::Line(pose) => {
                    s.lines += 1;
                    s.cutting_length += step(pose);
                }
                Op::Thread(thread) => {
                    s.lines += 1;
                    s.cutting_length += step(&thread.end);
                }
                Op::Arc(to) => arc(&mut s, to),
                Op::Oriented(to) => {
                    let end = *to.end.pose();
                    match to.course {
                        Course::Rapid => {
                            s.rapids += 1;
                            s.rapid_length += step(&end);
                        }
                        Course::Line => {
                            s.lines += 1;
                            s.cutting_length += step(&end);
                        }
                        Course::Arc(circle) => arc(&mut s, &ArcTo { end, circle }),
                    }
                }
                // How far these get only the machine knows.
                Op::Joints(_) | Op::MachineMove(_) => {
                    s.rapids += 1;
                    here = None;
                }
                Op::Probe(_) => here = None,
                Op::Hole(pose) => {
                    s.holes += 1;
                    if let Some(cycle) = &cycle {
                        let at = |height: f64| pose.point() + pose.axis() * height;
                        let over = from.map_or(0.0, |from| from.distance(at(cycle.clearance)));
                        s.cutting_length += cycle.clearance + cycle.depth;
                        s.rapid_length += over + cycle.retract + cycle.depth;
                        low = low.min(at(-cycle.depth)).min(at(cycle.retract));
                        high = high.max(at(-cycle.depth)).max(at(cycle.retract));
                        here = Some(at(cycle.retract));
                    }
                }
                Op::Cycle(c) => cycle = Some(**c),
                Op::CycleOff => cycle = None,
                Op::Tool(tool) => {
                    if !s.tools.contains(&tool.number) {
                        s.tools.push(tool.number);
                    }
                }
                // These neither move the tool nor say which one it is. The way home, like that into
                // another offset, is the machine's own.
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
        if low.is_finite() && high.is_finite() {
            s.low = low.to_array();
            s.high = high.to_array();
        }
        s
    }

    /// How far the box of all tool tips reaches along the unit vector `direction`, mm from the origin.
    pub fn reach(&self, direction: Vec3) -> f64 {
        geom::reach_of_box(self.low.into(), self.high.into(), direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ArcTo, Circle, CycleKind, Pose};
    use std::f64::consts::PI;

    #[test]
    fn lengths_and_extents_are_those_of_the_path() {
        let at = |x: f64, y: f64, z: f64| Pose::upright(Vec3::new(x, y, z)).unwrap();
        let mut p = Program::new("t");
        p.push(1, Op::Rapid(at(0.0, 0.0, 5.0)));
        p.push(2, Op::Rapid(at(10.0, 0.0, 5.0)));
        p.push(3, Op::Line(at(10.0, 0.0, 0.0)));
        let end = at(-10.0, 0.0, 0.0);
        p.push(
            4,
            Op::Arc(Box::new(ArcTo { end, circle: Circle::new(Vec3::ZERO, Vec3::Z, 0).unwrap() })),
        );
        let cycle = Cycle {
            kind: CycleKind::Drill,
            depth: 8.0,
            clearance: 2.0,
            retract: 5.0,
            feed: None,
            dwell: 0.0,
            first_peck: None,
            peck: None,
        };
        p.push(5, Op::Cycle(Box::new(cycle)));
        p.push(6, Op::Hole(at(-10.0, 0.0, 0.0)));
        let s = Statistics::of(&p);
        assert_eq!((s.rapids, s.lines, s.arcs, s.holes), (2, 1, 1, 1));
        assert!((s.cutting_length - (5.0 + 10.0 * PI + 10.0)).abs() < 1e-9);
        assert!((s.rapid_length - (10.0 + 2.0 + 13.0)).abs() < 1e-9);
        assert_eq!((s.low[2], s.high[0]), (-8.0, 10.0));
        assert!((s.high[1] - 10.0).abs() < 1e-4);
        assert!(!s.tilted);
    }

    #[test]
    fn the_reach_of_a_box_is_that_of_its_farthest_corner() {
        let (low, high) = ([-1.0, -2.0, -3.0], [4.0, 5.0, 6.0]);
        let s = Statistics { low, high, ..Statistics::default() };
        assert_eq!(s.reach(Vec3::Z), 6.0);
        assert_eq!(s.reach(Vec3::NEG_X), 1.0);
        assert!((s.reach(Vec3::new(0.6, 0.0, -0.8)) - 4.8).abs() < 1e-12);
    }
}
