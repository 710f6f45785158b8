//! Arcs from R and from I J, against hand calculation.

use geom::Vec2;
use std::f64::consts::PI;
use toolpost_wire::Direction::{Clockwise, CounterClockwise};
use toolpost_wire::{ARC_TOLERANCE, Direction, Element};

const P: Vec2 = Vec2::new(10.0, 0.0);
const K: Vec2 = Vec2::new(0.0, 10.0);

fn by_radius(start: Vec2, end: Vec2, radius: f64, direction: Direction) -> Element {
    Element::arc_by_radius(start, end, radius, direction, ARC_TOLERANCE).unwrap()
}

/// A quarter circle from (10, 0) to (0, 10): R = 10 puts the centre at (0, 0) or (10, 10).
#[test]
fn the_signs_of_direction_and_radius_take_the_side_of_the_specification() {
    let cases = [
        (CounterClockwise, 10.0, Vec2::ZERO, PI / 2.0),
        (Clockwise, 10.0, Vec2::new(10.0, 10.0), -PI / 2.0),
        (CounterClockwise, -10.0, Vec2::new(10.0, 10.0), 1.5 * PI),
        (Clockwise, -10.0, Vec2::ZERO, -1.5 * PI),
    ];
    for (direction, radius, center, sweep) in cases {
        let turn = by_radius(P, K, radius, direction).turn.unwrap();
        assert!(turn.center.distance(center) < 1e-12, "{direction:?} R{radius}: {}", turn.center);
        assert!((turn.sweep - sweep).abs() < 1e-12, "{direction:?} R{radius}: {}", turn.sweep);
    }
}

/// The formula of the source, section 2, with the signed differences: zn = +1 for G2 R > 0 and
/// G3 R < 0. With X to the right and Y up, as here, G2 turns clockwise.
#[test]
fn the_centre_is_that_of_the_formula_written_out() {
    let (start, end) = (Vec2::new(3.0, -2.0), Vec2::new(7.5, 4.25));
    for direction in [Clockwise, CounterClockwise] {
        for radius in [5.0f64, -5.0, 40.0, -40.0] {
            let zn = if (direction == Clockwise) == (radius > 0.0) { 1.0 } else { -1.0 };
            let d = start.distance(end);
            let root = (4.0 * radius * radius - d * d).sqrt() / (2.0 * d);
            let expected = Vec2::new(
                (start.x + end.x) / 2.0 - zn * (start.y - end.y) * root,
                (start.y + end.y) / 2.0 + zn * (start.x - end.x) * root,
            );
            let turn = by_radius(start, end, radius, direction).turn.unwrap();
            assert!(turn.center.distance(expected) < 1e-12, "{direction:?} R{radius}");
            assert_eq!(turn.sweep.abs() > PI, radius < 0.0);
        }
    }
}

#[test]
fn a_radius_just_within_the_tolerance_is_a_half_circle_and_just_beyond_is_refused() {
    let end = Vec2::new(-10.0, 0.0);
    let arc = by_radius(P, end, 10.0 - 0.0049, CounterClockwise);
    assert_eq!(arc.turn.unwrap().center, Vec2::ZERO);
    assert!((arc.turn.unwrap().sweep - PI).abs() < 1e-12);
    let refused = Element::arc_by_radius(P, end, 10.0 - 0.0051, Clockwise, ARC_TOLERANCE);
    let refused = refused.unwrap_err();
    assert_eq!(refused.rule, "arc-radius");
    assert!(refused.message.contains("9.9949 mm is shorter than 10.0000 mm"), "{refused}");
}

#[test]
fn a_full_circle_by_radius_is_refused_and_by_its_centre_it_is_whole() {
    let refused = Element::arc_by_radius(P, P, 10.0, Clockwise, ARC_TOLERANCE).unwrap_err();
    assert_eq!(refused.rule, "arc-radius");
    let circle = Element::arc_by_center(P, P, Vec2::ZERO, Clockwise, ARC_TOLERANCE).unwrap();
    assert_eq!(circle.turn.unwrap().sweep, -2.0 * PI);
    assert!((circle.length() - 20.0 * PI).abs() < 1e-12);
}

#[test]
fn ends_on_different_circles_are_refused_beyond_the_tolerance() {
    let to =
        |r: f64| Element::arc_by_center(P, Vec2::new(0.0, r), Vec2::ZERO, Clockwise, ARC_TOLERANCE);
    assert!((to(10.0049).unwrap().turn.unwrap().sweep + 1.5 * PI).abs() < 1e-12);
    let refused = to(10.0051).unwrap_err();
    assert_eq!(refused.rule, "arc-center");
    assert!(refused.message.contains("10.0051") && refused.message.contains("10.0000"));
    let on_center = Element::arc_by_center(P, K, P, Clockwise, ARC_TOLERANCE).unwrap_err();
    assert_eq!(on_center.rule, "arc-center");
}

#[test]
fn what_is_no_number_is_refused() {
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let bad = Vec2::new(bad, 0.0);
        let refused = Element::arc_by_radius(P, bad, 10.0, Clockwise, ARC_TOLERANCE).unwrap_err();
        assert_eq!(refused.rule, "not-a-place");
        assert!(Element::arc_by_center(P, K, bad, Clockwise, ARC_TOLERANCE).is_err());
    }
}
