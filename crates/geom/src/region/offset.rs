//! A region grown or shrunk by a distance: where the centre of a tool of that radius may go.
//!
//! The boundary of a region sweeps the area by which the region grows: a line sweeps a rectangle, an arc a sector of a
//! ring, a corner that points outwards a pie. All of these run counter-clockwise, and where they
//! share a side, one runs along it forwards and the other backwards. So their outlines and those of the
//! region add up to one chain: for each element its parallel, about a corner that points outwards an
//! arc, and at one that points inwards two lines through the corner itself. The grown region is what the
//! chain runs around at least once ([`Fill::Positive`]), however often it crosses itself. Shrinking is
//! growing what is outside: the same chain on the other side.
//!
//! Where parallels of lines cross at a corner that points inwards, the chain goes on there, without the lines through
//! the corner: the kernel has fewer crossings to look for.

use super::chords::boolean;
use super::kernel::Keep;
use super::{FAR, Fill, Region, RegionError};
use crate::{Element, Vec2, turn_angle};
use std::f64::consts::PI;
use std::iter;

/// Tips of parallels this near to each other need nothing between them, mm.
const SAME: f64 = 1e-6;

/// A turn that is so near to half a turn is one, radians: rounding of coordinates.
const BACK: f64 = 1e-5;

impl Region {
    /// All points up to `distance` mm from this region; where negative, all points in it that are
    /// farther than that from its boundary. Corners become round.
    ///
    /// # Errors
    /// Where the distance is no number or beyond 100 m, and [`RegionError::TooLarge`].
    pub fn offset(&self, distance: f64) -> Result<Region, RegionError> {
        if distance.is_nan() || distance.abs() > FAR {
            return Err(RegionError::NotALength(distance));
        }
        let chains: Vec<_> = self.chains().map(|chain| chain_at(chain, distance)).collect();
        boolean(chains.iter().map(Vec::as_slice), iter::empty(), Keep::Union, Fill::Positive)
    }
}

/// The chain at `distance` mm on the right of a ring.
fn chain_at(ring: &[Element], distance: f64) -> Vec<Element> {
    let mut sides: Vec<Side> = ring.iter().map(|element| Side::of(element, distance)).collect();
    for i in 0..ring.len() {
        trim(ring, &mut sides, i, distance);
    }
    let mut chain = Vec::with_capacity(2 * ring.len());
    let nexts = ring.iter().zip(&sides).cycle().skip(1);
    for ((element, side), (next, after)) in ring.iter().zip(&sides).zip(nexts) {
        let corner = next.start;
        let from = match side.curve {
            OffsetCurve::Parallel(parallel) => {
                chain.push(parallel);
                parallel.end
            }
            OffsetCurve::Around(center) => {
                chain.push(Element::line(element.start, center));
                chain.push(Element::line(center, corner));
                corner
            }
        };
        let to = match after.curve {
            OffsetCurve::Parallel(parallel) => parallel.start,
            OffsetCurve::Around(_) => corner,
        };
        let line = |from, to| (from != to).then(|| Element::line(from, to));
        let turn = turn_at(element, next);
        if turn * distance > 0.0 && side.end.distance(after.start) > SAME {
            chain.extend(line(from, side.end));
            chain.push(Element::arc(side.end, after.start, corner, turn));
            chain.extend(line(after.start, to));
        } else if from.distance(to) > SAME {
            chain.extend(line(from, corner));
            chain.extend(line(corner, to));
        }
    }
    chain
}

/// Lets the parallels of line `i` and the next one end where they cross, at a corner that points inwards and
/// is not sharp. The part of the chain that is left out there runs around the area swept by both lines: without it,
/// the chain runs around that area once less, and still once.
fn trim(ring: &[Element], sides: &mut [Side], i: usize, distance: f64) {
    let k = (i + 1) % ring.len();
    let (Some(element), Some(next)) = (ring.get(i), ring.get(k)) else { return };
    let (along, then) = (element.tangent(1.0), next.tangent(0.0));
    let lines = element.turn.is_none() && next.turn.is_none();
    if !(lines && along.dot(then) >= 0.0 && along.perp_dot(then) * distance < 0.0) {
        return;
    }
    let Ok(
        [
            Side { curve: OffsetCurve::Parallel(before), end, .. },
            Side { curve: OffsetCurve::Parallel(after), start, .. },
        ],
    ) = sides.get_disjoint_mut([i, k])
    else {
        return;
    };
    // The end of one is also at right angles to the other line, and neither parallel gets reversed.
    let (from, to) = (*end - next.start, *start - next.start);
    let crossing = next.start + (from + to) / (1.0 + along.dot(then));
    if (*start - element.start).dot(along) >= 0.0
        && (next.end - *end).dot(then) >= 0.0
        && (crossing - before.start).dot(along) > 0.0
        && (after.end - crossing).dot(then) > 0.0
    {
        before.end = crossing;
        after.start = crossing;
    }
}

/// The angle by which a ring turns between two elements, radians, positive to the left.
fn turn_at(element: &Element, next: &Element) -> f64 {
    let turn = turn_angle(element.tangent(1.0), next.tangent(0.0));
    // The two run back on each other, as where circles touch: they bend apart, and their curvatures
    // show to which side.
    let apart = element.curvature() + next.curvature();
    if PI - turn.abs() < BACK && apart != 0.0 { -PI.copysign(apart) } else { turn }
}

/// The parallel of an element.
struct Side {
    curve: OffsetCurve,
    /// The points at the distance from the start of the element, and from its end.
    start: Vec2,
    end: Vec2,
}

enum OffsetCurve {
    Parallel(Element),
    /// Through the centre of an arc, which is nearer than the distance: such an arc sweeps its whole
    /// sector.
    Around(Vec2),
}

impl Side {
    fn of(element: &Element, distance: f64) -> Side {
        let curve = match (element.parallel(-distance), element.turn) {
            (Some(parallel), _) => OffsetCurve::Parallel(parallel),
            (None, Some(turn)) => OffsetCurve::Around(turn.center),
            (None, None) => OffsetCurve::Around(element.start),
        };
        let moved = |at: Vec2, along: Vec2| at - along.perp() * distance;
        Side {
            curve,
            start: moved(element.start, element.tangent(0.0)),
            end: moved(element.end, element.tangent(1.0)),
        }
    }
}
