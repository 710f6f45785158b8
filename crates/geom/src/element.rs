//! Lines and arcs of a contour in its plane: their course, their parts, and what runs parallel to them.

use crate::Vec2;
use std::f64::consts::{PI, TAU};

/// Points closer than this are one, mm: rounding, far below what any machine resolves.
pub(crate) const SAME: f64 = 1e-9;

/// A line or an arc from `start` to `end`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// First point, mm.
    pub start: Vec2,
    /// Last point, mm.
    pub end: Vec2,
    /// How an arc turns; `None` for a line.
    pub turn: Option<Turn>,
}

/// How an arc turns. Where its ends are, by rounding, not equally far from the centre, each end has
/// its own radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Its centre, mm.
    pub center: Vec2,
    /// Angle turned through, radians, positive counter-clockwise; beyond ±2π for several turns.
    pub sweep: f64,
}

impl Element {
    /// A straight line.
    pub fn line(start: Vec2, end: Vec2) -> Element {
        Element { start, end, turn: None }
    }

    /// An arc about `center` through `sweep` radians, positive counter-clockwise.
    pub fn arc(start: Vec2, end: Vec2, center: Vec2, sweep: f64) -> Element {
        Element { start, end, turn: Some(Turn { center, sweep }) }
    }

    /// The same element, run backwards.
    pub fn reversed(&self) -> Element {
        let turn = self.turn.map(|turn| Turn { sweep: -turn.sweep, ..turn });
        Element { start: self.end, end: self.start, turn }
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        match self.turn {
            None => self.start.distance(self.end),
            Some(Turn { center, sweep }) => {
                (self.start.distance(center) + self.end.distance(center)) / 2.0 * sweep.abs()
            }
        }
    }

    /// Radius at the start, mm; `None` for a line.
    pub fn radius(&self) -> Option<f64> {
        self.turn.map(|turn| self.start.distance(turn.center))
    }

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
            Some(Turn { center, sweep }) => {
                let (from, to) = (self.start - center, self.end - center);
                let grown = 1.0 + t * (to.length() / from.length() - 1.0);
                center + Vec2::from_angle(sweep * t).rotate(from) * grown
            }
        }
    }

    /// Unit vector of travel at `t`; zero where the element has no length.
    pub fn tangent(&self, t: f64) -> Vec2 {
        match self.turn {
            None => self.end - self.start,
            Some(Turn { center, sweep }) => {
                let spoke = match t {
                    t if t <= 0.0 => self.start - center,
                    t if t >= 1.0 => self.end - center,
                    t => Vec2::from_angle(sweep * t).rotate(self.start - center),
                };
                spoke.perp() * sweep.signum()
            }
        }
        .normalize_or_zero()
    }

    /// The part from `from` to `to` (0 to 1, in this order).
    pub fn part(&self, from: f64, to: f64) -> Element {
        let turn = self.turn.map(|turn| Turn { sweep: turn.sweep * (to - from), ..turn });
        Element { start: self.at(from), end: self.at(to), turn }
    }

    /// The parameter of the nearest point and its distance, mm.
    pub fn nearest(&self, point: Vec2) -> (f64, f64) {
        let Some(turn) = self.turn else {
            let along = self.end - self.start;
            let squared = along.length_squared();
            let t = if squared > 0.0 {
                ((point - self.start).dot(along) / squared).clamp(0.0, 1.0)
            } else {
                0.0
            };
            return (t, point.distance(self.start + along * t));
        };
        let (from, to) = (point.distance(self.start), point.distance(self.end));
        let ends = if to < from { (1.0, to) } else { (0.0, from) };
        match self.parameter(turn, point) {
            Some(t) => {
                let on = point.distance(self.at(t));
                if on < ends.1 { (t, on) } else { ends }
            }
            None => ends,
        }
    }

    /// How far `point` is from it, mm: as [`nearest`](Element::nearest) tells, but for rounding, and without
    /// angles.
    pub fn away(&self, point: Vec2) -> f64 {
        let Some(Turn { center, sweep }) = self.turn else { return self.nearest(point).1 };
        let (from, to, at) = (self.start - center, self.end - center, point - center);
        let is_after_start = from.perp_dot(at) * sweep >= 0.0;
        let is_before_end = at.perp_dot(to) * sweep >= 0.0;
        let is_beside = match sweep.abs() {
            sweep if sweep >= TAU => true,
            sweep if sweep > PI => is_after_start || is_before_end,
            _ => is_after_start && is_before_end,
        };
        match is_beside {
            true => (at.length() - (from.length() + to.length()) / 2.0).abs(),
            false => point.distance(self.start).min(point.distance(self.end)),
        }
    }

    /// Where on the arc the direction from the centre to `point` falls.
    pub(crate) fn parameter(&self, turn: Turn, point: Vec2) -> Option<f64> {
        let angle = turn_angle(self.start - turn.center, point - turn.center) * turn.sweep.signum();
        let angle = if angle < 0.0 { angle + TAU } else { angle };
        let t = angle / turn.sweep.abs();
        (t <= 1.0).then_some(t)
    }

    /// The corners of the smallest box around it whose sides are parallel to the axes.
    pub fn extents(&self) -> (Vec2, Vec2) {
        let (mut low, mut high) = (self.start.min(self.end), self.start.max(self.end));
        if let Some(turn) = self.turn {
            let radius = self.start.distance(turn.center).max(self.end.distance(turn.center));
            for out in [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y] {
                let point = turn.center + out * radius;
                if self.parameter(turn, point).is_some() {
                    (low, high) = (low.min(point), high.max(point));
                }
            }
        }
        (low, high)
    }

    /// Area between the element and `about`, mm², positive counter-clockwise: the areas of a closed
    /// chain add up to what it encloses.
    pub fn area(&self, about: Vec2) -> f64 {
        let triangle = (self.start - about).perp_dot(self.end - about) / 2.0;
        let segment = self.turn.map_or(0.0, |Turn { center, sweep }| {
            let radius = self.start.distance(center);
            radius * radius * (sweep - sweep.sin()) / 2.0
        });
        triangle + segment
    }

    /// By how much the element turns to the left, radians per mm; 0 for a line.
    pub fn curvature(&self) -> f64 {
        self.turn.map_or(0.0, |turn| turn.sweep.signum() / self.start.distance(turn.center))
    }

    /// The element parallel to this one at `distance` mm on its left (on its right where
    /// negative): an arc stays an arc about its centre. `None` where the element has no length, or
    /// nothing is left of the radius of an arc.
    pub fn parallel(&self, distance: f64) -> Option<Element> {
        let moved = |p: Vec2, tangent: Vec2| p + tangent.perp() * distance;
        let (first, last) = (self.tangent(0.0), self.tangent(1.0));
        if first == Vec2::ZERO || last == Vec2::ZERO {
            return None;
        }
        if let Some(Turn { center, sweep }) = self.turn {
            let radius = self.start.distance(center).min(self.end.distance(center));
            if radius - distance * sweep.signum() <= SAME {
                return None;
            }
        }
        Some(Element { start: moved(self.start, first), end: moved(self.end, last), ..*self })
    }
}

/// The angle from the direction `first` to `next`, radians in (−π, π], positive
/// to the left; 0 where one has no direction.
pub fn turn_angle(first: Vec2, next: Vec2) -> f64 {
    let angle = first.perp_dot(next).atan2(first.dot(next));
    if angle <= -PI { PI } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quarter(radius: f64) -> Element {
        let (start, end) = (Vec2::new(radius, 0.0), Vec2::new(0.0, radius));
        Element::arc(start, end, Vec2::ZERO, PI / 2.0)
    }

    #[test]
    fn next_to_a_line_and_an_arc() {
        let line = Element::line(Vec2::ZERO, Vec2::new(10.0, 0.0));
        let left = Element::line(Vec2::new(0.0, 3.0), Vec2::new(10.0, 3.0));
        assert_eq!(line.parallel(3.0), Some(left));
        // A counter-clockwise arc has its centre on the left.
        let inside = quarter(10.0).parallel(3.0).unwrap();
        assert!(inside.start.distance(Vec2::new(7.0, 0.0)) < 1e-12);
        assert!((inside.length() - 7.0 * PI / 2.0).abs() < 1e-12);
        let outside = quarter(10.0).reversed().parallel(3.0).unwrap();
        assert!(outside.start.distance(Vec2::new(0.0, 13.0)) < 1e-12);
        assert_eq!(quarter(3.0).parallel(3.0), None);
        assert_eq!((line.curvature(), outside.curvature()), (0.0, -1.0 / 13.0));
        assert_eq!(Element::line(Vec2::X, Vec2::X).parallel(3.0), None);
    }

    #[test]
    fn how_far_away_a_point_is_is_reported_with_angles_and_without() {
        for sweep in [0.1, 1.5, PI, 3.5, 6.0, TAU, -0.5, -PI, -5.0, -TAU] {
            let (start, center) = (Vec2::new(3.0, 1.0), Vec2::new(1.0, 2.0));
            let end = center + Vec2::from_angle(sweep).rotate(start - center);
            for element in [Element::arc(start, end, center, sweep), Element::line(start, end)] {
                for x in -50..50 {
                    for y in -50..50 {
                        let point = Vec2::new(f64::from(x), f64::from(y)) * 0.093;
                        let (ours, other) = (element.away(point), element.nearest(point).1);
                        assert!((ours - other).abs() < 1e-12, "{element:?} {point}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_turn_back_is_a_turn_to_the_left() {
        assert_eq!(turn_angle(Vec2::X, Vec2::NEG_X), PI);
        assert_eq!(turn_angle(Vec2::NEG_X, Vec2::X), PI);
        assert_eq!(turn_angle(Vec2::X, Vec2::NEG_Y), -PI / 2.0);
    }
}
