//! A line of KRL: names, numbers, aggregates, expressions, statements. What a variable holds is asked of a [`Readable`].

mod expression;
mod scan;
mod statement;
mod value;
mod words;

pub(super) use expression::{Readable, whole_frame};
pub(super) use scan::Scan;
pub(super) use statement::{
    Approximation, Motion, Statement, Target, Waiting, function_name, of_kuka, read,
};
pub(super) use value::{AXES, COORDINATES, Name, OUTER, Value, frame};
pub(super) use words::SAMPLES;
