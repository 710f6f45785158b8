//! ISO code: FANUC 30i for milling, Haas, LinuxCNC's RS-274, Mach3, GRBL 1.1, Marlin; of wire-EDM
//! machines; and what FreeCAD's CAM workbench keeps.
//!
//! They share the words and the order of execution and differ in tables ([`flavors`]) and in the
//! rules that each maker states; `docs/controls/iso.md` and its neighbours say which, with sources.
//! A line goes by as it stands ([`mod@run`]), or leads elsewhere: O-words ([`owords`]) and statements of
//! macro B ([`macros`]). A block is taken apart ([`block`], and where it is wrong [`faults`]), its
//! numbers calculated where it says so ([`expression`], [`parameters`], [`system`]), and run with its
//! records held back ([`execute`], [`numbers`], [`motion`], [`arcs`], [`cycles`], [`coordinates`],
//! [`tools`]): a block with a mistake leaves none.

mod arcs;
mod arithmetic;
mod block;
mod branches;
mod calls;
mod coordinates;
mod cycles;
mod execute;
mod expression;
mod faults;
mod flavors;
mod frames;
mod freecad;
mod macros;
mod modes;
mod motion;
mod numbers;
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

use crate::Settings;
use crate::compensation::Compensator;
use block::Fault;
use run::Run;
use source::Source;

/// Runs a program.
pub(crate) fn run(
    settings: &Settings,
    text: &[u8],
    compensator: &mut Compensator,
) -> Result<(), Fault> {
    let main = Source::program(text);
    Run::new(settings, &main, compensator).run()
}
