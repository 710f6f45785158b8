//! Lines and words of the text.

use crate::decimal;
use program::Diagnostic;

/// What a step of the control answers.
pub(super) type Result<T> = std::result::Result<T, Box<Diagnostic>>;

/// The lines of a program with their numbers (from 1), ended by LF, CR LF or CR.
pub(super) struct Lines<'t> {
    rest: &'t [u8],
    line: u32,
}

impl<'t> Lines<'t> {
    pub(super) fn new(text: &'t [u8]) -> Lines<'t> {
        Lines { rest: text, line: 0 }
    }
}

impl<'t> Iterator for Lines<'t> {
    type Item = Scanner<'t>;

    fn next(&mut self) -> Option<Scanner<'t>> {
        if self.rest.is_empty() {
            return None;
        }
        let end = memchr::memchr2(b'\n', b'\r', self.rest).unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(end);
        self.rest = match rest {
            [b'\r', b'\n', rest @ ..] | [_, rest @ ..] => rest,
            [] => rest,
        };
        self.line = self.line.saturating_add(1);
        Some(Scanner {
            line: self.line,
            text: line,
            start: 0,
            at: 0,
            end: line.trim_ascii_end().len(),
        })
    }
}

/// A place in a line.
#[derive(Clone, Copy)]
pub(super) struct Scanner<'t> {
    /// Number of the line, from 1.
    pub(super) line: u32,
    text: &'t [u8],
    /// Where the block begins, behind its number.
    start: usize,
    at: usize,
    end: usize,
}

/// An address with what follows it: `X+1.5`, `DR-`, `FMAX`.
#[derive(Clone, Copy)]
pub(super) struct Word<'t> {
    /// The letters.
    pub(super) address: &'t [u8],
    /// The sign that is written, `1` or `-1`; 0 where there is none.
    pub(super) sign: f64,
    /// The number with its sign.
    pub(super) number: Option<f64>,
    /// Where the word stands in the line, bytes.
    pub(super) span: (usize, usize),
}

impl<'t> Scanner<'t> {
    /// The part of a line between two bytes.
    pub(super) fn within(line: Scanner<'t>, at: usize, end: usize) -> Scanner<'t> {
        Scanner { at, end, ..line }
    }

    /// Whether the line goes on in the next one; the mark (`~`) is taken off.
    pub(super) fn take_continuation(&mut self) -> bool {
        let line = self.text.get(..self.end).unwrap_or_default();
        let Some(rest) = line.strip_suffix(b"~") else { return false };
        self.end = rest.trim_ascii_end().len();
        true
    }

    /// What is not read yet, blanks at both ends taken off.
    pub(super) fn rest(&self) -> &'t [u8] {
        self.text.get(self.at..self.end).unwrap_or_default().trim_ascii()
    }

    /// The block begins at the next token.
    pub(super) fn begin_block(&mut self) {
        self.is_done();
        self.start = self.at;
    }

    /// Whether nothing but a comment follows.
    pub(super) fn is_done(&mut self) -> bool {
        while matches!(self.byte(), Some(b' ' | b'\t')) {
            self.at += 1;
        }
        matches!(self.byte(), None | Some(b';'))
    }

    /// The next characters up to a blank or a comment; empty at the end.
    pub(super) fn peek(&mut self) -> &'t [u8] {
        if self.is_done() {
            return &[];
        }
        let rest = self.text.get(self.at..self.end).unwrap_or_default();
        let length = rest.iter().position(|b| matches!(b, b' ' | b'\t' | b';'));
        &rest[..length.unwrap_or(rest.len())]
    }

    /// Takes what [`Scanner::peek`] shows, with its place.
    pub(super) fn token(&mut self) -> (&'t [u8], (usize, usize)) {
        let token = self.peek();
        let start = self.at;
        self.at += token.len();
        (token, (start, self.at))
    }

    /// Takes the next token if it is `expected`.
    pub(super) fn take(&mut self, expected: &[u8]) -> bool {
        let found = self.peek() == expected;
        if found {
            self.at += expected.len();
        }
        found
    }

    /// Takes `expected`, which must come next.
    pub(super) fn expect(&mut self, expected: &[u8]) -> Result<()> {
        if self.take(expected) {
            return Ok(());
        }
        let expected = String::from_utf8_lossy(expected);
        Err(self.error_here("syntax", format!("{expected} is expected here")))
    }

    /// Takes the next word; `None` at the end of the block.
    pub(super) fn word(&mut self) -> Result<Option<Word<'t>>> {
        if self.is_done() {
            return Ok(None);
        }
        let start = self.at;
        while matches!(self.byte(), Some(b'A'..=b'Z')) {
            self.at += 1;
        }
        let address = self.text.get(start..self.at).unwrap_or_default();
        let (sign, number) = self.number();
        if address.is_empty() || !matches!(self.byte(), None | Some(b' ' | b'\t' | b';')) {
            self.at = start;
            return Err(self.unknown());
        }
        Ok(Some(Word { address, sign, number, span: (start, self.at) }))
    }

    /// A number that stands alone (after blanks).
    pub(super) fn value(&mut self) -> Result<f64> {
        let done = self.is_done();
        let start = self.at;
        let (_, number) = self.number();
        match number {
            Some(number) if !done && matches!(self.byte(), None | Some(b' ' | b'\t' | b';')) => {
                Ok(number)
            }
            _ => {
                self.at = start;
                Err(self.error_here("syntax", "a number is expected here"))
            }
        }
    }

    /// Takes a text between quotes.
    pub(super) fn quoted(&mut self) -> Result<&'t [u8]> {
        self.is_done();
        let rest = self.text.get(self.at..self.end).unwrap_or_default();
        let length = rest.iter().skip(1).position(|b| *b == b'"');
        match (rest, length) {
            ([b'"', text @ ..], Some(length)) => {
                self.at += length + 2;
                Ok(&text[..length])
            }
            _ => Err(self.error_here("syntax", "a name in quotes is expected here")),
        }
    }

    /// Whether the block ends here; anything more is an error.
    pub(super) fn finish(&mut self) -> Result<()> {
        if self.is_done() { Ok(()) } else { Err(self.unknown()) }
    }

    /// The word here is not understood.
    pub(super) fn unknown(&mut self) -> Box<Diagnostic> {
        let shown = String::from_utf8_lossy(self.peek()).chars().take(40).collect::<String>();
        self.error_here("unknown-word", format!("{shown} is not understood here"))
    }

    /// An error at the next token.
    pub(super) fn error_here(
        &mut self,
        rule: &'static str,
        message: impl Into<String>,
    ) -> Box<Diagnostic> {
        let length = self.peek().len();
        self.error(rule, (self.at, self.at + length), message)
    }

    /// An error at bytes `span` of the line.
    pub(super) fn error(
        &self,
        rule: &'static str,
        span: (usize, usize),
        message: impl Into<String>,
    ) -> Box<Diagnostic> {
        Diagnostic::error(rule, message).at(self.line, self.text, span.0, span.1).into()
    }

    /// An error about the whole block.
    pub(super) fn error_block(
        &self,
        rule: &'static str,
        message: impl Into<String>,
    ) -> Box<Diagnostic> {
        self.error(rule, (self.start, self.end), message)
    }

    fn byte(&self) -> Option<u8> {
        if self.at < self.end { self.text.get(self.at).copied() } else { None }
    }

    /// The sign that is written here, and the number with it, as far as there are any.
    fn number(&mut self) -> (f64, Option<f64>) {
        let sign = match self.byte() {
            Some(b'+') => 1.0,
            Some(b'-') => -1.0,
            _ => 0.0,
        };
        let rest = self.text.get(self.at..self.end).unwrap_or_default();
        let Some(decimal) = decimal::parse(rest) else {
            self.at += usize::from(sign != 0.0);
            return (sign, None);
        };
        self.at += decimal.len;
        // The sum takes the sign off a zero: -0 would print and compare oddly.
        (sign, Some(decimal.value + 0.0).filter(|number| number.is_finite()))
    }
}
