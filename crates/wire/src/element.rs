//! Lines and arcs in the plane: what contours are made of.

use geom::Vec2;
use program::Diagnostic;
use std::f64::consts::{PI, TAU};

/// By how much an arc's radius may fall short of half its chord, or its two radii differ, mm: what
/// LinuxCNC allows for the radii (manual, "G2, G3", centre format).
pub const ARC_TOLERANCE: f64 = 0.005;

/// Ends closer than this are one point, mm: far below what any wire machine resolves.
pub(crate) const SAME: f64 = 1e-7;

/// The greatest coordinate that is taken, mm.
pub(crate) const FAR: f64 = 1e6;

/// A line or an arc from `start` to `end`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// Line of the source (from 1) that says so; 0 where there is none.
    pub line: u32,
    /// First point, mm.
    pub start: Vec2,
    /// Last point, mm.
    pub end: Vec2,
    /// How an arc turns; `None` for a line.
    pub turn: Option<Turn>,
}

/// How an arc turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Its centre, mm.
    pub center: Vec2,
    /// Angle turned through, radians, positive counter-clockwise; 2π for a full circle.
    pub sweep: f64,
}

/// Which way an arc turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// `G2`.
    Clockwise,
    /// `G3`.
    CounterClockwise,
}

impl Direction {
    fn sign(self) -> f64 {
        match self {
            Direction::Clockwise => -1.0,
            Direction::CounterClockwise => 1.0,
        }
    }
}

impl Element {
    /// A straight line.
    pub fn line(start: Vec2, end: Vec2) -> Element {
        Element { line: 0, start, end, turn: None }
    }

    /// An arc about `center` through `sweep` radians, positive counter-clockwise.
    pub fn arc(start: Vec2, end: Vec2, center: Vec2, sweep: f64) -> Element {
        Element { line: 0, start, end, turn: Some(Turn { center, sweep }) }
    }

    /// The same, from this line of the source.
    pub fn from_line(self, line: u32) -> Element {
        Element { line, ..self }
    }

    /// The arc of a signed radius: positive up to half a circle, negative beyond.
    ///
    /// With the chord d from start to end, its middle M and its left normal n the centre is
    /// M ± n·√(R² − d²/4): on the left for `G3` R > 0 and `G2` R < 0, on the right otherwise.
    ///
    /// # Errors
    /// `arc-radius` where R is shorter than half the chord by more than `tolerance`, and where the
    /// ends are one point: then R does not say which circle is meant.
    pub fn arc_by_radius(
        start: Vec2,
        end: Vec2,
        radius: f64,
        direction: Direction,
        tolerance: f64,
    ) -> Result<Element, Box<Diagnostic>> {
        finite(&[start, end, Vec2::splat(radius)])?;
        let along = end - start;
        let chord = along.length();
        if chord < SAME {
            let message = "an arc by R that ends where it starts";
            return Err(Diagnostic::error("arc-radius", message)
                .help("give the centre (I, J): R does not say which full circle is meant")
                .into());
        }
        if chord / 2.0 - radius.abs() > tolerance {
            let message = format!(
                "the radius {:.4} mm is shorter than {:.4} mm, which is half the distance of the ends",
                radius.abs(),
                chord / 2.0
            );
            return Err(Diagnostic::error("arc-radius", message)
                .help("correct R or the end of the arc")
                .into());
        }
        let height = (radius * radius - chord * chord / 4.0).max(0.0).sqrt();
        let left = if (direction == Direction::CounterClockwise) == (radius > 0.0) {
            height
        } else {
            -height
        };
        let center = start + along / 2.0 + along.perp() / chord * left;
        let half = (chord / 2.0).atan2(height);
        let sweep = if radius > 0.0 { 2.0 * half } else { TAU - 2.0 * half };
        Ok(Element::arc(start, end, center, direction.sign() * sweep))
    }

    /// The arc about a centre; equal ends are a full circle.
    ///
    /// # Errors
    /// `arc-center` where the arc starts on its centre, or the radii of its ends differ by more than
    /// `tolerance`.
    pub fn arc_by_center(
        start: Vec2,
        end: Vec2,
        center: Vec2,
        direction: Direction,
        tolerance: f64,
    ) -> Result<Element, Box<Diagnostic>> {
        finite(&[start, end, center])?;
        let (from, to) = (start - center, end - center);
        if from.length() < SAME {
            let message = "the arc starts on its own centre";
            return Err(Diagnostic::error("arc-center", message).help("correct I, J").into());
        }
        if (from.length() - to.length()).abs() > tolerance || to.length() < SAME {
            let message = format!(
                "the end is {:.4} mm from the centre and the start {:.4} mm: not on one circle",
                to.length(),
                from.length()
            );
            return Err(Diagnostic::error("arc-center", message)
                .help("correct I, J or the end of the arc")
                .into());
        }
        let sign = direction.sign();
        let mut sweep = sign * angle(from, to);
        if start.distance(end) < SAME {
            sweep = TAU;
        } else if sweep <= 0.0 {
            sweep += TAU;
        }
        Ok(Element::arc(start, end, center, sign * sweep))
    }

    /// Radius at the start, mm; `None` for a line.
    pub fn radius(&self) -> Option<f64> {
        self.turn.map(|turn| self.start.distance(turn.center))
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        match self.turn {
            None => self.start.distance(self.end),
            Some(turn) => self.start.distance(turn.center) * turn.sweep.abs(),
        }
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
            Some(turn) => {
                let (from, to) = (self.start - turn.center, self.end - turn.center);
                // The two radii differ by rounding of the source: from one to the other evenly.
                let grown = 1.0 + t * (to.length() / from.length() - 1.0);
                turn.center + Vec2::from_angle(turn.sweep * t).rotate(from) * grown
            }
        }
    }

    /// Unit vector of travel at `t`.
    pub fn tangent(&self, t: f64) -> Vec2 {
        match self.turn {
            None => (self.end - self.start).normalize_or_zero(),
            Some(turn) => {
                let spoke = Vec2::from_angle(turn.sweep * t).rotate(self.start - turn.center);
                (spoke.perp() * turn.sweep.signum()).normalize_or_zero()
            }
        }
    }

    /// The same, travelled from its end to its start.
    pub fn reversed(&self) -> Element {
        let turn = self.turn.map(|turn| Turn { sweep: -turn.sweep, ..turn });
        Element { start: self.end, end: self.start, turn, ..*self }
    }

    /// The part from `from` to `to` (0 to 1, in this order).
    pub fn part(&self, from: f64, to: f64) -> Element {
        let (start, end) = (self.at(from), self.at(to));
        let turn = self.turn.map(|turn| Turn { sweep: turn.sweep * (to - from), ..turn });
        Element { start, end, turn, ..*self }
    }

    /// The same shape between other ends, which are near the old ones. An arc up to half a circle keeps
    /// its sweep, a longer one its centre between both shifts.
    pub(crate) fn spanning(&self, start: Vec2, end: Vec2) -> Element {
        if start == self.start && end == self.end {
            return *self;
        }
        let chord = end - start;
        let turn = self.turn.and_then(|turn| {
            if turn.sweep.abs() <= PI {
                let middle = start + chord / 2.0;
                let center = middle + chord.perp() / (2.0 * (turn.sweep / 2.0).tan());
                return (chord.length() >= SAME).then_some(Turn { center, ..turn });
            }
            let center = turn.center + (start - self.start + end - self.end) / 2.0;
            let turned = |from: Vec2, to: Vec2| angle(from - turn.center, to - center);
            let sweep = turn.sweep - turned(self.start, start) + turned(self.end, end);
            let whole = TAU.copysign(turn.sweep);
            Some(Turn { center, sweep: if start == end { whole } else { sweep } })
        });
        Element { start, end, turn, ..*self }
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

    /// Where on the arc the direction from the centre to `point` falls.
    pub(crate) fn parameter(&self, turn: Turn, point: Vec2) -> Option<f64> {
        let angle = angle(self.start - turn.center, point - turn.center) * turn.sweep.signum();
        let angle = if angle < 0.0 { angle + TAU } else { angle };
        let t = angle / turn.sweep.abs();
        (t <= 1.0).then_some(t)
    }

    /// The corners of the smallest box around it whose sides are parallel to the axes.
    pub fn extents(&self) -> (Vec2, Vec2) {
        let (mut low, mut high) = (self.start.min(self.end), self.start.max(self.end));
        if let Some(turn) = self.turn {
            let radius = self.start.distance(turn.center);
            for out in [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y] {
                let point = turn.center + out * radius;
                if self.parameter(turn, point).is_some() {
                    (low, high) = (low.min(point), high.max(point));
                }
            }
        }
        (low, high)
    }

    /// Area between the element and the origin, mm², positive counter-clockwise: the areas of a
    /// closed chain add up to what it encloses.
    pub(crate) fn area(&self) -> f64 {
        let triangle = self.start.perp_dot(self.end) / 2.0;
        let segment = self.turn.map_or(0.0, |turn| {
            let radius = self.start.distance(turn.center);
            radius * radius * (turn.sweep - turn.sweep.sin()) / 2.0
        });
        triangle + segment
    }
}

/// The angle from `a` to `b`, radians, positive counter-clockwise; 0 where one has no direction.
pub(crate) fn angle(a: Vec2, b: Vec2) -> f64 {
    a.perp_dot(b).atan2(a.dot(b))
}

/// Refuses what is no number, and what is out of this world.
pub(crate) fn finite(points: &[Vec2]) -> Result<(), Box<Diagnostic>> {
    match points.iter().find(|p| !p.to_array().iter().all(|v| v.abs() <= FAR)) {
        None => Ok(()),
        Some(p) => {
            let message = format!("X {} Y {} is not a place within {FAR} mm", p.x, p.y);
            Err(Diagnostic::error("not-a-place", message)
                .help("look at the values of the line, and at the unit of the drawing")
                .into())
        }
    }
}
