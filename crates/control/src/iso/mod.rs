//! ISO code: FANUC 30i for milling, LinuxCNC's RS-274, and GRBL 1.1.
//!
//! The three share the words and the order of execution and differ in tables ([`words`]) and in the
//! rules that each maker states; `docs/controls/iso.md` and its neighbours say which, with sources.
//! A line goes by as it stands ([`run`]), or leads elsewhere: O-words ([`owords`]) and statements of
//! macro B ([`macros`]). A block is taken apart ([`block`]), its numbers calculated where it says so
//! ([`expression`], [`parameters`], [`system`]), run on a copy of the [`state`] with its records held
//! back ([`execute`], [`motion`], [`arcs`], [`cycles`]), and only a block without a mistake takes effect.

mod arcs;
mod block;
mod cycles;
mod execute;
mod expression;
mod macros;
mod motion;
mod owords;
mod parameters;
mod run;
mod source;
mod state;
mod system;
mod words;

use crate::{Settings, Sink};
use block::Fault;
use run::Run;
use source::Source;

/// Runs a program.
pub(crate) fn run(settings: &Settings, text: &[u8], sink: &mut Sink) -> Result<(), Fault> {
    let main = Source::program(text);
    Run::new(settings, &main, sink).run()
}
