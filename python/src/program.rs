//! A program: read from a file, or built.

use crate::arguments::{JobText, number, text, word};
use crate::builder::Builder;
use crate::columns::{Columns, Filled};
use crate::error::{findings, released};
use crate::machine::Machine;
use crate::record::Record;
use app::Stop;
use app::toolpath::{self, Toolpath};
use app::{Origin, Source};
use control::{Units, WholeNumbers};
use geom::Vec3;
use numpy::{PyArray1, PyArray2};
use program::CompensatedPath;
use program::Purpose;
use program::statistics::Statistics;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyList, PySlice, PyTuple};
use source::apt::Csys;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A program in the neutral vocabulary: a sequence of records, and its moves as NumPy arrays.
///
/// Points are tool tips in mm, axes are unit vectors from the tip towards the spindle, both in the work
/// frame. :func:`toolpost.read` reads one, :meth:`Program.builder` builds one; none ever changes.
///
/// The arrays have one row for each move (see :attr:`kinds`). They are made at the first use of any of
/// them; from then on every access gives the same memory, without copying. They are read-only, and outlive
/// the program.
#[pyclass(frozen, sequence, module = "toolpost")]
pub struct Program {
    pub toolpath: Toolpath,
    columns: PyOnceLock<Columns>,
}

impl From<Toolpath> for Program {
    fn from(toolpath: Toolpath) -> Program {
        Program { toolpath, columns: PyOnceLock::new() }
    }
}

impl Program {
    fn columns(&self, py: Python<'_>) -> PyResult<&Columns> {
        self.columns.get_or_try_init(py, || {
            let filled = released(py, || Ok::<_, Stop>(Filled::of(&self.toolpath.program)))?;
            filled.hand_over(py)
        })
    }
}

#[pymethods]
impl Program {
    /// A builder for a program of this name.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     What the program is called; the name of its file follows from it.
    #[staticmethod]
    #[pyo3(signature = (name = "part"))]
    fn builder(name: &str) -> Builder {
        Builder::new(name)
    }

    /// What the program is called.
    #[getter]
    fn name(&self) -> &str {
        &self.toolpath.program.name
    }

    /// Name of the file that it was read from; its own name where it was built.
    #[getter]
    fn file(&self) -> &str {
        &self.toolpath.file
    }

    /// The CAM system whose habits the file has, or the control that it was written for.
    #[getter]
    fn dialect(&self) -> &str {
        &self.toolpath.dialect
    }

    /// What the reader could not pass on, or had to assume: a tuple of :class:`toolpost.Finding`.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        findings(py, &self.toolpath.warnings)
    }

    /// Tool tips at the ends of the moves: float64, shape (moves, 3), mm; of a hole, the point of the cycle
    /// on the surface.
    #[getter]
    fn positions(&self, py: Python<'_>) -> PyResult<Py<PyArray2<f64>>> {
        Ok(self.columns(py)?.positions.clone_ref(py))
    }

    /// Tool axes at the ends of the moves: float64, shape (moves, 3), unit vectors.
    #[getter]
    fn axes(&self, py: Python<'_>) -> PyResult<Py<PyArray2<f64>>> {
        Ok(self.columns(py)?.axes.clone_ref(py))
    }

    /// Feeds of the moves: float64, shape (moves,), mm/min; NaN for a rapid, a thread, and a feed that is
    /// not given in mm/min.
    #[getter]
    fn feeds(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        Ok(self.columns(py)?.feeds.clone_ref(py))
    }

    /// Lines of the source: uint32, shape (moves,), from 1.
    #[getter]
    fn lines(&self, py: Python<'_>) -> PyResult<Py<PyArray1<u32>>> {
        Ok(self.columns(py)?.lines.clone_ref(py))
    }

    /// What the moves are: uint8, shape (moves,), values of :class:`toolpost.Kind`.
    #[getter]
    fn kinds(&self, py: Python<'_>) -> PyResult<Py<PyArray1<u8>>> {
        Ok(self.columns(py)?.kinds.clone_ref(py))
    }

    /// Where the moves are among the records: uint64, shape (moves,), from 0.
    #[getter]
    fn records(&self, py: Python<'_>) -> PyResult<Py<PyArray1<u64>>> {
        Ok(self.columns(py)?.records.clone_ref(py))
    }

    /// What the program amounts to: counts of records, rapids, lines, arcs and holes, lengths in mm, the box
    /// of the tool tips.
    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = released(py, || Ok::<_, Stop>(Statistics::of(&self.toolpath.program)))?;
        let counts = PyDict::new(py);
        counts.set_item("records", found.records)?;
        counts.set_item("rapids", found.rapids)?;
        counts.set_item("lines", found.lines)?;
        counts.set_item("arcs", found.arcs)?;
        counts.set_item("holes", found.holes)?;
        counts.set_item("tools", found.tools)?;
        counts.set_item("cutting_length", found.cutting_length)?;
        counts.set_item("rapid_length", found.rapid_length)?;
        counts.set_item("low", found.low)?;
        counts.set_item("high", found.high)?;
        counts.set_item("tilted", found.tilted)?;
        Ok(counts)
    }

    /// The path of the tool as an SVG drawing.
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let Toolpath { file, program, .. } = &self.toolpath;
        released(py, || Ok::<_, Stop>(drawing::tool_path(file, program)))
    }

    fn _repr_svg_(&self, py: Python<'_>) -> PyResult<String> {
        self.svg(py)
    }

    fn __len__(&self) -> usize {
        self.toolpath.program.records.len()
    }

    /// A record, counted from 0 or, where negative, from the end; or the records of a slice.
    fn __getitem__<'py>(&self, py: Python<'py>, index: Index<'py>) -> PyResult<Bound<'py, PyAny>> {
        let records = &self.toolpath.program.records;
        let record = |place: isize| {
            let place = usize::try_from(place).ok();
            let found = place.and_then(|place| records.get(place));
            let beyond =
                || PyIndexError::new_err(format!("the program has {} records", records.len()));
            Bound::new(py, Record::new(py, found.ok_or_else(beyond)?)?)
        };
        let count = isize::try_from(records.len())?;
        match index {
            Index::One(index) if index < 0 => Ok(record(index + count)?.into_any()),
            Index::One(index) => Ok(record(index)?.into_any()),
            Index::Slice(slice) => {
                let slice = slice.indices(count)?;
                let places = (0..slice.slicelength).scan(slice.start, |next, _| {
                    let place = *next;
                    *next += slice.step;
                    Some(place)
                });
                let found: PyResult<Vec<_>> = places.map(record).collect();
                Ok(PyList::new(py, found?)?.into_any())
            }
        }
    }

    fn __iter__(slf: Py<Self>) -> Records {
        Records { program: slf, next: AtomicUsize::new(0) }
    }

    fn __repr__(&self) -> String {
        let Toolpath { file, dialect, program, .. } = &self.toolpath;
        format!("<Program {file} ({dialect}): {} records>", program.records.len())
    }
}

/// What stands between the brackets of `program[...]`.
#[derive(FromPyObject)]
enum Index<'py> {
    One(isize),
    Slice(Bound<'py, PySlice>),
}

/// The records of a program, one after the other.
#[pyclass(frozen)]
struct Records {
    program: Py<Program>,
    next: AtomicUsize,
}

#[pymethods]
impl Records {
    fn __iter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Record>> {
        let next = self.next.fetch_add(1, Ordering::Relaxed);
        let records = &self.program.get().toolpath.program.records;
        records.get(next).map(|record| Record::new(py, record)).transpose()
    }
}

/// Read a toolpath from a file: cutter-location data (APT), a job of FreeCAD, or with ``control`` an NC
/// program.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     The file.
/// control : str or os.PathLike, optional
///     What an NC program was written for: a control or a machine of the library by its name, or a file
///     ending in .toml. A program with rotary axes needs its machine; so does a job with words for them.
/// tools : str or os.PathLike, optional
///     Tool table in LinuxCNC's format: with it cutter radius compensation becomes the path of the tool's
///     centre.
/// folders : sequence of str or os.PathLike
///     Where called programs are looked for, in this order; nothing outside them is opened.
/// whole_numbers : {"units", "increments"}, optional
///     What a length without a decimal point counts on a control that can be set either way.
/// units : {"mm", "inch"}, optional
///     What lengths count before the program says it.
/// block_delete : bool
///     Skip the blocks that begin with ``/``.
/// start : tuple of 3 floats, optional
///     Where the tool stands when the program starts, mm.
/// aside : {"+X", "-X", "+Y", "-Y"}, optional
///     Which way a boring bar goes from the wall of a hole, where the machine is set to it.
/// csys : {'local', 'world'}, optional
///     Where the coordinates behind a ``CSYS`` of SolidWorks CAM stand; by default in the world, where the file says
///     ``TRNTYP/WORLD``.
/// cutcom : {'centre', 'contour'}, optional
///     Which path the coordinates behind ``CUTCOM`` are; by default what an arc in the file shows.
/// strict : bool
///     Take every warning as an error.
///
/// Returns
/// -------
/// Program
///
/// Raises
/// ------
/// toolpost.Error
///     With everything that is wrong with the file, each with line, column, rule and way out. There is never
///     a part of a program.
///
/// Notes
/// -----
/// What each format means, with sources: ``docs/sources/apt.md``, ``docs/controls``.
#[pyfunction]
#[pyo3(signature = (path, control=None, *, tools=None, folders=Vec::new(), whole_numbers=None, units=None,
                    block_delete=false, start=None, aside=None, csys=None, cutcom=None, strict=false))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn read(
    py: Python<'_>,
    path: PathBuf,
    control: Option<PathBuf>,
    tools: Option<PathBuf>,
    folders: Vec<PathBuf>,
    whole_numbers: Option<&str>,
    units: Option<&str>,
    block_delete: bool,
    start: Option<[f64; 3]>,
    aside: Option<&str>,
    csys: Option<&str>,
    cutcom: Option<&str>,
    strict: bool,
) -> PyResult<Program> {
    let frames = [("local", Csys::Local), ("world", Csys::World)];
    let paths = [("centre", CompensatedPath::Center), ("contour", CompensatedPath::Contour)];
    let counts = [("units", WholeNumbers::Units), ("increments", WholeNumbers::Increments)];
    let ways = [("+X", Vec3::X), ("-X", Vec3::NEG_X), ("+Y", Vec3::Y), ("-Y", Vec3::NEG_Y)];
    let lengths = [("mm", Units::Millimeters), ("inch", Units::Inches)];
    for coordinate in start.into_iter().flatten() {
        number(py, "a coordinate of the start", coordinate)?;
    }
    let origin = Origin {
        from: control.map(text),
        tools: tools.map(Source::File),
        folders,
        whole_numbers: whole_numbers
            .map(|given| word(py, "whole_numbers", given, &counts))
            .transpose()?
            .unwrap_or_default(),
        units: units.map(|given| word(py, "units", given, &lengths)).transpose()?,
        block_delete,
        start: start.map(Vec3::from_array),
        aside: aside.map(|given| word(py, "aside", given, &ways)).transpose()?,
        csys: csys.map(|given| word(py, "csys", given, &frames)).transpose()?,
        cutcom: cutcom.map(|given| word(py, "cutcom", given, &paths)).transpose()?,
        ..Origin::default()
    };
    let source = Source::File(path);
    released(py, || toolpath::read(&source, strict, &origin, None, Purpose::Program))
        .map(Program::from)
}

/// Read a job of FreeCAD.
///
/// Parameters
/// ----------
/// job : dict, str or bytes
///     The job (``docs/sources/freecad.md``) as a dictionary or as JSON, or FreeCAD's own dump of its commands.
/// machine : Machine, optional
///     Whose rotary axes the words A, B and C are; without one there are three axes.
/// file : str
///     What the job is called in findings.
/// strict : bool
///     Take every warning as an error.
///
/// Returns
/// -------
/// Program
///
/// Raises
/// ------
/// toolpost.Error
///     What is wrong with the job, with the operation and the number of its command.
#[pyfunction]
#[pyo3(signature = (job, machine=None, *, file="job.json", strict=false))]
pub fn read_job(
    py: Python<'_>,
    job: JobText<'_>,
    machine: Option<&Machine>,
    file: &str,
    strict: bool,
) -> PyResult<Program> {
    let machine = machine.map(|machine| &machine.described);
    let job = job.job(py, file)?;
    released(py, || toolpath::read_job(file, job, strict, machine, Purpose::Program))
        .map(Program::from)
}
