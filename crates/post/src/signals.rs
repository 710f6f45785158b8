//! Outputs and inputs of the machine, and functions that its builder has added. A control says them only where its
//! file has a block for them; nothing of them is left out without a word.

use crate::catalogue::{BlockName, WordName};
use crate::walk::{Outcome, Walk, refuse};
use program::{Auxiliary, Diagnostic, Input, Output, OutputValue, Rule, Until};

/// Entries of the code word `output`.
mod switch {
    pub(super) const ON: usize = 0;
    pub(super) const OFF: usize = 1;
    pub(super) const ON_WITH_MOTION: usize = 2;
    pub(super) const OFF_WITH_MOTION: usize = 3;
}

/// Entries of the code word `analog`.
mod set {
    pub(super) const AT_ONCE: usize = 0;
    pub(super) const WITH_MOTION: usize = 1;
}

/// Entries of the code word `until`.
mod until {
    pub(super) const READ: usize = 0;
    pub(super) const RISE: usize = 1;
    pub(super) const FALL: usize = 2;
    pub(super) const HIGH: usize = 3;
    pub(super) const LOW: usize = 4;
}

impl Walk<'_> {
    /// An output of the machine.
    pub(crate) fn output(&mut self, output: &Output) -> Outcome {
        self.end_cycle()?;
        let number = f64::from(output.number);
        match output.value {
            OutputValue::Digital(on) => {
                let code = match (on, output.with_motion) {
                    (true, false) => switch::ON,
                    (false, false) => switch::OFF,
                    (true, true) => switch::ON_WITH_MOTION,
                    (false, true) => switch::OFF_WITH_MOTION,
                };
                self.has_code(WordName::Output, code)?;
                self.writer.code(WordName::Output, code);
                self.writer.set(WordName::Signal, number);
                self.required(BlockName::DigitalOutput)
            }
            OutputValue::Analog(value) => {
                let code = if output.with_motion { set::WITH_MOTION } else { set::AT_ONCE };
                self.has_code(WordName::AnalogOutput, code)?;
                self.writer.code(WordName::AnalogOutput, code);
                self.writer.set(WordName::Channel, number);
                self.writer.set(WordName::Value, value);
                self.required(BlockName::AnalogOutput)
            }
        }
    }

    /// An input of the machine, for which the program waits or which it reads.
    pub(crate) fn input(&mut self, input: &Input) -> Outcome {
        self.end_cycle()?;
        let number = f64::from(input.number);
        let code = match input.until {
            Until::ReadAnalog => {
                self.writer.set(WordName::Channel, number);
                return self.required(BlockName::AnalogInput);
            }
            Until::Read => until::READ,
            Until::Rise => until::RISE,
            Until::Fall => until::FALL,
            Until::High => until::HIGH,
            Until::Low => until::LOW,
        };
        self.has_code(WordName::Until, code)?;
        self.writer.code(WordName::Until, code);
        self.writer.set(WordName::Signal, number);
        if input.until != Until::Read {
            if self.writer.rounded(WordName::Timeout, input.timeout) <= 0.0 {
                let message = format!("a wait of {} s for an input, written as 0", input.timeout);
                return Err(refuse(Rule::Input, message).help("make it longer").into());
            }
            self.writer.set(WordName::Timeout, input.timeout);
        }
        self.required(BlockName::DigitalInput)
    }

    /// A function that the builder of the machine has added. What its number does at the machine of the source, it
    /// does at another one only where that one's file says that it has it.
    pub(crate) fn auxiliary(&mut self, function: &Auxiliary) -> Outcome {
        let Auxiliary { number, values } = *function;
        if self.machine.leaves_out(BlockName::Auxiliary.name()) {
            let message = format!("M{number} of the source is left out: `auxiliary` is empty");
            self.findings.warn(Diagnostic::warning(Rule::Auxiliary, message).line(self.line));
            return Ok(());
        }
        if self.machine.clamps(number).is_some() {
            let message = format!("M{number} works a clamp of a rotary axis on this machine");
            let help = "leave it out: the clamps are opened and closed where the axes turn";
            return Err(refuse(Rule::Auxiliary, message).help(help).into());
        }
        if !self.machine.auxiliary.contains(&number) {
            let message = format!("the machine file has no auxiliary function M{number}");
            let help = format!(
                "add {number} to `auxiliary` in the machine file if M{number} means the same there, or set \
                 `auxiliary = \"\"` under [blocks] to leave such functions out"
            );
            return Err(refuse(Rule::Auxiliary, message).help(help).into());
        }
        self.end_cycle()?;
        self.writer.set(WordName::M, f64::from(number));
        for (word, value) in [WordName::FirstValue, WordName::SecondValue].into_iter().zip(values) {
            let Some(value) = value else { continue };
            if !self.templates.places(BlockName::Auxiliary, word) {
                let message = format!(
                    "M{number} of the source is called with values, and the control has no words for them"
                );
                let help = format!("place {{{{{}}}}} in the block `auxiliary`", word.name());
                return Err(refuse(Rule::Auxiliary, message).help(help).into());
            }
            self.writer.set(word, value);
        }
        self.required(BlockName::Auxiliary)
    }

    /// # Errors
    /// The control has no text for this entry of a code word.
    fn has_code(&self, word: WordName, code: usize) -> Outcome {
        let name = word.codes().nth(code).unwrap_or_default();
        let texts = self.machine.words.get(word.name()).map(|word| &word.codes);
        if texts.is_some_and(|texts| texts.contains_key(name)) {
            return Ok(());
        }
        let message = format!("the control has no text for `{name}` of `{}`", word.name());
        let help = format!("`{name}` in [words.{}] of its file, or another program", word.name());
        Err(refuse(Rule::Unsupported, message).help(help).into())
    }
}
