//! Where joints may lead the tool off the straight line of a rapid: as high as the source ever goes, and beyond all its cuts.

use super::{Comparison, STRIDE, refused};
use geom::{Frame, Vec3, angle_between};
use program::{ALIKE, Outcome, Rule};

/// What is free at an end of a motion.
#[derive(Clone, Copy, Debug)]
struct Top {
    /// How the tool leans there.
    axis: Vec3,
    /// From how high along that axis nothing is known that would be in the way, mm: as high as the source ever goes with its tool leaning alike, and beyond
    /// all cuts. None where it never leans so.
    height: Option<f64>,
}

impl Top {
    /// How far a tip is below it, mm.
    fn short(&self, tip: Vec3) -> Option<f64> {
        self.height.map(|height| height - tip.dot(self.axis))
    }
}

impl Comparison<'_> {
    /// What is free at the ends of a motion, `clearance` mm beyond all cuts.
    fn tops(&self, ends: [&Frame; 2], clearance: f64) -> [Top; 2] {
        ends.map(|tool| {
            let axis = -self.in_part(tool).matrix3.z_axis;
            let height = Some(self.tops.along(axis)).filter(|height| height.is_finite());
            let beyond = self.cuts.reach(axis) + clearance;
            Top { axis, height: height.map(|height| height.max(beyond)) }
        })
    }

    /// Why the tool is not free of the part with its tip there, `unmeasured` mm off at the most. It is where it is `rapid_clearance` beyond all cuts along its
    /// own axis, and as high as the source ever goes: along the axis of that end of the motion which it leans like, or, where it leans like neither, of one of
    /// them. Near an end at which it leans as the source never does, the cuts alone count.
    fn blocked(
        &self,
        (tip, axis): (Vec3, Vec3),
        tops: &[Top; 2],
        unmeasured: f64,
    ) -> Option<String> {
        let can = &self.machine.capabilities;
        let beyond = tip.dot(axis) - self.cuts.reach(axis);
        let clearance = can.rapid_clearance + unmeasured;
        if beyond < clearance - STRIDE / 2.0 {
            return Some(format!(
                "{beyond:.2} mm beyond the cuts along the tool: {clearance} mm are asked for"
            ));
        }
        let [first, last] = tops.map(|top| angle_between(axis, top.axis));
        let (near, far, lean) = match last < first {
            true => (tops[1], tops[0], last),
            false => (tops[0], tops[1], first),
        };
        let low = near.short(tip)? + unmeasured;
        let other = far.short(tip).filter(|_| lean > ALIKE).map(|low| low + unmeasured);
        let low = low.min(other.unwrap_or(f64::INFINITY));
        (low > can.rapid_corridor).then(|| {
            let besides = match unmeasured > 0.0 {
                true => format!(" and the {unmeasured} mm that its joints may be off"),
                false => String::new(),
            };
            format!(
                "{low:.2} mm lower along the tool than the source ever goes with it leaning so{besides}: nobody knows what is around it there"
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
        let tops = self.tops(ends, self.machine.capabilities.rapid_clearance);
        for tool in places {
            let at = self.in_part(&tool);
            let (tip, axis) = (at.translation, -at.matrix3.z_axis);
            let Some(why) = self.blocked((tip, axis), &tops, unmeasured) else { continue };
            let message =
                format!("{what} the tip comes to X{:.1} Y{:.1} Z{:.1}, {why}", tip.x, tip.y, tip.z);
            let help = "go there by a straight line, or straight up along the tool first and down along it at the end; a program of an earlier version: post it again";
            return refused(Rule::RapidPath, message).map_err(|found| Box::new(found.help(help)));
        }
        Ok(())
    }
}
