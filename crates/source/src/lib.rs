//! Readers: what CAM systems write, in; a neutral [`program::Program`], out.
//!
//! A reader takes bytes, never a path: it does no input or output of its own. It gives a whole program
//! or none. Whatever it met that it could not pass on is a [`program::Diagnostic`] with file, line and
//! column. All lengths leave a reader in mm, all poses in the work frame.

pub mod apt;
