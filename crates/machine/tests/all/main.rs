//! The tests of this crate, one file for each subject: compiled together, they are linked once.

// By the name that the shared modules know it by.
extern crate toolpost_machine as machine;

mod arms;
mod axis_motion;
mod clock;
mod common;
mod inverse;
mod limits;
mod linearise;
mod linkage;
mod plan;
mod time;
