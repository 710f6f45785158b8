//! A calibrated arm has no closed form: the joints of the nominal one, corrected until the measured links reach the frame.

use super::Solutions;
use crate::arm::{Arm, Joints};
use crate::forward::Axis;
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
        let (reached, axes) = arm.flange_and_axes(&joints);
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

/// The rotation vector of a rotation by less than half a revolution.
fn turn(rotation: &Mat3) -> Vec3 {
    let (x, y, z) = (rotation.x_axis, rotation.y_axis, rotation.z_axis);
    let twice = Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x);
    let (sin, cos) = (twice.length() / 2.0, (x.x + y.y + z.z - 1.0) / 2.0);
    let angle = sin.atan2(cos);
    if sin > 0.0 { twice * (angle / (2.0 * sin)) } else { Vec3::ZERO }
}

/// The changes of the joints that move the flange by `gap` and `turn`.
fn solve(axes: &[Axis; 6], flange: &Vec3, gap: Vec3, turn: Vec3) -> Option<Joints> {
    // Turns count as much as a metre, so that rows are of one size.
    const METRE: f64 = 1000.0;
    let six = |moved: Vec3, turned: Vec3| {
        let Vec3 { x, y, z } = turned * METRE;
        [moved.x, moved.y, moved.z, x, y, z]
    };
    let columns =
        axes.map(|Axis { point, direction }| six(direction.cross(*flange - point), direction));
    linear::solve(&columns, six(gap, turn), FLATTEST)
}
