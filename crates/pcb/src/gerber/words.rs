//! The words of a command outside of `%`: a letter and its digits.

use crate::report::{Outcome, fault};
use program::Rule;

/// A letter and the number behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Word {
    pub(super) letter: u8,
    pub(super) value: i64,
    /// How many digits it has.
    pub(super) digits: u32,
}

/// More digits than this are no coordinate: 6 before and 6 after the point is the most that the format
/// knows.
const MOST_DIGITS: u32 = 15;

/// The words of `text`, in which blanks and line ends mean nothing.
pub(super) struct Words<'a> {
    text: &'a [u8],
}

impl<'a> Words<'a> {
    pub(super) fn of(text: &'a [u8]) -> Words<'a> {
        Words { text }
    }

    /// The next word.
    ///
    /// # Errors
    /// `word` for what is no letter with a whole number.
    pub(super) fn next(&mut self) -> Outcome<Option<Word>> {
        let Some(letter) = self.byte() else { return Ok(None) };
        if !letter.is_ascii_uppercase() {
            return Err(odd(letter, "is no word of a Gerber command"));
        }
        let mut word = Word { letter, value: 0, digits: 0 };
        let mut negative = false;
        while let Some(next) = self.peek() {
            match next {
                b'0'..=b'9' if word.digits < MOST_DIGITS => {
                    word.value = word.value * 10 + i64::from(next - b'0');
                    word.digits += 1;
                }
                b'+' | b'-' if word.digits == 0 && !negative => negative = next == b'-',
                b'0'..=b'9' => return Err(odd(letter, "has more than 15 digits")),
                b'.' => return Err(odd(letter, "has a decimal point")),
                _ => break,
            }
            self.byte();
        }
        if word.digits == 0 {
            return Err(odd(letter, "has no number"));
        }
        word.value = if negative { -word.value } else { word.value };
        Ok(Some(word))
    }

    fn peek(&mut self) -> Option<u8> {
        while let [b' ' | b'\n' | b'\r' | b'\t' | 0, rest @ ..] = self.text {
            self.text = rest;
        }
        self.text.first().copied()
    }

    fn byte(&mut self) -> Option<u8> {
        let byte = self.peek()?;
        self.text = &self.text[1..];
        Some(byte)
    }
}

#[cold]
fn odd(letter: u8, what: &str) -> crate::report::Fault {
    let letter = char::from(letter).escape_default();
    fault(
        Rule::DataWord,
        format!("{letter} {what}"),
        "coordinates are whole numbers in the format of %FS",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_and_whole_numbers() {
        let mut words = Words::of(b"G01 X-0050\r\nY+7D01");
        let mut next = || words.next().unwrap().map(|w| (char::from(w.letter), w.value, w.digits));
        assert_eq!(next(), Some(('G', 1, 2)));
        assert_eq!(next(), Some(('X', -50, 4)));
        assert_eq!(next(), Some(('Y', 7, 1)));
        assert_eq!(next(), Some(('D', 1, 2)));
        assert_eq!(next(), None);
        for text in ["X", "X1.5", "x1", "#", "X--1", "X1234567890123456"] {
            let mut words = Words::of(text.as_bytes());
            assert!(words.next().is_err(), "{text}");
        }
    }
}
