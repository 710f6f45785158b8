//! The records of a program.

use crate::{
    ArcTo, Auxiliary, Beam, Clamp, CompensatedPath, Compensation, Coolant, Cycle, Feed, Input,
    JointMove, MachineMove, Oriented, Output, PathMode, Pose, Probe, Spindle, Surface, Thread,
    Tool, WorkOffset, WorkOffsetData,
};
use geom::ending::go_on;
use geom::{Frame, Vec3};

/// A program in the neutral vocabulary.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// What the program is called: the part number of the source, or its file name.
    pub name: String,
    /// The records in the order in which they happen.
    pub records: Vec<Record>,
    /// Which path the coordinates are where cutter compensation is on; `None` where nobody has said or shown it.
    pub compensated_path: Option<CompensatedPath>,
    /// Smallest and largest corner of the box around the stock, mm, work frame; `None` where the source does not state it.
    pub stock: Option<[Vec3; 2]>,
    /// The highest Z, mm, work frame, from which the source sends Z home by a word that says no height in the work; `None` where it has none.
    pub sent_home: Option<f64>,
}

/// One thing that happens, and the line (from 1) of the source that says so.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Line of the source, from 1; 0 where there is none.
    pub line: u32,
    /// What happens.
    pub op: Op,
}

/// What a record says. Modal words (feed, spindle, coolant, compensation, cycle) hold from their
/// record on; every position is absolute.
///
/// Whoever handles records names each of them (`clippy::wildcard_enum_match_arm` is denied): a new one
/// stops the compiler at every place that has to know it. `docs/architecture.md` lists who does what
/// with which.
#[derive(Clone, Debug, PartialEq)]
pub enum Op {
    /// Rapid to a pose. The way there is the machine's own, only its end counts.
    Rapid(Pose),
    /// Straight line of the tool tip to a pose at the active feed.
    Line(Pose),
    /// Arc or helix of the tool tip at the active feed.
    Arc(Box<ArcTo>),
    /// Straight line whose feed is tied to the turn of the spindle, as a thread needs it (`G33`).
    Thread(Box<Thread>),
    /// Straight line at the active feed that ends where the probe answers. Where the tool stands
    /// afterwards only the machine knows.
    Probe(Box<Probe>),
    /// One hole of the active [`Cycle`]; the pose is the point of the cycle on the surface and the
    /// tool axis there. The tool ends at the cycle's retract level.
    Hole(Pose),
    /// A motion that says how far the tool is turned about its axis, too. For robots.
    Oriented(Box<Oriented>),
    /// The joints of an arm go to positions. For robots.
    Joints(Box<JointMove>),
    /// Axes go to positions that count from the zero of the machine.
    MachineMove(Box<MachineMove>),
    /// Z goes to a fixed position of the machine: the tool leaves the part. Where it stands afterwards
    /// is not known.
    Home,
    /// The hole cycle for the [`Op::Hole`]s that follow.
    Cycle(Box<Cycle>),
    /// End of the hole cycle.
    CycleOff,
    /// Feed from here on.
    Feed(Feed),
    /// What happens at corners from here on.
    PathMode(PathMode),
    /// Spindle from here on.
    Spindle(Spindle),
    /// Constant surface speed from here on, m/min: the spindle turns as fast as the distance of the tool
    /// from X 0 asks for, and its own speed is the most. `None` is its own speed again. It is for turning,
    /// and no mill's writer makes it.
    SurfaceSpeed(Option<f64>),
    /// Coolant from here on.
    Coolant(Coolant),
    /// The beam from here on.
    Beam(Beam),
    /// The laser fires so many pulses where it stands.
    Pulses(u32),
    /// Change to this tool.
    Tool(Box<Tool>),
    /// Make this tool number ready; nothing is changed yet.
    Preselect(u32),
    /// Cutter radius compensation from here on.
    Compensation(Compensation),
    /// Set-up frame from here on: local coordinates to the work frame. Poses are **already** in the
    /// work frame; writers use the frame to tilt the plane of work (3+2).
    Frame(Box<Frame>),
    /// Work offset from here on. Poses are in its frame, and how far it is from the one before
    /// is not known. A source without one leaves it to the machine.
    WorkOffset(WorkOffset),
    /// The zero of a work offset is written into the table of the control, where it stays when the program has ended.
    WorkOffsetData(Box<WorkOffsetData>),
    /// From here on poses below [`Surface::clear`] count from this surface, whose heights probing moves have
    /// found: the control raises each by the height of the surface there. Others count from Z 0, as before.
    Surface(Box<Surface>),
    /// Brakes of axes are closed or opened.
    Clamp(Clamp),
    /// An output of the machine is set.
    Output(Output),
    /// The program waits for an input of the machine, or reads it.
    Input(Box<Input>),
    /// A function that the builder of the machine has added (APT's `AUXFUN`). What it does is known at that
    /// machine alone.
    Auxiliary(Auxiliary),
    /// The wire is threaded where it stands (wire EDM), and cuts from here on.
    ThreadWire,
    /// The wire is cut: it is free of the part until it is threaded again.
    CutWire,
    /// The control leans the wire from here on, degrees: to the left of its way where positive, to the
    /// right where negative, 0 for not at all. Poses stay those of the lower end, upright.
    Taper(f64),
    /// Dwell, seconds.
    Dwell(f64),
    /// Unconditional stop.
    Stop,
    /// Stop when the operator has asked for it.
    OptionalStop,
    /// Start of an operation, by name.
    Operation(Box<str>),
    /// End of the operation.
    EndOfOperation,
    /// Words for the reader of the program.
    Comment(Box<str>),
    /// Words for the operator's screen.
    Message(Box<str>),
    /// End of the program.
    End,
}

/// Defines [`Kind`] with the name of each and the answer of [`Op::kind`].
macro_rules! kinds {
    ($($kind:ident $name:literal $pattern:pat,)*) => {
        /// Which record it is, without what it says.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Kind {
            $(#[doc = concat!("[`Op::", stringify!($kind), "`].")] $kind,)*
        }

        impl Kind {
            /// Every kind, in the order of [`Op`].
            pub const ALL: [Kind; [$(Kind::$kind),*].len()] = [$(Kind::$kind),*];

            /// Its name, as users see it.
            pub fn name(self) -> &'static str {
                match self {
                    $(Kind::$kind => $name,)*
                }
            }
        }

        impl Op {
            /// Which record it is.
            pub fn kind(&self) -> Kind {
                match self {
                    $($pattern => Kind::$kind,)*
                }
            }
        }
    };
}

kinds! {
    Rapid "rapid" Op::Rapid(_),
    Line "line" Op::Line(_),
    Arc "arc" Op::Arc(_),
    Thread "thread" Op::Thread(_),
    Probe "probe" Op::Probe(_),
    Hole "hole" Op::Hole(_),
    Oriented "oriented" Op::Oriented(_),
    Joints "joints" Op::Joints(_),
    MachineMove "machine-move" Op::MachineMove(_),
    Home "home" Op::Home,
    Cycle "cycle" Op::Cycle(_),
    CycleOff "cycle-off" Op::CycleOff,
    Feed "feed" Op::Feed(_),
    PathMode "path-mode" Op::PathMode(_),
    Spindle "spindle" Op::Spindle(_),
    SurfaceSpeed "surface-speed" Op::SurfaceSpeed(_),
    Coolant "coolant" Op::Coolant(_),
    Beam "beam" Op::Beam(_),
    Pulses "pulses" Op::Pulses(_),
    Tool "tool" Op::Tool(_),
    Preselect "preselect" Op::Preselect(_),
    Compensation "compensation" Op::Compensation(_),
    Frame "frame" Op::Frame(_),
    WorkOffset "work-offset" Op::WorkOffset(_),
    WorkOffsetData "work-offset-data" Op::WorkOffsetData(_),
    Surface "surface" Op::Surface(_),
    Clamp "clamp" Op::Clamp(_),
    Output "output" Op::Output(_),
    Input "input" Op::Input(_),
    Auxiliary "auxiliary" Op::Auxiliary(_),
    ThreadWire "thread-wire" Op::ThreadWire,
    CutWire "cut-wire" Op::CutWire,
    Taper "taper" Op::Taper(_),
    Dwell "dwell" Op::Dwell(_),
    Stop "stop" Op::Stop,
    OptionalStop "optional-stop" Op::OptionalStop,
    Operation "operation" Op::Operation(_),
    EndOfOperation "end-of-operation" Op::EndOfOperation,
    Comment "comment" Op::Comment(_),
    Message "message" Op::Message(_),
    End "end" Op::End,
}

impl Op {
    /// Whether nobody knows behind this record where the tool stands in the work frame.
    #[inline]
    pub fn loses_position(&self) -> bool {
        matches!(
            self,
            Op::Tool(_)
                | Op::Home
                | Op::WorkOffset(_)
                | Op::Probe(_)
                | Op::Joints(_)
                | Op::MachineMove(_)
        )
    }

    /// The pose the tool has after this record, where the record moves it to one.
    #[inline]
    pub fn pose(&self) -> Option<&Pose> {
        match self {
            Op::Rapid(pose) | Op::Line(pose) | Op::Hole(pose) => Some(pose),
            Op::Arc(arc) => Some(&arc.end),
            Op::Thread(thread) => Some(&thread.end),
            Op::Oriented(oriented) => Some(oriented.end.pose()),
            // Where these end only the machine knows.
            Op::Probe(_) | Op::Joints(_) | Op::MachineMove(_) | Op::Home => None,
            Op::Cycle(_)
            | Op::CycleOff
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
            | Op::End => None,
        }
    }
}

impl Program {
    /// An empty program.
    pub fn new(name: impl Into<String>) -> Program {
        Program { name: name.into(), ..Program::default() }
    }

    /// The same program with other records.
    pub fn with_records(&self, records: Vec<Record>) -> Program {
        let Program { name, records: _, compensated_path, stock, sent_home } = self;
        let (compensated_path, stock, sent_home) = (*compensated_path, *stock, *sent_home);
        Program { name: name.clone(), records, compensated_path, stock, sent_home }
    }

    /// The records for a pass over all of them, which ends where the work that it belongs to is [ended](geom::ending).
    pub fn each(&self) -> impl Iterator<Item = &Record> {
        self.records.iter().inspect(|_| go_on())
    }

    /// Adds a record that came from `line` of the source.
    pub fn push(&mut self, line: u32, op: Op) {
        self.records.push(Record { line, op });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Statistics;
    use crate::{CutBox, PathEvidence};
    use geom::ending::Ended;

    #[test]
    fn a_pass_over_all_records_ends_with_its_work() {
        let mut program = Program::new("t");
        program.push(1, Op::End);
        let ended = Ended::default();
        let is_ended = |answer: Option<()>| assert_eq!(answer, None);
        assert_eq!(ended.run(|| program.each().count()), Some(1));
        ended.end();
        is_ended(ended.run(|| program.each().for_each(|_| ())));
        is_ended(ended.run(|| _ = Statistics::of(&program)));
        is_ended(ended.run(|| _ = CutBox::of(&program)));
        is_ended(ended.run(|| _ = PathEvidence::of(&program)));
    }

    #[test]
    fn a_move_takes_at_most_64_bytes() {
        assert!(size_of::<Record>() <= 64, "{}", size_of::<Record>());
    }
}
