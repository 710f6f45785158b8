//! SINUMERIK 840D sl and 828D, milling.
//!
//! What the language means, with the manual that says so: `docs/controls/sinumerik.md`. A program comes
//! from a [`library`] and is followed from block to block ([`mod@run`]) and through its calls ([`levels`]). A
//! block is read whole ([`words`]), with every word looked up in a table ([`commands`], [`call`],
//! [`cycles`]) and every expression evaluated ([`expression`]). What it says of the order of blocks is a
//! [`statement`], for which the program's labels and control structures are found once ([`outline`]); the
//! rest is carried out by the [`interpreter`].

mod arc;
mod block;
mod call;
mod commands;
mod corner;
mod cycles;
mod definition;
mod expression;
mod frames;
mod functions;
mod interpreter;
mod levels;
mod library;
mod motion;
mod offsets;
mod operators;
mod orientation;
mod outline;
mod pattern;
mod polar;
mod programmable;
mod run;
mod scan;
mod state;
mod statement;
mod system;
mod thread;
mod value;
mod variables;
mod words;

use crate::Settings;
use crate::compensation::Compensator;
use program::Diagnostic;

/// What may go wrong.
type Fallible<T> = Result<T, Box<Diagnostic>>;

/// Runs a program.
pub(crate) fn run(settings: &Settings, text: &[u8], compensator: &mut Compensator) -> Fallible<()> {
    run::Run::main(settings, text, compensator)
}
