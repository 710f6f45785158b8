//! The neutral program: what every reader ends in and every writer starts from.
//!
//! A [`Program`] is a flat list of [`Record`]s in the order in which they happen, each with the line
//! of the source it came from. Its vocabulary is that of cutter-location data (ISO 4343): rapid,
//! line, arc, hole, tool, spindle, feed, coolant, compensation, frame, comment.
//!
//! Lengths are mm, feeds mm/min, times s, spindle speeds 1/min. A [`Pose`] is a tool tip with an
//! orientation; a reader of cutter-location data gives both in the frame of the part (the work
//! frame), a virtual control gives what the block says ([`Orientation`]).

pub mod diagnostic;
pub mod lowering;
mod record;
pub mod statistics;
mod surface;

pub use diagnostic::{Diagnostic, Severity, line_of, nearest};
pub use record::*;
pub use surface::Surface;
