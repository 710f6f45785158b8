//! `G5`, `G5.1`: splines in the plane X Y, as fine lines.

use super::step::Step;
use crate::iso::language::Fault;
use geom::Vec3;
use program::Rule;

/// How far the lines may lie from the spline, mm.
const TOLERANCE: f64 = 0.0005;

/// Most lines of a spline.
const MOST_LINES: f64 = 100_000.0;

impl Step<'_, '_, '_> {
    /// LinuxCNC's `G5` (cubic, control points I J from the start and P Q from the end) and `G5.1`
    /// (quadratic, one control point I J from the start).
    pub(super) fn spline(&mut self, cubic: bool) -> Result<(), Fault> {
        self.not_compensated("a spline")?;
        let target = self.target(false)?;
        if target.named == 0 && !b"IJPQ".iter().any(|&letter| self.block.has(letter)) {
            return self.has_no_axis_word();
        }
        let start = self.state.position;
        if self.state.plane.axes()[2] != 2 || target.named & !3 != 0 {
            return Err(self.wrong_spline("a spline lies in the plane X Y (G17)"));
        }
        if start.is_nan() {
            let message = "a spline, and where the tool stands is not known";
            return Err(self.block.whole(Rule::UnknownPosition, message));
        }
        self.feed_for_cut()?;
        let (i, j) = (self.take_length(b'I')?, self.take_length(b'J')?);
        let (p, q) = match cubic {
            true => (self.take_length(b'P')?, self.take_length(b'Q')?),
            false => (None, None),
        };
        let end = target.point;
        let from_start = |i: f64, j: f64| start + Vec3::new(i, j, 0.0);
        let [a, b] = if cubic {
            let (Some(p), Some(q)) = (p, q) else {
                return Err(self.wrong_spline("G5 needs its second control point P Q"));
            };
            let first = match (i, j) {
                (Some(i), Some(j)) => from_start(i, j),
                _ => {
                    let message = "G5 needs its first control point I J: what goes on from the last \
                                   spline is not followed";
                    return Err(self.wrong_spline(message));
                }
            };
            [first, end + Vec3::new(p, q, 0.0)]
        } else {
            if i.is_none() && j.is_none() {
                return Err(self.wrong_spline("G5.1 needs its control point I J"));
            }
            // The same curve of the third degree.
            let control = from_start(i.unwrap_or(0.0), j.unwrap_or(0.0));
            [start.lerp(control, 2.0 / 3.0), end.lerp(control, 2.0 / 3.0)]
        };
        // The chord of 1/n of a curve is off by an eighth of its greatest second derivative over n².
        let bend = (start - 2.0 * a + b).length().max((a - 2.0 * b + end).length()) * 6.0;
        let lines = (bend / 8.0 / TOLERANCE).sqrt().ceil().clamp(1.0, MOST_LINES);
        if lines == MOST_LINES {
            return Err(self.wrong_spline("the spline is too long to follow"));
        }
        for n in 1..=lines as u32 {
            let t = f64::from(n) / lines;
            let s = 1.0 - t;
            let point = start * (s * s * s)
                + a * (3.0 * s * s * t)
                + b * (3.0 * s * t * t)
                + end * (t * t * t);
            let point = if f64::from(n) == lines { end } else { point };
            self.straight(super::motion::Target { point, ..target }, false)?;
        }
        Ok(())
    }

    fn wrong_spline(&self, message: &str) -> Fault {
        self.block.whole(Rule::Spline, message)
    }
}
