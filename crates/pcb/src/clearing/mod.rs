//! Areas that are cleared, of surplus copper or of solder mask, by one tool after the other.
//!
//! A tool of width w that stays within an area A has its middle in C = A − w/2 (offset inwards), and of A
//! it reaches C + w/2. For a narrower tool of width v, with its middle in D = A − v/2, the places are
//! left from where it cuts something that the wider one did not reach: all of D but (C + w/2) − v/2.

mod rings;

use crate::Path;
use crate::isolation::Direction;
use crate::report::{Fault, Outcome, fault};
use geom::region::{Region, RegionError};
use program::Rule;

/// What is no farther than this from a place that the tool reaches counts as reached, mm.
const SLIVER: f64 = 0.005;

/// The finest step between rings, mm: regions are exact to a fifth of it.
const FINEST: f64 = 0.005;

/// The longest path of a tool, mm: 10 km, at 1 m/min a week.
const LONGEST: f64 = 1e7;

/// How an area is cleared.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearing {
    /// How wide the tools cut, mm, from the widest to the narrowest.
    pub widths: Vec<f64>,
    /// Which part of its width a ring shares with the one before at least: 0 or more, less than 1.
    pub overlap: f64,
    /// In which direction around.
    pub direction: Direction,
}

/// An area that is cleared.
#[derive(Clone, Debug, PartialEq)]
pub struct Cleared {
    /// The paths of the centre of each tool, from the edge of the area inwards; closed, but for those along
    /// ridges between rings.
    pub passes: Vec<Vec<Path>>,
    /// What no tool reaches, but for places up to 10 µm from one that is cut.
    pub rest: Region,
}

impl Clearing {
    /// The paths that clear `board` of all copper that is farther than `margin` mm from `copper`.
    ///
    /// # Errors
    /// As [`Clearing::clear`].
    pub fn rub_out(&self, copper: &Region, margin: f64, board: &Region) -> Outcome<Cleared> {
        let kept = copper.offset(margin).map_err(too_large)?;
        self.clear(&board.difference(&kept).map_err(too_large)?)
    }

    /// The paths that clear `area`, such as where solder mask is to be open, and cut nothing else.
    ///
    /// # Errors
    /// `tool-width` and `overlap` where these make no sense; `too-much` where a path would be longer than
    /// 10 km or a region is too large.
    pub fn clear(&self, area: &Region) -> Outcome<Cleared> {
        self.check()?;
        let mut passes = Vec::with_capacity(self.widths.len());
        let mut reached = Region::default();
        let middles = middles(area, &self.widths).map_err(too_large)?;
        for (width, middles) in self.widths.iter().zip(middles) {
            let step = width * (1.0 - self.overlap);
            let idle = reached.offset(-width / 2.0).map_err(too_large)?;
            let busy = middles.difference(&idle).map_err(too_large)?;
            let length = busy.area() / step;
            if length > LONGEST {
                let message = format!("clearing by steps of {step} mm takes {:.0} m", length / 1e3);
                return Err(fault(Rule::TooMuch, message, "use a wider tool first, or clear less"));
            }
            // Not where the middle may be, but where it goes: what is as small as the rounding of regions may be
            // lost between the two, and a disc around it is not small.
            let cut = busy.offset(width / 2.0 + SLIVER).map_err(too_large)?;
            reached = reached.union(&cut).map_err(too_large)?;
            let rings = rings::of(busy, *width, step).map_err(too_large)?;
            // The rings have on their right what stays.
            let paths = rings.into_iter().map(|ring| match self.direction {
                Direction::Climb | Direction::Either => ring,
                Direction::Conventional => ring.reversed(),
            });
            passes.push(paths.collect());
        }
        Ok(Cleared { passes, rest: area.difference(&reached).map_err(too_large)? })
    }

    fn check(&self) -> Outcome {
        let overlap = self.overlap;
        if !(0.0..1.0).contains(&overlap) {
            let message = format!("rings cannot share {overlap} of their width");
            return Err(fault(
                Rule::Overlap,
                message,
                "give a part from 0 to below 1, such as 0.4",
            ));
        }
        let mut wider = f64::INFINITY;
        for width in &self.widths {
            let step = width * (1.0 - overlap);
            if !(step >= FINEST && width.is_finite()) {
                let message = format!("a tool {width} mm wide cannot clear by steps of {step} mm");
                let help = format!("take a wider tool or less overlap: {FINEST} mm is the least");
                return Err(fault(Rule::ToolWidth, message, &help));
            }
            if *width >= wider {
                let message =
                    format!("a tool {width} mm wide finds nothing after one of {wider} mm");
                return Err(fault(
                    Rule::ToolWidth,
                    message,
                    "name the widest tool first, each once",
                ));
            }
            wider = *width;
        }
        Ok(())
    }
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
    fault(Rule::TooMuch, error.to_string(), "clear the area in parts")
}
