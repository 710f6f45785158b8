//! The tests of this crate, one file for each subject: compiled together, they are linked once.

mod arms;
mod common;
mod inverse;
mod limits;
mod linearise;
mod plan;
mod time;
