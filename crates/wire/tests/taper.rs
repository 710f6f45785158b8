//! The upper contour of a leaning wire, by hand.

use geom::Vec2;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use toolpost_wire::taper::{Rounding, lean};
use toolpost_wire::{Contour, Element};

fn p(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

/// A rectangle of 30 × 20 mm with rounded corners, counter-clockwise.
fn rounded(r: f64) -> Contour {
    let corner = |a, b, c| Element::arc(a, b, c, PI / 2.0);
    let elements = vec![
        Element::line(p(r, 0.0), p(30.0 - r, 0.0)),
        corner(p(30.0 - r, 0.0), p(30.0, r), p(30.0 - r, r)),
        Element::line(p(30.0, r), p(30.0, 20.0 - r)),
        corner(p(30.0, 20.0 - r), p(30.0 - r, 20.0), p(30.0 - r, 20.0 - r)),
        Element::line(p(30.0 - r, 20.0), p(r, 20.0)),
        corner(p(r, 20.0), p(0.0, 20.0 - r), p(r, 20.0 - r)),
        Element::line(p(0.0, 20.0 - r), p(0.0, r)),
        corner(p(0.0, r), p(r, 0.0), p(r, r)),
    ];
    let elements = elements.into_iter().zip(1..).map(|(e, line)| e.from_line(line)).collect();
    Contour::new(elements, 0.0).unwrap()
}

fn area(width: f64, height: f64, r: f64) -> f64 {
    width * height - (4.0 - PI) * r * r
}

#[test]
fn conical_corners_grow_and_constant_ones_stay() {
    // 1 mm outwards: to the right of a counter-clockwise contour.
    for (rounding, radius) in [(Rounding::Conical, 4.0), (Rounding::Constant, 3.0)] {
        let upper = lean(&rounded(3.0), -1.0, rounding, None).unwrap();
        assert_eq!(upper.elements().len(), 8);
        let radii = upper.elements().iter().filter_map(|e| e.radius());
        assert!(radii.clone().all(|r| (r - radius).abs() < 1e-12) && radii.count() == 4);
        assert!((upper.area() - area(32.0, 22.0, radius)).abs() < 1e-9);
        assert!(upper.is_closed());
    }
}

#[test]
fn a_corner_radius_that_would_pass_zero_needs_constant_corners() {
    let refused = lean(&rounded(0.8), 1.0, Rounding::Conical, None).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("taper-corner", 2));
    assert!(refused.message.contains("0.8000 mm would become -0.2000 mm"), "{refused}");
    let upper = lean(&rounded(0.8), 1.0, Rounding::Constant, None).unwrap();
    assert!((upper.area() - area(28.0, 18.0, 0.8)).abs() < 1e-9);
    // Exactly zero is the tip of a cone: the upper end stands still there.
    let upper = lean(&rounded(1.0), 1.0, Rounding::Conical, None).unwrap();
    assert_eq!(upper.elements()[1].length(), 0.0);
    assert!((upper.area() - 28.0 * 18.0).abs() < 1e-9);
}

#[test]
fn sharp_corners_stay_sharp() {
    let corners = [p(0.0, 0.0), p(30.0, 0.0), p(30.0, 20.0), p(0.0, 20.0)];
    let next = corners.iter().cycle().skip(1);
    let lines = corners.iter().zip(next).map(|(&p, &q)| Element::line(p, q)).collect();
    let upper = lean(&Contour::new(lines, 0.0).unwrap(), -1.0, Rounding::Conical, None).unwrap();
    assert!(upper.elements()[1].start.distance(p(31.0, -1.0)) < 1e-12);
    assert!((upper.area() - 32.0 * 22.0).abs() < 1e-9);
}

/// A line into an arc at a corner: the circle of 10 + 1 about the origin crosses y = −1 at √120.
#[test]
fn a_line_and_an_arc_meet_where_line_and_circle_cross() {
    let open = Contour::new(
        vec![
            Element::line(p(20.0, 0.0), p(10.0, 0.0)),
            Element::arc(p(10.0, 0.0), p(0.0, -10.0), Vec2::ZERO, -PI / 2.0),
        ],
        0.0,
    );
    let upper = lean(&open.unwrap(), 1.0, Rounding::Conical, None).unwrap();
    let expected = p(120f64.sqrt(), -1.0);
    assert!(upper.elements()[1].start.distance(expected) < 1e-12, "{:?}", upper.elements());
    let expected = (1.0f64 / 11.0).asin() - PI / 2.0;
    assert!((upper.elements()[1].turn.unwrap().sweep - expected).abs() < 1e-12);
}

#[test]
fn a_circle_becomes_a_cone_and_a_side_that_vanishes_is_refused() {
    let start = p(5.0, 0.0);
    let circle = Contour::new(vec![Element::arc(start, start, Vec2::ZERO, TAU)], 0.0).unwrap();
    let upper = lean(&circle, 2.0, Rounding::Constant, None).unwrap();
    assert!((upper.length() - TAU * 3.0).abs() < 1e-12);
    assert_eq!(
        lean(&circle, 5.5, Rounding::Constant, None).unwrap_err().rule.name(),
        "taper-corner"
    );
    // A step 1 mm wide between two outer corners, leaned inwards by 2 mm.
    let narrow = [p(0.0, 0.0), p(10.0, 0.0), p(10.0, 10.0), p(9.0, 11.0), p(0.0, 11.0)];
    let next = narrow.iter().cycle().skip(1);
    let lines: Vec<_> = narrow.iter().zip(next).map(|(&p, &q)| Element::line(p, q)).collect();
    let refused =
        lean(&Contour::new(lines, 0.0).unwrap(), 2.0, Rounding::Conical, None).unwrap_err();
    assert_eq!(refused.rule.name(), "taper-corner");
}

proptest! {
    /// Sides are parallel, arcs concentric, each as far from its partner as the lean.
    #[test]
    fn every_element_is_parallel_to_its_partner(
        radii in prop::collection::vec(10.0f64..20.0, 3..16),
        bulges in prop::collection::vec(-0.2f64..0.2, 16),
        distance in -2.0f64..2.0,
    ) {
        let n = radii.len();
        let corner = |i: usize| Vec2::from_angle(TAU * (i % n) as f64 / n as f64) * radii[i % n];
        let elements = (0..n).map(|i| {
            let (a, b, sweep) = (corner(i), corner(i + 1), 4.0 * bulges[i].atan());
            if sweep.abs() < 0.1 {
                return Element::line(a, b);
            }
            let center = (a + b) / 2.0 + (b - a).perp() / (2.0 * (sweep / 2.0).tan());
            Element::arc(a, b, center, sweep)
        });
        let lower = Contour::new(elements.collect(), 0.0).unwrap();
        let Ok(upper) = lean(&lower, distance, Rounding::Conical, None) else { return Ok(()) };
        prop_assert!(upper.is_closed() && upper.elements().len() == n);
        for (below, above) in lower.elements().iter().zip(upper.elements()) {
            let left = match below.turn {
                None => below.tangent(0.0).perp_dot(above.at(0.3) - below.start),
                Some(turn) => {
                    let inwards = below.start.distance(turn.center)
                        - above.at(0.3).distance(turn.center);
                    inwards * turn.sweep.signum()
                }
            };
            prop_assert!((left - distance).abs() < 1e-6, "{left} {distance}");
        }
    }
}
