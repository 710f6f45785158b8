//! What a program has set: data, modes, frames.

use crate::event::{Action, Risk};
use crate::kernel::Channel;
use crate::kernel::arm::{MOST_VARIABLES, tool_change};
use crate::kernel::formula::Typed;
use crate::rapid::language::{Declaration, Name, Readable, Scan, Target, Value};
use crate::{ArmAction, Turning};
use geom::Frame;
use program::{Outcome, OutputValue, Rule};
use std::collections::HashMap;

/// Data of a program.
struct Variable {
    kind: &'static str,
    value: Option<Value>,
    constant: bool,
    /// Data of a module that none of its procedures assigns: another one may not either.
    fixed: bool,
}

/// The data of a module.
#[derive(Default)]
pub(in crate::rapid) struct Data {
    variables: HashMap<Name, Variable>,
    /// How often the operator's procedure had been called when they were in use last.
    changes: u32,
}

/// What the motion before has set, so that each is reported where it changes alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Reported {
    pub(super) tool: Option<Frame>,
    pub(super) base: Option<Frame>,
    pub(super) on_flange: Option<bool>,
    pub(super) load: Option<[f64; 4]>,
    pub(super) speed: Option<[f64; 3]>,
}

/// What is active. The modes are not known before the program states them: what a program that was stopped has left is in force
/// where the operator does not begin at `main`.
pub(in crate::rapid) struct State {
    variables: HashMap<Name, Variable>,
    /// `SingArea`.
    pub(super) turning: Option<Turning>,
    /// `CirPathMode`.
    pub(super) circles: Option<Turning>,
    /// Whether `ConfL \Off` lets the arm take the posture nearest to where it stands.
    pub(super) is_nearest: bool,
    pub(super) reported: Reported,
    /// The tool in the work object, where the motion before has ended at a pose.
    pub(super) standing: Option<Frame>,
    /// The name of the operator's procedure that changes tools.
    tool_change: String,
    /// How often it has been called.
    changes: u32,
    /// What names of digital and of analog signals begin with; their numbers follow.
    signals: [String; 2],
}

/// What the operator's procedure leaves of data.
fn forget(variables: &mut HashMap<Name, Variable>) {
    for variable in variables.values_mut().filter(|variable| !variable.constant) {
        variable.value = None;
    }
}

impl Readable for State {
    fn value(&self, name: Name) -> Option<(&'static str, Option<&Value>)> {
        let variable = self.variables.get(&name)?;
        Some((variable.kind, variable.value.as_ref()))
    }
}

impl State {
    pub(in crate::rapid) fn new(tool_change: &str, signals: &[String; 2]) -> State {
        State {
            variables: HashMap::new(),
            turning: None,
            circles: None,
            is_nearest: false,
            reported: Reported::default(),
            standing: None,
            changes: 0,
            tool_change: tool_change.to_ascii_uppercase(),
            signals: signals.clone().map(|name| name.to_ascii_uppercase()),
        }
    }

    /// `ConfL`.
    pub(in crate::rapid) fn set_nearest(&mut self, is_nearest: bool) {
        self.is_nearest = is_nearest;
    }

    /// `SingArea`.
    pub(in crate::rapid) fn set_turning(&mut self, turning: Turning) {
        self.turning = Some(turning);
    }

    /// `CirPathMode`.
    pub(in crate::rapid) fn set_circles(&mut self, turning: Turning) {
        self.circles = Some(turning);
    }

    /// Data are declared.
    ///
    /// # Errors
    /// Others have that name, or there are too many.
    pub(in crate::rapid) fn declare(
        &mut self,
        scan: &Scan,
        from: usize,
        declared: Declaration,
    ) -> Outcome {
        let Declaration { name, kind, value, constant } = declared;
        if self.variables.len() >= MOST_VARIABLES {
            let message = "more data than a controller has room for";
            return Err(scan.since(from, Rule::TooMuch, message));
        }
        let variable = Variable { kind, value, constant, fixed: false };
        match self.variables.insert(name, variable) {
            None => Ok(()),
            Some(_) => Err(scan.since(from, Rule::Twice, format!("{name} is declared twice"))),
        }
    }

    /// Data of a module, which procedures of it assign or not. What a program assigns keeps that value for its next run (persistent data,
    /// and variables in continuous mode: ABB, "RAPID data"), so it has none before it is assigned.
    pub(in crate::rapid) fn outlive(&mut self, name: Name, is_assigned: bool) {
        if let Some(variable) = self.variables.get_mut(&name) {
            match is_assigned && !variable.constant {
                true => variable.value = None,
                false => variable.fixed = true,
            }
        }
    }

    /// Other data take the place of those that are there, which come back.
    pub(in crate::rapid) fn exchange(&mut self, mut data: Data) -> Data {
        if data.changes < self.changes {
            forget(&mut data.variables);
        }
        let variables = std::mem::replace(&mut self.variables, data.variables);
        Data { variables, changes: self.changes }
    }

    /// What a procedure has declared ends with it.
    pub(in crate::rapid) fn leave(&mut self, declared: &[Name]) {
        for name in declared {
            self.variables.remove(name);
        }
    }

    /// An assignment.
    pub(in crate::rapid) fn assign(
        &mut self,
        scan: &Scan,
        from: usize,
        target: &Target,
        value: Value,
    ) -> Outcome {
        let wrong = |message: String| Err(scan.since(from, Rule::Variable, message));
        let Some(variable) = self.variables.get_mut(&target.name) else {
            return wrong(format!("{} is not declared here", target.name));
        };
        if variable.constant {
            return wrong(format!("{} is a constant", target.name));
        }
        if variable.fixed {
            return wrong(format!(
                "{} belongs to another module, which relies on its value in the next run",
                target.name
            ));
        }
        if target.places.is_empty() {
            variable.value = Some(value);
            return Ok(());
        }
        let Some(mut part) = variable.value.as_mut() else {
            return wrong(format!("no statement has set the other parts of {}", target.name));
        };
        for place in &target.places {
            let Value::List(parts) = part else { return wrong(String::from("it has no parts")) };
            match parts.get_mut(*place) {
                Some(inner) => part = inner,
                None => return wrong(String::from("it has no such part")),
            }
        }
        *part = value;
        Ok(())
    }

    /// A call of the operator's tool change; whether it is that.
    pub(in crate::rapid) fn called(
        &mut self,
        (scan, from, line): (&Scan, usize, u32),
        name: Name,
        arguments: &[Value],
        channel: &mut Channel,
    ) -> Outcome<bool> {
        if self.tool_change.is_empty() || name.as_str() != self.tool_change {
            return Ok(false);
        }
        let number = if let [value] = arguments { value.number() } else { None };
        let tool = tool_change(number).map_err(|message| scan.since(from, Rule::Tool, message))?;
        channel.report(line, tool)?;
        // What the operator's procedure leaves behind, this program does not say.
        (self.turning, self.circles, self.is_nearest) = (None, None, false);
        (self.reported, self.standing) = (Reported::default(), None);
        self.changes += 1;
        forget(&mut self.variables);
        channel.arm(line, ArmAction::TurnSpeed([None; 2]))?;
        channel.arm(line, ArmAction::Base(None))?;
        channel.arm(line, ArmAction::Tool(None))?;
        Ok(true)
    }

    /// The number of a signal by its name; `None` where the machine has no such name.
    fn signal(&self, name: Name, which: usize) -> Option<u32> {
        let prefix = &self.signals[which];
        let digits = name.as_str().strip_prefix(prefix.as_str())?;
        let plain = !prefix.is_empty() && !digits.starts_with('0') && digits.len() <= 6;
        digits.parse().ok().filter(|_| plain)
    }

    /// `SetDO`, `SetAO`.
    pub(in crate::rapid) fn output(
        &mut self,
        line: u32,
        name: Name,
        value: OutputValue,
        channel: &mut Channel,
    ) -> Outcome {
        let which = usize::from(matches!(value, OutputValue::Analog(_)));
        match self.signal(name, which) {
            Some(number) => channel.output(line, number, value),
            None => channel.report(line, Action::Risk(Box::new(Risk::OPERATOR_SIGNAL))),
        }
    }

    /// `WaitDI`.
    pub(in crate::rapid) fn input(
        &mut self,
        line: u32,
        name: Name,
        on: bool,
        channel: &mut Channel,
    ) -> Outcome {
        // Inputs have names of their own: their number is that at the end of the name.
        let digits = name.as_str().trim_start_matches(|c: char| !c.is_ascii_digit());
        let Ok(number) = digits.parse() else {
            return channel.report(line, Action::Risk(Box::new(Risk::OPERATOR_SIGNAL)));
        };
        channel.input(line, number, on)
    }
}
