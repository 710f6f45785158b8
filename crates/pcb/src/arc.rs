//! Arcs from their ends and an inexact centre, or a third point.

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

/// The arc from `start` through `middle` to `end`, a line where they are in one; equal ends are the circle that
/// has them and `middle` opposite each other.
pub(crate) fn through(start: Vec2, middle: Vec2, end: Vec2) -> Element {
    let (first, chord) = (middle - start, end - start);
    if chord.length() <= SAME {
        return about(start, end, start.midpoint(middle), false);
    }
    let twice = first.perp_dot(chord);
    if twice.abs() <= SAME * chord.length() {
        return Element::line(start, end);
    }
    let to_center = (first * chord.length_squared() - chord * first.length_squared()).perp();
    about(start, end, start + to_center / (2.0 * twice), twice < 0.0)
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn three_points_on_a_circle() {
        let at = |degrees: f64| Vec2::new(3.0, -2.0) + Vec2::from_angle(degrees.to_radians()) * 5.0;
        for (from, over, to) in [(10.0, 50.0, 90.0), (90.0, 50.0, 10.0), (10.0, 200.0, 350.0)] {
            let arc = through(at(from), at(over), at(to));
            let turn = arc.turn.unwrap();
            assert!(turn.center.distance(Vec2::new(3.0, -2.0)) < 1e-12);
            assert!((turn.sweep.to_degrees() - (to - from)).abs() < 1e-9, "{from} {to}");
        }
        let whole = through(Vec2::X, Vec2::NEG_X, Vec2::X).turn.unwrap();
        assert_eq!((whole.center, whole.sweep), (Vec2::ZERO, 2.0 * PI));
        assert_eq!(through(Vec2::ZERO, Vec2::ONE, Vec2::ONE * 3.0).turn, None);
    }
}
