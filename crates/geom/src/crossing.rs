//! Where elements of a contour cross, and how far they are apart.

use crate::element::SAME;
use crate::{Element, Turn, Vec2};
use std::f64::consts::TAU;

/// Below this angle, radians, two lines do not cross at their corner: an arc second.
const PARALLEL: f64 = 1e-6;

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
    /// Where this element crosses `next`, nearest to the end of this one and the start of `next`: an
    /// arc of several turns counts with its last or its first. An arc counts with its radius at that
    /// corner.
    pub fn crossings(&self, next: &Element) -> impl Iterator<Item = Crossing> {
        let first = Carrier::of(self, self.end);
        let second = Carrier::of(next, next.start);
        let (first_length, next_length) = (self.length(), next.length());
        let back = self.reversed();
        let lines = self.turn.is_none() && next.turn.is_none();
        let slope = self.tangent(1.0).perp_dot(next.tangent(0.0));
        let places =
            if lines && slope.abs() < PARALLEL { [None; 2] } else { first.meets(&second, SAME) };
        places.into_iter().flatten().filter_map(move |point| {
            let (from_end, from_start) = (back.distance_to(point)?, next.distance_to(point)?);
            Some(Crossing {
                point,
                on_first: 1.0 - from_end / first_length,
                on_next: from_start / next_length,
                cut: from_end + from_start,
            })
        })
    }

    /// The places where `other` comes within `reach` mm of this element, of rounding's size, among their
    /// crossings and ends; where they run along each other, the ends of that.
    pub fn meets(&self, other: &Element, reach: f64) -> impl Iterator<Item = Vec2> {
        let [p, q] = self.whole_crossings(other, reach);
        let ends = [self.start, self.end, other.start, other.end].map(Some);
        ends.into_iter()
            .chain([p, q])
            .flatten()
            .filter(move |p| self.nearest(*p).1 <= reach && other.nearest(*p).1 <= reach)
    }

    /// Where the whole line or circle of this element crosses that of `other`; a place between them
    /// where they miss each other by no more than `reach` mm.
    pub fn whole_crossings(&self, other: &Element, reach: f64) -> [Option<Vec2>; 2] {
        Carrier::of(self, self.start).meets(&Carrier::of(other, other.start), reach)
    }

    /// The least distance from `other`, mm; 0 where they come within `reach` of each other.
    pub fn distance(&self, other: &Element, reach: f64) -> f64 {
        if self.meets(other, reach).next().is_some() {
            return 0.0;
        }
        let (on_this, on_other) = self.closest(other);
        on_this.distance(on_other)
    }

    /// Where this element and `other`, which do not cross, are nearest to each other: a point of each.
    pub fn closest(&self, other: &Element) -> (Vec2, Vec2) {
        let foot = |point: Vec2, on: &Element| on.at(on.nearest(point).0);
        let mut best = (self.start, foot(self.start, other));
        let mut least = best.0.distance(best.1);
        let mut consider = |one: Vec2, two: Vec2| {
            let distance = one.distance(two);
            if distance < least {
                (best, least) = ((one, two), distance);
            }
        };
        consider(self.end, foot(self.end, other));
        consider(foot(other.start, self), other.start);
        consider(foot(other.end, self), other.end);
        // Else the shortest distance between two inner points is at right angles to both: on an arc it
        // points at the centre.
        for (arc, rest, is_this) in [(self, other, true), (other, self, false)] {
            let Some(turn) = arc.turn else { continue };
            let toward = match rest.turn {
                None => {
                    let along = rest.end - rest.start;
                    let foot = (turn.center - rest.start).dot(along) / along.length_squared();
                    rest.start + along * foot - turn.center
                }
                Some(second) => second.center - turn.center,
            };
            let radius = arc.start.distance(turn.center);
            let out = toward.normalize_or_zero() * radius;
            // About a point of the other element, or its centre, the ends are as near as the rest.
            for point in [turn.center + out, turn.center - out] {
                if out != Vec2::ZERO && arc.parameter(turn, point).is_some() {
                    let across = foot(point, rest);
                    let (one, two) = if is_this { (point, across) } else { (across, point) };
                    consider(one, two);
                }
            }
        }
        best
    }

    /// How far along this element `point` lies, mm, which is on its line or circle; `None` beyond its
    /// ends.
    fn distance_to(&self, point: Vec2) -> Option<f64> {
        let length = self.length();
        let distance = match self.turn {
            None => (point - self.start).dot(self.tangent(0.0)),
            Some(Turn { center, sweep }) => {
                let (from, to) = (self.start - center, point - center);
                let angle =
                    (from.perp_dot(to).atan2(from.dot(to)) * sweep.signum()).rem_euclid(TAU);
                // Just before the start is the start.
                let angle = if (TAU - angle) * from.length() < SAME { 0.0 } else { angle };
                angle / sweep.abs() * length
            }
        };
        (distance > -SAME && distance < length + SAME).then(|| distance.clamp(0.0, length))
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
            None => Carrier::Line { point: at, along: element.tangent(0.0) },
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

    /// Its direction, forwards or backwards, where it passes `at`.
    pub(crate) fn direction_at(&self, at: Vec2) -> Vec2 {
        match self {
            Carrier::Line { along, .. } => *along,
            Carrier::Circle { center, .. } => (at - *center).perp().normalize_or_zero(),
        }
    }

    /// Their common points, and the place between them where they miss each other by no more than
    /// `reach` mm.
    pub(crate) fn meets(&self, other: &Carrier, reach: f64) -> [Option<Vec2>; 2] {
        match (self, other) {
            (Carrier::Line { point, along }, Carrier::Line { point: q, along: other }) => {
                let distance = (*q - *point).perp_dot(*other) / along.perp_dot(*other);
                [distance.is_finite().then(|| *point + *along * distance), None]
            }
            (Carrier::Line { point, along }, Carrier::Circle { center, radius })
            | (Carrier::Circle { center, radius }, Carrier::Line { point, along }) => {
                let foot = *point + *along * (*center - *point).dot(*along);
                let away = foot.distance(*center);
                two(foot, *along, *radius, away, reach)
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
                two(*center + along * away, along.perp(), *radius, away.abs(), reach)
            }
        }
    }
}

/// The two points of a circle of `radius` on the line through `foot`, which is `away` from its centre and
/// at most `reach` from the circle.
fn two(foot: Vec2, along: Vec2, radius: f64, away: f64, reach: f64) -> [Option<Vec2>; 2] {
    if away.is_nan() || away > radius + reach {
        return [None, None];
    }
    let half = ((radius - away).max(0.0) * (radius + away)).sqrt();
    [Some(foot + along * half), Some(foot - along * half)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn quarter(radius: f64) -> Element {
        let (start, end) = (Vec2::new(radius, 0.0), Vec2::new(0.0, radius));
        Element::arc(start, end, Vec2::ZERO, PI / 2.0)
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
}
