//! What a program has set: registers, frames, speeds.

use crate::event::{Action, Risk};
use crate::kernel::Channel;
use crate::kernel::arm::tool_change;
use crate::ls::language::{Frames, Scan, Statement, Sum, Value};
use crate::{ArmAction, Settings};
use geom::{Euler, Frame, Vec3};
use program::{Outcome, OutputValue, Rule};
use std::collections::HashMap;

/// What is active. Nothing of it is known before the program says it.
pub(in crate::ls) struct State {
    registers: HashMap<u32, f64>,
    /// Elements of position registers.
    elements: HashMap<(u32, u32), f64>,
    /// Frames that the program has set.
    frames: HashMap<(bool, u32), Frame>,
    /// The numbers of the active user frame and tool.
    pub(super) active: [Option<u32>; 2],
    /// mm/min.
    pub(super) feed: Option<f64>,
    /// Percent.
    pub(super) joint_speed: Option<f64>,
    /// The number of the user frame, the tool and the position register that programs of this machine may set.
    own: Option<u32>,
    tool_change: String,
}

impl State {
    pub(in crate::ls) fn new(settings: &Settings) -> State {
        State {
            registers: HashMap::new(),
            elements: HashMap::new(),
            frames: HashMap::new(),
            active: [None; 2],
            feed: None,
            joint_speed: None,
            own: settings.own_frame,
            tool_change: settings.tool_change.to_ascii_uppercase(),
        }
    }

    /// Before the first instruction the part stands, and frame and tool are as the operator has left them.
    pub(in crate::ls) fn begins(&mut self, line: u32, channel: &mut Channel) -> Outcome {
        self.active = [None; 2];
        for action in [ArmAction::PartOnFlange(false), ArmAction::Base(None), ArmAction::Tool(None)]
        {
            channel.arm(line, action)?;
        }
        Ok(())
    }

    /// An instruction that is neither a motion nor a call.
    pub(in crate::ls) fn instruction(
        &mut self,
        scan: &Scan,
        statement: &Statement,
        channel: &mut Channel,
    ) -> Outcome {
        let line = scan.line;
        match statement {
            Statement::Comment(text) => channel.report(line, Action::Comment(text.clone())),
            Statement::Select(which, number) => self.select(scan, *which, *number, channel),
            Statement::Frame(which, number, register) => {
                self.set_frame(scan, *which, [*number, *register], channel)
            }
            Statement::Element(register, element, sum) => {
                let value = self.sum(scan, sum)?;
                self.elements.insert((*register, *element), value);
                self.operator_data(scan, *register, channel)
            }
            Statement::Register(number, sum) => {
                let value = self.sum(scan, sum)?;
                self.registers.insert(*number, value);
                Ok(())
            }
            Statement::Digital(number, on) => {
                output(scan, *number, OutputValue::Digital(*on), channel)
            }
            Statement::Analog(number, value) => {
                let value = self.value(scan, *value)?;
                output(scan, *number, OutputValue::Analog(value), channel)
            }
            Statement::Wait(seconds) => {
                let seconds = self.value(scan, *seconds)?;
                match seconds >= 0.0 {
                    true => channel.report(line, Action::Dwell(seconds)),
                    false => Err(scan.since(0, Rule::Dwell, "a wait is not below 0 s")),
                }
            }
            Statement::Input(number, on) => channel.input(line, *number, *on),
            Statement::Message(text) => channel.report(line, Action::Message(text.clone())),
            Statement::Pause => channel.report(line, Action::Stop),
            Statement::Payload(number) => channel.arm(line, ArmAction::LoadNumber(*number)),
            Statement::Nothing | Statement::Motion(_) | Statement::Call(..) | Statement::End => {
                Ok(())
            }
        }
    }

    /// A call of the operator's tool change; whether it is that.
    pub(in crate::ls) fn called(
        &mut self,
        scan: &Scan,
        name: &str,
        arguments: &[Value],
        channel: &mut Channel,
    ) -> Outcome<bool> {
        if self.tool_change.is_empty() || !name.eq_ignore_ascii_case(&self.tool_change) {
            return Ok(false);
        }
        let number = match arguments {
            [number] => Some(self.value(scan, *number)?),
            _ => None,
        };
        let tool = tool_change(number).map_err(|message| scan.since(0, Rule::Tool, message))?;
        let line = scan.line;
        channel.report(line, tool)?;
        // What the operator's program leaves behind, this one does not say.
        (self.feed, self.joint_speed) = (None, None);
        self.registers.clear();
        self.elements.clear();
        self.begins(line, channel)?;
        Ok(true)
    }

    /// What a value comes to.
    ///
    /// # Errors
    /// No instruction has set the register.
    pub(super) fn value(&self, scan: &Scan, value: Value) -> Outcome<f64> {
        match value {
            Value::Number(number) => Ok(number),
            Value::Register(number) => self.registers.get(&number).copied().ok_or_else(|| {
                let message = format!("no instruction has set R[{number}]");
                scan.since(0, Rule::Variable, message)
            }),
        }
    }

    fn sum(&self, scan: &Scan, sum: &Sum) -> Outcome<f64> {
        let mut result = self.value(scan, sum.first)?;
        for (operator, value) in &sum.rest {
            let value = self.value(scan, *value)?;
            result = match operator {
                b'+' => result + value,
                b'-' => result - value,
                b'*' => result * value,
                _ => result / value,
            };
        }
        match result.is_finite() {
            true => Ok(result),
            false => Err(scan.since(0, Rule::Arithmetic, "the operators have no result")),
        }
    }

    /// `UFRAME_NUM=`: 0 is the world, or the flange; any other is what the program has set, or else the operator.
    fn select(
        &mut self,
        scan: &Scan,
        which: Frames,
        number: Value,
        channel: &mut Channel,
    ) -> Outcome {
        let number = self.value(scan, number)?;
        if number.fract() != 0.0 || !(0.0..=10.0).contains(&number) {
            let message = format!("no frame has the number {number}");
            return Err(scan.since(0, Rule::Index, message));
        }
        let number = number as u32;
        self.active[usize::from(which == Frames::Tool)] = Some(number);
        self.report_frame(scan, which, number, channel)
    }

    fn report_frame(
        &self,
        scan: &Scan,
        which: Frames,
        number: u32,
        channel: &mut Channel,
    ) -> Outcome {
        let frame = match number {
            0 => Some(Frame::IDENTITY),
            _ => self.frames.get(&(which == Frames::Tool, number)).copied(),
        }
        .map(Box::new);
        let action = match which {
            Frames::User => ArmAction::Base(frame),
            Frames::Tool => ArmAction::Tool(frame),
        };
        channel.arm(scan.line, action)
    }

    /// `UFRAME[9]=PR[9]`.
    fn set_frame(
        &mut self,
        scan: &Scan,
        which: Frames,
        [number, register]: [u32; 2],
        channel: &mut Channel,
    ) -> Outcome {
        if number == 0 {
            return Err(scan.since(0, Rule::Index, "frame 0 is the world, or the flange"));
        }
        let mut six = [0.0; 6];
        for (value, element) in six.iter_mut().zip(1..) {
            *value = *self.elements.get(&(register, element)).ok_or_else(|| {
                let message = format!("no instruction has set PR[{register},{element}]");
                scan.since(0, Rule::Variable, message)
            })?;
        }
        let [x, y, z, w, p, r] = six;
        let turn = Euler::FixedXyz.matrix([w, p, r].map(f64::to_radians));
        let frame = Frame::from_mat3_translation(turn, Vec3::new(x, y, z));
        self.frames.insert((which == Frames::Tool, number), frame);
        self.operator_data(scan, number, channel)?;
        match self.active[usize::from(which == Frames::Tool)] == Some(number) {
            true => self.report_frame(scan, which, number, channel),
            false => Ok(()),
        }
    }

    /// A frame or a position register changes that is not the programs' own: the operator may have measured it.
    fn operator_data(&self, scan: &Scan, number: u32, channel: &mut Channel) -> Outcome {
        if self.own == Some(number) {
            return Ok(());
        }
        channel.report(scan.line, Action::Risk(Box::new(Risk::OPERATOR_DATA)))
    }
}

fn output(scan: &Scan, number: u32, value: OutputValue, channel: &mut Channel) -> Outcome {
    if number == 0 {
        return Err(scan.since(0, Rule::Index, "outputs are numbered from 1"));
    }
    channel.output(scan.line, number, value)
}
