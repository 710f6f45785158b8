//! Lower and upper contour: which points belong together, wires that cross, limits of the machine.

use geom::Vec2;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use toolpost_wire::points::{Step, points};
use toolpost_wire::{Contour, Direction, Element, Limits, Path};

fn polygon(corners: &[(f64, f64)]) -> Contour {
    let corners: Vec<Vec2> = corners.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
    let next = corners.iter().cycle().skip(1);
    let elements = corners.iter().zip(next).zip(1..);
    let elements = elements.map(|((&p, &q), line)| Element::line(p, q).from_line(line)).collect();
    Contour::new(elements, 0.0).unwrap()
}

fn square(half: f64) -> Contour {
    polygon(&[(half, -half), (half, half), (-half, half), (-half, -half)])
}

fn circle(radius: f64, from: f64) -> Contour {
    let start = Vec2::from_angle(from) * radius;
    Contour::new(vec![Element::arc(start, start, Vec2::ZERO, TAU)], 0.0).unwrap()
}

#[test]
fn by_block_an_arc_and_a_line_get_as_many_points() {
    let lower = vec![Element::line(Vec2::new(10.0, 0.0), Vec2::new(0.0, 10.0))];
    let (start, end) = (Vec2::new(20.0, 0.0), Vec2::new(0.0, 20.0));
    let upper = vec![Element::arc(start, end, Vec2::ZERO, PI / 2.0)];
    let path = Path::by_block(lower, upper).unwrap();
    // 10π mm of arc in steps of π: ten parts on both sides.
    let found = points(&[&path], Step::Length(PI), None).unwrap().remove(0);
    assert_eq!((found.lower.len(), found.upper.len()), (11, 11));
    assert!(found.lower[5].distance(Vec2::new(5.0, 5.0)) < 1e-12);
    assert!(found.upper[5].distance(Vec2::splat(200f64.sqrt())) < 1e-12);
}

#[test]
fn by_block_needs_as_many_moves_below_as_above() {
    let lower = square(10.0).elements().to_vec();
    let upper = lower[..3].to_vec();
    let refused = Path::by_block(lower, upper).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("sync-blocks", 4));
    assert!(refused.message.contains("4 moves and the upper 3"), "{refused}");
}

#[test]
fn one_end_may_stand_still() {
    let tip = Vec2::new(0.0, 0.0);
    let lower = square(10.0).elements().to_vec();
    let upper = lower.iter().map(|_| Element::line(tip, tip)).collect();
    let path = Path::by_block(lower, upper).unwrap();
    let found = points(&[&path], Step::Length(1.0), None).unwrap().remove(0);
    assert_eq!(found.upper, vec![tip; 5]);
}

#[test]
fn by_length_corners_of_both_contours_are_points() {
    // A square of 80 mm and a circle from the same side: each corner at a quarter of the length.
    let lower = polygon(&[(10.0, 0.0), (10.0, 10.0), (-10.0, 10.0), (-10.0, -10.0), (10.0, -10.0)]);
    let path = Path::by_length(&lower, &circle(5.0, 0.0)).unwrap();
    assert_eq!(path.lower().elements().len(), 5);
    for (below, above) in path.elements() {
        let share = below.length() / 80.0;
        assert!((above.turn.unwrap().sweep - TAU * share).abs() < 1e-9);
    }
    let corner = path.upper().unwrap().elements()[0].end;
    assert!(corner.distance(Vec2::splat(12.5f64.sqrt())) < 1e-9, "{corner}");
}

#[test]
fn given_points_are_held_and_between_them_length_counts() {
    let (lower, upper) = (square(10.0), square(20.0));
    let held = (Vec2::new(10.0, 10.0), Vec2::new(20.0, 0.0));
    let path = Path::by_points(&lower, &upper, &[held]).unwrap();
    let segment = path.elements().find(|(p, _)| p.end == held.0).unwrap();
    assert!(segment.1.end.distance(held.1) < 1e-9);
    let off = Path::by_points(&lower, &upper, &[(Vec2::ZERO, held.1)]).unwrap_err();
    assert_eq!(off.rule.name(), "sync-point");
    let later = (Vec2::new(-10.0, 10.0), Vec2::new(-20.0, 20.0));
    assert!(Path::by_points(&lower, &upper, &[held, later]).is_ok());
    let back = Path::by_points(&lower, &upper, &[later, held]).unwrap_err();
    assert_eq!(back.rule.name(), "sync-point");
}

#[test]
fn wires_that_cross_are_refused_with_their_place() {
    let refused = Path::by_length(&circle(10.0, 0.0), &circle(12.0, 0.0).reversed()).unwrap_err();
    assert_eq!(refused.rule.name(), "wires-cross");
    assert!(refused.message.contains("X10.0000 Y0.0000 below and X12.0000"), "{refused}");
    // Up on the right below, to the left above, then to the left and up, then down and to the right:
    // the ends turn against each other, and at the third side they have turned half a turn apart.
    let refused = Path::by_length(&square(10.0), &square(12.0).reversed()).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("wires-cross", 3));
    // A quarter circle below and three quarters of one above: half a turn more.
    let arc =
        |sweep: f64| Element::arc(Vec2::X * 5.0, Vec2::from_angle(sweep) * 5.0, Vec2::ZERO, sweep);
    let close = |sweep| Path::by_block(vec![arc(0.5)], vec![arc(0.5 + sweep)]);
    assert!(close(PI - 0.01).is_ok());
    assert_eq!(close(PI + 0.01).unwrap_err().rule.name(), "wires-cross");
}

#[test]
fn an_open_contour_does_not_go_with_a_closed_one() {
    let open = Contour::new(square(10.0).elements()[..3].to_vec(), 0.0).unwrap();
    assert_eq!(Path::by_length(&open, &square(10.0)).unwrap_err().rule.name(), "sync-closed");
}

#[test]
fn a_lean_beyond_the_machine_is_refused_with_its_place() {
    let path = Path::by_length(&square(10.0), &square(12.0)).unwrap();
    let limits = |uv: f64, degrees: f64| Limits { uv, angle: degrees.to_radians() };
    // 2 mm in X and Y over 20 mm: 8.05°.
    assert!(path.within(&limits(2.0, 8.1), 20.0).is_ok());
    let refused = path.within(&limits(1.99, 30.0), 20.0).unwrap_err();
    assert_eq!((refused.rule.name(), refused.line), ("taper-limit", 1));
    assert!(refused.message.contains("U2.0000 V-2.0000"), "{refused}");
    let refused = path.within(&limits(5.0, 8.0), 20.0).unwrap_err();
    assert!(refused.message.contains("leans by 8.049°"), "{refused}");
    for height in [0.0, -1.0, f64::NAN] {
        assert_eq!(path.within(&limits(5.0, 30.0), height).unwrap_err().rule.name(), "part-height");
    }
}

proptest! {
    #[test]
    fn both_ends_go_forward_and_arrive_together(
        lower in prop::collection::vec(1.0f64..30.0, 3..12),
        upper in prop::collection::vec(1.0f64..30.0, 3..12),
        step in 0.05f64..2.0,
    ) {
        // Star-shaped polygons about the origin, from the same direction.
        let star = |radii: &[f64]| {
            let n = radii.len() as f64;
            let corner = |i: usize, r: f64| Vec2::from_angle(TAU * i as f64 / n) * r;
            let corners: Vec<Vec2> = radii.iter().enumerate().map(|(i, &r)| corner(i, r)).collect();
            let next = corners.iter().cycle().skip(1);
            let lines = corners.iter().zip(next).map(|(&p, &q)| Element::line(p, q)).collect();
            Contour::new(lines, 0.0).unwrap()
        };
        let (lower, upper) = (star(&lower), star(&upper));
        if let Ok(path) = Path::by_length(&lower, &upper) {
            let found = points(&[&path], Step::Length(step), None).unwrap().remove(0);
            prop_assert_eq!(found.lower.len(), found.upper.len());
            let along = |ends: &[Vec2]| ends.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>();
            prop_assert!((along(&found.lower) - lower.length()).abs() < 1e-6);
            prop_assert!((along(&found.upper) - upper.length()).abs() < 1e-6);
            for contour in [&lower, &upper] {
                let ends = if contour == &lower { &found.lower } else { &found.upper };
                for element in contour.elements() {
                    prop_assert!(ends.iter().any(|p| p.distance(element.end) < 1e-4));
                }
            }
        }
    }
}

/// Lower and upper corners fall on the same eighths of the length, but for the rounding of the upper ones
/// to so many mm.
#[test]
fn corners_that_rounding_parts_are_one() {
    let corners = [(0.0, -20.0), (-20.0, -20.0), (-20.0, 20.0), (20.0, 20.0), (20.0, -20.0)];
    for c in [8.485281, 8.4853, 8.485] {
        let ends = [(0.0, -12.0), (-c, -c), (-c, c), (c, c), (c, -c), (0.0, -12.0)];
        let arc = |ends: &[(f64, f64)]| {
            let [start, end] = [ends[0], ends[1]].map(Vec2::from);
            Element::arc_by_radius(start, end, 12.0, Direction::Clockwise, 0.005).unwrap()
        };
        let upper = Contour::new(ends.windows(2).map(arc).collect(), 0.0).unwrap();
        let path = Path::by_length(&polygon(&corners), &upper).unwrap();
        assert_eq!(path.elements().count(), 5, "{c}");
    }
}

/// A corner 1.5 µm after one of the other contour: the end that stands still has no arc there.
#[test]
fn an_end_that_stands_still_goes_no_arc() {
    let arcs = |turn: f64| {
        let at = |angle: f64| Vec2::from_angle(angle) * 10.0;
        let arc = |from: f64, to: f64| Element::arc(at(from), at(to), Vec2::ZERO, to - from);
        Contour::new(vec![arc(0.0, turn), arc(turn, PI)], 0.0).unwrap()
    };
    let path = Path::by_length(&arcs(1.0), &arcs(1.00015)).unwrap();
    for (below, above) in path.elements() {
        for end in [below, above] {
            assert!(end.turn.is_none() || end.length() > 1e-6, "{end:?}");
        }
    }
}
