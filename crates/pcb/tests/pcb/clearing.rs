//! Cleared areas against hand calculation, and against what the tools sweep on the path.

use crate::data;
use geom::Vec2;
use geom::region::{Cap, Fill, Region, Ring};
use proptest::prelude::*;
use std::f64::consts::PI;
use toolpost_pcb::board::covered;
use toolpost_pcb::isolation::Direction;
use toolpost_pcb::{Cleared, Clearing, Path, gerber};

fn clearing(widths: &[f64], overlap: f64) -> Clearing {
    Clearing { widths: widths.to_vec(), overlap, direction: Direction::Climb }
}

fn cleared(area: &Region, widths: &[f64], overlap: f64) -> Cleared {
    clearing(widths, overlap).clear(area).unwrap()
}

/// A rectangle between two corners.
fn rectangle(low: (f64, f64), high: (f64, f64)) -> Region {
    let corners = [low, (high.0, low.1), high, (low.0, high.1)];
    let ring = Ring::polygon(&corners.map(|(x, y)| Vec2::new(x, y))).unwrap();
    Region::inside([&ring], Fill::Positive).unwrap()
}

/// What a tool sweeps.
fn swept(paths: &[Path], width: f64) -> Region {
    let elements = paths.iter().flat_map(Path::elements);
    let strokes: Vec<Region> =
        elements.map(|element| Region::stroke(element, width, Cap::Round).unwrap()).collect();
    Region::union_of(&strokes).unwrap()
}

/// Asserts that the tools sweep nothing but `area`, and all of it but the rest.
fn check(area: &Region, widths: &[f64], overlap: f64) -> Vec<Vec<Path>> {
    let clearing = cleared(area, widths, overlap);
    let each: Vec<Region> = clearing
        .passes
        .iter()
        .zip(widths)
        .map(|(paths, width)| {
            let swept = swept(paths, *width);
            let beyond = swept.difference(&area.offset(0.003).unwrap()).unwrap();
            assert!(beyond.area() < 1e-9, "{} mm² beyond the area", beyond.area());
            swept
        })
        .collect();
    let cut = Region::union_of(&each).unwrap();
    // Up to 10 µm from each place that is cut may stay, and regions are exact to 1 µm.
    let left = area.difference(&cut.offset(0.012).unwrap()).unwrap();
    let left = left.difference(&clearing.rest.offset(0.003).unwrap()).unwrap();
    assert!(left.area() < 1e-6, "{} mm² are left at {:?}", left.area(), left.extents());
    clearing.passes
}

#[test]
fn a_rectangle_is_cleared_by_rings_within_each_other() {
    // Rings of 9 × 4, 8 × 3, 7 × 2, 6 × 1: the next would have no width.
    let area = rectangle((0.0, 0.0), (10.0, 5.0));
    let passes = check(&area, &[1.0], 0.5);
    let lengths: Vec<f64> = passes[0].iter().map(Path::length).collect();
    assert_eq!(lengths.len(), 4);
    for (length, expected) in lengths.iter().zip([26.0, 22.0, 18.0, 14.0]) {
        assert!((length - expected).abs() < 1e-6, "{length}");
    }
    assert!(passes[0].iter().all(Path::is_closed));
}

#[test]
fn what_a_wide_tool_leaves_in_corners_a_narrow_one_takes() {
    let area = rectangle((0.0, 0.0), (10.0, 5.0));
    // (4 − π) r² stays in the corners, less what is 5 µm from the cut.
    let rest = |widths: &[f64]| cleared(&area, widths, 0.5).rest.area();
    let corners = |width: f64| (4.0 - PI) * width * width / 4.0;
    assert!(rest(&[2.0]) < corners(2.0) && rest(&[2.0]) > 0.8 * corners(2.0));
    assert!(rest(&[2.0, 0.5]) < corners(0.5) && rest(&[2.0, 0.5]) > 0.5 * corners(0.5));
    check(&area, &[2.0, 0.5], 0.5);
    // Only there.
    let narrow = &cleared(&area, &[2.0, 0.5], 0.5).passes[1];
    assert!(narrow.iter().map(Path::length).sum::<f64>() < 4.0 * 4.0, "{narrow:?}");
}

#[test]
fn wide_steps_leave_no_ridges() {
    let triangle = [(0.0, 0.0), (30.0, 0.0), (30.0, 4.0)].map(|(x, y)| Vec2::new(x, y));
    let triangle = Region::inside([&Ring::polygon(&triangle).unwrap()], Fill::Positive).unwrap();
    let disc = Region::disc(Vec2::ZERO, 3.7).unwrap();
    for overlap in [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7] {
        for area in [&triangle, &disc, &rectangle((0.0, 0.0), (10.0, 5.3))] {
            check(area, &[1.0], overlap);
        }
    }
}

#[test]
fn what_is_too_narrow_is_reported() {
    let area = rectangle((0.0, 0.0), (10.0, 0.9));
    let clearing = cleared(&area, &[1.0], 0.4);
    assert!(clearing.passes[0].is_empty());
    assert!((clearing.rest.area() - 9.0).abs() < 1e-6);
}

/// Between a pad and the corner of the board a tool of 1.7 mm has 1.5 µm of room: its middle may be 0.85 mm from both
/// edges, which is 0.8515 mm from the corner of the pad. Whether it goes there or not, nothing stays but what is reported.
#[test]
fn where_a_tool_just_fits_it_cuts_or_leaves_it_to_the_next() {
    let board = rectangle((-1.0, -1.0), (11.0, 11.0));
    let area = board.difference(&rectangle((9.0, 9.3), (9.5, 9.6))).unwrap();
    check(&area, &[1.7, 0.1], 0.0);
}

#[test]
fn tools_that_cannot_clear_are_refused() {
    let area = rectangle((0.0, 0.0), (100.0, 100.0));
    for (width, overlap, rule) in [
        (0.0, 0.5, "tool-width"),
        (-1.0, 0.5, "tool-width"),
        (f64::NAN, 0.5, "tool-width"),
        (f64::INFINITY, 0.5, "tool-width"),
        (1.0, 1.0, "overlap"),
        (1.0, -0.1, "overlap"),
        (1.0, f64::NAN, "overlap"),
        (1.0, 0.9999, "tool-width"),
    ] {
        assert_eq!(
            clearing(&[width], overlap).clear(&area).unwrap_err().rule,
            rule,
            "{width} {overlap}"
        );
    }
    for widths in [[1.0, 1.0], [0.5, 1.0]] {
        assert_eq!(clearing(&widths, 0.5).clear(&area).unwrap_err().rule, "tool-width");
    }
    let field = rectangle((0.0, 0.0), (50_000.0, 50_000.0));
    assert_eq!(clearing(&[0.1], 0.5).clear(&field).unwrap_err().rule, "too-much");
}

#[test]
fn the_kept_copper_is_on_the_right_when_climbing() {
    // A pad in the middle of a square board: one ring around the pad, one along the edge.
    let pad = Region::disc(Vec2::ZERO, 2.0).unwrap();
    let board = rectangle((-4.5, -4.5), (4.5, 4.5));
    let paths = |direction| {
        let clearing = Clearing { widths: vec![2.0], overlap: 0.0, direction };
        let passes = clearing.rub_out(&pad, 0.3, &board).unwrap().passes;
        passes[0].iter().filter(|path| path.is_closed()).cloned().collect::<Vec<Path>>()
    };
    let area = |path: &Path| path.elements().iter().map(|e| e.area(Vec2::ZERO)).sum::<f64>();
    // Where 0.2 mm are between the two rings: 3.5² · 4 and −3.3² · π.
    let climbing: Vec<f64> = paths(Direction::Climb).iter().map(area).collect();
    assert_eq!(climbing.len(), 2);
    assert!((climbing[0] - 49.0).abs() < 1e-6 && (climbing[1] + 10.89 * PI).abs() < 1e-2);
    let other: Vec<f64> = paths(Direction::Conventional).iter().map(area).collect();
    assert!(other.iter().zip(&climbing).all(|(a, b)| (a + b).abs() < 1e-9));
}

/// A pad on a grid of 0.1 mm: a disc, or a rectangle.
fn pad() -> impl Strategy<Value = Region> {
    (any::<bool>(), 0..100, 0..100, 2..12, 2..12).prop_map(|(round, x, y, wide, high)| {
        let [x, y, wide, high] = [x, y, wide, high].map(|steps| f64::from(steps) / 10.0);
        match round {
            true => Region::disc(Vec2::new(x, y), wide).unwrap(),
            false => rectangle((x, y), (x + wide, y + high)),
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..Default::default() })]

    #[test]
    fn any_board_is_rubbed_out(
        pads in prop::collection::vec(pad(), 1..15),
        wide in 5..20,
        narrow in 1..5,
        overlap in 0..9,
    ) {
        let [wide, narrow, overlap] = [wide, narrow, overlap].map(|steps| f64::from(steps) / 10.0);
        let board = rectangle((-1.0, -1.0), (11.0, 11.0));
        let copper = Region::union_of(&pads).unwrap();
        check(&board.difference(&copper).unwrap(), &[wide, narrow], overlap);
    }
}

#[test]
fn real_boards_are_rubbed_out() {
    let Some(folder) = data::folder() else { return };
    for name in ["ecc83-pp/ecc83-pp-B_Cu.gbr", "pic_programmer/pic_programmer-B_Cu.gbr"] {
        let file = folder.join("kicad").join(name);
        let copper = covered(&gerber::read(name, &data::bytes(&file)).unwrap().image).unwrap();
        let (low, high) = copper.extents().unwrap();
        let board = rectangle((low.x - 2.0, low.y - 2.0), (high.x + 2.0, high.y + 2.0));
        let area = board.difference(&copper.offset(0.1).unwrap()).unwrap();
        let passes = check(&area, &[1.5, 0.4], 0.3);
        assert!(passes.iter().all(|paths| !paths.is_empty()), "{name}");
    }
}
