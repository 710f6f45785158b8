//! Isolation: the ways of a tool around the copper.
//!
//! A pass is the boundary of the copper grown by half the width of the cut, and more for each pass after
//! the first. The grown copper is a region, so no way crosses another, and none comes nearer to copper
//! than half its width. Where two passes would meet there is nothing left to cut, and they end.

use crate::{Copper, Cutter, Path};
use geom::region::{Index, Region, RegionError};

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
    /// Which way around.
    pub direction: Direction,
}

/// How a tool goes along what stays, as the machine sees it and with a spindle that turns clockwise (M3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// What stays is on the right: there the teeth move against the tool's way, and so with the feed of
    /// the work.
    Climb,
    /// What stays is on the left.
    Conventional,
    /// As it comes.
    Either,
}

impl Isolation {
    /// How wide it cuts at the surface, mm.
    pub fn width(&self) -> f64 {
        self.cutter.width(self.depth)
    }

    /// The ways of the middle of the tool around `copper`, pass by pass; closed but for where they leave
    /// `area`.
    ///
    /// # Errors
    /// [`RegionError`] where the copper and its width are more than can be computed.
    pub fn passes(&self, copper: &Copper, area: Option<&Region>) -> Result<Vec<Path>, RegionError> {
        let area = area.map(Index::new);
        let mut paths = Vec::new();
        for pass in 0..self.passes {
            let apart = self.width() * (0.5 + pass as f64 * (1.0 - self.overlap));
            let around = copper.region.offset(apart)?;
            // The rings of a region have it on their left.
            let rings = around.rings().filter_map(Path::around);
            let turned = rings.map(|path| match self.direction {
                Direction::Climb => path.reversed(),
                Direction::Conventional | Direction::Either => path,
            });
            match &area {
                Some(area) => paths.extend(turned.flat_map(|path| path.within(area))),
                None => paths.extend(turned),
            }
        }
        Ok(paths)
    }
}
