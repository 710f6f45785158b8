//! The flow of a program: which block is next.
//!
//! Programs come from a [`library`]. Block follows block ([`mod@run`]) unless a statement leads
//! elsewhere: to a label or through a control structure, which the program's [`outline`] knows, or over
//! a call into another program level ([`levels`]).

mod levels;
mod library;
pub(super) mod outline;
pub(super) mod run;
