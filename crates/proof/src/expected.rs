//! What the source says comes next.

use crate::compensation;
use crate::resolved_pose::PartialPose;
use geom::{Arc, Vec3};
use machine::Machine;
use program::{
    Auxiliary, Compensation, Coolant, Cycle, Feed, Input, Op, Output, PathMode, Pose, Probe,
    Program, Record, Spindle, Tool, WorkOffset, WorkOffsetData,
};

/// A motion of the source, from where the one before it ends.
#[derive(Clone, Debug)]
pub(crate) struct ExpectedMotion {
    /// Line of the source.
    pub line: u32,
    pub kind: Kind,
    /// Where the tool is before it; nothing before the first motion.
    pub from: Option<PartialPose>,
    /// Where it goes; for a hole the point of the hole.
    pub to: PartialPose,
    /// Whether the tool is changed before it.
    pub tool_change: bool,
    /// Whether the set-up changes before it.
    pub reset: bool,
    /// Whether Z goes home before it.
    pub homed: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    Rapid,
    Line,
    Arc(Arc),
    Hole(Cycle),
    /// In step with the spindle, mm a turn.
    Thread(f64),
    Probe {
        away: bool,
        must_answer: bool,
    },
    /// A record that makes no motion, and why.
    Broken(&'static str),
}

/// What comes next.
#[derive(Clone, Debug)]
pub(crate) enum Step {
    Move(ExpectedMotion),
    /// A dwell in s.
    Dwell(f64),
    Stop,
    OptionalStop,
    ThreadWire,
    CutWire,
    Output(Output),
    Input(Input),
    Auxiliary(Auxiliary),
    WorkOffsetData(WorkOffsetData),
    /// A record that no program can be compared with, and what it is.
    Unproven(&'static str),
    End,
}

/// What holds at a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExpectedState<'a> {
    pub feed: Option<Feed>,
    pub spindle: Spindle,
    /// Constant surface speed, m/min.
    pub surface_speed: Option<f64>,
    pub coolant: Coolant,
    pub tool: Option<&'a Tool>,
    pub compensation: Compensation,
    /// Lean of the wire by the control, degrees.
    pub taper: f64,
    /// The work offset, where the source names one.
    pub work_offset: Option<WorkOffset>,
    /// How closely its cuts are to be followed.
    pub path: PathMode,
    cycle: Option<Cycle>,
}

/// A walk along the source that stops at every motion, dwell and stop.
#[derive(Clone)]
pub(crate) struct Cursor<'a> {
    machine: &'a Machine,
    records: &'a [Record],
    next: usize,
    here: Option<PartialPose>,
    /// Line of the source of the step.
    pub line: u32,
    pub step: Step,
    pub wanted: ExpectedState<'a>,
    tool_change: bool,
    reset: bool,
    homed: bool,
    /// How the source has switched the spindle since its last motion.
    switched: Vec<Spindle>,
    /// Whether the program has to compensate where the source does.
    compensates: bool,
}

impl<'a> Cursor<'a> {
    /// A walk that stands at the first step.
    pub fn new(machine: &'a Machine, source: &'a Program) -> Cursor<'a> {
        let wanted = ExpectedState {
            feed: None,
            spindle: Spindle::Off,
            surface_speed: None,
            coolant: Coolant::Off,
            tool: None,
            compensation: Compensation::Off,
            taper: 0.0,
            work_offset: None,
            path: PathMode::AsSetUp,
            cycle: None,
        };
        let mut cursor = Cursor {
            machine,
            records: &source.records,
            compensates: compensation::is_due(source, machine),
            next: 0,
            here: None,
            line: 0,
            step: Step::End,
            wanted,
            tool_change: false,
            reset: false,
            homed: false,
            switched: Vec::new(),
        };
        cursor.advance();
        cursor
    }

    /// Goes to the next step.
    pub fn advance(&mut self) {
        if let Step::Move(goal) = &self.step {
            self.here = Some(goal.end());
            self.tool_change = false;
            self.reset = false;
            self.homed = false;
            self.switched.clear();
        }
        while let Some(record) = self.records.get(self.next) {
            self.next += 1;
            self.line = record.line;
            let step = match &record.op {
                Op::Rapid(pose) => self.motion(Kind::Rapid, pose),
                Op::Line(pose) => self.motion(Kind::Line, pose),
                Op::Arc(to) => {
                    let arc = self.here.and_then(|here| {
                        let center = to.circle.center();
                        let radius = here.tip.distance(center);
                        let end = to.end.point();
                        to.circle.arc(here.tip, end, radius).ok()
                    });
                    self.motion(
                        arc.map_or(Kind::Broken("its points make no arc"), Kind::Arc),
                        &to.end,
                    )
                }
                Op::Hole(pose) => {
                    let cycle = self.wanted.cycle.map(Kind::Hole);
                    self.motion(cycle.unwrap_or(Kind::Broken("no cycle is active")), pose)
                }
                Op::Thread(thread) => self.motion(Kind::Thread(thread.pitch()), &thread.end),
                Op::Probe(probe) => {
                    let Probe { away, must_answer, .. } = **probe;
                    self.motion(Kind::Probe { away, must_answer }, &probe.end)
                }
                Op::Oriented(_) => Step::Unproven("the turn of a tool about its axis"),
                Op::Joints(_) => Step::Unproven("a move of joints"),
                Op::MachineMove(_) => Step::Unproven("a move in machine coordinates"),
                Op::Beam(_) | Op::Pulses(_) => Step::Unproven("a beam"),
                Op::Dwell(seconds) if *seconds > 0.0 => Step::Dwell(*seconds),
                Op::Dwell(_) => continue,
                Op::Stop => Step::Stop,
                Op::OptionalStop if self.machine.leaves_out("optional_stop") => continue,
                Op::OptionalStop => Step::OptionalStop,
                Op::ThreadWire => Step::ThreadWire,
                Op::CutWire => Step::CutWire,
                Op::Output(output) => Step::Output(*output),
                Op::Input(input) => Step::Input(**input),
                Op::WorkOffsetData(_) if !self.machine.settings.sets_work_offsets => continue,
                Op::WorkOffsetData(data) => Step::WorkOffsetData(**data),
                Op::Auxiliary(_) if self.machine.leaves_out("auxiliary") => continue,
                Op::Auxiliary(function) => Step::Auxiliary(*function),
                Op::Home
                | Op::Cycle(_)
                | Op::CycleOff
                | Op::Feed(_)
                | Op::Spindle(_)
                | Op::SurfaceSpeed(_)
                | Op::Coolant(_)
                | Op::Tool(_)
                | Op::Preselect(_)
                | Op::Compensation(_)
                | Op::Frame(_)
                | Op::WorkOffset(_)
                | Op::Surface(_)
                | Op::PathMode(_)
                | Op::Clamp(_)
                | Op::Taper(_)
                | Op::Operation(_)
                | Op::EndOfOperation
                | Op::Comment(_)
                | Op::Message(_)
                | Op::End => {
                    self.note(&record.op);
                    continue;
                }
            };
            self.step = step;
            return;
        }
        self.step = Step::End;
    }

    /// Which record of the source the step is; the number of records behind the last one.
    pub fn record(&self) -> usize {
        if matches!(self.step, Step::End) { self.records.len() } else { self.next - 1 }
    }

    /// Whether the tool is changed here, or nothing has moved yet.
    pub fn at_tool_change(&self) -> bool {
        self.tool_change || self.here.is_none()
    }

    /// Whether the tool leaves the part here, whatever comes next: for a tool change, or home.
    pub fn leaves_part(&self) -> bool {
        self.at_tool_change() || self.homed
    }

    /// How the source has switched the spindle since its last motion.
    pub fn switched(&self) -> &[Spindle] {
        &self.switched
    }

    /// The next motion, whatever dwells and stops come before it.
    fn motion(&self, kind: Kind, pose: &Pose) -> Step {
        Step::Move(ExpectedMotion {
            line: self.line,
            kind,
            from: self.here,
            to: pose.into(),
            tool_change: self.tool_change,
            reset: self.reset,
            homed: self.homed,
        })
    }

    /// Whether the program has to compensate where the source does.
    pub fn compensates(&self) -> bool {
        self.compensates
    }

    /// Length of the active tool, mm, where the source says it.
    pub fn tool_length(&self) -> Option<f64> {
        self.wanted.tool.and_then(|tool| tool.length)
    }

    /// What holds from here on.
    fn note(&mut self, op: &'a Op) {
        let wanted = &mut self.wanted;
        match op {
            Op::Feed(feed) => wanted.feed = Some(*feed),
            Op::Spindle(spindle) => {
                wanted.spindle = *spindle;
                self.switched.push(*spindle);
            }
            Op::SurfaceSpeed(speed) => wanted.surface_speed = *speed,
            Op::Coolant(coolant) => wanted.coolant = *coolant,
            Op::Compensation(_) if !self.compensates => {}
            Op::Compensation(side) => wanted.compensation = *side,
            Op::Taper(degrees) => wanted.taper = *degrees,
            Op::PathMode(mode) => wanted.path = *mode,
            Op::Cycle(cycle) => wanted.cycle = Some(**cycle),
            Op::CycleOff => wanted.cycle = None,
            Op::Tool(tool) => {
                wanted.tool = Some(tool);
                self.tool_change = true;
            }
            Op::Frame(_) => self.reset = true,
            Op::Home => self.homed = true,
            Op::WorkOffset(offset) => {
                wanted.work_offset = Some(*offset);
                // How far the new frame is from the old is not known: the tool comes from above.
                self.homed |= self.here.take().is_some();
            }
            // Words for people, and what the control may do or leave. The surface is that of the trial; clamps follow the
            // axes of this machine.
            Op::Preselect(_)
            | Op::Clamp(_)
            | Op::Surface(_)
            | Op::Operation(_)
            | Op::EndOfOperation
            | Op::Comment(_)
            | Op::Message(_)
            | Op::End => {}
            // Steps of their own.
            Op::Rapid(_)
            | Op::Line(_)
            | Op::Arc(_)
            | Op::Thread(_)
            | Op::Probe(_)
            | Op::Hole(_)
            | Op::Oriented(_)
            | Op::Joints(_)
            | Op::MachineMove(_)
            | Op::Beam(_)
            | Op::Pulses(_)
            | Op::Output(_)
            | Op::WorkOffsetData(_)
            | Op::Input(_)
            | Op::Auxiliary(_)
            | Op::ThreadWire
            | Op::CutWire
            | Op::Dwell(_)
            | Op::Stop
            | Op::OptionalStop => {}
        }
    }
}

impl ExpectedMotion {
    /// Where the tool is after it.
    pub fn end(&self) -> PartialPose {
        match &self.kind {
            Kind::Hole(cycle) => self.to.lifted(cycle.retract),
            Kind::Probe { .. } => self.answered(),
            Kind::Rapid | Kind::Line | Kind::Arc(_) | Kind::Thread(_) | Kind::Broken(_) => self.to,
        }
    }

    /// Where a probe stands after it has answered: only what it has not moved along is known.
    fn answered(&self) -> PartialPose {
        let unknown = Vec3::splat(f64::NAN);
        let moved = self.from.map_or(unknown, |from| self.to.tip - from.tip);
        let tip = Vec3::select(moved.cmpeq(Vec3::ZERO), self.to.tip, unknown);
        PartialPose { tip, ..self.to }
    }

    /// Length of the way of the tip, mm; 0 from an unknown start.
    pub fn length(&self) -> f64 {
        match &self.kind {
            Kind::Arc(arc) => arc.length(),
            Kind::Rapid
            | Kind::Line
            | Kind::Hole(_)
            | Kind::Thread(_)
            | Kind::Probe { .. }
            | Kind::Broken(_) => self.from.map_or(0.0, |from| from.tip.distance(self.to.tip)),
        }
    }

    /// Whether home positions and turns of the rotary axes are in place before it: at the start,
    /// around a tool change, where the source goes home, and where a rapid goes to another set-up or
    /// orientation.
    pub fn free(&self, axis_degrees: f64) -> bool {
        let Some(from) = &self.from else { return true };
        let by_rapid = matches!(self.kind, Kind::Rapid | Kind::Hole(_));
        self.tool_change
            || self.homed
            || (by_rapid && (self.reset || from.apart(&self.to).1 > axis_degrees))
    }
}
