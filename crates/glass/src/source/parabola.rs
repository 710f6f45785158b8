//! Motion along a parabola, the worked example of the source (spec 2.10): x3 = h − k (x5 − b)², at a given speed.

/// The parabola, and the linear dynamics of its two axes: x3'' = damping·x3' + gain·u, and the same of x5.
#[derive(Clone, Copy, Debug)]
pub struct Parabola {
    /// k, 1/m.
    pub curvature: f64,
    /// b, m: half of its width.
    pub half_width: f64,
    /// α of x3 and x5, 1/s.
    pub damping: [f64; 2],
    /// β of x3 and x5.
    pub gain: [f64; 2],
}

impl Parabola {
    /// dx3/dx5 with its sign turned, at x5.
    fn slope(&self, x5: f64) -> f64 {
        2.0 * self.curvature * (x5 - self.half_width)
    }

    /// Its length from end to end, m.
    pub fn length(&self) -> f64 {
        let q = 2.0 * self.half_width * self.curvature;
        let root = (1.0 + q * q).sqrt();
        (q * root + (q + root).ln()) / (2.0 * self.curvature)
    }

    /// Speed of x5 and accelerations of x3 and x5 at the path speed `v` (m/s), which grows by `growth` (m/s²).
    fn motion(&self, x5: f64, v: f64, growth: f64) -> (f64, [f64; 2]) {
        let q = self.slope(x5);
        let steep = 1.0 + q * q;
        let x6 = v / steep.sqrt();
        let growth5 = growth / steep.sqrt() - 2.0 * self.curvature * q * v * v / (steep * steep);
        (x6, [-2.0 * self.curvature * x6 * x6 - q * growth5, growth5])
    }

    /// The controls of x3 and x5 that keep the path at x5 with the path speed `v` (m/s) and its growth (m/s²).
    pub fn controls(&self, x5: f64, v: f64, growth: f64) -> [f64; 2] {
        let (x6, accelerations) = self.motion(x5, v, growth);
        let speeds = [-self.slope(x5) * x6, x6];
        [0, 1].map(|i| (accelerations[i] - self.damping[i] * speeds[i]) / self.gain[i])
    }

    /// Runs it from end to end at a constant path speed `v` (m/s) by Runge and Kutta with steps of `step` (s): the time that
    /// it takes, s, and the largest distance of x3 from the path, m.
    pub fn run(&self, v: f64, step: f64) -> (f64, f64) {
        let top = self.curvature * self.half_width * self.half_width;
        let on_path = |x5: f64| top - self.curvature * (x5 - self.half_width).powi(2);
        // The state is x3, x3', x5, x5'; the controls are those of the place that x5 has reached.
        let rates = |s: [f64; 4]| {
            let u = self.controls(s[2], v, 0.0);
            let pull = |i: usize, speed: f64| self.damping[i] * speed + self.gain[i] * u[i];
            [s[1], pull(0, s[1]), s[3], pull(1, s[3])]
        };
        let along = |s: [f64; 4], r: [f64; 4], t: f64| [0, 1, 2, 3].map(|i| s[i] + t * r[i]);
        let (start, _) = self.motion(0.0, v, 0.0);
        let mut state = [0.0, -self.slope(0.0) * start, 0.0, start];
        let (mut time, mut worst) = (0.0, 0.0f64);
        let end = 2.0 * self.half_width;
        while state[2] < end && time < 1e3 {
            let a = rates(state);
            let b = rates(along(state, a, 0.5 * step));
            let c = rates(along(state, b, 0.5 * step));
            let d = rates(along(state, c, step));
            let mean = [0, 1, 2, 3].map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0);
            let next = along(state, mean, step);
            // The last step counts as far as it goes to the end.
            let part = if next[2] > end { (end - state[2]) / (next[2] - state[2]) } else { 1.0 };
            (time, state) = (time + part * step, next);
            worst = worst.max((state[0] - on_path(state[2])).abs());
        }
        (time, worst)
    }
}
