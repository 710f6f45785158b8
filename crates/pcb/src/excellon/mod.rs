//! Excellon drill files: holes, slots and routes, by tool.
//!
//! [`read`] takes the bytes of a file and gives a [`Drill`], in mm. Where the file leaves open which unit it is
//! in, or which zeros were left out, `evidence` looks for what says so; the reader warns of what it
//! concludes and refuses what it cannot.
//!
//! `words` finds what is in a line, `reader` obeys it; `coordinate` knows how numbers are written, `route` which arc
//! is meant, `tools` their diameters and platings.

mod coordinate;
mod evidence;
mod reader;
mod route;
mod tools;
mod words;

pub use coordinate::Unit;

use crate::contour::{Contour, Piece};
use crate::stroke::Pen;
use crate::{HoleShape, Transform};
use geom::{Element, Vec2};
use program::Diagnostic;

/// What a drill file says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drill {
    /// The tools, in the order of their definition.
    pub tools: Vec<Tool>,
    /// What is drilled and routed, in the order of the file.
    pub cuts: Vec<Cut>,
}

/// A drill, or a cutter for routes.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    /// Its number: 1 for `T1`.
    pub number: u32,
    /// Diameter, mm; 0 where the file does not say and no hole needs it.
    pub diameter: f64,
    /// Whether its holes are plated; `None` where the file does not say.
    pub plated: Option<bool>,
    /// What its holes are for (`.AperFunction`), such as `Plated,PTH,ViaDrill`.
    pub function: Option<String>,
}

/// A hole, a slot or a route.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// Line of the file (from 1).
    pub line: u32,
    /// Index of its tool.
    pub tool: u32,
    /// Where.
    pub path: HoleShape,
}

impl Drill {
    /// The exact shape of what is cut away.
    pub fn pieces(&self, cut: &Cut) -> Vec<Piece> {
        let diameter = self.tools.get(cut.tool as usize).map_or(0.0, |tool| tool.diameter);
        match &cut.path {
            HoleShape::Round(at) => vec![Piece::new(true, Contour::circle(*at, diameter / 2.0))],
            HoleShape::Slot(from, to) => {
                vec![Piece::new(true, Contour::stadium(*from, *to, diameter / 2.0))]
            }
            HoleShape::Route(elements) => {
                let pen = Pen::Round(diameter);
                let sweep = |element: &Element| pen.sweep(&Transform::NONE, element);
                elements.iter().flat_map(sweep).collect()
            }
        }
    }

    /// The corners of the smallest box around everything; `None` where there is nothing.
    pub fn extents(&self) -> Option<(Vec2, Vec2)> {
        let outlines = self.cuts.iter().flat_map(|cut| self.pieces(cut)).flat_map(|p| p.contours);
        outlines.map(|contour| contour.extents()).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }
}

/// What reading gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// What the file says.
    pub drill: Drill,
    /// What had to be concluded, or is not used, one for each cause.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a drill file. `file_name` is for the messages, and distinguishes plated holes from others where the
/// file itself does not (`-PTH`, `-NPTH`).
///
/// Time and memory are linear in `text` and in the number of holes that repeats make, which is limited
/// to a million.
///
/// # Errors
/// Every error found, at most twenty, in the order of their lines. There is no partial result.
pub fn read(file_name: &str, text: &[u8]) -> Result<Reading, Vec<Diagnostic>> {
    read_in(file_name, text, None)
}

/// The same of a file that is in `unit` where it does not say so itself.
///
/// # Errors
/// As [`read`].
pub fn read_in(
    file_name: &str,
    text: &[u8],
    unit: Option<Unit>,
) -> Result<Reading, Vec<Diagnostic>> {
    reader::read(file_name, text, unit)
}
