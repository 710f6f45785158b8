//! A module, taken from left to right. A statement may go over several lines.

use super::value::Name;
use crate::kernel::flow::BlockLocation;
use crate::kernel::source::Source;
use program::{Diagnostic, Outcome, Rule};

/// A module on its way through the reader. Everything from `!` to the end of a line is a comment.
pub(crate) struct Scan<'t> {
    pub(crate) text: &'t [u8],
    pub(crate) at: usize,
    /// How deep brackets nest here.
    pub(crate) depth: usize,
    /// The line of a byte before `at`, or of it.
    counted: BlockLocation,
}

impl<'t> Scan<'t> {
    pub(crate) fn new(text: &'t [u8], from: BlockLocation) -> Scan<'t> {
        Scan { text, at: from.at, depth: 0, counted: from }
    }

    /// Where the next byte stands.
    pub(crate) fn location(&mut self) -> BlockLocation {
        let passed = self.text.get(self.counted.at..self.at).unwrap_or_default();
        let lines = memchr::memchr_iter(b'\n', passed).count();
        self.counted.line = self.counted.line.saturating_add(lines as u32);
        self.counted.at = self.at;
        self.counted
    }

    /// Goes over blanks.
    pub(crate) fn blanks(&mut self) {
        let rest = self.rest();
        self.at += rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    }

    /// The text of the comment that begins here.
    pub(crate) fn comment(&mut self) -> Option<&'t [u8]> {
        let rest = self.rest().strip_prefix(b"!")?;
        let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        self.at += 1 + length;
        rest.get(..length).map(<[u8]>::trim_ascii)
    }

    /// The next byte that is neither blank nor comment; `None` at the end.
    pub(crate) fn peek(&mut self) -> Option<u8> {
        loop {
            self.blanks();
            if self.comment().is_none() {
                return self.text.get(self.at).copied();
            }
        }
    }

    /// What has not been taken yet.
    pub(crate) fn rest(&self) -> &'t [u8] {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Takes `byte` where it comes next.
    pub(crate) fn take(&mut self, byte: u8) -> bool {
        let here = self.peek() == Some(byte);
        self.at += usize::from(here);
        here
    }

    /// Takes `:=` where it comes next.
    pub(crate) fn assigns(&mut self) -> bool {
        let here = self.peek() == Some(b':') && self.rest().get(1) == Some(&b'=');
        self.at += 2 * usize::from(here);
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

    /// Takes a name where one comes next: letters, digits, `_`, a letter first.
    ///
    /// # Errors
    /// It is longer than a name may be.
    pub(crate) fn name(&mut self) -> Outcome<Option<Name>> {
        if !self.peek().is_some_and(|byte| byte.is_ascii_alphabetic()) {
            return Ok(None);
        }
        let rest = self.rest();
        let goes_on = |byte: &&u8| byte.is_ascii_alphanumeric() || **byte == b'_';
        let length = rest.iter().take_while(goes_on).count();
        let from = self.at;
        self.at += length;
        let name = Name::of(rest.get(..length).unwrap_or_default());
        match name {
            Some(_) => Ok(name),
            None => {
                let message = "a name of RAPID has at most 32 letters";
                Err(self.since(from, Rule::Syntax, message))
            }
        }
    }

    /// Takes the name `word` where it comes next.
    ///
    /// # Errors
    /// As [`Scan::name`].
    pub(crate) fn take_word(&mut self, word: &str) -> Outcome<bool> {
        let before = self.at;
        if self.name()?.is_some_and(|name| name.as_str() == word) {
            return Ok(true);
        }
        self.at = before;
        Ok(false)
    }

    /// Takes a name.
    ///
    /// # Errors
    /// Something else comes next: `what` says what is needed.
    pub(crate) fn needed(&mut self, what: &str) -> Outcome<Name> {
        let name = self.name()?;
        name.ok_or_else(|| self.wrong(format!("{what} is needed here")))
    }

    /// Takes a text in quotation marks; two of them within it are one.
    ///
    /// # Errors
    /// It has no end in its line, or more letters than a string holds.
    pub(crate) fn text(&mut self) -> Outcome<Box<str>> {
        let from = self.at;
        let mut found = Vec::new();
        self.at += 1;
        loop {
            match (self.rest().first(), self.rest().get(1)) {
                (Some(b'"'), Some(b'"')) => {
                    found.push(b'"');
                    self.at += 2;
                }
                (Some(b'"'), _) => {
                    self.at += 1;
                    break;
                }
                (None | Some(b'\n' | b'\r'), _) => {
                    return Err(self.since(from, Rule::Syntax, "the text has no end"));
                }
                (Some(byte), _) => {
                    found.push(*byte);
                    self.at += 1;
                }
            }
        }
        if found.len() > 80 {
            return Err(self.since(from, Rule::Syntax, "a string of RAPID has at most 80 letters"));
        }
        Ok(String::from_utf8_lossy(&found).into())
    }

    /// Goes behind the next `;` that is in no text and no comment.
    ///
    /// # Errors
    /// There is none.
    pub(crate) fn skip(&mut self) -> Outcome {
        let from = self.at;
        loop {
            match self.peek() {
                None => return Err(self.since(from, Rule::Syntax, "`;` is missing behind this")),
                Some(b';') => {
                    self.at += 1;
                    return Ok(());
                }
                Some(b'"') => drop(self.text()?),
                Some(_) => self.at += 1,
            }
        }
    }

    /// An error about what comes next.
    #[cold]
    pub(crate) fn wrong(&self, message: impl Into<String>) -> Box<Diagnostic> {
        let end = (self.at + 1).min(self.text.len().max(self.at));
        self.between(Rule::Syntax, self.at, end, message)
    }

    /// An error about what stands from byte `from` to here.
    #[cold]
    pub(crate) fn since(
        &self,
        from: usize,
        rule: Rule,
        message: impl Into<String>,
    ) -> Box<Diagnostic> {
        self.between(rule, from, self.at.max(from), message)
    }

    fn between(
        &self,
        rule: Rule,
        from: usize,
        to: usize,
        message: impl Into<String>,
    ) -> Box<Diagnostic> {
        let before = self.text.get(..from).unwrap_or(self.text);
        let line = 1 + memchr::memchr_iter(b'\n', before).count();
        let start = memchr::memrchr(b'\n', before).map_or(0, |at| at + 1);
        let rest = self.text.get(start..).unwrap_or_default();
        let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        let block = rest.get(..length).unwrap_or_default();
        let block = block.strip_suffix(b"\r").unwrap_or(block);
        let line = u32::try_from(line).unwrap_or(u32::MAX);
        let inside = |at: usize| (at - start).min(block.len());
        Source { line, text: block }.error(rule, inside(from)..inside(to), message)
    }
}
