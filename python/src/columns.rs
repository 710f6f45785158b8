//! The moves of a program as columns, which NumPy takes over as they are.

use crate::record::pose;
use numpy::ndarray::{Array, Dimension, Ix1, Ix2, ShapeBuilder};
use numpy::{Element, PyArray, PyArrayMethods};
use program::{Feed, Op, Program};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// One row for each move. The arrays are read-only and own their memory, so that they outlive the
/// program.
pub struct Columns {
    pub positions: Py<PyArray<f64, Ix2>>,
    pub axes: Py<PyArray<f64, Ix2>>,
    pub feeds: Py<PyArray<f64, Ix1>>,
    pub lines: Py<PyArray<u32, Ix1>>,
    pub kinds: Py<PyArray<u8, Ix1>>,
    pub records: Py<PyArray<u64, Ix1>>,
}

/// The columns while they are filled.
#[derive(Default)]
pub struct Filled {
    positions: Vec<f64>,
    axes: Vec<f64>,
    feeds: Vec<f64>,
    lines: Vec<u32>,
    kinds: Vec<u8>,
    records: Vec<u64>,
}

impl Filled {
    /// The moves of `program`.
    pub fn of(program: &Program) -> Filled {
        let count = program.records.iter().filter(|record| pose(&record.op).is_some()).count();
        let mut filled = Filled {
            positions: Vec::with_capacity(3 * count),
            axes: Vec::with_capacity(3 * count),
            feeds: Vec::with_capacity(count),
            lines: Vec::with_capacity(count),
            kinds: Vec::with_capacity(count),
            records: Vec::with_capacity(count),
        };
        let (mut active, mut cycle) = (None, None);
        for (index, record) in (0..).zip(&program.records) {
            match &record.op {
                Op::Feed(feed) => active = Some(*feed),
                Op::Cycle(found) => cycle = found.feed,
                _ => {}
            }
            let Some(pose) = pose(&record.op) else { continue };
            let (kind, feed) = match record.op {
                Op::Rapid(_) => (0, None),
                Op::Arc(_) => (2, active),
                Op::Thread(_) => (3, None),
                Op::Probe(_) => (4, active),
                Op::Hole(_) => (5, cycle.or(active)),
                _ => (1, active),
            };
            filled.positions.extend(pose.point().to_array());
            filled.axes.extend(pose.axis().to_array());
            filled.feeds.push(match feed {
                Some(Feed::PerMinute(feed)) => feed,
                _ => f64::NAN,
            });
            filled.lines.push(record.line);
            filled.kinds.push(kind);
            filled.records.push(index);
        }
        filled
    }

    /// Handed over to NumPy.
    pub fn hand_over(self, py: Python<'_>) -> PyResult<Columns> {
        let rows = self.lines.len();
        Ok(Columns {
            positions: frozen(array(py, (rows, 3), self.positions)?)?,
            axes: frozen(array(py, (rows, 3), self.axes)?)?,
            feeds: frozen(array(py, rows, self.feeds)?)?,
            lines: frozen(array(py, rows, self.lines)?)?,
            kinds: frozen(array(py, rows, self.kinds)?)?,
            records: frozen(array(py, rows, self.records)?)?,
        })
    }
}

/// An array that takes the memory of `values` over.
pub fn array<T: Element, S: ShapeBuilder>(
    py: Python<'_>,
    shape: S,
    values: Vec<T>,
) -> PyResult<Bound<'_, PyArray<T, S::Dim>>> {
    // Without NumPy the next lines would panic.
    py.import("numpy")?;
    let array = Array::from_shape_vec(shape.into_shape_with_order(), values);
    let array = array.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(PyArray::from_owned_array(py, array))
}

/// The array, which nobody can write to any more.
fn frozen<T: Element, D: Dimension>(
    array: Bound<'_, PyArray<T, D>>,
) -> PyResult<Py<PyArray<T, D>>> {
    array.try_readwrite()?.make_nonwriteable();
    Ok(array.unbind())
}
