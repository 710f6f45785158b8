//! A polyline as SVG path data, thinned as it comes: a program of two million moves must not make a
//! picture of two million points.

use glam::DVec2;
use std::fmt::Write as _;

/// A pen that draws connected and unconnected segments in tenths of a pixel. Points are left out while
/// the line drawn instead stays within a tolerance of each of them; so is a line that stays within the
/// tolerance of its start.
#[derive(Debug)]
pub struct Trace {
    tolerance: f64,
    data: String,
    points: usize,
    /// Where the pen stands in the data, tenths of a pixel.
    pen: (i64, i64),
    /// The line that is being drawn, and whether the pen is down at its anchor.
    open: Option<(Sleeve, bool)>,
}

/// The directions from the last drawn point in which a line passes all points since within tolerance
/// (Zhao and Saalfeld's sleeve: constant time and memory a point).
#[derive(Clone, Copy, Debug)]
struct Sleeve {
    anchor: DVec2,
    last: DVec2,
    /// Farthest point from the anchor so far; going back by more than the tolerance ends the line.
    reach: f64,
    /// Unit vectors, the edges of the cone of directions; none while all points are at the anchor.
    cone: Option<(DVec2, DVec2)>,
}

impl Trace {
    /// An empty one; the tolerance is in pixels.
    pub fn new(tolerance: f64) -> Trace {
        Trace { tolerance, data: String::new(), points: 0, pen: (0, 0), open: None }
    }

    /// Draws from `from` to `to` (pixels).
    pub fn segment(&mut self, from: DVec2, to: DVec2) {
        if self.open.is_none_or(|(sleeve, _)| sleeve.last != from) {
            self.lift();
            self.open = Some((Sleeve::at(from), false));
        }
        if let Some((mut sleeve, mut down)) = self.open {
            if !sleeve.extend(to, self.tolerance) {
                self.draw(sleeve, down);
                sleeve = Sleeve::at(sleeve.last);
                sleeve.extend(to, self.tolerance);
                down = true;
            }
            self.open = Some((sleeve, down));
        }
    }

    /// How many points are drawn.
    pub fn points(&self) -> usize {
        self.points
    }

    /// The path data, in tenths of a pixel.
    pub fn finish(mut self) -> String {
        self.lift();
        self.data
    }

    fn lift(&mut self) {
        if let Some((sleeve, down)) = self.open.take()
            && (down || sleeve.reach > self.tolerance)
        {
            self.draw(sleeve, down);
        }
    }

    fn draw(&mut self, sleeve: Sleeve, down: bool) {
        if !down {
            self.go('m', sleeve.anchor);
        }
        self.go('l', sleeve.last);
    }

    fn go(&mut self, letter: char, to: DVec2) {
        let to = ((to.x * 10.0).round() as i64, (to.y * 10.0).round() as i64);
        let (x, y) = (to.0 - self.pen.0, to.1 - self.pen.1);
        // The first `m` of a path is absolute by definition: the pen starts at 0, 0.
        let blank = if y < 0 { "" } else { " " };
        let _ = write!(self.data, "{letter}{x}{blank}{y}");
        self.pen = to;
        self.points += 1;
    }
}

impl Sleeve {
    fn at(anchor: DVec2) -> Sleeve {
        Sleeve { anchor, last: anchor, reach: 0.0, cone: None }
    }

    /// Takes `point` into the line, or answers that the line must end before it.
    fn extend(&mut self, point: DVec2, tolerance: f64) -> bool {
        let ray = point - self.anchor;
        let distance = ray.length();
        let near = distance <= tolerance;
        if distance < self.reach - tolerance || near && self.cone.is_some() {
            return false;
        }
        if !near {
            let ray = ray / distance;
            let sin = tolerance / distance;
            let turn = DVec2::new((1.0 - sin * sin).sqrt(), sin);
            let (mut right, mut left) = (DVec2::new(turn.x, -turn.y).rotate(ray), turn.rotate(ray));
            if let Some((r, l)) = self.cone {
                if r.perp_dot(ray) < 0.0 || l.perp_dot(ray) > 0.0 || (r + l).dot(ray) < 0.0 {
                    return false;
                }
                right = if r.perp_dot(right) > 0.0 { right } else { r };
                left = if l.perp_dot(left) < 0.0 { left } else { l };
            }
            self.cone = Some((right, left));
        }
        self.last = point;
        self.reach = self.reach.max(distance);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The points of relative path data, pixels.
    fn read(data: &str) -> Vec<DVec2> {
        let spaced = data.replace('-', " -").replace(['m', 'l'], " ");
        let numbers: Vec<f64> = spaced.split_whitespace().map(|n| n.parse().unwrap()).collect();
        let mut at = DVec2::ZERO;
        let step = |p: &[f64]| {
            at += DVec2::new(p[0], p[1]) / 10.0;
            at
        };
        numbers.chunks(2).map(step).collect()
    }

    fn distance(path: &[DVec2], p: DVec2) -> f64 {
        let near = |w: &[DVec2]| {
            let along = w[1] - w[0];
            let t = ((p - w[0]).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
            p.distance(w[0] + along * t)
        };
        path.windows(2).map(near).fold(f64::MAX, f64::min)
    }

    #[test]
    fn a_straight_line_of_many_points_keeps_its_two_ends() {
        let mut trace = Trace::new(0.1);
        let at = |i: i32| DVec2::splat(f64::from(i) / 10.0);
        for i in 0..1000 {
            trace.segment(at(i), at(i + 1));
        }
        assert_eq!(trace.finish(), "m0 0l1000 1000");
    }

    #[test]
    fn going_back_over_the_same_line_keeps_the_turning_point() {
        let mut trace = Trace::new(0.1);
        trace.segment(DVec2::ZERO, DVec2::new(50.0, 0.0));
        trace.segment(DVec2::new(50.0, 0.0), DVec2::new(10.0, 0.0));
        assert_eq!(trace.finish(), "m0 0l500 0l-400 0");
    }

    proptest! {
        #[test]
        fn no_point_is_farther_from_the_drawn_line_than_the_tolerance(
            steps in prop::collection::vec((-3.0..3.0, -3.0..3.0), 1..200),
            tolerance in 0.1..2.0,
        ) {
            let mut points = vec![DVec2::new(100.0, 100.0)];
            for (x, y) in steps {
                points.push(points[points.len() - 1] + DVec2::new(x, y));
            }
            let mut trace = Trace::new(tolerance);
            for w in points.windows(2) {
                trace.segment(w[0], w[1]);
            }
            let mut drawn = read(&trace.finish());
            if drawn.is_empty() {
                // A line that stays at its start is left out.
                drawn = vec![points[0]; 2];
            }
            for &p in &points {
                // A turn back within the tolerance adds one tolerance along the line; the grid of a
                // tenth of a pixel adds its half diagonal.
                prop_assert!(distance(&drawn, p) <= tolerance * 2f64.sqrt() + 0.08);
            }
        }
    }
}
