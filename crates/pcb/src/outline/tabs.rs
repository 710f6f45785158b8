//! Tabs: where the tool does not cut through, so that the piece stays where it is.

use crate::Path;
use crate::report::{Outcome, fault};
use crate::setting::{self, shown};
use geom::{Element, Turn, Vec2};
use program::{Diagnostic, Rule};

/// More tabs than this are a mistake.
const MOST: usize = 1000;

/// How many even layouts of tabs around a contour are tried.
const PHASES: usize = 64;

/// Bridges between a piece and what is around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tabs {
    /// How many hold each piece.
    pub count: usize,
    /// How wide each is where it meets the piece, mm.
    pub width: f64,
    /// How much of the thickness of the board each keeps, mm, counted from below.
    pub height: f64,
}

/// A part of a contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    pub(super) element: Element,
    /// Which element of the contour it is a piece of.
    pub(super) of: usize,
    /// Whether it is over a tab.
    pub(super) tab: bool,
}

impl Part {
    pub(super) fn reversed(&self) -> Part {
        Part { element: self.element.reversed(), ..*self }
    }
}

impl Tabs {
    /// # Errors
    /// `length`, `tab-height`, `tab-count`
    pub(super) fn check(&self, thickness: f64) -> Outcome {
        setting::length("the width of a tab", self.width)?;
        setting::length("the height of a tab", self.height)?;
        if self.height >= thickness {
            let message = format!(
                "a tab {} mm high is no less than the board, which is {} mm thick",
                shown(self.height),
                shown(thickness)
            );
            return Err(fault(Rule::TabHeight, message, "give a part of the thickness"));
        }
        if self.count == 0 || self.count > MOST {
            let help = format!("give 1 to {MOST}, or no tabs");
            return Err(fault(Rule::TabCount, format!("{} tabs a contour", self.count), &help));
        }
        Ok(())
    }

    /// Where along a closed contour of a tool of `width` mm tabs are whose middles are nearest to these places, from and to, mm
    /// from its start.
    pub(super) fn spans_at(&self, contour: &Path, width: f64, places: &[Vec2]) -> Vec<(f64, f64)> {
        let length = contour.length();
        let half = (self.width + width).min(length / 2.0) / 2.0;
        let mut spans = Vec::with_capacity(places.len());
        for place in places {
            let at = contour.nearest(*place);
            let elements = contour.elements();
            let before: f64 = elements.iter().take(at.element).map(Element::length).sum();
            let within = elements.get(at.element).map_or(0.0, |element| element.length() * at.t);
            let (from, to) = (before + within - half, before + within + half);
            spans.push((from.max(0.0), to.min(length)));
            // Around the start of the contour.
            if from < 0.0 {
                spans.push((length + from, length));
            }
            if to > length {
                spans.push((0.0, to - length));
            }
        }
        spans
    }

    /// Where along a closed contour of a tool of `width` mm the tabs are, from and to, mm from its
    /// start, in order: on straight pieces, as evenly as these let them be.
    pub(super) fn spans(
        &self,
        contour: &Path,
        width: f64,
        warnings: &mut Vec<Diagnostic>,
    ) -> Vec<(f64, f64)> {
        // Half the tool is over the tab when its middle is half its width before it.
        let span = self.width + width;
        let length = contour.length();
        let straight = straight(contour, span);
        let laid = (1..=self.count).rev().find_map(|count| {
            if straight.is_empty() {
                let apart = length / count as f64;
                let place = |i: usize| (i as f64 + 0.5) * apart;
                (apart >= 2.0 * span).then(|| (0..count).map(place).collect())
            } else {
                laid(count, length, span, &straight)
            }
        });
        let middles: Vec<f64> = laid.unwrap_or_default();
        let at = contour.start();
        if middles.len() < self.count {
            let message = format!(
                "only {} of {} tabs have room on the contour at X {:.3} Y {:.3}",
                middles.len(),
                self.count,
                at.x,
                at.y
            );
            let help = "give fewer or narrower tabs, or hold the piece otherwise";
            warnings.push(Diagnostic::warning(Rule::TabsLeftOut, message).help(help));
        }
        if straight.is_empty() && !middles.is_empty() {
            let message = format!(
                "no straight piece of the contour at X {:.3} Y {:.3} is {} mm long: its tabs are on arcs or corners",
                at.x,
                at.y,
                shown(span)
            );
            let help = "give narrower tabs, or be careful when breaking the piece out";
            warnings.push(Diagnostic::warning(Rule::TabsBent, message).help(help));
        }
        middles.into_iter().map(|middle| (middle - span / 2.0, middle + span / 2.0)).collect()
    }
}

/// Where along a contour the middle of a tab may be that is to be on a straight piece: from and to, mm.
fn straight(contour: &Path, span: f64) -> Vec<(f64, f64)> {
    let mut at = 0.0;
    let mut straight = Vec::new();
    for element in contour.elements() {
        let end = at + element.length();
        if element.turn.is_none() && end - at >= span {
            straight.push((at + span / 2.0, end - span / 2.0));
        }
        at = end;
    }
    straight
}

/// The middles of `count` tabs on `straight` pieces, those of the even layouts around the contour from
/// which they need to be moved least; `None` where they have no room.
fn laid(count: usize, length: f64, span: f64, straight: &[(f64, f64)]) -> Option<Vec<f64>> {
    let apart = length / count as f64;
    let layout = |phase: usize| {
        let mut moved = 0.0;
        let mut middles: Vec<f64> = Vec::with_capacity(count);
        for i in 0..count {
            let even = (i as f64 + phase as f64 / PHASES as f64) * apart;
            let middle = nearest(even, length, straight);
            let away = (middle - even).abs();
            moved += away.min(length - away).powi(2);
            middles.push(middle);
        }
        middles.sort_by(f64::total_cmp);
        let around = middles.first().map(|first| first + length);
        let nexts = middles.iter().copied().skip(1).chain(around);
        // At least as much is cut between two as each of them keeps.
        let room = middles.iter().zip(nexts).all(|(middle, next)| next - middle >= 2.0 * span);
        (room || count == 1).then_some((moved, middles))
    };
    let best = (0..PHASES).filter_map(layout).min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, middles)| middles)
}

/// The place on `straight` pieces nearest to `even`, around the contour.
fn nearest(even: f64, length: f64, straight: &[(f64, f64)]) -> f64 {
    let next = straight.partition_point(|(_, to)| *to < even);
    let before = next.checked_sub(1).and_then(|i| straight.get(i)).or(straight.last());
    let after = straight.get(next).or(straight.first());
    let away = |place: f64| {
        let apart = (place - even).abs();
        apart.min(length - apart)
    };
    let places = [before, after].into_iter().flatten().map(|(from, to)| match even {
        even if even < *from || even > *to => {
            if away(*from) < away(*to) {
                *from
            } else {
                *to
            }
        }
        even => even,
    });
    places.min_by(|a, b| away(*a).total_cmp(&away(*b))).unwrap_or(even)
}

/// A closed contour in parts over tabs and others, from the end of an element on that is nearest to
/// `start` and over no tab.
pub(super) fn parted(contour: &Path, spans: &[(f64, f64)], start: Vec2) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let mut begun = 0.0;
    for (of, element) in contour.elements().iter().enumerate() {
        let length = element.length();
        let ends = spans.iter().flat_map(|(from, to)| [*from, *to]);
        let inner = ends.map(|end| (end - begun) / length).filter(|t| *t > 0.0 && *t < 1.0);
        let mut from = 0.0;
        for to in inner.chain([1.0]) {
            let middle = begun + length * (from + to) / 2.0;
            let tab = spans.iter().any(|(from, to)| *from < middle && middle < *to);
            parts.push(Part { element: element.part(from, to), of, tab });
            from = to;
        }
        begun += length;
    }
    let free = parts.iter().enumerate().filter(|(_, part)| !part.tab);
    let first = free.min_by(|(_, a), (_, b)| {
        let away = |part: &Part| part.element.start.distance_squared(start);
        away(a).total_cmp(&away(b))
    });
    let first = first.map_or(0, |(i, _)| i);
    parts.rotate_left(first);
    parts
}

/// The elements of which `parts` are pieces, where they follow each other: what is cut above the tabs.
pub(super) fn whole(parts: &[Part]) -> Vec<Element> {
    let joined = |pieces: &[Part]| {
        let [first, .., last] = pieces else { return pieces.first().map(|piece| piece.element) };
        let sweep =
            pieces.iter().filter_map(|piece| piece.element.turn).map(|turn| turn.sweep).sum();
        let turn = first.element.turn.map(|turn| Turn { sweep, ..turn });
        Some(Element { end: last.element.end, turn, ..first.element })
    };
    parts.chunk_by(|a, b| a.of == b.of).filter_map(joined).collect()
}
