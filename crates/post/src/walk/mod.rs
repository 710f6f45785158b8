//! Goes through the program record by record: what is output to the machine, and when.

mod compensation;
mod technology;

pub(crate) use technology::{AxisPositions, Cut};

use crate::around::Around;
use crate::catalogue::{BlockName, WordName};
use crate::contour::Contour;
use crate::coordinate_mode::{CoordinateMode, Route, Stop};
use crate::findings::Findings;
use crate::position::ToolPosition;
use crate::sent::Sent;
use crate::template::{
    ORIENTATION, POSITION, Scope, Templates, coolant_value, file_name, map, program_number,
    program_value, spindle_value,
};
use crate::text::printed;
use crate::vectors::Followed;
use crate::wanted::Wanted;
use crate::wire::Wire;
use crate::words::{Words, bit};
use crate::writer::Writer;
use compensation::compensation_code;
use geom::Vec3;
use machine::limits::Limits;
use machine::{Inverse, Machine};
use minijinja::value::Value;
use program::statistics::Statistics;
use program::{
    Compensation, Coolant, CutBox, Diagnostic, Feed, Op, Program, Progress, Pulse, Record, Rule,
    Spindle, Tool, Tops, WorkOffset, WorkOffsetData,
};
use std::cell::{Cell, OnceCell};
use std::collections::BTreeMap;
use technology::feed_mode;

pub(crate) use program::Outcome;

/// Entries of the code word `motion`.
pub(crate) mod motion {
    pub(crate) const RAPID: usize = 0;
    pub(crate) const LINEAR: usize = 1;
    pub(crate) const ARC_CW: usize = 2;
    pub(crate) const ARC_CCW: usize = 3;
}

/// The words that say how the tool goes.
const MOTION: Words = Words::of(&[WordName::F, WordName::Motion]);

/// The entry of the code word `plane` for the plane XY.
pub(crate) const PLANE_XY: usize = 0;

/// The corners of the blank: the smallest X, Y, Z, and the largest.
const EXTENTS: [WordName; 6] = [
    WordName::LowX,
    WordName::LowY,
    WordName::LowZ,
    WordName::HighX,
    WordName::HighY,
    WordName::HighZ,
];

/// Z to which tools go on a machine without switches: `height` mm above the work zero and all that is cut, and no lower than
/// the source goes.
fn retract_height(program: &Program, height: f64) -> f64 {
    let poses = program.records.iter().filter_map(|record| record.op.pose());
    let highest = poses.map(|pose| pose.point().z).fold(f64::NEG_INFINITY, f64::max);
    (CutBox::of(program).reach(Vec3::Z).max(0.0) + height).max(highest)
}

/// What reaches over less, mm, is no body.
const THIN: f64 = 0.01;

/// After so many records whoever waits is asked: some milliseconds at the most.
const RECORDS_AT_ONCE: u32 = 256;

/// Rapids that are written by feed: how many, from which line of the source on, and how far together, mm.
#[derive(Debug, Default)]
pub(crate) struct ByFeed {
    pub(crate) count: u32,
    pub(crate) line: u32,
    pub(crate) length: f64,
}

/// A program being written.
pub(crate) struct Walk<'a> {
    pub(crate) machine: &'a Machine,
    pub(crate) inverse: Inverse<'a>,
    pub(crate) templates: Templates<'a>,
    pub(crate) writer: Writer,
    pub(crate) findings: Findings,
    scope: Scope,
    source: &'a Program,
    /// How far the source reaches; counted where it is asked for.
    statistics: Option<Statistics>,
    /// What it cuts; counted where it is asked for.
    cuts: Option<CutBox>,
    /// What it reaches by feed, with the heights from which it comes down; counted where it is asked for.
    fed: Option<CutBox>,
    /// How high it goes; looked for where it is asked for.
    tops: Option<Tops<'a>>,
    /// The feed for the air, else the fastest that the machine is known to take, mm/min; looked for where it is asked for.
    known_feed: OnceCell<Option<f64>>,
    /// Rapids that are written by feed.
    pub(crate) by_feed: ByFeed,
    /// The radii of the source's tools, mm, by their numbers; collected where they are asked for.
    radii: OnceCell<BTreeMap<u32, f64>>,
    /// Where in its records we are.
    pub(crate) index: usize,
    /// What the source says before and behind that record.
    pub(crate) around: Around,
    /// Source line of the record at hand.
    pub(crate) line: u32,
    /// What the source wants, what the control has been sent, and where the tool is.
    pub(crate) wanted: Wanted<'a>,
    pub(crate) sent: Sent,
    pub(crate) position: ToolPosition,
    /// The contour at hand, where the control offsets it and the radius of the tool is known.
    contour: Option<Box<Contour>>,
    /// Whether nothing but cuts has been since a straight one, and a straight one in the same orientation differs
    /// from that in where it goes alone.
    pub(crate) goes_on: bool,
    pub(crate) place: CoordinateMode,
    /// The wire, where the machine has one.
    pub(crate) wire: Option<Wire>,
    pub(crate) limits: Limits<'a>,
    /// The way along a vector that was asked for last.
    pub(crate) followed: Cell<Option<Followed>>,
    /// Smallest step of a linear axis, mm.
    pub(crate) resolution: f64,
    /// Smallest step of a rotary axis, degrees.
    pub(crate) rotary_resolution: f64,
    /// Rapids say their feed, in whose place the next cut says its own.
    feeds_rapids: bool,
    ended: bool,
}

impl<'a> Walk<'a> {
    pub(crate) fn new(program: &'a Program, machine: &'a Machine) -> Result<Self, Vec<Diagnostic>> {
        let templates = Templates::compile(machine)?;
        crate::promises::check(machine, &templates)?;
        let mut scope = Scope::new(machine);
        let tools = if templates.read_tools() { &program.records[..] } else { &[] };
        let mut writer = Writer::new(machine);
        if let Some(height) = machine.retract_height() {
            writer.set_always(WordName::RetractHeight, retract_height(program, height));
        }
        let reach = EXTENTS.iter().any(|word| templates.places(BlockName::ProgramStart, *word));
        let reach = if reach { blank(program) } else { None };
        let is_stock = reach.is_some() && program.stock.is_some();
        let blank = [("blank", reach.is_some()), ("stock", is_stock)];
        let name = file_name(&program.name);
        let number = program_number(machine, &name).map_err(|found| vec![*found])?;
        scope.program = program_value(machine, name, tools, number, blank, "");
        for (word, value) in EXTENTS.into_iter().zip(reach.into_iter().flatten()) {
            writer.set(word, value);
        }
        let feeds_rapids = templates.words().any(|(word, _)| word == WordName::RapidFeed);
        // What the catalogue asks of `program_start`.
        writer.assume(WordName::Plane, PLANE_XY);
        writer.assume(WordName::Compensation, compensation_code(Compensation::Off));
        writer.assume(WordName::TaperSide, 0);
        writer.assume(WordName::FeedMode, feed_mode::PER_MINUTE);
        Ok(Walk {
            machine,
            inverse: Inverse::of(machine),
            templates,
            feeds_rapids,
            writer,
            findings: Findings::default(),
            scope,
            source: program,
            statistics: None,
            cuts: None,
            fed: None,
            tops: None,
            known_feed: OnceCell::new(),
            by_feed: ByFeed::default(),
            radii: OnceCell::new(),
            index: 0,
            line: 0,
            wanted: Wanted::nothing(machine.path_tolerance()),
            sent: Sent::at_start(machine.path_tolerance()),
            position: ToolPosition::default(),
            around: Around::default(),
            contour: None,
            goes_on: false,
            place: CoordinateMode::start(machine),
            wire: Wire::of(machine, program),
            limits: Limits::new(machine),
            followed: Cell::new(None),
            resolution: machine.resolution(),
            rotary_resolution: machine.rotary_resolution(),
            ended: false,
        })
    }

    /// Writes everything; the text and its lines, or what keeps it from being written.
    pub(crate) fn run(mut self, progress: &dyn Progress) -> Result<crate::Output, Vec<Diagnostic>> {
        match self.records(progress) {
            Err(end) if end.rule == Rule::Cancelled => return Err(vec![*end]),
            Err(error) => drop(self.findings.error(*error)),
            Ok(()) => {}
        }
        if let Some(found) = self.slow_rapids() {
            self.findings.warn(found);
        }
        for error in self.limits.ways() {
            self.findings.error(error);
        }
        let warnings = self.findings.finish(self.machine.capabilities.lowering_tolerance)?;
        let (text, origins, blocks) = self.writer.finish();
        self.limits.memory(blocks).map_err(|found| vec![*found])?;
        Ok(crate::Output { text, origins, blocks, warnings, parts: Vec::new() })
    }

    fn records(&mut self, progress: &dyn Progress) -> Outcome {
        let all = self.source.records.len();
        let mut pulse = Pulse::new(progress, all, RECORDS_AT_ONCE);
        self.block(BlockName::ProgramStart)?;
        while self.index < self.source.records.len() {
            let rest = &self.source.records[self.index..];
            let done = self.index as f64 / all as f64;
            let waits = |_| progress.reached(done);
            let waits = Pulse::new(&waits, rest.len(), RECORDS_AT_ONCE);
            let (here, degrees) = (self.position.pose(), self.place.degrees());
            let route = match Route::of(self.machine, rest, here, degrees, waits) {
                Ok(route) => route,
                Err(end) if end.rule == Rule::Cancelled => return Err(end),
                // Without an orientation for each pose the operation cannot be written at all.
                Err(error) => {
                    if !self.findings.error(*error) {
                        return Ok(());
                    }
                    self.index += Route::length(rest);
                    continue;
                }
            };
            route.warnings().for_each(|warning| self.findings.warn(warning));
            let mut stops = route.stops();
            for record in &rest[..route.records] {
                pulse.step(self.index)?;
                self.line = record.line;
                self.writer.is_for(Some(self.index));
                let stop = record.op.pose().and_then(|_| stops.next());
                if let Err(error) = self.record(record, stop) {
                    let error = if error.line == 0 { error.line(self.line) } else { *error };
                    if !self.findings.error(error) {
                        return Ok(());
                    }
                }
                self.index += 1;
            }
        }
        self.writer.is_for(None);
        if self.ended { Ok(()) } else { self.end() }
    }

    fn record(&mut self, record: &'a Record, stop: Option<Stop>) -> Outcome {
        if self.ended {
            return match matches!(record.op, Op::End | Op::Comment(_) | Op::EndOfOperation) {
                true => Ok(()),
                false => Err(refuse(Rule::AfterEnd, "the program goes on after its end")),
            };
        }
        let goes_on = std::mem::take(&mut self.goes_on);
        // Where cuts go on, a route has one orientation; it is looked at all the same, since a block would not say another one.
        if let Op::Line(pose) = &record.op
            && goes_on
            && self.keeps_orientation(pose)
        {
            return self.line_on(pose);
        }
        let done = self.obey(record, stop);
        // What another record cuts straight on its way has a feed or an end of its own. An arc changes nothing but how the control moves.
        let is_line = matches!(record.op, Op::Line(_));
        let keeps = goes_on && matches!(record.op, Op::Arc(_));
        self.goes_on = done.is_ok() && (keeps || is_line && self.goes_on);
        done
    }

    fn obey(&mut self, record: &'a Record, stop: Option<Stop>) -> Outcome {
        match &record.op {
            Op::Rapid(pose) => self.motion(stop, |walk, stop| walk.rapid(pose, stop)),
            Op::Line(pose) => {
                self.come_back(stop.as_ref())?;
                self.motion(stop, |walk, stop| walk.line(pose, stop))
            }
            Op::Arc(to) => {
                self.come_back(stop.as_ref())?;
                self.motion(stop, |walk, stop| walk.arc(to, stop))
            }
            Op::Thread(thread) => {
                self.come_back(stop.as_ref())?;
                self.motion(stop, |walk, stop| walk.thread(thread, stop))
            }
            Op::Hole(pose) => self.motion(stop, |walk, stop| {
                walk.not_over_surface("a hole cycle")?;
                walk.hole(pose, stop)
            }),
            Op::Oriented(_) => {
                let help = "post it for a robot, or give the tool axis alone";
                Err(unknown_here(
                    "a move that says how far the tool is turned about its axis",
                    help,
                ))
            }
            Op::Joints(_) => Err(unknown_here("a move of joints", "post it for a robot")),
            Op::MachineMove(_) => Err(unknown_here(
                "a move to a position that counts from the zero of the machine",
                "leave it out: where the tool leaves the part, the machine file says it",
            )),
            Op::Probe(probe) => {
                self.come_back(stop.as_ref())?;
                self.probe(probe)
            }
            Op::Cycle(cycle) => {
                self.end_cycle()?;
                self.wanted.set_cycle(Some(cycle));
                Ok(())
            }
            Op::CycleOff => {
                self.wanted.set_cycle(None);
                self.end_cycle()
            }
            // What changes while a cycle is on holds from the next hole on, which defines it anew: a
            // block without a position would drill once more (SINUMERIK's MCALL), or not be heard.
            Op::Feed(feed) => {
                self.end_cycle()?;
                self.wanted.set_feed(Some(*feed));
                Ok(())
            }
            Op::Spindle(spindle) => {
                self.end_cycle()?;
                self.set_spindle(*spindle)
            }
            Op::SurfaceSpeed(None) => Ok(()),
            Op::SurfaceSpeed(Some(_)) => {
                let message = "the speed of the spindle follows X (G96), which is for turning";
                Err(refuse(Rule::SurfaceSpeed, message)
                    .help("give it speeds of its own (G97)")
                    .into())
            }
            Op::Coolant(coolant) => {
                self.end_cycle()?;
                self.wanted.set_coolant(*coolant);
                if *coolant == Coolant::Off { self.sync_coolant() } else { Ok(()) }
            }
            Op::Tool(tool) => self.change_tool(tool),
            Op::Preselect(number) if self.calls_next(*number) => Ok(()),
            Op::Preselect(number) => {
                self.limits.tool(&Tool { number: *number, ..Tool::default() }, self.line)?;
                self.writer.set(WordName::T, f64::from(*number));
                self.block(BlockName::ToolPreselect)
            }
            Op::Compensation(compensation) => self.set_compensation(*compensation),
            Op::Frame(frame) => {
                self.place.set_up(**frame);
                Ok(())
            }
            Op::Dwell(seconds) => self.dwell(*seconds),
            Op::Stop => self.stop(BlockName::Stop),
            Op::OptionalStop if self.machine.leaves_out("optional_stop") => {
                let message = "the control has no optional stop: it is left out";
                let found = Diagnostic::warning(Rule::OptionalStop, message);
                self.findings.warn(found.line(self.line));
                Ok(())
            }
            Op::OptionalStop => self.stop(BlockName::OptionalStop),
            Op::Operation(name) => {
                // What was switched on before it does not belong to it.
                if self.wanted.tool().is_some() {
                    self.expect_spindle()?;
                }
                if self.machine.format.fresh_operations {
                    self.writer.forget(POSITION | ORIENTATION | MOTION);
                    self.position.turn_to(None);
                }
                self.scope.operation = map([("name", Value::from(printed(self.machine, name)))]);
                self.block(BlockName::OperationStart)
            }
            Op::EndOfOperation => {
                self.end_cycle()?;
                self.block(BlockName::OperationEnd)
            }
            Op::Comment(text) => self.text(BlockName::Comment, text),
            Op::Message(text) if self.templates.has(BlockName::Message) => {
                self.text(BlockName::Message, text)
            }
            Op::Message(text) => self.text(BlockName::Comment, text),
            Op::End => self.end(),
            Op::ThreadWire => self.thread_wire(),
            Op::CutWire => self.cut_wire(),
            Op::Taper(degrees) => self.set_taper(*degrees),
            Op::Home => {
                self.end_cycle()?;
                self.leave_part()
            }
            Op::WorkOffset(offset) => self.set_work_offset(*offset),
            Op::WorkOffsetData(data) => self.write_work_offset(data),
            Op::Surface(surface) => self.set_surface(surface),
            Op::PathMode(mode) => {
                self.path_mode(*mode);
                Ok(())
            }
            Op::Beam(_) | Op::Pulses(_) => Err(unknown_here("a beam", "post it for a laser")),
            Op::Clamp(_) => {
                let message = "a clamp of the source's machine is left to this one's file: its blocks \
                               `unclamp` and `clamp` follow the axes";
                self.findings.warn(Diagnostic::warning(Rule::Clamp, message).line(self.line));
                Ok(())
            }
            Op::Output(output) => self.output(output),
            Op::Input(input) => self.input(input),
            Op::Auxiliary(function) => self.auxiliary(function),
        }
    }

    /// A motion, by a tool that has been called.
    #[inline]
    fn motion(
        &mut self,
        stop: Option<Stop>,
        go: impl FnOnce(&mut Self, &Stop) -> Outcome,
    ) -> Outcome {
        if self.wanted.tool().is_none() && self.wire.is_none() {
            self.default_tool()?;
        }
        stop.map_or(Ok(()), |stop| go(self, &stop))
    }

    /// Positions are counted from another work offset from here on; the way there leads over the part.
    fn set_work_offset(&mut self, offset: WorkOffset) -> Outcome {
        let number = offset.number();
        let name = number.to_string();
        let texts = self.machine.words.get(WordName::WorkOffset.name()).map(|word| &word.codes);
        let known = WordName::WorkOffset.codes().position(|code| code == name);
        let Some(index) = known.filter(|_| texts.is_some_and(|texts| texts.contains_key(&name)))
        else {
            let message = format!("the control has no text for work offset {number}");
            let help =
                format!("`{name}` in [words.work_offset] of its file, or another work offset");
            return Err(refuse(Rule::Unsupported, message).help(help).into());
        };
        self.not_over_surface("another work offset")?;
        self.end_cycle()?;
        self.leave_part()?;
        self.leave_place()?;
        self.plane_origin(Vec3::ZERO)?;
        self.position.leave(None);
        self.sent.select_work_offset(index);
        self.required(BlockName::WorkOffsetSelect)?;
        self.lose_position();
        Ok(())
    }

    /// The zero of a work offset, where the machine's programs may write it.
    fn write_work_offset(&mut self, data: &WorkOffsetData) -> Outcome {
        if !self.machine.settings.sets_work_offsets {
            let message = "the source writes work offsets (G10), and the program does not: whoever runs it sets them";
            let help = "`sets_work_offsets = true` in [settings] of a machine file whose shop sets its fixtures by programs";
            let found = Diagnostic::warning(Rule::OperatorData, message).help(help);
            self.findings.warn(found.line(self.line));
            return Ok(());
        }
        if self.position.is_located() {
            let message = "a work offset is written while the tool is over the part: where it then stands is not known";
            let help = "G10 before the first move of the tool";
            return Err(refuse(Rule::OperatorData, message).help(help).into());
        }
        self.end_cycle()?;
        // Here these words are no position to go to.
        let axes = POSITION | ORIENTATION;
        self.writer.forget(axes);
        let words = [WordName::X, WordName::Y, WordName::Z, WordName::A, WordName::B, WordName::C];
        for (word, value) in words.into_iter().zip(data.zero) {
            if let Some(value) = value {
                self.writer.set(word, value);
            }
        }
        self.writer
            .set(WordName::Offset, f64::from(data.offset.number() - WorkOffset::NONE.number()));
        self.required(BlockName::WorkOffsetData)?;
        self.writer.forget(axes);
        Ok(())
    }

    pub(crate) fn source(&self) -> &'a Program {
        self.source
    }

    /// How far the source reaches along the unit vector `direction`, mm.
    pub(crate) fn reach(&mut self, direction: Vec3) -> f64 {
        self.statistics.get_or_insert_with(|| Statistics::of(self.source)).reach(direction)
    }

    /// How far the source reaches by feed along the unit vector `direction`, with the heights from which it comes down, mm.
    pub(crate) fn fed_reach(&mut self, direction: Vec3) -> f64 {
        self.fed.get_or_insert_with(|| CutBox::fed(self.source)).reach(direction)
    }

    /// How high the source goes along the unit vector `axis`, mm.
    pub(crate) fn top_along(&mut self, axis: Vec3) -> f64 {
        self.tops.get_or_insert_with(|| Tops::of(self.source)).along(axis)
    }

    /// How far the cuts of the source reach along the unit vector `direction`, mm.
    pub(crate) fn cut_reach(&mut self, direction: Vec3) -> f64 {
        self.cuts.get_or_insert_with(|| CutBox::of(self.source)).reach(direction)
    }

    /// The fastest feed that the machine is known to take, mm/min: its own, or the fastest that the source has.
    pub(crate) fn known_feed(&self) -> Option<f64> {
        *self.known_feed.get_or_init(|| {
            if let Some(feed) = self.machine.settings.high_feed {
                return Some(feed.min(self.machine.feed_max));
            }
            if self.machine.feed_max.is_finite() {
                return Some(self.machine.feed_max);
            }
            let feeds = self.source.records.iter().filter_map(|record| {
                let Op::Feed(Feed::PerMinute(feed)) = record.op else { return None };
                Some(feed)
            });
            feeds.reduce(f64::max)
        })
    }

    /// Writes a block, where the machine has it.
    pub(crate) fn block(&mut self, name: BlockName) -> Outcome {
        self.writer.code(WordName::WorkOffset, self.sent.work_offset());
        let lines = self.writer.lines();
        match self.templates.lines(name) {
            Some(lines) => self.writer.block(name, lines)?,
            None => {
                // What runs before the first tool change, nobody knows.
                let known = self.wanted.tool().is_some();
                let spindle_stopped = known && self.sent.has_spindle(Spindle::Off);
                let clockwise = !matches!(self.wanted.spindle(), Spindle::CounterClockwise(_));
                let scope = Scope {
                    set: self.writer.set_words(),
                    spindle: spindle_value(self.sent.speed_changed(), clockwise, spindle_stopped),
                    coolant: coolant_value(
                        self.machine,
                        known && self.sent.has_coolant(Coolant::Off),
                        self.sent.last_coolant() == Coolant::Through,
                    ),
                    place: self.place.value(self.sent.is_home()),
                    cut: self.cut_value(),
                    ..self.scope.clone()
                };
                self.writer.block(name, &self.templates.render(name, scope)?)?;
            }
        }
        self.note_home(name);
        if let Some(contour) = &mut self.contour
            && name != BlockName::Comment
        {
            contour.blocks += self.writer.lines() - lines;
        }
        if self.feeds_rapids && self.templates.places(name, WordName::RapidFeed) {
            self.writer.forget(bit(WordName::F));
        }
        Ok(())
    }

    /// Whether Z is home behind a block.
    fn note_home(&mut self, name: BlockName) {
        use BlockName as B;
        if [B::Rapid, B::RapidVector, B::Linear, B::LinearVector].contains(&name) {
            self.sent.set_home(false);
            self.place.just_off = [false; 2];
        } else if name == B::ToolChange {
            self.sent.set_home(true);
            self.place.just_off = [false; 2];
        } else if name == B::Retract {
            self.sent.set_home(true);
        }
    }

    /// Writes a block that must be there.
    pub(crate) fn required(&mut self, name: BlockName) -> Outcome {
        if self.templates.has(name) {
            return self.block(name);
        }
        Err(Templates::missing(name).into())
    }

    fn text(&mut self, name: BlockName, text: &str) -> Outcome {
        self.scope.text = Value::from(printed(self.machine, text));
        self.block(name)
    }

    /// Everything is said, the control goes off.
    fn end(&mut self) -> Outcome {
        self.ended = true;
        self.wire_for(false, "the end of the program")?;
        self.uncompensated("the end of the program")?;
        self.end_cycle()?;
        self.look_ahead(false)?;
        self.warn_of_cut("ends");
        self.leave_place()?;
        if self.compensation_pending() {
            let message = "cutter compensation is switched here, and no move in the plane follows";
            let found = Diagnostic::warning(Rule::CompensationPending, message);
            self.findings.warn(found.line(self.wanted.compensation_line()));
        }
        self.plane_origin(Vec3::ZERO)?;
        self.place.turned = self.say_unturned(BlockName::ProgramEnd);
        if self.place.turned && self.machine.has_clamps() {
            self.writer.unset(Words::ALL);
            self.leave_part()?;
            self.unclamp()?;
            self.say_unturned(BlockName::ProgramEnd);
        }
        // What the next program finds: the plane XY, and F counts mm/min again, where the block places the word.
        self.plane_xy()?;
        self.writer.code(WordName::FeedMode, feed_mode::PER_MINUTE);
        self.block(BlockName::ProgramEnd)
    }

    fn dwell(&mut self, seconds: f64) -> Outcome {
        let positive = seconds > 0.0 && seconds.is_finite();
        if !positive {
            return Err(refuse(Rule::Dwell, format!("a dwell of {seconds} s")));
        }
        if self.writer.rounded(WordName::P, seconds) == 0.0 {
            let message = format!("a dwell of {seconds} s, written as 0");
            return Err(refuse(Rule::Dwell, message)
                .help("leave it out, or make it longer")
                .into());
        }
        self.end_cycle()?;
        self.expect_spindle()?;
        self.write_dwell(seconds)
    }

    /// A dwell. Where it says the feed mode, that is mm/min: under a feed per turn a control may count turns.
    pub(crate) fn write_dwell(&mut self, seconds: f64) -> Outcome {
        if self.templates.places(BlockName::Dwell, WordName::FeedMode) {
            self.writer.code(WordName::FeedMode, feed_mode::PER_MINUTE);
            if self.writer.changes(bit(WordName::FeedMode)) {
                self.writer.forget(bit(WordName::F));
            }
        }
        self.writer.set(WordName::P, seconds);
        self.required(BlockName::Dwell)
    }
}

/// The blank, as [`EXTENTS`]: the stock, or how far the cuts reach. `None` where that is no body, or where the program has
/// several work offsets, whose distance nobody knows.
fn blank(program: &Program) -> Option<[f64; 6]> {
    let (mut active, mut moves) = (None, false);
    for record in program.each() {
        if let Op::WorkOffset(offset) = record.op {
            if moves && active != Some(offset) {
                return None;
            }
            active = Some(offset);
        }
        moves |= record.op.pose().is_some();
    }
    let [low, high] = program.stock.or_else(|| CutBox::swept(program).corners())?;
    let is_body = (high - low).min_element() > THIN;
    is_body.then_some([low.x, low.y, low.z, high.x, high.y, high.z])
}

/// No block of a mill or a wire machine says this.
fn unknown_here(what: &str, help: &str) -> Box<Diagnostic> {
    refuse(Rule::Unsupported, format!("the machine has no words for {what}")).help(help).into()
}

/// An error; its line is that of the record at hand.
pub(crate) fn refuse(rule: Rule, message: impl Into<String>) -> Box<Diagnostic> {
    Box::new(Diagnostic::error(rule, message))
}
