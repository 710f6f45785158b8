//! The arguments of a command, each by its name.

use crate::kernel::formula::Typed;
use crate::urscript::language::{Argument, Scan, Value};
use program::{Outcome, Rule};

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
    pub(super) command: &'a str,
    names: &'static [&'static str],
    values: Vec<Option<&'a Value>>,
}

impl<'a> Given<'a> {
    /// # Errors
    /// The command has no such argument, or one twice.
    pub(super) fn of(
        scan: &Scan,
        command: &'a str,
        arguments: &'a [Argument],
    ) -> Outcome<Option<Given<'a>>> {
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

    pub(super) fn flag(&self, scan: &Scan, name: &str, otherwise: bool) -> Outcome<bool> {
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
    pub(super) fn output(&self, scan: &Scan, count: u32) -> Outcome<u32> {
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
