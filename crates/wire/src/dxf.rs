//! Drawings: the contours of an ASCII DXF file, of which [`sketch::dxf`] says what is read.

use crate::chain::chain;
use crate::contour::Contour;
use program::{Diagnostic, Rule};
pub use sketch::dxf::Options;

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
/// Those of [`sketch::dxf::read`]; `branch` and `gap` for elements that make no contour; `empty-contour` where there are none.
pub fn read(text: &[u8], options: &Options) -> Result<Drawing, Box<Diagnostic>> {
    let sketch::dxf::Drawing { pieces, mut warnings } = sketch::dxf::read(text, options)?;
    let pieces: Vec<_> = pieces.into_iter().map(|piece| piece.elements).collect();
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
