//! Regions of one piece: what boards and drawings are made of.

use super::chords::boolean;
use super::kernel::Keep;
use super::ring::place;
use super::{FAR, Fill, Island, Region, RegionError, Ring};
use crate::{Element, Turn, Vec2};
use std::f64::consts::{PI, TAU};
use std::iter;

/// An arc this near to a point has no inner side, mm.
const POINT: f64 = 1e-6;

/// How a stroke ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cap {
    /// In a half circle about the end of its middle line.
    Round,
    /// Straight across, half the width beyond the end of its middle line.
    Square,
}

impl Region {
    /// The disc of `radius` mm about `center`.
    ///
    /// # Errors
    /// Where a value is no number, too large, or the radius not above zero.
    pub fn disc(center: Vec2, radius: f64) -> Result<Region, RegionError> {
        place(center)?;
        length(radius)?;
        Ok(region(circle(center, radius, TAU), Vec::new()))
    }

    /// What `rings` enclose, which may cross themselves and each other.
    ///
    /// # Errors
    /// [`RegionError::TooLarge`].
    pub fn inside<'a, Rings>(rings: Rings, fill: Fill) -> Result<Region, RegionError>
    where
        Rings: IntoIterator<Item = &'a Ring, IntoIter: Clone>,
    {
        let chains = rings.into_iter().map(Ring::elements);
        boolean(chains, iter::empty(), Keep::Union, fill)
    }

    /// What a pen of `width` mm covers along `middle`; a middle line without length is a dot.
    ///
    /// # Errors
    /// Where a value is no number, too large, or the width not above zero; where the middle line is
    /// an arc that misses its ends; and for a dot with square ends, which says not how it is turned.
    pub fn stroke(middle: &Element, width: f64, cap: Cap) -> Result<Region, RegionError> {
        length(width)?;
        let half = width / 2.0;
        // Checks the element: there and back it is closed.
        Ring::new(vec![*middle, middle.reversed()])?;
        if middle.length() == 0.0 {
            return match cap {
                Cap::Round => Region::disc(middle.start, half),
                Cap::Square => Err(RegionError::NotALength(0.0)),
            };
        }
        let Some(turn) = middle.turn else { return Ok(along(middle, half, cap)) };
        let radius = middle.start.distance(turn.center);
        let whole = turn.sweep.abs() >= TAU * (1.0 - 1e-9);
        match (whole, radius > half + POINT) {
            (true, true) => {
                let hole = circle(turn.center, radius - half, -TAU);
                Ok(region(circle(turn.center, radius + half, TAU), vec![hole]))
            }
            (true, false) => Region::disc(turn.center, radius + half),
            // Up to half a turn the ends do not come around to each other.
            (false, true) if turn.sweep.abs() <= PI => Ok(along(middle, half, cap)),
            (false, true) => Region::inside(along(middle, half, cap).rings(), Fill::NonZero),
            (false, false) => around_center(middle, turn, half, cap),
        }
    }
}

/// What a pen of half the width `half` covers along a line, or along an arc that is wider than that.
fn along(middle: &Element, half: f64, cap: Cap) -> Region {
    let (Some(right), Some(left)) = (middle.parallel(-half), middle.parallel(half)) else {
        return Region::default();
    };
    let mut elements = vec![right];
    ending(&mut elements, middle.end, middle.tangent(1.0), half, cap);
    elements.push(left.reversed());
    ending(&mut elements, middle.start, -middle.tangent(0.0), half, cap);
    region(Ring { elements }, Vec::new())
}

/// The end of a stroke that leaves `middle` in the direction `along`, from its right to its left.
fn ending(elements: &mut Vec<Element>, middle: Vec2, along: Vec2, half: f64, cap: Cap) {
    let side = along.perp() * half;
    let (right, left) = (middle - side, middle + side);
    match cap {
        Cap::Round => elements.push(Element::arc(right, left, middle, PI)),
        Cap::Square => {
            let beyond = along * half;
            elements.push(Element::line(right, right + beyond));
            elements.push(Element::line(right + beyond, left + beyond));
            elements.push(Element::line(left + beyond, left));
        }
    }
}

/// What a pen covers along an arc whose centre it covers too: a sector, and the two ends.
fn around_center(middle: &Element, turn: Turn, half: f64, cap: Cap) -> Result<Region, RegionError> {
    let middle = if turn.sweep > 0.0 { *middle } else { middle.reversed() };
    let Some(outside) = middle.parallel(-half) else { return Ok(Region::default()) };
    let sector = vec![
        outside,
        Element::line(outside.end, turn.center),
        Element::line(turn.center, outside.start),
    ];
    let mut pieces = vec![region(Ring { elements: sector }, Vec::new())];
    for (end, along) in [(middle.start, -middle.tangent(0.0)), (middle.end, middle.tangent(1.0))] {
        pieces.push(match cap {
            Cap::Round => Region::disc(end, half)?,
            Cap::Square => {
                let mut elements = Vec::new();
                ending(&mut elements, end, along, half, cap);
                let (left, right) = (end + along.perp() * half, end - along.perp() * half);
                elements.push(Element::line(left, right));
                region(Ring { elements }, Vec::new())
            }
        });
    }
    Region::union_of(&pieces)
}

/// The circle about `center`, from its rightmost point through `sweep` radians: once around, in either direction.
pub(super) fn circle(center: Vec2, radius: f64, sweep: f64) -> Ring {
    let start = center + Vec2::X * radius;
    Ring { elements: vec![Element::arc(start, start, center, sweep)] }
}

fn region(outer: Ring, holes: Vec<Ring>) -> Region {
    Island { outer, holes }.into()
}

/// Refuses what is no length.
fn length(mm: f64) -> Result<(), RegionError> {
    if mm > 0.0 && mm <= FAR { Ok(()) } else { Err(RegionError::NotALength(mm)) }
}
