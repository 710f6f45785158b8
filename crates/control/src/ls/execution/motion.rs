//! Motions.

use super::state::State;
use crate::event::Action;
use crate::kernel::Channel;
use crate::ls::language::{Coordinates, Motion, Position, Scan, Shape, Speed, Termination};
use crate::{ArmAction, ArmMove, ArmPath, Corner, Rounding, Turning};
use program::{Feed, Outcome, Rule};
use std::collections::HashMap;

impl State {
    /// A motion to positions of the program.
    pub(in crate::ls) fn go(
        &mut self,
        scan: &Scan,
        motion: &Motion,
        positions: &HashMap<u32, Position>,
        channel: &mut Channel,
    ) -> Outcome {
        let coordinates = |number: u32| self.coordinates(scan, positions, number);
        let pose = |number: u32| match coordinates(number)? {
            Coordinates::Pose(frame, posture) => Ok((frame, posture)),
            Coordinates::Joints(_) => {
                let message =
                    format!("P[{number}] has joints: a line or an arc to joints is not followed");
                Err(scan.since(0, Rule::Unsupported, message))
            }
        };
        let rail_at = |number: u32| positions.get(&number).and_then(|position| position.rail);
        let rail = match motion.shape {
            Shape::Joint(number) | Shape::Linear(number) => rail_at(number),
            Shape::Circular(via, end) if rail_at(via) != rail_at(end) => {
                let message = format!("P[{via}] and P[{end}] of an arc state different E1");
                return Err(scan.since(0, Rule::Unsupported, message));
            }
            Shape::Circular(_, end) => rail_at(end),
        };
        let (path, posture) = match motion.shape {
            Shape::Joint(number) => match coordinates(number)? {
                Coordinates::Joints(joints) => (ArmPath::Joints(joints), Default::default()),
                Coordinates::Pose(frame, posture) => (ArmPath::Point(frame), posture),
            },
            Shape::Linear(number) => {
                let (end, posture) = pose(number)?;
                (ArmPath::Line(end), posture)
            }
            Shape::Circular(via, end) => {
                let ((via, _), (end, posture)) = (pose(via)?, pose(end)?);
                (ArmPath::Arc { via, end }, posture)
            }
        };
        self.speed(scan, motion.speed, channel)?;
        let by_joints = motion.by_wrist || matches!(motion.shape, Shape::Joint(_));
        let turning = Some(if by_joints { Turning::ByJoints } else { Turning::Even });
        let corner = match motion.termination {
            Termination::Fine => Corner::Exact,
            Termination::Region(distance) if distance > 0.0 && !by_joints => {
                Corner::Within(Rounding { distance, shortened: true, stops: false })
            }
            Termination::Continuous | Termination::Region(_) => Corner::Unbounded,
        };
        let motion = ArmMove { path, corner, turning, posture, rail };
        channel.motion(scan.line, motion)
    }

    /// # Errors
    /// There is no such position, or it counts in other frames than those that are active: the controller stops.
    fn coordinates(
        &self,
        scan: &Scan,
        positions: &HashMap<u32, Position>,
        number: u32,
    ) -> Outcome<Coordinates> {
        let Some(position) = positions.get(&number) else {
            let message = format!("the program has no position P[{number}]");
            return Err(scan.since(0, Rule::UnknownPosition, message));
        };
        match self.active == position.frames.map(Some) {
            true => Ok(position.coordinates),
            false => {
                let [frame, tool] = position.frames;
                let message = format!(
                    "P[{number}] counts in user frame {frame} with tool {tool}, which are not the active ones"
                );
                Err(scan.since(0, Rule::Frame, message))
            }
        }
    }

    fn speed(&mut self, scan: &Scan, speed: Speed, channel: &mut Channel) -> Outcome {
        let line = scan.line;
        let (value, factor) = match speed {
            Speed::Percent(value) => (self.value(scan, value)?, None),
            Speed::Tip(value, factor) => (self.value(scan, value)?, Some(factor)),
        };
        if value <= 0.0 || factor.is_none() && value > 100.0 {
            let message = format!("no motion goes at a speed of {value}");
            return Err(scan.since(0, Rule::Number, message));
        }
        match factor {
            Some(factor) if self.feed != Some(value * factor) => {
                self.feed = Some(value * factor);
                channel.report(line, Action::Feed(Feed::PerMinute(value * factor)))
            }
            None if self.joint_speed != Some(value) => {
                self.joint_speed = Some(value);
                channel.arm(line, ArmAction::JointSpeed(Some(value)))
            }
            Some(_) | None => Ok(()),
        }
    }
}
