//! What stands in a line.

mod expression;
mod scan;
mod statement;
mod value;
mod words;

pub(super) use expression::{Argument, Readable};
pub(super) use scan::Scan;
pub(super) use statement::{Scope, Statement, read, word_of};
pub(super) use value::{Value, frame};
pub(super) use words::SAMPLES;
