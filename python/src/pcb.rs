//! Making circuit boards.

use crate::arguments::word;
use crate::board::Board;
use crate::error::{class, raised, released};
use crate::machine::Machine;
use crate::posting::{reported, tolerances};
use ::pcb::board::Face;
use ::pcb::excellon::Unit;
use ::pcb::isolation::{Direction, Narrow};
use ::pcb::plan::{
    Clearing, Drilling, Isolate, Isolation, Outline, Part, Placing, Running, Settings, Turn,
};
use app::pcb::Job;
use app::{Source, Stop, Verdict, files};
use drawing::Format;
use geom::Vec2;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::path::{Path, PathBuf};

/// What board is meant.
#[derive(FromPyObject)]
pub enum Given<'py> {
    Built(PyRef<'py, Board>),
    Path(PathBuf),
    Paths(Vec<PathBuf>),
}

impl Given<'_> {
    fn sources(&self) -> Vec<Source> {
        match self {
            Given::Built(board) => {
                let (name, text) = (format!("{}.json", board.name()), board.text());
                vec![Source::memory(name, text.as_bytes())]
            }
            Given::Path(path) => vec![Source::File(path.clone())],
            Given::Paths(paths) => paths.iter().cloned().map(Source::File).collect(),
        }
    }
}

/// One width, or several.
#[derive(FromPyObject)]
pub enum Widths {
    One(f64),
    Many(Vec<f64>),
}

/// Write the programs that isolate, drill and cut out a circuit board, and prove them: where one is not proven, none is
/// given out.
///
/// Lengths are mm, feeds mm/min, speeds 1/min. The keywords are the options of the command ``toolpost pcb``, with its
/// meanings and defaults (``docs/pcb.md``).
///
/// Parameters
/// ----------
/// board : Board, str, os.PathLike or sequence of those paths
///     A board that was built; or a folder of Gerber and Excellon files, such files, a board of KiCad (.kicad_pcb), a
///     board of nodes, tracks and pads (.toml, .json).
/// machine : Machine
///     The mill.
/// only : sequence of str
///     What to make: ``front``, ``back``, ``drill``, ``outline``, ``front-mask``, ``back-mask``, ``front-legend``,
///     ``back-legend``; by default all that the board has and that tools are given for.
/// unit : {"mm", "inch"}, optional
///     The unit of drill files that do not say it.
/// tool : float or sequence of float, optional
///     Width of the end mill that cuts around copper; of several the widest first, each as far as it goes in.
/// vee : float, optional
///     Angle of a V-bit that does it, degrees.
/// tip, depth, step, passes, isolation_width, overlap, direction, narrow, isolate, invert
///     How copper is isolated; ``direction`` is ``climb`` or ``conventional``, ``narrow`` is ``bite``,
///     ``leave-out`` or ``middle``, ``isolate`` is ``contours``, ``middle`` or ``lines``.
/// clear, margin, mask_tool, legend_tool, engrave
///     What else is cut of copper, mask and legend.
/// drills, drill_tolerance, hole_mill, mill_holes_over, peck, from_side
///     How holes are made, from ``front`` or ``back``.
/// outline_tool, outline_step, tabs, tab_at, tab_width, tab_height, close_gaps, board_margin, rectangular
///     How the board is cut out; ``tab_at`` are places of tabs, gaps of its edge up to ``close_gaps`` are closed, and with
///     ``board_margin`` a board without an edge is a rectangle.
/// thickness, through, rotate, corner, as_drawn, turn, alignment, panel, spacing
///     Where the board lies; it is turned over about a line along ``y`` or ``x``; ``panel`` is columns and rows.
/// feed, plunge, drill_feed, outline_feed, speed, travel, approach, spin_up
///     How the machine runs.
/// text_before, text_after : sequence of str
///     Blocks of the control behind the machine's own beginning and before its end.
/// probe : tuple of 2 ints, optional
///     Columns and rows of the places at which the height of the board is measured.
/// on_control : bool
///     Let the programs that cut copper measure these heights themselves, and follow them.
/// split_tools : bool
///     Write a program for each tool, so that none changes tools.
/// heights : str or os.PathLike, optional
///     Measured heights that the programs follow.
/// picture : {"svg", "png"}, optional
///     How a picture is drawn next to each program; by default not at all.
/// tolerance : float, optional
///     Largest distance of the tool tip; by default what the resolution of the program's words explains.
/// strict : bool
///     Take every warning about the board as an error.
///
/// Returns
/// -------
/// BoardResult
///     The programs in the order in which they are run, and one report.
///
/// Raises
/// ------
/// toolpost.Error
///     Where there are no programs; or one is not proven, with its :attr:`~toolpost.Error.report`.
#[pyfunction]
#[pyo3(signature = (board, machine, *, only=Vec::new(), unit=None, tool=None, vee=None, tip=0.1, depth=0.1, step=None, passes=1,
                    isolation_width=None, overlap=0.25, direction="climb", narrow="bite", isolate="contours", invert=false, clear=Vec::new(), margin=0.0,
                    mask_tool=None, legend_tool=None, engrave=0.05, drills=Vec::new(), drill_tolerance=0.05,
                    hole_mill=None, mill_holes_over=None, peck=None, from_side="front", outline_tool=2.0, outline_step=0.5, tabs=4,
                    tab_at=Vec::new(), tab_width=2.0, tab_height=0.6, close_gaps=0.3, board_margin=None, rectangular=false,
                    thickness=1.6, through=0.2, rotate=0.0, corner=None,
                    as_drawn=false, turn="y",
                    alignment=None, panel=None, spacing=4.0, feed=200.0, plunge=60.0, drill_feed=100.0,
                    outline_feed=150.0, speed=None, travel=2.0, approach=0.5, spin_up=None, text_before=Vec::new(),
                    text_after=Vec::new(), probe=None, on_control=false, split_tools=false,
                    heights=None,
                    picture=None, tolerance=None, strict=false))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn pcb<'py>(
    py: Python<'py>,
    board: Given<'py>,
    machine: &Machine,
    only: Vec<String>,
    unit: Option<&str>,
    tool: Option<Widths>,
    vee: Option<f64>,
    tip: f64,
    depth: f64,
    step: Option<f64>,
    passes: u32,
    isolation_width: Option<f64>,
    overlap: f64,
    direction: &str,
    narrow: &str,
    isolate: &str,
    invert: bool,
    clear: Vec<f64>,
    margin: f64,
    mask_tool: Option<f64>,
    legend_tool: Option<f64>,
    engrave: f64,
    drills: Vec<f64>,
    drill_tolerance: f64,
    hole_mill: Option<f64>,
    mill_holes_over: Option<f64>,
    peck: Option<f64>,
    from_side: &str,
    outline_tool: f64,
    outline_step: f64,
    tabs: u32,
    tab_at: Vec<[f64; 2]>,
    tab_width: f64,
    tab_height: f64,
    close_gaps: f64,
    board_margin: Option<f64>,
    rectangular: bool,
    thickness: f64,
    through: f64,
    rotate: f64,
    corner: Option<[f64; 2]>,
    as_drawn: bool,
    turn: &str,
    alignment: Option<f64>,
    panel: Option<[u32; 2]>,
    spacing: f64,
    feed: f64,
    plunge: f64,
    drill_feed: f64,
    outline_feed: f64,
    speed: Option<f64>,
    travel: f64,
    approach: f64,
    spin_up: Option<f64>,
    text_before: Vec<String>,
    text_after: Vec<String>,
    probe: Option<[u32; 2]>,
    on_control: bool,
    split_tools: bool,
    heights: Option<PathBuf>,
    picture: Option<&str>,
    tolerance: Option<f64>,
    strict: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let parts = Part::ALL.map(|part| (part.name(), part));
    let only = only.iter().map(|given| word(py, "only", given, &parts)).collect::<PyResult<_>>()?;
    let directions = [("climb", Direction::Climb), ("conventional", Direction::Conventional)];
    let gaps =
        [("bite", Narrow::Bite), ("leave-out", Narrow::LeaveOut), ("middle", Narrow::Middle)];
    let cuts =
        [("contours", Isolate::Contours), ("middle", Isolate::Middle), ("lines", Isolate::Lines)];
    let units = [("mm", Unit::Metric), ("inch", Unit::Inch)];
    let mut wider = match tool {
        None => Vec::new(),
        Some(Widths::One(width)) => vec![width],
        Some(Widths::Many(widths)) => widths,
    };
    let tool = wider.pop();
    let settings = Settings {
        only,
        unit: unit.map(|given| word(py, "unit", given, &units)).transpose()?,
        isolation: Isolation {
            wider,
            tool,
            vee,
            tip,
            depth,
            step,
            passes,
            isolation_width,
            overlap,
            direction: word(py, "direction", direction, &directions)?,
            narrow: word(py, "narrow", narrow, &gaps)?,
            isolate: word(py, "isolate", isolate, &cuts)?,
            invert,
        },
        clearing: Clearing { clear, margin, mask_tool, legend_tool, engrave },
        drilling: Drilling {
            drills,
            drill_tolerance,
            hole_mill,
            mill_holes_over,
            peck,
            from: word(
                py,
                "from_side",
                from_side,
                &[("front", Face::Front), ("back", Face::Back)],
            )?,
        },
        outline: Outline {
            outline_tool,
            outline_step,
            tabs,
            tab_at: tab_at.into_iter().map(Vec2::from_array).collect(),
            tab_width,
            tab_height,
            close_gaps,
            board_margin,
            rectangular,
        },
        placing: Placing {
            thickness,
            through,
            rotate,
            corner: corner.map(Vec2::from_array),
            as_drawn,
            turn: word(py, "turn", turn, &[("y", Turn::Y), ("x", Turn::X)])?,
            alignment,
            panel,
            spacing,
        },
        running: Running {
            feed,
            plunge,
            drill_feed,
            outline_feed,
            speed,
            travel,
            approach,
            spin_up,
            text: [text_before, text_after].map(|blocks| blocks.join("\n")),
            probe,
            on_control,
            split_tools,
        },
    };
    let formats = [("svg", Format::Svg), ("png", Format::Png)];
    let picture = picture.map(|given| word(py, "picture", given, &formats)).transpose()?;
    let (sources, tolerances) = (board.sources(), tolerances(py, tolerance)?);
    let (machine, surface) = (&machine.described, heights.map(Source::File));
    let (account, contents, order, inputs) = released(py, || {
        let mut job = Job::new(machine, &settings, &tolerances)?;
        (job.surface, job.picture, job.strict) = (surface, picture, strict);
        let made = job.make(&sources, &())?;
        let account = made.account(&job, Vec::new());
        let report = format!("{:#}\n", account.data);
        let contents = made.contents(&job, &report).into_iter();
        let contents: Vec<_> = contents.map(|(name, bytes)| (name, bytes.to_vec())).collect();
        let order: Vec<String> = made.programs.iter().map(|made| made.file.clone()).collect();
        let read = made.files.iter().filter_map(Source::file).map(Path::to_owned);
        let inputs: Vec<PathBuf> = read.chain(machine.loaded_from.files.iter().cloned()).collect();
        Ok::<_, Stop>((account, contents, order, inputs))
    })?;
    let report = reported(py, &account, &format!("{:#}\n", account.data))?;
    if !matches!(account.verdict, Verdict::Done | Verdict::Partly) {
        let error = raised(py, &account.findings);
        error.value(py).setattr("report", report)?;
        return Err(error);
    }
    let files = PyDict::new(py);
    for (name, bytes) in &contents {
        files.set_item(name, PyBytes::new(py, bytes))?;
    }
    class(py, "BoardResult")?.call1((files, order, report, inputs))
}

/// Save files in a folder, all or none, and over none of those that they were made of.
#[pyfunction]
pub fn save_in(
    py: Python<'_>,
    folder: PathBuf,
    contents: Vec<(String, Vec<u8>)>,
    inputs: Vec<PathBuf>,
) -> PyResult<()> {
    released(py, || {
        let contents: Vec<(String, &[u8])> =
            contents.iter().map(|(name, bytes)| (name.clone(), &bytes[..])).collect();
        let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
        files::save_in(&folder, &contents, &inputs)
    })
}
