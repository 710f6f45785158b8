//! Hole cycles of older controls (1 pecking, 2 tapping, 17 rigid tapping): they start where the tool
//! stands, at the set-up clearance above the surface, and end there (TNC 407 ISO p. 8-4, TNC 370 p. 8-6).

use super::layout::TENTH_INCH;
use super::state::Control;
use super::state::older::{Older, parts_needed};
use crate::kernel::Outcome;
use crate::klartext::language::scan::Scanner;
use program::Rule;

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
