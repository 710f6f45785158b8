//! Lines and arcs of a source, each with its line: what contours are made of.

use geom::{Turn, Vec2, turn_angle};
use program::{Diagnostic, Rule};
use std::f64::consts::{PI, TAU};
use std::ops::Deref;

/// By how much an arc's radius may fall short of half its chord, or its two radii differ, mm: what
/// LinuxCNC allows for the radii (manual, "G2, G3", centre format).
pub const ARC_TOLERANCE: f64 = 0.005;

/// Ends closer than this are one point, mm: far below what any wire machine resolves.
pub const SAME: f64 = 1e-7;

/// The greatest coordinate that is taken, mm.
pub const FAR: f64 = 1e6;

/// A line or an arc of a source. Its geometry is that of its shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// Line of the source (from 1) that says so; 0 where there is none.
    pub line: u32,
    /// Where it goes.
    pub shape: geom::Element,
}

impl Deref for Element {
    type Target = geom::Element;

    fn deref(&self) -> &geom::Element {
        &self.shape
    }
}

/// The direction of an arc.
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
        Element { line: 0, shape: geom::Element::line(start, end) }
    }

    /// An arc about `center` through `sweep` radians, positive counter-clockwise.
    pub fn arc(start: Vec2, end: Vec2, center: Vec2, sweep: f64) -> Element {
        Element { line: 0, shape: geom::Element::arc(start, end, center, sweep) }
    }

    /// The same, from this line of the source.
    pub fn from_line(self, line: u32) -> Element {
        Element { line, ..self }
    }

    /// What has become of it, from the same line.
    pub fn shaped(&self, shape: geom::Element) -> Element {
        Element { line: self.line, shape }
    }

    /// The same, travelled from its end to its start.
    pub fn reversed(&self) -> Element {
        self.shaped(self.shape.reversed())
    }

    /// The part from `from` to `to` (0 to 1, in this order).
    pub fn part(&self, from: f64, to: f64) -> Element {
        self.shaped(self.shape.part(from, to))
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
            return Err(Diagnostic::error(Rule::ArcRadius, message)
                .help("give the centre (I, J): R does not say which full circle is meant")
                .into());
        }
        if chord / 2.0 - radius.abs() > tolerance {
            let message = format!(
                "the radius {:.4} mm is shorter than {:.4} mm, which is half the distance of the ends",
                radius.abs(),
                chord / 2.0
            );
            return Err(Diagnostic::error(Rule::ArcRadius, message)
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
            return Err(Diagnostic::error(Rule::ArcCenter, message).help("correct I, J").into());
        }
        if (from.length() - to.length()).abs() > tolerance || to.length() < SAME {
            let message = format!(
                "the end is {:.4} mm from the centre and the start {:.4} mm: not on one circle",
                to.length(),
                from.length()
            );
            return Err(Diagnostic::error(Rule::ArcCenter, message)
                .help("correct I, J or the end of the arc")
                .into());
        }
        let sign = direction.sign();
        let mut sweep = sign * turn_angle(from, to);
        if start.distance(end) < SAME {
            sweep = TAU;
        } else if sweep <= 0.0 {
            sweep += TAU;
        }
        Ok(Element::arc(start, end, center, sign * sweep))
    }

    /// The same shape between other ends, which are near the old ones. An arc up to half a circle keeps
    /// its sweep, a longer one its centre between both shifts.
    pub fn spanning(&self, start: Vec2, end: Vec2) -> Element {
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
            let turned = |from: Vec2, to: Vec2| turn_angle(from - turn.center, to - center);
            let sweep = turn.sweep - turned(self.start, start) + turned(self.end, end);
            let whole = TAU.copysign(turn.sweep);
            Some(Turn { center, sweep: if start == end { whole } else { sweep } })
        });
        self.shaped(geom::Element { start, end, turn })
    }
}

/// Refuses what is no number, and what is out of this world.
pub fn finite(points: &[Vec2]) -> Result<(), Box<Diagnostic>> {
    match points.iter().find(|p| !p.to_array().iter().all(|v| v.abs() <= FAR)) {
        None => Ok(()),
        Some(p) => {
            let message = format!("X {} Y {} is not a point within {FAR} mm", p.x, p.y);
            Err(Diagnostic::error(Rule::NotAPlace, message)
                .help("look at the values of the line, and at the unit of the drawing")
                .into())
        }
    }
}
