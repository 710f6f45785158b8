//! Which elements of a chain are near a place, without looking at all of them.

use crate::element::Element;
use cavalier_contours::static_aabb2d_index::{
    Control, NeighborPriorityQueue, StaticAABB2DIndex, StaticAABB2DIndexBuilder,
};
use geom::Vec2;

/// Elements in a tree of boxes.
pub(crate) struct Near<'a> {
    elements: &'a [Element],
    tree: Option<StaticAABB2DIndex<f64>>,
    queue: NeighborPriorityQueue<f64>,
}

/// What is nearest to a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// Index of the element.
    pub element: usize,
    /// How far along it, 0 to 1.
    pub t: f64,
    /// Distance, mm.
    pub distance: f64,
}

impl<'a> Near<'a> {
    pub fn new(elements: &'a [Element]) -> Near<'a> {
        let mut builder = StaticAABB2DIndexBuilder::new(elements.len());
        for element in elements {
            let (low, high) = element.extents();
            builder.add(low.x, low.y, high.x, high.y);
        }
        Near { elements, tree: builder.build().ok(), queue: NeighborPriorityQueue::new() }
    }

    /// Every element whose box comes within `margin` mm of the box of `element`, until `visit` says
    /// to stop.
    pub fn around(
        &self,
        element: &Element,
        margin: f64,
        visit: &mut dyn FnMut(usize) -> Control<()>,
    ) {
        let (low, high) = element.extents();
        let (low, high) = (low - margin, high + margin);
        if let Some(tree) = &self.tree {
            tree.visit_query(low.x, low.y, high.x, high.y, &mut |i: usize| visit(i));
        }
    }

    /// The element nearest to `point`.
    pub fn nearest(&mut self, point: Vec2) -> Option<Nearest> {
        let mut best: Option<Nearest> = None;
        self.by_distance(point, |i, element, box_distance| {
            if best.is_some_and(|best| box_distance > best.distance) {
                return false;
            }
            let (t, distance) = element.nearest(point);
            if best.is_none_or(|best| distance < best.distance) {
                best = Some(Nearest { element: i, t, distance });
            }
            true
        });
        best
    }

    /// The least distance of any element from `other`, where it is less than `least`.
    pub fn clearance(&self, other: &Element, least: f64) -> Option<f64> {
        let mut found = least;
        self.around(other, least, &mut |i| {
            if let Some(element) = self.elements.get(i) {
                found = found.min(element.distance(other));
            }
            Control::Continue
        });
        (found < least).then_some(found)
    }

    /// Elements in the order of the distance of their boxes, as long as `visit` wants more.
    fn by_distance(&mut self, point: Vec2, mut visit: impl FnMut(usize, &Element, f64) -> bool) {
        let Some(tree) = &self.tree else { return };
        tree.visit_neighbors_with_queue(
            point.x,
            point.y,
            &mut |i: usize, squared: f64| match self
                .elements
                .get(i)
                .is_some_and(|element| visit(i, element, squared.sqrt()))
            {
                true => Control::Continue,
                false => Control::Break(()),
            },
            &mut self.queue,
        );
    }
}
