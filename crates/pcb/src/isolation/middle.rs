//! The line between two conductors that is as far from the one as from the other, step by step.
//!
//! A step goes straight on, and from there at right angles to the line until both are as far. It is
//! halved until its chord is near the line all along, and until it is so short that nothing third can have
//! been nearer in between: on a step of 1 mm the distance of anything changes by 1 mm at most.

use super::field::{Field, Near, Window};
use geom::{Element, Vec2};

/// How far a chord may be from the line, mm.
pub(super) const CHORD: f64 = 0.005;

/// A step as short as this is looked at only at its ends, mm.
const SHORT: f64 = 0.001;

/// How exactly the line and its ends are found, mm.
const EXACT: f64 = 1e-7;

/// How often a place off the line is moved to it.
const TRIES: usize = 16;

/// A point of the line.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinePoint {
    pub at: Vec2,
    /// How far the two conductors are, mm.
    pub away: f64,
}

/// Where a walk along the line ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// Where the two are as far away as is asked for.
    Open,
    /// Where a third conductor is as near.
    Corner,
    /// Where it began.
    Closed,
    /// Where the two touch, and there is no line.
    Touch,
}

/// The line between two conductors, and what is around the place on it that was looked at last.
pub(super) struct Middle<'f, 'a> {
    field: &'f Field<'a>,
    pair: [usize; 2],
    /// The line ends where the two are farther than this, mm.
    limit: f64,
    /// How far they were at the last place, mm.
    away: f64,
    window: Window<'a>,
}

/// A place, and what is near it.
struct Placed<'a> {
    at: Vec2,
    near: Near<'a>,
}

impl Placed<'_> {
    fn point(&self) -> LinePoint {
        LinePoint { at: self.at, away: self.near.away() }
    }

    /// The direction in which the distance of the first grows over that of the second: at right angles to the
    /// line.
    fn across(&self) -> Vec2 {
        let [first, second] = self.near.feet.map(|foot| (self.at - foot.at) / foot.away);
        first - second
    }

    /// How far it is from the line, mm.
    fn off(&self) -> f64 {
        let [first, second] = self.near.feet.map(|foot| foot.away);
        (first - second).abs() / self.across().length()
    }

    /// The direction of the line.
    fn along(&self) -> Vec2 {
        self.across().perp().normalize_or_zero()
    }
}

impl<'f, 'a> Middle<'f, 'a> {
    pub fn new(field: &'f Field<'a>, pair: [usize; 2], limit: f64, start: LinePoint) -> Self {
        let window = field.window(start.at, 0.0);
        Middle { field, pair, limit, away: start.away, window }
    }

    /// A direction of the line at `point`, which is on it; none where the two touch.
    pub fn direction(&mut self, point: Vec2) -> Option<Vec2> {
        let along = self.placed(point)?.along();
        (along != Vec2::ZERO).then_some(along)
    }

    /// The points from `start` in the direction `along`; the start itself is left out.
    pub fn walk(&mut self, start: LinePoint, mut along: Vec2) -> (Vec<LinePoint>, End) {
        let mut points: Vec<LinePoint> = Vec::new();
        let mut from = start;
        let mut margin = self.placed(start.at).map_or(0.0, |placed| placed.near.margin().max(0.0));
        // What starts in a corner ends in one.
        let (mut has_left, is_corner) = (false, margin < EXACT);
        let mut step = SHORT;
        while step > EXACT && from.away > EXACT {
            let Some(next) = self.step(from.at, along, step, margin) else {
                step /= 2.0;
                continue;
            };
            if self.is_beyond(&next) {
                let (last, end) = self.end_between(from, next);
                points.push(last);
                return (points, end);
            }
            has_left |= !is_corner && from.at.distance(start.at) > 2.0 * CHORD;
            if has_left && Element::line(from.at, next.at).nearest(start.at).1 < CHORD {
                points.push(start);
                return (points, End::Closed);
            }
            step = (2.0 * from.at.distance(next.at)).min(8.0 * next.near.away().max(SHORT));
            along = next.along() * (next.at - from.at).dot(next.along()).signum();
            (from, margin) = (next.point(), next.near.margin());
            points.push(from);
        }
        (points, End::Touch)
    }

    /// The next place of the line, some `step` mm on; `None` where that is too far.
    fn step(&mut self, from: Vec2, along: Vec2, step: f64, margin: f64) -> Option<Placed<'a>> {
        let guess = from + along * step;
        let next = self.settled(guess)?;
        let length = from.distance(next.at);
        if guess.distance(next.at) > step || (next.at - from).dot(along) <= 0.0 {
            return None;
        }
        let mut margin = margin.min(next.near.margin());
        for t in [0.25, 0.5, 0.75] {
            let place = self.placed(from.lerp(next.at, t))?;
            if place.off() > CHORD {
                return None;
            }
            margin = margin.min(place.near.margin());
        }
        // Between two places that are a quarter of the length apart a margin shrinks, and grows again, by no
        // more than that.
        let is_seen = margin >= length / 4.0 && !self.is_beyond(&next);
        (is_seen || length <= SHORT).then_some(next)
    }

    fn is_beyond(&self, placed: &Placed) -> bool {
        placed.near.margin() < 0.0 || placed.near.away() > self.limit
    }

    /// The last place between one of the line and one beyond its end.
    fn end_between(&mut self, mut from: LinePoint, mut beyond: Placed<'a>) -> (LinePoint, End) {
        while from.at.distance(beyond.at) > EXACT {
            let Some(middle) = self.settled(from.at.midpoint(beyond.at)) else { break };
            if self.is_beyond(&middle) {
                beyond = middle;
            } else {
                from = middle.point();
            }
        }
        (from, if beyond.near.margin() < 0.0 { End::Corner } else { End::Open })
    }

    /// The place of the line at right angles to it from `point`, which is near it.
    fn settled(&mut self, mut point: Vec2) -> Option<Placed<'a>> {
        for _ in 0..TRIES {
            let placed = self.placed(point)?;
            let [first, second] = placed.near.feet.map(|foot| foot.away);
            if (first - second).abs() < EXACT / 10.0 {
                return Some(placed);
            }
            let across = placed.across();
            // The two are in one direction, or touch.
            if across.length_squared().is_nan() || across.length_squared() < 1e-6 {
                return None;
            }
            point -= across * ((first - second) / across.length_squared());
        }
        None
    }

    /// What is near a place; `None` in copper, and where the two are far away.
    fn placed(&mut self, at: Vec2) -> Option<Placed<'a>> {
        let mut half = 5.0 * self.away.max(SHORT);
        let near = loop {
            if let Some(near) = self.window.near(at, self.pair) {
                break near;
            }
            if half > 20.0 * self.limit {
                return None;
            }
            self.window = self.field.window(at, half);
            half *= 2.0;
        };
        self.away = near.away();
        near.is_outside().then_some(Placed { at, near })
    }
}
