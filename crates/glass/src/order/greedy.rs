//! The first order: band by band from below, from each point to the best legal neighbour.

use super::shadow::{Bonds, Shadow};
use crate::clock::Clock;
use crate::cloud::{Point, Slabs};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Points in a band. All of a band come before all of the band above it, so that only bonds within a band have to be known.
const BAND: usize = 40_000;

/// How many bands are looked at together: their bonds are in memory at the same time.
const TOGETHER: usize = 16;

/// How many one-tick reaches of height count as much as one open neighbour: a sixth. Found by trying: 0.09 and 0.13 mm, three
/// bodies.
const HEIGHT: i64 = 6;

/// How many of the lowest legal points are looked at for the nearest one.
const FAR: usize = 400;

/// A legal order of `points` (µm in the glass) at which the axes stand at `axes` (µm).
pub(super) fn order(points: &[Point], axes: &[Point], shadow: Shadow, clock: &Clock) -> Vec<u32> {
    let by_height = Slabs::new(points.len(), |i| points[i][2]);
    let bands: Vec<&[u32]> = by_height.order().chunks(BAND).collect();
    let mut order = Vec::with_capacity(points.len());
    let mut at = None;
    for bands in bands.chunks(TOGETHER) {
        let bond = |band: &&[u32]| {
            let own =
                |all: &[Point]| -> Vec<Point> { band.iter().map(|&i| all[i as usize]).collect() };
            let axes = own(axes);
            let bonds = Bonds::new(&own(points), &axes, shadow, clock);
            (axes, bonds)
        };
        let bonds: Vec<_> = bands.par_iter().map(bond).collect();
        for (band, (axes, bonds)) in bands.iter().zip(&bonds) {
            let ordered = one_band(axes, bonds, at, clock);
            at = ordered.last().map(|&i| axes[i as usize]).or(at);
            order.extend(ordered.into_iter().map(|i| band[i as usize]));
        }
    }
    order
}

/// The order of one band, begun near `start`.
fn one_band(axes: &[Point], bonds: &Bonds, start: Option<Point>, clock: &Clock) -> Vec<u32> {
    let count = axes.len() as u32;
    let length = |list: &[u32]| list.len() as u32;
    let mut bound: Vec<u32> = (0..count).map(|i| length(bonds.before.of(i))).collect();
    let mut open: Vec<u32> = (0..count).map(|i| length(bonds.near.of(i))).collect();
    let height = |i: u32| axes[i as usize][2];
    // Points that are not yet ordered and that nothing has to come before any more, lowest first.
    let unbound = (0..count).filter(|&i| bound[i as usize] == 0);
    let mut legal: BTreeSet<(i32, u32)> = unbound.map(|i| (height(i), i)).collect();
    let reach = clock.reach(1)[2].max(1);
    let mut order: Vec<u32> = Vec::with_capacity(axes.len());
    while let Some(&(_, lowest)) = legal.first() {
        let near = order.last().map_or(&[][..], |&at| bonds.near.of(at)).iter().copied();
        // A point with few open neighbours is left behind if it is not taken now; a low one keeps those above it waiting.
        let value =
            |i: &u32| (reach * i64::from(open[*i as usize]) + HEIGHT * i64::from(height(*i)), *i);
        let next = near.filter(|&i| legal.contains(&(height(i), i))).min_by_key(value);
        let from = order.last().map(|&at| axes[at as usize]).or(start);
        let next = next.unwrap_or_else(|| {
            let cost =
                |from| move |&(z, i): &(i32, u32)| (clock.step(from, axes[i as usize]), z, i);
            let nearest = from.and_then(|from| legal.iter().take(FAR).map(cost(from)).min());
            nearest.map_or(lowest, |(_, _, i)| i)
        });
        legal.remove(&(height(next), next));
        order.push(next);
        bonds.near.of(next).iter().for_each(|&i| open[i as usize] -= 1);
        for &i in bonds.after.of(next) {
            bound[i as usize] -= 1;
            if bound[i as usize] == 0 {
                legal.insert((height(i), i));
            }
        }
    }
    order
}
