//! What goes wrong, as a `toolpost.Error`.

use app::Stop;
use program::{Diagnostic, Findings, Rule};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyTuple, PyType};
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What the last panic had to say, and where it was. Work is done on several threads, so that the panic of a call
/// need not be on its own: of two calls that panic at once both may tell the later one.
static PANIC: Mutex<String> = Mutex::new(String::new());

fn said() -> MutexGuard<'static, String> {
    PANIC.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From here on a panic says nothing on the error stream: [`released`] tells it.
pub fn catch_panics() {
    set_hook(Box::new(|panic| *said() = panic.to_string()));
}

/// Does `work` while other threads of Python go on. What stops it is raised, a panic like anything else.
pub fn released<T: Send, E: Into<Stop> + Send>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, E> + Send,
) -> PyResult<T> {
    match py.detach(|| catch_unwind(AssertUnwindSafe(work)).map_err(|_| said().clone())) {
        Ok(done) => done.map_err(|stop| raised(py, &stop.into().findings)),
        Err(said) => {
            let message = format!("this is a mistake in Toolpost: {said}");
            let help = "please report it, with what was given to it";
            Err(refused(py, Diagnostic::error(Rule::Internal, message).help(help)))
        }
    }
}

/// The exception for one finding.
pub fn refused(py: Python<'_>, found: Diagnostic) -> PyErr {
    raised(py, &[found])
}

/// The exception for these findings.
pub fn raised(py: Python<'_>, found: &[Diagnostic]) -> PyErr {
    let error = findings(py, found).and_then(|found| class(py, "Error")?.call1((found,)));
    error.map_or_else(|failed| failed, PyErr::from_value)
}

/// Findings as Python has them; of many like ones a few.
pub fn findings<'py>(py: Python<'py>, found: &[Diagnostic]) -> PyResult<Bound<'py, PyTuple>> {
    let finding = class(py, "Finding")?;
    let all: PyResult<Vec<_>> = found
        .iter()
        .cloned()
        .collect::<Findings>()
        .finish()
        .iter()
        .map(|found| {
            let rule = found.rule.name();
            let Diagnostic { message, help, file, line, column, excerpt, count, .. } = found;
            let severity = if found.is_error() { "error" } else { "warning" };
            let shown = found.to_string();
            finding
                .call1((severity, rule, message, help, file, line, column, excerpt, count, shown))
        })
        .collect();
    PyTuple::new(py, all?)
}

/// A class that is written in Python.
pub fn class<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyType>> {
    static ANSWERS: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let module =
        ANSWERS.get_or_try_init(py, || py.import("toolpost._answers").map(Bound::unbind))?;
    Ok(module.bind(py).getattr(name)?.cast_into()?)
}
