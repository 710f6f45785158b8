//! Printed circuit boards: what their files say, as exact shapes in mm.
//!
//! ```text
//!   copper, mask, outline ── gerber ──▶ Image: flashes, strokes and regions, dark and clear in order
//!   holes, slots, routes ── excellon ─▶ Drill: holes and routes by tool
//! ```
//!
//! Nothing is flattened here: arcs stay arcs. A shape is a list of [`Piece`]s, each of which adds to or takes
//! from what the pieces before it made. Readers give every error they find, at most twenty, or a
//! result with warnings.
//!
//! What is believed of the two formats, with its sources, is in `docs/sources/gerber.md` and
//! `docs/sources/excellon.md`.

mod arc;
pub mod board;
mod clearing;
mod contour;
mod crossing;
mod decimal;
pub mod drilling;
mod engraving;
pub mod excellon;
pub mod gerber;
mod hole;
pub mod isolation;
pub mod job;
pub mod kicad;
mod merge;
pub mod model;
mod operation;
pub mod outline;
mod path;
mod report;
mod setting;
mod stroke;
pub mod tour;
mod voronoi;

pub use board::{Board, Copper, Side};
pub use clearing::{Cleared, Clearing};
pub use contour::{Contour, Piece};
pub use engraving::{Engraving, engraved};
pub use geom::Transform;
pub use hole::{Hole, HoleShape};
pub use merge::joined;
pub use operation::{Cut, Cutter, Operation, Stretch, Tool, depths};
pub use path::{Path, Site};
pub use voronoi::{Division, divided};

/// The farthest coordinate that is taken, mm.
const FAR: f64 = 1e6;

/// Points nearer than this are one, mm: a tenth of the finest step that a Gerber file can have.
const SAME: f64 = 1e-7;
