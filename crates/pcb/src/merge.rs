//! Ways in fewer elements, and fewer ways.

use crate::Path;
use geom::{Element, Turn, Vec2, turn_angle};
use std::f64::consts::TAU;

impl Path {
    /// The same way in fewer elements, nowhere farther than `tolerance` mm from this one. Elements shorter
    /// than a quarter of that are dropped, and lines and arcs that go on in one line or circle are one.
    /// What is closed stays closed, though it may begin elsewhere; a way back along itself stays a
    /// way back. `None` where nothing is left.
    pub fn merged(&self, tolerance: f64) -> Option<Path> {
        // Starts move where something is dropped, centres follow, ends are beside the line or circle that
        // they are merged into, and its centre follows: each by no more than a quarter.
        let quarter = tolerance / 4.0;
        let elements = without_short(self.elements(), quarter);
        let (merged, last) = merged(&elements, quarter);
        if self.is_closed() && last > 0 {
            // What ends at the start may go on there.
            let around = [&elements[last..], &elements[..last]].concat();
            let (other, _) = self::merged(&around, quarter);
            if other.len() < merged.len() {
                return Path::new(other);
            }
        }
        Path::new(merged)
    }
}

/// `paths`, in their order, without lifting the tool where it need not be: it cuts straight to where the next
/// one starts where that widens a cut of `width` mm by no more than `tolerance` mm.
pub fn joined(paths: &[Path], width: f64, tolerance: f64) -> Vec<Path> {
    let reach = pitch(width, tolerance);
    let mut ways: Vec<Vec<Element>> = Vec::new();
    for path in paths {
        let end = ways.last().and_then(|way| way.last()).map(|element| element.end);
        match (ways.last_mut(), end) {
            (Some(way), Some(end)) if end.distance(path.start()) <= reach => {
                if end != path.start() {
                    way.push(Element::line(end, path.start()));
                }
                way.extend(path.elements());
            }
            _ => ways.push(path.elements().to_vec()),
        }
    }
    ways.into_iter().filter_map(Path::new).collect()
}

/// How far apart (mm) discs of `width` mm may be that what stays between two of them and their common
/// tangent is nowhere higher than `scallop` mm.
pub(crate) fn pitch(width: f64, scallop: f64) -> f64 {
    // Half the pitch, and what is left of half the width, are at right angles.
    let scallop = scallop.clamp(0.0, width / 2.0);
    2.0 * (scallop * (width - scallop)).sqrt()
}

/// The chain without what is shorter than `least` mm: the next element starts where the last one ended.
fn without_short(elements: &[Element], least: f64) -> Vec<Element> {
    let (Some(first), Some(last)) = (elements.first(), elements.last()) else { return Vec::new() };
    let mut kept: Vec<Element> = Vec::with_capacity(elements.len());
    let mut at = first.start;
    for element in elements {
        let whole = element.start == at;
        let moved = if whole { *element } else { spanning(element, at, element.end, least) };
        if moved.length() >= least && moved.length() > 0.0 {
            kept.push(moved);
            at = moved.end;
        }
    }
    if let Some(end) = kept.last_mut().filter(|_| at != last.end) {
        *end = spanning(end, end.start, last.end, least);
    }
    kept
}

/// `element` between other ends, which are near to its own. An arc keeps its centre to `within` mm, and
/// is equally far from both ends where it can be.
fn spanning(element: &Element, start: Vec2, end: Vec2, within: f64) -> Element {
    let Some(Turn { center, sweep }) = element.turn else { return Element::line(start, end) };
    let across = (end - start).perp().normalize_or_zero();
    let middle = start.midpoint(end);
    let balanced = middle + across * (center - middle).dot(across);
    let center = if balanced.distance(center) <= within { balanced } else { center };
    let angle = turn_angle(start - center, end - center);
    let sweep_near = angle + TAU * ((sweep - angle) / TAU).round();
    if sweep_near * sweep > 0.0 {
        Element::arc(start, end, center, sweep_near)
    } else {
        Element::line(start, end)
    }
}

/// The chain in runs of one line or circle each, and where in it the last one begins.
fn merged(elements: &[Element], within: f64) -> (Vec<Element>, usize) {
    let mut merged = Vec::new();
    let mut first = 0;
    while let Some(element) = elements.get(first) {
        let mut run = Run::of(element, within);
        let rest = &elements[first + 1..];
        let length = 1 + rest.iter().take_while(|next| run.takes(next)).count();
        merged.push(if length == 1 { *element } else { run.element() });
        first += length;
        if first >= elements.len() {
            return (merged, first - length);
        }
    }
    (merged, 0)
}

/// Elements that follow each other on one line or circle.
struct Run {
    /// The first one, with the end of the last.
    whole: Element,
    within: f64,
    /// By which angles the line to the next end may turn from the first to pass all ends so far; for arcs
    /// not of interest.
    least: f64,
    most: f64,
}

impl Run {
    fn of(first: &Element, within: f64) -> Run {
        let mut run = Run { whole: *first, within, least: f64::NEG_INFINITY, most: f64::INFINITY };
        run.pass(0.0, first.length());
        run
    }

    /// The line from the start is to pass an end, which is `away` from the start.
    fn pass(&mut self, angle: f64, away: f64) {
        let play = (self.within / away).min(1.0).asin();
        self.least = self.least.max(angle - play);
        self.most = self.most.min(angle + play);
    }

    /// Whether `next` goes on in the same line or circle; then it is part of the run.
    fn takes(&mut self, next: &Element) -> bool {
        match (self.whole.turn, next.turn) {
            (None, None) => self.takes_line(next),
            (Some(turn), Some(other)) => self.takes_arc(turn, next, other),
            _ => false,
        }
    }

    fn takes_line(&mut self, next: &Element) -> bool {
        let (along, to) = (self.whole.end - self.whole.start, next.end - self.whole.start);
        // Of a line, the angles are those from its direction so far.
        let angle = turn_angle(along, to);
        let onwards = (next.end - next.start).dot(to) > 0.0;
        if !(onwards && self.least <= angle && angle <= self.most) {
            return false;
        }
        (self.least, self.most) = (self.least - angle, self.most - angle);
        self.whole.end = next.end;
        self.pass(0.0, to.length());
        true
    }

    fn takes_arc(&mut self, turn: Turn, next: &Element, other: Turn) -> bool {
        let radius = self.whole.start.distance(turn.center);
        let on = |point: Vec2| (point.distance(turn.center) - radius).abs() <= self.within;
        let sweep = turn.sweep + other.sweep;
        let fits = turn.sweep * other.sweep > 0.0
            && sweep.abs() <= TAU * (1.0 + 1e-9)
            && [0.25, 0.5, 0.75, 1.0].into_iter().all(|t| on(next.at(t)));
        if fits {
            self.whole.turn = Some(Turn { sweep, ..turn });
            self.whole.end = next.end;
        }
        fits
    }

    /// All of it as one element.
    fn element(&self) -> Element {
        spanning(&self.whole, self.whole.start, self.whole.end, self.within)
    }
}
