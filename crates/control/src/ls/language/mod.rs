//! What stands in an instruction, and in a position.

mod position;
mod scan;
mod statement;
mod words;

pub(super) use position::{Coordinates, Position, positions};
pub(super) use scan::Scan;
pub(super) use statement::{
    Frames, Motion, Shape, Speed, Statement, Sum, Termination, Value, read,
};
pub(super) use words::SAMPLES;
