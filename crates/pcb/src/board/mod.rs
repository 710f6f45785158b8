//! A board, whatever files it comes from.
//!
//! ```text
//!   Gerber and Excellon ──files──▶ Artwork ──copper──▶ Board ──check──▶ what is odd about it
//!                 edge ──outline──▶
//! ```
//!
//! `layer` recognises which file is which, `holes` what is drilled, `copper` what is copper, `crop` what is outside the edge;
//! [`Artwork`] is a board of which
//! each side is united by itself. What is done to a board as a whole is in `placed`: moved, turned over, on a panel.

mod artwork;
mod check;
mod copper;
mod crop;
mod files;
pub(crate) mod holes;
mod layer;
mod mend;
pub mod outline;
mod placed;

pub use artwork::Artwork;
pub use copper::{Copper, Named, Shape, covered};
pub(crate) use copper::{Drawn, Pattern};
pub use files::{File, Layers, Reading, artwork, read};
pub(crate) use layer::Format;
pub use layer::{Face, Layer};
pub use placed::Axis;

use crate::Hole;
use crate::contour::around;
use crate::gerber::Image;
use geom::region::Region;
use geom::{Element, Vec2};
use outline::{BrokenEdge, Outlined};
use program::Diagnostic;

/// A board, seen from the front: X to the right, Y up, mm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Board {
    /// What it is called.
    pub name: String,
    /// The side that is looked at.
    pub front: Side,
    /// The other side, as if the board were glass.
    pub back: Side,
    /// Where there is board: within its edge, and not in its cut-outs. `None` where no file says so.
    pub outline: Option<Region>,
    /// An edge that a file draws, and that encloses no board: there is no outline then.
    pub broken_edge: Option<BrokenEdge>,
    /// What is drilled, chained or routed through it.
    pub holes: Vec<Hole>,
}

/// A side of a board. What no file says is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Side {
    /// Its copper.
    pub copper: Option<Copper>,
    /// Where its solder mask is open.
    pub mask: Option<Region>,
    /// What is printed on it.
    pub legend: Option<Image>,
    /// The middle of the lines that its copper is drawn with.
    pub lines: Vec<Element>,
}

impl Board {
    /// Takes the outline from the lines that draw its edge, each with its line in the file; answers what had to be mended.
    pub(crate) fn take_edge(&mut self, lines: &[(Element, u32)]) -> Vec<Diagnostic> {
        self.take_outline(outline::of_lines(lines), |findings| {
            BrokenEdge::of_lines(findings, lines)
        })
    }

    /// Takes the outline, or what `broken` makes of an edge that is none; answers what had to be mended.
    fn take_outline(
        &mut self,
        found: Result<Outlined, Vec<Diagnostic>>,
        broken: impl FnOnce(Vec<Diagnostic>) -> BrokenEdge,
    ) -> Vec<Diagnostic> {
        match found {
            Ok((region, mended)) => {
                self.outline = Some(region);
                mended
            }
            Err(findings) => {
                self.broken_edge = Some(broken(findings));
                Vec::new()
            }
        }
    }

    /// A side of it.
    pub fn side(&self, face: Face) -> &Side {
        match face {
            Face::Front => &self.front,
            Face::Back => &self.back,
        }
    }

    /// A side of it.
    pub(crate) fn side_mut(&mut self, face: Face) -> &mut Side {
        match face {
            Face::Front => &mut self.front,
            Face::Back => &mut self.back,
        }
    }

    /// The corners of the smallest box around the board, with sides parallel to the axes, mm: of its outline, or of all that
    /// there is but what is printed where it has none; `None` where there is nothing.
    pub fn extents(&self) -> Option<(Vec2, Vec2)> {
        self.outline.as_ref().and_then(Region::extents).or_else(|| self.around_all())
    }

    /// The same of all that there is but what is printed: holes may be outside the outline.
    fn around_all(&self) -> Option<(Vec2, Vec2)> {
        let copper = [&self.front, &self.back].into_iter().filter_map(|side| side.copper.as_ref());
        let regions = copper.map(|copper| &copper.region).chain(&self.outline);
        let edge = self.broken_edge.as_ref().and_then(|edge| edge.extents);
        let others = self.holes.iter().map(Hole::extents).chain(edge);
        regions.filter_map(Region::extents).chain(others).reduce(around)
    }
}
