//! Laser ticks: the laser fires at a constant rate, and a step to the next point costs whole ticks.

use crate::profile::{Limits, Profile};

/// Part of a tick that counts as no time: 0.1875 mm at 7.5 m/s² and 100 Hz is one tick, whatever the rounding.
const ROUNDING: f64 = 1e-9;

/// How many ticks a motion of `time` (s) takes at `rate` (Hz): one at least, since a point needs its pulse.
pub fn ticks(time: f64, rate: f64) -> u32 {
    (time * rate - ROUNDING).ceil().clamp(1.0, f64::from(u32::MAX)) as u32
}

/// The rate of a laser and three axes that move at the same time: a step takes as long as its slowest axis. Axes count in steps:
/// µm, or a fixed part of a degree.
#[derive(Clone, Debug)]
pub struct Clock {
    /// Pulses of the laser, Hz.
    pub rate: f64,
    /// The speed profile of every axis.
    pub profile: Profile,
    /// Of each axis what it can do (mm or degrees), its steps in a mm or degree, and in a turn where it turns on and on.
    axes: [(Limits, f64, Option<i64>); 3],
    /// The farthest distances that each axis goes in 1, 2, … ticks, steps.
    reach: [Vec<i64>; 3],
}

/// How many ticks are looked up; longer steps are computed.
const LISTED: u32 = 64;

impl Clock {
    /// Of three axes in µm; `rate` in Hz.
    pub fn new(rate: f64, profile: Profile, limits: [Limits; 3]) -> Clock {
        Clock::of(rate, profile, limits.map(|limits| (limits, 1e3, None)))
    }

    /// Of axes whose limits (mm or degrees), steps in a mm or degree, and steps in a turn, where they turn on and on, are given.
    pub fn of(rate: f64, profile: Profile, axes: [(Limits, f64, Option<i64>); 3]) -> Clock {
        let reach = axes.map(|(limits, steps, _)| {
            let reach = |n| profile.reach((f64::from(n) + ROUNDING) / rate, limits);
            (1..=LISTED).map(|n| (reach(n) * steps + 1e-6).floor() as i64).collect()
        });
        Clock { rate, profile, axes, reach }
    }

    /// The ticks from a place where the axes pass at the speed `leaves` to one that they pass at the speed `enters`, both in steps
    /// for each tick, and all in steps: they brake, go from rest to rest, and gain speed again.
    pub fn between(&self, way: [f64; 3], leaves: [f64; 3], enters: [f64; 3]) -> u64 {
        let (braking, braked) = self.gained(leaves);
        let (gaining, gained) = self.gained(enters);
        let mut time: f64 = 0.0;
        for axis in 0..3 {
            let (limits, steps, turn) = self.axes[axis];
            let way = shortest(way[axis], turn) - braked[axis] - gained[axis];
            let length = shortest(way, turn).abs() / steps;
            time = time.max(self.profile.fastest(length, limits).time);
        }
        u64::from(ticks(braking + time + gaining, self.rate))
    }

    /// The time (s) in which the axes gain a speed (steps for each tick) from rest, and how far each goes meanwhile, steps.
    pub fn gained(&self, speed: [f64; 3]) -> (f64, [f64; 3]) {
        let mut time: f64 = 0.0;
        for (speed, (limits, steps, _)) in speed.into_iter().zip(self.axes) {
            time = time.max(speed.abs() * self.rate / steps / limits.acceleration);
        }
        (time, speed.map(|speed| 0.5 * speed * self.rate * time))
    }

    /// How many ticks a motion at `speed` (steps for each tick) takes for a way of so many steps.
    pub fn passed(&self, way: [f64; 3], speed: [f64; 3]) -> u64 {
        let fastest =
            (0..3).max_by(|a, b| speed[*a].abs().total_cmp(&speed[*b].abs())).unwrap_or(0);
        let (way, speed) = (way[fastest], speed[fastest]);
        let way = match self.axes[fastest].2 {
            Some(turn) if speed < 0.0 => -(-way).rem_euclid(turn as f64),
            Some(turn) => way.rem_euclid(turn as f64),
            None => way,
        };
        (way / speed).round().max(1.0) as u64
    }

    /// Whether no axis is faster than it can be at a speed in steps for each tick.
    pub fn allows(&self, speed: [f64; 3]) -> bool {
        let within = |(speed, (limits, steps, _)): (f64, (Limits, f64, Option<i64>))| {
            speed.abs() * self.rate / steps <= limits.speed * (1.0 + ROUNDING)
        };
        speed.into_iter().zip(self.axes).all(within)
    }

    /// How far each axis goes in `ticks` (1 at least), steps.
    pub fn reach(&self, ticks: u32) -> [i64; 3] {
        let n = ticks.clamp(1, LISTED) as usize - 1;
        [0, 1, 2].map(|axis| self.reach[axis][n])
    }

    /// What a step costs between two places, steps.
    pub fn step(&self, from: [i32; 3], to: [i32; 3]) -> u32 {
        let cost = |axis: usize| self.axis(axis, i64::from(to[axis]) - i64::from(from[axis]));
        cost(0).max(cost(1)).max(cost(2))
    }

    fn axis(&self, axis: usize, way: i64) -> u32 {
        let (limits, steps, turn) = self.axes[axis];
        let way = match turn {
            Some(turn) => {
                let way = way.rem_euclid(turn);
                way.min(turn - way)
            }
            None => way.abs(),
        };
        let reach = &self.reach[axis];
        if way <= reach[0] {
            return 1;
        }
        match reach.iter().position(|reach| way <= *reach) {
            Some(n) => n as u32 + 1,
            None => {
                let motion = self.profile.fastest(way as f64 / steps, limits);
                ticks(motion.time, self.rate).max(LISTED + 1)
            }
        }
    }
}

/// The shortest way of an axis, which may turn on and on.
fn shortest(way: f64, turn: Option<i64>) -> f64 {
    match turn {
        Some(turn) => {
            let turn = turn as f64;
            way - turn * (way / turn).round()
        }
        None => way,
    }
}

/// The pump energy limits the rate of the laser: E·f must stay below 1000 W (spec 2.3). The rate that `energy` (J) must
/// stay below, Hz.
pub fn pump_limit(energy: f64) -> f64 {
    1000.0 / energy
}
