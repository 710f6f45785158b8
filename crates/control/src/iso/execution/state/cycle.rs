//! The hole cycle that runs.

use crate::iso::language::words::Canned;
use program::Cycle;

/// The cycle that runs and what it keeps from block to block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Holding {
    pub canned: Canned,
    /// The level along the drilling axis when the first of the contiguous cycles began, mm.
    pub initial: f64,
    /// Last R and bottom as the words give them, mm.
    pub words: (Option<f64>, Option<f64>),
    /// R plane and bottom along the drilling axis, mm.
    pub r: Option<f64>,
    pub bottom: Option<f64>,
    /// Q, mm: a peck, or how far the tool goes aside.
    pub q: Option<f64>,
    /// P, s.
    pub dwell: Option<f64>,
    /// What the events said last.
    pub reported: Option<Cycle>,
    /// The spindle is turned by rigid tapping.
    pub rigid: bool,
}

impl Holding {
    /// Whether it cuts a thread with a tap.
    pub(crate) fn taps(&self) -> bool {
        matches!(self.canned, Canned::Tap | Canned::LeftTap)
    }

    /// The upper and the lower end of the feed, mm: back boring goes down to R and feeds up to Z.
    pub(crate) fn ends(&self) -> (Option<f64>, Option<f64>) {
        match self.canned == Canned::BackBore {
            true => (self.bottom, self.r),
            false => (self.r, self.bottom),
        }
    }
}
