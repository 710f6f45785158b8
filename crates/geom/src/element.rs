//! Lines and arcs of a contour in its plane, what runs parallel to them, and where those cross.

use crate::Vec2;
use std::f64::consts::{PI, TAU};

/// Points closer than this are one, mm: rounding, far below what any machine resolves.
const SAME: f64 = 1e-9;

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

/// Where the end of one element crosses the start of the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The point, mm.
    pub point: Vec2,
    /// Its place on the first element: 0 at the start, 1 at the end.
    pub on_first: f64,
    /// Its place on the next element.
    pub on_next: f64,
    /// How much of the two it cuts off at their common corner, mm.
    pub cut: f64,
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

    /// The same way back.
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

    /// Unit vector of travel at the start; zero where the element has no length.
    pub fn tangent_at_start(&self) -> Vec2 {
        self.tangent(self.start)
    }

    /// Unit vector of travel at the end; zero where the element has no length.
    pub fn tangent_at_end(&self) -> Vec2 {
        self.tangent(self.end)
    }

    fn tangent(&self, at: Vec2) -> Vec2 {
        match self.turn {
            None => self.end - self.start,
            Some(Turn { center, sweep }) => (at - center).perp() * sweep.signum(),
        }
        .normalize_or_zero()
    }

    /// By how much the way turns to the left, radians for each mm; 0 for a line.
    pub fn curvature(&self) -> f64 {
        self.turn.map_or(0.0, |turn| turn.sweep.signum() / self.start.distance(turn.center))
    }

    /// The element that runs beside this one at `distance` mm on its left (on its right where
    /// negative): an arc stays an arc about its centre. `None` where the element has no length, or
    /// nothing is left of the radius of an arc.
    pub fn parallel(&self, distance: f64) -> Option<Element> {
        let beside = |p: Vec2, tangent: Vec2| p + tangent.perp() * distance;
        let (first, last) = (self.tangent_at_start(), self.tangent_at_end());
        if first == Vec2::ZERO || last == Vec2::ZERO {
            return None;
        }
        if let Some(Turn { center, sweep }) = self.turn {
            let radius = self.start.distance(center).min(self.end.distance(center));
            if radius - distance * sweep.signum() <= SAME {
                return None;
            }
        }
        Some(Element { start: beside(self.start, first), end: beside(self.end, last), ..*self })
    }

    /// Where this element crosses `next`, nearest to the end of this one and the start of `next`: an
    /// arc of several turns counts with its last or its first. An arc counts with its radius at that
    /// corner.
    pub fn crossings(&self, next: &Element) -> impl Iterator<Item = Crossing> {
        let first = Carrier::of(self, self.end);
        let second = Carrier::of(next, next.start);
        let (first_length, next_length) = (self.length(), next.length());
        let back = self.reversed();
        first.meets(&second).into_iter().flatten().filter_map(move |point| {
            let (from_end, from_start) = (back.way_to(point)?, next.way_to(point)?);
            Some(Crossing {
                point,
                on_first: 1.0 - from_end / first_length,
                on_next: from_start / next_length,
                cut: from_end + from_start,
            })
        })
    }

    /// How far along this element `point` lies, mm, which is on its line or circle; `None` beyond its
    /// ends.
    fn way_to(&self, point: Vec2) -> Option<f64> {
        let length = self.length();
        let way = match self.turn {
            None => (point - self.start).dot(self.tangent_at_start()),
            Some(Turn { center, sweep }) => {
                let (from, to) = (self.start - center, point - center);
                let angle =
                    (from.perp_dot(to).atan2(from.dot(to)) * sweep.signum()).rem_euclid(TAU);
                // Just before the start is the start.
                let angle = if (TAU - angle) * from.length() < SAME { 0.0 } else { angle };
                angle / sweep.abs() * length
            }
        };
        (way > -SAME && way < length + SAME).then(|| way.clamp(0.0, length))
    }
}

/// The endless line or the whole circle that an element is a piece of.
pub(crate) enum Carrier {
    Line { point: Vec2, along: Vec2 },
    Circle { center: Vec2, radius: f64 },
}

impl Carrier {
    /// That of `element` through its end `at`.
    pub(crate) fn of(element: &Element, at: Vec2) -> Carrier {
        match element.turn {
            None => Carrier::Line { point: at, along: element.tangent_at_start() },
            Some(Turn { center, .. }) => Carrier::Circle { center, radius: at.distance(center) },
        }
    }

    /// How far `at` is from it, mm.
    pub(crate) fn distance(&self, at: Vec2) -> f64 {
        match self {
            Carrier::Line { point, along } => along.perp_dot(at - *point).abs(),
            Carrier::Circle { center, radius } => (at.distance(*center) - radius).abs(),
        }
    }

    /// Its direction, one way or the other, where it passes `at`.
    pub(crate) fn direction_at(&self, at: Vec2) -> Vec2 {
        match self {
            Carrier::Line { along, .. } => *along,
            Carrier::Circle { center, .. } => (at - *center).perp().normalize_or_zero(),
        }
    }

    /// Their common points; one that touches by rounding counts.
    pub(crate) fn meets(&self, other: &Carrier) -> [Option<Vec2>; 2] {
        match (self, other) {
            (Carrier::Line { point, along }, Carrier::Line { point: q, along: other }) => {
                let across = along.perp_dot(*other);
                // Below an arc second two lines are parallel.
                let far = across.abs() < 1e-6;
                [(!far).then(|| *point + *along * ((*q - *point).perp_dot(*other) / across)), None]
            }
            (Carrier::Line { point, along }, Carrier::Circle { center, radius })
            | (Carrier::Circle { center, radius }, Carrier::Line { point, along }) => {
                let foot = *point + *along * (*center - *point).dot(*along);
                let away = foot.distance(*center);
                two(foot, *along, *radius, away)
            }
            (
                Carrier::Circle { center, radius },
                Carrier::Circle { center: other, radius: second },
            ) => {
                let between = *other - *center;
                let distance = between.length();
                if distance < SAME {
                    return [None, None];
                }
                let along = between / distance;
                let away =
                    (distance * distance + radius * radius - second * second) / (2.0 * distance);
                two(*center + along * away, along.perp(), *radius, away.abs())
            }
        }
    }
}

/// The two points of a circle of `radius` on the line through `foot`, which is `away` from its centre.
fn two(foot: Vec2, along: Vec2, radius: f64, away: f64) -> [Option<Vec2>; 2] {
    if away.is_nan() || away > radius + SAME {
        return [None, None];
    }
    let half = ((radius - away).max(0.0) * (radius + away)).sqrt();
    [Some(foot + along * half), Some(foot - along * half)]
}

/// The angle by which the way turns from the unit vector `first` to `next`, radians in (−π, π], positive
/// to the left.
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
    fn beside_a_line_and_an_arc() {
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
    fn two_lines_cross_at_their_corner() {
        // A corner of 90° to the left; 3 mm inside of it both lose 3 mm.
        let first = Element::line(Vec2::new(0.0, 3.0), Vec2::new(20.0, 3.0));
        let next = Element::line(Vec2::new(17.0, 0.0), Vec2::new(17.0, 20.0));
        let crossing = first.crossings(&next).next().unwrap();
        assert_eq!(crossing.point, Vec2::new(17.0, 3.0));
        assert!((crossing.on_first - 0.85).abs() < 1e-12 && (crossing.cut - 6.0).abs() < 1e-12);
        assert_eq!(first.crossings(&first.reversed()).count(), 0);
    }

    #[test]
    fn a_line_meets_a_circle_twice_and_beyond_the_arc_not_at_all() {
        let line = Element::line(Vec2::new(-20.0, 6.0), Vec2::new(20.0, 6.0));
        let circle = Element::arc(Vec2::X * 10.0, Vec2::X * 10.0, Vec2::ZERO, TAU);
        let points: Vec<Vec2> = line.crossings(&circle).map(|c| c.point).collect();
        assert_eq!(points, [Vec2::new(8.0, 6.0), Vec2::new(-8.0, 6.0)]);
        let right: Vec<Vec2> = line.crossings(&quarter(10.0)).map(|c| c.point).collect();
        assert_eq!(right, [Vec2::new(8.0, 6.0)]);
        let above = Element::line(Vec2::new(-20.0, 10.1), Vec2::new(20.0, 10.1));
        assert_eq!(above.crossings(&circle).count(), 0);
    }

    #[test]
    fn an_arc_of_several_turns_counts_with_its_last_before_and_its_first_after_a_corner() {
        let turns = Element::arc(Vec2::X * 10.0, Vec2::X * 10.0, Vec2::ZERO, 3.0 * TAU);
        let up = Element::line(Vec2::new(0.0, 0.0), Vec2::new(0.0, 20.0));
        let last = turns.crossings(&up).next().unwrap();
        assert!((last.on_first - 2.25 / 3.0).abs() < 1e-12);
        let first = up.crossings(&turns).next().unwrap();
        assert!((first.on_next - 0.25 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn two_circles_cross_or_touch() {
        let left = Element::arc(Vec2::X * -10.0, Vec2::X * -10.0, Vec2::X * -5.0, TAU);
        let right = Element::arc(Vec2::X * 10.0, Vec2::X * 10.0, Vec2::X * 5.0, -TAU);
        assert!(left.crossings(&right).all(|c| c.point.length() < 1e-7));
        let wide = Element::arc(Vec2::X * 10.0, Vec2::X * 10.0, Vec2::X * 2.0, TAU);
        for crossing in left.crossings(&wide) {
            assert!((crossing.point.distance(Vec2::X * -5.0) - 5.0).abs() < 1e-12);
            assert!((crossing.point.distance(Vec2::X * 2.0) - 8.0).abs() < 1e-12);
        }
        assert_eq!(left.crossings(&wide).count(), 2);
        assert_eq!(left.crossings(&left).count(), 0);
    }

    #[test]
    fn a_turn_back_is_a_turn_to_the_left() {
        assert_eq!(turn_angle(Vec2::X, Vec2::NEG_X), PI);
        assert_eq!(turn_angle(Vec2::NEG_X, Vec2::X), PI);
        assert_eq!(turn_angle(Vec2::X, Vec2::NEG_Y), -PI / 2.0);
    }
}
