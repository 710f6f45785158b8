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
