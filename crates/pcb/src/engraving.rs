//! Legend and text, engraved.

use crate::Path;
use crate::board::covered;
use crate::gerber::{Image, Object};
use crate::report::{Fault, Outcome, fault};
use geom::Element;
use geom::region::{Index, Region, RegionError};
use program::Rule;

/// What is no farther than this from a point that the tool reaches counts as reached, mm.
const SLIVER: f64 = 0.005;

/// What is engraved.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Engraving {
    /// The paths of the centre of the tool. One without length is a dot.
    pub paths: Vec<Path>,
    /// What is too narrow for the tool, but for places up to 5 µm from one that it reaches.
    pub rest: Region,
}

/// The paths of a tool of `width` mm that engrave what `image` says: strokes of a round pen that is not wider
/// than the tool along their middle, and everything else along its outline, from inside.
///
/// # Errors
/// `tool-width` where the width makes no sense; `too-much` where the image is too large.
pub fn engraved(image: &Image, width: f64) -> Outcome<Engraving> {
    let is_line = |object: &Object| {
        object.dark && image.stroke(object).is_some_and(|(_, pen)| pen > 0.0 && pen <= width)
    };
    let mut shapes = image.clone();
    shapes.objects.retain(|object| !is_line(object));
    let mut engraving = outlined(&covered(&shapes).map_err(too_large)?, width)?;
    let lines = image.objects.iter().filter(|object| is_line(object));
    let lines = chained(lines.filter_map(|object| Some(image.stroke(object)?.0)));
    if image.objects.iter().all(|object| object.dark) {
        engraving.paths.extend(lines);
    } else {
        // What is erased from a line is not engraved.
        let covered = covered(image).map_err(too_large)?;
        let covered = Index::new(&covered);
        engraving.paths.extend(lines.iter().flat_map(|line| line.within(&covered)));
    }
    Ok(engraving)
}

/// The paths of a tool of `width` mm along the outline of `region`, from inside.
///
/// # Errors
/// `tool-width` where the width makes no sense; `too-much` where the region is too large.
fn outlined(region: &Region, width: f64) -> Outcome<Engraving> {
    if !(width > 0.0 && width.is_finite()) {
        let message = format!("a tool {width} mm wide cannot engrave");
        return Err(fault(Rule::ToolWidth, message, "give the width of the cut in mm, above 0"));
    }
    let middles = region.offset(-width / 2.0).map_err(too_large)?;
    let reached = middles.offset(width / 2.0 + SLIVER).map_err(too_large)?;
    let rest = region.difference(&reached).map_err(too_large)?;
    Ok(Engraving { paths: middles.rings().filter_map(Path::around).collect(), rest })
}

/// Paths along `lines`; a line that starts where the one before ends continues its path.
fn chained(lines: impl Iterator<Item = Element>) -> Vec<Path> {
    let lines: Vec<Element> = lines.collect();
    let chains = lines.chunk_by(|line, next| line.end == next.start);
    chains.filter_map(|chain| Path::new(chain.to_vec())).collect()
}

fn too_large(error: RegionError) -> Fault {
    fault(Rule::TooMuch, error.to_string(), "engrave it in parts")
}
