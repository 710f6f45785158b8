//! Toolpaths that tilt the tool, on machines that cannot.

use crate::coordinate_mode::same;
use geom::Vec3;
use machine::{Machine, library};
use program::{Diagnostic, Program, Rule};

/// So many machines with rotary axes are named.
const NAMED: usize = 4;

/// A machine without rotary axes takes toolpaths alone whose tool stands upright.
///
/// # Errors
/// `unreachable-orientation` once for the whole toolpath, at its first move with a tilted tool.
pub(crate) fn check(program: &Program, machine: &Machine) -> Result<(), Box<Diagnostic>> {
    if !machine.rotary.is_empty() || machine.wire.is_some() {
        return Ok(());
    }
    let poses = program.records.iter().filter_map(|record| Some((record.line, record.op.pose()?)));
    let tilted = poses.filter(|(_, pose)| !same(pose.axis(), Vec3::Z));
    let mut tilted =
        tilted.map(|(line, pose)| (line, pose.axis().angle_between(Vec3::Z).to_degrees()));
    let Some((first, mut most)) = tilted.next() else { return Ok(()) };
    let mut found = Diagnostic::error(Rule::UnreachableOrientation, "").line(first);
    for (line, degrees) in tilted {
        found.again(line);
        most = most.max(degrees);
    }
    let message = format!(
        "five-axis toolpath, three-axis machine: the toolpath tilts the tool by up to {most:.3}° from Z, and \
         the machine has no rotary axes"
    );
    let help = format!(
        "choose a machine with rotary axes, such as {}; or post the operations alone whose tool stands upright",
        with_rotary_axes(machine)
    );
    Err(Box::new(Diagnostic { message, ..found.help(help) }))
}

/// Some machines of the library that turn the tool or the part, those of the same control first.
fn with_rotary_axes(machine: &Machine) -> String {
    let all = library::names(library::MACHINES).filter_map(|name| machine::load(name).ok());
    let mut all: Vec<Machine> = all.filter(|known| !known.rotary.is_empty()).collect();
    all.sort_by_key(|known| known.reader != machine.reader);
    let names: Vec<String> =
        all.iter().take(NAMED).map(|known| format!("`{}`", known.name)).collect();
    names.join(", ")
}
