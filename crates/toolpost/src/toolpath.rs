//! Getting the toolpath and the machine that a command names.

use crate::answer::{Stop, Verdict};
use crate::files;
use machine::Machine;
use program::{Diagnostic, Program};
use std::path::Path;

/// A toolpath as it was read.
pub struct Toolpath {
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
        file,
        dialect: reading.dialect.to_string(),
        program: reading.program,
        warnings: reading.warnings,
    })
}

/// The machine of a name in the library or of a file.
///
/// # Errors
/// Where there is none, or its file has a mistake.
pub fn machine(name_or_path: &str) -> Result<Machine, Stop> {
    machine::load(name_or_path).map_err(|finding| finding.into())
}
