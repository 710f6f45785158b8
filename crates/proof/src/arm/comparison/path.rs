//! Lines and arcs: on the path of the source, with joints that follow.

use super::super::expected::{Expected, REENTRY, Step};
use super::super::follow::{Followed, Path, angle, follow, turned};
use super::{Comparison, STRIDE, Standing, arc_through, refused};
use crate::observer::Deviation;
use crate::report::Excursion;
use ::arm::Joints;
use control::{ArmMove, ArmPosture, Corner, Dialect, Rounding, Turning};
use geom::{Arc, Frame, Mat3, Quat, Vec3, angle_between, between, nearest_on_segment};
use program::{Diagnostic, Outcome, Pose, Rule};
use std::f64::consts::TAU;

/// How far rounding of its three points moves an arc, in tip tolerances: see `crate::arc`.
const ROUNDINGS: f64 = 3.0;

/// So near to the edge of what a posture states a joint is not let, degrees: rounding would decide.
const EDGE: f64 = 1e-3;

/// A turn that is so near to half a turn goes one way or the other: rounding would decide, radians (0.5°).
const HALF_TURN: f64 = std::f64::consts::PI - 8.726_646_259_971_648e-3;

/// A turn below this, radians (0.01°), is rounding.
const SMALL_TURN: f64 = 1.745_329_251_994_329_6e-4;

/// By so much of itself the time of a cut may be longer than its feed wants it.
const SLOWER: f64 = 0.05;

/// How much farther the turn over the way point of an arc may be than the turn to its end, radians.
const DETOUR: f64 = 0.02;

impl Comparison<'_> {
    /// A straight line of the tip.
    pub(super) fn line(
        &mut self,
        line: u32,
        motion: &ArmMove,
        end: &Frame,
        from_corner: Option<Rounding>,
    ) -> Outcome {
        let start = self.start(motion)?;
        let (a, b) = (start.tool, *end);
        let at = |part: f64| {
            let turned = turned(&a.matrix3, &b.matrix3, part);
            Frame::from_mat3_translation(turned, a.translation.lerp(b.translation, part))
        };
        let length = a.translation.distance(b.translation);
        let turn = sure_turn(&a.matrix3, &b.matrix3)?;
        let path = Path { at: &at, length, turn, time: None };
        if !start.exact {
            return self.correct(motion, start, path);
        }
        if self.away.is_some() {
            return self.line_away(line, motion, start, path);
        }
        let Some(expected) = self.expected.get(self.next).cloned() else {
            return self.retract(line, motion, (start, path), from_corner);
        };
        if self.leaves_cut(&expected, &start, &path) {
            return self.leave_cut(line, motion, (start, path), from_corner);
        }
        let cuts = match &expected.step {
            Step::Rapid(from, to) => {
                // Up to the height of a rapid that comes from home is not yet that rapid.
                let lifts = from.is_none() && !self.is_home && self.rise(&start, &path) > 0.0;
                if lifts || !self.arrives(end, to, false) {
                    return self.retract(line, motion, (start, path), from_corner);
                }
                self.is_rapid_path(&start, &path, (from.as_ref(), to))?;
                let off = self.off(end, to);
                Deviation::widen(&mut self.deviation, off);
                self.report.compared.rapids += 1;
                false
            }
            Step::Above(last) => {
                if !self.is_above(end, last, REENTRY) {
                    return refused(
                        Rule::Peck,
                        "the tool does not go back into the hole to a little above the last depth",
                    );
                }
                false
            }
            Step::Line(from, to) => {
                self.on_line(&at, [from, to], line)?;
                true
            }
            Step::Arc(arc, to) => {
                self.chord(&at, arc, to, line)?;
                true
            }
            Step::Home
            | Step::Tool(_)
            | Step::Contour(_)
            | Step::Dwell(_)
            | Step::Stop
            | Step::Output(_)
            | Step::Input(_) => return self.retract(line, motion, (start, path), from_corner),
        };
        if cuts {
            self.in_cut(&expected)?;
        }
        self.corner(motion, (from_corner, length), cuts, &expected)?;
        self.pass(start, path, (motion, cuts))?;
        self.complete(end, &expected);
        Ok(())
    }

    /// A straight line to where the joints should have led an arm that is not measured: they were beyond all cuts, by as much as they
    /// may be off.
    ///
    /// # Errors
    /// It leads elsewhere.
    fn correct(&mut self, motion: &ArmMove, start: Standing, path: Path) -> Outcome {
        if path.length > 2.0 * self.tip(true) || path.turn > self.axis_allowed().to_radians() {
            let message = "joints have led an arm here whose calibration the machine file does not state, and the next line goes elsewhere";
            let help = "a straight line to the same pose before it, or the calibration of the arm";
            return Err(Diagnostic::error(Rule::UnknownPosition, message).help(help).into());
        }
        if motion.corner != Corner::Exact {
            return refused(
                Rule::PathTolerance,
                "a corner is passed where the arm corrects its pose",
            );
        }
        self.pass(start, path, (motion, false))
    }

    /// A straight retract up along the tool's own axis, between two steps of the source; or along Z, of a tool that lies.
    ///
    /// # Errors
    /// It is none.
    fn retract(
        &mut self,
        line: u32,
        motion: &ArmMove,
        (start, path): (Standing, Path),
        from_corner: Option<Rounding>,
    ) -> Outcome {
        let (lift, ascent) = (self.rise(&start, &path), self.ascent(&start, &path));
        let is_lift = lift > 0.0 || ascent != 0.0;
        let lift_mm = lift.max(ascent).max(0.0);
        if !is_lift || self.done > 0.0 || from_corner.is_some() || motion.corner != Corner::Exact {
            return refused(Rule::ExtraMotion, "the tool moves where the source does not");
        }
        self.report.excursion(Excursion {
            source_line: self.line_before(),
            program_file: self.file.as_deref().map(str::to_owned),
            first_program_line: line,
            last_program_line: line,
            lift_mm,
        });
        self.pass(start, path, (motion, false))
    }

    /// How far a line leads the tool up along its own axis, mm, below 0 where it leads down; 0 where it leads aside, or turns the tool.
    pub(super) fn rise(&self, start: &Standing, path: &Path) -> f64 {
        let (from, to) = (self.in_part(&start.tool), self.in_part(&(path.at)(1.0)));
        let way = to.translation - from.translation;
        let axis = -from.matrix3.z_axis;
        let aside = way.reject_from_normalized(axis).length();
        match aside <= self.tip(true) + 1e-4 * path.length && path.turn < 1e-4 {
            true => way.dot(axis),
            false => 0.0,
        }
    }

    /// # Errors
    /// A straight rapid is neither on the line of the source, nor down along the tool or along Z to its end, nor free of the part.
    fn is_rapid_path(
        &self,
        start: &Standing,
        path: &Path,
        (from, to): (Option<&Pose>, &Pose),
    ) -> Outcome {
        let tip = self.in_part(&start.tool).translation;
        let is_own = from.is_some_and(|from| tip.distance(from.point()) <= 2.0 * self.tip(true));
        let is_above = self.is_above(&start.tool, to, f64::INFINITY);
        if is_own || is_above || self.ascent(start, path) != 0.0 {
            return Ok(());
        }
        let at = path.at;
        let count = (path.length / STRIDE).ceil().clamp(1.0, 1e6);
        let places = (0..=count as usize).map(|step| at(step as f64 / count));
        let what = "on a straight rapid that begins elsewhere than that of the source";
        self.off_line(places, [&start.tool, &at(1.0)], (what, 0.0))
    }

    /// An arc through a point.
    pub(super) fn arc(
        &mut self,
        line: u32,
        motion: &ArmMove,
        [via, end]: [&Frame; 2],
        from_corner: Option<Rounding>,
    ) -> Outcome {
        let start = self.start(motion)?;
        if !start.exact {
            let message = "an arc from where joints have led an arm whose calibration the machine file does not state";
            return refused(Rule::UnknownPosition, message);
        }
        let Some(expected) = self.expected.get(self.next).cloned() else {
            return refused(Rule::ExtraMotion, "the tool goes on where the source has ended");
        };
        let Step::Arc(wanted, to) = &expected.step else {
            return refused(Rule::Arc, "the program cuts an arc where the source does not");
        };
        let points = [start.tool.translation, via.translation, end.translation];
        let arc = arc_through(points)?;
        let (a, b) = (start.tool.matrix3, end.matrix3);
        let at = |part: f64| Frame::from_mat3_translation(turned(&a, &b, part), arc.at(part));
        let turn = sure_turn(&a, &b)?;
        let counts =
            Dialect::named(&self.machine.reader).is_some_and(Dialect::turns_over_way_point);
        if counts && angle(&a, &via.matrix3) + angle(&via.matrix3, &b) > angle(&a, &b) + DETOUR {
            let message = "the orientation at the way point of the arc is not on the way from its start to its end";
            return refused(Rule::OrientationWay, message);
        }
        self.on_arc(&at, wanted, &arc, to, line)?;
        self.bulge(&arc, points[1], wanted, line)?;
        self.in_cut(&expected)?;
        self.corner(motion, (from_corner, arc.length()), true, &expected)?;
        let path = Path { at: &at, length: arc.length(), turn, time: None };
        self.pass(start, path, (motion, true))?;
        self.complete(end, &expected);
        Ok(())
    }

    /// Where the motion begins.
    fn start(&self, motion: &ArmMove) -> Outcome<Standing> {
        self.frames()?;
        if motion.turning != Some(Turning::Even) {
            let message = "how the tool turns on the way is not stated, or not evenly";
            return Err(Diagnostic::error(Rule::OrientationWay, message)
                .help("it turns evenly from the start to the end: $ORI_TYPE=#VAR and $CIRC_TYPE=#BASE in KRL, mode=0 in URScript")
                .into());
        }
        match self.standing {
            Some(standing) if motion.rail.is_some_and(|at| (at - standing.rail).abs() > 1e-6) => {
                let message = "the rail moves while the tool goes straight or on an arc";
                Err(Diagnostic::error(Rule::Rail, message)
                    .help("move the rail in motions of the joints alone, with the tool beyond all cuts")
                    .into())
            }
            Some(standing) => Ok(standing),
            None => refused(Rule::UnknownPosition, "a straight line from where nobody knows"),
        }
    }

    /// How long the control takes at the least to turn the tool by so much, radians, in s.
    pub(super) fn turning_time(&self, turn: f64) -> f64 {
        match self.running.turn_speed {
            // A turn is part swing and part turn about the tool; the slower of both decides.
            [Some(swing), Some(roll)] => turn.to_degrees() / (swing + roll),
            [_, None] | [None, _] => 0.0,
        }
    }

    /// The joints follow the path.
    pub(super) fn pass(
        &mut self,
        start: Standing,
        path: Path,
        (motion, cuts): (&ArmMove, bool),
    ) -> Outcome {
        let (Some(base), Some(tool)) = (self.running.base, self.running.tool) else {
            return Ok(());
        };
        let Some(feed) = self.running.feed else {
            return refused(Rule::NoFeed, "the program goes straight and has not stated how fast");
        };
        let feed_time = path.length / (feed / 60.0);
        self.is_cut = cuts;
        match cuts {
            true => self.keeps_feed(&path, feed_time)?,
            false if feed > self.cell.rapid + self.feed_step => {
                let most = self.cell.rapid;
                let message = format!(
                    "a straight rapid goes at {feed:.0} mm/min, `rapid` of the cell is {most:.0}"
                );
                return refused(Rule::RapidFeed, message);
            }
            false => {}
        }
        match cuts {
            true => self.turned = Some(self.turns()),
            false => self.leaves_turning(&start)?,
        }
        let time = feed_time.max(self.turning_time(path.turn));
        if cuts && time > feed_time * (1.0 + SLOWER) {
            self.report.compared.slowed += 1;
            self.checked().slowed_s += time - feed_time;
        }
        let end = (path.at)(1.0);
        let path = Path { time: Some(time), ..path };
        let base = self.cell.foot(start.rail).inverse() * base;
        let followed = follow(self.arm, [&base, &tool], start.joints, &path);
        let Followed { joints, limit, wrist, speed } = match followed {
            Ok(followed) => followed,
            Err(lost) => {
                return self.lost(if cuts { Rule::AxisLimit } else { Rule::RapidPath }, lost);
            }
        };
        self.posture(&joints, &motion.posture)?;
        let checked = self.checked();
        checked.note_limit(limit);
        checked.note_wrist(wrist);
        checked.speed_percent = checked.speed_percent.max(100.0 * speed);
        let rail = start.rail;
        self.standing = Some(Standing { joints, rail, tool: end, exact: true, by_joints: false });
        self.is_home = false;
        Ok(())
    }

    /// # Errors
    /// The tool turns on the way so slowly that the feed is not kept, or nothing states how fast it turns.
    fn keeps_feed(&self, path: &Path, feed_time: f64) -> Outcome {
        let [swing, roll] = turns((path.at)(0.0).matrix3, (path.at)(1.0).matrix3);
        // Where the tip stays no feed is kept.
        if path.length <= self.tip(true) || swing.hypot(roll) < SMALL_TURN {
            return Ok(());
        }
        let time = match self.running.turn_speed {
            // One speed for the whole turn, which no maker states (docs/controls/urscript.md): not compared with the feed.
            [Some(_), Some(0.0)] => 0.0,
            [Some(of_swing), Some(of_roll)] => {
                (swing.to_degrees() / of_swing).max(roll.to_degrees() / of_roll)
            }
            [_, None] | [None, _] if self.machine.words.contains_key("TURN_SPEED") => {
                return refused(Rule::Feed, "the tool turns in a cut, and nothing states how fast");
            }
            [_, None] | [None, _] => 0.0,
        };
        match time > feed_time * (1.0 + SLOWER) {
            true => refused(
                Rule::Feed,
                format!(
                    "the tool turns in a cut, which takes {time:.3} s; at its feed the cut takes {feed_time:.3} s"
                ),
            ),
            false => Ok(()),
        }
    }

    /// # Errors
    /// The program states another posture than that of these joints, or one so near to them that rounding decides.
    fn posture(&self, joints: &Joints, stated: &ArmPosture) -> Outcome {
        let own = self.arm.posture(joints);
        let letters = [
            (stated.rear, own.rear(), "the wrist is behind axis 1"),
            (stated.below, own.below(), "the elbow is below"),
            (stated.flip, own.flip(), "the wrist is flipped"),
        ];
        for (stated, own, what) in letters {
            if stated.is_some_and(|stated| stated != own) {
                let (is, not) = if own { ("", "not ") } else { ("not ", "") };
                let message =
                    format!("it is {is}so that {what}, and the program says it is {not}so");
                return refused(Rule::Posture, message);
            }
        }
        let shown = self.arm.shown(joints).unwrap_or(*joints).map(f64::to_degrees);
        for (number, (at, range)) in (1..).zip(shown.iter().zip(stated.joints)) {
            if let Some([from, to]) = range
                && !(from + EDGE..=to - EDGE).contains(at)
            {
                let message = format!(
                    "joint {number} is at {at:.4}°, and the program states {from}° to {to}°"
                );
                return refused(Rule::Posture, message);
            }
        }
        Ok(())
    }

    /// The step is done where the tool has come to its end.
    fn complete(&mut self, end: &Frame, expected: &Expected) {
        let tool = self.in_part(end);
        let (to, counted) = match &expected.step {
            Step::Rapid(_, to) | Step::Above(to) => (to, None),
            Step::Line(_, to) => (to, Some(&mut self.report.compared.lines)),
            Step::Arc(_, to) => (to, Some(&mut self.report.compared.arcs)),
            Step::Home
            | Step::Tool(_)
            | Step::Contour(_)
            | Step::Dwell(_)
            | Step::Stop
            | Step::Output(_)
            | Step::Input(_) => return,
        };
        if let Some(counted) = counted {
            let is_end = tool.translation.distance(to.point()) <= self.report.tolerances.tip_mm
                && self.done > 1.0 - 1e-9;
            if !is_end {
                return;
            }
            *counted += 1;
        }
        self.make_next();
        self.done = 0.0;
    }

    /// # Errors
    /// The line is not on that of the source, or goes back on it.
    fn on_line(&mut self, at: &dyn Fn(f64) -> Frame, [from, to]: [&Pose; 2], line: u32) -> Outcome {
        let allowed = self.tip(true);
        let length = from.point().distance(to.point());
        let part = |tip: Vec3| nearest_on_segment(from.point(), to.point(), tip);
        let (mut reached, _) = part(self.in_part(&at(1.0)).translation);
        let at_end = self.off(&at(1.0), to).0 <= self.tip(false);
        if at_end || length < allowed {
            reached = 1.0;
        }
        if reached < self.done - allowed / length.max(allowed) {
            return refused(Rule::Path, "the tool goes back on the line of the source");
        }
        let samples = 1 + (angle_between(from.axis(), to.axis()) / 0.02).ceil().min(1e4) as usize;
        for step in 0..=samples {
            let share = step as f64 / samples as f64;
            let tool = self.in_part(&at(share));
            let (_, aside) = part(tool.translation);
            let along = self.done + share * (reached - self.done);
            let lean = angle_between(-tool.matrix3.z_axis, between(from.axis(), to.axis(), along))
                .to_degrees();
            if aside.is_nan() || aside > allowed {
                let message = format!("the tip is {aside:.4} mm off the line of the source");
                return refused(Rule::Path, message);
            }
            self.note_between(aside, lean, line)?;
        }
        if reached == 1.0 {
            self.note_end(&at(1.0), to, line)?;
        }
        self.done = reached;
        Ok(())
    }

    /// Takes down how far a place between the ends of a step is off it: the tip in mm, the axis in degrees.
    ///
    /// # Errors
    /// The axis is off.
    fn note_between(&mut self, aside: f64, lean: f64, line: u32) -> Outcome {
        if lean.is_nan() || lean > self.report.tolerances.sweep_degrees {
            let message = format!("the axis is {lean:.3}° off that of the source on the way");
            return refused(Rule::Path, message);
        }
        let place = (self.file.as_deref(), line);
        self.report.deviations.path_mm.note(aside, self.expected[self.next].line, place);
        Deviation::widen(&mut self.deviation, (aside, lean));
        Ok(())
    }

    /// Angle from the start of an arc to a point, that comes behind the part that is done; radians.
    fn angle_on(arc: &Arc, done: f64, tip: Vec3) -> f64 {
        let spoke = |point: Vec3| (point - arc.center).reject_from_normalized(arc.normal);
        let (a, b) = (spoke(arc.at(done)), spoke(tip));
        let turn = arc.normal.dot(a.cross(b)).atan2(a.dot(b));
        done * arc.sweep + if turn < -1e-6 { turn + TAU } else { turn }
    }

    fn on_arc(
        &mut self,
        at: &dyn Fn(f64) -> Frame,
        wanted: &Arc,
        arc: &Arc,
        to: &Pose,
        line: u32,
    ) -> Outcome {
        let allowed = ROUNDINGS * self.tip(true);
        let before = self.done;
        let end = self.in_part(&at(1.0));
        let mut reached = Comparison::angle_on(wanted, before, end.translation) / wanted.sweep;
        let left = (reached - 1.0).abs() * wanted.length();
        if end.translation.distance(wanted.end) <= self.tip(false) && left <= 2.0 * allowed {
            reached = 1.0;
        }
        if reached <= before || reached > 1.0 + 1e-9 {
            return refused(
                Rule::Arc,
                "the arc goes back, or beyond the end of that of the source",
            );
        }
        // Points of a circle of another direction or radius are off it somewhere.
        let samples = 4 * (1 + (arc.sweep / 0.5).ceil().min(100.0) as usize);
        for step in 1..=samples {
            let share = step as f64 / samples as f64;
            let tool = self.in_part(&at(share));
            let aside = tool.translation.distance(wanted.at(before + share * (reached - before)));
            if aside.is_nan() || aside > allowed {
                let message = format!("the tip is {aside:.4} mm off the arc of the source");
                return refused(Rule::Arc, message);
            }
            let lean = angle_between(-tool.matrix3.z_axis, to.axis()).to_degrees();
            self.note_between(aside, lean, line)?;
        }
        if reached == 1.0 {
            self.note_end(&at(1.0), to, line)?;
        }
        self.done = reached;
        Ok(())
    }

    /// How far the circle of three points is off that of the source, between its ends.
    ///
    /// # Errors
    /// By more than the tolerance and what the rounding of the three points does.
    fn bulge(&mut self, arc: &Arc, via: Vec3, wanted: &Arc, line: u32) -> Outcome {
        let aside = |tip: Vec3| {
            let radius = (wanted.start - wanted.center).reject_from_normalized(wanted.normal);
            let off = (tip - wanted.center).reject_from_normalized(wanted.normal);
            let height = (tip - wanted.start).dot(wanted.normal);
            (off.length() - radius.length()).hypot(height)
        };
        let in_part = |tip: Vec3| self.in_part(&Frame::from_translation(tip)).translation;
        let spoke = |point: Vec3| (point - arc.center).reject_from_normalized(arc.normal);
        let (a, b) = (spoke(arc.at(0.0)), spoke(via));
        let on_way = arc.normal.dot(a.cross(b)).atan2(a.dot(b)).rem_euclid(TAU);
        // A point that is moved aside moves the circle by this part of it, with the two others kept: the polynomial of sines.
        let share = |at: f64, own: f64, others: [f64; 2]| {
            let part = |other: f64| ((at - other) / 2.0).sin() / ((own - other) / 2.0).sin();
            (part(others[0]) * part(others[1])).abs()
        };
        // Half a step of X, Y and Z each; where the arc begins has been judged.
        let half = 0.5 * self.machine.resolution() * 3.0_f64.sqrt();
        let begins = half.max(aside(in_part(arc.at(0.0))));
        let (mut worst, tip) = (0.0, self.report.tolerances.tip_mm);
        for step in 1..=64 {
            let part = f64::from(step) / 64.0;
            let (at, end) = (part * arc.sweep, arc.sweep);
            let rounding = begins * share(at, 0.0, [on_way, end])
                + half * (share(at, on_way, [0.0, end]) + share(at, end, [0.0, on_way]));
            let aside = aside(in_part(arc.at(part)));
            if aside.is_nan() || aside > tip + rounding {
                let message = format!(
                    "the circle of the three points is {aside:.4} mm off the arc of the source"
                );
                return refused(Rule::Arc, message);
            }
            worst = f64::max(worst, aside);
        }
        let source = self.expected.get(self.next).map_or(0, |expected| expected.line);
        self.report.deviations.tip_mm.note(worst, source, (self.file.as_deref(), line));
        Deviation::widen(&mut self.deviation, (worst, 0.0));
        Ok(())
    }

    /// A line that is a chord of an arc.
    fn chord(&mut self, at: &dyn Fn(f64) -> Frame, wanted: &Arc, to: &Pose, line: u32) -> Outcome {
        let allowed = self.tip(true);
        let before = self.done;
        let tip = self.in_part(&at(1.0)).translation;
        let mut reached = Comparison::angle_on(wanted, before, tip) / wanted.sweep;
        if tip.distance(wanted.end) <= self.tip(false) && reached > 1.0 - 0.25 {
            reached = 1.0;
        }
        if reached <= before
            || reached > 1.0 + 1e-9
            || (reached - before) * wanted.sweep > TAU / 4.0
        {
            return refused(Rule::Path, "the line is no chord of the arc of the source");
        }
        // The tool leans nowhere on an arc.
        let lean = self.off(&at(1.0), to).1;
        if lean.is_nan() || lean > self.axis_allowed() {
            return refused(
                Rule::Path,
                format!("the axis is {lean:.3}° off that of the source on the arc"),
            );
        }
        for step in 1..=8 {
            let share = f64::from(step) / 8.0;
            let off = self
                .in_part(&at(share))
                .translation
                .distance(wanted.at(before + share * (reached - before)));
            if off.is_nan() || off > allowed + self.report.tolerances.chord_mm {
                return refused(
                    Rule::ArcChord,
                    format!("the chord is {off:.4} mm off the arc of the source"),
                );
            }
            Deviation::widen(&mut self.deviation, (off, lean));
        }
        if reached == 1.0 {
            self.note_end(&at(1.0), to, line)?;
        }
        self.done = reached;
        Ok(())
    }
}

/// By how much the tool turns, radians.
///
/// # Errors
/// So near to half a turn that its direction is not sure.
fn sure_turn(from: &Mat3, to: &Mat3) -> Outcome<f64> {
    let turn = angle(from, to);
    match turn < HALF_TURN {
        true => Ok(turn),
        false => Err(Diagnostic::error(
            Rule::OrientationWay,
            "the tool turns by half a turn in one motion: in which direction, rounding decides",
        )
        .help("a pose between the two, or another turn about the tool")
        .into()),
    }
}

/// By how much the axis of the tool swings and how much the tool turns about it, radians, on an even turn.
fn turns(from: Mat3, to: Mat3) -> [f64; 2] {
    let [from, to] = [from, to].map(|turned| Quat::from_mat3(&turned));
    let between = from.inverse() * to;
    let about = Vec3::new(between.x, between.y, between.z).normalize_or_zero();
    let turn = 2.0 * Vec3::new(between.x, between.y, between.z).length().atan2(between.w.abs());
    [turn * about.x.hypot(about.y), turn * about.z.abs()]
}
