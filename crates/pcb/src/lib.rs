//! Printed circuit boards: from their files to what a machine does.
//!
//! ```text
//!   gerber, excellon ─┐                     ┌─ isolation, voronoi ─┐
//!   kicad ────────────┼──▶ Artwork ▶ Board ─┼─ clearing, engraving ┼──▶ Operation ──job──▶ Program
//!   model ────────────┘                     └─ drilling, outline ──┘
//! ```
//!
//! Nothing is flattened here: arcs stay arcs. Readers give every error they find, at most twenty, or a result
//! with warnings. Areas are [`geom::region`]s; what a tool does is an [`Operation`], its ways are [`Path`]s
//! in an order of short travel ([`tour`]). The board is seen from above, its surface is Z 0; lengths are
//! mm, feeds mm/min, angles radians.
//!
//! What is believed of the formats, with its sources, is in `docs/sources`; what is made of a board in
//! `docs/pcb.md`.

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
pub mod plan;
mod report;
pub mod setting;
mod stroke;
pub mod tour;
mod voronoi;

pub use board::{Artwork, Board, Copper, Side};
pub use clearing::{Cleared, Clearing};
pub use contour::{Contour, Piece};
pub use engraving::{Engraving, engraved};
pub use geom::Transform;
pub use hole::{Hole, HoleShape};
pub use merge::{MERGED, joined};
pub use operation::{Cut, Cutter, Operation, Stretch, Tool, depths};
pub use path::{Path, Site};
pub use voronoi::{Division, divided};

/// The farthest coordinate that is taken, mm.
const FAR: f64 = 1e6;

/// Points nearer than this are one, mm: a tenth of the finest step that a Gerber file can have.
const SAME: f64 = 1e-7;
