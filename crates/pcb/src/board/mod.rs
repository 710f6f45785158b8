//! A board, whatever files it comes from.

mod copper;

pub(crate) use copper::united;
pub use copper::{Copper, covered};

use crate::Hole;
use geom::region::Region;

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
    pub legend: Option<Region>,
}
