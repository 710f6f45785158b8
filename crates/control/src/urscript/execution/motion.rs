//! Motions.

use super::arguments::Given;
use super::state::State;
use crate::event::Action;
use crate::kernel::Channel;
use crate::kernel::arm::FARTHEST;
use crate::kernel::formula::Typed;
use crate::urscript::language::{Scan, Value, frame};
use crate::{ArmAction, ArmMove, ArmPath, ArmPosture, Corner, Rounding, Turning};
use geom::Frame;
use program::{Feed, Outcome, Rule};

/// mm/min in a m/s.
const PER_MINUTE: f64 = 60_000.0;

/// mm in a metre.
const METRE: f64 = 1000.0;

/// How fast the tool turns where a line turns it, radians/s for each m/s of its speed.
const TURNS: f64 = 4.0;

impl State {
    /// `movej(q,a=1.4,v=1.05,t=0,r=0)`: joints, or a pose in the posture in which the arm stands.
    pub(super) fn movej(&mut self, scan: &Scan, given: &Given, channel: &mut Channel) -> Outcome {
        let path = match given.needed(scan, "q")? {
            Value::Pose(pose) => ArmPath::Point(within_reach(scan, *pose)?),
            list => match list.numbers::<6>() {
                Some(joints) => ArmPath::Joints(angles(scan, joints)?),
                None => {
                    let message = "movej goes to six joints, or to a pose";
                    return Err(scan.since(0, Rule::Type, message));
                }
            },
        };
        let acceleration = given.positive(scan, "a", 1.4)?;
        if self.joint_acceleration.replace(acceleration) != Some(acceleration) {
            let action = ArmAction::JointAcceleration(acceleration.to_degrees());
            channel.arm(scan.line, action)?;
        }
        let rate = given.positive(scan, "v", 1.05)?;
        no_time(scan, given)?;
        if self.joint_rate != Some(rate) {
            self.joint_rate = Some(rate);
            let action = ArmAction::JointRate(rate.to_degrees());
            channel.arm(scan.line, action)?;
        }
        // The joints go evenly: by how much the tip leaves its path, they decide.
        let corner = match given.number(scan, "r", 0.0)? {
            0.0 => Corner::Exact,
            _ => Corner::Unbounded,
        };
        report(scan, (path, Turning::ByJoints), corner, channel)
    }

    /// `movel(pose,a=1.2,v=0.25,t=0,r=0)`.
    pub(super) fn movel(&mut self, scan: &Scan, given: &Given, channel: &mut Channel) -> Outcome {
        let end = pose_of(scan, given, "pose")?;
        self.acceleration(scan, given, channel)?;
        no_time(scan, given)?;
        self.feed(scan, given.positive(scan, "v", 0.25)?, channel)?;
        let corner = corner(scan, given)?;
        report(scan, (ArmPath::Line(end), Turning::Even), corner, channel)
    }

    /// `movec(pose_via,pose_to,a=1.2,v=0.25,r=0,mode=0)`: mode 0 turns the tool evenly to the orientation at the end, mode 1 keeps it
    /// to the tangent.
    pub(super) fn movec(&mut self, scan: &Scan, given: &Given, channel: &mut Channel) -> Outcome {
        let (via, end) = (pose_of(scan, given, "pose_via")?, pose_of(scan, given, "pose_to")?);
        self.acceleration(scan, given, channel)?;
        let turning = match given.number(scan, "mode", 0.0)? {
            0.0 => Turning::Even,
            1.0 => Turning::AlongPath,
            mode => {
                let message = format!("the mode of an arc is 0 or 1, not {mode}");
                return Err(scan.since(0, Rule::Argument, message));
            }
        };
        self.feed(scan, given.positive(scan, "v", 0.25)?, channel)?;
        let corner = corner(scan, given)?;
        let path = ArmPath::Arc { via, end };
        report(scan, (path, turning), corner, channel)
    }

    /// The acceleration of a line or an arc, where it changes.
    fn acceleration(&mut self, scan: &Scan, given: &Given, channel: &mut Channel) -> Outcome {
        let acceleration = given.positive(scan, "a", 1.2)?;
        if self.tip_acceleration.replace(acceleration) != Some(acceleration) {
            channel.arm(scan.line, ArmAction::TipAcceleration(acceleration * METRE))?;
        }
        Ok(())
    }

    /// The speed of lines and arcs, m/s, where it changes.
    fn feed(&mut self, scan: &Scan, speed: f64, channel: &mut Channel) -> Outcome {
        if self.speed == Some(speed) {
            return Ok(());
        }
        self.speed = Some(speed);
        let line = scan.line;
        channel.report(line, Action::Feed(Feed::PerMinute(speed * PER_MINUTE)))?;
        let turn = [Some((TURNS * speed).to_degrees()), Some(0.0)];
        channel.arm(line, ArmAction::TurnSpeed(turn))
    }
}

fn report(
    scan: &Scan,
    (path, turning): (ArmPath, Turning),
    corner: Corner,
    channel: &mut Channel,
) -> Outcome {
    // No word says a posture.
    let posture = ArmPosture::default();
    let motion = ArmMove { path, corner, turning: Some(turning), posture, rail: None };
    channel.motion(scan.line, motion)
}

/// # Errors
/// The motion is to take a stated time, whatever its speed says.
fn no_time(scan: &Scan, given: &Given) -> Outcome {
    match given.number(scan, "t", 0.0)? {
        0.0 => Ok(()),
        _ => {
            let message = "a motion by its time (t) is not followed: write its speed";
            Err(scan.since(0, Rule::Unsupported, message))
        }
    }
}

/// Blends do not overlap, and what follows a blend that is no motion happens where it begins.
fn corner(scan: &Scan, given: &Given) -> Outcome<Corner> {
    let radius = given.number(scan, "r", 0.0)?;
    match radius {
        0.0 => Ok(Corner::Exact),
        _ if radius > 0.0 && radius.is_finite() => Ok(Corner::Within(Rounding {
            distance: radius * METRE,
            shortened: false,
            stops: false,
        })),
        _ => Err(scan.since(0, Rule::Number, format!("a blend radius is not below 0: {radius}"))),
    }
}

fn pose_of(scan: &Scan, given: &Given, name: &str) -> Outcome<Frame> {
    match given.needed(scan, name)? {
        Value::Pose(pose) => within_reach(scan, *pose),
        Value::List(_) => {
            let message =
                "joints as the end of a line or an arc are not followed: write a pose p[..]";
            Err(scan.since(0, Rule::Unsupported, message))
        }
        other => {
            let message = format!("{} where a pose is needed", other.kind());
            Err(scan.since(0, Rule::Type, message))
        }
    }
}

pub(super) fn within_reach(scan: &Scan, pose: [f64; 6]) -> Outcome<Frame> {
    let limit = FARTHEST / METRE;
    match pose.iter().all(|number| number.abs() <= limit) {
        true => Ok(frame(pose)),
        false => Err(scan.since(0, Rule::Number, "the pose is beyond any arm")),
    }
}

/// Joints in degrees.
fn angles(scan: &Scan, joints: [f64; 6]) -> Outcome<[f64; 6]> {
    let degrees = joints.map(f64::to_degrees);
    match degrees.iter().all(|joint| joint.abs() <= FARTHEST) {
        true => Ok(degrees),
        false => Err(scan.since(0, Rule::Number, "the joints are beyond any arm's")),
    }
}
