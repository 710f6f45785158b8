//! The area that round pens cover along their strokes.
//!
//! A covered point has a nearest point on the strokes. Where that is within a line or an arc, the covered point is at
//! right angles to it: in a rectangle, or in a sector of a ring. Where it is an end, the covered point is not in front of
//! any stroke that leaves this end: it is in what remains of a disc. So a network of thousands of strokes needs no whole
//! disc, and mostly no part of one: most of the time of a union goes into the arcs of discs.

use super::kernel::GridPoint;
use super::ring::place;
use super::shape::circle;
use super::{FAR, RegionError, Ring};
use crate::ending::go_on;
use crate::{Element, Turn, Vec2};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// Tips of an arc this near to each other need nothing between them, mm.
const SAME: f64 = 1e-6;

/// The rings, all counter-clockwise, that together enclose what round pens cover on `strokes`, each with the
/// width of its pen, mm; a stroke without length is a dot. Rings overlap: see [`super::Fill::Positive`].
///
/// # Errors
/// Where a value is no number, too large, or a width not above zero; where an arc misses its ends.
pub fn strokes(strokes: &[(Element, f64)]) -> Result<Vec<Ring>, RegionError> {
    let mut rings = Vec::with_capacity(2 * strokes.len());
    let mut ends = Ends::default();
    for (stroke, width) in strokes {
        go_on();
        place(stroke.start)?;
        place(stroke.end)?;
        if !(*width > 0.0 && *width <= FAR) {
            return Err(RegionError::NotALength(*width));
        }
        let radius = width / 2.0;
        if stroke.turn.is_some() {
            // Checks the arc: there and back it is closed.
            Ring::new(vec![*stroke, stroke.reversed()])?;
        }
        match stroke.turn {
            Some(turn) if turn.sweep.abs() >= TAU * (1.0 - 1e-9) => {
                around(&mut rings, stroke, turn, radius)
            }
            _ if stroke.length() <= SAME => ends.add(stroke.start, radius, None),
            turn => {
                sides(&mut rings, stroke, turn, radius);
                ends.add(stroke.start, radius, Some(stroke.tangent(0.0)));
                ends.add(stroke.end, radius, Some(-stroke.tangent(1.0)));
            }
        }
    }
    rings.extend(ends.all.iter().inspect(|_| go_on()).filter_map(End::ring));
    Ok(rings)
}

/// The area at right angles to a line or an arc.
fn sides(rings: &mut Vec<Ring>, stroke: &Element, turn: Option<Turn>, radius: f64) {
    // Counter-clockwise, so that the outer side of an arc is on its right.
    let stroke =
        if turn.is_some_and(|turn| turn.sweep < 0.0) { stroke.reversed() } else { *stroke };
    let Some(right) = stroke.parallel(-radius) else { return };
    let (inside, back) = match (stroke.parallel(radius), turn) {
        (Some(left), _) => (left.end, vec![left.reversed()]),
        (None, Some(turn)) => (turn.center, Vec::new()),
        (None, None) => return,
    };
    // Through the ends of the stroke, as the rings of the ends: sides with the same corners leave no gap.
    let mut elements =
        vec![right, Element::line(right.end, stroke.end), Element::line(stroke.end, inside)];
    elements.extend(back);
    let last = elements.last().map_or(inside, |last| last.end);
    elements.extend([Element::line(last, stroke.start), Element::line(stroke.start, right.start)]);
    rings.push(Ring { elements });
}

/// The area that is covered on a whole turn. The ring runs once around the outside and back around the inside.
fn around(rings: &mut Vec<Ring>, stroke: &Element, turn: Turn, radius: f64) {
    let middle = stroke.start.distance(turn.center);
    let mut elements = circle(turn.center, middle + radius, TAU).elements;
    if middle - radius > SAME {
        let inner = circle(turn.center, middle - radius, TAU).elements;
        let (outside, inside) =
            (turn.center + Vec2::X * (middle + radius), turn.center + Vec2::X * (middle - radius));
        elements.push(Element::line(outside, inside));
        elements.extend(inner.iter().map(Element::reversed));
        elements.push(Element::line(inside, outside));
    }
    rings.push(Ring { elements });
}

/// Where strokes begin, end and meet: once for each point and width.
#[derive(Default)]
struct Ends {
    all: Vec<End>,
    /// Index of the end at a point with a radius.
    known: HashMap<(GridPoint, u64), usize>,
}

/// A point where strokes of one width end.
struct End {
    at: Vec2,
    radius: f64,
    cone: Cone,
}

/// The directions that are not in front of any stroke.
#[derive(Clone, Copy)]
enum Cone {
    /// All: no stroke leaves.
    All,
    /// From the first to the second, unit vectors, counter-clockwise, by up to half a turn.
    Between(Vec2, Vec2),
    /// None.
    Nothing,
}

impl Ends {
    /// A stroke leaves `at` in the direction `ahead`; a dot leaves in none.
    fn add(&mut self, at: Vec2, radius: f64, ahead: Option<Vec2>) {
        let new = self.all.len();
        let index = *self.known.entry((GridPoint::of(at), radius.to_bits())).or_insert(new);
        if index == new {
            self.all.push(End { at, radius, cone: Cone::All });
        }
        if let (Some(end), Some(ahead)) = (self.all.get_mut(index), ahead) {
            end.cone = end.cone.behind(ahead);
        }
    }
}

impl Cone {
    /// What of it is not in front of a stroke in the direction `ahead`.
    fn behind(self, ahead: Vec2) -> Cone {
        let (first, last) = (ahead.perp(), -ahead.perp());
        let (from, to) = match self {
            Cone::All => return Cone::Between(first, last),
            Cone::Between(from, to) => (from, to),
            Cone::Nothing => return Cone::Nothing,
        };
        // A direction nearly at right angles counts as behind: the strokes may go straight on.
        let behind = |direction: Vec2| direction.dot(ahead) <= 1e-12;
        match (behind(from), behind(to)) {
            // Both at the sides of a stroke that goes straight on: half a turn, in front of it or behind it.
            (true, true) if from.dot(to) < -0.5 && from.perp().dot(ahead) > 0.5 => Cone::Nothing,
            (true, true) => Cone::Between(from, to),
            (true, false) => Cone::Between(from, last),
            (false, true) => Cone::Between(first, to),
            (false, false) => Cone::Nothing,
        }
    }
}

impl End {
    fn ring(&self) -> Option<Ring> {
        let (from, to) = match self.cone {
            Cone::All => return Some(circle(self.at, self.radius, TAU)),
            Cone::Between(from, to) => (self.at + from * self.radius, self.at + to * self.radius),
            Cone::Nothing => return None,
        };
        if from.distance(to) <= SAME {
            return None;
        }
        let sweep = crate::turn_angle(from - self.at, to - self.at);
        let sweep = if sweep <= 0.0 { sweep.abs().min(PI) } else { sweep };
        Some(Ring {
            elements: vec![
                Element::line(self.at, from),
                Element::arc(from, to, self.at, sweep),
                Element::line(to, self.at),
            ],
        })
    }
}
