//! What lies outside the edge of a board is no part of it: the outline says where the board is.
//!
//! Cropped is what is outside all outer contours. What lies within a cut-out stays, since a contour inside another one may
//! be a second board.

use super::{Board, Copper, Face};
use crate::gerber::{Image, Object, Shape};
use crate::{Hole, Path, SAME};
use geom::region::{Fill, Index, Island, Region, RegionError, Ring};
use program::{Diagnostic, Rule};

/// Copper outside that covers less is rounding, mm²: 10 mm of an edge by a tenth of a micrometre.
const SLIVER: f64 = 1e-3;

/// Where more than this part of the copper and of its conductors is outside, the outline is of something else, and nothing
/// is cropped.
const MOST: f64 = 0.5;

/// By how much the rim of a cut-out may be off that of a hole which is the same, mm.
const SAME_RIM: f64 = 0.1;

/// Leaves cut-outs to the drill that makes them: holes in the same place that are nowhere smaller.
///
/// # Errors
/// Where the outline is more than can be computed.
pub(super) fn drilled(board: &mut Board) -> Result<Option<Diagnostic>, RegionError> {
    let Some(outline) = &mut board.outline else { return Ok(None) };
    let is_drilled = |ring: &&Ring| board.holes.iter().any(|hole| is_rim(ring, hole));
    let cutouts = || outline.islands().iter().flat_map(Island::holes);
    let count = cutouts().filter(is_drilled).count();
    let Some(first) = cutouts().find(is_drilled) else { return Ok(None) };
    let (low, high) = first.extents();
    let at = low.midpoint(high);
    let others = cutouts().filter(|ring| !is_drilled(ring));
    let rings: Vec<&Ring> = outline.islands().iter().map(Island::outer).chain(others).collect();
    *outline = Region::inside(rings, Fill::EvenOdd)?;
    let message = format!(
        "{count} of the outline's cut-outs are holes in the drill files too, and left to drill.nc, the first at X {:.3} Y {:.3}",
        at.x, at.y
    );
    let help = "nothing to do, if the same holes are meant";
    Ok(Some(Diagnostic::warning(Rule::HoleTwice, message).help(help)))
}

/// Whether a cut-out is a hole that is drilled: where this is, and nowhere larger.
fn is_rim(ring: &Ring, hole: &Hole) -> bool {
    let ((low, high), (least, most)) = (ring.extents(), hole.extents());
    let is_within = (least - SAME_RIM).cmple(low).all() && (most + SAME_RIM).cmpge(high).all();
    is_within && low.midpoint(high).distance(least.midpoint(most)) < SAME_RIM
}

/// What the outer contours of an outline enclose, its cut-outs filled.
pub(super) fn filled(outline: &Region) -> Result<Region, RegionError> {
    Region::inside(outline.islands().iter().map(Island::outer), Fill::NonZero)
}

/// Crops the copper of a side, of which `edge` is what the outer contours enclose, and `index` its index.
///
/// # Errors
/// `copper-outside` where the two cannot be compared.
pub(super) fn copper(
    board: &mut Board,
    face: Face,
    edge: &Region,
    index: &Index,
) -> Result<Option<Diagnostic>, Box<Diagnostic>> {
    let Some(copper) = &mut board.side_mut(face).copper else { return Ok(None) };
    let refused = |error: RegionError| {
        let message = format!("the {face} copper and the outline cannot be compared: {error}");
        Box::new(Diagnostic::error(Rule::CopperOutside, message))
    };
    let mut islands = Vec::with_capacity(copper.region.islands().len());
    let mut nets = Vec::with_capacity(copper.nets.len());
    let (mut area, mut places, mut first) = (0.0, 0, None);
    for (i, island) in copper.region.islands().iter().enumerate() {
        let net = copper.nets.get(i).cloned().flatten();
        let whole = std::iter::once(island.clone()).collect::<Region>();
        let parts = match beyond(island, index) {
            Beyond::No => whole,
            Beyond::Wholly => Region::default(),
            Beyond::Perhaps => {
                let parts = whole.intersection(edge).map_err(refused)?;
                if island.area() - parts.area() > SLIVER { parts } else { whole }
            }
        };
        let outside = island.area() - parts.area();
        if outside > 0.0 {
            (area, places) = (area + outside, places + 1);
            first.get_or_insert(island.outer().extents());
        }
        nets.extend(std::iter::repeat_n(net, parts.islands().len()));
        islands.extend(parts.islands().iter().cloned());
    }
    let Some((low, high)) = first.filter(|_| area > SLIVER) else { return Ok(None) };
    let most = MOST * copper.region.islands().len() as f64;
    if area > MOST * copper.region.area() && f64::from(places) > most {
        let message = format!("more than half of the {face} copper lies outside the outline");
        let help = "nothing is cropped: look whether the outline is the right one, and plotted with the same origin";
        return Ok(Some(Diagnostic::warning(Rule::LayersShifted, message).help(help)));
    }
    *copper = Copper { region: islands.into_iter().collect(), nets };
    let message = format!(
        "{area:.3} mm² of the {face} copper is outside the outline and left out, in {places} place{}, the first of a \
         conductor within X {:.3} to {:.3}, Y {:.3} to {:.3} mm",
        if places == 1 { "" } else { "s" },
        low.x,
        high.x,
        low.y,
        high.y
    );
    let help = "the board ends at its outline; look whether it is the right one";
    Ok(Some(Diagnostic::warning(Rule::CopperOutside, message).help(help)))
}

/// Crops the solder mask and the legend of a side.
pub(super) fn coats(board: &mut Board, face: Face, edge: &Region, index: &Index) {
    let side = board.side_mut(face);
    if let Some(mask) = &mut side.mask
        && let Ok(inside) = mask.intersection(edge)
        && mask.area() - inside.area() > SLIVER
    {
        *mask = inside;
    }
    if let Some(legend) = &mut side.legend {
        legend.objects =
            legend.objects.iter().flat_map(|object| printed(legend, object, index)).collect();
    }
}

/// What of an object is printed on the board: strokes end at its edge, all else is on it where its middle is.
fn printed(legend: &Image, object: &Object, index: &Index) -> Vec<Object> {
    if let Shape::Stroke { path, aperture, transform } = object.shape
        && path.length() > SAME
    {
        let parts = Path::new(vec![path]).map(|path| path.within(index)).unwrap_or_default();
        let parts = parts.iter().flat_map(|part| part.elements().to_vec());
        let drawn = |path| {
            let mut part = *object;
            part.shape = Shape::Stroke { path, aperture, transform };
            part
        };
        return parts.map(drawn).collect();
    }
    let is_on = legend
        .extents_of(object)
        .is_some_and(|(low, high)| index.island_at(low.midpoint(high)).is_some());
    if is_on { vec![*object] } else { Vec::new() }
}

/// Whether an island reaches beyond an edge.
enum Beyond {
    No,
    Perhaps,
    Wholly,
}

fn beyond(island: &Island, index: &Index) -> Beyond {
    let (low, high) = island.outer().extents();
    if index.within(low, high).next().is_some() {
        return Beyond::Perhaps;
    }
    let start = island.outer().elements().first().map(|first| first.start);
    match start.and_then(|start| index.island_at(start)) {
        Some(_) => Beyond::No,
        None => Beyond::Wholly,
    }
}
