//! SINUMERIK 840D sl and 828D, milling.
//!
//! What the language means, with the manual that says so: `docs/controls/sinumerik.md`. The [`flow`] of
//! a program goes from block to block and through its calls. In its [`language`] a block is read whole
//! before anything is done; what it says of the order of blocks goes back to the flow, and the rest is
//! carried out ([`execution`]).

mod execution;
mod flow;
mod language;

use crate::Settings;
use crate::kernel::{Channel, Outcome};

/// Its commands, addresses, calls and cycles, and the M functions of the control itself.
pub(crate) fn vocabulary() -> Vec<String> {
    let words = language::vocabulary().into_iter();
    words.chain((0..=45).chain([70]).map(|number| format!("M{number}"))).collect()
}

/// Runs a program.
pub(crate) fn run(settings: &Settings, text: &[u8], channel: &mut Channel) -> Outcome {
    flow::run::Run::main(settings, text, channel)
}
