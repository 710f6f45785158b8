//! Cutting by wire.

use crate::arguments::{text, word};
use crate::error::{class, raised, refused, released};
use crate::machine::Machine;
use crate::posting::{reported, tolerances};
use ::wire::cutting::{Cutting, Side};
use ::wire::plan::Trims;
use ::wire::taper::Rounding;
use ::wire::{Lead, LeadShape};
use app::wire::{Settings, Sync, make};
use app::{Origin, Source, Verdict};
use geom::Vec2;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::{Path, PathBuf};

/// Write the program of a wire-EDM machine for a contour, and prove it: what is not proven is not given out.
///
/// Lengths are mm. The keywords are the options of the command ``toolpost wire``, with its meanings and defaults
/// (``docs/wire.md``).
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     The contour: a drawing (.dxf), cutter-location data, or with ``control`` an NC program.
/// machine : Machine
///     The wire-EDM machine.
/// control : str or os.PathLike, optional
///     What an NC program was written for.
/// side : {"inside", "outside", "part", "left", "right"}, optional
///     On which side of the contours the wire runs; by default along the contours themselves.
/// wire, gap : float
///     Diameter of the wire, and spark gap of the last pass.
/// leave : sequence of float
///     What each pass but the last leaves for those after it.
/// trims : {"alternate", "repeat"}
///     Which way round the passes after the first go.
/// thread : sequence of tuples of 2 floats
///     Where the wire is threaded; one place for each contour.
/// lead, lead_arc : float, optional
///     How far from a contour the wire is threaded where ``thread`` does not say it; radius of the quarter circle by
///     which it comes to the contour.
/// begin : tuple of 2 floats, optional
///     The cut of a closed contour begins at the place nearest to this point.
/// tab : float, optional
///     How much of each closed contour holds the part until all else is cut.
/// taper : float, optional
///     How far the wire leans, degrees: the part larger at the top, or smaller where negative.
/// rounding : {"conical", "constant"}
///     What becomes of rounded corners on the way up.
/// by_control : bool
///     Let the control offset and lean the wire.
/// round_corners : bool
///     Let inner corners that the wire is too thick for become as round as the wire.
/// feed : sequence of float
///     Feeds, mm/s: one for all passes, or one for each.
/// upper : str or os.PathLike, optional
///     The upper contour; ``path`` is then the lower one.
/// sync : {"block", "length"}
///     Which point above belongs to which below.
/// height, uv_height : float, optional
///     Height of the part, and of the plane in which the machine counts U and V.
/// layers : sequence of str
///     Layers of a drawing that are read; all by default.
/// close : float
///     How far ends in a drawing that belong together may be apart.
/// step, chord_error : float, optional
///     One point every so many mm of arc, or as many points as keep this chord error.
/// fit : bool
///     As many points as the memory of the control holds.
/// memory : int, optional
///     How many points the control holds.
/// file : str, optional
///     Name of the program's file, for the report; by default that of ``path`` with the ending of the machine.
/// tolerance : float, optional
///     Largest distance from the contour; by default what the resolution of the program's words explains.
/// strict : bool
///     Take every warning about the source as an error.
///
/// Returns
/// -------
/// Result
///     The program and its report.
///
/// Raises
/// ------
/// toolpost.Error
///     Where there is no program; or it is not proven, with its :attr:`~toolpost.Error.report`.
#[pyfunction]
#[pyo3(signature = (path, machine, control=None, *, side=None, wire=0.0, gap=0.0, leave=Vec::new(), trims="alternate",
                    thread=Vec::new(), lead=0.0, lead_arc=None, begin=None, tab=None, taper=None, rounding="conical",
                    by_control=false, round_corners=false, feed=Vec::new(), upper=None, sync="block", height=None,
                    uv_height=None, layers=Vec::new(), close=0.01, step=None, chord_error=None, fit=false, memory=None,
                    file=None, tolerance=None, strict=false))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn wire<'py>(
    py: Python<'py>,
    path: PathBuf,
    machine: &Machine,
    control: Option<PathBuf>,
    side: Option<&str>,
    wire: f64,
    gap: f64,
    leave: Vec<f64>,
    trims: &str,
    thread: Vec<[f64; 2]>,
    lead: f64,
    lead_arc: Option<f64>,
    begin: Option<[f64; 2]>,
    tab: Option<f64>,
    taper: Option<f64>,
    rounding: &str,
    by_control: bool,
    round_corners: bool,
    feed: Vec<f64>,
    upper: Option<PathBuf>,
    sync: &str,
    height: Option<f64>,
    uv_height: Option<f64>,
    layers: Vec<String>,
    close: f64,
    step: Option<f64>,
    chord_error: Option<f64>,
    fit: bool,
    memory: Option<usize>,
    file: Option<String>,
    tolerance: Option<f64>,
    strict: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let sides = [
        ("inside", Side::Inside),
        ("outside", Side::Outside),
        ("part", Side::Part),
        ("left", Side::Left),
        ("right", Side::Right),
    ];
    let ways = [("alternate", Trims::Alternate), ("repeat", Trims::Repeat)];
    let corners = [("conical", Rounding::Conical), ("constant", Rounding::Constant)];
    let cutting = Cutting {
        side: side.map(|given| word(py, "side", given, &sides)).transpose()?,
        wire,
        gap,
        leave,
        trims: word(py, "trims", trims, &ways)?,
        thread: thread.into_iter().map(Vec2::from_array).collect(),
        lead: Lead { length: lead, shape: lead_arc.map_or(LeadShape::Straight, LeadShape::Arc) },
        begin: begin.map(Vec2::from_array),
        tab,
        taper,
        rounding: word(py, "rounding", rounding, &corners)?,
        by_control,
        round_corners,
        feeds: feed,
    };
    let step = app::wire::step(step, chord_error, fit).map_err(|found| refused(py, *found))?;
    let settings = Settings {
        layers,
        close,
        upper: upper.map(Source::File),
        sync: word(py, "sync", sync, &[("block", Sync::Block), ("length", Sync::Length)])?,
        height,
        uv_height,
        cutting,
        step,
        memory,
        ..Settings::default()
    };
    let origin = Origin { from: control.map(text), ..Origin::default() };
    let (source, machine) = (Source::File(path), &machine.described);
    let file = file.unwrap_or_else(|| {
        let name = source.path().with_extension(&machine.extension);
        app::files::name(&name)
    });
    let tolerances = tolerances(py, tolerance)?;
    let made = released(py, || {
        make(&source, strict, &origin, machine.clone(), &settings, &file, &tolerances, &())
    })?;
    let account = &made.posted.account;
    let report = reported(py, account, &made.report())?;
    if account.verdict != Verdict::Done {
        let error = raised(py, &account.findings);
        error.value(py).setattr("report", report)?;
        return Err(error);
    }
    let read = made.toolpath.files().into_iter().map(Path::to_owned);
    let inputs: Vec<PathBuf> = read.chain(machine.loaded_from.files.iter().cloned()).collect();
    class(py, "Result")?.call1((PyBytes::new(py, &made.posted.text), report, inputs))
}
