//! The line or arc between two points that follows a run of others.
//!
//! An arc between two points has one freedom, its bulge: the tangent of a quarter of its sweep, 0 for a line. Each
//! point of the run leaves some of it. What is left in common is a guess: whether the element follows is
//! measured on whole lines and arcs, and not on points of them.

use super::walk::Walk;
use super::{GREATEST, LEAST};
use geom::{Element, Turn, Vec2};
use std::f64::consts::{PI, TAU};

/// The most that an arc may sweep which is put in the place of others, but for whole circles.
const MOST: f64 = 1.9 * PI;

/// How often the bulge is improved, at most.
const ROUNDS: usize = 6;

/// A run of pieces that go on from each other; an arc among them turns by π at most.
#[derive(Clone, Copy)]
pub(super) struct Run<'a> {
    pub(super) pieces: &'a [Element],
    /// Points of it, in order.
    pub(super) marks: &'a [Vec2],
}

impl Run<'_> {
    /// The line from `start` to `end`, or else an arc, that follows it within `tolerance` mm, and how far it
    /// is from it at most, mm.
    pub(super) fn fitted(self, start: Vec2, end: Vec2, tolerance: f64) -> Option<(Element, f64)> {
        let (low, high) = self.bulges(start, end, tolerance)?;
        if low <= 0.0 && high >= 0.0 {
            let line = Element::line(start, end);
            if let Some(away) = self.away(&line, tolerance) {
                return Some((line, away));
            }
        }
        let arc = bulged(start, end, low.midpoint(high))?;
        Some((arc, self.away(&arc, tolerance)?))
    }

    /// The arc between the same ends that is nearest to it; a line stays.
    pub(super) fn nearest(self, (mut best, mut away): (Element, f64)) -> Element {
        for _ in 0..ROUNDS {
            if best.turn.is_none() {
                break;
            }
            let bulges = self.bulges(best.start, best.end, away);
            let arc =
                bulges.and_then(|(low, high)| bulged(best.start, best.end, low.midpoint(high)));
            let Some(arc) = arc else { break };
            match self.away(&arc, away) {
                Some(nearer) if nearer < away => (best, away) = (arc, nearer),
                _ => break,
            }
        }
        best
    }

    /// The whole circle that it goes around within `tolerance` mm, begun near its start.
    pub(super) fn circle(self, tolerance: f64) -> Option<Element> {
        let start = self.pieces.first()?.start;
        let count = self.marks.len() as f64;
        let mean = self.marks.iter().sum::<Vec2>() / count;
        // Least squares of what the squares of the distances differ by (Kåsa).
        let (mut xx, mut xy, mut yy, mut out) = (0.0, 0.0, 0.0, Vec2::ZERO);
        for from in self.marks.iter().map(|mark| *mark - mean) {
            xx += from.x * from.x;
            xy += from.x * from.y;
            yy += from.y * from.y;
            out += from * (from.length_squared() / 2.0);
        }
        let solved = Vec2::new(out.x * yy - out.y * xy, out.y * xx - out.x * xy);
        let center = mean + solved / (xx * yy - xy * xy);
        let distances = self.marks.iter().map(|mark| mark.distance(center));
        let (least, most) = distances.fold((f64::INFINITY, 0.0), |(least, most), distance| {
            (f64::min(least, distance), f64::max(most, distance))
        });
        let radius = least.midpoint(most);
        if !(LEAST..GREATEST).contains(&radius) {
            return None;
        }
        let area: f64 = self.pieces.iter().map(|piece| piece.area(center)).sum();
        let start = center + (start - center).normalize_or_zero() * radius;
        let circle = Element::arc(start, start, center, TAU.copysign(area));
        self.away(&circle, tolerance).map(|_| circle)
    }

    /// The least and the greatest bulge of arcs from `start` to `end` that pass its marks within `tolerance` mm.
    /// Where all are as good, that is 0.
    pub(super) fn bulges(self, start: Vec2, end: Vec2, tolerance: f64) -> Option<(f64, f64)> {
        let half = start.distance(end) / 2.0;
        let (middle, along) = (start.midpoint(end), (end - start) / (2.0 * half));
        let squared = tolerance * tolerance;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for mark in self.marks {
            let from = *mark - middle;
            let right = from.perp_dot(along);
            // Points of the circle with the ends for a diameter have 0, those within less.
            let beyond = (from.length_squared() - half * half - squared) / half;
            let root = beyond * beyond + 4.0 * (right * right - squared);
            // What is near to an end is near to all of them.
            if root < 0.0 || mark.distance_squared(start).min(mark.distance_squared(end)) < squared
            {
                continue;
            }
            let scale = 2.0 / (root.sqrt() - beyond);
            low = low.max((right - tolerance) * scale);
            high = high.min((right + tolerance) * scale);
            if low > high {
                return None;
            }
        }
        match (low.is_finite(), high.is_finite()) {
            (true, true) => Some((low, high)),
            _ => Some((0.0, 0.0)),
        }
    }

    /// How far `element` and the run are from each other where both are followed from end to end without
    /// turning back, mm; `None` where that is more than `tolerance`.
    fn away(self, element: &Element, tolerance: f64) -> Option<f64> {
        let mut walk = Walk::along(element, tolerance);
        walk.pass(self.pieces.first()?.start)?;
        let begins = walk.may_begin();
        for piece in self.pieces {
            for point in walk.extremes(piece).into_iter().flatten() {
                walk.pass(point)?;
            }
            walk.pass(piece.end)?;
        }
        (begins && walk.may_end()).then_some(walk.away)
    }
}

/// The arc between two points with a bulge; `None` where no machine makes it well.
fn bulged(start: Vec2, end: Vec2, bulge: f64) -> Option<Element> {
    let arc = between(start, end, bulge);
    let sweep = arc.turn?.sweep.abs();
    let is_made = (LEAST..GREATEST).contains(&arc.radius()?) && sweep < MOST;
    is_made.then_some(arc)
}

fn between(start: Vec2, end: Vec2, bulge: f64) -> Element {
    let center = (end - start).perp() * ((1.0 - bulge * bulge) / (4.0 * bulge));
    Element::arc(start, end, start.midpoint(end) + center, 4.0 * bulge.atan())
}

/// The element from a start that is near to its own; but for a whole circle, which stays.
pub(super) fn started(element: &Element, start: Vec2) -> Element {
    match element.turn {
        None => Element::line(start, element.end),
        Some(Turn { sweep, .. }) if sweep.abs() < MOST => {
            between(start, element.end, (sweep / 4.0).tan())
        }
        Some(_) => *element,
    }
}
