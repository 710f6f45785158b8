//! A region grown or shrunk by a distance: where the centre of a tool of that radius may go.
//!
//! What grows a region is swept by its boundary: beside a line a rectangle, beside an arc a sector of a
//! ring, about a corner that points outwards a pie. All of these run counter-clockwise, and where they
//! share a side, the one runs along it forth and the other back. So their outlines and those of the
//! region add up to one chain: beside each element its parallel, about a corner that points outwards an
//! arc, and at one that points inwards the way by the corner itself. The grown region is what the
//! chain runs around at least once ([`Fill::Positive`]), however often it crosses itself. Shrinking is
//! growing what is outside: the same chain on the other side.
//!
//! Where parallels of lines cross at a corner that points inwards, the chain goes on there, without the way by
//! the corner: the kernel has fewer crossings to look for.

use super::chords::boolean;
use super::kernel::Keep;
use super::{FAR, Fill, Region, RegionError};
use crate::{Element, Vec2, turn_angle};
use std::f64::consts::PI;
use std::iter;

/// Tips of parallels this near to each other need nothing between them, mm.
const SAME: f64 = 1e-6;

/// A turn that is so near to half a turn is one, radians: rounding of places.
const BACK: f64 = 1e-5;

impl Region {
    /// All places up to `distance` mm from this region; where negative, all places in it that are
    /// farther than that from its boundary. Corners become round.
    ///
    /// # Errors
    /// Where the distance is no number or beyond 100 m, and [`RegionError::TooLarge`].
    pub fn offset(&self, distance: f64) -> Result<Region, RegionError> {
        if distance.is_nan() || distance.abs() > FAR {
            return Err(RegionError::NotALength(distance));
        }
        let chains: Vec<_> = self.chains().map(|chain| beside(chain, distance)).collect();
        boolean(chains.iter().map(Vec::as_slice), iter::empty(), Keep::Union, Fill::Positive)
    }
}

/// The chain at `distance` mm on the right of a ring.
fn beside(ring: &[Element], distance: f64) -> Vec<Element> {
    let mut sides: Vec<Side> = ring.iter().map(|element| Side::of(element, distance)).collect();
    for i in 0..ring.len() {
        trim(ring, &mut sides, i, distance);
    }
    let mut chain = Vec::with_capacity(2 * ring.len());
    let nexts = ring.iter().zip(&sides).cycle().skip(1);
    for ((element, side), (next, after)) in ring.iter().zip(&sides).zip(nexts) {
        let corner = next.start;
        let from = match side.way {
            Way::Parallel(parallel) => {
                chain.push(parallel);
                parallel.end
            }
            Way::Around(center) => {
                chain.push(Element::line(element.start, center));
                chain.push(Element::line(center, corner));
                corner
            }
        };
        let to = match after.way {
            Way::Parallel(parallel) => parallel.start,
            Way::Around(_) => corner,
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
/// is not sharp. What of the chain is left out there runs around what lies beside both lines: without it,
/// the chain runs around that once less, and still once.
fn trim(ring: &[Element], sides: &mut [Side], i: usize, distance: f64) {
    let k = (i + 1) % ring.len();
    let (Some(element), Some(next)) = (ring.get(i), ring.get(k)) else { return };
    let (along, then) = (element.tangent(1.0), next.tangent(0.0));
    let lines = element.turn.is_none() && next.turn.is_none();
    if !(lines && along.dot(then) >= 0.0 && along.perp_dot(then) * distance < 0.0) {
        return;
    }
    let Ok(
        [Side { way: Way::Parallel(way), end, .. }, Side { way: Way::Parallel(after), start, .. }],
    ) = sides.get_disjoint_mut([i, k])
    else {
        return;
    };
    // The one's end is beside the other line too, and neither parallel gets turned round.
    let (from, to) = (*end - next.start, *start - next.start);
    let crossing = next.start + (from + to) / (1.0 + along.dot(then));
    if (*start - element.start).dot(along) >= 0.0
        && (next.end - *end).dot(then) >= 0.0
        && (crossing - way.start).dot(along) > 0.0
        && (after.end - crossing).dot(then) > 0.0
    {
        way.end = crossing;
        after.start = crossing;
    }
}

/// The angle by which a ring turns between two elements, radians, positive to the left.
fn turn_at(element: &Element, next: &Element) -> f64 {
    let turn = turn_angle(element.tangent(1.0), next.tangent(0.0));
    // The two run back on each other, as where circles touch: they bend apart, and to which side, their
    // curvatures tell.
    let apart = element.curvature() + next.curvature();
    if PI - turn.abs() < BACK && apart != 0.0 { -PI.copysign(apart) } else { turn }
}

/// What runs beside an element.
struct Side {
    way: Way,
    /// What is beside its start, and its end.
    start: Vec2,
    end: Vec2,
}

enum Way {
    Parallel(Element),
    /// By the centre of an arc, which is nearer than the distance: what such an arc sweeps is its whole
    /// sector.
    Around(Vec2),
}

impl Side {
    fn of(element: &Element, distance: f64) -> Side {
        let way = match (element.parallel(-distance), element.turn) {
            (Some(parallel), _) => Way::Parallel(parallel),
            (None, Some(turn)) => Way::Around(turn.center),
            (None, None) => Way::Around(element.start),
        };
        let beside = |at: Vec2, along: Vec2| at - along.perp() * distance;
        Side {
            way,
            start: beside(element.start, element.tangent(0.0)),
            end: beside(element.end, element.tangent(1.0)),
        }
    }
}
