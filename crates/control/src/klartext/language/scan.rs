//! Lines and words of the text.

use super::registers::{Parameter, Registers};
use crate::kernel::{Outcome, decimal};
use program::{Diagnostic, Rule};

/// A place in a line.
#[derive(Clone, Copy)]
pub(crate) struct Scanner<'t> {
    /// Number of the line, from 1.
    pub(crate) line: u32,
    /// Name of a called file; empty in the main program.
    file: &'t str,
    text: &'t [u8],
    /// Where the block begins, behind its number.
    start: usize,
    at: usize,
    end: usize,
}

/// An address with what follows it: `X+1.5`, `DR-`, `FMAX`.
#[derive(Clone, Copy)]
pub(crate) struct Word<'t> {
    /// The letters.
    pub(crate) address: &'t [u8],
    /// The sign that is written, `1` or `-1`; 0 where there is none.
    pub(crate) sign: f64,
    /// The number with its sign.
    pub(crate) number: Option<f64>,
    /// Where the word stands in the line, bytes.
    pub(crate) span: (usize, usize),
}

impl<'t> Scanner<'t> {
    /// At the start of a line of `file`.
    pub(crate) fn new(file: &'t str, line: u32, text: &'t [u8]) -> Scanner<'t> {
        Scanner { line, file, text, start: 0, at: 0, end: text.trim_ascii_end().len() }
    }

    /// The part of a line between two bytes.
    pub(crate) fn within(line: Scanner<'t>, at: usize, end: usize) -> Scanner<'t> {
        Scanner { at, end, ..line }
    }

    /// Whether the line goes on in the next one; the mark (`~`) is taken off.
    pub(crate) fn take_continuation(&mut self) -> bool {
        let line = self.text.get(..self.end).unwrap_or_default();
        let Some(rest) = line.strip_suffix(b"~") else { return false };
        self.end = rest.trim_ascii_end().len();
        true
    }

    /// Whether the block begins with `/`, which is taken.
    pub(crate) fn take_slash(&mut self) -> bool {
        let found = self.byte() == Some(b'/');
        self.at += usize::from(found);
        found
    }

    /// Whether there is nothing in the line.
    pub(crate) fn is_blank(&self) -> bool {
        self.end == 0
    }

    /// What is not read yet, blanks at both ends taken off.
    pub(crate) fn rest(&self) -> &'t [u8] {
        self.text.get(self.at..self.end).unwrap_or_default().trim_ascii()
    }

    /// The block begins at the next token.
    pub(crate) fn begin_block(&mut self) {
        self.is_done();
        self.start = self.at;
    }

    /// Whether nothing but a comment follows.
    pub(crate) fn is_done(&mut self) -> bool {
        while matches!(self.byte(), Some(b' ' | b'\t')) {
            self.at += 1;
        }
        matches!(self.byte(), None | Some(b';'))
    }

    /// Whether no word goes on here.
    #[inline]
    pub(crate) fn is_between_words(&self) -> bool {
        matches!(self.byte(), None | Some(b' ' | b'\t' | b';'))
    }

    /// Whether `LBL` stands here.
    #[inline]
    pub(crate) fn is_at_label(&self) -> bool {
        self.unread().starts_with(b"LBL")
    }

    /// The next characters up to a blank or a comment; empty at the end.
    pub(crate) fn peek(&mut self) -> &'t [u8] {
        if self.is_done() {
            return &[];
        }
        let rest = self.text.get(self.at..self.end).unwrap_or_default();
        let length = rest.iter().position(|b| matches!(b, b' ' | b'\t' | b';'));
        &rest[..length.unwrap_or(rest.len())]
    }

    /// Takes what [`Scanner::peek`] shows, with its place.
    pub(crate) fn token(&mut self) -> (&'t [u8], (usize, usize)) {
        let token = self.peek();
        let start = self.at;
        self.at += token.len();
        (token, (start, self.at))
    }

    /// Takes the next token if it is `expected`.
    pub(crate) fn take(&mut self, expected: &[u8]) -> bool {
        let found = self.peek() == expected;
        if found {
            self.at += expected.len();
        }
        found
    }

    /// Takes `expected`, which must come next.
    pub(crate) fn expect(&mut self, expected: &[u8]) -> Outcome {
        if self.take(expected) {
            return Ok(());
        }
        let expected = String::from_utf8_lossy(expected);
        Err(self.error_here(Rule::Syntax, format!("{expected} is expected here")))
    }

    /// Takes the next word, a Q parameter as its value; `None` at the end of the block.
    pub(crate) fn word(&mut self, registers: &Registers) -> Outcome<Option<Word<'t>>> {
        if self.is_done() {
            return Ok(None);
        }
        let start = self.at;
        let rest = self.unread();
        // No address has a Q: there the parameter begins (`FQ5`).
        let letters = rest.iter().take_while(|b| matches!(b, b'A'..=b'P' | b'R'..=b'Z')).count();
        let address = &rest[..letters];
        if address.is_empty() {
            return Err(self.unknown());
        }
        self.at += letters;
        let (sign, number) = self.number();
        let end = self.at - start;
        if number.is_some() && matches!(rest.get(end), None | Some(b' ' | b'\t' | b';')) {
            return Ok(Some(Word { address, sign, number, span: (start, self.at) }));
        }
        self.other_word(start, address, (sign, number), registers).map(Some)
    }

    /// A word that is no address with its number close to it.
    #[inline(never)]
    fn other_word(
        &mut self,
        start: usize,
        address: &'t [u8],
        (mut sign, mut number): (f64, Option<f64>),
        registers: &Registers,
    ) -> Outcome<Word<'t>> {
        if number.is_none() {
            if sign == 0.0 && matches!(self.byte(), Some(b' ' | b'\t')) {
                (sign, number) = self.number_apart();
            }
            if self.byte() == Some(b'Q') && number.is_none() {
                number = Some(self.parameter_value(sign, registers)?);
            }
        }
        if !self.is_between_words() {
            self.at = start;
            return Err(self.unknown());
        }
        Ok(Word { address, sign, number, span: (start, self.at) })
    }

    /// A number that stands alone (after blanks).
    pub(crate) fn value(&mut self, registers: &Registers) -> Outcome<f64> {
        let done = self.is_done();
        let start = self.at;
        let (_, number) = self.number_or_parameter(registers)?;
        match number {
            Some(number) if !done && self.is_between_words() => Ok(number),
            _ => {
                self.at = start;
                Err(self.error_here(Rule::Syntax, "a number is expected here"))
            }
        }
    }

    /// Takes a text between quotes.
    pub(crate) fn quoted(&mut self) -> Outcome<&'t [u8]> {
        self.is_done();
        let rest = self.text.get(self.at..self.end).unwrap_or_default();
        let length = rest.iter().skip(1).position(|b| *b == b'"');
        match (rest, length) {
            ([b'"', text @ ..], Some(length)) => {
                self.at += length + 2;
                Ok(&text[..length])
            }
            _ => Err(self.error_here(Rule::Syntax, "a name in quotes is expected here")),
        }
    }

    /// Whether the block ends here; anything more is an error.
    pub(crate) fn finish(&mut self) -> Outcome {
        if self.is_done() { Ok(()) } else { Err(self.unknown()) }
    }

    /// The word here is not understood.
    pub(super) fn unknown(&mut self) -> Box<Diagnostic> {
        let shown = String::from_utf8_lossy(self.peek()).chars().take(40).collect::<String>();
        self.error_here(Rule::UnknownWord, format!("{shown} is not understood here"))
    }

    /// An error at the next token.
    pub(crate) fn error_here(&mut self, rule: Rule, message: impl Into<String>) -> Box<Diagnostic> {
        let length = self.peek().len();
        self.error(rule, (self.at, self.at + length), message)
    }

    /// An error at bytes `span` of the line.
    pub(crate) fn error(
        &self,
        rule: Rule,
        span: (usize, usize),
        message: impl Into<String>,
    ) -> Box<Diagnostic> {
        let error = Diagnostic::error(rule, message).file(self.file);
        error.at(self.line, self.text, span.0, span.1).into()
    }

    /// An error about the whole block.
    pub(crate) fn error_block(&self, rule: Rule, message: impl Into<String>) -> Box<Diagnostic> {
        self.error(rule, (self.start, self.end), message)
    }

    /// The next character.
    pub(super) fn byte(&self) -> Option<u8> {
        if self.at < self.end { self.text.get(self.at).copied() } else { None }
    }

    /// Takes `expected` where it stands next after blanks, whatever follows it.
    pub(crate) fn take_symbol(&mut self, expected: &[u8]) -> bool {
        let found = !self.is_done() && self.unread().starts_with(expected);
        if found {
            self.at += expected.len();
        }
        found
    }

    /// Takes the letters that stand next after blanks.
    pub(crate) fn letters(&mut self) -> &'t [u8] {
        self.is_done();
        let start = self.at;
        while matches!(self.byte(), Some(b'A'..=b'Z')) {
            self.at += 1;
        }
        self.text.get(start..self.at).unwrap_or_default()
    }

    /// Takes the text before a number, which may stand close to it (`DWELL5`).
    pub(crate) fn take_text(&mut self) {
        let text = self.peek();
        let number = |byte: &u8| byte.is_ascii_digit() || b".,+-".contains(byte);
        let before = text.iter().rposition(|byte| !number(byte)).map_or(0, |last| last + 1);
        let close = text.last().is_some_and(u8::is_ascii_digit);
        self.at += if close { before } else { text.len() };
    }

    /// Takes the digits that stand next, as a number of at most `most`.
    pub(crate) fn digits(&mut self, most: u32) -> Outcome<u32> {
        let start = self.at;
        while matches!(self.byte(), Some(b'0'..=b'9')) {
            self.at += 1;
        }
        let digits = self.text.get(start..self.at).unwrap_or_default();
        let number = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok());
        number.filter(|number| *number <= most).ok_or_else(|| {
            let message = format!("a whole number from 0 to {most} is expected here");
            self.error(Rule::Syntax, (start, self.at), message)
        })
    }

    /// Takes a whole number that stands alone after blanks; `None` where there is none.
    pub(crate) fn whole_number(&mut self) -> Option<u32> {
        self.is_done();
        let mut number = 0u32;
        for (length, byte) in self.unread().iter().enumerate() {
            match byte {
                b'0'..=b'9' => {
                    number = number.checked_mul(10)?.checked_add(u32::from(byte - b'0'))?;
                }
                b' ' | b'\t' if length > 0 => {
                    self.at += length;
                    return Some(number);
                }
                _ => return None,
            }
        }
        None
    }

    /// Takes the name of a Q parameter, if one stands next after blanks.
    pub(crate) fn parameter(&mut self) -> Outcome<Option<Parameter>> {
        if self.is_done() || self.byte() != Some(b'Q') {
            return Ok(None);
        }
        let start = self.at;
        self.at += 1;
        let kind = self.byte().filter(u8::is_ascii_uppercase);
        self.at += usize::from(kind.is_some());
        let Some((make, most)) = Parameter::kind(kind) else {
            return Err(self.error(
                Rule::UnknownWord,
                (start, self.at),
                "there is no such Q parameter",
            ));
        };
        Ok(Some(make(self.digits(most)? as u16)))
    }

    /// Takes what stands between parentheses; `None` where there are none.
    pub(crate) fn parenthesis(&mut self) -> Option<Scanner<'t>> {
        if !self.take_symbol(b"(") {
            return None;
        }
        let length = self.unread().iter().position(|b| *b == b')')?;
        let inside = Scanner { end: self.at + length, ..*self };
        self.at += length + 1;
        Some(inside)
    }

    /// Leaves the rest of the block unread.
    pub(crate) fn skip(&mut self) {
        self.at = self.end;
    }

    /// How far the line is read.
    pub(crate) fn at(&self) -> usize {
        self.at
    }

    fn unread(&self) -> &'t [u8] {
        self.text.get(self.at..self.end).unwrap_or_default()
    }

    /// The sign that is written here, and the number or the parameter with it, as far as there are any.
    pub(crate) fn number_or_parameter(
        &mut self,
        registers: &Registers,
    ) -> Outcome<(f64, Option<f64>)> {
        let (sign, mut number) = self.number();
        if number.is_none() && self.byte() == Some(b'Q') {
            number = Some(self.parameter_value(sign, registers)?);
        }
        Ok((sign, number))
    }

    /// What the parameter holds that stands next, with the sign before it.
    #[cold]
    fn parameter_value(&mut self, sign: f64, registers: &Registers) -> Outcome<f64> {
        let start = self.at;
        let Some(parameter) = self.parameter()? else { return Err(self.unknown()) };
        let value = registers
            .number(parameter)
            .map_err(|message| self.error(Rule::Parameter, (start, self.at), message))?;
        Ok(if sign < 0.0 { 0.0 - value } else { value })
    }

    /// A sign that stands apart from its address (`Z + 5`), and the number with it; nothing is taken
    /// where none stands next.
    #[cold]
    fn number_apart(&mut self) -> (f64, Option<f64>) {
        let before = *self;
        self.is_done();
        let sign = match self.byte() {
            Some(b'+') => 1.0,
            Some(b'-') => -1.0,
            _ => {
                *self = before;
                return (0.0, None);
            }
        };
        self.at += 1;
        self.is_done();
        let (twice, number) = self.number();
        if twice != 0.0 {
            *self = before;
            return (0.0, None);
        }
        (sign, number.map(|number| sign * number + 0.0))
    }

    /// The sign that is written here, and the number with it, as far as there are any.
    #[inline(always)]
    pub(super) fn number(&mut self) -> (f64, Option<f64>) {
        let rest = self.unread();
        let sign = match rest.first() {
            Some(b'+') => 1.0,
            Some(b'-') => -1.0,
            _ => 0.0,
        };
        let Some((value, length)) = decimal(rest) else {
            self.at += usize::from(sign != 0.0);
            return (sign, None);
        };
        self.at += length;
        // The sum takes the sign off a zero: -0 would print and compare oddly.
        (sign, Some(value + 0.0).filter(|number| number.is_finite()))
    }
}

/// The number that `text` begins with, and its length. The decimal sign is a point, or a comma where
/// the control was set so when it gave out the program.
#[inline]
fn decimal(text: &[u8]) -> Option<(f64, usize)> {
    let number = decimal::parse(text)?;
    if text.get(number.len) == Some(&b',') && !number.point {
        return with_comma(text, number.len);
    }
    Some((number.value, number.len))
}

/// The number whose decimal sign is a comma after so many characters.
#[cold]
fn with_comma(text: &[u8], whole: usize) -> Option<(f64, usize)> {
    let mut with_point = [0; 40];
    let length = text.len().min(with_point.len());
    with_point[..length].copy_from_slice(&text[..length]);
    *with_point.get_mut(whole)? = b'.';
    let number = decimal::parse(&with_point[..length])?;
    Some((number.value, number.len))
}
