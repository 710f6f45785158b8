//! Where elements of rings cross each other.

use super::index::tree;
use crate::crossing::Carrier;
use crate::ending::{go_on, is_ended};
use crate::{Element, Vec2};
use rayon::prelude::*;
use static_aabb2d_index::Control;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How deep two elements may cross and count as touching, mm: rounding of the kernel.
pub(super) const TOUCH: f64 = 2e-6;

/// So many pairs of elements whose boxes overlap are looked at for each crossing that is allowed.
const PAIRS_OF_A_CROSSING: usize = 32;

/// Where an element of a ring crosses another.
#[derive(Clone, Copy, Debug)]
pub(super) struct RingCrossing {
    pub ring: usize,
    pub element: usize,
    pub point: Vec2,
}

/// For each element of `rings` that crosses others one crossing, in their order.
pub(super) fn crossings(rings: &[&[Element]]) -> Vec<RingCrossing> {
    let elements: Vec<(usize, usize, &Element)> = rings
        .iter()
        .enumerate()
        .flat_map(|(r, ring)| ring.iter().enumerate().map(move |(e, element)| (r, e, element)))
        .collect();
    let boxes: Vec<(Vec2, Vec2)> =
        elements.iter().map(|(_, _, element)| element.extents()).collect();
    let Some(index) = tree(boxes.iter().copied()) else { return Vec::new() };
    let mut places: Vec<Option<Vec2>> = vec![None; elements.len()];
    let found = elements.par_iter().zip(&boxes).enumerate().flat_map_iter(|(i, of)| {
        let ((_, _, element), (low, high)) = of;
        let mut found = Vec::new();
        if is_ended() {
            return found;
        }
        index.visit_query(low.x, low.y, high.x, high.y, &mut |other: usize| {
            if let (true, Some((_, _, second))) = (other > i, elements.get(other))
                && let Some(point) = crossing(element, second)
            {
                found.extend([(i, point), (other, point)]);
            }
            Control::<()>::Continue
        });
        found
    });
    let found: Vec<_> = found.collect();
    go_on();
    for (i, point) in found {
        if let Some(place) = places.get_mut(i) {
            *place = Some(point);
        }
    }
    let found = elements.iter().zip(places);
    found
        .filter_map(|((ring, element, _), point)| {
            Some(RingCrossing { ring: *ring, element: *element, point: point? })
        })
        .collect()
}

/// How many pairs of elements of `chains` have boxes that overlap, so that they may cross or touch; none where more than `most` pairs cross, or more pairs are
/// looked at than that many crossings are worth.
pub(super) fn pairs<'a>(chains: impl Iterator<Item = &'a [Element]>, most: usize) -> Option<usize> {
    let elements: Vec<&Element> = chains.flatten().collect();
    let boxes: Vec<(Vec2, Vec2)> = elements.iter().map(|element| element.extents()).collect();
    let Some(index) = tree(boxes.iter().copied()) else { return Some(0) };
    let (pairs, found) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let is_enough = || {
        found.load(Ordering::Relaxed) > most
            || pairs.load(Ordering::Relaxed) > most.saturating_mul(PAIRS_OF_A_CROSSING)
    };
    elements.par_iter().zip(&boxes).enumerate().for_each(|(i, (element, (low, high)))| {
        if is_ended() {
            return;
        }
        index.visit_query(low.x, low.y, high.x, high.y, &mut |other: usize| {
            let second = elements.get(other).filter(|_| other > i);
            if let Some(second) = second {
                found
                    .fetch_add(usize::from(crossing(element, second).is_some()), Ordering::Relaxed);
                pairs.fetch_add(1, Ordering::Relaxed);
            }
            if is_enough() { Control::Break(()) } else { Control::Continue }
        });
    });
    go_on();
    (!is_enough()).then(|| pairs.into_inner())
}

/// Where two elements cross deeper than by rounding.
fn crossing(first: &Element, second: &Element) -> Option<Vec2> {
    let mut crossings = first.crossings(second).map(|crossing| crossing.point);
    let (one, other) = (crossings.next(), crossings.next());
    let ends = [first.start, first.end, second.start, second.end];
    let is_deep = |point: Vec2, other: Option<Vec2>| {
        let direction = |of: &Element| Carrier::of(of, of.start).direction_at(point);
        let across = direction(first).perp_dot(direction(second)).abs();
        // Between here and an end, or the other crossing, the two get no farther apart than the distance
        // times the angle between them.
        let mut apart = ends.iter().copied().chain(other).map(|end| end.distance(point) * across);
        apart.all(|apart| apart > TOUCH)
    };
    one.filter(|point| is_deep(*point, other)).or(other.filter(|point| is_deep(*point, one)))
}
