//! Hole cycles of older controls (1 pecking, 2 tapping, 17 rigid tapping): they start where the tool
//! stands, at the set-up clearance above the surface, and end there (TNC 407 ISO p. 8-4, TNC 370 p. 8-6).

use super::state::{Control, TENTH_INCH};
use crate::kernel::Outcome;
use crate::klartext::language::scan::Scanner;
use program::{Cycle, CycleKind, Feed, Rule};

/// An older cycle with the values of its parts, `1.1` first, in mm, mm/min and s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Older {
    number: u32,
    values: [f64; 5],
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
    pub(super) fn clearance(&self) -> f64 {
        self.values[0].abs()
    }

    /// The cycle in the neutral vocabulary, or why that cannot be.
    pub(super) fn cycle(&self) -> Result<Cycle, String> {
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

impl Control<'_, '_> {
    /// A part of an older hole cycle: `1.2 DEPTH -15`; answers the cycle where it is the last one.
    pub(super) fn older_part(
        &mut self,
        s: &mut Scanner,
        number: u32,
        part: u32,
    ) -> Outcome<Option<Older>> {
        let value = self.named_value(s)?;
        let feed = if self.unit == 1.0 { 1.0 } else { TENTH_INCH };
        let unit = match (number, part) {
            (1, 4) | (2, 3) => 1.0,
            (1, 5) | (2, 4) => feed,
            _ => self.unit,
        };
        if part == 1 {
            self.older = Older { number, ..Older::default() };
        }
        let Some(place) = self.older.values.get_mut((part as usize).wrapping_sub(1)) else {
            return Err(s.error_block(Rule::CycleParameter, "the cycle has no such part"));
        };
        *place = value * unit;
        if part < parts_needed(number) {
            return Ok(None);
        }
        let checked = self.older.cycle();
        checked.map_err(|message| {
            s.error_block(Rule::CycleParameter, format!("cycle {number}: {message}"))
        })?;
        Ok(Some(self.older))
    }

    /// A value behind its name, which is of one or two words in the language of the control.
    fn named_value(&self, s: &mut Scanner) -> Outcome<f64> {
        let mut value = None;
        while value.is_none() && matches!(s.peek(), [b'A'..=b'P' | b'R'..=b'Z', ..]) {
            if !s.take(b"V.ZEIT") {
                value = s.word(&self.registers)?.and_then(|word| word.number);
            }
        }
        let value = match value {
            Some(value) => value,
            None => s.value(&self.registers)?,
        };
        s.finish()?;
        Ok(value)
    }
}
