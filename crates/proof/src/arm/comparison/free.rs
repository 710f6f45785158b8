//! Where the tool may leave the straight line of a rapid: beyond all that the source cuts, and not below where one of its feeds begins.

use super::super::expected::Step;
use super::ONE_LINE;
use super::{Comparison, STRIDE, refused};
use geom::{Vec3, angle_between};
use program::{Outcome, Pose, Rule};
use std::ops::Range;

/// Whether a rapid goes on along the line of those before it, with the tool as it was; one that goes nowhere does.
fn goes_on(before: &[Pose; 2], next: &[Pose; 2]) -> bool {
    let ways = [before, next].map(|[from, to]| to.point() - from.point());
    let poses = [before[0], before[1], next[1]];
    let turns = poses.iter().any(|pose| angle_between(pose.axis(), next[0].axis()) > ONE_LINE);
    !turns && (ways.contains(&Vec3::ZERO) || angle_between(ways[0], ways[1]) <= ONE_LINE)
}

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

    /// The ends of a step that is a rapid from a known place, `Some(None)` of one in which the tool stands.
    fn rapid_at(&self, at: usize) -> Option<Option<[Pose; 2]>> {
        match &self.expected.get(at)?.step {
            Step::Rapid(Some(from), to) => Some(Some([*from, *to])),
            Step::Dwell(_) | Step::Stop | Step::Output(_) | Step::Input(_) => Some(None),
            Step::Rapid(None, _)
            | Step::Above(_)
            | Step::Line(..)
            | Step::Arc(..)
            | Step::Contour(_)
            | Step::Home
            | Step::Tool(_) => None,
        }
    }

    /// Where the rapids along one line begin and end of which the next step is one: stops on the way do not make two ways of one. From home, where nobody
    /// knows from how high the source comes, its end and that of the rapids by which it goes up again, where the tool leans the same way there.
    fn line_of_rapids(&mut self) -> Option<[Pose; 2]> {
        let next = self.next;
        if let Some((steps, ends)) = &self.line_of_rapids
            && steps.contains(&next)
        {
            return Some(*ends);
        }
        let step = &self.expected.get(next)?.step;
        let (steps, ends) = if let Step::Rapid(None, to) = step {
            let behind = (next + 1..self.expected.len())
                .take_while(|at| !matches!(self.expected[*at].step, Step::Home | Step::Tool(_)));
            let mut rapids = behind.filter(|at| self.rapid_at(*at).flatten().is_some());
            let up = rapids.next().and_then(|at| self.along_line(at)).map(|(_, ends)| ends[1]);
            let up = up.filter(|up| angle_between(up.axis(), to.axis()) <= ONE_LINE);
            (next..next + 1, [*to, up.unwrap_or(*to)])
        } else {
            self.along_line(next)?
        };
        self.line_of_rapids = Some((steps, ends));
        Some(ends)
    }

    /// The rapids along one line of which a step is one: which steps, and where they begin and end.
    fn along_line(&self, at: usize) -> Option<(Range<usize>, [Pose; 2])> {
        let mut ends = self.rapid_at(at)??;
        let (mut first, mut last) = (at, at);
        while let Some(before) = first.checked_sub(1).and_then(|at| self.rapid_at(at)) {
            match before {
                Some(before) if goes_on(&before, &ends) => ends[0] = before[0],
                Some(_) => break,
                None => {}
            }
            first -= 1;
        }
        while let Some(behind) = self.rapid_at(last + 1) {
            match behind {
                Some(behind) if goes_on(&ends, &behind) => ends[1] = behind[1],
                Some(_) => break,
                None => {}
            }
            last += 1;
        }
        Some((first..last + 1, ends))
    }

    /// The ends of the rapids along one line to which the next step belongs, where they lead into the part or out of it: at one of them the tool is not
    /// `rapid_clearance` beyond all that the source feeds through.
    pub(super) fn part_way(&mut self) -> Option<[Vec3; 2]> {
        let [from, to] = &self.line_of_rapids()?;
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
