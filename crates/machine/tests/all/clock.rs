//! A second estimate of time: of the toolpath, by its records, where the proof adds up the motions of the program.
//!
//! - A rapid of a robot takes its length at `rapid` of the cell: how its joints go, the toolpath does not show.
//! - A dwell takes what it says; what waits for a person takes nothing.
//!
//! Where rotary axes turn, the linear axes go as the kinematics of the machine have it, where its file and the tool say enough
//! for that; otherwise as the tip. F is the speed of the tip, as the writer makes it: where it has to count degrees for that, F
//! goes no higher than `feed_max`. Where the tool turns about its tip without tool-centre control, F is the speed of the axes.

use geom::Vec3;
use machine::time::{self, TOOL_CHANGE, Times};
use machine::{Inverse, Machine, OrientationMode, RotaryFeed};
use program::{ArcTo, Course, Cycle, CycleKind, Feed, Op, Pose, Program, Spindle, lowering};

/// A move of the tip below this, mm, is none.
const STANDS: f64 = 1e-6;

/// The times of `program`.
pub fn times_of(program: &Program, machine: &Machine) -> Times {
    let mut clock = Clock::new(machine);
    program.records.iter().for_each(|record| clock.run(&record.op));
    clock.times
}

/// Adds up the times of a program as its records come.
#[derive(Clone, Debug)]
pub struct Clock<'a> {
    machine: &'a Machine,
    /// What has been spent so far.
    pub times: Times,
    inverse: Inverse<'a>,
    here: Option<TipPose>,
    /// Degrees of A, B, C.
    degrees: [f64; 3],
    /// Length of the tool, mm, where it is known.
    tool_length: Option<f64>,
    feed: Feed,
    spindle: Spindle,
    cycle: Option<Cycle>,
}

impl<'a> Clock<'a> {
    /// A clock at zero; the machine stands where its first move begins.
    pub fn new(machine: &'a Machine) -> Clock<'a> {
        Clock {
            machine,
            times: Times::default(),
            inverse: Inverse::of(machine),
            here: None,
            degrees: [0.0; 3],
            tool_length: None,
            feed: Feed::PerMinute(0.0),
            spindle: Spindle::Off,
            cycle: None,
        }
    }

    /// Adds the time of one record.
    pub fn run(&mut self, op: &Op) {
        match op {
            Op::Rapid(pose) => self.rapid(pose.into()),
            Op::Line(pose) => self.line(pose.into()),
            Op::Arc(to) => self.arc(to),
            Op::Thread(thread) => {
                let feed = std::mem::replace(&mut self.feed, Feed::PerTurn(thread.pitch()));
                self.line((&thread.end).into());
                self.feed = feed;
            }
            // At the latest it ends there.
            Op::Probe(probe) => self.line((&probe.end).into()),
            Op::Hole(pose) => self.hole(pose),
            Op::Oriented(to) => {
                let end = *to.end.pose();
                match to.course {
                    Course::Rapid => self.rapid((&end).into()),
                    Course::Line => self.line((&end).into()),
                    Course::Arc(circle) => self.arc(&ArcTo { end, circle }),
                }
            }
            Op::Cycle(cycle) => self.cycle = Some(**cycle),
            Op::CycleOff => self.cycle = None,
            Op::Feed(feed) => self.feed = *feed,
            Op::Spindle(spindle) => {
                if *spindle != Spindle::Off && self.spindle == Spindle::Off {
                    self.times.dwell += self.machine.spindle.dwell;
                }
                self.spindle = *spindle;
            }
            Op::Tool(tool) => {
                // The change has stopped it.
                if self.spindle != Spindle::Off {
                    self.times.dwell += self.machine.spindle.dwell;
                }
                self.tool_length = tool.length;
                // A robot whose cell has no program for that waits for a person.
                let by_hand =
                    self.machine.cell.as_ref().is_some_and(|cell| cell.tool_change.is_empty());
                self.times.tool_change += if by_hand { 0.0 } else { TOOL_CHANGE };
            }
            Op::Dwell(seconds) => self.times.dwell += seconds,
            // Where the axes are sent to, or how far it is, the program does not know.
            Op::Joints(_) | Op::MachineMove(_) | Op::Home | Op::WorkOffset(_) => {}
            Op::WorkOffsetData(_) => {}
            // Who answers, or when, is not known; the rest takes no time of its own.
            Op::Stop
            | Op::OptionalStop
            | Op::Input(_)
            | Op::PathMode(_)
            | Op::SurfaceSpeed(_)
            | Op::Coolant(_)
            | Op::Beam(_)
            | Op::Pulses(_)
            | Op::Preselect(_)
            | Op::Compensation(_)
            | Op::Frame(_)
            | Op::Surface(_)
            | Op::Clamp(_)
            | Op::Output(_)
            | Op::Auxiliary(_)
            | Op::ThreadWire
            | Op::CutWire
            | Op::Taper(_)
            | Op::Operation(_)
            | Op::EndOfOperation
            | Op::Comment(_)
            | Op::Message(_)
            | Op::End => {}
        }
    }

    fn line(&mut self, to: TipPose) {
        let length = self.here.map_or(0.0, |here| to.point.distance(here.point));
        self.cut(to, length);
    }

    fn arc(&mut self, to: &ArcTo) {
        let end: TipPose = (&to.end).into();
        let arc = self.here.and_then(|here| to.circle.arc(here.point, end.point, f64::MAX).ok());
        self.cut(end, arc.map_or(0.0, |arc| arc.length()));
    }

    fn rapid(&mut self, to: TipPose) {
        let (way, turn) = self.go(to);
        self.times.rapid += match &self.machine.cell {
            Some(cell) => 60.0 * way.length() / cell.rapid,
            None => time::rapid(self.machine, way, turn),
        };
    }

    fn cut(&mut self, to: TipPose, length: f64) {
        let (way, turn) = self.go(to);
        let speed = match self.spindle {
            Spindle::Off => 0.0,
            Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) => speed,
        };
        let at_feed = match self.feed {
            Feed::InverseTime(moves) => 1.0 / moves,
            feed @ (Feed::PerMinute(_) | Feed::PerTurn(_)) => {
                length / lowering::feed_per_minute(feed, length, speed)
            }
        };
        if self.machine.cell.is_some() {
            self.times.cutting += if at_feed.is_finite() { 60.0 * at_feed } else { 0.0 };
            return;
        }
        let at_feed = self.counted(at_feed, length, way, turn);
        self.times.cutting += time::cut(self.machine, way, turn, 60.0 * at_feed);
    }

    /// The time of a cut at its feed, minutes, where the control does not follow the tip and F counts degrees.
    fn counted(&self, at_feed: f64, length: f64, way: Vec3, turn: [f64; 3]) -> f64 {
        let machine = self.machine;
        let by_angles = machine.orientation.simultaneous == OrientationMode::MachineAngles;
        if !by_angles || turn == [0.0; 3] {
            return at_feed;
        }
        let counted =
            machine.settings.rotary_feed.unwrap_or(RotaryFeed::AllAxes).counted(way, turn);
        match self.feed {
            Feed::PerMinute(feed) if length <= STANDS => counted / feed,
            Feed::PerMinute(_) | Feed::PerTurn(_) | Feed::InverseTime(_) => {
                let most = if machine.capabilities.inverse_time {
                    f64::INFINITY
                } else {
                    machine.feed_max
                };
                at_feed.max(counted / most)
            }
        }
    }

    /// The moves of a hole, as if there were no cycle. Tapping goes in and out in step with the spindle.
    fn hole(&mut self, pose: &Pose) {
        let Some(cycle) = self.cycle else { return self.rapid(pose.into()) };
        let axis = pose.axis();
        let at = |height: f64| TipPose { point: pose.point() + axis * height, axis };
        self.rapid(at(cycle.clearance));
        let feed = self.feed;
        if let Some(feed) = cycle.feed {
            self.feed = feed;
        }
        if let CycleKind::Tap { pitch, .. } = cycle.kind {
            self.feed = Feed::PerTurn(pitch);
            for height in [-cycle.depth, cycle.clearance] {
                self.line(at(height));
            }
            self.times.dwell += cycle.dwell;
            self.rapid(at(cycle.retract));
        } else if let Some(way) = cycle.kind.withdrawal() {
            let moved = |height: f64| TipPose { point: at(height).point + way.aside, axis };
            if let CycleKind::BackBore { through, .. } = cycle.kind {
                let bored = self.feed;
                self.rapid(moved(cycle.clearance));
                self.feed = through.unwrap_or(bored);
                match through {
                    Some(_) => self.line(moved(-cycle.depth)),
                    None => self.rapid(moved(-cycle.depth)),
                }
                self.rapid(at(-cycle.depth));
                self.feed = bored;
                self.line(at(0.0));
            } else {
                self.line(at(-cycle.depth));
                self.rapid(moved(-cycle.depth));
            }
            self.times.dwell += cycle.dwell;
            self.rapid(moved(cycle.retract));
            self.rapid(at(cycle.retract));
        } else {
            let moves = lowering::hole(&cycle, pose, self.spindle).unwrap_or_default();
            moves.into_iter().for_each(|part| self.run(&part.into()));
        }
        self.feed = feed;
    }

    /// Moves to a pose; returns how far the linear axes move, mm, and A, B, C, degrees.
    fn go(&mut self, to: TipPose) -> (Vec3, [f64; 3]) {
        let degrees = match self.here.is_some_and(|here| here.axis == to.axis) {
            true => self.degrees,
            false => self.nearest(to.axis),
        };
        // A table that is turned carries the part with it: what is one way on the part is another one of the axes.
        let is_upright = degrees == [0.0; 3] && self.degrees == [0.0; 3];
        let way = self.here.map_or(Vec3::ZERO, |here| match is_upright {
            true => to.point - here.point,
            false => self.axes(to.point, degrees) - self.axes(here.point, self.degrees),
        });
        let turn = [0, 1, 2].map(|i| degrees[i] - self.degrees[i]);
        self.degrees = degrees;
        self.here = Some(to);
        (way, turn)
    }

    /// The positions of the linear axes, mm, where it is known how the rotary ones carry the tip and the part.
    fn axes(&self, tip: Vec3, degrees: [f64; 3]) -> Vec3 {
        match self.machine.unsaid(degrees, self.tool_length) {
            Some(_) => tip,
            None => self.machine.linear_for(tip, degrees, self.tool_length.unwrap_or(0.0)),
        }
    }

    /// The positions for a tool axis that are reached soonest from where the axes stand.
    fn nearest(&self, axis: Vec3) -> [f64; 3] {
        let Ok(solutions) = self.inverse.solve(axis) else { return self.degrees };
        let near = solutions.degrees.map(|degrees| {
            [0, 1, 2].map(|i| {
                let turn = (degrees[i] - self.degrees[i]).to_radians();
                let turn = if solutions.free == Some(i) { 0.0 } else { geom::wrap(turn) };
                self.degrees[i] + turn.to_degrees()
            })
        });
        let far = |to: [f64; 3]| (0..3).map(|i| (to[i] - self.degrees[i]).abs()).sum::<f64>();
        if far(near[1]) < far(near[0]) { near[1] } else { near[0] }
    }
}

/// The pose of the tool: tip and axis.
#[derive(Clone, Copy, Debug)]
struct TipPose {
    point: Vec3,
    axis: Vec3,
}

impl From<&Pose> for TipPose {
    fn from(pose: &Pose) -> TipPose {
        TipPose { point: pose.point(), axis: pose.axis() }
    }
}
