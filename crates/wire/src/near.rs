//! Which elements of a chain are near a point, without looking at all of them.

use crate::crossing::TOUCH;
use cavalier_contours::static_aabb2d_index::{
    Control, NeighborPriorityQueue, StaticAABB2DIndex, StaticAABB2DIndexBuilder,
};
use geom::Vec2;
use sketch::Element;

/// Elements in a tree of boxes.
pub(crate) struct Near<'a> {
    elements: &'a [Element],
    tree: Option<StaticAABB2DIndex<f64>>,
    queue: NeighborPriorityQueue<f64>,
    /// The element that was found last: those that ask follow a contour too.
    last: usize,
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

impl Nearest {
    fn of(index: usize, element: &Element, point: Vec2) -> Option<Nearest> {
        let (t, distance) = element.nearest(point);
        distance.is_finite().then_some(Nearest { element: index, t, distance })
    }
}

impl<'a> Near<'a> {
    pub fn new(elements: &'a [Element]) -> Near<'a> {
        let mut builder = StaticAABB2DIndexBuilder::new(elements.len());
        for element in elements {
            let (low, high) = element.extents();
            builder.add(low.x, low.y, high.x, high.y);
        }
        Near { elements, tree: builder.build().ok(), queue: NeighborPriorityQueue::new(), last: 0 }
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

    /// An element within `enough` mm of `point`, or else the nearest.
    pub fn nearest(&mut self, point: Vec2, enough: f64) -> Option<Nearest> {
        let around = (self.last.saturating_sub(1)..).take(4);
        let found = around.filter_map(|i| Nearest::of(i, self.elements.get(i)?, point));
        let found = found.min_by(|a, b| a.distance.total_cmp(&b.distance));
        let found = found.filter(|found| found.distance <= enough);
        let found = found.or_else(|| self.nearest_of_all(point))?;
        self.last = found.element;
        Some(found)
    }

    fn nearest_of_all(&mut self, point: Vec2) -> Option<Nearest> {
        let mut best: Option<Nearest> = None;
        self.by_distance(point, |i, element, box_distance| {
            if best.is_some_and(|best| box_distance > best.distance) {
                return false;
            }
            let found = Nearest::of(i, element, point);
            if found.is_some_and(|found| best.is_none_or(|best| found.distance < best.distance)) {
                best = found;
            }
            true
        });
        best
    }

    /// The least distance of any element from `other`, where it is less than `least`.
    pub fn clearance(&self, other: &Element, least: f64) -> Option<f64> {
        let (mut found, middle, length) = (least, other.at(0.5), other.length());
        self.around(other, least, &mut |i| {
            if let Some(element) = self.elements.get(i) {
                // Both reach half their lengths from their middles, at most.
                let reach = (element.length() + length) / 2.0;
                if element.at(0.5).distance(middle) - reach < found {
                    found = found.min(element.distance(other, TOUCH));
                }
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
