//! A board elsewhere: moved, turned over, many of it on a panel, and the pins that keep its place.

use super::outline::BrokenEdge;
use super::{Board, Copper, Side};
use crate::contour::around;
use crate::{Hole, HoleShape};
use geom::region::Region;
use geom::{Transform, Vec2};
use program::{Diagnostic, Rule};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The farthest that anything is moved, mm: regions reach no farther.
const FAR: f64 = 1e5;

/// The most boards of a panel.
const MOST_BOARDS: usize = 10_000;

/// The most lines, arcs and holes of a panel: a boolean of regions takes no more straight edges, of which each of them becomes one or more.
const MOST_ELEMENTS: usize = 1 << 22;

/// Copies are at least this far apart, mm: what is nearer may become one.
const APART: f64 = 1e-3;

/// A line about which a board is turned over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// Parallel to Y, at this X, mm: left and right change places.
    X(f64),
    /// Parallel to X, at this Y, mm: top and bottom change places.
    Y(f64),
}

impl Axis {
    /// How this reflects: mirrored or turned about the origin, which goes there.
    pub(crate) fn reflection(self) -> (Transform, Vec2) {
        match self {
            Axis::X(x) => (Transform::new(true, 0.0, 1.0), Vec2::new(2.0 * x, 0.0)),
            Axis::Y(y) => (Transform::new(true, 180.0, 1.0), Vec2::new(0.0, 2.0 * y)),
        }
    }
}

impl Board {
    /// The board moved by so much, mm.
    ///
    /// # Errors
    /// `not-a-place` where that is no number or leads farther than 100 m.
    pub fn moved(&self, by: Vec2) -> Result<Board, Box<Diagnostic>> {
        let (low, high) = self.around_all().unwrap_or_default();
        let far = (low + by).abs().max((high + by).abs()).max_element();
        if far.is_nan() || far > FAR {
            let message = format!("the board cannot be moved by X {} Y {} mm", by.x, by.y);
            let help = format!("no place is farther than {FAR} mm from the zero");
            return Err(Diagnostic::error(Rule::NotAPlace, message).help(help).into());
        }
        Ok(self.placed(&Transform::NONE, by))
    }

    /// The board turned counter-clockwise about the zero, by degrees.
    pub fn rotated(&self, degrees: f64) -> Board {
        self.placed(&Transform::new(false, degrees, 1.0), Vec2::ZERO)
    }

    /// The board turned over about `axis`: the back is looked at, and so is the front.
    pub fn turned_over(&self, axis: Axis) -> Board {
        let (mirror, at) = axis.reflection();
        let turned = self.placed(&mirror, at);
        Board { front: turned.back, back: turned.front, ..turned }
    }

    /// The place in the middle between its ends, mm; the origin where there is nothing.
    pub fn middle(&self) -> Vec2 {
        self.extents().map_or(Vec2::ZERO, |(low, high)| low.midpoint(high))
    }

    /// Two holes of `diameter` mm for pins that hold the board in place while it is turned over about
    /// `axis`: the axis is in the middle between them, and they are next to the board, halfway along
    /// it, their edges at least `distance` mm from the board.
    ///
    /// # Errors
    /// `pins` where the diameter is not above 0, the distance is below 0, or there is no board.
    pub fn pins(
        &self,
        axis: Axis,
        diameter: f64,
        distance: f64,
    ) -> Result<[Hole; 2], Box<Diagnostic>> {
        let good = diameter > 0.0 && distance >= 0.0 && diameter.max(distance) <= FAR;
        let (Some((low, high)), true) = (self.extents(), good) else {
            let message =
                format!("no pins of {diameter} mm can be put {distance} mm from the board");
            let help = "give a diameter above 0, and a distance of 0 or more";
            return Err(Diagnostic::error(Rule::Pins, message).help(help).into());
        };
        let away = distance + diameter / 2.0;
        let middle = low.midpoint(high);
        let place = |side: f64| match axis {
            Axis::X(x) => Vec2::new(x + side * ((high.x - x).max(x - low.x) + away), middle.y),
            Axis::Y(y) => Vec2::new(middle.x, y + side * ((high.y - y).max(y - low.y) + away)),
        };
        let pin = |side| Hole { shape: HoleShape::Round(place(side)), diameter, plated: None };
        Ok([pin(-1.0), pin(1.0)])
    }

    /// A panel of the board: so many next to and above each other, `spacing` mm between what is
    /// outermost of each. The first keeps its place. Each has nets of its own: `GND` of the second from
    /// the left in the lowest row is `GND (2,1)`.
    ///
    /// # Errors
    /// `panel` where there is no board, or more than fit into memory, or the spacing is not above 1 µm.
    pub fn panel(
        &self,
        columns: usize,
        rows: usize,
        spacing: Vec2,
    ) -> Result<Board, Box<Diagnostic>> {
        let refused = |message: String, help: &str| {
            Err(Box::new(Diagnostic::error(Rule::Panel, message).help(help)))
        };
        let boards = columns.saturating_mul(rows);
        let Some((low, high)) = self.extents().filter(|_| boards > 0) else {
            let message = format!("{columns} by {rows} of {} are no panel", self.name);
            return refused(message, "a panel has one board or more");
        };
        let near = columns > 1 && spacing.x <= APART || rows > 1 && spacing.y <= APART;
        if near || !spacing.is_finite() {
            let message = format!("boards {} and {} mm apart would touch", spacing.x, spacing.y);
            return refused(message, "leave room for the cutter that parts them");
        }
        if boards > MOST_BOARDS || boards.saturating_mul(self.elements()) > MOST_ELEMENTS {
            let message = format!("{columns} by {rows} boards are more than are worked on at once");
            return refused(message, "make several panels");
        }
        let step = high - low + spacing;
        let mut panel: Option<Board> = None;
        for row in 0..rows {
            for column in 0..columns {
                let mut copy = self.moved(Vec2::new(column as f64, row as f64) * step)?;
                let place = format!(" ({},{})", column + 1, row + 1);
                for side in [&mut copy.front, &mut copy.back] {
                    if let Some(copper) = &mut side.copper {
                        rename(&mut copper.nets, &place);
                    }
                }
                match &mut panel {
                    None => panel = Some(copy),
                    Some(panel) => panel.take(copy),
                }
            }
        }
        Ok(panel.unwrap_or_default())
    }

    /// Takes in other layers of the board, or another board, which does not come near.
    pub(super) fn take(&mut self, other: Board) {
        self.holes.extend(other.holes);
        take(&mut self.outline, other.outline, Region::extend);
        take(&mut self.broken_edge, other.broken_edge, |edge, more| {
            edge.extents = edge.extents.into_iter().chain(more.extents).reduce(around);
        });
        for (side, more) in [(&mut self.front, other.front), (&mut self.back, other.back)] {
            take(&mut side.mask, more.mask, Region::extend);
            side.lines.extend(more.lines);
            take(&mut side.legend, more.legend, |legend, more| legend.objects.extend(more.objects));
            take(&mut side.copper, more.copper, |copper, more| {
                copper.region.extend(more.region);
                copper.nets.extend(more.nets);
            });
        }
    }

    /// All of it elsewhere: transformed about the origin, which goes to `at`.
    fn placed(&self, transform: &Transform, at: Vec2) -> Board {
        let place = |region: &Region| region.placed(transform, at);
        let point = |point: Vec2| at + transform.apply(point);
        let side = |side: &Side| Side {
            copper: side
                .copper
                .as_ref()
                .map(|copper| Copper { region: place(&copper.region), nets: copper.nets.clone() }),
            mask: side.mask.as_ref().map(place),
            legend: side.legend.as_ref().map(|image| image.placed(transform, at)),
            lines: side.lines.iter().map(|line| transform.element(line, at)).collect(),
        };
        let edge = |edge: &BrokenEdge| {
            let mut edge = edge.clone();
            edge.extents = edge.extents.map(|(low, high)| {
                let (low, high) = (point(low), point(high));
                (low.min(high), low.max(high))
            });
            edge
        };
        let hole = |hole: &Hole| Hole {
            shape: match &hole.shape {
                HoleShape::Round(at) => HoleShape::Round(point(*at)),
                HoleShape::Slot(from, to) => HoleShape::Slot(point(*from), point(*to)),
                HoleShape::Route(elements) => {
                    let elements = elements.iter();
                    HoleShape::Route(elements.map(|e| transform.element(e, at)).collect())
                }
            },
            diameter: hole.diameter * transform.scale(),
            plated: hole.plated,
        };
        Board {
            name: self.name.clone(),
            front: side(&self.front),
            back: side(&self.back),
            outline: self.outline.as_ref().map(place),
            broken_edge: self.broken_edge.as_ref().map(edge),
            holes: self.holes.iter().map(hole).collect(),
        }
    }

    /// How many lines, arcs, printed objects and holes it has.
    fn elements(&self) -> usize {
        let sides = [&self.front, &self.back];
        let copper = sides.iter().filter_map(|side| side.copper.as_ref()).map(|c| &c.region);
        let others = sides.iter().map(|side| side.mask.as_ref());
        let regions = copper.chain(others.flatten()).chain(&self.outline);
        let rings = regions.flat_map(|region| region.rings());
        let printed = sides.iter().filter_map(|side| side.legend.as_ref());
        rings.map(|ring| ring.elements().len()).sum::<usize>()
            + sides.iter().map(|side| side.lines.len()).sum::<usize>()
            + printed.map(|image| image.objects.len()).sum::<usize>()
            + self.holes.len()
    }
}

/// Puts `place` behind the name of each net.
fn rename(nets: &mut [Option<Arc<str>>], place: &str) {
    // Names are shared.
    let mut known: BTreeMap<Arc<str>, Arc<str>> = BTreeMap::new();
    for net in nets.iter_mut().flatten() {
        let renamed = known.entry(net.clone()).or_insert_with(|| format!("{net}{place}").into());
        *net = renamed.clone();
    }
}

/// Puts more of a layer to what there is, by `put` where there is something.
fn take<T>(layer: &mut Option<T>, more: Option<T>, put: impl FnOnce(&mut T, T)) {
    match (&mut *layer, more) {
        (Some(layer), Some(more)) => put(layer, more),
        (None, more) => *layer = more,
        (Some(_), None) => {}
    }
}
