//! Drawings: what an ASCII DXF file holds of lines and curves.
//!
//! Read are `LINE`, `ARC`, `CIRCLE`, `ELLIPSE`, `SPLINE`, `LWPOLYLINE` and `POLYLINE` of model space,
//! and blocks through `INSERT`. Every entity lies in a plane of its own height. What is not read is counted by its kind.

mod entity;
mod groups;
mod placement;
mod reader;
mod shapes;

use crate::Element;
use groups::groups;
use program::{Diagnostic, Rule};
use reader::Reader;

/// How a drawing is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The layers that are read; none for all that are on and not frozen.
    pub layers: Vec<String>,
    /// How far ends that belong together may be apart, mm.
    pub gap: f64,
    /// By how much arcs may leave splines and ellipses, mm.
    pub tolerance: f64,
    /// mm in a unit of the drawing; `None` for what its `$INSUNITS` says.
    pub unit: Option<f64>,
}

impl Default for Options {
    fn default() -> Options {
        Options { layers: Vec::new(), gap: 0.01, tolerance: 0.001, unit: None }
    }
}

/// Elements that hang together.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Their height over the plane of the drawing, mm.
    pub height: f64,
    /// The elements, mm, each with the line of the file on which its entity begins.
    pub elements: Vec<Element>,
}

/// What was in a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// What is drawn, in the order of the file.
    pub pieces: Vec<Piece>,
    /// What was left out or assumed.
    pub warnings: Vec<Diagnostic>,
}

/// Reads what is drawn in a file.
///
/// # Errors
/// `dxf-...` with the line for a file that is no ASCII DXF, and for entities that are not whole or not
/// in the plane; `dxf-layer` for a layer that holds nothing; `curve-fit` for a curve that arcs do not
/// follow.
pub fn read(text: &[u8], options: &Options) -> Result<Drawing, Box<Diagnostic>> {
    for (name, value) in [("gap", options.gap), ("tolerance", options.tolerance)] {
        if !(1e-6..=10.0).contains(&value) {
            let message = format!("a {name} of {value} mm");
            let refused = Diagnostic::error(Rule::DxfOptions, message);
            return Err(refused.help("between 0.000001 mm and 10 mm").into());
        }
    }
    let groups = groups(text)?;
    let mut reader = Reader::new(&groups, options);
    reader.read()?;
    reader.finish()
}
