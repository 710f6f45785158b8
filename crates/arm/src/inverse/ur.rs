//! Universal Robots: joints 2, 3 and 4 turn about one direction, which joint 1 sets.

use super::{Solutions, WRIST_FREE, root};
use crate::arm::Dh;
use crate::posture::Posture;
use geom::{Mat3, Vec3, wrap};

/// The solutions in posture `of`, or all, and those that differ from it by the elbow; joint 6 is `free` where it may stand anywhere.
pub(super) fn inverse(
    dh: &Dh,
    axes: &Mat3,
    flange: Vec3,
    (free, of): (f64, Option<Posture>),
) -> Solutions {
    let mut solutions = Solutions::NONE;
    // The end of the wrist lies at the distance d4 from the plane through axis 1 in which the links bend.
    let end = flange - axes.z_axis * dh.d6;
    let square = end.x * end.x + end.y * end.y;
    let Some(front) = root(square - dh.d4 * dh.d4, square) else { return solutions };
    if square == 0.0 {
        return solutions;
    }
    let rears = [false, true].into_iter().filter(|rear| of.is_none_or(|of| of.rear() == *rear));
    for rear in rears {
        let front = if rear { -front } else { front };
        // Unit vectors in the bending plane, and along axes 2, 3 and 4.
        let ahead =
            Vec3::new(end.x * front - end.y * dh.d4, end.y * front + end.x * dh.d4, 0.0) / square;
        let across = Vec3::new(ahead.y, -ahead.x, 0.0);
        let shoulder = Shoulder { ahead, across, rear };
        let flips = [false, true].into_iter().filter(|flip| of.is_none_or(|of| of.flip() == *flip));
        for flip in flips {
            wrist(dh, axes, end, &shoulder, flip, free, &mut solutions);
        }
    }
    solutions
}

/// How joint 1 stands.
struct Shoulder {
    ahead: Vec3,
    across: Vec3,
    rear: bool,
}

/// Joints 5 and 6, then both positions of the elbow.
fn wrist(
    dh: &Dh,
    axes: &Mat3,
    end: Vec3,
    shoulder: &Shoulder,
    flip: bool,
    free: f64,
    solutions: &mut Solutions,
) {
    let Shoulder { ahead, across, rear } = shoulder;
    let [x, y, z] = [axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| axis.dot(*across));
    let sin = if flip { -x.hypot(y) } else { x.hypot(y) };
    let q5 = sin.atan2(z);
    let (q6, s6, c6) = match sin.abs() > WRIST_FREE {
        true => ((-y / sin).atan2(x / sin), -y / sin, x / sin),
        false => (free, free.sin(), free.cos()),
    };
    // Axis 5, and the X of the frame of joint 4.
    let fifth = -(axes.x_axis * s6 + axes.y_axis * c6);
    let fourth = (axes.x_axis * c6 - axes.y_axis * s6) * z - axes.z_axis * sin;
    let joint_4 = end - fifth * dh.d5 - *across * dh.d4;
    let (along, up) = (joint_4.dot(*ahead), joint_4.z - dh.d1);
    let sum = fourth.z.atan2(fourth.dot(*ahead));
    let distance = along * along + up * up;
    let cos = (distance - dh.a2 * dh.a2 - dh.a3 * dh.a3) / (2.0 * dh.a2 * dh.a3);
    let Some(sin) = root(1.0 - cos * cos, 1.0) else { return };
    let q1 = ahead.y.atan2(ahead.x);
    for below in [false, true] {
        let q3 = if below { -sin } else { sin }.atan2(cos);
        let q2 = up.atan2(along) - (dh.a3 * q3.sin()).atan2(dh.a2 + dh.a3 * q3.cos());
        let joints = [q1, q2, q3, sum - q2 - q3, q5, q6].map(wrap);
        solutions.set(Posture::of(*rear, below, flip), joints);
    }
}
