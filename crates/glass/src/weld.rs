//! Points that are too close to others are left out.

use crate::cloud::{Grid, Point, Slabs, longest, squared};
use crate::sample::Apart;
use geom::ending::{go_on, is_ended};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;

/// The points of `points` that are at least `spacing` (µm) from all that are kept before them: slab by slab along the longest axis
/// of the cloud ([`Slabs`]), and within a slab in the order given.
pub fn welded(points: &[Point], spacing: u32) -> Vec<Point> {
    let spacing = i64::from(spacing.max(1));
    let axis = longest(points);
    let slabs = Slabs::new(points.len(), |i| points[i][axis]);
    let mut is_kept = vec![false; points.len()];
    for slab in slabs.each() {
        let mut kept = Kept::new(spacing);
        let low = slab.first().map_or(0, |&i| i64::from(points[i as usize][axis]));
        // What is kept so far lies in the slabs before.
        let border = slabs.within(low - spacing, low).iter().map(|&i| i as usize);
        border.filter(|&i| is_kept[i]).for_each(|i| kept.push(points[i]));
        let mut own = slab.to_vec();
        own.sort_unstable();
        for i in own.into_iter().map(|i| i as usize) {
            go_on();
            is_kept[i] = !kept.is_near(points[i]);
            if is_kept[i] {
                kept.push(points[i]);
            }
        }
    }
    points.iter().zip(is_kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}

/// Points that are kept. They are a spacing apart, so that a cube of that side holds few of them, however many are asked about.
pub(crate) struct Kept {
    spacing: i64,
    /// The last point of each cube, and of each point the one before it in its cube.
    cubes: HashMap<[i64; 3], u32>,
    points: Vec<(Point, Option<u32>)>,
}

impl Kept {
    /// None yet; `spacing` in µm.
    pub(crate) fn new(spacing: i64) -> Kept {
        Kept { spacing, cubes: HashMap::new(), points: Vec::new() }
    }

    fn cube(&self, point: Point) -> [i64; 3] {
        point.map(|value| i64::from(value).div_euclid(self.spacing))
    }

    pub(crate) fn push(&mut self, point: Point) {
        let number = self.points.len() as u32;
        let before = self.cubes.insert(self.cube(point), number);
        self.points.push((point, before));
    }

    pub(crate) fn is_near(&self, point: Point) -> bool {
        let [x, y, z] = self.cube(point);
        // The point's own cube first, which holds one most often.
        let way = |i: i64| [0, -1, 1][(i % 3) as usize];
        let cubes = (0..27).map(|i| [x + way(i), y + way(i / 3), z + way(i / 9)]);
        cubes.filter_map(|cube| self.cubes.get(&cube)).any(|&last| {
            let mut next = Some(last);
            while let Some(at) = next {
                let (other, before) = self.points[at as usize];
                if squared(point, other) < self.spacing * self.spacing {
                    return true;
                }
                next = before;
            }
            false
        })
    }
}

/// The points of `points` that are as far from all of `others` as `apart` says.
pub fn clear(points: &[Point], others: &[Point], apart: Apart) -> Vec<Point> {
    let reach = i64::from(apart.spacing) + apart.lost.ceil() as i64;
    let least = f64::from(apart.spacing).powi(2);
    let axis = longest(others);
    let (slabs, around) = (
        Slabs::new(points.len(), |i| points[i][axis]),
        Slabs::new(others.len(), |i| others[i][axis]),
    );
    let mut is_kept = vec![false; points.len()];
    for slab in slabs.each() {
        let at = |i: Option<&u32>| i.map_or(0, |&i| i64::from(points[i as usize][axis]));
        let seen = around.within(at(slab.first()) - reach, at(slab.last()) + reach);
        let own: Vec<Point> = seen.iter().map(|&i| others[i as usize]).collect();
        let grid = Grid::new(&own, reach);
        let is_clear = |&i: &u32| {
            if is_ended() {
                return (i, false);
            }
            let here = points[i as usize];
            let way = |near: u32| {
                let other = own[near as usize];
                DVec3::from_array([0, 1, 2].map(|axis| f64::from(here[axis] - other[axis])))
            };
            (i, grid.near(here).all(|near| apart.squared(way(near)) >= least))
        };
        let found: Vec<(u32, bool)> = slab.par_iter().map(is_clear).collect();
        go_on();
        found.into_iter().for_each(|(i, clear)| is_kept[i as usize] = clear);
    }
    points.iter().zip(is_kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}
