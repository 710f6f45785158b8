//! A statement of RAPID: names, numbers, aggregates, expressions. What a variable holds is asked of a [`Readable`].

mod expression;
mod records;
mod scan;
mod statement;
mod value;
mod words;

pub(super) use expression::Readable;
pub(super) use scan::Scan;
pub(super) use statement::{
    Declaration, Motion, MotionKind, Routine, Statement, Target, declaration, read,
};
pub(super) use value::{Name, Value, frame};
pub(super) use words::{REFUSED, RESERVED, SAMPLES};
