//! The flow of a program: which line is next.
//!
//! Line follows line ([`mod@run`], [`ahead`]) in the files that belong to the program ([`source`]), unless a call
//! ([`calls`], with what it keeps of the modes: [`modes`]), an O-word ([`branches`]) or a statement of macro B ([`macros`])
//! leads elsewhere. Where they lead is looked up in each file once ([`owords`], [`numbers`]); a program that is under way
//! is a [`frame`].

#![deny(clippy::wildcard_enum_match_arm)]

pub(super) mod ahead;
mod branches;
mod calls;
mod corners;
mod frame;
mod macros;
mod modes;
mod numbers;
mod owords;
pub(super) mod run;
pub(super) mod source;
mod start;
