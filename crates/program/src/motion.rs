//! What motions need beside the pose where they end.

use crate::{FullPose, Pose};
use geom::Vec3;

/// An arc or helix from where the tool is, which ends at a pose of the type `P`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcTo<P = Pose> {
    /// Where it ends. The orientation holds during the arc.
    pub end: P,
    /// A point of the axis of the arc, in the frame of the pose's point.
    pub center: Vec3,
    /// Unit vector about which the arc turns counter-clockwise.
    pub normal: Vec3,
    /// Full turns more than the shortest.
    pub turns: u32,
}

/// A thread from where the tool is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thread<P = Pose> {
    /// Where it ends.
    pub end: P,
    /// mm along the way for each turn of the spindle.
    pub pitch: f64,
}

/// A probing move from where the tool is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe<P = Pose> {
    /// Where it ends at the latest.
    pub end: P,
    /// Whether it ends where the probe lets go of the part (`G38.4`, `G38.5`), and not where it touches
    /// it.
    pub away: bool,
    /// Whether a probe that has not answered on the way stops the program (`G38.2`, `G38.4`).
    pub must_answer: bool,
    /// The place of a [`Surface`](crate::Surface) whose height is kept where it answers, counted from 0 row by row.
    pub place: Option<u32>,
}

/// A motion to a full orientation of the tool, as a robot makes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Oriented {
    /// Where it ends.
    pub end: FullPose,
    /// How it goes there.
    pub course: Course,
    /// In which of the ways that reach the pose the arm ends; `None` leaves it to the writer.
    pub configuration: Option<Configuration>,
    /// Positions of the external axes where it ends, mm or degrees; none for those that stay.
    pub external: Vec<f64>,
}

/// How an oriented motion goes to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// Joint by joint, all at the same time: the way is the arm's own.
    Rapid,
    /// Straight at the active feed.
    Line,
    /// On an arc at the active feed, as [`ArcTo`] says it.
    Arc {
        /// A point of the axis of the arc, mm.
        center: Vec3,
        /// Unit vector about which the arc turns counter-clockwise.
        normal: Vec3,
        /// Full turns more than the shortest.
        turns: u32,
    },
}

/// In which of the ways that reach a pose an arm stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration {
    /// Whether the arm reaches over its first axis, backwards.
    pub backward: bool,
    /// Whether the elbow is below the line from shoulder to wrist.
    pub elbow_down: bool,
    /// Whether the fifth joint is below 0.
    pub flipped: bool,
    /// Full turns of the first, the fourth and the sixth joint beyond ±180 degrees.
    pub turns: [i8; 3],
}

/// A motion of the joints of an arm, all at the same time, to positions that are given.
#[derive(Clone, Debug, PartialEq)]
pub struct JointMove {
    /// Where each joint ends, degrees.
    pub degrees: [f64; 6],
    /// Positions of the external axes, mm or degrees.
    pub external: Vec<f64>,
}

/// A rapid of some axes to positions that count from the zero of the machine (`G53`, `SUPA`, `M91`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MachineMove {
    /// Where X, Y and Z go, mm; `None` for an axis that stays.
    pub linear: [Option<f64>; 3],
    /// Where A, B and C go, degrees; `None` for an axis that stays.
    pub rotary: [Option<f64>; 3],
}
