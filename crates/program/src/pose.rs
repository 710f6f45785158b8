//! Where a tool is: its tip, its axis, and for a robot how far it is turned about that axis.

use crate::{Diagnostic, Rule};
use geom::Vec3;
use std::fmt;

/// How far the square of a unit vector's length may be from 1: rounding of what is computed, not of what is written.
const UNIT: f64 = 1e-9;

/// A tool tip and a tool axis, both in the work frame. Every number is finite, and the axis is a unit vector.
///
/// A wire is a tool with a direction: its point is where it crosses the lower plane, Z 0, and its axis
/// points from there to the upper end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    point: Vec3,
    axis: Vec3,
}

impl Pose {
    /// The pose of a tool whose tip is at `point`, mm, and which points along the unit vector `axis`, from the tip
    /// towards the spindle.
    ///
    /// # Errors
    /// A number that is not finite, or an axis whose length is not 1.
    #[inline]
    pub fn new(point: Vec3, axis: Vec3) -> Result<Pose, NoPose> {
        match point.is_finite() && is_unit(axis) {
            true => Ok(Pose { point, axis }),
            false => Err(NoPose::of(point, axis)),
        }
    }

    /// The pose of a tool along +Z.
    ///
    /// # Errors
    /// A coordinate that is not finite.
    #[inline]
    pub fn upright(point: Vec3) -> Result<Pose, NoPose> {
        Pose::new(point, Vec3::Z)
    }

    /// The tool tip, mm.
    #[inline]
    pub fn point(&self) -> Vec3 {
        self.point
    }

    /// Unit vector from the tool tip towards the spindle.
    #[inline]
    pub fn axis(&self) -> Vec3 {
        self.axis
    }

    /// The same axis with the tip at `point`, mm.
    ///
    /// # Errors
    /// A coordinate that is not finite.
    #[inline]
    pub fn at(self, point: Vec3) -> Result<Pose, NoPose> {
        match point.is_finite() {
            true => Ok(Pose { point, ..self }),
            false => Err(NoPose::of(point, self.axis)),
        }
    }

    /// The pose that is `height` mm away along the tool axis, away from the part where that is positive.
    ///
    /// # Errors
    /// A height that is not finite.
    #[inline]
    pub fn lifted(self, height: f64) -> Result<Pose, NoPose> {
        self.at(self.point + self.axis * height)
    }
}

/// A pose with the turn about the tool axis, as a robot needs it: a full orientation of the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullPose {
    pose: Pose,
    side: Vec3,
}

impl FullPose {
    /// The pose whose tool has its own X direction along the unit vector `side`, which is at right angles to the tool
    /// axis.
    ///
    /// # Errors
    /// A side that is no unit vector, or not at right angles to the axis within 1e-6.
    pub fn new(pose: Pose, side: Vec3) -> Result<FullPose, NoPose> {
        match is_unit(side) && side.dot(pose.axis).abs() <= 1e-6 {
            true => Ok(FullPose { pose, side }),
            false => Err(NoPose::of(pose.point, side)),
        }
    }

    /// Tip and axis.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Unit vector along which the tool's own X direction points.
    pub fn side(&self) -> Vec3 {
        self.side
    }
}

#[inline]
pub(crate) fn is_unit(axis: Vec3) -> bool {
    // False for what is not a number.
    (axis.length_squared() - 1.0).abs() <= UNIT
}

/// Numbers that make no pose and no circle: one that is not finite, or an axis that is no unit vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoPose {
    point: Vec3,
    axis: Vec3,
}

impl NoPose {
    #[cold]
    pub(crate) fn of(point: Vec3, axis: Vec3) -> NoPose {
        NoPose { point, axis }
    }
}

impl fmt::Display for NoPose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.point.to_array();
        let [i, j, k] = self.axis.to_array();
        match self.point.is_finite() {
            true => write!(f, "({i}, {j}, {k}) is no direction of length 1"),
            false => write!(f, "X{x} Y{y} Z{z} is no position"),
        }
    }
}

impl std::error::Error for NoPose {}

impl From<NoPose> for Box<Diagnostic> {
    fn from(numbers: NoPose) -> Box<Diagnostic> {
        let help =
            "every coordinate must be a finite number of mm, and a tool axis a vector of length 1";
        Diagnostic::error(Rule::NoPose, numbers.to_string()).help(help).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_holds_finite_numbers_and_a_unit_vector_alone() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(Pose::upright(Vec3::new(0.0, bad, 0.0)).is_err(), "{bad}");
            assert!(Pose::new(Vec3::ZERO, Vec3::new(0.0, 0.0, bad)).is_err(), "{bad}");
        }
        let pose = Pose::upright(Vec3::ONE).unwrap();
        for axis in [Vec3::ZERO, Vec3::new(0.0, 0.0, 1.000_01), Vec3::ONE] {
            assert!(Pose::new(Vec3::ZERO, axis).is_err(), "{axis}");
        }
        assert!(Pose::new(Vec3::ZERO, Vec3::new(0.6, 0.0, 0.8)).is_ok());
        assert!(pose.at(Vec3::NAN).is_err());
        assert!(pose.lifted(f64::MAX).is_ok_and(|pose| pose.lifted(f64::MAX).is_err()));
    }

    #[test]
    fn the_side_of_a_tool_is_across_its_axis() {
        let pose = Pose::upright(Vec3::ZERO).unwrap();
        assert!(FullPose::new(pose, Vec3::X).is_ok());
        assert!(FullPose::new(pose, Vec3::Z).is_err());
        assert!(FullPose::new(pose, Vec3::new(0.8, 0.0, 0.6)).is_err());
        assert!(FullPose::new(pose, Vec3::X * 2.0).is_err());
    }

    #[test]
    fn what_makes_no_pose_says_which_number() {
        let found: Box<Diagnostic> =
            Pose::upright(Vec3::new(1.0, f64::NAN, 2.0)).unwrap_err().into();
        assert_eq!(found.message, "X1 YNaN Z2 is no position");
        let found: Box<Diagnostic> =
            Pose::new(Vec3::ZERO, Vec3::new(0.0, 0.0, 2.0)).unwrap_err().into();
        assert_eq!(found.message, "(0, 0, 2) is no direction of length 1");
    }
}
