//! The flow of a program: which block is next.
//!
//! Block follows block ([`mod@run`]) in the text of the program ([`source`]), unless it jumps or calls a
//! label or another program ([`calls`]), and goes back to where that says ([`returns`]).

mod calls;
mod returns;
pub(super) mod run;
mod source;
