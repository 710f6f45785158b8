//! Plain lines: letters with the numbers that are written behind them, and nothing else. What they consist of
//! does not depend on what has been run before them.

use super::block::Word;
use crate::decimal;

/// Adds the words of the line that begins at byte `from` of `text` to `words`, and answers where it ends;
/// `None` where it is not plain.
pub(crate) fn line(text: &[u8], from: usize, words: &mut Vec<Word>) -> Option<usize> {
    let mut at = from;
    loop {
        match text.get(at) {
            None | Some(b'\n') => return Some(at),
            Some(b' ' | b'\t') => at += 1,
            Some(b'\r') if matches!(text.get(at + 1), None | Some(b'\n')) => return Some(at + 1),
            Some(&letter @ b'A'..=b'Z') => {
                let number = decimal::parse(text.get(at + 1..).unwrap_or_default())?;
                let end = at + 1 + number.len;
                words.push(Word::written(letter, &number, at - from, end - from));
                at = end;
            }
            _ => return None,
        }
    }
}
