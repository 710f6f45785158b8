//! The boundary of a board by exact crossings: each line and arc of each shape is cut wherever it meets
//! another, and what lies in no other shape is kept. Slow, and right as far as doubles are.

use super::NEAR;
use super::board::{Board, Shape};
use super::field::away;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toolpost_geom::{Element, Vec2};

/// Nearer than this is the same, mm.
const SAME: f64 = 1e-9;

/// What the boundary of a board is.
#[derive(Default)]
pub struct Exact {
    pub area: f64,
    /// Length of its lines, mm.
    pub lines: f64,
    /// Length of its arcs, mm.
    pub curved: f64,
    /// Arcs, where pieces that continue each other count as one.
    pub fewest_arcs: usize,
    /// The same, where each place that another shape meets cuts an arc.
    pub most_arcs: usize,
    /// Of each piece a point, and whether beyond a gap of less than 4 µm there is the board again.
    pub points: Vec<(Vec2, bool)>,
}

/// A piece of the boundary of a shape, counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub enum Curve {
    Line { from: Vec2, along: Vec2, length: f64 },
    Arc { center: Vec2, radius: f64, from: f64, sweep: f64 },
}

impl Curve {
    fn of_shape(shape: &Shape, radius: f64) -> Vec<Curve> {
        if shape.from == shape.to {
            return vec![Curve::Arc { center: shape.from, radius, from: 0.0, sweep: TAU }];
        }
        let length = shape.from.distance(shape.to);
        let along = (shape.to - shape.from) / length;
        let right = -along.perp() * radius;
        let angle = along.to_angle();
        vec![
            Curve::Line { from: shape.from + right, along, length },
            Curve::Arc { center: shape.to, radius, from: angle - FRAC_PI_2, sweep: PI },
            Curve::Line { from: shape.to - right, along: -along, length },
            Curve::Arc { center: shape.from, radius, from: angle + FRAC_PI_2, sweep: PI },
        ]
    }

    pub fn length(&self) -> f64 {
        match *self {
            Curve::Line { length, .. } => length,
            Curve::Arc { radius, sweep, .. } => radius * sweep,
        }
    }

    /// The point that is `distance` mm along.
    pub fn at(&self, distance: f64) -> Vec2 {
        match *self {
            Curve::Line { from, along, .. } => from + along * distance,
            Curve::Arc { center, radius, from, .. } => {
                center + Vec2::from_angle(from + distance / radius) * radius
            }
        }
    }

    /// Unit vector to the outside.
    pub fn outwards(&self, distance: f64) -> Vec2 {
        match *self {
            Curve::Line { along, .. } => -along.perp(),
            Curve::Arc { radius, from, .. } => Vec2::from_angle(from + distance / radius),
        }
    }

    /// How far along `point` is, which is on its line or circle; `None` beyond the ends.
    pub fn distance_to(&self, point: Vec2) -> Option<f64> {
        let distance = match *self {
            Curve::Line { from, along, .. } => (point - from).dot(along),
            Curve::Arc { center, radius, from, .. } => {
                (((point - center).to_angle() - from).rem_euclid(TAU)) * radius
            }
        };
        (distance > 0.0 && distance < self.length()).then_some(distance)
    }

    /// The piece that an element of a region is.
    pub fn of_element(element: &Element) -> Curve {
        let (from, to) = (element.start, element.end);
        let Some(turn) = element.turn else {
            let length = from.distance(to);
            return Curve::Line { from, along: (to - from) / length, length };
        };
        let first = if turn.sweep > 0.0 { from } else { to };
        let radius = (from.distance(turn.center) + to.distance(turn.center)) / 2.0;
        let angle = (first - turn.center).to_angle();
        Curve::Arc { center: turn.center, radius, from: angle, sweep: turn.sweep.abs() }
    }

    fn is_on(&self, point: Vec2) -> bool {
        match *self {
            Curve::Line { from, along, .. } => along.perp_dot(point - from).abs() < SAME,
            Curve::Arc { center, radius, .. } => (point.distance(center) - radius).abs() < SAME,
        }
    }

    /// Where the lines or circles meet.
    pub fn meets(&self, other: &Curve) -> Vec<Vec2> {
        match (*self, *other) {
            (Curve::Line { from, along, .. }, Curve::Line { from: q, along: other, .. }) => {
                let across = along.perp_dot(other);
                if across.abs() < 1e-9 {
                    return Vec::new();
                }
                vec![from + along * ((q - from).perp_dot(other) / across)]
            }
            (Curve::Line { from, along, .. }, Curve::Arc { center, radius, .. })
            | (Curve::Arc { center, radius, .. }, Curve::Line { from, along, .. }) => {
                let foot = from + along * (center - from).dot(along);
                chord(foot, along, radius, foot.distance(center))
            }
            (
                Curve::Arc { center, radius, .. },
                Curve::Arc { center: other, radius: second, .. },
            ) => {
                let apart = other.distance(center);
                if apart < SAME {
                    return Vec::new();
                }
                let along = (other - center) / apart;
                let foot = (apart * apart + radius * radius - second * second) / (2.0 * apart);
                chord(center + along * foot, along.perp(), radius, foot.abs())
            }
        }
    }

    /// Twice the area between the origin and the piece from one distance along the curve to another.
    fn twice_area(&self, low: f64, high: f64) -> f64 {
        let (from, to) = (self.at(low), self.at(high));
        match *self {
            Curve::Line { .. } => from.perp_dot(to),
            Curve::Arc { center, radius, .. } => center.perp_dot(to - from) + radius * (high - low),
        }
    }
}

fn chord(foot: Vec2, along: Vec2, radius: f64, away: f64) -> Vec<Vec2> {
    if away > radius + SAME {
        return Vec::new();
    }
    let half = (radius * radius - away * away).max(0.0).sqrt();
    vec![foot + along * half, foot - along * half]
}

/// The board grown by `grown`.
pub fn of(board: &Board, grown: f64) -> Exact {
    let shapes: Vec<Shape> =
        board.shapes.iter().map(|s| Shape { radius: s.radius + grown, ..*s }).collect();
    let curves: Vec<(usize, Curve)> = shapes
        .iter()
        .enumerate()
        .flat_map(|(i, s)| Curve::of_shape(s, s.radius).into_iter().map(move |curve| (i, curve)))
        .collect();
    let mut exact = Exact::default();
    // Of each kept arc its circle and angles.
    let mut kept: Vec<(usize, f64, f64)> = Vec::new();
    let mut circles: Vec<(Vec2, f64)> = Vec::new();
    for (shape, curve) in &curves {
        let mut cuts = vec![0.0, curve.length()];
        for (other, second) in &curves {
            if other == shape {
                continue;
            }
            let ends = [second.at(0.0), second.at(second.length())];
            let on = ends.into_iter().filter(|end| curve.is_on(*end));
            cuts.extend(
                curve.meets(second).into_iter().chain(on).filter_map(|p| curve.distance_to(p)),
            );
        }
        cuts.sort_by(f64::total_cmp);
        for pair in cuts.windows(2) {
            let (low, high) = (pair[0], pair[1]);
            let middle = (low + high) / 2.0;
            if high - low < 1e-7 || !is_outside(*shape, curve, middle, &shapes) {
                continue;
            }
            exact.area += curve.twice_area(low, high) / 2.0;
            let point = curve.at(middle);
            let beyond = point + curve.outwards(middle) * (4.0 * NEAR);
            exact.points.push((point, shapes.iter().any(|shape| away(shape, beyond) < 0.0)));
            match *curve {
                Curve::Line { .. } => exact.lines += high - low,
                Curve::Arc { center, radius, from, .. } => {
                    exact.curved += high - low;
                    let same = |(c, r): &(Vec2, f64)| {
                        c.distance(center) < SAME && (r - radius).abs() < SAME
                    };
                    let circle = circles.iter().position(same).unwrap_or_else(|| {
                        circles.push((center, radius));
                        circles.len() - 1
                    });
                    kept.push((circle, from + low / radius, from + high / radius));
                }
            }
        }
    }
    exact.most_arcs = kept.len();
    let continued = kept.iter().filter(|(circle, _, to)| {
        kept.iter().any(|(other, from, _)| {
            let apart = (to - from).rem_euclid(TAU);
            circle == other && apart.min(TAU - apart) < 1e-6
        })
    });
    let whole = kept.iter().filter(|(_, from, to)| to - from > TAU - 1e-6).count();
    exact.fewest_arcs = kept.len() - continued.count() + whole;
    exact
}

/// Whether the boundary of a shape at `distance` is the boundary of all of them.
fn is_outside(shape: usize, curve: &Curve, distance: f64, shapes: &[Shape]) -> bool {
    let (point, outwards) = (curve.at(distance), curve.outwards(distance));
    shapes.iter().enumerate().all(|(i, other)| {
        let away = away(other, point);
        if i == shape || away > 1e-10 {
            return true;
        }
        if away < -1e-10 {
            return false;
        }
        // On the boundary of both: with the other on this side the first shape counts; with it on the
        // other side the boundary is inside.
        let beyond = self::away(other, point + outwards * 1e-3);
        beyond > 0.0 && shape < i
    })
}
