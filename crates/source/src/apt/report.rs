//! Where the reader's findings gather: errors up to a cap, warnings one for each cause.

use super::statement::Statement;
use program::{Diagnostic, NoPose, Rule};

/// After so many errors the reader gives up: what follows is mostly the echo of the first.
const MAX_ERRORS: usize = 20;

/// What a handler of a statement gives back.
pub(super) type Outcome = Result<(), Box<Fault>>;

/// What is wrong with a statement, before its place is known.
#[derive(Debug)]
pub(super) struct Fault {
    rule: Rule,
    message: String,
    help: String,
    /// First field and how many, where the fault is in fields.
    fields: Option<(usize, usize)>,
}

impl Fault {
    /// A fault of `rule` in the statement as a whole.
    pub(super) fn new(rule: Rule, message: impl Into<String>) -> Box<Fault> {
        Box::new(Fault { rule, message: message.into(), help: String::new(), fields: None })
    }

    /// With the way out.
    pub(super) fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Fault> {
        self.help = help.into();
        self
    }

    /// In `count` fields from field `first` (from 0) on.
    pub(super) fn fields(mut self: Box<Self>, first: usize, count: usize) -> Box<Fault> {
        self.fields = Some((first, count));
        self
    }
}

/// Numbers that make no pose; frames and units may lead beyond what a number holds.
impl From<NoPose> for Box<Fault> {
    fn from(numbers: NoPose) -> Box<Fault> {
        Fault::new(Rule::OutOfRange, numbers.to_string())
    }
}

/// The findings of one reading.
pub(super) struct Report {
    file: String,
    strict: bool,
    /// In the order of their lines.
    pub(super) errors: Vec<Diagnostic>,
    /// In the order of their first occurrence.
    pub(super) warnings: Vec<Diagnostic>,
}

impl Report {
    /// An empty report on `file`; with `strict` a warning is an error.
    pub(super) fn new(file: &str, strict: bool) -> Report {
        Report { file: file.into(), strict, errors: Vec::new(), warnings: Vec::new() }
    }

    /// Whether reading on makes sense.
    pub(super) fn is_full(&self) -> bool {
        self.errors.len() >= MAX_ERRORS
    }

    /// Adds an error in `statement`.
    #[cold]
    pub(super) fn fault(&mut self, statement: &Statement, fault: Fault) {
        let error = Diagnostic::error(fault.rule, fault.message).help(fault.help);
        self.error(statement.locate(error, fault.fields));
    }

    /// Adds an error whose place is known, and the file's name to it.
    #[cold]
    pub(super) fn error(&mut self, error: Diagnostic) {
        if !self.is_full() {
            self.errors.push(error.file(&*self.file));
        }
    }

    /// Adds a warning of `rule` in `statement`; one that was given before only counts. What is the same
    /// says the message.
    #[cold]
    pub(super) fn warn(&mut self, statement: &Statement, rule: Rule, message: &str, help: &str) {
        let warning = Diagnostic::warning(rule, message).help(help);
        self.warning(statement.locate(warning, None));
    }

    /// As [`Report::warn`], for a warning whose place is known.
    #[cold]
    pub(super) fn warning(&mut self, warning: Diagnostic) {
        let list = if self.strict { &mut self.errors } else { &mut self.warnings };
        let known =
            list.iter_mut().find(|d| d.rule == warning.rule && d.message == warning.message);
        match known {
            Some(known) => known.again(warning.line),
            None if self.strict => {
                let severity = program::Severity::Error;
                self.error(Diagnostic { severity, ..warning });
            }
            None => list.push(warning.file(&*self.file)),
        }
    }

    /// How many different warnings of `rule` there are.
    pub(super) fn count_of(&self, rule: Rule) -> usize {
        self.errors.iter().chain(&self.warnings).filter(|d| d.rule == rule).count()
    }
}
