//! How work ended, and what is reported of it.

use program::{Diagnostic, Findings};
use serde_json::{Value, json};

/// How work ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The command is done.
    Done,
    /// What could be made is made, and something is left out: the findings say what, and why.
    Partly,
    /// The machine cannot do it, or the proof failed.
    Failed,
    /// The input or the call is wrong.
    Invalid,
    /// The caller has ended it ([`crate::Watch::is_cancelled`]).
    Cancelled,
}

/// What is reported of a program: in rows for a person, in JSON for a machine.
#[derive(Clone, Debug)]
pub struct Account {
    /// Whether it is proven.
    pub verdict: Verdict,
    /// What is reported of it, and under which head.
    pub rows: Vec<(&'static str, String)>,
    /// The same, and more: an object.
    pub data: Value,
    /// What is wrong with it, or worth knowing.
    pub findings: Vec<Diagnostic>,
}

impl Account {
    /// The report that is saved next to a program, as JSON.
    pub fn report(&self) -> String {
        let mut report = self.data.clone();
        let findings = self.findings.iter().cloned().collect::<Findings>().finish();
        report["warnings"] = json!(findings);
        format!("{report:#}\n")
    }

    /// Names the file of the program, which was called `from`, `to`: so is what was found in it. What was found in a source that is called `from`
    /// too keeps its name.
    pub fn rename_program(&mut self, from: &str, to: &str) {
        let source = self.data.pointer("/source/file").is_some_and(|file| file == from);
        let lists = ["/proof/warnings", "/proof/accepted"];
        let proof: Vec<Value> = lists
            .iter()
            .filter_map(|list| self.data.pointer(list)?.as_array())
            .flatten()
            .cloned()
            .collect();
        for found in self.findings.iter_mut().filter(|found| found.file == from) {
            if !source || proof.contains(&json!(found)) {
                to.clone_into(&mut found.file);
            }
        }
        if let Some(file) = self.data.pointer_mut("/program/file") {
            *file = json!(to);
        }
        for list in lists {
            let found = self.data.pointer_mut(list).and_then(Value::as_array_mut);
            for found in found.into_iter().flatten().filter(|found| found["file"] == from) {
                found["file"] = json!(to);
            }
        }
    }
}

impl From<Account> for Stop {
    fn from(Account { verdict, findings, .. }: Account) -> Stop {
        Stop { verdict, findings }
    }
}

impl From<Stop> for Account {
    fn from(Stop { verdict, findings }: Stop) -> Account {
        Account { verdict, rows: Vec::new(), data: json!({}), findings }
    }
}

/// What stops work: how it ended, and why.
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

    /// The caller has ended the work.
    pub fn cancelled() -> Stop {
        Stop { verdict: Verdict::Cancelled, findings: vec![program::cancelled()] }
    }
}

/// A finding that stops work is about its input, unless the work says otherwise.
impl From<Box<Diagnostic>> for Stop {
    fn from(finding: Box<Diagnostic>) -> Stop {
        Stop::invalid(vec![*finding])
    }
}

impl From<Diagnostic> for Stop {
    fn from(finding: Diagnostic) -> Stop {
        Box::new(finding).into()
    }
}

impl From<Vec<Diagnostic>> for Stop {
    fn from(findings: Vec<Diagnostic>) -> Stop {
        Stop::invalid(findings)
    }
}
