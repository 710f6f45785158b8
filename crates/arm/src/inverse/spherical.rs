//! Seven lengths: the wrist centre gives joints 1 to 3, what is left of the orientation gives 4 to 6.

use super::{Solutions, WRIST_FREE, root};
use crate::arm::Spherical;
use crate::posture::Posture;
use geom::{Mat3, Vec3};
use std::f64::consts::PI;

/// Sine and cosine of an angle.
#[derive(Clone, Copy)]
struct Direction {
    sin: f64,
    cos: f64,
}

impl Direction {
    fn angle(self) -> f64 {
        self.sin.atan2(self.cos)
    }

    /// The angle that is this one and `other` together.
    fn plus(self, other: Direction) -> Direction {
        Direction {
            sin: self.sin * other.cos + self.cos * other.sin,
            cos: self.cos * other.cos - self.sin * other.sin,
        }
    }
}

/// The solutions in posture `of`, or all, and those that differ from it by the wrist; joint 4 is `free` where it may stand anywhere.
pub(super) fn inverse(
    arm: &Spherical,
    axes: &Mat3,
    flange: Vec3,
    (free, of): (f64, Option<Posture>),
) -> Solutions {
    let mut solutions = Solutions::NONE;
    let centre = flange - axes.z_axis * arm.c4 - Vec3::new(0.0, 0.0, arm.c1);
    // The plane of the arm passes axis 1 at the distance b.
    let square = centre.x * centre.x + centre.y * centre.y;
    let Some(front) = root(square - arm.b * arm.b, square) else { return solutions };
    let rears = [false, true].into_iter().filter(|rear| of.is_none_or(|of| of.rear() == *rear));
    for rear in rears {
        let front = if rear { -front } else { front };
        let first = match square > 0.0 {
            true => Direction {
                sin: (centre.y * front - centre.x * arm.b) / square,
                cos: (centre.x * front + centre.y * arm.b) / square,
            },
            // The wrist centre is on axis 1, which may stand anywhere.
            false => Direction { sin: 0.0, cos: 1.0 },
        };
        bent(arm, axes, first, [front - arm.a1, centre.z], (free, of), rear, &mut solutions);
    }
    solutions
}

/// Both positions of the elbow, for the wrist centre `ahead` and `up` of axis 2 in the plane of the arm.
fn bent(
    arm: &Spherical,
    axes: &Mat3,
    first: Direction,
    [ahead, up]: [f64; 2],
    (free, of): (f64, Option<Posture>),
    rear: bool,
    solutions: &mut Solutions,
) {
    let forearm = arm.a2.hypot(arm.c3);
    let bend = Direction { sin: arm.a2 / forearm, cos: arm.c3 / forearm };
    let distance = ahead * ahead + up * up;
    let cos = (distance - arm.c2 * arm.c2 - forearm * forearm) / (2.0 * arm.c2 * forearm);
    let Some(sin) = root(1.0 - cos * cos, 1.0) else { return };
    let cos = cos.clamp(-1.0, 1.0);
    let belows = [false, true].into_iter().filter(|below| of.is_none_or(|of| of.below() == *below));
    for below in belows {
        let elbow = Direction { sin: if below { -sin } else { sin }, cos };
        // Forearm and upper arm as seen along the upper arm.
        let (along, across) = (arm.c2 + forearm * elbow.cos, forearm * elbow.sin);
        let second = match distance > 0.0 {
            true => Direction {
                sin: (ahead * along - up * across) / distance,
                cos: (up * along + ahead * across) / distance,
            },
            false => Direction { sin: 0.0, cos: 1.0 },
        };
        let third = elbow.plus(Direction { sin: -bend.sin, cos: bend.cos });
        let [t1, t2, t3] = [first, second, third].map(Direction::angle);
        let free = arm.signs[3] * free - arm.offsets[3];
        let [t4, t5, t6] = wrist(axes, first, second.plus(third), free);
        let plain = [t1, t2, t3, t4, t5, t6];
        let flipped = [t1, t2, t3, t4 + PI, -t5, t6 + PI];
        solutions.set(Posture::of(rear, below, false), arm.joints(&plain));
        solutions.set(Posture::of(rear, below, true), arm.joints(&flipped));
    }
}

/// Angles 4 to 6, the fifth from 0 to π, of what is left of `axes` behind a turn by `first` about Z and by `lean` about Y.
fn wrist(axes: &Mat3, first: Direction, lean: Direction, free: f64) -> [f64; 3] {
    let toward = |v: Vec3| first.cos * v.x + first.sin * v.y;
    let aside = |v: Vec3| first.cos * v.y - first.sin * v.x;
    // The flange's Z in the frame of the forearm.
    let z = axes.z_axis;
    let x = lean.cos * toward(z) - lean.sin * z.z;
    let (y, along) = (aside(z), lean.sin * toward(z) + lean.cos * z.z);
    let across = x.hypot(y);
    let (t4, fourth) = match across > WRIST_FREE {
        true => (y.atan2(x), Direction { sin: y / across, cos: x / across }),
        false => (free, Direction { sin: free.sin(), cos: free.cos() }),
    };
    // The direction of axis 5 lies at right angles to the flange's Z: what it makes with X and Y is joint 6.
    let level = -fourth.sin * lean.cos;
    let axis = Vec3::new(
        first.cos * level - first.sin * fourth.cos,
        first.sin * level + first.cos * fourth.cos,
        fourth.sin * lean.sin,
    );
    [t4, across.atan2(along), axis.dot(axes.x_axis).atan2(axis.dot(axes.y_axis))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::Joints;

    #[test]
    fn a_sum_of_directions_is_the_direction_of_the_sum() {
        let at = |angle: f64| Direction { sin: angle.sin(), cos: angle.cos() };
        assert!((at(0.4).plus(at(1.1)).angle() - 1.5).abs() < 1e-15);
    }

    #[test]
    fn joints_come_back_as_the_angles_that_they_were_made_of() {
        let arm = Spherical {
            a1: 0.0,
            a2: 0.0,
            b: 0.0,
            c1: 0.0,
            c2: 1.0,
            c3: 1.0,
            c4: 0.0,
            offsets: [0.0, -PI / 2.0, 0.0, 0.0, 0.0, PI],
            signs: [-1.0, 1.0, 1.0, -1.0, 1.0, -1.0],
        };
        let joints: Joints = [0.1, -0.2, 0.3, 3.1, -0.5, 0.6];
        let again = arm.joints(&arm.angles(&joints));
        assert!(again.iter().zip(&joints).all(|(a, b)| (a - b).abs() < 1e-15), "{again:?}");
    }
}
