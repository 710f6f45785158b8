//! Boards divided among their conductors: each keeps all copper that is nearer to it than to another.
//!
//! ```text
//!  boundaries ──samples──▶ points ──web──▶ places as near to one conductor as to another, in threads
//!     ──straight──▶ lines, cut off at the edge of the board
//! ```
//!
//! One way between two conductors is all that it takes, in the middle of the gap, where it is farthest
//! from both; all copper stays. Ways are in that middle to 5 µm, or a fiftieth of the gap where this is more.
//!
//! The triangles between the points are the work of the crate `spade`, whose predicates are exact.

mod samples;
mod straight;
mod web;

use crate::report::{Outcome, fault};
use crate::{Copper, Path};
use geom::Vec2;
use geom::region::{Index, Region};
use samples::{Boundary, frame};
use web::Place;

/// A board takes more points than there may be.
struct TooMany;

/// A gap is resolved down to this part of the tool's width.
const RESOLVED: f64 = 4.0;

/// What is wider than a gap by no more than this fits into it, mm: rounding.
const FITS: f64 = 1e-3;

/// How a board is divided among its conductors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Division {
    /// The ways of the middle of the tool.
    pub paths: Vec<Path>,
    /// The ways where it would cut into copper.
    pub straits: Vec<Strait>,
}

/// A way between two conductors that the tool is too wide for.
#[derive(Clone, Debug, PartialEq)]
pub struct Strait {
    /// The way in the middle, in parts where it leaves the area.
    pub paths: Vec<Path>,
    /// Where it is narrowest, mm.
    pub at: Vec2,
    /// How wide it is there, mm.
    pub width: f64,
    /// The islands of copper on both sides there.
    pub islands: [usize; 2],
}

/// The ways of a tool of `width` mm that divide `area` among the conductors of `copper`. Islands of the same
/// net are one conductor, an island of no known net is one of its own.
///
/// # Errors
/// `tool-width` where the width makes no sense; `too-much` where the boundaries are too long for it.
pub fn divided(copper: &Copper, area: &Region, width: f64) -> Outcome<Division> {
    if !(width > 0.0 && width.is_finite()) {
        let message = format!("a tool {width} mm wide cannot divide copper");
        return Err(fault("tool-width", message, "give the width of the cut in mm, above 0"));
    }
    let (Some(board), Some(around)) = (copper.region.extents(), area.extents()) else {
        return Ok(Division::default());
    };
    let boundary = Boundary::of(copper);
    let mut samples =
        boundary.samples(&Index::new(&copper.region), width / RESOLVED).map_err(|_| {
            let message = format!("the copper is too much for a tool {width} mm wide");
            fault("too-much", message, "use a wider tool, or divide the board in parts")
        })?;
    samples.extend(frame(board.0.min(around.0), board.1.max(around.1)));
    let threads = web::threads(&boundary, samples)
        .map_err(|error| fault("not-a-place", error.to_string(), "look at the copper's places"))?;
    let mut division = Division::default();
    let index = Index::new(area);
    let fits = |ends: &[Place]| ends.iter().all(|end| 2.0 * end.clearance >= width - FITS);
    for thread in &threads {
        for run in runs(thread, fits) {
            let path = straight::path(run.iter().map(|place| place.at));
            let paths = path.map(|path| path.within(&index)).unwrap_or_default();
            let inside = run.iter().filter(|place| index.island_at(place.at).is_some());
            let narrowest = inside.min_by(|a, b| a.clearance.total_cmp(&b.clearance));
            match narrowest.filter(|_| !fits(run)) {
                _ if paths.is_empty() => {}
                None => division.paths.extend(paths),
                Some(place) => division.straits.push(Strait {
                    paths,
                    at: place.at,
                    width: 2.0 * place.clearance,
                    islands: place.islands,
                }),
            }
        }
    }
    Ok(division)
}

/// The runs of a thread along which the tool fits everywhere, or nowhere; each ends where the next begins.
fn runs(thread: &[Place], fits: impl Fn(&[Place]) -> bool) -> Vec<&[Place]> {
    let pieces: Vec<bool> = thread.windows(2).map(fits).collect();
    let mut from = 0;
    let run = |alike: &[bool]| {
        let to = from + alike.len();
        let run = thread.get(from..=to);
        from = to;
        run
    };
    pieces.chunk_by(|a, b| a == b).filter_map(run).collect()
}
