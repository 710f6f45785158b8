//! Drawings: the contours of an ASCII DXF file.
//!
//! Read are `LINE`, `ARC`, `CIRCLE`, `ELLIPSE`, `SPLINE`, `LWPOLYLINE` and `POLYLINE` of model space,
//! and blocks through `INSERT`. Every contour element has the line of the file on which its entity
//! begins. What is not read is counted by its kind.

mod entity;
mod groups;
mod placement;
mod reader;
mod shapes;

use crate::chain::chain;
use crate::contour::Contour;
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

/// What was in a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The contours, in the order of their first entities.
    pub contours: Vec<Contour>,
    /// What was left out, assumed or mended.
    pub warnings: Vec<Diagnostic>,
}

/// Reads the contours of a drawing.
///
/// # Errors
/// `dxf-...` with the line for a file that is no ASCII DXF, and for entities that are not whole or not
/// in the plane; `dxf-layer` for a layer that holds nothing; `curve-fit` for a curve that arcs do not
/// follow; `branch` and `gap` for elements that make no contour; `empty-contour` where there are none.
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
    let (pieces, mut warnings) = reader.finish()?;
    let chained = chain(&pieces, options.gap)?;
    if chained.contours.is_empty() {
        let refused = Diagnostic::error(Rule::EmptyContour, "the drawing holds no contour");
        return Err(refused.help("LINE, ARC, CIRCLE, polylines, ELLIPSE, SPLINE are read").into());
    }
    if chained.doubled > 0 {
        let message = format!("{} entities lie on others and were left out", chained.doubled);
        warnings.push(Diagnostic::warning(Rule::DxfDoubled, message));
    }
    if chained.gaps > 0 {
        let message =
            format!("{} gaps were closed, the widest of {:.6} mm", chained.gaps, chained.widest);
        warnings.push(Diagnostic::warning(Rule::DxfGap, message));
    }
    Ok(Drawing { contours: chained.contours, warnings })
}
