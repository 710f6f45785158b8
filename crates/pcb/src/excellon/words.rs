//! The words of a line: a letter and its number, which stays as it is written.

use crate::report::{Outcome, fault};
use program::Rule;

/// A letter and the number behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Word<'a> {
    pub(super) letter: u8,
    pub(super) number: &'a [u8],
}

/// The words of `line`; after a comma the rest of the line is text for the operator.
///
/// # Errors
/// `word`
pub(super) fn words(line: &[u8]) -> Outcome<Vec<Word<'_>>> {
    let mut found = Vec::new();
    let mut rest = line;
    loop {
        rest = rest.trim_ascii_start();
        let Some((letter, after)) = rest.split_first() else { return Ok(found) };
        if *letter == b',' || *letter == b';' {
            return Ok(found);
        }
        if !letter.is_ascii_alphabetic() {
            let message = format!("{} is no word", char::from(*letter).escape_default());
            return Err(fault(
                Rule::DataWord,
                message,
                "see docs/sources/excellon.md for what is read",
            ));
        }
        let part = |c: &u8| c.is_ascii_digit() || matches!(c, b'.' | b'+' | b'-');
        let end = after.iter().position(|c| !part(c)).unwrap_or(after.len());
        let (number, after) = after.split_at(end);
        found.push(Word { letter: letter.to_ascii_uppercase(), number });
        rest = after;
    }
}

/// The text of `file` in lines, each with its number from 1 and the byte where it starts.
pub(super) fn lines(file: &[u8]) -> impl Iterator<Item = (u32, usize, &[u8])> {
    let mut start = 0;
    (1u32..).zip(file.split(|c| *c == b'\n')).map(move |(number, line)| {
        let at = start;
        start += line.len() + 1;
        let blank = line.len() - line.trim_ascii_start().len();
        (number, at + blank, line.trim_ascii())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_with_numbers_as_they_are() {
        let found = words(b"x-0010 Y.5G85X+1.M47,text").unwrap();
        let shown: Vec<String> = found
            .iter()
            .map(|w| format!("{}{}", char::from(w.letter), String::from_utf8_lossy(w.number)))
            .collect();
        assert_eq!(shown, ["X-0010", "Y.5", "G85", "X+1.", "M47"]);
        assert_eq!(words(b"X1#").unwrap_err().rule, "data-word");
    }
}
