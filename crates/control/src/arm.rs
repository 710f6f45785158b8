//! What a control of an arm does beyond what every control does: moves of joints, poses with the whole orientation of the tool,
//! frames, and how corners are passed.
//!
//! Lengths are mm, joints degrees as the controller shows them. A [`Frame`] of a move is the frame of the tool, its tip with the Z out
//! of the tool, in the frame of the base; the base stands in the world of the controller.

use geom::Frame;

/// What a control of an arm does. Frames and speeds hold from their event on.
#[derive(Clone, Debug, PartialEq)]
pub enum ArmAction {
    /// The frame of the tool in that of the flange; `None` is data of the operator that the program does not state.
    Tool(Option<Frame>),
    /// The base in the world; `None` as for the tool.
    Base(Option<Frame>),
    /// Whether the base is on the flange and the tool stands (a part on the robot).
    PartOnFlange(bool),
    /// Speed of moves of joints, percent of the fastest.
    JointSpeed(f64),
    /// How fast the tool may turn in lines and arcs, degrees/s: its axis, and about its axis; `None` is as the control is set up.
    TurnSpeed([Option<f64>; 2]),
    /// A motion.
    Move(Box<ArmMove>),
    /// The load on the flange is stated.
    Load,
}

/// A motion of an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmMove {
    /// Where it goes.
    pub path: ArmPath,
    /// How its end is passed.
    pub corner: Corner,
    /// How the tool turns on the way of a straight line or an arc; `None` is as the control is set up.
    pub turning: Option<Turning>,
}

/// Where a motion goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ArmPath {
    /// All joints together to these positions, degrees.
    Joints([f64; 6]),
    /// All joints together to those that put the tool there, in a posture that `status` and `turn` say, as the maker counts them;
    /// `None` leaves it to where the arm stands.
    Point {
        /// The tool.
        end: Frame,
        /// The posture (KUKA's S).
        status: Option<u8>,
        /// The signs of the joints (KUKA's T).
        turn: Option<u8>,
    },
    /// The tip straight to a frame at the active feed.
    Line(Frame),
    /// The tip on a circle through the origin of `via` to `end` at the active feed.
    Arc {
        /// A point on the way.
        via: Frame,
        /// Where it ends.
        end: Frame,
    },
}

/// How the end of a motion is passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Corner {
    /// The arm stops there.
    Exact,
    /// It leaves the path no farther from the end than this, mm along it, and comes back as near behind it.
    Within(f64),
    /// It leaves the path by an amount that speeds, or joints, decide.
    Unbounded,
}

/// How the tool turns on the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turning {
    /// Evenly from the orientation at the start to that at the end, about one axis.
    Even,
    /// It keeps the orientation of the start.
    Kept,
    /// Evenly, with the orientation counted along the path of an arc.
    AlongPath,
    /// As the joints of the wrist turn evenly.
    ByJoints,
}
