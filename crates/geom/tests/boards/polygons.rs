//! A board as another library's polygons: its union, with chords that are as good as the arcs.

use super::board::{Board, Shape};
use clipper2_rust::core::{FillRule, PathsD, PointD};
use clipper2_rust::union_subjects_d;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toolpost_geom::Vec2;

/// How far the middle of a chord is from its arc, mm.
const CHORD_ERROR: f64 = 1.5e-7;

/// Decimal places of a millimetre that the library keeps.
const PLACES: i32 = 8;

/// Rings around less are not counted, mm².
pub const SMALL: f64 = 1e-4;

/// Area of the union, mm², and the numbers of its outer rings and holes.
pub fn union(board: &Board, grown: f64) -> (f64, usize, usize) {
    let paths: PathsD = board.shapes.iter().map(|shape| polygon(shape, grown)).collect();
    let union = union_subjects_d(&paths, FillRule::NonZero, PLACES);
    let areas: Vec<f64> = union.iter().map(clipper2_rust::core::area).collect();
    let islands = areas.iter().filter(|area| **area > SMALL).count();
    let holes = areas.iter().filter(|area| **area < -SMALL).count();
    (areas.iter().sum(), islands, holes)
}

fn polygon(shape: &Shape, grown: f64) -> Vec<PointD> {
    let radius = shape.radius + grown;
    let along = (shape.to - shape.from).to_angle();
    let arcs = match shape.from == shape.to {
        true => vec![(shape.from, 0.0, TAU)],
        false => vec![(shape.to, along - FRAC_PI_2, PI), (shape.from, along + FRAC_PI_2, PI)],
    };
    let mut points = Vec::new();
    for (center, from, sweep) in arcs {
        let steps = (sweep / (8.0 * CHORD_ERROR / radius).sqrt()).ceil();
        // A full circle is closed by its first point; a half one has its last point.
        let last = if sweep == TAU { steps as usize - 1 } else { steps as usize };
        for i in 0..=last {
            let point = center + Vec2::from_angle(from + sweep * i as f64 / steps) * radius;
            points.push(PointD { x: point.x, y: point.y });
        }
    }
    points
}
