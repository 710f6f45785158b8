//! The commands of a file: what stands between its `*` and `%`.

use crate::report::{Location, Outcome, fault};
use memchr::{memchr, memchr_iter, memchr2};
use program::{Rule, encoding};

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Token<'a> {
    /// A command up to its `*`, which is not part of it, and whether it is between two `%`.
    Block { text: &'a [u8], extended: bool },
    /// The `%` after extended commands.
    Close,
}

/// The commands of a text, with the location of the last one.
pub(super) struct Blocks<'a> {
    text: &'a [u8],
    at: usize,
    line: u32,
    extended: bool,
    /// Location of the last token.
    pub(super) location: Location,
}

impl<'a> Blocks<'a> {
    pub(super) fn of(text: &'a [u8]) -> Blocks<'a> {
        let at = text.len() - encoding::without_mark(text).len();
        Blocks { text, at, line: 1, extended: false, location: Location::default() }
    }

    /// The next token, `None` at the end of the text.
    ///
    /// # Errors
    /// `unterminated` where a command lacks its `*`, or an extended one its `%`; reading goes on after it.
    pub(super) fn next(&mut self) -> Outcome<Option<Token<'a>>> {
        loop {
            let rest = &self.text[self.at..];
            let Some(blank) = rest.iter().position(|c| !c.is_ascii_whitespace() && *c != 0) else {
                self.advance(rest.len());
                self.location = Location { line: self.line, start: self.at, end: self.at };
                if std::mem::take(&mut self.extended) {
                    return Err(unterminated("the extended command at the end lacks its %"));
                }
                return Ok(None);
            };
            self.advance(blank);
            let rest = &rest[blank..];
            self.location = Location { line: self.line, start: self.at, end: self.at + 1 };
            if rest.first() == Some(&b'%') {
                self.advance(1);
                self.extended = !self.extended;
                if self.extended {
                    continue;
                }
                return Ok(Some(Token::Close));
            }
            // A comment may hold a %.
            let comment = rest.starts_with(b"G04") || rest.starts_with(b"G4 ");
            let end = if comment { memchr(b'*', rest) } else { memchr2(b'*', b'%', rest) };
            let (length, closed) = match end {
                Some(end) => (end, rest.get(end) == Some(&b'*')),
                None => (rest.len(), false),
            };
            let text = &rest[..length];
            self.location.end = self.at + text.trim_ascii_end().len();
            self.advance(length + usize::from(closed));
            if !closed {
                let shown = String::from_utf8_lossy(&text[..length.min(30)]);
                return Err(unterminated(format!(
                    "the command {:?} lacks its *",
                    shown.trim_end()
                )));
            }
            return Ok(Some(Token::Block { text, extended: self.extended }));
        }
    }

    fn advance(&mut self, length: usize) {
        let passed = &self.text[self.at..self.at + length];
        let lines = memchr_iter(b'\n', passed).count();
        self.line = self.line.saturating_add(u32::try_from(lines).unwrap_or(u32::MAX));
        self.at += length;
    }
}

#[cold]
fn unterminated(message: impl Into<String>) -> crate::report::Fault {
    fault(Rule::Unterminated, message, "the file may be cut off: write it again")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_of_one_line_and_a_command_over_several() {
        let text = b"G04 50%*%FSLAX24Y24*MOIN*%\r\nX1\nY2D01*%LPD*%%LPC*%M02*";
        let mut blocks = Blocks::of(text);
        let mut seen = Vec::new();
        while let Some(token) = blocks.next().unwrap() {
            if let Token::Block { text, extended } = token {
                seen.push((std::str::from_utf8(text).unwrap(), extended, blocks.location.line));
            }
        }
        let expected = [
            ("G04 50%", false, 1),
            ("FSLAX24Y24", true, 1),
            ("MOIN", true, 1),
            ("X1\nY2D01", false, 2),
            ("LPD", true, 3),
            ("LPC", true, 3),
            ("M02", false, 3),
        ];
        assert_eq!(seen, expected);
    }
}
