//! Boards of KiCad 6 to 9 (`.kicad_pcb`).
//!
//! [`read`] takes the bytes of a file and gives a [`Board`]: the copper of both sides by net, with its
//! arcs, the holes, and the outline. Y is turned over: KiCad's points down. What is believed of the format, with
//! its sources, is in `docs/sources/kicad.md`.
//!
//! `tree` finds lists and words, `reader` obeys the items; `layer` knows where they are, `frame` how they are placed,
//! `graphic` what is drawn and `curve` its Béziers, `pad`, `zone` and `text` what these are made of.

mod curve;
mod frame;
mod graphic;
mod layer;
mod pad;
mod reader;
mod text;
mod tree;
mod zone;

use crate::board::Shape;
use crate::{Artwork, Board, Hole};
use geom::Element;
use program::Diagnostic;

/// What a board file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The board.
    pub board: Board,
    /// What is left out or looks wrong, one for each cause.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a board of KiCad 6 to 9. `file_name` is for the messages, and names the board.
///
/// Time and memory are linear in `text`, but for the union of the copper (see [`geom::region`]).
///
/// # Errors
/// Every error found, at most twenty, in the order of their lines. There is no partial result.
pub fn read(file_name: &str, text: &[u8]) -> Result<Reading, Vec<Diagnostic>> {
    let (board, warnings) = artwork(file_name, text)?.united()?;
    Ok(Reading { board, warnings })
}

/// What a board draws, each with its line in the file.
pub(crate) struct Items {
    pub(crate) front: Vec<(Shape, u32)>,
    pub(crate) back: Vec<(Shape, u32)>,
    pub(crate) holes: Vec<(Hole, u32)>,
    pub(crate) edges: Vec<(Element, u32)>,
}

/// The items of a board as they stand in its file.
///
/// # Errors
/// As [`read`].
pub(crate) fn items(file_name: &str, text: &[u8]) -> Result<Items, Vec<Diagnostic>> {
    reader::items(file_name, text)
}

/// The board of such a file, with copper that is still to be united.
///
/// # Errors
/// As [`read`].
pub fn artwork(file_name: &str, text: &[u8]) -> Result<Artwork, Vec<Diagnostic>> {
    reader::read(file_name, text)
}
