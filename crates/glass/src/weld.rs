//! Points of lists that are too close to others are left out.

use crate::cloud::{Grid, Point, squared};

/// The points of `points` that are at least `spacing` (µm) from all that are kept before them.
pub fn welded(points: &[Point], spacing: u32) -> Vec<Point> {
    let spacing = i64::from(spacing);
    let grid = Grid::new(points, spacing);
    let mut kept = vec![false; points.len()];
    for (i, &here) in points.iter().enumerate() {
        let close = |j: u32| {
            (j as usize) < i
                && kept[j as usize]
                && squared(here, points[j as usize]) < spacing * spacing
        };
        kept[i] = !grid.near(here).any(close);
    }
    points.iter().zip(kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}
