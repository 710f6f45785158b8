//! What the dissertation printed that the models come from: its tables, its slips, and the model that stands for its lost
//! cloud. Only `toolpost glass tables` and the tests read this.

mod appendix_f;
pub mod parabola;
pub mod surrogate;
mod tables;

pub use tables::{Check, Row, Series, checks, report, series};

/// Points of the experiment's object, whose geometry is lost.
pub const POINTS: f64 = 16_179.0;
