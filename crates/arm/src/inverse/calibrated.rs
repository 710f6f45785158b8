//! A calibrated arm has no closed form: the joints of the nominal one, corrected until the measured links reach the frame.

use super::Solutions;
use crate::arm::{Arm, Joints, Structure};
use geom::{Frame, Mat3, Vec3, linear, wrap};

/// Steps at most: each squares what is left.
const MOST_STEPS: usize = 12;
/// What is left at the end, mm and radians.
const CLOSE: f64 = 1e-9;
/// Below this pivot the equations are those of a singular pose.
const FLATTEST: f64 = 1e-6;

/// The nominal joints `near` a frame, corrected; those that do not come to rest, close to a singularity, are left out.
pub(super) fn refine(arm: &Arm, flange: &Frame, near: &Solutions) -> Solutions {
    let mut solutions = Solutions::NONE;
    for (posture, joints) in near.iter() {
        if let Some(joints) = corrected(arm, flange, *joints) {
            solutions.set(posture, joints.map(wrap));
        }
    }
    solutions
}

fn corrected(arm: &Arm, flange: &Frame, mut joints: Joints) -> Option<Joints> {
    for _ in 0..MOST_STEPS {
        let (axes, reached) = axes(arm, &joints)?;
        let gap = flange.translation - reached.translation;
        let turn = turn(&(flange.matrix3 * reached.matrix3.transpose()));
        if gap.length() < CLOSE && turn.length() < CLOSE {
            return Some(joints);
        }
        let step = solve(&axes, &reached.translation, gap, turn)?;
        // A step of a radian has left the neighbourhood in which steps get smaller.
        if step.iter().any(|angle| angle.abs() > 1.0) {
            return None;
        }
        joints = std::array::from_fn(|i| joints[i] + step[i]);
    }
    None
}

/// A point and the direction of each axis, and the flange.
fn axes(arm: &Arm, joints: &Joints) -> Option<([(Vec3, Vec3); 6], Frame)> {
    let Structure::Ur(_, Some(calibration)) = &arm.structure else { return None };
    let mut here = Frame::from_translation(Vec3::new(0.0, 0.0, -arm.world_height));
    let axes = std::array::from_fn(|i| {
        here *= calibration.0[i];
        let axis = (here.translation, here.matrix3.z_axis);
        here *= Frame::from_mat3(Mat3::from_rotation_z(joints[i]));
        axis
    });
    Some((axes, here))
}

/// The rotation vector of a rotation by less than half a revolution.
fn turn(rotation: &Mat3) -> Vec3 {
    let (x, y, z) = (rotation.x_axis, rotation.y_axis, rotation.z_axis);
    let twice = Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x);
    let (sin, cos) = (twice.length() / 2.0, (x.x + y.y + z.z - 1.0) / 2.0);
    let angle = sin.atan2(cos);
    if sin > 0.0 { twice * (angle / (2.0 * sin)) } else { Vec3::ZERO }
}

/// The changes of the joints that move the flange by `gap` and `turn`.
fn solve(axes: &[(Vec3, Vec3); 6], flange: &Vec3, gap: Vec3, turn: Vec3) -> Option<Joints> {
    // Turns count as much as a metre, so that rows are of one size.
    const METRE: f64 = 1000.0;
    let six = |moved: Vec3, turned: Vec3| {
        let Vec3 { x, y, z } = turned * METRE;
        [moved.x, moved.y, moved.z, x, y, z]
    };
    let columns = axes.map(|(point, axis)| six(axis.cross(*flange - point), axis));
    linear::solve(&columns, six(gap, turn), FLATTEST)
}
