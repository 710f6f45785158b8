//! Random boards, as bad as boards are: everything on a grid, tracks that end in pads and in each other,
//! equal widths, circles that coincide and touch.
//!
//! Three judges that share nothing with `region`: the distances of points to pads and tracks ([`field`]),
//! the boundary put together from exact crossings ([`arrangement`]), and another library's union of
//! polygons ([`polygons`]).

mod arrangement;
mod board;
mod crossing;
mod field;
mod neighbours;
mod polygons;

use board::{Board, Random};
use std::panic::RefUnwindSafe;
use toolpost_geom::Vec2;
use toolpost_geom::region::Region;

/// Boards of each kind that are united.
const UNITED: u64 = 5000;

/// Boards of each kind that are offset.
const OFFSET: u64 = 1500;

/// Pairs of regions that are nearly one.
const NEIGHBOURS: u64 = 4000;

/// How far a boundary is off by rounding, mm.
const ROUNDING: f64 = 1e-6;

/// How far a boundary may be from where it ought to be, mm.
const NEAR: f64 = 0.001;

/// Judges `boards` of a kind, by two threads, and gives the share of those that agree but nearly.
fn on_all<Kind: RefUnwindSafe>(
    boards: u64,
    kind: fn(&mut Random) -> Kind,
    judge: impl Fn(&Kind, &mut Random) -> Verdict + Copy + Send + RefUnwindSafe,
) -> f64 {
    let half = move |from: u64| {
        let (mut rejected, mut near) = (Vec::new(), 0);
        for seed in (from..boards).step_by(2) {
            let board = kind(&mut Random::new(seed));
            match std::panic::catch_unwind(|| judge(&board, &mut Random::new(seed))) {
                Ok(Verdict::Exact) => {}
                Ok(Verdict::Near) => near += 1,
                Err(words) => rejected.push((seed, words.downcast_ref::<String>().cloned())),
            }
        }
        (rejected, near)
    };
    let (mut rejected, near) = std::thread::scope(|scope| {
        let other = scope.spawn(move || half(1));
        let (mut rejected, near) = half(0);
        let (more, others) = other.join().unwrap();
        rejected.extend(more);
        (rejected, near + others)
    });
    rejected.truncate(10);
    assert!(rejected.is_empty(), "rejected: {rejected:#?}");
    f64::from(near) / boards as f64
}

/// How well a region agrees with a board.
enum Verdict {
    /// To rounding.
    Exact,
    /// To 1 µm: something in it is so thin, or comes so near to something else.
    Near,
}

/// Holds a region against the board grown by `grown`.
fn compare(region: &Region, board: &Board, grown: f64, random: &mut Random) -> Verdict {
    // Each of two steps may be off by as much.
    let near = if grown == 0.0 { NEAR } else { 2.0 * NEAR };
    let off = field::agrees(region, board, grown, near, random);
    crossing::never(region);
    let exact = arrangement::of(board, grown);
    let missing = exact.points.iter().filter(|(point, is_gap)| {
        let each = region.rings().map(|ring| ring.distance(*point));
        let away = each.fold(f64::INFINITY, f64::min);
        assert!(away < near || *is_gap, "{point} is on the boundary, {away} mm from ours");
        away > ROUNDING
    });
    let area = region.area();
    if off > ROUNDING || missing.count() > 0 {
        let most = near * (exact.lines + exact.curved);
        assert!((area - exact.area).abs() <= most, "area {area} for {}", exact.area);
        return Verdict::Near;
    }
    assert!((area - exact.area).abs() <= 1e-6 * exact.area, "area {area} for {}", exact.area);
    let (mut lengths, mut arcs) = ([0.0, 0.0], 0);
    for element in region.rings().flat_map(|ring| ring.elements()) {
        let is_arc = element.turn.is_some();
        lengths[usize::from(is_arc)] += element.length();
        arcs += usize::from(is_arc);
    }
    for (what, ours, exact) in
        [("lines", lengths[0], exact.lines), ("arcs", lengths[1], exact.curved)]
    {
        assert!((ours - exact).abs() < 1e-5 * exact.max(1.0), "{what} of {ours} mm for {exact}");
    }
    let right = exact.fewest_arcs..=exact.most_arcs;
    assert!(right.contains(&arcs), "{arcs} arcs for {right:?}");
    Verdict::Exact
}

fn union(board: &Board, grown: f64) -> Region {
    Region::union_of(&board.regions(grown)).unwrap()
}

#[test]
fn the_union_of_a_board_on_a_grid_is_exact() {
    let near = on_all(UNITED, board::on_a_grid, |board, random| {
        compare(&union(board, 0.0), board, 0.0, random)
    });
    assert!(near < 0.01, "{near}");
}

#[test]
fn the_union_of_a_board_at_any_angle_is_exact() {
    let near = on_all(UNITED, board::at_any_angle, |board, random| {
        compare(&union(board, 0.0), board, 0.0, random)
    });
    assert!(near < 0.1, "{near}");
}

#[test]
fn a_board_that_is_grown_is_the_union_of_what_is_grown() {
    for kind in [board::on_a_grid, board::at_any_angle] {
        on_all(OFFSET, kind, |board, random| {
            let distance = [0.05, 0.1, 0.125, 0.25][random.below(4)];
            compare(&union(board, 0.0).offset(distance).unwrap(), board, distance, random)
        });
    }
}

#[test]
fn a_board_that_is_shrunk_is_what_is_far_enough_from_its_boundary() {
    on_all(OFFSET, board::on_a_grid, |board, random| {
        let board_region = union(board, 0.0);
        let distance = [0.02, 0.05, 0.1, 0.125][random.below(4)];
        let shrunk = board_region.offset(-distance).unwrap();
        crossing::never(&shrunk);
        let inside = |point| {
            let each = board_region.rings().map(|ring| ring.distance(point));
            let away = each.fold(f64::INFINITY, f64::min);
            if board_region.contains(point) { away - distance } else { -away - distance }
        };
        let (low, high) = board.extents();
        for _ in 0..100 {
            let point = low + (high - low) * Vec2::new(random.unit(), random.unit());
            let inside = inside(point);
            if inside.abs() > NEAR {
                assert_eq!(shrunk.contains(point), inside > 0.0, "{point}, {inside} mm inside");
            }
        }
        for element in shrunk.rings().flat_map(|ring| ring.elements()) {
            for t in [0.0, 0.3, 0.6] {
                let inside = inside(element.at(t));
                assert!(inside.abs() < NEAR, "{element:?} is {inside} mm off at {t}");
            }
        }
        Verdict::Exact
    });
}

#[test]
fn booleans_of_regions_that_are_nearly_one_are_right() {
    on_all(NEIGHBOURS, neighbours::pair, |pair, random| {
        neighbours::judge(pair, random);
        Verdict::Exact
    });
}

#[test]
fn another_library_has_the_same_area_islands_and_holes() {
    for seed in 0..50 {
        for kind in [board::on_a_grid, board::at_any_angle] {
            let board = kind(&mut Random::new(seed));
            let region = union(&board, 0.0);
            let (area, islands, holes) = polygons::union(&board, 0.0);
            assert!(
                (region.area() - area).abs() < 1e-6 * area,
                "{seed}: {} for {area}",
                region.area()
            );
            let areas: Vec<f64> = region.rings().map(|ring| ring.area()).collect();
            let ours = (
                areas.iter().filter(|area| **area > polygons::SMALL).count(),
                areas.iter().filter(|area| **area < -polygons::SMALL).count(),
            );
            assert_eq!(ours, (islands, holes), "{seed}: {board:?}");
        }
    }
}
