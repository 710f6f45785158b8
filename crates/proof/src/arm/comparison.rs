//! The events of a control against the steps of the source.

mod between;
mod contour;
mod cut;
mod free;
mod joints;
mod motions;
mod path;
mod reentry;

use super::expected::{Expected, Step};
use super::follow::Lost;
use crate::observer::{Deviation, Walk};
use crate::report::{ArmChecked, Report, SourceLine};
use crate::speeds::Speeds;
use ::arm::{Arm, Joints};
use control::kernel::arc::through;
use control::{Action, ArmAction, ArmMove, ArmPath, Corner, Dialect, Event, Rounding};
use geom::{Arc, Frame, Vec3, angle_between};
use machine::{Cell, Machine, OptionKey, OptionValue};
use program::{CutBox, Diagnostic, Feed, Outcome, Pose, Program, Rule, Tops};

/// Points of a motion of joints are so near that the tip moves by no more than this between them, mm.
const STRIDE: f64 = 1.0;

/// What the text of a program has switched on.
struct Running {
    /// mm/min.
    feed: Option<f64>,
    turn_speed: [Option<f64>; 2],
    /// Percent.
    joint_speed: Option<f64>,
    /// mm/s, where the control states one.
    rail_speed: Option<f64>,
    is_on: bool,
    speed: Option<f64>,
    /// How long the spindle still takes to its speed, s.
    runs_up: f64,
    coolant: bool,
    base: Option<Frame>,
    /// The same in the frame of the source.
    base_in_part: Option<Frame>,
    tool: Option<Frame>,
    on_flange: Option<bool>,
}

/// Where the arm is.
#[derive(Clone, Copy)]
struct Standing {
    joints: Joints,
    /// Of the rail, mm; 0 without one.
    rail: f64,
    /// The tool in the base of the program.
    tool: Frame,
    /// Whether it is there, or as far off as joints leave an arm that is not measured.
    exact: bool,
    /// Whether joints have led it there.
    by_joints: bool,
}

/// How tools are changed.
struct Changes {
    /// By hand, at a stop of the program: the source calls several, and the cell names no program for it.
    by_hand: bool,
    /// Number of the tool that is in the spindle.
    held: Option<u32>,
    /// The number that the last message to the operator names first.
    asked: Option<u32>,
}

pub(super) struct Comparison<'a> {
    source: &'a Program,
    machine: &'a Machine,
    arm: &'a Arm,
    cell: &'a Cell,
    cuts: CutBox,
    /// How high the source goes.
    tops: Tops<'a>,
    /// How fast it has its tools turn.
    speeds: Speeds,
    expected: Vec<Expected>,
    next: usize,
    /// How much of the next step is done, 0 to 1.
    done: f64,
    running: Running,
    standing: Option<Standing>,
    is_home: bool,
    /// The corner that the motion before has left open: the next one has to be a cut.
    open: Option<Rounding>,
    /// How the spindle has turned in the cut that was the motion before: whether, and how fast.
    turned: Option<(bool, Option<f64>)>,
    /// Where the tool has left a cut, to which it has to come back.
    away: Option<reentry::Away>,
    /// What a contour is compared with at its end.
    gathered: Option<contour::Gathered>,
    loaded: bool,
    changes: Changes,
    /// The called file in which the program is; none where it is in the one that is run.
    file: Option<Box<str>>,
    /// The motions since they were taken last, where they are wanted.
    motions: Option<Walk>,
    /// The record that the motion at hand has made.
    made: Option<usize>,
    /// How far that motion is from the source.
    deviation: Option<Deviation>,
    /// Whether it is a cut of the source.
    is_cut: bool,
    /// Whether it is one of a contour that has been compared as a whole.
    follows_contour: bool,
    /// The called files in which it has been.
    files: Vec<Box<str>>,
    ended: bool,
    failed: bool,
    report: Report,
    /// Half a step of F, mm/min, and the part of a feed by which it may be off besides; half a step of a joint, radians.
    feed_step: f64,
    feed_part: f64,
    joint_step: f64,
}

impl<'a> Comparison<'a> {
    pub(super) fn new(
        source: &'a Program,
        (machine, arm, cell): (&'a Machine, &'a Arm, &'a Cell),
        expected: Vec<Expected>,
        report: Report,
    ) -> Comparison<'a> {
        let half = |word: &str, otherwise: f64| {
            let word = machine.words.get(word);
            word.map_or(otherwise, |word| 0.5 * word.resolution())
        };
        Comparison {
            source,
            machine,
            arm,
            cell,
            cuts: CutBox::of(source),
            tops: Tops::of(source),
            speeds: Speeds::of(source),
            expected,
            next: 0,
            done: 0.0,
            running: Running {
                feed: None,
                turn_speed: [None; 2],
                joint_speed: None,
                rail_speed: None,
                is_on: false,
                speed: None,
                runs_up: 0.0,
                coolant: false,
                base: None,
                base_in_part: None,
                tool: None,
                on_flange: None,
            },
            standing: None,
            is_home: false,
            open: None,
            turned: None,
            away: None,
            gathered: None,
            loaded: false,
            changes: Changes {
                by_hand: cell.tool_change.is_empty() && source.calls_several_tools(),
                held: None,
                asked: None,
            },
            file: None,
            motions: None,
            made: None,
            deviation: None,
            is_cut: false,
            follows_contour: false,
            files: Vec::new(),
            ended: false,
            failed: false,
            report: Report { arm: Some(ArmChecked::default()), ..report },
            // Where a finer word says feeds too, the coarse one is for those that it nearly meets.
            feed_step: half("F_fine", half("F", 0.5)) * (1.0 + 1e-6),
            feed_part: if machine.words.contains_key("F_fine") { 0.005 } else { 1e-9 },
            joint_step: half("J1", 5e-4).to_radians(),
        }
    }

    /// The report, and the called files in which the program has been. `run` is what the control has answered.
    pub(super) fn finish(mut self, run: Outcome) -> (Report, Vec<Box<str>>) {
        if let Err(found) = run.and_then(|()| self.ends_on_contour()) {
            self.differs(*found);
        }
        if !self.failed {
            self.leave_out();
            if let Some(missing) = self.expected.get(self.next) {
                let message = format!("{}the program ends before this", SourceLine(missing.line));
                self.differs(Diagnostic::error(Rule::Missing, message));
            } else if !self.ended {
                self.differs(Diagnostic::error(Rule::NoEnd, "the program has no end"));
            }
        }
        self.report.proven = self.report.mismatches.is_empty();
        self.assumed_heights();
        (self.report, self.files)
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
        // Behind the last step the program still goes home.
        let source = self.expected.get(self.next).or(self.expected.last());
        let source = source.map_or(0, |expected| expected.line);
        let done = match self.gather(event) {
            Ok(true) => Ok(()),
            Ok(false) => self.take(event),
            Err(found) => Err(found),
        };
        done.map_err(|found| {
            let message = format!("{}{}", SourceLine(source), found.message);
            let line = if found.line == 0 { event.line } else { found.line };
            let file = self.file.as_deref().unwrap_or_default().to_owned();
            Box::new(Diagnostic { message, ..*found }.line(line).file(file))
        })
    }

    fn take(&mut self, event: &Event) -> Outcome {
        let before = self.standing;
        (self.made, self.deviation, self.is_cut) = (None, None, false);
        self.obey(event)?;
        self.keep_motion(event, before);
        Ok(())
    }

    fn obey(&mut self, event: &Event) -> Outcome {
        self.stays_away(&event.action)?;
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
                if self.stands_in_cut() {
                    return refused(Rule::StopInCut, "the program stops while the tool is in the cut")
                        .map_err(|found| Box::new(found.help("draw the tool back in the toolpath before STOP, by rapid or along the tool axis")));
                }
                if self.running.is_on || self.running.coolant {
                    return refused(
                        Rule::StopRunning,
                        "the program stops while the spindle or the coolant is on",
                    )
                    .map_err(|found| Box::new(found.help("switch both off before it")));
                }
                self.leave_out();
                match self.expected.get(self.next).map(|expected| &expected.step) {
                    Some(Step::Tool(tool)) if self.changes.by_hand => {
                        self.tool_by_hand(tool.number)
                    }
                    _ => self.happens(Rule::Stop, "stops", |step| matches!(step, Step::Stop)),
                }
            }
            Action::Tool(tool) => self.tool(tool.number),
            Action::Risk(risk) => {
                let message = format!("the program {}", risk.what);
                Err(Diagnostic::error(risk.rule, message).help(risk.help).into())
            }
            Action::Message(text) => {
                self.changes.asked = first_number(text);
                Ok(())
            }
            Action::Comment(_) => Ok(()),
            Action::End => self.ends(),
            Action::Rapid(_)
            | Action::Line(_)
            | Action::Arc(_)
            | Action::Thread(_)
            | Action::Probe(_)
            | Action::TouchOff(_)
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
            ArmAction::Tool(frame) => self.running.tool = frame.as_deref().copied(),
            ArmAction::Base(frame) => {
                self.running.base = frame.as_deref().copied();
                self.running.base_in_part =
                    self.running.base.map(|base| self.cell.part.inverse() * base);
                if frame.is_none() {
                    // Another program, or the configuration of the machine, has set the speed.
                    self.running.feed = None;
                }
            }
            ArmAction::PartOnFlange(on_flange) => self.running.on_flange = Some(*on_flange),
            ArmAction::JointSpeed(speed) => self.running.joint_speed = *speed,
            ArmAction::RailSpeed(speed) => self.running.rail_speed = Some(*speed),
            ArmAction::JointRate(rate) => {
                let slowest =
                    self.arm.joints().iter().map(|joint| joint.speed).fold(f64::INFINITY, f64::min);
                self.running.joint_speed = Some(100.0 * rate / slowest.to_degrees());
            }
            ArmAction::Acceleration => {
                let message = "the program sets an acceleration, and no machine file states which one the arm may have";
                return Err(Diagnostic::error(Rule::Unproven, message)
                    .help("leave it as the control is set up")
                    .into());
            }
            ArmAction::TipAcceleration(rate) => {
                return self.acceleration(OptionKey::Acceleration, 1e-3 * rate, "m/s2");
            }
            ArmAction::JointAcceleration(rate) => {
                return self.acceleration(
                    OptionKey::JointAcceleration,
                    rate.to_radians(),
                    "rad/s2",
                );
            }
            ArmAction::LoadNumber(number) => return self.load_number(*number),
            ArmAction::Load(mass, center) => return self.load(*mass, *center),
            ArmAction::TurnSpeed(speed) => self.running.turn_speed = *speed,
            ArmAction::File(name) => {
                self.border()?;
                if let Some(name) = name.as_ref().filter(|name| !self.files.contains(*name)) {
                    self.files.push(name.clone());
                }
                self.file = name.clone();
            }
            ArmAction::Move(motion) => return self.motion(line, motion),
        }
        Ok(())
    }

    /// # Errors
    /// The arm is to accelerate faster than the options of the machine's files state.
    fn acceleration(&self, option: OptionKey, rate: f64, unit: &str) -> Outcome {
        let most = match self.machine.option(option) {
            Some(OptionValue::Number(most)) => *most,
            Some(OptionValue::Flag(_) | OptionValue::Text(_)) | None => f64::NAN,
        };
        if rate <= most * 1.001 {
            return Ok(());
        }
        let option = option.name();
        let message = format!(
            "the arm accelerates by {rate:.2} {unit}, `{option}` of the machine's options is {most}"
        );
        let help = "as much as the option states, or less";
        Err(Diagnostic::error(Rule::Acceleration, message).help(help).into())
    }

    /// The program goes on in another file: the arm stops there, and the control reads that file meanwhile.
    ///
    /// # Errors
    /// The tool is in a cut.
    fn border(&mut self) -> Outcome {
        self.exact()?;
        self.leave_out();
        let last = self.last_motion();
        let is_cut = matches!(last, Some(Step::Line(..) | Step::Arc(..) | Step::Contour(_)));
        let is_cut = is_cut && !self.is_home;
        if is_cut || self.done > 0.0 || self.gathered.is_some() {
            let message = "the program goes on in another file while the tool is in a cut: the arm stops there";
            let help = "divide the program where a rapid has taken the tool off the part";
            return Err(Diagnostic::error(Rule::FileBorder, message).help(help).into());
        }
        Ok(())
    }

    /// The last step so far that is a motion.
    fn last_motion(&self) -> Option<&Step> {
        let steps = self.expected[..self.next].iter().rev().map(|expected| &expected.step);
        let mut motions = steps.filter(|step| match step {
            Step::Line(..)
            | Step::Arc(..)
            | Step::Contour(_)
            | Step::Rapid(..)
            | Step::Above(_)
            | Step::Home => true,
            Step::Tool(_) | Step::Dwell(_) | Step::Stop | Step::Output(_) | Step::Input(_) => false,
        });
        motions.next()
    }

    /// The program has made the next step, which is a motion.
    fn make_next(&mut self) {
        self.made = self.expected.get(self.next).map(|expected| expected.record);
        self.next += 1;
    }

    /// Steps of the source that need nothing of the program: a tool that is in the spindle, a way home, moves shorter than a step.
    fn leave_out(&mut self) {
        while let Some(expected) = self.expected.get(self.next) {
            let is_none = match &expected.step {
                // The one of the program, or the one before once more.
                Step::Tool(tool) => {
                    let in_place = match self.changes.by_hand {
                        true => self.changes.held == Some(tool.number),
                        false => self.cell.tool_change.is_empty(),
                    };
                    in_place && {
                        self.report.compared.tool_changes += 1;
                        true
                    }
                }
                Step::Home => self.is_home,
                Step::Rapid(Some(from), to) | Step::Line(from, to) => self.is_short(from, to),
                Step::Rapid(None, _)
                | Step::Above(_)
                | Step::Arc(..)
                | Step::Contour(_)
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
            && self.standing.is_some_and(|standing| {
                self.off(&standing.tool, to).0 <= 2.0 * self.tip(standing.by_joints)
            })
    }

    /// The tool of the program in the frame of the source.
    fn in_part(&self, tool: &Frame) -> Frame {
        match self.running.base_in_part {
            Some(base) => base * *tool,
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

    fn motion(&mut self, line: u32, motion: &ArmMove) -> Outcome {
        let from_corner = self.open.take();
        self.leave_out();
        let rail = self.rail(motion)?;
        match motion.path {
            ArmPath::Joints(shown) => {
                if from_corner.is_some() || motion.corner != Corner::Exact {
                    return refused(
                        Rule::PathTolerance,
                        "a corner is passed between a cut and a motion of joints",
                    );
                }
                match self.away.is_some() {
                    true => self.joints_away(shown, rail),
                    false => self.joints(shown, rail),
                }
            }
            ArmPath::Point(_) => {
                let message = "the joints go to a pose: in which posture, letters say that depend on rounding";
                Err(Diagnostic::error(Rule::Unproven, message).help("write the joints").into())
            }
            ArmPath::Line(end) => self.line(line, motion, &end, from_corner),
            ArmPath::Arc { via, end } => self.arc(line, motion, [&via, &end], from_corner),
        }
    }

    /// Line of the source of the step before the next one; 0 where there is none.
    fn line_before(&self) -> u32 {
        let before = self.next.checked_sub(1).and_then(|before| self.expected.get(before));
        before.map_or(0, |before| before.line)
    }

    /// Where the rail is behind a motion, mm.
    ///
    /// # Errors
    /// The program does not say it, or it is beyond the travel of the rail; there is none.
    fn rail(&self, motion: &ArmMove) -> Outcome<f64> {
        let refused = |rule, message: String, help: &str| {
            Err(Diagnostic::error(rule, message).help(help).into())
        };
        // KUKA's controllers write E1 0 into positions that are taught, of an arm without outer axes as well.
        let is_taught = Dialect::named(&self.machine.reader) == Some(Dialect::Krl);
        match (&self.cell.rail, motion.rail) {
            (None, None) => Ok(0.0),
            (None, Some(0.0)) if is_taught => Ok(0.0),
            (None, Some(at)) => refused(
                Rule::Rail,
                format!("the program moves a rail to {at:.3} mm, and the arm stands on none"),
                "`rail` below [cell] of the machine file, or no position of it (9E9 in RAPID)",
            ),
            (Some(_), None) => refused(
                Rule::Rail,
                String::from("the program moves the arm and has not stated where its rail stands"),
                "write the position of the rail (E1 in KRL) into the first motion, and behind each tool change",
            ),
            (Some(rail), Some(at)) if rail.holds(at) => Ok(at),
            (Some(rail), Some(at)) => refused(
                Rule::AxisLimit,
                format!(
                    "the rail would be at {at:.3} mm, its travel is {} to {} mm",
                    rail.min, rail.max
                ),
                "a position within `min` and `max` of `rail` below [cell]",
            ),
        }
    }

    /// # Errors
    /// Why the arm cannot be where it is led.
    fn lost<T>(&self, rule: Rule, lost: Lost) -> Outcome<T> {
        let cable = match lost {
            Lost::Limit(joint, _) => self.cell.cable(joint),
            Lost::Reach | Lost::Posture | Lost::Singular(_) | Lost::Speed(..) => None,
        };
        let found = Diagnostic::error(rule, lost.to_string());
        let own = "another place of the part (`toolpost fit` looks for one), or a lower feed";
        Err(match cable {
            Some(cable) => found.help(cable),
            None if rule == Rule::AxisLimit => found.help(own),
            None => found,
        }
        .into())
    }

    fn arrives(&self, at: &Frame, to: &Pose, by_joints: bool) -> bool {
        let (tip, axis) = self.off(at, to);
        tip <= self.tip(by_joints) && axis <= self.axis_allowed()
    }

    fn checked(&mut self) -> &mut ArmChecked {
        self.report.arm.get_or_insert_default()
    }

    fn elsewhere<T>(&self, end: &Frame, to: &Pose) -> Outcome<T> {
        let (tip, axis) = self.off(end, to);
        let message = format!("the tip ends {tip:.4} mm off, the axis {axis:.4}°");
        Err(Diagnostic::error(Rule::EndPoint, message).help(self.way_to_end()).into())
    }

    /// The way out where a motion ends elsewhere.
    fn way_to_end(&self) -> &'static str {
        match self.cell.rail {
            Some(_) => {
                "the end of the source's motion: its position, or its joints and the place of the rail (E1 in KRL and LS, eax_a in RAPID) that belong together"
            }
            None => "the end of the source's motion: its position, or the joints that lead there",
        }
    }

    /// Notes how far the end of a step is off.
    fn note_end(&mut self, end: &Frame, to: &Pose, line: u32) -> Outcome {
        if !self.arrives(end, to, false) {
            return self.elsewhere(end, to);
        }
        let (tip, axis) = self.off(end, to);
        let source = self.expected.get(self.next).map_or(0, |expected| expected.line);
        let place = (self.file.as_deref(), line);
        self.report.deviations.tip_mm.note(tip, source, place);
        self.report.deviations.axis_degrees.note(axis, source, place);
        Deviation::widen(&mut self.deviation, (tip, axis));
        Ok(())
    }
}

/// The first number of a text.
fn first_number(text: &str) -> Option<u32> {
    text.split(|c: char| !c.is_ascii_digit()).find(|digits| !digits.is_empty())?.parse().ok()
}

/// The arc through three points.
///
/// # Errors
/// There is none.
fn arc_through([from, via, to]: [Vec3; 3]) -> Outcome<Arc> {
    let Some((center, normal)) = through(from, via, to) else {
        return refused(
            Rule::ArcPoints,
            "the three points of the arc are on a line, or two of them are one",
        );
    };
    let radius = from.distance(center);
    Arc::new(from, to, center, normal, 0, radius * 1e-6)
        .or_else(|_| refused(Rule::Arc, "the three points span no arc"))
}

fn refused<T>(rule: Rule, message: impl Into<String>) -> Outcome<T> {
    Err(Diagnostic::error(rule, message).into())
}
