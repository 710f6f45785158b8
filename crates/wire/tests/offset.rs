//! The path of the wire's centre: known offsets, distances everywhere, refusals.

use geom::Vec2;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use toolpost_wire::offset::{Corners, offset};
use toolpost_wire::{Contour, Element};

fn polygon(corners: &[Vec2]) -> Contour {
    let next = corners.iter().cycle().skip(1);
    let elements = corners.iter().zip(next).zip(1..);
    let elements = elements.map(|((&p, &q), line)| Element::line(p, q).from_line(line)).collect();
    Contour::new(elements, 0.0).unwrap()
}

fn rectangle(width: f64, height: f64) -> Contour {
    let corner = |x: f64, y: f64| Vec2::new(x, y);
    polygon(&[Vec2::ZERO, corner(width, 0.0), corner(width, height), corner(0.0, height)])
}

/// A slot of two lines and two half circles, counter-clockwise.
fn slot(length: f64, radius: f64) -> Contour {
    let p = |x: f64, y: f64| Vec2::new(x, y);
    let elements = vec![
        Element::line(p(0.0, -radius), p(length, -radius)).from_line(1),
        Element::arc(p(length, -radius), p(length, radius), p(length, 0.0), PI).from_line(2),
        Element::line(p(length, radius), p(0.0, radius)).from_line(3),
        Element::arc(p(0.0, radius), p(0.0, -radius), p(0.0, 0.0), PI).from_line(4),
    ];
    Contour::new(elements, 0.0).unwrap()
}

/// Outside a rectangle: its area, a strip along each side, and a quarter circle at each corner.
#[test]
fn outside_a_rectangle_the_corners_become_arcs() {
    let offset_path = offset(&rectangle(30.0, 20.0), -0.15, Corners::Refuse).unwrap();
    let area = 600.0 + 0.15 * 100.0 + PI * 0.15 * 0.15;
    assert!((offset_path.contour.area() - area).abs() < 1e-9, "{}", offset_path.contour.area());
    assert_eq!(offset_path.contour.elements().len(), 8);
    assert!(offset_path.rounded.is_empty());
    let arcs = offset_path.contour.elements().iter().filter_map(|e| e.turn);
    assert!(arcs.clone().all(|turn| (turn.sweep - PI / 2.0).abs() < 1e-9));
    assert_eq!(arcs.count(), 4);
}

/// In a sharp corner of 90° the wire leaves r(√2 − 1).
#[test]
fn inside_sharp_corners_are_refused_with_their_place_or_become_round() {
    let refused = offset(&rectangle(30.0, 20.0), 0.15, Corners::Refuse).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("inner-corner", 1));
    assert!(refused.message.contains("X0.0000 Y0.0000: 0.0621 mm stay (4 such"), "{refused}");
    let offset_path = offset(&rectangle(30.0, 20.0), 0.15, Corners::Round).unwrap();
    assert!((offset_path.contour.area() - 29.7 * 19.7).abs() < 1e-9);
    let places: Vec<Vec2> = offset_path.rounded.iter().map(|corner| corner.place).collect();
    let corners = rectangle(30.0, 20.0);
    assert_eq!(places, corners.elements().iter().map(|e| e.start).collect::<Vec<_>>());
}

#[test]
fn arcs_stay_arcs_and_keep_their_lines() {
    let offset_path = offset(&slot(10.0, 3.0), 0.5, Corners::Refuse).unwrap();
    let expected = 10.0 * 5.0 + PI * 2.5 * 2.5;
    assert!((offset_path.contour.area() - expected).abs() < 1e-9);
    let mut lines: Vec<u32> = offset_path.contour.elements().iter().map(|e| e.line).collect();
    lines.sort_unstable();
    assert_eq!(lines, [1, 2, 3, 4]);
    let radii = offset_path.contour.elements().iter().filter_map(|e| e.radius());
    assert!(radii.clone().all(|radius| (radius - 2.5).abs() < 1e-9) && radii.count() == 2);
}

#[test]
fn a_full_circle_stays_one_whichever_way_it_goes() {
    let p = Vec2::new(5.0, 0.0);
    for (sweep, expected) in [(TAU, 4.9), (-TAU, 5.1)] {
        let circle = Contour::new(vec![Element::arc(p, p, Vec2::ZERO, sweep)], 0.0).unwrap();
        let offset_path = offset(&circle, 0.1, Corners::Refuse).unwrap();
        let [element] = offset_path.contour.elements() else { panic!("{offset_path:?}") };
        assert!((element.radius().unwrap() - expected).abs() < 1e-9);
        assert!((element.turn.unwrap().sweep - sweep).abs() < 1e-9);
    }
}

/// A rounded inner corner of radius 0.1 and a wire of 0.15: √2·(0.15 − 0.1) less the difference of
/// the radii stays at 45°.
#[test]
fn an_inner_arc_smaller_than_the_wire_is_found_with_its_line() {
    let p = |x: f64, y: f64| Vec2::new(x, y);
    let rounded = |r: f64| {
        Contour::new(
            vec![
                Element::line(p(0.0, 10.0), p(0.0, r)).from_line(1),
                Element::arc(p(0.0, r), p(r, 0.0), p(r, r), PI / 2.0).from_line(2),
                Element::line(p(r, 0.0), p(10.0, 0.0)).from_line(3),
            ],
            0.0,
        )
        .unwrap()
    };
    let refused = offset(&rounded(0.1), 0.15, Corners::Refuse).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("inner-corner", 2));
    let left = 0.05 * 2f64.sqrt() - 0.05;
    assert!(refused.message.contains(&format!("{left:.4} mm stay (1 such")), "{refused}");
    let offset_path = offset(&rounded(0.2), 0.15, Corners::Refuse).unwrap();
    assert_eq!(offset_path.contour.elements().len(), 3);
    assert!(!offset_path.contour.is_closed());
    // On its other side the corner is an outer one.
    let offset_path = offset(&rounded(0.1), -0.15, Corners::Refuse).unwrap();
    assert!((offset_path.contour.elements()[1].radius().unwrap() - 0.25).abs() < 1e-9);
}

#[test]
fn a_wire_without_room_and_a_neck_are_refused() {
    let refused = offset(&rectangle(0.2, 20.0), 0.15, Corners::Round).unwrap_err();
    assert_eq!(refused.rule.name(), "offset-vanishes");
    // Two squares with a neck of 0.2 mm between them.
    let p = |x: f64, y: f64| Vec2::new(x, y);
    let neck = polygon(&[
        p(0.0, 0.0),
        p(10.0, 0.0),
        p(10.0, 4.9),
        p(12.0, 4.9),
        p(12.0, 0.0),
        p(22.0, 0.0),
        p(22.0, 10.0),
        p(12.0, 10.0),
        p(12.0, 5.1),
        p(10.0, 5.1),
        p(10.0, 10.0),
        p(0.0, 10.0),
    ]);
    let refused = offset(&neck, 0.15, Corners::Round).unwrap_err();
    assert_eq!(refused.rule.name(), "offset-divides");
}

#[test]
fn contours_that_cross_or_touch_themselves_are_refused_with_both_lines() {
    let p = |x: f64, y: f64| Vec2::new(x, y);
    let eight = polygon(&[p(0.0, 0.0), p(10.0, 10.0), p(10.0, 0.0), p(0.0, 10.0)]);
    let refused = offset(&eight, 0.1, Corners::Round).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("self-crossing", 1));
    assert!(refused.message.contains("X5.0000 Y5.0000: lines 1 and 3"), "{refused}");
    // A corner that touches a side, and a line that runs back over itself.
    let touching = polygon(&[p(0.0, 0.0), p(10.0, 0.0), p(10.0, 5.0), p(5.0, 0.0), p(0.0, 5.0)]);
    assert_eq!(offset(&touching, 0.1, Corners::Round).unwrap_err().rule.name(), "self-crossing");
    let back = Contour::new(
        vec![Element::line(p(0.0, 0.0), p(10.0, 0.0)), Element::line(p(10.0, 0.0), p(4.0, 0.0))],
        0.0,
    );
    assert_eq!(
        offset(&back.unwrap(), 0.1, Corners::Round).unwrap_err().rule.name(),
        "self-crossing"
    );
    // Tangent neighbours do not: a line into a large arc.
    let far = Vec2::new(0.0, 1000.0);
    let end = far + Vec2::from_angle(-PI / 2.0 + 0.3) * 1000.0;
    let smooth =
        vec![Element::line(p(-50.0, 0.0), p(0.0, 0.0)), Element::arc(p(0.0, 0.0), end, far, 0.3)];
    assert!(Contour::new(smooth, 0.0).unwrap().simple().is_ok());
}

#[test]
fn nan_and_zero_offsets() {
    assert_eq!(
        offset(&slot(1.0, 1.0), f64::NAN, Corners::Round).unwrap_err().rule.name(),
        "not-a-place"
    );
    assert_eq!(offset(&slot(1.0, 1.0), 0.0, Corners::Refuse).unwrap().contour, slot(1.0, 1.0));
    let line = Contour::new(vec![Element::line(Vec2::ZERO, Vec2::X * 10.0)], 0.0).unwrap();
    let offset_path = offset(&line, 0.1, Corners::Refuse).unwrap().contour;
    assert!(
        offset_path.start().distance(Vec2::new(0.0, 0.1)) < 1e-12
            && offset_path.elements().len() == 1
    );
}

proptest! {
    /// Star-shaped contours of lines and arcs: from outside every point of the path is exactly as far
    /// from the contour as the offset, measured point against point.
    #[test]
    fn the_distance_is_the_offset_everywhere(
        radii in prop::collection::vec(8.0f64..20.0, 3..24),
        bulges in prop::collection::vec(-0.3f64..0.3, 24),
        distance in 0.05f64..1.0,
        inside: bool,
    ) {
        let n = radii.len();
        let corner = |i: usize| Vec2::from_angle(TAU * (i % n) as f64 / n as f64) * radii[i % n];
        let elements: Vec<Element> = (0..n).map(|i| {
            let (p, q, sweep) = (corner(i), corner(i + 1), 4.0 * bulges[i].atan());
            if sweep.abs() < 0.05 {
                return Element::line(p, q);
            }
            let center = (p + q) / 2.0 + (q - p).perp() / (2.0 * (sweep / 2.0).tan());
            Element::arc(p, q, center, sweep)
        }).collect();
        let contour = Contour::new(elements, 0.0).unwrap();
        let signed = if inside { distance } else { -distance };
        let Ok(offset_path) = offset(&contour, signed, Corners::Round) else { return Ok(()) };
        for element in offset_path.contour.elements() {
            for i in 0..8 {
                let p = element.at(f64::from(i) / 8.0);
                let found = contour.nearest(p).point.distance(p);
                prop_assert!((found - distance).abs() < 2e-4, "{found} for {distance} at {p}");
            }
        }
        prop_assert_eq!(offset_path.contour.area() < contour.area(), inside);
    }
}
