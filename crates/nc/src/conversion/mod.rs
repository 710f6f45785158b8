//! The events of a control become the records of a neutral program, one after the other.

mod tools;

use crate::path::MOST_PLACES;
use crate::pose::{PartialPose, ROUNDING, ToolPosition, resolve, unknown, within_reach};
use crate::settings::feed_path_in;
use crate::{Sink, refuse};
use control::{Action, Dialect, Event, FeedPath, Orientation, Position, Risk, Settings, Setup};
use geom::Vec3;
use machine::{LengthOffset, Machine};
use program::{
    ArcTo, Axes, Circle, CompensatedPath, Cycle, Diagnostic, Feed, MachineMove, Op, Outcome, Pose,
    Probe, Program, Record, Rule, Thread, WorkOffset,
};
use std::collections::{BTreeSet, HashMap};
use tools::Loaded;

/// Most records of a reading, which are kept in memory: a program of a few lines can loop to more.
const MOST_RECORDS: usize = 20_000_000;

/// The conversion of the events of a control into a neutral program.
pub(crate) struct Conversion<'a> {
    machine: &'a Machine,
    /// The program is what a CAM system keeps, and no control reads it.
    is_source: bool,
    setup: &'a Setup,
    pub(crate) program: Program,
    keep: &'a mut Sink<'a>,
    /// How many records there have been.
    pub(crate) count: usize,
    /// A code has ended the program.
    pub(crate) ended: bool,
    pub(crate) warnings: Vec<Diagnostic>,
    tool_at: ToolPosition,
    /// The position of the last block that moved, unless the axes have gone home since.
    position: Option<Position>,
    /// The active feed, what it counts, and the feed of the last record.
    feed: Option<Feed>,
    feed_path: FeedPath,
    written_feed: Option<Feed>,
    /// Z has been sent home since the last move, on this line.
    home: Option<u32>,
    /// The tool in the spindle, and whether nothing has moved since it was called.
    pub(crate) tool: Option<(Loaded, bool)>,
    /// The line on which the spindle has been emptied, and no tool has come since.
    emptied: Option<u32>,
    /// The cycle that withdraws from the wall, as the control has it, and the withdrawal at the last hole.
    boring: Option<(Cycle, Option<Vec3>)>,
    /// The work offset that the program names.
    work_offset: Option<WorkOffset>,
    /// Whether it works in more than the first.
    pub(crate) several: bool,
    /// Numbers of the tools that the program calls, with the names of those that it calls by name.
    numbers: HashMap<u32, String>,
    /// The numbers of those that it calls by name.
    named: HashMap<String, u32>,
    /// No number below this is free for a tool that is called by name.
    free_from: u32,
    /// The program has to call length offsets, since its control takes none with the tool.
    calls_lengths: bool,
    /// The register of the length offset that it has called last, also for another tool.
    length_offset: Option<u32>,
    /// Registers of the tools that are reported to cut without a length offset.
    bare: BTreeSet<u32>,
}

impl<'a> Conversion<'a> {
    pub(crate) fn new(
        machine: &'a Machine,
        settings: &'a Settings,
        name: &str,
        keep: &'a mut Sink<'a>,
    ) -> Conversion<'a> {
        let is_source = matches!(settings.dialect, Dialect::Source(_));
        let registers = machine.capabilities.length_offset == LengthOffset::ToolNumber;
        Conversion {
            machine,
            is_source,
            setup: &settings.setup,
            program: Program {
                // What the control offsets is the contour.
                compensated_path: Some(CompensatedPath::Contour),
                ..Program::new(name)
            },
            keep,
            count: 0,
            ended: false,
            warnings: Vec::new(),
            tool_at: settings.setup.start.map_or(ToolPosition::Unknown, |tip| {
                ToolPosition::Start(PartialPose { tip, axis: Vec3::Z })
            }),
            position: None,
            feed: None,
            feed_path: feed_path_in(Some(settings.dialect), machine),
            written_feed: None,
            home: None,
            tool: None,
            emptied: None,
            boring: None,
            work_offset: None,
            several: false,
            numbers: HashMap::new(),
            named: HashMap::new(),
            free_from: 1,
            // The post calls the lengths of what a CAM system keeps.
            calls_lengths: registers && !is_source,
            length_offset: None,
            bare: BTreeSet::new(),
        }
    }

    pub(crate) fn event(&mut self, event: Event) -> Outcome {
        let line = event.line;
        if self.count >= MOST_RECORDS {
            let message = format!("the program makes more than {MOST_RECORDS} records");
            let help = "it may loop without end; if not, read it in parts";
            return Err(refuse(Rule::ProgramLength, message, help));
        }
        let position = event.action.position().copied();
        within_reach(&event.action)?;
        if self.moves_empty(&event.action)? {
            return Ok(());
        }
        if let (Action::Arc(_) | Action::Hole(_) | Action::Probe(_), Some(feed)) =
            (&event.action, self.feed)
        {
            self.say_feed(line, feed);
        }
        match event.action {
            Action::Rapid(position) => {
                let pose = self.partial_pose(&position);
                match pose.complete() {
                    Some(pose) => self.arrive(line, Op::Rapid(pose))?,
                    None => self.tool_at = ToolPosition::At(pose),
                }
            }
            Action::Line(position) if self.starts_a_picture(&position) => {
                let message = "where the tool comes from is not known: it is drawn from the end of this block on";
                self.warn_once(line, Diagnostic::warning(Rule::UnknownStart, message));
                let pose = self.partial_pose(&position);
                if let Some(pose) = pose.complete() {
                    self.arrive(line, Op::Rapid(pose))?;
                }
            }
            Action::Line(position) => {
                let pose = self.cut(&position)?;
                self.time_cut(line, &position);
                self.arrive(line, Op::Line(pose))?;
            }
            Action::Arc(arc) => {
                let arc = self.arc(&arc)?;
                self.arrive(line, Op::Arc(Box::new(arc)))?;
            }
            Action::Thread(thread) => {
                let end = self.cut(&thread.end)?;
                self.arrive(line, Op::Thread(Box::new(Thread::new(end, thread.pitch)?)))?;
            }
            Action::Probe(probe) => {
                let Probe { away, must_answer, place, .. } = *probe;
                let end = self.cut(&probe.end)?;
                let probe = Probe { end, away, must_answer, place };
                self.arrive(line, Op::Probe(Box::new(probe)))?;
                self.tool_at = ToolPosition::Unknown;
            }
            Action::Hole(position) => {
                let pose = self.partial_pose(&position);
                let withdrawal =
                    self.boring.as_ref().and_then(|(cycle, _)| cycle.kind.withdrawal());
                let aside = withdrawal.map(|withdrawal| {
                    let moved = Position { point: position.point + withdrawal.aside, ..position };
                    self.partial_pose(&moved).tip - pose.tip
                });
                let Some(pose) = pose.complete() else {
                    return Err(self.lost("a hole", &position, &pose));
                };
                self.bore(line, aside);
                self.arrive(line, Op::Hole(pose))?;
            }
            Action::Cycle(cycle) => {
                self.boring = cycle.kind.withdrawal().is_some().then_some((*cycle, None));
                if self.boring.is_none() {
                    self.push(line, Op::Cycle(cycle));
                }
            }
            Action::Home(axes) => {
                self.position = None;
                return self.go_home(line, axes);
            }
            Action::MachineMove(to) => {
                self.position = None;
                return self.machine_move(line, &to);
            }
            Action::Tool(tool) if tool.number == 0 && tool.name.is_empty() => {
                self.emptied = Some(line);
                let message = "the spindle is emptied (T0): the last tool stays in what is written from this, and moves without one are \
                               left out";
                self.warn_once(line, Diagnostic::warning(Rule::Tool, message));
            }
            Action::Tool(mut tool) => {
                self.emptied = None;
                self.number(line, &mut tool)?;
                if let Some(entry) = self.setup.tools.iter().find(|e| e.number == tool.number) {
                    tool.diameter = Some(2.0 * entry.radius);
                    tool.length = Some(entry.length);
                }
                self.home = None;
                let register = tool.offset.unwrap_or(tool.number);
                self.tool = Some((Loaded { register, length: tool.length, offset: None }, true));
                self.push(line, Op::Tool(tool));
            }
            Action::LengthOffset(register) => return self.length_offset(line, register),
            Action::WorkOffset(offset) => self.set_work_offset(line, offset),
            Action::WorkOffsetData(data) => self.push(line, Op::WorkOffsetData(data)),
            // The moves behind it say where the tool goes.
            Action::Swivel(_) => {}
            Action::Across(position) => {
                let nowhere = Position { point: Vec3::NAN, ..*position };
                self.tool_at = ToolPosition::At(self.partial_pose(&nowhere));
            }
            Action::CycleOff => self.push(line, Op::CycleOff),
            Action::Feed(feed) => {
                (self.feed, self.written_feed) = (Some(feed), Some(feed));
                self.push(line, Op::Feed(feed));
            }
            Action::FeedPath(path) => self.feed_path = path,
            // A rapid of a source has its ends only.
            Action::RapidsTogether(_) => {}
            Action::Spindle(spindle) => self.push(line, Op::Spindle(spindle)),
            Action::SurfaceSpeed(speed) => self.push(line, Op::SurfaceSpeed(speed)),
            Action::Coolant(coolant) => self.push(line, Op::Coolant(coolant)),
            Action::Preselect(number) => self.push(line, Op::Preselect(number)),
            Action::Compensation(side) => self.push(line, Op::Compensation(side)),
            Action::Output(output) => self.push(line, Op::Output(output)),
            Action::Input(input) => self.push(line, Op::Input(input)),
            Action::Auxiliary(function) => {
                let clamp = self.machine.clamps(function.number).map(Op::Clamp);
                self.push(line, clamp.unwrap_or(Op::Auxiliary(function)));
            }
            Action::ThreadWire => self.push(line, Op::ThreadWire),
            Action::CutWire => self.push(line, Op::CutWire),
            Action::Taper(degrees) => self.push(line, Op::Taper(degrees)),
            Action::Risk(risk) => {
                self.risk(line, *risk);
            }
            Action::TouchOff(_) => {
                let message =
                    "sets Z by what a probe has touched: how high that is, only the machine knows";
                let help = "take the touch-off out of the program: the tool changes of the machine's file have their own";
                return Err(refuse(Rule::Probe, message, help));
            }
            Action::PathMode(mode) => self.push(line, Op::PathMode(mode)),
            Action::Dwell(seconds) => self.push(line, Op::Dwell(seconds)),
            Action::Stop => self.push(line, Op::Stop),
            Action::OptionalStop => self.push(line, Op::OptionalStop),
            // The source of a mill has poses and no joints: programs of arms are proven, and no source yet.
            Action::Arm(_) => {
                let message = "a motion of a robot: its programs are no source yet";
                let help = "post the toolpath that it was made of";
                return Err(refuse(Rule::Unsupported, message, help));
            }
            Action::Comment(text) => self.push(line, Op::Comment(text)),
            Action::Message(text) => self.push(line, Op::Message(text)),
            Action::End => {
                self.ended = true;
                self.push(line, Op::End);
            }
        }
        self.position = position.or(self.position);
        Ok(())
    }

    /// Points of a rapid on which rotary axes turn without tool-centre control, a degree apart.
    pub(crate) fn sample_rapid(&mut self, line: u32, from: &Position, to: &Position) -> Outcome {
        let (
            Orientation::Rotary { degrees: a, tool_center: false },
            Orientation::Rotary { degrees: b, tool_center: false },
        ) = (from.orientation, to.orientation)
        else {
            return Ok(());
        };
        let turn = (0..3).map(|i| f64::abs(b[i] - a[i])).fold(0.0, f64::max);
        let places = turn.ceil().min(MOST_PLACES);
        for i in 1..places as u32 {
            let part = f64::from(i) / places;
            let degrees = std::array::from_fn(|k| a[k] + (b[k] - a[k]) * part);
            let orientation = Orientation::Rotary { degrees, tool_center: false };
            let place = Position { point: from.point.lerp(to.point, part), orientation };
            if let Some(pose) = self.partial_pose(&place).complete() {
                self.arrive(line, Op::Rapid(pose))?;
            }
        }
        Ok(())
    }

    /// Adds the feed of a straight cut to `to`: as inverse time where its number is not the speed of the tip.
    fn time_cut(&mut self, line: u32, to: &Position) {
        let Some(feed) = self.feed else { return };
        let turned = self.position.filter(|from| !self.feed_path.is_of_tip(from, to));
        let counted = turned.and_then(|from| self.feed_path.length(&from, to));
        let feed = match (feed, counted) {
            (Feed::PerMinute(f), Some(length)) if length > 0.0 => Feed::InverseTime(f / length),
            (feed, None) if turned.is_some() && matches!(feed, Feed::PerMinute(_)) => {
                self.unknown_speed(line);
                feed
            }
            (feed, _) => feed,
        };
        self.say_feed(line, feed);
    }

    /// Adds a record of the feed where it differs from the last one.
    fn say_feed(&mut self, line: u32, feed: Feed) {
        if self.written_feed != Some(feed) {
            self.written_feed = Some(feed);
            self.push(line, Op::Feed(feed));
        }
    }

    /// F is taken as the speed of the tip where it is not known what it counts.
    #[cold]
    fn unknown_speed(&mut self, line: u32) {
        // The feeds of a CAM system are those of the tool.
        if self.is_source {
            return;
        }
        let message = "rotary axes turn in the cut, and a parameter of the control decides which axes F in mm/min counts: it is \
                       taken as the speed of the tool tip";
        if let Some(known) = self.warnings.iter_mut().find(|found| found.rule == Rule::RotaryFeed) {
            known.again(line);
            return;
        }
        let help = "set `rotary_feed` in [settings] of the machine file (FANUC: parameter 1408#0)";
        self.warnings.push(Diagnostic::warning(Rule::RotaryFeed, message).help(help).line(line));
    }

    fn push(&mut self, line: u32, op: Op) {
        self.count += 1;
        (self.keep)(&mut self.program.records, Record { line, op }, self.several);
    }

    /// The tool moves, from home where it was sent there.
    fn arrive(&mut self, line: u32, op: Op) -> Outcome {
        if self.calls_lengths && !matches!(op, Op::Rapid(_)) {
            self.see_length(line)?;
        }
        match (self.home.take(), self.tool_at) {
            (Some(line), _) => self.push(line, Op::Home),
            (None, ToolPosition::Start(start)) if !matches!(op, Op::Rapid(_)) => {
                let start = start.complete().map(Op::Rapid);
                start.into_iter().for_each(|start| self.push(line, start));
            }
            _ => {}
        }
        if let Some((_, fresh)) = &mut self.tool {
            *fresh = false;
        }
        let at =
            |pose: &Pose| ToolPosition::At(PartialPose { tip: pose.point(), axis: pose.axis() });
        self.tool_at = op.pose().map_or(ToolPosition::Unknown, at);
        self.push(line, op);
        Ok(())
    }

    /// Adds the boring cycle again where its withdrawal, which turns with the table, has another direction.
    fn bore(&mut self, line: u32, aside: Option<Vec3>) {
        let (Some((cycle, last)), Some(aside)) = (&mut self.boring, aside) else { return };
        if last.is_some_and(|last| last.distance(aside) < ROUNDING) {
            return;
        }
        *last = Some(aside);
        let cycle = Cycle { kind: cycle.kind.with_aside(aside), ..*cycle };
        self.push(line, Op::Cycle(Box::new(cycle)));
    }

    /// Whether the start of a straight cut to `end` is not known, in a program that is only drawn.
    fn starts_a_picture(&self, end: &Position) -> bool {
        let drawn = !self.setup.purpose.asks_ends();
        let known = |pose: &PartialPose| pose.complete().is_some();
        let from_home = self.home.is_some() || !self.tool_at.pose().is_some_and(known);
        drawn && from_home && known(&self.partial_pose(end))
    }

    /// Where a cut ends; it must begin somewhere.
    fn cut(&self, end: &Position) -> Outcome<Pose> {
        let pose = self.partial_pose(end);
        let start = self.tool_at.pose().filter(|_| self.home.is_none());
        let nowhere = PartialPose { tip: Vec3::NAN, axis: Vec3::Z };
        let start = start.copied().unwrap_or(nowhere);
        if start.complete().is_none() {
            return Err(self.lost("the start of a cut", end, &start));
        }
        pose.complete().ok_or_else(|| self.lost("the end of a cut", end, &pose))
    }

    /// The refusal of a block that goes to `end` because `pose` is not known.
    #[cold]
    fn lost(&self, what: &str, end: &Position, pose: &PartialPose) -> Box<Diagnostic> {
        let Orientation::Rotary { degrees, tool_center: false } = end.orientation else {
            return unknown(what, pose);
        };
        let length = self.tool.and_then(|(tool, _)| tool.length);
        match self.machine.unsaid(degrees, length) {
            Some(unsaid) => {
                let message = format!("{what} depends on what is not given: {unsaid}");
                refuse(unsaid.rule(), message, &unsaid.way_out())
            }
            None => unknown(what, pose),
        }
    }

    /// An arc in the work frame: its centre and its axis turn with the table, as its end does.
    fn arc(&self, arc: &control::ArcTo) -> Outcome<ArcTo> {
        let control::ArcTo { mut center, mut normal, turns, .. } = *arc;
        if !self.machine.rotary.is_empty() {
            let of = |point| self.partial_pose(&Position { point, ..arc.end }).tip;
            center = of(arc.center);
            normal = (of(arc.center + arc.normal) - center).normalize();
        }
        let end = self.cut(&arc.end)?;
        let circle = Circle::new(center, normal, turns);
        let circle = circle.map_err(|_| {
            unknown("the centre of an arc", &PartialPose { tip: center, axis: end.axis() })
        })?;
        Ok(ArcTo { end, circle })
    }

    /// A position as a block gives it, in the work frame. The tip of a tool of unknown length that a head has
    /// turned is not known.
    fn partial_pose(&self, position: &Position) -> PartialPose {
        let length = self.tool.and_then(|(tool, _)| tool.length);
        let (mut tip, axis) = resolve(self.machine, position, length);
        self.setup.flatten(&mut tip);
        PartialPose { tip, axis }
    }

    /// Axes go to a fixed position of the machine. Only Z matters there: the other axes come back
    /// by words of their own, and the machine decides their path.
    fn go_home(&mut self, line: u32, axes: Axes) -> Outcome {
        let is_known = self.tool_at.pose().is_some_and(|pose| pose.complete().is_some());
        if !axes.contains(Axes::Z) && self.home.is_none() && is_known {
            let message =
                "axes are sent home while Z is not: the machine decides their path past the part";
            let help = "send Z home before";
            return Err(refuse(Rule::Home, message, help));
        }
        if let (true, Some(from)) = (axes.contains(Axes::Z), self.tool_at.pose()) {
            self.home.get_or_insert(line);
            // The higher of both: of a number and none it is the number.
            let height = self.program.sent_home.unwrap_or(f64::NAN).max(from.tip.z);
            self.program.sent_home = Some(height).filter(|height| height.is_finite());
        }
        Ok(())
    }

    /// Reports a risk, once for all its lines.
    fn risk(&mut self, line: u32, risk: Risk) {
        let message = format!("the program {}", risk.what);
        self.warn_once(line, Diagnostic::warning(risk.rule, message).help(risk.help));
    }

    /// Reports a warning with its first line, and counts those that are the same.
    fn warn_once(&mut self, line: u32, warning: Diagnostic) {
        let same = |found: &&mut Diagnostic| {
            found.rule == warning.rule && found.message == warning.message
        };
        match self.warnings.iter_mut().find(same) {
            Some(found) => found.again(line),
            None => self.warnings.push(warning.line(line)),
        }
    }

    /// A move in machine coordinates is a move home where Z goes to its safe height. Where the machine file has no
    /// safe height, Z 0 or above is taken for it, as on machines whose Z counts down from its top.
    fn machine_move(&mut self, line: u32, to: &MachineMove) -> Outcome {
        if let Some(z) = to.linear[2] {
            let safe = self.machine.safe_height;
            if z.is_nan() || z < safe.unwrap_or(0.0) - ROUNDING {
                let below = safe.map_or(String::new(), |safe| {
                    format!(
                        ", below the safe height of {safe} mm of the machine it was written for"
                    )
                });
                let height = match z.is_nan() {
                    true => String::from("a height that is not known"),
                    false => format!("{z} mm"),
                };
                let message = format!(
                    "Z goes to {height} in machine coordinates{below}: where that is in the work is \
                     not known"
                );
                return Err(refuse(Rule::MachinePosition, message, machine::SAFE_HEIGHT_HELP));
            }
            if safe.is_none() {
                let message = format!(
                    "Z {z} mm in machine coordinates is taken for clear of the part: no safe height \
                     of the machine is known that the program was written for"
                );
                let found = Diagnostic::warning(Rule::MachinePosition, message);
                self.warnings.push(found.help(machine::SAFE_HEIGHT_HELP).line(line));
            }
        }
        self.go_home(line, to.axes())
    }

    /// Positions are counted from another work offset from here on.
    fn set_work_offset(&mut self, line: u32, offset: WorkOffset) {
        // Where the start is given, all offsets are 0, and it is one in the first.
        let known = self.setup.start.map(|_| WorkOffset::FIRST);
        let before = self.work_offset.replace(offset).or(known);
        if before == Some(offset) {
            return;
        }
        self.several |= offset != WorkOffset::FIRST;
        // The position at the start is given with all offsets at 0.
        if let ToolPosition::At(_) = self.tool_at {
            self.several = true;
            self.tool_at = ToolPosition::Unknown;
        }
        self.push(line, Op::WorkOffset(offset));
    }
}
