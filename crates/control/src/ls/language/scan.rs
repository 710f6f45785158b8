//! An instruction, taken from left to right.

use crate::kernel::decimal;
use crate::kernel::source::Source;
use program::{Diagnostic, Outcome, Rule};

/// A piece of the text on its way through the reader.
pub(crate) struct Scan<'t> {
    pub(crate) source: Source<'t>,
    pub(crate) at: usize,
}

impl<'t> Scan<'t> {
    pub(crate) fn new(source: Source<'t>) -> Scan<'t> {
        Scan { source, at: 0 }
    }

    /// The next byte that is no blank.
    pub(crate) fn peek(&mut self) -> Option<u8> {
        let rest = self.rest();
        self.at += rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        self.source.text.get(self.at).copied()
    }

    /// What has not been taken yet.
    pub(crate) fn rest(&self) -> &'t [u8] {
        self.source.text.get(self.at..).unwrap_or_default()
    }

    /// Takes `byte` where it comes next.
    pub(crate) fn take(&mut self, byte: u8) -> bool {
        let here = self.peek() == Some(byte);
        self.at += usize::from(here);
        here
    }

    /// # Errors
    /// Something else comes next.
    pub(crate) fn expect(&mut self, byte: u8) -> Outcome {
        match self.take(byte) {
            true => Ok(()),
            false => Err(self.wrong(format!("`{}` is needed here", char::from(byte)))),
        }
    }

    /// Takes a word where one comes next: letters and `_`, behind the first digits too where `numbered` says so.
    fn letters(&mut self, numbered: bool) -> Option<&'t str> {
        let begins = |byte: u8| byte.is_ascii_alphabetic() || byte == b'_';
        if !self.peek().is_some_and(begins) {
            return None;
        }
        let rest = self.rest();
        let goes_on = |byte: &&u8| begins(**byte) || numbered && byte.is_ascii_digit();
        let length = rest.iter().take_while(goes_on).count();
        self.at += length;
        rest.get(..length).and_then(|word| std::str::from_utf8(word).ok())
    }

    /// Takes a word of letters and `_`: the number in `CNT50` is no part of it.
    pub(crate) fn word(&mut self) -> Option<&'t str> {
        self.letters(false)
    }

    /// Takes a name, in which digits may stand behind the first letter.
    pub(crate) fn name(&mut self) -> Option<&'t str> {
        self.letters(true)
    }

    /// Takes `text` where it comes next.
    pub(crate) fn take_text(&mut self, text: &str) -> bool {
        self.peek();
        let here = self.rest().starts_with(text.as_bytes());
        self.at += if here { text.len() } else { 0 };
        here
    }

    /// Takes a decimal with its sign, where one comes next.
    pub(crate) fn decimal(&mut self) -> Option<f64> {
        self.peek();
        let before = self.at;
        let negative = self.take(b'-');
        self.peek();
        match decimal::parse(self.rest()) {
            Some(read) => {
                self.at += read.len;
                Some(if negative { -read.value } else { read.value })
            }
            None => {
                self.at = before;
                None
            }
        }
    }

    /// Takes a whole number in square brackets, behind which a remark may stand (`[1:spindle]`).
    ///
    /// # Errors
    /// There is none, or it is above `most`.
    pub(crate) fn index(&mut self, most: u32) -> Outcome<u32> {
        self.expect(b'[')?;
        let from = self.at;
        let Some(number) = self.decimal() else {
            return Err(self.wrong("a number in brackets is needed here"));
        };
        if number.fract() != 0.0 || !(0.0..=f64::from(most)).contains(&number) {
            let message = format!("the number is a whole one from 0 to {most}");
            return Err(self.since(from, Rule::Index, message));
        }
        if self.take(b':') {
            let rest = self.rest();
            self.at += rest.iter().take_while(|byte| **byte != b']').count();
        }
        Ok(number as u32)
    }

    /// # Errors
    /// Anything follows.
    pub(crate) fn ends(&mut self) -> Outcome {
        match self.peek() {
            None => Ok(()),
            Some(_) => {
                let rest = String::from_utf8_lossy(self.rest());
                let word = rest.split_whitespace().next().unwrap_or_default();
                Err(self.wrong(format!("`{word}` is not understood here")))
            }
        }
    }

    /// An error about what comes next.
    #[cold]
    pub(crate) fn wrong(&self, message: impl Into<String>) -> Box<Diagnostic> {
        let end = (self.at + 1).min(self.source.text.len().max(self.at));
        self.source.error(Rule::Syntax, self.at..end, message)
    }

    /// An error about what stands from byte `from` to here.
    #[cold]
    pub(crate) fn since(
        &self,
        from: usize,
        rule: Rule,
        message: impl Into<String>,
    ) -> Box<Diagnostic> {
        self.source.error(rule, from..self.at.max(from), message)
    }
}
