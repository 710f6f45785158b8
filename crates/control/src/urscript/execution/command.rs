//! Commands that are no motion.

use super::arguments::Given;
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
