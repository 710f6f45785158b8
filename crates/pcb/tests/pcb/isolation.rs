//! The paths around copper, compared with hand calculation and with the distances of points to the copper.

use crate::data;
use geom::region::{Cap, Fill, Index, Region, Ring};
use geom::{Element, Vec2};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{FRAC_PI_4, PI, TAU};
use toolpost_pcb::board::covered;
use toolpost_pcb::isolation::{
    BITE_OFF, Direction, Fate, Isolated, Isolation, MOST_BITE, Narrow, NarrowGap, severed,
};
use toolpost_pcb::{Copper, Cutter, Path, gerber};

/// A cut 0.2 mm wide.
const ISOLATION: Isolation = Isolation {
    cutter: Cutter::Cylinder { diameter: 0.2 },
    depth: 0.05,
    passes: 1,
    overlap: 0.0,
    direction: Direction::Climb,
    narrow: Narrow::LeaveOut,
};

/// Copper of unnamed islands.
fn copper(shapes: &[Region]) -> Copper {
    let region = Region::union_of(shapes).unwrap();
    Copper { nets: vec![None; region.islands().len()], region }
}

fn disc(x: f64, y: f64, radius: f64) -> Region {
    Region::disc(Vec2::new(x, y), radius).unwrap()
}

#[test]
fn around_a_pad_passes_are_circles_each_farther_out() {
    let two = Isolation { passes: 2, overlap: 0.25, ..ISOLATION };
    let paths = two.isolate(&copper(&[disc(3.0, 4.0, 1.0)]), None).unwrap().paths;
    // 0.1 mm from the copper, and three quarters of 0.2 mm farther.
    for (path, radius) in paths.iter().zip([1.1, 1.25]) {
        assert!(path.is_closed());
        assert!((path.length() - TAU * radius).abs() < 1e-6, "{}", path.length());
    }
    assert_eq!(paths.len(), 2);
}

#[test]
fn climbing_has_the_copper_on_its_right() {
    let ring = disc(0.0, 0.0, 3.0).difference(&disc(0.0, 0.0, 2.0)).unwrap();
    for (direction, side) in [(Direction::Climb, -1.0), (Direction::Conventional, 1.0)] {
        let paths = Isolation { direction, ..ISOLATION }
            .isolate(&copper(std::slice::from_ref(&ring)), None)
            .unwrap()
            .paths;
        assert_eq!(paths.len(), 2);
        for path in paths {
            let element = path.elements()[0];
            let outside = element.start.length() > 2.5;
            let inwards = if outside { -element.start } else { element.start };
            assert!(element.tangent(0.0).perp().dot(inwards) * side > 0.0, "{direction:?}");
        }
    }
}

#[test]
fn a_way_ends_where_the_board_ends() {
    let area = disc(0.0, 0.0, 2.0);
    let paths = ISOLATION.isolate(&copper(&[disc(2.0, 0.0, 0.9)]), Some(&area)).unwrap().paths;
    let [path] = &*paths else { panic!("{paths:?}") };
    assert!(!path.is_closed());
    // Circles of radius 2 and 1, 2 apart: the part within is 2·acos(1/4) of the smaller.
    assert!((path.length() - 2.0 * 0.25f64.acos()).abs() < 1e-6);
    assert!((path.start().length() - 2.0).abs() < 1e-6 && (path.end().length() - 2.0).abs() < 1e-6);
    let inside = ISOLATION.isolate(&copper(&[disc(0.0, 0.0, 0.9)]), Some(&area)).unwrap().paths;
    assert!(inside[0].is_closed() && (inside[0].length() - 2.0 * PI).abs() < 1e-6);
}

fn track(from: (f64, f64), to: (f64, f64), width: f64) -> Region {
    Region::stroke(&Element::line(from.into(), to.into()), width, Cap::Round).unwrap()
}

#[track_caller]
fn near(ours: f64, right: f64, tolerance: f64) {
    assert!((ours - right).abs() < tolerance, "{ours} for {right}");
}

/// The gaps that are too narrow for a cut of `width`.
fn narrow(copper: &Copper, width: f64) -> Vec<NarrowGap> {
    let cutter = Cutter::Cylinder { diameter: width };
    Isolation { cutter, ..ISOLATION }.isolate(copper, None).unwrap().narrow
}

#[test]
fn two_pads_too_near_are_one_gap() {
    // A gap of 0.1 mm. It is narrower than 0.2 mm as far as places in its middle are nearer to the pads
    // than 0.1 mm less half of what fits: on circles of 1.099 mm.
    let pads = copper(&[disc(0.0, 0.0, 1.0), disc(2.1, 0.0, 1.0)]);
    let [gap] = &*narrow(&pads, 0.2) else { panic!() };
    assert!(gap.at.distance(Vec2::new(1.05, 0.0)) < 1e-6, "{}", gap.at);
    near(gap.width, 0.1, 1e-6);
    near(gap.widest_cut(), 0.098, 1e-6);
    near(gap.thinned(0.2), 0.05, 1e-6);
    near(gap.length, 2.0 * (1.099f64.powi(2) - 1.05f64.powi(2)).sqrt(), 1e-3);
    assert_eq!(gap.islands, [0, 1]);
    // All of it is straight.
    assert_eq!(gap.middle.as_ref().unwrap().elements().len(), 1);
    assert!(narrow(&pads, 0.1).is_empty());
}

#[test]
fn two_tracks_side_by_side_are_one_gap() {
    for turned in [0.0, FRAC_PI_4, 1.0] {
        let at = |x: f64, y: f64| Vec2::from_angle(turned).rotate(Vec2::new(x, y)).into();
        let tracks = [0.0, 0.4].map(|y| track(at(0.0, y), at(10.0, y), 0.3));
        let [gap] = &*narrow(&copper(&tracks), 0.2) else { panic!("{turned}") };
        near(gap.width, 0.1, 1e-6);
        near(gap.length, 10.0 + 2.0 * (0.249f64.powi(2) - 0.04).sqrt(), 2e-3);
        // Apart by just as much as the cut is wide: one path between them, and no finding.
        let fits = [0.0, 0.5].map(|y| track(at(0.0, y), at(10.0, y), 0.3));
        let Isolated { paths, narrow, .. } = ISOLATION.isolate(&copper(&fits), None).unwrap();
        assert!(narrow.is_empty(), "{narrow:?}");
        let between: Vec<f64> =
            paths.iter().filter(|path| !path.is_closed()).map(Path::length).collect();
        assert_eq!(between.len(), 1);
        near(between[0], 10.0, 0.1);
    }
}

#[test]
fn tracks_of_one_net_are_not_to_be_isolated_from_each_other() {
    let tracks = [0.0, 0.4].map(|y| track((0.0, y), (10.0, y), 0.3));
    let mut named = copper(&tracks);
    named.nets = ["GND", "GND"].map(|net| Some(net.into())).to_vec();
    assert!(narrow(&named, 0.2).is_empty());
    named.nets = vec![Some("GND".into()), Some("VCC".into())];
    assert_eq!(narrow(&named, 0.2).len(), 1);
    named.nets = vec![Some("GND".into()), None];
    assert_eq!(narrow(&named, 0.2).len(), 1);
}

#[test]
fn around_a_pad_in_a_ring_the_gap_is_closed() {
    let ring = disc(3.0, 3.0, 2.0).difference(&disc(3.0, 3.0, 1.0)).unwrap();
    let [gap] = &*narrow(&copper(&[ring, disc(3.0, 3.0, 0.9)]), 0.2) else { panic!() };
    let middle = gap.middle.as_ref().unwrap();
    assert!(middle.is_closed());
    near(middle.length(), TAU * 0.95, 0.01);
    for element in middle.elements() {
        near(element.at(0.5).distance(Vec2::splat(3.0)), 0.95, 0.005);
    }
}

#[test]
fn between_three_pads_three_gaps_meet_and_between_four_four() {
    for count in [3, 4, 5, 6] {
        // Pads of 1 mm around the origin, 0.1 mm from each other.
        let radius = 0.55 / (PI / f64::from(count)).sin();
        let at = |i: i32| Vec2::from_angle(TAU * f64::from(i) / f64::from(count)) * radius;
        let pads: Vec<Region> = (0..count).map(|i| disc(at(i).x, at(i).y, 0.5)).collect();
        // Wide enough for the place in the middle of all.
        let gaps = narrow(&copper(&pads), 2.0 * (radius - 0.5) + 0.2);
        assert_eq!(gaps.len(), count as usize);
        for gap in gaps {
            near(gap.width, 0.1, 1e-6);
            let middle = gap.middle.unwrap();
            let inner = middle.start().length().min(middle.end().length());
            near(inner, 0.0, 1e-4);
        }
    }
}

#[test]
fn pads_that_touch_have_a_gap_of_nothing() {
    let [gap] = &*narrow(&copper(&[disc(0.0, 0.0, 1.0), disc(2.0, 0.0, 1.0)]), 0.2) else {
        panic!()
    };
    near(gap.width, 0.0, 1e-5);
    assert!(gap.at.distance(Vec2::X) < 1e-5);
    assert_eq!((gap.length, gap.middle.is_none(), gap.widest_cut()), (0.0, true, 0.0));
    assert_eq!(gap.fate, Fate::Joined);
}

#[test]
fn ways_across_a_track_sever_it_and_one_along_it_leaves_nothing() {
    let tracks = [0.0, 1.0, 2.0].map(|y| track((0.0, y), (10.0, y), 0.3));
    let copper = copper(&tracks);
    let line = |from: (f64, f64), to: (f64, f64)| {
        Path::new(vec![Element::line(from.into(), to.into())]).unwrap()
    };
    // Twice across the lowest, at 3 and 9 mm, along the middle one, and next to the uppermost.
    let paths = [
        line((3.0, -0.5), (3.0, 0.5)),
        line((9.0, -0.5), (9.0, 0.5)),
        line((-1.0, 1.0), (11.0, 1.0)),
        line((-1.0, 2.2), (11.0, 2.2)),
    ];
    let mut pieces: Vec<(f64, usize, Vec2)> = severed(&copper, &paths, 0.4)
        .unwrap()
        .iter()
        .map(|one| (copper.region.islands()[one.island].outer().extents().0.y, one.pieces, one.at))
        .collect();
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [lowest, middle] = &pieces[..] else { panic!("{pieces:?}") };
    assert_eq!((lowest.1, middle.1), (3, 0));
    // The smallest piece is the last.
    assert!(lowest.2.x > 9.0 && (middle.2.y - 1.0).abs() <= 0.15, "{pieces:?}");
    assert_eq!(severed(&copper, &[], 0.4).unwrap(), []);
}

/// What becomes of copper with a cut of `width`.
fn isolated(copper: &Copper, width: f64, narrow: Narrow) -> Isolated {
    let cutter = Cutter::Cylinder { diameter: width };
    Isolation { cutter, narrow, ..ISOLATION }.isolate(copper, None).unwrap()
}

/// Two tracks of 10 mm, one `wide` and one 1 mm wide, with a gap of 0.2 mm.
fn pair(wide: f64) -> Copper {
    copper(&[
        track((0.0, 0.0), (10.0, 0.0), wide),
        track((0.0, wide / 2.0 + 0.7), (10.0, wide / 2.0 + 0.7), 1.0),
    ])
}

#[test]
fn a_bite_takes_no_more_than_is_said_and_no_more_than_a_tenth_of_the_copper() {
    // A cut of 0.25 mm takes 0.025 mm: a tenth of 0.25 mm.
    for (wide, width, fate) in [
        (0.3, 0.25, Fate::Cut),
        (0.26, 0.25, Fate::Cut),
        (0.24, 0.25, Fate::Joined),
        // 0.03 mm and a little less, and more.
        (1.0, 0.259, Fate::Cut),
        (1.0, 0.262, Fate::Joined),
    ] {
        let Isolated { narrow, paths, severed, .. } = isolated(&pair(wide), width, Narrow::Bite);
        let fates: Vec<Fate> = narrow.iter().map(|gap| gap.fate).collect();
        let length: f64 = narrow.iter().filter(|gap| gap.fate == fate).map(|gap| gap.length).sum();
        // The ends are round: there the gap grows, and a little of it may be cut in any case.
        assert!(
            fates.contains(&fate) && (9.9..10.6).contains(&length),
            "{wide} {width}: {narrow:?}"
        );
        let along = paths.iter().filter(|path| !path.is_closed()).map(Path::length).sum::<f64>();
        assert_eq!(along > 9.9, fate == Fate::Cut, "{wide} {width}: {along}");
        assert_eq!(severed, []);
    }
}

#[test]
fn a_gap_that_grows_narrower_is_cut_as_far_as_it_may_be() {
    // Between a track and one that leans, 0.2 mm apart at 0 and 0.1 mm at 10.
    let lean = Element::line(Vec2::new(0.0, 1.2), Vec2::new(10.0, 1.1));
    let copper = copper(&[
        track((0.0, 0.0), (10.0, 0.0), 1.0),
        Region::stroke(&lean, 1.0, Cap::Round).unwrap(),
    ]);
    let gaps = isolated(&copper, 0.2, Narrow::Bite).narrow;
    let length = |fate: Fate| -> f64 {
        gaps.iter().filter(|gap| gap.fate == fate).map(|gap| gap.length).sum()
    };
    // From 0.198 mm, where it is too narrow, to 0.14 mm.
    near(length(Fate::Cut), 5.8, 0.1);
    near(length(Fate::Joined), 4.3, 0.4);
}

#[test]
fn a_gap_that_is_shorter_than_the_cut_is_wide_is_parted_from_its_ends() {
    // Pads of 0.2 mm radius, 0.18 mm apart: the tool is in the middle 0.2 mm above and below of it and less.
    let pads = |gap: f64| copper(&[disc(0.0, 0.0, 0.2), disc(0.4 + gap, 0.0, 0.2)]);
    for (gap, fate) in [(0.19, Fate::Parted), (0.1, Fate::Joined)] {
        // The middle of the tool stays 0.3 mm from the middles of the pads.
        let end = (0.09f64 - (0.2 + gap / 2.0) * (0.2 + gap / 2.0)).sqrt();
        assert_eq!(end < 0.094, fate == Fate::Parted, "{end}");
        let [one] = &isolated(&pads(gap), 0.2, Narrow::LeaveOut).narrow[..] else { panic!() };
        assert_eq!(one.fate, fate, "{gap}");
    }
}

#[test]
fn a_slot_within_a_conductor_is_found_and_a_corner_is_none() {
    let plane = |width: f64| {
        let slot = track((2.0, 0.0), (8.0, 0.0), width);
        let plane = track((0.0, 0.0), (10.0, 0.0), 6.0).difference(&slot).unwrap();
        // With a right angle.
        copper(&[plane.union(&track((0.0, 0.0), (0.0, 9.0), 1.0)).unwrap()])
    };
    let Isolated { slots, unreached, narrow, .. } = isolated(&plane(0.15), 0.2, Narrow::Bite);
    let [slot] = &slots[..] else { panic!("{slots:?}") };
    near(slot.width, 0.15, 0.01);
    near(slot.length, 6.0 + 0.075 * PI, 0.02);
    assert!(slot.at.y.abs() < 0.1 && (1.9..8.1).contains(&slot.at.x), "{slot:?}");
    near(unreached.area(), 0.15 * 6.0 + PI * 0.075 * 0.075, 0.02);
    assert_eq!(narrow, []);
    let Isolated { slots, unreached, .. } = isolated(&plane(0.25), 0.2, Narrow::Bite);
    assert!(slots.is_empty() && unreached.is_empty(), "{slots:?}");
}

/// What a tool of `width` takes away along `paths`.
fn swept(paths: &[Path], width: f64) -> Region {
    let strokes: Vec<Region> = paths
        .iter()
        .flat_map(Path::elements)
        .map(|element| Region::stroke(element, width, Cap::Round).unwrap())
        .collect();
    Region::union_of(&strokes).unwrap()
}

/// Cuts the isolation out of the board and compares what is left with what was reported.
fn judge(name: &str, copper: &Copper, width: f64, narrow: Narrow) {
    let isolation = Isolation { cutter: Cutter::Cylinder { diameter: width }, narrow, ..ISOLATION };
    let isolated = isolation.isolate(copper, None).unwrap();
    let index = Index::new(&copper.region);
    for element in isolated.paths.iter().filter(|path| path.is_closed()).flat_map(Path::elements) {
        for t in [0.0, 0.3, 0.7] {
            let at = element.at(t);
            let in_gap =
                isolated.narrow.iter().flat_map(|gap| &gap.middle).flat_map(Path::elements);
            let away = index.nearest(at, f64::INFINITY).unwrap().distance;
            let is_around = (away - width / 2.0).abs() < 0.002;
            assert!(is_around || in_gap.into_iter().any(|other| other == element), "{name} {at}");
        }
    }
    let cut = swept(&isolated.paths, width);
    let made = isolated.narrow.iter().filter(|gap| gap.fate == Fate::Cut);
    let most: f64 = made.map(|gap| (gap.length + width) * 2.0 * gap.thinned(width)).sum();
    assert!(narrow != Narrow::LeaveOut || most == 0.0);
    if narrow == Narrow::Bite {
        let deep = copper
            .region
            .offset(-MOST_BITE - BITE_OFF - 0.001)
            .unwrap()
            .intersection(&cut)
            .unwrap();
        assert!(deep.area() < 1e-6, "{name}: {} mm² too deep, {:?}", deep.area(), deep.extents());
    }
    let lost = copper.region.intersection(&cut).unwrap().area();
    // The boundary of the cut may be 2 µm off.
    let length = isolated.paths.iter().map(Path::length).sum::<f64>();
    assert!(lost < most + 0.002 * length, "{name}: {lost} mm² lost");

    // What is left is in pieces, and in each of them there is one conductor, or those that only gaps that
    // are left out are between.
    let (low, high) = copper.region.extents().unwrap();
    let around = [low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)];
    let board = Region::inside(&[Ring::polygon(&around).unwrap()], Fill::NonZero).unwrap();
    let left = board.offset(1.0).unwrap().difference(&cut).unwrap();
    let pieces = Index::new(&left);
    let mut conductors = BTreeMap::<usize, BTreeSet<usize>>::new();
    let reported: BTreeSet<usize> = isolated.severed.iter().map(|severed| severed.island).collect();
    for (i, island) in copper.region.islands().iter().enumerate() {
        let inside = |element: &Element| element.at(0.5) + element.tangent(0.5).perp() * 0.005;
        let places = island.outer().elements().iter().map(inside);
        let of: BTreeSet<usize> = places.filter_map(|place| pieces.island_at(place)).collect();
        for &piece in &of {
            conductors.entry(piece).or_default().insert(i);
        }
        assert!(
            of.len() < 2 || reported.contains(&i),
            "{name}: island {i} is in {} pieces",
            of.len()
        );
    }
    for mut together in conductors.into_values() {
        let mut reached: Vec<usize> = together.pop_first().into_iter().collect();
        while let Some(one) = reached.pop() {
            let touching = isolated
                .narrow
                .iter()
                .filter(|gap| gap.islands.contains(&one) && gap.fate == Fate::Joined);
            for other in touching.flat_map(|gap| gap.islands) {
                if together.remove(&other) {
                    reached.push(other);
                }
            }
        }
        assert!(together.is_empty(), "{name}: {together:?} are joined");
    }
}

#[test]
fn on_real_boards_nothing_is_lost_and_conductors_are_apart() {
    let Some(folder) = data::folder() else { return };
    let coldfire = "kicad/kit-dev-coldfire-xilinx_5213/kit-dev-coldfire-xilinx_5213-F_Cu.gbr";
    for (name, width, narrow) in [
        ("kicad/StickHub/StickHub-F_Cu.gbr", 0.3, Narrow::Middle),
        ("kicad/StickHub/StickHub-F_Cu.gbr", 0.2, Narrow::Bite),
        (coldfire, 0.2, Narrow::Bite),
        ("kicad/microwave/microwave-F_Cu.gbr", 0.3, Narrow::Bite),
        ("a64/A64-OlinuXino_Rev_D-F.Cu.gbr", 0.15, Narrow::Bite),
        ("kicad/StickHub/StickHub-B_Cu.gbr", 0.3, Narrow::LeaveOut),
        ("kicad/carte_test/carte_test-F_Cu.gbr", 0.3, Narrow::Middle),
        ("kicad/ecc83-pp/ecc83-pp-B_Cu.gbr", 0.5, Narrow::Middle),
        ("kicad/interf_u/interf_u-F_Cu.gbr", 0.3, Narrow::Middle),
        (coldfire, 0.3, Narrow::Middle),
        ("kicad/microwave/microwave-F_Cu.gbr", 0.4, Narrow::Middle),
        ("kicad/pic_programmer/pic_programmer-B_Cu.gbr", 0.3, Narrow::LeaveOut),
        ("a64/A64-OlinuXino_Rev_D-B.Cu.gbr", 0.2, Narrow::Middle),
    ] {
        let image = gerber::read(name, &data::bytes(&folder.join(name))).unwrap().image;
        let region = covered(&image).unwrap();
        let copper = Copper { nets: vec![None; region.islands().len()], region };
        judge(name, &copper, width, narrow);
    }
}

/// A pad or a track; on a grid, as on most boards, or not.
fn shape() -> impl Strategy<Value = Region> {
    let place = || (-40..40i32, -40..40i32, any::<bool>());
    let at = |(x, y, on_grid): (i32, i32, bool)| {
        let point = Vec2::new(x.into(), y.into());
        if on_grid { (point * 0.25).round() * 0.5 } else { point * 0.117 }
    };
    (place(), place(), 1..4u32, any::<bool>()).prop_map(move |(from, to, size, is_pad)| {
        let (from, to, width) = (at(from), at(to), f64::from(size) * 0.2);
        let end = if is_pad { from } else { to };
        Region::stroke(&Element::line(from, end), width, Cap::Round).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(100) })]

    #[test]
    fn on_any_board_nothing_is_lost_and_conductors_are_apart(
        shapes in proptest::collection::vec(shape(), 2..12), width in 1..12u32, how in 0..3usize
    ) {
        let narrow = [Narrow::Bite, Narrow::LeaveOut, Narrow::Middle][how];
        judge("random", &copper(&shapes), f64::from(width) * 0.1, narrow);
    }

    #[test]
    fn the_middle_is_as_far_from_two_and_no_nearer_to_a_third(
        shapes in proptest::collection::vec(shape(), 2..12), width in 1..20u32
    ) {
        let copper = copper(&shapes);
        for gap in narrow(&copper, f64::from(width) * 0.1) {
            let islands = copper.region.islands();
            let away = |point| {
                let mut away: Vec<f64> = islands.iter().map(|i| i.distance(point)).collect();
                let two = gap.islands.map(|i| away[i]);
                away.sort_by(f64::total_cmp);
                (two, away[0])
            };
            let ([first, second], least) = away(gap.at);
            let half = gap.width / 2.0;
            prop_assert!([first, second, least].iter().all(|away| (away - half).abs() < 1e-5), "{first} {second} {least} {half} {gap:?}");
            for element in gap.middle.iter().flat_map(Path::elements) {
                for t in [0.0, 0.5, 1.0] {
                    // Chords are 6 µm from the line at most, and at right angles to it distances change as much.
                    let ([first, second], least) = away(element.at(t));
                    prop_assert!((first - second).abs() < 0.013, "{first} {second} {element:?} {t} of {} len {} width {} {:?} {:?}", gap.length, element.length(), gap.width, gap.at, gap.middle);
                    prop_assert!(first.min(second) - least < 0.013, "{first} {least}");
                    prop_assert!(first > half - 0.007, "{first} {half} {gap:?}");
                }
            }
        }
    }
}
