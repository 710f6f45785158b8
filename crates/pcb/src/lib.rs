//! Printed circuit boards: from their files to what a machine does.
//!
//! The crate promises tools that cut no copper which is to stay, or a finding that says where and how much they do.
//!
//! ```text
//!   gerber, excellon ─┐                     ┌─ isolation, voronoi ─┐
//!   kicad ────────────┼──▶ Artwork ▶ Board ─┼─ clearing, engraving ┼──▶ Operation ──job──▶ Program
//!   model ────────────┘                     └─ drilling, outline ──┘
//! ```
//!
//! Arcs stay arcs. Readers report every error they find, at most twenty, or give a result with warnings. Areas are
//! [`geom::region`]s; what a tool does is an [`Operation`], along [`Path`]s in an order of short travel ([`tour`]).
//!
//! The board is seen from above, its surface is Z 0; lengths are mm, feeds mm/min, angles radians. The same files and
//! settings give the same paths in the same order, on any number of threads.
//!
//! ```
//! use toolpost_pcb::isolation::{Direction, Isolation, Narrow};
//! use toolpost_pcb::{Copper, Cutter, gerber};
//!
//! // Two round pads of 2 mm, 5 mm apart.
//! let layer = b"%FSLAX36Y36*%%MOMM*%%ADD10C,2*%D10*X0Y0D03*X5000000D03*M02*";
//! let image = gerber::read("front.gbr", layer).unwrap().image;
//! let (copper, _) = Copper::of_image(&image).unwrap();
//!
//! let isolation = Isolation {
//!     cutter: Cutter::Cylinder { diameter: 0.2 },
//!     depth: 0.1,
//!     passes: 1,
//!     overlap: 0.0,
//!     direction: Direction::Climb,
//!     narrow: Narrow::LeaveOut,
//! };
//! let isolated = isolation.isolate(&copper, None).unwrap();
//! // The centre of the tool goes round each pad once, at half its width from the copper.
//! let lengths: Vec<f64> = isolated.paths.iter().map(|path| path.length()).collect();
//! assert_eq!(lengths.len(), 2);
//! assert!(lengths.iter().all(|mm| (mm - 1.1 * std::f64::consts::TAU).abs() < 1e-6));
//! ```
//!
//! It never writes NC text or knows a machine, and it never mends a board silently: what it closes, leaves out or assumes is
//! a warning. What is believed of the formats, with its sources, is in `docs/sources`; what is made of a board in
//! `docs/pcb.md`.

mod arc;
pub mod board;
mod clearing;
mod contour;
mod crossing;
mod decimal;
mod drawn;
pub mod drilling;
mod engraving;
pub mod excellon;
pub mod gerber;
mod hole;
pub mod isolation;
pub mod job;
pub mod kicad;
mod linking;
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
pub use drawn::{Drawn, LayerFile, Line};
pub use engraving::{Engraving, engraved};
pub use geom::Transform;
pub use hole::{Hole, HoleShape};
pub use merge::{MERGED, joined};
pub use operation::{Cut, Cutter, Operation, Segment, Tool, depths};
pub use path::{Path, PathPoint};
pub use voronoi::{Division, divided};

/// The farthest coordinate that is taken, mm.
const FAR: f64 = 1e6;

/// Points nearer than this are one, mm: a tenth of the finest step that a Gerber file can have.
const SAME: f64 = 1e-7;
