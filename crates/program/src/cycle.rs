//! Hole cycles.

use crate::Feed;
use geom::Vec3;

/// A hole cycle. Heights are mm from the point of the hole, positive along the tool axis, away from
/// the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// What the tool does in the hole.
    pub kind: CycleKind,
    /// Depth of the bottom below the point, mm, greater than 0.
    pub depth: f64,
    /// Height above the point from which the tool feeds (the R plane), mm.
    pub clearance: f64,
    /// Height above the point to which the tool goes back after the hole, mm.
    pub retract: f64,
    /// Feed into the hole; `None` leaves the active feed.
    pub feed: Option<Feed>,
    /// Dwell at the bottom, s; 0 for none.
    pub dwell: f64,
    /// Depth of the first peck, mm, where the cycle pecks.
    pub first_peck: Option<f64>,
    /// Depth of each further peck, mm, where the cycle pecks.
    pub peck: Option<f64>,
}

/// What the tool does in the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CycleKind {
    /// Feed in, rapid out (`G81`, `G82` with dwell).
    Drill,
    /// Feed in by pecks, to the R plane after each (`G83`).
    Deep,
    /// Feed in by pecks with a short break of the chip after each (`G73`).
    BreakChip,
    /// Feed in in step with the spindle, reverse, feed out (`G84`, `G74`). Pitch in mm.
    Tap {
        /// mm a turn.
        pitch: f64,
        /// Left-hand thread.
        left: bool,
    },
    /// Feed in, feed out (`G85`, `G89` with dwell).
    Ream,
    /// Feed in, spindle stop, rapid out (`G86`).
    Bore,
    /// Feed in, aside from the wall, rapid out, back over the hole, where the spindle turns again (`G76`).
    FineBore(Withdrawal),
    /// Aside above the hole, down through it to the bottom, back to the axis, feed **up** to the point
    /// with the spindle turning, aside again and out (`G87`). The clearance is the height at which the
    /// tool goes aside.
    BackBore {
        /// How it passes through the hole.
        withdrawal: Withdrawal,
        /// Feed of the way through the hole, in and out; `None` is by rapid.
        through: Option<Feed>,
    },
}

/// How a boring bar leaves the wall: the spindle stops in position, and the tool goes aside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Withdrawal {
    /// How far and where to, mm, in the frame of the pose's point.
    pub aside: Vec3,
    /// Position of the spindle, degrees; `None` is the one that the machine is set to (`M19`).
    pub angle: Option<f64>,
}

impl CycleKind {
    /// How the tool leaves the wall, where it does.
    pub fn withdrawal(&self) -> Option<&Withdrawal> {
        match self {
            CycleKind::FineBore(withdrawal) | CycleKind::BackBore { withdrawal, .. } => {
                Some(withdrawal)
            }
            CycleKind::Drill
            | CycleKind::Deep
            | CycleKind::BreakChip
            | CycleKind::Tap { .. }
            | CycleKind::Ream
            | CycleKind::Bore => None,
        }
    }

    /// The same, where the tool leaves the wall by `aside`.
    pub fn with_aside(mut self, aside: Vec3) -> CycleKind {
        if let CycleKind::FineBore(withdrawal) | CycleKind::BackBore { withdrawal, .. } = &mut self
        {
            withdrawal.aside = aside;
        }
        self
    }
}
