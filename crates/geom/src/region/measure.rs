//! Where an element is: a point of it, its box, what is nearest, what it encloses.

use crate::{Element, Vec2};
use std::f64::consts::TAU;

impl Element {
    /// The point at `t`: 0 is the start, 1 the end, both exact.
    pub fn at(&self, t: f64) -> Vec2 {
        if t <= 0.0 {
            return self.start;
        }
        if t >= 1.0 {
            return self.end;
        }
        match self.turn {
            None => self.start.lerp(self.end, t),
            Some(turn) => {
                let (from, to) = (self.start - turn.center, self.end - turn.center);
                // The two radii differ by rounding: from one to the other evenly.
                let grown = 1.0 + t * (to.length() / from.length() - 1.0);
                turn.center + Vec2::from_angle(turn.sweep * t).rotate(from) * grown
            }
        }
    }

    /// The parameter of the nearest point and its distance, mm.
    pub fn nearest(&self, point: Vec2) -> (f64, f64) {
        let (from, to) = (point.distance(self.start), point.distance(self.end));
        let ends = if to < from { (1.0, to) } else { (0.0, from) };
        let t = match self.turn {
            None => {
                let along = self.end - self.start;
                (point - self.start).dot(along) / along.length_squared()
            }
            Some(_) => self.parameter(point),
        };
        if !(t > 0.0 && t < 1.0) {
            return ends;
        }
        let on = point.distance(self.at(t));
        if on < ends.1 { (t, on) } else { ends }
    }

    /// Where on the arc the direction from the centre to `point` falls; beyond 1 where it is not on it.
    fn parameter(&self, point: Vec2) -> f64 {
        self.turn.map_or(0.0, |turn| {
            let (from, to) = (self.start - turn.center, point - turn.center);
            let angle = from.perp_dot(to).atan2(from.dot(to)) * turn.sweep.signum();
            (if angle < 0.0 { angle + TAU } else { angle }) / turn.sweep.abs()
        })
    }

    /// Unit vector of travel where the element passes `point`.
    pub(crate) fn direction_at(&self, point: Vec2) -> Vec2 {
        match self.turn {
            None => self.tangent_at_start(),
            Some(turn) => ((point - turn.center).perp() * turn.sweep.signum()).normalize_or_zero(),
        }
    }

    /// The corners of the smallest box around it whose sides are parallel to the axes.
    pub fn extents(&self) -> (Vec2, Vec2) {
        let (mut low, mut high) = (self.start.min(self.end), self.start.max(self.end));
        if let Some(turn) = self.turn {
            let radius = self.start.distance(turn.center).max(self.end.distance(turn.center));
            for out in [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y] {
                let point = turn.center + out * radius;
                if self.parameter(point) <= 1.0 {
                    (low, high) = (low.min(point), high.max(point));
                }
            }
        }
        (low, high)
    }

    /// Area between the element and `origin`, mm², positive counter-clockwise: the areas of a closed
    /// chain add up to what it encloses.
    pub fn area(&self, origin: Vec2) -> f64 {
        let (start, end) = (self.start - origin, self.end - origin);
        let twice = match self.turn {
            None => start.perp_dot(end),
            Some(turn) => {
                let from = self.start.distance(turn.center);
                let to = self.end.distance(turn.center);
                // The radius goes from one to the other evenly.
                let squares = (from * from + from * to + to * to) / 3.0;
                (turn.center - origin).perp_dot(end - start) + turn.sweep * squares
            }
        };
        twice / 2.0
    }
}
