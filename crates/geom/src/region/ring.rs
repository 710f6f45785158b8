//! A closed boundary of lines and arcs.

use super::{FAR, RegionError};
use crate::{Element, Transform, Vec2};
use std::f64::consts::TAU;

/// Ends nearer to each other than this meet, mm; the start of the next element counts. An arc may
/// miss its ends by as much.
const MEET: f64 = 1e-3;

/// A closed chain of lines and arcs.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    pub(super) elements: Vec<Element>,
}

impl Ring {
    /// The ring of `elements`, each of which ends where the next one starts, to 1 µm.
    ///
    /// # Errors
    /// Where a coordinate is no number or too far away, an element does not meet the next, or an arc
    /// not its ends.
    pub fn new(elements: Vec<Element>) -> Result<Ring, RegionError> {
        let nexts = elements.iter().cycle().skip(1);
        for (i, (element, next)) in elements.iter().zip(nexts).enumerate() {
            place(element.start)?;
            place(element.end)?;
            let gap = element.end.distance(next.start);
            if gap > MEET {
                return Err(RegionError::Gap { element: i, gap });
            }
            let Some(turn) = element.turn else { continue };
            place(turn.center)?;
            let from = element.start - turn.center;
            let to = turn.center + Vec2::from_angle(turn.sweep).rotate(from);
            let off = to.distance(element.end);
            let turns = turn.sweep.abs() <= TAU * (1.0 + 1e-9) && from.length() > 0.0;
            if !(off <= MEET && turns) {
                return Err(RegionError::NotAnArc { element: i, off });
            }
        }
        Ok(Ring { elements })
    }

    /// The ring through `points`, by straight lines.
    ///
    /// # Errors
    /// Where a coordinate is no number or too far away.
    pub fn polygon(points: &[Vec2]) -> Result<Ring, RegionError> {
        let nexts = points.iter().cycle().skip(1);
        Ring::new(points.iter().zip(nexts).map(|(a, b)| Element::line(*a, *b)).collect())
    }

    /// The same elsewhere, run in the same direction: transformed about the origin, which goes to
    /// `at`.
    pub(super) fn placed(&self, transform: &Transform, at: Vec2) -> Ring {
        let place = |element: &Element| transform.element(element, at);
        let elements = self.elements.iter();
        let elements = match transform.mirrors() {
            true => elements.rev().map(|element| place(&element.reversed())).collect(),
            false => elements.map(place).collect(),
        };
        Ring { elements }
    }

    /// Its lines and arcs, in order.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// What it encloses, mm²: positive where it runs counter-clockwise, negative where clockwise.
    pub fn area(&self) -> f64 {
        let origin = self.elements.first().map_or(Vec2::ZERO, |first| first.start);
        self.elements.iter().map(|element| element.area(origin)).sum()
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.elements.iter().map(Element::length).sum()
    }

    /// The corners of the smallest box around it whose sides are parallel to the axes.
    pub fn extents(&self) -> (Vec2, Vec2) {
        let nothing = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        self.elements
            .iter()
            .map(Element::extents)
            .fold(nothing, |(low, high), (other, second)| (low.min(other), high.max(second)))
    }

    /// Whether it runs around `point`.
    pub fn encloses(&self, point: Vec2) -> bool {
        self.elements.iter().map(|element| winding(element, point)).sum::<i32>() != 0
    }

    /// How far `point` is from the nearest point of the ring, mm.
    pub fn distance(&self, point: Vec2) -> f64 {
        let each = self.elements.iter().map(|element| element.nearest(point).1);
        each.fold(f64::INFINITY, f64::min)
    }
}

/// Refuses what is no number, and what is out of this world.
pub(super) fn place(point: Vec2) -> Result<(), RegionError> {
    let near = point.to_array().iter().all(|value| value.abs() <= FAR);
    if near { Ok(()) } else { Err(RegionError::NotAPlace(point)) }
}

/// How often `element` runs upwards past `point` on its right, less how often downwards. The sum over a
/// closed chain is how often that runs around the point, counter-clockwise.
pub(super) fn winding(element: &Element, point: Vec2) -> i32 {
    let (start, end) = (element.start - point, element.end - point);
    // A point at the height of an end counts as a little above it, and so one on a chord that is level.
    let across = start.perp_dot(end);
    let left = if across == 0.0 { start.x < end.x } else { across > 0.0 };
    let chord = match (start.y <= 0.0, end.y <= 0.0) {
        (true, false) if left => 1,
        (false, true) if !left => -1,
        _ => 0,
    };
    // What an arc and its chord enclose is on the right of the chord for an arc to the left.
    let segment = element.turn.map_or(0, |turn| {
        let radius =
            (element.start.distance(turn.center) + element.end.distance(turn.center)) / 2.0;
        let whole = element.start == element.end;
        let beyond = whole || left != (turn.sweep > 0.0);
        let enclosed = beyond && point.distance(turn.center) < radius;
        i32::from(enclosed) * turn.sweep.signum() as i32
    });
    chord + segment
}
