//! The first order: band by band from below, from each point to the best legal neighbour.

use super::shadow::{Bonds, Shadow};
use crate::clock::Clock;
use crate::cloud::{Point, Slabs};
use crate::watch::Watch;
use rayon::prelude::*;

/// Points in a band, at least. All of a band come before all of the band above it, so that only bonds within a band have to be known.
const BAND: usize = 40_000;

/// Points in a band, at most: their bonds are in memory, those of a band for each thread.
const MOST: usize = 1 << 20;

/// How many one-tick reaches of height count as much as one open neighbour: a sixth. Found by trying: 0.09 and 0.13 mm, three
/// bodies.
const HEIGHT: i64 = 6;

/// How many of the lowest legal points are looked at for the nearest one.
const FAR: usize = 400;

/// A legal order of `points` (µm in the glass) at which the axes stand at `axes` (µm). Each band begins at its lowest point, so that
/// bands do not wait for each other.
pub(super) fn order(
    points: &[Point],
    axes: &[Point],
    shadow: Shadow,
    clock: &Clock,
    watch: &dyn Watch,
) -> Vec<u32> {
    let by_height = Slabs::new(points.len(), |i| points[i][2]);
    let of_band = |band: &[u32]| -> Vec<u32> {
        let own = |all: &[Point]| -> Vec<Point> { band.iter().map(|&i| all[i as usize]).collect() };
        let axes = own(axes);
        let bonds = Bonds::new(&own(points), &axes, shadow, clock, watch);
        one_band(&axes, &bonds, clock, watch).into_iter().map(|i| band[i as usize]).collect()
    };
    // Half as much again as the axes go in a tick: a solid of 10 million points then uses 0.958 of the pulses, not 0.910; twice as
    // much gives 0.966 for twice the time.
    let bands = bands(by_height.order(), axes, clock.reach(1)[2] * 3 / 2);
    let ordered: Vec<Vec<u32>> = bands.into_par_iter().map(of_band).collect();
    ordered.concat()
}

/// The points, which come by their height, in bands of at least `least` steps of height, so that points have neighbours in their
/// own band; less where that would be too many points.
fn bands<'a>(by_height: &'a [u32], axes: &[Point], least: i64) -> Vec<&'a [u32]> {
    let mut bands = Vec::new();
    let mut left = by_height;
    while let Some(&lowest) = left.first() {
        let height =
            |i: &u32| i64::from(axes[*i as usize][2]) - i64::from(axes[lowest as usize][2]);
        let high = left.partition_point(|i| height(i) < least);
        let high = high.clamp(BAND, MOST);
        // Few points above would be far from each other.
        let is_last = left.len() < high + BAND / 2;
        let (band, above) = left.split_at(if is_last { left.len() } else { high });
        bands.push(band);
        left = above;
    }
    bands
}

/// The order of one band, whose points come by their height.
fn one_band(axes: &[Point], bonds: &Bonds, clock: &Clock, watch: &dyn Watch) -> Vec<u32> {
    let count = axes.len() as u32;
    let length = |list: &[u32]| list.len() as u32;
    let mut bound: Vec<u32> = (0..count).map(|i| length(bonds.before.of(i))).collect();
    let mut open: Vec<u32> = (0..count).map(|i| length(bonds.near.of(i))).collect();
    let height = |i: u32| axes[i as usize][2];
    let mut legal = Legal::new(axes.len());
    (0..count).filter(|&i| bound[i as usize] == 0).for_each(|i| legal.insert(i));
    let reach = clock.reach(1)[2].max(1);
    let mut order: Vec<u32> = Vec::with_capacity(axes.len());
    while let Some(lowest) = legal.lowest().filter(|_| !watch.is_ended()) {
        let near = order.last().map_or(&[][..], |&at| bonds.near.of(at)).iter().copied();
        // A point with few open neighbours is left behind if it is not taken now; a low one keeps those above it waiting.
        let value =
            |i: &u32| (reach * i64::from(open[*i as usize]) + HEIGHT * i64::from(height(*i)), *i);
        let next = near.filter(|&i| legal.has(i)).min_by_key(value);
        let next = next.unwrap_or_else(|| match order.last() {
            Some(&at) => legal.nearest(axes[at as usize], axes, clock),
            None => lowest,
        });
        legal.remove(next);
        order.push(next);
        bonds.near.of(next).iter().for_each(|&i| open[i as usize] -= 1);
        for &i in bonds.after.of(next) {
            bound[i as usize] -= 1;
            if bound[i as usize] == 0 {
                legal.insert(i);
            }
        }
    }
    order
}

/// Points that are not yet ordered and that nothing has to come before any more, a bit for each point of a band.
struct Legal {
    bits: Vec<u64>,
    /// The first word that is not empty, or an empty one before it.
    first: usize,
}

impl Legal {
    fn new(count: usize) -> Legal {
        Legal { bits: vec![0; count.div_ceil(64)], first: 0 }
    }

    fn has(&self, i: u32) -> bool {
        self.bits[i as usize / 64] >> (i % 64) & 1 == 1
    }

    fn insert(&mut self, i: u32) {
        self.bits[i as usize / 64] |= 1 << (i % 64);
        self.first = self.first.min(i as usize / 64);
    }

    fn remove(&mut self, i: u32) {
        self.bits[i as usize / 64] &= !(1 << (i % 64));
    }

    fn lowest(&mut self) -> Option<u32> {
        while *self.bits.get(self.first)? == 0 {
            self.first += 1;
        }
        Some(self.first as u32 * 64 + self.bits[self.first].trailing_zeros())
    }

    /// All of them from below.
    fn all(&self) -> impl Iterator<Item = u32> {
        let words = (self.first..).zip(&self.bits[self.first..]);
        words.flat_map(|(at, &word)| {
            let rest = |word: &u64| Some(word & (word - 1)).filter(|rest| *rest != 0);
            let words = std::iter::successors(Some(word).filter(|word| *word != 0), rest);
            words.map(move |word| at as u32 * 64 + word.trailing_zeros())
        })
    }

    /// The nearest of the lowest ones, of which there is one at least; none is within a tick.
    fn nearest(&self, from: Point, axes: &[Point], clock: &Clock) -> u32 {
        let mut best = (u32::MAX, 0);
        for i in self.all().take(FAR) {
            let cost = clock.step(from, axes[i as usize]);
            if cost < best.0 {
                best = (cost, i);
            }
            if cost <= 2 {
                break;
            }
        }
        best.1
    }
}
