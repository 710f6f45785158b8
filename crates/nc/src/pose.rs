//! Poses of a source: positions of rotary axes become a tool axis, what is not known yet is NaN, and how far anything may lie.

use crate::refuse;
use control::{Action, Orientation, Position};
use geom::Vec3;
use machine::Machine;
use program::{Diagnostic, Outcome, Pose, Rule, Spindle};

/// The farthest place, mm, as in cutter-location data.
pub(crate) const FARTHEST: f64 = 1e6;

/// The farthest centre of an arc, mm: one that is nearly straight has a far one.
pub(crate) const FARTHEST_CENTER: f64 = 1e9;

/// The largest feed, speed (1/min) and dwell (s).
pub(crate) const LARGEST: f64 = 1e9;

/// How far apart two equal points may be after a turn of the table, mm.
pub(crate) const ROUNDING: f64 = 1e-9;

/// A tool tip (mm) and a tool axis (unit vector) in the work frame; what is not known is NaN.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartialPose {
    pub(crate) tip: Vec3,
    pub(crate) axis: Vec3,
}

impl PartialPose {
    /// The same as a pose, where everything is known.
    pub(crate) fn complete(self) -> Option<Pose> {
        Pose::new(self.tip, self.axis).ok()
    }
}

/// The position of the tool, as far as the program determines it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ToolPosition {
    /// The given position at the start: a cut from there begins with a rapid to it.
    Start(PartialPose),
    /// The end of the last block.
    At(PartialPose),
    Unknown,
}

impl ToolPosition {
    pub(crate) fn pose(&self) -> Option<&PartialPose> {
        match self {
            ToolPosition::Start(pose) | ToolPosition::At(pose) => Some(pose),
            ToolPosition::Unknown => None,
        }
    }
}

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

/// The positions of X, Y and Z, in the coordinates of the work offset, mm.
pub(crate) fn axes_at(
    machine: &Machine,
    position: &Position,
    length: Option<f64>,
) -> Outcome<Vec3> {
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

/// The refusal of coordinates that no block has given.
#[cold]
pub(crate) fn unknown(what: &str, pose: &PartialPose) -> Box<Diagnostic> {
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
pub(crate) fn within_reach(action: &Action) -> Outcome {
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
