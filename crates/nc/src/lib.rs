//! NC programs as a source: what a virtual control makes of one, as a neutral program.
//!
//! A control's records say what its blocks say: positions of rotary axes, coordinates that nobody knows
//! yet, axes sent home. A neutral program says where the tool is: every pose complete and in the work
//! frame. This crate goes from the one to the other, and no other place does:
//!
//! - Rotary positions become a tool axis by the kinematics of the machine that the program was
//!   written for.
//! - A rapid whose end is not known in every coordinate waits for the next ones, as after a reference
//!   return: `X10 Y20`, then `Z5`, is one way to a known place. A cut from such a place is refused.
//! - Z sent home between two moves stays, as [`Op::Home`]. At a tool change and at the end it goes: a
//!   writer brings the tool home there by itself.
//! - A change of the work offset stays; the tool comes to the first place in it from above.
//! - A length offset becomes the register of the tool; a tool that is called by its name gets a number,
//!   and one of the tool table its diameter and length.
//!
//! What cannot be told truly is refused with its line.

#![deny(clippy::wildcard_enum_match_arm)]

use control::{
    Action, Dialect, Ending, Event, FeedPath, Orientation, Position, Risk, Settings, Setup, Wire,
};
use geom::{Arc, Vec3};
use machine::{LengthOffset, Machine, Mount, RotaryFeed};
use program::{
    ArcTo, Axes, Circle, CompensatedPath, Cycle, Diagnostic, Feed, MachineMove, Op, Pose, Probe,
    Program, Record, Severity, Thread, Tool, WorkOffset,
};
use std::collections::{BTreeSet, HashMap};

/// Most records of a reading, which are kept in memory: a program of a few lines can loop to more.
const MOST_RECORDS: usize = 20_000_000;

/// Most places of one rapid in a picture.
const MOST_PLACES: f64 = 1440.0;

/// A step that may be refused.
type Done = Result<(), Box<Diagnostic>>;

/// What was read.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// What the program does.
    pub program: Program,
    /// What is worth knowing, with lines.
    pub warnings: Vec<Diagnostic>,
}

/// How a record is put to those before it, and whether the program has worked in several work offsets so far.
/// It may hold records back, but no tool of a source that has length offsets: these correct the last tool.
pub type Keep<'a> = dyn FnMut(&mut Vec<Record>, Record, bool) + 'a;

/// The virtual control of `machine`, with what the operator has set up.
///
/// # Errors
/// `reader` where there is no control of the name that the machine file gives.
pub fn settings(machine: &Machine, setup: Setup) -> Result<Settings, Box<Diagnostic>> {
    let Some(dialect) = Dialect::named(&machine.reader) else {
        let message = format!("there is no virtual control `{}`", machine.reader);
        let names = Dialect::NAMES.map(|(name, _)| name).join(", ");
        let place = &machine.reader_place;
        return Err(Diagnostic::error("reader", message)
            .help(format!("`reader` is one of {names}"))
            .file(&place.file)
            .line(place.line)
            .into());
    };
    let (mut rotary, mut table, mut modulo) = ([false; 3], [false; 3], [None; 3]);
    for axis in &machine.rotary {
        rotary[axis.index()] = true;
        table[axis.index()] = axis.on == Mount::Table;
        modulo[axis.index()] = axis.modulo;
    }
    let clamps = machine.rotary.iter().filter_map(|axis| axis.clamp);
    let clamps = clamps.flat_map(|clamp| [clamp.open, clamp.close]);
    Ok(Settings {
        auxiliary: machine.auxiliary.iter().copied().chain(clamps).collect(),
        modulo,
        floating_holder: machine.settings.floating_holder,
        retract_above_r: machine.settings.retract_above_r,
        length_along_z: machine.settings.length_along_z,
        length_moves_axis: machine.settings.length_moves_axis,
        dwell_p_milliseconds: machine.settings.dwell_p_milliseconds,
        rotary_by_sign: machine.settings.rotary_by_sign,
        table,
        table_frame_at_zero: machine.settings.table_frame_at_zero,
        sets_work_offsets: machine.settings.sets_work_offsets,
        operator_parameters: machine.operator_parameters.clone(),
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
    })
}

/// Along which way the control of `machine` counts the feed before a program says it. What a parameter of the control decides,
/// the machine's file may say.
pub fn feed_path(machine: &Machine) -> FeedPath {
    let path = Dialect::named(&machine.reader).map_or(FeedPath::AsSetUp, Dialect::feed_path);
    match (path, machine.settings.rotary_feed) {
        (FeedPath::AsSetUp, Some(RotaryFeed::AllAxes)) => FeedPath::AllAxes,
        (FeedPath::AsSetUp, Some(RotaryFeed::LinearAxes)) => FeedPath::LinearAxes,
        (path, _) => path,
    }
}

/// Reads the NC program `text`, which was written for `machine`.
///
/// # Errors
/// The first block that the control does not understand, or that cannot be told as a neutral program,
/// with `file_name`, line and the way out.
pub fn read(
    machine: &Machine,
    setup: Setup,
    file_name: &str,
    text: &[u8],
) -> Result<Reading, Box<Diagnostic>> {
    let keep = &mut |records: &mut Vec<Record>, record, _| records.push(record);
    let (mut reading, several) = read_by(machine, setup, file_name, text, keep)?;
    let records = &mut reading.program.records;
    let is_offset = |record: &Record| matches!(record.op, Op::WorkOffset(_));
    // There is one at most: another one would be one of several.
    if !several && let Some(first) = records.iter().position(is_offset) {
        records.remove(first);
    }
    Ok(reading)
}

/// The same for a picture: a rapid that turns rotary axes without tool-centre control is as many as its tip takes to be seen where
/// it really goes, all axes going together.
///
/// # Errors
/// As [`read`].
pub fn read_swinging(
    machine: &Machine,
    setup: Setup,
    file_name: &str,
    text: &[u8],
) -> Result<Program, Box<Diagnostic>> {
    let settings = settings(machine, setup)?;
    let keep = &mut |records: &mut Vec<Record>, record, _| records.push(record);
    let mut lift = Lift::new(machine, &settings.setup, file_name, keep);
    let mut before: Option<Position> = None;
    let run = control::read(&settings, file_name, text, &mut |event| {
        let line = event.line;
        let told = |found: Box<Diagnostic>| found.line(line).into();
        if let (Action::Rapid(to), Some(from)) = (&event.action, before) {
            lift.swing(line, &from, to).map_err(told)?;
        }
        before = event.action.position().copied().or(before);
        lift.event(event).map_err(told)
    });
    run.map_err(way_out)?;
    Ok(lift.program)
}

/// The same in the frame of the machine: where X, Y and Z stand, in the coordinates of the work offset, mm. The work turns on its
/// table, and a straight way of the tool is none of the axes.
///
/// # Errors
/// As [`read`]; `machine-frame` where only the control knows how the axes stand.
pub fn read_in_machine(
    machine: &Machine,
    setup: Setup,
    file_name: &str,
    text: &[u8],
) -> Result<Program, Box<Diagnostic>> {
    let settings = settings(machine, setup)?;
    let drop = &mut |_: &mut Vec<Record>, _, _| {};
    let mut lift = Lift::new(machine, &settings.setup, file_name, drop);
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
            let length = lift.tool.and_then(|(tool, _)| tool.length);
            for place in between(&from, to, arc) {
                let at = axes_at(machine, &place, length).map_err(|found| found.line(line))?;
                if let Ok(pose) = Pose::upright(at) {
                    program.push(line, if is_rapid { Op::Rapid(pose) } else { Op::Line(pose) });
                    // `event` looks at the number of records.
                    lift.count += 1;
                }
            }
        }
        lift.event(event).map_err(|found| found.line(line).into())
    });
    run.map_err(way_out)?;
    Ok(program)
}

/// Places of a block between which the axes go nearly straight, its end among them.
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

/// Where X, Y and Z stand, in the coordinates of the work offset, mm.
fn axes_at(
    machine: &Machine,
    position: &Position,
    length: Option<f64>,
) -> Result<Vec3, Box<Diagnostic>> {
    match position.orientation {
        Orientation::Rotary { degrees, tool_center: true } => {
            Ok(machine.linear_for(position.point, degrees, length.unwrap_or(0.0)))
        }
        Orientation::Rotary { tool_center: false, .. } => Ok(position.point),
        Orientation::Axis(_) if machine.rotary.is_empty() => Ok(position.point),
        Orientation::Axis(_) => Err(refuse(
            "machine-frame",
            "how the axes stand along a vector or in a tilted plane, only the control knows",
            "draw it in the frame of the part: without `--frame machine`",
        )),
    }
}

/// The same for a caller that has a hand in how the records are kept, as they come. Answers besides whether
/// the program works in more than the first work offset; one that does not leaves it to the machine, and what
/// it says of it does not belong to its records.
///
/// # Errors
/// As [`read`].
pub fn read_by(
    machine: &Machine,
    setup: Setup,
    file_name: &str,
    text: &[u8],
    keep: &mut Keep,
) -> Result<(Reading, bool), Box<Diagnostic>> {
    let settings = settings(machine, setup)?;
    let name = file_name.rsplit_once('.').map_or(file_name, |(stem, _)| stem);
    let mut lift = Lift::new(machine, &settings.setup, name, keep);
    // FreeCAD's commands call no lengths: the post does.
    lift.calls_lengths &= settings.dialect != Dialect::FreeCad;
    let run = control::read(&settings, file_name, text, &mut |event| {
        let line = event.line;
        lift.event(event).map_err(|found| found.line(line).into())
    });
    run.map_err(way_out)?;
    let cut_off = cut_off(settings.dialect, lift.ended, text);
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
        lift.warnings.push(found);
    }
    let mut optional = control::optional_blocks(text);
    if let Some((line, _)) = optional.next() {
        let (done, other) = match settings.setup.block_delete {
            true => ("left out", "without it they run"),
            false => ("run", "`--block-delete` leaves them out"),
        };
        let message =
            format!("the blocks behind `/`, which the operator may switch off, are read as {done}");
        let mut found = Diagnostic::warning("block-skip", message).help(other).line(line);
        found.count += u32::try_from(optional.count()).unwrap_or(u32::MAX - 1);
        lift.warnings.push(found);
    }
    Ok((Reading { program: lift.program, warnings: lift.warnings }, lift.several))
}

/// What says that the program in `text` is only the first part of one; `ended` is whether a code has ended it.
fn cut_off(dialect: Dialect, ended: bool, text: &[u8]) -> Option<Diagnostic> {
    const HELP: &str = "the file may be cut off: send it once more";
    if text.trim_ascii().is_empty() {
        let message = "the file is empty";
        return Some(Diagnostic::error("program-end", message).help(HELP));
    }
    let ending = dialect.ending();
    let has_percent = !matches!(dialect, Dialect::Klartext | Dialect::Grbl | Dialect::Marlin)
        && !matches!(dialect, Dialect::Sinumerik | Dialect::Sinumerik828d | Dialect::FreeCad);
    let percent_signs = if has_percent { control::percent_signs(text) } else { 0 };
    if percent_signs == 1 {
        let message = "`%` opens the program, and none closes it";
        let found = if ended { Diagnostic::warning } else { Diagnostic::error };
        return Some(found("program-end", message).help(HELP));
    }
    if ended || ending == Ending::CodeOrPercent && percent_signs > 1 {
        return None;
    }
    let message = "the program has no end: M30 or M2 is missing";
    match ending {
        Ending::Code | Ending::CodeOrPercent => {
            Some(Diagnostic::error("program-end", message).help(HELP))
        }
        Ending::CodeOrText => Some(Diagnostic::warning("program-end", message).help(HELP)),
        Ending::Text => None,
    }
}

/// Adds to what a control refuses what the user of a source can do about it.
fn way_out(mut found: Box<Diagnostic>) -> Box<Diagnostic> {
    let way_out = match found.rule {
        "nc-unknown-position" | "unknown-position" => "or say where the tool stands at the start",
        _ => return found,
    };
    found.help_too(way_out);
    found
}

/// The events of a control on their way into a neutral program.
struct Lift<'a> {
    machine: &'a Machine,
    setup: &'a Setup,
    program: Program,
    keep: &'a mut Keep<'a>,
    /// How many records there have been.
    count: usize,
    /// A code has ended the program.
    ended: bool,
    warnings: Vec<Diagnostic>,
    place: Place,
    /// What the last block that moved has said, where the axes have not gone home since.
    position: Option<Position>,
    /// The active feed, what it counts, and the feed of the last record.
    feed: Option<Feed>,
    feed_path: FeedPath,
    written_feed: Option<Feed>,
    /// Z has been sent home since the last move, on this line.
    home: Option<u32>,
    /// The tool in the spindle, and whether nothing has moved since it was called.
    tool: Option<(Loaded, bool)>,
    /// The cycle that goes aside from the wall, as the control says it, and the way aside of the last hole.
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
    /// Registers of the tools that are told to cut without a length offset.
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
struct Spot {
    tip: Vec3,
    axis: Vec3,
}

impl Spot {
    /// The pose that it is, where everything is known.
    fn pose(self) -> Option<Pose> {
        Pose::new(self.tip, self.axis).ok()
    }
}

/// Where the tool is, as far as the program says it.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// Where it was said to stand at the start: a cut from there begins with the way to it.
    Start(Spot),
    /// Where the last block has sent it.
    At(Spot),
    Nowhere,
}

impl Place {
    fn spot(&self) -> Option<&Spot> {
        match self {
            Place::Start(spot) | Place::At(spot) => Some(spot),
            Place::Nowhere => None,
        }
    }
}

impl<'a> Lift<'a> {
    fn new(machine: &'a Machine, setup: &'a Setup, name: &str, keep: &'a mut Keep<'a>) -> Lift<'a> {
        Lift {
            machine,
            setup,
            program: Program {
                // What the control offsets is the contour.
                compensated_path: Some(CompensatedPath::Contour),
                ..Program::new(name)
            },
            keep,
            count: 0,
            ended: false,
            warnings: Vec::new(),
            place: setup
                .start
                .map_or(Place::Nowhere, |tip| Place::Start(Spot { tip, axis: Vec3::Z })),
            position: None,
            feed: None,
            feed_path: feed_path(machine),
            written_feed: None,
            home: None,
            tool: None,
            boring: None,
            work_offset: None,
            several: false,
            numbers: HashMap::new(),
            named: HashMap::new(),
            free_from: 1,
            calls_lengths: machine.capabilities.length_offset == LengthOffset::ToolNumber,
            length_offset: None,
            bare: BTreeSet::new(),
        }
    }

    fn event(&mut self, event: Event) -> Done {
        let line = event.line;
        if self.count >= MOST_RECORDS {
            let message = format!("the program makes more than {MOST_RECORDS} records");
            let help = "it may loop without end; if not, read it in parts";
            return Err(refuse("program-length", message, help));
        }
        let position = event.action.position().copied();
        if let (Action::Arc(_) | Action::Hole(_) | Action::Probe(_), Some(feed)) =
            (&event.action, self.feed)
        {
            self.say_feed(line, feed);
        }
        match event.action {
            Action::Rapid(position) => {
                let spot = self.spot(&position);
                match spot.pose() {
                    Some(pose) => self.arrive(line, Op::Rapid(pose))?,
                    None => self.place = Place::At(spot),
                }
            }
            Action::Line(position) if self.starts_a_picture(&position) => {
                let message = "where the tool comes from is not known: it is drawn from the end of this block on";
                self.warn_once(line, Diagnostic::warning("unknown-start", message));
                let spot = self.spot(&position);
                if let Some(pose) = spot.pose() {
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
                self.place = Place::Nowhere;
            }
            Action::Hole(position) => {
                let spot = self.spot(&position);
                let way = self.boring.as_ref().and_then(|(cycle, _)| cycle.kind.withdrawal());
                let aside = way.map(|way| {
                    let beside = Position { point: position.point + way.aside, ..position };
                    self.spot(&beside).tip - spot.tip
                });
                let Some(pose) = spot.pose() else {
                    return Err(self.lost("a hole", &position, &spot));
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
            Action::Tool(mut tool) => {
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
                self.place = Place::At(self.spot(&nowhere));
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

    /// Places of a rapid on which rotary axes turn that the tip does not follow, a degree apart.
    fn swing(&mut self, line: u32, from: &Position, to: &Position) -> Done {
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
            if let Some(pose) = self.spot(&place).pose() {
                self.arrive(line, Op::Rapid(pose))?;
            }
        }
        Ok(())
    }

    /// Says the feed of a straight cut to `to` where its number is not the speed of the tip: as the time that the cut takes.
    fn time_cut(&mut self, line: u32, to: &Position) {
        let Some(feed) = self.feed else { return };
        let turned = self.position.filter(|from| !self.feed_path.is_of_tip(from, to));
        let counted = turned.and_then(|from| self.feed_path.length(&from, to));
        let feed = match (feed, counted) {
            (Feed::PerMinute(f), Some(way)) if way > 0.0 => Feed::InverseTime(f / way),
            (feed, None) if turned.is_some() && matches!(feed, Feed::PerMinute(_)) => {
                self.unknown_speed(line);
                feed
            }
            (feed, _) => feed,
        };
        self.say_feed(line, feed);
    }

    /// Says a feed that the last record of a feed does not.
    fn say_feed(&mut self, line: u32, feed: Feed) {
        if self.written_feed != Some(feed) {
            self.written_feed = Some(feed);
            self.push(line, Op::Feed(feed));
        }
    }

    /// F is taken as the speed of the tip where nobody knows what it counts.
    #[cold]
    fn unknown_speed(&mut self, line: u32) {
        // FreeCAD's feeds are those of the tool.
        if Dialect::named(&self.machine.reader) == Some(Dialect::FreeCad) {
            return;
        }
        let message = "rotary axes turn in the cut, and which axes F in mm/min counts, a parameter of the control decides: it is \
                       taken as the speed of the tool tip";
        if let Some(known) = self.warnings.iter_mut().find(|found| found.rule == "rotary-feed") {
            known.count = known.count.saturating_add(1);
            return;
        }
        let help = "say `rotary_feed` in [settings] of the machine file (FANUC: parameter 1408#0)";
        self.warnings.push(Diagnostic::warning("rotary-feed", message).help(help).line(line));
    }

    fn push(&mut self, line: u32, op: Op) {
        self.count += 1;
        (self.keep)(&mut self.program.records, Record { line, op }, self.several);
    }

    /// The tool moves, from home where it was sent there.
    fn arrive(&mut self, line: u32, op: Op) -> Done {
        if self.calls_lengths && !matches!(op, Op::Rapid(_)) {
            self.see_length(line)?;
        }
        match (self.home.take(), self.place) {
            (Some(line), _) => self.push(line, Op::Home),
            (None, Place::Start(start)) if !matches!(op, Op::Rapid(_)) => {
                let start = start.pose().map(Op::Rapid);
                start.into_iter().for_each(|start| self.push(line, start));
            }
            _ => {}
        }
        if let Some((_, fresh)) = &mut self.tool {
            *fresh = false;
        }
        let at = |pose: &Pose| Place::At(Spot { tip: pose.point(), axis: pose.axis() });
        self.place = op.pose().map_or(Place::Nowhere, at);
        self.push(line, op);
        Ok(())
    }

    /// The tool cuts: whether a length offset is on, and whose. The new program calls that of the tool in any case.
    fn see_length(&mut self, line: u32) -> Done {
        let Some((tool, _)) = &mut self.tool else { return Ok(()) };
        let (register, active) = (tool.register, self.length_offset);
        if tool.offset.replace(active.is_some()).is_some_and(|before| before != active.is_some()) {
            let message = "the tool cuts with its length offset and without: a tool with two lengths cannot be told";
            let help = "post the parts with the offset and without as programs of their own";
            return Err(refuse("length-offset", message, help));
        }
        match active {
            None if self.bare.insert(register) => {
                let message = format!(
                    "the tool cuts without a length offset (no G43): a control that calls lengths writes register \
                     {register}"
                );
                let help = "where the source counts on a length of 0, set that of the tool to 0 at the new machine";
                let found = Diagnostic::warning("length-offset", message).help(help);
                self.warnings.push(found.line(line));
            }
            Some(active) if active != register => {
                let message = format!(
                    "length offset {active}, which was called before the tool, stays on for it: it is written in \
                     place of {register}"
                );
                let help = "check that the tool is meant to have that length";
                let found = Diagnostic::warning("length-offset", message).help(help);
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

    /// Says the boring cycle anew where its way aside, which turns with the table, is another one.
    fn bore(&mut self, line: u32, aside: Option<Vec3>) {
        let (Some((cycle, told)), Some(aside)) = (&mut self.boring, aside) else { return };
        if told.is_some_and(|told| told.distance(aside) < ROUNDING) {
            return;
        }
        *told = Some(aside);
        let cycle = Cycle { kind: cycle.kind.with_aside(aside), ..*cycle };
        self.push(line, Op::Cycle(Box::new(cycle)));
    }

    /// Whether a straight cut to `end` comes from where nobody knows, in a program that is only drawn.
    fn starts_a_picture(&self, end: &Position) -> bool {
        let drawn = !self.setup.purpose.asks_ends();
        let known = |spot: &Spot| spot.pose().is_some();
        let from_home = self.home.is_some() || !self.place.spot().is_some_and(known);
        drawn && from_home && known(&self.spot(end))
    }

    /// Where a cut ends; it must begin somewhere.
    fn cut(&self, end: &Position) -> Result<Pose, Box<Diagnostic>> {
        let spot = self.spot(end);
        let start = self.place.spot().filter(|_| self.home.is_none());
        let nowhere = Spot { tip: Vec3::NAN, axis: Vec3::Z };
        match start.copied().unwrap_or(nowhere) {
            start if start.pose().is_none() => Err(self.lost("the start of a cut", end, &start)),
            _ => spot.pose().ok_or_else(|| self.lost("the end of a cut", end, &spot)),
        }
    }

    /// What is refused because nobody knows where `spot` is, of a block that goes to `end`.
    #[cold]
    fn lost(&self, what: &str, end: &Position, spot: &Spot) -> Box<Diagnostic> {
        let Orientation::Rotary { degrees, tool_center: false } = end.orientation else {
            return unknown(what, spot);
        };
        let length = self.tool.and_then(|(tool, _)| tool.length);
        match self.machine.unsaid(degrees, length) {
            Some(unsaid) => {
                let message = format!("{what} hangs on what nobody says: {unsaid}");
                refuse(unsaid.rule(), message, &unsaid.way_out())
            }
            None => unknown(what, spot),
        }
    }

    /// An arc in the work frame: its centre and its axis turn with the table, as its end does.
    fn arc(&self, arc: &control::ArcTo) -> Result<ArcTo, Box<Diagnostic>> {
        let control::ArcTo { mut center, mut normal, turns, .. } = *arc;
        if !self.machine.rotary.is_empty() {
            let of = |point| self.spot(&Position { point, ..arc.end }).tip;
            center = of(arc.center);
            normal = (of(arc.center + arc.normal) - center).normalize();
        }
        let end = self.cut(&arc.end)?;
        let circle = Circle::new(center, normal, turns);
        let circle = circle.map_err(|_| {
            unknown("the centre of an arc", &Spot { tip: center, axis: end.axis() })
        })?;
        Ok(ArcTo { end, circle })
    }

    /// A position as a block gives it, in the work frame. Where the tip of a tool of unknown length is that
    /// a head has turned, is not known.
    fn spot(&self, position: &Position) -> Spot {
        let length = self.tool.and_then(|(tool, _)| tool.length);
        let (mut tip, axis) = resolve(self.machine, position, length);
        self.setup.flatten(&mut tip);
        Spot { tip, axis }
    }

    /// Gives a tool that is called by its name a number, of which no other tool has it.
    fn number(&mut self, line: u32, tool: &mut Tool) -> Done {
        if tool.number > 0 {
            let name = self.numbers.entry(tool.number).or_default();
            if !name.is_empty() {
                let message =
                    format!("T{} is called, and stands for \"{name}\" already", tool.number);
                let help = "give the tools that are called by name their numbers in a tool table";
                return Err(refuse("tool-number", message, help));
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
        let found = Diagnostic::warning("tool-number", message);
        self.warnings.push(found.help("a tool table gives it a number of your own").line(line));
        Ok(())
    }

    /// Axes go to a fixed place of the machine. Only what Z does there matters: the others come back
    /// by words of their own, and their way is the machine's.
    fn go_home(&mut self, line: u32, axes: Axes) -> Done {
        let is_known = self.place.spot().is_some_and(|spot| spot.pose().is_some());
        if !axes.contains(Axes::Z) && self.home.is_none() && is_known {
            let message =
                "axes are sent home while Z is not: the way there beside the part is the machine's";
            let help = "send Z home before";
            return Err(refuse("home", message, help));
        }
        if axes.contains(Axes::Z) && self.place.spot().is_some() {
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

    /// A move in machine coordinates is a way home where Z goes to its safe height. Where the machine's file does not
    /// say that, Z 0 or above is taken for it, as on machines whose Z counts down from its top.
    fn machine_move(&mut self, line: u32, to: &MachineMove) -> Done {
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
                return Err(refuse("machine-position", message, machine::SAFE_HEIGHT_HELP));
            }
            if safe.is_none() {
                let message = format!(
                    "Z {z} mm in machine coordinates is taken for clear of the part: no safe height \
                     of the machine is known that the program was written for"
                );
                let found = Diagnostic::warning("machine-position", message);
                self.warnings.push(found.help(machine::SAFE_HEIGHT_HELP).line(line));
            }
        }
        self.go_home(line, to.axes())
    }

    fn length_offset(&mut self, line: u32, register: Option<u32>) -> Done {
        self.length_offset = register;
        let Some(register) = register else { return Ok(()) };
        let Some((tool, fresh)) = &mut self.tool else {
            let message = format!(
                "length offset {register} is called, and no tool before it: the new program writes the register \
                 of the tool that it calls"
            );
            let found = Diagnostic::warning("length-offset", message);
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
                "length offset {register} where {own} is the tool's: a tool with two lengths cannot be told"
            );
            let help = "post the parts with each offset as programs of their own";
            return Err(refuse("length-offset", message, help));
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
        // Where the tool stands at the start is said with all offsets at 0.
        if let Place::At(_) = self.place {
            self.several = true;
            self.place = Place::Nowhere;
        }
        self.push(line, Op::WorkOffset(offset));
    }
}

/// What two places that are the same may be apart after a turn of the table, mm.
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

/// What is refused because of coordinates that no block has given.
#[cold]
fn unknown(what: &str, spot: &Spot) -> Box<Diagnostic> {
    let letters = ["X", "Y", "Z"].into_iter().zip(spot.tip.to_array());
    let mut missing: Vec<&str> = letters.filter(|(_, v)| v.is_nan()).map(|(l, _)| l).collect();
    if !spot.axis.is_finite() {
        missing.push("the rotary axes");
    }
    let message = match missing.is_empty() {
        true => format!("{what} is at the machine's home, which the program does not know"),
        false => format!("{what} is not known in {}", missing.join(", ")),
    };
    let help = "go there by rapid with every axis named, before";
    refuse("unknown-position", message, help)
}

/// An error; its line is that of the record at hand.
fn refuse(rule: &'static str, message: impl Into<String>, help: &str) -> Box<Diagnostic> {
    Diagnostic::error(rule, message).help(help).into()
}
