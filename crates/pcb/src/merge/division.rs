//! The division of a path into the fewest elements.

use super::fit::Run;
use super::{LEAST, SHORT};
use geom::ending::go_on;
use geom::{Element, Turn, Vec2, turn_angle};
use std::f64::consts::{FRAC_PI_4, PI};

/// How far from a corner of the path an element may end, as a part of the tolerance: the rest is for rounding.
const OFF_CORNER: f64 = 0.9;

/// What turns by less, radians, may be a corner of two lines.
const BEND: f64 = 0.6 * PI;

/// Corners where no element can go on are those that are sharper than this many tolerances.
const SHARP: f64 = 2.0;

/// How many nodes before the farthest one that is reached with as many elements are looked at.
const BEHIND: usize = 1;

/// After this many nodes that an element does not reach none is looked for beyond.
const MISSED: usize = 2;

/// Beyond so many nodes an element is not tried to each.
const NEAR: usize = 16;

/// More pieces than these are divided side by side.
const LONG: usize = 256;

/// A path that is divided: pieces of its elements, and the nodes between them.
pub(super) struct Division {
    pieces: Vec<Element>,
    /// Of which element each piece is.
    element: Vec<usize>,
    /// Points of the pieces, for the guesses of fits.
    marks: Vec<Vec2>,
    /// Where the marks of each piece begin, and where they all end.
    first_mark: Vec<usize>,
    /// Before each piece, and at the end.
    nodes: Vec<Node>,
    tolerance: f64,
}

/// Where an element may end and the next one start.
struct Node {
    /// On the path, but for the middle of a bend; then next to it.
    places: [Vec2; 3],
    /// How many of them there are.
    count: usize,
    /// Whether the first is on the path.
    is_on: bool,
    /// Whether no element goes on here.
    is_sharp: bool,
}

/// How a point is reached best.
#[derive(Clone, Copy)]
struct Reached {
    /// By how many elements.
    elements: usize,
    /// Sum of the squares of how far they are from the path, in tolerances.
    strain: f64,
    /// From where the last of them leads: node and point.
    from: (usize, usize),
}

const NEVER: Reached = Reached { elements: usize::MAX, strain: f64::INFINITY, from: (0, 0) };

impl Division {
    /// Of `elements`, which go on from each other.
    pub(super) fn of(elements: &[Element], tolerance: f64) -> Division {
        let mut all = Division {
            pieces: Vec::with_capacity(elements.len() * 2),
            element: Vec::with_capacity(elements.len() * 2),
            marks: Vec::with_capacity(elements.len() * 4),
            first_mark: vec![0],
            nodes: Vec::with_capacity(elements.len() * 2),
            tolerance,
        };
        for (i, element) in elements.iter().enumerate() {
            go_on();
            let parts = all.parts(element);
            for part in 0..parts {
                let [from, to] = [part, part + 1].map(|part| part as f64 / parts as f64);
                let piece = element.part(from, to);
                let marks: &[f64] = if piece.turn.is_some_and(|turn| turn.sweep.abs() > 0.8) {
                    &[0.25, 0.5, 0.75]
                } else {
                    &[0.5]
                };
                all.marks.extend(marks.iter().map(|t| piece.at(*t)));
                all.marks.push(piece.end);
                all.first_mark.push(all.marks.len());
                all.pieces.push(piece);
                all.element.push(i);
            }
        }
        all.nodes = (0..=all.pieces.len()).map(|i| all.node(i)).collect();
        all
    }

    /// Into how many pieces an element is divided.
    fn parts(&self, element: &Element) -> usize {
        let Some(Turn { center, sweep }) = element.turn else { return 1 };
        let sweep = sweep.abs();
        if element.start.distance(center) < LEAST {
            // It becomes lines.
            return (sweep / FRAC_PI_4).ceil().clamp(1.0, 64.0) as usize;
        }
        let is_bend = sweep < BEND && apex(element) < 2.2 * self.tolerance;
        if is_bend || sweep > PI { 2 } else { 1 }
    }

    fn node(&self, i: usize) -> Node {
        let around = i
            .checked_sub(1)
            .and_then(|before| Some((self.pieces.get(before)?, self.pieces.get(i)?)));
        let Some((before, next)) = around else {
            let on = self.pieces.get(i).map(|piece| piece.start);
            let on = on.or(self.pieces.last().map(|piece| piece.end)).unwrap_or_default();
            return Node { places: [on; 3], count: 1, is_on: true, is_sharp: true };
        };
        let on = next.start;
        let (along, on_from) = (before.tangent(1.0), next.tangent(0.0));
        let is_sharp = self.is_sharp(before, next);
        let normal = (along + on_from).normalize_or_zero().perp();
        if let (Some(Turn { center, sweep }), true) = (next.turn, self.is_of(i, i - 1)) {
            // Of an arc between two lines, where these meet.
            let out = (on - center).normalize_or_zero();
            let whole = Element::arc(before.start, next.end, center, 2.0 * sweep);
            let apex = on + out * apex(&whole).min(0.97 * self.tolerance);
            let is_on = sweep.abs() > BEND / 2.0
                || self.is_of(i, i.wrapping_sub(2))
                || self.is_of(i, i + 1);
            return match is_on {
                true => Node { places: [on; 3], count: 1, is_on, is_sharp },
                false => Node { places: [apex; 3], count: 1, is_on, is_sharp },
            };
        }
        let off = normal * (OFF_CORNER * self.tolerance);
        Node {
            places: [on, on + off, on - off],
            count: if is_sharp { 1 } else { 3 },
            is_on: true,
            is_sharp,
        }
    }

    /// Whether two pieces are of one element.
    fn is_of(&self, i: usize, k: usize) -> bool {
        self.element.get(i).is_some_and(|element| self.element.get(k) == Some(element))
    }

    /// Whether no element goes on from one piece to the next.
    fn is_sharp(&self, before: &Element, next: &Element) -> bool {
        sharpness(before, next) > SHARP * self.tolerance
    }

    /// Whether no element goes on over the start of a closed path.
    pub(super) fn starts_sharp(&self) -> bool {
        let ends = self.pieces.last().zip(self.pieces.first());
        ends.is_some_and(|(before, next)| self.is_sharp(before, next))
    }

    /// The whole circle that is as good as a closed path.
    pub(super) fn circle(&self) -> Option<Element> {
        let is_round = self.pieces.len() > 2 && !self.starts_sharp();
        self.run(0, self.pieces.len()).circle(self.tolerance).filter(|_| is_round)
    }

    /// The fewest elements; among such, those that are nearest to the path. And of which element of the path the
    /// middle one of them starts.
    pub(super) fn fewest(&self) -> Option<(Vec<Element>, usize)> {
        let fewest = self.fewest_within(0, self.pieces.len())?;
        let middle = fewest.get(fewest.len() / 2).map_or(0, |(_, piece)| self.element[*piece]);
        Some((fewest.into_iter().map(|(element, _)| element).collect(), middle))
    }

    /// The fewest elements between two nodes at which they end in any case, and the piece at which each starts.
    fn fewest_within(&self, start: usize, end: usize) -> Option<Vec<(Element, usize)>> {
        if let Some(sharp) = self.parted(start, end) {
            let halves =
                rayon::join(|| self.fewest_within(start, sharp), || self.fewest_within(sharp, end));
            return Some([halves.0?, halves.1?].concat());
        }
        // From the start on.
        let mut reached = vec![[NEVER; 3]; end - start + 1];
        reached[0][0] = Reached { elements: 0, strain: 0.0, from: (start, 0) };
        // The farthest node that is reached with so many elements.
        let mut farthest = vec![start];
        let mut far = start;
        for node in start..end {
            go_on();
            let at = reached[node - start];
            let fewest = at.iter().map(|at| at.elements).min().unwrap_or(usize::MAX);
            if farthest.get(fewest).is_some_and(|far| *far <= node + BEHIND) {
                farthest.resize(farthest.len().max(fewest + 2), start);
                let onwards = &mut reached[node - start + 1..];
                far = self.reach(node, far.max(node + 1), end);
                self.onwards(
                    node,
                    fewest,
                    at,
                    &mut onwards[..far - node],
                    &mut farthest[fewest + 1],
                );
            }
        }
        let mut to = (end, 0);
        let mut fewest = Vec::new();
        while to.0 > start {
            let Reached { from, elements, .. } = reached[to.0 - start][to.1];
            if elements == usize::MAX {
                return None;
            }
            fewest.push((self.between(from, to)?, from.0));
            to = from;
        }
        fewest.reverse();
        Some(fewest)
    }

    /// Where the elements between two nodes are parted, so that both halves are found side by side.
    fn parted(&self, start: usize, end: usize) -> Option<usize> {
        let middle = start.midpoint(end);
        let sharp = (start + 1..end).filter(|node| self.nodes[*node].is_sharp);
        sharp.min_by_key(|node| node.abs_diff(middle)).filter(|_| end - start > LONG)
    }

    /// The element between two places.
    fn between(&self, from: (usize, usize), to: (usize, usize)) -> Option<Element> {
        let run = self.run(from.0, to.0);
        let fitted = || run.fitted(self.at(from), self.at(to), self.tolerance);
        self.whole(from, to).or_else(|| Some(run.nearest(fitted()?)))
    }

    /// Looks for elements from the points of a node, reached as `at` says, to those after it.
    fn onwards(
        &self,
        from: usize,
        elements: usize,
        at: [Reached; 3],
        reached: &mut [[Reached; 3]],
        farthest: &mut usize,
    ) {
        for node in (from + 1..=from + reached.len()).rev() {
            if node + BEHIND < *farthest {
                return;
            }
            for (place, at) in at.into_iter().enumerate() {
                if at.elements > elements {
                    continue;
                }
                let count = self.nodes[node].count;
                for (to, old) in reached[node - from - 1].iter_mut().enumerate().take(count) {
                    if (old.elements, old.strain) <= (elements + 1, at.strain) {
                        continue;
                    }
                    let Some(strain) = self.strain((from, place), (node, to)) else { continue };
                    *farthest = node.max(*farthest);
                    let strain = at.strain + strain;
                    if (elements + 1, strain) < (old.elements, old.strain) {
                        *old = Reached { elements: elements + 1, strain, from: (from, place) };
                    }
                }
            }
        }
    }

    /// The farthest node up to `end` to which one element may lead: `least` or one beyond it.
    fn reach(&self, from: usize, least: usize, end: usize) -> usize {
        let (mut far, mut missed) = (least, 0);
        for node in least..=(from + NEAR).min(end) {
            if self.leads(from, node, 2.0 * self.tolerance) {
                (far, missed) = (node, 0);
            } else {
                missed += 1;
            }
            if missed == MISSED || self.nodes[node].is_sharp {
                return far;
            }
        }
        // Longer and longer elements, until one is too long; then as long as may be.
        let (mut step, mut is_growing) = (NEAR, true);
        while step > 0 {
            let leads = far + step <= end && self.leads(from, far + step, self.tolerance);
            far += if leads { step } else { 0 };
            is_growing &= leads;
            step = if is_growing { step * 2 } else { step / 2 };
        }
        far
    }

    /// Whether an element may lead from one node to another: a guess.
    fn leads(&self, from: usize, to: usize, tolerance: f64) -> bool {
        let (start, end) = (self.at((from, 0)), self.at((to, 0)));
        start == end || self.run(from, to).bulges(start, end, tolerance).is_some()
    }

    /// How good an element between two places is; `None` where it is none.
    fn strain(&self, from: (usize, usize), to: (usize, usize)) -> Option<f64> {
        if self.whole(from, to).is_some() {
            return Some(0.0);
        }
        let (start, end) = (self.at(from), self.at(to));
        if start.distance(end) < SHORT * self.tolerance {
            return None;
        }
        let (_, away) = self.run(from.0, to.0).fitted(start, end, self.tolerance)?;
        Some((away / self.tolerance).powi(2))
    }

    /// The element, or part of it, of which all pieces between two nodes are.
    fn whole(&self, from: (usize, usize), to: (usize, usize)) -> Option<Element> {
        let is_on = |(node, place): (usize, usize)| place == 0 && self.nodes[node].is_on;
        if !is_on(from) || !is_on(to) || !self.is_of(from.0, to.0 - 1) {
            return None;
        }
        let (first, last) = (self.pieces[from.0], self.pieces[to.0 - 1]);
        let parts = (to.0 - from.0) as f64;
        let turn = first.turn.map(|turn| Turn { sweep: turn.sweep * parts, ..turn });
        let whole = Element { start: first.start, end: last.end, turn };
        let is_made = whole.length() >= SHORT * self.tolerance
            && whole.radius().is_none_or(|radius| radius >= LEAST);
        is_made.then_some(whole)
    }

    fn run(&self, from: usize, to: usize) -> Run<'_> {
        let marks = &self.marks[self.first_mark[from]..self.first_mark[to]];
        Run { pieces: &self.pieces[from..to], marks }
    }

    fn at(&self, (node, place): (usize, usize)) -> Vec2 {
        self.nodes[node].places[place]
    }
}

/// How far where the lines on along both ends of an arc meet is from its middle, mm.
fn apex(arc: &Element) -> f64 {
    let Some(Turn { center, sweep }) = arc.turn else { return 0.0 };
    arc.start.distance(center) * (1.0 / (sweep / 2.0).cos() - 1.0)
}

/// How far an element that goes on over the corner between two would be from it, roughly, mm.
pub(super) fn sharpness(before: &Element, next: &Element) -> f64 {
    let turn = turn_angle(before.tangent(1.0), next.tangent(0.0));
    let shorter = before.start.distance(before.end).min(next.start.distance(next.end));
    shorter / 4.0 * (turn.abs() / 4.0).tan()
}
