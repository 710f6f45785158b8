//! The flow of a program: which block is next.
//!
//! Programs come from a [`library`]. Block follows block ([`mod@run`]) unless a statement leads
//! elsewhere: to a label or through a control structure, which the program's [`outline`] knows, or over
//! a call ([`calls`]) into another program [`level`].

mod calls;
mod level;
mod library;
pub(super) mod outline;
pub(super) mod run;
