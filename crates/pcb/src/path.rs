//! Paths of a tool over the board.

use crate::SAME;
use geom::region::{Index, Ring};
use geom::{Element, Vec2};
use std::iter;

/// A chain of lines and arcs, each of which starts where the one before ends, bit for bit; at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    elements: Vec<Element>,
}

/// A point on a path, by its element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Index of its element.
    pub element: usize,
    /// How far along the element, from 0 at its start to below 1.
    pub t: f64,
}

/// How many points of one element are looked at, at most.
const MOST_POINTS: f64 = 1000.0;

impl Path {
    /// The path along `elements`; `None` where there are none. Where one does not start where the one
    /// before ends, its start is put there: ends apart by more than rounding are the caller's mistake.
    pub fn new(mut elements: Vec<Element>) -> Option<Path> {
        let mut end = elements.first()?.start;
        for element in &mut elements {
            element.start = end;
            end = element.end;
        }
        Some(Path { elements })
    }

    /// Once around `ring`, which is on the left of a path around an island, and on the right of one around
    /// a hole.
    pub fn around(ring: &Ring) -> Option<Path> {
        let mut path = Path::new(ring.elements().to_vec())?;
        // Elements of a ring meet to rounding.
        let start = path.start();
        if let Some(last) = path.elements.last_mut() {
            last.end = start;
        }
        Some(path)
    }

    /// Its elements, in the order of travel.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Where it begins, mm.
    pub fn start(&self) -> Vec2 {
        self.elements[0].start
    }

    /// Where it ends, mm.
    pub fn end(&self) -> Vec2 {
        self.elements[self.elements.len() - 1].end
    }

    /// Whether it ends where it begins.
    pub fn is_closed(&self) -> bool {
        self.start() == self.end()
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.elements.iter().map(Element::length).sum()
    }

    /// The same closed path with another start; the same where it is not closed.
    pub fn starting_at(&self, point: PathPoint) -> Path {
        let (Some(cut), true) = (self.elements.get(point.element), self.is_closed()) else {
            return self.clone();
        };
        if let ([_], Some(_)) = (&self.elements[..], cut.turn) {
            // A circle stays one.
            let start = cut.at(point.t);
            return Path { elements: vec![Element { start, end: start, ..*cut }] };
        }
        let (before, after) =
            (&self.elements[..point.element], &self.elements[point.element + 1..]);
        let mut elements = Vec::with_capacity(self.elements.len() + 1);
        elements.push(cut.part(point.t, 1.0));
        elements.extend(after);
        elements.extend(before);
        if point.t > 0.0 {
            elements.push(cut.part(0.0, point.t));
        }
        Path { elements }
    }

    /// Where it may begin: at its corners, and on elements longer than `stride` mm as often as that, evenly.
    pub(crate) fn points(&self, stride: f64) -> impl Iterator<Item = PathPoint> {
        self.elements.iter().enumerate().flat_map(move |(element, long)| {
            let parts = (long.length() / stride).ceil().clamp(1.0, MOST_POINTS);
            (0..parts as usize).map(move |part| PathPoint { element, t: part as f64 / parts })
        })
    }

    /// The point of a place on it, mm; its start where there is no such place.
    pub fn at(&self, point: PathPoint) -> Vec2 {
        self.elements.get(point.element).map_or(self.start(), |element| element.at(point.t))
    }

    /// Its place nearest to `point`; the end of an element is the start of the next.
    pub fn nearest(&self, point: Vec2) -> PathPoint {
        let all = self.elements.iter().enumerate().map(|(i, element)| (i, element.nearest(point)));
        let nearest = all.min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let (element, (t, _)) = nearest.unwrap_or_default();
        let length = self.elements.get(element).map_or(0.0, Element::length);
        match (t * length <= SAME, (1.0 - t) * length <= SAME) {
            (true, _) => PathPoint { element, t: 0.0 },
            (_, true) => PathPoint { element: (element + 1) % self.elements.len(), t: 0.0 },
            _ => PathPoint { element, t },
        }
    }

    /// The same path, run backwards.
    pub fn reversed(&self) -> Path {
        Path { elements: self.elements.iter().rev().map(Element::reversed).collect() }
    }

    /// The parts of it that are in the region of which `area` is the boundary, in their order. On the
    /// boundary the answer may be either.
    pub fn within(&self, area: &Index) -> Vec<Path> {
        let mut parts: Vec<Vec<Element>> = Vec::new();
        let mut was_inside = false;
        for piece in self.elements.iter().flat_map(|element| pieces(element, area)) {
            let is_inside = area.island_at(piece.at(0.5)).is_some();
            match parts.last_mut() {
                Some(part) if is_inside && was_inside => part.push(piece),
                _ if is_inside => parts.push(vec![piece]),
                _ => {}
            }
            was_inside = is_inside;
        }
        // A part that ends at the start of a closed path goes on there.
        let starts = parts.first().and_then(|part| part.first()).map(|piece| piece.start);
        if self.is_closed() && was_inside && parts.len() > 1 && starts == Some(self.start()) {
            let mut last = parts.pop().unwrap_or_default();
            last.append(&mut parts[0]);
            parts[0] = last;
        }
        parts.into_iter().filter_map(Path::new).collect()
    }
}

/// The pieces into which a boundary cuts an element, in its order; an element without length is one.
fn pieces(element: &Element, boundary: &Index) -> impl Iterator<Item = Element> {
    let (low, high) = element.extents();
    let length = element.length();
    let mut cuts: Vec<f64> = boundary
        .within(low, high)
        .flat_map(|piece| element.meets(piece.element, SAME))
        .map(|point| element.nearest(point).0)
        .filter(|cut| cut * length > SAME && (1.0 - cut) * length > SAME)
        .collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|next, cut| (*next - *cut) * length <= SAME);
    let starts = iter::once(0.0).chain(cuts.clone());
    starts.zip(cuts.into_iter().chain([1.0])).map(|(from, to)| element.part(from, to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::region::{Fill, Region};
    use std::f64::consts::{PI, TAU};

    fn square(side: f64) -> Region {
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(Vec2::from);
        Region::inside(&[Ring::polygon(&corners).unwrap()], Fill::NonZero).unwrap()
    }

    #[test]
    fn of_a_circle_about_a_corner_a_quarter_is_in_the_square() {
        let region = square(10.0);
        let start = Vec2::new(3.0, 0.0);
        // From anywhere on the circle it is one part, from axis to axis.
        for turned in [0.0, 0.3, 1.0, 2.0, 4.0] {
            let start = Vec2::from_angle(turned).rotate(start);
            let circle = Path::new(vec![Element::arc(start, start, Vec2::ZERO, TAU)]).unwrap();
            let parts = circle.within(&Index::new(&region));
            let [part] = &*parts else { panic!("{parts:?}") };
            assert!((part.length() - 1.5 * PI).abs() < 1e-9);
            assert!(part.start().distance(Vec2::new(3.0, 0.0)) < 1e-9);
            assert!(part.end().distance(Vec2::new(0.0, 3.0)) < 1e-9);
        }
    }

    #[test]
    fn a_way_in_and_out_and_in_again_is_two_parts() {
        let way = [(5.0, 5.0), (15.0, 5.0), (15.0, 8.0), (2.0, 8.0)].map(Vec2::from);
        let lines = way.windows(2).map(|ends| Element::line(ends[0], ends[1])).collect();
        let parts = Path::new(lines).unwrap().within(&Index::new(&square(10.0)));
        let lengths: Vec<f64> = parts.iter().map(|part| part.length().round()).collect();
        assert_eq!(lengths, [5.0, 8.0]);
        assert!(parts[1].start().distance(Vec2::new(10.0, 8.0)) < 1e-9);
        let within = square(10.0).offset(-3.0).unwrap();
        let whole = Path::around(within.rings().next().unwrap()).unwrap();
        assert_eq!(whole.within(&Index::new(&square(10.0))), std::slice::from_ref(&whole));
        assert!(whole.within(&Index::new(&Region::default())).is_empty());
    }
}
