//! What every comparison needs to know: the machine, the tolerances, the length of the tool.

use crate::resolved_pose::{PartialPose, ResolvedPose};
use crate::state::CornerLimits;
use crate::tolerance::Applied;
use control::Position;
use machine::Machine;

/// The machine, the tolerances, the length of the active tool.
#[derive(Clone, Copy)]
pub(crate) struct Gauge<'a> {
    pub machine: &'a Machine,
    pub allowed: Applied,
    pub corners: CornerLimits,
    /// mm, where the source says it.
    pub tool_length: Option<f64>,
    /// Whether the axes go together in a rapid, on a straight line.
    pub straight_rapids: bool,
}

impl Gauge<'_> {
    /// What a block says, and where that is.
    pub fn resolve(&self, line: u32, position: Position) -> ResolvedPose {
        ResolvedPose {
            line,
            position,
            place: PartialPose::of(self.machine, &position, self.tool_length),
        }
    }

    /// How far the tip may be from where it should be at `pose`, mm.
    pub fn slack(&self, pose: &ResolvedPose) -> f64 {
        self.allowed.tip(self.machine, &pose.position, &pose.place, self.tool_length)
    }

    /// Whether `pose` is at `place`: tip and axis. Never where a coordinate is not known.
    pub fn at(&self, pose: &ResolvedPose, place: &PartialPose) -> bool {
        let (tip, axis) = pose.place.apart(place);
        tip <= self.slack(pose) && axis <= self.allowed.axis_degrees
    }

    /// Whether two places of the program are one: each is rounded for itself.
    pub fn meet(&self, a: &ResolvedPose, b: &ResolvedPose) -> bool {
        let (tip, axis) = a.place.apart(&b.place);
        tip <= self.slack(a) + self.slack(b) && axis <= 2.0 * self.allowed.axis_degrees
    }

    /// How far `pose` stands above `place` along its axis, where it stands on that axis.
    pub fn height_over(&self, place: &PartialPose, pose: &ResolvedPose) -> Option<f64> {
        let (height, aside) = place.above(pose.place.tip);
        (aside <= self.slack(pose)).then_some(height)
    }
}
