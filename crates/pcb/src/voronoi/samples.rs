//! The boundaries of conductors as points, each of which knows the element that it is on.

use super::TooMany;
use crate::Copper;
use geom::ending::go_on;
use geom::region::Index;
use geom::{Element, Vec2};
use spade::{HasPosition, Point2};
use std::f64::consts::FRAC_PI_4;
use std::iter;

/// The farthest that points are apart, mm.
const FARTHEST: f64 = 1.0;

/// How many times farther than that another conductor is.
const APART: f64 = 4.0;

/// Gaps are looked at as if they were no narrower, mm: a region is not more exact.
const FINEST: f64 = 1e-3;

/// The elements of the boundaries of conductors, one after the other.
pub(super) struct Boundary {
    pieces: Vec<Piece>,
    /// The conductor that each island is part of.
    conductors: Vec<usize>,
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
    /// Whether another conductor is too near to be distinguished by points.
    pub(super) touches: bool,
}

impl HasPosition for Sample {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        // The triangulation has nothing else in which it can be asked.
        go_on();
        Point2::new(self.at.x, self.at.y)
    }
}

impl Boundary {
    pub(super) fn of(copper: &Copper) -> Boundary {
        let mut pieces: Vec<Piece> = Vec::new();
        for (island, rings) in copper.region.islands().iter().enumerate() {
            for ring in iter::once(rings.outer()).chain(rings.holes()) {
                let (first, count) = (pieces.len(), ring.elements().len());
                pieces.extend(ring.elements().iter().enumerate().map(|(i, element)| Piece {
                    element: *element,
                    island,
                    before: first + (i + count - 1) % count,
                    after: first + (i + 1) % count,
                }));
            }
        }
        Boundary { pieces, conductors: copper.conductors() }
    }

    /// Points on it, among them the ends of all elements: so near to each other that another conductor is
    /// four times as far. `copper` is what it bounds. No more than `most`.
    pub(super) fn samples(&self, copper: &Index, most: usize) -> Result<Vec<Sample>, TooMany> {
        let alone = |part: &Element, island: usize| {
            let (low, high) = part.extents();
            let (middle, length) = (part.at(0.5), part.length());
            let around = Vec2::splat(APART * length);
            copper.within(low - around, high + around).all(|near| {
                self.conductors.get(near.island) == self.conductors.get(island)
                    || near.element.nearest(middle).1 > (APART + 0.5) * length
            })
        };
        let mut samples = Vec::new();
        for (piece, i) in self.pieces.iter().zip(0..) {
            let parts = parts(&piece.element);
            for part in 0..parts as u64 {
                let mut open = vec![(part as f64 / parts, (part + 1) as f64 / parts)];
                while let Some((from, to)) = open.pop() {
                    go_on();
                    let part = piece.element.part(from, to);
                    let alone = alone(&part, piece.island);
                    if !alone && part.length() * APART > FINEST {
                        let middle = (from + to) / 2.0;
                        open.extend([(middle, to), (from, middle)]);
                    } else if samples.len() < most {
                        samples.push(Sample { at: part.start, piece: Some(i), touches: !alone });
                    } else {
                        return Err(TooMany);
                    }
                }
            }
        }
        Ok(samples)
    }

    fn piece(&self, sample: &Sample) -> Option<&Piece> {
        self.pieces.get(sample.piece? as usize)
    }

    /// The island that a sample is on; `None` for the frame.
    pub(super) fn island(&self, sample: &Sample) -> Option<usize> {
        Some(self.piece(sample)?.island)
    }

    /// The conductor that a sample is on; `None` for the frame.
    pub(super) fn conductor(&self, sample: &Sample) -> Option<usize> {
        self.conductors.get(self.island(sample)?).copied()
    }

    /// What is nearest to `from` of the boundary about a sample.
    pub(super) fn foot(&self, sample: &Sample, from: Vec2) -> Vec2 {
        let around = self.piece(sample).map(|piece| {
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
    corners.map(|corner| Sample { at: middle + corner, piece: None, touches: false })
}

/// In how many parts an element is cut so that none is too long, nor more than an eighth of a circle.
fn parts(element: &Element) -> f64 {
    let eighths = element.turn.map_or(0.0, |turn| turn.sweep.abs() / FRAC_PI_4);
    (element.length() / FARTHEST).max(eighths).ceil().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::region::{Fill, Region, Ring};

    #[test]
    fn points_are_as_near_to_each_other_as_the_gap_asks_for_and_no_more_than_allowed() {
        // Two plates of 10 mm, 0.2 mm apart.
        let plate = |low: f64| {
            let corners = [(0.0, low), (10.0, low), (10.0, low + 1.0), (0.0, low + 1.0)];
            Ring::polygon(&corners.map(Vec2::from)).unwrap()
        };
        let region = Region::inside(&[plate(0.0), plate(1.2)], Fill::NonZero).unwrap();
        let copper = Copper { region, nets: Vec::new() };
        let (boundary, index) = (Boundary::of(&copper), Index::new(&copper.region));
        let Ok(samples) = boundary.samples(&index, 10_000) else { panic!("too many") };
        let mut edge: Vec<f64> =
            samples.iter().filter(|s| (s.at.y - 1.0).abs() < 1e-9).map(|s| s.at.x).collect();
        edge.sort_by(f64::total_cmp);
        assert!(edge.windows(2).all(|pair| (0.015..=0.05).contains(&(pair[1] - pair[0]))));
        assert!(samples.len() < 2000 && boundary.samples(&index, 100).is_err());
    }
}
