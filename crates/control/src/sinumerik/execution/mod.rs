//! The execution of a block: what it does, from the state that the blocks before it have left.
//!
//! The [`interpreter`] goes through the block in the order of the control. It sends the axes where the
//! block says ([`motion`], [`polar`], [`arc`], [`thread`]), with a [`corner`] between two moves, drills
//! ([`cycles`], [`pattern`]) or calls again behind it ([`modal`]), and changes the [`frames`]
//! ([`programmable`], [`offsets`], [`orientation`]), and keeps to the path as [`smoothing`] says. What holds is the [`state`].

#![deny(clippy::wildcard_enum_match_arm)]

mod arc;
mod corner;
mod cycles;
mod ending;
mod frames;
pub(super) mod interpreter;
pub(super) mod modal;
mod motion;
mod offsets;
mod orientation;
mod pattern;
mod polar;
mod programmable;
pub(super) mod smoothing;
pub(crate) mod state;
mod thread;
