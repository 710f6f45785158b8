//! For tests: finds the judges, which are other people's programs, Python modules and real files.
//!
//! None of them is part of the project. Where one is missing, the test says on the error stream that
//! nothing was judged, and passes. With `CI=true` in the environment, which `.ci/run` sets, it fails: no judge is
//! missing there without notice.
//!
//! ```
//! // The first program of every test of this project.
//! assert!(toolpost_judge::program("cargo", "https://rustup.rs"));
//! ```

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Whether the program is on the `PATH`; `source` says where it comes from.
#[track_caller]
pub fn program(name: &str, source: &str) -> bool {
    let path = env::var_os("PATH").unwrap_or_default();
    let found = env::split_paths(&path).any(|folder| folder.join(name).is_file());
    if !found {
        missing(&format!("{name} ({source}) is not installed"));
    }
    found
}

/// A Python that has the module, which is a package of PyPI: that of `make judges`, or the one on the `PATH`.
#[track_caller]
pub fn python(module: &str) -> Option<PathBuf> {
    let ours = project().join(".venv/bin/python");
    let has = |python: &PathBuf| {
        let run = Command::new(python).args(["-c", &format!("import {module}")]).output();
        run.is_ok_and(|run| run.status.success())
    };
    let found = [ours, "python3".into(), "/usr/bin/python3".into()].into_iter().find(has);
    if found.is_none() {
        missing(&format!("no Python has the module {module} (PyPI)"));
    }
    found
}

/// A folder of the real input: of `TOOLPOST_DATA`, or of `../shared/data` next to the project.
#[track_caller]
pub fn data(folder: &str) -> Option<PathBuf> {
    let next_to_project = || project().join("../shared/data");
    let data =
        env::var_os("TOOLPOST_DATA").map_or_else(next_to_project, PathBuf::from).join(folder);
    if data.is_dir() {
        return Some(data);
    }
    missing(&format!("there is no real input in {} (TOOLPOST_DATA)", data.display()));
    None
}

/// The script that runs a program on a whole LinuxCNC: of `TOOLPOST_TOOLS`, or of `../shared/tools` next to the project.
/// `None` as well where the package `linuxcnc-uspace` is not installed.
#[track_caller]
pub fn linuxcnc() -> Option<PathBuf> {
    let next_to_project = || project().join("../shared/tools");
    let tools = env::var_os("TOOLPOST_TOOLS").map_or_else(next_to_project, PathBuf::from);
    let script = tools.join("linuxcnc-run/linuxcnc-run");
    if !program("linuxcnc", "Debian package linuxcnc-uspace") {
        return None;
    }
    if script.is_file() {
        return Some(script);
    }
    missing(&format!("there is no {} (TOOLPOST_TOOLS)", script.display()));
    None
}

/// Whether the judges may take their time (`make judges-long`): many more programs, and other ones each time.
pub fn long() -> bool {
    env::var_os("TOOLPOST_JUDGES").is_some_and(|value| value == "long")
}

/// Says on the error stream that nothing was judged, and why.
///
/// # Panics
///
/// With `CI=true` in the environment.
#[track_caller]
pub fn missing(why: &str) {
    missing_where(env::var_os("CI").is_some_and(|value| value == "true"), why);
}

#[track_caller]
fn missing_where(required: bool, why: &str) {
    assert!(!required, "{why}; with CI=true every judge has to be there (`scripts/setup judges`)");
    eprintln!("nothing was judged: {why} (`make judges`)");
}

/// The top folder of the project.
fn project() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_judge_is_no_failure_at_home() {
        missing_where(false, "rs274 is not installed");
    }

    #[test]
    #[should_panic(expected = "rs274 is not installed; with CI=true")]
    fn a_missing_judge_is_a_failure_in_ci() {
        missing_where(true, "rs274 is not installed");
    }
}
