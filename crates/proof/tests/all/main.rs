//! The tests of this crate, one file for each subject: compiled together, they are linked once.

mod any_damage;
mod common;
mod feeds;
mod five_axes;
mod holes;
mod motion;
mod motions;
mod signals;
mod state;
mod travel;
