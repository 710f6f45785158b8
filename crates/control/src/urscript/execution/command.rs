//! Commands: their arguments, and those that are no motion.

use super::motion::within_reach;
use super::state::State;
use crate::ArmAction;
use crate::event::Action;
use crate::kernel::Channel;
use crate::kernel::arm::tool_change;
use crate::kernel::formula::Typed;
use crate::urscript::language::{Argument, Scan, Value};
use program::{Outcome, OutputValue, Rule};

/// Outputs of the controller: 0 to 7 digital, 0 and 1 analog.
const DIGITAL: u32 = 8;
const ANALOG: u32 = 2;

/// mm in a metre.
const METRE: f64 = 1000.0;

/// The commands that are understood, with the names of their arguments in order.
const COMMANDS: &[(&str, &[&str])] = &[
    ("movej", &["q", "a", "v", "t", "r"]),
    ("movel", &["pose", "a", "v", "t", "r"]),
    ("movec", &["pose_via", "pose_to", "a", "v", "r", "mode"]),
    ("set_tcp", &["pose", "tcp_name"]),
    ("set_payload", &["m", "cog"]),
    ("set_target_payload", &["m", "cog", "inertia", "transition_time"]),
    ("set_standard_digital_out", &["n", "b"]),
    ("set_digital_out", &["n", "b"]),
    ("set_standard_analog_out", &["n", "f"]),
    ("sleep", &["t"]),
    ("sync", &[]),
    ("textmsg", &["s1", "s2"]),
    ("popup", &["s", "title", "warning", "error", "blocking"]),
];

/// The arguments of a command, each by its name.
pub(super) struct Given<'a> {
    command: &'a str,
    names: &'static [&'static str],
    values: Vec<Option<&'a Value>>,
}

impl<'a> Given<'a> {
    /// # Errors
    /// The command has no such argument, or one twice.
    fn of(scan: &Scan, command: &'a str, arguments: &'a [Argument]) -> Outcome<Option<Given<'a>>> {
        let Some((_, names)) = COMMANDS.iter().find(|(name, _)| *name == command) else {
            return Ok(None);
        };
        let mut values = vec![None; names.len()];
        for (place, argument) in arguments.iter().enumerate() {
            let index = match argument.name {
                None => Some(place),
                Some(name) => names.iter().position(|own| *own == name),
            };
            match index.and_then(|index| values.get_mut(index)) {
                Some(value @ None) => *value = Some(&argument.value),
                Some(Some(_)) | None => {
                    let message = format!("{command} has the arguments {}", names.join(", "));
                    return Err(scan.since(0, Rule::Argument, message));
                }
            }
        }
        Ok(Some(Given { command, names, values }))
    }

    fn get(&self, name: &str) -> Option<&'a Value> {
        let index = self.names.iter().position(|own| *own == name)?;
        self.values.get(index).copied().flatten()
    }

    /// # Errors
    /// It is missing.
    pub(super) fn needed(&self, scan: &Scan, name: &str) -> Outcome<&'a Value> {
        self.get(name).ok_or_else(|| {
            let message = format!("{} lacks its argument {name}", self.command);
            scan.since(0, Rule::Argument, message)
        })
    }

    /// A number, or what the controller takes where it is missing.
    ///
    /// # Errors
    /// It is none.
    pub(super) fn number(&self, scan: &Scan, name: &str, otherwise: f64) -> Outcome<f64> {
        match self.get(name) {
            None => Ok(otherwise),
            Some(Value::Number(number)) if number.is_finite() => Ok(*number),
            Some(other) => {
                let message =
                    format!("{} of {} is a number, not {}", name, self.command, other.kind());
                Err(scan.since(0, Rule::Type, message))
            }
        }
    }

    /// # Errors
    /// It is not above 0.
    pub(super) fn positive(&self, scan: &Scan, name: &str, otherwise: f64) -> Outcome<f64> {
        let number = self.number(scan, name, otherwise)?;
        match number > 0.0 {
            true => Ok(number),
            false => {
                let message = format!("{name} of {} is above 0, not {number}", self.command);
                Err(scan.since(0, Rule::Number, message))
            }
        }
    }

    fn flag(&self, scan: &Scan, name: &str, otherwise: bool) -> Outcome<bool> {
        match self.get(name) {
            None => Ok(otherwise),
            Some(Value::Flag(flag)) => Ok(*flag),
            Some(other) => {
                let message =
                    format!("{} of {} is True or False, not {}", name, self.command, other.kind());
                Err(scan.since(0, Rule::Type, message))
            }
        }
    }

    /// The number of an output, 0 to below `count`.
    fn output(&self, scan: &Scan, count: u32) -> Outcome<u32> {
        self.needed(scan, "n")?;
        let number = self.number(scan, "n", -1.0)?;
        match number.fract() == 0.0 && (0.0..f64::from(count)).contains(&number) {
            true => Ok(number as u32),
            false => {
                let message = format!("the outputs are 0 to {}, not {number}", count - 1);
                Err(scan.since(0, Rule::Index, message))
            }
        }
    }
}

impl State {
    /// A command of the language, or the operator's tool change; whether it is one of them.
    pub(in crate::urscript) fn command(
        &mut self,
        scan: &Scan,
        (name, arguments): (&str, &[Argument]),
        channel: &mut Channel,
    ) -> Outcome<bool> {
        if !self.tool_change.is_empty() && name == self.tool_change {
            return self.change_tool(scan, arguments, channel).map(|()| true);
        }
        let Some(given) = Given::of(scan, name, arguments)? else { return Ok(false) };
        let line = scan.line;
        match name {
            "movej" => self.movej(scan, &given, channel)?,
            "movel" => self.movel(scan, &given, channel)?,
            "movec" => self.movec(scan, &given, channel)?,
            "set_tcp" => {
                let Value::Pose(pose) = given.needed(scan, "pose")? else {
                    return Err(scan.since(0, Rule::Type, "the tool is a pose: p[x,y,z,rx,ry,rz]"));
                };
                let tool = within_reach(scan, *pose)?;
                channel.arm(line, ArmAction::Tool(Some(Box::new(tool))))?;
            }
            "set_payload" | "set_target_payload" => load(scan, &given, channel)?,
            "set_standard_digital_out" | "set_digital_out" => {
                given.needed(scan, "b")?;
                let on = given.flag(scan, "b", false)?;
                channel.output(line, given.output(scan, DIGITAL)?, OutputValue::Digital(on))?;
            }
            "set_standard_analog_out" => {
                given.needed(scan, "f")?;
                let part = given.number(scan, "f", 0.0)?;
                if !(0.0..=1.0).contains(&part) {
                    let message =
                        format!("an analog output is set to a part of it, 0 to 1, not {part}");
                    return Err(scan.since(0, Rule::Number, message));
                }
                channel.output(line, given.output(scan, ANALOG)?, OutputValue::Analog(part))?;
            }
            "sleep" => {
                given.needed(scan, "t")?;
                let seconds = given.number(scan, "t", 0.0)?;
                if seconds < 0.0 {
                    return Err(scan.since(0, Rule::Dwell, "a program does not sleep below 0 s"));
                }
                channel.report(line, Action::Dwell(seconds))?;
            }
            "textmsg" | "popup" => message(scan, &given, channel)?,
            _ => {}
        }
        Ok(true)
    }

    fn change_tool(
        &mut self,
        scan: &Scan,
        arguments: &[Argument],
        channel: &mut Channel,
    ) -> Outcome {
        let number = match arguments {
            [Argument { name: None, value }] => value.number(),
            _ => None,
        };
        let tool = tool_change(number).map_err(|message| scan.since(0, Rule::Tool, message))?;
        let line = scan.line;
        channel.report(line, tool)?;
        // What the operator's function leaves behind, this program does not say.
        (self.speed, self.joint_rate) = (None, None);
        self.begins(line, channel)
    }
}

/// `set_payload(m,cog)`: kg, and metres in the frame of the flange.
fn load(scan: &Scan, given: &Given, channel: &mut Channel) -> Outcome {
    given.needed(scan, "m")?;
    let mass = given.positive(scan, "m", 0.0)?;
    let Some(center) = given.needed(scan, "cog")?.numbers::<3>() else {
        let message = "the centre of gravity is a list of three numbers";
        return Err(scan.since(0, Rule::Type, message));
    };
    let center = geom::Vec3::from(center) * METRE;
    channel.arm(scan.line, ArmAction::Load(mass, center))
}

/// `textmsg` writes into the log; `popup` shows a text, and waits for the operator where it blocks.
fn message(scan: &Scan, given: &Given, channel: &mut Channel) -> Outcome {
    let is_popup = given.command == "popup";
    let text = match given.needed(scan, if is_popup { "s" } else { "s1" })? {
        Value::Text(text) => text.clone(),
        Value::Number(number) => number.to_string().into(),
        other => {
            let message = format!("{} where a text is needed", other.kind());
            return Err(scan.since(0, Rule::Type, message));
        }
    };
    let line = scan.line;
    channel.report(line, Action::Message(text))?;
    match is_popup && given.flag(scan, "blocking", false)? {
        true => channel.report(line, Action::Stop),
        false => Ok(()),
    }
}
