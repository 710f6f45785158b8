//! Points on contours: the table of the specification, bounds, memory, selection.

use geom::Vec2;
use proptest::prelude::*;
use std::f64::consts::PI;
use toolpost_wire::points::{self, Points, Refusal, Step};
use toolpost_wire::{Accuracy, Contour, Element, Path};

/// The sector of the source: two radii of 40 mm and a quarter circle, from line 10 on.
fn sector() -> Contour {
    let (right, top) = (Vec2::new(40.0, 0.0), Vec2::new(0.0, 40.0));
    let elements = vec![
        Element::line(Vec2::ZERO, right).from_line(10),
        Element::arc(right, top, Vec2::ZERO, PI / 2.0).from_line(20),
        Element::line(top, Vec2::ZERO).from_line(30),
    ];
    Contour::new(elements, 0.0).unwrap()
}

fn points(path: &Path, step: Step, memory: Option<usize>) -> Result<Points, Refusal> {
    points::points(&[path], step, memory).map(|mut all| all.remove(0))
}

fn divided(contour: &Contour, step: Step, memory: Option<usize>) -> Result<Points, Refusal> {
    points(&Path::upright(contour.clone()), step, memory)
}

/// Section 3 of the specification, to its printed digits.
#[test]
fn the_table_of_the_source_is_reproduced() {
    let table = [
        (0.1, 629, "3.125e-5", "7.8e-7"),
        (0.5, 126, "7.812e-4", "1.95e-5"),
        (1.0, 63, "3.125e-3", "7.8e-5"),
    ];
    for (step, count, error, relative) in table {
        let path = Path::upright(sector());
        let points = points(&path, Step::Length(step), None).unwrap();
        let (accuracy, _) = Accuracy::of(&path, &points);
        let arc = accuracy.arcs[0];
        assert_eq!(arc.chords.count, count);
        assert_eq!(points.of_element(1).len(), count);
        assert_eq!(format!("{:.3e}", arc.chords.largest), error);
        let digits = relative.find('e').unwrap() - 2;
        assert_eq!(format!("{:.digits$e}", arc.chords.largest / arc.radius), relative);
        // The last chord is shorter, so the mean is a little smaller.
        assert!(
            arc.chords.mean < arc.chords.largest && arc.chords.mean > 0.98 * arc.chords.largest
        );
    }
}

#[test]
fn the_sector_is_cut_in_21_6_minutes_at_0_11_mm_a_second() {
    let length = Path::upright(sector()).length();
    assert_eq!(format!("{length:.1}"), "142.8");
    assert_eq!(format!("{:.1}", length / 0.11 / 60.0), "21.6");
}

/// n chords of 2π/n in a circle of R leave 1 − sin(2π/n)/(2π/n) of its area uncovered.
#[test]
fn the_area_error_of_a_circle_is_that_of_its_polygon() {
    let p = Vec2::new(10.0, 0.0);
    let circle = Contour::new(vec![Element::arc(p, p, Vec2::ZERO, 2.0 * PI)], 0.0).unwrap();
    assert!(circle.is_closed());
    let path = Path::upright(circle);
    // The chord error of a hexagon of R = 10: 10 − 5√3.
    let points = points(&path, Step::ChordError(10.0 - 75f64.sqrt()), None).unwrap();
    assert_eq!(points.lower.len(), 7);
    let (accuracy, _) = Accuracy::of(&path, &points);
    let hexagon = 1.5 * 3f64.sqrt() * 100.0;
    assert!((accuracy.area_error.unwrap() - (hexagon - 100.0 * PI)).abs() < 1e-9);
    assert!((accuracy.all.largest - (10.0 - 75f64.sqrt())).abs() < 1e-12);
}

#[test]
fn points_and_instructions_find_each_other() {
    let points = divided(&sector(), Step::Length(0.5), None).unwrap();
    assert_eq!(points.lower.len(), 1 + 1 + 126 + 1);
    assert_eq!(points.element_of(0), None);
    assert!(points.of_line(10).eq(std::iter::once(1..2)));
    assert!(points.of_line(20).eq(std::iter::once(2..128)));
    assert!(points.of_line(30).eq(std::iter::once(128..129)));
    assert_eq!(points.of_line(40).count(), 0);
    for point in 1..points.lower.len() {
        let line = points.line_of(point).unwrap();
        assert!(points.of_line(line).any(|range| range.contains(&point)));
    }
    assert_eq!(points.lower[127], Vec2::new(0.0, 40.0));
    assert_eq!(points.lower[128], Vec2::ZERO);
}

#[test]
fn a_step_that_does_not_fit_comes_back_with_the_finest_that_does() {
    let refusal = divided(&sector(), Step::Length(0.1), Some(200)).unwrap_err();
    assert_eq!(refusal.diagnostic.rule.name(), "memory");
    let Some(Step::Length(k)) = refusal.offer else { panic!("{refusal:?}") };
    // 200 points are the start, two ends of lines and 197 on the arc of 20π mm.
    assert!((k - 20.0 * PI / 197.0).abs() < 1e-6, "{k}");
    assert_eq!(divided(&sector(), Step::Length(k), Some(200)).unwrap().lower.len(), 200);
    assert!(divided(&sector(), Step::Length(k * 0.9999), Some(200)).is_err());
}

#[test]
fn fit_takes_the_smallest_chord_error_whose_points_fit() {
    for memory in [4, 5, 10, 1000] {
        let fitted = divided(&sector(), Step::Fit, Some(memory)).unwrap();
        assert_eq!(fitted.lower.len(), memory);
        let Step::ChordError(error) = fitted.step else { panic!() };
        let chords = (memory - 3) as f64;
        let expected = 40.0 * (1.0 - (PI / 4.0 / chords).cos());
        assert!((error - expected).abs() < 1e-9, "{error} {expected}");
    }
    let refused = divided(&sector(), Step::Fit, Some(3)).unwrap_err();
    assert_eq!((refused.diagnostic.rule.name(), refused.offer), ("memory", None));
    assert!(refused.diagnostic.message.contains("4 points"), "{}", refused.diagnostic);
    let refused = divided(&sector(), Step::Fit, None).unwrap_err();
    assert_eq!(refused.diagnostic.rule.name(), "fit-without-memory");
}

#[test]
fn several_paths_share_the_memory() {
    let path = Path::upright(sector());
    let found = points::points(&[&path, &path], Step::Fit, Some(100)).unwrap();
    // Two starts and four ends of lines leave 47 for each arc.
    assert!(found.iter().all(|points| points.lower.len() == 50));
    assert!(points::points(&[&path, &path], Step::Fit, Some(7)).is_err());
}

#[test]
fn a_step_that_is_no_step_is_refused() {
    for bad in [0.0, -0.1, f64::NAN, f64::INFINITY, 143.0] {
        for step in [Step::Length(bad), Step::ChordError(bad)] {
            assert_eq!(divided(&sector(), step, None).unwrap_err().diagnostic.rule.name(), "step");
        }
    }
    let refused = divided(&sector(), Step::Length(1e-300), None).unwrap_err();
    assert_eq!(refused.diagnostic.rule.name(), "memory");
    assert!(refused.offer.is_some());
}

proptest! {
    #[test]
    fn points_lie_on_the_arc_and_the_bound_holds_and_is_reached(
        radius in 0.01f64..500.0, from in -PI..PI, sweep in 0.01f64..6.2, share in 0.001f64..0.5,
        clockwise: bool,
    ) {
        let center = Vec2::new(12.0, -7.0);
        let sweep = if clockwise { -sweep } else { sweep };
        let start = center + Vec2::from_angle(from) * radius;
        let end = center + Vec2::from_angle(from + sweep) * radius;
        let arc = Element::arc(start, end, center, sweep);
        let path = Path::upright(Contour::new(vec![arc], 0.0).unwrap());
        let bound = radius * share * (1.0 - (sweep.abs().min(2.0) / 2.0).cos());
        let found = points(&path, Step::ChordError(bound), None).unwrap();
        prop_assert_eq!(*found.lower.last().unwrap(), end);
        for p in &found.lower {
            prop_assert!((p.distance(center) - radius).abs() < 1e-9 * radius.max(1.0));
        }
        let largest = found.lower.windows(2).map(|p| {
            radius - ((p[0] + p[1]) / 2.0).distance(center)
        }).fold(0.0, f64::max);
        prop_assert!(largest <= bound * (1.0 + 1e-6) + 1e-12);
        // One chord less would break the bound.
        let n = (found.lower.len() - 2) as f64;
        if n >= 1.0 && sweep.abs() / n < 2.0 {
            prop_assert!(radius * (1.0 - (sweep / n / 2.0).cos()) > bound);
        }
    }
}
