//! How easily an arm stands: its margins in one number, and a quick look at a path with one turn about the tool and one posture.

use crate::{Cell, Point, Worst};
use arm::{Arm, Frame, Joints, Margins, Posture, Vec3};
use geom::Mat3;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// What is ample: of a joint from its limit, of joint 5 and of the elbow from stretched or folded, radians (30 degrees).
const AMPLE_ANGLE: f64 = std::f64::consts::FRAC_PI_6;

/// Of the wrist from axis 1, mm.
const AMPLE_SHOULDER: f64 = 200.0;

/// Of a joint's speed, as a part of it that is left.
const AMPLE_SPEED: f64 = 0.5;

impl Worst {
    /// The least of the margins as a part of what is ample (30 degrees, 200 mm from axis 1, half of a joint's speed): above 1 where all are ample.
    pub fn ease(&self) -> f64 {
        let margins =
            Margins { wrist: self.wrist.0, elbow: self.elbow.0, shoulder: self.shoulder.0 };
        ease(self.limit.0, &margins).min((1.0 - self.speed.0) / AMPLE_SPEED)
    }
}

/// How easily the arm stands with these joints, as [`Worst::ease`] without speeds.
pub fn ease_of(arm: &Arm, joints: &Joints) -> f64 {
    ease(room_of(arm, joints), &arm.margins(joints))
}

fn ease(limit: f64, margins: &Margins) -> f64 {
    let angle = limit.min(margins.wrist).min(margins.elbow);
    (angle / AMPLE_ANGLE).min(margins.shoulder / AMPLE_SHOULDER)
}

/// How easily the arm stands at all of `points` with one turn about the tool, of so many, and in one posture: the best of them, as
/// [`Worst::ease`]; `None` where none reaches all. [`crate::choose`] may find a way all the same, and says whether there is one between.
pub fn stand(arm: &Arm, cell: &Cell, points: &[Point], turns: u16) -> Option<f64> {
    let off = cell.tool.inverse();
    let mut side = Vec3::X;
    let axes: Vec<(Vec3, Mat3)> = (points.iter())
        .map(|point| {
            let along = side.reject_from_normalized(point.axis);
            side = match along.length() > 0.1 {
                true => along.normalize(),
                false => point.axis.any_orthonormal_vector(),
            };
            let out = -point.axis;
            (point.tip, Mat3::from_cols(side, out.cross(side), out))
        })
        .collect();
    let at_turn = |turn: u16| {
        let about = Mat3::from_rotation_z(TAU * f64::from(turn) / f64::from(turns));
        let mut least: Option<BTreeMap<Posture, f64>> = None;
        for (tip, axes) in &axes {
            let tool = Frame::from_mat3_translation(*axes * about, *tip);
            let found = arm.inverse(&(cell.part * tool * off), 0.0);
            let here = found.iter().filter_map(|(posture, joints)| {
                Some((posture, ease(room(arm, joints)?, &arm.margins(joints))))
            });
            let before = least.take();
            let kept = here.filter_map(|(posture, here)| match &before {
                None => Some((posture, here)),
                Some(before) => before.get(&posture).map(|least| (posture, least.min(here))),
            });
            let kept: BTreeMap<Posture, f64> = kept.collect();
            if kept.is_empty() {
                return None;
            }
            least = Some(kept);
        }
        least?.into_values().reduce(f64::max)
    };
    (0..turns).filter_map(at_turn).reduce(f64::max)
}

/// How far the joints are from their limits, radians, in that revolution of each in which it is most; `None` where a limit is passed.
fn room(arm: &Arm, joints: &Joints) -> Option<f64> {
    arm.within(joints).map(|joints| room_of(arm, &joints)).reduce(f64::max)
}

fn room_of(arm: &Arm, joints: &Joints) -> f64 {
    let all = arm.joints().iter().zip(joints);
    all.map(|(joint, at)| (at - joint.min).min(joint.max - at)).fold(f64::INFINITY, f64::min)
}
