//! Elements as chords: what the kernel is given.

use super::kernel::{GridPoint, Keep, Kernel, Operand};
use super::{Fill, Region, RegionError, crossings, refit, step};
use crate::crossing::Carrier;
use crate::ending::{go_on, has_helper};
use crate::{Element, Turn, Vec2};
use std::f64::consts::TAU;

/// How far the middle of a chord is from its arc at most, mm: below this, arcs meet or miss each
/// other as their chords do.
const CHORD_ERROR: f64 = 0.0009;

/// The most edges of one boolean: 15 times as many as the largest real one that is known, a copper layer of the A64-OLinuXino (286,136). So many of discs that
/// overlap nothing take a helper 890 MB, 212 bytes an edge, and 4 s of the processor.
const MOST_EDGES: usize = 1 << 22;

/// So many crossings are taken however few elements there are: some 600 MB.
const MANY_CROSSINGS: usize = 1 << 20;

/// With more edges, and pairs of elements that may cross, than this a boolean may take longer than 10 ms, in which the kernel does not ask whether it goes on.
const LONG: usize = 8192;

/// An end of an arc stands for the place of the grid of angles that is this near, mm.
const SAME: f64 = 1e-6;

/// The boolean of what two sets of closed chains enclose, which may cross themselves and each other.
pub(super) fn boolean<'a>(
    first: impl Iterator<Item = &'a [Element]> + Clone,
    second: impl Iterator<Item = &'a [Element]> + Clone,
    keep: Keep,
    fill: Fill,
) -> Result<Region, RegionError> {
    let chains = first.clone().chain(second.clone());
    let (edges, elements) = (count(chains.clone()), len(chains.clone()));
    if edges > MOST_EDGES {
        return Err(RegionError::TooLarge { edges, most: MOST_EDGES });
    }
    if has_helper()
        && is_long(chains.clone(), edges, elements)
        && let Some(made) = step::helped(first.clone(), second.clone(), keep, fill)
    {
        return made;
    }
    let crossings = MANY_CROSSINGS.max(elements.saturating_mul(4));
    if all_pairs(elements) > crossings && crossings::pairs(chains, crossings).is_none() {
        return Err(RegionError::TooTangled { most: crossings });
    }
    let mut chords = Chords { kernel: Kernel::new(edges), sources: Vec::with_capacity(elements) };
    first.for_each(|chain| chords.add(chain, Operand::First));
    second.for_each(|chain| chords.add(chain, Operand::Second));
    Ok(refit::region(chords.kernel.islands(keep, fill), &chords.sources))
}

/// Whether the boolean of chains may take long.
fn is_long<'a>(chains: impl Iterator<Item = &'a [Element]>, edges: usize, elements: usize) -> bool {
    let is_with = |pairs: usize| edges.saturating_add(pairs) > LONG;
    is_with(0) || is_with(all_pairs(elements)) && crossings::pairs(chains, LONG).is_none_or(is_with)
}

/// How many pairs there are of so many elements, at the most.
fn all_pairs(elements: usize) -> usize {
    elements.saturating_mul(elements) / 2
}

/// How many elements the chains have.
fn len<'a>(chains: impl Iterator<Item = &'a [Element]>) -> usize {
    chains.map(<[Element]>::len).sum()
}

/// How many edges the chains become.
fn count<'a>(chains: impl Iterator<Item = &'a [Element]>) -> usize {
    let inner = |element: &Element| element.turn.map_or(0, |turn| Inner::of(element, turn).count());
    let edges = chains.inspect(|_| go_on()).flatten().map(|element| inner(element) + 1);
    edges.fold(0, usize::saturating_add)
}

/// What edges are pieces of: an element of an operand, and its whole line or circle.
pub(super) struct Source {
    pub element: Element,
    pub carrier: Carrier,
}

/// The operands of a boolean, as chords.
struct Chords {
    kernel: Kernel,
    sources: Vec<Source>,
}

impl Chords {
    fn add(&mut self, chain: &[Element], operand: Operand) {
        let starts = chain.iter().map(|element| GridPoint::of(element.start));
        let ends = starts.clone().cycle().skip(1);
        for (element, (mut from, end)) in chain.iter().zip(starts.zip(ends)) {
            go_on();
            // There are no more sources than edges.
            let source = self.sources.len() as u32;
            let carrier = if let Some(turn) = element.turn {
                let inner = Inner::of(element, turn);
                for place in inner.places() {
                    self.kernel.add(from, place, source, operand);
                    from = place;
                }
                Carrier::Circle { center: turn.center, radius: inner.radius }
            } else {
                Carrier::of(element, element.start)
            };
            self.sources.push(Source { element: *element, carrier });
            self.kernel.add(from, end, source, operand);
        }
    }
}

/// The inner ends of the chords of an arc.
///
/// They lie where its circle meets a grid of angles that depends on the radius alone, so that arcs on
/// top of each other have the same chords. The grid has the axes and the diagonals, where the circles
/// of a board touch.
struct Inner {
    center: Vec2,
    radius: f64,
    /// Steps of the grid in a turn.
    steps: i64,
    /// The first and the last step, in the order of the grid.
    first: i64,
    last: i64,
    backwards: bool,
}

impl Inner {
    fn of(element: &Element, turn: Turn) -> Inner {
        let spoke = element.start - turn.center;
        let radius = (spoke.length() + element.end.distance(turn.center)) / 2.0;
        // The middle of a chord over the angle a is r·(1 − cos(a/2)) ≤ r·a²/8 from its arc.
        let eighth = (TAU / (8.0 * CHORD_ERROR / radius).sqrt() / 8.0).ceil().max(1.0);
        let step = TAU / (8.0 * eighth);
        let from = spoke.to_angle();
        let (low, high) = (from.min(from + turn.sweep), from.max(from + turn.sweep));
        let margin = SAME / radius;
        Inner {
            center: turn.center,
            radius,
            steps: 8 * eighth as i64,
            first: (((low + margin) / step).floor() as i64).saturating_add(1),
            last: (((high - margin) / step).ceil() as i64).saturating_sub(1),
            backwards: turn.sweep < 0.0,
        }
    }

    fn count(&self) -> usize {
        usize::try_from(self.last.saturating_sub(self.first).saturating_add(1)).unwrap_or(0)
    }

    fn places(&self) -> impl Iterator<Item = GridPoint> {
        // Circles that are one but for rounding get the same places.
        let center = GridPoint::of(self.center).point();
        let radius = GridPoint::of(Vec2::splat(self.radius)).point().x;
        (0..self.count() as i64).map(move |i| {
            let step = if self.backwards { self.last - i } else { self.first + i };
            let angle = step.rem_euclid(self.steps) as f64 / self.steps as f64 * TAU;
            GridPoint::of(center + Vec2::from_angle(angle) * radius)
        })
    }
}
