//! Where copper stays that is part of no conductor, since the tool does not go in.

use crate::{Copper, Path, SAME};
use geom::region::{self, Fill, Index, Region, RegionError, Ring};
use geom::{Element, Vec2};
use std::collections::BTreeSet;

/// By how much a place is smaller here than what the tool does not reach, mm: regions are exact to half of it.
const LESS: f64 = 0.002;

/// A slot is longer than so many widths of the cut; what is shorter is the rounding of a corner.
const LONG: f64 = 2.0;

/// A slot within a conductor, or between islands of one, which the tool does not enter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slot {
    /// A place in it, mm.
    pub at: Vec2,
    /// An island of copper at its side.
    pub island: usize,
    /// How wide it is in the middle of its longest side, mm.
    pub width: f64,
    /// How long, mm.
    pub length: f64,
}

/// Copper that stays where it should not.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Unreached {
    /// The longest first.
    pub slots: Vec<Slot>,
    /// All of it: slots, and what is between conductors.
    pub region: Region,
}

/// What a cut of `width` mm leaves between edges of `copper`: its middle stays out of `around`, but for where it goes along
/// `cuts`.
pub(super) fn unreached(
    copper: &Copper,
    around: &Region,
    cuts: &[Path],
    width: f64,
) -> Result<Unreached, RegionError> {
    let kept = around.offset(-width / 2.0 - LESS)?.difference(&copper.region)?;
    let kept = match cuts.is_empty() {
        true => kept,
        false => kept.difference(&strokes(cuts, width + 2.0 * LESS)?)?,
    };
    let index = Index::new(&copper.region);
    let conductors = copper.conductors();
    let (mut slots, mut rings) = (Vec::new(), Vec::new());
    for island in kept.islands() {
        let mut sides: BTreeSet<usize> = BTreeSet::new();
        let (mut edge, mut longest): (f64, Option<(f64, usize, &Element)>) = (0.0, None);
        let all = std::iter::once(island.outer()).chain(island.holes());
        for element in all.clone().flat_map(Ring::elements) {
            let Some(near) = index.nearest(element.at(0.5), LESS) else { continue };
            let of = near.piece.island;
            sides.extend(conductors.get(of));
            let length = element.length();
            edge += length;
            if longest.is_none_or(|(most, ..)| length > most) {
                longest = Some((length, of, element));
            }
        }
        let Some((_, of, side)) = longest else { continue };
        let is_slot = sides.len() == 1;
        if is_slot && edge < 2.0 * LONG * width {
            continue;
        }
        rings.extend(all.cloned());
        if is_slot {
            // Its mouth is round: the average is less.
            let width = across(&index, side, width).unwrap_or(2.0 * island.area() / edge);
            slots.push(Slot { at: side.at(0.5), island: of, width, length: edge / 2.0 });
        }
    }
    slots.sort_by(|a, b| b.length.total_cmp(&a.length));
    Ok(Unreached { slots, region: Region::inside(&rings, Fill::EvenOdd)? })
}

/// How far it is from the middle of a side of a slot to the other side, up to `most` mm.
fn across(copper: &Index, side: &Element, most: f64) -> Option<f64> {
    let from = side.at(0.5);
    // The slot is on the left of what bounds it.
    let towards = side.tangent(0.5).perp();
    let line = Element::line(from + towards * 2.0 * LESS, from + towards * most);
    let (low, high) = line.extents();
    let met = copper.within(low, high).flat_map(|piece| line.meets(piece.element, SAME));
    met.map(|at| at.distance(from)).reduce(f64::min)
}

/// What a tool of `width` mm takes away along `paths`.
pub(super) fn strokes(paths: &[Path], width: f64) -> Result<Region, RegionError> {
    let elements = paths.iter().flat_map(Path::elements);
    let drawn: Vec<(Element, f64)> = elements.map(|element| (*element, width)).collect();
    Region::inside(&region::strokes(&drawn)?, Fill::Positive)
}
