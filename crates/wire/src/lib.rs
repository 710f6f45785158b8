//! Wire EDM: from a contour to the path of the wire.
//!
//! The crate promises a path that never comes nearer to the finished contour than the wire offset, or a refusal that names
//! the line of the source.
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
//! Lengths are mm, feeds mm/min, times s, angles radians, in the plane of X and Y of the drawing or program. The lower
//! contour is at Z 0. The same contours and settings give the same path, bit for bit.
//!
//! ```
//! use geom::Vec2;
//! use toolpost_wire::offset::{Corners, offset};
//! use toolpost_wire::{Contour, Element};
//!
//! # fn main() -> Result<(), Box<program::Diagnostic>> {
//! // A square punch of 10 mm, counter-clockwise: its part is on the left, the wire runs on the right.
//! let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(|(x, y)| Vec2::new(x, y));
//! let sides = (0..4).map(|i| Element::line(corners[i], corners[(i + 1) % 4])).collect();
//! let punch = Contour::new(sides, 0.001)?;
//!
//! // A wire of 0.25 mm with a spark gap of 0.01 mm: its centre is 0.135 mm from the contour.
//! let centre = offset(&punch, -0.135, Corners::Refuse)?.contour;
//! assert_eq!(centre.elements().len(), 8, "four sides, and an arc about each corner");
//! assert!((centre.length() - (40.0 + std::f64::consts::TAU * 0.135)).abs() < 1e-9);
//! # Ok(())
//! # }
//! ```
//!
//! It never reads a machine file or writes NC text, and it never moves a contour: what the wire cannot reach is reported, with
//! the amount that stays. What is refused is a [`program::Diagnostic`] with the line of the source; the caller, who knows it,
//! adds the file.

mod accuracy;
mod chain;
mod contour;
mod crossing;
pub mod cutting;
pub mod dxf;
mod lead;
mod near;
pub mod offset;
mod order;
mod path;
pub mod plan;
pub mod points;
mod room;
mod round;
pub mod segment;
mod sync;
pub mod taper;
mod trace;

pub use accuracy::{Accuracy, ArcChords, Chords};
pub use contour::{Contour, ContourPoint};

pub use lead::{Lead, LeadShape};
pub use path::{Limits, Path};
pub use sketch::{ARC_TOLERANCE, Direction, Element};
pub use trace::{Cut, OffsetContour, contours, cuts, offset_contours};
