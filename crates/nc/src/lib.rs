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

mod conversion;
mod path;
mod pose;
mod settings;

pub use pose::resolve;
pub use settings::{feed_path, settings, settings_in};

use control::{Action, Dialect, Ending, Position, Settings, Setup};
use conversion::Conversion;
use machine::Machine;
use path::between;
use pose::axes_at;
use program::{Diagnostic, Op, Outcome, Pose, Program, Progress, Pulse, Record, Rule, Severity};

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

/// After so many events of the control whoever waits is asked: some milliseconds at the most.
const EVENTS_AT_ONCE: u32 = 256;

/// Reads the NC program `text`, which was written for `machine`.
///
/// # Errors
/// The first block that the control does not understand, or that a neutral program cannot express,
/// with `file_name`, line and the way out.
pub fn read(machine: &Machine, setup: Setup, file_name: &str, text: &[u8]) -> Outcome<Reading> {
    read_for(machine, setup, (file_name, text), &())
}

/// The same for somebody who waits for it.
///
/// # Errors
/// As [`read`]; the work was ended (`cancelled`).
pub fn read_for(
    machine: &Machine,
    setup: Setup,
    (file_name, text): (&str, &[u8]),
    progress: &dyn Progress,
) -> Outcome<Reading> {
    let keep = &mut |records: &mut Vec<Record>, record, _| records.push(record);
    let settings = settings(machine, setup)?;
    let (mut reading, several) = read_by(machine, &settings, (file_name, text), keep, progress)?;
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

/// The same by a control of these settings, with a function that receives each record. The second answer is whether the program works in more than the
/// first work offset; where it does not, the machine decides the offset, and the record of it does not belong to the program.
///
/// # Errors
/// As [`read`].
pub fn read_by(
    machine: &Machine,
    settings: &Settings,
    (file_name, text): (&str, &[u8]),
    keep: &mut Sink,
    progress: &dyn Progress,
) -> Outcome<(Reading, bool)> {
    let lines = text.iter().filter(|byte| **byte == b'\n').count();
    let mut pulse = Pulse::new(progress, lines, EVENTS_AT_ONCE);
    let name = file_name.rsplit_once('.').map_or(file_name, |(stem, _)| stem);
    let mut conversion = Conversion::new(machine, settings, name, keep);
    let run = control::read(settings, file_name, text, &mut |event| {
        let line = event.line;
        pulse.step(line as usize)?;
        conversion.event(event).map_err(|found| found.line(line).into())
    });
    run.map_err(way_out)?;
    let cut_off = cut_off(settings.dialect, conversion.ended, text);
    if let Some(mut found) = cut_off {
        if !settings.setup.purpose.asks_ends() {
            found.severity = Severity::Warning;
        }
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
        optional.for_each(|(line, _)| found.again(line));
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

fn refuse(rule: Rule, message: impl Into<String>, help: &str) -> Box<Diagnostic> {
    Diagnostic::error(rule, message).help(help).into()
}
