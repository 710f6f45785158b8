//! Where a tool is.

use control::Position;
use geom::{Vec3, angle_between};
use machine::Machine;
use program::Pose;
use std::fmt;

/// A tool tip (mm) and a tool axis (unit vector), both in the work frame. What is not known is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PartialPose {
    pub tip: Vec3,
    pub axis: Vec3,
}

impl PartialPose {
    /// The place that a block says, with a tool of `tool_length` mm.
    pub fn of(machine: &Machine, position: &Position, tool_length: Option<f64>) -> PartialPose {
        let (tip, axis) = nc::resolve(machine, position, tool_length);
        PartialPose { tip, axis }
    }

    /// Whether every coordinate is known.
    pub fn known(&self) -> bool {
        self.tip.is_finite() && self.axis.is_finite()
    }

    /// How far `point` stands above this place along its axis, and how far from that axis, mm.
    pub fn above(&self, point: Vec3) -> (f64, f64) {
        let from = point - self.tip;
        let height = from.dot(self.axis);
        (height, (from - self.axis * height).length())
    }

    /// Whether `tip` stands off this place's axis by more than `slack` mm, or nobody knows where: the
    /// way between the two moves in the plane of work.
    pub fn is_across(&self, tip: Vec3, slack: f64) -> bool {
        let across = self.above(tip).1;
        across.is_nan() || across > slack
    }

    /// This place moved along its axis, mm.
    pub fn lifted(&self, height: f64) -> PartialPose {
        PartialPose { tip: self.tip + self.axis * height, ..*self }
    }

    /// Distance of the tips, mm, and angle of the axes, degrees. NaN where either is not known.
    pub fn apart(&self, other: &PartialPose) -> (f64, f64) {
        let angle =
            if self.axis == other.axis { 0.0 } else { angle_between(self.axis, other.axis) };
        (self.tip.distance(other.tip), angle.to_degrees())
    }
}

/// `X1 Y2 Z3`, with the tool axis behind where it is not +Z; `X1 (Y and Z not known)` where that is so.
impl fmt::Display for PartialPose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all = ["X", "Y", "Z"].into_iter().zip(self.tip.to_array());
        let (unknown, known): (Vec<_>, Vec<_>) = all.partition(|(_, value)| value.is_nan());
        if known.is_empty() {
            return write!(f, "a place that is not known");
        }
        for (i, (letter, value)) in known.into_iter().enumerate() {
            let gap = if i > 0 { " " } else { "" };
            write!(f, "{gap}{letter}{}", Number(value))?;
        }
        if !unknown.is_empty() {
            let letters: Vec<&str> = unknown.into_iter().map(|(letter, _)| letter).collect();
            write!(f, " ({} not known)", letters.join(" and "))?;
        }
        if self.axis.is_nan() {
            write!(f, " (tool axis not known)")?;
        } else if !self.axis.abs_diff_eq(Vec3::Z, 1e-9) {
            let [i, j, k] = self.axis.to_array();
            write!(f, " (tool axis {i:.6}, {j:.6}, {k:.6})")?;
        }
        Ok(())
    }
}

/// The place of a pose of the source.
impl From<&Pose> for PartialPose {
    fn from(pose: &Pose) -> PartialPose {
        PartialPose { tip: pose.point(), axis: pose.axis() }
    }
}

/// From here on a number is shown by its power of ten.
const TOO_LONG: f64 = 1e12;

/// A number for a person: at most four decimals, no trailing zeros, no `-0`, no more than twelve digits before the point.
pub(crate) struct Number(pub f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_nan() {
            return write!(f, "unknown");
        }
        if self.0.abs() >= TOO_LONG {
            return write!(f, "{:e}", self.0);
        }
        let rounded = (self.0 * 1e4).round() / 1e4;
        write!(f, "{}", if rounded == 0.0 { 0.0 } else { rounded })
    }
}

/// A place that the NC program reached: what its block says, and where that is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ResolvedPose {
    /// Line of the NC program.
    pub line: u32,
    /// What the block says.
    pub position: Position,
    /// Where that is in the work frame.
    pub place: PartialPose,
}
