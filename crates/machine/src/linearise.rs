//! Straight lines of the tool tip on a machine that only knows its axes.
//!
//! Without tool-centre control every axis moves in proportion to the others, so that the tip
//! follows a curve where a rotary axis turns. Points are added on the commanded line until it leaves
//! that line by no more than a tolerance. The rotary axes turn evenly from end to end, so the points
//! change nothing in the orientations that are passed through.
//!
//! How many points that takes is a bound, not a trial. The linear positions that would keep the tip on
//! the line are a curve L(s), s from 0 to 1; a table and a head only turn what they carry, so the tip
//! is off the line by exactly what the axes, going straight, are off L. A chord of n of L is off by
//! |L″| / 8n² at most, and |L″| is bounded by how far the axes turn, how far from them the tip is, and
//! how far it goes.

use crate::{Machine, Mount, RotaryAxis};
use geom::Vec3;
use program::{Diagnostic, Rule};

/// Tool tip and rotary positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotaryPose {
    /// Tool tip, mm, work frame.
    pub tip: Vec3,
    /// Degrees of A, B, C.
    pub degrees: [f64; 3],
}

/// The most points for one line. More than that is a tolerance or a move that cannot be meant.
pub const MAX_POINTS: usize = 100_000;

impl Machine {
    /// The points of the line between two stances through which the axes must go, so that a tool of
    /// `tool_length` mm leaves it by at most `tolerance` mm; without the first, with the last.
    ///
    /// # Errors
    /// `linearisation` where it takes more than [`MAX_POINTS`], or a number is not finite.
    pub fn linearise(
        &self,
        from: RotaryPose,
        to: RotaryPose,
        tool_length: Option<f64>,
        tolerance: f64,
    ) -> Result<impl ExactSizeIterator<Item = RotaryPose> + use<>, Box<Diagnostic>> {
        let chords = (self.bend(&from, &to, tool_length) / (8.0 * tolerance)).sqrt().ceil();
        let sound = chords <= MAX_POINTS as f64 && to.tip.is_finite();
        if !sound {
            let message =
                format!("keeping the tool tip within {tolerance} mm takes {chords} points");
            return Err(Diagnostic::error(Rule::Linearisation, message)
                .help("allow a larger tolerance, or split the move in the source")
                .into());
        }
        let count = (chords as usize).max(1);
        let point = move |i| if i == count { to } else { from.toward(&to, i, count) };
        Ok((0..count).map(move |i| point(i + 1)))
    }

    /// A bound of |L″|, mm, for the whole move.
    fn bend(&self, from: &RotaryPose, to: &RotaryPose, tool_length: Option<f64>) -> f64 {
        let zero = self.work_zero.unwrap_or(Vec3::ZERO);
        let hanging = Vec3::new(0.0, 0.0, -tool_length.unwrap_or(0.0));
        let path = [from.tip + zero, to.tip + zero];
        self.bend_of(Mount::Table, path, from, to)
            + self.bend_of(Mount::Head, [hanging; 2], from, to)
    }

    /// The same for what one side carries along the straight `path`.
    ///
    /// With an outer rotation R₁ about c₁, an inner one R₂ about c₂, and p on the path, it comes to
    /// R₁ R₂ (p − c₂) + R₁ (c₂ − c₁) + c₁. Each prime on a rotation is a factor of its angle, and takes
    /// what stands along its axis out of what it turns; p″ is zero.
    fn bend_of(&self, mount: Mount, path: [Vec3; 2], from: &RotaryPose, to: &RotaryPose) -> f64 {
        let mut side = self.rotary.iter().filter(|axis| axis.on == mount);
        let angle = |axis: &RotaryAxis| {
            let i = axis.index();
            (to.degrees[i] - from.degrees[i]).to_radians().abs()
        };
        let velocity = path[1] - path[0];
        // The distance of a straight path from a point, or a line, is largest at one of its ends.
        let off = |point: Vec3, measure: &dyn Fn(Vec3) -> Vec3| {
            path.map(|p| measure(p - point).length()).into_iter().fold(0.0, f64::max)
        };
        match (side.next(), side.next()) {
            (None, _) => 0.0,
            (Some(only), None) => {
                let w = angle(only);
                let out = |v: Vec3| v.reject_from_normalized(only.axis);
                w * w * off(only.point, &out) + 2.0 * w * out(velocity).length()
            }
            (Some(outer), Some(inner)) => {
                let (w1, w2) = (angle(outer), angle(inner));
                let out = |v: Vec3| v.reject_from_normalized(inner.axis);
                let between = (inner.point - outer.point).reject_from_normalized(outer.axis);
                w1 * w1 * (off(inner.point, &|v| v) + between.length())
                    + w2 * (2.0 * w1 + w2) * off(inner.point, &out)
                    + 2.0 * w1 * velocity.length()
                    + 2.0 * w2 * out(velocity).length()
            }
        }
    }
}

impl RotaryPose {
    /// The pose after `i` of `count` equal steps to `to`.
    fn toward(&self, to: &RotaryPose, i: usize, count: usize) -> RotaryPose {
        let part = i as f64 / count as f64;
        let mut degrees = self.degrees;
        for (here, there) in degrees.iter_mut().zip(to.degrees) {
            *here += (there - *here) * part;
        }
        RotaryPose { tip: self.tip.lerp(to.tip, part), degrees }
    }
}
