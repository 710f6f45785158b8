//! Pulses in motion: runs of points that the axes pass one a tick at constant speed, and what that saves (spec 4.12).
//!
//! From rest to rest a step takes a tick only as far as the acceleration reaches; at constant speed it takes one however far
//! the points are apart, up to the speed limit. The trigger leads by what the axes go until the laser fires.

use crate::clock::Clock;
use crate::cloud::Point;

/// A run of pulses in motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Its first pulse, from 0.
    pub first: usize,
    /// How many there are.
    pub count: usize,
    /// How far each axis goes in a tick, steps.
    pub speed: [f64; 3],
}

/// The fewest pulses of a run.
const FEWEST: usize = 3;

/// By how much a pulse may miss its point, steps.
const MISSED: f64 = 0.5;

/// The longest run that begins at `first`: points that one speed passes a tick after the other.
fn longest(axes: &[Point], first: usize, clock: &Clock) -> Option<Run> {
    let mut range = [(f64::MIN, f64::MAX); 3];
    let mut count = 1;
    for (ticks, at) in axes[first + 1..].iter().enumerate().map(|(i, at)| (i as f64 + 1.0, at)) {
        let mut next = range;
        for axis in 0..3 {
            let way = f64::from(at[axis]) - f64::from(axes[first][axis]);
            let (low, high) = next[axis];
            next[axis] = (low.max((way - MISSED) / ticks), high.min((way + MISSED) / ticks));
        }
        if next.iter().any(|(low, high)| low > high) {
            break;
        }
        range = next;
        count += 1;
    }
    let speed = range.map(|(low, high)| 0.5 * (low + high));
    let moves = speed.iter().any(|speed| speed.abs() >= 1.0);
    (count >= FEWEST && moves && clock.allows(speed)).then_some(Run { first, count, speed })
}

/// The runs of an order at which the axes stand at `axes`, where they save ticks; `steps` are those of a mm or degree of each axis, and
/// the trigger leads by `late` ticks.
pub fn runs(axes: &[Point], steps: [f64; 3], late: f64, clock: &Clock) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut at = 0;
    while at + FEWEST <= axes.len() {
        let Some(mut run) = longest(axes, at, clock) else {
            at += 1;
            continue;
        };
        run.speed = stated(run.speed, steps);
        let last = runs.last().filter(|before| before.first + before.count == at).copied();
        let part = &axes[at.saturating_sub(1)..(at + run.count + 1).min(axes.len())];
        let own = Run { first: at - at.saturating_sub(1), ..run };
        let before = last.map_or([0.0; 3], |last| last.speed);
        if ticks(part, &[own], before, late, clock) < ticks(part, &[], before, late, clock) {
            at += run.count;
            runs.push(run);
        } else {
            // What the run would not save, a part of it does not either.
            at += run.count - 1;
        }
    }
    runs
}

/// The ticks of all steps of an order with its `runs`; the first place is passed at the speed `before`. A run's trigger leads by
/// `late` ticks, and its motion is that of its first place and its speed, as a program has them.
pub fn ticks(axes: &[Point], runs: &[Run], before: [f64; 3], late: f64, clock: &Clock) -> u64 {
    let led = |at: usize, speed: [f64; 3]| {
        [0, 1, 2].map(|axis| (f64::from(axes[at][axis]) - speed[axis] * late).round())
    };
    let mut runs = runs.iter().peekable();
    let mut sum = 0;
    let mut leaves = before;
    let mut place = axes.first().map_or([0.0; 3], |at| at.map(f64::from));
    let mut moving: Option<Run> = None;
    for at in 0..axes.len() {
        if let Some(run) = moving.filter(|run| at < run.first + run.count) {
            let passed = clock.passed(way(axes[at - 1], axes[at]), run.speed);
            sum += passed;
            place = [0, 1, 2].map(|axis| place[axis] + run.speed[axis] * passed as f64);
            continue;
        }
        moving = runs.next_if(|run| run.first == at).copied();
        let enters = moving.map_or([0.0; 3], |run| run.speed);
        let to = led(at, enters);
        if at > 0 {
            sum += match leaves == [0.0; 3] && enters == [0.0; 3] {
                true => u64::from(clock.step(axes[at - 1], axes[at])),
                false => {
                    let way = [0, 1, 2].map(|axis| to[axis] - place[axis].round());
                    clock.between(way, leaves, enters)
                }
            };
        }
        (leaves, place) = (enters, to);
    }
    sum
}

fn way(from: Point, to: Point) -> [f64; 3] {
    [0, 1, 2].map(|axis| f64::from(to[axis]) - f64::from(from[axis]))
}

/// A speed in steps for each tick as a program can say it: nine decimals of a mm or degree.
pub fn stated(speed: [f64; 3], steps: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| (speed[axis] / steps[axis] * 1e9).round() / 1e9 * steps[axis])
}
