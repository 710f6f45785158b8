//! What holds for the whole file: unit, format of coordinates, and what is deprecated of that kind.

use crate::decimal::{decimal, whole};
use crate::gerber::words::Word;
use crate::report::{Outcome, fault};
use geom::INCH;
use program::Rule;

/// How coordinates are written (section 4.2.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Format {
    /// Digits before and after the point, for X and I.
    x: (u32, u32),
    /// The same for Y and J.
    y: (u32, u32),
    /// Whether zeros are left out at the end, not the start (deprecated, section 8.2.1).
    trailing: bool,
    /// Whether coordinates count from the last point (deprecated, section 8.2.1).
    pub(super) incremental: bool,
}

impl Format {
    /// Reads what stands behind `FS`.
    ///
    /// # Errors
    /// `format`
    pub(super) fn of(text: &[u8]) -> Outcome<Format> {
        let odd = || {
            let help = "it is such as %FSLAX36Y36*%: digits before and after the point";
            fault(Rule::Format, "not the format of coordinates", help)
        };
        let mut format = Format { x: (0, 0), y: (0, 0), trailing: false, incremental: false };
        let mut rest = text.trim_ascii();
        while let Some((letter, after)) = rest.split_first() {
            let length = after.iter().position(|c| !c.is_ascii_digit()).unwrap_or(after.len());
            let (digits, after) = after.split_at(length);
            rest = after;
            match (letter, digits) {
                (b'L' | b'A', []) => {}
                (b'T', []) => format.trailing = true,
                (b'I', []) => format.incremental = true,
                (b'X' | b'Y', [before @ b'0'..=b'6', after @ b'0'..=b'7']) => {
                    let both = (u32::from(before - b'0'), u32::from(after - b'0'));
                    *(if *letter == b'X' { &mut format.x } else { &mut format.y }) = both;
                }
                // How many digits other codes have.
                (b'N' | b'G' | b'D' | b'M', [b'0'..=b'9']) => {}
                _ => return Err(odd()),
            }
        }
        let whole = |digits: (u32, u32)| digits.0 + digits.1 > 0;
        if whole(format.x) && whole(format.y) { Ok(format) } else { Err(odd()) }
    }

    /// Whether it is one that the current specification no longer has.
    pub(super) fn is_deprecated(&self) -> bool {
        self.trailing || self.incremental || self.x != self.y
    }

    /// The value of a coordinate in the unit of the file.
    pub(super) fn value(&self, word: &Word) -> f64 {
        let (before, after) = if matches!(word.letter, b'X' | b'I') { self.x } else { self.y };
        let shift = if self.trailing { word.digits.saturating_sub(before) } else { after };
        word.value as f64 / 10f64.powi(i32::try_from(shift).unwrap_or(i32::MAX))
            * match self.trailing && word.digits < before {
                true => 10f64.powi(i32::try_from(before - word.digits).unwrap_or(0)),
                false => 1.0,
            }
    }

    /// The smallest step of a coordinate, in the unit of the file.
    pub(super) fn step(&self) -> f64 {
        10f64.powi(-i32::try_from(self.x.1.min(self.y.1)).unwrap_or(0))
    }
}

/// mm in the unit that `MO` names.
///
/// # Errors
/// `unit`
pub(super) fn unit(text: &[u8]) -> Outcome<f64> {
    match text.trim_ascii() {
        b"MM" => Ok(1.0),
        b"IN" => Ok(INCH),
        _ => Err(fault(Rule::Unit, "neither MM nor IN", "say %MOMM*% or %MOIN*%")),
    }
}

/// Looks at a deprecated command that moves or inverts the image as a whole (sections 8.1.2 to 8.1.9).
///
/// # Errors
/// `image-transformation` where it does anything: it was made for the output device, and readers differ in
/// what they make of it.
pub(super) fn transformation(name: &[u8; 2], text: &[u8]) -> Outcome {
    let numbers = |neutral: f64| {
        let mut rest = text.trim_ascii();
        while let Some((b'A' | b'B', after)) = rest.split_first() {
            let end = after.iter().position(u8::is_ascii_uppercase).unwrap_or(after.len());
            let (number, next) = after.split_at(end);
            if decimal(number.trim_ascii()) != Some(neutral) {
                return false;
            }
            rest = next;
        }
        rest.is_empty()
    };
    let neutral = match name {
        b"AS" => text.trim_ascii() == b"AXBY",
        b"IP" => text.trim_ascii() == b"POS",
        b"IR" => whole(text.trim_ascii()) == Some(0),
        b"SF" => numbers(1.0),
        _ => numbers(0.0),
    };
    if neutral {
        return Ok(());
    }
    let shown = String::from_utf8_lossy(&text[..text.len().min(30)]).into_owned();
    let name = String::from_utf8_lossy(name);
    let help =
        "it is deprecated, and readers differ in what it does: write the layer again without it";
    Err(fault(
        Rule::ImageTransformation,
        format!("{name}{shown} changes the image as a whole"),
        help,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(format: &str, letter: u8, digits: &str) -> f64 {
        let format = Format::of(format.as_bytes()).unwrap();
        let value = digits.parse().unwrap();
        let digits = digits.trim_start_matches('-').len() as u32;
        format.value(&Word { letter, value, digits })
    }

    #[test]
    fn zeros_are_left_out_in_front_or_behind() {
        assert_eq!(value("LAX24Y24", b'X', "-15"), -0.0015);
        assert_eq!(value("LAX36Y36", b'J', "123123456"), 123.123456);
        // The older specification's example: X15 with trailing zeros left out in 2.3 is 15.
        assert_eq!(value("TAX23Y23", b'X', "15"), 15.0);
        assert_eq!(value("TAX23Y23", b'X', "00015"), 0.015);
        assert_eq!(value("TAX23Y23", b'X', "1"), 10.0);
    }

    #[test]
    fn only_what_changes_nothing_is_taken() {
        for (name, text) in
            [(b"AS", "AXBY"), (b"IP", "POS"), (b"MI", "A0B0"), (b"SF", "A1.0B1"), (b"OF", "A0.0B0")]
        {
            assert!(transformation(name, text.as_bytes()).is_ok(), "{text}");
        }
        for (name, text) in [
            (b"AS", "AYBX"),
            (b"IP", "NEG"),
            (b"MI", "A1"),
            (b"SF", "B2"),
            (b"OF", "A1"),
            (b"IR", "90"),
        ] {
            assert_eq!(
                transformation(name, text.as_bytes()).unwrap_err().rule,
                "image-transformation"
            );
        }
        assert!(
            Format::of(b"LAX2Y24").is_err()
                && Format::of(b"LA").is_err()
                && Format::of(b"LAX99Y99").is_err()
        );
    }
}
