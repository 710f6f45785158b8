//! What a program has set: variables, frames, modes, where the arm is.

use crate::event::Action;
use crate::kernel::Channel;
use crate::kernel::arm::MOST_VARIABLES;
use crate::kernel::formula::Typed;
use crate::krl::language::{Name, Readable, Scan, Target, Value, Waiting};
use crate::{ArmAction, Turning};
use program::{Diagnostic, Outcome, Rule};
use std::collections::HashMap;

/// Where the arm is, as far as the program says it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Standing {
    /// Nothing has moved: a line may not begin here.
    NotStarted,
    /// Where only the machine knows.
    Unknown,
    /// At these joints, degrees.
    Joints([f64; 6]),
    /// At X, Y, Z, A, B, C in the base.
    Pose([f64; 6]),
}

/// A key of a variable: its name, its index, and its field where it is one of a structure.
type Key = (Name, Option<i64>, Option<Name>);

/// What is active. All of it is unknown before the program says it, and behind `BAS (#INITMOV,0)`, which takes the values of the
/// machine's configuration.
pub(in crate::krl) struct State {
    variables: HashMap<Key, Value>,
    /// The types of declared variables.
    types: HashMap<Name, Name>,
    pub(super) standing: Standing,
    /// `E1`, mm: it stays where a position leaves it out.
    pub(super) rail: Option<f64>,
    /// `$APO.CDIS`, mm.
    pub(super) distance: Option<f64>,
    /// `$ORI_TYPE`.
    pub(super) turning: Option<Turning>,
    /// Whether `$CIRC_TYPE` is `#PATH`.
    pub(super) along_path: Option<bool>,
    /// `$VEL.ORI1` and `$VEL.ORI2`, degrees/s.
    pub(super) turn_speed: [Option<f64>; 2],
    /// `$VEL_AXIS`, percent.
    pub(super) joint_speeds: [Option<f64>; 6],
    /// `$LOOP_CONT`: whether a text in `$LOOP_MSG[]` is shown to the operator.
    pub(super) shows: bool,
    /// The name of the operator's program that changes tools.
    pub(super) tool_change: String,
}

impl Readable for State {
    fn value(&self, name: Name, index: Option<i64>, field: Option<Name>) -> Option<Value> {
        let found = self.variables.get(&(name, index, field)).cloned();
        let of_operator = matches!(name.as_str(), "BASE_DATA" | "TOOL_DATA") && field.is_none();
        match found {
            None if of_operator && index.is_some() => Some(Value::OfOperator),
            None => self.field_of(name, index, field?),
            found => found,
        }
    }
}

impl State {
    pub(in crate::krl) fn new(tool_change: &str) -> State {
        State {
            variables: HashMap::new(),
            types: HashMap::new(),
            standing: Standing::NotStarted,
            rail: None,
            distance: None,
            turning: None,
            along_path: None,
            turn_speed: [None; 2],
            joint_speeds: [None; 6],
            shows: false,
            tool_change: tool_change.to_ascii_uppercase(),
        }
    }

    /// The program stops: the operator may lead the rail elsewhere.
    pub(in crate::krl) fn halted(&mut self) {
        self.rail = None;
    }

    /// The field of a structure that has been set as a whole.
    fn field_of(&self, name: Name, index: Option<i64>, field: Name) -> Option<Value> {
        let Value::Fields(fields) = self.variables.get(&(name, index, None))? else { return None };
        fields.iter().find(|(own, _)| *own == field).map(|(_, value)| value.clone())
    }

    /// What an element of an array holds.
    pub(super) fn element(&self, array: &str, number: i64) -> Option<&Value> {
        self.variables.get(&(Name::of(array)?, Some(number), None))
    }

    /// A variable has this value from here on.
    pub(in crate::krl) fn set(&mut self, scan: &Scan, target: Target, value: Value) -> Outcome {
        if self.variables.len() >= MOST_VARIABLES {
            let message = "more variables than a controller has room for";
            return Err(scan.since(0, Rule::TooMuch, message));
        }
        let value = self.typed(scan, target, value)?;
        self.variables.insert((target.name, target.index, target.field), value);
        Ok(())
    }

    /// What a variable of a declared type holds of `value`.
    ///
    /// # Errors
    /// A REAL for an INT: sources differ on how the controller rounds it. A number for a variable whose type nothing states.
    fn typed(&self, scan: &Scan, target: Target, value: Value) -> Outcome<Value> {
        if let Some(field) = target.field {
            return Ok(value.in_field(field));
        }
        let kind = self.types.get(&target.name).map(Name::as_str);
        match (kind, value) {
            (Some("REAL"), value) => Ok(value.real()),
            (Some("INT"), value @ Value::Number(_)) => {
                let help = "write a whole number without a point, or declare the variable REAL";
                Err(Box::new(unfit(scan, target.name, &value, "a whole number").help(help)))
            }
            (None, Value::Number(_) | Value::Integer(_)) => {
                let message = format!("whether {} is INT or REAL is not stated", target.name);
                Err(Box::new(scan.since(0, Rule::Variable, message).help("declare it: DECL REAL")))
            }
            (_, value) => Ok(value),
        }
    }

    /// Variables are of a type from here on.
    ///
    /// # Errors
    /// One of them is of another type already; there are too many of them.
    pub(in crate::krl) fn declare(&mut self, scan: &Scan, kind: Name, names: &[Name]) -> Outcome {
        for name in names {
            if self.types.len() >= MOST_VARIABLES {
                let message = "more variables than a controller has room for";
                return Err(scan.since(0, Rule::TooMuch, message));
            }
            if self.types.insert(*name, kind).is_some_and(|other| other != kind) {
                let message = format!("{name} is declared twice, of different types");
                return Err(scan.since(0, Rule::Twice, message));
            }
        }
        Ok(())
    }

    /// Frames and modes are as the machine is configured, or as another program has left them.
    pub(super) fn forget(&mut self, line: u32, channel: &mut Channel) -> Outcome {
        (self.distance, self.turning, self.along_path) = (None, None, None);
        self.turn_speed = [None; 2];
        channel.arm(line, ArmAction::TurnSpeed(self.turn_speed))?;
        self.joint_speeds = [None; 6];
        channel.arm(line, ArmAction::JointSpeed(None))?;
        self.frame(line, ArmAction::Base(None), channel)?;
        self.frame(line, ArmAction::Tool(None), channel)
    }

    /// A frame changes: the pose counts in another one from here on.
    pub(super) fn frame(&mut self, line: u32, action: ArmAction, channel: &mut Channel) -> Outcome {
        if matches!(self.standing, Standing::Pose(_)) {
            self.standing = Standing::Unknown;
        }
        channel.arm(line, action)
    }

    /// A wait.
    pub(in crate::krl) fn wait(
        &mut self,
        scan: &Scan,
        waiting: Waiting,
        channel: &mut Channel,
    ) -> Outcome {
        let line = scan.line;
        match waiting {
            Waiting::Seconds(seconds) => channel.report(line, Action::Dwell(seconds)),
            // It is taken away.
            Waiting::Message => channel.report(line, Action::Message("".into())),
            Waiting::Input(number, on) => {
                let Ok(number) = u32::try_from(number) else {
                    return Err(scan.since(0, Rule::Index, "no input has this number"));
                };
                channel.input(line, number, on)
            }
        }
    }
}

/// The error of an assignment whose value does not fit.
pub(super) fn unfit(scan: &Scan, name: Name, value: &Value, needed: &str) -> Box<Diagnostic> {
    let message = format!("{name} takes {needed}, not {}", value.kind());
    scan.since(0, Rule::Type, message)
}
