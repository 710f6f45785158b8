//! The order of openings: inner before outer, then short travel.

use crate::contour::Contour;
use geom::Vec2;

/// How often the order is gone through for a better one.
const SWEEPS: usize = 8;

/// More openings than this stay in the order of always the nearest next.
const IMPROVED: usize = 2000;

/// The order in which to cut `contours` that are threaded at `threads`, beginning with the first that
/// may be. What lies within another is cut before it: the outer one takes the part away.
pub(crate) fn order(contours: &[&Contour], threads: &[Vec2]) -> Vec<usize> {
    let inner = inner(contours);
    let mut order = nearest_next(&inner, threads);
    if order.len() <= IMPROVED {
        for _ in 0..SWEEPS {
            if !improve(&mut order, &inner, threads) {
                break;
            }
        }
    }
    order
}

/// For each contour those that lie within it.
fn inner(contours: &[&Contour]) -> Vec<Vec<usize>> {
    let boxes: Vec<(Vec2, Vec2)> = contours.iter().map(|contour| contour.extents()).collect();
    let within = |outer: usize, inner: usize| -> bool {
        let (Some((low, high)), Some((p, q))) = (boxes.get(outer), boxes.get(inner)) else {
            return false;
        };
        let (Some(around), Some(contour)) = (contours.get(outer), contours.get(inner)) else {
            return false;
        };
        // Of two that cover each other neither is the inner one.
        contour.area().abs() < around.area().abs()
            && low.cmple(*p).all()
            && high.cmpge(*q).all()
            && around.encloses(contour.start())
    };
    let all = 0..contours.len();
    all.clone().map(|outer| all.clone().filter(|i| within(outer, *i)).collect()).collect()
}

/// Always the nearest of those whose inner ones are done.
fn nearest_next(inner: &[Vec<usize>], threads: &[Vec2]) -> Vec<usize> {
    let mut done = vec![false; inner.len()];
    let mut order: Vec<usize> = Vec::with_capacity(inner.len());
    while order.len() < inner.len() {
        let may = |i: &usize| !done[*i] && inner[*i].iter().all(|j| done[*j]);
        let open = (0..inner.len()).filter(may);
        let next = match order.last() {
            None => open.min(),
            Some(last) => open.min_by(|i, j| {
                let distance = |i: usize| threads[i].distance_squared(threads[*last]);
                distance(*i).total_cmp(&distance(*j))
            }),
        };
        let Some(next) = next else { break };
        done[next] = true;
        order.push(next);
    }
    order
}

/// Moves single openings to where they shorten the route; whether any was moved.
fn improve(order: &mut Vec<usize>, inner: &[Vec<usize>], threads: &[Vec2]) -> bool {
    let mut better = false;
    for from in 1..order.len() {
        let moved = order[from];
        let distance = |i: Option<&usize>, j: Option<&usize>| match (i, j) {
            (Some(i), Some(j)) => threads[*i].distance(threads[*j]),
            _ => 0.0,
        };
        let (before, after) = (order.get(from - 1), order.get(from + 1));
        let saved = distance(before, Some(&moved)) + distance(Some(&moved), after)
            - distance(before, after);
        // After everything within it, and before everything around it.
        let first = (0..from).rev().find(|i| inner[moved].contains(&order[*i])).unwrap_or(0);
        let last = (from + 1..order.len()).find(|i| inner[order[*i]].contains(&moved));
        let last = last.unwrap_or(order.len());
        let places = (first + 1..last + 1).filter(|to| *to != from && *to != from + 1);
        let cost = |to: usize| {
            let (p, q) = (order.get(to - 1), order.get(to));
            distance(p, Some(&moved)) + distance(Some(&moved), q) - distance(p, q)
        };
        let best = places.map(|to| (to, cost(to))).min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((to, cost)) = best
            && cost < saved - 1e-9
        {
            order.remove(from);
            order.insert(if to > from { to - 1 } else { to }, moved);
            better = true;
        }
    }
    better
}
