//! Ways of a tool over the board.

use geom::region::Ring;
use geom::{Element, Vec2};

/// A chain of lines and arcs, each of which starts where the one before ends, bit for bit; at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    elements: Vec<Element>,
}

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

    /// Once around `ring`; `None` where that has no elements.
    pub fn around(ring: &Ring) -> Option<Path> {
        let mut elements = ring.elements().to_vec();
        let start = elements.first()?.start;
        elements.last_mut()?.end = start;
        Path::new(elements)
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

    /// The same way back.
    pub fn reversed(&self) -> Path {
        Path { elements: self.elements.iter().rev().map(Element::reversed).collect() }
    }
}
