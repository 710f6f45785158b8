//! Loose elements as contours, whatever their order and direction.

use crate::contour::Contour;
use geom::ChainError;
use program::{Diagnostic, Rule};
use sketch::Element;

/// What chaining made.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Chained {
    /// The contours, in the order of their first pieces, which give the direction.
    pub contours: Vec<Contour>,
    /// How many pieces lay on another one and fell away.
    pub doubled: usize,
    /// How many gaps were closed.
    pub gaps: usize,
    /// The widest of them, mm.
    pub widest: f64,
}

/// Chains `pieces`, each of which hangs together already, where their ends are no more than `gap` mm
/// apart; the nearest ends first.
///
/// # Errors
/// `branch` where more than two ends meet; `too-tangled` where too many ends lie within `gap`; those
/// of [`Contour::new`].
pub(crate) fn chain(pieces: &[Vec<Element>], gap: f64) -> Result<Chained, Box<Diagnostic>> {
    let shapes = |piece: &Vec<Element>| piece.iter().map(|element| element.shape).collect();
    let shapes: Vec<Vec<geom::Element>> = pieces.iter().map(shapes).collect();
    let chains = geom::chain(&shapes, gap).map_err(|error| refused(&error, pieces, gap))?;
    let mut contours = Vec::with_capacity(chains.chains.len());
    for chain in chains.chains {
        let mut elements = Vec::new();
        for (piece, backwards) in chain.pieces {
            match backwards {
                false => elements.extend(pieces[piece].iter().copied()),
                true => elements.extend(pieces[piece].iter().rev().map(Element::reversed)),
            }
        }
        contours.push(Contour::new(elements, gap)?);
    }
    let widths = chains.gaps.iter().map(|(from, to)| from.distance(*to));
    let (gaps, widest) = (chains.gaps.len(), widths.fold(0.0, f64::max));
    Ok(Chained { contours, doubled: chains.doubled, gaps, widest })
}

/// Why there are no contours, with the line that says so.
fn refused(error: &ChainError, pieces: &[Vec<Element>], gap: f64) -> Box<Diagnostic> {
    let line = |piece: usize| pieces[piece].first().map_or(0, |element| element.line);
    match *error {
        ChainError::Branch { place, pieces: [one, other] } => {
            let message = format!(
                "more than two ends meet at X{:.4} Y{:.4}: lines {} and {} are two of them",
                place.x,
                place.y,
                line(one),
                line(other)
            );
            Diagnostic::error(Rule::Branch, message)
                .help("a contour has no branches: choose layers by --layer, or take out what is too much")
                .line(line(other))
                .into()
        }
        ChainError::Tangled { place, piece } => {
            let message =
                format!("very many ends lie within {gap} mm of X{:.4} Y{:.4}", place.x, place.y);
            Diagnostic::error(Rule::TooTangled, message)
                .help("allow smaller gaps by --close, or choose layers by --layer")
                .line(line(piece))
                .into()
        }
    }
}
