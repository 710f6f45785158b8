//! What a command has to say, and where it is said: findings to the error stream, the rest to the
//! output, or everything as one JSON object.

use app::{Account, Stop, Verdict, summary};
use program::{Diagnostic, Findings, Rule};
use serde_json::{Map, Value, json};
use std::io::{self, Write};

/// What JSON calls a verdict, and its exit code.
fn ending(verdict: Verdict) -> (&'static str, u8) {
    match verdict {
        Verdict::Done => ("done", 0),
        Verdict::Partly => ("partly", 3),
        Verdict::Failed => ("failed", 1),
        Verdict::Invalid => ("invalid", 2),
        Verdict::Cancelled => ("cancelled", crate::INTERRUPTED),
    }
}

/// The answer of a command.
#[derive(Debug)]
pub struct Answer {
    verdict: Verdict,
    text: String,
    /// Whether the text only tells what was done, so that `--quiet` drops it.
    summary: bool,
    /// The same as the text, for machines: an object.
    data: Value,
    findings: Vec<Diagnostic>,
}

/// The answer about a program that is not saved.
pub fn not_saved(mut account: Account) -> Answer {
    account.rows.push(("saved", String::from("nothing: what was there before is as it was")));
    account.into()
}

impl Answer {
    /// What was asked for.
    pub fn product(text: impl Into<String>, data: Value) -> Answer {
        let (verdict, findings) = (Verdict::Done, Vec::new());
        Answer { verdict, text: text.into(), summary: false, data, findings }
    }

    /// What was done.
    pub fn summary(verdict: Verdict, text: impl Into<String>, data: Value) -> Answer {
        Answer { verdict, summary: true, ..Answer::product(text, data) }
    }

    /// With another verdict.
    pub fn ending(self, verdict: Verdict) -> Answer {
        Answer { verdict, ..self }
    }

    /// With findings.
    pub fn findings(mut self, findings: Vec<Diagnostic>) -> Answer {
        self.findings.extend(findings);
        self
    }

    /// Says it, and answers the exit code.
    pub fn say(self, quiet: bool, json: bool) -> u8 {
        let findings = self.findings.into_iter().collect::<Findings>().finish();
        let this = Answer { findings, ..self };
        let lost = this.findings.iter().find(|finding| finding.help.is_empty());
        debug_assert!(lost.is_none(), "a finding without a way out: {lost:?}");
        let (_, code) = ending(this.verdict);
        let said = if json { this.say_json() } else { this.say_text(quiet) };
        match said {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                let _ = writeln!(io::stderr(), "error: the answer cannot be printed: {error}");
                ending(Verdict::Invalid).1.max(code)
            }
            _ => code,
        }
    }

    fn say_text(self, quiet: bool) -> io::Result<()> {
        let mut err = io::stderr().lock();
        let is_said = |f: &&Diagnostic| f.is_error() || !quiet || is_assumption(f.rule);
        for finding in self.findings.iter().filter(is_said) {
            writeln!(err, "{}", printable(&finding.to_string()))?;
        }
        let mut out = io::stdout().lock();
        if !(quiet && self.summary) {
            out.write_all(printable(&self.text).as_bytes())?;
        }
        out.flush()
    }

    fn say_json(self) -> io::Result<()> {
        let (errors, warnings): (Vec<_>, Vec<_>) =
            self.findings.into_iter().partition(Diagnostic::is_error);
        let mut object = Map::new();
        object.insert("status".into(), ending(self.verdict).0.into());
        if let Value::Object(data) = self.data {
            object.extend(data);
        }
        object.insert("errors".into(), json!(errors));
        object.insert("warnings".into(), json!(warnings));
        let mut out = io::stdout().lock();
        serde_json::to_writer_pretty(&mut out, &object)?;
        writeln!(out)?;
        out.flush()
    }
}

impl From<Account> for Answer {
    fn from(account: Account) -> Answer {
        let Account { verdict, rows, data, findings } = account;
        Answer::summary(verdict, summary::rows(&rows), data).findings(findings)
    }
}

impl From<Stop> for Answer {
    fn from(stop: Stop) -> Answer {
        Answer::summary(stop.verdict, "", Value::Null).findings(stop.findings)
    }
}

/// Text from a file may hold control characters that would steer a terminal: they show as blanks.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() && c != '\n' && c != '\t' { ' ' } else { c }).collect()
}

/// Whether a program rests on what a finding of this rule says: a unit that was guessed, blocks that were read as switched on, a
/// stop that is left out, a height that nobody knows, a rule that was accepted.
fn is_assumption(rule: Rule) -> bool {
    const READ_SO: [Rule; 4] =
        [Rule::UnknownUnit, Rule::BlockSkip, Rule::OptionalStop, Rule::EndHeight];
    READ_SO.contains(&rule) || proof::ACCEPTABLE.iter().any(|(acceptable, _)| rule == *acceptable)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_not_printed() {
        assert_eq!(printable("a\u{1b}[2Jb\r\n\tc"), "a [2Jb \n\tc");
    }
}
