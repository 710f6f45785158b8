//! Motions of the joints: home, rapids, and the path that the tool takes on them.

use super::super::expected::{REENTRY, Step};
use super::super::follow::limit;
use super::{Comparison, STRIDE, Standing, refused};
use crate::observer::Deviation;
use ::arm::Joints;
use geom::{Frame, Vec3, angle_between, nearest_on_segment};
use program::{Diagnostic, Outcome, Pose, Rule};

/// Joints that differ by no more are the same, radians: what the rounding of a pose that has led there does, too.
const SAME_JOINTS: f64 = 1e-4;

impl Comparison<'_> {
    /// A motion of all joints.
    pub(super) fn joints(&mut self, shown: [f64; 6], rail: f64) -> Outcome {
        let Some((before, now)) = self.turn_joints(shown, rail)? else {
            return Ok(());
        };
        let Standing { joints, tool: at, .. } = now;
        let home = self.is_home;
        let same = before.joints.iter().zip(joints).all(|(a, b)| (a - b).abs() <= SAME_JOINTS);
        if same && before.tool.translation.distance(at.translation) <= self.tip(true) {
            // A file of a program begins by the joints at which the one before has ended.
            return Ok(());
        }
        let wanted = self.expected.get(self.next).map(|expected| expected.step.clone());
        let rapid = match &wanted {
            Some(Step::Rapid(from, to)) => Some((*from, *to)),
            _ => None,
        };
        let arrives = match &wanted {
            Some(Step::Rapid(_, to)) => self.arrives(&at, to, true),
            Some(Step::Above(last)) => self.is_above(&at, last, REENTRY),
            _ => false,
        };
        let line = match (&wanted, rapid) {
            (Some(Step::Above(_)), _) => {
                Some([before.tool, at].map(|tool| self.in_part(&tool).translation))
            }
            (_, Some((Some(from), to))) => Some([from.point(), to.point()]),
            (_, _) => None,
        };
        self.clear([&before, &now], line.filter(|_| arrives))?;
        // From above the end of a rapid the tool goes down to it along its axis.
        let is_over = rapid.is_some_and(|(_, to)| {
            self.is_above(&at, &to, f64::INFINITY) || self.is_over(&at, &to)
        });
        match arrives {
            true => {
                if let Some((_, to)) = rapid {
                    let off = self.off(&at, &to);
                    Deviation::widen(&mut self.deviation, off);
                }
                self.report.compared.rapids += 1;
                self.make_next();
                Ok(())
            }
            false if self.done == 0.0 && (home || is_over) => Ok(()),
            false => {
                let end = self.in_part(&at).translation;
                let message = format!(
                    "the joints bring the tip to X{:.3} Y{:.3} Z{:.3}, where the source does not go by rapid",
                    end.x, end.y, end.z
                );
                let found = Diagnostic::error(Rule::EndPoint, message);
                Err(found.help(self.way_to_end()).into())
            }
        }
    }

    /// Turns the joints to what the controller shows; where the arm stood, and where it stands. `None` where it was led from somewhere to home.
    ///
    /// # Errors
    /// A joint beyond its limit, too fast, or frames that are not those of the cell; the first motion does not lead home.
    pub(super) fn turn_joints(
        &mut self,
        shown: [f64; 6],
        rail: f64,
    ) -> Outcome<Option<(Standing, Standing)>> {
        let home = shown.iter().zip(self.cell.home).all(|(at, home)| (at - home).abs() < 1e-3)
            && (rail - self.cell.rail_home()).abs() < 1e-3;
        let Some(joints) = self.arm.model(&shown.map(f64::to_radians)) else {
            return refused(Rule::ArmCoupling, "how the controller counts joint 3 is not known");
        };
        let margin = limit(self.arm, &joints).or_else(|lost| self.lost(Rule::AxisLimit, lost))?;
        self.checked().note_limit(margin);
        self.frames()?;
        self.joint_speed()?;
        let (Some(base), Some(tool)) = (self.running.base, self.running.tool) else {
            return Ok(None);
        };
        let at = base.inverse() * self.cell.foot(rail) * self.arm.flange(&joints) * tool;
        let exact = self.arm.unmeasured() == 0.0;
        let now = Standing { joints, rail, tool: at, exact, by_joints: true };
        let before = self.standing.replace(now);
        self.is_home = home;
        match (before, home) {
            (Some(before), _) => {
                self.leaves_turning(&before)?;
                if before.rail != rail {
                    self.rail_speed()?;
                }
                Ok(Some((before, now)))
            }
            (None, true) => Ok(None),
            (None, false) => refused(
                Rule::Home,
                "the first motion, of the program or behind a tool change, does not bring the joints home",
            ),
        }
    }

    /// # Errors
    /// The joints go faster than the cell states, or nothing states how fast though the control has a word for it.
    fn joint_speed(&self) -> Outcome {
        let most = self.cell.joint_speed;
        let word = self.machine.words.get("JOINT_SPEED");
        // A control whose motions state rates rounds those.
        let step = word.map_or(1e-3 * most, |word| 0.5 * word.resolution());
        match self.running.joint_speed {
            Some(speed) if speed <= most + step => Ok(()),
            None if word.is_none() => self.tip_speed_of_joints(),
            stated => {
                let message = match stated {
                    Some(speed) => format!(
                        "the joints go at {speed:.1} %, `joint_speed` of the cell is {most} %"
                    ),
                    None => String::from("nothing states how fast the joints go"),
                };
                let help = "state the speed of the joints before they move, no faster than `joint_speed` below [cell] of the machine file";
                Err(Diagnostic::error(Rule::RapidFeed, message).help(help).into())
            }
        }
    }

    /// Where a control says how fast the rail goes, that is as fast as the cell lets joints go, in percent, or less; else the percents of the joints
    /// are those of the rail, too.
    ///
    /// # Errors
    /// It goes faster.
    fn rail_speed(&self) -> Outcome {
        let (Some(rail), Some(stated)) = (&self.cell.rail, self.running.rail_speed) else {
            return Ok(());
        };
        let most = rail.speed / 60.0 * self.cell.joint_speed / 100.0;
        if stated <= most * 1.001 {
            return Ok(());
        }
        let message = format!(
            "the rail goes at {stated:.1} mm/s, `joint_speed` of the cell leaves {most:.1} to it"
        );
        let help = "a slower speed of linear outer axes in the motion";
        Err(Diagnostic::error(Rule::RapidFeed, message).help(help).into())
    }

    /// RAPID says how fast the tip goes and how fast the tool turns in motions of joints, too; the slower decides.
    ///
    /// # Errors
    /// The tip goes faster than a rapid of the cell, or the tool turns faster than the slowest joint may.
    fn tip_speed_of_joints(&self) -> Outcome {
        let slowest =
            self.arm.joints().iter().map(|joint| joint.speed).fold(f64::INFINITY, f64::min);
        let turn = slowest.to_degrees() * self.cell.joint_speed / 100.0;
        let (feed, [stated, _]) = (self.running.feed, self.running.turn_speed);
        let is_slow = feed.is_some_and(|feed| feed <= self.cell.rapid + self.feed_step)
            && stated.is_some_and(|stated| stated <= turn * 1.001);
        if is_slow {
            return Ok(());
        }
        let shown = |speed: Option<f64>| {
            speed.map_or_else(|| String::from("nothing"), |speed| format!("{speed:.1}"))
        };
        let message = format!(
            "a motion of joints states {} mm/min and {} degrees/s; `rapid` of the cell is {:.0}, and `joint_speed` leaves {turn:.1} to the slowest joint",
            shown(feed),
            shown(stated),
            self.cell.rapid
        );
        let help = "state a slower speed in the motion, or others below [cell] of the machine file";
        Err(Diagnostic::error(Rule::RapidFeed, message).help(help).into())
    }

    /// Whether the tool stands on the axis of a pose, above it by `most` mm at the most.
    pub(super) fn is_above(&self, at: &Frame, pose: &Pose, most: f64) -> bool {
        self.stands_above(&self.in_part(at), pose, most)
    }

    /// The same of a tool in the frame of the source.
    pub(super) fn stands_above(&self, tool: &Frame, pose: &Pose, most: f64) -> bool {
        let off = tool.translation - pose.point();
        let height = off.dot(pose.axis());
        let lean = angle_between(-tool.matrix3.z_axis, pose.axis());
        // A slant of the axis is a way aside, over the height.
        let aside = off.reject_from_normalized(pose.axis()).length() + lean * height.abs();
        let slack = self.axis_allowed().to_radians() * height.abs() + self.tip(true);
        height >= -self.tip(true)
            && height <= most + self.tip(true)
            && aside <= 2.0 * slack
            && lean.to_degrees() <= self.axis_allowed()
    }

    /// # Errors
    /// On the way of the joints the tool is neither near the line of the source nor free of the part: see [`Comparison::off_line`].
    pub(super) fn clear(&self, [from, to]: [&Standing; 2], line: Option<[Vec3; 2]>) -> Outcome {
        let (Some(base), Some(tool)) = (self.running.base, self.running.tool) else {
            return Ok(());
        };
        let turns: f64 = from.joints.iter().zip(to.joints).map(|(a, b)| (b - a).abs()).sum();
        let along = (to.rail - from.rail).abs();
        let count = ((turns * self.lever() + along) / STRIDE).ceil().clamp(1.0, 1e6);
        let corridor = self.machine.capabilities.rapid_corridor;
        let unmeasured = self.arm.unmeasured();
        let line = line.filter(|_| unmeasured == 0.0);
        let places = (0..=count as usize).map(|step| {
            let part = step as f64 / count;
            let joints: Joints =
                std::array::from_fn(|i| from.joints[i] + part * (to.joints[i] - from.joints[i]));
            let foot = self.cell.foot(from.rail + part * (to.rail - from.rail));
            base.inverse() * foot * self.arm.flange(&joints) * tool
        });
        let places = places.filter(|place| {
            let tip = self.in_part(place).translation;
            !line.is_some_and(|[start, end]| nearest_on_segment(start, end, tip).1 <= corridor)
        });
        let ends = [&from.tool, &to.tool];
        self.off_line(places, ends, ("on the way of the joints", unmeasured))
    }
}
