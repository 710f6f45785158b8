//! How long a machine takes for its motions.
//!
//! - A rapid takes as long as its slowest axis, each going from rest to rest with its acceleration up
//!   to its rapid (trapezoid), all at the same time.
//! - A cut takes its length at its feed, and no less than its fastest axis needs at its rapid. Corners
//!   are taken for free, as a control that looks ahead nearly does.
//! - A tool change takes [`TOOL_CHANGE`].

use crate::{LinearAxis, Machine};
use geom::Vec3;
use serde::Serialize;

/// Rapid of an axis of which the machine's file does not say it, mm/min.
const UNKNOWN_RAPID: f64 = 10_000.0;

/// A tool change, seconds: a common machining centre, chip to chip.
pub const TOOL_CHANGE: f64 = 6.0;

/// Seconds that a program takes, by what they are spent on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Times {
    /// Cutting moves.
    pub cutting: f64,
    /// Rapid moves.
    pub rapid: f64,
    /// Dwells.
    pub dwell: f64,
    /// Tool changes.
    pub tool_change: f64,
}

impl Times {
    /// All of them, seconds.
    pub fn total(&self) -> f64 {
        self.cutting + self.rapid + self.dwell + self.tool_change
    }
}

/// Rapid of an axis, mm/min.
#[inline]
fn rapid_of(axis: &LinearAxis) -> f64 {
    axis.rapid.unwrap_or(UNKNOWN_RAPID)
}

/// Seconds that a rapid takes in which the linear axes go so far, mm, and A, B and C turn by so many degrees: as the slowest axis, each
/// from rest to rest. What is not known (NaN) takes nothing.
pub fn rapid(machine: &Machine, way: Vec3, turn: [f64; 3]) -> f64 {
    each(machine, way, turn).fold(0.0, f64::max)
}

/// Seconds that each axis takes for it: X, Y, Z and the rotary axes of the file.
pub fn each(machine: &Machine, way: Vec3, turn: [f64; 3]) -> impl Iterator<Item = f64> {
    let linear = machine.linear.iter().zip(way.to_array()).map(|(axis, way)| {
        from_rest_to_rest(way, rapid_of(axis) / 60.0, axis.acceleration * 1000.0)
    });
    let rotary = machine.rotary.iter().map(move |axis| {
        from_rest_to_rest(turn[axis.index()], axis.rapid / 60.0, axis.acceleration)
    });
    linear.chain(rotary)
}

/// Seconds that a cut takes that takes so many at its feed: no less than each axis needs at its rapid. What is not known takes nothing.
#[inline]
pub fn cut(machine: &Machine, way: Vec3, turn: [f64; 3], at_feed: f64) -> f64 {
    // A feed that is missing makes no sensible time: what the axes need is left.
    let mut seconds = if at_feed.is_finite() { at_feed } else { 0.0 };
    // Few cuts are as fast as that: divisions are for these.
    let mut at_least = |way: f64, rapid: f64| {
        let minute = 60.0 * way.abs();
        if minute > seconds * rapid {
            seconds = minute / rapid;
        }
    };
    for (i, axis) in machine.linear.iter().enumerate() {
        at_least(way[i], rapid_of(axis));
    }
    for axis in &machine.rotary {
        at_least(turn[axis.index()], axis.rapid);
    }
    seconds
}

/// Seconds for the distance `way` with the speed (per s) and the acceleration (per s²) of an axis.
fn from_rest_to_rest(way: f64, speed: f64, acceleration: f64) -> f64 {
    let way = way.abs();
    if way >= speed * speed / acceleration {
        way / speed + speed / acceleration
    } else {
        2.0 * (way / acceleration).sqrt()
    }
}
