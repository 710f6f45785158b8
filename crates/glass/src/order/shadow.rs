//! The shadow rule: a finished point scatters the beam that has to pass it, so what lies below in its cone comes first.

use crate::clock::Clock;
use crate::cloud::{Grid, Point, bounds};
use crate::watch::Watch;
use rayon::prelude::*;

/// The cone of the beam below a finished point: points are in its shadow that lie lower by `h` and nearer to its axis than
/// `radius + slope × h` (spec 4.9).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shadow {
    /// Tangent of the half angle of the beam in the glass.
    pub slope: f64,
    /// Radius of a point's crack, µm.
    pub radius: f64,
}

impl Shadow {
    /// Whether `below` lies in the shadow of `above`, so that it must come first.
    pub fn hides(&self, above: Point, below: Point) -> bool {
        let way = |axis: usize| f64::from(above[axis]) - f64::from(below[axis]);
        let height = way(2);
        let reach = self.radius + self.slope * height;
        height > 0.0 && way(0) * way(0) + way(1) * way(1) < reach * reach
    }
}

/// Which points are neighbours, and which bind each other.
pub(super) struct Bonds {
    /// For each point those that the axes reach in a tick.
    pub near: Lists,
    /// For each point those that must come before it.
    pub before: Lists,
    /// For each point those that must come after it.
    pub after: Lists,
}

impl Bonds {
    /// Of `points` (µm in the glass) at which the axes stand at `axes` (µm). Where the work is ended, some are missing.
    pub(super) fn new(
        points: &[Point],
        axes: &[Point],
        shadow: Shadow,
        clock: &Clock,
        watch: &dyn Watch,
    ) -> Bonds {
        let before = before(points, shadow, watch);
        let after = before.turned();
        Bonds { near: near(axes, clock, watch), before, after }
    }
}

/// For each point those that the axes reach in a tick.
fn near(axes: &[Point], clock: &Clock, watch: &dyn Watch) -> Lists {
    let reach = clock.reach(1);
    let grid = Grid::new(axes, reach[0].max(reach[1]).max(reach[2]));
    let of = |i: usize| {
        if watch.is_ended() {
            return Vec::new();
        }
        let within = |&j: &u32| j as usize != i && clock.step(axes[i], axes[j as usize]) == 1;
        grid.near(axes[i]).filter(within).collect()
    };
    Lists::new((0..axes.len()).into_par_iter().map(of).collect())
}

/// Lists of numbers, one for each point, in one piece of memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Lists {
    starts: Vec<u32>,
    all: Vec<u32>,
}

impl Lists {
    /// Of so many lists.
    fn new(lists: Vec<Vec<u32>>) -> Lists {
        let mut starts = Vec::with_capacity(lists.len() + 1);
        starts.push(0);
        let mut end = 0;
        starts.extend(lists.iter().map(|list| {
            end += list.len() as u32;
            end
        }));
        Lists { starts, all: lists.concat() }
    }

    /// The list of point `i`.
    pub(super) fn of(&self, i: u32) -> &[u32] {
        &self.all[self.starts[i as usize] as usize..self.starts[i as usize + 1] as usize]
    }

    /// For each point those whose lists name it.
    fn turned(&self) -> Lists {
        let count = self.starts.len().saturating_sub(1);
        let mut starts = vec![0u32; count + 1];
        self.all.iter().for_each(|&i| starts[i as usize + 1] += 1);
        for i in 0..count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut all = vec![0; self.all.len()];
        for i in 0..count as u32 {
            for &j in self.of(i) {
                all[next[j as usize] as usize] = i;
                next[j as usize] += 1;
            }
        }
        Lists { starts, all }
    }
}

/// For each of `points` those that must come before it. A point that must come before one of those anyway is left out where
/// that is found by looking at pairs: what follows from the lists together is the whole rule.
fn before(points: &[Point], shadow: Shadow, watch: &dyn Watch) -> Lists {
    let Some((low, high)) = bounds(points) else { return Lists::new(Vec::new()) };
    let deepest = f64::from(high[2]) - f64::from(low[2]);
    let widest = (shadow.radius + shadow.slope * deepest).ceil() as i64;
    // Columns: the points as seen along the beam.
    let flat: Vec<Point> = points.iter().map(|point| [point[0], point[1], 0]).collect();
    let grid = Grid::new(&flat, widest.max(1));
    let of = |i: usize| {
        if watch.is_ended() {
            return Vec::new();
        }
        let here = points[i];
        let mut below: Vec<u32> =
            grid.near(flat[i]).filter(|&j| shadow.hides(here, points[j as usize])).collect();
        below.sort_unstable_by_key(|&j| (-points[j as usize][2], j));
        let mut kept: Vec<u32> = Vec::new();
        for j in below {
            let there = points[j as usize];
            if !kept.iter().any(|&k| shadow.hides(points[k as usize], there)) {
                kept.push(j);
            }
        }
        kept
    };
    Lists::new((0..points.len()).into_par_iter().map(of).collect())
}
