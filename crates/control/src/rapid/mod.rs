//! RAPID, the language of ABB's controllers (S4C+, IRC5, OmniCore): modules of data and procedures, motions, outputs and calls.
//!
//! `language` takes statements apart, `flow` goes through modules and what they call, `execution` keeps what is active and reports
//! motions. What each statement does, with its source, is in `docs/controls/rapid.md`. Control structures of hand-written programs
//! (`IF`, `FOR`, `WHILE`) are refused, not skipped.

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
