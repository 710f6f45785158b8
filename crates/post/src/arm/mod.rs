//! Programs for arms: joints where the joints interpolate, poses with the whole orientation along lines and arcs.
//!
//! `plan` finds the motions of the source and, by `armpath`, the joints at the end of each; `rapid` says how a rapid goes; what stands here
//! writes the blocks. The language is the control file's: no block of it is known here but by its name.

mod plan;
mod rapid;

use crate::catalogue::{BlockName, WordName};
use crate::findings::Findings;
use crate::template::{Scope, Templates, file_name, map, program_value};
use crate::text::printed;
use crate::writer::Writer;
use crate::{Output, promises};
use ::arm::{Arm, Joints};
use geom::{Euler, Frame, Mat3, Quat};
use machine::limits::Limits;
use machine::{Cell, Machine};
use minijinja::value::Value;
use plan::{Act, Kind, Motion, Position, Step, plan};
use program::{Coolant, CutBox, Diagnostic, Outcome, OutputValue, Program, Rule, Spindle, Tool};
use rapid::{Leg, Way, Ways};

/// Entries of the code word `corner`.
mod corner {
    pub(super) const EXACT: usize = 0;
    pub(super) const BLEND: usize = 1;
}

/// The words of a pose, and of the point half way along an arc.
const POSE: [WordName; 6] =
    [WordName::X, WordName::Y, WordName::Z, WordName::A, WordName::B, WordName::C];
const MIDDLE: [WordName; 6] =
    [WordName::MX, WordName::MY, WordName::MZ, WordName::MA, WordName::MB, WordName::MC];
const JOINTS: [WordName; 6] =
    [WordName::J1, WordName::J2, WordName::J3, WordName::J4, WordName::J5, WordName::J6];

/// Writes `program` for the arm of `machine`.
///
/// # Errors
/// As [`crate::write`].
pub(crate) fn write(
    program: &Program,
    machine: &Machine,
    robot: (&Arm, &Cell),
) -> Result<Output, Vec<Diagnostic>> {
    let mut walk = Walk::new(program, machine, robot)?;
    if let Err(error) = plan(program, machine, robot).and_then(|steps| walk.all(&steps)) {
        walk.findings.error(*error);
    }
    let warnings = walk.findings.finish(machine.capabilities.lowering_tolerance)?;
    let (text, blocks) = walk.writer.finish();
    Ok(Output { text, blocks, warnings })
}

/// Compiles the templates of an arm's machine and compares them with what its control promises.
///
/// # Errors
/// The mistakes in its files.
pub(crate) fn check(machine: &Machine, robot: (&Arm, &Cell)) -> Result<(), Vec<Diagnostic>> {
    Walk::new(&Program::default(), machine, robot).map(drop)
}

/// What the control has been sent.
struct Sent {
    /// mm/min.
    feed: Option<f64>,
    corner: Option<f64>,
    spindle: Spindle,
    coolant: Coolant,
}

struct Walk<'a> {
    machine: &'a Machine,
    arm: &'a Arm,
    cell: &'a Cell,
    templates: Templates<'a>,
    writer: Writer,
    scope: Scope,
    findings: Findings,
    limits: Limits<'a>,
    ways: Ways<'a>,
    sent: Sent,
    /// What the source wants in cuts.
    spindle: Spindle,
    coolant: Coolant,
    /// The tool's tip in the frame of the flange.
    tool: Option<Frame>,
    /// Where the arm is; home without a pose that the source has named.
    here: Position,
    tools: u32,
}

impl<'a> Walk<'a> {
    fn new(
        program: &Program,
        machine: &'a Machine,
        (arm, cell): (&'a Arm, &'a Cell),
    ) -> Result<Walk<'a>, Vec<Diagnostic>> {
        let templates = Templates::compile(machine)?;
        promises::check_arm(machine, &templates)?;
        let one = |found: Diagnostic| vec![found.file(machine.file.clone())];
        let home = arm.model(&cell.home.map(f64::to_radians)).ok_or_else(|| {
            let message = "how the controller counts joint 3 is not stated";
            let help = "`coupling` below [arm] of the machine file: look at the controller";
            one(Diagnostic::error(Rule::ArmCoupling, message).help(help))
        })?;
        if !arm.allows(&home) {
            let message = "`home` below [cell] is beyond a limit of a joint";
            return Err(one(Diagnostic::error(Rule::AxisLimit, message)));
        }
        let mut scope = Scope::new(machine);
        let name = name_of(&program.name);
        scope.program =
            program_value(machine, name, &[], None, [("blank", false), ("stock", false)]);
        let mut writer = Writer::new(machine);
        writer.set(WordName::JointSpeed, cell.joint_speed);
        Ok(Walk {
            machine,
            arm,
            cell,
            templates,
            writer,
            scope,
            findings: Findings::default(),
            limits: Limits::new(machine),
            ways: Ways { arm, cell, can: &machine.capabilities, cuts: CutBox::of(program) },
            sent: Sent { feed: None, corner: None, spindle: Spindle::Off, coolant: Coolant::Off },
            spindle: Spindle::Off,
            coolant: Coolant::Off,
            tool: None,
            here: Position { tool: Frame::IDENTITY, joints: home },
            tools: 0,
        })
    }

    /// The whole program.
    fn all(&mut self, steps: &[Step]) -> Outcome {
        self.block(BlockName::ProgramStart)?;
        for (index, step) in steps.iter().enumerate() {
            let (line, done) = match step {
                Step::Act(act, line) => (*line, self.act(*act, *line)),
                Step::Move(motion) => {
                    let next = match steps.get(index + 1) {
                        Some(Step::Move(next)) => Some(next),
                        Some(Step::Act(..)) | None => None,
                    };
                    (motion.line, self.motion(motion, next))
                }
            };
            done.map_err(|found| {
                Box::new(if found.line == 0 { found.line(line) } else { *found })
            })?;
        }
        self.begin()?;
        self.home()?;
        self.switch_off()?;
        self.block(BlockName::ProgramEnd)
    }

    fn act(&mut self, act: Act, line: u32) -> Outcome {
        match act {
            Act::Tool(tool) => self.change_tool(tool, line),
            Act::Home => self.home(),
            Act::Spindle(spindle) => {
                self.limits.spindle(spindle, line)?;
                self.spindle = spindle;
                if spindle == Spindle::Off { self.stop_spindle() } else { Ok(()) }
            }
            Act::Coolant(coolant) => {
                self.coolant = coolant;
                if coolant == Coolant::Off { self.stop_coolant() } else { Ok(()) }
            }
            Act::Dwell(seconds) => self.dwell(seconds),
            Act::Stop => {
                self.begin()?;
                self.switch_off()?;
                self.required(BlockName::Stop)
            }
            Act::Output(output) => {
                let OutputValue::Digital(on) = output.value else {
                    let message = "an analog output of the source is not written for robots";
                    return Err(Diagnostic::error(Rule::Unsupported, message).into());
                };
                self.begin()?;
                self.writer.set(WordName::Signal, f64::from(output.number));
                self.writer.code(WordName::Output, usize::from(!on));
                self.required(BlockName::DigitalOutput)
            }
            Act::Operation(name) => {
                self.scope.operation = map([("name", Value::from(printed(self.machine, name)))]);
                self.block(BlockName::OperationStart)
            }
            Act::Text(text) => {
                self.scope.text = Value::from(printed(self.machine, text));
                self.block(BlockName::Comment)
            }
        }
    }

    /// The arm is home, with its frames stated, before anything else happens.
    fn begin(&mut self) -> Outcome {
        if self.tool.is_some() {
            return Ok(());
        }
        self.load(&Tool::default())
    }

    /// Frames of this tool, and the joints home.
    fn load(&mut self, tool: &Tool) -> Outcome {
        let Some(frame) = self.cell.tool(tool.length) else {
            let message =
                "neither the source nor `tool_length` of the cell states the length of the tool";
            let help = "LENGTH in the source's tool call, or `tool_length` below [cell] of the machine file";
            return Err(Diagnostic::error(Rule::ToolLength, message).help(help).into());
        };
        self.tool = Some(frame);
        (self.sent.feed, self.sent.corner) = (None, None);
        let part = self.cell.part;
        self.set(POSE, &part);
        self.set(MIDDLE, &frame);
        self.required(BlockName::Frames)?;
        self.joints(&self.home_joints())
    }

    fn home_joints(&self) -> Joints {
        self.arm.model(&self.cell.home.map(f64::to_radians)).unwrap_or_default()
    }

    fn change_tool(&mut self, tool: &Tool, line: u32) -> Outcome {
        self.limits.tool(tool, line)?;
        (self.spindle, self.coolant) = (Spindle::Off, Coolant::Off);
        self.tools += 1;
        if self.cell.tool_change.is_empty() {
            if self.tools > 1 {
                let message = "the source calls another tool, and the machine file names no program that changes it";
                let help = "`tool_change` below [cell], or one program for each tool";
                return Err(Diagnostic::error(Rule::ToolChange, message).help(help).into());
            }
            return self.load(tool);
        }
        self.begin()?;
        self.home()?;
        self.switch_off()?;
        self.writer.set(WordName::T, f64::from(tool.number));
        self.scope.tool = crate::template::tool_value(self.machine, tool, self.tools == 1, None);
        self.required(BlockName::ToolChange)?;
        self.load(tool)
    }

    /// The joints go home, where the path is clear.
    fn home(&mut self) -> Outcome {
        let (Some(tool), home) = (self.tool, self.home_joints()) else { return Ok(()) };
        if self.here.joints == home {
            return Ok(());
        }
        let end = self.at_joints(&tool, &home);
        let Some(route) = self.ways.route(&tool, &self.here, &end, true) else {
            let message = "the way home by the joints comes too near to what is cut";
            let help =
                "end with a rapid that lifts the tool off the part, or change `home` below [cell]";
            return Err(Diagnostic::error(Rule::RapidPath, message).help(help).into());
        };
        self.follow(&route)
    }

    /// The position of these joints.
    fn at_joints(&self, tool: &Frame, joints: &Joints) -> Position {
        let at = self.cell.part.inverse() * self.arm.flange(joints) * *tool;
        Position { tool: at, joints: *joints }
    }

    /// Goes by rapid along a route.
    fn follow(&mut self, route: &[Leg]) -> Outcome {
        for leg in route {
            match leg.way {
                Way::Joints => self.joints(&leg.end.joints)?,
                Way::Straight(feed) => {
                    self.feed(feed)?;
                    self.straight(&leg.end, corner::EXACT)?;
                }
            }
        }
        Ok(())
    }

    fn joints(&mut self, joints: &Joints) -> Outcome {
        let Some(shown) = self.arm.shown(joints) else {
            let message = "how the controller counts joint 3 is not stated";
            return Err(Diagnostic::error(Rule::ArmCoupling, message).into());
        };
        for (word, joint) in JOINTS.into_iter().zip(shown) {
            self.writer.set(word, joint.to_degrees());
        }
        self.required(BlockName::Joints)?;
        let tool = self.tool.unwrap_or(Frame::IDENTITY);
        self.here = self.at_joints(&tool, joints);
        Ok(())
    }

    fn motion(&mut self, motion: &Motion, next: Option<&Motion>) -> Outcome {
        self.begin()?;
        match motion.kind {
            Kind::Rapid => self.rapid(motion),
            Kind::Line | Kind::Arc(_) => self.cut(motion, next),
        }
    }

    fn rapid(&mut self, motion: &Motion) -> Outcome {
        let Some(tool) = self.tool else { return Ok(()) };
        let apart = self.here.tool.translation.distance(motion.end.tool.translation);
        if self.here.joints == motion.end.joints && apart < self.machine.resolution() {
            return Ok(());
        }
        let Some(route) = self.ways.route(&tool, &self.here, &motion.end, false) else {
            let message = "the arm cannot go here by rapid: by its joints the tool would come too near to what is cut, and straight the \
                           posture or a turn of a joint would not fit";
            let help = "a rapid that lifts the tool higher before it, or another place of the part (`part` below [cell])";
            return Err(Diagnostic::error(Rule::RapidPath, message).help(help).into());
        };
        self.follow(&route)
    }

    fn cut(&mut self, motion: &Motion, next: Option<&Motion>) -> Outcome {
        let Motion { line, kind, feed, .. } = *motion;
        self.limits.feed(program::Feed::PerMinute(feed), self.spindle, line)?;
        self.start_spindle()?;
        self.start_coolant()?;
        self.feed(feed)?;
        // Only within a cut is a corner passed.
        let goes_on = next.is_some_and(|next| next.kind != Kind::Rapid);
        let distance = 2.0 * motion.corner;
        let passes = goes_on && distance > 0.0;
        if passes && self.sent.corner != Some(distance) {
            self.writer.set(WordName::Corner, distance);
            self.required(BlockName::CornerDistance)?;
            self.sent.corner = Some(distance);
        }
        let code = if passes { corner::BLEND } else { corner::EXACT };
        match kind {
            Kind::Arc(via) => {
                let [a, b] =
                    [&self.here.tool, &motion.end.tool].map(|tool| Quat::from_mat3(&tool.matrix3));
                let half = Mat3::from_quat(a.slerp(b, 0.5));
                self.set(MIDDLE, &Frame::from_mat3_translation(half, via));
                self.set(POSE, &motion.end.tool);
                self.writer.code(WordName::CornerMode, code);
                self.required(BlockName::ArcThrough)?;
                self.here = motion.end;
                Ok(())
            }
            Kind::Line | Kind::Rapid => self.straight(&motion.end, code),
        }
    }

    fn straight(&mut self, end: &Position, code: usize) -> Outcome {
        self.set(POSE, &end.tool);
        self.writer.code(WordName::CornerMode, code);
        self.required(BlockName::Linear)?;
        self.here = *end;
        Ok(())
    }

    /// The feed, where it changes.
    fn feed(&mut self, feed: f64) -> Outcome {
        if self.sent.feed == Some(feed) {
            return Ok(());
        }
        self.writer.set(WordName::F, feed);
        self.required(BlockName::Feed)?;
        self.sent.feed = Some(feed);
        Ok(())
    }

    /// The six numbers of a frame: X, Y, Z, and the turns about Z, the new Y and the new X.
    fn set(&mut self, words: [WordName; 6], frame: &Frame) {
        let [c, b, a] = Euler::FixedXyz.angles(&frame.matrix3).map(f64::to_degrees);
        let tip = frame.translation;
        for (word, value) in words.into_iter().zip([tip.x, tip.y, tip.z, a, b, c]) {
            self.writer.set(word, value);
        }
    }

    fn start_spindle(&mut self) -> Outcome {
        if self.spindle == self.sent.spindle {
            return Ok(());
        }
        let (block, speed) = match self.spindle {
            Spindle::Off => return self.stop_spindle(),
            Spindle::Clockwise(speed) => (BlockName::SpindleCw, speed),
            Spindle::CounterClockwise(speed) => (BlockName::SpindleCcw, speed),
        };
        let (Some(output), Some((channel, full))) =
            (self.cell.spindle_output, self.cell.spindle_analog)
        else {
            let message =
                "the source starts the spindle, and the cell does not state by which outputs";
            let help = "`spindle_output`, `spindle_analog` and `spindle_full` below [cell]";
            return Err(Diagnostic::error(Rule::Spindle, message).help(help).into());
        };
        self.writer.set(WordName::Signal, f64::from(output));
        self.writer.set(WordName::Channel, f64::from(channel));
        self.writer.set(WordName::Value, speed / full);
        self.required(block)?;
        self.sent.spindle = self.spindle;
        match self.machine.spindle.dwell {
            0.0 => Ok(()),
            seconds => self.dwell(seconds),
        }
    }

    fn stop_spindle(&mut self) -> Outcome {
        let Some(output) = self.cell.spindle_output.filter(|_| self.sent.spindle != Spindle::Off)
        else {
            return Ok(());
        };
        self.writer.set(WordName::Signal, f64::from(output));
        self.sent.spindle = Spindle::Off;
        self.required(BlockName::SpindleOff)
    }

    fn start_coolant(&mut self) -> Outcome {
        if self.coolant == self.sent.coolant {
            return Ok(());
        }
        let (Some(output), Coolant::Flood) = (self.cell.coolant_output, self.coolant) else {
            let message = "the source switches coolant on for which the cell has no output";
            let help = "`coolant_output` below [cell], which is that of flood coolant";
            return Err(Diagnostic::error(Rule::Coolant, message).help(help).into());
        };
        self.writer.set(WordName::Signal, f64::from(output));
        self.sent.coolant = self.coolant;
        self.required(BlockName::CoolantFlood)
    }

    fn stop_coolant(&mut self) -> Outcome {
        let Some(output) = self.cell.coolant_output.filter(|_| self.sent.coolant != Coolant::Off)
        else {
            return Ok(());
        };
        self.writer.set(WordName::Signal, f64::from(output));
        self.sent.coolant = Coolant::Off;
        self.required(BlockName::CoolantOff)
    }

    fn switch_off(&mut self) -> Outcome {
        self.stop_spindle()?;
        self.stop_coolant()
    }

    fn dwell(&mut self, seconds: f64) -> Outcome {
        self.begin()?;
        self.writer.set(WordName::P, seconds);
        self.required(BlockName::Dwell)
    }

    /// Writes a block, where the control has it.
    fn block(&mut self, name: BlockName) -> Outcome {
        match self.templates.lines(name) {
            Some(lines) => self.writer.block(lines),
            None => {
                let scope = Scope { set: self.writer.set_words(), ..self.scope.clone() };
                self.writer.block(&self.templates.render(name, scope)?)
            }
        }
    }

    /// Writes a block that must be there.
    fn required(&mut self, name: BlockName) -> Outcome {
        if self.templates.has(name) {
            return self.block(name);
        }
        let message = format!("the control has no block `{}`", name.name());
        let help = format!("`{}` in its file, or a toolpath that does without", name.name());
        Err(Diagnostic::error(Rule::MissingBlock, message).help(help).into())
    }
}

/// The name of a program as controllers of robots take it: letters, digits and `_`, a letter first, at most 24.
fn name_of(name: &str) -> String {
    let name: String = file_name(name).chars().map(|c| if c == '-' { '_' } else { c }).collect();
    match name.chars().next().is_some_and(|first| first.is_ascii_alphabetic()) {
        true => name,
        false => format!("P{name}").chars().take(24).collect(),
    }
}
