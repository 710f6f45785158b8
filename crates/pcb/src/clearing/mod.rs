//! Areas that are cleared, of surplus copper or of solder mask, by one tool after the other.
//!
//! A tool of width w that stays within an area A has its middle in C = A − w/2 (offset inwards), and of A
//! it reaches C + w/2. For a narrower tool of width v, with its middle in D = A − v/2, the places are
//! left from where it cuts something that the wider one did not reach: all of D but (C + w/2) − v/2.

mod rings;

use crate::Path;
use crate::report::{Fault, Outcome, fault};
use geom::region::{Region, RegionError};

/// Of a place that was cut, what is not wider than twice this is not cut once more, mm.
const SLIVER: f64 = 0.005;

/// The finest step between rings, mm: regions are exact to a fifth of it.
const FINEST: f64 = 0.005;

/// The longest way of a tool, mm: 10 km, at 1 m/min a week.
const LONGEST: f64 = 1e7;

/// How an area is cleared.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearing {
    /// The ways of the middle of each tool, from the edge of the area inwards. Closed ones have what
    /// they clear on their left.
    pub passes: Vec<Vec<Path>>,
    /// What no tool reaches, but for slivers up to 10 µm wide.
    pub rest: Region,
}

/// How tools of these `widths` (mm, from the widest to the narrowest) clear `area` and cut nothing else: in
/// rings, each of which covers the part `overlap` (0 or more, below 1) of the width of the one before, or
/// more.
///
/// # Errors
/// `tool-width` and `overlap` where these make no sense; `too-much` where a way would be longer than
/// 10 km or a region is too large.
pub fn cleared(area: &Region, widths: &[f64], overlap: f64) -> Outcome<Clearing> {
    if !(0.0..1.0).contains(&overlap) {
        let message = format!("rings cannot cover {overlap} of the width of those before them");
        return Err(fault("overlap", message, "give a part from 0 to below 1, such as 0.4"));
    }
    for (i, width) in widths.iter().enumerate() {
        let step = width * (1.0 - overlap);
        if !(step >= FINEST && width.is_finite()) {
            let message = format!("a tool {width} mm wide cannot clear by steps of {step} mm");
            let help = format!("give a wider tool or less overlap: {FINEST} mm is the finest step");
            return Err(fault("tool-width", message, &help));
        }
        if let Some(wider) = i.checked_sub(1).and_then(|i| widths.get(i)).filter(|w| *w <= width) {
            let message =
                format!("a tool {width} mm wide has nothing to do after one of {wider} mm");
            return Err(fault("tool-width", message, "give the widest tool first, and each once"));
        }
    }
    let mut passes = Vec::with_capacity(widths.len());
    let mut reached = Region::default();
    for (width, middles) in widths.iter().zip(middles(area, widths).map_err(too_large)?) {
        let step = width * (1.0 - overlap);
        let idle = reached.offset(-width / 2.0).map_err(too_large)?;
        let busy = middles.difference(&idle).map_err(too_large)?;
        let way = busy.area() / step;
        if way > LONGEST {
            let message = format!("clearing by steps of {step} mm takes {:.0} m", way / 1e3);
            return Err(fault("too-much", message, "use a wider tool first, or clear less"));
        }
        passes.push(rings::of(busy, *width, step).map_err(too_large)?);
        reached = middles.offset(width / 2.0 + SLIVER).map_err(too_large)?;
    }
    Ok(Clearing { passes, rest: area.difference(&reached).map_err(too_large)? })
}

/// Where the middle of each tool may be.
fn middles(area: &Region, widths: &[f64]) -> Result<Vec<Region>, RegionError> {
    // From the narrowest on: wide tools find less and less to be kept off.
    let (mut inner, mut depth) = (area.clone(), 0.0);
    let mut middles = Vec::with_capacity(widths.len());
    for width in widths.iter().rev() {
        inner = inner.offset(depth - width / 2.0)?;
        depth = width / 2.0;
        middles.push(inner.clone());
    }
    middles.reverse();
    Ok(middles)
}

fn too_large(error: RegionError) -> Fault {
    fault("too-much", error.to_string(), "clear the area in parts")
}
