//! What the writer has to say about its work: each kind of lowering once, with how often and from
//! which source line on.

use program::{Diagnostic, MOST_PLACES, Rule};

/// The most lines that are listed of warnings like one before.
const MOST_LINES: usize = 20;

/// More errors than this nobody reads.
const MOST_ERRORS: usize = 20;

/// Errors and warnings as they are collected.
#[derive(Default)]
pub(crate) struct Findings {
    errors: Vec<Diagnostic>,
    warnings: Vec<Diagnostic>,
    lowered: Vec<Lowered>,
}

/// One kind of lowering.
struct Lowered {
    rule: Rule,
    what: &'static str,
    line: u32,
    /// Lines of all others, the first so many.
    places: Vec<u32>,
    count: usize,
    blocks: usize,
}

impl Findings {
    /// Keeps an error, or counts it where there is one of its rule that says the same, or has the same way out in
    /// the same line; `false` when there are enough of them.
    pub(crate) fn error(&mut self, error: Diagnostic) -> bool {
        let same = |known: &&mut Diagnostic| {
            let same_way_out = known.help == error.help && !error.help.is_empty();
            known.rule == error.rule
                && (known.message == error.message || known.line == error.line && same_way_out)
        };
        match self.errors.iter_mut().find(same) {
            Some(known) => known.again(error.line),
            None => self.errors.push(error),
        }
        self.errors.len() < MOST_ERRORS
    }

    /// Keeps a warning; one of the same rule and message is counted.
    pub(crate) fn warn(&mut self, warning: Diagnostic) {
        let same = |w: &&mut Diagnostic| w.rule == warning.rule && w.message == warning.message;
        match self.warnings.iter_mut().find(same) {
            Some(known) => known.again(warning.line),
            None => self.warnings.push(warning),
        }
    }

    /// The same of what somebody has to look at in each place: the lines of those that are like an earlier one, up to a fixed number.
    pub(crate) fn warn_of_lines(&mut self, warning: Diagnostic) {
        let same = |w: &&mut Diagnostic| w.rule == warning.rule && w.message == warning.message;
        match self.warnings.iter_mut().find(same) {
            Some(known) if known.lines.len() < MOST_LINES => known.lines.push(warning.line),
            _ => {}
        }
        self.warn(warning);
    }

    /// Counts one thing (`what`, in the plural) that was written as so many lines.
    pub(crate) fn lowered(&mut self, rule: Rule, what: &'static str, line: u32, blocks: usize) {
        match self.lowered.iter_mut().find(|l| l.rule == rule && l.what == what) {
            Some(known) => {
                known.count += 1;
                known.blocks += blocks;
                if known.places.len() < MOST_PLACES {
                    known.places.push(line);
                }
            }
            None => {
                let places = Vec::new();
                self.lowered.push(Lowered { rule, what, line, places, count: 1, blocks });
            }
        }
    }

    /// The warnings, or the errors in the order of their lines where there are some.
    pub(crate) fn finish(mut self, tolerance: f64) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
        if !self.errors.is_empty() {
            // Some are known only at the end.
            self.errors.sort_by_key(|error| error.line);
            return Err(self.errors);
        }
        let mut warnings = self.warnings;
        warnings.extend(self.lowered.iter().map(|l| {
            let Lowered { rule, what, count, blocks, line, places } = l;
            // A board has no lines.
            let here = if *line == 0 { "" } else { ", first here" };
            let message = format!(
                "{what}: {count} written as {blocks} lines, tolerance {tolerance} mm{here}"
            );
            Diagnostic { places: places.clone(), ..Diagnostic::warning(*rule, message).line(*line) }
        }));
        Ok(warnings)
    }
}
