//! The boundaries of conductors as points, each of which knows the element that it is on.

use geom::region::Region;
use geom::{Element, Vec2};
use spade::{HasPosition, Point2};
use std::f64::consts::FRAC_PI_4;

/// The elements of the boundaries of conductors, one after the other.
pub(super) struct Boundary {
    pieces: Vec<Piece>,
}

struct Piece {
    element: Element,
    /// The island that it bounds.
    island: usize,
    /// Its neighbours on its ring.
    before: usize,
    after: usize,
}

/// A point of a boundary, or of the frame around everything.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) at: Vec2,
    /// What it is on; `None` for the frame.
    piece: Option<u32>,
}

impl HasPosition for Sample {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(self.at.x, self.at.y)
    }
}

impl Boundary {
    pub(super) fn of(region: &Region) -> Boundary {
        let mut pieces: Vec<Piece> = Vec::new();
        for (island, rings) in region.islands().iter().enumerate() {
            for ring in std::iter::once(rings.outer()).chain(rings.holes()) {
                let (first, count) = (pieces.len(), ring.elements().len());
                pieces.extend(ring.elements().iter().enumerate().map(|(i, element)| Piece {
                    element: *element,
                    island,
                    before: first + (i + count - 1) % count,
                    after: first + (i + 1) % count,
                }));
            }
        }
        Boundary { pieces }
    }

    /// How many points `spacing` mm apart are, at most, on it.
    pub(super) fn count(&self, spacing: f64) -> f64 {
        self.pieces.iter().map(|piece| steps(&piece.element, spacing)).sum()
    }

    /// Points on it up to `spacing` mm apart, among them the ends of all elements.
    pub(super) fn samples(&self, spacing: f64) -> Vec<Sample> {
        let mut samples = Vec::new();
        for (i, piece) in self.pieces.iter().enumerate() {
            let steps = steps(&piece.element, spacing);
            let at = |step: u32| piece.element.at(f64::from(step) / steps);
            let piece = u32::try_from(i).ok();
            samples.extend((0..steps as u32).map(|step| Sample { at: at(step), piece }));
        }
        samples
    }

    /// The island that a sample is on; `None` for the frame.
    pub(super) fn island(&self, sample: &Sample) -> Option<usize> {
        Some(self.pieces.get(sample.piece? as usize)?.island)
    }

    /// What is nearest to `from` of the boundary about a sample.
    pub(super) fn foot(&self, sample: &Sample, from: Vec2) -> Vec2 {
        let piece = sample.piece.and_then(|piece| self.pieces.get(piece as usize));
        let around = piece.map(|piece| {
            let neighbours = [piece.before, piece.after].map(|i| self.pieces.get(i));
            neighbours.into_iter().flatten().chain([piece])
        });
        let feet = around.into_iter().flatten().map(|piece| {
            let (t, distance) = piece.element.nearest(from);
            (distance, piece.element.at(t))
        });
        feet.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(sample.at, |(_, foot)| foot)
    }
}

/// Four points so far from the box between two corners that whatever is in there is nearer to all of it.
pub(super) fn frame(low: Vec2, high: Vec2) -> [Sample; 4] {
    let (middle, far) = ((low + high) / 2.0, 4.0 * (1.0 + low.distance(high)));
    let corners =
        [Vec2::new(-far, -far), Vec2::new(far, -far), Vec2::splat(far), Vec2::new(-far, far)];
    corners.map(|corner| Sample { at: middle + corner, piece: None })
}

/// In how many parts an element is cut so that none is longer than `spacing` mm, nor an eighth of a circle.
fn steps(element: &Element, spacing: f64) -> f64 {
    let eighths = element.turn.map_or(0.0, |turn| turn.sweep.abs() / FRAC_PI_4);
    (element.length() / spacing).max(eighths).ceil().max(1.0)
}
