//! Where a tool is too wide for an outline.

use crate::setting::shown;
use geom::Vec2;
use geom::region::{Fill, Index, Island, Region, RegionError, Ring};
use program::{Diagnostic, Rule};
use std::collections::BTreeMap;

/// What is left of a corner is reported from this width on, mm.
const SLIVER: f64 = 0.02;

/// Which part of a slot its corners are at most that a tool leaves which goes into it.
const CORNERS: f64 = 0.2;

/// The largest tool that fits is looked for among so many widths up to that of the tool.
const WIDTHS: usize = 16;

/// More places than this are counted, not listed.
const LISTED: usize = 50;

/// An error for each cut-out of `board` that a tool of `width` mm does not go into.
pub(super) fn cutouts(board: &Region, width: f64) -> Result<Vec<Diagnostic>, RegionError> {
    let mut errors = Vec::new();
    for hole in board.islands().iter().flat_map(Island::holes) {
        let inside = Region::inside([hole], Fill::NonZero)?;
        if !inside.offset(-width / 2.0)?.is_empty() {
            continue;
        }
        let mut fits = None;
        for narrower in narrower(width) {
            if !inside.offset(-narrower / 2.0)?.is_empty() {
                fits = Some(narrower);
                break;
            }
        }
        let at = middle(hole);
        let message = format!(
            "the cut-out at X {:.3} Y {:.3} is too small for a tool of {} mm",
            at.x,
            at.y,
            shown(width)
        );
        list(&mut errors, Diagnostic::error(Rule::CutoutTooSmall, message).help(way_out(fits)));
    }
    Ok(errors)
}

/// An error for each piece of `board` that a tool of `width` mm does not separate from its neighbour.
pub(super) fn pieces(board: &Region, width: f64) -> Result<Vec<Diagnostic>, RegionError> {
    let together = together(board, width)?;
    let mut fits: Vec<Option<f64>> = vec![None; together.len()];
    for narrower in narrower(width) {
        if fits.iter().all(Option::is_some) {
            break;
        }
        let left = self::together(board, narrower)?;
        for ((piece, _), fits) in together.iter().zip(&mut fits) {
            if !left.iter().any(|(other, _)| other == piece) {
                fits.get_or_insert(narrower);
            }
        }
    }
    let mut errors = Vec::new();
    for ((piece, neighbour), fits) in together.into_iter().zip(fits) {
        let [at, other] = [piece, neighbour].map(|i| middle(board.islands()[i].outer()));
        let message = format!(
            "a tool of {} mm does not separate the piece around X {:.3} Y {:.3} from that around \
             X {:.3} Y {:.3}",
            shown(width),
            at.x,
            at.y,
            other.x,
            other.y
        );
        list(&mut errors, Diagnostic::error(Rule::NotParted, message).help(way_out(fits)));
    }
    Ok(errors)
}

/// Which islands of `board` are one when it has grown by half of `width` mm: each with the first of them.
fn together(board: &Region, width: f64) -> Result<Vec<(usize, usize)>, RegionError> {
    let grown = board.offset(width / 2.0)?;
    let index = Index::new(&grown);
    let mut firsts = BTreeMap::new();
    let islands = board.islands().iter().enumerate().filter_map(|(i, island)| {
        let start = island.outer().elements().first()?.start;
        Some((i, *firsts.entry(index.island_at(start)?).or_insert(i)))
    });
    Ok(islands.filter(|(island, first)| island != first).collect())
}

/// A warning for each corner of `board` that a tool of `width` mm does not reach.
pub(super) fn corners(board: &Region, width: f64) -> Result<Vec<Diagnostic>, RegionError> {
    let corners = unreached(board, width)?;
    let mut fits: Vec<Option<f64>> = vec![None; corners.islands().len()];
    if !corners.is_empty() {
        // What a narrower tool does not reach is part of what a wider one does not.
        for narrower in narrower(width) {
            let left = unreached(board, narrower)?;
            let parts: Vec<(Vec2, f64)> = left
                .islands()
                .iter()
                .filter_map(|island| {
                    Some((island.outer().elements().first()?.start, island.area()))
                })
                .collect();
            for (corner, fits) in corners.islands().iter().zip(&mut fits) {
                let (low, high) = corner.outer().extents();
                // A tool that goes into a slot leaves its corners.
                let most =
                    if (high - low).max_element() > width { CORNERS * corner.area() } else { 0.0 };
                let within = |p: &Vec2| low.cmple(*p).all() && high.cmpge(*p).all();
                let rest = parts.iter().filter(|(start, _)| within(start));
                if fits.is_none() && rest.map(|(_, area)| area).sum::<f64>() <= most {
                    *fits = Some(narrower);
                }
            }
        }
    }
    let mut warnings: Vec<Diagnostic> = Vec::new();
    for (corner, fits) in corners.islands().iter().zip(fits) {
        let at = middle(corner.outer());
        let (low, high) = corner.outer().extents();
        let size = high - low;
        let message = match size.max_element() > width {
            true => format!(
                "a tool of {} mm does not go into the slot of {:.2} x {:.2} mm at X {:.3} Y {:.3}",
                shown(width),
                size.x,
                size.y,
                at.x,
                at.y
            ),
            false => format!(
                "a tool of {} mm does not reach all of the corner at X {:.3} Y {:.3}",
                shown(width),
                at.x,
                at.y
            ),
        };
        list(&mut warnings, Diagnostic::warning(Rule::NarrowCorner, message).help(way_out(fits)));
    }
    Ok(warnings)
}

/// Adds a finding, or counts it with the last where there are too many.
fn list(findings: &mut Vec<Diagnostic>, finding: Diagnostic) {
    let full = findings.len() >= LISTED;
    match findings.last_mut().filter(|_| full) {
        Some(last) => last.count = last.count.saturating_add(1),
        None => findings.push(finding),
    }
}

/// What a tool of `width` mm leaves outside the board although it is no part of it, without slivers.
fn unreached(board: &Region, width: f64) -> Result<Region, RegionError> {
    let left = board.offset(width / 2.0)?.offset(-width / 2.0)?.difference(board)?;
    left.offset(-SLIVER / 2.0)
}

/// Widths below that of the tool, mm, the widest first.
fn narrower(width: f64) -> impl Iterator<Item = f64> {
    (1..WIDTHS).rev().map(move |part| width * part as f64 / WIDTHS as f64)
}

fn way_out(fits: Option<f64>) -> String {
    match fits {
        Some(fits) => format!("take a tool of at most {} mm", shown(fits)),
        None => "no tool that is much narrower does: change the outline".to_owned(),
    }
}

/// The middle of what is around a ring, mm.
fn middle(ring: &Ring) -> Vec2 {
    let (low, high) = ring.extents();
    low.midpoint(high)
}
