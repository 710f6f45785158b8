//! Ways in fewer elements, and fewer ways.

use crate::Path;
use geom::{Element, Turn, Vec2, turn_angle};
use std::f64::consts::TAU;

impl Path {
    /// The same way in fewer elements, nowhere farther than `tolerance` mm from this one. Elements shorter
    /// than a quarter of that are dropped, what is as good as one line or one arc is one, and an arc with a
    /// radius of less than 10 µm is lines.
    /// What is closed stays closed, though it may begin elsewhere; a way back along itself stays a
    /// way back. `None` where nothing is left.
    pub fn merged(&self, tolerance: f64) -> Option<Path> {
        // Where something is dropped, starts move and centres follow, each by no more than a quarter; what
        // has become lines has no centre to follow.
        let elements: Vec<Element> =
            self.elements().iter().flat_map(|element| straight(element, tolerance / 4.0)).collect();
        let elements = without_short(&elements, tolerance / 4.0);
        let (merged, last) = merged(&elements, tolerance / 2.0);
        if self.is_closed() && last > 0 {
            // What ends at the start may go on there.
            let around = [&elements[last..], &elements[..last]].concat();
            let (other, _) = self::merged(&around, tolerance / 2.0);
            if other.len() < merged.len() {
                return Path::new(other);
            }
        }
        Path::new(merged)
    }
}

/// The greatest radius of an arc that is made of others, mm: what is flatter stays as it is.
const GREATEST: f64 = 1000.0;

/// The least radius of an arc, mm: ten steps of a machine. Of a smaller one a control sees the rounding of
/// its ends rather than the arc.
const LEAST: f64 = 0.01;

/// Lines for an arc whose radius is less than that are no more than so many.
const CHORDS: f64 = 64.0;

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

/// The element; but for an arc that is too small, or from end to end no farther than `within` mm from a line,
/// lines that are as near.
fn straight(element: &Element, within: f64) -> Vec<Element> {
    let Some(Turn { center, sweep }) = element.turn else { return vec![*element] };
    let radius = element.start.distance(center);
    // An arc is farthest from its chord in its middle: by the radius less the cosine of half its sweep.
    let widest = 2.0 * (1.0 - within / radius).clamp(-1.0, 1.0).acos();
    let chords = (sweep.abs() / widest).ceil().clamp(1.0, CHORDS);
    if radius >= LEAST && chords > 1.0 {
        return vec![*element];
    }
    let places = (1..chords as usize).map(|chord| element.at(chord as f64 / chords));
    let mut start = element.start;
    let line = |end| Element::line(std::mem::replace(&mut start, end), end);
    places.chain([element.end]).map(line).collect()
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
    let balances = start != end && balanced.distance(center) <= within;
    let center = if balances { balanced } else { center };
    let angle = turn_angle(start - center, end - center);
    let sweep_near = angle + TAU * ((sweep - angle) / TAU).round();
    if sweep_near * sweep > 0.0 {
        Element::arc(start, end, center, sweep_near)
    } else {
        Element::line(start, end)
    }
}

/// The chain in runs that are as good as one line or arc each, and where in it the last one begins.
fn merged(elements: &[Element], within: f64) -> (Vec<Element>, usize) {
    let mut merged = Vec::new();
    let (mut first, mut last) = (0, 0);
    while let Some(element) = elements.get(first) {
        last = first;
        // Longer and longer runs, until one is too long; then as long as may be.
        let rest = &elements[first..];
        let fit = |length: usize| rest.get(..length).and_then(|run| one(run, within));
        let (mut length, mut best) = (1, *element);
        let mut too_long = None;
        let mut next = 2;
        while too_long.is_none_or(|too_long| next < too_long) {
            match fit(next) {
                Some(found) => (length, best) = (next, found),
                None => too_long = Some(next),
            }
            next = match too_long {
                None => length + length.div_ceil(2),
                Some(too_long) => length.midpoint(too_long).max(length + 1),
            };
        }
        merged.push(best);
        first += length;
    }
    (merged, last)
}

/// The line or arc that is as good as the whole of `run`.
fn one(run: &[Element], within: f64) -> Option<Element> {
    let (start, end) = (run.first()?.start, run.last()?.end);
    let line = Element::line(start, end);
    if follows(run, within, |point| {
        let (from, along) = (point - start, (end - start).normalize_or_zero());
        (from.dot(along), along.perp_dot(from))
    }) {
        return Some(line);
    }
    let length: f64 = run.iter().map(Element::length).sum();
    let [p, q] = [length / 3.0, length * 2.0 / 3.0].map(|way| along(run, way));
    let center = center(start, p, q)?;
    let sense = (p - start).perp_dot(q - p).signum();
    // As often around as the points of the run are.
    let mut before = start;
    let mut sweep = 0.0;
    for point in points(run) {
        sweep += turn_angle(before - center, point - center);
        before = point;
    }
    let arc = spanning(&Element::arc(start, end, center, sweep), start, end, f64::INFINITY);
    let turn = arc.turn?;
    let radius = start.distance(turn.center);
    let (mut before, mut turned) = (start, 0.0);
    let fits = turn.sweep * sense > 0.0
        && turn.sweep.abs() <= TAU * (1.0 + 1e-9)
        && (LEAST..GREATEST).contains(&radius)
        && follows(run, within, |point| {
            turned += turn_angle(before - turn.center, point - turn.center);
            before = point;
            (turned * sense, point.distance(turn.center) - radius)
        });
    fits.then_some(arc)
}

/// Whether the points of `run` are within `within` mm of a course, and go on along it: `place` tells how far
/// along it a point is, and how far beside it, mm.
fn follows(run: &[Element], within: f64, mut place: impl FnMut(Vec2) -> (f64, f64)) -> bool {
    let mut before = 0.0;
    points(run).all(|point| {
        let (along, beside) = place(point);
        let onwards = along > before;
        before = along;
        onwards && beside.abs() <= within
    })
}

/// Points of a run, in order, the last of each element among them.
fn points(run: &[Element]) -> impl Iterator<Item = Vec2> {
    run.iter().flat_map(|element| [0.25, 0.5, 0.75, 1.0].map(|t| element.at(t)))
}

/// The point of a run `way` mm from its start.
fn along(run: &[Element], mut way: f64) -> Vec2 {
    let mut point = Vec2::ZERO;
    for element in run {
        let length = element.length();
        point = element.at(way / length);
        if way <= length {
            break;
        }
        way -= length;
    }
    point
}

/// The centre of the circle through three points; `None` where they are on a line.
fn center(a: Vec2, b: Vec2, c: Vec2) -> Option<Vec2> {
    let (b, c) = (b - a, c - a);
    let twice = 2.0 * b.perp_dot(c);
    let center = a + (b * c.length_squared() - c * b.length_squared()).perp() / twice;
    center.is_finite().then_some(center)
}
