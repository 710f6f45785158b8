//! Regions of few shapes, whose results are known.

use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toolpost_geom::region::{Cap, Fill, Index, Region, RegionError, Ring, strokes};
use toolpost_geom::{Element, Vec2, turn_angle};

/// How far a boundary may be from where it ought to be, mm.
const NEAR: f64 = 0.001;

fn disc(x: f64, y: f64, radius: f64) -> Region {
    Region::disc(Vec2::new(x, y), radius).unwrap()
}

fn square(x: f64, y: f64, side: f64) -> Region {
    let corners = [(x, y), (x + side, y), (x + side, y + side), (x, y + side)].map(Vec2::from);
    Region::inside(&[Ring::polygon(&corners).unwrap()], Fill::NonZero).unwrap()
}

fn elements(region: &Region) -> Vec<Element> {
    region.rings().flat_map(|ring| ring.elements().iter().copied()).collect()
}

fn arcs(region: &Region) -> usize {
    elements(region).iter().filter(|element| element.turn.is_some()).count()
}

fn close(ours: f64, right: f64) {
    assert!((ours - right).abs() < 1e-6 * right.abs().max(1e-3), "{ours} for {right}");
}

/// A piece of the circle of `radius` about the origin.
fn arc(radius: f64, from: f64, sweep: f64) -> Element {
    let at = |angle: f64| Vec2::from_angle(angle) * radius;
    Element::arc(at(from), at(from + sweep), Vec2::ZERO, sweep)
}

#[test]
fn two_discs_that_overlap_share_a_lens() {
    // Two circles of radius 1 through each other's centre: a lens of 2π/3 − √3/2.
    let (a, b) = (disc(0.0, 0.0, 1.0), disc(1.0, 0.0, 1.0));
    let lens = TAU / 3.0 - 3f64.sqrt() / 2.0;
    let union = a.union(&b).unwrap();
    close(union.area(), TAU - lens);
    close(a.intersection(&b).unwrap().area(), lens);
    close(a.difference(&b).unwrap().area(), PI - lens);
    close(a.xor(&b).unwrap().area(), TAU - 2.0 * lens);
    assert_eq!((union.islands().len(), elements(&union).len(), arcs(&union)), (1, 2, 2));
    // They cross at x 0.5, y ±√3/2.
    for element in elements(&union) {
        assert!(
            (element.start - Vec2::new(0.5, 0.75f64.sqrt().copysign(element.start.y))).length()
                < 1e-12
        );
    }
}

#[test]
fn discs_that_touch_stay_two() {
    for angle in [0.0, PI / 4.0, FRAC_PI_2, 0.3] {
        let at = Vec2::from_angle(angle) * 2.0;
        let both = disc(0.0, 0.0, 1.0).union(&disc(at.x, at.y, 1.0)).unwrap();
        close(both.area(), TAU);
        assert_eq!((both.islands().len(), arcs(&both)), (2, 2), "{angle}");
    }
}

#[test]
fn squares_that_touch_in_a_corner_stay_two_and_along_a_side_become_one() {
    let corner = square(0.0, 0.0, 1.0).union(&square(1.0, 1.0, 1.0)).unwrap();
    assert_eq!(corner.islands().len(), 2);
    let side = square(0.0, 0.0, 1.0).union(&square(1.0, 0.0, 1.0)).unwrap();
    assert_eq!((side.islands().len(), elements(&side).len()), (1, 4));
    close(side.area(), 2.0);
}

#[test]
fn a_disc_that_was_cut_is_one_circle_again() {
    let (whole, half) = (disc(3.0, 1.0, 0.7), square(3.0, 0.0, 5.0));
    let (left, right) = (whole.difference(&half).unwrap(), whole.intersection(&half).unwrap());
    assert_eq!((arcs(&left), arcs(&right)), (1, 1));
    let again = left.union(&right).unwrap();
    assert_eq!(elements(&again).len(), 1);
    close(again.area(), whole.area());
}

#[test]
fn an_island_in_a_hole_is_distinguished() {
    let ring = disc(0.0, 0.0, 3.0).difference(&disc(0.0, 0.0, 2.0)).unwrap();
    let both = ring.union(&disc(0.0, 0.0, 1.0)).unwrap();
    let mut areas: Vec<(f64, usize)> =
        both.islands().iter().map(|island| (island.area(), island.holes().len())).collect();
    areas.sort_by(|a, b| a.0.total_cmp(&b.0));
    close(areas[0].0, PI);
    close(areas[1].0, 5.0 * PI);
    assert_eq!((areas[0].1, areas[1].1), (0, 1));
    let at = |x: f64| Vec2::new(x, 0.0);
    let inside = [0.5, 1.5, 2.5, 3.5].map(|x| both.contains(at(x)));
    assert_eq!(inside, [true, false, true, false]);
    close(both.distance(at(1.4)), 0.4);
    close(both.distance(at(5.0)), 2.0);
    assert_eq!(both.extents(), Some((Vec2::splat(-3.0), Vec2::splat(3.0))));
}

#[test]
fn what_a_ring_that_crosses_itself_encloses_is_decided_by_the_fill() {
    // A figure of eight: one triangle to the left, one to the right; each of area 1.
    let eight = [(-1.0, -1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, 1.0)].map(Vec2::from);
    // Twice around the same square.
    let twice = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(Vec2::from).repeat(2);
    let area = |points: &[Vec2], fill| {
        Region::inside(&[Ring::polygon(points).unwrap()], fill).unwrap().area()
    };
    let fills = [Fill::EvenOdd, Fill::NonZero, Fill::Positive];
    assert_eq!(fills.map(|fill| area(&eight, fill)), [2.0, 2.0, 1.0]);
    assert_eq!(fills.map(|fill| area(&twice, fill)), [0.0, 4.0, 4.0]);
}

#[test]
fn a_stroke_covers_what_is_within_half_its_width() {
    let line = Element::line(Vec2::ZERO, Vec2::new(3.0, 4.0));
    close(Region::stroke(&line, 2.0, Cap::Round).unwrap().area(), 10.0 + PI);
    close(Region::stroke(&line, 2.0, Cap::Square).unwrap().area(), 14.0);
    // An arc, thin: its length times the width, and two half discs.
    let thin = Region::stroke(&arc(5.0, 0.3, -2.0), 1.0, Cap::Round).unwrap();
    close(thin.area(), 10.0 + PI / 4.0);
    let ring = Region::stroke(&arc(5.0, 0.0, TAU), 1.0, Cap::Round).unwrap();
    close(ring.area(), 10.0 * PI);
    assert_eq!((arcs(&ring), elements(&ring).len()), (2, 2));
    let dot = Element::line(Vec2::ONE, Vec2::ONE);
    assert_eq!(Region::stroke(&dot, 2.0, Cap::Round), Ok(disc(1.0, 1.0, 1.0)));
}

#[test]
fn a_stroke_along_an_arc_that_is_wider_than_its_pen_by_rounding_is_whole() {
    // A sector of 2 mm, and half a disc of 1 mm at each end.
    for hair in [0.0, 1e-12, 9e-10, 2e-9, 1e-7] {
        let stroke = Region::stroke(&arc(1.0 + hair, 0.4, 1.0), 2.0, Cap::Round).unwrap();
        assert!((stroke.area() - 2.0 - PI).abs() < 1e-5, "{hair}: {}", stroke.area());
    }
}

#[test]
fn a_stroke_along_an_arc_is_right_by_distance_however_wide_and_long() {
    for (sweep, width) in [(1.0, 0.5), (6.0, 0.8), (-6.2, 1.9), (5.0, 2.5), (-1.0, 3.0), (4.0, 2.0)]
    {
        let middle = arc(1.0, 0.4, sweep);
        let stroke = Region::stroke(&middle, width, Cap::Round).unwrap();
        for x in -30..30 {
            for y in -30..30 {
                let point = Vec2::new(f64::from(x), f64::from(y)) * 0.1 + 0.013;
                let away = middle_distance(sweep, point) - width / 2.0;
                if away.abs() > NEAR {
                    assert_eq!(stroke.contains(point), away < 0.0, "{sweep} {width} {point}");
                }
            }
        }
    }
}

/// How far a point is from the arc of radius 1 that starts at 0.4 rad, by hand.
fn middle_distance(sweep: f64, point: Vec2) -> f64 {
    let (from, to) = if sweep > 0.0 { (0.4, 0.4 + sweep) } else { (0.4 + sweep, 0.4) };
    let on = (point.to_angle() - from).rem_euclid(TAU) <= to - from;
    let ends = [from, to].map(|angle| point.distance(Vec2::from_angle(angle)));
    if on { (point.length() - 1.0).abs() } else { ends[0].min(ends[1]) }
}

#[test]
fn a_square_grown_has_round_corners_and_shrunk_sharp_ones() {
    let square = square(1.0, 2.0, 4.0);
    let grown = square.offset(0.5).unwrap();
    close(grown.area(), 16.0 + 4.0 * 4.0 * 0.5 + PI * 0.25);
    assert_eq!((elements(&grown).len(), arcs(&grown)), (8, 4));
    let shrunk = square.offset(-0.5).unwrap();
    close(shrunk.area(), 9.0);
    assert_eq!((elements(&shrunk).len(), arcs(&shrunk)), (4, 0));
    assert!(square.offset(-2.0).unwrap().is_empty());
    assert!(square.offset(-50.0).unwrap().is_empty());
    assert_eq!(square.offset(0.0).unwrap().area(), 16.0);
}

#[test]
fn a_hole_closes_from_all_sides() {
    let plate = square(0.0, 0.0, 10.0).difference(&disc(5.0, 5.0, 1.0)).unwrap();
    let hole = |by: f64| {
        let grown = plate.offset(by).unwrap();
        grown.islands()[0].holes().iter().map(|hole| -hole.area()).sum::<f64>()
    };
    close(hole(0.25), PI * 0.5625);
    assert_eq!(hole(1.0), 0.0);
    assert_eq!(hole(1.5), 0.0);
    close(hole(-0.5), PI * 2.25);
}

#[test]
fn nothing_stays_nothing() {
    let (nothing, something) = (Region::default(), disc(0.0, 0.0, 1.0));
    assert_eq!(nothing.union(&something).unwrap(), something);
    assert!(nothing.intersection(&something).unwrap().is_empty());
    assert!(something.difference(&something).unwrap().is_empty());
    assert!(something.xor(&something).unwrap().is_empty());
    assert!(nothing.offset(1.0).unwrap().is_empty());
    assert!(Region::union_of([]).unwrap().is_empty());
    assert_eq!((nothing.area(), nothing.extents()), (0.0, None));
    assert_eq!(nothing.distance(Vec2::ZERO), f64::INFINITY);
    assert!(!nothing.contains(Vec2::ZERO));
    let index = Index::new(&nothing);
    assert_eq!(index.island_at(Vec2::ZERO), None);
    assert!(index.nearest(Vec2::ZERO, f64::INFINITY).is_none());
    assert_eq!(index.within(Vec2::splat(-1e9), Vec2::splat(1e9)).count(), 0);
}

#[test]
fn what_is_no_shape_is_refused() {
    let far = Vec2::new(1e9, 0.0);
    assert_eq!(Region::disc(far, 1.0), Err(RegionError::NotAPlace(far)));
    assert!(matches!(Region::disc(Vec2::NAN, 1.0), Err(RegionError::NotAPlace(_))));
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
        let refused = Region::disc(Vec2::ZERO, radius);
        assert!(matches!(refused, Err(RegionError::NotALength(_))), "{radius}");
    }
    let line = Element::line(Vec2::ZERO, Vec2::X);
    assert!(Region::stroke(&line, f64::NAN, Cap::Round).is_err());
    assert!(Region::stroke(&Element::line(Vec2::X, Vec2::X), 1.0, Cap::Square).is_err());
    let off = Element::arc(Vec2::X, Vec2::new(0.0, 1.1), Vec2::ZERO, FRAC_PI_2);
    assert!(matches!(
        Region::stroke(&off, 1.0, Cap::Round),
        Err(RegionError::NotAnArc { element: 0, .. })
    ));
    let open = Ring::new(vec![line, Element::line(Vec2::X, Vec2::Y)]);
    assert_eq!(open, Err(RegionError::Gap { element: 1, gap: 1.0 }));
    for sweep in [f64::NAN, f64::INFINITY, 100.0, 2.0 * TAU] {
        let turns = Ring::new(vec![Element::arc(Vec2::X, Vec2::X, Vec2::ZERO, sweep)]);
        assert!(matches!(turns, Err(RegionError::NotAnArc { .. })), "{sweep}");
    }
    let around_itself = Ring::new(vec![Element::arc(Vec2::X, Vec2::X, Vec2::X, TAU)]);
    assert!(matches!(around_itself, Err(RegionError::NotAnArc { .. })));
    assert!(disc(0.0, 0.0, 1.0).offset(f64::NAN).is_err());
    assert!(disc(0.0, 0.0, 1.0).offset(1e9).is_err());
}

#[test]
fn what_encloses_nothing_is_nothing() {
    let (a, b) = (Vec2::ZERO, Vec2::new(5.0, 3.0));
    for points in
        [vec![], vec![a], vec![a, b], vec![a, a, a], vec![a, b, a, b], vec![a, (a + b) / 2.0, b]]
    {
        let ring = Ring::polygon(&points).unwrap();
        assert!(Region::inside(&[ring], Fill::NonZero).unwrap().is_empty(), "{points:?}");
    }
}

#[test]
fn the_largest_and_the_smallest_keep_their_arcs() {
    // 50 m and 5 µm.
    for radius in [5e4, 0.005] {
        let union = disc(0.0, 0.0, radius).union(&disc(radius, 0.0, radius)).unwrap();
        assert_eq!((arcs(&union), elements(&union).len()), (2, 2), "{radius}");
        let lens = radius * radius * (TAU / 3.0 - 3f64.sqrt() / 2.0);
        close(union.area() / (TAU * radius * radius - lens), 1.0);
    }
}

#[test]
fn more_than_fits_into_memory_is_refused() {
    // The chords of a circle of 90 m, a multiple of 8: 2π/√(8·0.0009/90 000) = 22,214.4.
    let large = disc(0.0, 0.0, 9e4);
    let union = |count| Region::union_of(std::iter::repeat_n(&large, count));
    assert_eq!(union(200), Err(RegionError::TooLarge { edges: 200 * 22_216, most: 4_194_304 }));
    // As many as are taken: 2.2 million.
    assert_eq!(union(100).unwrap(), large);
}

/// 3,000 strips along X over 3,000 along Y: 36 million corners, some 10 GB.
#[test]
fn what_crosses_in_too_many_places_is_refused_before_it_takes_the_memory() {
    let strip = |i: u32, across: bool| {
        let (near, far) = (f64::from(i), f64::from(i) + 0.5);
        let corners = [(near, 0.0), (far, 0.0), (far, 3000.0), (near, 3000.0)];
        let turned = |(x, y)| if across { Vec2::new(3000.0 - y, x) } else { Vec2::new(x, y) };
        Ring::polygon(&corners.map(turned)).unwrap()
    };
    let strips = |count: u32| -> Vec<Ring> {
        (0..count).flat_map(|i| [strip(i, false), strip(i, true)]).collect()
    };
    let inside = |count| Region::inside(&strips(count), Fill::Positive);
    assert_eq!(inside(3000), Err(RegionError::TooTangled { most: 1 << 20 }));
    // 100 of each: 10,000 holes, less those that would be at two of the sides.
    assert_eq!(inside(100).unwrap().rings().count(), 1 + 99 * 99);
}

/// A grid of strokes: at each of 14,400 points some 16 lines meet.
#[test]
fn strokes_that_meet_do_not_count_as_crossing() {
    let place = |x: u32, y: u32| Vec2::new(f64::from(x), f64::from(y));
    let network: Vec<_> = (0..120)
        .flat_map(|x| (0..120).map(move |y| (x, y)))
        .flat_map(|(x, y)| {
            let ends = [place(x + 1, y), place(x, y + 1)];
            ends.map(|end| (Element::line(place(x, y), end), 0.2))
        })
        .collect();
    let grid = Region::inside(&strokes(&network).unwrap(), Fill::Positive).unwrap();
    assert_eq!((grid.islands().len(), grid.rings().count()), (1, 1 + 119 * 119));
}

#[test]
fn what_two_readers_make_of_one_corner_leaves_next_to_nothing() {
    // Copper of a board (StickHub), as a plotter and a board file have it: a wide arc and a line, between
    // which one of them has a narrow arc of 1 µm, tangent to both; elsewhere they are 30 nm apart.
    let v = Vec2::new;
    let region = |mut elements: Vec<Element>| {
        let (from, to, corner) =
            (elements[elements.len() - 1].end, elements[0].start, v(151.5, -94.5));
        elements.extend([Element::line(from, corner), Element::line(corner, to)]);
        Region::inside(&[Ring::new(elements).unwrap()], Fill::NonZero).unwrap()
    };
    let line = Element::line(v(152.706356, -93.242092), v(152.15, -92.685736));
    let wide = Element::arc(
        v(153.38001, -94.868437),
        line.start,
        v(151.08001047857445, -94.86843692651406),
        0.7853980124495832,
    );
    let other = Element::arc(
        v(153.37997558273224, -94.86389286354535),
        v(152.70705689703348, -93.24279515158915),
        v(151.0800002971669, -94.86840071745955),
        0.7829921018112681,
    );
    let narrow =
        Element::arc(other.end, line.start, v(152.494224, -93.454224), 0.0033093803813141753);
    let (plotted, drawn) = (region(vec![wide, line]), region(vec![other, narrow, line]));
    let slack = slack(&[&plotted, &drawn]);
    let missing = plotted.difference(&drawn).unwrap();
    assert!(drawn.difference(&plotted).unwrap().area() < 1e-9);
    assert!((plotted.area() - drawn.area() - missing.area()).abs() < slack);
    let turns = elements(&missing).into_iter().filter_map(|element| element.turn);
    assert!(turns.into_iter().all(|turn| turn.sweep.abs() < 0.79));
}

fn shape() -> impl Strategy<Value = Region> {
    let place =
        || (-200..200i32, -200..200i32).prop_map(|(x, y)| Vec2::new(x.into(), y.into()) * 0.025);
    (place(), place(), 1..40u32, 0..4u32).prop_map(|(from, to, size, kind)| {
        let size = f64::from(size) * 0.05;
        match kind {
            0 => Region::disc(from, size).unwrap(),
            1 => Region::stroke(&Element::line(from, to), size, Cap::Round).unwrap(),
            2 => square(from.x, from.y, size),
            _ => {
                let start = from + Vec2::X * size;
                let quarter = Element::arc(start, from + Vec2::Y * size, from, FRAC_PI_2);
                Region::stroke(&quarter, size * 0.7, Cap::Round).unwrap()
            }
        }
    })
}

fn some() -> impl Strategy<Value = Region> {
    proptest::collection::vec(shape(), 1..8).prop_map(|shapes| Region::union_of(&shapes).unwrap())
}

/// What may be lost or won on a boundary of this length, mm².
fn slack(regions: &[&Region]) -> f64 {
    let length = |region: &&Region| region.rings().map(Ring::length).sum::<f64>();
    1e-6 + NEAR * regions.iter().map(length).sum::<f64>()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn areas_add_up(a in some(), b in some()) {
        let (union, common) = (a.union(&b).unwrap(), a.intersection(&b).unwrap());
        let (rest, either) = (a.difference(&b).unwrap(), a.xor(&b).unwrap());
        let slack = slack(&[&a, &b]);
        prop_assert!((a.area() + b.area() - union.area() - common.area()).abs() < slack);
        prop_assert!((rest.area() + common.area() - a.area()).abs() < slack);
        prop_assert!((union.area() - common.area() - either.area()).abs() < slack);
        // What was added and taken away again leaves the rest.
        let back = union.difference(&b).unwrap();
        prop_assert!(back.xor(&rest).unwrap().area() < slack);
    }

    #[test]
    fn a_region_grows_with_the_distance(a in some(), by in 1..40u32) {
        let by = f64::from(by) * 0.02;
        let (less, more) = (a.offset(by / 2.0).unwrap(), a.offset(by).unwrap());
        prop_assert!(a.difference(&less).unwrap().area() < slack(&[&a]));
        prop_assert!(less.difference(&more).unwrap().area() < slack(&[&less]));
        // Grown in two steps is grown in one.
        let steps = less.offset(by / 2.0).unwrap();
        prop_assert!(steps.xor(&more).unwrap().area() < slack(&[&more]));
        // Out and in again closes gaps, and takes nothing away.
        let closed = more.offset(-by).unwrap();
        prop_assert!(a.difference(&closed).unwrap().area() < slack(&[&a]));
        // In and out again rounds corners, and adds nothing.
        let opened = a.offset(-by).unwrap().offset(by).unwrap();
        prop_assert!(opened.difference(&a).unwrap().area() < slack(&[&a]));
    }

    #[test]
    fn the_boundary_of_what_grew_is_as_far_away_as_it_grew(a in some(), by in 1..40u32) {
        let by = f64::from(by) * 0.02;
        let grown = a.offset(by).unwrap();
        for element in elements(&grown) {
            for t in [0.0, 0.3, 0.7] {
                let away = a.distance(element.at(t));
                prop_assert!((away - by).abs() < NEAR, "{element:?} {away} {by}");
            }
        }
    }

    #[test]
    fn an_index_finds_what_looking_at_everything_finds(
        a in some(), points in proptest::collection::vec((-600..600i32, -600..600i32), 20)
    ) {
        let index = Index::new(&a);
        for (x, y) in points {
            // Half of the points are on the grid of the shapes, at the height of corners.
            let point = Vec2::new(x.into(), y.into()) * 0.0125;
            let away = a.rings().map(|ring| ring.distance(point)).fold(f64::INFINITY, f64::min);
            if away > NEAR {
                let inside = a.islands().iter().position(|island| island.contains(point));
                prop_assert_eq!(index.island_at(point), inside);
            }
            let nearest = index.nearest(point, f64::INFINITY).unwrap();
            prop_assert!((nearest.distance - away).abs() < 1e-12);
            let (piece, on) = (nearest.piece, nearest.piece.element.at(nearest.t));
            prop_assert!((on.distance(point) - away).abs() < 1e-9);
            let ring = a.rings().nth(piece.ring).unwrap();
            prop_assert!(ring.elements().contains(piece.element));
            prop_assert!(a.islands()[piece.island].distance(on) < 1e-9);
            prop_assert!(index.nearest(point, away + 1e-9).is_some());
            prop_assert!(index.nearest(point, away - 1e-9).is_none_or(|_| away == 0.0));
            let box_of = |half: f64| index.within(point - half, point + half).count();
            prop_assert!(box_of(away + 1e-9) > 0);
            prop_assert_eq!(box_of(100.0), index.pieces().len());
        }
    }

    #[test]
    fn the_same_again_is_the_same(shapes in proptest::collection::vec(shape(), 1..12)) {
        let once = Region::union_of(&shapes).unwrap();
        prop_assert_eq!(&once, &Region::union_of(&shapes).unwrap());
        prop_assert_eq!(once.offset(0.3).unwrap(), once.offset(0.3).unwrap());
        // A union is its own union, but for a step of the grid all along its boundary.
        let again = Region::union_of([&once]).unwrap();
        let step = 1e-7 * once.rings().map(Ring::length).sum::<f64>();
        let change = (again.area() - once.area()).abs();
        // With that step what leads to a corner may be another line.
        let long = |region: &Region| {
            elements(region).iter().filter(|element| element.length() > NEAR).count()
        };
        let parts = |region: &Region| (region.islands().len(), region.rings().count());
        if parts(&again) == parts(&once) {
            prop_assert!(change < 1e-6 + step);
            prop_assert_eq!(long(&again), long(&once));
        } else {
            // What touches may be joined, and a hole within the tolerance (0.008 by 0.001 mm) may close.
            prop_assert!(change < slack(&[&once]));
            prop_assert!(again.islands().len() <= once.islands().len());
        }
    }
}

/// Strokes on a grid, where many meet, go straight on or back on each other, with dots and arcs.
fn any_network() -> impl Strategy<Value = Vec<(Element, f64)>> {
    let spot = (0..4i32, 0..4i32).prop_map(|(x, y)| Vec2::new(f64::from(x), f64::from(y)));
    let stroke = (spot.clone(), spot, 0..4u32, 0..2u32).prop_map(|(from, to, form, wide)| {
        let width = [0.4, 2.6][wide as usize];
        let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
        let element = match form {
            0 if from != to => Element::arc(from, to, middle, PI),
            // A quarter clockwise.
            1 if from != to => Element::arc(from, to, middle - half.perp(), -FRAC_PI_2),
            _ => Element::line(from, to),
        };
        (element, width)
    });
    proptest::collection::vec(stroke, 1..12)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn a_network_of_strokes_covers_what_its_strokes_cover(network in any_network()) {
        let together = Region::inside(&strokes(&network).unwrap(), Fill::Positive).unwrap();
        let each: Vec<Region> = network
            .iter()
            .map(|(stroke, width)| match stroke.length() > 0.0 {
                true => Region::stroke(stroke, *width, Cap::Round).unwrap(),
                false => Region::disc(stroke.start, width / 2.0).unwrap(),
            })
            .collect();
        let united = Region::union_of(&each).unwrap();
        let apart = together.xor(&united).unwrap().area();
        prop_assert!(apart < slack(&[&together, &united]), "{apart} mm² for {}", united.area());
        prop_assert_eq!(together.islands().len(), united.islands().len());
    }
}

#[test]
fn strokes_that_go_straight_on_need_no_arcs_between_them() {
    let line = |from: f64, to: f64| (Element::line(Vec2::X * from, Vec2::X * to), 1.0);
    let rings = strokes(&[line(0.0, 2.0), line(2.0, 3.0), line(5.0, 3.0)]).unwrap();
    let arcs = rings.iter().flat_map(Ring::elements).filter(|element| element.turn.is_some());
    assert_eq!((rings.len(), arcs.count()), (5, 2), "three rectangles and two half discs");
    assert!(matches!(
        strokes(&[(Element::line(Vec2::X, Vec2::Y), 0.0)]),
        Err(RegionError::NotALength(_))
    ));
}

#[test]
fn between_strokes_that_go_on_nearly_straight_there_is_no_slit() {
    for (skew, angle) in [-1.6, -1.0, -0.6, 0.6, 1.0, 1.6].into_iter().zip((0..).map(f64::from)) {
        // Sides of the line and of the arc are a few steps of the kernel's grid apart at their tips.
        let place = |x: f64, y: f64| Vec2::from_angle(angle).rotate(Vec2::new(x, y));
        let center = place(skew * 1e-6, 0.275);
        let end = center + Vec2::from_angle(1.0).rotate(-center);
        let network = [
            Element::line(place(-1.0, 0.0), Vec2::ZERO),
            Element::arc(Vec2::ZERO, end, center, 1.0),
        ];
        let rings = strokes(&network.map(|stroke| (stroke, 0.3))).unwrap();
        let region = Region::inside(&rings, Fill::Positive).unwrap();
        close(region.area(), 0.3 * 1.275 + PI * 0.0225);
        assert_eq!((region.islands().len(), region.rings().count()), (1, 1), "{skew}");
        let elements = elements(&region);
        for (element, next) in elements.iter().zip(elements.iter().cycle().skip(1)) {
            let turn = turn_angle(element.tangent(1.0), next.tangent(0.0));
            assert!(turn.abs() < 2.0, "{skew}: {element:?} {next:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn a_way_of_strokes_at_any_angle_is_one(
        turns in proptest::collection::vec((-1.0..1.0f64, 0.2..2.0f64), 1..6), bends in 0..2u32
    ) {
        let (mut at, mut angle, mut network) = (Vec2::new(7.1, -3.3), 0.0, Vec::new());
        for (turn, length) in turns {
            angle += turn;
            let along = Vec2::from_angle(angle);
            let center = at + along.perp();
            let stroke = match bends {
                0 => Element::line(at, at + along * length),
                _ => {
                    let end = center + Vec2::from_angle(length).rotate(at - center);
                    angle += length;
                    Element::arc(at, end, center, length)
                }
            };
            at = stroke.end;
            network.push((stroke, 0.31));
        }
        let region = Region::inside(&strokes(&network).unwrap(), Fill::Positive).unwrap();
        prop_assert_eq!(region.islands().len(), 1);
    }
}

#[test]
fn the_number_of_threads_does_not_show() {
    // A grid of discs that overlap, of more chords than are sorted on one thread.
    let discs: Vec<Region> =
        (0..900).map(|i| disc(f64::from(i % 30) * 1.7, f64::from(i / 30) * 1.7, 1.0)).collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Region::union_of(&discs).unwrap().offset(0.3).unwrap())
    };
    let one = on(1);
    assert!([2, 3, 8].into_iter().all(|threads| on(threads) == one));
}
