//! The arcs of routes.

use crate::report::{Outcome, fault};
use crate::{SAME, arc};
use geom::{Element, Vec2};
use program::Rule;

/// How far ends and centre may be off one circle, mm: four steps of the coarsest format, 0.01 mm.
const TOLERANCE: f64 = 0.04;

/// The arc of a radius, which is at most half a circle.
///
/// # Errors
/// `arc`
pub(super) fn by_radius(start: Vec2, end: Vec2, radius: f64, clockwise: bool) -> Outcome<Element> {
    let chord = end - start;
    let half = chord.length() / 2.0;
    if half <= SAME || radius <= 0.0 || half > radius + TOLERANCE {
        let message = format!("a radius of {radius:.4} mm over {:.4} mm", 2.0 * half);
        return Err(fault(Rule::Arc, message, "correct A or the end of the arc"));
    }
    let height = (radius * radius - half * half).max(0.0).sqrt();
    let left = if clockwise { -height } else { height };
    let center = start.midpoint(end) + chord.perp().normalize_or_zero() * left;
    Ok(arc::about(start, end, center, clockwise))
}

/// The arc about a centre, which is given from the start; equal ends are a full circle.
///
/// # Errors
/// `arc`
pub(super) fn by_center(start: Vec2, end: Vec2, offset: Vec2, clockwise: bool) -> Outcome<Element> {
    let center = start + offset;
    if offset.length() <= SAME || arc::deviation(start, end, center) > TOLERANCE {
        let message = format!(
            "the start is {:.4} mm from the centre and the end {:.4} mm",
            offset.length(),
            end.distance(center)
        );
        return Err(fault(Rule::Arc, message, "correct I and J, or the end of the arc"));
    }
    Ok(arc::about(start, end, center, clockwise))
}
