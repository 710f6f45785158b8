//! What the objects of a layer cover, and which nets its copper belongs to.

use crate::contour::Piece;
use crate::gerber::{Image, Object};
use geom::region::{Fill, Region, RegionError, Ring};
use std::sync::Arc;

/// The copper of a side of a board.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Copper {
    /// All of it. Each island is a conductor.
    pub region: Region,
    /// The net of each island, in their order; `None` where no file says.
    pub nets: Vec<Option<Arc<str>>>,
}

/// What an image covers when all its objects are painted in their order.
///
/// # Errors
/// [`RegionError`] where a shape is out of this world or there are too many.
pub fn covered(image: &Image) -> Result<Region, RegionError> {
    let runs: Vec<&[Object]> = image.objects.chunk_by(|a, b| a.dark == b.dark).collect();
    let paint = Paint::of(&runs, &|run: &&[Object]| {
        let pieces: Vec<Vec<Piece>> = run.iter().map(|object| image.pieces(object)).collect();
        let shape = united(&pieces)?;
        Ok(Paint::new(run.first().is_some_and(|object| object.dark), shape))
    })?;
    Ok(paint.dark)
}

/// What is in any of some shapes, each of which is given by its pieces.
pub(crate) fn united(shapes: &[Vec<Piece>]) -> Result<Region, RegionError> {
    let mut rings = Vec::new();
    for pieces in shapes {
        if pieces.iter().all(|piece| piece.solid) {
            for contour in pieces.iter().flat_map(|piece| &piece.contours) {
                rings.push(Ring::new(contour.elements().to_vec())?);
            }
        } else {
            let paint = Paint::of(pieces, &|piece: &Piece| {
                Ok(Paint::new(piece.solid, united(&[vec![solid(piece)]])?))
            })?;
            rings.extend(paint.dark.rings().cloned());
        }
    }
    Region::inside(&rings, Fill::Positive)
}

/// The area of a piece, whether it adds or takes.
fn solid(piece: &Piece) -> Piece {
    Piece { solid: true, ..piece.clone() }
}

/// What painting does to the image under it: it takes `clear` away, and then adds `dark`.
#[derive(Default)]
struct Paint {
    clear: Region,
    dark: Region,
}

impl Paint {
    fn new(dark: bool, shape: Region) -> Paint {
        let nothing = Region::default();
        let (clear, dark) = if dark { (nothing, shape) } else { (shape, nothing) };
        Paint { clear, dark }
    }

    /// What `layers` do, one after the other. By halves: a layer is worked on again only as often as the
    /// logarithm of their number, however dark and clear alternate.
    fn of<T>(
        layers: &[T],
        each: &dyn Fn(&T) -> Result<Paint, RegionError>,
    ) -> Result<Paint, RegionError> {
        match layers {
            [] => Ok(Paint::default()),
            [one] => each(one),
            _ => {
                let (first, then) = layers.split_at(layers.len() / 2);
                let (first, then) = (Paint::of(first, each)?, Paint::of(then, each)?);
                Ok(Paint {
                    clear: first.clear.union(&then.clear)?,
                    dark: first.dark.difference(&then.clear)?.union(&then.dark)?,
                })
            }
        }
    }
}
