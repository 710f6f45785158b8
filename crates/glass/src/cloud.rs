//! Clouds of points: whole µm in the frame of the block, their boxes, and the proof of their minimum distance.

use geom::ending::{go_on, is_ended};
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

/// The axis along which points reach farthest.
pub fn longest(points: &[Point]) -> usize {
    let (low, high) = bounds(points).unwrap_or_default();
    let length = |axis: usize| i64::from(high[axis]) - i64::from(low[axis]);
    (0..3).max_by_key(|axis| length(*axis)).unwrap_or(2)
}

/// Points in cubes of equal size, sorted so that the points of a row of cubes along X follow one another.
#[derive(Debug)]
pub struct Grid {
    /// Side of a cube, µm.
    side: i64,
    /// The corner of the first cube.
    low: Point,
    /// Cubes along each axis.
    counts: [i64; 3],
    /// Numbers of points, row by row and from low to high X.
    order: Vec<u32>,
    /// Where the points of each cube are among them.
    cubes: Cubes,
}

/// Where the points of each cube begin.
#[derive(Debug)]
enum Cubes {
    /// Of every cube, and of one more.
    All(Vec<u32>),
    /// Of the rows that hold points, in order; and of each point the number of its cube along X.
    Rows(Vec<(i64, u32)>, Vec<u32>),
}

/// Cubes for each point up to which all of them are listed.
const LISTED: i64 = 4;

impl Grid {
    /// Cubes of `side` (µm, 1 at least) over `points`, of which there are fewer than 2³².
    pub fn new(points: &[Point], side: i64) -> Grid {
        let (low, high) = bounds(points).unwrap_or_default();
        let side = side.max(1);
        go_on();
        let counts =
            [0, 1, 2].map(|axis: usize| (i64::from(high[axis]) - i64::from(low[axis])) / side + 1);
        let none = Cubes::Rows(Vec::new(), Vec::new());
        let grid = Grid { side, low, counts, order: Vec::new(), cubes: none };
        let [x, y, z] = counts;
        let all = x.saturating_mul(y).saturating_mul(z);
        match all <= LISTED * points.len() as i64 {
            true => grid.with_all(points, all as usize),
            false => grid.with_rows(points),
        }
    }

    /// Lists all cubes: points are counted and then put where those of their cube begin.
    fn with_all(self, points: &[Point], all: usize) -> Grid {
        let of: Vec<u32> = points
            .par_iter()
            .map(|&point| {
                let [x, y, z] = self.cell(point);
                ((z * self.counts[1] + y) * self.counts[0] + x) as u32
            })
            .collect();
        // One place later than where each cube begins, so that it is there once its points are put.
        let mut starts = vec![0u32; all + 2];
        of.iter().for_each(|&cube| starts[cube as usize + 2] += 1);
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut order = vec![0; points.len()];
        for (i, &cube) in of.iter().enumerate() {
            let at = &mut starts[cube as usize + 1];
            order[*at as usize] = i as u32;
            *at += 1;
        }
        Grid { order, cubes: Cubes::All(starts), ..self }
    }

    /// Lists the rows that hold points.
    fn with_rows(self, points: &[Point]) -> Grid {
        let number = |(i, &point): (usize, &Point)| {
            let [x, y, z] = self.cell(point);
            (z * self.counts[1] + y, x as u32, i as u32)
        };
        let mut keyed: Vec<(i64, u32, u32)> = points.par_iter().enumerate().map(number).collect();
        keyed.par_sort_unstable();
        let mut rows: Vec<(i64, u32)> = Vec::new();
        for (at, &(row, _, _)) in keyed.iter().enumerate() {
            if rows.last().is_none_or(|(last, _)| *last != row) {
                rows.push((row, at as u32));
            }
        }
        let order = keyed.iter().map(|(_, _, i)| *i).collect();
        let along = keyed.into_iter().map(|(_, x, _)| x).collect();
        Grid { order, cubes: Cubes::Rows(rows, along), ..self }
    }

    fn cell(&self, point: Point) -> [i64; 3] {
        [0, 1, 2]
            .map(|axis| (i64::from(point[axis]) - i64::from(self.low[axis])).div_euclid(self.side))
    }

    /// The points in the cubes whose numbers along X go from `x` to `x + 2` in one row: these are neighbours in the order.
    fn row(&self, x: i64, y: i64, z: i64) -> &[u32] {
        let (from, to) = (x.max(0), (x + 2).min(self.counts[0] - 1));
        let inside = (0..self.counts[1]).contains(&y) && (0..self.counts[2]).contains(&z);
        if from > to || !inside {
            return &[];
        }
        let row = z * self.counts[1] + y;
        let (rows, along) = match &self.cubes {
            Cubes::All(starts) => {
                let first = row * self.counts[0];
                let start = |x: i64| starts[(first + x) as usize] as usize;
                return &self.order[start(from)..start(to + 1)];
            }
            Cubes::Rows(rows, along) => (rows, along),
        };
        let Ok(number) = rows.binary_search_by_key(&row, |(row, _)| *row) else {
            return &[];
        };
        let start = rows[number].1 as usize;
        let end = rows.get(number + 1).map_or(self.order.len(), |(_, end)| *end as usize);
        let along = &along[start..end];
        let first = along.partition_point(|cube| i64::from(*cube) < from);
        let beyond = along[first..].partition_point(|cube| i64::from(*cube) <= to);
        &self.order[start + first..start + first + beyond]
    }

    /// Numbers of all points within one side of `point` along each axis, and some farther ones.
    pub fn near(&self, point: Point) -> impl Iterator<Item = u32> {
        let [x, y, z] = self.cell(point);
        let rows = (-1..=1).flat_map(move |dz| (-1..=1).map(move |dy| (y + dy, z + dz)));
        rows.flat_map(move |(y, z)| self.row(x - 1, y, z)).copied()
    }
}

/// So many points are counted between two asks whether the work goes on.
const SOME: usize = 4096;

/// Points of a slab, at most.
const SLAB: usize = 1 << 20;

/// Points sorted along an axis, to be worked on slab by slab, so that only what belongs to a slab needs room.
///
/// **Border rule.** A slab is a part of the points in their order along the axis. Work on it sees, besides its own points, all points
/// that lie before or behind it by the reach of the work or less; what is found of a point belongs to the slab of the point. So the
/// result depends neither on where slabs begin nor on who works on which.
#[derive(Debug)]
pub struct Slabs {
    /// Numbers of the points, from low to high; where they are level, in their order.
    order: Vec<u32>,
    /// The lowest place, µm, and how many points lie lower than each µm from there on.
    low: i32,
    below: Vec<u32>,
}

impl Slabs {
    /// Of `count` points (fewer than 2³²); `at` says where each lies on the axis, µm within 2 m.
    pub fn new(count: usize, at: impl Fn(usize) -> i32 + Sync) -> Slabs {
        let range = (0..count).into_par_iter().map(|i| (at(i), at(i)));
        let range = range.reduce_with(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (low, high) = range.unwrap_or_default();
        let asked = |i: &usize| {
            if i.is_multiple_of(SOME) {
                go_on();
            }
        };
        let above = |i: usize| (i64::from(at(i)) - i64::from(low)) as usize;
        // Points are counted µm by µm and then put where theirs begin.
        let mut below = vec![0u32; (i64::from(high) - i64::from(low)) as usize + 2];
        for i in (0..count).inspect(asked) {
            below[above(i) + 1] += 1;
        }
        for i in 1..below.len() {
            below[i] += below[i - 1];
        }
        let mut next = below.clone();
        let mut order = vec![0; count];
        for i in (0..count).inspect(asked) {
            let place = &mut next[above(i)];
            order[*place as usize] = i as u32;
            *place += 1;
        }
        Slabs { order, low, below }
    }

    /// The numbers of all points, from low to high.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// The numbers of all points, slab by slab.
    pub fn each(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        self.order.chunks(SLAB)
    }

    /// The numbers of all points that lie from `low` to `high` (µm), both of which count.
    pub fn within(&self, low: i64, high: i64) -> &[u32] {
        let before = |place: i64| {
            let at = (place - i64::from(self.low)).clamp(0, self.below.len() as i64 - 1);
            self.below[at as usize] as usize
        };
        let (from, to) = (before(low), before(high.saturating_add(1)));
        &self.order[from..to.max(from)]
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
    let spacing = spacing.max(1);
    let near = distances_within(points, spacing, spacing + spacing / 4);
    match near.nearest {
        Some(_) => near,
        None => distances_within(points, spacing, 2 * spacing),
    }
}

/// As [`distances`]; pairs farther apart than `reach` (µm, more than the spacing) are not looked at.
fn distances_within(points: &[Point], spacing: i64, reach: i64) -> Distances {
    let (most, least) = (reach * reach, spacing * spacing);
    let axis = longest(points);
    let slabs = Slabs::new(points.len(), |i| points[i][axis]);
    type Found = ((i64, u32, u32), u64, u64);
    let join = |a: Found, b: Found| (a.0.min(b.0), a.1 + b.1, a.2 + b.2);
    let none = || ((i64::MAX, 0, 0), 0, 0);
    let at = |i: Option<&u32>| i.map_or(0, |&i| i64::from(points[i as usize][axis]));
    let of_slab = |slab: &[u32]| {
        let (low, high) = (at(slab.first()), at(slab.last()));
        let seen = in_order(slabs.within(low - reach, high + reach));
        let own: Vec<Point> = seen.iter().map(|&i| points[i as usize]).collect();
        let grid = Grid::new(&own, reach);
        let of = |&i: &u32| {
            if is_ended() {
                return none();
            }
            let here = points[i as usize];
            let (mut nearest, mut close) = ((i64::MAX, 0, 0), 0u64);
            for near in grid.near(here) {
                let square = squared(here, own[near as usize]);
                let j = seen[near as usize];
                if square <= most && j != i {
                    nearest = nearest.min((square, i.min(j), i.max(j)));
                    close += u64::from(square < least);
                }
            }
            (nearest, close, u64::from(close > 0))
        };
        let found = in_order(slab).par_iter().map(of).reduce(none, join);
        go_on();
        found
    };
    let (nearest, close, crowded) = slabs.each().map(of_slab).fold(none(), join);
    let pair = |(square, a, b): (i64, u32, u32)| Pair {
        points: [a, b],
        distance: (square as f64).sqrt() * 1e-3,
    };
    let nearest = (nearest.0 < i64::MAX).then(|| pair(nearest));
    Distances { nearest, too_close: close / 2, crowded }
}

/// The points of a slab in their own order: those of a program follow one another in space, so that work on them stays where it is.
pub(crate) fn in_order(slab: &[u32]) -> Vec<u32> {
    let mut own = slab.to_vec();
    own.sort_unstable();
    own
}
