//! How far the cuts of a program reach.

use crate::{Cycle, Op, Pose, Program};
use geom::Vec3;

/// The smallest box, its sides parallel to the axes of the work frame, that holds everything that a program cuts.
///
/// A tool that is beyond it along its own axis touches nothing that has been cut, nor anything that is still to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutBox {
    /// Smallest coordinates, mm; above the largest where nothing is cut.
    low: Vec3,
    /// Largest coordinates, mm.
    high: Vec3,
}

impl CutBox {
    /// The box of `program`, whose poses are in the work frame. A cut along the tool axis cuts at its lower end:
    /// the tool comes to it through the air, or leaves it through what it has cut.
    pub fn of(program: &Program) -> CutBox {
        let mut all = CutBox { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };
        let mut here: Option<Pose> = None;
        let mut cycle: Option<&Cycle> = None;
        for record in &program.records {
            let from = here;
            if let Some(pose) = record.op.pose() {
                here = Some(*pose);
            }
            match &record.op {
                Op::Line(to) => all.line(from, to),
                Op::Thread(thread) => all.line(from, &thread.end),
                Op::Probe(probe) => all.line(from, &probe.end),
                Op::Arc(to) => {
                    let start = from.map_or(to.end.point(), |from| from.point());
                    all.add(start);
                    all.add(to.end.point());
                    if let Ok(arc) = to.circle.arc(start, to.end.point(), f64::MAX) {
                        let (low, high) = arc.extents();
                        all.add(low);
                        all.add(high);
                    }
                }
                Op::Hole(pose) => {
                    let depth = cycle.map_or(0.0, |cycle| cycle.depth);
                    all.add(pose.point());
                    all.add(pose.point() - pose.axis() * depth);
                    let retract = cycle.map_or(0.0, |cycle| cycle.retract);
                    here = pose.at(pose.point() + pose.axis() * retract).ok();
                }
                Op::Cycle(new) => cycle = Some(new),
                Op::CycleOff => cycle = None,
                Op::Oriented(to) => {
                    let end = to.end.pose();
                    all.line(from, end);
                    here = Some(*end);
                }
                // Where the tool then stands is not known.
                Op::Joints(_) | Op::MachineMove(_) | Op::Home | Op::WorkOffset(_) => here = None,
                Op::Rapid(_)
                | Op::Feed(_)
                | Op::PathMode(_)
                | Op::Spindle(_)
                | Op::SurfaceSpeed(_)
                | Op::Coolant(_)
                | Op::Beam(_)
                | Op::Pulses(_)
                | Op::Tool(_)
                | Op::Preselect(_)
                | Op::Compensation(_)
                | Op::Frame(_)
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
        all
    }

    /// How far it reaches along the unit vector `direction`, mm from the origin; minus infinity where nothing is cut.
    pub fn reach(&self, direction: Vec3) -> f64 {
        if self.low.x > self.high.x {
            return f64::NEG_INFINITY;
        }
        geom::reach_of_box(self.low, self.high, direction)
    }

    /// Its smallest and largest coordinates, mm; none where nothing is cut.
    pub fn corners(&self) -> Option<[Vec3; 2]> {
        (self.low.x <= self.high.x).then_some([self.low, self.high])
    }

    fn add(&mut self, point: Vec3) {
        self.low = self.low.min(point);
        self.high = self.high.max(point);
    }

    fn line(&mut self, from: Option<Pose>, to: &Pose) {
        let Some(from) = from else { return self.add(to.point()) };
        let way = to.point() - from.point();
        let rise = way.dot(to.axis());
        // Along the axis, but for the rounding of its numbers.
        let along = from.axis() == to.axis() && rise.abs() >= way.length() * (1.0 - 1e-9);
        if !along || rise >= 0.0 {
            self.add(from.point());
        }
        if !along || rise <= 0.0 {
            self.add(to.point());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ArcTo, Circle};

    fn at(x: f64, y: f64, z: f64) -> Pose {
        Pose::upright(Vec3::new(x, y, z)).unwrap()
    }

    fn cut_by(ops: Vec<Op>) -> CutBox {
        let mut program = Program::new("t");
        for (line, op) in (1..).zip(ops) {
            program.push(line, op);
        }
        CutBox::of(&program)
    }

    #[test]
    fn coming_down_and_leaving_by_feed_cuts_at_the_lower_end() {
        let cut = cut_by(vec![
            Op::Rapid(at(0.0, 0.0, 50.0)),
            Op::Line(at(0.0, 0.0, -2.0)),
            Op::Line(at(10.0, 0.0, -1.0)),
            Op::Line(at(10.0, 0.0, 40.0)),
        ]);
        assert_eq!(
            (cut.reach(Vec3::Z), cut.reach(Vec3::X), cut.reach(Vec3::NEG_Z)),
            (-1.0, 10.0, 2.0)
        );
    }

    #[test]
    fn an_arc_reaches_as_far_as_its_turn_and_nothing_reaches_nowhere() {
        let circle = Circle::new(Vec3::ZERO, Vec3::Z, 0).unwrap();
        let end = at(-10.0, 0.0, 0.0);
        let half = Op::Arc(Box::new(ArcTo { end, circle }));
        let cut = cut_by(vec![Op::Rapid(at(10.0, 0.0, 0.0)), half]);
        assert!((cut.reach(Vec3::Y) - 10.0).abs() < 1e-9);
        assert_eq!(cut_by(vec![Op::Rapid(at(10.0, 0.0, 0.0))]).reach(Vec3::Z), f64::NEG_INFINITY);
    }
}
