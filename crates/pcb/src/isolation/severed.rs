//! Conductors that cuts down the middle of gaps leave in pieces.

use super::slot::strokes;
use super::too_large;
use crate::report::Outcome;
use crate::{Copper, Path};
use geom::Vec2;
use geom::region::{Index, Island};

/// How far inside a boundary it is certain to which island a place belongs, mm.
const INSIDE: f64 = 0.001;

/// An island of copper that is no longer one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Severed {
    /// The island.
    pub island: usize,
    /// How many pieces it is in; 0 where nothing is left.
    pub pieces: usize,
    /// A place of its smallest piece, or where it was, mm.
    pub at: Vec2,
}

/// The islands that are not one piece any more when a tool of `width` mm has gone along `paths`.
///
/// # Errors
/// `board-too-large` where there is more than can be computed.
pub fn severed(copper: &Copper, paths: &[Path], width: f64) -> Outcome<Vec<Severed>> {
    if paths.is_empty() {
        return Ok(Vec::new());
    }
    let cut = strokes(paths, width).map_err(too_large)?;
    let left = copper.region.difference(&cut).map_err(too_large)?;
    let index = Index::new(&copper.region);
    let islands = copper.region.islands();
    // Of each island how many pieces there are, and the smallest.
    let mut pieces: Vec<(usize, f64, Option<Vec2>)> = vec![(0, f64::INFINITY, None); islands.len()];
    for piece in left.islands() {
        let Some(at) = place_in(piece) else { continue };
        let Some(of) = index.island_at(at).and_then(|island| pieces.get_mut(island)) else {
            continue;
        };
        of.0 += 1;
        if piece.area() < of.1 {
            (of.1, of.2) = (piece.area(), Some(at));
        }
    }
    let severed = islands.iter().zip(pieces).enumerate().filter(|(_, (_, of))| of.0 != 1);
    Ok(severed
        .filter_map(|(island, (copper, (pieces, _, at)))| {
            Some(Severed { island, pieces, at: at.or_else(|| place_in(copper))? })
        })
        .collect())
}

/// A point in an island; none where the island is only a sliver.
fn place_in(island: &Island) -> Option<Vec2> {
    let inside = island.outer().elements().iter().map(|element| {
        // The island is on the left of its boundary.
        element.at(0.5) + element.tangent(0.5).perp() * INSIDE
    });
    inside.into_iter().find(|place| island.contains(*place))
}
