//! The report of a program: what the program was made of, and whether the two are still a pair.

use crate::account::Account;
use crate::files;
use crate::toolpath::Toolpath;
use control::Folders;
use machine::Machine;
use program::{Diagnostic, Digest, Rule};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::path::Path;

/// The version of the shape of a report. It grows where a key goes or means something else; new keys may come at any
/// time.
pub const SCHEMA: u32 = 4;

/// The largest report that is read, bytes.
const LARGEST: u64 = 256 << 20;

/// SHA-256 of a program and of what it was made of, in hexadecimal digits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Digests {
    /// The program.
    program: String,
    /// The toolpath, where it came from a file.
    source: Option<String>,
    /// The files of the machine and the options that were given for it.
    machine: String,
}

impl Digests {
    /// The digests of a program, with the files that it calls in the order of their names, and what it was made of.
    pub fn of(text: &[u8], parts: &[&[u8]], toolpath: &Toolpath, machine: &Machine) -> Digests {
        Digests {
            program: Digest::of([text].into_iter().chain(parts.iter().copied())),
            source: toolpath.digest().map(str::to_owned),
            machine: machine.loaded_from.digest.clone(),
        }
    }

    /// What is not the same on two sides.
    fn differences(&self, other: &Digests) -> Vec<&'static str> {
        let sides = [
            (self.program != other.program, "program"),
            (self.source != other.source, "toolpath"),
            (self.machine != other.machine, "machine file"),
        ];
        sides.into_iter().filter(|(differs, _)| *differs).map(|(_, name)| name).collect()
    }
}

/// The texts of the files that a program has called, as [`Digests::of`] takes them.
///
/// # Errors
/// One can no longer be read.
pub fn called(folders: &Folders) -> Result<Vec<Vec<u8>>, Box<Diagnostic>> {
    folders.files_read().iter().map(|path| files::read(path)).collect()
}

/// What a report says of a program that calls files: their names and sizes, bytes, and in place of its own size that of all together.
pub(crate) fn set_parts<'a>(program: &mut Value, parts: impl Iterator<Item = (&'a str, &'a [u8])>) {
    let part = |(file, text): (&str, &[u8])| json!({ "file": file, "bytes": text.len() });
    let parts: Vec<Value> = parts.map(part).collect();
    if parts.is_empty() {
        return;
    }
    let own = program["bytes"].as_u64().unwrap_or_default();
    let bytes = parts.iter().filter_map(|part| part["bytes"].as_u64()).sum::<u64>() + own;
    program["bytes"] = json!(bytes);
    program["parts"] = json!(parts);
}

/// Adds to the account of a program that was proven and not written, as after an edit by hand, what that of a written one has: the files that
/// it calls, and what it was made of.
pub fn complete<'a>(
    account: &mut Account,
    parts: impl Iterator<Item = (&'a str, &'a [u8])>,
    digests: &Digests,
) {
    set_parts(&mut account.data["program"], parts);
    account.data["schema"] = json!(SCHEMA);
    account.data["toolpost"] = json!(env!("CARGO_PKG_VERSION"));
    account.data["sha256"] = json!(digests);
}

/// What a report holds, as far as it is read again.
#[derive(Deserialize)]
struct Saved {
    sha256: Digests,
}

/// What the report next to the program file `path` says about its origin; `now` finds the digests of today. Nothing where
/// there is no report.
///
/// # Errors
/// A warning: it is the report of something else, or it cannot be read.
pub fn pair(path: &Path, now: impl FnOnce() -> Digests) -> Result<Option<String>, Box<Diagnostic>> {
    let report = files::report_of(path);
    let name = files::name(&report);
    let other = |message: String| {
        let help = "post the program anew for a report of its own, or remove the report";
        let found = Diagnostic::warning(Rule::ReportPair, message);
        Err(found.help(help).file(name.clone()).into())
    };
    let Ok(metadata) = std::fs::metadata(&report) else { return Ok(None) };
    if metadata.len() > LARGEST {
        return other(format!("is no report: it is larger than {} MB", LARGEST >> 20));
    }
    let bytes = match files::read(&report) {
        Ok(bytes) => bytes,
        Err(found) => return other(found.message),
    };
    let Ok(Saved { sha256 }) = serde_json::from_slice(&bytes) else {
        return other(String::from("does not say what it was made of"));
    };
    match sha256.differences(&now())[..] {
        [] => Ok(Some(format!("{name} belongs to this program, toolpath and machine file"))),
        ref what => other(format!("is the report of another {}", what.join(" and "))),
    }
}
