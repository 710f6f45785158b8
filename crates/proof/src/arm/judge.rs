//! The events of a control against the steps of the source.

use super::expected::{Expected, REENTRY, Step};
use super::follow::{Followed, Path, angle, follow, limit, turned};
use crate::report::{ArmChecked, Report};
use ::arm::{Arm, Joints};
use control::kernel::arc::through;
use control::{Action, ArmAction, ArmMove, ArmPath, ArmPosture, Corner, Event, Rounding, Turning};
use geom::{Arc, Frame, Vec3, angle_between, between, nearest_on_segment};
use machine::{Cell, Machine};
use program::{
    Coolant, CutBox, Diagnostic, Feed, Outcome, Output, OutputValue, Pose, Program, Rule, Spindle,
};
use std::f64::consts::TAU;

/// How far rounding of its three points moves an arc, in tip tolerances: see `crate::arc`.
const ROUNDINGS: f64 = 3.0;

/// Points of a motion of joints are so near that the tip moves by no more than this between them, mm.
const STRIDE: f64 = 1.0;

/// So near to the edge of what a posture states a joint is not let, degrees: rounding would decide.
const EDGE: f64 = 1e-3;

/// What the text of a program has switched on.
struct Running {
    /// mm/min.
    feed: Option<f64>,
    turn_speed: [Option<f64>; 2],
    is_on: bool,
    speed: Option<f64>,
    /// How long the spindle still takes to its speed, s.
    runs_up: f64,
    coolant: bool,
    base: Option<Frame>,
    tool: Option<Frame>,
    on_flange: Option<bool>,
}

/// Where the arm is.
#[derive(Clone, Copy)]
struct Standing {
    joints: Joints,
    /// The tool in the base of the program.
    tool: Frame,
    /// Whether it is there, or as far off as joints leave an arm that is not measured.
    exact: bool,
}

pub(super) struct Judge<'a> {
    machine: &'a Machine,
    arm: &'a Arm,
    cell: &'a Cell,
    cuts: CutBox,
    expected: Vec<Expected>,
    next: usize,
    /// How much of the next step is done, 0 to 1.
    done: f64,
    running: Running,
    standing: Option<Standing>,
    is_home: bool,
    /// The corner that the motion before has left open: the next one has to be a cut.
    open: Option<Rounding>,
    loaded: bool,
    ended: bool,
    failed: bool,
    report: Report,
    /// Half a step of F, mm/min, and of a joint, radians.
    feed_step: f64,
    joint_step: f64,
}

impl<'a> Judge<'a> {
    pub(super) fn new(
        source: &Program,
        (machine, arm, cell): (&'a Machine, &'a Arm, &'a Cell),
        expected: Vec<Expected>,
        report: Report,
    ) -> Judge<'a> {
        let half = |word: &str, otherwise: f64| {
            let word = machine.words.get(word);
            word.map_or(otherwise, |word| 0.5 * word.resolution())
        };
        Judge {
            machine,
            arm,
            cell,
            cuts: CutBox::of(source),
            expected,
            next: 0,
            done: 0.0,
            running: Running {
                feed: None,
                turn_speed: [None; 2],
                is_on: false,
                speed: None,
                runs_up: 0.0,
                coolant: false,
                base: None,
                tool: None,
                on_flange: None,
            },
            standing: None,
            is_home: false,
            open: None,
            loaded: false,
            ended: false,
            failed: false,
            report: Report { arm: Some(ArmChecked::default()), ..report },
            feed_step: half("F", 0.5) * (1.0 + 1e-6),
            joint_step: half("J1", 5e-4).to_radians(),
        }
    }

    /// The report. `run` is what the control has answered.
    pub(super) fn finish(mut self, run: Outcome) -> Report {
        if let Err(found) = run {
            self.differs(*found);
        }
        if !self.failed {
            self.leave_out();
            if let Some(missing) = self.expected.get(self.next) {
                let message = format!("source line {}: the program ends before this", missing.line);
                self.differs(Diagnostic::error(Rule::Missing, message));
            } else if !self.ended {
                self.differs(Diagnostic::error(Rule::NoEnd, "the program has no end"));
            }
        }
        self.report.proven = self.report.mismatches.is_empty();
        self.report
    }

    fn differs(&mut self, found: Diagnostic) {
        self.failed = true;
        let line = self.expected.get(self.next).map_or(0, |expected| expected.line);
        self.report.mismatch(line, found);
    }

    /// An event of the control.
    ///
    /// # Errors
    /// What differs: the run ends there.
    pub(super) fn event(&mut self, event: &Event) -> Outcome {
        let source = self.expected.get(self.next).map_or(0, |expected| expected.line);
        self.take(event).map_err(|found| {
            let message = match source {
                0 => found.message.clone(),
                line => format!("source line {line}: {}", found.message),
            };
            Box::new(Diagnostic { message, ..*found }.line(event.line))
        })
    }

    fn take(&mut self, event: &Event) -> Outcome {
        match &event.action {
            Action::Arm(action) => self.of_arm(event.line, action),
            Action::Feed(Feed::PerMinute(feed)) => {
                self.running.feed = Some(*feed);
                Ok(())
            }
            Action::Output(output) => self.output(output),
            Action::Input(input) => {
                self.exact()?;
                let input = **input;
                self.happens(
                    Rule::Input,
                    "waits for an input",
                    |step| matches!(step, Step::Input(wanted) if *wanted == input),
                )
            }
            Action::Dwell(seconds) => self.dwell(*seconds),
            Action::Stop => {
                self.exact()?;
                if self.running.is_on || self.running.coolant {
                    return refused(
                        Rule::StopRunning,
                        "the program stops while the spindle or the coolant is on",
                    )
                    .map_err(|found| Box::new(found.help("switch both off before it")));
                }
                self.happens(Rule::Stop, "stops", |step| matches!(step, Step::Stop))
            }
            Action::Tool(tool) => self.tool(tool.number),
            Action::Risk(risk) => {
                let message = format!("the program {}", risk.what);
                Err(Diagnostic::error(risk.rule, message).help(risk.help).into())
            }
            Action::Comment(_) | Action::Message(_) => Ok(()),
            Action::End => self.ends(),
            Action::Rapid(_)
            | Action::Line(_)
            | Action::Arc(_)
            | Action::Thread(_)
            | Action::Probe(_)
            | Action::Hole(_)
            | Action::Home(_)
            | Action::MachineMove(_)
            | Action::Swivel(_)
            | Action::Across(_)
            | Action::Cycle(_)
            | Action::CycleOff
            | Action::Feed(_)
            | Action::FeedPath(_)
            | Action::RapidsTogether(_)
            | Action::Spindle(_)
            | Action::SurfaceSpeed(_)
            | Action::Coolant(_)
            | Action::Preselect(_)
            | Action::LengthOffset(_)
            | Action::Compensation(_)
            | Action::WorkOffset(_)
            | Action::PathMode(_)
            | Action::Auxiliary(_)
            | Action::ThreadWire
            | Action::CutWire
            | Action::WorkOffsetData(_)
            | Action::Taper(_)
            | Action::OptionalStop => {
                refused(Rule::Unproven, "no program of an arm is proven with this")
            }
        }
    }

    /// What is no motion: the arm stops where it is.
    ///
    /// # Errors
    /// It does not: the corner before is passed all the same.
    fn exact(&mut self) -> Outcome {
        match self.open.take() {
            Some(Rounding { stops: false, .. }) => refused(
                Rule::PathTolerance,
                "something happens between two motions whose corner is passed: before the first one is at its end",
            ),
            Some(_) | None => Ok(()),
        }
    }

    fn of_arm(&mut self, line: u32, action: &ArmAction) -> Outcome {
        match action {
            ArmAction::Tool(frame) => self.running.tool = *frame,
            ArmAction::Base(frame) => {
                self.running.base = *frame;
                if frame.is_none() {
                    // Another program, or the configuration of the machine, has set the speed.
                    self.running.feed = None;
                }
            }
            ArmAction::PartOnFlange(on_flange) => self.running.on_flange = Some(*on_flange),
            ArmAction::JointSpeed(_) => {}
            ArmAction::Load(mass, center) => return self.load(*mass, *center),
            ArmAction::TurnSpeed(speed) => self.running.turn_speed = *speed,
            ArmAction::Move(motion) => return self.motion(line, motion),
        }
        Ok(())
    }

    /// What hangs on the flange.
    ///
    /// # Errors
    /// The machine's file states another load.
    fn load(&mut self, mass: f64, center: Vec3) -> Outcome {
        self.loaded = true;
        let Some(load) = self.cell.load else { return Ok(()) };
        let off = center.distance(load.center);
        match (mass - load.mass).abs() <= 5e-3 && off <= 0.1 {
            true => Ok(()),
            false => refused(
                Rule::Payload,
                format!(
                    "the load of the program is {mass} kg, its centre {off:.1} mm off; the machine's file states {} kg",
                    load.mass
                ),
            ),
        }
    }

    /// An output: the spindle's, the coolant's, or one of the source's own.
    fn output(&mut self, output: &Output) -> Outcome {
        self.exact()?;
        let running = &mut self.running;
        match output.value {
            OutputValue::Digital(on) if self.cell.spindle_output == Some(output.number) => {
                if on && !running.is_on {
                    running.runs_up = self.machine.spindle.dwell;
                }
                running.is_on = on;
            }
            OutputValue::Digital(on) if self.cell.coolant_output == Some(output.number) => {
                running.coolant = on;
            }
            OutputValue::Analog(part)
                if self.cell.spindle_analog.is_some_and(|(number, _)| number == output.number) =>
            {
                let full = self.cell.spindle_analog.map_or(0.0, |(_, full)| full);
                // What the output counts at its full value.
                let scale = self.machine.words.get("VALUE").map_or(1.0, |word| word.scale);
                let speed = part / scale * full;
                if running.is_on && running.speed != Some(speed) {
                    running.runs_up = self.machine.spindle.dwell;
                }
                running.speed = Some(speed);
            }
            OutputValue::Digital(_) | OutputValue::Analog(_) => {
                let output = *output;
                return self.happens(
                    Rule::Output,
                    "sets an output",
                    |step| matches!(step, Step::Output(wanted) if *wanted == output),
                );
            }
        }
        Ok(())
    }

    fn dwell(&mut self, seconds: f64) -> Outcome {
        self.exact()?;
        let allowed = self.report.tolerances.dwell_s;
        if self.running.runs_up > 0.0 && seconds >= self.running.runs_up - allowed {
            self.running.runs_up = 0.0;
            return Ok(());
        }
        self.happens(
            Rule::Dwell,
            "dwells",
            |step| matches!(step, Step::Dwell(wanted) if (wanted - seconds).abs() <= allowed),
        )
    }

    /// Something between motions that the source has there too.
    fn happens(&mut self, rule: Rule, what: &str, is: impl Fn(&Step) -> bool) -> Outcome {
        self.leave_out();
        match self.expected.get(self.next) {
            Some(expected) if self.done == 0.0 && is(&expected.step) => {
                self.next += 1;
                self.report.compared.events += 1;
                Ok(())
            }
            _ => {
                refused(rule, format!("the program {what} where the source does not, or otherwise"))
            }
        }
    }

    /// A tool change by the operator's program.
    fn tool(&mut self, number: u32) -> Outcome {
        self.exact()?;
        let running = &mut self.running;
        if running.is_on || running.coolant || !self.is_home {
            let message = "the tool is changed where the arm is not home, or with the spindle or the coolant on";
            return refused(Rule::ToolChange, message);
        }
        running.turn_speed = [None; 2];
        running.on_flange = None;
        self.loaded = false;
        self.standing = None;
        self.leave_out();
        let wanted = self.expected.get(self.next).map(|expected| &expected.step);
        match wanted {
            Some(Step::Tool(tool)) if tool.number == number => {
                self.report.compared.tool_changes += 1;
                self.report.program.tool(number.to_string());
                self.next += 1;
                Ok(())
            }
            _ => refused(
                Rule::ExtraToolChange,
                format!("the program changes to tool {number}, the source does not"),
            ),
        }
    }

    fn ends(&mut self) -> Outcome {
        self.exact()?;
        self.ended = true;
        let running = &self.running;
        if running.is_on || running.coolant {
            return refused(Rule::LeftOn, "the program ends with the spindle or the coolant on");
        }
        match self.is_home {
            true => Ok(()),
            false => refused(Rule::Home, "the program does not end with the joints at home"),
        }
    }

    /// Steps of the source that need nothing of the program: a tool that is in the spindle, a way home, moves shorter than a step.
    fn leave_out(&mut self) {
        while let Some(expected) = self.expected.get(self.next) {
            let is_none = match &expected.step {
                Step::Tool(_) => {
                    self.cell.tool_change.is_empty() && self.report.compared.tool_changes == 0 && {
                        self.report.compared.tool_changes += 1;
                        true
                    }
                }
                Step::Home => self.is_home,
                Step::Rapid(Some(from), to) | Step::Line(from, to) => self.is_short(from, to),
                Step::Rapid(None, _)
                | Step::Above(_)
                | Step::Arc(..)
                | Step::Dwell(_)
                | Step::Stop
                | Step::Output(_)
                | Step::Input(_) => false,
            };
            if !is_none || self.done > 0.0 {
                return;
            }
            if !matches!(expected.step, Step::Tool(_) | Step::Home) {
                self.report.compared.left_out += 1;
            }
            self.next += 1;
        }
    }

    /// Whether a move is less than a step of the program's words, and the tool is at its end already.
    fn is_short(&self, from: &Pose, to: &Pose) -> bool {
        let short = from.point().distance(to.point()) < self.machine.resolution()
            && angle_between(from.axis(), to.axis()) < 1e-5;
        short
            && self
                .standing
                .is_some_and(|standing| self.off(&standing.tool, to).0 <= 2.0 * self.tip(false))
    }

    /// The tool of the program in the frame of the source.
    fn in_part(&self, tool: &Frame) -> Frame {
        match self.running.base {
            Some(base) => self.cell.part.inverse() * base * *tool,
            None => Frame::from_translation(Vec3::NAN),
        }
    }

    /// How far the tip is off, mm, and the axis, degrees.
    fn off(&self, tool: &Frame, pose: &Pose) -> (f64, f64) {
        let tool = self.in_part(tool);
        let axis = -tool.matrix3.z_axis;
        (tool.translation.distance(pose.point()), angle_between(axis, pose.axis()).to_degrees())
    }

    /// How far the tip may be off, mm: by the words of poses, or by those of joints too.
    fn tip(&self, by_joints: bool) -> f64 {
        let tip = self.report.tolerances.tip_mm;
        match by_joints {
            false => tip,
            true => tip + 6.0 * self.joint_step * self.lever(),
        }
    }

    /// How far the tip is from the axes of the joints at the most, mm.
    fn lever(&self) -> f64 {
        let tool = self.running.tool.map_or(0.0, |tool| tool.translation.length());
        // From the wrist centre to the flange no arm has more than half of its reach.
        1.5 * self.arm.reach() + tool
    }

    fn axis_allowed(&self) -> f64 {
        self.report.tolerances.axis_degrees.max(6.0 * self.joint_step.to_degrees())
    }

    /// # Errors
    /// Base and tool are not those of the cell, within the rounding of their words.
    fn frames(&self) -> Outcome {
        let length = self.expected.get(self.next).or(self.expected.last());
        let length = length.and_then(|expected| expected.state.tool_length);
        let Some(tool) = self.cell.tool(length) else {
            let message =
                "neither the source nor `tool_length` of the cell states the length of the tool";
            return refused(Rule::ToolLength, message);
        };
        // Poses in the world itself are compared there.
        let in_world = self.running.base == Some(Frame::IDENTITY);
        let base = if in_world { Frame::IDENTITY } else { self.cell.part };
        if !self.loaded && self.machine.words.contains_key("LOAD_MASS") {
            let message = "the program moves and has not stated the load on the flange";
            return refused(Rule::Payload, message);
        }
        for (name, stated, wanted) in
            [("base", self.running.base, base), ("tool", self.running.tool, tool)]
        {
            let Some(stated) = stated else {
                return refused(
                    Rule::Frame,
                    format!("the program moves and has not stated its {name}"),
                );
            };
            let apart = stated.translation.distance(wanted.translation);
            let turn = angle(&stated.matrix3, &wanted.matrix3).to_degrees();
            if apart > self.report.tolerances.tip_mm || turn > 2e-4 {
                let message = format!(
                    "the {name} of the program is {apart:.4} mm and {turn:.5}° off that of the machine's file"
                );
                return refused(Rule::Frame, message);
            }
        }
        match self.running.on_flange {
            Some(false) => Ok(()),
            Some(true) | None => refused(
                Rule::Frame,
                "the program does not say that the part stands and the tool moves",
            ),
        }
    }

    fn motion(&mut self, line: u32, motion: &ArmMove) -> Outcome {
        let from_corner = self.open.take();
        self.leave_out();
        match motion.path {
            ArmPath::Joints(shown) => {
                if from_corner.is_some() || motion.corner != Corner::Exact {
                    return refused(
                        Rule::PathTolerance,
                        "a corner is passed between a cut and a motion of joints",
                    );
                }
                self.joints(shown)
            }
            ArmPath::Point(_) => {
                let message = "the joints go to a pose: in which posture, letters say that depend on rounding";
                Err(Diagnostic::error(Rule::Unproven, message).help("write the joints").into())
            }
            ArmPath::Line(end) => self.line(line, motion, &end, from_corner),
            ArmPath::Arc { via, end } => self.arc(line, motion, [&via, &end], from_corner),
        }
    }

    /// A motion of all joints.
    fn joints(&mut self, shown: [f64; 6]) -> Outcome {
        let home = shown.iter().zip(self.cell.home).all(|(at, home)| (at - home).abs() < 1e-3);
        let Some(joints) = self.arm.model(&shown.map(f64::to_radians)) else {
            return refused(Rule::ArmCoupling, "how the controller counts joint 3 is not known");
        };
        let margin =
            limit(self.arm, &joints).or_else(|lost| refused(Rule::AxisLimit, lost.to_string()))?;
        self.checked().note_limit(margin);
        self.frames()?;
        let (Some(base), Some(tool)) = (self.running.base, self.running.tool) else {
            return Ok(());
        };
        let at = base.inverse() * self.arm.flange(&joints) * tool;
        let exact = self.arm.unmeasured() == 0.0;
        let before = self.standing.replace(Standing { joints, tool: at, exact });
        let was_home = std::mem::replace(&mut self.is_home, home);
        let Some(before) = before else {
            return match home {
                true => Ok(()),
                false if was_home => Ok(()),
                false => refused(Rule::Home, "the first motion does not bring the joints home"),
            };
        };
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
        self.clear(&before.joints, &joints, line.filter(|_| arrives))?;
        // From above the end of a rapid the tool goes down to it along its axis.
        let is_over = rapid.is_some_and(|(_, to)| self.is_above(&at, &to, f64::INFINITY));
        match arrives {
            true => {
                self.report.compared.rapids += 1;
                self.next += 1;
                Ok(())
            }
            false if self.done == 0.0 && (home || is_over) => Ok(()),
            false => {
                let end = self.in_part(&at).translation;
                let message = format!(
                    "the joints bring the tip to X{:.3} Y{:.3} Z{:.3}, where the source does not go by rapid",
                    end.x, end.y, end.z
                );
                refused(Rule::EndPoint, message)
            }
        }
    }

    /// Whether the tool stands on the axis of a pose, above it by `most` mm at the most.
    fn is_above(&self, at: &Frame, pose: &Pose, most: f64) -> bool {
        let tool = self.in_part(at);
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

    fn arrives(&self, at: &Frame, to: &Pose, by_joints: bool) -> bool {
        let (tip, axis) = self.off(at, to);
        tip <= self.tip(by_joints) && axis <= self.axis_allowed()
    }

    fn checked(&mut self) -> &mut ArmChecked {
        self.report.arm.get_or_insert_default()
    }

    /// # Errors
    /// On the way of the joints the tool is neither beyond all cuts along its axis nor near the line of the source.
    fn clear(&self, from: &Joints, to: &Joints, line: Option<[Vec3; 2]>) -> Outcome {
        let (Some(base), Some(tool)) = (self.running.base, self.running.tool) else {
            return Ok(());
        };
        let turns: f64 = from.iter().zip(to).map(|(a, b)| (b - a).abs()).sum();
        let count = (turns * self.lever() / STRIDE).ceil().clamp(1.0, 1e6);
        let unmeasured = self.arm.unmeasured();
        let clearance = self.machine.capabilities.rapid_clearance + unmeasured;
        let corridor = self.machine.capabilities.rapid_corridor;
        let line = line.filter(|_| unmeasured == 0.0);
        for step in 0..=count as usize {
            let part = step as f64 / count;
            let joints = std::array::from_fn(|i| from[i] + part * (to[i] - from[i]));
            let at = self.in_part(&(base.inverse() * self.arm.flange(&joints) * tool));
            let (tip, axis) = (at.translation, -at.matrix3.z_axis);
            let beyond = tip.dot(axis) - self.cuts.reach(axis);
            let near =
                line.is_some_and(|[start, end]| nearest_on_segment(start, end, tip).1 <= corridor);
            if beyond < clearance - STRIDE / 2.0 && !near {
                let message = format!(
                    "on the way of the joints the tip comes to X{:.1} Y{:.1} Z{:.1}, {beyond:.2} mm beyond the cuts along the tool: \
                     {clearance} mm are asked for",
                    tip.x, tip.y, tip.z
                );
                let help = "go there by a straight line, or higher";
                return Err(Diagnostic::error(Rule::RapidPath, message).help(help).into());
            }
        }
        Ok(())
    }

    /// A straight line of the tip.
    fn line(
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
        let turn = angle(&a.matrix3, &b.matrix3);
        let path = Path { at: &at, length, turn, time: None };
        if !start.exact {
            return self.correct(motion, start, path);
        }
        let Some(expected) = self.expected.get(self.next).cloned() else {
            return self.lift(motion, start, path, from_corner);
        };
        let cuts = match &expected.step {
            Step::Rapid(from, to) => {
                if !self.arrives(end, to, false) {
                    return self.lift(motion, start, path, from_corner);
                }
                self.is_rapid_path(&start, &at, (from.as_ref(), to), length)?;
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
            Step::Arc(arc, _) => {
                self.chord(&at, arc, end)?;
                true
            }
            Step::Home
            | Step::Tool(_)
            | Step::Dwell(_)
            | Step::Stop
            | Step::Output(_)
            | Step::Input(_) => return self.lift(motion, start, path, from_corner),
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

    /// A straight way up along the tool's own axis, between two steps of the source.
    ///
    /// # Errors
    /// It is none.
    fn lift(
        &mut self,
        motion: &ArmMove,
        start: Standing,
        path: Path,
        from_corner: Option<Rounding>,
    ) -> Outcome {
        let (from, to) = (self.in_part(&start.tool), self.in_part(&(path.at)(1.0)));
        let way = to.translation - from.translation;
        let axis = -from.matrix3.z_axis;
        let aside = way.reject_from_normalized(axis).length();
        let is_lift = self.done == 0.0
            && way.dot(axis) > 0.0
            && aside <= self.tip(true) + 1e-4 * path.length
            && path.turn < 1e-4;
        if !is_lift || from_corner.is_some() || motion.corner != Corner::Exact {
            return refused(Rule::ExtraMotion, "the tool moves where the source does not");
        }
        self.report.compared.excursions += 1;
        self.pass(start, path, (motion, false))
    }

    /// # Errors
    /// A straight rapid is neither on the line of the source, nor down along the tool to its end, nor beyond all cuts.
    fn is_rapid_path(
        &self,
        start: &Standing,
        at: &dyn Fn(f64) -> Frame,
        (from, to): (Option<&Pose>, &Pose),
        length: f64,
    ) -> Outcome {
        let tip = self.in_part(&start.tool).translation;
        let is_own = from.is_some_and(|from| tip.distance(from.point()) <= 2.0 * self.tip(true));
        if is_own || self.is_above(&start.tool, to, f64::INFINITY) {
            return Ok(());
        }
        let clearance = self.machine.capabilities.rapid_clearance;
        let count = (length / STRIDE).ceil().clamp(1.0, 1e6);
        for step in 0..=count as usize {
            let tool = self.in_part(&at(step as f64 / count));
            let (tip, axis) = (tool.translation, -tool.matrix3.z_axis);
            if tip.dot(axis) - self.cuts.reach(axis) < clearance - STRIDE / 2.0 {
                let message = "a straight rapid begins elsewhere than that of the source, and comes near to what is cut";
                return refused(Rule::RapidPath, message);
            }
        }
        Ok(())
    }

    /// An arc through a point.
    fn arc(
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
        let Some((center, normal)) = through(points[0], points[1], points[2]) else {
            return refused(
                Rule::ArcPoints,
                "the three points of the arc are on a line, or two of them are one",
            );
        };
        let radius = points[0].distance(center);
        let Ok(arc) = Arc::new(points[0], points[2], center, normal, 0, radius * 1e-6) else {
            return refused(Rule::Arc, "the three points span no arc");
        };
        let (a, b) = (start.tool.matrix3, end.matrix3);
        let at = |part: f64| Frame::from_mat3_translation(turned(&a, &b, part), arc.at(part));
        self.on_arc(&at, wanted, &arc, to, line)?;
        self.in_cut(&expected)?;
        self.corner(motion, (from_corner, arc.length()), true, &expected)?;
        let path = Path { at: &at, length: arc.length(), turn: angle(&a, &b), time: None };
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
            Some(standing) => Ok(standing),
            None => refused(Rule::UnknownPosition, "a straight line from where nobody knows"),
        }
    }

    /// The joints follow the path.
    fn pass(&mut self, start: Standing, path: Path, (motion, cuts): (&ArmMove, bool)) -> Outcome {
        let (Some(base), Some(tool)) = (self.running.base, self.running.tool) else {
            return Ok(());
        };
        let Some(feed) = self.running.feed else {
            return refused(Rule::NoFeed, "the program goes straight and has not stated how fast");
        };
        let time = (path.length / (feed / 60.0)).max(match self.running.turn_speed {
            // A turn is part swing and part turn about the tool; the slower of both decides.
            [Some(swing), Some(roll)] => path.turn.to_degrees() / (swing + roll),
            [_, None] | [None, _] => 0.0,
        });
        let end = (path.at)(1.0);
        let path = Path { time: Some(time), ..path };
        let followed = follow(self.arm, [&base, &tool], start.joints, &path);
        let Followed { joints, limit, wrist, speed } = match followed {
            Ok(followed) => followed,
            Err(lost) => {
                let rule = if cuts { Rule::AxisLimit } else { Rule::RapidPath };
                return refused(rule, lost.to_string());
            }
        };
        self.posture(&joints, &motion.posture)?;
        let checked = self.checked();
        checked.note_limit(limit);
        checked.note_wrist(wrist);
        checked.speed_percent = checked.speed_percent.max(100.0 * speed);
        self.standing = Some(Standing { joints, tool: end, exact: true });
        self.is_home = false;
        Ok(())
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
        let (to, counted) = match &expected.step {
            Step::Rapid(_, to) | Step::Above(to) => (to, None),
            Step::Line(_, to) => (to, Some(&mut self.report.compared.lines)),
            Step::Arc(_, to) => (to, Some(&mut self.report.compared.arcs)),
            Step::Home
            | Step::Tool(_)
            | Step::Dwell(_)
            | Step::Stop
            | Step::Output(_)
            | Step::Input(_) => return,
        };
        let tool = match self.running.base {
            Some(base) => self.cell.part.inverse() * base * *end,
            None => return,
        };
        if let Some(counted) = counted {
            let is_end = tool.translation.distance(to.point()) <= self.report.tolerances.tip_mm
                && self.done > 1.0 - 1e-9;
            if !is_end {
                return;
            }
            *counted += 1;
        }
        self.next += 1;
        self.done = 0.0;
    }

    fn elsewhere<T>(&self, end: &Frame, to: &Pose) -> Outcome<T> {
        let (tip, axis) = self.off(end, to);
        refused(Rule::EndPoint, format!("the tip ends {tip:.4} mm off, the axis {axis:.4}°"))
    }

    /// Notes how far the end of a step is off.
    fn note_end(&mut self, end: &Frame, to: &Pose, line: u32) -> Outcome {
        if !self.arrives(end, to, false) {
            return self.elsewhere(end, to);
        }
        let (tip, axis) = self.off(end, to);
        let source = self.expected.get(self.next).map_or(0, |expected| expected.line);
        self.report.deviations.tip_mm.note(tip, source, line);
        self.report.deviations.axis_degrees.note(axis, source, line);
        Ok(())
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
                return refused(
                    Rule::Path,
                    format!("the tip is {aside:.4} mm off the line of the source"),
                );
            }
            if lean > self.report.tolerances.sweep_degrees {
                return refused(
                    Rule::Path,
                    format!("the axis is {lean:.3}° off that of the source on the way"),
                );
            }
            self.report.deviations.path_mm.note(aside, self.expected[self.next].line, line);
        }
        if reached == 1.0 {
            self.note_end(&at(1.0), to, line)?;
        }
        self.done = reached;
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
        let mut reached = Judge::angle_on(wanted, before, end.translation) / wanted.sweep;
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
                return refused(
                    Rule::Arc,
                    format!("the tip is {aside:.4} mm off the arc of the source"),
                );
            }
            let lean = angle_between(-tool.matrix3.z_axis, to.axis()).to_degrees();
            if lean > self.report.tolerances.sweep_degrees {
                return refused(
                    Rule::Path,
                    format!("the axis is {lean:.3}° off that of the source on the arc"),
                );
            }
            self.report.deviations.path_mm.note(aside, self.expected[self.next].line, line);
        }
        if reached == 1.0 {
            self.note_end(&at(1.0), to, line)?;
        }
        self.done = reached;
        Ok(())
    }

    /// A line that is a chord of an arc.
    fn chord(&mut self, at: &dyn Fn(f64) -> Frame, wanted: &Arc, end: &Frame) -> Outcome {
        let allowed = self.tip(true);
        let before = self.done;
        let tip = self.in_part(end).translation;
        let mut reached = Judge::angle_on(wanted, before, tip) / wanted.sweep;
        if tip.distance(wanted.end) <= self.tip(false) && reached > 1.0 - 0.25 {
            reached = 1.0;
        }
        if reached <= before
            || reached > 1.0 + 1e-9
            || (reached - before) * wanted.sweep > TAU / 4.0
        {
            return refused(Rule::Path, "the line is no chord of the arc of the source");
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
        }
        self.done = reached;
        Ok(())
    }

    /// # Errors
    /// Feed, spindle or coolant are not as the source wants them in this cut.
    fn in_cut(&self, expected: &Expected) -> Outcome {
        let state = &expected.state;
        let Some(feed) = self.running.feed else {
            return refused(Rule::NoFeed, "the program cuts and has not stated its feed");
        };
        if (feed - state.feed).abs() > self.feed_step + 1e-9 * state.feed.abs() {
            let message = format!("the feed is {feed:.3} mm/min, the source has {:.3}", state.feed);
            return refused(Rule::Feed, message);
        }
        let full = self.cell.spindle_analog.map_or(0.0, |(_, full)| full);
        let step = self.machine.words.get("VALUE").map_or(1e-3, machine::Word::resolution);
        let is_right = match state.spindle {
            Spindle::Off => !self.running.is_on,
            Spindle::Clockwise(speed) => {
                self.running.is_on
                    && self.running.speed.is_some_and(|own| (own - speed).abs() <= full * step)
            }
            Spindle::CounterClockwise(_) => false,
        };
        if !is_right {
            let message = format!(
                "the spindle is {} at {:.0} 1/min, the source has {:?}",
                if self.running.is_on { "on" } else { "off" },
                self.running.speed.unwrap_or(0.0),
                state.spindle
            );
            return refused(Rule::Spindle, message);
        }
        if self.running.is_on && self.running.runs_up > 0.0 {
            let message =
                format!("the cut begins before the spindle has had {} s", self.running.runs_up);
            return refused(Rule::SpindleDwell, message);
        }
        let coolant = match state.coolant {
            Coolant::Off => !self.running.coolant,
            Coolant::Flood => self.running.coolant,
            Coolant::Mist | Coolant::FloodAndMist | Coolant::Through => false,
        };
        match coolant {
            true => Ok(()),
            false => refused(
                Rule::Coolant,
                format!("the coolant is not as the source wants it ({:?})", state.coolant),
            ),
        }
    }

    /// # Errors
    /// A corner is left by more than is allowed, overlaps with the one before on a motion of this length, or is passed from a cut to what
    /// is none.
    fn corner(
        &mut self,
        motion: &ArmMove,
        (before, length): (Option<Rounding>, f64),
        cuts: bool,
        expected: &Expected,
    ) -> Outcome {
        if before.is_some() && !cuts {
            return refused(Rule::PathTolerance, "the corner between a cut and a rapid is passed");
        }
        let own = match motion.corner {
            Corner::Within(rounding) => Some(rounding),
            Corner::Exact | Corner::Unbounded => None,
        };
        let rounded: f64 = [before, own]
            .into_iter()
            .flatten()
            .filter(|rounding| !rounding.shortened)
            .map(|rounding| rounding.distance)
            .sum();
        if rounded > length {
            let message = format!(
                "the corners at both ends of a motion of {length:.4} mm reach {rounded:.4} mm into it: the controller would skip a point"
            );
            return refused(Rule::PathTolerance, message);
        }
        let rounding = match motion.corner {
            Corner::Exact => return Ok(()),
            Corner::Within(rounding) => rounding,
            Corner::Unbounded => {
                return refused(
                    Rule::PathTolerance,
                    "a corner is passed by an amount that is not stated in mm",
                );
            }
        };
        // Both legs of the corner are left within the distance: no point between is farther from them than half of it.
        let own = self.machine.path_tolerance();
        let allowed = expected.state.corner.map_or(own, |wanted| wanted.min(own));
        let distance = rounding.distance;
        if !cuts || distance / 2.0 > allowed + 1e-9 {
            let message =
                format!("a corner may be left by {} mm, {allowed} mm are allowed", distance / 2.0);
            return refused(Rule::PathTolerance, message);
        }
        self.open = Some(rounding);
        Ok(())
    }
}

fn refused<T>(rule: Rule, message: impl Into<String>) -> Outcome<T> {
    Err(Diagnostic::error(rule, message).into())
}
