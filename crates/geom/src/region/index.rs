//! What of a region is at or near a place, without looking at all of it.

use super::Region;
use super::ring::winding;
use crate::{Element, Vec2};
use static_aabb2d_index::{Control, StaticAABB2DIndex, StaticAABB2DIndexBuilder};
use std::iter;

/// The boundary of a region in a tree of boxes.
pub struct Index<'a> {
    pieces: Vec<Piece<'a>>,
    /// `None` where there is nothing in it.
    tree: Option<StaticAABB2DIndex<f64>>,
}

/// An element of the boundary of a region.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a> {
    /// The island that it bounds, in the order of [`Region::islands`].
    pub island: usize,
    /// Its ring, in the order of [`Region::rings`].
    pub ring: usize,
    /// The element itself.
    pub element: &'a Element,
}

/// What of a boundary is nearest to a point.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<'a> {
    /// The element.
    pub piece: Piece<'a>,
    /// How far along it, 0 to 1.
    pub t: f64,
    /// How far away, mm.
    pub distance: f64,
}

impl<'a> Index<'a> {
    /// The boundary of `region`. Takes n·log n of its elements.
    pub fn new(region: &'a Region) -> Index<'a> {
        let islands = region.islands().iter().enumerate();
        let rings = islands.flat_map(|(island, rings)| {
            iter::once(rings.outer()).chain(rings.holes()).map(move |ring| (island, ring))
        });
        let pieces: Vec<Piece> = rings
            .enumerate()
            .flat_map(|(i, (island, ring))| {
                ring.elements().iter().map(move |element| Piece { island, ring: i, element })
            })
            .collect();
        let tree = tree(pieces.iter().map(|piece| piece.element.extents()));
        Index { pieces, tree }
    }

    /// The island that `point` is in. On the boundary the answer may be either.
    pub fn island_at(&self, point: Vec2) -> Option<usize> {
        // What winds around the point is on its right.
        let mut windings: Vec<(usize, i32)> = self
            .within(point, Vec2::new(f64::INFINITY, point.y))
            .map(|piece| (piece.island, winding(piece.element, point)))
            .collect();
        windings.sort_unstable();
        let mut islands = windings.chunk_by(|a, b| a.0 == b.0);
        // Around what is in a hole the outer ring runs forth and the hole back.
        let around = |island: &&[(usize, i32)]| island.iter().map(|(_, times)| times).sum::<i32>();
        islands.find(|island| around(island) != 0)?.first().map(|(island, _)| *island)
    }

    /// What is nearest to `point`, if it is up to `within` mm away.
    pub fn nearest(&self, point: Vec2, within: f64) -> Option<Nearest<'a>> {
        let mut best: Option<Nearest> = None;
        let mut visit = |i: usize, box_away: f64| {
            let most = best.map_or(within, |best| best.distance);
            if box_away > most * most {
                return Control::Break(());
            }
            if let Some(piece) = self.pieces.get(i) {
                let (t, distance) = piece.element.nearest(point);
                if distance <= most {
                    best = Some(Nearest { piece: *piece, t, distance });
                }
            }
            Control::Continue
        };
        self.tree.as_ref()?.visit_neighbors(point.x, point.y, &mut visit);
        best
    }

    /// The elements that may be in the box between two corners: those whose own boxes touch it.
    pub fn within(&self, low: Vec2, high: Vec2) -> impl Iterator<Item = Piece<'a>> {
        let found =
            self.tree.iter().flat_map(move |tree| tree.query_iter(low.x, low.y, high.x, high.y));
        found.filter_map(|i| self.pieces.get(i).copied())
    }

    /// All elements, ring by ring.
    pub fn pieces(&self) -> &[Piece<'a>] {
        &self.pieces
    }
}

/// A tree of boxes, each given by two of its corners.
pub(super) fn tree(
    boxes: impl ExactSizeIterator<Item = (Vec2, Vec2)>,
) -> Option<StaticAABB2DIndex<f64>> {
    let mut tree = StaticAABB2DIndexBuilder::new(boxes.len());
    for (low, high) in boxes {
        tree.add(low.x, low.y, high.x, high.y);
    }
    tree.build().ok()
}
