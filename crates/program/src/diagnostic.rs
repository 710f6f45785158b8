//! What a reader, a writer or the proof has to say about a place in a file.

use crate::rule::Rule;
use serde::Serialize;
use std::fmt::{self, Write as _};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing; the result is good.
    Warning,
    /// There is no result.
    Error,
}

/// What a step makes, or the finding that refuses it.
pub type Outcome<T = ()> = Result<T, Box<Diagnostic>>;

/// One finding: where, which rule, what, and the way out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// The rule that it is of.
    #[serde(flatten, serialize_with = "Rule::fields")]
    pub rule: Rule,
    /// What is wrong, with values and units.
    pub message: String,
    /// The way out: that of the finding, or that of its rule.
    pub help: String,
    /// Name of the file; empty where there is none.
    pub file: String,
    /// Line from 1; 0 where the finding is about the whole.
    pub line: u32,
    /// Column from 1 in characters; 0 where the finding is about the whole line.
    pub column: u32,
    /// How many characters it covers; 0 counts as 1.
    pub width: u32,
    /// The text of the line (cut to a window where it is long); empty where it is not at hand.
    pub excerpt: String,
    /// How often it occurred, or one like it that is not listed; 1 for once.
    pub count: u32,
    /// Lines of the first few findings like this one that are not listed; see [`crate::Findings`].
    pub lines: Vec<u32>,
    /// Lines of those that [`Diagnostic::count`] counts besides this one, in the order in which they were found, the first
    /// [`MOST_PLACES`]: for whoever leads from one to the next. Messages leave them out, and answers and reports where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<u32>,
}

/// So many further lines of a finding are kept.
pub const MOST_PLACES: usize = 10_000;

/// The longest piece of a line that an excerpt keeps, characters.
const EXCERPT: usize = 160;

impl Diagnostic {
    /// An error of `rule`, with the way out of the rule.
    pub fn error(rule: Rule, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(Severity::Error, rule, message.into())
    }

    /// A warning of `rule`, with the way out of the rule.
    pub fn warning(rule: Rule, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(Severity::Warning, rule, message.into())
    }

    fn new(severity: Severity, rule: Rule, message: String) -> Diagnostic {
        Diagnostic {
            severity,
            rule,
            message: readable(message),
            help: rule.way_out().into(),
            file: String::new(),
            line: 0,
            column: 0,
            width: 0,
            excerpt: String::new(),
            count: 1,
            lines: Vec::new(),
            places: Vec::new(),
        }
    }

    /// It has been found once more, on this line (0 where that has no line).
    pub fn again(&mut self, line: u32) {
        self.count = self.count.saturating_add(1);
        if line > 0 && self.places.len() < MOST_PLACES {
            self.places.push(line);
        }
    }

    /// With this way out; where it is empty, with that of the rule.
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        let help = help.into();
        if !help.is_empty() {
            self.help = readable(help);
        }
        self
    }

    /// Adds another way out to those that there are.
    pub fn help_too(&mut self, help: &str) {
        if !self.help.is_empty() {
            self.help.push_str("; ");
        }
        self.help.push_str(help);
    }

    /// In this file.
    pub fn file(mut self, file: impl Into<String>) -> Diagnostic {
        self.file = file.into();
        self
    }

    /// On this line (from 1).
    pub fn line(mut self, line: u32) -> Diagnostic {
        self.line = line;
        self
    }

    /// At bytes `start..end` of `text`, which is line `line` (from 1). Bytes that are not UTF-8 show
    /// as replacement characters, control characters as blanks, a long line as a window.
    pub fn at(mut self, line: u32, text: &[u8], start: usize, end: usize) -> Diagnostic {
        let start = start.min(text.len());
        let end = end.clamp(start, text.len());
        let from = start.saturating_sub(EXCERPT / 2);
        let to = (from + EXCERPT).min(text.len());
        let show = |bytes: &[u8]| -> String {
            let text = String::from_utf8_lossy(bytes);
            text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
        };
        let before = show(&text[from..start]);
        let cut = if from > 0 { "…" } else { "" };
        let rest = if to < text.len() { "…" } else { "" };
        self.line = line;
        // Columns count characters, but what lies before the window of a very long line is not read:
        // there they count bytes.
        let column = if from > 0 { start } else { before.chars().count() };
        self.column = u32::try_from(column + 1).unwrap_or(u32::MAX);
        self.width =
            show(&text[start..end.clamp(start, to.max(start))]).chars().count().max(1) as u32;
        self.excerpt = format!("{cut}{}{rest}", show(&text[from..to]));
        let indent = before.chars().count() + cut.chars().count();
        let _ = write!(self.excerpt, "\n{}{}", " ".repeat(indent), "^".repeat(self.width as usize));
        self
    }

    /// About the whole of line `line` (from 1), which is `text`.
    pub fn on(mut self, line: u32, text: &[u8]) -> Diagnostic {
        self = self.at(line, text, 0, 0);
        (self.column, self.width) = (0, 0);
        self.excerpt.truncate(self.excerpt.find('\n').unwrap_or(0));
        self
    }

    /// Whether there is no result.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Line `number` (from 1) of `text`, whose lines end with LF, CR LF or CR; empty where there is none.
pub fn line_of(text: &[u8], number: u32) -> &[u8] {
    let mut rest = text;
    for _ in 1..number {
        let Some(end) = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')) else {
            return b"";
        };
        let length = if rest[end..].starts_with(b"\r\n") { 2 } else { 1 };
        rest = &rest[end + length..];
    }
    let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
    &rest[..end.unwrap_or(rest.len())]
}

/// `file:line:column: error[rule]: message`, then the line with a caret and the way out.
impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.file.is_empty() {
            write!(f, "{}:", self.file)?;
        }
        if self.line > 0 {
            write!(f, "{}:", self.line)?;
        }
        if self.column > 0 {
            write!(f, "{}:", self.column)?;
        }
        if !self.file.is_empty() || self.line > 0 {
            f.write_str(" ")?;
        }
        let severity = if self.is_error() { "error" } else { "warning" };
        write!(f, "{severity}[{}]: {}", self.rule, self.message)?;
        if self.count > 1 && self.lines.is_empty() {
            write!(f, " ({} times, first here)", self.count)?;
        }
        for line in self.excerpt.lines() {
            write!(f, "\n    | {line}")?;
        }
        if !self.lines.is_empty() {
            let lines: Vec<String> = self.lines.iter().map(u32::to_string).collect();
            let others = thousands(self.count - 1);
            let on = if (self.count - 1) as usize > lines.len() { " and on" } else { "" };
            write!(f, "\n    … and {others} more like this, at lines {}{on}", lines.join(", "))?;
        }
        if !self.help.is_empty() {
            write!(f, "\n    = {}", self.help)?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostic {}

/// The most digits in a row that a message says.
const MOST_DIGITS: usize = 24;

/// A text in which no number is longer than anybody reads.
fn readable(text: String) -> String {
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    if !text.as_bytes().windows(MOST_DIGITS + 1).any(|part| part.iter().all(u8::is_ascii_digit)) {
        return text;
    }
    let parts = text.as_bytes().chunk_by(|a, b| a.is_ascii_digit() == b.is_ascii_digit());
    let parts = parts.map(String::from_utf8_lossy).map(|part| {
        match part.len() > MOST_DIGITS && digits(&part) {
            true => format!("{}…", &part[..16]),
            false => part.into_owned(),
        }
    });
    parts.collect()
}

/// A number with a comma between each three digits.
fn thousands(number: u32) -> String {
    let digits = number.to_string();
    let groups = digits.as_bytes().rchunks(3).rev();
    groups.map(String::from_utf8_lossy).collect::<Vec<_>>().join(",")
}

/// The names of `known` that `name` was most likely meant to be, for an error: at most three, the nearest
/// first; empty where none is near.
pub fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let name: String = name.to_lowercase().chars().take(64).collect();
    let (length, most) = (name.chars().count(), |k: &str| 1 + k.len().max(name.len()) / 3);
    let mut ranked: Vec<(usize, &str)> = known
        // What is longer or shorter by more differs by more: of 150,000 names most need no comparison.
        .filter(|k| k.chars().count().abs_diff(length) <= most(k))
        .map(|k| (strsim::levenshtein(&name, &k.to_lowercase()), k))
        .filter(|&(d, k)| d <= most(k))
        .collect();
    ranked.sort();
    ranked.truncate(3);
    ranked.iter().map(|(_, k)| format!("`{k}`")).collect::<Vec<_>>().join(", ")
}

/// The least length (mm), feed or speed that a setting takes where it is above 0.
pub const LEAST_SETTING: f64 = 1e-6;

/// The largest length (mm), feed (mm/min) or speed (1/min) that a setting takes: beyond every machine.
pub const MOST_SETTING: f64 = 1e5;

/// Checks that a setting is a number within its bounds.
///
/// # Errors
/// `setting`
pub fn within(name: &str, value: f64, low: f64, high: f64) -> Result<(), Box<Diagnostic>> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    let help = format!("give a number from {low} to {high}");
    Err(Diagnostic::error(Rule::Setting, format!("`{name}` is {value}")).help(help).into())
}

/// Checks that of two settings that exclude each other not both are given.
///
/// # Errors
/// `setting`, with both names.
pub fn not_both(name: &str, other: &str, both: bool) -> Result<(), Box<Diagnostic>> {
    if !both {
        return Ok(());
    }
    let message =
        format!("`{name}` and `{other}` are given, of which one leaves the other no meaning");
    Err(Diagnostic::error(Rule::Setting, message).help("leave one of them out").into())
}

/// Checks that a setting is not given without the one on which its meaning depends.
///
/// # Errors
/// `setting`, with both names.
pub fn needs(name: &str, other: &str, missing: bool) -> Result<(), Box<Diagnostic>> {
    if !missing {
        return Ok(());
    }
    let message = format!("`{name}` is given, which has no meaning without `{other}`");
    let help = format!("give `{other}`, or leave `{name}` out");
    Err(Diagnostic::error(Rule::Setting, message).help(help).into())
}

/// One finding where there may be several.
impl From<Box<Diagnostic>> for Vec<Diagnostic> {
    fn from(finding: Box<Diagnostic>) -> Vec<Diagnostic> {
        vec![*finding]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_of_many_digits_is_cut() {
        let digits = "1234567890".repeat(30);
        let found = Diagnostic::error(Rule::Path, format!("Q1 is {digits}, not -0.{digits} mm"))
            .help(format!("give {digits}"));
        assert_eq!(found.message, "Q1 is 1234567890123456…, not -0.1234567890123456… mm");
        assert_eq!(found.help, "give 1234567890123456…");
        let kept = "at X 1234567890123456789012.5, 2026-11-24";
        assert_eq!(Diagnostic::warning(Rule::Path, kept).message, kept);
    }

    #[test]
    fn a_slip_of_the_keyboard_finds_the_name_that_was_meant() {
        let blocks = || ["arc_cw", "helix_cw", "linear", "tool_change"].into_iter();
        assert_eq!(nearest("liner", blocks()), "`linear`");
        assert_eq!(nearest("Tool_chnge", blocks()), "`tool_change`");
        assert_eq!(nearest("qqqqqqqqqqq", blocks()), "");
        assert_eq!(nearest(&"x".repeat(100_000), blocks()), "");
    }

    #[test]
    fn an_error_names_file_line_column_rule_and_way_out() {
        let shown = Diagnostic::error(Rule::ZeroVector, "the tool axis has no length")
            .help("give a direction")
            .file("a.cls")
            .at(3, b"GOTO/1,2,3,0,0,0", 11, 16)
            .to_string();
        assert_eq!(
            shown,
            "a.cls:3:12: error[zero-vector]: the tool axis has no length\n    | GOTO/1,2,3,0,0,0\n    \
             |            ^^^^^\n    = give a direction"
        );
    }

    #[test]
    fn a_finding_about_a_whole_line_shows_it_without_a_caret() {
        let shown = Diagnostic::error(Rule::NoFini, "y").help("z").on(3, b"GOTO/1,2,3").to_string();
        assert_eq!(shown, "3: error[no-fini]: y\n    | GOTO/1,2,3\n    = z");
    }

    #[test]
    fn a_very_long_line_is_shown_as_a_window() {
        let mut text = vec![b'A'; 1_000_000];
        text[500_000] = b'!';
        let d = Diagnostic::error(Rule::Syntax, "y").at(1, &text, 500_000, 500_001);
        assert_eq!(d.column, 500_001);
        assert!(d.excerpt.len() < 600);
        let mut lines = d.excerpt.lines();
        let caret = lines.next().unwrap().chars().position(|c| c == '!').unwrap();
        assert_eq!(lines.next().unwrap().chars().position(|c| c == '^').unwrap(), caret);
    }

    #[test]
    fn lines_end_with_lf_cr_lf_or_cr() {
        let text = b"one\ntwo\r\nthree\rfour";
        let lines: Vec<&[u8]> = (1..=5).map(|number| line_of(text, number)).collect();
        assert_eq!(lines, [&b"one"[..], b"two", b"three", b"four", b""]);
    }
}
