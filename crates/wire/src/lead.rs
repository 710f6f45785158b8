//! From where the wire is threaded to the contour, and back.

use crate::contour::Contour;
use crate::path::Path;
use geom::Vec2;
use sketch::Element;
use std::f64::consts::FRAC_PI_2;

/// How the wire comes to the contour; it leaves it likewise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lead {
    /// How far from the start of the contour the wire is threaded where no thread point is given, mm.
    pub length: f64,
    /// The shape of the path from there.
    pub shape: LeadShape,
}

/// The path from where the wire is threaded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LeadShape {
    /// Straight to the start.
    Straight,
    /// Straight, and then a quarter circle of this radius in mm that runs into the contour.
    Arc(f64),
}

/// Elements of the lower and the upper end in pairs.
pub(crate) type Pairs = Vec<(Element, Element)>;

impl LeadShape {
    /// From `thread`, where the wire stands upright, to the start of `path`, on whose left (or right)
    /// there is room.
    pub(crate) fn into(self, thread: Vec2, path: &Path, left: bool) -> Pairs {
        let upper = path.upper().unwrap_or(path.lower());
        let below = self.to_contour(thread, path.lower(), left);
        below.into_iter().zip(self.to_contour(thread, upper, left)).collect()
    }

    /// From the end of `path` to `thread`.
    pub(crate) fn out(self, thread: Vec2, path: &Path, left: bool) -> Pairs {
        reversed(&self.into(thread, &path.reversed(), !left))
    }

    fn to_contour(self, thread: Vec2, contour: &Contour, left: bool) -> Vec<Element> {
        let entry = contour.start();
        let LeadShape::Arc(radius) = self else { return vec![Element::line(thread, entry)] };
        let travel = contour.elements().first().map_or(Vec2::X, |element| element.tangent(0.0));
        let side = if left { 1.0 } else { -1.0 };
        let center = entry + travel.perp() * (side * radius);
        let start = center - travel * radius;
        vec![Element::line(thread, start), Element::arc(start, entry, center, side * FRAC_PI_2)]
    }
}

/// The same, travelled the other way.
pub(crate) fn reversed(pairs: &[(Element, Element)]) -> Pairs {
    pairs.iter().rev().map(|(below, above)| (below.reversed(), above.reversed())).collect()
}
