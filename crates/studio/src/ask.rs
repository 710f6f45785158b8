//! What the page asks for and what it is answered: the types of the socket's heads, in Rust and, by a test, in TypeScript
//! (`studio/src/protocol/types.ts`).
//!
//! An ask is `{ "id": 7, "ask": "folder", "params": {...} }`, answered by [`Done`], with arrays where the type says so, or by [`Stopped`].
//! Meanwhile come [`Progress`] events; [`Cancel`] ends it. What nobody knows is null, and never 0.

use program::Diagnostic;
use serde::{Deserialize, Serialize};
use serde_json::Value;
#[cfg(test)]
use ts_rs::TS;

/// The first frame of a page.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct Hello {
    /// The token of the link.
    pub token: String,
}

/// Ends the work of an ask.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct Cancel {
    /// Its id.
    pub cancel: u32,
}

/// What an ask was for.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Done<T> {
    /// Its id.
    pub id: u32,
    /// The answer.
    pub done: T,
}

/// An ask that has no answer.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Stopped {
    /// Its id.
    pub id: u32,
    /// How it ended, and why.
    pub stop: Stop,
}

/// How work without a result ended, and why.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Stop {
    /// How.
    pub verdict: Verdict,
    /// Why.
    pub findings: Vec<Finding>,
}

/// How work ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// It is done, and where it is a program, proven.
    Done,
    /// Something is left out.
    Partly,
    /// The machine cannot do it, or the proof failed.
    Failed,
    /// The input is wrong.
    Invalid,
    /// A newer ask, or the page, has ended it.
    Cancelled,
}

impl From<app::Verdict> for Verdict {
    fn from(verdict: app::Verdict) -> Verdict {
        match verdict {
            app::Verdict::Done => Verdict::Done,
            app::Verdict::Partly => Verdict::Partly,
            app::Verdict::Failed => Verdict::Failed,
            app::Verdict::Invalid => Verdict::Invalid,
            app::Verdict::Cancelled => Verdict::Cancelled,
        }
    }
}

/// How far an ask has come.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Progress {
    /// `progress`.
    #[cfg_attr(test, ts(type = "\"progress\""))]
    pub event: &'static str,
    /// Of which ask.
    pub id: u32,
    /// What is being done: `reading`, `writing`, `proving`.
    pub step: &'static str,
    /// How much of it is done, from 0 to 1, where that is known.
    pub part: Option<f64>,
}

/// A finding, as `--json` prints it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// The rule that it is of; `toolpost explain RULE` says more.
    pub rule: &'static str,
    /// What is wrong, with values and units.
    pub message: String,
    /// The way out.
    pub help: String,
    /// Name of the file; empty where there is none.
    pub file: String,
    /// Which text that file is, where it is one of the job's.
    pub of: Option<Of>,
    /// Line from 1; 0 where it is about the whole.
    pub line: u32,
    /// Column from 1 in characters; 0 where it is about the whole line.
    pub column: u32,
    /// How many characters it covers.
    pub width: u32,
    /// The text of the line, and a mark below it; empty where it is not at hand.
    pub excerpt: String,
    /// How often it occurred.
    pub count: u32,
    /// Lines of the first few like it.
    pub lines: Vec<u32>,
}

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The result is good.
    Warning,
    /// There is no result.
    Error,
}

impl From<Diagnostic> for Finding {
    fn from(found: Diagnostic) -> Finding {
        Finding {
            severity: if found.is_error() { Severity::Error } else { Severity::Warning },
            rule: found.rule.name(),
            message: found.message,
            help: found.help,
            file: found.file,
            of: None,
            line: found.line,
            column: found.column,
            width: found.width,
            excerpt: found.excerpt,
            count: found.count,
            lines: found.lines,
        }
    }
}

/// `open {}`: what there is.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Opened {
    /// Of the command.
    pub version: &'static str,
    /// Name of the folder.
    pub folder: String,
    /// What the command line named.
    pub source: Option<FileOrUpload>,
    /// The same.
    pub machine: Option<String>,
    /// Drafts that are kept.
    pub drafts: Vec<Draft>,
    /// What the server takes.
    pub limits: Limits,
}

/// What the server takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Limits {
    /// The largest upload, bytes.
    pub upload: u64,
    /// The largest frame, bytes.
    pub frame: u64,
    /// How many jobs are open at the same time; the older ones go.
    pub jobs: u32,
    /// How many sockets are open at the same time.
    pub sockets: u32,
}

/// A file of the folder, or what was uploaded.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum FileOrUpload {
    /// Its path in the folder.
    File(String),
    /// The id that the upload was answered with.
    Upload(String),
}

/// `folder { path }`.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct FolderParams {
    /// Below the named folder; empty for itself.
    pub path: String,
}

/// What is in a folder.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Listing {
    /// Folders first, in the order of their names.
    pub entries: Vec<Entry>,
    /// Whether these are all.
    pub is_whole: bool,
}

/// An entry of a folder.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Its path below the named folder.
    pub path: String,
    /// What it is.
    pub kind: EntryKind,
    /// Size of a file.
    pub bytes: Option<u64>,
}

/// What an entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum EntryKind {
    /// A folder.
    Folder,
    /// A file.
    File,
}

/// `machines {}`: a machine that can be picked.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct MachineEntry {
    /// A name of the library, or the path of a file of the folder.
    pub name: String,
    /// What a person calls it.
    pub title: String,
    /// What it is.
    pub kind: MachineKind,
    /// The control that it extends.
    pub control: String,
    /// Names of its axes.
    pub axes: Vec<String>,
    /// Whether it is a file of the folder.
    pub is_own: bool,
    /// What is wrong with its file.
    pub findings: Vec<Finding>,
}

/// What a machine is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum MachineKind {
    /// A mill, a router or an engraver.
    Mill,
    /// Wire EDM.
    Wire,
    /// An arm with its control.
    Robot,
}

/// One of the texts of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(rename_all = "lowercase")]
pub enum Of {
    /// The program.
    Program,
    /// The source.
    Source,
    /// The machine file.
    Machine,
}

/// An edit that is kept, and nowhere saved.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Draft {
    /// Its name.
    pub name: String,
    /// What the page has said of it (source, machine, options, file).
    #[cfg_attr(test, ts(type = "unknown"))]
    pub of: Value,
    /// Size of its text.
    pub bytes: u64,
}

/// `draft { name, of }` with the array `text`: keeps it.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct DraftParams {
    /// Up to 100 letters, digits, `-`, `_` and `.`.
    pub name: String,
    /// What the page wants to know of it later.
    #[cfg_attr(test, ts(type = "unknown"))]
    pub of: Value,
}

/// `draft_text { name }`: answers the array `text`; `drop_draft { name }`.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(TS))]
#[serde(deny_unknown_fields)]
pub struct DraftName {
    /// Its name.
    pub name: String,
}

/// An answer that says no more than that it is done.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Nothing {}

/// `PUT /upload/NAME` is answered with it.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(TS))]
pub struct Uploaded {
    /// Its id.
    pub upload: String,
    /// Its size.
    pub bytes: u64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write as _;
    use std::path::Path;
    use ts_rs::Config;

    /// The types as TypeScript, each with its sentence.
    fn types() -> String {
        let config = Config::new().with_large_int("number");
        let mut text = String::from(
            "// Written by `TOOLPOST_DOCS=write cargo test -p toolpost-studio types`: the types of crates/studio/src/ask.rs.\n",
        );
        macro_rules! declare {
            ($($type:ty),* $(,)?) => { $(
                let docs = <$type as TS>::docs().unwrap_or_default();
                let _ = write!(text, "\n{docs}export {}\n", <$type as TS>::decl(&config));
            )* };
        }
        declare!(
            Hello,
            Cancel,
            Done<Nothing>,
            Stopped,
            Stop,
            Verdict,
            Progress,
            Finding,
            Severity,
            Opened,
            Limits,
            FileOrUpload,
            FolderParams,
            Listing,
            Entry,
            EntryKind,
            MachineEntry,
            MachineKind,
            Of,
            Draft,
            DraftParams,
            DraftName,
            Nothing,
            Uploaded,
        );
        text
    }

    #[test]
    fn the_types_of_the_page_are_those_of_the_server() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studio/src/protocol/types.ts");
        let types = types();
        if std::env::var_os("TOOLPOST_DOCS").is_some() {
            std::fs::write(&path, &types).unwrap();
        }
        let kept = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(kept == types, "run `TOOLPOST_DOCS=write cargo test -p toolpost-studio types`");
    }
}
