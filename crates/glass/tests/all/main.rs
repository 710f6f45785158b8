//! The tests of this crate, one file for each subject: compiled together, they are linked once.

mod bodies;
mod chain;
mod common;
mod curves;
mod ending;
mod fill;
mod galvo;
mod jobs;
mod machines;
mod optics;
mod order;
mod paint;
mod pictures;
mod polar;
mod readers;
mod sampling;
mod shells;
mod simulate;
mod slabs;
mod tables;
mod threemf;
