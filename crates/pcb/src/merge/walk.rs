//! Whether two paths are near each other all along.
//!
//! The distance of two paths is the greatest distance of two points that follow one path each from end to end, neither of
//! which ever goes back (Fréchet). Between the points where a piece is parallel to an element or to its normal it does not
//! turn back along the element: only these points need be looked at.

use geom::{Element, Turn, Vec2, turn_angle};
use std::f64::consts::TAU;

/// A walk along an element that follows the points of a path in their order.
pub(super) struct Walk {
    curve: Curve,
    ends: [Vec2; 2],
    length: f64,
    /// How far from it the points may be, mm.
    tolerance: f64,
    /// How far from it the farthest of them is, mm.
    pub(super) away: f64,
    /// How far along the walk has come, at least and at most, mm.
    reached: (f64, f64),
}

enum Curve {
    /// Along a unit vector.
    Line(Vec2),
    Arc {
        center: Vec2,
        radius: f64,
        /// 1 to the left, -1 to the right.
        sense: f64,
        /// Angle of the last point about the centre, from the start on, radians.
        turned: f64,
    },
}

impl Walk {
    /// At the start of `element`, which has a length.
    pub(super) fn along(element: &Element, tolerance: f64) -> Walk {
        let length = element.length();
        let curve = match element.turn {
            None => Curve::Line((element.end - element.start) / length),
            Some(Turn { center, sweep }) => Curve::Arc {
                center,
                radius: element.start.distance(center),
                sense: sweep.signum(),
                turned: 0.0,
            },
        };
        let ends = [element.start, element.end];
        Walk { curve, ends, length, tolerance, away: 0.0, reached: (0.0, 0.0) }
    }

    /// Whether it may be at its start yet.
    pub(super) fn may_begin(&self) -> bool {
        self.reached.0 <= 0.0
    }

    /// Whether it may be at its end.
    pub(super) fn may_end(&self) -> bool {
        self.reached.1 >= self.length
    }

    /// Goes on to where `point` is nearest; `None` where that is too far away or back.
    pub(super) fn pass(&mut self, point: Vec2) -> Option<()> {
        let [start, end] = self.ends;
        let (distance, off, stretch) = match &mut self.curve {
            Curve::Line(along) => {
                let from = point - start;
                (from.dot(*along), from.perp_dot(*along).abs(), 1.0)
            }
            Curve::Arc { center, radius, sense, turned } => {
                let out = point - *center;
                let angle = turn_angle(start - *center, out) * *sense;
                *turned = angle + TAU * ((*turned - angle) / TAU).round();
                let distance = out.length();
                // On a smaller circle the same angle is a shorter distance.
                let stretch = *radius / distance.max(*radius);
                (*turned * *radius, (distance - *radius).abs(), stretch)
            }
        };
        let (distance, away, reach) = if distance < 0.0 {
            let away = point.distance(start);
            (0.0, away, self.tolerance - away)
        } else if distance > self.length {
            let away = point.distance(end);
            (self.length, away, self.tolerance - away)
        } else {
            let squared = self.tolerance * self.tolerance - off * off;
            (distance, off, squared.max(0.0).sqrt() * stretch)
        };
        if away > self.tolerance || self.reached.0 > distance + reach {
            return None;
        }
        self.reached = (self.reached.0.max(distance - reach), distance + reach);
        self.away = self.away.max(away);
        Some(())
    }

    /// The points between the ends of `piece`, in order, where it may be farthest from the curve, or turns
    /// back along it. An arc turns by π at most.
    pub(super) fn extremes(&self, piece: &Element) -> [Option<Vec2>; 4] {
        let mut points = [None; 4];
        let (Turn { center, sweep }, normal, cosine) = match (&self.curve, piece.turn) {
            (Curve::Line(_), None) => return points,
            (Curve::Arc { center, .. }, None) => {
                let along = piece.end - piece.start;
                let t = (*center - piece.start).dot(along) / along.length_squared();
                points[0] = (t > 0.0 && t < 1.0).then(|| piece.start + along * t);
                return points;
            }
            (Curve::Line(along), Some(turn)) => (turn, along.perp(), 0.0),
            (Curve::Arc { center, .. }, Some(turn)) => {
                let to = *center - turn.center;
                let cosine = piece.start.distance(turn.center) / to.length();
                (turn, to.normalize_or_zero(), cosine)
            }
        };
        let (from, to) = (piece.start - center, piece.end - center);
        let before = |a: Vec2, b: Vec2| a.perp_dot(b) * sweep > 0.0;
        // It turns back where the centre of the curve is on its tangent.
        let tangent = Vec2::new(cosine, (1.0 - cosine * cosine).max(0.0).sqrt());
        let outs = [
            normal,
            -normal,
            tangent.rotate(normal),
            Vec2::new(tangent.x, -tangent.y).rotate(normal),
        ];
        let radius = from.length();
        let passed = |(i, out): &(usize, Vec2)| {
            (*i < 2 || cosine < 1.0) && before(from, *out) && before(*out, to)
        };
        let passed = outs.into_iter().enumerate().filter(passed);
        for (point, (_, out)) in points.iter_mut().zip(passed) {
            *point = Some(center + out * radius);
        }
        let order = |a: &Option<Vec2>, b: &Option<Vec2>| match (a, b) {
            (Some(a), Some(b)) => {
                before(*b - center, *a - center).cmp(&before(*a - center, *b - center))
            }
            _ => b.is_some().cmp(&a.is_some()),
        };
        points.sort_by(order);
        points
    }
}
