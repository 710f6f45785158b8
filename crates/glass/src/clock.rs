//! Laser ticks: the laser fires at a constant rate, and a step to the next point costs whole ticks.

use crate::profile::{Limits, Profile};

/// Part of a tick that counts as no time: 0.1875 mm at 7.5 m/s² and 100 Hz is one tick, whatever the rounding.
const ROUNDING: f64 = 1e-9;

/// How many ticks a motion of `time` (s) takes at `rate` (Hz): one at least, since a point needs its pulse.
pub fn ticks(time: f64, rate: f64) -> u32 {
    (time * rate - ROUNDING).ceil().clamp(1.0, f64::from(u32::MAX)) as u32
}

/// The rate of a laser and three axes that move at the same time: a step takes as long as its slowest axis.
#[derive(Clone, Debug)]
pub struct Clock {
    /// Pulses of the laser, Hz.
    pub rate: f64,
    /// The speed profile of every axis.
    pub profile: Profile,
    /// X, Y and Z.
    pub limits: [Limits; 3],
    /// The farthest distances that each axis goes in 1, 2, … ticks, µm.
    reach: [Vec<i64>; 3],
}

/// How many ticks are looked up; longer steps are computed.
const LISTED: u32 = 64;

impl Clock {
    /// `rate` in Hz.
    pub fn new(rate: f64, profile: Profile, limits: [Limits; 3]) -> Clock {
        let reach = limits.map(|limits| {
            let reach = |n| profile.reach((f64::from(n) + ROUNDING) / rate, limits);
            (1..=LISTED).map(|n| (reach(n) * 1e3 + 1e-6).floor() as i64).collect()
        });
        Clock { rate, profile, limits, reach }
    }

    /// How far each axis goes in `ticks` (1 at least), µm.
    pub fn reach(&self, ticks: u32) -> [i64; 3] {
        let n = ticks.clamp(1, LISTED) as usize - 1;
        [0, 1, 2].map(|axis| self.reach[axis][n])
    }

    /// What a step costs whose axes go so far, µm.
    pub fn step(&self, from: [i32; 3], to: [i32; 3]) -> u32 {
        let cost = |axis: usize| self.axis(axis, i64::from(to[axis]) - i64::from(from[axis]));
        cost(0).max(cost(1)).max(cost(2))
    }

    fn axis(&self, axis: usize, way: i64) -> u32 {
        let way = way.abs();
        let reach = &self.reach[axis];
        if way <= reach[0] {
            return 1;
        }
        match reach.iter().position(|reach| way <= *reach) {
            Some(n) => n as u32 + 1,
            None => {
                let motion = self.profile.fastest(way as f64 * 1e-3, self.limits[axis]);
                ticks(motion.time, self.rate).max(LISTED + 1)
            }
        }
    }
}

/// The pump energy limits the rate of the laser: E·f must stay below 1000 W (spec 2.3). The rate that `energy` (J) must
/// stay below, Hz.
pub fn pump_limit(energy: f64) -> f64 {
    1000.0 / energy
}
