//! Holes, slots and routes that a cutter mills: rings from the middle to the wall, deeper each time.

use super::{Mill, of};
use crate::isolation::Direction;
use crate::report::{Fault, Outcome, fault};
use crate::setting;
use crate::{Cut, Hole, HoleShape, Path, Segment, depths};
use geom::Element;
use geom::region::{Cap, Region, RegionError};
use program::Rule;

/// A hole so much wider than the cutter is as wide as it, mm.
const WIDTH: f64 = 0.01;

/// The cuts that make a hole down to `depth` mm.
pub(super) fn cuts(hole: &Hole, mill: &Mill, depth: f64) -> Outcome<Vec<Cut>> {
    let width = setting::diameter(&mill.tool)?;
    let depths = depths(depth, mill.step);
    let reach = (hole.diameter - width) / 2.0;
    if reach <= WIDTH / 2.0 {
        return Ok(vec![match along(hole).and_then(Path::new) {
            Some(path) => Cut::along(&path, &depths),
            None => Cut::Hole { at: super::place(hole), depth, peck: Some(mill.step) },
        }]);
    }
    // No core stays within the innermost ring, and each next takes at most half the cutter's width.
    let count = (reach / (width / 2.0)).ceil().max(1.0);
    let rings = (1..=count as usize).map(|ring| rings(hole, reach * ring as f64 / count));
    let rings = rings
        .collect::<Result<Vec<Vec<Path>>, RegionError>>()
        .map_err(|error| too_large(hole, &error))?;
    // The rings have what they clear on their left, and so what stays on their right.
    let turned = |path: Path| match mill.direction {
        Direction::Climb | Direction::Either => path,
        Direction::Conventional => path.reversed(),
    };
    let rings: Vec<Vec<Path>> =
        rings.into_iter().map(|rings| rings.into_iter().map(turned).collect()).collect();
    let single: Option<Vec<Path>> = rings
        .iter()
        .map(|level| <&[Path; 1]>::try_from(&**level).ok().map(|[ring]| ring.clone()))
        .collect();
    Ok(match single {
        Some(nested) => vec![outwards(&nested, &depths)],
        None => rings.iter().flatten().map(|ring| Cut::along(ring, &depths)).collect(),
    })
}

/// Whether a piece of the board comes loose within the hole: a route that closes leaves one, and no tab.
pub(super) fn frees_a_piece(hole: &Hole) -> Outcome<bool> {
    if !matches!(hole.shape, HoleShape::Route(_)) {
        return Ok(false);
    }
    let rings = rings(hole, (hole.diameter + WIDTH) / 2.0);
    Ok(rings.map_err(|error| too_large(hole, &error))?.len() > 1)
}

/// The middle line of what is not round.
fn along(hole: &Hole) -> Option<Vec<Element>> {
    match &hole.shape {
        HoleShape::Round(_) => None,
        HoleShape::Slot(a, b) => (a != b).then(|| vec![Element::line(*a, *b)]),
        HoleShape::Route(elements) => Some(elements.clone()),
    }
}

/// The paths at `reach` mm from the middle line.
fn rings(hole: &Hole, reach: f64) -> Result<Vec<Path>, RegionError> {
    let swept = match along(hole) {
        None => Region::disc(super::place(hole), reach)?,
        Some(elements) => {
            let strokes = elements.iter().map(|e| Region::stroke(e, 2.0 * reach, Cap::Round));
            Region::union_of(&strokes.collect::<Result<Vec<Region>, RegionError>>()?)?
        }
    };
    Ok(swept.rings().filter_map(Path::around).collect())
}

/// Around rings that lie in each other, from the innermost out, at each depth; back inwards the tool goes
/// where it has cut.
fn outwards(rings: &[Path], depths: &[f64]) -> Cut {
    let mut paths: Vec<Path> = Vec::with_capacity(rings.len());
    for ring in rings {
        let ring = paths
            .last()
            .map_or(ring.clone(), |inner| ring.starting_at(ring.nearest(inner.start())));
        paths.push(ring);
    }
    let links: Vec<Element> =
        paths.windows(2).map(|pair| Element::line(pair[0].start(), pair[1].start())).collect();
    let mut segments = Vec::new();
    for (level, &depth) in depths.iter().enumerate() {
        if level > 0 {
            // Still at the depth before.
            let above = depths[level - 1];
            let back = links.iter().rev().map(Element::reversed);
            segments.extend(back.map(|element| Segment { element, depth: above }));
        }
        for (i, path) in paths.iter().enumerate() {
            let link = i.checked_sub(1).and_then(|i| links.get(i));
            let elements = link.into_iter().chain(path.elements());
            segments.extend(elements.map(|&element| Segment { element, depth }));
        }
    }
    Cut::Path(segments)
}

fn too_large(hole: &Hole, error: &RegionError) -> Fault {
    fault(Rule::TooLarge, format!("{}: {error}", of(hole)), "correct the drill file")
}
