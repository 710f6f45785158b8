//! Which path a source gives where it compensates, and what the tool table of the machine makes of it.
//!
//! A contour is compared twice: as the program says it, with the rest of the program, and as its control leads the centre of the
//! source's tools along it ([`resolved`], [`centre`]).

pub(crate) mod centre;
pub(crate) mod resolved;
pub(crate) mod trail;

use crate::report::SourceLine;
use control::{Action, ArcTo, Dialect, Position};
use machine::{Machine, ToolRadius};
use program::{CompensatedPath, Compensation, Diagnostic, Program, Rule};

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
    let message = format!("{}{message}", SourceLine(line));
    Some(Diagnostic::error(Rule::CompensatedPath, message).help(help))
}

/// Why no program of an arm can be compared with `source`: which path it gives is not known. A contour is compared with where the program
/// leads the tool's centre, since no robot offsets it.
pub(crate) fn unsettled_for_arm(source: &Program) -> Option<Diagnostic> {
    let line = source.compensates().filter(|_| source.compensated_path.is_none())?;
    let message = format!(
        "{}whether the coordinates with compensation are the path of the tool's centre or the contour is not known",
        SourceLine(line)
    );
    let help = "`--cutcom centre` or `--cutcom contour`";
    Some(Diagnostic::error(Rule::CompensatedPath, message).help(help))
}

/// Whether the virtual control of `machine` is to be asked where it leads the tools of `source`.
///
/// # Errors
/// That it cannot be, as a warning, where it should.
pub(crate) fn is_resolved(source: &Program, machine: &Machine) -> Result<bool, Box<Diagnostic>> {
    let compensates = source.compensates().is_some();
    if !compensates || machine.wire.is_some() || !is_due(source, machine) {
        return Ok(false);
    }
    if Dialect::named(&machine.reader).is_some_and(Dialect::resolves_compensation) {
        return Ok(true);
    }
    Err(resolved::not_compared("how this control leads it is not documented well enough").into())
}

/// What an action means for a contour.
pub(crate) enum Part<'a> {
    /// A move to a position, along an arc where it is one.
    Move(&'a Position, Option<&'a ArcTo>),
    /// No contour has this within: the tool is led away.
    End,
    /// Compensation is a state from here on.
    Side(Compensation),
    /// Nothing.
    Other,
}

impl Part<'_> {
    pub fn of(action: &Action) -> Part<'_> {
        match action {
            Action::Rapid(position) | Action::Line(position) => Part::Move(position, None),
            Action::Arc(to) => Part::Move(&to.end, Some(to)),
            Action::Compensation(side) => Part::Side(*side),
            Action::Home(_)
            | Action::MachineMove(_)
            | Action::Tool(_)
            | Action::WorkOffset(_)
            | Action::Hole(_)
            | Action::Thread(_)
            | Action::Probe(_)
            | Action::TouchOff(_)
            | Action::Across(_) => Part::End,
            Action::Swivel(_)
            | Action::Cycle(_)
            | Action::CycleOff
            | Action::Feed(_)
            | Action::FeedPath(_)
            | Action::RapidsTogether(_)
            | Action::Spindle(_)
            | Action::SurfaceSpeed(_)
            | Action::Coolant(_)
            | Action::Preselect(_)
            | Action::LengthOffset(_)
            | Action::PathMode(_)
            | Action::Output(_)
            | Action::Input(_)
            | Action::Auxiliary(_)
            | Action::ThreadWire
            | Action::CutWire
            | Action::WorkOffsetData(_)
            | Action::Taper(_)
            | Action::Dwell(_)
            | Action::Stop
            | Action::OptionalStop
            | Action::Risk(_)
            | Action::Arm(_)
            | Action::Comment(_)
            | Action::Message(_)
            | Action::End => Part::Other,
        }
    }
}
