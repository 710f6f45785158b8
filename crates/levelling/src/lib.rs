//! Surfaces that are not flat: probed on a grid, and programs that follow them.
//!
//! ```text
//!   Grid ── probing ──▶ Program ─ ─ the machine ─ ─▶ log ── read ──▶ HeightMap
//!                                                                        │
//!                       Program ──────────────── level ──────────────────┴──▶ Program
//!
//!   Grid and Program ── follow ──▶ Program that probes and follows, all on the control
//! ```
//!
//! A map, and what it makes of a program that finds the surface itself, is [`program::heights`]: the proof takes it
//! from there. The surface between the places that were probed is bilinear; Z 0 is where the surface was taken to be. What
//! is believed of the logs, with its sources, is in `docs/sources/heights.md`.

mod course;
mod follow;
mod grid;
mod ground;
mod heights;
mod level;
mod log;

pub use follow::follow;
pub use grid::{Grid, Probing};
pub use heights::height_map;
pub use level::{Allowed, level};
pub use log::read;
