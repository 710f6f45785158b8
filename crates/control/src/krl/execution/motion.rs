//! Motions.

use super::state::{Standing, State};
use crate::kernel::Channel;
use crate::kernel::arm::FARTHEST;
use crate::krl::language::{AXES, Approximation, COORDINATES, Motion, OUTER, Scan, Value, frame};
use crate::{ArmMove, ArmPath, ArmPosture, Corner, Rounding, Turning};
use program::{Outcome, Rule};

/// Fields of a position that say the posture.
const POSTURE: [&str; 2] = ["S", "T"];

/// The axis beyond the arm that is followed: a rail on which it stands.
const RAIL: &str = OUTER[0];

impl State {
    /// A motion.
    pub(in crate::krl) fn go(
        &mut self,
        scan: &Scan,
        motion: &Motion,
        channel: &mut Channel,
    ) -> Outcome {
        let mut posture = ArmPosture::default();
        let (path, standing, approximation) = match motion {
            Motion::Here => {
                if matches!(self.standing, Standing::NotStarted) {
                    self.standing = Standing::Unknown;
                }
                return Ok(());
            }
            Motion::Ptp(to, approximation) => {
                let (path, standing, stated) = self.point_to_point(scan, to)?;
                posture = stated;
                (path, standing, *approximation)
            }
            Motion::Lin(to, approximation) => {
                self.started(scan)?;
                let end = self.pose(scan, to)?;
                (ArmPath::Line(frame(end)), Standing::Pose(end), *approximation)
            }
            Motion::LinRel(by, approximation) => {
                let end = self.moved_by(scan, by)?;
                (ArmPath::Line(frame(end)), Standing::Pose(end), *approximation)
            }
            Motion::Circ(via, end, approximation) => {
                self.started(scan)?;
                whole_arc(scan, [via, end])?;
                let (via, end) = (self.pose(scan, via)?, self.pose(scan, end)?);
                let path = ArmPath::Arc { via: frame(via), end: frame(end) };
                (path, Standing::Pose(end), *approximation)
            }
        };
        self.standing = standing;
        self.rail = self.rail_behind(scan, motion)?;
        let corner = self.corner(scan, approximation, &path)?;
        let turning = self.turning_of(&path);
        let motion = ArmMove { turning, path, corner, posture, rail: self.rail };
        channel.motion(scan.line, motion)
    }

    /// Where the rail is at the end of a motion.
    ///
    /// # Errors
    /// No rail is that long; the points of an arc state different positions.
    fn rail_behind(&self, scan: &Scan, motion: &Motion) -> Outcome<Option<f64>> {
        let stated = |to: &Value| match to.field(RAIL) {
            Some(at) if at.is_nan() || at.abs() > FARTHEST => {
                Err(scan.since(0, Rule::Number, format!("{RAIL} {at} is beyond any rail")))
            }
            at => Ok(at),
        };
        let to = match motion {
            Motion::Here => None,
            Motion::Ptp(to, _) | Motion::Lin(to, _) | Motion::LinRel(to, _) => stated(to)?,
            Motion::Circ(via, end, _) => {
                let end = stated(end)?;
                if stated(via)?.is_some_and(|on_way| Some(on_way) != end) {
                    let message = format!("the two points of an arc state different {RAIL}");
                    return Err(scan.since(0, Rule::Unsupported, message));
                }
                end
            }
        };
        Ok(to.or(self.rail))
    }

    /// How the tool turns on the way.
    fn turning_of(&self, path: &ArmPath) -> Option<Turning> {
        match (path, self.along_path) {
            (ArmPath::Joints(_) | ArmPath::Point(_), _) => Some(Turning::ByJoints),
            (ArmPath::Line(_), _) | (ArmPath::Arc { .. }, Some(false)) => self.turning,
            (ArmPath::Arc { .. }, Some(true)) => self.turning.map(|_| Turning::AlongPath),
            (ArmPath::Arc { .. }, None) => None,
        }
    }

    /// # Errors
    /// Nothing has moved yet: the control refuses a straight line there (KSS, "The first motion has to be a PTP").
    fn started(&self, scan: &Scan) -> Outcome {
        match self.standing {
            Standing::NotStarted => {
                let message = "the first motion of a program is a PTP to all six axes";
                let help = "write PTP {A1 ..,A2 ..,A3 ..,A4 ..,A5 ..,A6 ..} before it";
                Err(Box::new(scan.since(0, Rule::UnknownPosition, message).help(help)))
            }
            Standing::Unknown | Standing::Joints(_) | Standing::Pose(_) => Ok(()),
        }
    }

    /// `PTP` to joints, or to a position in a posture.
    fn point_to_point(&self, scan: &Scan, to: &Value) -> Outcome<(ArmPath, Standing, ArmPosture)> {
        if to.has_only(&[&AXES, &OUTER]) {
            let before = match self.standing {
                Standing::Joints(joints) => joints.map(Some),
                Standing::NotStarted | Standing::Unknown | Standing::Pose(_) => [None; 6],
            };
            let help = "write all six axes";
            let joints = numbers(scan, to, AXES, before, help)?;
            let posture = ArmPosture::default();
            return Ok((ArmPath::Joints(joints), Standing::Joints(joints), posture));
        }
        let end = self.pose(scan, to)?;
        let posture = posture(whole(scan, to, "S", 31)?, whole(scan, to, "T", 63)?);
        Ok((ArmPath::Point(frame(end)), Standing::Pose(end), posture))
    }

    /// The six numbers of a position; those that it does not have stay as they are.
    fn pose(&self, scan: &Scan, to: &Value) -> Outcome<[f64; 6]> {
        if !to.has_only(&[&COORDINATES, &POSTURE, &OUTER]) {
            let message = "a position of X, Y, Z, A, B, C is needed here";
            return Err(scan.since(0, Rule::Type, message));
        }
        let before = match self.standing {
            Standing::Pose(pose) => pose.map(Some),
            Standing::NotStarted | Standing::Unknown | Standing::Joints(_) => [None; 6],
        };
        let help =
            "write all of X, Y, Z, A, B and C in the first motion behind joints or another frame";
        numbers(scan, to, COORDINATES, before, help)
    }

    /// `LIN_REL`: X, Y and Z from where the tool stands, in the base.
    fn moved_by(&self, scan: &Scan, by: &Value) -> Outcome<[f64; 6]> {
        let Standing::Pose(pose) = self.standing else {
            let message = "LIN_REL counts from where the tool stands, which is not known";
            return Err(scan.since(0, Rule::UnknownPosition, message));
        };
        if !by.has_only(&[&COORDINATES[..3]]) {
            let message = "of LIN_REL X, Y and Z are followed";
            return Err(scan.since(0, Rule::Unsupported, message));
        }
        let moved = numbers(scan, by, COORDINATES, [Some(0.0); 6], "")?;
        Ok(std::array::from_fn(|i| pose[i] + moved[i]))
    }

    fn corner(&self, scan: &Scan, approximation: Approximation, path: &ArmPath) -> Outcome<Corner> {
        match (approximation, path) {
            (Approximation::None, _) => Ok(Corner::Exact),
            (Approximation::Distance, ArmPath::Line(_) | ArmPath::Arc { .. }) => {
                let distance = self.distance.ok_or_else(|| {
                    let message = "C_DIS needs a distance, and no block has set $APO.CDIS";
                    scan.since(0, Rule::Variable, message)
                })?;
                // An output or a wait ends the look-ahead.
                Ok(Corner::Within(Rounding { distance, shortened: true, stops: true }))
            }
            (Approximation::Distance | Approximation::Other, _) => Ok(Corner::Unbounded),
        }
    }
}

/// # Errors
/// A point of an arc leaves something out: from which point the controller takes it, no source states.
fn whole_arc(scan: &Scan, [via, end]: [&Value; 2]) -> Outcome {
    for (point, needed) in [(via, &COORDINATES[..3]), (end, &COORDINATES[..])] {
        if let Some(name) = needed.iter().find(|name| point.field(name).is_none()) {
            let message =
                format!("{name} is left out in an arc, and from where it is taken is not known");
            let help = "write X, Y and Z of the point on the way, and all of X, Y, Z, A, B and C of the end";
            return Err(Box::new(scan.since(0, Rule::UnknownPosition, message).help(help)));
        }
    }
    Ok(())
}

/// The numbers of six fields, or what they were before.
///
/// # Errors
/// A field is missing and was not known before; an axis beyond arm and rail moves; a number is no arm's.
fn numbers(
    scan: &Scan,
    to: &Value,
    names: [&str; 6],
    before: [Option<f64>; 6],
    help: &str,
) -> Outcome<[f64; 6]> {
    if let Some(name) = OUTER[1..].iter().find(|name| to.field(name).is_some_and(|at| at != 0.0)) {
        let message =
            format!("{name} is an axis beyond the arm and its rail, which is not followed");
        return Err(scan.since(0, Rule::Unsupported, message));
    }
    let mut all = [0.0; 6];
    for ((number, name), before) in all.iter_mut().zip(names).zip(before) {
        let Some(value) = to.field(name).or(before) else {
            let message = format!("{name} is left out, and what it was before is not known");
            return Err(Box::new(scan.since(0, Rule::UnknownPosition, message).help(help)));
        };
        if value.is_nan() || value.abs() > FARTHEST {
            return Err(scan.since(0, Rule::Number, format!("{name} {value} is beyond any arm")));
        }
        *number = value;
    }
    Ok(all)
}

/// The posture that S and T state: bit 0 of S the wrist is behind axis 1, bit 1 the elbow is not below, bit 2 A5 is below 0; bit i of
/// T is set where A(i+1) is below 0.
fn posture(status: Option<u8>, turn: Option<u8>) -> ArmPosture {
    let status = |bit: u8| status.map(|status| status >> bit & 1 != 0);
    let joint = |i: usize| {
        turn.map(|turn| match turn >> i & 1 {
            0 => [0.0, f64::INFINITY],
            _ => [f64::NEG_INFINITY, 0.0],
        })
    };
    ArmPosture {
        rear: status(0),
        below: status(1).map(|above| !above),
        flip: status(2),
        joints: std::array::from_fn(joint),
    }
}

/// S or T, where it is there.
fn whole(scan: &Scan, to: &Value, name: &str, most: u8) -> Outcome<Option<u8>> {
    match to.field(name) {
        None => Ok(None),
        Some(value) if value.fract() == 0.0 && (0.0..=f64::from(most)).contains(&value) => {
            Ok(Some(value as u8))
        }
        Some(value) => {
            let message = format!("{name} is a whole number from 0 to {most}, not {value}");
            Err(scan.since(0, Rule::Number, message))
        }
    }
}
