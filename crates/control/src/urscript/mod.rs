//! URScript, the language of Universal Robots (CB3 and e-Series): programs of motions, assignments, outputs and calls.
//!
//! `language` takes a line apart, `flow` goes through functions and what they call, `execution` keeps what is active and reports
//! motions. What each statement does, with its source, is in `docs/controls/urscript.md`. Control structures of hand-written programs
//! (`if`, `while` but for an input) are refused, not skipped.

mod execution;
mod flow;
mod language;

use crate::Settings;
use crate::kernel::Channel;
use program::Outcome;

/// Runs a program.
pub(crate) fn run(settings: &Settings, text: &[u8], channel: &mut Channel) -> Outcome {
    flow::run(settings, text, channel)
}

/// A statement of each word that is understood.
pub(crate) fn vocabulary() -> Vec<String> {
    language::SAMPLES.iter().map(|sample| String::from(*sample)).collect()
}
