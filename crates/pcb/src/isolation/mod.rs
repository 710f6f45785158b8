//! Isolation: the paths of a tool around the copper, and the places where it does not fit.
//!
//! A pass is the boundary of the copper grown by half the width of the cut, and more for each pass after
//! the first. The grown copper is a region, so no path crosses another, and none comes nearer to copper
//! than half its width. Where two passes would meet there is nothing left to cut, and they end.
//!
//! Where two conductors are nearer to each other than the cut is wide, the passes run around both, and what
//! is between them stays. Such a gap is found by the line in its middle: a [`NarrowGap`], which is left
//! out or cut along that line, as the user says. What that does to thin copper is reported: a conductor that it
//! leaves in pieces is [`Severed`]. A [`Slot`] within one conductor that the cut does not enter is reported too.

mod bite;
mod field;
mod gap;
mod lines;
mod middle;
mod severed;
mod slot;
mod swept;

pub use bite::{BITE_OFF, MOST_BITE};
pub use gap::{FITS, Fate, NarrowGap};
pub use severed::{Severed, severed};
pub use slot::Slot;

pub(crate) use bite::Bite;
pub(crate) use gap::{cuts, decide};

use crate::{Copper, Cutter, Path};
use geom::region::{Index, Region, RegionError};
use program::{Diagnostic, Rule};

/// How copper is isolated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isolation {
    /// With what.
    pub cutter: Cutter,
    /// How deep its tip goes, mm below the surface, greater than 0.
    pub depth: f64,
    /// How often around, at least once.
    pub passes: usize,
    /// By which part of its width a pass overlaps the one before: 0 or more, less than 1.
    pub overlap: f64,
    /// In which direction around.
    pub direction: Direction,
    /// What is done where the cut is too wide.
    pub narrow: Narrow,
}

/// How a tool goes along what stays, as the machine sees it and with a spindle that turns clockwise (M3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// What stays is on the right: there the teeth move against the direction of the tool, and so with the feed of
    /// the work.
    Climb,
    /// What stays is on the left.
    Conventional,
    /// As it comes.
    Either,
}

/// What is done in gaps that are narrower than the cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Narrow {
    /// A cut down the middle where it takes no more than [`MOST_BITE`] mm, and a tenth of the copper behind the edge, from
    /// either side, both to [`BITE_OFF`] mm; else nothing.
    Bite,
    /// Nothing: the conductors stay joined there.
    LeaveOut,
    /// A cut down the middle, which takes as much from the one as from the other.
    Middle,
}

/// Copper that is isolated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Isolated {
    /// The paths of the centre of the tool, pass by pass, and then down the middle of gaps; closed but for
    /// those in gaps, and where they leave the area.
    pub paths: Vec<Path>,
    /// Where the cut is too wide, whether it is made or not; the narrowest first.
    pub narrow: Vec<NarrowGap>,
    /// Slots within conductors which the tool does not enter; the longest first.
    pub slots: Vec<Slot>,
    /// Copper that stays between conductors, and in slots.
    pub unreached: Region,
    /// What the middle of the tool stays out of, but for cuts down the middle of gaps.
    pub around: Region,
    /// Whether the paths go around all copper together, and none is between conductors.
    pub is_around_all: bool,
    /// Which conductors the cuts down the middle of gaps leave in pieces.
    pub severed: Vec<Severed>,
}

impl Isolation {
    /// How wide it cuts at the surface, mm.
    pub fn width(&self) -> f64 {
        self.cutter.width(self.depth)
    }

    /// The paths around `copper`, within `area` where one is given.
    ///
    /// # Errors
    /// Where there is more than can be computed: `board-too-large`, and `cut-too-wide` where the cut is
    /// so wide that too much is within its reach everywhere.
    pub fn isolate(
        &self,
        copper: &Copper,
        area: Option<&Region>,
    ) -> Result<Isolated, Box<Diagnostic>> {
        let width = self.width();
        let (passes, gaps) = rayon::join(
            || self.passes(copper),
            || gap::gaps(&Bite::new(copper, width, self.narrow), width),
        );
        let (around, mut paths) = passes.map_err(too_large)?;
        let mut gaps = gaps.map_err(|_| too_wide(width))?;
        let is_one_ring = around.rings().count() == 1;
        paths.append(&mut gaps.fitting.clone());
        let mut short = decide(&mut gaps.narrow, gaps.short, &paths, width);
        gaps.fitting.extend(short.iter().cloned());
        paths.append(&mut short);
        let is_around_all = is_one_ring && gaps.fitting.is_empty();
        let mut middles: Vec<Path> = cuts(&gaps.narrow).cloned().collect();
        let is_around_all = is_around_all && middles.is_empty();
        gaps.fitting.extend(middles.iter().cloned());
        let unreached =
            slot::unreached(copper, &around, &gaps.fitting, width).map_err(too_large)?;
        let slot::Unreached { mut slots, region: unreached } = unreached;
        if let Some(area) = area.map(Index::new) {
            let within = |path: &Path| path.within(&area);
            (paths, middles) = (
                paths.iter().flat_map(within).collect(),
                middles.iter().flat_map(within).collect(),
            );
            gaps.narrow.retain(|gap| area.island_at(gap.at).is_some());
            slots.retain(|slot| area.island_at(slot.at).is_some());
        }
        let severed = severed(copper, &middles, width)?;
        paths.append(&mut middles);
        let narrow = gaps.narrow;
        Ok(Isolated { paths, narrow, slots, unreached, around, is_around_all, severed })
    }

    /// What the middle of the tool stays out of, and all passes around the copper.
    fn passes(&self, copper: &Copper) -> Result<(Region, Vec<Path>), RegionError> {
        let mut paths = Vec::new();
        let mut first = None;
        for pass in 0..self.passes {
            let apart = self.width() * (0.5 + pass as f64 * (1.0 - self.overlap));
            let around = copper.region.offset(apart)?;
            // The rings of a region have it on their left.
            paths.extend(around.rings().filter_map(Path::around).map(
                |path| match self.direction {
                    Direction::Climb => path.reversed(),
                    Direction::Conventional | Direction::Either => path,
                },
            ));
            first.get_or_insert(around);
        }
        Ok((first.unwrap_or_default(), paths))
    }
}

fn too_large(error: RegionError) -> Box<Diagnostic> {
    let finding = Diagnostic::error(Rule::BoardTooLarge, error.to_string());
    Box::new(finding.help("take a part of the board"))
}

fn too_wide(width: f64) -> Box<Diagnostic> {
    let what = format!("a cut {width:.3} mm wide is near too much of the copper everywhere");
    Box::new(Diagnostic::error(Rule::CutTooWide, what).help("take a narrower tool"))
}
