//! The boolean kernel: closed chains of short straight edges on a grid of whole units, each edge with
//! the number of the element that it is a piece of.
//!
//! Whole numbers make the topology right whatever the input; the half unit that rounding to them
//! costs stays. This module alone knows of `i_overlay`.

use super::Fill;
use crate::Vec2;
use crate::ending::go_on;
use i_overlay::core::edge_data::{EdgeDataMerge, EdgeDataSplit, OverlayEdgeData};
use i_overlay::core::edge_overlay::{EdgeOverlay, InputEdge};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::ShapeType;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::number::int::IntNumber;
use i_overlay::i_float::int::point::IntPoint;
use i_overlay::segm::boolean::ShapeCountBoolean;
use i_overlay::vector::edge::DataVectorEdge;

/// Units in a millimetre. A unit is 0.1 nm, so that every coordinate of a KiCad or Gerber file is a
/// whole number of them, in inches (10⁻⁶ in = 254 units) as in millimetres.
const UNITS: f64 = 1e7;

/// The kernel takes up to 2⁶² units; half of that is 200 000 km.
const FARTHEST: f64 = (1u64 << 61) as f64;

/// A point of the grid of units.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct GridPoint(IntPoint<i64>);

impl GridPoint {
    /// The nearest to `point`, mm.
    pub fn of(point: Vec2) -> GridPoint {
        let units = |mm: f64| (mm * UNITS).round().clamp(-FARTHEST, FARTHEST) as i64;
        GridPoint(IntPoint::new(units(point.x), units(point.y)))
    }

    /// In mm.
    pub fn point(self) -> Vec2 {
        // A quotient is the double next to the decimal number; a product would not be.
        Vec2::new(self.0.x as f64 / UNITS, self.0.y as f64 / UNITS)
    }
}

/// A straight piece of the boundary of a result.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub start: GridPoint,
    pub end: GridPoint,
    /// Number of the element that it is a piece of.
    pub source: usize,
}

/// The two operands of a boolean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operand {
    First,
    Second,
}

/// What a boolean keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keep {
    /// What is in one operand or the other.
    Union,
    /// What is in both.
    Intersection,
    /// What is in the first and not in the second.
    Difference,
    /// What is in one of the two alone.
    Xor,
}

/// The number of an element, as the kernel takes it along.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Carried(u32);

impl OverlayEdgeData for Carried {
    type Store = ();

    // Called for each cut of an edge, each turned one and each two that fall together: nothing else of the kernel can ask. Between these it
    // looks for crossings and sweeps, some 0.9 s for a million edges: what is long is done by a helper, where there is one.
    fn split<I: IntNumber>(self, _: EdgeDataSplit<I>, (): &mut ()) -> (Carried, Carried) {
        go_on();
        (self, self)
    }

    fn reversed(self, (): &mut ()) -> Carried {
        go_on();
        self
    }

    /// Of two pieces on top of each other the earlier one is seen.
    fn merge(of: EdgeDataMerge<ShapeCountBoolean, Carried>, (): &mut ()) -> Carried {
        go_on();
        Carried(of.lhs_data.0.min(of.rhs_data.0))
    }
}

/// A boolean that is being put together.
pub(super) struct Kernel(EdgeOverlay<i64, Carried>);

impl Kernel {
    /// With room for so many edges.
    pub fn new(edges: usize) -> Kernel {
        Kernel(EdgeOverlay::new(edges))
    }

    /// Adds an edge of a closed chain. One without length adds nothing.
    pub fn add(&mut self, start: GridPoint, end: GridPoint, source: u32, operand: Operand) {
        let shape = match operand {
            Operand::First => ShapeType::Subject,
            Operand::Second => ShapeType::Clip,
        };
        self.0.add_edge(InputEdge { a: start.0, b: end.0, data: Carried(source) }, shape);
    }

    /// The islands of the result; of each first its outer ring, counter-clockwise, then its holes,
    /// clockwise.
    pub fn islands(mut self, keep: Keep, fill: Fill) -> Vec<Vec<Vec<Edge>>> {
        let keep = match keep {
            Keep::Union => OverlayRule::Union,
            Keep::Intersection => OverlayRule::Intersect,
            Keep::Difference => OverlayRule::Difference,
            Keep::Xor => OverlayRule::Xor,
        };
        let fill = match fill {
            Fill::EvenOdd => FillRule::EvenOdd,
            Fill::NonZero => FillRule::NonZero,
            Fill::Positive => FillRule::Positive,
        };
        let edge = |edge: DataVectorEdge<i64, Carried>| Edge {
            start: GridPoint(edge.a),
            end: GridPoint(edge.b),
            source: edge.data.0 as usize,
        };
        let ring = |ring: Vec<_>| ring.into_iter().map(edge).collect();
        let islands = self.0.build_vector_shapes(keep, fill);
        islands.into_iter().map(|rings| rings.into_iter().map(ring).collect()).collect()
    }
}
