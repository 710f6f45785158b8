//! The frames between the program's coordinates and the work frame.
//!
//! Base frame (the work frame, that of the settable offset at the first move in it) ← change of that
//! offset since ← swivelled plane (`CYCLE800`) ←
//! programmable frame (`TRANS`, `ROT`) ← the program.

use geom::{Frame, Mat3, Vec3};

/// The chain of frames.
pub(crate) struct Frames {
    offset_change: Vec3,
    swivel: Option<Frame>,
    programmable: Frame,
    /// The part of the programmable translation that `ATRANS` and `G59` have added.
    fine: Vec3,
    total: Frame,
    /// The lengths of the axes of the program where they are parallel to those of the work frame.
    scale: Vec3,
    turned: bool,
}

impl Frames {
    /// None but the work frame.
    pub fn new() -> Frames {
        Frames {
            offset_change: Vec3::ZERO,
            swivel: None,
            programmable: Frame::IDENTITY,
            fine: Vec3::ZERO,
            total: Frame::IDENTITY,
            scale: Vec3::ONE,
            turned: false,
        }
    }

    /// The programmable frame.
    pub fn programmable(&self) -> Frame {
        self.programmable
    }

    /// The part of its translation that has been added.
    pub fn fine(&self) -> Vec3 {
        self.fine
    }

    /// Sets the programmable frame, and the part of its translation that has been added.
    pub fn set_programmable(&mut self, frame: Frame, fine: Vec3) {
        self.programmable = frame;
        self.fine = fine;
        self.combine();
    }

    /// The swivelled plane, where one is active.
    pub fn swivel(&self) -> Option<Frame> {
        self.swivel
    }

    /// Sets the swivelled plane.
    pub fn set_swivel(&mut self, frame: Option<Frame>) {
        self.swivel = frame;
        self.combine();
    }

    /// Sets by how much the settable offset has changed since the first move in it.
    pub fn set_offset_change(&mut self, change: Vec3) {
        self.offset_change = change;
        self.combine();
    }

    fn combine(&mut self) {
        self.total = Frame::from_translation(self.offset_change)
            * self.swivel.unwrap_or(Frame::IDENTITY)
            * self.programmable;
        let matrix = self.total.matrix3;
        self.scale = Vec3::new(matrix.x_axis.x, matrix.y_axis.y, matrix.z_axis.z);
        self.turned = matrix != Mat3::from_diagonal(self.scale);
    }

    /// Whether the program's axes are not parallel to those of the work frame.
    pub fn turned(&self) -> bool {
        self.turned
    }

    /// Whether the program's axes are those of the work frame, moved at most.
    pub fn moved_only(&self) -> bool {
        !self.turned && self.scale == Vec3::ONE
    }

    /// Whether lengths along axis `axis` of the program are as long in the work frame and the other two
    /// turn about it the same way or mirrored (-1); nothing where neither is so.
    pub fn sense_about(&self, axis: usize) -> Option<f64> {
        let matrix = self.total.matrix3;
        let determinant = matrix.determinant();
        let rigid = (determinant.abs() - 1.0).abs() < 1e-9
            && (0..3).all(|i| (matrix.col(i).length() - 1.0).abs() < 1e-9);
        let kept = determinant > 0.0 || matrix.col(axis.min(2)) == Vec3::AXES[axis.min(2)];
        (rigid && kept).then_some(determinant.signum())
    }

    /// A point of the program in the work frame. Without a rotation each coordinate, known or not
    /// (NaN), stays for itself.
    #[inline(always)]
    pub fn in_work_frame(&self, point: Vec3) -> Vec3 {
        if self.turned {
            self.total.transform_point3(point)
        } else {
            point * self.scale + self.total.translation
        }
    }

    /// A point of the work frame in the coordinates of the program.
    pub fn in_program(&self, point: Vec3) -> Vec3 {
        if self.turned {
            self.total.inverse().transform_point3(point)
        } else {
            (point - self.total.translation) / self.scale
        }
    }

    /// A direction of the program in the work frame; its length means nothing.
    pub fn direction(&self, vector: Vec3) -> Vec3 {
        self.total.transform_vector3(vector)
    }

    /// The unit vector about which a circle turns in the work frame that turns about `normal` (a unit
    /// vector) in the program; nothing where it is no circle there.
    pub fn circle_normal(&self, normal: Vec3) -> Option<Vec3> {
        if self.moved_only() {
            return Some(normal);
        }
        let (across, along) = normal.any_orthonormal_pair();
        let (across, along) = (self.direction(across), self.direction(along));
        let (a, b) = (across.length(), along.length());
        let round = (a - b).abs() <= 1e-9 * a && across.dot(along).abs() <= 1e-9 * a * b;
        round.then(|| across.cross(along).normalize())
    }
}

/// A rotation by degrees about axis 0 (X), 1 (Y) or 2 (Z), right-handed.
pub(super) fn about(axis: usize, degrees: f64) -> Mat3 {
    // Whole quarter turns are exact, so that a plane on its side has no traces of the others.
    let quarters = degrees / 90.0;
    let (sin, cos) = if quarters.fract() == 0.0 {
        match quarters.rem_euclid(4.0) as u8 {
            0 => (0.0, 1.0),
            1 => (1.0, 0.0),
            2 => (0.0, -1.0),
            _ => (-1.0, 0.0),
        }
    } else {
        degrees.to_radians().sin_cos()
    };
    let columns = match axis {
        0 => [[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]],
        1 => [[cos, 0.0, -sin], [0.0, 1.0, 0.0], [sin, 0.0, cos]],
        _ => [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]],
    };
    Mat3::from_cols_array_2d(&columns)
}

/// The rotation of `ROT X.. Y.. Z..`: about Z, then about the new Y, then about the new X (RPY, the
/// control's setting MD10600 = 1; Function Manual K2, frames).
pub(super) fn roll_pitch_yaw(degrees: Vec3) -> Mat3 {
    about(2, degrees.z) * about(1, degrees.y) * about(0, degrees.x)
}

/// The axes of the three rotations of `CYCLE800` with `mode`, where it swivels axis by axis: bits 1
/// and 0 name the first, 3 and 2 the second, 5 and 4 the third (1 X, 2 Y, 3 Z).
pub(super) fn swivel_order(mode: u32) -> Option<[usize; 3]> {
    if mode >> 6 != 0 {
        return None;
    }
    let axis = |shift: u32| ((mode >> shift & 3) as usize).checked_sub(1);
    Some([axis(0)?, axis(2)?, axis(4)?])
}

/// The plane of `CYCLE800`: moved to `before`, turned by three angles (degrees) one after the other,
/// each about an axis of what the last has turned, then moved by `after` in the turned axes.
pub(super) fn swivelled(before: Vec3, order: [usize; 3], angles: [f64; 3], after: Vec3) -> Frame {
    let turned =
        about(order[0], angles[0]) * about(order[1], angles[1]) * about(order[2], angles[2]);
    Frame::from_mat3_translation(turned, before) * Frame::from_translation(after)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mode_57_turns_about_x_y_z_and_27_about_z_y_x() {
        assert_eq!(swivel_order(57), Some([0, 1, 2]));
        assert_eq!(swivel_order(27), Some([2, 1, 0]));
        assert_eq!(swivel_order(39), Some([2, 0, 1]));
        assert_eq!(swivel_order(192), None);
        assert_eq!(swivel_order(1), None);
    }

    #[test]
    fn a_quarter_about_x_takes_y_to_z_and_is_exact() {
        assert_eq!(about(0, 90.0) * Vec3::Y, Vec3::Z);
        assert_eq!(about(1, 90.0) * Vec3::Z, Vec3::X);
        assert_eq!(about(2, -90.0) * Vec3::Y, Vec3::X);
        assert!((about(2, 30.0) * Vec3::X).distance(Vec3::new(0.75f64.sqrt(), 0.5, 0.0)) < 1e-15);
    }
}
