//! Where the tool may leave the straight line of a rapid: beyond all that the source cuts, and not below where one of its feeds begins.

use super::{Comparison, STRIDE, refused};
use geom::Vec3;
use program::{Outcome, Pose, Rule};

impl Comparison<'_> {
    /// Why the tool is not free of the part with its tip there, `unmeasured` mm off at the most. It is where it is `rapid_clearance` beyond all cuts along its
    /// own axis, and not below where a feed of the source begins, but for `rapid_corridor`: what is fed through may be material up to there.
    fn blocked(&self, (tip, axis): (Vec3, Vec3), unmeasured: f64) -> Option<String> {
        let height = tip.dot(axis);
        let can = &self.machine.capabilities;
        let (beyond, above) = (height - self.cuts.reach(axis), height - self.fed.reach(axis));
        let clearance = can.rapid_clearance + unmeasured;
        if beyond < clearance - STRIDE / 2.0 {
            return Some(format!(
                "{beyond:.2} mm beyond the cuts along the tool: {clearance} mm are asked for"
            ));
        }
        (above < unmeasured - can.rapid_corridor).then(|| match unmeasured > 0.0 {
            true => format!(
                "{above:.2} mm above where the source begins to feed: {unmeasured} mm are asked for"
            ),
            false => {
                format!("{:.2} mm below where the source begins to feed into the part", -above)
            }
        })
    }

    /// The ends of a rapid that leads into the part or out of it: at one of them the tool is not `rapid_clearance` beyond all that the source feeds through.
    pub(super) fn part_way(&self, from: &Pose, to: &Pose) -> Option<[Vec3; 2]> {
        let clearance = self.machine.capabilities.rapid_clearance;
        let is_in = |pose: &Pose| {
            pose.point().dot(pose.axis()) - self.fed.reach(pose.axis()) < clearance - 1e-6
        };
        (is_in(from) || is_in(to)).then(|| [from.point(), to.point()])
    }

    /// Looks at a place of the tool off the line of the source. `part_way` are the ends of the rapid that is made there, where it leads into the part: the
    /// tool is then not lower than its higher end either, for it may go through a hole that was there before.
    ///
    /// # Errors
    /// The tool is not free there.
    pub(super) fn off_line(
        &self,
        (tip, axis): (Vec3, Vec3),
        part_way: Option<[Vec3; 2]>,
        (what, unmeasured): (&str, f64),
    ) -> Outcome {
        let highest = |[a, b]: [Vec3; 2]| a.dot(axis).max(b.dot(axis));
        let above = part_way.map_or(f64::INFINITY, |ends| tip.dot(axis) - highest(ends));
        let short = unmeasured - above;
        let why = self.blocked((tip, axis), unmeasured).or_else(|| {
            (short > self.machine.capabilities.rapid_corridor).then(|| {
                format!("{short:.2} mm too low: a rapid into the part or out of it is not left below its higher end")
            })
        });
        let Some(why) = why else { return Ok(()) };
        let message =
            format!("{what} the tip comes to X{:.1} Y{:.1} Z{:.1}, {why}", tip.x, tip.y, tip.z);
        refused(Rule::RapidPath, message)
            .map_err(|found| Box::new(found.help("go there by a straight line, or higher")))
    }
}
