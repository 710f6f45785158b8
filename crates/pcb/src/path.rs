//! Ways of a tool over the board.

use geom::{Element, Vec2};

/// A chain of lines and arcs, each of which starts where the one before ends, bit for bit; at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    elements: Vec<Element>,
}

/// A place on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Index of its element.
    pub element: usize,
    /// How far along the element, from 0 at its start to below 1.
    pub t: f64,
}

/// How many places of one element are looked at, at most.
const MOST_SITES: f64 = 1000.0;

impl Path {
    /// The way along `elements`; `None` where there are none. Where one does not start where the one
    /// before ends, its start is put there: ends apart by more than rounding are the caller's mistake.
    pub fn new(mut elements: Vec<Element>) -> Option<Path> {
        let mut end = elements.first()?.start;
        for element in &mut elements {
            element.start = end;
            end = element.end;
        }
        Some(Path { elements })
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

    /// The same closed way, begun elsewhere on it; the same where it is not closed.
    pub fn starting_at(&self, site: Site) -> Path {
        let (Some(cut), true) = (self.elements.get(site.element), self.is_closed()) else {
            return self.clone();
        };
        let (before, after) = (&self.elements[..site.element], &self.elements[site.element + 1..]);
        let mut elements = Vec::with_capacity(self.elements.len() + 1);
        elements.push(cut.part(site.t, 1.0));
        elements.extend(after);
        elements.extend(before);
        if site.t > 0.0 {
            elements.push(cut.part(0.0, site.t));
        }
        Path { elements }
    }

    /// Where it may begin: at its corners, and on elements longer than `stride` mm as often as that, evenly.
    pub(crate) fn sites(&self, stride: f64) -> impl Iterator<Item = Site> {
        self.elements.iter().enumerate().flat_map(move |(element, long)| {
            let parts = (long.length() / stride).ceil().clamp(1.0, MOST_SITES);
            (0..parts as usize).map(move |part| Site { element, t: part as f64 / parts })
        })
    }

    /// The point of a place on it, mm; its start where there is no such place.
    pub fn at(&self, site: Site) -> Vec2 {
        self.elements.get(site.element).map_or(self.start(), |element| element.at(site.t))
    }

    /// The same way back.
    pub fn reversed(&self) -> Path {
        Path { elements: self.elements.iter().rev().map(Element::reversed).collect() }
    }
}
