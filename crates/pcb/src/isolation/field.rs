//! How far it is from a place to the conductors around it.

use crate::Copper;
use geom::ending::go_on;
use geom::region::Index;
use geom::{Element, Vec2};

/// Copper as conductors: islands of one net are one, an island without a net is one of its own.
pub(super) struct Field<'a> {
    index: Index<'a>,
    /// The conductor of each island.
    conductors: Vec<usize>,
}

/// A piece of the boundary of a conductor.
#[derive(Clone, Copy)]
pub(super) struct Edge<'a> {
    pub conductor: usize,
    pub island: usize,
    pub element: &'a Element,
}

impl<'a> Edge<'a> {
    /// Whether the shortest line to `point` begins outside of the conductor, which is on its left. At a sharp
    /// corner only one of the two edges may show it.
    pub fn is_left_towards(&self, point: Vec2) -> bool {
        let (t, _) = self.element.nearest(point);
        self.element.tangent(t).perp_dot(point - self.element.at(t)) <= 0.0
    }

    /// What of it is nearest to `point`.
    fn foot(&self, point: Vec2) -> Foot<'a> {
        let (t, away) = self.element.nearest(point);
        let at = self.element.at(t);
        let is_corner = t <= 0.0 || t >= 1.0;
        let is_outside = is_corner || self.element.tangent(t).perp_dot(point - at) <= 0.0;
        Foot { edge: *self, at, away, is_outside }
    }
}

/// The edges in a box.
pub(super) struct Window<'a> {
    center: Vec2,
    half: f64,
    edges: Vec<Edge<'a>>,
}

/// What is nearest of a conductor.
#[derive(Clone, Copy)]
pub(super) struct Foot<'a> {
    pub edge: Edge<'a>,
    pub at: Vec2,
    /// How far away, mm.
    pub away: f64,
    /// Whether it is seen from outside of the conductor, as far as that can be known.
    pub is_outside: bool,
}

impl<'a> Field<'a> {
    pub fn new(copper: &'a Copper) -> Field<'a> {
        Field { index: Index::new(&copper.region), conductors: copper.conductors() }
    }

    /// All edges.
    pub fn edges(&self) -> impl Iterator<Item = Edge<'a>> {
        self.index.pieces().iter().filter_map(|piece| {
            let conductor = *self.conductors.get(piece.island)?;
            Some(Edge { conductor, island: piece.island, element: piece.element })
        })
    }

    /// The edges that may be in the box between two corners.
    pub fn within(&self, low: Vec2, high: Vec2) -> impl Iterator<Item = Edge<'a>> {
        self.index.within(low, high).filter_map(|piece| {
            let conductor = *self.conductors.get(piece.island)?;
            Some(Edge { conductor, island: piece.island, element: piece.element })
        })
    }

    /// Whether nothing is nearer to `point` than `distance` mm.
    pub fn is_free(&self, point: Vec2, distance: f64) -> bool {
        let (low, high) = (point - distance, point + distance);
        self.index.within(low, high).all(|piece| piece.element.away(point) >= distance)
    }

    /// The islands of two conductors that are nearest to `point`, both `away` mm.
    pub fn islands(&self, point: Vec2, pair: [usize; 2], away: f64) -> Option<[usize; 2]> {
        let near = self.window(point, 3.0 * away + 1e-3).near(point, pair)?;
        Some(near.feet.map(|foot| foot.edge.island))
    }

    /// The edges up to `half` mm left, right, above and below of `center`.
    pub fn window(&self, center: Vec2, half: f64) -> Window<'a> {
        Window { center, half, edges: self.within(center - half, center + half).collect() }
    }
}

/// What is near a place, of two conductors and the rest.
#[derive(Clone, Copy)]
pub(super) struct Near<'a> {
    /// Of each of the two.
    pub feet: [Foot<'a>; 2],
    /// How far the rest is at least, mm.
    pub other: f64,
}

impl Near<'_> {
    /// How far the two are, mm, where they are as far.
    pub fn away(&self) -> f64 {
        self.feet[0].away.min(self.feet[1].away)
    }

    /// Whether it is outside of the two.
    pub fn is_outside(&self) -> bool {
        self.feet.iter().all(|foot| foot.is_outside)
    }

    /// How much farther the rest is, mm.
    pub fn margin(&self) -> f64 {
        self.other - self.away()
    }
}

impl<'a> Window<'a> {
    /// What is near `point`; `None` where the window does not reach twice as far as the two are.
    pub fn near(&self, point: Vec2, pair: [usize; 2]) -> Option<Near<'a>> {
        let mut best: [Option<(f64, &Edge<'a>)>; 2] = [None; 2];
        let reach = self.reach(point);
        let mut other = reach;
        go_on();
        for edge in &self.edges {
            let away = edge.element.away(point);
            match pair.iter().position(|conductor| *conductor == edge.conductor) {
                Some(i) if best[i].is_none_or(|(least, _)| away < least) => {
                    best[i] = Some((away, edge));
                }
                Some(_) => {}
                None => other = other.min(away),
            }
        }
        let [first, second] = best;
        let feet = [first?, second?].map(|(_, edge)| edge.foot(point));
        feet.iter().all(|foot| 2.0 * foot.away <= reach).then_some(Near { feet, other })
    }

    /// How far around `point` everything is in the window, mm.
    fn reach(&self, point: Vec2) -> f64 {
        self.half - (point - self.center).abs().max_element()
    }

    /// The edges that are no farther than the nearest and `tie` mm more.
    pub fn nearest(&self, point: Vec2, tie: f64) -> Vec<Foot<'a>> {
        let mut feet: Vec<Foot<'a>> = self.edges.iter().map(|edge| edge.foot(point)).collect();
        let least = feet.iter().map(|foot| foot.away).fold(f64::INFINITY, f64::min);
        feet.retain(|foot| foot.away <= least + tie);
        feet
    }
}
