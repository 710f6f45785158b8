//! A cut that is left and entered again, where the cell allows that: straight up along the tool, by the joints above all cuts (also by way of home), straight
//! down along the tool to the same place, and on with the cut.

use super::super::expected::{Expected, Step};
use super::super::follow::Path;
use super::{Comparison, Standing, refused};
use crate::report::Excursion;
use control::{Action, ArmAction, ArmMove, Corner, Rounding};
use geom::{Vec3, nearest_on_segment};
use program::{Outcome, Pose, Rule};

/// Where the tool has left a cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Away {
    /// The place, in the frame of the source.
    place: Pose,
    /// Line of the source at whose motion it has left.
    source_line: u32,
    /// Line of the program on which it has left.
    line: u32,
    /// The highest that the tool has been above the place, mm.
    height: f64,
}

impl Comparison<'_> {
    /// Whether a line leads straight up out of a cut that is not at its end, where the cell allows that.
    pub(super) fn leaves_cut(&self, expected: &Expected, start: &Standing, path: &Path) -> bool {
        let before = self.next.checked_sub(1).and_then(|before| self.expected.get(before));
        let is_cut = |step: &Step| matches!(step, Step::Line(..) | Step::Arc(..));
        let within = self.done > 0.0 || before.is_some_and(|before| is_cut(&before.step));
        let end = self.in_part(&(path.at)(1.0)).translation;
        let is_off = match &expected.step {
            Step::Line(from, to) => {
                nearest_on_segment(from.point(), to.point(), end).1 > self.tip(true)
            }
            Step::Arc(..) => true,
            Step::Rapid(..)
            | Step::Above(_)
            | Step::Contour(_)
            | Step::Home
            | Step::Tool(_)
            | Step::Dwell(_)
            | Step::Stop
            | Step::Output(_)
            | Step::Input(_) => false,
        };
        self.cell.reentry_feed.is_some() && within && is_off && self.rise(start, path) > 0.0
    }

    /// Straight up out of a cut.
    ///
    /// # Errors
    /// It is passed by a corner, faster than the cell allows near the cut, or the joints cannot follow.
    pub(super) fn leave_cut(
        &mut self,
        line: u32,
        motion: &ArmMove,
        (start, path): (Standing, Path),
        from_corner: Option<Rounding>,
    ) -> Outcome {
        if from_corner.is_some() {
            let message = "the corner is passed at which the tool leaves the cut";
            return refused(Rule::PathTolerance, message);
        }
        let tool = self.in_part(&start.tool);
        let place = Pose::new(tool.translation, -tool.matrix3.z_axis)?;
        // At the end of a motion it is not yet that of the next one.
        let source_line = match self.done > 0.0 {
            true => self.expected.get(self.next).map_or(0, |expected| expected.line),
            false => self.line_before(),
        };
        self.away = Some(Away { place, source_line, line, height: 0.0 });
        self.axially(motion, (start, path))
    }

    /// A straight line while the tool is away from a cut; the last one brings it back.
    ///
    /// # Errors
    /// It does not lead along the tool above the place at which the cut was left.
    pub(super) fn line_away(
        &mut self,
        line: u32,
        motion: &ArmMove,
        start: Standing,
        path: Path,
    ) -> Outcome {
        let Some(away) = self.away else { return Ok(()) };
        let end = (path.at)(1.0);
        self.axially(motion, (start, path))?;
        if !self.arrives(&end, &away.place, false) {
            return Ok(());
        }
        self.away = None;
        self.report.excursion(Excursion {
            source_line: away.source_line,
            program_file: self.file.as_deref().map(str::to_owned),
            first_program_line: away.line,
            last_program_line: line,
            lift_mm: away.height,
        });
        Ok(())
    }

    /// A straight line along the tool, above the place at which the cut was left or to it.
    fn axially(&mut self, motion: &ArmMove, (start, path): (Standing, Path)) -> Outcome {
        let (Some(away), Some(most)) = (self.away, self.cell.reentry_feed) else { return Ok(()) };
        if motion.corner != Corner::Exact {
            return refused(
                Rule::PathTolerance,
                "a corner is passed while the tool is out of a cut",
            );
        }
        let end = (path.at)(1.0);
        if self.rise(&start, &path) == 0.0 || !self.is_above(&end, &away.place, f64::INFINITY) {
            let message = "the tool has left a cut, and does not go straight along its axis back to where it left";
            return refused(Rule::ExtraMotion, message);
        }
        let above = |tip: Vec3| (tip - away.place.point()).dot(away.place.axis());
        let heights = [&start.tool, &end].map(|tool| above(self.in_part(tool).translation));
        let lowest = heights[0].min(heights[1]);
        let clearance = self.machine.capabilities.rapid_clearance;
        if lowest < clearance - self.tip(true) {
            let Some(feed) = self.running.feed else {
                return refused(
                    Rule::NoFeed,
                    "the program goes straight and has not stated how fast",
                );
            };
            if feed > most + self.feed_step {
                let message = format!(
                    "the tool leaves a cut, or comes back to it, at {feed:.0} mm/min: `reentry_feed` of the cell is {most:.0}"
                );
                return refused(Rule::Feed, message);
            }
        }
        let height = away.height.max(heights[0]).max(heights[1]);
        self.away = Some(Away { height, ..away });
        self.pass(start, path, (motion, false))
    }

    /// A motion of the joints while the tool is away from a cut.
    ///
    /// # Errors
    /// It ends neither home nor above the place, comes near to a cut on the way, or goes beyond a limit.
    pub(super) fn joints_away(&mut self, shown: [f64; 6], rail: f64) -> Outcome {
        let Some(away) = self.away else { return Ok(()) };
        let Some((before, now)) = self.turn_joints(shown, rail)? else { return Ok(()) };
        self.clear([&before, &now], None)?;
        match self.is_home || self.is_above(&now.tool, &away.place, f64::INFINITY) {
            true => Ok(()),
            false => refused(
                Rule::ExtraMotion,
                "the tool has left a cut, and the joints do not bring it above the place at which it left",
            ),
        }
    }

    /// # Errors
    /// While the tool is away from a cut something else happens than that it comes back.
    pub(super) fn stays_away(&self, action: &Action) -> Outcome {
        let harmless = matches!(
            action,
            Action::Arm(
                ArmAction::Move(_)
                    | ArmAction::JointSpeed(_)
                    | ArmAction::JointRate(_)
                    | ArmAction::RailSpeed(_)
                    | ArmAction::TurnSpeed(_)
            ) | Action::Feed(_)
                | Action::Comment(_)
                | Action::Message(_)
                | Action::Risk(_)
        );
        match (self.away, harmless) {
            (None, _) | (Some(_), true) => Ok(()),
            (Some(_), false) => refused(
                Rule::Missing,
                "the tool has left a cut, and something else happens before it is back in it",
            ),
        }
    }
}
