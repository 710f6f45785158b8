//! A block of a text, and what is said about a piece of it.

use program::{Diagnostic, Rule};
use std::ops::Range;

/// One block of the program text.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// Its line, from 1.
    pub line: u32,
    /// Its bytes without the line end.
    pub text: &'a [u8],
}

impl Source<'_> {
    /// An error about a piece of the block.
    #[cold]
    pub fn error(
        &self,
        rule: Rule,
        piece: Range<usize>,
        message: impl Into<String>,
    ) -> Box<Diagnostic> {
        Diagnostic::error(rule, message).at(self.line, self.text, piece.start, piece.end).into()
    }

    /// An error about the whole block.
    #[cold]
    pub fn block_error(&self, rule: Rule, message: impl Into<String>) -> Box<Diagnostic> {
        let blanks = |bytes: &mut dyn Iterator<Item = &u8>| {
            bytes.take_while(|b| b.is_ascii_whitespace()).count()
        };
        let start = blanks(&mut self.text.iter());
        let end = self.text.len() - blanks(&mut self.text.iter().rev());
        self.error(rule, start..end.max(start), message)
    }
}
