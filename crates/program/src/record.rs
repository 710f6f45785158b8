//! The records of a program.

use crate::Surface;
use geom::{Frame, Vec3};

/// A program in the neutral vocabulary.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// What the program is called: the part number of the source, or its file name.
    pub name: String,
    /// The records in the order in which they happen.
    pub records: Vec<Record>,
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
    /// The hole cycle for the [`Op::Hole`]s that follow.
    Cycle(Box<Cycle>),
    /// End of the hole cycle.
    CycleOff,
    /// Feed from here on.
    Feed(Feed),
    /// Spindle from here on.
    Spindle(Spindle),
    /// Constant surface speed from here on, m/min: the spindle turns as fast as the distance of the tool
    /// from X 0 asks for, and its own speed is the most. `None` is its own speed again. It is for turning,
    /// and no mill's writer makes it.
    SurfaceSpeed(Option<f64>),
    /// Coolant from here on.
    Coolant(Coolant),
    /// Change to this tool.
    Tool(Box<Tool>),
    /// Make this tool number ready; nothing is changed yet.
    Preselect(u32),
    /// Tool length offset from here on (virtual controls only): the register, or none.
    LengthOffset(Option<u32>),
    /// Cutter radius compensation from here on.
    Compensation(Compensation),
    /// Set-up frame from here on: local coordinates to the work frame. Poses are **already** in the
    /// work frame; writers use the frame to tilt the plane of work (3+2).
    Frame(Box<Frame>),
    /// Work offset from here on, by its place among those that the control can set: 54 is the first
    /// (`G54`), 55 the second; 53 is none. Poses are in its frame, and how far it is from the one before
    /// is not known. A source without one leaves it to the machine.
    WorkOffset(u32),
    /// From here on poses below [`Surface::clear`] count from this surface, whose heights probing moves have
    /// found: the control raises each by the height of the surface there. Others count from Z 0, as before.
    Surface(Box<Surface>),
    /// The wire is threaded where it stands (wire EDM), and cuts from here on.
    ThreadWire,
    /// The wire is cut: it is free of the part until it is threaded again.
    CutWire,
    /// The control leans the wire from here on, degrees: to the left of its way where positive, to the
    /// right where negative, 0 for not at all. Poses stay those of the lower end, upright.
    Taper(f64),
    /// Axes sent to a fixed position of the machine; bit 0 is X, 1 Y, 2 Z, 3 A, 4 B, 5 C. Their
    /// positions are not known afterwards. A source has Z alone: the tool leaves the part.
    Home(u8),
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

/// The first work offset that a control can set: `G54`.
pub const FIRST_WORK_OFFSET: u32 = 54;

/// A tool tip and an orientation.
///
/// A wire is a tool with a direction: its point is where it crosses the lower plane, Z 0, and its axis
/// points from there to the upper end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Tool tip, mm. In a virtual control's output a coordinate that no block has set yet (or that a
    /// [`Op::Home`] has made unknown) is NaN.
    pub point: Vec3,
    /// Where the tool points.
    pub orientation: Orientation,
}

/// How a pose says where the tool points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Orientation {
    /// Unit vector from the tool tip towards the spindle, in the work frame; the point is in the work
    /// frame too.
    Axis(Vec3),
    /// Positions of the rotary axes in degrees, as a block of an NC program gives them, in the order
    /// A, B, C (those the machine lacks are 0). With `tool_center` the control keeps the tip where the
    /// block says, in the work frame (`TRAORI`, `G43.4`, `M128`); without, the point is the linear
    /// axes' position and the tip follows from the machine's kinematics.
    Rotary {
        /// Degrees of A, B, C.
        degrees: [f64; 3],
        /// Whether the control does the tool-center-point transformation.
        tool_center: bool,
    },
}

impl Pose {
    /// A pose in the work frame with the tool along `axis` (a unit vector).
    pub fn new(point: Vec3, axis: Vec3) -> Pose {
        Pose { point, orientation: Orientation::Axis(axis) }
    }

    /// The tool axis in the work frame, where the pose has one.
    pub fn axis(&self) -> Option<Vec3> {
        match self.orientation {
            Orientation::Axis(axis) => Some(axis),
            Orientation::Rotary { .. } => None,
        }
    }
}

/// An arc or helix from where the tool is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcTo {
    /// Where it ends. The orientation holds during the arc.
    pub end: Pose,
    /// A point of the axis of the arc, in the frame of the pose's point.
    pub center: Vec3,
    /// Unit vector about which the arc turns counter-clockwise.
    pub normal: Vec3,
    /// Full turns more than the shortest.
    pub turns: u32,
}

/// A thread from where the tool is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thread {
    /// Where it ends.
    pub end: Pose,
    /// mm along the way for each turn of the spindle.
    pub pitch: f64,
}

/// A probing move from where the tool is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Where it ends at the latest.
    pub end: Pose,
    /// Whether it ends where the probe lets go of the part (`G38.4`, `G38.5`), and not where it touches
    /// it.
    pub away: bool,
    /// Whether a probe that has not answered on the way stops the program (`G38.2`, `G38.4`).
    pub must_answer: bool,
    /// The place of a [`Surface`] whose height is kept where it answers, counted from 0 row by row.
    pub place: Option<u32>,
}

/// How fast the tool moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feed {
    /// mm/min.
    PerMinute(f64),
    /// mm for each turn of the spindle.
    PerTurn(f64),
    /// Moves in a minute: 1 / (minutes the move takes).
    InverseTime(f64),
}

/// What the spindle does; speeds in 1/min.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spindle {
    /// Stopped.
    Off,
    /// Clockwise, seen from the spindle to the part (`M3`).
    Clockwise(f64),
    /// Counter-clockwise (`M4`).
    CounterClockwise(f64),
}

/// Which coolant runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coolant {
    /// None.
    Off,
    /// Flood (`M8`).
    Flood,
    /// Mist (`M7`).
    Mist,
    /// Flood and mist together.
    FloodAndMist,
    /// Through the tool.
    Through,
}

/// A tool as the source describes it. What the source does not say is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tool {
    /// Place in the magazine, from 1.
    pub number: u32,
    /// Its name or description.
    pub name: String,
    /// Cutting diameter, mm.
    pub diameter: Option<f64>,
    /// Corner radius, mm.
    pub corner_radius: Option<f64>,
    /// Length from the gauge line of the spindle to the tip, mm.
    pub length: Option<f64>,
    /// Register of the length offset where the source names one.
    pub offset: Option<u32>,
}

/// Cutter radius compensation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compensation {
    /// None (`G40`).
    Off,
    /// Tool on the left of the path (`G41`), with its register where one is named.
    Left(Option<u32>),
    /// Tool on the right of the path (`G42`).
    Right(Option<u32>),
}

/// A hole cycle. Heights are mm from the point of the hole, positive along the tool axis, away from
/// the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// What the tool does in the hole.
    pub kind: CycleKind,
    /// Depth of the bottom below the point, mm, greater than 0.
    pub depth: f64,
    /// Height above the point from which the tool feeds (the R plane), mm.
    pub clearance: f64,
    /// Height above the point to which the tool goes back after the hole, mm.
    pub retract: f64,
    /// Feed into the hole; `None` leaves the active feed.
    pub feed: Option<Feed>,
    /// Dwell at the bottom, s; 0 for none.
    pub dwell: f64,
    /// Depth of the first peck, mm, where the cycle pecks.
    pub first_peck: Option<f64>,
    /// Depth of each further peck, mm, where the cycle pecks.
    pub peck: Option<f64>,
}

/// What the tool does in the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CycleKind {
    /// Feed in, rapid out (`G81`, `G82` with dwell).
    Drill,
    /// Feed in by pecks, to the R plane after each (`G83`).
    Deep,
    /// Feed in by pecks with a short break of the chip after each (`G73`).
    BreakChip,
    /// Feed in in step with the spindle, reverse, feed out (`G84`, `G74`). Pitch in mm.
    Tap {
        /// mm a turn.
        pitch: f64,
        /// Left-hand thread.
        left: bool,
    },
    /// Feed in, feed out (`G85`, `G89` with dwell).
    Ream,
    /// Feed in, spindle stop, rapid out (`G86`).
    Bore,
    /// Feed in, aside from the wall, rapid out, back over the hole, where the spindle turns again (`G76`).
    FineBore(Withdrawal),
    /// Aside above the hole, down through it to the bottom, back to the axis, feed **up** to the point
    /// with the spindle turning, aside again and out (`G87`). The clearance is the height at which the
    /// tool goes aside.
    BackBore {
        /// How it passes through the hole.
        withdrawal: Withdrawal,
        /// Feed of the way through the hole, in and out; `None` is by rapid.
        through: Option<Feed>,
    },
}

/// How a boring bar leaves the wall: the spindle stops in position, and the tool goes aside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Withdrawal {
    /// How far and where to, mm, in the frame of the pose's point.
    pub aside: Vec3,
    /// Position of the spindle, degrees; `None` is the one that the machine is set to (`M19`).
    pub angle: Option<f64>,
}

impl CycleKind {
    /// How the tool leaves the wall, where it does.
    pub fn withdrawal(&self) -> Option<&Withdrawal> {
        match self {
            CycleKind::FineBore(withdrawal) | CycleKind::BackBore { withdrawal, .. } => {
                Some(withdrawal)
            }
            _ => None,
        }
    }

    /// The same, where the tool leaves the wall by `aside`.
    pub fn with_aside(mut self, aside: Vec3) -> CycleKind {
        if let CycleKind::FineBore(withdrawal) | CycleKind::BackBore { withdrawal, .. } = &mut self
        {
            withdrawal.aside = aside;
        }
        self
    }
}

impl Op {
    /// The pose the tool has after this record, where the record moves it to one.
    pub fn pose(&self) -> Option<&Pose> {
        match self {
            Op::Rapid(pose) | Op::Line(pose) | Op::Hole(pose) => Some(pose),
            Op::Arc(arc) => Some(&arc.end),
            Op::Thread(thread) => Some(&thread.end),
            _ => None,
        }
    }
}

impl Program {
    /// An empty program.
    pub fn new(name: impl Into<String>) -> Program {
        Program { name: name.into(), records: Vec::new() }
    }

    /// Adds a record that came from `line` of the source.
    pub fn push(&mut self, line: u32, op: Op) {
        self.records.push(Record { line, op });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_move_takes_at_most_72_bytes() {
        assert!(size_of::<Record>() <= 72, "{}", size_of::<Record>());
    }
}
