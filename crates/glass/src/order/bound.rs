//! How few ticks any order can take: the bound of an assignment.
//!
//! In an order each point but the last is followed by one point, and each but the first follows one. Without regard to whether such
//! pairs join to a single order, the most pairs that are a tick apart are a maximum matching (Hopcroft and Karp) of points as those
//! that are followed and points as those that follow. All other steps take two ticks at least. Under the shadow rule a pair counts
//! only where the second point need not come before the first, and none is known that must come between them.
//!
//! Points that are followed are matched in pieces by themselves, each with all points that may follow: what pieces take twice
//! makes the bound lower, never too high.

use super::Shadow;
use crate::clock::Clock;
use crate::cloud::{Grid, Point, Slabs};
use crate::watch::Watch;
use rayon::prelude::*;

/// Points of a piece.
const PIECE: usize = 40_000;

/// No partner.
const NONE: u32 = u32::MAX;

/// The fewest ticks that the steps of any order of `points` (µm in the glass) take, at which the axes stand at `axes`: of those that
/// keep the rule of `shadow`, or of all.
pub fn bound(points: &[Point], axes: &[Point], shadow: Option<Shadow>, clock: &Clock) -> u64 {
    bound_for(points, axes, shadow, clock, &())
}

/// As [`bound()`], for who may end the work: then it answers a number of no use.
pub fn bound_for(
    points: &[Point],
    axes: &[Point],
    shadow: Option<Shadow>,
    clock: &Clock,
    watch: &dyn Watch,
) -> u64 {
    let reach = clock.reach(1);
    let grid = Grid::new(axes, reach[0].max(reach[1]).max(reach[2]));
    let by_height = Slabs::new(points.len(), |i| points[i][2]);
    let matched = |piece: &[u32]| {
        let goes_on = |_: &&u32| !watch.is_ended();
        let followers = |&u: &u32| followers(u, points, axes, shadow, clock, &grid);
        let partners: Vec<_> = piece.iter().take_while(goes_on).map(followers).collect();
        matching(&partners, watch)
    };
    let pieces: Vec<&[u32]> = by_height.order().chunks(PIECE).collect();
    let matched: u64 = pieces.into_par_iter().map(matched).sum();
    let steps = (points.len() as u64).saturating_sub(1);
    steps + steps.saturating_sub(matched)
}

/// The points that may follow point `u` within a tick.
fn followers(
    u: u32,
    points: &[Point],
    axes: &[Point],
    shadow: Option<Shadow>,
    clock: &Clock,
    grid: &Grid,
) -> Vec<u32> {
    let at = |i: u32| points[i as usize];
    let within = |&v: &u32| v != u && clock.step(axes[u as usize], axes[v as usize]) == 1;
    let near: Vec<u32> = grid.near(axes[u as usize]).filter(within).collect();
    let Some(shadow) = shadow else { return near };
    let above: Vec<u32> = near.iter().copied().filter(|&w| shadow.hides(at(w), at(u))).collect();
    let is_barred = |v: &u32| {
        // Where `v` is above `u`, all that is above `u` and below `v` comes between them.
        let is_between = |&w: &u32| w != *v && shadow.hides(at(*v), at(w));
        shadow.hides(at(u), at(*v)) || (shadow.hides(at(*v), at(u)) && above.iter().any(is_between))
    };
    near.into_iter().filter(|v| !is_barred(v)).collect()
}

/// The size of a maximum matching: of each number on one side its possible partners on the other.
fn matching(partners: &[Vec<u32>], watch: &dyn Watch) -> u64 {
    let mut names: Vec<u32> = partners.iter().flatten().copied().collect();
    names.sort_unstable();
    names.dedup();
    let number = |name: &u32| names.partition_point(|own| own < name) as u32;
    let partners: Vec<Vec<u32>> =
        partners.iter().map(|own| own.iter().map(number).collect()).collect();
    let mut of_left = vec![NONE; partners.len()];
    let mut of_right = vec![NONE; names.len()];
    // Most find a partner at once.
    for (left, own) in partners.iter().enumerate() {
        if let Some(&right) = own.iter().find(|&&right| of_right[right as usize] == NONE) {
            of_left[left] = right;
            of_right[right as usize] = left as u32;
        }
    }
    let mut layer = vec![0; partners.len()];
    while !watch.is_ended() && layered(&partners, &of_left, &of_right, &mut layer) {
        let mut tried = vec![0; partners.len()];
        for left in 0..partners.len() {
            if of_left[left] == NONE {
                augment(left, &partners, &mut of_left, &mut of_right, &mut layer, &mut tried);
            }
        }
    }
    of_left.iter().filter(|right| **right != NONE).count() as u64
}

/// How many pairs each number on the left is away from one that has no partner; answers whether a way ends at a free one on the right.
fn layered(partners: &[Vec<u32>], of_left: &[u32], of_right: &[u32], layer: &mut [u32]) -> bool {
    layer.fill(NONE);
    let mut queue: Vec<u32> =
        (0..partners.len() as u32).filter(|&left| of_left[left as usize] == NONE).collect();
    queue.iter().for_each(|&left| layer[left as usize] = 0);
    let (mut next, mut is_open) = (0, false);
    while let Some(&left) = queue.get(next) {
        next += 1;
        for &right in &partners[left as usize] {
            match of_right[right as usize] {
                NONE => is_open = true,
                other if layer[other as usize] == NONE => {
                    layer[other as usize] = layer[left as usize] + 1;
                    queue.push(other);
                }
                _ => {}
            }
        }
    }
    is_open
}

/// Looks for a way from `start` along the layers to a free number on the right, and exchanges the pairs on it.
fn augment(
    start: usize,
    partners: &[Vec<u32>],
    of_left: &mut [u32],
    of_right: &mut [u32],
    layer: &mut [u32],
    tried: &mut [usize],
) {
    let mut way = vec![start];
    while let Some(&left) = way.last() {
        let Some(&right) = partners[left].get(tried[left]) else {
            layer[left] = NONE;
            way.pop();
            continue;
        };
        tried[left] += 1;
        match of_right[right as usize] {
            NONE => {
                for &left in &way {
                    let right = partners[left][tried[left] - 1];
                    of_left[left] = right;
                    of_right[right as usize] = left as u32;
                }
                return;
            }
            other if layer[other as usize] == layer[left] + 1 => way.push(other as usize),
            _ => {}
        }
    }
}
