//! A chain of lines and arcs, open or closed.

use geom::{Turn, Vec2, turn_angle};
use program::{Diagnostic, Rule};
use sketch::{Element, SAME, finite};
use std::f64::consts::{PI, TAU};

/// A chain of elements, each of which starts, bit for bit, where the one before ends. It is closed
/// where the last ends at the start of the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    elements: Vec<Element>,
    /// The line of the source that brings the wire to its start; 0 for none.
    brought_by: u32,
}

/// A point on a contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourPoint {
    /// Index of the element.
    pub element: usize,
    /// How far along the element, 0 to 1.
    pub t: f64,
    /// The point, mm.
    pub point: Vec2,
}

impl Contour {
    /// Chains `elements` in their order. Gaps up to `gap` mm are closed, also the one between the end
    /// and the start; elements without length fall away.
    ///
    /// # Errors
    /// `gap` where two neighbours are farther apart, `not-a-place` for coordinates that are no numbers,
    /// `empty-contour` where nothing has a length.
    pub fn new(mut elements: Vec<Element>, gap: f64) -> Result<Contour, Box<Diagnostic>> {
        for element in &elements {
            let turn = element.turn.unwrap_or(Turn { center: element.start, sweep: 0.0 });
            finite(&[element.start, element.end, turn.center, Vec2::splat(turn.sweep)])
                .map_err(|d| d.line(element.line))?;
        }
        elements.retain(|element| element.length() >= SAME);
        Contour::joined(elements, gap.max(SAME))
    }

    /// The same with finite elements, none of which falls away: where the upper end of a leaning wire
    /// stands still its element is a point.
    pub(crate) fn joined(mut chain: Vec<Element>, gap: f64) -> Result<Contour, Box<Diagnostic>> {
        for i in 1..chain.len() {
            let (last, next) = (chain[i - 1].end, &mut chain[i]);
            let apart = last.distance(next.start);
            if apart > gap {
                let message = format!(
                    "a gap of {apart:.4} mm between X{:.4} Y{:.4} and X{:.4} Y{:.4}",
                    last.x, last.y, next.start.x, next.start.y
                );
                return Err(Diagnostic::error(Rule::Gap, message)
                    .help(format!("close it; of a drawing, --close allows more than {gap} mm"))
                    .line(next.line)
                    .into());
            }
            *next = next.spanning(last, next.end);
        }
        let many = chain.len() > 1;
        let (Some(start), Some(last)) = (chain.first().map(|e| e.start), chain.last_mut()) else {
            return Err(Diagnostic::error(Rule::EmptyContour, "the contour has no length").into());
        };
        let whole = last.turn.is_some_and(|turn| turn.sweep.abs() > PI);
        if last.end.distance(start) <= gap && (many || whole) {
            *last = last.spanning(last.start, start);
        }
        Ok(Contour { elements: chain, brought_by: 0 })
    }

    /// The elements in their order; never empty.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// The same, to whose start this line of the source brings the wire.
    #[must_use]
    pub fn starting_by(self, line: u32) -> Contour {
        Contour { brought_by: line, ..self }
    }

    /// The line of the source that brings the wire to its start: that of the first element where no other does.
    pub fn starts_by(&self) -> u32 {
        match self.brought_by {
            0 => self.elements.first().map_or(0, |element| element.line),
            line => line,
        }
    }

    /// Where it starts.
    pub fn start(&self) -> Vec2 {
        self.elements.first().map_or(Vec2::ZERO, |element| element.start)
    }

    /// Where it ends.
    pub fn end(&self) -> Vec2 {
        self.elements.last().map_or(Vec2::ZERO, |element| element.end)
    }

    /// Whether it ends where it starts.
    pub fn is_closed(&self) -> bool {
        self.start() == self.end()
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.elements.iter().map(|element| element.length()).sum()
    }

    /// What a closed contour encloses, mm², positive counter-clockwise; 0 for an open one.
    pub fn area(&self) -> f64 {
        if !self.is_closed() {
            return 0.0;
        }
        // About the start, not the origin: a small contour far out keeps its digits.
        self.elements.iter().map(|element| element.area(self.start())).sum()
    }

    /// Whether a closed contour goes round `point`.
    pub fn encloses(&self, point: Vec2) -> bool {
        let turns = |element: &Element| {
            let chord = turn_angle(element.start - point, element.end - point) / TAU;
            // Between an arc and its chord, which lies to the left of one that turns left.
            let bulge = element.turn.map_or(0.0, |turn| {
                let side = turn.sweep.signum();
                let within = point.distance(turn.center) < element.start.distance(turn.center);
                let beyond = (element.end - element.start).perp_dot(point - element.start);
                let whole = element.start == element.end;
                if within && (whole || beyond * side < 0.0) { side } else { 0.0 }
            });
            chord + bulge
        };
        self.is_closed() && self.elements.iter().map(turns).sum::<f64>().abs() > 0.5
    }

    /// The corners of the smallest box around it whose sides are parallel to the axes.
    pub fn extents(&self) -> (Vec2, Vec2) {
        let all = self.elements.iter().map(|element| element.extents());
        all.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default()
    }

    /// The same, travelled the other way.
    pub fn reversed(&self) -> Contour {
        let elements = self.elements.iter().rev().map(Element::reversed).collect();
        Contour { elements, brought_by: 0 }
    }

    /// The point of the contour nearest to `point`; of equally near ones the first.
    pub fn nearest(&self, point: Vec2) -> ContourPoint {
        let mut best = ContourPoint { element: 0, t: 0.0, point: self.start() };
        let mut least = f64::INFINITY;
        for (i, element) in self.elements.iter().enumerate() {
            let (t, distance) = element.nearest(point);
            if distance < least {
                (least, best) = (distance, ContourPoint::on(element, i, t));
            }
        }
        best
    }

    /// The point `along` mm after the start, at most the end.
    pub fn point_at(&self, along: f64) -> ContourPoint {
        let mut left = along.max(0.0);
        for (i, element) in self.elements.iter().enumerate() {
            let length = element.length();
            if left < length {
                return ContourPoint::on(element, i, left / length);
            }
            left -= length;
        }
        ContourPoint { element: self.elements.len().saturating_sub(1), t: 1.0, point: self.end() }
    }

    /// A closed contour with its start moved to `start`; an open one as it is.
    pub fn started_at(&self, start: &ContourPoint) -> Contour {
        if !self.is_closed() || start.point == self.start() {
            return self.clone();
        }
        let parts = start.up_to(&self.point_at(f64::INFINITY));
        let parts = parts.chain(self.point_at(0.0).up_to(start));
        let part = |(i, from, to): (usize, f64, f64)| Some(self.elements.get(i)?.part(from, to));
        Contour { elements: parts.filter_map(part).collect(), brought_by: 0 }
    }
}

impl ContourPoint {
    /// The parts of elements from here to a later point: index, start and end.
    pub(crate) fn up_to(
        &self,
        to: &ContourPoint,
    ) -> impl Iterator<Item = (usize, f64, f64)> + use<> {
        let (from, to) = (*self, *to);
        let parts = (from.element..=to.element).map(move |i| {
            let start = if i == from.element { from.t } else { 0.0 };
            (i, start, if i == to.element { to.t } else { 1.0 })
        });
        parts.filter(|(_, start, end)| start < end)
    }

    /// At `t` of element `index`; what is nearly its end is its end.
    fn on(element: &Element, index: usize, t: f64) -> ContourPoint {
        let length = element.length();
        let t = match t {
            t if t * length < 1e-6 => 0.0,
            t if (1.0 - t) * length < 1e-6 => 1.0,
            t => t,
        };
        ContourPoint { element: index, t, point: element.at(t) }
    }
}
