//! Closed contours of lines and arcs, and the pieces that shapes are made of.

use crate::{SAME, Transform};
use geom::{Element, Vec2};
use std::f64::consts::{PI, TAU};

/// A closed chain of lines and arcs, each of which starts, bit for bit, where the one before ends, and the
/// first where the last ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    elements: Vec<Element>,
}

/// A part of a shape. A shape is what remains of its pieces when they are added and taken away in their
/// order.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Whether it is added; otherwise it is taken away from the pieces before it.
    pub solid: bool,
    /// The outer contour, counter-clockwise, and then its holes, clockwise.
    pub contours: Vec<Contour>,
}

impl Contour {
    /// A chain that is known to be closed.
    pub(crate) fn new(elements: Vec<Element>) -> Contour {
        Contour { elements }
    }

    /// A circle, counter-clockwise from its rightmost point.
    pub(crate) fn circle(center: Vec2, radius: f64) -> Contour {
        let start = center + Vec2::X * radius;
        Contour::new(vec![Element::arc(start, start, center, TAU)])
    }

    /// The polygon with these corners.
    pub(crate) fn polygon(corners: &[Vec2]) -> Contour {
        let next = corners.iter().cycle().skip(1);
        Contour::new(corners.iter().zip(next).map(|(a, b)| Element::line(*a, *b)).collect())
    }

    /// The rectangle between two opposite corners.
    pub(crate) fn rectangle(low: Vec2, high: Vec2) -> Contour {
        Contour::polygon(&[low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)])
    }

    /// What a disc covers on the straight line from `from` to `to`.
    pub(crate) fn stadium(from: Vec2, to: Vec2, radius: f64) -> Contour {
        let Some(along) = (to - from).try_normalize() else {
            return Contour::circle(from, radius);
        };
        let right = -along.perp() * radius;
        Contour::new(vec![
            Element::line(from + right, to + right),
            Element::arc(to + right, to - right, to, PI),
            Element::line(to - right, from - right),
            Element::arc(from - right, from + right, from, PI),
        ])
    }

    /// The regular polygon around whose corners runs a circle of `radius`; the first corner is in the
    /// direction of `first`, radians.
    pub(crate) fn regular(center: Vec2, radius: f64, corners: u32, first: f64) -> Contour {
        let corner = |i: u32| {
            center + Vec2::from_angle(first + TAU * f64::from(i) / f64::from(corners)) * radius
        };
        Contour::polygon(&(0..corners).map(corner).collect::<Vec<Vec2>>())
    }

    /// The elements in their order; at least one.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// What it encloses, mm², positive counter-clockwise.
    pub fn area(&self) -> f64 {
        // About a point of the contour, not the origin: a small one far out keeps its digits.
        let about = self.elements.first().map_or(Vec2::ZERO, |element| element.start);
        self.elements.iter().map(|element| element.area(about)).sum()
    }

    /// The corners of the smallest box around it whose sides are parallel to the axes.
    pub fn extents(&self) -> (Vec2, Vec2) {
        self.placed_extents(&Transform::NONE, Vec2::ZERO)
    }

    /// Those of the same elsewhere.
    pub(crate) fn placed_extents(&self, transform: &Transform, at: Vec2) -> (Vec2, Vec2) {
        let all = self.elements.iter().map(|element| transform.element(element, at).extents());
        all.reduce(around).unwrap_or_default()
    }

    /// The same, counter-clockwise.
    pub(crate) fn counter_clockwise(self) -> Contour {
        if self.area() < 0.0 { self.reversed() } else { self }
    }

    /// The same, run in the other direction.
    pub(crate) fn reversed(&self) -> Contour {
        Contour::new(self.elements.iter().rev().map(Element::reversed).collect())
    }

    /// The same elsewhere, run in the same direction.
    pub(crate) fn placed(&self, transform: &Transform, at: Vec2) -> Contour {
        let elements = self.elements.iter().map(|element| transform.element(element, at)).collect();
        let placed = Contour::new(elements);
        if transform.mirrors() { placed.reversed() } else { placed }
    }
}

impl Piece {
    /// A piece with this outline, which runs counter-clockwise.
    pub(crate) fn new(solid: bool, outline: Contour) -> Piece {
        Piece { solid, contours: vec![outline] }
    }

    /// The same elsewhere.
    pub(crate) fn placed(&self, transform: &Transform, at: Vec2) -> Piece {
        let contours = self.contours.iter().map(|contour| contour.placed(transform, at)).collect();
        Piece { solid: self.solid, contours }
    }
}

/// The corners of the smallest box around pieces that are added, mm; `None` where there are none.
pub(crate) fn extents(pieces: &[Piece]) -> Option<(Vec2, Vec2)> {
    let solid = pieces.iter().filter(|piece| piece.solid);
    let boxes = solid.flat_map(|piece| &piece.contours).map(Contour::extents);
    boxes.reduce(around)
}

/// The box around two boxes, each of which is given by its lower left and its upper right corner.
pub(crate) fn around(a: (Vec2, Vec2), b: (Vec2, Vec2)) -> (Vec2, Vec2) {
    (a.0.min(b.0), a.1.max(b.1))
}

/// The convex hull of `points`, counter-clockwise; fewer than three corners where they are in one line.
pub(crate) fn hull(mut points: Vec<Vec2>) -> Vec<Vec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut corners: Vec<Vec2> = Vec::with_capacity(points.len());
    let back: Vec<Vec2> = points.iter().rev().skip(1).copied().collect();
    let mut kept = 1;
    for half in [points, back] {
        for point in half {
            while let [.., a, b] = corners[..]
                && corners.len() > kept
                && (b - a).perp_dot(point - a) <= SAME * (b - a).length()
            {
                corners.pop();
            }
            corners.push(point);
        }
        kept = corners.len();
    }
    corners.pop();
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_and_boxes_of_the_basic_contours() {
        let circle = Contour::circle(Vec2::new(100.0, -50.0), 2.0);
        assert!((circle.area() - 4.0 * PI).abs() < 1e-9);
        assert_eq!(circle.extents(), (Vec2::new(98.0, -52.0), Vec2::new(102.0, -48.0)));
        let stadium = Contour::stadium(Vec2::ZERO, Vec2::new(3.0, 4.0), 1.0);
        assert!((stadium.area() - (10.0 + PI)).abs() < 1e-9);
        let (low, high) = stadium.extents();
        assert!(
            low.distance(Vec2::splat(-1.0)) < 1e-9 && high.distance(Vec2::new(4.0, 5.0)) < 1e-9
        );
        let point = Contour::stadium(Vec2::ONE, Vec2::ONE, 1.0);
        assert!((point.area() - PI).abs() < 1e-9);
        assert!((stadium.reversed().area() + stadium.area()).abs() < 1e-9);
        // A hexagon's area is 3√3/2 r².
        let hexagon = Contour::regular(Vec2::ZERO, 2.0, 6, 0.3);
        assert!((hexagon.area() - 6.0 * 3f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn a_hull_has_the_outer_corners_only() {
        let points = [(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0), (2.0, 2.0), (0.0, 2.0)];
        let corners = hull(points.iter().map(|(x, y)| Vec2::new(*x, *y)).collect());
        let expected = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        assert_eq!(corners, expected.map(|(x, y)| Vec2::new(x, y)));
        assert!(hull(vec![Vec2::ZERO, Vec2::ONE, Vec2::ONE * 2.0]).len() < 3);
        assert!(hull(vec![Vec2::ZERO]).len() < 3 && hull(Vec::new()).is_empty());
    }
}
