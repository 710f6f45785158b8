//! The numbers of words as a control counts them: lengths, angles, seconds, whole numbers.

use super::step::Step;
use crate::WholeNumbers;
use crate::event::{Action, Risk};
use crate::iso::dialects::facts::DwellUnit;
use crate::iso::language::Fault;
use crate::iso::language::arithmetic;
use crate::iso::language::words::WHOLE_NUMBERS_HELP;
use program::Rule;

impl Step<'_, '_, '_> {
    /// mm in the unit of length, for the word of this letter.
    ///
    /// # Errors
    /// The program has not said which unit it is in.
    #[inline]
    pub(super) fn unit(&self, inches: Option<bool>, letter: u8) -> Result<f64, Fault> {
        match inches {
            Some(true) => Ok(geom::INCH),
            Some(false) => Ok(1.0),
            None => Err(self.no_unit(letter)),
        }
    }

    #[cold]
    fn no_unit(&self, letter: u8) -> Fault {
        let message = "a length, and neither G20 nor G21 has been given";
        let fault = self.block.at_word(letter, Rule::Units, message);
        fault.help("write G20 or G21: a control keeps the unit of the program before").into()
    }

    /// The length (mm) of this letter.
    ///
    /// # Errors
    /// A length other than 0 before the unit is known. On FANUC a number other than 0 without a point
    /// where it is not known whether it counts units or least increments (parameter 3401, bit 0).
    #[inline]
    pub(super) fn take_length(&mut self, letter: u8) -> Result<Option<f64>, Fault> {
        let Some((value, increments)) = self.take_pointed(letter)? else { return Ok(None) };
        if value == 0.0 {
            return Ok(Some(0.0));
        }
        let unit = self.unit(self.state.inches, letter)?;
        let length = match (increments, self.state.inches) {
            (false, _) => value * unit,
            (true, Some(true)) => value / 10_000.0 * unit,
            (true, _) => value / 1000.0 * unit,
        };
        Ok(Some(if self.state.diameter && letter == b'X' { length / 2.0 } else { length }))
    }

    /// The angle (degrees) of this letter; errors as [`Step::take_length`].
    pub(super) fn take_degrees(&mut self, letter: u8) -> Result<Option<f64>, Fault> {
        let degrees = |(value, increments)| if increments { value / 1000.0 } else { value };
        Ok(self.take_pointed(letter)?.map(degrees))
    }

    /// The number of this letter, and whether it counts least increments.
    #[inline]
    pub(super) fn take_pointed(&mut self, letter: u8) -> Result<Option<(f64, bool)>, Fault> {
        let Some(word) = self.block.take(letter) else { return Ok(None) };
        if word.is_in_units() || word.value == 0.0 {
            return Ok(Some((word.value, false)));
        }
        match self.whole_numbers {
            WholeNumbers::Units => Ok(Some((word.value, false))),
            WholeNumbers::Increments => Ok(Some((word.value, true))),
            WholeNumbers::Unknown => Err(self.no_point(letter)),
        }
    }

    #[cold]
    fn no_point(&self, letter: u8) -> Fault {
        let shown = self.block.shown(letter);
        let message = format!(
            "{shown} has no decimal point: units or least increments, as the machine is set"
        );
        let fault = self.block.at_word(letter, Rule::DecimalPoint, message);
        fault.help(WHOLE_NUMBERS_HELP).into()
    }

    /// The whole number of this letter.
    pub(super) fn take_whole(&mut self, letter: u8) -> Result<Option<u32>, Fault> {
        let Some(word) = self.block.take(letter) else { return Ok(None) };
        let pointed = word.point && self.facts.numbers.point_counts;
        let value = if word.computed { arithmetic::whole(word.value) } else { exact(word.value) };
        match value.filter(|&value| !pointed && value <= 99_999_999) {
            Some(value) => Ok(Some(value)),
            None => {
                let message = format!("{} must be a whole number", char::from(letter));
                Err(self.block.at_word(letter, Rule::Number, message))
            }
        }
    }

    /// The dwell of a FANUC in P, s: least increments of time, of which it is not known how long they are where the
    /// machine's file does not say it.
    fn dwell_increments(&mut self) -> Result<Option<f64>, Fault> {
        let Some(increments) = self.take_whole(b'P')? else { return Ok(None) };
        if self.state.dwell_p_milliseconds.is_none() && increments > 0 {
            self.actions.push(Action::Risk(Risk::DWELL_UNIT.into()));
        }
        let a_second =
            if self.state.dwell_p_milliseconds == Some(false) { 10_000.0 } else { 1000.0 };
        Ok(Some(f64::from(increments) / a_second))
    }

    /// The dwell in P, s.
    pub(super) fn dwell_p(&mut self) -> Result<Option<f64>, Fault> {
        let unit = self.facts.numbers.dwell;
        if unit == DwellUnit::AsSetUp {
            return self.dwell_increments();
        }
        let stated = self.state.dwell_p_milliseconds;
        let word = self.block.take(b'P');
        let lasts = word.is_some_and(|word| word.value > 0.0);
        if unit == DwellUnit::SecondsAsSetUp && stated.is_none() && lasts {
            self.actions.push(Action::Risk(Risk::DWELL_AS_SET_UP.into()));
        }
        Ok(word.map(|word| match unit {
            DwellUnit::ByPoint if !word.point => word.value / 1000.0,
            DwellUnit::Milliseconds => word.value / 1000.0,
            DwellUnit::SecondsAsSetUp if stated == Some(true) => word.value / 1000.0,
            DwellUnit::Seconds
            | DwellUnit::ByPoint
            | DwellUnit::AsSetUp
            | DwellUnit::SecondsAsSetUp => word.value,
        }))
    }
}

/// The whole number that is written.
fn exact(value: f64) -> Option<u32> {
    (value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value)).then_some(value as u32)
}
