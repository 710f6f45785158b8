//! `G5.2` to `G5.3` of LinuxCNC: a rational B-spline in the plane X Y, as fine lines.
//!
//! The first control point is where the tool stands; each block gives the next by X, Y and its weight P. The knots are
//! uniform, and as often at both ends as the order says, so that the curve begins and ends in its outer points.

use super::state::Nurbs;
use super::step::Step;
use crate::iso::language::Fault;
use crate::iso::language::words::{G, Group, Motion};
use geom::Vec3;
use program::Rule;

/// How far the lines may lie from the curve, mm.
const TOLERANCE: f64 = 0.0005;

/// Most control points of a curve.
const MOST_POINTS: usize = 10_000;

/// The order without L, which is also the least: `rs274` takes no lower one.
const ORDER: usize = 3;

/// The highest order that is followed.
const HIGHEST: usize = 16;

/// How often a span may be halved.
const DEEPEST: u32 = 24;

impl Step<'_, '_, '_> {
    /// Between `G5.2` and `G5.3` there are control points, F and comments; `rs274` passes over or drops all else.
    pub(super) fn inside_nurbs(&self) -> Result<(), Fault> {
        // What else stands in the first block acts before it, as with any motion.
        if self.state.nurbs.is_none() {
            return Ok(());
        }
        let closes = self.block.g(Group::Motion) == Some(G::Motion(Motion::EndOfNurbs));
        let letters: &[u8] = if closes { b"N" } else { b"NXYPF" };
        let others = self.block.m_count > 0 || self.block.commands() > usize::from(closes);
        if others || !self.block.gives_only(letters) {
            return Err(self.wrong_nurbs("between G5.2 and G5.3 there are X, Y, P and F only"));
        }
        Ok(())
    }

    /// `G5.2`, and the blocks behind it: one more control point.
    pub(super) fn control_point(&mut self) -> Result<(), Fault> {
        if self.state.nurbs.is_none() {
            self.not_compensated("a NURBS")?;
            if self.state.plane.axes()[2] != 2 {
                return Err(self.wrong_nurbs("a NURBS lies in the plane X Y (G17)"));
            }
            if self.state.position.is_nan() {
                let message = "a NURBS, and where the tool stands is not known";
                return Err(self.block.whole(Rule::UnknownPosition, message));
            }
        }
        let order = self.take_whole(b'L')?.map_or(ORDER, |l| (l as usize).max(ORDER));
        if order > HIGHEST {
            let message = format!("a NURBS of order {order}: up to {HIGHEST} is followed");
            return Err(self.wrong_nurbs(&message));
        }
        let weight = self.block.take(b'P').map(|word| word.value);
        let is_point = self.block.has(b'X') || self.block.has(b'Y');
        if is_point && !(self.block.has(b'X') && self.block.has(b'Y')) {
            return Err(self.wrong_nurbs("a control point needs both X and Y"));
        }
        if is_point && weight.is_none() || weight.is_some_and(|weight| weight <= 0.0) {
            return Err(self.wrong_nurbs("a control point needs its weight P, greater than 0"));
        }
        let target = self.target(false)?;
        if target.named & !3 != 0 {
            return Err(self.wrong_nurbs("a control point has X and Y only"));
        }
        let start = self.state.position;
        let nurbs = self.state.nurbs.get_or_insert_with(|| {
            // P of a first block without X and Y is the weight of the start.
            let weight = weight.filter(|_| !is_point).unwrap_or(1.0);
            Box::new(Nurbs { points: vec![weighted(start, weight)], order })
        });
        if let Some(weight) = weight.filter(|_| is_point) {
            nurbs.points.push(weighted(target.point, weight));
        }
        if nurbs.points.len() > MOST_POINTS {
            return Err(self.wrong_nurbs("a NURBS of more than 10000 control points"));
        }
        Ok(())
    }

    /// `G5.3`: the tool goes along the curve.
    pub(super) fn along_nurbs(&mut self) -> Result<(), Fault> {
        self.state.motion = None;
        let Some(nurbs) = self.state.nurbs.take() else {
            return Err(self.wrong_nurbs("G5.3 and no G5.2 before it"));
        };
        if nurbs.points.len() < nurbs.order {
            let message = format!("a NURBS of order {} needs as many control points", nurbs.order);
            return Err(self.wrong_nurbs(&message));
        }
        self.feed_for_cut()?;
        let mut ends = Vec::new();
        for span in 0..=nurbs.points.len() - nurbs.order {
            if !halve(nurbs.span(span), DEEPEST, &mut ends) {
                return Err(self.wrong_nurbs("the NURBS is too long to follow"));
            }
        }
        let target = self.target(false)?;
        for end in ends {
            let point = end.with_z(target.point.z);
            self.straight(super::motion::Target { point, ..target }, false)?;
        }
        Ok(())
    }

    fn wrong_nurbs(&self, message: &str) -> Fault {
        self.block.whole(Rule::Spline, message)
    }
}

/// Homogeneous coordinates.
fn weighted(point: Vec3, weight: f64) -> Vec3 {
    Vec3::new(point.x * weight, point.y * weight, weight)
}

/// The point that they are, in the plane.
fn plain(point: Vec3) -> Vec3 {
    Vec3::new(point.x / point.z, point.y / point.z, 0.0)
}

impl Nurbs {
    /// Knot `i`: 0 as often as the order, then 1, 2, ..., and the last as often as the order.
    fn knot(&self, i: usize) -> f64 {
        let last = self.points.len() + 1 - self.order;
        (i + 1).saturating_sub(self.order).min(last) as f64
    }

    /// The control points of the curve between the knots `span` and `span` + 1 as a Bézier curve, homogeneous: values of
    /// its polar form (Ramshaw) at the ends of the span.
    fn span(&self, span: usize) -> Vec<Vec3> {
        let degree = self.order - 1;
        let (low, high) = (span as f64, span as f64 + 1.0);
        (0..=degree)
            .map(|at_high| self.polar_form(span, |r| if r < at_high { high } else { low }))
            .collect()
    }

    /// De Boor's algorithm with another parameter in each step.
    fn polar_form(&self, span: usize, parameter: impl Fn(usize) -> f64) -> Vec3 {
        let degree = self.order - 1;
        let mut d: Vec<Vec3> = self.points[span..=span + degree].to_vec();
        for r in 1..=degree {
            for j in (r..=degree).rev() {
                let (from, to) = (self.knot(span + j), self.knot(span + j + degree + 1 - r));
                let part = (parameter(r - 1) - from) / (to - from);
                d[j] = d[j - 1].lerp(d[j], part);
            }
        }
        d[degree]
    }
}

/// Divides a Bézier curve into pieces whose chords lie within the tolerance, and adds their ends. With weights above 0 a curve
/// lies within the hull of its control points: where they are near the chord it is. Whether it came to an end.
fn halve(curve: Vec<Vec3>, depth: u32, ends: &mut Vec<Vec3>) -> bool {
    let [Some(first), Some(last)] = [curve.first(), curve.last()].map(|p| p.copied().map(plain))
    else {
        return true;
    };
    let is_flat = curve.iter().all(|point| from_chord(first, last, plain(*point)) <= TOLERANCE);
    if is_flat {
        ends.push(last);
        return true;
    }
    if depth == 0 || ends.len() > 100_000 {
        return false;
    }
    let mut row = curve;
    let (mut low, mut high) = (Vec::new(), Vec::new());
    while let (Some(a), Some(b)) = (row.first().copied(), row.last().copied()) {
        low.push(a);
        high.push(b);
        row = row.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0).collect();
    }
    high.reverse();
    halve(low, depth - 1, ends) && halve(high, depth - 1, ends)
}

/// Distance of `point` from the straight line between two others, mm.
fn from_chord(from: Vec3, to: Vec3, point: Vec3) -> f64 {
    let way = to - from;
    let part = match way.length_squared() {
        0.0 => 0.0,
        length => ((point - from).dot(way) / length).clamp(0.0, 1.0),
    };
    point.distance(from + way * part)
}
