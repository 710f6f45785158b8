//! The writer: a neutral program and a machine in, an NC program out.
//!
//! A control's blocks are templates; one that consists only of words is compiled once and runs without
//! the template engine. What the control lacks is lowered within a
//! stated tolerance and reported in the warnings; what can be neither written nor lowered is refused.
//! Nothing here reads NC text: whether the program is right is the proof's to say.
//!
//! ```
//! use program::{Builder, Feed, Spindle, Tool};
//!
//! let mut slot = Builder::new("slot");
//! slot.tool(Tool { number: 1, diameter: Some(6.0), ..Tool::default() })?;
//! slot.spindle(Spindle::Clockwise(5000.0))?;
//! slot.rapid([0.0, 0.0, 5.0], None)?;
//! slot.feed(Feed::PerMinute(300.0))?;
//! slot.line([0.0, 0.0, -1.0], None)?;
//! slot.line([10.0, 0.0, -1.0], None)?;
//! slot.rapid([10.0, 0.0, 5.0], None)?;
//! let machine = machine::load("generic-3axis-linuxcnc")?;
//! let text = toolpost_post::write(&slot.build(), &machine).unwrap().text;
//! let text = String::from_utf8(text).unwrap();
//! assert!(text.contains("G1 Z-1 F300\nX10\n"), "{text}");
//! # Ok::<(), Box<program::Diagnostic>>(())
//! ```
//!
//! Lengths are mm, feeds mm/min. The same program and machine give the same bytes.
//!
//! [`catalogue()`] names every block, word and variable that a control file may use. One record at a time
//! goes through `walk`, which knows what has been output to the control; `coordinate_mode` brings the tool into its
//! orientation, `motion`, `arcs`, `single` and `cycles` say where it goes, `wire` says how a wire is inclined,
//! `contour` finds out whether a tool can follow a contour that the control offsets, `center` offsets it for a machine that cannot,
//! `surface` writes Z relative to a surface that the control has probed, and `writer` leaves out what repeats. Before that, `sweep` splits cuts that would swing the tool out of
//! its way.

#![deny(clippy::wildcard_enum_match_arm)]

mod arcs;
mod arm;
mod around;
mod away;
mod catalogue;
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "what is not named is refused, or moves nothing"
)]
mod center;
mod contour;
mod coordinate_mode;
mod cycles;
mod findings;
#[expect(clippy::wildcard_enum_match_arm, reason = "what is not named is refused")]
mod guard;
mod leads;
mod motion;
mod no_effect;
mod number;
mod origins;
mod position;
mod promises;
mod rapid;
mod sent;
mod signals;
mod single;
mod surface;
mod sweep;
mod template;
mod text;
mod tilt;
mod upright;
mod vectors;
mod walk;
mod wanted;
mod wire;
mod words;
mod writer;

pub use arm::reach::{ArmLooks, ArmMargins, ArmSample, arm_margins, arm_samples};
pub use catalogue::{Kind, Parameter, catalogue};
pub use no_effect::without_effect;
pub use origins::{Origin, Origins, places};
pub use template::number_of;

use machine::Machine;
use program::{Diagnostic, MOST_PLACES, Program, Progress, Rule, Severity};

/// A written program.
#[derive(Clone, Debug, Default)]
pub struct Output {
    /// The text, ready to be saved.
    pub text: Vec<u8>,
    /// Which template wrote each line of it, for which record.
    pub origins: Origins,
    /// Blocks (lines) written.
    pub blocks: usize,
    /// What was lowered or is worth knowing, with source lines.
    pub warnings: Vec<Diagnostic>,
    /// The files that the program calls, in this order; none where it is whole.
    pub parts: Vec<Part>,
}

/// A file of a program that is divided.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The name of the file, as the call looks for it.
    pub file: String,
    /// Its text, ready to be saved.
    pub text: Vec<u8>,
    /// Which template wrote each line of it, for which record.
    pub origins: Origins,
}

/// Writes `program` for `machine`.
///
/// # Errors
/// Everything that keeps the program from being written, up to a fixed number of findings, each with
/// the source line it comes from; mistakes in the machine's own files with their place there.
pub fn write(program: &Program, machine: &Machine) -> Result<Output, Vec<Diagnostic>> {
    write_named(program, machine, &program.name, &())
}

/// The same for the file `name`: by that, not by the name of the program, controllers of robots know it; and for somebody who
/// waits for it.
///
/// # Errors
/// As [`write()`]; the work was ended (`cancelled`).
pub fn write_named(
    program: &Program,
    machine: &Machine,
    name: &str,
    progress: &dyn Progress,
) -> Result<Output, Vec<Diagnostic>> {
    let is_error = |found: &Diagnostic| found.severity == Severity::Error;
    let (errors, warnings) = program.tools_under_one_number().into_iter().partition(is_error);
    let errors: Vec<Diagnostic> = errors;
    if !errors.is_empty() {
        return Err(errors);
    }
    let leads = match machine.wire {
        Some(_) => Vec::new(),
        None => leads::check(program, robot(machine).is_none().then(|| machine.resolution())),
    };
    let (errors, of_leads) = leads.into_iter().partition(is_error);
    let (mut errors, of_leads): (Vec<Diagnostic>, Vec<Diagnostic>) = (errors, of_leads);
    let written = match robot(machine) {
        Some(robot) => write_arm(program, machine, robot, name, progress),
        None => write_moves(program, machine, progress),
    };
    let mut output = match written {
        Ok(output) if errors.is_empty() => output,
        Ok(_) => return Err(errors),
        Err(mut found) => {
            found.append(&mut errors);
            return Err(found);
        }
    };
    let warnings: Vec<Diagnostic> = warnings;
    output.warnings.extend(warnings.into_iter().chain(of_leads));
    if !machine.loaded_from.files.is_empty() {
        output.warnings.extend(without_effect(machine));
    }
    Ok(output)
}

fn write_arm(
    program: &Program,
    machine: &Machine,
    robot: (&::arm::Arm, &machine::Cell),
    name: &str,
    progress: &dyn Progress,
) -> Result<Output, Vec<Diagnostic>> {
    let centered = center::centered(program, machine.resolution());
    let Some((offset, warning)) = centered.map_err(|found| vec![*found])? else {
        return arm::write(program, machine, robot, (name, false), progress);
    };
    let mut output = arm::write(&offset, machine, robot, (name, true), progress)?;
    output.warnings.push(warning);
    let places = places(program, &offset);
    output.origins = output.origins.moved(|record| places.get(record).copied());
    for part in &mut output.parts {
        part.origins =
            std::mem::take(&mut part.origins).moved(|record| places.get(record).copied());
    }
    Ok(output)
}

fn write_moves(
    program: &Program,
    machine: &Machine,
    progress: &dyn Progress,
) -> Result<Output, Vec<Diagnostic>> {
    let split = sweep::split(program, machine, progress).map_err(|end| vec![*end])?;
    let Some(sweep::Split { records, places, lines }) = split else {
        let walk = walk::Walk::new(program, machine)?;
        return upright::check(program, machine)
            .map_err(|found| vec![*found])
            .and_then(|()| walk.run(progress));
    };
    let mut output = walk::Walk::new(&program.with_records(records), machine)?.run(progress)?;
    output.origins = output.origins.moved(|record| places.get(record).map(|place| *place as usize));
    let message = format!(
        "{} cuts turn the tool so far, or so near to a singular pose, that they are split, first here",
        lines.len()
    );
    let mut found = Diagnostic::warning(Rule::Sweep, message).line(lines[0]);
    found.places.extend(lines.iter().skip(1).take(MOST_PLACES));
    output.warnings.push(found);
    Ok(output)
}

/// Compiles the templates of `machine` and holds them against what its capabilities promise.
///
/// # Errors
/// The mistakes in the machine's files, with their place there.
pub fn check(machine: &Machine) -> Result<(), Vec<Diagnostic>> {
    match robot(machine) {
        Some(robot) => arm::check(machine, robot),
        None => walk::Walk::new(&Program::default(), machine).map(drop),
    }
}

/// The arm and its cell, where the machine is a robot.
fn robot(machine: &Machine) -> Option<(&::arm::Arm, &machine::Cell)> {
    machine.arm.as_ref().zip(machine.cell.as_ref())
}
