//! A board as distances: how far a point is from the nearest pad or track.

use super::board::{Board, Random, Shape};
use toolpost_geom::Vec2;
use toolpost_geom::region::Region;

/// How far `point` is from a shape, mm; negative inside.
pub fn away(shape: &Shape, point: Vec2) -> f64 {
    let along = shape.to - shape.from;
    let squared = along.length_squared();
    let t = if squared > 0.0 {
        ((point - shape.from).dot(along) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    point.distance(shape.from + along * t) - shape.radius
}

/// How far `point` is from the board, mm; negative inside, and then no more than from the nearest boundary.
pub fn away_from_board(board: &Board, point: Vec2) -> f64 {
    board.shapes.iter().map(|shape| away(shape, point)).fold(f64::INFINITY, f64::min)
}

/// Random points are in the region where they are in the board grown by `grown`, but for what is `near`
/// the boundary, and every element of the region's boundary is as near to that board's. Gives how far it is from there
/// at most, mm.
pub fn agrees(region: &Region, board: &Board, grown: f64, near: f64, random: &mut Random) -> f64 {
    let (low, high) = board.extents();
    for _ in 0..200 {
        let point = low + (high - low) * Vec2::new(random.unit(), random.unit());
        let away = away_from_board(board, point) - grown;
        if away.abs() > near {
            assert_eq!(region.contains(point), away < 0.0, "{point}, {away} mm away");
        }
        if away > near {
            let distance = region.distance(point);
            assert!((distance - away).abs() < near, "{point}: {distance} mm for {away}");
        }
    }
    let mut most: f64 = 0.0;
    for element in region.rings().flat_map(|ring| ring.elements()) {
        for t in [0.0, 0.2, 0.4, 0.6, 0.8] {
            let away = away_from_board(board, element.at(t)) - grown;
            assert!(away.abs() < near, "{element:?} is {away} mm off at {t}");
            most = away.abs().max(most);
        }
    }
    most
}
