//! A hole cycle of older controls.

use program::{Cycle, CycleKind, Feed};

/// An older cycle with the values of its parts, `1.1` first, in mm, mm/min and s.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Older {
    pub number: u32,
    pub values: [f64; 5],
}

/// How many parts behind `.0` a cycle needs.
pub(crate) fn parts_needed(cycle: u32) -> u32 {
    match cycle {
        1 => 5,
        2 => 4,
        17 => 3,
        _ => 1,
    }
}

impl Older {
    /// Height of the tool above the surface where the cycle starts, mm. Still older controls write it
    /// with the sign of the depth.
    pub fn clearance(&self) -> f64 {
        self.values[0].abs()
    }

    /// The cycle in the neutral vocabulary, or why that cannot be.
    pub fn cycle(&self) -> Result<Cycle, String> {
        let [_, depth, third, fourth, fifth] = self.values;
        if depth >= 0.0 {
            return Err("the depth must be negative".into());
        }
        let (peck, dwell, feed) = match self.number {
            1 => (third.abs(), fourth, Some(fifth)),
            2 => (0.0, third, Some(fourth)),
            _ => (0.0, 0.0, None),
        };
        if !(0.0..=3600.0).contains(&dwell) || feed.is_some_and(|feed| feed <= 0.0) {
            return Err("the dwell is 0 to 3600 s, and the feed greater than 0".into());
        }
        let kind = match self.number {
            1 if peck == 0.0 => return Err("the pecking depth must not be 0".into()),
            1 if peck < -depth => CycleKind::Deep,
            1 => CycleKind::Drill,
            // The pitch follows from feed and spindle.
            2 => CycleKind::Tap { pitch: f64::NAN, left: false },
            _ if third == 0.0 => return Err("the pitch must not be 0".into()),
            _ => CycleKind::Tap { pitch: third.abs(), left: third < 0.0 },
        };
        let peck = Some(peck).filter(|_| kind == CycleKind::Deep);
        Ok(Cycle {
            kind,
            depth: -depth,
            clearance: self.clearance(),
            retract: self.clearance(),
            feed: feed.map(Feed::PerMinute),
            dwell,
            first_peck: peck,
            peck,
        })
    }
}
