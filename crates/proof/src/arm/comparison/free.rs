//! Where joints may lead the tool off the straight line of a rapid: as high as the source ever goes, along the tool and along Z, and beyond all its cuts.

use super::super::follow::Path;
use super::{Comparison, STRIDE, Standing, refused};
use geom::{Frame, Vec3, angle_between};
use program::{Diagnostic, LYING, Outcome, Pose, Rule};

/// From how high along an axis, mm, nothing is known that would be in the way: as high as the source ever goes, and beyond all cuts.
#[derive(Clone, Copy, Debug)]
struct Top {
    axis: Vec3,
    height: f64,
}

impl Top {
    /// How far a tip is below it, mm.
    fn short(&self, tip: Vec3) -> f64 {
        self.height - tip.dot(self.axis)
    }
}

impl Comparison<'_> {
    /// That of a tool that leans so.
    fn top_of(&self, axis: Vec3) -> Top {
        let beyond = self.cuts.reach(axis) + self.machine.capabilities.rapid_clearance;
        Top { axis, height: self.tops.along(axis).max(beyond) }
    }

    /// Says what was taken for the top of the part where the source does not say how high that is.
    pub(super) fn assumed_heights(&mut self) {
        if let Some(height) = self.tops.below_zero() {
            let message = format!(
                "the toolpath goes no higher than Z{height:.1}, below its zero, which is taken for the top of the part: joints may lead the tool from 1 mm above \
                 zero on, and from there it goes straight along its axis"
            );
            let help = "begin and end the toolpath with a rapid above the part";
            self.report.warn(Diagnostic::warning(Rule::HomeHeight, message).help(help));
        }
        let highest = self.tops.along(Vec3::Z) - self.machine.capabilities.rapid_corridor;
        let sent_home = self.source.sent_home.filter(|from| *from >= highest);
        if let Some(height) = sent_home.filter(|_| self.cuts.reach(Vec3::Z) > 0.0) {
            let message = format!(
                "the source sends Z home from Z{height:.1}, the highest place that it names, and cuts above its zero, which is not the top of the part then: \
                 joints may lead the tool home from there, and from home to there"
            );
            let help = "nothing of the part and its clamps may be higher than that: else a rapid above them before Z goes home";
            self.report.warn(Diagnostic::warning(Rule::HomeHeight, message).help(help));
        }
    }

    /// Why the tool is not free of the part with its tip there, `unmeasured` mm off at the most. It is where it is `rapid_clearance` beyond all cuts along its
    /// own axis, and as high as the source ever goes: along the tool, as it leans at that end of the motion to which it is nearest, along the ways in to which
    /// it leans near there, and along Z. A tool that leans is as high along itself deep in a pocket, far on the side to which it leans.
    fn blocked(&self, place: (Vec3, Vec3), ends: &[Top], unmeasured: f64) -> Option<String> {
        self.blocked_along_tool(place, ends, unmeasured).or_else(|| {
            let upward = Top { axis: Vec3::Z, height: self.tops.upward() };
            self.too_low(upward.short(place.0) + unmeasured, ("Z", unmeasured))
        })
    }

    /// The same without its height along Z.
    fn blocked_along_tool(
        &self,
        (tip, axis): (Vec3, Vec3),
        ends: &[Top],
        unmeasured: f64,
    ) -> Option<String> {
        let beyond = tip.dot(axis) - self.cuts.reach(axis);
        let clearance = self.machine.capabilities.rapid_clearance + unmeasured;
        if beyond < clearance - STRIDE / 2.0 {
            return Some(format!(
                "{beyond:.2} mm beyond the cuts along the tool: {clearance} mm are asked for"
            ));
        }
        let leans = |end: &Top| angle_between(axis, end.axis);
        let own = ends.iter().min_by(|a, b| leans(a).total_cmp(&leans(b)))?;
        self.too_low(own.short(tip) + unmeasured, ("the tool", unmeasured)).or_else(|| {
            let corridor = self.machine.capabilities.rapid_corridor;
            let low = |short: f64, _: f64| short + unmeasured;
            let low = self.tops.along_ways_in((tip, own.axis), corridor, low);
            self.too_low(low, ("the way in", unmeasured))
        })
    }

    /// Says so where the tool is so much lower than it has to be, mm, by what is unmeasured at the most.
    fn too_low(&self, low: f64, (along, unmeasured): (&str, f64)) -> Option<String> {
        (low > self.machine.capabilities.rapid_corridor).then(|| {
            let besides = match unmeasured > 0.0 {
                true => format!(" and the {unmeasured} mm that its joints may be off"),
                false => String::new(),
            };
            format!(
                "{low:.2} mm lower along {along} than the source ever goes{besides}: nobody knows what is around it there"
            )
        })
    }

    /// Looks at the places of the tool on a way, between two ends, that is not the line of the source.
    ///
    /// # Errors
    /// The tool is not free at one of them.
    pub(super) fn off_line(
        &self,
        places: impl Iterator<Item = Frame>,
        ends: [&Frame; 2],
        (what, unmeasured): (&str, f64),
    ) -> Outcome {
        let tops = ends.map(|tool| self.top_of(-self.in_part(tool).matrix3.z_axis));
        for tool in places {
            let at = self.in_part(&tool);
            let (tip, axis) = (at.translation, -at.matrix3.z_axis);
            let Some(why) = self.blocked((tip, axis), &tops, unmeasured) else { continue };
            let message =
                format!("{what} the tip comes to X{:.1} Y{:.1} Z{:.1}, {why}", tip.x, tip.y, tip.z);
            let help = "go there by a straight line, or straight up along the tool first until it is so high along Z, too, and down along it at the end; a program of an earlier version: post it again";
            return refused(Rule::RapidPath, message).map_err(|found| Box::new(found.help(help)));
        }
        Ok(())
    }

    /// How far a straight line leads the tool up along Z, mm, below 0 where it leads down, with nothing in the way: the tool lies, and is all along as high
    /// along itself as the source ever goes. 0 where it is none.
    pub(super) fn ascent(&self, start: &Standing, path: &Path) -> f64 {
        let ends = [start.tool, (path.at)(1.0)];
        let [from, to] = ends.map(|end| self.in_part(&end));
        let (way, axis) = (to.translation - from.translation, -from.matrix3.z_axis);
        let aside = way.reject_from_normalized(Vec3::Z).length();
        let is_along = aside <= self.tip(true) + 1e-4 * path.length && path.turn < 1e-4;
        let tops = [self.top_of(axis)];
        let mut tips = [from, to].into_iter().map(|end| (end.translation, axis));
        let is_free = is_along
            && lies(axis)
            && tips.all(|tip| self.blocked_along_tool(tip, &tops, 0.0).is_none());
        if is_free { way.z } else { 0.0 }
    }

    /// Whether the tool stands where such a line, and one along the tool behind it, lead down to a pose.
    pub(super) fn is_over(&self, at: &Frame, pose: &Pose) -> bool {
        let tool = self.in_part(at);
        let (axis, off) = (pose.axis(), tool.translation - pose.point());
        if !lies(axis) {
            return false;
        }
        // Across the tool the way is up along Z alone.
        let across = Vec3::Z.reject_from_normalized(axis);
        let up = off.dot(across) / across.length_squared();
        let foot = Frame::from_mat3_translation(tool.matrix3, tool.translation - Vec3::Z * up);
        up > 0.0 && self.stands_above(&foot, pose, f64::INFINITY)
    }
}

/// Whether a tool leans by so much that it lies rather than stands: up along it, it would go far aside before it is higher along Z.
fn lies(axis: Vec3) -> bool {
    // Rounding of the words.
    axis.z < LYING + 1e-4
}
