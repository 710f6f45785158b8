//! What a control of an arm does beyond what every control does: moves of joints, poses with the whole orientation of the tool,
//! frames, and how corners are passed.
//!
//! Lengths are mm, joints degrees as the controller shows them. A [`Frame`] of a move is the frame of the tool, its tip with the Z out
//! of the tool, in the frame of the base; the base stands in the world of the controller.

use geom::{Frame, Vec3};

/// What a control of an arm does. Frames and speeds hold from their event on.
#[derive(Clone, Debug, PartialEq)]
pub enum ArmAction {
    /// The frame of the tool in that of the flange; `None` is data of the operator that the program does not state.
    Tool(Option<Box<Frame>>),
    /// The base in the world; `None` as for the tool.
    Base(Option<Box<Frame>>),
    /// Whether the base is on the flange and the tool stands (a part on the robot).
    PartOnFlange(bool),
    /// Speed of moves of joints, percent of the fastest; `None` is as the control is set up.
    JointSpeed(Option<f64>),
    /// Speed of the joint that turns farthest in the moves of joints that follow, degrees/s.
    JointRate(f64),
    /// The acceleration of the lines and arcs that follow, mm/s², where each of them states it.
    TipAcceleration(f64),
    /// That of the joint that turns farthest in the moves of joints that follow, degrees/s².
    JointAcceleration(f64),
    /// Another acceleration, of joints or of lines, than that with which the control is set up.
    Acceleration,
    /// How fast the tool may turn in lines and arcs, degrees/s: its axis, and about its axis; `None` is as the control is set up.
    TurnSpeed([Option<f64>; 2]),
    /// How fast the rail on which the arm stands may go, mm/s.
    RailSpeed(f64),
    /// The program goes on in the file of this name, or in the one that is run where it has none: the arm stops there. The line of this event is
    /// still of the file before.
    File(Option<Box<str>>),
    /// A motion.
    Move(Box<ArmMove>),
    /// What hangs on the flange: its mass, kg, and its centre of gravity in the frame of the flange, mm.
    Load(f64, Vec3),
    /// The load that the operator has entered under this number hangs on the flange.
    LoadNumber(u32),
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
    /// What the program says of the posture at the end; of a motion to joints nothing.
    pub posture: ArmPosture,
    /// Where the rail on which the arm stands is at the end, mm: outer axis 1, which goes evenly with the motion; `None` where no block
    /// has said it.
    pub rail: Option<f64>,
}

/// Where a motion goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ArmPath {
    /// All joints together to these positions, degrees.
    Joints([f64; 6]),
    /// All joints together to those that put the tool there.
    Point(Frame),
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

/// What a program says of the posture in which a frame is reached; nothing of what is `None`, which the controller chooses by where the
/// arm stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ArmPosture {
    /// Whether the wrist centre is behind axis 1.
    pub rear: Option<bool>,
    /// Whether the elbow is below the line from shoulder to wrist.
    pub below: Option<bool>,
    /// Whether joint 5 of the model is negative.
    pub flip: Option<bool>,
    /// From where to below where each joint is, degrees.
    pub joints: [Option<[f64; 2]>; 6],
}

/// How the end of a motion is passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Corner {
    /// The arm stops there.
    Exact,
    /// It leaves the path no farther from the end than a distance, and comes back as near behind it.
    Within(Rounding),
    /// It leaves the path by an amount that speeds, or joints, decide.
    Unbounded,
}

/// How a corner is rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding {
    /// How far from the end of the motion, mm along it.
    pub distance: f64,
    /// Whether the controller shortens that to half of the shorter motion; where it does not, it skips points whose roundings overlap.
    pub shortened: bool,
    /// Whether the arm stops at the end after all where something else than a motion follows; where it does not, that happens before the
    /// end is reached.
    pub stops: bool,
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
