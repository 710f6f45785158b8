//! How far the cuts of a program reach.

use crate::{Cycle, Op, Pose, Program, Tool};
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

/// Which ends of a cut along the tool axis count.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ends {
    Lower,
    Both,
}

impl CutBox {
    /// The box of `program`, whose poses are in the work frame. A cut along the tool axis cuts at its lower end:
    /// the tool comes to it through the air, or leaves it through what it has cut.
    pub fn of(program: &Program) -> CutBox {
        CutBox::around(program, |_| 0.0, Ends::Lower)
    }

    /// The box of all that `program` reaches by feed, with the heights from which it comes down to a cut and to which it leaves it;
    /// of holes with their R planes. Beyond it along the tool axis no tool is between the walls of a cut.
    pub fn fed(program: &Program) -> CutBox {
        CutBox::around(program, |_| 0.0, Ends::Both)
    }

    /// The box of what the edges of the tools reach, each as far around the tip as the source says its radius; of a tool whose radius
    /// it does not say, the tip.
    pub fn swept(program: &Program) -> CutBox {
        CutBox::around(program, |tool| tool.diameter.unwrap_or(0.0) / 2.0, Ends::Lower)
    }

    /// The box of discs across the tool axis, as large as `radius` says of the tool, mm.
    fn around(program: &Program, radius: impl Fn(&Tool) -> f64, ends: Ends) -> CutBox {
        let (mut edge, mut margin) = (0.0, Vec3::ZERO);
        let mut all = CutBox { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };
        let mut here: Option<Pose> = None;
        let mut cycle: Option<&Cycle> = None;
        for record in program.each() {
            let from = here;
            if let Some(pose) = record.op.pose() {
                here = Some(*pose);
                margin = disc(edge, pose.axis())
                    .max(from.map_or(margin, |from| disc(edge, from.axis())));
            }
            match &record.op {
                Op::Line(to) => all.line(from, to, margin, ends),
                Op::Thread(thread) => all.line(from, &thread.end, margin, ends),
                Op::Probe(probe) => all.line(from, &probe.end, margin, ends),
                Op::Arc(to) => {
                    let start = from.map_or(to.end.point(), |from| from.point());
                    all.add(start, margin);
                    all.add(to.end.point(), margin);
                    if let Ok(arc) = to.circle.arc(start, to.end.point(), f64::MAX) {
                        let (low, high) = arc.extents();
                        all.add(low, margin);
                        all.add(high, margin);
                    }
                }
                Op::Hole(pose) => {
                    let depth = cycle.map_or(0.0, |cycle| cycle.depth);
                    all.add(pose.point(), margin);
                    all.add(pose.point() - pose.axis() * depth, margin);
                    if let (Ends::Both, Some(cycle)) = (ends, cycle) {
                        all.add(pose.point() + pose.axis() * cycle.clearance, margin);
                    }
                    let retract = cycle.map_or(0.0, |cycle| cycle.retract);
                    here = pose.at(pose.point() + pose.axis() * retract).ok();
                }
                Op::Tool(tool) => edge = radius(tool),
                Op::Cycle(new) => cycle = Some(new),
                Op::CycleOff => cycle = None,
                Op::Oriented(to) => {
                    let end = to.end.pose();
                    all.line(from, end, margin, ends);
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

    fn add(&mut self, point: Vec3, margin: Vec3) {
        self.low = self.low.min(point - margin);
        self.high = self.high.max(point + margin);
    }

    fn line(&mut self, from: Option<Pose>, to: &Pose, margin: Vec3, ends: Ends) {
        let Some(from) = from else { return self.add(to.point(), margin) };
        let way = to.point() - from.point();
        let rise = way.dot(to.axis());
        // Along the axis, but for the rounding of its numbers.
        let along = ends == Ends::Lower
            && from.axis() == to.axis()
            && rise.abs() >= way.length() * (1.0 - 1e-9);
        if !along || rise >= 0.0 {
            self.add(from.point(), margin);
        }
        if !along || rise <= 0.0 {
            self.add(to.point(), margin);
        }
    }
}

/// How far a disc of this radius across `axis` reaches along X, Y and Z.
fn disc(radius: f64, axis: Vec3) -> Vec3 {
    (Vec3::ONE - axis * axis).max(Vec3::ZERO).map(f64::sqrt) * radius
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
    fn what_is_fed_begins_where_the_feed_begins() {
        let mut program = Program::new("t");
        let ops = [Op::Rapid(at(0.0, 0.0, 50.0)), Op::Rapid(at(0.0, 0.0, 2.0))];
        for op in ops.into_iter().chain([Op::Line(at(0.0, 0.0, -3.0))]) {
            program.push(1, op);
        }
        let (cut, fed) = (CutBox::of(&program), CutBox::fed(&program));
        assert_eq!((cut.reach(Vec3::Z), fed.reach(Vec3::Z)), (-3.0, 2.0));
    }

    /// By hand: upright 5 mm in X and Y and none in Z; at 45 degrees in the plane XZ 5 mm in Y and 5/sqrt(2) in X and Z.
    #[test]
    fn the_edge_of_a_tool_reaches_its_radius_across_its_axis() {
        let tool = Tool { number: 1, diameter: Some(10.0), ..Tool::default() };
        let swept = |end: Pose| {
            let mut program = Program::new("t");
            program.push(1, Op::Tool(Box::new(tool.clone())));
            program.push(2, Op::Line(end));
            CutBox::swept(&program).corners().unwrap()
        };
        assert_eq!(
            swept(at(1.0, 2.0, 3.0)),
            [Vec3::new(-4.0, -3.0, 3.0), Vec3::new(6.0, 7.0, 3.0)]
        );
        let leaning = Pose::new(Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0).normalize()).unwrap();
        let across = 12.5_f64.sqrt();
        let [_, high] = swept(leaning);
        assert!(high.distance(Vec3::new(across, 5.0, across)) < 1e-9, "{high}");
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
