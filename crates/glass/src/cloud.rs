//! Clouds of points: whole µm in the frame of the block, their boxes, and the proof of their minimum distance.

use glam::DVec3;
use rayon::prelude::*;

/// A point, µm.
pub type Point = [i32; 3];

/// The point nearest to `place` (mm), or `None` beyond 2 m from the origin or where a coordinate is no number.
pub fn point(place: DVec3) -> Option<Point> {
    let micrometres = (place * 1e3).round();
    let fits = micrometres.is_finite() && micrometres.abs().max_element() <= 2e6;
    fits.then(|| micrometres.to_array().map(|value| value as i32))
}

/// Where a point is, mm.
pub fn place(point: Point) -> DVec3 {
    DVec3::from_array(point.map(f64::from)) * 1e-3
}

/// The square of the distance of two points, µm².
pub fn squared(a: Point, b: Point) -> i64 {
    let way = |axis: usize| i64::from(a[axis]) - i64::from(b[axis]);
    let [x, y, z] = [way(0), way(1), way(2)];
    x * x + y * y + z * z
}

/// The smallest box around points, µm; `None` of no points.
pub fn bounds(points: &[Point]) -> Option<(Point, Point)> {
    let join = |a: (Point, Point), b: (Point, Point)| {
        let axis = |f: fn(i32, i32) -> i32, a: Point, b: Point| [0, 1, 2].map(|i| f(a[i], b[i]));
        (axis(i32::min, a.0, b.0), axis(i32::max, a.1, b.1))
    };
    points.par_iter().map(|&point| (point, point)).reduce_with(join)
}

/// Points in cubes of equal size, sorted so that the points of a cube follow one another.
#[derive(Debug)]
pub struct Grid {
    /// Side of a cube, µm.
    side: i64,
    /// The corner of the first cube.
    low: Point,
    /// Cubes along X and Y.
    counts: [i64; 2],
    /// The cubes that hold points, in order, and where their points begin in `order`.
    cubes: Vec<(i64, u32)>,
    /// Numbers of points.
    order: Vec<u32>,
}

impl Grid {
    /// Cubes of `side` (µm, 1 at least) over `points`, of which there are fewer than 2³².
    pub fn new(points: &[Point], side: i64) -> Grid {
        let (low, high) = bounds(points).unwrap_or_default();
        let side = side.max(1);
        let count = |axis: usize| (i64::from(high[axis]) - i64::from(low[axis])) / side + 1;
        let mut grid =
            Grid { side, low, counts: [count(0), count(1)], cubes: vec![], order: vec![] };
        let number = |(i, &point)| (grid.key(grid.cell(point)), i as u32);
        let mut keyed: Vec<(i64, u32)> = points.par_iter().enumerate().map(number).collect();
        keyed.par_sort_unstable();
        for (at, &(key, _)) in keyed.iter().enumerate() {
            if grid.cubes.last().is_none_or(|(last, _)| *last != key) {
                grid.cubes.push((key, at as u32));
            }
        }
        grid.order = keyed.into_iter().map(|(_, i)| i).collect();
        grid
    }

    fn cell(&self, point: Point) -> [i64; 3] {
        [0, 1, 2]
            .map(|axis| (i64::from(point[axis]) - i64::from(self.low[axis])).div_euclid(self.side))
    }

    fn key(&self, cell: [i64; 3]) -> i64 {
        (cell[2] * self.counts[1] + cell[1]) * self.counts[0] + cell[0]
    }

    /// The points in the cubes whose numbers along X go from `x` to `x + 2` in one row: these are neighbours in the order.
    fn row(&self, x: i64, y: i64, z: i64) -> &[u32] {
        let (from, to) = (x.max(0), (x + 2).min(self.counts[0] - 1));
        if from > to || !(0..self.counts[1]).contains(&y) || z < 0 {
            return &[];
        }
        let start = |key: i64| {
            let at = self.cubes.partition_point(|(cube, _)| *cube < key);
            self.cubes.get(at).map_or(self.order.len(), |(_, start)| *start as usize)
        };
        &self.order[start(self.key([from, y, z]))..start(self.key([to, y, z]) + 1)]
    }

    /// Numbers of all points within one side of `point` along each axis, and some farther ones.
    pub fn near(&self, point: Point) -> impl Iterator<Item = u32> {
        let [x, y, z] = self.cell(point);
        let rows = (-1..=1).flat_map(move |dz| (-1..=1).map(move |dy| (y + dy, z + dz)));
        rows.flat_map(move |(y, z)| self.row(x - 1, y, z)).copied()
    }
}

/// Two points of a cloud, and their distance.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Pair {
    /// Numbers of the points, from 0; of a job in the order of its pulses.
    pub points: [u32; 2],
    /// Their distance, mm.
    pub distance: f64,
}

/// What was found about the minimum distance of a cloud.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Distances {
    /// The nearest two points; `None` where none are within a spacing, or there are fewer than two.
    pub nearest: Option<Pair>,
    /// How many pairs are nearer than the spacing.
    pub too_close: u64,
    /// How many points have a neighbour nearer than the spacing.
    pub crowded: u64,
}

/// Compares every pair of `points` with `spacing` (µm, more than 0): exact, in whole numbers. Pairs farther apart than the spacing
/// are looked at up to twice of it, to name the nearest.
pub fn distances(points: &[Point], spacing: i64) -> Distances {
    let grid = Grid::new(points, 2 * spacing.max(1));
    let least = spacing * spacing;
    let of = |(i, &here): (usize, &Point)| {
        let (mut nearest, mut close) = ((i64::MAX, 0, 0), 0u64);
        for j in grid.near(here) {
            if j as usize != i {
                let square = squared(here, points[j as usize]);
                let (a, b) = ((i as u32).min(j), (i as u32).max(j));
                nearest = nearest.min((square, a, b));
                close += u64::from(square < least);
            }
        }
        (nearest, close, u64::from(close > 0))
    };
    let join = |a: ((i64, u32, u32), u64, u64), b: ((i64, u32, u32), u64, u64)| {
        (a.0.min(b.0), a.1 + b.1, a.2 + b.2)
    };
    let none = || ((i64::MAX, 0, 0), 0, 0);
    let (nearest, close, crowded) = points.par_iter().enumerate().map(of).reduce(none, join);
    let pair = |(square, a, b): (i64, u32, u32)| Pair {
        points: [a, b],
        distance: (square as f64).sqrt() * 1e-3,
    };
    let nearest = (nearest.0 < i64::MAX).then(|| pair(nearest));
    Distances { nearest, too_close: close / 2, crowded }
}
