//! What a tool takes away along its paths, asked place by place.

use crate::Path;
use geom::ending::go_on;
use geom::{Element, Vec2};
use static_aabb2d_index::{StaticAABB2DIndex, StaticAABB2DIndexBuilder};

/// By how much what is certainly cut is narrower than the cut on either side, mm: merged paths are off by 5 µm, and a tool may
/// be as much as 20 µm thinner than it is said to be.
const SURE: f64 = 0.016;

/// From place to place of a path that is looked at, mm.
const STEP: f64 = 0.005;

/// What a tool takes away for certain.
pub(crate) struct Swept<'a> {
    elements: Vec<&'a Element>,
    /// `None` where there is nothing in it.
    tree: Option<StaticAABB2DIndex<f64>>,
    /// How far from its middle the tool cuts for certain, mm.
    reach: f64,
}

impl<'a> Swept<'a> {
    /// By a tool of `width` mm along `paths`.
    pub fn new(paths: impl Iterator<Item = &'a Path>, width: f64) -> Swept<'a> {
        let elements: Vec<&Element> = paths.flat_map(Path::elements).collect();
        let mut tree = StaticAABB2DIndexBuilder::new(elements.len());
        for element in &elements {
            let (low, high) = element.extents();
            tree.add(low.x, low.y, high.x, high.y);
        }
        Swept { elements, tree: tree.build().ok(), reach: width / 2.0 - SURE }
    }

    /// Whether all of `path` is taken away: what is left on its two sides is not joined then.
    pub fn covers(&self, path: &Path) -> bool {
        path.elements().iter().all(|element| {
            let steps = (element.length() / STEP).ceil().max(1.0);
            (0..=steps as usize).all(|step| self.takes(element.at(step as f64 / steps)))
        })
    }

    fn takes(&self, at: Vec2) -> bool {
        go_on();
        let (low, high) = (at - self.reach, at + self.reach);
        let near = self.tree.iter().flat_map(|tree| tree.query(low.x, low.y, high.x, high.y));
        let mut near = near.filter_map(|i| self.elements.get(i));
        near.any(|element| element.away(at) <= self.reach)
    }
}
