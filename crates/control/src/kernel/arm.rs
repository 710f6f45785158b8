//! What the languages of robots do alike: how they report, what no arm reaches, calls of the operator's programs.

use super::{Channel, Outcome};
use crate::event::Action;
use crate::{ArmAction, ArmMove};
use program::{Input, Output, OutputValue, Tool, Until};

/// A coordinate or a joint beyond this, mm or degrees, is no arm's.
pub(crate) const FARTHEST: f64 = 1e6;

/// Most variables that a program may set.
pub(crate) const MOST_VARIABLES: usize = 100_000;

/// Largest number of a tool.
const MOST_TOOLS: f64 = 1e6;

impl Channel<'_> {
    /// Reports what an arm does.
    pub(crate) fn arm(&mut self, line: u32, action: ArmAction) -> Outcome {
        self.report(line, Action::Arm(action))
    }

    /// Reports a motion.
    pub(crate) fn motion(&mut self, line: u32, motion: ArmMove) -> Outcome {
        self.arm(line, ArmAction::Move(Box::new(motion)))
    }

    /// Reports an output that is set at once.
    pub(crate) fn output(&mut self, line: u32, number: u32, value: OutputValue) -> Outcome {
        self.report(line, Action::Output(Output { number, value, with_motion: false }))
    }

    /// Reports that the program waits for an input, however long.
    pub(crate) fn input(&mut self, line: u32, number: u32, on: bool) -> Outcome {
        let until = if on { Until::High } else { Until::Low };
        let input = Input { number, until, timeout: f64::INFINITY };
        self.report(line, Action::Input(Box::new(input)))
    }
}

/// What a call of the operator's program for changing tools does, by its one argument.
///
/// # Errors
/// It has no such argument, or no tool has that number.
pub(crate) fn tool_change(argument: Option<f64>) -> Result<Action, &'static str> {
    match argument.filter(|number| number.fract() == 0.0 && (1.0..=MOST_TOOLS).contains(number)) {
        Some(number) => {
            Ok(Action::Tool(Box::new(Tool { number: number as u32, ..Tool::default() })))
        }
        None => Err("a tool change has the number of the tool as its one argument"),
    }
}
