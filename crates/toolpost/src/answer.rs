//! What a command has to say, and where it is said: findings to the error stream, the rest to the
//! output, or everything as one JSON object.

use crate::summary;
use program::{Diagnostic, Findings};
use serde_json::{Map, Value, json};
use std::io::{self, Write};

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// What was asked for is done.
    Done,
    /// The machine cannot do it, or the proof failed.
    Failed,
    /// The input or the call is wrong.
    Invalid,
}

impl Verdict {
    fn name(self) -> &'static str {
        match self {
            Verdict::Done => "done",
            Verdict::Failed => "failed",
            Verdict::Invalid => "invalid",
        }
    }

    fn code(self) -> u8 {
        match self {
            Verdict::Done => 0,
            Verdict::Failed => 1,
            Verdict::Invalid => 2,
        }
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

/// What is told of a program: in rows for a person, in JSON for a machine.
#[derive(Debug)]
pub struct Account {
    /// Whether it is proven.
    pub verdict: Verdict,
    /// What is told of it, and under which head.
    pub rows: Vec<(&'static str, String)>,
    /// The same, and more: an object.
    pub data: Value,
    /// What is wrong with it, or worth knowing.
    pub findings: Vec<Diagnostic>,
}

impl Account {
    /// The answer where the program is therefore not saved.
    pub fn not_saved(mut self) -> Answer {
        self.rows.push(("saved", String::from("nothing: what was there before is as it was")));
        self.into()
    }

    /// The report that is saved beside a program.
    pub fn report(&self) -> String {
        let mut report = self.data.clone();
        let findings = self.findings.iter().cloned().collect::<Findings>().finish();
        report["warnings"] = json!(findings);
        format!("{report:#}\n")
    }
}

/// What stops a command: how it ended, and why.
#[derive(Debug)]
pub struct Stop {
    /// How.
    pub verdict: Verdict,
    /// Why.
    pub findings: Vec<Diagnostic>,
}

impl Stop {
    /// What is wrong with the input.
    pub fn invalid(findings: Vec<Diagnostic>) -> Stop {
        Stop { verdict: Verdict::Invalid, findings }
    }
}

/// A finding that stops a command is about its input, unless the command says otherwise.
impl From<Box<Diagnostic>> for Stop {
    fn from(finding: Box<Diagnostic>) -> Stop {
        Stop { verdict: Verdict::Invalid, findings: vec![*finding] }
    }
}

impl From<Diagnostic> for Stop {
    fn from(finding: Diagnostic) -> Stop {
        Box::new(finding).into()
    }
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
        let code = this.verdict.code();
        let said = if json { this.say_json() } else { this.say_text(quiet) };
        match said {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                let _ = writeln!(io::stderr(), "error: the answer cannot be printed: {error}");
                Verdict::Invalid.code().max(code)
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
        object.insert("status".into(), self.verdict.name().into());
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

/// Whether a program rests on what a finding of this rule says: a unit that was guessed, a rule that was accepted.
fn is_assumption(rule: &str) -> bool {
    rule == "unknown-unit" || proof::ACCEPTABLE.iter().any(|(name, _)| *name == rule)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_not_printed() {
        assert_eq!(printable("a\u{1b}[2Jb\r\n\tc"), "a [2Jb \n\tc");
    }
}
