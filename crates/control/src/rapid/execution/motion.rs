//! Motions.

use super::state::State;
use crate::event::Action;
use crate::kernel::Channel;
use crate::kernel::arc::through;
use crate::kernel::arm::FARTHEST;
use crate::kernel::formula::Typed;
use crate::rapid::language::{Motion, MotionKind, Scan, Value, frame};
use crate::{ArmAction, ArmMove, ArmPath, ArmPosture, Corner, Rounding, Turning};
use geom::{Arc, Frame, Quat, Vec3};
use program::{Feed, Outcome, Rule};

/// An axis that is not there.
const NO_AXIS: f64 = 9e9;

/// How far the ranges of `confdata` reach beyond themselves under `ConfL \Off`, where the control does not use them, degrees.
const BEYOND: f64 = 2e-3;

/// The most that an arc turns ("MoveC", Limitations), radians.
const MOST_SWEEP: f64 = 240.0 * std::f64::consts::PI / 180.0;

/// The least distance of the points of an arc, mm, and the least angle at its start between the other two, radians.
const NEAREST: f64 = 0.1;
const FLATTEST: f64 = std::f64::consts::PI / 180.0;

/// How much farther the turn over the point of an arc may be than the turn to its end, radians.
const DETOUR: f64 = 0.02;

impl State {
    /// A motion.
    pub(in crate::rapid) fn go(
        &mut self,
        (scan, from, line): (&Scan, usize, u32),
        motion: &Motion,
        channel: &mut Channel,
    ) -> Outcome {
        let wrong = |rule: Rule, message: String| scan.since(from, rule, message);
        self.surroundings((scan, from, line), motion, channel)?;
        let (path, posture, rail) =
            self.path(motion).map_err(|(rule, message)| wrong(rule, message))?;
        let corner = corner(motion).map_err(|message| wrong(Rule::Number, message))?;
        let turning = match path {
            ArmPath::Joints(_) | ArmPath::Point(_) => Some(Turning::ByJoints),
            ArmPath::Line(_) => self.turning,
            // Both have to be as usual for an arc to be.
            ArmPath::Arc { .. } => match self.turning {
                Some(Turning::Even) => self.circles,
                other => other,
            },
        };
        self.standing = match path {
            ArmPath::Joints(_) => None,
            ArmPath::Point(end) | ArmPath::Line(end) | ArmPath::Arc { end, .. } => Some(end),
        };
        let motion = ArmMove { path, corner, turning, posture, rail };
        channel.motion(line, motion)
    }

    /// Where a motion goes, in which posture, and where it takes the rail.
    fn path(&self, motion: &Motion) -> Result<(ArmPath, ArmPosture, Option<f64>), (Rule, String)> {
        let framed = |message: String| (Rule::Frame, message);
        if let (MotionKind::AbsoluteJoints, [axes, others]) = (motion.kind, motion.to.parts()) {
            let rail = rail(others)?;
            let joints = axes.numbers::<6>().filter(|all| all.iter().all(|at| at.abs() < FARTHEST));
            let joints = joints.ok_or((Rule::Number, String::from("a joint is beyond any arm")))?;
            return Ok((ArmPath::Joints(joints), ArmPosture::default(), rail));
        }
        let end = place(&motion.to).map_err(framed)?;
        let [_, _, configuration, others] = motion.to.parts() else {
            return Err((Rule::Type, String::from("a robtarget is needed here")));
        };
        let rail = rail(others)?;
        let posture = self.posture(configuration, motion.kind)?;
        let path = match (motion.kind, &motion.via) {
            (MotionKind::Arc, Some(via)) => {
                same_rail(via, rail)?;
                let via = place(via).map_err(framed)?;
                self.is_arc(&via, &end)?;
                ArmPath::Arc { via, end }
            }
            (MotionKind::Joints, _) => ArmPath::Point(end),
            (_, _) => ArmPath::Line(end),
        };
        Ok((path, posture, rail))
    }

    /// # Errors
    /// The control refuses an arc through these points, or the orientation on the way is not on the shortest turn.
    fn is_arc(&self, via: &Frame, end: &Frame) -> Result<(), (Rule, String)> {
        let Some(start) = self.standing else { return Ok(()) };
        let refused = |rule: Rule, message: &str| Err((rule, String::from(message)));
        let [a, b, c] = [&start, via, end].map(|frame| frame.translation);
        if a.distance(b) < NEAREST || a.distance(c) < NEAREST {
            return refused(
                Rule::ArcPoints,
                "points of an arc are nearer to each other than 0.1 mm",
            );
        }
        if (b - a).angle_between(c - a) < FLATTEST {
            return refused(Rule::ArcPoints, "the points of an arc are within 1° of a line");
        }
        let sweep = through(a, b, c).and_then(|(center, normal)| {
            Arc::new(a, c, center, normal, 0, a.distance(center) * 1e-3).ok().map(|arc| arc.sweep)
        });
        if sweep.is_none_or(|sweep| sweep > MOST_SWEEP) {
            return refused(Rule::Arc, "an arc of MoveC turns by 240° at the most");
        }
        let [p, q, r] = [&start, via, end].map(|frame| Quat::from_mat3(&frame.matrix3));
        if p.angle_between(q) + q.angle_between(r) > p.angle_between(r) + DETOUR {
            return refused(
                Rule::OrientationWay,
                "the orientation at the point of the arc is not on the way from its start to its end",
            );
        }
        Ok(())
    }

    /// What `[cf1,cf4,cf6,cfx]` states: quarters of a turn of joints 1, 4 and 6, and 4 for a wrist behind axis 1, 2 for an elbow
    /// below, 1 for joint 5 below 0.
    fn posture(
        &self,
        configuration: &Value,
        kind: MotionKind,
    ) -> Result<ArmPosture, (Rule, String)> {
        let whole = |number: &f64| number.fract() == 0.0;
        let numbers = configuration.numbers::<4>().filter(|all| all.iter().all(whole));
        let Some([one, four, six, all]) = numbers.filter(|all| (0.0..=7.0).contains(&all[3]))
        else {
            return Err((
                Rule::Number,
                String::from("a configuration has three whole numbers and one from 0 to 7"),
            ));
        };
        let beyond = if self.is_nearest && kind != MotionKind::Joints { BEYOND } else { 0.0 };
        let range = |quarter: f64| Some([90.0 * quarter - beyond, 90.0 * quarter + 90.0 + beyond]);
        let bit = |bit: u8| Some((all as u8) >> bit & 1 != 0);
        Ok(ArmPosture {
            rear: bit(2),
            below: bit(1),
            flip: bit(0),
            joints: [range(one), None, None, range(four), None, range(six)],
        })
    }

    /// Tool, work object, load and speed, where they are others than before.
    fn surroundings(
        &mut self,
        (scan, from, line): (&Scan, usize, u32),
        motion: &Motion,
        channel: &mut Channel,
    ) -> Outcome {
        let wrong = |rule: Rule, message: String| scan.since(from, rule, message);
        let speed = motion.speed.parts();
        let speeds = [0, 1, 2].map(|i| speed.get(i).and_then(Value::number));
        let [Some(tip), Some(turn), Some(rail)] = speeds else {
            return Err(wrong(Rule::Type, String::from("a speeddata is needed here")));
        };
        if !(tip > 0.0 && turn > 0.0 && rail > 0.0) {
            return Err(wrong(Rule::Feed, String::from("speeds of a speeddata are above 0")));
        }
        let [Value::Flag(held), tool, load] = motion.tool.parts() else {
            return Err(wrong(Rule::Type, String::from("a tooldata is needed here")));
        };
        let tool = frame(tool.parts()).map_err(|message| wrong(Rule::Frame, message))?;
        let load = load_of(load).map_err(|message| wrong(Rule::Payload, message))?;
        let (base, object_held) = match &motion.object {
            Some(object) => work_object(object).map_err(|(rule, text)| wrong(rule, text))?,
            None => (Frame::IDENTITY, false),
        };
        if *held == object_held {
            let message = "one of tool and work object is held by the robot, and the other is not";
            return Err(wrong(Rule::Frame, String::from(message)));
        }
        let mut reported = self.reported;
        if reported.base != Some(base) || reported.tool != Some(tool) {
            // Poses count in other frames from here on.
            self.standing = None;
        }
        let mut report = |is_new: bool, action: Action| match is_new {
            true => channel.report(line, action),
            false => Ok(()),
        };
        let arm = Action::Arm;
        report(reported.tool != Some(tool), arm(ArmAction::Tool(Some(Box::new(tool)))))?;
        report(reported.base != Some(base), arm(ArmAction::Base(Some(Box::new(base)))))?;
        let on_flange = object_held;
        report(reported.on_flange != Some(on_flange), arm(ArmAction::PartOnFlange(on_flange)))?;
        let [mass, x, y, z] = load;
        report(reported.load != Some(load), arm(ArmAction::Load(mass, Vec3::new(x, y, z))))?;
        let before = reported.speed;
        report(
            before.map(|speed| speed[0]) != Some(tip),
            Action::Feed(Feed::PerMinute(tip * 60.0)),
        )?;
        report(
            before.map(|speed| speed[1]) != Some(turn),
            arm(ArmAction::TurnSpeed([Some(turn); 2])),
        )?;
        report(before.map(|speed| speed[2]) != Some(rail), arm(ArmAction::RailSpeed(rail)))?;
        reported.tool = Some(tool);
        reported.base = Some(base);
        reported.on_flange = Some(on_flange);
        reported.load = Some(load);
        reported.speed = Some([tip, turn, rail]);
        self.reported = reported;
        Ok(())
    }
}

/// The frame of a robtarget.
fn place(target: &Value) -> Result<Frame, String> {
    let frame = frame(target.parts())?;
    match frame.translation.to_array().iter().all(|at| at.abs() < FARTHEST) {
        true => Ok(frame),
        false => Err(String::from("a coordinate is beyond any arm")),
    }
}

/// Where the outer axis a is, mm: a rail on which the arm stands. `None` where it is not there.
///
/// # Errors
/// Another outer axis is moved; no rail is that long.
fn rail(others: &Value) -> Result<Option<f64>, (Rule, String)> {
    let none = |value: &Value| value.number() == Some(NO_AXIS);
    let Some((first, others)) = others.parts().split_first() else { return Ok(None) };
    if !others.iter().all(none) {
        let message = "axes beyond the arm and its rail (eax_a) are not followed: 9E9 stands for one that is not there";
        return Err((Rule::Unsupported, String::from(message)));
    }
    match first.number() {
        Some(NO_AXIS) => Ok(None),
        Some(at) if at.abs() <= FARTHEST => Ok(Some(at)),
        _ => Err((Rule::Number, String::from("eax_a is beyond any rail"))),
    }
}

/// # Errors
/// The point on the way of an arc states another position of the rail than its end.
fn same_rail(via: &Value, end: Option<f64>) -> Result<(), (Rule, String)> {
    let [_, _, _, others] = via.parts() else { return Ok(()) };
    match rail(others)? == end {
        true => Ok(()),
        false => {
            let message = "the two points of an arc state different positions of the rail (eax_a)";
            Err((Rule::Unsupported, String::from(message)))
        }
    }
}

/// No tool reaches so far around its centre of gravity, m: its moments of inertia are below its mass times the square of this.
const WIDEST: f64 = 1.0;

/// Mass, kg, and its centre, mm, of a `loaddata`.
fn load_of(load: &Value) -> Result<[f64; 4], String> {
    let [mass, center, turn, moments @ ..] = load.parts() else {
        return Err(String::from("a loaddata is needed here"));
    };
    let (Some(mass), Some([x, y, z])) = (mass.number(), center.numbers::<3>()) else {
        return Err(String::from("a loaddata has a mass and its centre"));
    };
    if mass <= 0.0 {
        return Err(String::from("the mass of a tool is above 0 kg"));
    }
    let most = mass * WIDEST * WIDEST;
    let fits = |moment: f64| (0.0..=most).contains(&moment);
    if !moments.iter().all(|moment| moment.number().is_some_and(fits)) {
        return Err(format!(
            "the moments of inertia of a tool of {mass} kg are from 0 to {most} kgm²: it reaches no farther than {WIDEST} m around its centre"
        ));
    }
    frame(&[center.clone(), turn.clone()])?;
    Ok([mass, x, y, z])
}

/// The frame of a work object, and whether the robot holds it.
fn work_object(object: &Value) -> Result<(Frame, bool), (Rule, String)> {
    let [Value::Flag(held), fixed, unit, user, own] = object.parts() else {
        return Err((Rule::Type, String::from("a wobjdata is needed here")));
    };
    if !fixed.is_true() || *unit != Value::Text("".into()) {
        let message = "a work object on a moving unit is not followed: ufprog TRUE and ufmec \"\"";
        return Err((Rule::Unsupported, String::from(message)));
    }
    let framed = |message: String| (Rule::Frame, message);
    let user = frame(user.parts()).map_err(framed)?;
    Ok((user * frame(own.parts()).map_err(framed)?, *held))
}

/// How the end is passed.
fn corner(motion: &Motion) -> Result<Corner, String> {
    let [is_fine, sizes @ ..] = motion.zone.parts() else {
        return Err(String::from("a zonedata is needed here"));
    };
    if is_fine.is_true() {
        return Ok(Corner::Exact);
    }
    let sizes: Option<Vec<f64>> = sizes.iter().map(Value::number).collect();
    let Some([tip, turn, ..]) = sizes.as_deref() else {
        return Err(String::from("a zonedata is needed here"));
    };
    if sizes.iter().flatten().any(|size| *size < 0.0) {
        return Err(String::from("a zone is not below 0"));
    }
    match motion.kind {
        MotionKind::AbsoluteJoints | MotionKind::Joints => Ok(Corner::Unbounded),
        // The tool turns within its own zone, which is no smaller. The program goes on where the zone is reached.
        MotionKind::Line | MotionKind::Arc => {
            Ok(Corner::Within(Rounding { distance: tip.max(*turn), shortened: true, stops: false }))
        }
    }
}
