//! KRL, the language of KUKA's controllers (KRC2, KRC4): programs of motions, assignments, outputs and calls.
//!
//! `language` takes a line apart, `flow` goes through programs and what they call, `execution` keeps what is active and reports
//! motions. What each statement does, with its source, is in `docs/controls/krl.md`. Control structures of hand-written programs
//! (`IF`, `FOR`, `LOOP`) are refused, not skipped.

mod execution;
mod flow;
mod language;

use crate::Settings;
use crate::kernel::Channel;
use program::Outcome;

/// Runs a program, of which the name of its file is known.
pub(crate) fn run(settings: &Settings, program: (&str, &[u8]), channel: &mut Channel) -> Outcome {
    flow::run(settings, program, channel)
}

/// # Errors
/// No program has the name of a file that is called so.
pub(crate) fn check_file_name(file_name: &str) -> Outcome {
    flow::check_file_name(file_name)
}

/// A statement of each word that is understood.
pub(crate) fn vocabulary() -> Vec<String> {
    language::SAMPLES.iter().map(|sample| String::from(*sample)).collect()
}
