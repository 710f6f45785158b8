//! The tests of this crate, one file for each subject: compiled together, they are linked once.

mod arms;
mod common;
mod inverse;
mod limits;
mod linearise;
mod linkage;
mod plan;
mod time;
