//! HEIDENHAIN Klartext (TNC 640, iTNC 530).
//!
//! A program is a list of numbered blocks between `BEGIN PGM` and `END PGM`; a line that ends in `~`
//! goes on in the next one. What a block means, in which order its parts act, and where that is
//! written is stated in `docs/controls/klartext.md`. The [`flow`] of the program takes one block after the
//! other, its [`language`] gives the words, and its [`execution`] the events.

mod execution;
mod flow;
mod language;

use crate::Settings;
use crate::kernel::{Channel, Outcome};
use execution::state::Control;
use flow::run::Run;

/// Its M functions.
pub(crate) fn vocabulary() -> Vec<String> {
    language::functions::vocabulary().map(|number| format!("M{number}")).collect()
}

/// Runs a program.
pub(crate) fn run(settings: &Settings, text: &[u8], channel: &mut Channel) -> Outcome {
    let mut control = Control::new(settings, channel);
    Run::begin(&mut control, "", text)?.finish()
}
