//! What is odd about a board: layers that do not fit together, copper and holes outside of it.

use super::{Board, Copper, Face, Side};
use crate::contour::around;
use crate::gerber::Image;
use crate::report::Outcome;
use crate::{Hole, HoleShape};
use geom::region::{Index, Region, RegionError};
use geom::{Element, Vec2};
use program::{Diagnostic, Rule};

/// Copper outside that covers less is rounding, mm²: 10 mm of an edge by a tenth of a micrometre.
const SLIVER: f64 = 1e-3;

/// A box whose sides are parallel to the axes: two opposite corners, mm.
type Extents = (Vec2, Vec2);

/// Copper of a side, once it is cropped, that is in a cut-out of the outline, of which this is the index.
///
/// # Errors
/// `copper-outside` where the two cannot be compared.
pub(super) fn copper(
    board: &Board,
    face: Face,
    index: Option<&Index>,
) -> Outcome<Option<Diagnostic>> {
    let (Some(outline), Some(copper), Some(index)) =
        (&board.outline, &board.side(face).copper, index)
    else {
        return Ok(None);
    };
    let outside = outside(copper, outline, index).map_err(|error| {
        let message = format!("the {face} copper and the outline cannot be compared: {error}");
        Box::new(Diagnostic::error(Rule::CopperOutside, message))
    })?;
    let area = outside.area();
    let first = outside.islands().first().filter(|_| area > SLIVER);
    Ok(first.map(|island| {
        let places = match outside.islands().len() {
            1 => String::from("1 place"),
            places => format!("{places} places"),
        };
        let first = shown(island.outer().extents());
        let message = format!(
            "{area:.3} mm² of the {face} copper is where there is no board, in {places}, the first \
             within {first}"
        );
        let help = "it is cut through with the outline; look whether that contour is a cut-out, or a board within another contour";
        Diagnostic::warning(Rule::CopperOutside, message).help(help)
    }))
}

/// Holes that are outside the outline of this index.
pub(super) fn holes(board: &Board, index: Option<&Index>) -> Option<Diagnostic> {
    let index = index?;
    let beyond: Vec<&Hole> =
        board.holes.iter().filter(|hole| index.island_at(middle(hole)).is_none()).collect();
    let first = beyond.first()?;
    let at = middle(first);
    let message = format!(
        "{} of {} holes are outside the outline, first one of {:.3} mm at X {:.4} Y {:.4}",
        beyond.len(),
        board.holes.len(),
        first.diameter,
        at.x,
        at.y
    );
    let help = "look whether outline and holes are of one board";
    Some(Diagnostic::warning(Rule::HoleOutside, message).help(help))
}

/// Compares each layer with the outline, or with the first layer where there is no outline.
///
/// # Errors
/// `layers-apart` where a layer lies wholly outside the board: it has another origin.
pub(super) fn layers(board: &Board) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
    let of = |region: Option<&Region>| region.and_then(Region::extents);
    let copper = |copper: &Option<Copper>| of(copper.as_ref().map(|copper| &copper.region));
    let legend = |side: &Side| side.legend.as_ref().and_then(Image::extents);
    let layers = [
        ("outline", of(board.outline.as_ref())),
        ("edge", board.broken_edge.as_ref().and_then(|edge| edge.extents)),
        ("front copper", copper(&board.front.copper)),
        ("back copper", copper(&board.back.copper)),
        ("front solder mask", of(board.front.mask.as_ref())),
        ("back solder mask", of(board.back.mask.as_ref())),
        ("front legend", legend(&board.front)),
        ("back legend", legend(&board.back)),
        ("holes", board.holes.iter().map(Hole::extents).reduce(around)),
    ];
    let mut there = layers.into_iter().filter_map(|(name, extents)| Some((name, extents?)));
    let Some((first, board)) = there.next() else { return Ok(Vec::new()) };
    let (mut errors, mut warnings) = (Vec::new(), Vec::new());
    // What is cropped may reach as far as it likes.
    let is_cropped = |name: &str| first == "outline" && name != "holes" || name.ends_with("legend");
    for (name, extents) in there {
        let message = |what: &str| {
            let (layer, board) = (shown(extents), shown(board));
            format!("{what}: {name} within {layer}, {first} within {board}")
        };
        let help = "plot all layers with the same origin and unit";
        // What is thinner than 1 µm counts as that: all holes may be in one line.
        let size = |low: Vec2, high: Vec2| (high - low).max(Vec2::splat(1e-3)).element_product();
        let (low, high) = (extents.0.max(board.0), extents.1.min(board.1));
        if low.x > high.x || low.y > high.y {
            let found =
                Diagnostic::error(Rule::LayersApart, message("a layer lies outside the board"));
            errors.push(found.help(help));
        } else if size(low, high) < 0.5 * size(extents.0, extents.1) && !is_cropped(name) {
            let message = message("more than half of a layer lies outside the board");
            warnings.push(Diagnostic::warning(Rule::LayersShifted, message).help(help));
        }
    }
    if errors.is_empty() { Ok(warnings) } else { Err(errors) }
}

/// The copper that is not within the outline. Only islands that come near an edge are worked on.
fn outside(copper: &Copper, outline: &Region, index: &Index) -> Result<Region, RegionError> {
    let near = |element: &Element| {
        let (low, high) = element.extents();
        index.within(low, high).next().is_some()
    };
    let suspect = copper.region.islands().iter().filter(|island| {
        let elements = island.outer().elements();
        let off_board = |first: &Element| index.island_at(first.start).is_none();
        elements.first().is_some_and(off_board) || elements.iter().any(near)
    });
    suspect.cloned().collect::<Region>().difference(outline)
}

/// A place in the middle of a hole.
fn middle(hole: &Hole) -> Vec2 {
    match &hole.shape {
        HoleShape::Round(at) => *at,
        HoleShape::Slot(from, to) => from.midpoint(*to),
        HoleShape::Route(elements) => elements.first().map_or(Vec2::ZERO, |element| element.start),
    }
}

fn shown((low, high): Extents) -> String {
    format!("X {:.3} to {:.3}, Y {:.3} to {:.3} mm", low.x, high.x, low.y, high.y)
}
