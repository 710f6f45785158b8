//! Machines: those of the library, and files.

use crate::arguments::{number, rows, text};
use crate::columns::array;
use crate::error::{refused, released};
use crate::kinematics;
use ::machine::library::{MACHINES, names};
use app::Stop;
use app::toolpath;
use numpy::{AllowTypeChange, PyArray2, PyArrayLike2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::PathBuf;

/// Two arrays with one row for each pose.
type Pair<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

/// A machine with its control; :func:`toolpost.machine` loads one.
#[pyclass(frozen, module = "toolpost")]
pub struct Machine {
    pub described: ::machine::Machine,
}

#[pymethods]
impl Machine {
    /// Its name in the library, or that of its file.
    #[getter]
    fn name(&self) -> &str {
        &self.described.name
    }

    /// What a person calls it.
    #[getter]
    fn title(&self) -> &str {
        &self.described.title
    }

    /// The control that it extends.
    #[getter]
    fn control(&self) -> &str {
        &self.described.control
    }

    /// The dialect of its programs, whose virtual control proves them.
    #[getter]
    fn reader(&self) -> &str {
        &self.described.reader
    }

    /// Ending of the names of its programs, without the dot.
    #[getter]
    fn extension(&self) -> &str {
        &self.described.extension
    }

    /// Letters of its rotary axes, from the machine's frame outwards.
    #[getter]
    fn rotary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.described.rotary.iter().map(|axis| axis.letter))
    }

    /// Whether it is a machine for wire EDM, for which :func:`toolpost.wire` writes.
    #[getter]
    fn wire(&self) -> bool {
        self.described.wire.is_some()
    }

    /// The positions of the axes that bring the tool tip to points and the tool along axes.
    ///
    /// Each pose has the solution that the machine prefers, for itself. A posted program chooses between the
    /// solutions, and turns more than half a turn, over whole operations.
    ///
    /// Parameters
    /// ----------
    /// points : array_like, shape (n, 3)
    ///     Tool tips in the work frame, mm.
    /// axes : array_like, shape (n, 3)
    ///     Directions from the tip towards the spindle, in the work frame, of any length.
    /// tool_length : float
    ///     From the gauge line of the spindle to the tip, mm; matters where a head turns.
    ///
    /// Returns
    /// -------
    /// linear : ndarray, shape (n, 3)
    ///     X, Y and Z, mm, as a program without tool-center control gives them: where the tip would be, from
    ///     the work zero, with the head in its zero position.
    /// rotary : ndarray, shape (n, k)
    ///     Degrees in (-180, 180], a column for each of :attr:`rotary`. An axis that may stand anywhere
    ///     (singular pose) is given in its zero.
    ///
    /// Raises
    /// ------
    /// toolpost.Error
    ///     ``unreachable-orientation``, with the row and how far the nearest axis in reach is away;
    ///     ``zero-vector``; ``number`` for what is not finite; ``array-shape``.
    ///
    /// Notes
    /// -----
    /// Closed form for one or two rotary axes of any direction: the first two subproblems of Paden and Kahan
    /// (Murray, Li and Sastry, *A Mathematical Introduction to Robotic Manipulation*, 1994, 3.3.2).
    #[pyo3(signature = (points, axes, tool_length = 0.0))]
    fn inverse<'py>(
        &self,
        py: Python<'py>,
        points: PyArrayLike2<'py, f64, AllowTypeChange>,
        axes: PyArrayLike2<'py, f64, AllowTypeChange>,
        tool_length: f64,
    ) -> PyResult<Pair<'py>> {
        let machine = &self.described;
        let length = number(py, "tool_length", tool_length)?;
        let (points, axes) = (rows(py, "points", &points, 3)?, rows(py, "axes", &axes, 3)?);
        let (linear, rotary) =
            released(py, || kinematics::inverse(machine, &points, &axes, length))?;
        let shape = (points.len(), machine.rotary.len());
        Ok((array(py, (points.len(), 3), linear)?, array(py, shape, rotary)?))
    }

    /// Where positions of the axes bring the tool: the way back from :meth:`inverse`.
    ///
    /// Parameters
    /// ----------
    /// linear : array_like, shape (n, 3)
    ///     X, Y and Z, mm.
    /// rotary : array_like, shape (n, k)
    ///     Degrees, a column for each of :attr:`rotary`.
    /// tool_length : float
    ///     From the gauge line of the spindle to the tip, mm.
    ///
    /// Returns
    /// -------
    /// points : ndarray, shape (n, 3)
    ///     Tool tips in the work frame, mm.
    /// axes : ndarray, shape (n, 3)
    ///     Unit vectors from the tip towards the spindle, in the work frame.
    ///
    /// Raises
    /// ------
    /// toolpost.Error
    ///     ``number`` for what is not finite; ``array-shape``.
    #[pyo3(signature = (linear, rotary, tool_length = 0.0))]
    fn forward<'py>(
        &self,
        py: Python<'py>,
        linear: PyArrayLike2<'py, f64, AllowTypeChange>,
        rotary: PyArrayLike2<'py, f64, AllowTypeChange>,
        tool_length: f64,
    ) -> PyResult<Pair<'py>> {
        let machine = &self.described;
        let length = number(py, "tool_length", tool_length)?;
        let linear = rows(py, "linear", &linear, 3)?;
        let rotary = rows(py, "rotary", &rotary, machine.rotary.len())?;
        let (points, axes) =
            released(py, || kinematics::forward(machine, &linear, &rotary, length))?;
        Ok((array(py, (linear.len(), 3), points)?, array(py, (linear.len(), 3), axes)?))
    }

    fn __repr__(&self) -> String {
        format!("<Machine {}: {}>", self.described.name, self.described.title)
    }
}

/// Load a machine.
///
/// Parameters
/// ----------
/// name_or_path : str or os.PathLike
///     Its name in the library, or a file ending in .toml.
/// **options
///     Other values for what stands in ``[options]`` of its file.
///
/// Returns
/// -------
/// Machine
///
/// Raises
/// ------
/// toolpost.Error
///     Where there is none (with the names that there are), its file has a mistake (with line and column), or
///     it has no such option.
#[pyfunction]
#[pyo3(signature = (name_or_path, /, **options))]
pub fn machine(
    py: Python<'_>,
    name_or_path: PathBuf,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Machine> {
    let name = text(name_or_path.clone());
    let mut described = released(py, || toolpath::machine(&name))?;
    for (name, value) in options.into_iter().flatten() {
        let value = match value.extract::<bool>() {
            Ok(flag) => flag.to_string(),
            Err(_) => value.str()?.to_string(),
        };
        described
            .set_option(&name.extract::<String>()?, &value)
            .map_err(|found| refused(py, *found))?;
    }
    Ok(Machine { described })
}

/// The machines of the library, in the order of their names.
///
/// Returns
/// -------
/// list of Machine
#[pyfunction]
pub fn library(py: Python<'_>) -> PyResult<Vec<Machine>> {
    let machines =
        released(py, || names(MACHINES).map(toolpath::machine).collect::<Result<Vec<_>, Stop>>())?;
    Ok(machines.into_iter().map(|described| Machine { described }).collect())
}
