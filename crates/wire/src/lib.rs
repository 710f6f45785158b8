//! Wire EDM: from a contour to the wire's way.
//!
//! ```text
//!   program ─ trace ─┐                          ┌─ points ─▶ list of coordinates
//!                    ├─▶ Contour ─▶ Plan ─▶ Path ┤
//!   drawing ─ dxf ───┘    (offset, passes,       └─▶ blocks of lines and arcs
//!                          leads, tabs, taper)
//! ```
//!
//! A [`Contour`] is a chain of lines and arcs, each with its line of the source. A [`Path`] is where
//! the wire goes: the contour of its lower end, and of its upper end where the wire leans. [`points`]
//! divides a path into the points that a control without arcs takes.
//!
//! Lengths are mm, feeds mm/min, times s, angles radians. What is refused is a
//! [`program::Diagnostic`] with the line of the source; the caller, who knows it, adds the file.

mod accuracy;
mod chain;
mod contour;
mod crossing;
pub mod cutting;
pub mod dxf;
mod element;
mod fit;
mod lead;
pub mod leg;
mod near;
pub mod offset;
mod order;
mod path;
pub mod plan;
pub mod points;
mod room;
mod round;
mod sync;
pub mod taper;
mod trace;

pub use accuracy::{Accuracy, ArcChords, Chords};
pub use contour::{Contour, Place};
pub use element::{ARC_TOLERANCE, Direction, Element};
pub use lead::{Lead, LeadShape};
pub use path::{Limits, Path};
pub use trace::{Beside, beside, contours, cuts};
