//! Which path a source gives where it compensates, and what the tool table of the machine makes of it.

use machine::{Machine, ToolRadius};
use program::{CompensatedPath, Diagnostic, Program};

/// Whether a program for `machine` has to compensate where `source` does. A path of the tool's centre goes without, unless the
/// tool table keeps nothing but wear: the control would offset it by the tool once more.
pub(crate) fn is_due(source: &Program, machine: &Machine) -> bool {
    let keeps_wear = machine.settings.tool_radius == Some(ToolRadius::Wear);
    machine.wire.is_some()
        || source.compensated_path != Some(CompensatedPath::Center)
        || keeps_wear && machine.capabilities.compensation
}

/// Why no program of `machine` can be compared with `source`: what the control would offset, and by what, is not known or does
/// not go together.
pub(crate) fn unsettled(source: &Program, machine: &Machine) -> Option<Diagnostic> {
    let line = source.compensates().filter(|_| machine.wire.is_none())?;
    let (message, help) = match (source.compensated_path, machine.settings.tool_radius) {
        (Some(CompensatedPath::Center), _)
        | (Some(CompensatedPath::Contour), Some(ToolRadius::Full)) => return None,
        (None, _) => (
            "whether the coordinates with compensation are the path of the tool's centre or the contour is not known",
            "`--cutcom centre` or `--cutcom contour`",
        ),
        (Some(CompensatedPath::Contour), Some(ToolRadius::Wear)) => (
            "the source gives the contour, and the tool table keeps nothing but wear: the tool is off by its radius",
            "a machine whose table keeps the full radius (`tool_radius` in [settings])",
        ),
        (Some(CompensatedPath::Contour), None) => (
            "the source gives the contour, and whether the tool table keeps the radius of the tool is not known",
            "`tool_radius = \"full\"` in [settings] of the machine file, where it does",
        ),
    };
    let message = format!("source line {line}: {message}");
    Some(Diagnostic::error("compensated-path", message).help(help))
}
