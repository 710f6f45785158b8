//! Gerber layers: RS-274X with the attributes of X2 and X3.
//!
//! [`read`] takes the bytes of a file and gives an [`Image`]: flashes, strokes and regions in the order in
//! which they are painted, dark or clear, in mm, with net, pad and aperture function. Step and repeat and block
//! apertures are carried out; aperture macros are evaluated; arcs stay arcs.
//!
//! From bytes to image: `block` finds commands, `words` the words in them, and `reader` obeys. `header` has what
//! holds for the whole file, `load` what holds for the next objects, `attribute` what they are for; `plot` has the
//! operations, `region` the contours, `repeat` step and repeat and block apertures; `aperture`, and of
//! macros `template`, `expression` and `primitive`, the shapes that are flashed.

mod aperture;
mod attribute;
mod block;
mod expression;
mod header;
mod image;
mod load;
mod plot;
mod primitive;
mod reader;
mod region;
mod repeat;
mod template;
mod words;

pub use crate::stroke::Pen;
pub use aperture::Aperture;
pub use attribute::Attributes;
pub use image::{Image, Object, Region, Shape};

use program::Diagnostic;

/// What a file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Its image.
    pub image: Image,
    /// What is deprecated or had to be assumed, one for each cause.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a Gerber file. `file_name` is for the messages.
///
/// Time and memory are linear in `text`, and in the number of objects that step and repeat and blocks
/// make, which is limited to five million.
///
/// # Errors
/// Every error found, at most twenty, in the order of their lines. There is no partial image.
pub fn read(file_name: &str, text: &[u8]) -> Result<Reading, Vec<Diagnostic>> {
    reader::read(file_name, text)
}
