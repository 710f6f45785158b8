//! Writing and proving.

use crate::arguments::{Text, positive};
use crate::error::{class, findings, raised, released};
use crate::machine::Machine;
use crate::program::Program;
use app::files;
use app::helper::Launcher;
use app::post::{Posted, proven};
use app::prove::compare;
use app::{Account, Stop, Verdict};
use control::Folders;
use proof::Tolerances;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Write the program of a machine, and prove it: what is not proven is not given out.
///
/// The program is read back by a virtual control of its own, and its motion compared with ``program``.
///
/// Parameters
/// ----------
/// program : Program
///     What the machine shall do.
/// machine : Machine
///     Which machine; not one for wire EDM.
/// file : str, optional
///     Name of the program's file, for the report and its findings; by default that of ``program`` with the
///     ending of the machine.
/// tolerance : float, optional
///     Largest distance of the tool tip from the toolpath, mm; by default what the resolution of the
///     program's words explains.
///
/// Returns
/// -------
/// Result
///     The program and its report.
///
/// Raises
/// ------
/// toolpost.Error
///     Where the program cannot be written; or is not proven, with its :attr:`~toolpost.Error.report`.
///
/// Notes
/// -----
/// What a proof accepts: ``docs/proof.md``. What the controls are believed to do, with sources:
/// ``docs/controls``.
#[pyfunction]
#[pyo3(signature = (program, machine, *, file=None, tolerance=None))]
pub fn post<'py>(
    py: Python<'py>,
    program: &Program,
    machine: &Machine,
    file: Option<String>,
    tolerance: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let read = program.toolpath.files().into_iter().map(Path::to_owned);
    let inputs: Vec<PathBuf> =
        read.chain(machine.described.loaded_from.files.iter().cloned()).collect();
    let (toolpath, machine) = (&program.toolpath, &machine.described);
    let file = file.unwrap_or_else(|| {
        let name = toolpath.file.rsplit_once('.').map_or(&*toolpath.file, |(stem, _)| stem);
        format!("{name}.{}", machine.extension)
    });
    let tolerances = tolerances(py, tolerance)?;
    let Posted { text, parts, account, .. } =
        released(py, || proven(toolpath, machine, &file, &tolerances, &()))?;
    let report = report(py, &account)?;
    if account.verdict != Verdict::Done {
        let error = raised(py, &account.findings);
        error.value(py).setattr("report", report)?;
        return Err(error);
    }
    let called = PyDict::new(py);
    for part in &parts {
        called.set_item(&part.file, PyBytes::new(py, &part.text))?;
    }
    class(py, "Result")?.call1((PyBytes::new(py, &text), report, inputs, called))
}

/// Hold a program, also one edited by hand, against the toolpath that it should make.
///
/// Parameters
/// ----------
/// text : str or bytes
///     The program.
/// machine : Machine
///     The machine whose virtual control reads it.
/// program : Program
///     What the machine shall do.
/// file : str, optional
///     Name of the program's file, for the report and its findings.
/// tolerance : float, optional
///     Largest distance of the tool tip from the toolpath, mm; by default what the resolution of the
///     program's words explains.
/// parts : dict of str to bytes, optional
///     The files that the program calls, by their names: the :attr:`~toolpost.Result.parts` of a robot's
///     program that is divided.
///
/// Returns
/// -------
/// Report
///     Its :attr:`~toolpost.Report.proven` says whether the program makes that motion, and its findings
///     where it does not.
#[pyfunction]
#[pyo3(signature = (text, machine, program, *, file="program", tolerance=None, parts=None))]
pub fn prove<'py>(
    py: Python<'py>,
    text: Text,
    machine: &Machine,
    program: &Program,
    file: &str,
    tolerance: Option<f64>,
    parts: Option<BTreeMap<String, Vec<u8>>>,
) -> PyResult<Bound<'py, PyAny>> {
    let tolerances = tolerances(py, tolerance)?;
    let (toolpath, machine) = (&program.toolpath, &machine.described);
    let folders = Folders::from(parts.unwrap_or_default());
    let text = (file, text.bytes(), &folders);
    let account = released(py, || compare(toolpath, machine, text, &tolerances, &()))?;
    report(py, &account)
}

pub fn tolerances(py: Python<'_>, position: Option<f64>) -> PyResult<Tolerances> {
    let position = position.map(|mm| positive(py, "tolerance", mm)).transpose()?;
    Ok(Tolerances { position, ..Tolerances::default() })
}

fn report<'py>(py: Python<'py>, account: &Account) -> PyResult<Bound<'py, PyAny>> {
    reported(py, account, &account.report())
}

/// What Python has as a report: an account, and the text that is saved of it.
pub fn reported<'py>(
    py: Python<'py>,
    account: &Account,
    saved: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let rows = PyTuple::new(py, &account.rows)?;
    let proven = matches!(account.verdict, Verdict::Done | Verdict::Partly);
    class(py, "Report")?.call1((proven, rows, findings(py, &account.findings)?, saved))
}

/// Save a program, the files that it calls beside it, and its report, all or none, and over none of the files that it was made of: files
/// as they were before stay where one cannot be saved.
#[pyfunction]
pub fn save(
    py: Python<'_>,
    path: PathBuf,
    text: &[u8],
    parts: Vec<(String, PyBackedBytes)>,
    report: Option<&str>,
    inputs: Vec<PathBuf>,
) -> PyResult<()> {
    released(py, || {
        let parts: Vec<(&str, &[u8])> =
            parts.iter().map(|(file, text)| (file.as_str(), &text[..])).collect();
        let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
        files::save_program(&path, text, &parts, report, &inputs)
    })
}

/// Obey the words of a command line, the name of the command first, and answer its exit code. By the words `helper` the
/// studio starts its helpers.
#[pyfunction]
pub fn run_command(py: Python<'_>, words: Vec<OsString>, helper: Vec<OsString>) -> PyResult<u8> {
    let mut helper = helper.into_iter();
    let helper = helper.next().map(|program| Launcher::new(program, helper));
    released(py, || Ok::<_, Stop>(toolpost::run(words, helper)))
}
