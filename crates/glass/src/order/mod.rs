//! The order in which points are made: legal under the shadow rule, and in as few laser ticks as can be found.
//!
//! [`fastest`] first goes from point to point greedily (`greedy`), then improves stretches of the order by exchanging and
//! turning pieces of it (`window`). [`kdz`] and [`layers`] are those of the source, which keep no shadow rule.
//! [`bound()`] says how few ticks any order can take. What is legal is found here for the planning; the proof finds it once more by itself.

mod bound;
mod greedy;
mod shadow;
mod sorted;
mod window;

pub use bound::{bound, bound_for};
pub use shadow::Shadow;
pub use sorted::{kdz, layers};

use crate::clock::Clock;
use crate::cloud::Point;
use crate::sample::Dice;
use crate::watch::Watch;
use rayon::prelude::*;
use std::time::Instant;
use window::Window;

/// Points in a stretch that is improved by itself.
const STRETCH: usize = 24_000;

/// The last round is the one that saves less than a tick for so many points: the next would save less still.
const ENOUGH: u64 = 200;

/// How hot each part of a stretch's improvement is, ticks.
const HEAT: [f64; 6] = [0.2, 0.16, 0.12, 0.08, 0.04, 0.0];

/// How much is tried.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// How often the whole order is improved, at most.
    pub rounds: u32,
    /// Changes tried in a round for each step that takes more than a tick.
    pub tries: u64,
    /// When to stop with the best so far; without, the result depends on nothing but the points.
    pub until: Option<Instant>,
}

impl Default for Effort {
    fn default() -> Effort {
        Effort { rounds: 4, tries: 10_000, until: None }
    }
}

/// A legal order of `points` (µm in the glass) at which the axes stand at `axes` (µm): numbers of points. It takes few ticks of
/// `clock`.
pub fn fastest(
    points: &[Point],
    axes: &[Point],
    shadow: Shadow,
    clock: &Clock,
    effort: Effort,
) -> Vec<u32> {
    fastest_for(points, axes, shadow, clock, effort, &())
}

/// As [`fastest`], for who may end the work: then it answers points of no use.
pub fn fastest_for(
    points: &[Point],
    axes: &[Point],
    shadow: Shadow,
    clock: &Clock,
    effort: Effort,
    watch: &dyn Watch,
) -> Vec<u32> {
    let mut order = greedy::order(points, axes, shadow, clock, watch);
    let is_over = || watch.is_ended() || effort.until.is_some_and(|until| Instant::now() >= until);
    let mut left = ticks(axes, &order, clock);
    for round in 0..effort.rounds {
        if is_over() {
            break;
        }
        let begun = left;
        // Every other round the stretches begin half a stretch later, so that what one round does not join the next one may.
        let shift = if round % 2 == 0 { 0 } else { STRETCH / 2 };
        let (head, rest) = order.split_at(shift.min(order.len()));
        let pieces: Vec<&[u32]> =
            std::iter::once(head).chain(rest.chunks(STRETCH)).filter(|p| !p.is_empty()).collect();
        let improved = |(at, piece): (usize, &&[u32])| {
            if is_over() {
                return piece.to_vec();
            }
            let end = |i: Option<&u32>| i.map(|&i| axes[i as usize]);
            let before = at.checked_sub(1).and_then(|before| end(pieces[before].last()));
            let after = pieces.get(at + 1).and_then(|after| end(after.first()));
            let own =
                |all: &[Point]| -> Vec<Point> { piece.iter().map(|&i| all[i as usize]).collect() };
            let mut window =
                Window::new(&own(points), &own(axes), [before, after], (shadow, clock), watch);
            let mut dice = Dice(u64::from(round) << 32 | at as u64);
            let begun = window.ticks();
            for heat in HEAT {
                let tries = effort.tries * window.slow() as u64 / HEAT.len() as u64;
                window.improve(tries, heat, &mut dice, &is_over);
            }
            match window.ticks() <= begun {
                true => window.order().iter().map(|&i| piece[i as usize]).collect(),
                false => piece.to_vec(),
            }
        };
        let improved: Vec<Vec<u32>> = pieces.par_iter().enumerate().map(improved).collect();
        order = improved.concat();
        left = ticks(axes, &order, clock);
        if (begun - left) * ENOUGH < points.len() as u64 {
            break;
        }
    }
    order
}

/// The ticks of all steps of an order: the first point's pulse is not counted.
pub fn ticks(axes: &[Point], order: &[u32], clock: &Clock) -> u64 {
    let step = |pair: &[u32]| u64::from(clock.step(axes[pair[0] as usize], axes[pair[1] as usize]));
    order.par_windows(2).map(step).sum()
}
