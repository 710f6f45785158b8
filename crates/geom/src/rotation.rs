//! Rotations as three angles, in the orders in which controls write a tilted plane.

use crate::{ANGLE_EPSILON, Mat3, wrap};

/// The order of three turns that make a rotation. Angles are radians, in the order of the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Euler {
    /// About the fixed X, then the fixed Y, then the fixed Z axis: Rz · Ry · Rx.
    FixedXyz,
    /// About X, then the turned Y, then the Z turned by both: Rx · Ry · Rz.
    MovingXyz,
    /// About Z, then the turned X, then the Z turned by both (precession, nutation, rotation):
    /// Rz · Rx · Rz.
    MovingZxz,
}

impl Euler {
    /// The rotation that the three turns make; its columns are the axes of the turned frame.
    pub fn matrix(self, [first, second, third]: [f64; 3]) -> Mat3 {
        let (x, y, z) = (Mat3::from_rotation_x, Mat3::from_rotation_y, Mat3::from_rotation_z);
        match self {
            Euler::FixedXyz => z(third) * y(second) * x(first),
            Euler::MovingXyz => x(first) * y(second) * z(third),
            Euler::MovingZxz => z(first) * x(second) * z(third),
        }
    }

    /// The three turns that make `rotation`, each in (−π, π]; the middle one in [−π/2, π/2], for
    /// [`Euler::MovingZxz`] in [0, π]. Where the first and the third axis fall together only their sum
    /// counts, and the third angle is 0.
    pub fn angles(self, rotation: &Mat3) -> [f64; 3] {
        let angles = match self {
            Euler::FixedXyz => fixed_xyz(rotation),
            // The transpose undoes the turns in the opposite order.
            Euler::MovingXyz => fixed_xyz(&rotation.transpose()).map(|angle| -angle),
            Euler::MovingZxz => moving_zxz(rotation),
        };
        // Adding zero turns −0 into 0.
        angles.map(|angle| wrap(angle) + 0.0)
    }
}

fn fixed_xyz(m: &Mat3) -> [f64; 3] {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let cos = x.x.hypot(x.y);
    let second = (-x.z).atan2(cos);
    if cos < ANGLE_EPSILON {
        [(-z.y).atan2(y.y), second, 0.0]
    } else {
        [y.z.atan2(z.z), second, x.y.atan2(x.x)]
    }
}

fn moving_zxz(m: &Mat3) -> [f64; 3] {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let sin = z.x.hypot(z.y);
    let second = sin.atan2(z.z);
    if sin < ANGLE_EPSILON {
        [x.y.atan2(x.x), second, 0.0]
    } else {
        [z.x.atan2(-z.y), second, x.z.atan2(y.z)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;
    use std::f64::consts::{FRAC_PI_2, PI};

    const ALL: [Euler; 3] = [Euler::FixedXyz, Euler::MovingXyz, Euler::MovingZxz];

    fn assert_recomposed(euler: Euler, rotation: &Mat3) {
        let again = euler.matrix(euler.angles(rotation));
        assert!(again.abs_diff_eq(*rotation, 3e-6), "{euler:?} {rotation:?} {again:?}");
    }

    #[test]
    fn angles_make_the_rotation_they_came_from_also_where_two_axes_fall_together() {
        let grid = (-12..=12).map(|i| f64::from(i) * PI / 12.0);
        for (a, b) in grid.clone().flat_map(|a| grid.clone().map(move |b| (a, b))) {
            for c in grid.clone() {
                for from in ALL {
                    let rotation = from.matrix([a, b, c]);
                    ALL.iter().for_each(|to| assert_recomposed(*to, &rotation));
                }
            }
        }
    }

    #[test]
    fn close_to_where_two_axes_fall_together_nothing_is_lost() {
        for off in [1e-3, 1e-5, 2e-6, 1e-7, 1e-12] {
            for euler in ALL {
                let b = if euler == Euler::MovingZxz { off } else { FRAC_PI_2 - off };
                assert_recomposed(euler, &euler.matrix([0.3, b, 0.4]));
            }
        }
    }

    #[test]
    fn the_order_of_the_turns_is_the_one_named() {
        let quarter = FRAC_PI_2;
        // X by 90° carries Z to −Y; then Z by 90°, about the fixed axis, carries −Y to X.
        let m = Euler::FixedXyz.matrix([quarter, 0.0, quarter]);
        assert!((m * Vec3::Z).distance(Vec3::X) < 1e-15);
        // About the turned axis the tool axis is what is turned about: it stays −Y.
        let m = Euler::MovingXyz.matrix([quarter, 0.0, quarter]);
        assert!((m * Vec3::Z).distance(Vec3::NEG_Y) < 1e-15);
        // Precession turns X to Y; nutation about that carries Z to X.
        let m = Euler::MovingZxz.matrix([quarter, quarter, 0.0]);
        assert!((m * Vec3::Z).distance(Vec3::X) < 1e-15);
    }

    #[test]
    fn no_rotation_is_three_plain_zeros() {
        for euler in ALL {
            let angles = euler.angles(&Mat3::IDENTITY);
            assert!(angles.iter().all(|a| *a == 0.0 && a.is_sign_positive()), "{angles:?}");
        }
    }
}
