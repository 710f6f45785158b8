//! Where a reader's findings gather: errors up to a cap, warnings one for each cause.

use memchr::{memchr2, memrchr2};
pub(crate) use program::Outcome;
use program::{Diagnostic, Rule};

/// After so many errors the reader gives up: what follows is mostly the echo of the first.
const MAX_ERRORS: usize = 20;

/// A finding whose location is not known yet.
pub(crate) type Fault = Box<Diagnostic>;

/// An error of `rule`; its caller adds the location.
#[cold]
pub(crate) fn fault(rule: Rule, message: impl Into<String>, help: &str) -> Fault {
    Diagnostic::error(rule, message).help(help).into()
}

/// A range of bytes of the text, and the line (from 1) in which it begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Location {
    pub(crate) line: u32,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// The findings of one reading.
pub(crate) struct Report<'a> {
    file: &'a str,
    text: &'a [u8],
    /// In the order in which they were found.
    pub(crate) errors: Vec<Diagnostic>,
    /// In the order of their first occurrence.
    pub(crate) warnings: Vec<Diagnostic>,
}

impl<'a> Report<'a> {
    pub(crate) fn new(file: &'a str, text: &'a [u8]) -> Report<'a> {
        Report { file, text, errors: Vec::new(), warnings: Vec::new() }
    }

    /// Whether reading on makes no sense: without a unit all else is the echo of that.
    pub(crate) fn is_full(&self) -> bool {
        let has_no_unit = |error: &Diagnostic| error.rule == Rule::NoUnit;
        self.errors.len() >= MAX_ERRORS || self.errors.last().is_some_and(has_no_unit)
    }

    /// Adds an error at `location`.
    #[cold]
    pub(crate) fn error(&mut self, location: Location, error: Diagnostic) {
        if !self.is_full() {
            self.errors.push(self.locate(location, error));
        }
    }

    /// Adds a warning at `location`; one that was given before only counts. What is the same says the
    /// message.
    #[cold]
    pub(crate) fn warn(&mut self, location: Location, rule: Rule, message: &str, help: &str) {
        let known = |d: &&mut Diagnostic| d.rule == rule && d.message == message;
        match self.warnings.iter_mut().find(known) {
            Some(known) => known.count = known.count.saturating_add(1),
            None => {
                let warning = Diagnostic::warning(rule, message).help(help);
                self.warnings.push(self.locate(location, warning));
            }
        }
    }

    fn locate(&self, location: Location, finding: Diagnostic) -> Diagnostic {
        let end = location.end.min(self.text.len());
        let start = location.start.min(end);
        let line_start = memrchr2(b'\n', b'\r', &self.text[..start]).map_or(0, |at| at + 1);
        let rest = &self.text[line_start..];
        let line = &rest[..memchr2(b'\n', b'\r', rest).unwrap_or(rest.len())];
        let finding = finding.file(self.file);
        if location.line == 0 {
            return finding;
        }
        finding.at(location.line, line, start - line_start, end - line_start)
    }
}
