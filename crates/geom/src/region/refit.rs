//! From the chords of the kernel back to lines and arcs.
//!
//! Edges that follow each other on one line or circle are a run. Where two runs meet, the crossing of
//! their lines and circles takes the place of the crossing of their chords, and a run becomes one
//! element again. An arc turns by what its chords turn together: its ends alone would not distinguish a
//! whole circle from a point.
//!
//! The chords cross nothing, but what is fitted lies up to [a chord's error](super::chords) away from
//! them. Elements that cross nevertheless become chords again, where they cross.

use super::chords::Source;
use super::crossings::{TOUCH, crossings};
use super::index::tree;
use super::kernel::{Edge, GridPoint};
use super::{Island, Region, Ring};
use crate::crossing::Carrier;
use crate::ending::{go_on, is_ended};
use crate::{Element, Vec2, turn_angle};
use rayon::prelude::*;
use std::collections::VecDeque;
use std::f64::consts::TAU;
use std::ops::Range;

/// Lines and circles within this of each other are one, mm.
const ALIKE: f64 = 1e-6;

/// A corner this near to its two lines or circles is where they cross, mm: some units of the kernel.
const ON: f64 = 4e-7;

/// How far from the crossing of the chords the crossing of their circles may be, mm, however flat they
/// run into each other.
const REACH: f64 = 1.0;

/// How far apart two lines or circles may be where their chords cross, mm: twice the distance of a chord from
/// its arc, and twice that where the two bend apart.
const APART: f64 = 0.004;

/// How far from their own chords and elements corners and runs may be put, mm: what is promised.
const NEAR: f64 = 0.001;

/// Edges shorter than this are what rounding leaves; they have no direction of their own, mm.
const TINY: f64 = 5e-7;

/// What has less area for its boundary than a strip of this width, and is thin everywhere, is dropped, mm:
/// chords of one circle that are cut in two ways leave the like, up to two thirds of
/// [a chord's error](super::chords) wide.
const THIN: f64 = 0.0007;

/// How often corners are looked for until all are where the chords cross.
const PASSES: usize = 8;

/// How often crossings are looked for until everything is left as chords.
const ROUNDS: usize = 8;

/// The region of `islands`, whose edges are pieces of `sources`.
pub(super) fn region(islands: Vec<Vec<Vec<Edge>>>, sources: &[Source]) -> Region {
    let outlines = islands.into_par_iter().enumerate().flat_map_iter(|(island, rings)| {
        let outlines = if is_ended() { Vec::new() } else { Outline::of_island(rings, sources) };
        outlines.into_iter().map(move |outline| (island, outline))
    });
    let mut outlines: Vec<(usize, Outline)> = outlines.collect();
    go_on();
    for round in 1..=ROUNDS {
        let rings: Vec<&[Element]> = outlines.iter().map(|(_, o)| &*o.elements).collect();
        let mut found = false;
        // From the last element on, as the runs of those before it then keep their numbers.
        for place in crossings(&rings).into_iter().rev() {
            if let Some((_, outline)) = outlines.get_mut(place.ring) {
                found |= outline.unfit(place.element, place.point, round == ROUNDS);
            }
        }
        if !found {
            break;
        }
        outlines
            .par_iter_mut()
            .filter(|_| !is_ended())
            .for_each(|(_, outline)| outline.fit(sources));
        go_on();
    }
    let mut region = Region::default();
    let mut last = None;
    for (island, outline) in outlines {
        let ring = Ring { elements: outline.elements };
        match region.islands.last_mut() {
            Some(open) if last == Some(island) => open.holes.push(ring),
            _ => region.islands.push(Island { outer: ring, holes: Vec::new() }),
        }
        last = Some(island);
    }
    region
}

/// Edges that follow each other.
#[derive(Clone)]
struct Run {
    edges: Range<usize>,
    /// The number of an element on whose line or circle they are; `None` where they are left as chords.
    source: Option<usize>,
    /// Whether it starts where the chords cross.
    keeps_corner: bool,
}

/// A ring of the kernel and what is fitted to it.
struct Outline {
    edges: Vec<Edge>,
    runs: Vec<Run>,
    elements: Vec<Element>,
    /// Of each element its run.
    run_of: Vec<usize>,
}

impl Outline {
    /// Those of an island that are something; none where the outer one is nothing.
    fn of_island(rings: Vec<Vec<Edge>>, sources: &[Source]) -> Vec<Outline> {
        let mut outlines = Vec::with_capacity(rings.len());
        for (i, edges) in rings.into_iter().enumerate() {
            let outline = Outline::of(edges, sources);
            match outline.is_nothing(i > 0) {
                true if i == 0 => break,
                true => {}
                false => outlines.push(outline),
            }
        }
        outlines
    }

    fn of(edges: Vec<Edge>, sources: &[Source]) -> Outline {
        let mut edges = without_slits(edges);
        let mut before = edges.iter().rfind(|edge| !is_tiny(edge)).map_or(0, |edge| edge.source);
        let first = edges.iter().position(|edge| {
            let breaks = !is_tiny(edge) && !continues(before, edge, sources);
            if !is_tiny(edge) {
                before = edge.source;
            }
            breaks
        });
        edges.rotate_left(first.unwrap_or(0));
        let mut runs: Vec<Run> = Vec::new();
        for (i, edge) in edges.iter().enumerate() {
            go_on();
            match runs.last_mut() {
                Some(run) if is_tiny(edge) || run.takes(edge, sources) => run.edges.end = i + 1,
                _ => runs.push(Run {
                    edges: i..i + 1,
                    source: Some(edge.source),
                    keeps_corner: false,
                }),
            }
        }
        let mut outline = Outline { edges, runs, elements: Vec::new(), run_of: Vec::new() };
        outline.leave_chords(sources);
        outline.fit(sources);
        outline
    }

    /// Leaves as chords what does not go along its circle.
    fn leave_chords(&mut self, sources: &[Source]) {
        for run in &mut self.runs {
            let edges = self.edges.get(run.edges.clone()).unwrap_or_default();
            if let Some(Carrier::Circle { center, radius }) = run.carrier(sources) {
                let length: f64 = edges.iter().map(length).sum();
                if sweep(edges, *center).abs() * radius < length / 2.0 {
                    run.source = None;
                }
            }
        }
    }

    /// Whether nothing is left of it: circles that cross where their chords do not may even turn it inside
    /// out.
    fn is_nothing(&self, is_hole: bool) -> bool {
        let Some(first) = self.elements.first() else { return true };
        let area: f64 = self.elements.iter().map(|element| element.area(first.start)).sum();
        let length: f64 = self.elements.iter().map(Element::length).sum();
        let inside = if is_hole { -area } else { area };
        // A strip of width w and length l has the area w·l and the boundary 2·l.
        inside <= 0.0 || inside * 2.0 < THIN * length && self.is_thin()
    }

    /// Whether it is so thin everywhere, and not only in the middle.
    fn is_thin(&self) -> bool {
        let lines: Vec<Element> = self.edges.iter().map(line).collect();
        let Some(tree) = tree(lines.iter().map(Element::extents)) else { return true };
        lines.iter().enumerate().all(|(i, line)| {
            let middle = line.at(0.5);
            let (low, high) = (middle - NEAR, middle + NEAR);
            let opposite =
                |k: &usize| *k != i && lines.get(*k).is_some_and(|line| line.away(middle) < NEAR);
            tree.query_iter(low.x, low.y, high.x, high.y).any(|k| opposite(&k))
        })
    }

    /// Makes elements of the runs.
    fn fit(&mut self, sources: &[Source]) {
        for pass in 1..=PASSES {
            let corners: Vec<Corner> =
                (0..self.runs.len()).map(|i| self.corner(i, sources)).collect();
            let turned = self.put_in(&corners, sources);
            if turned.is_empty() {
                return;
            }
            for i in turned.into_iter().rev() {
                self.give_way(i, sources);
            }
            if pass + 1 == PASSES {
                self.runs.iter_mut().for_each(|run| run.keeps_corner = true);
            }
        }
    }

    /// Puts the elements between the corners. Gives the runs that the corners turn round.
    fn put_in(&mut self, corners: &[Corner], sources: &[Source]) -> Vec<usize> {
        let mut turned = Vec::new();
        self.elements.clear();
        self.run_of.clear();
        let nexts = corners.iter().cycle().skip(1);
        for (i, ((run, from), to)) in self.runs.iter().zip(corners).zip(nexts).enumerate() {
            go_on();
            let edges = self.edges.get(run.edges.clone()).unwrap_or_default();
            let on = run.carrier(sources);
            match on.map(|on| fitted_to(on, edges, *from, *to)) {
                Some(Some(element)) => {
                    // An arc that does not go through the crossing of the chords is led there.
                    let lead = |from, to| (from != to).then(|| Element::line(from, to));
                    self.elements.extend(lead(from.at, element.start));
                    self.elements.push(element);
                    self.elements.extend(lead(element.end, to.at));
                }
                Some(None) if from.is_moved() || to.is_moved() => turned.push(i),
                _ => self.elements.extend(edges.iter().map(line)),
            }
            self.run_of.resize(self.elements.len(), i);
        }
        turned
    }

    /// Where a run is turned round by its corners, three lines or circles meet nearly in one point, and
    /// its neighbours cross before it: then it goes, if its edges are as good as a neighbour's. Otherwise
    /// its corners stay where the chords cross.
    fn give_way(&mut self, i: usize, sources: &[Source]) {
        let n = self.runs.len();
        let (before, next) = ((i + n - 1) % n, (i + 1) % n);
        let Some(edges) = self.runs.get(i).map(|run| run.edges.clone()) else { return };
        // The ring is cut before its first run.
        let heir = [(before, next, i > 0), (next, i, next > 0)].into_iter().find(
            |&(heir, corner, joins)| {
                let place = self.runs.get(corner).map(|run| self.vertex(run));
                let crosses = |place| self.crossing(before, next, place, sources).is_some();
                joins && self.is_along(heir, &edges, sources) && place.is_some_and(crosses)
            },
        );
        if let (true, Some((heir, ..))) = (n > 2, heir) {
            if let Some(heir) = self.runs.get_mut(heir) {
                heir.edges = heir.edges.start.min(edges.start)..heir.edges.end.max(edges.end);
            }
            self.runs.remove(i);
            return;
        }
        for k in [i, next] {
            if let Some(run) = self.runs.get_mut(k) {
                run.keeps_corner = true;
            }
        }
    }

    /// Whether `edges` are along the line or circle of a run.
    fn is_along(&self, i: usize, edges: &Range<usize>, sources: &[Source]) -> bool {
        let edges = self.edges.get(edges.clone()).unwrap_or_default();
        let carrier = self.runs.get(i).and_then(|run| run.carrier(sources));
        carrier.is_some_and(|carrier| {
            let near = |place: GridPoint| carrier.distance(place.point()) < NEAR;
            edges.iter().all(|edge| near(edge.start) && near(edge.end))
        })
    }

    /// Where run `i` starts.
    fn corner(&self, i: usize, sources: &[Source]) -> Corner {
        go_on();
        let Some(run) = self.runs.get(i) else { return Corner::default() };
        let chords = self.vertex(run);
        let before = (i + self.runs.len() - 1) % self.runs.len();
        let at = match run.carrier(sources) {
            // A whole circle starts on its right.
            Some(Carrier::Circle { center, radius }) if before == i => {
                Some(*center + Vec2::X * *radius)
            }
            Some(_) if !run.keeps_corner => self.crossing(before, i, chords, sources),
            _ => None,
        };
        Corner { chords, at: at.unwrap_or(chords) }
    }

    /// The point of the kernel's grid where a run starts.
    fn vertex(&self, run: &Run) -> Vec2 {
        self.edges.get(run.edges.start).map_or(Vec2::ZERO, |edge| edge.start.point())
    }

    /// Where the lines or circles of two runs cross near `place`.
    fn crossing(&self, first: usize, next: usize, place: Vec2, sources: &[Source]) -> Option<Vec2> {
        let on = |i: usize| self.runs.get(i)?.carrier(sources);
        let (on_first, on_next) = (on(first)?, on(next)?);
        if is_on(on_first, place) && is_on(on_next, place) {
            return Some(place);
        }
        let near = |crossing: &Vec2| {
            let distance = crossing.distance(place);
            let across = on_first.direction_at(*crossing).perp_dot(on_next.direction_at(*crossing));
            distance < REACH && distance * across.abs() < APART
        };
        let reached = |crossing: &Vec2| {
            [first, next].into_iter().all(|i| self.reaches(i, *crossing, sources))
        };
        let crossings = on_first.meets(on_next, 0.0).into_iter().flatten();
        crossings
            .filter(|crossing| near(crossing) && reached(crossing))
            .min_by(|a, b| a.distance_squared(place).total_cmp(&b.distance_squared(place)))
    }

    /// Whether the elements that a run is made of pass `place`, and not only their lines or circles do.
    fn reaches(&self, i: usize, place: Vec2, sources: &[Source]) -> bool {
        let edges = self.runs.get(i).and_then(|run| self.edges.get(run.edges.clone()));
        let mut pieces = edges.unwrap_or_default().chunk_by(|a, b| a.source == b.source);
        pieces.any(|piece| {
            let source = piece.first().and_then(|edge| sources.get(edge.source));
            source.is_some_and(|source| source.element.away(place) < NEAR)
        })
    }

    /// Leaves the run of an element as chords around `place`, or all runs. Tells whether that changes
    /// anything.
    fn unfit(&mut self, element: usize, place: Vec2, all: bool) -> bool {
        if all {
            let fitted = self.runs.iter().any(|run| run.source.is_some());
            self.runs.iter_mut().for_each(|run| run.source = None);
            return fitted;
        }
        let Some(&i) = self.run_of.get(element) else { return false };
        let Some(Run { edges, source: Some(source), .. }) = self.runs.get(i).cloned() else {
            return false;
        };
        let away = |edge: &Edge| line(edge).nearest(place).1;
        let all = self.edges.get(edges.clone()).unwrap_or_default();
        let nearest = all.iter().enumerate().min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)));
        let nearest = edges.start + nearest.map_or(0, |(i, _)| i);
        let (from, to) = (nearest.saturating_sub(1).max(edges.start), (nearest + 2).min(edges.end));
        let parts =
            [(edges.start..from, Some(source)), (from..to, None), (to..edges.end, Some(source))];
        let parts = parts.into_iter().filter(|(edges, _)| !edges.is_empty());
        let run = |(edges, source)| Run { edges, source, keeps_corner: false };
        self.runs.splice(i..=i, parts.map(run));
        true
    }
}

impl Run {
    /// Whether `edge`, which follows, is on the same line or circle.
    fn takes(&self, edge: &Edge, sources: &[Source]) -> bool {
        self.source.is_some_and(|source| continues(source, edge, sources))
    }

    /// The line or circle that it is fitted to.
    fn carrier<'a>(&self, sources: &'a [Source]) -> Option<&'a Carrier> {
        Some(&sources.get(self.source?)?.carrier)
    }
}

/// Where two runs meet.
#[derive(Clone, Copy, Default)]
struct Corner {
    /// Where their chords cross.
    chords: Vec2,
    /// Where their lines or circles do.
    at: Vec2,
}

impl Corner {
    fn is_moved(self) -> bool {
        self.at != self.chords
    }
}

/// The element on a line or circle that `edges` become between two corners; `None` where it would turn
/// round.
fn fitted_to(on: &Carrier, edges: &[Edge], from: Corner, to: Corner) -> Option<Element> {
    match on {
        Carrier::Line { .. } => {
            let along = (to.at - from.at).dot(to.chords - from.chords) > 0.0;
            along.then(|| Element::line(from.at, to.at))
        }
        Carrier::Circle { center, radius } => {
            let nearest = |point: Vec2| match is_on(on, point) {
                true => point,
                false => *center + (point - *center).normalize_or_zero() * *radius,
            };
            let chords = sweep(edges, *center);
            let moved = |corner: Corner| turn_angle(corner.chords - *center, corner.at - *center);
            let whole = from.at == to.at && chords.abs() > 1.0;
            let sweep = match whole {
                true => TAU.copysign(chords),
                false => chords - moved(from) + moved(to),
            };
            let along = sweep * chords > 0.0 && sweep.abs() <= TAU && sweep.abs() * radius > TINY;
            along.then(|| Element::arc(nearest(from.at), nearest(to.at), *center, sweep))
        }
    }
}

/// The angle that `edges` turn about `center` together, radians.
fn sweep(edges: &[Edge], center: Vec2) -> f64 {
    edges
        .iter()
        .map(|edge| turn_angle(edge.start.point() - center, edge.end.point() - center))
        .sum()
}

/// A ring without the parts of it that go back on themselves.
fn without_slits(edges: Vec<Edge>) -> Vec<Edge> {
    let mut kept = VecDeque::with_capacity(edges.len());
    for edge in edges {
        follow(&mut kept, edge);
    }
    // The last edge may go back on the first.
    while let (Some(last), Some(first)) = (kept.back(), kept.front())
        && kept.len() > 2
        && goes_back(last, first)
        && let Some(first) = kept.pop_front()
    {
        follow(&mut kept, first);
    }
    kept.into()
}

/// Adds an edge, but for what of it goes back on those before it.
fn follow(kept: &mut VecDeque<Edge>, mut edge: Edge) {
    while let Some(last) = kept.back().copied().filter(|last| goes_back(last, &edge)) {
        kept.pop_back();
        let longer = if length(&last) < length(&edge) { edge } else { last };
        edge = Edge { start: last.start, end: edge.end, source: longer.source };
    }
    if edge.start != edge.end {
        kept.push_back(edge);
    }
}

/// Whether two edges that follow each other lie on each other, but for rounding.
fn goes_back(first: &Edge, next: &Edge) -> bool {
    let (from, tip, to) = (first.start.point(), next.start.point(), next.end.point());
    (tip - from).dot(to - tip) < 0.0
        && (line(first).away(to) < TOUCH || line(next).away(from) < TOUCH)
}

fn line(edge: &Edge) -> Element {
    Element::line(edge.start.point(), edge.end.point())
}

fn length(edge: &Edge) -> f64 {
    edge.start.point().distance(edge.end.point())
}

fn is_tiny(edge: &Edge) -> bool {
    length(edge) < TINY
}

fn is_on(carrier: &Carrier, point: Vec2) -> bool {
    carrier.distance(point) < ON
}

/// Whether `edge` is on the same line or circle as the edges before it, which are pieces of `source`.
fn continues(source: usize, edge: &Edge, sources: &[Source]) -> bool {
    if source == edge.source {
        return true;
    }
    let carrier = |i: usize| sources.get(i).map(|source| &source.carrier);
    match (carrier(source), carrier(edge.source)) {
        (Some(line @ Carrier::Line { .. }), Some(Carrier::Line { .. })) => {
            line.distance(edge.start.point()) < ALIKE && line.distance(edge.end.point()) < ALIKE
        }
        (
            Some(Carrier::Circle { center, radius }),
            Some(Carrier::Circle { center: other, radius: second }),
        ) => center.distance(*other) < ALIKE && (radius - second).abs() < ALIKE,
        _ => false,
    }
}
