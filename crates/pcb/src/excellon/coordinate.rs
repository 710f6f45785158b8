//! How coordinates are written: unit, zeros, places.

use crate::FAR;
use crate::decimal::decimal;
use crate::report::{Outcome, fault};
use geom::INCH;
use program::Rule;

/// Which zeros of a coordinate without a point are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Zeros {
    /// `LZ`: the first digit is always that of the highest place.
    Leading,
    /// `TZ`: the last digit is always that of the lowest place.
    Trailing,
}

/// The unit of lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Inches.
    Inch,
    /// Millimetres.
    Metric,
}

impl Unit {
    pub(super) fn millimetres(self) -> f64 {
        match self {
            Unit::Inch => INCH,
            Unit::Metric => 1.0,
        }
    }

    /// Places before and after the point, unless the file says otherwise.
    fn places(self) -> (usize, usize) {
        match self {
            Unit::Inch => (2, 4),
            Unit::Metric => (3, 3),
        }
    }
}

/// What is known of how coordinates are written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Notation {
    pub(super) unit: Option<Unit>,
    pub(super) zeros: Option<Zeros>,
    /// Places before and after the point.
    pub(super) places: Option<(usize, usize)>,
}

impl Notation {
    /// A length with a point, such as a diameter, mm.
    ///
    /// # Errors
    /// `word`, `no-unit`
    pub(super) fn length(&self, text: &[u8]) -> Outcome<f64> {
        let number = decimal(text).ok_or_else(|| malformed(text))?;
        Ok(number * self.unit()?.millimetres())
    }

    /// A coordinate, mm.
    ///
    /// # Errors
    /// `word`, `no-unit`, `no-zeros`, `format`, `not-a-place`
    pub(super) fn coordinate(&self, text: &[u8]) -> Outcome<f64> {
        let unit = self.unit()?;
        let number = decimal(text).ok_or_else(|| malformed(text))?;
        let number = match text.contains(&b'.') {
            true => number,
            false => number * self.scale(text, unit)?,
        };
        let value = number * unit.millimetres();
        if value.abs() > FAR {
            let message = format!("{value} is not a place within {FAR} mm");
            return Err(fault(Rule::NotAPlace, message, "look at the unit and the format"));
        }
        Ok(value)
    }

    /// What the last digit of a number without a point is worth.
    fn scale(&self, text: &[u8], unit: Unit) -> Outcome<f64> {
        let digits = text.iter().filter(|c| c.is_ascii_digit()).count();
        let (before, after) = self.places.unwrap_or(unit.places());
        if digits > before + after {
            let message = format!("{digits} digits, where {before} and {after} are the format");
            let help = "say the format in the header, such as METRIC,TZ,000.0000";
            return Err(fault(Rule::Format, message, help));
        }
        let places = match self.zeros {
            // No zeros were left out, so nothing distinguishes the two.
            _ if digits == before + after || decimal(text) == Some(0.0) => after,
            Some(Zeros::Trailing) => after,
            Some(Zeros::Leading) => {
                // Fewer digits than stand before the point are worth more than 1.
                let worth = i32::try_from(before).unwrap_or(0) - i32::try_from(digits).unwrap_or(0);
                return Ok(10f64.powi(worth));
            }
            None => {
                let help = "say LZ or TZ in the header, such as METRIC,TZ";
                return Err(fault(Rule::NoZeros, "which zeros were left out is not said", help));
            }
        };
        Ok(10f64.powi(-i32::try_from(places).unwrap_or(0)))
    }

    fn unit(&self) -> Outcome<Unit> {
        self.unit.ok_or_else(|| {
            let help = "say METRIC or INCH in the header, or --unit mm or --unit inch";
            fault(Rule::NoUnit, "a length, but the file does not say its unit", help)
        })
    }
}

#[cold]
fn malformed(text: &[u8]) -> crate::report::Fault {
    let shown = String::from_utf8_lossy(&text[..text.len().min(30)]).into_owned();
    fault(Rule::DataWord, format!("{shown:?} is no number"), "correct it")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(unit: Unit, zeros: Zeros, text: &str) -> f64 {
        let notation = Notation { unit: Some(unit), zeros: Some(zeros), places: None };
        notation.coordinate(text.as_bytes()).unwrap() / unit.millimetres()
    }

    /// The examples of the CNC-7 manual and of FlatCAM's page on the format.
    #[test]
    fn zeros_in_front_and_behind() {
        assert!((value(Unit::Inch, Zeros::Leading, "12345") - 12.345).abs() < 1e-12);
        assert!((value(Unit::Inch, Zeros::Leading, "023456") - 2.3456).abs() < 1e-12);
        assert!((value(Unit::Inch, Zeros::Trailing, "12345") - 1.2345).abs() < 1e-12);
        assert!((value(Unit::Metric, Zeros::Trailing, "-12345") + 12.345).abs() < 1e-12);
        assert!((value(Unit::Metric, Zeros::Leading, "1") - 100.0).abs() < 1e-12);
        assert_eq!(value(Unit::Metric, Zeros::Leading, "0"), 0.0);
        assert_eq!(value(Unit::Metric, Zeros::Leading, "7.25"), 7.25);
    }

    #[test]
    fn what_is_not_said_is_refused() {
        let rule = |notation: Notation, text: &[u8]| notation.coordinate(text).unwrap_err().rule;
        let metric = Notation { unit: Some(Unit::Metric), ..Notation::default() };
        assert_eq!(rule(Notation::default(), b"1.5"), "no-unit");
        assert_eq!(rule(metric, b"1234"), "no-zeros");
        assert_eq!(rule(metric, b"1234567"), "format");
        assert_eq!(rule(metric, b"1.2.3"), "data-word");
        assert_eq!(rule(metric, b"9999999.0"), "not-a-place");
        // All six digits are there, whichever zeros would have been left out.
        assert_eq!(metric.coordinate(b"123456").unwrap(), 123.456);
    }
}
