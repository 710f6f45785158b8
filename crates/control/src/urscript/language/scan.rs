//! A line, taken from left to right.

use crate::kernel::source::Source;
use program::{Diagnostic, Outcome, Rule};

/// A line on its way through the reader. Everything behind `#` is a comment.
pub(crate) struct Scan<'t> {
    pub(crate) source: Source<'t>,
    pub(crate) at: usize,
    /// How deep brackets nest here.
    pub(crate) depth: usize,
}

impl<'t> Scan<'t> {
    pub(crate) fn new(source: Source<'t>) -> Scan<'t> {
        Scan { source, at: 0, depth: 0 }
    }

    /// The next byte that is no blank; `None` at the end and before a comment.
    pub(crate) fn peek(&mut self) -> Option<u8> {
        let rest = self.rest();
        self.at += rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        self.source.text.get(self.at).copied().filter(|byte| *byte != b'#')
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

    /// Takes a name where one comes next: letters, digits, `_`, not beginning with a digit. Capitals make a difference.
    pub(crate) fn name(&mut self) -> Option<&'t str> {
        let begins = |byte: u8| byte.is_ascii_alphabetic() || byte == b'_';
        if !self.peek().is_some_and(begins) {
            return None;
        }
        let rest = self.rest();
        let goes_on = |byte: &&u8| begins(**byte) || byte.is_ascii_digit();
        let length = rest.iter().take_while(goes_on).count();
        self.at += length;
        rest.get(..length).and_then(|name| std::str::from_utf8(name).ok())
    }

    /// Takes the name `word` where it comes next.
    pub(crate) fn take_word(&mut self, word: &str) -> bool {
        let before = self.at;
        let here = self.name() == Some(word);
        if !here {
            self.at = before;
        }
        here
    }

    /// # Errors
    /// Anything but a comment follows.
    pub(crate) fn ends(&mut self) -> Outcome {
        match self.peek() {
            None => Ok(()),
            Some(byte) => {
                let message = format!("`{}` is not understood here", char::from(byte));
                Err(self.wrong(message))
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
