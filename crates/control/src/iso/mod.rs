//! ISO code: FANUC 30i for milling, Haas, LinuxCNC's RS-274, Mach3, GRBL 1.1, Marlin; and of wire-EDM machines. What a CAM
//! system keeps in ISO code and no machine reads is described by the crate that reads it ([`Facts::source`]).
//!
//! They share the words and the order of execution and differ in tables (`dialects`) and in
//! the rules that each maker states; `docs/controls/iso.md` and its neighbours say which, with sources.
//! The `flow` of a program takes one line after the other, or leads elsewhere. In its `language` the
//! line becomes a block, and the `execution` carries that out with its events held back: a block with
//! a mistake leaves none.

pub(crate) mod dialects;
mod execution;
mod flow;
mod language;

use crate::Settings;
use crate::kernel::Channel;
pub use dialects::facts::{Facts, SourceRules};
use flow::ahead::Ahead;
use flow::run::Run;
use flow::source::Source;
use language::Fault;
pub use language::words::{
    Canned, Dictionary, FeedMode, G, GRow, Group, M, MRow, Motion, Path, Pattern, Plane, Refused,
    Side,
};

/// The G and M words of the dialect of these facts.
pub(crate) fn vocabulary(facts: &Facts) -> Vec<String> {
    facts.words.vocabulary()
}

/// Runs a program of the dialect of these facts.
pub(crate) fn run(
    facts: &'static Facts,
    settings: &Settings,
    text: &[u8],
    channel: &mut Channel,
) -> Result<(), Fault> {
    let main = Source::program(text);
    Ahead::of(text, |ahead| Run::new(facts, settings, &main, ahead, channel).run())
}
