//! Plain lines: letters with the numbers that are written behind them, and nothing else. What they consist of
//! does not depend on what has been run before them.

use super::block::Word;
use crate::kernel::decimal;

/// Most words of a line: a block has each letter once, and as many G and M words as there are groups.
const MOST: usize = 100;

/// Adds the words of the line that begins at byte `from` of `text` to `words`, and answers where it ends;
/// `None` where it is not plain.
pub(crate) fn line(text: &[u8], from: usize, words: &mut Vec<Word>) -> Option<usize> {
    let (mut at, most) = (from, words.len() + MOST);
    loop {
        match text.get(at) {
            None | Some(b'\n') => return Some(at),
            Some(b' ' | b'\t') => at += 1,
            Some(b'\r') if matches!(text.get(at + 1), None | Some(b'\n')) => return Some(at + 1),
            Some(&letter @ b'A'..=b'Z') if words.len() < most => {
                let number = decimal::parse(text.get(at + 1..).unwrap_or_default())?;
                let end = at + 1 + number.len;
                words.push(Word::written(letter, &number, at - from, end - from));
                at = end;
            }
            _ => return None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_and_numbers_are_words_up_to_the_end_of_the_line() {
        let text = b"M2\nG1 X-1.5Y.25\tN3 \r\nZ7";
        let mut words = Vec::new();
        // The line feed is at byte 20.
        assert_eq!(line(text, 3, &mut words), Some(20));
        let read = words.iter().map(|w| (w.letter, w.value, w.point, w.start, w.end));
        let expected = [
            (b'G', 1.0, false, 0, 2),
            (b'X', -1.5, true, 3, 8),
            (b'Y', 0.25, true, 8, 12),
            (b'N', 3.0, false, 13, 15),
        ];
        assert!(read.eq(expected));
        assert_eq!(line(text, 21, &mut words), Some(23));
        assert_eq!(words.last().map(|w| (w.letter, w.value)), Some((b'Z', 7.0)));
    }

    #[test]
    fn what_needs_more_than_its_bytes_is_not_plain() {
        for text in ["X", "X 1", "X[1]", "X#1", "x1", "#1=2", "/X1", "(a)", "X1 ; a", "%", "X1\rY2"]
        {
            assert_eq!(line(text.as_bytes(), 0, &mut Vec::new()), None, "{text}");
        }
        let words = |count: usize| line("X1".repeat(count).as_bytes(), 0, &mut Vec::new());
        assert_eq!((words(MOST), words(MOST + 1)), (Some(2 * MOST), None));
    }
}
