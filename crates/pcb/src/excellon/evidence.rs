//! What a file says between the lines about how its coordinates are written.

use super::coordinate::{Notation, Unit, Zeros};
use super::words::{lines, words};
use crate::decimal::decimal;

/// What was found in the text.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Evidence {
    /// What comments of KiCad, Altium and Eagle say.
    pub(super) comments: Notation,
    /// The least and the greatest diameter, in the unit of the file.
    diameters: Option<(f64, f64)>,
    /// Whether a coordinate with less than six digits begins with a zero.
    begins_with_zero: bool,
    /// Whether one ends with a zero.
    ends_with_zero: bool,
    /// Whether `M71`, and whether `M72`, stands anywhere.
    metric: bool,
    inch: bool,
    /// Whether routes say `M15` where the tool goes down.
    pub(super) plunges: bool,
}

impl Evidence {
    /// Looks through a file.
    pub(super) fn of(text: &[u8]) -> Evidence {
        let mut evidence = Evidence::default();
        for (_, _, line) in lines(text) {
            if let Some(comment) = line.strip_prefix(b";") {
                evidence.comment(comment);
                continue;
            }
            let tool = line.first() == Some(&b'T');
            for word in words(line).unwrap_or_default() {
                match word.letter {
                    b'C' if tool => evidence.diameter(word.number),
                    b'X' | b'Y' if !word.number.contains(&b'.') => evidence.coordinate(word.number),
                    b'M' if word.number == b"15" => evidence.plunges = true,
                    b'M' if word.number == b"71" => evidence.metric = true,
                    b'M' if word.number == b"72" => evidence.inch = true,
                    _ => {}
                }
            }
        }
        evidence
    }

    /// `FORMAT={3:3/ absolute / metric / suppress leading zeros}` of KiCad, `FILE_FORMAT=4:4` of Altium.
    fn comment(&mut self, comment: &[u8]) {
        let comment = String::from_utf8_lossy(&comment[..comment.len().min(200)]);
        let Some((_, format)) = comment.split_once("FORMAT=") else { return };
        let format = format.trim_start_matches('{');
        let places =
            format.split(|c: char| !c.is_ascii_digit() && c != ':').next().unwrap_or_default();
        if let Some((before, after)) = places.split_once(':')
            && let (Ok(before), Ok(after)) = (before.parse(), after.parse())
            && before + after <= 12usize
        {
            self.comments.places = Some((before, after));
        }
        let says = |words: &str| format.contains(words);
        self.comments.unit = match (says("metric"), says("inch")) {
            (true, false) => Some(Unit::Metric),
            (false, true) => Some(Unit::Inch),
            _ => self.comments.unit,
        };
        self.comments.zeros = match (says("suppress leading"), says("suppress trailing")) {
            (true, false) => Some(Zeros::Trailing),
            (false, true) => Some(Zeros::Leading),
            _ => self.comments.zeros,
        };
    }

    fn diameter(&mut self, number: &[u8]) {
        if let Some(diameter) = decimal(number) {
            let (least, most) = self.diameters.unwrap_or((diameter, diameter));
            self.diameters = Some((least.min(diameter), most.max(diameter)));
        }
    }

    fn coordinate(&mut self, number: &[u8]) {
        let sign = number.iter().take_while(|c| !c.is_ascii_digit()).count();
        let digits = number.get(sign..).unwrap_or_default();
        // Zero may be written as one digit in either format, and six digits leave nothing out.
        if digits.len() < 6 && digits.iter().any(|c| *c != b'0') {
            self.begins_with_zero |= digits.first() == Some(&b'0');
            self.ends_with_zero |= digits.last() == Some(&b'0');
        }
    }

    /// Which zeros are written, where short coordinates show it: with `LZ` none of them ends with a zero,
    /// with `TZ` none begins with one.
    pub(super) fn zeros(&self) -> Option<Zeros> {
        match (self.begins_with_zero, self.ends_with_zero) {
            (true, false) => Some(Zeros::Leading),
            (false, true) => Some(Zeros::Trailing),
            _ => None,
        }
    }

    /// The unit that the file says behind the first length, and what says it.
    pub(super) fn late_unit(&self) -> Option<(Unit, &'static str)> {
        match (self.metric, self.inch) {
            (true, false) => Some((Unit::Metric, "M71")),
            (false, true) => Some((Unit::Inch, "M72")),
            _ => None,
        }
    }

    /// The unit that the diameters are in. The smallest drills of boards are 0.1 to 0.6 mm and the
    /// largest some 6.5 mm: diameters that are all below 0.1 are inches, and one above 0.3 is mm where
    /// the smallest is at least 0.1.
    pub(super) fn unit(&self) -> Option<Unit> {
        match self.diameters? {
            (least, most) if least > 0.0 && most < 0.1 => Some(Unit::Inch),
            (least, most) if least >= 0.1 && most > 0.3 => Some(Unit::Metric),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_show_themselves_in_short_coordinates() {
        let zeros = |text: &str| Evidence::of(text.as_bytes()).zeros();
        assert_eq!(zeros("X0123Y05\nX123456"), Some(Zeros::Leading));
        assert_eq!(zeros("X12340Y-5500\nX000010"), Some(Zeros::Trailing));
        assert_eq!(zeros("X1234Y0"), None);
        assert_eq!(zeros("X0120"), None);
        assert_eq!(zeros("X1.50Y05.0"), None);
    }

    #[test]
    fn units_from_diameters_and_comments() {
        let unit = |text: &str| Evidence::of(text.as_bytes()).unit();
        assert_eq!(unit("T1C0.028\nT2C.063"), Some(Unit::Inch));
        assert_eq!(unit("T1C0.3\nT2F00S00C3.2"), Some(Unit::Metric));
        assert_eq!(unit("T1C0.125"), None);
        let comments = |text: &str| Evidence::of(text.as_bytes()).comments;
        let kicad = comments("; FORMAT={3:4/ absolute / inch / suppress leading zeros}");
        assert_eq!(kicad.unit, Some(Unit::Inch));
        assert_eq!((kicad.zeros, kicad.places), (Some(Zeros::Trailing), Some((3, 4))));
        assert_eq!(comments(";FILE_FORMAT=2:5").places, Some((2, 5)));
        assert_eq!(comments("; FORMAT={-:-/ absolute / metric / decimal}").places, None);
    }
}
