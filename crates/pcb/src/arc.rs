//! Arcs from their ends and an inexact centre.

use crate::SAME;
use geom::{Element, Vec2};
use std::f64::consts::TAU;

/// The arc from `start` to `end` about the point nearest to `center` that is equally far from both; equal
/// ends are a full circle.
pub(crate) fn about(start: Vec2, end: Vec2, center: Vec2, clockwise: bool) -> Element {
    let sign = if clockwise { -1.0 } else { 1.0 };
    let chord = end - start;
    if chord.length() <= SAME {
        return Element::arc(start, end, center, sign * TAU);
    }
    let middle = start.midpoint(end);
    let across = chord.perp().normalize_or_zero();
    let center = middle + across * (center - middle).dot(across);
    Element::arc(start, end, center, sign * turned(start, end, center, clockwise))
}

/// By how much the radii of the two ends differ, mm.
pub(crate) fn deviation(start: Vec2, end: Vec2, center: Vec2) -> f64 {
    (start.distance(center) - end.distance(center)).abs()
}

/// The angle from `start` to `end` in this direction, radians in (0, 2π].
pub(crate) fn turned(start: Vec2, end: Vec2, center: Vec2, clockwise: bool) -> f64 {
    let angle = (start - center).angle_to(end - center);
    let angle = if clockwise { -angle } else { angle };
    if angle <= 0.0 { angle + TAU } else { angle }
}
