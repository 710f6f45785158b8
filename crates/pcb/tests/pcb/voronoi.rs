//! Boards divided among their conductors.

use crate::data;
use geom::Vec2;
use geom::region::{Cap, Fill, Index, Region, Ring};
use proptest::prelude::*;
use toolpost_pcb::board::covered;
use toolpost_pcb::isolation::Narrow;
use toolpost_pcb::{Copper, Division, Path, divided, gerber};

fn rectangle(low: (f64, f64), high: (f64, f64)) -> Region {
    let corners = [low, (high.0, low.1), high, (low.0, high.1)];
    let ring = Ring::polygon(&corners.map(|(x, y)| Vec2::new(x, y))).unwrap();
    Region::inside([&ring], Fill::Positive).unwrap()
}

fn disc(x: f64, y: f64, radius: f64) -> Region {
    Region::disc(Vec2::new(x, y), radius).unwrap()
}

/// Copper of islands without nets.
fn copper(pieces: &[Region]) -> Copper {
    let region = Region::union_of(pieces).unwrap();
    Copper { nets: vec![None; region.islands().len()], region }
}

fn swept<'a>(paths: impl IntoIterator<Item = &'a Path>, width: f64) -> Region {
    let elements = paths.into_iter().flat_map(Path::elements);
    let strokes: Vec<Region> =
        elements.map(|element| Region::stroke(element, width, Cap::Round).unwrap()).collect();
    Region::union_of(&strokes).unwrap()
}

/// Asserts that no path is in the copper, that all conductors are apart on the board, and that paths are in the
/// middle.
fn check(copper: &Copper, board: &Region, width: f64) -> Division {
    let division = divided(copper, board, width, Narrow::LeaveOut).unwrap();
    let cut = swept(&division.paths, width);
    // A gap that is just as wide as the tool is met to a fiftieth of it.
    let near = (width / 45.0).max(0.005);
    let hurt = cut.intersection(&copper.region.offset(-near).unwrap()).unwrap();
    assert!(hurt.area() < 1e-9, "{} mm² of copper at {:?}", hurt.area(), hurt.extents());
    // Where it is too wide the tool would cut copper; there a thin one shows that the path divides.
    let middles = division.narrow.iter().filter_map(|gap| gap.middle.as_ref());
    let cut = cut.union(&swept(middles, 0.02)).unwrap();
    let pieces = board.difference(&cut).unwrap();
    let index = Index::new(&pieces);
    let mut owners: Vec<Option<usize>> = vec![None; pieces.islands().len()];
    for (i, island) in copper.region.islands().iter().enumerate() {
        for element in island.outer().elements() {
            let Some(piece) = index.island_at(element.at(0.5)) else { continue };
            let owner = *owners[piece].get_or_insert(i);
            let net = |island: usize| copper.nets[island].as_ref();
            let one = owner == i || net(i).is_some() && net(owner) == net(i);
            assert!(one, "islands {owner} and {i} are joined at {}", element.at(0.5));
        }
    }
    division
}

#[test]
fn between_two_discs_runs_a_line() {
    let copper = copper(&[disc(-5.0, 0.0, 2.0), disc(5.0, 0.0, 2.0)]);
    let board = rectangle((-10.0, -4.0), (10.0, 4.0));
    let division = check(&copper, &board, 0.4);
    assert!(division.narrow.is_empty());
    let [path] = &division.paths[..] else { panic!("{:?}", division.paths) };
    assert!((path.length() - 8.0).abs() < 1e-3 && path.elements().len() < 4, "{path:?}");
    assert!(path.elements().iter().all(|e| e.start.x.abs() < 3e-3 && e.end.x.abs() < 3e-3));
}

#[test]
fn three_discs_are_parted_by_three_lines_that_meet_in_the_middle() {
    let places = [0.0f64, 120.0, 240.0].map(|angle| Vec2::from_angle(angle.to_radians()) * 5.0);
    let copper = copper(&places.map(|place| disc(place.x, place.y, 1.0)));
    let board = disc(0.0, 0.0, 8.0);
    let division = check(&copper, &board, 0.2);
    assert_eq!(division.paths.len(), 3);
    for path in &division.paths {
        assert!((path.length() - 8.0).abs() < 2e-3, "{}", path.length());
        assert!(path.start().length().min(path.end().length()) < 1e-6);
    }
}

#[test]
fn between_a_pad_and_the_zone_around_it_runs_a_circle() {
    let zone = rectangle((-10.0, -10.0), (10.0, 10.0)).difference(&disc(0.0, 0.0, 4.0)).unwrap();
    let copper = copper(&[zone, disc(0.0, 0.0, 2.0)]);
    let division = check(&copper, &rectangle((-11.0, -11.0), (11.0, 11.0)), 0.5);
    let [path] = &division.paths[..] else { panic!("{:?}", division.paths) };
    assert!(path.is_closed());
    assert!(path.elements().iter().all(|e| (e.start.length() - 3.0).abs() < 5e-6));
}

#[test]
fn between_a_line_and_a_small_pad_runs_a_parabola() {
    // The pad's middle is 2 mm above the edge, the pad's radius 0.1: |p − f| − 0.1 = y.
    let copper = copper(&[rectangle((-20.0, -2.0), (20.0, 0.0)), disc(0.0, 2.0, 0.1)]);
    let division = check(&copper, &rectangle((-5.0, -5.0), (5.0, 5.0)), 0.2);
    let [path] = &division.paths[..] else { panic!("{:?}", division.paths) };
    assert!(path.elements().len() > 10);
    for p in path.elements().iter().map(|e| e.start) {
        // Where it is cut off at the board it may be on a chord.
        let off = if p.y > 4.999 { 2.0 * 4.9 / 50.0 } else { 5e-6 };
        assert!((p.distance(Vec2::new(0.0, 2.0)) - 0.1 - p.y).abs() < off, "{p}");
    }
}

#[test]
fn islands_of_one_net_are_not_parted() {
    let mut copper = copper(&[disc(-5.0, 0.0, 2.0), disc(5.0, 0.0, 2.0)]);
    copper.nets = vec![Some("GND".into()), Some("GND".into())];
    let board = rectangle((-10.0, -4.0), (10.0, 4.0));
    assert_eq!(divided(&copper, &board, 0.4, Narrow::LeaveOut).unwrap(), Division::default());
}

#[test]
fn a_gap_narrower_than_the_tool_is_reported_with_its_place() {
    // Two discs 0.3 apart, a tool of 0.5: too narrow where |x| is small.
    let copper = copper(&[disc(-2.15, 0.0, 2.0), disc(2.15, 0.0, 2.0)]);
    let board = rectangle((-10.0, -4.0), (10.0, 4.0));
    let division = check(&copper, &board, 0.5);
    let [gap] = &division.narrow[..] else { panic!("{:?}", division.narrow) };
    // To the spacing of points along the path.
    assert!((gap.width - 0.3).abs() < 2e-3 && gap.at.length() < 0.1, "{gap:?}");
    assert_eq!(division.paths.len(), 2);
    // Its ends are where |p − f| = 2.25.
    let end = (2.25f64.powi(2) - 2.15f64.powi(2)).sqrt();
    assert!((gap.length - 2.0 * end).abs() < 0.3, "{}", gap.length);
}

#[test]
fn a_gap_between_two_corners_is_as_narrow_as_they_are_near() {
    // √(0.1² + 0.2²) = 0.2236 between the corners; on the path past them nothing else is as near.
    let copper = copper(&[rectangle((9.7, 7.8), (9.9, 8.7)), rectangle((8.8, 8.9), (9.6, 9.1))]);
    let division = check(&copper, &rectangle((7.0, 7.0), (11.0, 11.0)), 0.25);
    let [gap] = &division.narrow[..] else { panic!("{:?}", division.narrow) };
    assert!(
        (gap.width - 0.05f64.sqrt()).abs() < 1e-9 && gap.at.distance(Vec2::new(9.65, 8.8)) < 1e-9
    );
}

#[test]
fn widths_that_are_none_are_refused() {
    let copper = copper(&[disc(-5.0, 0.0, 2.0), disc(5.0, 0.0, 2.0)]);
    let board = rectangle((-10.0, -4.0), (10.0, 4.0));
    for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(
            divided(&copper, &board, width, Narrow::LeaveOut).unwrap_err().rule,
            "tool-width"
        );
    }
}

/// A pad on a grid of 0.1 mm: a disc, or a rectangle.
fn pad() -> impl Strategy<Value = Region> {
    (any::<bool>(), 0..100, 0..100, 2..12, 2..12).prop_map(|(round, x, y, wide, high)| {
        let [x, y, wide, high] = [x, y, wide, high].map(|steps| f64::from(steps) / 10.0);
        if round { disc(x, y, wide) } else { rectangle((x, y), (x + wide, y + high)) }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..Default::default() })]

    #[test]
    fn any_board_is_divided_in_the_middle(
        pads in prop::collection::vec(pad(), 2..15),
        width in 1..8,
    ) {
        let width = f64::from(width) / 20.0;
        let copper = copper(&pads);
        let board = rectangle((-1.0, -1.0), (11.0, 11.0));
        let division = check(&copper, &board, width);
        let middles = division.narrow.iter().filter_map(|gap| gap.middle.as_ref());
        for path in division.paths.iter().chain(middles) {
            for element in path.elements() {
                let islands = copper.region.islands().iter();
                let mut away: Vec<f64> =
                    islands.map(|island| island.distance(element.start)).collect();
                away.sort_by(f64::total_cmp);
                let off = away[1] - away[0];
                prop_assert!(off < 0.005 + away[0] / 25.0, "{off} at {}", element.start);
            }
        }
    }
}

#[test]
fn real_boards_are_divided() {
    let Some(folder) = data::folder() else { return };
    for (name, width) in [
        ("ecc83-pp/ecc83-pp-B_Cu.gbr", 0.4),
        ("pic_programmer/pic_programmer-F_Cu.gbr", 0.2),
        ("pic_programmer/pic_programmer-F_Cu.gbr", 0.4),
    ] {
        let file = folder.join("kicad").join(name);
        let region = covered(&gerber::read(name, &data::bytes(&file)).unwrap().image).unwrap();
        let copper = Copper { nets: vec![None; region.islands().len()], region };
        let (low, high) = copper.region.extents().unwrap();
        let board = rectangle((low.x - 2.0, low.y - 2.0), (high.x + 2.0, high.y + 2.0));
        let division = check(&copper, &board, width);
        assert!(!division.paths.is_empty(), "{name}");
        assert!(division.narrow.iter().all(|gap| gap.width < width), "{name}");
    }
}
