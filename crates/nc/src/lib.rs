//! NC programs as a source: the events of a virtual control become a neutral program.
//!
//! The crate promises that every pose of the neutral program is complete and in the work frame, or that the program is
//! refused with its line. The events of a control have positions of rotary axes, coordinates that are not known yet, and
//! axes sent home. Only this crate converts them:
//!
//! - Rotary positions become a tool axis by the kinematics of the machine that the program was
//!   written for.
//! - A rapid whose end is not known in every coordinate waits for the next ones, as after a reference
//!   return: `X10 Y20`, then `Z5`, is one rapid to a known position. A cut from a position that is not known is refused.
//! - Z sent home between two moves stays, as [`Op::Home`]. At a tool change and at the end it is left out: a
//!   writer brings the tool home there by itself.
//! - A change of the work offset stays; the tool comes to its first position in it from above.
//! - A length offset becomes the register of the tool; a tool that is called by its name gets a number,
//!   and one of the tool table its diameter and length.
//!
//! Lengths are mm in the work frame, feeds mm/min, times s, angles of rotary axes degrees. The same text, machine and set-up
//! give the same program.
//!
//! ```
//! use control::Setup;
//! use program::{Op, Purpose};
//! use toolpost_nc as nc;
//!
//! let machine = machine::load("generic-3axis-linuxcnc").unwrap();
//! let setup = Setup { purpose: Purpose::Contour, ..Setup::default() };
//! let text = b"G21 G90 G17\nG0 X0. Y0. Z5.\nG1 Z-1. F100.\nX10.\nM30\n";
//! let program = nc::read(&machine, setup, "slot.ngc", text).unwrap().program;
//! let ends = program.records.iter().filter_map(|record| record.op.pose());
//! let ends: Vec<[f64; 3]> = ends.map(|pose| pose.point().to_array()).collect();
//! assert_eq!(ends, [[0.0, 0.0, 5.0], [0.0, 0.0, -1.0], [10.0, 0.0, -1.0]]);
//! ```
//!
//! It never guesses: a coordinate, a tool length or a unit that the program does not give is refused or asked for, and it does
//! not parse NC text itself (`control` does).

#![deny(clippy::wildcard_enum_match_arm)]

use control::{
    Action, Dialect, Ending, Event, FeedPath, Orientation, Position, Risk, Settings, Setup,
    TableAxis, Wire,
};
use geom::{Arc, Vec3};
use machine::{LengthOffset, Machine, Mount, RotaryFeed};
use program::{
    ArcTo, Axes, Circle, CompensatedPath, Cycle, Diagnostic, Feed, MachineMove, Op, Outcome, Pose,
    Probe, Program, Record, Rule, Severity, Spindle, Thread, Tool, WorkOffset,
};
use std::collections::{BTreeSet, HashMap};

/// Most records of a reading, which are kept in memory: a program of a few lines can loop to more.
const MOST_RECORDS: usize = 20_000_000;

/// The farthest place, mm, as in cutter-location data.
const FARTHEST: f64 = 1e6;

/// The farthest centre of an arc, mm: one that is nearly straight has a far one.
const FARTHEST_CENTER: f64 = 1e9;

/// The largest feed, speed (1/min) and dwell (s).
const LARGEST: f64 = 1e9;

/// The most points of one rapid in a picture.
const MOST_PLACES: f64 = 1440.0;

/// What was read.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// What the program does.
    pub program: Program,
    /// What is worth knowing, with lines.
    pub warnings: Vec<Diagnostic>,
}

/// Adds a record to those before it; the last argument says whether the program has worked in several work offsets so far.
/// It may delay records, but no tool of a source that has length offsets: these correct the last tool.
pub type Sink<'a> = dyn FnMut(&mut Vec<Record>, Record, bool) + 'a;

/// The settings of the virtual control of `machine`, with what the operator has set up.
///
/// # Errors
/// `reader` where there is no control of the name that the machine file gives.
pub fn settings(machine: &Machine, setup: Setup) -> Outcome<Settings> {
    let Some(dialect) = Dialect::named(&machine.reader) else {
        let message = format!("there is no virtual control `{}`", machine.reader);
        let names = Dialect::NAMES.map(|(name, _)| name).join(", ");
        let place = &machine.reader_place;
        return Err(Diagnostic::error(Rule::Reader, message)
            .help(format!("`reader` is one of {names}"))
            .file(&place.file)
            .line(place.line)
            .into());
    };
    Ok(settings_in(dialect, machine, setup))
}

/// Where the table of `machine` turns, as its control has measured it; `None` where the file does not say it.
fn table_axes(machine: &Machine) -> Option<Vec<TableAxis>> {
    let zero = machine.work_zero?;
    let mut axes: Vec<TableAxis> = Vec::new();
    for axis in machine.rotary.iter().rev() {
        if axis.on != Mount::Table || !axis.is_placed {
            return None;
        }
        axes.push(TableAxis {
            index: axis.index(),
            point: axis.point - zero,
            axis: axis.axis * axis.sign,
            offset: axis.offset,
        });
    }
    Some(axes)
}

/// The settings of a virtual control with the axes of `machine` that reads `dialect`, as [`settings`].
pub fn settings_in(dialect: Dialect, machine: &Machine, setup: Setup) -> Settings {
    let (mut rotary, mut table, mut modulo) = ([false; 3], [false; 3], [None; 3]);
    for axis in &machine.rotary {
        rotary[axis.index()] = true;
        table[axis.index()] = axis.on == Mount::Table;
        modulo[axis.index()] = axis.modulo;
    }
    let clamps = machine.rotary.iter().filter_map(|axis| axis.clamp);
    let clamps = clamps.flat_map(|clamp| [clamp.open, clamp.close]);
    Settings {
        auxiliary: machine.auxiliary.iter().copied().chain(clamps).collect(),
        coolant: machine.coolant,
        modulo,
        floating_holder: machine.settings.floating_holder,
        retract_above_r: machine.settings.retract_above_r,
        length_along_z: machine.settings.length_along_z,
        length_moves_axis: machine.settings.length_moves_axis,
        dwell_p_milliseconds: machine.settings.dwell_p_milliseconds,
        rotary_by_sign: machine.settings.rotary_by_sign,
        table,
        table_axes: table_axes(machine),
        table_frame_at_zero: machine.settings.table_frame_at_zero,
        sets_work_offsets: machine.settings.sets_work_offsets,
        operator_parameters: machine.operator_parameters.clone(),
        tool_change: machine.cell.as_ref().map(|cell| cell.tool_change.clone()).unwrap_or_default(),
        own_frame: machine.cell.as_ref().and_then(|cell| cell.own_frame),
        signals: ["SIGNAL", "CHANNEL"]
            .map(|word| machine.words.get(word).map_or("", |word| word.address.trim()).to_owned()),
        wire: machine.wire.map_or(Wire::default(), |wire| Wire {
            height: wire.height,
            thread: wire.thread,
            cut: wire.cut,
        }),
        kinematics: machine
            .settings
            .kinematics
            .map(|k| control::Kinematics { tip: k.tip, axes: k.axes }),
        swivel_data: machine.swivel_data().to_owned(),
        path_tolerance: machine.path_tolerance(),
        orientation_tolerance: machine.orientation_tolerance(),
        setup,
        ..Settings::new(dialect, rotary)
    }
}

/// Along which path the control of `machine` counts the feed until a program states it. Where a parameter of the control
/// decides, the machine file may state it.
pub fn feed_path(machine: &Machine) -> FeedPath {
    feed_path_in(Dialect::named(&machine.reader), machine)
}

/// The same of a control that reads `dialect`.
fn feed_path_in(dialect: Option<Dialect>, machine: &Machine) -> FeedPath {
    let path = dialect.map_or(FeedPath::AsSetUp, Dialect::feed_path);
    match (path, machine.settings.rotary_feed) {
        (FeedPath::AsSetUp, Some(RotaryFeed::AllAxes)) => FeedPath::AllAxes,
        (FeedPath::AsSetUp, Some(RotaryFeed::LinearAxes)) => FeedPath::LinearAxes,
        (path, _) => path,
    }
}

/// Reads the NC program `text`, which was written for `machine`.
///
/// # Errors
/// The first block that the control does not understand, or that a neutral program cannot express,
/// with `file_name`, line and the way out.
pub fn read(machine: &Machine, setup: Setup, file_name: &str, text: &[u8]) -> Outcome<Reading> {
    let keep = &mut |records: &mut Vec<Record>, record, _| records.push(record);
    let settings = settings(machine, setup)?;
    let (mut reading, several) = read_by(machine, &settings, file_name, text, keep)?;
    let records = &mut reading.program.records;
    let is_offset = |record: &Record| matches!(record.op, Op::WorkOffset(_));
    // There is one at most: another one would be one of several.
    if !several && let Some(first) = records.iter().position(is_offset) {
        records.remove(first);
    }
    Ok(reading)
}

/// The same for a picture: a rapid that turns rotary axes without tool-centre control becomes several, so that the picture shows
/// the real path of the tip, with all axes moving together.
///
/// # Errors
/// As [`read`].
pub fn read_with_rapids_sampled(
    machine: &Machine,
    setup: Setup,
    file_name: &str,
    text: &[u8],
) -> Outcome<Program> {
    let settings = settings(machine, setup)?;
    let keep = &mut |records: &mut Vec<Record>, record, _| records.push(record);
    let mut conversion = Conversion::new(machine, &settings, file_name, keep);
    let mut before: Option<Position> = None;
    let run = control::read(&settings, file_name, text, &mut |event| {
        let line = event.line;
        let located = |found: Box<Diagnostic>| Box::new(found.line(line));
        if let (Action::Rapid(to), Some(from)) = (&event.action, before) {
            conversion.sample_rapid(line, &from, to).map_err(located)?;
        }
        before = event.action.position().copied().or(before);
        conversion.event(event).map_err(located)
    });
    run.map_err(way_out)?;
    Ok(conversion.program)
}

/// The same in the frame of the machine: the positions of X, Y and Z, in the coordinates of the work offset, mm. The work turns on
/// its table, so a straight line of the tool is no straight line of the axes.
///
/// # Errors
/// As [`read`]; `machine-frame` where only the control knows the positions of the axes.
pub fn read_in_machine(
    machine: &Machine,
    setup: Setup,
    file_name: &str,
    text: &[u8],
) -> Outcome<Program> {
    let settings = settings(machine, setup)?;
    let drop = &mut |_: &mut Vec<Record>, _, _| {};
    let mut conversion = Conversion::new(machine, &settings, file_name, drop);
    let mut program = Program::new(file_name);
    let mut before: Option<Position> = None;
    let run = control::read(&settings, file_name, text, &mut |event| {
        let (line, from) = (event.line, before);
        before = event.action.position().copied().or(before);
        if let Action::Tool(tool) = &event.action {
            program.push(line, Op::Tool(tool.clone()));
        }
        let is_rapid = matches!(event.action, Action::Rapid(_));
        let arc = if let Action::Arc(arc) = &event.action { Some(&**arc) } else { None };
        if let (Some(from), Some(to)) = (from, event.action.position()) {
            let length = conversion.tool.and_then(|(tool, _)| tool.length);
            for place in between(&from, to, arc) {
                let at = axes_at(machine, &place, length).map_err(|found| found.line(line))?;
                if let Ok(pose) = Pose::upright(at) {
                    program.push(line, if is_rapid { Op::Rapid(pose) } else { Op::Line(pose) });
                    // `event` looks at the number of records.
                    conversion.count += 1;
                }
            }
        }
        conversion.event(event).map_err(|found| found.line(line).into())
    });
    run.map_err(way_out)?;
    Ok(program)
}

/// Positions of a block between which the axes go nearly straight; the last is its end.
fn between(from: &Position, to: &Position, arc: Option<&control::ArcTo>) -> Vec<Position> {
    let arc = arc.and_then(|arc| {
        let ends = (from.point, arc.end.point);
        Arc::new(ends.0, ends.1, arc.center, arc.normal, arc.turns, f64::INFINITY).ok()
    });
    let followed = |position: &Position| {
        let Orientation::Rotary { degrees, tool_center: true } = position.orientation else {
            return None;
        };
        Some(degrees)
    };
    let turns = followed(from).zip(followed(to));
    let turn =
        turns.map_or(0.0, |(a, b)| (0..3).map(|i| f64::abs(b[i] - a[i])).fold(0.0, f64::max));
    let sweep = arc.map_or(0.0, |arc| arc.sweep.to_degrees() / 2.0);
    let places = turn.max(sweep).ceil().clamp(1.0, MOST_PLACES) as u32;
    let place = |i: u32| {
        let part = f64::from(i) / f64::from(places);
        let point = arc.map_or_else(|| from.point.lerp(to.point, part), |arc| arc.at(part));
        let orientation = match turns {
            Some((a, b)) => Orientation::Rotary {
                degrees: std::array::from_fn(|k| a[k] + (b[k] - a[k]) * part),
                tool_center: true,
            },
            None => to.orientation,
        };
        Position { point, orientation }
    };
    (1..=places).map(place).collect()
}

/// The positions of X, Y and Z, in the coordinates of the work offset, mm.
fn axes_at(machine: &Machine, position: &Position, length: Option<f64>) -> Outcome<Vec3> {
    match position.orientation {
        Orientation::Rotary { degrees, tool_center: true } => {
            Ok(machine.linear_for(position.point, degrees, length.unwrap_or(0.0)))
        }
        Orientation::Rotary { tool_center: false, .. } => Ok(position.point),
        Orientation::Axis(_) if machine.rotary.is_empty() => Ok(position.point),
        Orientation::Axis(_) => Err(refuse(
            Rule::MachineFrame,
            "only the control knows the positions of the axes along a vector or in a tilted plane",
            "draw it in the frame of the part: without `--frame machine`",
        )),
    }
}

/// The same by a control of these settings, with a function that receives each record. The second answer is whether the program works in more than the
/// first work offset; where it does not, the machine decides the offset, and the record of it does not belong to the program.
///
/// # Errors
/// As [`read`].
pub fn read_by(
    machine: &Machine,
    settings: &Settings,
    file_name: &str,
    text: &[u8],
    keep: &mut Sink,
) -> Outcome<(Reading, bool)> {
    let name = file_name.rsplit_once('.').map_or(file_name, |(stem, _)| stem);
    let mut conversion = Conversion::new(machine, settings, name, keep);
    let run = control::read(settings, file_name, text, &mut |event| {
        let line = event.line;
        conversion.event(event).map_err(|found| found.line(line).into())
    });
    run.map_err(way_out)?;
    let cut_off = cut_off(settings.dialect, conversion.ended, text);
    if let Some(mut found) = cut_off {
        if !settings.setup.purpose.asks_ends() {
            found.severity = Severity::Warning;
        }
        let lines = text.iter().filter(|byte| **byte == b'\n').count();
        let last = u32::try_from(lines).unwrap_or(u32::MAX).max(1);
        let found = found.file(file_name).line(last);
        if found.is_error() {
            return Err(found.into());
        }
        conversion.warnings.push(found);
    }
    let mut optional = control::optional_blocks(text);
    if let Some((line, _)) = optional.next() {
        let (done, other) = match settings.setup.block_delete {
            true => ("left out", "without it they run"),
            false => ("run", "`--block-delete` leaves them out"),
        };
        let message =
            format!("the blocks behind `/`, which the operator may switch off, are read as {done}");
        let mut found = Diagnostic::warning(Rule::BlockSkip, message).help(other).line(line);
        found.count += u32::try_from(optional.count()).unwrap_or(u32::MAX - 1);
        conversion.warnings.push(found);
    }
    Ok((Reading { program: conversion.program, warnings: conversion.warnings }, conversion.several))
}

/// The finding that the program in `text` is only the first part of one; `ended` is whether a code has ended it.
fn cut_off(dialect: Dialect, ended: bool, text: &[u8]) -> Option<Diagnostic> {
    const HELP: &str = "the file may be cut off: send it once more";
    if text.trim_ascii().is_empty() {
        let message = "the file is empty";
        return Some(Diagnostic::error(Rule::ProgramEnd, message).help(HELP));
    }
    let ending = dialect.ending();
    let has_percent = !matches!(dialect, Dialect::Klartext | Dialect::Grbl | Dialect::Marlin)
        && !matches!(dialect, Dialect::Sinumerik | Dialect::Sinumerik828d | Dialect::Source(_));
    let percent_signs = if has_percent { control::percent_signs(text) } else { 0 };
    if percent_signs == 1 {
        let message = "`%` opens the program, and none closes it";
        let found = if ended { Diagnostic::warning } else { Diagnostic::error };
        return Some(found(Rule::ProgramEnd, message).help(HELP));
    }
    if ended || ending == Ending::CodeOrPercent && percent_signs > 1 {
        return None;
    }
    let message = "the program has no end: M30 or M2 is missing";
    match ending {
        Ending::Code | Ending::CodeOrPercent => {
            Some(Diagnostic::error(Rule::ProgramEnd, message).help(HELP))
        }
        Ending::CodeOrText => Some(Diagnostic::warning(Rule::ProgramEnd, message).help(HELP)),
        Ending::Text => None,
    }
}

/// Adds to what a control refuses what the user of a source can do about it.
fn way_out(mut found: Box<Diagnostic>) -> Box<Diagnostic> {
    if found.rule == Rule::UnknownPosition {
        found.help_too("or give the position of the tool at the start");
    }
    found
}

/// The conversion of the events of a control into a neutral program.
struct Conversion<'a> {
    machine: &'a Machine,
    /// The program is what a CAM system keeps, and no control reads it.
    is_source: bool,
    setup: &'a Setup,
    program: Program,
    keep: &'a mut Sink<'a>,
    /// How many records there have been.
    count: usize,
    /// A code has ended the program.
    ended: bool,
    warnings: Vec<Diagnostic>,
    tool_at: ToolPosition,
    /// The position of the last block that moved, unless the axes have gone home since.
    position: Option<Position>,
    /// The active feed, what it counts, and the feed of the last record.
    feed: Option<Feed>,
    feed_path: FeedPath,
    written_feed: Option<Feed>,
    /// Z has been sent home since the last move, on this line.
    home: Option<u32>,
    /// The tool in the spindle, and whether nothing has moved since it was called.
    tool: Option<(Loaded, bool)>,
    /// The line on which the spindle has been emptied, and no tool has come since.
    emptied: Option<u32>,
    /// The cycle that withdraws from the wall, as the control has it, and the withdrawal at the last hole.
    boring: Option<(Cycle, Option<Vec3>)>,
    /// The work offset that the program names.
    work_offset: Option<WorkOffset>,
    /// Whether it works in more than the first.
    several: bool,
    /// Numbers of the tools that the program calls, with the names of those that it calls by name.
    numbers: HashMap<u32, String>,
    /// The numbers of those that it calls by name.
    named: HashMap<String, u32>,
    /// No number below this is free for a tool that is called by name.
    free_from: u32,
    /// The program has to call length offsets, since its control takes none with the tool.
    calls_lengths: bool,
    /// The register of the length offset that it has called last, also for another tool.
    length_offset: Option<u32>,
    /// Registers of the tools that are reported to cut without a length offset.
    bare: BTreeSet<u32>,
}

/// The tool in the spindle.
#[derive(Clone, Copy, Debug)]
struct Loaded {
    /// Register of its length offset.
    register: u32,
    /// Length, where it is known, mm.
    length: Option<f64>,
    /// Whether it has cut with the length offset of the register (`true`) or without any; it has not cut yet without
    /// a value.
    offset: Option<bool>,
}

/// A tool tip (mm) and a tool axis (unit vector) in the work frame; what is not known is NaN.
#[derive(Clone, Copy, Debug)]
struct PartialPose {
    tip: Vec3,
    axis: Vec3,
}

impl PartialPose {
    /// The same as a pose, where everything is known.
    fn complete(self) -> Option<Pose> {
        Pose::new(self.tip, self.axis).ok()
    }
}

/// The position of the tool, as far as the program determines it.
#[derive(Clone, Copy, Debug)]
enum ToolPosition {
    /// The given position at the start: a cut from there begins with a rapid to it.
    Start(PartialPose),
    /// The end of the last block.
    At(PartialPose),
    Unknown,
}

impl ToolPosition {
    fn pose(&self) -> Option<&PartialPose> {
        match self {
            ToolPosition::Start(pose) | ToolPosition::At(pose) => Some(pose),
            ToolPosition::Unknown => None,
        }
    }
}

impl<'a> Conversion<'a> {
    fn new(
        machine: &'a Machine,
        settings: &'a Settings,
        name: &str,
        keep: &'a mut Sink<'a>,
    ) -> Conversion<'a> {
        let is_source = matches!(settings.dialect, Dialect::Source(_));
        let registers = machine.capabilities.length_offset == LengthOffset::ToolNumber;
        Conversion {
            machine,
            is_source,
            setup: &settings.setup,
            program: Program {
                // What the control offsets is the contour.
                compensated_path: Some(CompensatedPath::Contour),
                ..Program::new(name)
            },
            keep,
            count: 0,
            ended: false,
            warnings: Vec::new(),
            tool_at: settings.setup.start.map_or(ToolPosition::Unknown, |tip| {
                ToolPosition::Start(PartialPose { tip, axis: Vec3::Z })
            }),
            position: None,
            feed: None,
            feed_path: feed_path_in(Some(settings.dialect), machine),
            written_feed: None,
            home: None,
            tool: None,
            emptied: None,
            boring: None,
            work_offset: None,
            several: false,
            numbers: HashMap::new(),
            named: HashMap::new(),
            free_from: 1,
            // The post calls the lengths of what a CAM system keeps.
            calls_lengths: registers && !is_source,
            length_offset: None,
            bare: BTreeSet::new(),
        }
    }

    fn event(&mut self, event: Event) -> Outcome {
        let line = event.line;
        if self.count >= MOST_RECORDS {
            let message = format!("the program makes more than {MOST_RECORDS} records");
            let help = "it may loop without end; if not, read it in parts";
            return Err(refuse(Rule::ProgramLength, message, help));
        }
        let position = event.action.position().copied();
        within_reach(&event.action)?;
        if self.moves_empty(&event.action)? {
            return Ok(());
        }
        if let (Action::Arc(_) | Action::Hole(_) | Action::Probe(_), Some(feed)) =
            (&event.action, self.feed)
        {
            self.say_feed(line, feed);
        }
        match event.action {
            Action::Rapid(position) => {
                let pose = self.partial_pose(&position);
                match pose.complete() {
                    Some(pose) => self.arrive(line, Op::Rapid(pose))?,
                    None => self.tool_at = ToolPosition::At(pose),
                }
            }
            Action::Line(position) if self.starts_a_picture(&position) => {
                let message = "where the tool comes from is not known: it is drawn from the end of this block on";
                self.warn_once(line, Diagnostic::warning(Rule::UnknownStart, message));
                let pose = self.partial_pose(&position);
                if let Some(pose) = pose.complete() {
                    self.arrive(line, Op::Rapid(pose))?;
                }
            }
            Action::Line(position) => {
                let pose = self.cut(&position)?;
                self.time_cut(line, &position);
                self.arrive(line, Op::Line(pose))?;
            }
            Action::Arc(arc) => {
                let arc = self.arc(&arc)?;
                self.arrive(line, Op::Arc(Box::new(arc)))?;
            }
            Action::Thread(thread) => {
                let end = self.cut(&thread.end)?;
                self.arrive(line, Op::Thread(Box::new(Thread::new(end, thread.pitch)?)))?;
            }
            Action::Probe(probe) => {
                let Probe { away, must_answer, place, .. } = *probe;
                let end = self.cut(&probe.end)?;
                let probe = Probe { end, away, must_answer, place };
                self.arrive(line, Op::Probe(Box::new(probe)))?;
                self.tool_at = ToolPosition::Unknown;
            }
            Action::Hole(position) => {
                let pose = self.partial_pose(&position);
                let withdrawal =
                    self.boring.as_ref().and_then(|(cycle, _)| cycle.kind.withdrawal());
                let aside = withdrawal.map(|withdrawal| {
                    let moved = Position { point: position.point + withdrawal.aside, ..position };
                    self.partial_pose(&moved).tip - pose.tip
                });
                let Some(pose) = pose.complete() else {
                    return Err(self.lost("a hole", &position, &pose));
                };
                self.bore(line, aside);
                self.arrive(line, Op::Hole(pose))?;
            }
            Action::Cycle(cycle) => {
                self.boring = cycle.kind.withdrawal().is_some().then_some((*cycle, None));
                if self.boring.is_none() {
                    self.push(line, Op::Cycle(cycle));
                }
            }
            Action::Home(axes) => {
                self.position = None;
                return self.go_home(line, axes);
            }
            Action::MachineMove(to) => {
                self.position = None;
                return self.machine_move(line, &to);
            }
            Action::Tool(tool) if tool.number == 0 && tool.name.is_empty() => {
                self.emptied = Some(line);
                let message = "the spindle is emptied (T0): the last tool stays in what is written from this, and moves without one are \
                               left out";
                self.warn_once(line, Diagnostic::warning(Rule::Tool, message));
            }
            Action::Tool(mut tool) => {
                self.emptied = None;
                self.number(line, &mut tool)?;
                if let Some(entry) = self.setup.tools.iter().find(|e| e.number == tool.number) {
                    tool.diameter = Some(2.0 * entry.radius);
                    tool.length = Some(entry.length);
                }
                self.home = None;
                let register = tool.offset.unwrap_or(tool.number);
                self.tool = Some((Loaded { register, length: tool.length, offset: None }, true));
                self.push(line, Op::Tool(tool));
            }
            Action::LengthOffset(register) => return self.length_offset(line, register),
            Action::WorkOffset(offset) => self.set_work_offset(line, offset),
            Action::WorkOffsetData(data) => self.push(line, Op::WorkOffsetData(data)),
            // The moves behind it say where the tool goes.
            Action::Swivel(_) => {}
            Action::Across(position) => {
                let nowhere = Position { point: Vec3::NAN, ..*position };
                self.tool_at = ToolPosition::At(self.partial_pose(&nowhere));
            }
            Action::CycleOff => self.push(line, Op::CycleOff),
            Action::Feed(feed) => {
                (self.feed, self.written_feed) = (Some(feed), Some(feed));
                self.push(line, Op::Feed(feed));
            }
            Action::FeedPath(path) => self.feed_path = path,
            // A rapid of a source has its ends only.
            Action::RapidsTogether(_) => {}
            Action::Spindle(spindle) => self.push(line, Op::Spindle(spindle)),
            Action::SurfaceSpeed(speed) => self.push(line, Op::SurfaceSpeed(speed)),
            Action::Coolant(coolant) => self.push(line, Op::Coolant(coolant)),
            Action::Preselect(number) => self.push(line, Op::Preselect(number)),
            Action::Compensation(side) => self.push(line, Op::Compensation(side)),
            Action::Output(output) => self.push(line, Op::Output(output)),
            Action::Input(input) => self.push(line, Op::Input(input)),
            Action::Auxiliary(function) => {
                let clamp = self.machine.clamps(function.number).map(Op::Clamp);
                self.push(line, clamp.unwrap_or(Op::Auxiliary(function)));
            }
            Action::ThreadWire => self.push(line, Op::ThreadWire),
            Action::CutWire => self.push(line, Op::CutWire),
            Action::Taper(degrees) => self.push(line, Op::Taper(degrees)),
            Action::Risk(risk) => {
                self.risk(line, *risk);
            }
            Action::PathMode(mode) => self.push(line, Op::PathMode(mode)),
            Action::Dwell(seconds) => self.push(line, Op::Dwell(seconds)),
            Action::Stop => self.push(line, Op::Stop),
            Action::OptionalStop => self.push(line, Op::OptionalStop),
            // The source of a mill has poses and no joints: programs of arms are proven, and no source yet.
            Action::Arm(_) => {
                let message = "a motion of a robot: its programs are no source yet";
                let help = "post the toolpath that it was made of";
                return Err(refuse(Rule::Unsupported, message, help));
            }
            Action::Comment(text) => self.push(line, Op::Comment(text)),
            Action::Message(text) => self.push(line, Op::Message(text)),
            Action::End => {
                self.ended = true;
                self.push(line, Op::End);
            }
        }
        self.position = position.or(self.position);
        Ok(())
    }

    /// Points of a rapid on which rotary axes turn without tool-centre control, a degree apart.
    fn sample_rapid(&mut self, line: u32, from: &Position, to: &Position) -> Outcome {
        let (
            Orientation::Rotary { degrees: a, tool_center: false },
            Orientation::Rotary { degrees: b, tool_center: false },
        ) = (from.orientation, to.orientation)
        else {
            return Ok(());
        };
        let turn = (0..3).map(|i| f64::abs(b[i] - a[i])).fold(0.0, f64::max);
        let places = turn.ceil().min(MOST_PLACES);
        for i in 1..places as u32 {
            let part = f64::from(i) / places;
            let degrees = std::array::from_fn(|k| a[k] + (b[k] - a[k]) * part);
            let orientation = Orientation::Rotary { degrees, tool_center: false };
            let place = Position { point: from.point.lerp(to.point, part), orientation };
            if let Some(pose) = self.partial_pose(&place).complete() {
                self.arrive(line, Op::Rapid(pose))?;
            }
        }
        Ok(())
    }

    /// Adds the feed of a straight cut to `to`: as inverse time where its number is not the speed of the tip.
    fn time_cut(&mut self, line: u32, to: &Position) {
        let Some(feed) = self.feed else { return };
        let turned = self.position.filter(|from| !self.feed_path.is_of_tip(from, to));
        let counted = turned.and_then(|from| self.feed_path.length(&from, to));
        let feed = match (feed, counted) {
            (Feed::PerMinute(f), Some(length)) if length > 0.0 => Feed::InverseTime(f / length),
            (feed, None) if turned.is_some() && matches!(feed, Feed::PerMinute(_)) => {
                self.unknown_speed(line);
                feed
            }
            (feed, _) => feed,
        };
        self.say_feed(line, feed);
    }

    /// Adds a record of the feed where it differs from the last one.
    fn say_feed(&mut self, line: u32, feed: Feed) {
        if self.written_feed != Some(feed) {
            self.written_feed = Some(feed);
            self.push(line, Op::Feed(feed));
        }
    }

    /// F is taken as the speed of the tip where it is not known what it counts.
    #[cold]
    fn unknown_speed(&mut self, line: u32) {
        // The feeds of a CAM system are those of the tool.
        if self.is_source {
            return;
        }
        let message = "rotary axes turn in the cut, and a parameter of the control decides which axes F in mm/min counts: it is \
                       taken as the speed of the tool tip";
        if let Some(known) = self.warnings.iter_mut().find(|found| found.rule == Rule::RotaryFeed) {
            known.count = known.count.saturating_add(1);
            return;
        }
        let help = "set `rotary_feed` in [settings] of the machine file (FANUC: parameter 1408#0)";
        self.warnings.push(Diagnostic::warning(Rule::RotaryFeed, message).help(help).line(line));
    }

    fn push(&mut self, line: u32, op: Op) {
        self.count += 1;
        (self.keep)(&mut self.program.records, Record { line, op }, self.several);
    }

    /// The tool moves, from home where it was sent there.
    fn arrive(&mut self, line: u32, op: Op) -> Outcome {
        if self.calls_lengths && !matches!(op, Op::Rapid(_)) {
            self.see_length(line)?;
        }
        match (self.home.take(), self.tool_at) {
            (Some(line), _) => self.push(line, Op::Home),
            (None, ToolPosition::Start(start)) if !matches!(op, Op::Rapid(_)) => {
                let start = start.complete().map(Op::Rapid);
                start.into_iter().for_each(|start| self.push(line, start));
            }
            _ => {}
        }
        if let Some((_, fresh)) = &mut self.tool {
            *fresh = false;
        }
        let at =
            |pose: &Pose| ToolPosition::At(PartialPose { tip: pose.point(), axis: pose.axis() });
        self.tool_at = op.pose().map_or(ToolPosition::Unknown, at);
        self.push(line, op);
        Ok(())
    }

    /// The tool cuts: whether a length offset is on, and whose. The new program calls that of the tool in any case.
    fn see_length(&mut self, line: u32) -> Outcome {
        let Some((tool, _)) = &mut self.tool else { return Ok(()) };
        let (register, active) = (tool.register, self.length_offset);
        if tool.offset.replace(active.is_some()).is_some_and(|before| before != active.is_some()) {
            let message = "the tool cuts with its length offset and without: a tool with two lengths cannot be converted";
            let help = "post the parts with the offset and without as programs of their own";
            return Err(refuse(Rule::LengthOffset, message, help));
        }
        match active {
            None if self.bare.insert(register) => {
                let message = format!(
                    "the tool cuts without a length offset (no G43): a control that calls lengths writes register \
                     {register}"
                );
                let help = "where the source counts on a length of 0, set that of the tool to 0 at the new machine";
                let found = Diagnostic::warning(Rule::LengthOffset, message).help(help);
                self.warnings.push(found.line(line));
            }
            Some(active) if active != register => {
                let message = format!(
                    "length offset {active}, which was called before the tool, stays on for it: it is written in \
                     place of {register}"
                );
                let help = "check that the tool is meant to have that length";
                let found = Diagnostic::warning(Rule::LengthOffset, message).help(help);
                self.warnings.push(found.line(line));
                self.correct(active);
            }
            _ => {}
        }
        Ok(())
    }

    /// The tool has another register for its length.
    fn correct(&mut self, register: u32) {
        if let Some((tool, _)) = &mut self.tool {
            tool.register = register;
        }
        let mut records = self.program.records.iter_mut().rev();
        let last = records
            .find_map(|record| if let Op::Tool(tool) = &mut record.op { Some(tool) } else { None });
        if let Some(tool) = last {
            tool.offset = Some(register);
        }
    }

    /// Adds the boring cycle again where its withdrawal, which turns with the table, has another direction.
    fn bore(&mut self, line: u32, aside: Option<Vec3>) {
        let (Some((cycle, last)), Some(aside)) = (&mut self.boring, aside) else { return };
        if last.is_some_and(|last| last.distance(aside) < ROUNDING) {
            return;
        }
        *last = Some(aside);
        let cycle = Cycle { kind: cycle.kind.with_aside(aside), ..*cycle };
        self.push(line, Op::Cycle(Box::new(cycle)));
    }

    /// Whether the start of a straight cut to `end` is not known, in a program that is only drawn.
    fn starts_a_picture(&self, end: &Position) -> bool {
        let drawn = !self.setup.purpose.asks_ends();
        let known = |pose: &PartialPose| pose.complete().is_some();
        let from_home = self.home.is_some() || !self.tool_at.pose().is_some_and(known);
        drawn && from_home && known(&self.partial_pose(end))
    }

    /// Where a cut ends; it must begin somewhere.
    fn cut(&self, end: &Position) -> Outcome<Pose> {
        let pose = self.partial_pose(end);
        let start = self.tool_at.pose().filter(|_| self.home.is_none());
        let nowhere = PartialPose { tip: Vec3::NAN, axis: Vec3::Z };
        let start = start.copied().unwrap_or(nowhere);
        if start.complete().is_none() {
            return Err(self.lost("the start of a cut", end, &start));
        }
        pose.complete().ok_or_else(|| self.lost("the end of a cut", end, &pose))
    }

    /// The refusal of a block that goes to `end` because `pose` is not known.
    #[cold]
    fn lost(&self, what: &str, end: &Position, pose: &PartialPose) -> Box<Diagnostic> {
        let Orientation::Rotary { degrees, tool_center: false } = end.orientation else {
            return unknown(what, pose);
        };
        let length = self.tool.and_then(|(tool, _)| tool.length);
        match self.machine.unsaid(degrees, length) {
            Some(unsaid) => {
                let message = format!("{what} depends on what is not given: {unsaid}");
                refuse(unsaid.rule(), message, &unsaid.way_out())
            }
            None => unknown(what, pose),
        }
    }

    /// An arc in the work frame: its centre and its axis turn with the table, as its end does.
    fn arc(&self, arc: &control::ArcTo) -> Outcome<ArcTo> {
        let control::ArcTo { mut center, mut normal, turns, .. } = *arc;
        if !self.machine.rotary.is_empty() {
            let of = |point| self.partial_pose(&Position { point, ..arc.end }).tip;
            center = of(arc.center);
            normal = (of(arc.center + arc.normal) - center).normalize();
        }
        let end = self.cut(&arc.end)?;
        let circle = Circle::new(center, normal, turns);
        let circle = circle.map_err(|_| {
            unknown("the centre of an arc", &PartialPose { tip: center, axis: end.axis() })
        })?;
        Ok(ArcTo { end, circle })
    }

    /// A position as a block gives it, in the work frame. The tip of a tool of unknown length that a head has
    /// turned is not known.
    fn partial_pose(&self, position: &Position) -> PartialPose {
        let length = self.tool.and_then(|(tool, _)| tool.length);
        let (mut tip, axis) = resolve(self.machine, position, length);
        self.setup.flatten(&mut tip);
        PartialPose { tip, axis }
    }

    /// Whether this goes by rapid with an empty spindle, from where it stands nobody then knows.
    ///
    /// # Errors
    /// It cuts so.
    fn moves_empty(&mut self, action: &Action) -> Outcome<bool> {
        let Some(line) = self.emptied else { return Ok(false) };
        if matches!(action, Action::Rapid(_)) {
            self.tool_at = ToolPosition::Unknown;
            return Ok(true);
        }
        if action.position().is_none() {
            return Ok(false);
        }
        let message = format!("cuts without a tool: line {line} has emptied the spindle (T0)");
        Err(refuse(Rule::Tool, message, "call a tool before the cut"))
    }

    /// Gives a tool that is called by its name a number that no other tool has.
    fn number(&mut self, line: u32, tool: &mut Tool) -> Outcome {
        if tool.number > 0 {
            let name = self.numbers.entry(tool.number).or_default();
            if !name.is_empty() {
                let message =
                    format!("T{} is called, and stands for \"{name}\" already", tool.number);
                let help = "give the tools that are called by name their numbers in a tool table";
                return Err(refuse(Rule::ToolNumber, message, help));
            }
            return Ok(());
        }
        if let Some(entry) =
            self.setup.tools.iter().find(|e| e.name.eq_ignore_ascii_case(&tool.name))
        {
            tool.number = entry.number;
            return Ok(());
        }
        if let Some(number) = self.named.get(&tool.name) {
            tool.number = *number;
            return Ok(());
        }
        let free = |n: &u32| {
            !self.numbers.contains_key(n) && self.setup.tools.iter().all(|entry| entry.number != *n)
        };
        tool.number = (self.free_from..).find(free).unwrap_or_default();
        self.free_from = tool.number.saturating_add(1);
        self.numbers.insert(tool.number, tool.name.clone());
        self.named.insert(tool.name.clone(), tool.number);
        let message =
            format!("tool \"{}\" is called by its name, and T{} here", tool.name, tool.number);
        let found = Diagnostic::warning(Rule::ToolNumber, message);
        self.warnings.push(found.help("a tool table gives it a number of your own").line(line));
        Ok(())
    }

    /// Axes go to a fixed position of the machine. Only Z matters there: the other axes come back
    /// by words of their own, and the machine decides their path.
    fn go_home(&mut self, line: u32, axes: Axes) -> Outcome {
        let is_known = self.tool_at.pose().is_some_and(|pose| pose.complete().is_some());
        if !axes.contains(Axes::Z) && self.home.is_none() && is_known {
            let message =
                "axes are sent home while Z is not: the machine decides their path past the part";
            let help = "send Z home before";
            return Err(refuse(Rule::Home, message, help));
        }
        if axes.contains(Axes::Z) && self.tool_at.pose().is_some() {
            self.home.get_or_insert(line);
        }
        Ok(())
    }

    /// Reports a risk, once for all its lines.
    fn risk(&mut self, line: u32, risk: Risk) {
        let message = format!("the program {}", risk.what);
        self.warn_once(line, Diagnostic::warning(risk.rule, message).help(risk.help));
    }

    /// Reports a warning with its first line, and counts those that are the same.
    fn warn_once(&mut self, line: u32, warning: Diagnostic) {
        let same = |found: &&mut Diagnostic| {
            found.rule == warning.rule && found.message == warning.message
        };
        match self.warnings.iter_mut().find(same) {
            Some(found) => found.count = found.count.saturating_add(1),
            None => self.warnings.push(warning.line(line)),
        }
    }

    /// A move in machine coordinates is a move home where Z goes to its safe height. Where the machine file has no
    /// safe height, Z 0 or above is taken for it, as on machines whose Z counts down from its top.
    fn machine_move(&mut self, line: u32, to: &MachineMove) -> Outcome {
        if let Some(z) = to.linear[2] {
            let safe = self.machine.safe_height;
            if z.is_nan() || z < safe.unwrap_or(0.0) - ROUNDING {
                let below = safe.map_or(String::new(), |safe| {
                    format!(
                        ", below the safe height of {safe} mm of the machine it was written for"
                    )
                });
                let message = format!(
                    "Z goes to {z} mm in machine coordinates{below}: where that is in the work is \
                     not known"
                );
                return Err(refuse(Rule::MachinePosition, message, machine::SAFE_HEIGHT_HELP));
            }
            if safe.is_none() {
                let message = format!(
                    "Z {z} mm in machine coordinates is taken for clear of the part: no safe height \
                     of the machine is known that the program was written for"
                );
                let found = Diagnostic::warning(Rule::MachinePosition, message);
                self.warnings.push(found.help(machine::SAFE_HEIGHT_HELP).line(line));
            }
        }
        self.go_home(line, to.axes())
    }

    fn length_offset(&mut self, line: u32, register: Option<u32>) -> Outcome {
        self.length_offset = register;
        let Some(register) = register else { return Ok(()) };
        let Some((tool, fresh)) = &mut self.tool else {
            let message = format!(
                "length offset {register} is called, and no tool before it: the new program writes the register \
                 of the tool that it calls"
            );
            let found = Diagnostic::warning(Rule::LengthOffset, message);
            let help = "name the tool in the source, or set `default_tool` to the one that has this register";
            self.warnings.push(found.help(help).line(line));
            return Ok(());
        };
        // Where a register is an edge of the tool in the spindle (SINUMERIK's D), the first is the tool
        // itself.
        let edges = self.machine.capabilities.length_offset == LengthOffset::One;
        let own = if edges { 1 } else { tool.register };
        if register == own {
            return Ok(());
        }
        if edges || !*fresh {
            let message = format!(
                "length offset {register} where {own} is the tool's: a tool with two lengths cannot be converted"
            );
            let help = "post the parts with each offset as programs of their own";
            return Err(refuse(Rule::LengthOffset, message, help));
        }
        self.correct(register);
        Ok(())
    }

    /// Positions are counted from another work offset from here on.
    fn set_work_offset(&mut self, line: u32, offset: WorkOffset) {
        // Where the start is given, all offsets are 0, and it is one in the first.
        let known = self.setup.start.map(|_| WorkOffset::FIRST);
        let before = self.work_offset.replace(offset).or(known);
        if before == Some(offset) {
            return;
        }
        self.several |= offset != WorkOffset::FIRST;
        // The position at the start is given with all offsets at 0.
        if let ToolPosition::At(_) = self.tool_at {
            self.several = true;
            self.tool_at = ToolPosition::Unknown;
        }
        self.push(line, Op::WorkOffset(offset));
    }
}

/// How far apart two equal points may be after a turn of the table, mm.
const ROUNDING: f64 = 1e-9;

/// The tool tip (mm) and the tool axis (unit vector), both in the work frame, of a position as a block gives it,
/// with a tool of `tool_length` mm. What is not known is NaN: also a tip of which [`Machine::unsaid`] names a fact.
pub fn resolve(machine: &Machine, position: &Position, tool_length: Option<f64>) -> (Vec3, Vec3) {
    match position.orientation {
        Orientation::Axis(axis) => (position.point, axis),
        Orientation::Rotary { degrees, tool_center: true } => {
            (position.point, machine.axis_at(degrees))
        }
        Orientation::Rotary { degrees, tool_center: false } => {
            let (tip, axis) = machine.forward(position.point, degrees, tool_length.unwrap_or(0.0));
            let is_known = machine.unsaid(degrees, tool_length).is_none();
            (if is_known { tip } else { Vec3::NAN }, axis)
        }
    }
}

/// The refusal of coordinates that no block has given.
#[cold]
fn unknown(what: &str, pose: &PartialPose) -> Box<Diagnostic> {
    let letters = ["X", "Y", "Z"].into_iter().zip(pose.tip.to_array());
    let mut missing: Vec<&str> = letters.filter(|(_, v)| v.is_nan()).map(|(l, _)| l).collect();
    if !pose.axis.is_finite() {
        missing.push("the rotary axes");
    }
    let message = match missing.is_empty() {
        true => format!("{what} is at the machine's home, which the program does not know"),
        false => format!("{what} is not known in {}", missing.join(", ")),
    };
    let help = "go there by rapid with every axis named, before";
    refuse(Rule::UnknownPosition, message, help)
}

/// An error; its line is that of the record at hand.
/// Refuses what is beyond every machine: sums over such places and times are infinite.
fn within_reach(action: &Action) -> Outcome {
    let place = action.position().map_or(0.0, |to| to.point.abs().max_element());
    let (what, number, most, unit) = if let Action::Arc(arc) = action
        && place <= FARTHEST
    {
        ("the centre lies", arc.center.abs().max_element(), FARTHEST_CENTER, " mm away")
    } else if let Action::Dwell(seconds) = action {
        ("the dwell takes", *seconds, LARGEST, " s")
    } else if let Action::Feed(feed) = action {
        ("the feed is", feed.value(), LARGEST, "")
    } else if let Action::Spindle(Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed)) =
        action
    {
        ("the spindle speed is", *speed, LARGEST, "")
    } else {
        ("the place lies", place, FARTHEST, " mm away")
    };
    // What nobody knows is not far.
    if number.is_nan() || number <= most {
        return Ok(());
    }
    let message =
        format!("{what} {number:e}{unit}: more than {most}{unit} is beyond every machine");
    Err(refuse(
        Rule::OutOfRange,
        message,
        "check the numbers of the block, and the unit (G20, G21)",
    ))
}

fn refuse(rule: Rule, message: impl Into<String>, help: &str) -> Box<Diagnostic> {
    Diagnostic::error(rule, message).help(help).into()
}
