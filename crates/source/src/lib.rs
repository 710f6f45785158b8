//! Readers: what CAM systems write, in; a neutral [`program::Program`], out.
//!
//! A reader promises a whole program or none: what it cannot pass on is a [`program::Diagnostic`] with file, line and
//! column. All lengths leave a reader in mm, feeds in mm/min, all poses in the work frame. The same bytes give the same program.
//!
//! ```
//! use program::Op;
//! use toolpost_source::apt;
//!
//! let text = b"UNITS/INCHES\nLOADTL/1\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,1\nFEDRAT/4,IPM\nGOTO/0,0,-0.5\nFINI\n";
//! let program = apt::read("hole.cls", text, &apt::Options::default()).unwrap().program;
//! let Some(Op::Line(end)) = program.records.iter().map(|record| &record.op).rfind(|op| op.pose().is_some()) else { panic!() };
//! assert_eq!(end.point().z, -12.7);
//! ```
//!
//! It never reads a file itself, never guesses what a word means, and leaves nothing out silently.

pub mod apt;
