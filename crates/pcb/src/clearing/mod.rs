//! Areas that are cleared, of surplus copper or of solder mask, by one tool after the other.
//!
//! A tool of width w that stays within an area A has its middle in C = A − w/2 (offset inwards), and of A
//! it reaches C + w/2. What it leaves, D, is for the next, narrower tool, which goes where it cuts some of
//! D: within (D + w) ∩ A, since no place that it cuts together with one of D is farther from that than w.

mod rings;

use crate::clip::Clip;
use crate::report::{Outcome, fault};
use crate::Path;
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
    /// The ways of the middle of each tool, from the edge of the area inwards.
    pub passes: Vec<Vec<Path>>,
    /// What no tool reaches, but for slivers up to 10 µm wide.
    pub rest: Region,
}

/// How tools of these `widths` (mm, the widest first) clear `area` and cut nothing else: in rings, each
/// of which covers the part `overlap` (0 or more, below 1) of the width of the one before, or more.
///
/// # Errors
/// `tool-width` and `overlap` where these make no sense; `too-much` where a way would be longer than
/// 10 km or a region is too large.
pub fn cleared(area: &Region, widths: &[f64], overlap: f64) -> Outcome<Clearing> {
    if !(0.0..1.0).contains(&overlap) {
        let message = format!("rings cannot cover {overlap} of the width of those before them");
        return Err(fault("overlap", message, "give a part from 0 to below 1, such as 0.4"));
    }
    let mut clearing = Clearing { passes: Vec::new(), rest: area.clone() };
    for width in widths {
        let step = width * (1.0 - overlap);
        if !(step >= FINEST && width.is_finite()) {
            let message = format!("a tool {width} mm wide cannot clear by steps of {step} mm");
            let help = format!("give a wider tool or less overlap: {FINEST} mm is the finest step");
            return Err(fault("tool-width", message, &help));
        }
        let way = clearing.rest.area() / step;
        if way > LONGEST {
            let message = format!("clearing by steps of {step} mm takes {:.0} m", way / 1e3);
            return Err(fault("too-much", message, "use a wider tool first, or clear less"));
        }
        clearing.pass(area, *width, step).map_err(|error| {
            fault("too-much", error.to_string(), "clear the area in parts, or by wider tools")
        })?;
    }
    Ok(clearing)
}

impl Clearing {
    /// Has the next tool do what it can of the rest of `area`.
    fn pass(&mut self, area: &Region, width: f64, step: f64) -> Result<(), RegionError> {
        let within = match self.passes.is_empty() {
            true => area.clone(),
            false => self.rest.offset(width + SLIVER)?.intersection(area)?,
        };
        let middles = within.offset(-width / 2.0)?;
        let reached = middles.offset(width / 2.0 + SLIVER)?;
        // Beyond copper there may be places near to the rest from which it is out of reach.
        let cutting = self.rest.offset(width / 2.0)?;
        let cutting = Clip::to(&cutting);
        let rings = rings::of(middles, width, step)?;
        self.passes.push(rings.into_iter().filter(|path| cutting.meets(path)).collect());
        self.rest = self.rest.difference(&reached)?;
        Ok(())
    }
}
