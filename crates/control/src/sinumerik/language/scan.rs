//! Characters to names, numbers and texts.

use crate::kernel::Outcome;
use crate::kernel::source::Source;
use program::{Diagnostic, Rule};
use std::ops::Range;

/// Largest number that a word takes, mm, degrees or 1/min (the range of the axis addresses in the
/// address table of the programming manual).
const LARGEST: f64 = 99_999_999.999_9;

/// Longest name (variables have 31 characters, labels 32; Fundamentals, identifiers).
const LONGEST_NAME: usize = 32;

/// A name in capitals.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Name {
    bytes: [u8; LONGEST_NAME],
    length: usize,
}

impl Name {
    /// The name that `text` is, where it is one: letters, digits and underscores, in capitals.
    pub fn of(text: &str) -> Option<Name> {
        let mut scanner = Scanner::new(Source { line: 0, text: text.as_bytes() });
        let name = scanner.name().ok()?;
        (name.length > 0 && scanner.at == text.len()).then_some(name)
    }

    /// The name as text.
    pub fn as_str(&self) -> &str {
        self.bytes.get(..self.length).and_then(|b| str::from_utf8(b).ok()).unwrap_or("")
    }
}

/// What stands before the words of a block.
#[derive(Clone, Copy, Default)]
pub(crate) struct Head {
    /// Block number.
    pub number: Option<u32>,
    /// Label.
    pub label: Option<Name>,
}

/// Reads a block from left to right.
pub(crate) struct Scanner<'a> {
    /// The block.
    pub source: Source<'a>,
    /// The next byte to read.
    pub at: usize,
}

impl<'a> Scanner<'a> {
    /// At the start of a block.
    pub fn new(source: Source<'a>) -> Scanner<'a> {
        Scanner { source, at: 0 }
    }

    /// The byte `ahead` of the next one in capitals; 0 behind the end.
    #[inline]
    pub fn peek_at(&self, ahead: usize) -> u8 {
        self.source.text.get(self.at + ahead).map_or(0, u8::to_ascii_uppercase)
    }

    /// The next byte in capitals; 0 at the end.
    #[inline]
    pub fn peek(&self) -> u8 {
        self.peek_at(0)
    }

    /// Takes blanks. `&` is a formatting character that reads like one.
    #[inline]
    pub fn blanks(&mut self) {
        while let Some(b' ' | b'\t' | b'&') = self.source.text.get(self.at) {
            self.at += 1;
        }
    }

    /// Takes `byte`, which is no letter, after blanks, where it comes next.
    #[inline]
    pub fn take(&mut self, byte: u8) -> bool {
        let back = self.at;
        self.blanks();
        let found = self.source.text.get(self.at) == Some(&byte);
        self.at = if found { self.at + 1 } else { back };
        found
    }

    /// Takes `byte` or says that it is missing.
    pub fn expect(&mut self, byte: u8) -> Outcome {
        if self.take(byte) {
            return Ok(());
        }
        self.blanks();
        Err(self.error_here(Rule::Syntax, format!("'{}' is missing here", byte as char)))
    }

    /// An error about the next character.
    #[cold]
    pub fn error_here(&self, rule: Rule, message: impl Into<String>) -> Box<Diagnostic> {
        self.source.error(rule, self.at..self.at + 1, message)
    }

    /// An error about what was read since `start`.
    #[cold]
    pub fn error_since(
        &self,
        start: usize,
        rule: Rule,
        message: impl Into<String>,
    ) -> Box<Diagnostic> {
        self.source.error(rule, start..self.at, message)
    }

    /// Whether a digit comes next.
    pub fn digit_next(&self) -> bool {
        self.peek().is_ascii_digit()
    }

    /// Whether the next character would grow a name.
    pub fn name_goes_on(&self) -> bool {
        self.peek() == b'_' || self.peek().is_ascii_alphanumeric()
    }

    /// Takes a name: letters, digits and underscores.
    pub fn name(&mut self) -> Outcome<Name> {
        let start = self.at;
        let mut name = Name { bytes: [0; LONGEST_NAME], length: 0 };
        while self.name_goes_on() {
            if let Some(place) = name.bytes.get_mut(name.length) {
                *place = self.peek();
            }
            name.length += 1;
            self.at += 1;
        }
        if name.length > LONGEST_NAME {
            return Err(self.error_since(start, Rule::Syntax, "a name has at most 32 characters"));
        }
        Ok(name)
    }

    /// Whether a name of several letters comes next, and not an address.
    #[inline]
    pub fn name_next(&self) -> bool {
        let letter = |byte: u8| byte == b'_' || byte.is_ascii_alphabetic();
        letter(self.peek()) && letter(self.peek_at(1))
    }

    /// Takes `word`, after blanks, where it comes next as a whole name.
    pub fn take_word(&mut self, word: &str) -> bool {
        let back = self.at;
        self.blanks();
        let end = self.at + word.len();
        let piece = self.source.text.get(self.at..end).unwrap_or(&[]);
        self.at = end;
        if piece.eq_ignore_ascii_case(word.as_bytes()) && !self.name_goes_on() {
            return true;
        }
        self.at = back;
        false
    }

    /// Whether nothing but blanks and a comment is left of the block.
    pub fn rests(&mut self) -> bool {
        self.blanks();
        self.at >= self.source.text.len() || self.peek() == b';'
    }

    /// Takes skip mark, block number and label. A label is a name of which the first two characters
    /// are letters or underscores, and a colon.
    #[inline(always)]
    pub fn head(&mut self) -> Outcome<Head> {
        let mut head = Head::default();
        self.blanks();
        let mut next = self.peek();
        if next == b'/' {
            self.at += 1;
            if self.digit_next() {
                self.at += 1;
            }
            self.blanks();
            next = self.peek();
        }
        if next == b':' || next == b'N' && self.peek_at(1).is_ascii_digit() {
            self.at += 1;
            head.number = Some(self.integer()?);
            self.blanks();
        }
        if self.name_next() {
            let back = self.at;
            while self.name_goes_on() {
                self.at += 1;
            }
            let label = self.peek() == b':';
            self.at = back;
            if label {
                head.label = Some(self.name()?);
                self.at += 1;
            }
        }
        Ok(head)
    }

    /// Takes a whole number without a sign.
    #[inline]
    pub fn integer(&mut self) -> Outcome<u32> {
        let start = self.at;
        let mut value: u32 = 0;
        while self.digit_next() {
            let digit = u32::from(self.peek() - b'0');
            self.at += 1;
            value = value
                .checked_mul(10)
                .and_then(|v| v.checked_add(digit))
                .ok_or_else(|| self.error_since(start, Rule::Number, "the number is too large"))?;
        }
        if self.at == start {
            return Err(self.error_here(Rule::Number, "a whole number is missing here"));
        }
        Ok(value)
    }

    /// Takes the number of an address.
    #[inline]
    pub fn number(&mut self) -> Outcome<f64> {
        let start = self.at;
        let value = self.constant()?;
        if value.abs() <= LARGEST {
            return Ok(value);
        }
        Err(self.error_since(start, Rule::Number, "the number is beyond 99999999.9999"))
    }

    /// Takes a number: sign, digits, point, digits, exponent (`EX`).
    #[inline(always)]
    pub fn constant(&mut self) -> Outcome<f64> {
        let start = self.at;
        let negative = self.peek() == b'-';
        if negative || self.peek() == b'+' {
            self.at += 1;
        }
        let mut mantissa: u64 = 0;
        let mut digits = 0;
        let mut decimals = 0;
        let mut point = false;
        while let Some(&byte) = self.source.text.get(self.at) {
            match byte {
                b'0'..=b'9' => {
                    mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                    digits += 1;
                    decimals += usize::from(point);
                }
                b'.' if !point => point = true,
                _ => break,
            }
            self.at += 1;
        }
        if digits == 0 {
            return Err(self.error_here(Rule::Number, "a number is missing here"));
        }
        let exponent = self.peek() == b'E' && self.peek_at(1) == b'X';
        // Below 2^53 and 10^22 both are exact, so that the quotient is rounded correctly.
        match POWERS.get(decimals) {
            Some(power) if digits <= 15 && !exponent => {
                let size = mantissa as f64 / power;
                Ok(if negative { -size } else { size })
            }
            _ => self.slow_number(start, exponent),
        }
    }

    /// The number from `start` with many digits or an exponent.
    #[cold]
    fn slow_number(&mut self, start: usize, exponent: bool) -> Outcome<f64> {
        let end_of_mantissa = self.at;
        if exponent {
            self.at += 2;
            if matches!(self.peek(), b'+' | b'-') {
                self.at += 1;
            }
            let digits = self.at;
            while self.digit_next() {
                self.at += 1;
            }
            if self.at == digits {
                return Err(self.error_here(Rule::Number, "the exponent has no digits"));
            }
        }
        let text = self.source.text;
        let piece = |range: Range<usize>| String::from_utf8_lossy(text.get(range).unwrap_or(&[]));
        let mut number = piece(start..end_of_mantissa).into_owned();
        if exponent {
            number.push('e');
            number.push_str(&piece(end_of_mantissa + 2..self.at));
        }
        number.parse().map_err(|_| self.error_since(start, Rule::Number, "this is not a number"))
    }

    /// Takes a text in quotes.
    pub fn quoted(&mut self) -> Outcome<String> {
        self.expect(b'"')?;
        let start = self.at;
        let rest = self.source.text.get(start..).unwrap_or(&[]);
        let Some(length) = rest.iter().position(|&b| b == b'"') else {
            return Err(self.source.error(
                Rule::Syntax,
                start.saturating_sub(1)..self.source.text.len(),
                "the text has no closing quote",
            ));
        };
        self.at = start + length + 1;
        Ok(String::from_utf8_lossy(&rest[..length]).into_owned())
    }
}

/// Powers of ten that a binary number holds exactly.
const POWERS: [f64; 16] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
