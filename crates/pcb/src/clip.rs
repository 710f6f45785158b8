//! Ways cut off where they leave a region.

use crate::{Path, SAME};
use geom::region::{Index, Region};
use geom::{Element, Vec2};

/// A region that ways are cut off at.
pub(crate) struct Clip<'a> {
    index: Index<'a>,
}

impl<'a> Clip<'a> {
    pub(crate) fn to(region: &'a Region) -> Clip<'a> {
        Clip { index: Index::new(region) }
    }

    /// Whether `point` is in the region. On its boundary either may be told.
    pub(crate) fn contains(&self, point: Vec2) -> bool {
        self.index.island_at(point).is_some()
    }

    /// The parts of `path` that are in the region, in their order; of a closed path the first may be
    /// one over its start.
    pub(crate) fn within(&self, path: &Path) -> Vec<Path> {
        let mut runs: Vec<Vec<Element>> = Vec::new();
        let mut before = false;
        let mut from_start = None;
        for (part, inside) in self.parts(path) {
            match runs.last_mut().filter(|_| before) {
                Some(run) if inside => run.push(part),
                _ if inside => runs.push(vec![part]),
                _ => {}
            }
            before = inside;
            from_start.get_or_insert(inside);
        }
        if path.is_closed() && before && from_start == Some(true) && runs.len() > 1 {
            let mut last = runs.pop().unwrap_or_default();
            if let Some(first) = runs.first_mut() {
                last.append(first);
                *first = last;
            }
        }
        runs.into_iter().filter_map(Path::new).collect()
    }

    /// The pieces of `path` between the places where it meets the boundary, each with whether it is inside.
    fn parts(&self, path: &Path) -> impl Iterator<Item = (Element, bool)> {
        // Whether the last piece was inside, as long as no boundary was met since.
        let mut known: Option<bool> = None;
        path.elements().iter().flat_map(move |element| {
            let meetings = self.meetings(element);
            if !meetings.is_empty() {
                known = None;
            }
            let ends = meetings.iter().copied().chain([1.0]);
            let mut from = 0.0;
            let mut parts = Vec::new();
            for to in ends {
                if (to - from) * element.length() < SAME && to < 1.0 {
                    continue;
                }
                let part = element.part(from, to);
                let inside = known.unwrap_or_else(|| self.contains(part.at(0.5)));
                parts.push((part, inside));
                from = to;
                known = meetings.is_empty().then_some(inside);
            }
            parts
        })
    }

    /// Where `element` meets the boundary, 0 to 1, in order.
    fn meetings(&self, element: &Element) -> Vec<f64> {
        let (low, high) = element.extents();
        let near = self.index.within(low - Vec2::splat(SAME), high + Vec2::splat(SAME));
        let places = near.flat_map(|piece| element.meets(piece.element, SAME).collect::<Vec<_>>());
        let mut along: Vec<f64> = places.map(|place| element.nearest(place).0).collect();
        along.sort_by(f64::total_cmp);
        along
    }
}
