//! The joints along a path of the tool: from where they stand, step by step, by the forward kinematics alone.

use ::arm::{Arm, Joints, Posture};
use geom::{Frame, Mat3, Quat, Vec3, linear};

/// Points of a path are at most so far apart, mm.
const SPACING: f64 = 5.0;

/// The tool turns by at most so much between two of them, radians.
const TURN: f64 = 0.035;

/// Most points of one motion.
const MOST: f64 = 100_000.0;

/// A joint that turns by more than this between two points leaps, radians: the points are too far apart, as where joint 5 is nearly
/// stretched and joint 4 turns by twenty times the angle of the tool.
const LEAP: f64 = 0.35;

/// Into so many parts, a power of two, a step is divided where a joint would leap.
const PARTS: usize = 64;

/// Wrist and elbow are at least so far from stretched or folded along a path, radians (1°), and the wrist so far from axis 1, mm:
/// nearer to that controllers slow down or stop.
const NEAREST: f64 = 0.017_453_292_519_943_295;
const NEAREST_AXIS: f64 = 5.0;

/// What is a millimetre to a radian, in the equations.
const SCALE: f64 = 1e-3;

/// Below this pivot the equations are those of a singular pose.
const FLATTEST: f64 = 1e-9;

/// A path of the tool in the base.
pub(super) struct Path<'a> {
    /// The frame of the tool at a part of it, 0 to 1.
    pub(super) at: &'a dyn Fn(f64) -> Frame,
    /// Its length, mm, and by how much the tool turns on it, radians.
    pub(super) length: f64,
    pub(super) turn: f64,
    /// How long the motion takes, s; `None` where only its way is looked at.
    pub(super) time: Option<f64>,
}

/// What is found along a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Followed {
    pub(super) joints: Joints,
    /// The least distance of a joint from its limits, radians.
    pub(super) limit: f64,
    /// The least distance of joint 5 from stretched, radians.
    pub(super) wrist: f64,
    /// The largest part of a joint's speed.
    pub(super) speed: f64,
}

/// Why a path cannot be followed, from a part of it on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lost {
    /// No joints put the tool there near where they stand: out of reach, or singular.
    Reach,
    /// The posture would change.
    Posture,
    /// The arm comes nearer to a singular pose than [`NEAREST`] or [`NEAREST_AXIS`].
    Singular(&'static str),
    /// A joint (number from 1) would be beyond its limit, by so many radians.
    Limit(usize, f64),
    /// A joint would need this part of its speed.
    Speed(usize, f64),
}

impl std::fmt::Display for Lost {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Lost::Reach => {
                f.write_str("the arm cannot follow it: out of reach, or through a singular pose")
            }
            Lost::Posture => f.write_str("the arm would have to change its posture on the way"),
            Lost::Singular(what) => write!(f, "the arm comes too near to where {what}"),
            Lost::Limit(joint, by) => {
                write!(f, "joint {joint} would be {:.3}° beyond its limit", by.to_degrees())
            }
            Lost::Speed(joint, part) => {
                write!(f, "joint {joint} would need {:.0} % of its speed", 100.0 * part)
            }
        }
    }
}

/// How far joints are from the limits, radians.
///
/// # Errors
/// One is beyond its own.
pub(super) fn limit(arm: &Arm, joints: &Joints) -> Result<f64, Lost> {
    let mut least = f64::INFINITY;
    for (number, (joint, at)) in (1..).zip(arm.joints().iter().zip(joints)) {
        let room = (at - joint.min).min(joint.max - at);
        if !joint.holds(*at) {
            return Err(Lost::Limit(number, -room));
        }
        least = least.min(room);
    }
    if arm.allows(joints) { Ok(least) } else { Err(Lost::Limit(3, 0.0)) }
}

/// Follows a path from `joints`, at which the tool is at its start. `base` is in the world, `tool` in the flange.
pub(super) fn follow(
    arm: &Arm,
    [base, tool]: [&Frame; 2],
    joints: Joints,
    path: &Path,
) -> Result<Followed, Lost> {
    let count = (path.length / SPACING).max(path.turn / TURN).ceil().clamp(1.0, MOST);
    let posture = arm.posture(&joints);
    let off = tool.inverse();
    let mut found =
        Followed { joints, limit: limit(arm, &joints)?, wrist: f64::INFINITY, speed: 0.0 };
    let all = PARTS * count as usize;
    let (mut done, mut step) = (0, PARTS);
    while done < all {
        let flange = *base * (path.at)((done + step) as f64 / all as f64) * off;
        let Some(next) = solve(arm, &flange, &found.joints) else {
            step /= 2;
            if step == 0 {
                return Err(Lost::Reach);
            }
            continue;
        };
        let time = path.time.map(|time| time * step as f64 / all as f64);
        passed(arm, &mut found, next, posture, time)?;
        done += step;
        if step < PARTS && done.is_multiple_of(2 * step) {
            step *= 2;
        }
    }
    Ok(found)
}

fn passed(
    arm: &Arm,
    found: &mut Followed,
    next: Joints,
    posture: Posture,
    time: Option<f64>,
) -> Result<(), Lost> {
    if arm.posture(&next) != posture {
        return Err(Lost::Posture);
    }
    found.limit = found.limit.min(limit(arm, &next)?);
    let margins = arm.margins(&next);
    found.wrist = found.wrist.min(margins.wrist);
    for (is_near, what) in [
        (margins.wrist < NEAREST, "joint 5 is stretched or folded"),
        (margins.elbow < NEAREST, "the elbow is stretched or folded"),
        (margins.shoulder < NEAREST_AXIS, "the wrist is above axis 1"),
    ] {
        if is_near {
            return Err(Lost::Singular(what));
        }
    }
    for (number, (i, joint)) in (1..).zip(arm.joints().iter().enumerate()) {
        let change = (next[i] - found.joints[i]).abs();
        if let Some(time) = time
            && change > 1e-9
        {
            let part = change / (joint.speed * time);
            if part.is_nan() || part > 1.0 {
                return Err(Lost::Speed(number, part));
            }
            found.speed = found.speed.max(part);
        }
    }
    found.joints = next;
    Ok(())
}

/// The joints near `guess` that put the flange there: none of them leaps.
fn solve(arm: &Arm, flange: &Frame, guess: &Joints) -> Option<Joints> {
    let mut joints = *guess;
    for _ in 0..16 {
        let (here, axes) = arm.flange_and_axes(&joints);
        let error = difference(&here, flange);
        if error.iter().all(|part| part.abs() < 1e-11) {
            let leaps = joints.iter().zip(guess).any(|(to, from)| (to - from).abs() > LEAP);
            return (!leaps).then_some(joints);
        }
        // How each joint moves the flange, and about what it turns it.
        let columns = axes.map(|axis| {
            let moved = axis.direction.cross(here.translation - axis.point) * SCALE;
            let about = axis.direction;
            [moved.x, moved.y, moved.z, about.x, about.y, about.z]
        });
        let change = linear::solve(&columns, error, FLATTEST)?;
        if change.iter().any(|part| part.abs() > LEAP) {
            return None;
        }
        joints = std::array::from_fn(|i| joints[i] + change[i]);
    }
    None
}

/// By how much `to` is moved and turned against `from`: scaled mm, and radians about X, Y and Z; for small turns.
fn difference(from: &Frame, to: &Frame) -> [f64; 6] {
    let moved = (to.translation - from.translation) * SCALE;
    let turned: Mat3 = to.matrix3 * from.matrix3.transpose();
    let (x, y, z) = (turned.x_axis, turned.y_axis, turned.z_axis);
    let about = Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x) / 2.0;
    [moved.x, moved.y, moved.z, about.x, about.y, about.z]
}

/// The orientation between two, evenly about one axis.
pub(super) fn turned(from: &Mat3, to: &Mat3, part: f64) -> Mat3 {
    // Most of a path is looked at at its ends.
    match part {
        0.0 => return *from,
        1.0 => return *to,
        _ => {}
    }
    let [from, to] = [from, to].map(Quat::from_mat3);
    Mat3::from_quat(from.slerp(to, part))
}

/// The angle between two orientations, radians.
pub(super) fn angle(from: &Mat3, to: &Mat3) -> f64 {
    let [from, to] = [from, to].map(Quat::from_mat3);
    let between = from.inverse() * to;
    2.0 * Vec3::new(between.x, between.y, between.z).length().atan2(between.w.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tool that swings by 2 degrees, square to its 5 degrees off the forearm, and the joints with which it begins.
    fn swing(time: Option<f64>) -> Result<[Joints; 2], Lost> {
        let machine = machine::load("kuka-kr6-r900").unwrap();
        let arm = machine.arm.as_ref().unwrap();
        let joints = [0.0, -90.0, 90.0, 0.0, 5.0, 0.0].map(f64::to_radians);
        let (flange, forearm) = (arm.flange(&joints), Vec3::X);
        let out = flange.matrix3.z_axis;
        // 80 mm from the flange to the wrist.
        let wrist = flange.translation - out * 80.0;
        let about = forearm.reject_from_normalized(out).normalize();
        let at = |part: f64| {
            let turned = Mat3::from_axis_angle(about, part * 2_f64.to_radians());
            let tip = wrist + turned * (flange.translation - wrist);
            Frame::from_mat3_translation(turned * flange.matrix3, tip)
        };
        let path =
            Path { at: &at, length: 80.0 * 2_f64.to_radians(), turn: 2_f64.to_radians(), time };
        follow(arm, [&Frame::IDENTITY; 2], joints, &path).map(|found| [joints, found.joints])
    }

    #[test]
    fn a_joint_that_turns_much_in_one_step_is_followed_in_smaller_ones() {
        let [from, to] = swing(None).unwrap();
        // A right-angled triangle on the sphere: its sides are 5° and 2°.
        let (five, two) = (5_f64.to_radians(), 2_f64.to_radians());
        let joint_4 = (two.tan() / five.sin()).atan();
        assert!(((to[3] - from[3]).abs() - joint_4).abs() < 1e-9, "{to:?}");
        assert!((to[4].cos() - five.cos() * two.cos()).abs() < 1e-9, "{to:?}");
        // 21.8° at 381 degrees a second take 57 ms; it is quickest at the start: 2 / sin 5° of the tool's 2°, 60 ms of 381 degrees a second.
        assert!(swing(Some(0.062)).is_ok());
        assert!(matches!(swing(Some(0.058)), Err(Lost::Speed(4, _))), "{:?}", swing(Some(0.058)));
    }
}
