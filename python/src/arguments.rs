//! What Python gives: points, directions, arrays, words that stand for something.

use crate::error::{refused, released};
use app::Stop;
use freecad::Job;
use numpy::{AllowTypeChange, PyArrayLike2};
use program::{Diagnostic, Rule};
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyUnicodeEncodeError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList, PyTuple};
use serde_json::Value;
use std::path::PathBuf;

/// A path as text: what names a file, or something of the library.
pub fn text(path: PathBuf) -> String {
    path.to_string_lossy().into_owned()
}

/// What a file says, of which nobody has to know how it is encoded.
#[derive(FromPyObject)]
pub enum Text {
    Str(String),
    Bytes(Vec<u8>),
}

impl Text {
    /// As it stands in the file.
    pub fn bytes(&self) -> &[u8] {
        match self {
            Text::Str(text) => text.as_bytes(),
            Text::Bytes(bytes) => bytes,
        }
    }
}

/// A job of FreeCAD's: the text of its file, or what that would hold.
#[derive(FromPyObject)]
pub enum JobText<'py> {
    Text(Text),
    Sheet(Bound<'py, PyDict>),
}

impl JobText<'_> {
    /// The job, which is called `file`.
    pub fn job(self, py: Python<'_>, file: &str) -> PyResult<Job> {
        let sheet = match self {
            JobText::Text(text) => {
                return released(py, || Ok::<_, Stop>(Job::of(file, text.bytes())?));
            }
            JobText::Sheet(sheet) => json(sheet.as_any(), "job", DEEPEST)?,
        };
        released(py, || Ok::<_, Stop>(Job::of_value(file, sheet)?))
    }
}

/// How deep the lists and dictionaries of a job may be in one another: they are three.
const DEEPEST: u32 = 8;

/// What JSON would hold of a value that stands under `key`. Methods of Python's run meanwhile, which may change
/// what is read here: lists and dictionaries are copied.
fn json(any: &Bound<'_, PyAny>, key: &str, deepest: u32) -> PyResult<Value> {
    let py = any.py();
    let wrong = |message: String| {
        let help = "text of whole characters, numbers, True, False, None, lists and dictionaries";
        refused(py, Diagnostic::error(Rule::Argument, message).help(help))
    };
    let Some(deeper) = deepest.checked_sub(1) else {
        return Err(wrong(format!("`{key}` is in too many lists and dictionaries")));
    };
    if let Ok(dictionary) = any.cast::<PyDict>() {
        let entry = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            let Some(name) = exactly::<String>(&name)? else {
                return Err(wrong(format!("`{key}` has a key that is no text")));
            };
            let value = json(&value, &name, deeper)?;
            Ok((name, value))
        };
        let entries = dictionary.items();
        return entries
            .iter()
            .map(|item| entry(item.extract()?))
            .collect::<PyResult<_>>()
            .map(Value::Object);
    }
    let list = any.cast::<PyList>().map(|list| list.to_tuple());
    if let Ok(list) = list.or_else(|_| any.cast::<PyTuple>().cloned()) {
        return list.iter().map(|value| json(&value, key, deeper)).collect();
    }
    if any.is_none() {
        return Ok(Value::Null);
    }
    if let Ok(is) = any.cast::<PyBool>() {
        return Ok(Value::Bool(is.is_true()));
    }
    if let Some(text) = exactly::<String>(any)? {
        return Ok(text.into());
    }
    if let Some(whole) = exactly::<i64>(any)? {
        return Ok(whole.into());
    }
    match exactly::<f64>(any)? {
        Some(value) => Ok(number(py, "a number of the job", value)?.into()),
        None => Err(wrong(format!("`{key}` is a {} that JSON does not hold", any.get_type()))),
    }
}

/// A value as a `T`, where it is one: of the right type, no text with half a character, no number that is too great.
/// What else goes wrong, its own methods have raised.
fn exactly<'py, T>(any: &Bound<'py, PyAny>) -> PyResult<Option<T>>
where
    T: for<'a> FromPyObject<'a, 'py, Error = PyErr>,
{
    let py = any.py();
    any.extract().map(Some).or_else(|error: PyErr| {
        let other = error.is_instance_of::<PyTypeError>(py)
            || error.is_instance_of::<PyUnicodeEncodeError>(py)
            || error.is_instance_of::<PyOverflowError>(py);
        if other { Ok(None) } else { Err(error) }
    })
}

/// A finite number.
pub fn number(py: Python<'_>, what: &str, value: f64) -> PyResult<f64> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(refused(py, Diagnostic::error(Rule::Number, format!("{what} is {value}")))),
    }
}

/// A finite number greater than 0.
pub fn positive(py: Python<'_>, what: &str, value: f64) -> PyResult<f64> {
    match number(py, what, value)? > 0.0 {
        true => Ok(value),
        false => {
            let found = Diagnostic::error(Rule::Number, format!("{what} is {value}"));
            Err(refused(py, found.help("it must be greater than 0")))
        }
    }
}

/// What a word stands for, among those that there are.
pub fn word<T: Copy>(py: Python<'_>, what: &str, given: &str, all: &[(&str, T)]) -> PyResult<T> {
    let found = all.iter().find(|(word, _)| *word == given);
    found.map(|(_, meaning)| *meaning).ok_or_else(|| {
        let words: Vec<&str> = all.iter().map(|(word, _)| *word).collect();
        let found = Diagnostic::error(Rule::Argument, format!("{what} is `{given}`"));
        refused(py, found.help(format!("it is one of {}", words.join(", "))))
    })
}

/// The rows of an array of so many columns, copied, so that nobody can change them meanwhile.
pub fn rows(
    py: Python<'_>,
    what: &str,
    array: &PyArrayLike2<'_, f64, AllowTypeChange>,
    columns: usize,
) -> PyResult<Vec<[f64; 3]>> {
    let array = array.as_array();
    if array.ncols() != columns {
        let message = format!("{what} has {} columns where {columns} are needed", array.ncols());
        return Err(refused(py, Diagnostic::error(Rule::ArrayShape, message)));
    }
    let rows = array.rows().into_iter().map(|row| {
        let mut all = [0.0; 3];
        all.iter_mut().zip(row).for_each(|(to, from)| *to = *from);
        all
    });
    Ok(rows.collect())
}
