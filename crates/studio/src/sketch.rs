//! The path of a source of which no program could be written: as its records go, where the machine's axes stand is not known.

use geom::Vec3;
use machine::Machine;
use program::{Cycle, Feed, Op, Pose, Program};
use proof::{AxisPositions, Course, Motion, MotionKind, Observer, ToolPose};

/// Tells an observer the moves of a source, each in the time that its cuts take at their feed; rapids take none.
pub(crate) fn follow(source: &Program, machine: &Machine, observer: &mut dyn Observer) {
    let mut path = Path {
        axes: unknown(machine),
        here: ToolPose { tip: Vec3::NAN, axis: Vec3::NAN },
        feed: None,
        cycle: None,
        observer,
    };
    for (number, record) in source.records.iter().enumerate() {
        path.go((number, record.line), &record.op);
    }
}

/// Axes of which nobody knows where they stand.
fn unknown(machine: &Machine) -> AxisPositions {
    match (&machine.arm, &machine.wire) {
        (Some(_), _) => AxisPositions::Arm {
            joints: [f64::NAN; 6],
            rail: machine.cell.as_ref().and_then(|cell| cell.rail.as_ref()).map(|_| f64::NAN),
        },
        (None, Some(_)) => AxisPositions::Wire { guide: Vec3::NAN, lean: [f64::NAN; 2] },
        (None, None) => AxisPositions::Mill { linear: Vec3::NAN, rotary: [f64::NAN; 3] },
    }
}

struct Path<'o> {
    axes: AxisPositions,
    here: ToolPose,
    feed: Option<Feed>,
    cycle: Option<Cycle>,
    observer: &'o mut dyn Observer,
}

impl Path<'_> {
    fn go(&mut self, of: (usize, u32), op: &Op) {
        let place = |pose: &Pose| ToolPose { tip: pose.point(), axis: pose.axis() };
        match op {
            Op::Rapid(pose) => self.step(of, MotionKind::Rapid, place(pose)),
            Op::Line(pose) => self.step(of, MotionKind::Line, place(pose)),
            Op::Thread(thread) => self.step(of, MotionKind::Line, place(&thread.end)),
            Op::Probe(probe) => {
                self.step(of, MotionKind::Line, place(&probe.end));
                self.lose();
            }
            Op::Arc(arc) => self.round(of, &arc.circle, place(&arc.end)),
            Op::Oriented(to) => {
                let end = place(to.end.pose());
                match &to.course {
                    program::Course::Rapid => self.step(of, MotionKind::Rapid, end),
                    program::Course::Line => self.step(of, MotionKind::Line, end),
                    program::Course::Arc(circle) => self.round(of, circle, end),
                }
            }
            Op::Hole(pose) => {
                let Some(cycle) = self.cycle else { return };
                let at = |height: f64| ToolPose {
                    tip: pose.point() + pose.axis() * height,
                    axis: pose.axis(),
                };
                self.step(of, MotionKind::Rapid, at(cycle.clearance));
                self.step(of, MotionKind::Line, at(-cycle.depth));
                self.step(of, MotionKind::Rapid, at(cycle.retract));
            }
            // Where the tool goes by these, the source does not say.
            Op::Home | Op::Joints(_) | Op::MachineMove(_) => self.lose(),
            Op::Cycle(cycle) => self.cycle = Some(**cycle),
            Op::CycleOff => self.cycle = None,
            Op::Feed(feed) => self.feed = Some(*feed),
            Op::PathMode(_)
            | Op::Spindle(_)
            | Op::SurfaceSpeed(_)
            | Op::Coolant(_)
            | Op::Beam(_)
            | Op::Pulses(_)
            | Op::Tool(_)
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

    fn lose(&mut self) {
        self.here = ToolPose { tip: Vec3::NAN, axis: Vec3::NAN };
    }

    fn round(&mut self, of: (usize, u32), circle: &program::Circle, end: ToolPose) {
        let kind = match circle.arc(self.here.tip, end.tip, f64::MAX) {
            Ok(arc) if self.here.tip.is_finite() => MotionKind::Arc(Box::new(arc)),
            _ => MotionKind::Line,
        };
        self.step(of, kind, end);
    }

    fn step(&mut self, (record, source_line): (usize, u32), kind: MotionKind, end: ToolPose) {
        let length = match &kind {
            MotionKind::Arc(arc) => arc.length(),
            MotionKind::Rapid | MotionKind::Line | MotionKind::Joints => {
                self.here.tip.distance(end.tip)
            }
        };
        let seconds = match (self.feed, &kind) {
            (Some(Feed::PerMinute(feed)), MotionKind::Line | MotionKind::Arc(_)) => {
                60.0 * length / feed
            }
            _ => 0.0,
        };
        self.observer.moved(&Motion {
            file: None,
            line: 0,
            record,
            source_line,
            kind,
            course: Course::Tool,
            tool: [self.here, end],
            axes: self.axes,
            feed: self.feed,
            seconds,
            waited: 0.0,
            deviation: None,
        });
        self.here = end;
    }
}
