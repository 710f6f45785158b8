//! Boards divided among their conductors: each keeps all copper that is nearer to it than to another.
//!
//! ```text
//!  boundaries ──samples──▶ points ──diagram──▶ places as near to one conductor as to another, in chains
//!     ──straight──▶ lines, cut off at the edge of the board
//! ```
//!
//! One path between two conductors is enough, in the middle of the gap, where it is farthest
//! from both; all copper stays. Paths are in that middle to 5 µm, or a fiftieth of the gap where this is more.
//!
//! The triangles between the points are the work of the crate `spade`, whose predicates are exact.

mod diagram;
mod samples;
mod straight;

use crate::isolation::{Bite, FITS, Fate, Narrow, NarrowGap, cuts, decide};
use crate::report::{Outcome, fault};
use crate::{Copper, Path};
use diagram::DiagramPoint;
use geom::region::{Index, Region};
use program::Rule;
use samples::{Boundary, frame};

/// The most points on boundaries: some 500 MB.
const MOST: usize = 2_000_000;

/// A board takes more points than there may be.
struct TooMany;

/// How a board is divided among its conductors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Division {
    /// The paths of the centre of the tool, those down the middle of gaps too.
    pub paths: Vec<Path>,
    /// Where it cuts into copper, or would, each with its path; the narrowest first.
    pub narrow: Vec<NarrowGap>,
}

/// The paths of a tool of `width` mm that divide `area` among the [conductors](Copper::conductors) of `copper`. What is done
/// where it is wider than the gap, `narrow` says.
///
/// # Errors
/// `tool-width` where the width makes no sense; `too-much` where there are too many gaps.
pub fn divided(copper: &Copper, area: &Region, width: f64, narrow: Narrow) -> Outcome<Division> {
    if !(width > 0.0 && width.is_finite()) {
        let message = format!("a tool {width} mm wide cannot divide copper");
        return Err(fault(Rule::ToolWidth, message, "give the width of the cut in mm, above 0"));
    }
    let (Some(board), Some(around)) = (copper.region.extents(), area.extents()) else {
        return Ok(Division::default());
    };
    let boundary = Boundary::of(copper);
    let index = Index::new(&copper.region);
    let mut samples = boundary.samples(&index, MOST).map_err(|_| {
        let message = format!("the gaps of the board take more than {MOST} points");
        fault(Rule::TooMuch, message, "divide the board in parts")
    })?;
    samples.extend(frame(board.0.min(around.0), board.1.max(around.1)));
    let chains = diagram::chains(&boundary, samples, &index).map_err(|error| {
        fault(Rule::NotAPlace, error.to_string(), "look at the copper's places")
    })?;
    let mut division = Division::default();
    let area = Index::new(area);
    let bite = Bite::new(copper, width, narrow);
    let is_wide = |end: &DiagramPoint| 2.0 * end.clearance >= width - FITS;
    let fits = |ends: &[DiagramPoint]| ends.iter().all(is_wide);
    // Whether a piece fits, and whether it is cut all the same.
    let kind = |ends: &[DiagramPoint]| {
        let fits = fits(ends);
        (fits, !fits && ends.iter().all(|end| is_wide(end) || bite.may_cut(end.at)))
    };
    for chain in &chains {
        for run in runs(chain, kind) {
            let path = straight::path(run.iter().map(|place| place.at));
            let paths = path.map(|path| path.within(&area)).unwrap_or_default();
            if fits(run) {
                division.paths.extend(paths);
                continue;
            }
            let is_cut = run.get(..2).is_some_and(|piece| kind(piece).1);
            let fate = if is_cut { Fate::Cut } else { Fate::Joined };
            // The narrowest place of those that are in the area, if any is.
            let outside = |place: &DiagramPoint| area.island_at(place.at).is_none();
            let narrowest = run.iter().min_by(|a, b| {
                outside(a).cmp(&outside(b)).then(a.clearance.total_cmp(&b.clearance))
            });
            division.narrow.extend(narrowest.into_iter().flat_map(|place| {
                paths.iter().map(|path| NarrowGap {
                    at: place.at,
                    islands: place.islands,
                    width: 2.0 * place.clearance,
                    length: path.length(),
                    middle: Some(path.clone()),
                    fate,
                })
            }));
        }
    }
    division.narrow.sort_by(|a, b| a.width.total_cmp(&b.width));
    decide(&mut division.narrow, Vec::new(), &division.paths, width);
    division.paths.extend(cuts(&division.narrow).cloned());
    Ok(division)
}

/// The runs of a chain whose pieces are of one kind; each ends where the next begins.
fn runs<Kind: PartialEq>(
    chain: &[DiagramPoint],
    kind: impl Fn(&[DiagramPoint]) -> Kind,
) -> Vec<&[DiagramPoint]> {
    let pieces: Vec<Kind> = chain.windows(2).map(kind).collect();
    let mut from = 0;
    let run = |alike: &[Kind]| {
        let to = from + alike.len();
        let run = chain.get(from..=to);
        from = to;
        run
    };
    pieces.chunk_by(|a, b| a == b).filter_map(run).collect()
}
