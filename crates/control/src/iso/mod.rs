//! ISO code: FANUC 30i for milling, Haas, LinuxCNC's RS-274, Mach3, GRBL 1.1, Marlin; and of
//! wire-EDM machines.
//!
//! They share the words and the order of execution and differ in tables ([`flavors`]) and in the
//! rules that each maker states; `docs/controls/iso.md` and its neighbours say which, with sources.
//! A line goes by as it stands ([`mod@run`]), or leads elsewhere: O-words ([`owords`]) and statements of
//! macro B ([`macros`]). A block is taken apart ([`block`]), its numbers calculated where it says so
//! ([`expression`], [`parameters`], [`system`]), and run with its records held back ([`execute`],
//! [`motion`], [`arcs`], [`cycles`], [`coordinates`], [`tools`]): a block with a mistake leaves none.

mod arcs;
mod arithmetic;
mod block;
mod branches;
mod calls;
mod coordinates;
mod cycles;
mod execute;
mod expression;
mod flavors;
mod frames;
mod macros;
mod modes;
mod motion;
mod owords;
mod parameters;
mod patterns;
mod places;
mod run;
mod source;
mod splines;
mod state;
mod system;
mod threads;
mod tools;
mod wire;
mod words;

use crate::compensation::Compensator;
use crate::{Dialect, Settings};
use block::Fault;
use program::{Op, Record};
use run::Run;
use source::Source;

/// Runs a program.
pub(crate) fn run(
    settings: &Settings,
    text: &[u8],
    compensator: &mut Compensator,
) -> Result<(), Fault> {
    let main = Source::program(text);
    Run::new(settings, &main, compensator).run()?;
    // Marlin has no word for the end: the program ends with its last line.
    if settings.dialect == Dialect::Marlin {
        let lines = text.split(|&b| b == b'\n').count();
        compensator.take(Record { line: u32::try_from(lines).unwrap_or(u32::MAX), op: Op::End })?;
    }
    Ok(())
}
