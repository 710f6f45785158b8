//! The language: a line becomes a block of words, and what is wrong with it is said at its place.
//!
//! What a word means stands in one list ([`words`]), which of them a dialect has in its table
//! ([`super::dialects`]). A line is taken apart by that ([`block`], [`faults`]), a plain one ahead of
//! its run ([`plain`]); its numbers are calculated where it says so ([`expression`], [`arithmetic`]) from
//! what the program has set ([`parameters`]) and what the control says of itself
//! ([`parameters::System`]).

pub(super) mod arithmetic;
pub(super) mod block;
pub(super) mod expression;
mod faults;
pub(super) mod parameters;
pub(super) mod plain;
pub(super) mod value;
pub(super) mod words;

use program::Diagnostic;

/// A finding about a block.
pub(crate) type Fault = Box<Diagnostic>;
