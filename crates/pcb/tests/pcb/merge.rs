//! Merged paths: fewer elements, the same path.

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
    // More than the tolerance off the line is not on it, nor on one arc.
    let bent = [(0.0, 0.0), (4.0, 0.0041), (10.0, 0.0)];
    assert_eq!(merged(&bent), bent);
    let back = [(0.0, 0.0), (10.0, 0.0), (5.0, 0.0)];
    assert_eq!(merged(&back), back);
    // A bend that comes to much is not straight. What an arc leaves of a parabola y = x² / 100 mm of length l is
    // about c·l³·√3 / 36, where c is a sixth of how fast its curvature changes: 1 µm for 10 mm, 50 µm for 30 mm,
    // of which three arcs make a twenty-seventh.
    let bow = |to: i32| {
        let points = (0..=to * 10).map(|i| f64::from(i) / 10.0).map(|x| (x, x * x / 100.0));
        merged(&points.collect::<Vec<_>>()).len()
    };
    assert_eq!((bow(10), bow(30)), (2, 4));
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

/// Corners of a regular polygon from `from` to `to` of `count` about the origin.
fn corners(count: u32, radius: f64, from: u32, to: u32) -> Vec<(f64, f64)> {
    let corner = |i: u32| Vec2::from_angle(TAU * f64::from(i % count) / f64::from(count)) * radius;
    (from..=to).map(|i| corner(i).into()).collect()
}

#[test]
fn circles_that_were_made_of_sixteen_lines_are_circles() {
    // Their middles are 0.3·(1 - cos 11.25°), 5.8 µm, within the corners: a circle between is off by half of that.
    let circle = lines(&corners(16, 0.3, 0, 16)).merged(0.004).unwrap();
    let [whole] = circle.elements() else { panic!("{circle:?}") };
    let radius = 0.3 * (1.0 + (PI / 16.0).cos()) / 2.0;
    assert!((whole.radius().unwrap() - radius).abs() < 1e-9);
    assert!((whole.turn.unwrap().sweep - TAU).abs() < 1e-9);
    assert!(whole.turn.unwrap().center.length() < 1e-9);
    let back = lines(&corners(16, 0.3, 0, 16)).reversed().merged(0.004).unwrap();
    assert_eq!(back.elements()[0].turn.unwrap().sweep, -TAU);
    // Not where the tolerance is less than that half.
    assert!(lines(&corners(16, 0.3, 0, 16)).merged(0.0028).unwrap().elements().len() > 1);
    // Round a corner between lines it is one arc, and the lines stay.
    let mut round = corners(16, 0.3, 0, 4);
    round.insert(0, (0.3, -2.0));
    round.push((-2.0, 0.3));
    let merged = lines(&round).merged(0.005).unwrap();
    let [first, arc, last] = merged.elements() else { panic!("{merged:?}") };
    assert!(first.turn.is_none() && arc.turn.is_some() && last.turn.is_none());
    // Of a thousand corners too.
    assert_eq!(lines(&corners(1000, 5.0, 0, 1000)).merged(0.004).unwrap().elements().len(), 1);
}

#[test]
fn the_outside_of_a_bent_track_is_a_corner_of_two_lines() {
    // A track of 0.127 mm bent by 45°, grown by 1 µm: the corner is 0.0645·(1 / cos 22.5° - 1), 5.3 µm, from the arc.
    let (radius, sweep) = (0.0645, PI / 4.0);
    let (a, center) = (Vec2::ZERO, Vec2::new(0.0, radius));
    let b = center + Vec2::from_angle(sweep).rotate(a - center);
    let arc = Element::arc(a, b, center, sweep);
    let (from, to) = (Vec2::new(-3.0, 0.0), b + Vec2::from_angle(sweep) * 3.0);
    let path = Path::new(vec![Element::line(from, a), arc, Element::line(b, to)]).unwrap();
    let corner = Vec2::new(radius * (sweep / 2.0).tan(), 0.0);
    let exact = path.merged(0.006).unwrap();
    assert_eq!(exact.elements().len(), 2);
    assert!(exact.elements()[0].end.distance(corner) < 1e-12);
    let near = path.merged(0.004).unwrap();
    assert_eq!(near.elements().len(), 2);
    assert!(near.elements()[0].end.distance(corner) < 0.002);
    assert!(walk_together(&path, &near, 0.0041));
    // Half of the 5.3 µm is the least that two lines can leave.
    assert_eq!(path.merged(0.0025).unwrap(), path);
}

#[test]
fn what_is_as_short_as_can_be_stays_as_it_is() {
    let square = [(1.0, 1.0), (3.0, 1.0), (3.0, 2.0), (1.0, 2.0), (1.0, 1.0)];
    assert_eq!(lines(&square).merged(0.005), Some(lines(&square)));
    // Its corners of 1 µm, left by a tool 2 µm wide, are sharp again, and its sides along the axes; but
    // for where it starts.
    let square = lines(&square);
    let grown = square.elements().iter().flat_map(|side| {
        let side = side.parallel(-0.001).unwrap();
        let turned = Vec2::from_angle(PI / 2.0).rotate((side.end - side.start).normalize() * 0.001);
        let center = side.end + turned;
        let end = center + Vec2::from_angle(PI / 2.0).rotate(side.end - center);
        [side, Element::arc(side.end, end, center, PI / 2.0)]
    });
    let merged = Path::new(grown.collect()).unwrap().merged(0.005).unwrap();
    assert_eq!(merged.elements().len(), 4);
    for side in &merged.elements()[1..3] {
        let along = side.end - side.start;
        assert!(along.x.abs().min(along.y.abs()) < 1e-9, "{side:?}");
    }
    // A spike longer than the tolerance stays, and so does a figure that touches itself.
    let spike = [(0.0, 0.0), (10.0, 0.0), (10.0, 0.05), (10.0, 0.0), (20.0, 0.0)];
    assert_eq!(lines(&spike).merged(0.005), Some(lines(&spike)));
    let touching =
        [(0.0, 0.0), (2.0, 2.0), (4.0, 0.0), (4.0, 4.0), (2.0, 2.0), (0.0, 4.0), (0.0, 0.0)];
    let merged = lines(&touching).merged(0.005).unwrap();
    assert_eq!(merged.elements().len(), 6);
    assert!(merged.is_closed() && merged.length() == lines(&touching).length());
}

#[test]
fn many_tiny_elements_take_their_time_only_once() {
    let start = std::time::Instant::now();
    let spiral = (0..300_000)
        .map(|i| f64::from(i) * 1e-3)
        .map(|turned| <(f64, f64)>::from(Vec2::from_angle(turned) * (1.0 + turned / 10.0)));
    let merged = lines(&spiral.collect::<Vec<_>>()).merged(0.004).unwrap();
    assert!(merged.elements().len() < 3000, "{}", merged.elements().len());
    let noise =
        (0..300_000i32).map(|i| (f64::from(i) * 2e-3, f64::from(i % 101 * 79 % 101) * 1e-4));
    let merged = lines(&noise.collect::<Vec<_>>()).merged(0.004).unwrap();
    assert!(merged.elements().len() < 300_000);
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
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
    // Lines that meet 0.2·(1 / cos 0.05 - 1), 0.25 µm, from the arc are as good; 0.2·(1 / cos 0.35 - 1) is 13 µm,
    // half of which is too much too.
    assert!(radii(&bent(0.2, 0.1).merged(0.004).unwrap()).is_empty());
    for (radius, sweep) in [(0.02, PI), (0.2, 0.7)] {
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

/// Points on a path, so near that chords between them leave it by 0.1 µm at most.
fn chords(path: &Path) -> Vec<Vec2> {
    let mut points = vec![path.start()];
    for element in path.elements() {
        let parts = element.turn.map_or(1.0, |turn| {
            let widest = 2.0 * (1.0 - 1e-4 / element.radius().unwrap().max(1e-3)).acos();
            (turn.sweep.abs() / widest).ceil().max(1.0)
        });
        points.extend((1..=parts as usize).map(|part| element.at(part as f64 / parts)));
    }
    points
}

/// Which part of the line from `a` to `b` is within `reach` of `point`.
fn near(a: Vec2, b: Vec2, point: Vec2, reach: f64) -> Option<(f64, f64)> {
    let (from, along) = (a - point, b - a);
    let (p, q) = (from.dot(along), along.length_squared());
    if q == 0.0 {
        return (from.length() <= reach).then_some((0.0, 1.0));
    }
    let root = p * p - q * (from.length_squared() - reach * reach);
    let (low, high) = ((-p - root.sqrt()) / q, (-p + root.sqrt()) / q);
    (root >= 0.0 && low <= 1.0 && high >= 0.0).then_some((low.max(0.0), high.min(1.0)))
}

/// Whether two points can follow the paths from end to end, never back, and never farther apart than `reach`:
/// what of each cell of the pairs of chords can be come to from the cells before it (Alt and Godau, Computing the
/// Fréchet distance between two polygonal curves, 1995).
fn walk_together(path: &Path, other: &Path, reach: f64) -> bool {
    let (p, q) = (chords(path), chords(other));
    let ends =
        |p: &[Vec2], q: &[Vec2]| (p[0].distance(q[0])).max(p[p.len() - 1].distance(q[q.len() - 1]));
    if ends(&p, &q) > reach {
        return false;
    }
    // Of the chords of `q`, what is come to with the other walker at the start of the row.
    let mut open = true;
    let mut below: Vec<Option<(f64, f64)>> = (1..q.len())
        .map(|j| {
            let free = near(q[j - 1], q[j], p[0], reach).filter(|free| open && free.0 <= 0.0);
            open = free.is_some_and(|free| free.1 >= 1.0);
            free
        })
        .collect();
    let mut first_open = true;
    let mut left = None;
    for i in 1..p.len() {
        let start = near(p[i - 1], p[i], q[0], reach).filter(|free| first_open && free.0 <= 0.0);
        first_open = start.is_some_and(|free| free.1 >= 1.0);
        left = start;
        for j in 1..q.len() {
            let later = |free: Option<(f64, f64)>, same: Option<(f64, f64)>, crosses: bool| {
                let (low, high) = free?;
                let from = if crosses { low } else { low.max(same?.0) };
                (from <= high).then_some((from, high))
            };
            let right = later(near(p[i - 1], p[i], q[j], reach), left, below[j - 1].is_some());
            let above = later(near(q[j - 1], q[j], p[i], reach), below[j - 1], left.is_some());
            (left, below[j - 1]) = (right, above);
        }
    }
    left.is_some_and(|left| left.1 >= 1.0)
}

#[test]
fn the_walkers_of_the_tests_do_not_go_back() {
    let forth = lines(&[(0.0, 0.0), (10.0, 0.0)]);
    let zigzag = lines(&[(0.0, 0.0), (6.0, 0.1), (4.0, 0.1), (10.0, 0.0)]);
    // The one who goes forth waits halfway between the turns.
    let apart = 1.0f64.hypot(0.1);
    assert!(
        walk_together(&zigzag, &forth, apart + 1e-9)
            && walk_together(&forth, &zigzag, apart + 1e-9)
    );
    assert!(!walk_together(&zigzag, &forth, apart - 1e-9));
    assert!(apart > self::apart(&zigzag, &forth));
    let circle = Path::new(vec![arc(0.0, TAU)]).unwrap();
    assert!(
        walk_together(&circle, &circle, 1e-9) && !walk_together(&circle, &circle.reversed(), 1.0)
    );
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
        let begun = path.starting_at(path.nearest(merged.start()));
        prop_assert!(walk_together(&begun, &merged, 0.004 + 3e-4));
        let least = merged.elements().iter().map(Element::length).fold(f64::INFINITY, f64::min);
        prop_assert!(least >= 0.001 - 1e-12, "{least}");
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
