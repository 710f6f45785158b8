//! Where joints may lead the tool off the straight line of a rapid: as high as the source ever goes, and beyond all its cuts.

use super::{Comparison, STRIDE, refused};
use geom::{Frame, Vec3, angle_between};
use program::{Outcome, Rule};

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
    fn top(&self, axis: Vec3) -> Top {
        let beyond = self.cuts.reach(axis) + self.machine.capabilities.rapid_clearance;
        Top { axis, height: self.tops.along(axis).max(beyond) }
    }

    /// Why the tool is not free of the part with its tip there, `unmeasured` mm off at the most. It is where it is `rapid_clearance` beyond all cuts along its
    /// own axis, and as high as the source ever goes: along the tool, as it leans at that end of the motion to which it is nearest.
    fn blocked(
        &self,
        (tip, axis): (Vec3, Vec3),
        ends: &[Top; 2],
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
        let leans = ends.map(|end| angle_between(axis, end.axis));
        let along = ends[usize::from(leans[1] < leans[0])];
        let low = along.short(tip) + unmeasured;
        (low > can.rapid_corridor).then(|| {
            let besides = match unmeasured > 0.0 {
                true => format!(" and the {unmeasured} mm that its joints may be off"),
                false => String::new(),
            };
            format!(
                "{low:.2} mm lower along the tool than the source ever goes{besides}: nobody knows what is around it there"
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
        let tops = ends.map(|tool| self.top(-self.in_part(tool).matrix3.z_axis));
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
