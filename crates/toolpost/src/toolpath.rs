//! Getting the toolpath and the machine that a command names.

use crate::answer::{Stop, Verdict};
use crate::files;
use crate::summary::Shape;
use machine::Machine;
use program::{Diagnostic, Program};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// A toolpath as it was read.
pub struct Toolpath {
    path: PathBuf,
    /// Name of its file.
    pub file: String,
    /// The CAM system whose habits the file has.
    pub dialect: String,
    /// What it says.
    pub program: Program,
    /// What was not passed on.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a toolpath.
///
/// # Errors
/// What is wrong with the file; with `strict` also what would be a warning.
pub fn read(path: &Path, strict: bool) -> Result<Toolpath, Stop> {
    let bytes = files::read(path)?;
    let file = files::name(path);
    let reading = source::apt::read(&file, &bytes, &source::apt::Options { strict })
        .map_err(|findings| Stop { verdict: Verdict::Invalid, findings })?;
    Ok(Toolpath {
        path: path.to_owned(),
        file,
        dialect: reading.dialect.to_string(),
        program: reading.program,
        warnings: reading.warnings,
    })
}

impl Toolpath {
    /// Puts the file's name and the text of the line to findings that have nothing but a line of the
    /// source. The file is read again: while all goes well, nobody needs its text.
    pub fn quote(&self, findings: &mut [Diagnostic]) {
        let mut lines = None;
        for finding in findings.iter_mut().filter(|f| f.file.is_empty() && f.line > 0) {
            let text = lines.get_or_insert_with(|| files::read(&self.path).unwrap_or_default());
            *finding = finding.clone().on(finding.line, line(text, finding.line)).file(&self.file);
        }
    }

    /// The source and its measures, as JSON.
    pub fn describe(&self, shape: &Shape) -> Value {
        json!({ "file": self.file, "dialect": self.dialect, "measures": shape })
    }

    /// The first lines of a summary: what was done, for which machine.
    pub fn rows(&self, machine: &Machine) -> Vec<(&'static str, String)> {
        vec![
            ("toolpath", format!("{} ({})", self.file, self.dialect)),
            ("machine", format!("{} ({})", machine.title, machine.name)),
        ]
    }

    /// The text of a line of the source; empty where there is none.
    pub fn line(&self, number: u32) -> String {
        let text = files::read(&self.path).unwrap_or_default();
        String::from_utf8_lossy(line(&text, number)).into_owned()
    }
}

/// Line `number` (from 1) of `text`, whose lines end with LF, CR LF or CR.
fn line(text: &[u8], number: u32) -> &[u8] {
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

/// The machine of a name in the library or of a file.
///
/// # Errors
/// Where there is none, or its file has a mistake.
pub fn machine(name_or_path: &str) -> Result<Machine, Stop> {
    let machine = machine::load(name_or_path)?;
    if control::Dialect::named(&machine.reader).is_none() {
        let names = control::Dialect::NAMES.map(|(name, _)| name).join(", ");
        let message = format!("there is no virtual control `{}`", machine.reader);
        let place = machine.reader_place;
        return Err(Diagnostic::error("reader", message)
            .help(format!("`reader` is one of {names}"))
            .file(place.file)
            .line(place.line)
            .into());
    }
    Ok(machine)
}

/// What a machine is called, as JSON.
pub fn describe(machine: &Machine) -> Value {
    json!({
        "name": machine.name,
        "title": machine.title,
        "control": machine.control,
        "reader": machine.reader,
        "extension": machine.extension,
        "path_tolerance_mm": machine.path_tolerance(),
    })
}

#[cfg(test)]
mod tests {
    use super::line;

    #[test]
    fn lines_end_with_lf_cr_lf_or_cr() {
        let text = b"one\ntwo\r\nthree\rfour";
        let lines: Vec<&[u8]> = (1..=5).map(|number| line(text, number)).collect();
        assert_eq!(lines, [&b"one"[..], b"two", b"three", b"four", b""]);
    }
}
