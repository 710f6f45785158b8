//! A cloud that nobody has: steps with a lognormal length, fitted to the experiment of the source.

use crate::profile::{Limits, Profile};

/// Lognormal lengths of steps.
#[derive(Clone, Copy, Debug)]
pub struct Surrogate {
    /// Median length, mm.
    pub median: f64,
    /// Standard deviation of ln(length).
    pub deviation: f64,
}

/// The one that fits the 53 rows of appendix F (spec 2.8).
pub const FITTED: Surrogate = Surrogate { median: 0.065, deviation: 1.06 };

impl Surrogate {
    /// Ticks per point at `rate` (Hz) with a triangle profile: the sum over n of P(length > reach in n ticks).
    pub fn ticks_per_point(self, rate: f64, limits: Limits) -> f64 {
        let longer = |ticks: u32| {
            let reach = Profile::Triangle.reach(f64::from(ticks) / rate, limits);
            upper_tail((reach / self.median).ln() / self.deviation)
        };
        let mut sum = 1.0;
        for ticks in 1..100_000 {
            let part = longer(ticks);
            sum += part;
            if part < 1e-12 {
                break;
            }
        }
        sum
    }
}

/// P(X > x) of a standard normal X, by the trapezium rule over the density: 1e-12 for |x| up to 8.
fn upper_tail(x: f64) -> f64 {
    if x < 0.0 {
        return 1.0 - upper_tail(-x);
    }
    // The density is smooth and vanishes with all derivatives at the far end; Simpson on 400 parts of 0.02.
    let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    let part = 0.02;
    let simpson = |i: u32| {
        let a = x + f64::from(i) * part;
        (density(a) + 4.0 * density(a + 0.5 * part) + density(a + part)) * part / 6.0
    };
    (0..400).map(simpson).sum()
}
