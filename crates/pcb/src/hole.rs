//! Holes of a board: what is drilled, chained or routed through it.

use geom::{Element, Vec2};

/// A hole, a slot or a route.
#[derive(Clone, Debug, PartialEq)]
pub struct Hole {
    /// Where, and of which form.
    pub shape: HoleShape,
    /// Its width, mm, greater than 0.
    pub diameter: f64,
    /// Whether its wall is plated; `None` where the file does not say.
    pub plated: Option<bool>,
}

/// Where a hole is, and of which form: the way of the middle of a round tool as wide as the hole.
#[derive(Clone, Debug, PartialEq)]
pub enum HoleShape {
    /// Round.
    Round(Vec2),
    /// From hole to hole.
    Slot(Vec2, Vec2),
    /// Along lines and arcs, each of which starts where the one before ends; at least one.
    Route(Vec<Element>),
}

impl Hole {
    /// The corners of the smallest box around it whose sides are parallel to the axes, mm.
    pub fn extents(&self) -> (Vec2, Vec2) {
        let (low, high) = match &self.shape {
            HoleShape::Round(at) => (*at, *at),
            HoleShape::Slot(from, to) => (from.min(*to), from.max(*to)),
            HoleShape::Route(elements) => {
                let each = elements.iter().map(Element::extents);
                each.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default()
            }
        };
        let radius = Vec2::splat(self.diameter / 2.0);
        (low - radius, high + radius)
    }
}
