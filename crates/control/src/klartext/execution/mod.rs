//! The execution of a block: what it does, from the state that the blocks before it have left.
//!
//! The [`state`] turns it into events: path functions ([`motion`]) along a [`contour`] with its
//! [`approach`], cycles ([`cycle`] with its [`layout`], [`hole`], [`helix`], [`older`]) at a place or over
//! a [`pattern`], [`tool`]s, and the coordinates ([`transform`], and the tilted [`plane`]).

#![deny(clippy::wildcard_enum_match_arm)]

mod approach;
mod contour;
pub(super) mod cycle;
mod ending;
mod helix;
mod hole;
mod layout;
mod motion;
pub(super) mod older;
mod pattern;
mod plane;
pub(super) mod state;
mod tool;
mod transform;
