//! The plane of compensation.

use geom::{Vec2, Vec3};

/// Points closer than this are one, mm: rounding of what is computed from four decimals.
pub(super) const SAME: f64 = 1e-6;

/// Two axes and the normal, right-handed, in the frame of the poses.
#[derive(Clone, Copy)]
pub(super) struct Plane {
    axes: [Vec3; 2],
    pub normal: Vec3,
}

impl Plane {
    /// The plane across the unit vector `normal`.
    pub(super) fn new(normal: Vec3) -> Plane {
        let (first, second) = normal.any_orthonormal_pair();
        Plane { axes: [first, second], normal }
    }

    /// A point in the plane, and its height above it.
    pub(super) fn flat(&self, point: Vec3) -> (Vec2, f64) {
        (Vec2::new(point.dot(self.axes[0]), point.dot(self.axes[1])), point.dot(self.normal))
    }

    /// The point in space.
    pub(super) fn lift(&self, point: Vec2, height: f64) -> Vec3 {
        self.axes[0] * point.x + self.axes[1] * point.y + self.normal * height
    }
}
