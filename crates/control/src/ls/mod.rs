//! LS, the listing of FANUC's robot programs (R-J3 to R-30iB): instructions, and positions behind them.
//!
//! `language` takes an instruction apart, `flow` goes through programs and what they call, `execution` keeps what is active and reports
//! motions. What each instruction does, with its source, is in `docs/controls/ls.md`. Control structures of hand-written programs
//! (`IF`, `FOR`, `JMP`) are refused, not skipped.

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

/// An instruction of each word that is understood.
pub(crate) fn vocabulary() -> Vec<String> {
    language::SAMPLES.iter().map(|sample| String::from(*sample)).collect()
}
