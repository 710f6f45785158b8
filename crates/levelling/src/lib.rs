//! Surfaces that are not flat: probed on a grid, and programs that follow them.
//!
//! The crate promises that a levelled cut stays within a stated deviation of the surface, and that no rapid comes nearer to it than
//! in the flat program.
//!
//! ```text
//!   Grid ── probing ──▶ Program ─ ─ the machine ─ ─▶ log ── read ──▶ HeightMap
//!                                                                        │
//!                       Program ──────────────── level ──────────────────┴──▶ Program
//!
//!   Grid and Program ── follow ──▶ Program that probes and follows, all on the control
//! ```
//!
//! Lengths are mm in the work frame; Z 0 is the surface as the program assumes it. A map, and what it makes of a program that finds
//! the surface itself, is [`program::heights`]: the proof uses the same map. Between the probed points the surface is
//! bilinear. The same map and program give the same levelled program.
//!
//! ```
//! use geom::{Vec2, Vec3};
//! use toolpost_levelling::height_map;
//!
//! // Four probed corners of a board; the one at the upper right is 0.4 mm higher.
//! let probed = [(0.0, 0.0, 0.0), (20.0, 0.0, 0.0), (0.0, 10.0, 0.0), (20.0, 10.0, 0.4)];
//! let map = height_map(&probed.map(|(x, y, z)| Vec3::new(x, y, z))).unwrap();
//! assert!((map.at(Vec2::new(10.0, 5.0)) - 0.1).abs() < 1e-9, "in the middle a quarter of it");
//! ```
//!
//! It never extends the surface beyond what the caller allows, and it divides no move of a robot, no tilted tool and no
//! compensated contour: these are refused. What is believed of the logs, with its sources, is in `docs/sources/heights.md`.

mod follow;
mod grid;
mod ground;
mod heights;
mod level;
mod log;
mod surface_line;

pub use follow::follow;
pub use grid::{Grid, Probing};
pub use heights::height_map;
pub use level::{Allowed, level};
pub use log::read;
