//! Programs for arms: joints where the joints interpolate, poses with the whole orientation along lines and arcs.
//!
//! `plan` finds the motions of the source and, by `armpath`, the joints at the end of each; `rapid` says how a rapid goes; what stands here
//! writes the blocks. The language is the control file's: no block of it is known here but by its name.

mod parts;
mod plan;
mod rail;
mod rapid;
pub(crate) mod reach;

use crate::around::{Around, ends_in_cut, stops_in_cut};
use crate::catalogue::{BlockName, WordName};
use crate::findings::Findings;
use crate::template::{Scope, Templates, file_name, map, program_value};
use crate::text::printed;
use crate::writer::{Cutting, Writer};
use crate::{Output, Part, promises};
use ::arm::{Arm, Joints};
use geom::{Euler, Frame, Mat3, Quat, Vec3, wrap};
use machine::limits::Limits;
use machine::{Cell, Load, Machine, Word};
use minijinja::value::Value;
use parts::{Border, Size};
use plan::{Act, Kind, Motion, Position, Reentry, Step, plan};
use program::{
    Coolant, Diagnostic, LYING, Op, Outcome, OutputValue, Program, Progress, Pulse, Record, Rule,
    Spindle, Tool,
};
use rapid::{RapidPath, RapidPlanner, RapidSegment};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Entries of the code word `corner`.
mod corner {
    pub(super) const EXACT: usize = 0;
    pub(super) const BLEND: usize = 1;
}

/// By how much the word of a feed may round it, as a part of it.
const ROUGH: f64 = 0.05;

/// By how much of itself a cut may take longer than at its feed, because the tool turns.
const SLOWER: f64 = 0.02;

/// By how much a word may round a feed before a finer one is taken, as a part of it.
const FAIR: f64 = 0.005;

/// Joints of which a position states how many turns they have made, and its words.
const TURNS: [(WordName, usize); 3] =
    [(WordName::Turn1, 0), (WordName::Turn4, 3), (WordName::Turn6, 5)];

/// By how much the tool is turned about its axis where rounding would decide that, degrees.
const NUDGES: [f64; 6] = [0.01, -0.01, 0.03, -0.03, 0.1, -0.1];

/// Whether rounding decides how many turns a joint has made, degrees as the controller shows it.
fn is_on_edge(shown: f64) -> bool {
    let turns = (shown + 180.0) / 360.0;
    (turns - turns.round()).abs() * 360.0 < 2e-3
}

/// After so many steps whoever waits is asked: some milliseconds at the most.
const STEPS_AT_ONCE: u32 = 32;

/// A tool that rises along Z by no less than this part of its way along itself stands upright: it leans by 5 degrees at the most.
const UPRIGHT: f64 = 0.996;

/// Joints that differ by less are the same, radians.
const SAME_JOINTS: f64 = 1e-5;

/// The words of a pose: where the tip is, and the orientation in each form that a control may place.
pub(crate) struct PoseWords {
    pub(crate) tip: [WordName; 3],
    /// Turns about Z, the new Y and the new X.
    pub(crate) turns: [WordName; 3],
    pub(crate) vector: [WordName; 3],
    pub(crate) quaternion: [WordName; 4],
}

pub(crate) const POSE: PoseWords = PoseWords {
    tip: [WordName::X, WordName::Y, WordName::Z],
    turns: [WordName::A, WordName::B, WordName::C],
    vector: [WordName::VectorX, WordName::VectorY, WordName::VectorZ],
    quaternion: [
        WordName::Quaternion1,
        WordName::Quaternion2,
        WordName::Quaternion3,
        WordName::Quaternion4,
    ],
};

/// Those of the point half way along an arc.
pub(crate) const MIDDLE: PoseWords = PoseWords {
    tip: [WordName::MX, WordName::MY, WordName::MZ],
    turns: [WordName::MA, WordName::MB, WordName::MC],
    vector: [WordName::MiddleVectorX, WordName::MiddleVectorY, WordName::MiddleVectorZ],
    quaternion: [
        WordName::MiddleQuaternion1,
        WordName::MiddleQuaternion2,
        WordName::MiddleQuaternion3,
        WordName::MiddleQuaternion4,
    ],
};

const JOINTS: [WordName; 6] =
    [WordName::J1, WordName::J2, WordName::J3, WordName::J4, WordName::J5, WordName::J6];

/// Writes `program` for the arm of `machine` under a name; `offsets` where its contours have been offset.
///
/// # Errors
/// As [`crate::write`].
pub(crate) fn write(
    program: &Program,
    machine: &Machine,
    robot: (&Arm, &Cell),
    (name, offsets): (&str, bool),
    progress: &dyn Progress,
) -> Result<Output, Vec<Diagnostic>> {
    let mut walk = Walk { offsets, ..Walk::new(program, machine, robot, name)? };
    let planned = plan(program, machine, robot);
    match planned.as_ref().map_err(Clone::clone).and_then(|steps| walk.all(steps, progress)) {
        Ok(size) if parts::bounds(machine).hold(&size) => {}
        Ok(size) => {
            let whole = walk;
            walk = Walk { offsets, ..Walk::new(program, machine, robot, name)? };
            let steps = planned.as_deref().unwrap_or_default();
            if let Err(error) = walk.divided(steps, &whole.borders, size, progress) {
                walk.findings.error(*error);
            }
        }
        Err(error) => {
            walk.findings.error(*error);
        }
    }
    if let Some(line) = program.compensates() {
        let message = "the source gives the path of the tool's centre with cutter compensation: it is written as it is, and offsets \
                       at the robot do not change the size of what is cut";
        let found = Diagnostic::warning(Rule::CompensatedPath, message);
        walk.findings.warn(found.help("a robot has no compensation").line(line));
    }
    for record in program.records.iter().filter(|record| matches!(record.op, Op::Clamp(_))) {
        let message = "a clamp of a rotary axis is left out: a robot has none";
        let found = Diagnostic::warning(Rule::Clamp, message).help("nothing to do");
        walk.findings.warn(found.line(record.line));
    }
    let warnings = walk.findings.finish(machine.capabilities.lowering_tolerance)?;
    let parts = std::mem::take(&mut walk.parts);
    let (text, origins, blocks) = walk.writer.finish();
    Ok(Output { text, origins, blocks, warnings, parts })
}

/// Compiles the templates of an arm's machine and compares them with what its control promises.
///
/// # Errors
/// The mistakes in its files.
pub(crate) fn check(machine: &Machine, robot: (&Arm, &Cell)) -> Result<(), Vec<Diagnostic>> {
    Walk::new(&Program::default(), machine, robot, "").map(drop)
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
    rapids: RapidPlanner<'a>,
    sent: Sent,
    /// Whether contours have been offset.
    offsets: bool,
    records: &'a [Record],
    /// Of the record at hand.
    index: usize,
    around: Around,
    /// What the source wants in cuts.
    spindle: Spindle,
    coolant: Coolant,
    /// The tool's tip in the frame of the flange.
    tool: Option<Frame>,
    /// The entry of the code word `feed_unit` that the last feed has.
    feed_unit: usize,
    /// Where the arm is; home without a pose that the source has named.
    here: Position,
    /// Whether it is there, or as far off as joints leave it.
    is_exact: bool,
    /// The orientation that was written last as a vector along its axis of rotation, radians.
    vector: Vec3,
    /// Positions that stand behind the instructions, and how many they are.
    table: Cutting,
    points: u32,
    /// Whether the last motion has cut.
    is_cutting: bool,
    /// The line of the last motion of the source.
    last_line: u32,
    /// Whether the source calls tools of more than one number.
    changes: bool,
    /// Number of the tool that is in the spindle.
    held: Option<u32>,
    /// Length of each tool so far, as its first call states it, mm.
    lengths: HashMap<u32, Option<f64>>,
    /// The name of the program.
    name: String,
    /// Lines of the files before this one.
    earlier_lines: usize,
    /// Where the program may be divided.
    borders: Vec<Border>,
    /// The files that are written, where it is.
    parts: Vec<Part>,
}

impl<'a> Walk<'a> {
    fn new(
        program: &'a Program,
        machine: &'a Machine,
        (arm, cell): (&'a Arm, &'a Cell),
        name: &str,
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
            let beyond = (arm.joints().iter().zip(home)).position(|(joint, at)| !joint.holds(at));
            // The limit that is left is that of joint 3 as the controller shows it.
            let joint = beyond.map_or(3, |joint| joint + 1);
            let message = format!(
                "`home` below [cell] has joint {joint} at {} degrees, beyond its limit",
                cell.home[joint - 1]
            );
            let own = "a `home` within the limits of all joints".to_owned();
            let help = cell.cable(joint).map_or(own.clone(), |cable| format!("{own}: {cable}"));
            return Err(one(Diagnostic::error(Rule::AxisLimit, message).help(help)));
        }
        let mut scope = Scope::new(machine);
        let name = name_of(name);
        scope.program = named(machine, &name, "");
        let mut writer = Writer::new(machine);
        if let Some(speed) = machine.turn_speed() {
            writer.set_always(WordName::TurnSpeed, speed);
        }
        if let Some(number) = cell.own_frame {
            writer.set_always(WordName::OwnFrame, f64::from(number));
        } else if templates.places(BlockName::Frames, WordName::OwnFrame) {
            let message = "the control keeps frames by numbers, and the cell does not state which its programs may set";
            let help = "`own_frame` below [cell]: a user frame, a tool and a position register of this number that nothing else uses";
            return Err(one(Diagnostic::error(Rule::Frame, message).help(help)));
        }
        if templates.places(BlockName::Frames, WordName::LoadMass) && cell.load.is_none() {
            let message =
                "the control asks for the load on the flange, and the cell does not state it";
            let help =
                "weigh the spindle with a tool in it: `load_mass` and `load_center` below [cell]";
            return Err(one(Diagnostic::error(Rule::Payload, message).help(help)));
        }
        Ok(Walk {
            machine,
            arm,
            cell,
            templates,
            writer,
            scope,
            findings: Findings::default(),
            limits: Limits::new(machine),
            rapids: RapidPlanner::new(program, machine, (arm, cell)),
            sent: Sent { feed: None, corner: None, spindle: Spindle::Off, coolant: Coolant::Off },
            offsets: false,
            records: &program.records,
            index: 0,
            around: Around::default(),
            spindle: Spindle::Off,
            coolant: Coolant::Off,
            tool: None,
            here: Position { tool: Frame::IDENTITY, joints: home, rail: cell.rail_home() },
            is_exact: false,
            feed_unit: 0,
            vector: Vec3::ZERO,
            table: Cutting::default(),
            points: 0,
            is_cutting: false,
            last_line: 0,
            changes: program.calls_several_tools(),
            held: None,
            lengths: HashMap::new(),
            name,
            earlier_lines: 0,
            borders: Vec::new(),
            parts: Vec::new(),
        })
    }

    /// The whole program in one file; how large it is.
    fn all(&mut self, steps: &[Step<'_>], progress: &dyn Progress) -> Outcome<Size> {
        let mut pulse = Pulse::new(progress, steps.len(), STEPS_AT_ONCE);
        self.start(BlockName::ProgramStart)?;
        let is_bounded = !parts::bounds(self.machine).hold(&Size::MOST);
        for index in 0..steps.len() {
            pulse.step(index)?;
            if is_bounded && self.is_border() {
                self.borders.push(Border { step: index, size: self.size() });
            }
            self.step(steps, index)?;
        }
        self.finish()?;
        self.end(BlockName::ProgramStart, BlockName::ProgramEnd)
    }

    /// One step of it.
    fn step(&mut self, steps: &[Step<'_>], index: usize) -> Outcome {
        let (line, done) = match &steps[index] {
            Step::Act(act, line, record) => {
                self.index = *record;
                self.writer.is_for(Some(*record));
                (*line, self.act(*act, *line))
            }
            Step::Reenter(reentry) => (reentry.line, self.reenter(reentry)),
            Step::Move(motion) => {
                self.writer.is_for(Some(motion.record));
                let next = match steps.get(index + 1) {
                    Some(Step::Move(next)) => Some(next),
                    Some(Step::Act(..) | Step::Reenter(_)) | None => None,
                };
                self.last_line = motion.line;
                let done = match motion.kind {
                    Kind::Rapid => self.begin().and_then(|()| self.rapid(motion)),
                    Kind::Line | Kind::Arc(_) => self.begin().and_then(|()| self.cut(motion, next)),
                };
                (motion.line, done)
            }
        };
        done.map_err(|found| Box::new(if found.line == 0 { found.line(line) } else { *found }))
    }

    fn stands_in_cut(&mut self) -> bool {
        self.around.stands_in_cut(self.records, self.index)
    }

    fn warn_of_cut(&mut self, ends: &str, line: u32) {
        if self.stands_in_cut() {
            self.findings.warn(ends_in_cut(ends).line(line));
        }
    }

    /// The arm goes home, and everything is switched off.
    ///
    /// # Errors
    /// It cannot, with the line of the last motion.
    fn finish(&mut self) -> Outcome {
        self.writer.is_for(None);
        self.index = self.records.len();
        self.warn_of_cut("ends", self.records.last().map_or(0, |record| record.line));
        let done = self.begin().and_then(|()| self.home()).and_then(|()| self.switch_off());
        done.map_err(|found| Box::new(found.line(self.last_line)))
    }

    /// Whether the head of a file counts its lines: it is written last then.
    fn counts(&self, start: BlockName) -> bool {
        self.templates.places(start, WordName::Lines)
    }

    /// The head of a file.
    fn start(&mut self, start: BlockName) -> Outcome {
        if self.counts(start) { Ok(()) } else { self.block(start) }
    }

    /// The end of a file, behind its positions, and its head where that counts its lines; how large it is.
    fn end(&mut self, start: BlockName, end: BlockName) -> Outcome<Size> {
        self.block(BlockName::PositionsStart)?;
        let table = std::mem::take(&mut self.table);
        self.writer.paste(table);
        self.block(end)?;
        if self.counts(start) {
            let at = self.writer.end();
            self.writer.set(WordName::Lines, self.writer.numbered() as f64);
            self.block(start)?;
            let head = self.writer.cut(at);
            self.writer.paste_before(head);
        }
        Ok(self.size())
    }

    fn act(&mut self, act: Act<'_>, line: u32) -> Outcome {
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
            Act::Dwell(seconds) => {
                self.begin()?;
                // The source lets its spindle run up, or turn in the cut.
                let has_waited = self.start_spindle(seconds)?;
                if has_waited { Ok(()) } else { self.dwell(seconds) }
            }
            Act::Stop if self.stands_in_cut() => Err(stops_in_cut().into()),
            Act::Stop => {
                self.begin()?;
                self.switch_off()?;
                self.required(BlockName::Stop)
            }
            Act::Output(output) => {
                let OutputValue::Digital(on) = output.value else {
                    let message = "an analog output of the source is not written for robots";
                    let help = "a toolpath that sets digital outputs alone";
                    return Err(Diagnostic::error(Rule::Unsupported, message).help(help).into());
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
        self.state_frames(&frame)?;
        self.joints(&self.rapids.home(&frame))
    }

    /// States the frames, the load and the speeds of all that follows.
    fn state_frames(&mut self, tool: &Frame) -> Outcome {
        (self.sent.feed, self.sent.corner) = (None, None);
        self.vector = Vec3::ZERO;
        let part = self.cell.part;
        self.set(&POSE, &part);
        self.set(&MIDDLE, tool);
        if let Some(load) = self.cell.load {
            self.say_load(load);
        }
        self.say_joint_speed();
        self.required(BlockName::Frames)?;
        let states = |word: WordName| self.templates.places(BlockName::Load, word);
        let (by_mass, by_number) = (states(WordName::LoadMass), states(WordName::LoadNumber));
        match (self.cell.load, self.cell.load_number) {
            (Some(load), _) if by_mass => self.say_load(load),
            (_, Some(number)) if by_number => {
                self.writer.set(WordName::LoadNumber, f64::from(number));
            }
            (_, _) => return Ok(()),
        }
        self.block(BlockName::Load)
    }

    fn say_load(&mut self, load: Load) {
        self.writer.set(WordName::LoadMass, load.mass);
        let words = [WordName::LoadX, WordName::LoadY, WordName::LoadZ];
        self.set_each(words, load.center.to_array());
    }

    fn change_tool(&mut self, tool: &Tool, line: u32) -> Outcome {
        self.limits.tool(tool, line)?;
        self.warn_of_cut("changes the tool", line);
        let by_hand = self.cell.tool_change.is_empty();
        let held = self.held.replace(tool.number);
        let stays = by_hand && held == Some(tool.number);
        let first = *self.lengths.entry(tool.number).or_insert(tool.length);
        if self.cell.tool(first) != self.cell.tool(tool.length) {
            let [before, now] =
                [first, tool.length].map(|length| match length.or(self.cell.tool_length) {
                    Some(mm) => format!("{mm} mm"),
                    None => String::from("a length that nothing states"),
                });
            let message = format!(
                "tool {} is called with {now}, and has been called with {before}",
                tool.number
            );
            let help = "the same LENGTH in each call of this tool (a call without it counts as `tool_length` below [cell]), or another number for another tool";
            return Err(Diagnostic::error(Rule::ToolTwice, message).help(help).into());
        }
        if by_hand && !self.changes && held.is_none() {
            return self.load(tool);
        }
        self.begin()?;
        self.home()?;
        self.switch_off()?;
        if !stays {
            self.writer.set(WordName::T, f64::from(tool.number));
            self.scope.tool = crate::template::tool_value(self.machine, tool, held.is_none(), None);
            self.required(if by_hand { BlockName::ToolByHand } else { BlockName::ToolChange })?;
        }
        if by_hand && !stays {
            let message = "the program stops at home for each tool, which is put into the spindle by hand: the machine file names no program \
                           that changes it";
            let help = "`tool_change` below [cell], where a program changes tools";
            self.findings
                .warn(Diagnostic::warning(Rule::ToolByHand, message).help(help).line(line));
            if let (None, Some(length)) = (tool.length, self.cell.tool_length) {
                let message = format!(
                    "the source states no length of tool {}: it has to stand {length} mm out of the spindle, as `tool_length` of the cell says",
                    tool.number
                );
                let help = "LENGTH in the source's tool call, as it has been measured";
                let found = Diagnostic::warning(Rule::ToolLength, message).help(help);
                self.findings.warn(found.line(line));
            }
        }
        self.load(tool)
    }

    /// The joints go home, where the path is clear.
    fn home(&mut self) -> Outcome {
        let Some(tool) = self.tool.filter(|_| !self.is_home()) else { return Ok(()) };
        let home = self.rapids.home(&tool);
        let Some(route) = self.rapids.route(&tool, [&self.here, &home]) else {
            return Err(self.no_way([&self.here, &home]).into());
        };
        self.is_cutting = false;
        self.follow(&route)
    }

    fn is_home(&self) -> bool {
        self.rapids.is_home(&self.here)
    }

    /// The refusal of a rapid from one place to another.
    fn no_way(&self, ends: [&Position; 2]) -> Diagnostic {
        let unmeasured = self.arm.unmeasured();
        let (besides, measured) = match unmeasured > 0.0 {
            true => (
                format!(" ({unmeasured:.0} mm more for an arm whose calibration is not stated)"),
                "the `calibration` of the arm below [arm], ",
            ),
            false => (String::new(), ""),
        };
        let high = format!(
            "off the line of the source joints may lead the tool only beyond all cuts and as high as the source ever goes, along the tool and along Z{besides}"
        );
        let place = "another place of the part (`part` below [cell]; `toolpost fit` looks for one)";
        let slack = self.machine.capabilities.rapid_corridor / 2.0;
        let [from, to] = ends.map(|end| {
            let [along, up] = self.rapids.below(end);
            let lacks = [(along, "along the tool"), (up, "along Z")];
            let lacks = lacks.into_iter().filter(|(below, _)| *below > slack);
            let lacks: Vec<_> = lacks.map(|(mm, along)| format!("{mm:.1} mm {along}")).collect();
            (self.rapids.is_home(end), lacks.join(" and "))
        });
        for (is_home, lacks) in [&from, &to] {
            if *is_home && !lacks.is_empty() {
                let message = format!("home is too low, by {lacks}: {high}");
                let help = format!(
                    "{measured}a higher `home` below [cell], a toolpath whose highest rapid is lower, or {place}"
                );
                return Diagnostic::error(Rule::RapidPath, message).help(help);
            }
        }
        let up = |lacks: &str| match lacks.is_empty() {
            true => String::from("where it is"),
            false => format!("higher by {lacks}"),
        };
        let what = match (from.0, to.0) {
            (_, true) => "the arm finds no way home",
            (true, false) => "the arm finds no way here from home",
            (false, false) => {
                "the arm cannot go here by rapid: straight the posture or a turn of a joint does not fit"
            }
        };
        let message = format!(
            "{what}; {high}. That is, at its beginning, {}, and at its end {}: between those, and from up to {:.0} mm higher, there is none",
            up(&from.1),
            up(&to.1),
            rapid::RETRACTS[rapid::RETRACTS.len() - 1]
        );
        let rail = match self.cell.rail {
            Some(_) => ", or of the rail nearer to the part (`home` below [cell.rail])",
            None => "",
        };
        // Up along a tool that leans, the way to a height along Z is long, and leads aside.
        let is_aslant = |end: &Position| {
            let [_, up] = self.rapids.below(end);
            let rise = -end.tool.matrix3.z_axis.z;
            up > slack && (LYING..UPRIGHT).contains(&rise)
        };
        let upright = match (from.0, to.0) {
            (false, true) if is_aslant(ends[0]) => {
                "a rapid of the toolpath that sets the tool upright where it is out of the part, from where it goes straight up, "
            }
            (true, false) if is_aslant(ends[1]) => {
                "a rapid of the toolpath with the tool upright before it leans, to where it comes straight down, "
            }
            _ => "",
        };
        let other = match from.0 || to.0 {
            true => {
                format!("{upright}a `home` below [cell] with the tool leaning more as here{rail}")
            }
            false => String::from("a rapid that lifts the tool before it turns"),
        };
        let own = format!("{other}, {measured}a toolpath whose highest rapid is lower, or {place}");
        let [from, to] = ends.map(|at| self.arm.posture(&at.joints));
        let changes = [
            (from.rear() != to.rear(), "the wrist on the other side of axis 1"),
            (from.below() != to.below(), "the elbow on the other side"),
            (from.flip() != to.flip(), "the wrist turned over (joint 5)"),
        ];
        let changes: Vec<_> = changes.iter().filter(|(is, _)| *is).map(|(_, what)| *what).collect();
        let help = match changes.is_empty() {
            true => own,
            false => format!(
                "what follows is cut in another posture, {}: `home` below [cell] in that posture, or {own}",
                changes.join(" and ")
            ),
        };
        Diagnostic::error(Rule::RapidPath, message).help(help)
    }

    /// A straight line to where joints have led an arm that is measured one by one, and whose measures are not known here: its controller
    /// corrects what they leave.
    fn correct(&mut self) -> Outcome {
        if self.is_exact {
            return Ok(());
        }
        self.feed(self.cell.rapid)?;
        let here = self.here;
        self.straight(&here, 0.0)
    }

    /// Goes by rapid along a route.
    fn follow(&mut self, route: &[RapidSegment]) -> Outcome {
        for segment in route {
            match segment.path {
                RapidPath::Joints => self.joints(&segment.end)?,
                RapidPath::Straight(feed) => {
                    self.correct()?;
                    self.feed(feed)?;
                    self.straight(&segment.end, 0.0)?;
                }
            }
        }
        Ok(())
    }

    fn joints(&mut self, to: &Position) -> Outcome {
        let Some(shown) = self.arm.shown(&to.joints) else {
            let message = "how the controller counts joint 3 is not stated";
            return Err(Diagnostic::error(Rule::ArmCoupling, message).into());
        };
        self.set_each(JOINTS, shown.map(f64::to_degrees));
        self.writer.set(WordName::Rail, to.rail);
        let point = self.position(BlockName::PositionJoints)?;
        self.set_each(JOINTS, shown.map(f64::to_degrees));
        self.writer.set(WordName::Rail, to.rail);
        self.writer.set(WordName::Point, point);
        self.say_joint_speed();
        // The speed of the tip, for controls that bound moves of joints by it.
        self.writer.set(WordName::F, self.cell.rapid);
        self.required(BlockName::Joints)?;
        self.is_exact = self.arm.unmeasured() == 0.0;
        let tool = self.tool.unwrap_or(Frame::IDENTITY);
        self.here = self.rapids.at_joints(&tool, (&to.joints, to.rail));
        Ok(())
    }

    /// A rapid, which is a step of the source.
    fn rapid(&mut self, motion: &Motion) -> Outcome {
        let Some(tool) = self.tool else { return Ok(()) };
        let apart = self.here.tool.translation.distance(motion.end.tool.translation);
        let turns = self.here.joints.iter().zip(motion.end.joints).map(|(a, b)| (a - b).abs());
        // What is less than a step of the words is no motion.
        let is_same = turns.fold(0.0, f64::max) < SAME_JOINTS && self.here.rail == motion.end.rail;
        if apart < self.machine.resolution() && is_same {
            return Ok(());
        }
        let Some(route) = self.rapids.route(&tool, [&self.here, &motion.end]) else {
            return Err(self.no_way([&self.here, &motion.end]).into());
        };
        self.is_cutting = false;
        self.follow(&route)
    }

    /// Leaves a cut straight along the tool, turns by the joints above all cuts, and enters at the same place.
    fn reenter(&mut self, reentry: &Reentry) -> Outcome {
        let Some(tool) = self.tool else { return Ok(()) };
        let Reentry { line, back, feed, why } = *reentry;
        let home = self.rapids.home(&tool);
        let most = feed.unwrap_or(self.cell.rapid);
        // A contour is proven as a whole: no way out of it is.
        let route = match self.offsets {
            true => None,
            false => self.rapids.reentry(&tool, [&self.here, &back, &home], most),
        };
        let Some(feed) = feed else {
            return Err(reentry.refusal(route.is_some(), self.cell).into());
        };
        let Some((route, height)) = route else {
            let (what, first) = match self.offsets {
                true => (
                    "a cut is not left and entered again where contours are offset",
                    "the path of the tool's centre from the CAM system, ",
                ),
                false => (
                    "the arm cannot retract here along the tool, turn above all cuts and enter the cut again",
                    "",
                ),
            };
            let message = format!("behind this point {why}, and {what}");
            let help = format!(
                "{first}another place of the part (`toolpost fit` looks for one), or cut it in two operations"
            );
            return Err(Diagnostic::error(Rule::ArmPath, message).help(help).into());
        };
        self.follow(&route)?;
        let message = format!(
            "the tool leaves the cut here, {height:.0} mm along its axis, turns and enters again at the same place at {feed:.0} mm/min: \
             without that {why}"
        );
        let help = "look at the mark that it may leave; another place of the part (`toolpost fit`) may do without";
        let found = Diagnostic::warning(Rule::Rewind, message).help(help);
        self.findings.warn_of_lines(found.line(line));
        Ok(())
    }

    fn cut(&mut self, motion: &Motion, next: Option<&Motion>) -> Outcome {
        let Motion { line, kind, feed, .. } = *motion;
        self.limits.feed(program::Feed::PerMinute(feed), self.spindle, line)?;
        self.turns_in_time(motion)?;
        self.is_cutting = true;
        self.start_spindle(0.0)?;
        self.start_coolant()?;
        self.correct()?;
        self.feed(feed)?;
        // Only within a cut is a corner passed.
        let goes_on = next.is_some_and(|next| next.kind != Kind::Rapid);
        let distance = match next {
            Some(next) if goes_on => self.corner(motion, next)?,
            _ => 0.0,
        };
        match kind {
            Kind::Arc(via) => {
                let [a, b] =
                    [&self.here.tool, &motion.end.tool].map(|tool| Quat::from_mat3(&tool.matrix3));
                let half = Mat3::from_quat(a.slerp(b, 0.5));
                let middle = Frame::from_mat3_translation(half, via);
                let middle = self.settled(self.at_frame(&middle)?);
                let to = self.settled(motion.end);
                let via = self.point(&middle)?;
                let end = self.point(&to)?;
                self.set(&MIDDLE, &middle.tool);
                self.writer.set(WordName::MiddlePoint, via);
                self.along(&to, (distance, end));
                self.required(BlockName::ArcThrough)?;
                self.here = to;
                Ok(())
            }
            Kind::Line | Kind::Rapid => self.straight(&motion.end, distance),
        }
    }

    /// # Errors
    /// The tool turns on the way so much that a controller whose program states how fast it may does not keep the feed.
    fn turns_in_time(&self, motion: &Motion) -> Outcome {
        let stated = self.machine.turn_speed();
        let states = self.machine.words.contains_key(WordName::TurnSpeed.name());
        let Some(speed) = stated.filter(|_| states) else { return Ok(()) };
        let [from, to] =
            [&self.here.tool, &motion.end.tool].map(|tool| Quat::from_mat3(&tool.matrix3));
        let between = from.inverse() * to;
        let shorter = if between.w < 0.0 { -between } else { between };
        let about = shorter.to_scaled_axis().map(|angle| angle.to_degrees());
        // Its axis, and about it.
        let turn = about.x.hypot(about.y).max(about.z.abs());
        let (length, feed) = (motion.length(&self.here), motion.feed);
        let at_feed = turn * feed / 60.0 / length;
        if length <= self.machine.resolution() || at_feed <= speed * (1.0 + SLOWER) {
            return Ok(());
        }
        let message = format!(
            "the tool turns by {turn:.2} degrees on {length:.3} mm: at {feed:.0} mm/min that is {at_feed:.0} degrees/s, and `turn_speed` of the options is {speed}"
        );
        let help = format!(
            "a feed of {:.0} mm/min at the most here, or a larger `turn_speed` below [options] of the machine file",
            (feed * speed / at_feed).floor()
        );
        Err(Diagnostic::error(Rule::Feed, message).help(help).into())
    }

    /// How far before its end a cut may leave its path, mm; 0 where it stops there.
    ///
    /// # Errors
    /// The control has no block for that.
    fn corner(&mut self, motion: &Motion, next: &Motion) -> Outcome<f64> {
        let step = self.machine.words.get(WordName::Corner.name()).map_or(0.0, Word::resolution);
        // Not more than the corner may be off, whatever the word rounds.
        let mut distance = match step > 0.0 {
            true => (2.0 * motion.corner / step + 1e-6).floor() * step,
            false => 2.0 * motion.corner,
        };
        if self.machine.capabilities.fits_corners {
            // The ends of two corners on one motion must not overlap: a step of the word is room for rounding.
            let step =
                self.machine.words.get(WordName::Corner.name()).map_or(0.0, Word::resolution);
            let shorter = motion.length(&self.here).min(next.length(&motion.end));
            distance = distance.min(shorter / 2.0 - 2.0 * step);
            if distance < step {
                return Ok(0.0);
            }
        }
        if distance > 0.0
            && self.sent.corner != Some(distance)
            && self.templates.has(BlockName::CornerDistance)
        {
            self.writer.set(WordName::Corner, distance);
            self.required(BlockName::CornerDistance)?;
        }
        self.sent.corner = Some(distance);
        Ok(distance)
    }

    /// The words that lines and arcs have in common: their end, how it is passed, and the feed.
    fn along(&mut self, end: &Position, (corner, point): (f64, f64)) {
        self.set(&POSE, &end.tool);
        self.writer.set(WordName::Rail, end.rail);
        self.writer.set(WordName::Point, point);
        self.set_configuration(&end.joints);
        let code = if corner > 0.0 { corner::BLEND } else { corner::EXACT };
        self.writer.code(WordName::CornerMode, code);
        // An exact stop that has a word of its own has no distance.
        if corner > 0.0 || !self.templates.places(BlockName::Linear, WordName::CornerMode) {
            self.writer.set(WordName::Corner, corner);
        }
        if let Some(feed) = self.sent.feed {
            self.writer.set(WordName::F, feed);
            self.writer.code(WordName::FeedUnit, self.feed_unit);
        }
    }

    /// Writes a position behind the instructions, where the control keeps them there; its number.
    fn position(&mut self, block: BlockName) -> Outcome<f64> {
        if !self.templates.has(block) {
            return Ok(0.0);
        }
        self.points += 1;
        let number = f64::from(self.points);
        self.writer.set(WordName::Point, number);
        let from = self.writer.end();
        self.block(block)?;
        let entry = self.writer.cut(from);
        self.table.append(entry);
        Ok(number)
    }

    /// The same of a pose, with the posture in which the arm comes there.
    ///
    /// # Errors
    /// Its letters or turns would hang on rounding.
    fn point(&mut self, at: &Position) -> Outcome<f64> {
        if !self.templates.has(BlockName::Position) {
            return Ok(0.0);
        }
        self.set(&POSE, &at.tool);
        self.writer.set(WordName::Rail, at.rail);
        let posture = self.arm.posture(&at.joints);
        self.writer.code(WordName::Wrist, usize::from(posture.flip()));
        self.writer.code(WordName::Elbow, usize::from(posture.below()));
        self.writer.code(WordName::Shoulder, usize::from(posture.rear()));
        let shown = self.arm.shown(&at.joints).unwrap_or(at.joints).map(f64::to_degrees);
        for (word, joint) in TURNS {
            if is_on_edge(shown[joint]) {
                let message = format!(
                    "joint {} comes to {:.4}°, where rounding decides how many turns the position states",
                    joint + 1,
                    shown[joint]
                );
                let help = "turn the part by some degrees (`part` below [cell]): no small turn of the tool about its axis moves that joint off the edge";
                return Err(Diagnostic::error(Rule::Posture, message).help(help).into());
            }
            self.writer.set(word, ((shown[joint] + 180.0) / 360.0).floor());
        }
        self.position(BlockName::Position)
    }

    /// The same tip and axis, turned about the axis by so little that no rounding decides how many turns of a joint the position states;
    /// as it is where the control states none, or no such turn does.
    fn settled(&self, at: Position) -> Position {
        let states =
            TURNS.iter().any(|(word, _)| self.templates.places(BlockName::Position, *word));
        let is_settled = |joints: &Joints| {
            let shown = self.arm.shown(joints).unwrap_or(*joints);
            TURNS.iter().all(|(_, joint)| !is_on_edge(shown[*joint].to_degrees()))
        };
        if !states || is_settled(&at.joints) {
            return at;
        }
        let turned = NUDGES.iter().filter_map(|turn| {
            let turn = Quat::from_rotation_z(turn.to_radians());
            let tool = at.tool * Frame::from_rotation_translation(turn, Vec3::ZERO);
            self.near(&tool, &at.joints)
        });
        let mut turned = turned.filter(|found| is_settled(&found.joints));
        turned.next().unwrap_or(at)
    }

    /// The position of the arm at a frame near where it is, in the same posture.
    ///
    /// # Errors
    /// It does not reach there.
    fn at_frame(&self, tool: &Frame) -> Outcome<Position> {
        self.near(tool, &self.here.joints).ok_or_else(|| {
            let message = "the arm does not reach the point half way along the arc in its posture";
            Diagnostic::error(Rule::ArmPath, message).into()
        })
    }

    /// The position at a frame, near these joints and in their posture; `None` where the arm does not reach there.
    fn near(&self, tool: &Frame, before: &Joints) -> Option<Position> {
        let off = self.tool.unwrap_or(Frame::IDENTITY).inverse();
        let flange = self.cell.part_from(self.here.rail) * *tool * off;
        let joints = self.arm.inverse_in(self.arm.posture(before), &flange, before[3])?;
        let joints = std::array::from_fn(|i| before[i] + wrap(joints[i] - before[i]));
        Some(Position { tool: *tool, joints, ..self.here })
    }

    /// Quarters of joints 1, 4 and 6 and the posture. Where a joint is at the edge of a quarter, the control does not use it.
    fn set_configuration(&mut self, joints: &Joints) {
        let Some(shown) = self.arm.shown(joints) else { return };
        let quarter = |joint: usize| (shown[joint].to_degrees() / 90.0).floor();
        let posture = self.arm.posture(joints);
        let bits = [(posture.rear(), 4.0), (posture.below(), 2.0), (posture.flip(), 1.0)];
        let posture = bits.into_iter().filter(|(is, _)| *is).map(|(_, bit)| bit).sum();
        let words = [
            WordName::Configuration1,
            WordName::Configuration4,
            WordName::Configuration6,
            WordName::ConfigurationX,
        ];
        self.set_each(words, [quarter(0), quarter(3), quarter(5), posture]);
    }

    fn straight(&mut self, end: &Position, corner: f64) -> Outcome {
        let end = self.settled(*end);
        let point = self.point(&end)?;
        self.along(&end, (corner, point));
        self.required(BlockName::Linear)?;
        (self.here, self.is_exact) = (end, true);
        Ok(())
    }

    /// The feed, where it changes.
    fn feed(&mut self, feed: f64) -> Outcome {
        if self.sent.feed == Some(feed) {
            return Ok(());
        }
        self.writer.feed_form(WordName::F);
        let off = |written: f64| (written - feed).abs();
        let [own, fine] = [WordName::F, WordName::FeedFine];
        let [coarse, finer] = [own, fine].map(|word| self.writer.rounded(word, feed));
        let is_fine =
            self.writer.has(&[fine]) && off(coarse) > FAIR * feed && off(finer) < off(coarse);
        let (word, written) = if is_fine { (fine, finer) } else { (own, coarse) };
        self.writer.feed_form(word);
        self.feed_unit = usize::from(is_fine);
        if (written - feed).abs() > ROUGH * feed {
            let message = format!(
                "the control would take the feed of {feed:.3} mm/min for {written:.3} mm/min: its word has no more digits"
            );
            let step = self.machine.words.get(word.name()).map_or(1.0, Word::resolution);
            let below = step * (feed / step).floor();
            let help = match below > 0.0 {
                true => format!("{below:.2} or {:.2} mm/min in the source", below + step),
                false => format!("{:.2} mm/min in the source", below + step),
            };
            return Err(Diagnostic::error(Rule::Feed, message).help(help).into());
        }
        self.sent.feed = Some(feed);
        if self.templates.has(BlockName::Feed) {
            self.writer.set(WordName::F, feed);
            self.required(BlockName::Feed)?;
        }
        Ok(())
    }

    /// A frame, with its orientation in each form.
    fn set(&mut self, words: &PoseWords, frame: &Frame) {
        self.set_each(words.tip, frame.translation.to_array());
        let [c, b, a] = Euler::FixedXyz.angles(&frame.matrix3).map(f64::to_degrees);
        self.set_each(words.turns, [a, b, c]);
        let turn = Quat::from_mat3(&frame.matrix3);
        let turn = if turn.w < 0.0 { -turn } else { turn };
        self.vector = nearest_writing(turn.to_scaled_axis(), self.vector);
        self.set_each(words.vector, self.vector.to_array().map(f64::to_degrees));
        self.set_each(words.quaternion, [turn.w, turn.x, turn.y, turn.z]);
    }

    fn set_each<const N: usize>(&mut self, words: [WordName; N], values: [f64; N]) {
        for (word, value) in words.into_iter().zip(values) {
            self.writer.set(word, value);
        }
    }

    /// How fast joints turn: as a part of the fastest, and what that leaves to the slowest of them.
    fn say_joint_speed(&mut self) {
        let slowest =
            self.arm.joints().iter().map(|joint| joint.speed).fold(f64::INFINITY, f64::min);
        if let Some(rail) = self.cell.rail {
            let speed = rail.speed / 60.0 * self.cell.joint_speed / 100.0;
            self.writer.set(WordName::RailSpeed, speed);
        }
        self.writer.set(WordName::JointSpeed, self.cell.joint_speed);
        self.writer.set(WordName::JointRate, slowest.to_degrees() * self.cell.joint_speed / 100.0);
    }

    /// Starts the spindle, where it is not as the source has it, and waits until it has its speed: as long as the machine file
    /// says, or `wanted` s, where the source wants more: whether it has done that.
    fn start_spindle(&mut self, wanted: f64) -> Outcome<bool> {
        if self.spindle == self.sent.spindle {
            return Ok(false);
        }
        let speed = match self.spindle {
            Spindle::Off => return self.stop_spindle().map(|()| false),
            Spindle::Clockwise(speed) => speed,
            Spindle::CounterClockwise(_) => {
                let message = "the source turns the spindle counter-clockwise, and the outputs of a cell state a speed and no direction";
                let help =
                    "a toolpath and tools that cut with the spindle clockwise (SPINDL with CLW)";
                return Err(Diagnostic::error(Rule::Spindle, message).help(help).into());
            }
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
        self.required(BlockName::SpindleCw)?;
        self.sent.spindle = self.spindle;
        match self.machine.spindle.dwell {
            0.0 => Ok(false),
            own if wanted >= own => self.dwell(wanted).map(|()| true),
            own => self.dwell(own).map(|()| false),
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
            Some(lines) => self.writer.block(name, lines),
            None => {
                let scope = Scope { set: self.writer.set_words(), ..self.scope.clone() };
                self.writer.block(name, &self.templates.render(name, scope)?)
            }
        }
    }

    /// Writes a block that must be there.
    fn required(&mut self, name: BlockName) -> Outcome {
        if self.templates.has(name) {
            return self.block(name);
        }
        Err(Templates::missing(name).into())
    }
}

/// The vector of the same orientation that is nearest to another one: it may turn the other way round, by what is left of a revolution.
/// A tool that points straight down turns by half of one, which has two writings: a program that changed between them would look as if
/// the tool turned.
fn nearest_writing(vector: Vec3, to: Vec3) -> Vec3 {
    let angle = vector.length();
    if angle < 1e-9 {
        return vector;
    }
    let other = vector * (1.0 - TAU / angle);
    if other.distance(to) < vector.distance(to) - 1e-6 { other } else { vector }
}

/// What templates read of a program of this name, which calls a part.
fn named(machine: &Machine, name: &str, part: &str) -> Value {
    program_value(machine, name.to_owned(), &[], None, [("blank", false), ("stock", false)], part)
}

/// The name of a program as controllers of robots take it: letters, digits and `_`, a letter first, at most 24.
fn name_of(name: &str) -> String {
    let name: String = file_name(name).chars().map(|c| if c == '-' { '_' } else { c }).collect();
    match name.chars().next().is_some_and(|first| first.is_ascii_alphabetic()) {
        true => name,
        false => format!("P{name}").chars().take(24).collect(),
    }
}
