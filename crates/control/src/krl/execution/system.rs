//! System variables, outputs, and `BAS`.

use super::state::{Standing, State, unfit};
use crate::event::{Action, Risk};
use crate::kernel::Channel;
use crate::kernel::arm::tool_change;
use crate::kernel::formula::Typed;
use crate::krl::language::{Name, Scan, Target, Value, frame, whole_frame};
use crate::{ArmAction, Turning};
use geom::{Frame, Vec3};
use program::{Feed, Outcome, OutputValue, Rule};

/// mm/min in a m/s.
const PER_MINUTE: f64 = 60_000.0;

/// Most frames that the controller keeps for the operator.
const MOST_FRAMES: i64 = 128;

impl State {
    /// An assignment.
    pub(in crate::krl) fn assign(
        &mut self,
        scan: &Scan,
        target: Target,
        value: Value,
        channel: &mut Channel,
    ) -> Outcome {
        if target.name.as_str().starts_with('$') {
            return assign(self, scan, target, value, channel);
        }
        if matches!(target.name.as_str(), "BASE_DATA" | "TOOL_DATA" | "LOAD_DATA") {
            let risk = Action::Risk(Box::new(Risk::OPERATOR_DATA));
            channel.report(scan.line, risk)?;
        }
        self.set(scan, target, value)
    }

    /// A call of `BAS` or of the operator's tool change; whether it is one of them.
    pub(in crate::krl) fn called(
        &mut self,
        scan: &Scan,
        name: Name,
        arguments: &[Value],
        channel: &mut Channel,
    ) -> Outcome<bool> {
        if name.as_str() == "BAS" {
            return bas(self, scan, arguments, channel).map(|()| true);
        }
        if self.tool_change.is_empty() || name.as_str() != self.tool_change {
            return Ok(false);
        }
        let number = if let [value] = arguments { value.number() } else { None };
        let tool = tool_change(number).map_err(|message| scan.since(0, Rule::Tool, message))?;
        channel.report(scan.line, tool)?;
        // What the operator's program leaves behind, this one does not say.
        self.forget(scan.line, channel)?;
        (self.standing, self.rail) = (Standing::Unknown, None);
        Ok(true)
    }
}

/// Assigns to a system variable.
fn assign(
    state: &mut State,
    scan: &Scan,
    Target { name, index, field }: Target,
    value: Value,
    channel: &mut Channel,
) -> Outcome {
    let line = scan.line;
    match (name.as_str(), field.as_ref().map(Name::as_str)) {
        ("$OUT" | "$ANOUT", None) => output(scan, name, index, &value, channel),
        ("$BASE", None) => {
            state.frame(line, ArmAction::Base(frame_of(scan, name, &value)?.map(Box::new)), channel)
        }
        ("$TOOL", None) => {
            state.frame(line, ArmAction::Tool(frame_of(scan, name, &value)?.map(Box::new)), channel)
        }
        ("$VEL", Some("CP")) => {
            let speed = positive(scan, name, &value)?;
            channel.report(line, Action::Feed(Feed::PerMinute(speed * PER_MINUTE)))
        }
        ("$VEL", Some(which @ ("ORI1" | "ORI2"))) => {
            let speed = positive(scan, name, &value)?;
            state.turn_speed[usize::from(which == "ORI2")] = Some(speed);
            channel.arm(line, ArmAction::TurnSpeed(state.turn_speed))
        }
        ("$LOAD", None) => match load(&value) {
            Some((mass, center)) => channel.arm(line, ArmAction::Load(mass, center)),
            None => Err(unfit(scan, name, &value, "{M .., CM {X ..,Y ..,Z ..,..}}")),
        },
        ("$LOOP_MSG", None) => match value {
            Value::Text(text) if state.shows => channel.report(line, Action::Message(text)),
            Value::Text(_) => Ok(()),
            other => Err(unfit(scan, name, &other, "a text")),
        },
        ("$IPO_MODE", None) => {
            let on_flange = chosen(scan, name, &value, &[("BASE", false), ("TCP", true)])?;
            channel.arm(line, ArmAction::PartOnFlange(on_flange))
        }
        ("$ACC", Some("CP" | "ORI1" | "ORI2")) | ("$ACC_AXIS", None) => {
            positive(scan, name, &value)?;
            channel.arm(line, ArmAction::Acceleration)
        }
        ("$VEL_AXIS", None) => joint_speed(state, scan, index, &value, channel),
        ("$LOOP_CONT", None) => match value {
            Value::Flag(shows) => match std::mem::replace(&mut state.shows, shows) && !shows {
                true => channel.report(line, Action::Message("".into())),
                false => Ok(()),
            },
            other => Err(unfit(scan, name, &other, "TRUE or FALSE")),
        },
        (_, field) => mode(state, scan, name, field, &value),
    }
}

/// Assigns to a variable that motions read.
fn mode(state: &mut State, scan: &Scan, name: Name, field: Option<&str>, value: &Value) -> Outcome {
    match (name.as_str(), field) {
        ("$APO", Some("CDIS")) => {
            let distance = number(scan, name, value)?;
            if distance < 0.0 {
                return Err(scan.since(0, Rule::Number, "a distance is not below 0"));
            }
            state.distance = Some(distance);
        }
        // They make corners wider: a motion that is passed by them has no bound (`Unbounded`).
        ("$APO", Some("CVEL" | "CORI" | "CPTP")) => drop(positive(scan, name, value)?),
        ("$ADVANCE", None) => {
            let count = number(scan, name, value)?;
            if count.fract() != 0.0 || !(0.0..=5.0).contains(&count) {
                let message = format!("$ADVANCE is 0 to 5, not {count}");
                return Err(scan.since(0, Rule::Number, message));
            }
        }
        ("$ORI_TYPE", None) => {
            let entries =
                [("VAR", Turning::Even), ("CONSTANT", Turning::Kept), ("JOINT", Turning::ByJoints)];
            state.turning = Some(chosen(scan, name, value, &entries)?);
        }
        ("$CIRC_TYPE", None) => {
            let entries = [("BASE", false), ("PATH", true)];
            state.along_path = Some(chosen(scan, name, value, &entries)?);
        }
        ("$BWDSTART", None) if matches!(value, Value::Flag(_)) => {}
        _ => {
            let message = format!("what {name} does is not known here");
            return Err(scan.since(0, Rule::UnknownWord, message));
        }
    }
    Ok(())
}

/// `BAS (#COMMAND,value)`, as in KUKA's `BAS.SRC`.
fn bas(state: &mut State, scan: &Scan, arguments: &[Value], channel: &mut Channel) -> Outcome {
    let line = scan.line;
    let command = match arguments {
        [Value::Entry(command), value] => value.number().map(|value| (command, value)),
        _ => None,
    };
    let Some((command, value)) = command else {
        let message = "BAS has a command and a number: BAS (#VEL_PTP,20)";
        return Err(scan.since(0, Rule::Argument, message));
    };
    let percent = value > 0.0 && value <= 100.0;
    match command.as_str() {
        "INITMOV" => state.forget(line, channel),
        "VEL_PTP" if percent => {
            state.joint_speeds = [Some(value); 6];
            channel.arm(line, ArmAction::JointSpeed(Some(value)))
        }
        "ACC_PTP" if percent => channel.arm(line, ArmAction::Acceleration),
        "VEL_CP" if value > 0.0 => {
            channel.report(line, Action::Feed(Feed::PerMinute(value * PER_MINUTE)))
        }
        "TOOL" => {
            let frame = numbered(state, scan, "TOOL_DATA", value)?;
            state.frame(line, ArmAction::Tool(frame.map(Box::new)), channel)
        }
        "BASE" => {
            let frame = numbered(state, scan, "BASE_DATA", value)?;
            state.frame(line, ArmAction::Base(frame.map(Box::new)), channel)
        }
        _ => {
            let message = format!("BAS (#{command},{value}) is not understood");
            Err(scan.since(0, Rule::UnknownCommand, message))
        }
    }
}

/// `$VEL_AXIS[1]=20`: percent of the speed of one joint. The fastest of the joints counts.
fn joint_speed(
    state: &mut State,
    scan: &Scan,
    index: Option<i64>,
    value: &Value,
    channel: &mut Channel,
) -> Outcome {
    let joint = index.and_then(|index| usize::try_from(index).ok()?.checked_sub(1));
    let speed = joint.and_then(|joint| state.joint_speeds.get_mut(joint));
    let percent = value.number().filter(|percent| *percent > 0.0 && *percent <= 100.0);
    let (Some(speed), Some(percent)) = (speed, percent) else {
        let message = "$VEL_AXIS[1] to $VEL_AXIS[6] take a number above 0, up to 100 percent";
        return Err(scan.since(0, Rule::Number, message));
    };
    *speed = Some(percent);
    let all: Option<Vec<f64>> = state.joint_speeds.iter().copied().collect();
    let fastest = all.map(|all| all.into_iter().fold(0.0, f64::max));
    channel.arm(scan.line, ArmAction::JointSpeed(fastest))
}

/// The frame of a number: 0 is that of the flange, or the world; `None` is one that the operator has measured.
fn numbered(state: &State, scan: &Scan, array: &str, number: f64) -> Outcome<Option<Frame>> {
    let index = if number.fract() == 0.0 { number as i64 } else { -1 };
    match index {
        0 => Ok(Some(Frame::IDENTITY)),
        1..=MOST_FRAMES => Ok(state.element(array, index).and_then(whole_frame).map(frame)),
        _ => Err(scan.since(0, Rule::Index, format!("no frame has the number {number}"))),
    }
}

/// `$OUT[1]=TRUE`, and `$ANOUT[1]=0.5`: -1 to 1 of the range of the output.
fn output(
    scan: &Scan,
    name: Name,
    index: Option<i64>,
    value: &Value,
    channel: &mut Channel,
) -> Outcome {
    let number = index.and_then(|index| u32::try_from(index).ok()).filter(|number| *number > 0);
    let Some(number) = number else {
        return Err(scan.since(0, Rule::Index, format!("an output has a number: {name}[1]")));
    };
    let value = match (name.as_str(), value) {
        ("$OUT", Value::Flag(on)) => OutputValue::Digital(*on),
        ("$OUT", other) => return Err(unfit(scan, name, other, "TRUE or FALSE")),
        (_, value) => match value.number().filter(|part| part.abs() <= 1.0) {
            Some(part) => OutputValue::Analog(part),
            None => return Err(unfit(scan, name, value, "a number from -1 to 1")),
        },
    };
    channel.output(scan.line, number, value)
}

/// A frame all of whose numbers are there; `None` is one of the operator.
fn frame_of(scan: &Scan, name: Name, value: &Value) -> Outcome<Option<Frame>> {
    match value {
        Value::OfOperator => Ok(None),
        Value::Fields(_) => match whole_frame(value) {
            Some(numbers) if numbers.iter().all(|number| number.is_finite()) => {
                Ok(Some(frame(numbers)))
            }
            _ => {
                let message = format!("{name} needs each of X, Y, Z, A, B and C");
                Err(scan.since(0, Rule::Frame, message))
            }
        },
        other => Err(unfit(scan, name, other, "a frame")),
    }
}

/// Mass, kg, and centre of gravity, mm, of `{M 1.5,CM {X 0,Y 0,Z 75,..},..}`.
fn load(value: &Value) -> Option<(f64, Vec3)> {
    let Value::Fields(fields) = value else { return None };
    let (_, center) = fields.iter().find(|(name, _)| name.as_str() == "CM")?;
    let center = [center.field("X")?, center.field("Y")?, center.field("Z")?];
    Some((value.field("M")?, center.into()))
}

fn number(scan: &Scan, name: Name, value: &Value) -> Outcome<f64> {
    let finite = value.number().filter(|number| number.is_finite());
    finite.ok_or_else(|| unfit(scan, name, value, "a number"))
}

fn positive(scan: &Scan, name: Name, value: &Value) -> Outcome<f64> {
    let number = number(scan, name, value)?;
    match number > 0.0 {
        true => Ok(number),
        false => Err(scan.since(0, Rule::Number, format!("{name} is above 0, not {number}"))),
    }
}

/// What an entry of an enumeration means.
fn chosen<T: Copy>(scan: &Scan, name: Name, value: &Value, entries: &[(&str, T)]) -> Outcome<T> {
    let entry = match value {
        Value::Entry(entry) => entries.iter().find(|(known, _)| *known == entry.as_str()),
        _ => None,
    };
    entry.map(|(_, meaning)| *meaning).ok_or_else(|| {
        let names: Vec<String> = entries.iter().map(|(known, _)| format!("#{known}")).collect();
        let message = format!("{name} is one of {}", names.join(", "));
        scan.since(0, Rule::Type, message)
    })
}
