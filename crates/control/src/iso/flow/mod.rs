//! The flow of a program: which line is next.
//!
//! Line follows line ([`mod@run`], [`ahead`]) in the files that belong to the program ([`source`]), unless a call
//! ([`calls`], with what it keeps of the modes: [`modes`]), an O-word ([`owords`], [`branches`]) or a
//! statement of macro B ([`macros`]) leads elsewhere.

pub(super) mod ahead;
mod branches;
mod calls;
mod corners;
mod macros;
mod modes;
mod owords;
pub(super) mod run;
pub(super) mod source;
