//! What compensation refuses.

use program::{Diagnostic, Rule};

/// An error of `rule` in `line`.
pub(super) fn error(rule: Rule, line: u32, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(rule, message).line(line)
}

/// Only LinuxCNC has a way for that, and it needs the radius.
pub(super) fn on_arc(line: u32) -> Box<Diagnostic> {
    error(Rule::CompensationEntry, line, "compensation is switched on in an arc")
        .help("switch it on in a straight move before the arc")
        .into()
}

/// Elements that corners add would take the time of a move once more.
pub(super) fn inverse_time(line: u32) -> Box<Diagnostic> {
    error(Rule::CompensationFeed, line, "compensation with the feed as inverse time (G93)")
        .help("corners add moves, whose time is then not known: use G94")
        .into()
}
