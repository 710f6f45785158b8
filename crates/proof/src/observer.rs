//! Who follows a proof while it runs: it is asked whether the proof goes on, and told what the control does.

use crate::report::Report;
use crate::resolved_pose::PartialPose;
use control::{Event, Settings};
use geom::{Arc, Vec3};
use program::{
    Compensation, Coolant, Cycle, Diagnostic, Feed, Outcome, PathMode, Spindle, Tool, WorkOffset,
    cancelled,
};

/// Who follows a proof. `()` follows nothing and never ends it.
pub trait Observer {
    /// The proof has come to this part of the lines of the program, 0 to 1: whether it goes on. It is asked every few
    /// milliseconds; a program with loops and calls goes back and forth.
    fn reached(&mut self, _part: f64) -> bool {
        true
    }

    /// Whether it is told the motions. It is asked once, at the beginning.
    fn wants_motions(&self) -> bool {
        false
    }

    /// The next motion of the program, in the order in which the control makes them. Of a program that the proof runs
    /// several times (with and without its optional blocks, on several surfaces) it is told the motions of the first run.
    fn moved(&mut self, _motion: &Motion) {}

    /// What holds from the next motion on, told before the first motion and wherever it has changed since: as the control has read it.
    fn stated(&mut self, _state: &MachineState) {}

    /// The first mismatch, behind the last motion before it. What is compared along whole contours is found behind the last
    /// motion of all: the line of the finding says which block it is about.
    fn mismatched(&mut self, _found: &Diagnostic) {}

    /// The proof is over: of a program that it runs several times, all of them.
    fn ended(&mut self, _report: &Report) {}
}

impl Observer for () {}

/// It keeps all motions.
impl Observer for Vec<Motion> {
    fn wants_motions(&self) -> bool {
        true
    }

    fn moved(&mut self, motion: &Motion) {
        self.push(motion.clone());
    }
}

/// After so many events of the control the observer is asked whether the proof goes on: some milliseconds at the most.
pub(crate) const EVENTS_AT_ONCE: u32 = 256;

/// The same of an arm, whose joints are followed along each motion.
pub(crate) const MOTIONS_AT_ONCE: u32 = 8;

/// Whether an observer has been told of the first mismatch.
#[derive(Default)]
pub(crate) struct Mark(bool);

impl Mark {
    /// Tells the first of `mismatches`, once.
    pub fn tell(&mut self, mismatches: &[Diagnostic], observer: &mut dyn Observer) {
        if let (false, [first, ..]) = (self.0, mismatches) {
            self.0 = true;
            observer.mismatched(first);
        }
    }
}

/// Runs a program, for as long as the observer says so, and hands each event to `take`.
///
/// # Errors
/// What the control or `take` refuses; the observer has ended the proof (`cancelled`).
pub(crate) fn run(
    settings: &Settings,
    (file_name, text): (&str, &[u8]),
    (observer, every): (&mut dyn Observer, u32),
    mut take: impl FnMut(&Event, &mut dyn Observer) -> Outcome,
) -> Outcome {
    let mut events: u32 = 0;
    let lines = memchr::memchr_iter(b'\n', text).count().max(1) as f64;
    control::read(settings, file_name, text, &mut |event| {
        events = events.wrapping_add(1);
        if events.is_multiple_of(every)
            && !observer.reached(f64::from(event.line).min(lines) / lines)
        {
            return Err(cancelled().into());
        }
        take(&event, observer)
    })
}

/// An observer that is only asked whether a further run of the program goes on.
pub(crate) struct Silent<'a>(pub &'a mut dyn Observer);

impl Observer for Silent<'_> {
    fn reached(&mut self, part: f64) -> bool {
        self.0.reached(part)
    }
}

/// A motion of the program that the proof has accepted. What nobody knows is NaN: where an axis stands that has gone
/// home, or that no block has set.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// The file that the block stands in; none where it is the program itself.
    pub file: Option<Box<str>>,
    /// Line of that file, from 1.
    pub line: u32,
    /// Which record of the source (place in [`program::Program::records`]) it makes, or on the way to which it is; the number of
    /// records behind the last one.
    pub record: usize,
    /// Line of the source on which that record stands; 0 where it stands on none.
    pub source_line: u32,
    /// How it goes.
    pub kind: MotionKind,
    /// How the axes go between its ends.
    pub course: Course,
    /// Where the tool is before it and behind it, in the work frame.
    pub tool: [ToolPose; 2],
    /// Where the axes of the machine stand behind it.
    pub axes: AxisPositions,
    /// The feed that the control has read last, in a hole that of its cycle; of a thread in step with the spindle its pitch by the
    /// spindle's speed, mm/min. None where it has read none.
    pub feed: Option<Feed>,
    /// How long it takes, s, as [`machine::time`] estimates it of what the control has read: a rapid as its slowest axis, each from
    /// rest to rest, a cut by its feed, a probing move as if it went to its end. A way that is not known, as to and from home, takes nothing.
    pub seconds: f64,
    /// How long the machine waits before it, s: dwells, and [`machine::time::TOOL_CHANGE`] for each tool change.
    pub waited: f64,
    /// How far it is from the motion of the source; none where nothing is compared in it alone: on the way to a record by several
    /// rapids, in an excursion, to home, and along a contour on which an arm compensates, which is compared as a whole.
    pub deviation: Option<Deviation>,
}

/// How far the tool is from where the source has it, at the most. Of a cut anywhere along it but at its start, which is the end of
/// the motion before; of a rapid at the end of its record alone; in a hole from the axis and the depths of the hole. Of a canned cycle, which
/// the control makes in one block, each motion has the largest of all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Of the tip, mm.
    pub tip_mm: f64,
    /// Of the axis, degrees.
    pub axis_degrees: f64,
}

impl Deviation {
    /// Takes a further place of the motion in, which is so far apart, mm and degrees.
    #[inline]
    pub(crate) fn widen(most: &mut Option<Deviation>, (tip_mm, axis_degrees): (f64, f64)) {
        let before = most.unwrap_or_default();
        *most = Some(Deviation {
            tip_mm: before.tip_mm.max(tip_mm),
            axis_degrees: before.axis_degrees.max(axis_degrees),
        });
    }
}

/// What holds while the tool moves, as the control has read it.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineState {
    /// The spindle.
    pub spindle: SpindleState,
    /// Constant surface speed, m/min.
    pub surface_speed: Option<f64>,
    /// Coolant; on an arm, on which an output switches it, flood.
    pub coolant: Coolant,
    /// The tool that was changed to last, with what the block says of it.
    pub tool: Option<Tool>,
    /// Compensation of the tool's radius.
    pub compensation: Compensation,
    /// Register of the tool's length.
    pub length_offset: Option<u32>,
    /// Work offset.
    pub work_offset: Option<WorkOffset>,
    /// The hole cycle that is on.
    pub cycle: Option<Cycle>,
    /// What happens at corners.
    pub path: PathMode,
    /// By how much the control leans the wire, degrees, to the left.
    pub taper: f64,
    /// How fast an arm may turn its joints, percent; none where nobody has said it.
    pub joint_speed: Option<f64>,
}

/// How a spindle turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpindleState {
    /// It stands.
    Off,
    /// Clockwise, turns a minute.
    Clockwise(f64),
    /// Counter-clockwise, turns a minute.
    CounterClockwise(f64),
    /// An output of an arm's controller has switched it on; turns a minute, where another output says them.
    On(Option<f64>),
}

impl From<Spindle> for SpindleState {
    fn from(spindle: Spindle) -> SpindleState {
        match spindle {
            Spindle::Off => SpindleState::Off,
            Spindle::Clockwise(speed) => SpindleState::Clockwise(speed),
            Spindle::CounterClockwise(speed) => SpindleState::CounterClockwise(speed),
        }
    }
}

/// The state that an observer has been told.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stated(Option<MachineState>);

impl Stated {
    /// What holds from here on, where it is something new.
    pub fn news(&mut self, state: MachineState) -> Option<&MachineState> {
        let is_new = self.0.as_ref() != Some(&state);
        is_new.then(|| &*self.0.insert(state))
    }
}

/// What an observer is told of an event of an arm, until it is taken.
#[derive(Clone, Debug, Default)]
pub(crate) struct Walk {
    moved: Vec<Motion>,
    /// What holds from the motion on that has this place among them.
    stated: Vec<(usize, MachineState)>,
    state: Stated,
    /// Waiting since the last motion, s.
    pub waited: f64,
}

impl Walk {
    /// Keeps what holds from here on, where it is something new.
    pub fn state(&mut self, state: MachineState) {
        if let Some(state) = self.state.news(state) {
            self.stated.push((self.moved.len(), state.clone()));
        }
    }

    /// Keeps a motion, before which the machine has waited.
    #[inline]
    pub fn moved(&mut self, mut motion: Motion) {
        motion.waited = std::mem::take(&mut self.waited);
        self.moved.push(motion);
    }

    /// Tells what has been kept.
    pub fn tell(&mut self, observer: &mut dyn Observer) {
        let mut states = self.stated.iter().peekable();
        for (place, motion) in self.moved.iter().enumerate() {
            while let Some((_, state)) = states.next_if(|(from, _)| *from <= place) {
                observer.stated(state);
            }
            observer.moved(motion);
        }
        self.stated.clear();
        self.moved.clear();
    }
}

/// How a motion goes.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionKind {
    /// As fast as the axes can.
    Rapid,
    /// At the feed, on a straight line of the tip, or as the axes lead it ([`Course`]).
    Line,
    /// At the feed, along an arc or a helix of the tip.
    Arc(Box<Arc>),
    /// All joints of an arm together, each from where it stands to where it goes: the tip goes along no line.
    Joints,
}

/// How the axes go between the ends of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// The control keeps the tip on its line or arc, and turns the tool axis on the great circle between both ends: along vectors, in a
    /// tilted plane, and lines of an arm.
    Tool,
    /// The control keeps the tip on its line or arc, and each rotary axis turns evenly: tool-centre control by angles.
    Tip,
    /// All axes go evenly and arrive together; the tip goes where they lead it.
    Axes,
    /// Each axis goes as fast as it can, in a rapid; the tip goes where they lead it.
    EachAxis,
}

/// A tool tip, mm, and a tool axis (unit vector), in the work frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolPose {
    /// The tip, mm.
    pub tip: Vec3,
    /// The axis, from the tip to the spindle.
    pub axis: Vec3,
}

impl From<ToolPose> for PartialPose {
    fn from(ToolPose { tip, axis }: ToolPose) -> PartialPose {
        PartialPose { tip, axis }
    }
}

impl From<PartialPose> for ToolPose {
    fn from(PartialPose { tip, axis }: PartialPose) -> ToolPose {
        ToolPose { tip, axis }
    }
}

/// Where the axes of a machine stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisPositions {
    /// Of a mill: X, Y and Z as its control shows them in machine coordinates, mm, where the machine's file states its
    /// `work_zero`, otherwise from the work zero; to the gauge line of the spindle where the source states the length of
    /// the tool, otherwise to its tip. A, B and C, degrees; NaN where several positions are possible.
    Mill {
        /// X, Y, Z, mm.
        linear: Vec3,
        /// A, B, C, degrees.
        rotary: [f64; 3],
    },
    /// Of a wire: X, Y and Z in the work frame, mm, and how far the upper end of the wire is from the lower one along U and V, mm.
    Wire {
        /// X, Y, Z, mm.
        guide: Vec3,
        /// U, V, mm.
        lean: [f64; 2],
    },
    /// Of an arm: its joints as its controller counts them, degrees, and where the rail stands on which it is, mm.
    Arm {
        /// Joints 1 to 6, degrees; NaN where nobody says how the controller counts joint 3.
        joints: [f64; 6],
        /// mm; none where it stands on no rail.
        rail: Option<f64>,
    },
}
