//! From the chords of the kernel back to lines and arcs.
//!
//! Edges that follow each other on one line or circle are a run. Where two runs meet, the crossing of
//! their lines and circles takes the place of the crossing of their chords, and a run becomes one
//! element again. An arc turns by what its chords turn together: its ends alone would not tell a
//! whole circle from nothing.
//!
//! The chords cross nothing, but what is fitted lies up to [a chord's error](super::chords) beside
//! them. So elements that cross all the same are taken back to chords, where they do.

use super::crossings::crossings;
use super::kernel::Edge;
use super::{Island, Region, Ring};
use crate::crossing::Carrier;
use crate::{Element, Vec2, turn_angle};
use std::f64::consts::TAU;
use std::ops::Range;

/// Lines and circles within this of each other are one, mm.
const ALIKE: f64 = 1e-6;

/// A corner this near to its two lines or circles is where they cross, mm: some units of the kernel.
const ON: f64 = 4e-7;

/// How far from the crossing of the chords the crossing of their circles may be, mm, however flat they
/// run into each other.
const REACH: f64 = 1.0;

/// How far apart two lines or circles may be where their chords cross, mm: twice what a chord is beside
/// its arc, and twice that where the two bend apart.
const APART: f64 = 0.004;

/// Edges shorter than this are what rounding leaves; they have no direction of their own, mm.
const TINY: f64 = 5e-7;

/// What has less area for its boundary than a strip of this width is dropped, mm: chords of one circle
/// that are cut in two ways leave the like, up to two thirds of [a chord's error](super::chords) wide.
const THIN: f64 = 0.0007;

/// How often corners are looked for until all are where the chords cross.
const PASSES: usize = 8;

/// How often crossings are looked for until everything is left as chords.
const ROUNDS: usize = 8;

/// The region of `islands`, of whose edges `carriers` has the lines and circles.
pub(super) fn region(islands: Vec<Vec<Vec<Edge>>>, carriers: &[Carrier]) -> Region {
    let mut outlines = Vec::new();
    for (island, rings) in islands.into_iter().enumerate() {
        for (i, edges) in rings.into_iter().enumerate() {
            let outline = Outline::of(edges, carriers);
            if outline.elements.is_empty() {
                if i == 0 {
                    break;
                }
                continue;
            }
            outlines.push((island, outline));
        }
    }
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
        outlines.iter_mut().for_each(|(_, outline)| outline.fit(carriers));
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
    /// The line or circle they are on; `None` where they are left as chords.
    carrier: Option<usize>,
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
    /// Without elements where nothing is left of it.
    fn of(mut edges: Vec<Edge>, carriers: &[Carrier]) -> Outline {
        let mut before = edges.iter().rfind(|edge| !is_tiny(edge)).map_or(0, |edge| edge.carrier);
        let first = edges.iter().position(|edge| {
            let breaks = !is_tiny(edge) && !continues(before, edge, carriers);
            if !is_tiny(edge) {
                before = edge.carrier;
            }
            breaks
        });
        edges.rotate_left(first.unwrap_or(0));
        let mut runs: Vec<Run> = Vec::new();
        for (i, edge) in edges.iter().enumerate() {
            match runs.last_mut() {
                Some(run) if is_tiny(edge) || run.takes(edge, carriers) => run.edges.end = i + 1,
                _ => runs.push(Run {
                    edges: i..i + 1,
                    carrier: Some(edge.carrier),
                    keeps_corner: false,
                }),
            }
        }
        let mut outline = Outline { edges, runs, elements: Vec::new(), run_of: Vec::new() };
        outline.leave_chords(carriers);
        outline.fit(carriers);
        if outline.is_thin() {
            outline.elements.clear();
        }
        outline
    }

    /// Leaves as chords what does not go along its circle.
    fn leave_chords(&mut self, carriers: &[Carrier]) {
        for run in &mut self.runs {
            let edges = self.edges.get(run.edges.clone()).unwrap_or_default();
            if let Some(Carrier::Circle { center, radius }) =
                run.carrier.and_then(|c| carriers.get(c))
            {
                let length: f64 = edges.iter().map(length).sum();
                if sweep(edges, *center).abs() * radius < length / 2.0 {
                    run.carrier = None;
                }
            }
        }
    }

    fn is_thin(&self) -> bool {
        let Some(first) = self.elements.first() else { return true };
        let area: f64 = self.elements.iter().map(|element| element.area(first.start)).sum();
        let length: f64 = self.elements.iter().map(Element::length).sum();
        // A strip of width w and length l has the area w·l and the boundary 2·l.
        area.abs() * 2.0 < THIN * length
    }

    /// Makes elements of the runs.
    fn fit(&mut self, carriers: &[Carrier]) {
        for pass in 1..=PASSES {
            let corners: Vec<Corner> =
                (0..self.runs.len()).map(|i| self.corner(i, carriers)).collect();
            let turned = self.put_in(&corners, carriers);
            if turned.is_empty() {
                return;
            }
            for i in turned.into_iter().rev() {
                self.give_way(i, carriers);
            }
            if pass + 1 == PASSES {
                self.runs.iter_mut().for_each(|run| run.keeps_corner = true);
            }
        }
    }

    /// Puts the elements between the corners. Gives the runs that the corners turn round.
    fn put_in(&mut self, corners: &[Corner], carriers: &[Carrier]) -> Vec<usize> {
        let mut turned = Vec::new();
        self.elements.clear();
        self.run_of.clear();
        let nexts = corners.iter().cycle().skip(1);
        for (i, ((run, from), to)) in self.runs.iter().zip(corners).zip(nexts).enumerate() {
            let edges = self.edges.get(run.edges.clone()).unwrap_or_default();
            let on = run.carrier.and_then(|carrier| carriers.get(carrier));
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
    /// those beside it cross before it: then it goes. Otherwise its corners stay where the chords cross.
    fn give_way(&mut self, i: usize, carriers: &[Carrier]) {
        let n = self.runs.len();
        let next = (i + 1) % n;
        let (Some(run), Some(after)) = (self.runs.get(i), self.runs.get(next)) else { return };
        let short =
            self.edges.get(run.edges.clone()).unwrap_or_default().iter().map(length).sum::<f64>()
                < REACH;
        let place = self.vertex(after);
        let crossing = self.crossing((i + n - 1) % n, next, place, carriers);
        if n > 2 && short && crossing.is_some() {
            let gone = self.runs.remove(i).edges;
            // Its edges turn on with a neighbour.
            match i.checked_sub(1).and_then(|before| self.runs.get_mut(before)) {
                Some(before) => before.edges.end = gone.end,
                None => self.runs.iter_mut().take(1).for_each(|run| run.edges.start = gone.start),
            }
            return;
        }
        for k in [i, next] {
            if let Some(run) = self.runs.get_mut(k) {
                run.keeps_corner = true;
            }
        }
    }

    /// Where run `i` starts.
    fn corner(&self, i: usize, carriers: &[Carrier]) -> Corner {
        let Some(run) = self.runs.get(i) else { return Corner::default() };
        let chords = self.vertex(run);
        let before = (i + self.runs.len() - 1) % self.runs.len();
        let at = match run.carrier.and_then(|carrier| carriers.get(carrier)) {
            // A whole circle starts on its right.
            Some(Carrier::Circle { center, radius }) if before == i => {
                Some(*center + Vec2::X * *radius)
            }
            Some(_) if !run.keeps_corner => self.crossing(before, i, chords, carriers),
            _ => None,
        };
        Corner { chords, at: at.unwrap_or(chords) }
    }

    /// The place of the kernel where a run starts.
    fn vertex(&self, run: &Run) -> Vec2 {
        self.edges.get(run.edges.start).map_or(Vec2::ZERO, |edge| edge.start.point())
    }

    /// Where the lines or circles of two runs cross near `place`.
    fn crossing(
        &self,
        first: usize,
        next: usize,
        place: Vec2,
        carriers: &[Carrier],
    ) -> Option<Vec2> {
        let on = |i: usize| carriers.get(self.runs.get(i)?.carrier?);
        let (first, next) = (on(first)?, on(next)?);
        if is_on(first, place) && is_on(next, place) {
            return Some(place);
        }
        let crossings = first.meets(next, 0.0).into_iter().flatten();
        let crossing = crossings
            .min_by(|a, b| a.distance_squared(place).total_cmp(&b.distance_squared(place)))?;
        let way = crossing.distance(place);
        let across = first.direction_at(crossing).perp_dot(next.direction_at(crossing)).abs();
        (way < REACH && way * across < APART).then_some(crossing)
    }

    /// Leaves the run of an element as chords around `place`, or all runs. Tells whether that changes
    /// anything.
    fn unfit(&mut self, element: usize, place: Vec2, all: bool) -> bool {
        if all {
            let fitted = self.runs.iter().any(|run| run.carrier.is_some());
            self.runs.iter_mut().for_each(|run| run.carrier = None);
            return fitted;
        }
        let Some(&i) = self.run_of.get(element) else { return false };
        let Some(Run { edges, carrier: Some(carrier), .. }) = self.runs.get(i).cloned() else {
            return false;
        };
        let away = |edge: &Edge| line(edge).nearest(place).1;
        let all = self.edges.get(edges.clone()).unwrap_or_default();
        let nearest = all.iter().enumerate().min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)));
        let nearest = edges.start + nearest.map_or(0, |(i, _)| i);
        let (from, to) = (nearest.saturating_sub(1).max(edges.start), (nearest + 2).min(edges.end));
        let parts =
            [(edges.start..from, Some(carrier)), (from..to, None), (to..edges.end, Some(carrier))];
        let parts = parts.into_iter().filter(|(edges, _)| !edges.is_empty());
        let run = |(edges, carrier)| Run { edges, carrier, keeps_corner: false };
        self.runs.splice(i..=i, parts.map(run));
        true
    }
}

impl Run {
    /// Whether `edge`, which follows, is on the same line or circle.
    fn takes(&self, edge: &Edge, carriers: &[Carrier]) -> bool {
        self.carrier.is_some_and(|carrier| continues(carrier, edge, carriers))
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

/// Whether `edge` is on the same line or circle as the edges before it, which are on `carrier`.
fn continues(carrier: usize, edge: &Edge, carriers: &[Carrier]) -> bool {
    if carrier == edge.carrier {
        return true;
    }
    match (carriers.get(carrier), carriers.get(edge.carrier)) {
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
