//! What the objects of a layer cover, and which nets its copper belongs to.

use crate::contour::Piece;
use crate::gerber::{Image, Object};
use geom::Element;
use geom::region::{Fill, Region, RegionError, Ring, strokes};
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
        let mut shapes = Shapes::default();
        for object in *run {
            match image.stroke(object) {
                Some(stroke) => shapes.strokes.push(stroke),
                None => shapes.add(&image.pieces(object))?,
            }
        }
        Ok(Paint::new(run.first().is_some_and(|object| object.dark), shapes.united()?))
    })?;
    Ok(paint.dark)
}

/// Shapes that are to be united.
#[derive(Default)]
pub(crate) struct Shapes {
    /// The ways of round pens, with their width, mm.
    pub(crate) strokes: Vec<(Element, f64)>,
    /// What others are inside of.
    rings: Vec<Ring>,
}

impl Shapes {
    /// Adds the shape that is given by its pieces.
    pub(crate) fn add(&mut self, pieces: &[Piece]) -> Result<(), RegionError> {
        if pieces.iter().all(|piece| piece.solid) {
            for contour in pieces.iter().flat_map(|piece| &piece.contours) {
                self.rings.push(Ring::new(contour.elements().to_vec())?);
            }
            return Ok(());
        }
        let paint = Paint::of(pieces, &|piece: &Piece| {
            let mut area = Shapes::default();
            area.add(&[Piece { solid: true, ..piece.clone() }])?;
            Ok(Paint::new(piece.solid, area.united()?))
        })?;
        self.rings.extend(paint.dark.rings().cloned());
        Ok(())
    }

    /// What is in any of them.
    pub(crate) fn united(mut self) -> Result<Region, RegionError> {
        // An aperture without size draws nothing.
        self.strokes.retain(|(_, width)| *width > 0.0);
        self.rings.extend(strokes(&self.strokes)?);
        Region::inside(&self.rings, Fill::Positive)
    }
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
