//! The way off a contour, and the way to it: neither may cut into it.

use super::faults::error;
use super::plane::{Plane, SAME};
use crate::event::Position;
use crate::kernel::Outcome;
use geom::{Element, Vec2};
use program::Rule;

/// The end of a contour that the tool has not left yet.
pub(super) struct Leaving {
    pub plane: Plane,
    pub guarded: bool,
    /// The last element, and its parallel.
    pub contour: Element,
    pub parallel: Element,
}

impl Leaving {
    /// # Errors
    /// The tool does not leave the contour by a straight move to `pose`.
    pub(super) fn check(&self, line: u32, pose: &Position) -> Outcome {
        let (to, _) = self.plane.flat(pose.point);
        if !self.guarded || to.is_nan() {
            return Ok(());
        }
        if to.distance(self.contour.end) < SAME && to.distance(self.parallel.end) > SAME {
            let message = "compensation is switched off in the block of a move out of its plane: whether the \
                           tool goes to the contour is not known";
            return Err(error(Rule::CompensationExit, line, message)
                .help("switch it off in a straight move in the plane")
                .into());
        }
        if cuts(to, &self.contour.reversed(), &self.parallel.reversed()) {
            let message = "the way off the contour cuts into it";
            return Err(error(Rule::CompensationGouge, line, message)
                .help("end on the tool's side of the contour, or beyond its end")
                .into());
        }
        Ok(())
    }
}

/// Whether the straight way from `from` to the start of `parallel` cuts into `contour` beyond its
/// first point, which each control passes as close as the way leads.
pub(super) fn cuts(from: Vec2, contour: &Element, parallel: &Element) -> bool {
    let (back, outward) = (from - parallel.start, parallel.start - contour.start);
    if back.length() < SAME || outward.length() < SAME {
        return false;
    }
    let ahead = back.dot(contour.tangent(0.0)) > SAME;
    let inward = back.dot(outward.normalize()) < -SAME;
    let way = Element::line(from, parallel.start);
    ahead && inward || way.crossings(parallel).any(|crossing| crossing.cut > SAME)
}
