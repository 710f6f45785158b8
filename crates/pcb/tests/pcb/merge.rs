//! Merged ways: fewer elements, the same way.

use crate::data;
use geom::region::Ring;
use geom::{Element, Vec2};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use toolpost_pcb::{Path, board, gerber, joined};

fn lines(points: &[(f64, f64)]) -> Path {
    let points: Vec<Vec2> = points.iter().copied().map(Vec2::from).collect();
    Path::new(points.windows(2).map(|ends| Element::line(ends[0], ends[1])).collect()).unwrap()
}

fn points(path: &Path) -> Vec<(f64, f64)> {
    let ends = path.elements().iter().map(|element| element.end);
    std::iter::once(path.start()).chain(ends).map(<(f64, f64)>::from).collect()
}

fn arc(from: f64, to: f64) -> Element {
    let at = |angle: f64| Vec2::from_angle(angle) * 5.0;
    Element::arc(at(from), at(to), Vec2::ZERO, to - from)
}

#[test]
fn lines_that_go_on_are_one_and_ways_back_are_not() {
    let merged = |points_: &[(f64, f64)]| points(&lines(points_).merged(0.004).unwrap());
    let corner = [(0.0, 0.0), (10.0, 0.0), (10.0, 5.0)];
    assert_eq!(merged(&[(0.0, 0.0), (3.0, 0.0), (4.0, 0.0005), (10.0, 0.0), (10.0, 5.0)]), corner);
    // More than half the tolerance beside the line is not on it, nor on one arc.
    let bent = [(0.0, 0.0), (4.0, 0.0021), (10.0, 0.0)];
    assert_eq!(merged(&bent), bent);
    let back = [(0.0, 0.0), (10.0, 0.0), (5.0, 0.0)];
    assert_eq!(merged(&back), back);
    // A bend that comes to much is not straight; three arcs follow a parabola of 10 mm by 1 mm.
    let bow = (0..=100).map(|i| f64::from(i) / 10.0).map(|x| (x, x * x / 100.0));
    let fewer = merged(&bow.collect::<Vec<_>>());
    assert!((3..6).contains(&fewer.len()), "{}", fewer.len());
    // A spike of less than the tolerance is none.
    let spike = [(0.0, 0.0), (10.0, 0.0), (10.0, 0.0004), (10.0, 0.0), (20.0, 0.0)];
    assert_eq!(merged(&spike), [(0.0, 0.0), (20.0, 0.0)]);
}

#[test]
fn a_square_is_merged_over_its_start() {
    let square = [(5.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0), (5.0, 0.0)];
    let merged = lines(&square).merged(0.004).unwrap();
    assert_eq!((merged.elements().len(), merged.length()), (4, 40.0));
    assert!(merged.is_closed());
}

#[test]
fn arcs_of_one_circle_are_one() {
    let three = Path::new(vec![arc(0.0, 1.0), arc(1.0, 2.0), arc(2.0, 5.0)]).unwrap().merged(0.004);
    let three = three.unwrap();
    let [one] = three.elements() else { panic!("{three:?}") };
    assert!((one.turn.unwrap().sweep - 5.0).abs() < 1e-9);
    let start = arc(1.0, 4.0).start;
    let whole = Path::new(vec![arc(1.0, 4.0), Element { end: start, ..arc(4.0, 1.0 + TAU) }])
        .unwrap()
        .merged(0.004)
        .unwrap();
    assert!(whole.is_closed() && whole.elements().len() == 1);
    assert!((whole.length() - 10.0 * PI).abs() < 1e-9);
    // Chords of 2° leave a circle of 5 mm by 0.76 µm: they are an arc.
    let chord = |i: i32| arc(f64::from(i).to_radians(), f64::from(i + 2).to_radians());
    let chords = (0..90).step_by(2).map(|i| Element::line(chord(i).start, chord(i).end));
    let quarter = Path::new(chords.collect()).unwrap().merged(0.004).unwrap();
    assert_eq!(quarter.elements().len(), 1);
    assert!((quarter.length() - 2.5 * PI).abs() < 0.004);
    // Back on the same circle.
    let back = Path::new(vec![arc(0.0, 2.0), arc(2.0, 1.0)]).unwrap();
    assert_eq!(back.merged(0.004), Some(back));
    // An S of equal arcs.
    let s = vec![
        arc(0.0, 1.0),
        Element::arc(arc(0.0, 1.0).end, Vec2::new(9.0, 9.0), Vec2::new(7.0, 7.0), -1.0),
    ];
    assert_eq!(Path::new(s).unwrap().merged(0.004).unwrap().elements().len(), 2);
}

#[test]
fn what_is_short_is_dropped_and_the_chain_stays_closed() {
    let many: Vec<Vec2> =
        (0..=1000).map(|i| Vec2::from_angle(TAU * f64::from(i % 1000) / 1000.0) * 0.01).collect();
    let chords = many.windows(2).map(|ends| Element::line(ends[0], ends[1])).collect();
    let merged = Path::new(chords).unwrap().merged(0.004).unwrap();
    // Chords of at least 1 µm on a circumference of 63 µm.
    assert!(merged.elements().len() <= 63, "{}", merged.elements().len());
    assert!(merged.is_closed());
    let dot = lines(&[(0.0, 0.0), (1e-4, 0.0), (0.0, 0.0)]);
    assert_eq!(dot.merged(0.004), None);
}

#[test]
fn arcs_that_no_machine_resolves_are_lines() {
    // A line of 5 mm with a half circle of this radius at its end, and a line on.
    let bent = |radius: f64, sweep: f64| {
        let (a, center) = (Vec2::new(5.0, 0.0), Vec2::new(5.0, radius));
        let b = center + Vec2::from_angle(sweep).rotate(a - center);
        let on = b + Vec2::from_angle(sweep) * 5.0;
        let arc = Element::arc(a, b, center, sweep);
        Path::new(vec![Element::line(Vec2::ZERO, a), arc, Element::line(b, on)]).unwrap()
    };
    let radii = |path: &Path| -> Vec<f64> {
        let turned = |e: &Element| e.turn.map(|turn| turn.center.distance(e.start));
        path.elements().iter().filter_map(turned).collect()
    };
    for (radius, sweep) in [(0.0005, PI), (0.001, PI), (0.003, 1.5 * PI), (0.009, PI), (0.2, 0.1)] {
        let path = bent(radius, sweep);
        let merged = path.merged(0.004).unwrap();
        assert!(radii(&merged).iter().all(|radius| *radius >= 0.01), "{radius}: {merged:?}");
        assert!(apart(&merged, &path) <= 0.004 && apart(&path, &merged) <= 0.004, "{radius}");
        assert!(merged.elements().iter().all(|element| element.length() >= 0.001), "{radius}");
    }
    // 0.2·(1 - cos 0.05) is 0.25 µm, as good as a line; 0.2·(1 - cos 0.25) is 6 µm.
    assert!(radii(&bent(0.2, 0.1).merged(0.004).unwrap()).is_empty());
    for (radius, sweep) in [(0.02, PI), (0.2, 0.5)] {
        assert_eq!(radii(&bent(radius, sweep).merged(0.004).unwrap()).len(), 1, "{radius}");
    }
    // Nor are lines made an arc that is as small.
    let around = (0..=8).map(|i| Vec2::from_angle(PI * f64::from(i) / 8.0) * 0.006);
    let around: Vec<(f64, f64)> = around.map(<(f64, f64)>::from).collect();
    assert!(radii(&lines(&around).merged(0.004).unwrap()).is_empty());
}

#[test]
fn near_ends_are_joined_where_that_cuts_nothing_new() {
    // Discs of 1 mm whose middles are 0.6 mm apart: 0.5 - √(0.5² - 0.3²) = 0.1 mm stay between them.
    let both = [lines(&[(0.0, 0.0), (5.0, 0.0)]), lines(&[(5.0, 0.6), (0.0, 0.6)])];
    assert_eq!(joined(&both, 1.0, 0.0999).len(), 2);
    let one = joined(&both, 1.0, 0.1001);
    assert_eq!(points(&one[0]), [(0.0, 0.0), (5.0, 0.0), (5.0, 0.6), (0.0, 0.6)]);
    let on = [lines(&[(0.0, 0.0), (5.0, 0.0)]), lines(&[(5.0, 0.0), (5.0, 6.0)])];
    assert_eq!(points(&joined(&on, 1.0, 0.0)[0]), [(0.0, 0.0), (5.0, 0.0), (5.0, 6.0)]);
}

/// The farthest that a point of `path` is from `other`.
fn apart(path: &Path, other: &Path) -> f64 {
    let samples = path.elements().iter().flat_map(|e| (0..=20).map(|i| e.at(f64::from(i) / 20.0)));
    let away = |point: Vec2| {
        let each = other.elements().iter().map(|element| element.nearest(point).1);
        each.fold(f64::INFINITY, f64::min)
    };
    samples.map(away).fold(0.0, f64::max)
}

/// Chains that often go on in one line or circle, or nearly.
fn any_chain() -> impl Strategy<Value = Vec<Element>> {
    let turn = prop_oneof![Just(0.0), -0.01..0.01, -3.0..3.0];
    let step = (
        turn,
        prop_oneof![0.0001..0.003, 0.05..2.0f64],
        prop_oneof![Just(None), (-3.0..3.0f64).prop_map(Some), Just(Some(1.0))],
    );
    prop::collection::vec(step, 1..40).prop_map(|steps| {
        let (mut at, mut along) = (Vec2::ZERO, Vec2::X);
        let mut elements = Vec::new();
        for (turn, length, bend) in steps {
            along = Vec2::from_angle(turn).rotate(along);
            let element = match bend.filter(|bend| bend.abs() > 0.01) {
                None => Element::line(at, at + along * length),
                Some(bend) => {
                    let sweep = f64::clamp(length * bend, -6.0, 6.0);
                    let center = at + along.perp() / bend;
                    let end = center + Vec2::from_angle(sweep).rotate(at - center);
                    along = Vec2::from_angle(sweep).rotate(along);
                    Element::arc(at, end, center, sweep)
                }
            };
            at = element.end;
            elements.push(element);
        }
        elements
    })
}

proptest! {
    #[test]
    fn no_point_is_farther_than_the_tolerance_and_no_arc_turns_another_way(
        elements in any_chain(),
        closed in any::<bool>(),
    ) {
        let mut elements = elements;
        if closed {
            elements.push(Element::line(elements[elements.len() - 1].end, elements[0].start));
        }
        let path = Path::new(elements).unwrap();
        let Some(merged) = path.merged(0.004) else {
            prop_assert!(path.length() < 0.2);
            return Ok(());
        };
        prop_assert!(merged.elements().len() <= path.elements().len());
        prop_assert_eq!(merged.is_closed(), path.is_closed());
        if !closed {
            prop_assert_eq!((merged.start(), merged.end()), (path.start(), path.end()));
        }
        prop_assert!(apart(&path, &merged) <= 0.004 + 1e-9, "{}", apart(&path, &merged));
        prop_assert!(apart(&merged, &path) <= 0.004 + 1e-9, "{}", apart(&merged, &path));
        let area = |path: &Path| path.elements().iter().map(|e| e.area(path.start())).sum::<f64>();
        prop_assert!((area(&path) - area(&merged)).abs() <= 0.004 * path.length() + 1e-9 || !closed);
        // Each is an arc about its centre.
        for element in merged.elements().iter().filter(|element| element.turn.is_some()) {
            let there = [*element, Element::line(element.end, element.start)];
            prop_assert!(Ring::new(there.to_vec()).is_ok() || element.start == element.end);
        }
    }
}

#[test]
fn the_isolation_of_a_board_stays_in_its_place() {
    let Some(folder) = data::folder() else { return };
    let bytes = data::bytes(&folder.join("kicad/ecc83-pp/ecc83-pp-B_Cu.gbr"));
    let image = gerber::read("back", &bytes).unwrap().image;
    let around = board::covered(&image).unwrap().offset(0.1).unwrap();
    let (mut before, mut after) = (0, 0);
    for path in around.rings().filter_map(Path::around) {
        let merged = path.merged(0.004).unwrap();
        assert!(merged.is_closed() && apart(&merged, &path) <= 0.004);
        before += path.elements().len();
        after += merged.elements().len();
    }
    assert!(after < before, "{after} of {before}");
}
