//! Two-dimensional drawings as lines and arcs, each with its line of the source; smooth curves become arcs; readers of DXF and HP-GL.
//!
//! Lengths are mm, angles radians. Nothing here knows what a drawing is for: `wire` chains its pieces to contours, `glass` puts
//! points along them. The same file gives the same pieces, bit for bit; what is
//! left out of a drawing is named, with its first line.
//!
//! ```
//! use toolpost_sketch::dxf;
//!
//! let text = "0\nSECTION\n2\nENTITIES\n0\nLINE\n10\n0\n20\n0\n11\n3\n21\n4\n0\nENDSEC\n0\nEOF\n";
//! let drawing = dxf::read(text.as_bytes(), &dxf::Options::default())?;
//! assert_eq!(drawing.pieces[0].elements[0].length(), 5.0);
//! # Ok::<(), Box<program::Diagnostic>>(())
//! ```

pub mod dxf;
mod element;
mod fit;

pub use element::{ARC_TOLERANCE, Direction, Element, FAR, SAME, finite};
