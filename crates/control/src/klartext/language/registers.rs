//! Q parameters: what they hold.

use std::collections::HashMap;

/// A Q parameter by its kind and number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Parameter {
    /// `Q0` to `Q1999`: for all programs.
    Global(u16),
    /// `QL0` to `QL499`: for the program in which it stands.
    Local(u16),
    /// `QR0` to `QR499`: kept when the control is switched off.
    Lasting(u16),
    /// `QS0` to `QS1999`: a text.
    Text(u16),
}

/// A parameter of one kind by its number, and the highest number.
type Kind = (fn(u16) -> Parameter, u32);

impl Parameter {
    /// What the letter behind Q says.
    pub(super) fn kind(letter: Option<u8>) -> Option<Kind> {
        match letter {
            None => Some((Parameter::Global, 1999)),
            Some(b'L') => Some((Parameter::Local, 499)),
            Some(b'R') => Some((Parameter::Lasting, 499)),
            Some(b'S') => Some((Parameter::Text, 1999)),
            Some(_) => None,
        }
    }
}

impl std::fmt::Display for Parameter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Parameter::Global(n) => write!(f, "Q{n}"),
            Parameter::Local(n) => write!(f, "QL{n}"),
            Parameter::Lasting(n) => write!(f, "QR{n}"),
            Parameter::Text(n) => write!(f, "QS{n}"),
        }
    }
}

/// The parameters that the control sets itself.
const PREASSIGNED: std::ops::Range<u16> = 100..200;

/// Longest text, characters.
pub(super) const LONGEST: usize = 255;

/// Largest number that the control calculates with.
const LARGEST: f64 = 1e10;

/// The values of all Q parameters. What no block has set is not known.
pub(crate) struct Registers {
    global: Numbers,
    local: Numbers,
    lasting: Numbers,
    texts: HashMap<u16, Box<[u8]>>,
}

/// Numbers by index, as far as any is set; NaN where one is not.
#[derive(Default)]
pub(crate) struct Numbers(Vec<f64>);

impl Numbers {
    fn get(&self, index: u16) -> f64 {
        self.0.get(usize::from(index)).copied().unwrap_or(f64::NAN)
    }

    fn set(&mut self, index: u16, value: f64) {
        let index = usize::from(index);
        if self.0.len() <= index {
            self.0.resize(index + 1, f64::NAN);
        }
        self.0[index] = value;
    }
}

impl Registers {
    pub(crate) fn new() -> Registers {
        Registers {
            global: Numbers::default(),
            local: Numbers::default(),
            lasting: Numbers::default(),
            texts: HashMap::new(),
        }
    }

    /// The number in a parameter, or why there is none.
    pub(crate) fn number(&self, parameter: Parameter) -> Result<f64, String> {
        let value = match parameter {
            Parameter::Global(index) => self.global.get(index),
            Parameter::Local(index) => self.local.get(index),
            Parameter::Lasting(index) => self.lasting.get(index),
            Parameter::Text(_) => return Err(format!("{parameter} is a text, not a number")),
        };
        if !value.is_nan() {
            return Ok(value);
        }
        Err(match parameter {
            Parameter::Global(index) if PREASSIGNED.contains(&index) => {
                format!(
                    "{parameter} is set by the control to what is not known here, as to the tool without a tool table"
                )
            }
            _ => format!("{parameter} has no value: no block before has set it"),
        })
    }

    /// The text in `QS`, or why there is none.
    pub(crate) fn text(&self, index: u16) -> Result<&[u8], String> {
        let text = self.texts.get(&index);
        text.map(|text| &**text)
            .ok_or_else(|| format!("QS{index} has no text: no block before has set it"))
    }

    /// A block sets a parameter.
    ///
    /// # Errors
    /// Why it cannot have this value.
    pub(crate) fn assign(&mut self, parameter: Parameter, value: f64) -> Result<(), String> {
        if value.is_nan() || value.abs() >= LARGEST {
            return Err(format!(
                "{parameter} would be {value}: the control calculates up to 10^10"
            ));
        }
        match parameter {
            Parameter::Global(index) if PREASSIGNED.contains(&index) => {
                return Err(format!("{parameter} is set by the control and not by a program"));
            }
            Parameter::Global(index) => self.global.set(index, value),
            Parameter::Local(index) => self.local.set(index, value),
            Parameter::Lasting(index) => self.lasting.set(index, value),
            Parameter::Text(_) => return Err(format!("{parameter} is a text, not a number")),
        }
        Ok(())
    }

    /// A block sets a text.
    ///
    /// # Errors
    /// Why it cannot have this value.
    pub(crate) fn assign_text(&mut self, index: u16, text: Vec<u8>) -> Result<(), String> {
        if PREASSIGNED.contains(&index) {
            return Err(format!("QS{index} is set by the control and not by a program"));
        }
        self.texts.insert(index, text.into());
        Ok(())
    }

    /// The control sets one of its own parameters, or, with NaN, no longer knows it.
    pub(crate) fn preassign(&mut self, index: u16, value: f64) {
        self.global.set(index, value);
    }

    /// Puts other QL parameters in the place of those of the program; answers these.
    pub(crate) fn exchange_local(&mut self, local: Numbers) -> Numbers {
        std::mem::replace(&mut self.local, local)
    }
}
