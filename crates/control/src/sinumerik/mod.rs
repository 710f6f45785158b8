//! SINUMERIK 840D sl and 828D, milling.
//!
//! What the language means, with the manual that says so: `docs/controls/sinumerik.md`. The [`flow`] of
//! a program goes from block to block and through its calls. In its [`language`] a block is read whole
//! before anything is done; what it says of the order of blocks goes back to the flow, and the rest is
//! carried out ([`execution`]). What the models differ in is a table of facts ([`models`]).

mod execution;
mod flow;
mod language;
mod models;

use crate::Settings;
use crate::kernel::{Channel, Outcome};
pub(crate) use models::{Facts, S828D, S840D};

/// Its commands, addresses, calls and cycles, and the M functions of the control itself.
pub(crate) fn vocabulary() -> Vec<String> {
    let words = language::vocabulary().into_iter();
    words.chain((0..=45).chain([70]).map(|number| format!("M{number}"))).collect()
}

/// Runs a program.
pub(crate) fn run(
    facts: &'static Facts,
    settings: &Settings,
    text: &[u8],
    channel: &mut Channel,
) -> Outcome {
    flow::run::Run::main(facts, settings, text, channel)
}
