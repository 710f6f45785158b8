//! The way through the program, record by record: what the machine is told, and when.

use crate::catalogue::{BlockName, WordName};
use crate::findings::Findings;
use crate::place::{Place, Route};
use crate::template::{
    LENGTH_OFFSET, ORIENTATION, POSITION, Scope, Templates, Words, bit, map, program_value,
    spindle_value, tool_value,
};
use crate::text::printed;
use crate::wire::Wire;
use crate::writer::Writer;
use geom::Vec3;
use machine::limits::Limits;
use machine::{LengthOffset, Machine, OptionValue};
use minijinja::value::Value;
use program::statistics::Statistics;
use program::{
    Compensation, Coolant, Cycle, Diagnostic, Feed, Op, Pose, Program, Record, Spindle, Surface,
    Tool, lowering,
};

/// A step that may be refused.
pub(crate) type Done = Result<(), Box<Diagnostic>>;

/// Entries of the code word `motion`.
pub(crate) mod motion {
    pub(crate) const RAPID: usize = 0;
    pub(crate) const LINEAR: usize = 1;
    pub(crate) const ARC_CW: usize = 2;
    pub(crate) const ARC_CCW: usize = 3;
}

/// Entries of the code word `feed_mode`.
mod feed_mode {
    pub(super) const PER_MINUTE: usize = 0;
    pub(super) const PER_TURN: usize = 1;
    pub(super) const INVERSE_TIME: usize = 2;
}

/// The words that say how the tool goes.
const MOTION: Words = bit(WordName::F) | bit(WordName::Motion);

/// The entry of the code word `plane` for the plane XY.
pub(crate) const PLANE_XY: usize = 0;

/// A program being written.
pub(crate) struct Walk<'a> {
    pub(crate) machine: &'a Machine,
    pub(crate) templates: Templates<'a>,
    pub(crate) writer: Writer,
    pub(crate) findings: Findings,
    scope: Scope,
    source: &'a Program,
    /// How far the source reaches; counted where it is asked for.
    statistics: Option<Statistics>,
    /// Where in its records we are.
    index: usize,
    /// Source line of the record at hand.
    pub(crate) line: u32,
    pub(crate) tool: Option<Tool>,
    /// The register of its length offset, where the control wants one.
    pub(crate) length_offset: Option<f64>,
    /// What the source wants, and what the control has been told.
    pub(crate) spindle: Spindle,
    pub(crate) active_spindle: Option<Spindle>,
    coolant: Coolant,
    active_coolant: Option<Coolant>,
    pub(crate) feed: Option<Feed>,
    compensation: Compensation,
    active_compensation: Compensation,
    compensation_line: u32,
    pub(crate) cycle: Option<&'a Cycle>,
    /// The definition that the control has, where a cycle is on.
    pub(crate) open_cycle: Option<crate::cycles::Open>,
    /// Length of the way of the tip in the cut of the source at hand, mm.
    pub(crate) whole: f64,
    /// The last pose of the source.
    pub(crate) here: Option<Pose>,
    /// Whether the control stands where the last pose says.
    pub(crate) located: bool,
    /// Whether nothing but cuts has been since a straight one, and a straight one in the same orientation differs
    /// from that in where it goes alone.
    pub(crate) goes_on: bool,
    pub(crate) place: Place,
    /// The wire, where the machine has one.
    pub(crate) wire: Option<Wire>,
    /// The surface that moves count from, where the control finds it.
    pub(crate) surface: Option<&'a Surface>,
    /// Where the next block brings the tool tip, mm, work frame.
    pub(crate) tip: Vec3,
    /// The same in the coordinates of the block, mm.
    pub(crate) said: Vec3,
    /// Where the last arc leads, in the coordinates of the block, where it is told by its angle.
    pub(crate) turned_to: Option<Vec3>,
    pub(crate) limits: Limits<'a>,
    /// Smallest step of a linear axis, mm.
    pub(crate) resolution: f64,
    /// Entry of the code word `work_offset` that is active.
    work_offset: usize,
    ended: bool,
}

impl<'a> Walk<'a> {
    pub(crate) fn new(program: &'a Program, machine: &'a Machine) -> Result<Self, Vec<Diagnostic>> {
        let templates = Templates::compile(machine)?;
        crate::promises::check(machine, &templates)?;
        let mut scope = Scope::new(machine);
        let tools = if templates.read_tools() { &program.records[..] } else { &[] };
        scope.program = program_value(machine, &program.name, tools);
        let mut writer = Writer::new(machine);
        // What the catalogue asks of `program_start`.
        writer.assume(WordName::Plane, PLANE_XY);
        writer.assume(WordName::Compensation, compensation_code(Compensation::Off));
        writer.assume(WordName::TaperSide, 0);
        writer.assume(WordName::FeedMode, feed_mode::PER_MINUTE);
        Ok(Walk {
            machine,
            templates,
            writer,
            findings: Findings::default(),
            scope,
            source: program,
            statistics: None,
            index: 0,
            line: 0,
            tool: None,
            length_offset: None,
            spindle: Spindle::Off,
            active_spindle: Some(Spindle::Off),
            coolant: Coolant::Off,
            active_coolant: Some(Coolant::Off),
            feed: None,
            compensation: Compensation::Off,
            active_compensation: Compensation::Off,
            compensation_line: 0,
            cycle: None,
            open_cycle: None,
            whole: 0.0,
            here: None,
            located: false,
            goes_on: false,
            place: Place::start(machine),
            wire: Wire::of(machine, program),
            surface: None,
            tip: Vec3::ZERO,
            said: Vec3::ZERO,
            turned_to: None,
            limits: Limits::new(machine),
            resolution: machine.resolution(),
            work_offset: 0,
            ended: false,
        })
    }

    /// Writes everything; the text and its lines, or what keeps it from being written.
    pub(crate) fn run(mut self) -> Result<crate::Output, Vec<Diagnostic>> {
        if let Err(error) = self.records() {
            self.findings.error(*error);
        }
        for error in self.limits.ways() {
            self.findings.error(error);
        }
        let warnings = self.findings.finish(self.machine.capabilities.lowering_tolerance)?;
        let (text, blocks) = self.writer.finish();
        self.limits.memory(blocks).map_err(|found| vec![*found])?;
        Ok(crate::Output { text, blocks, warnings })
    }

    fn records(&mut self) -> Done {
        self.block(BlockName::ProgramStart)?;
        while self.index < self.source.records.len() {
            let rest = &self.source.records[self.index..];
            let route = Route::of(self.machine, rest, self.here, self.place.degrees());
            let route = match route {
                Ok(route) => route,
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
                self.line = record.line;
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
        if self.ended { Ok(()) } else { self.end() }
    }

    fn record(&mut self, record: &'a Record, stop: Option<crate::place::Stop>) -> Done {
        if self.ended {
            return match record.op {
                Op::End | Op::Comment(_) | Op::EndOfOperation => Ok(()),
                _ => Err(refuse("after-end", "the program goes on after its end")),
            };
        }
        let goes_on = std::mem::take(&mut self.goes_on);
        match &record.op {
            Op::Line(pose) if goes_on && self.keeps_orientation(pose) => return self.line_on(pose),
            op if op.pose().is_some() => return self.motion(op, stop, goes_on),
            _ => {}
        }
        match &record.op {
            Op::Rapid(_) | Op::Line(_) | Op::Arc(_) | Op::Thread(_) | Op::Hole(_) => Ok(()),
            Op::Probe(probe) => self.probe(probe),
            Op::Cycle(cycle) => {
                self.end_cycle()?;
                self.cycle = Some(cycle);
                Ok(())
            }
            Op::CycleOff => {
                self.cycle = None;
                self.end_cycle()
            }
            // What changes while a cycle is on holds from the next hole on, which defines it anew: a
            // block without a position would drill once more (SINUMERIK's MCALL), or not be heard.
            Op::Feed(feed) => {
                self.end_cycle()?;
                self.feed = Some(*feed);
                Ok(())
            }
            Op::Spindle(spindle) => {
                self.end_cycle()?;
                self.set_spindle(*spindle)
            }
            Op::SurfaceSpeed(None) => Ok(()),
            Op::SurfaceSpeed(Some(_)) => {
                let message = "the speed of the spindle follows X (G96), which is for turning";
                Err(refuse("surface-speed", message).help("give it speeds of its own (G97)").into())
            }
            Op::Coolant(coolant) => {
                self.end_cycle()?;
                self.coolant = *coolant;
                if *coolant == Coolant::Off { self.sync_coolant() } else { Ok(()) }
            }
            Op::Tool(tool) => self.change_tool(tool),
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
                let found = Diagnostic::warning("optional-stop", message);
                self.findings.warn(found.line(self.line));
                Ok(())
            }
            Op::OptionalStop => self.stop(BlockName::OptionalStop),
            Op::Operation(name) => {
                // What was switched on before it does not belong to it.
                if self.tool.is_some() {
                    self.sync_spindle()?;
                }
                if self.machine.format.fresh_operations {
                    self.writer.forget(POSITION | ORIENTATION | MOTION);
                    self.turned_to = None;
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
            Op::Home(_) => {
                self.end_cycle()?;
                self.leave_part()
            }
            Op::WorkOffset(number) => self.set_work_offset(*number),
            Op::Surface(surface) => self.set_surface(surface),
            Op::LengthOffset(_) => {
                Err(refuse("unsupported", "only virtual controls give this record"))
            }
        }
    }

    fn motion(&mut self, op: &'a Op, stop: Option<crate::place::Stop>, goes_on: bool) -> Done {
        if self.tool.is_none() && self.wire.is_none() {
            self.default_tool()?;
        }
        let Some(stop) = stop else { return Ok(()) };
        let done = match op {
            Op::Rapid(pose) => self.rapid(pose, &stop),
            Op::Line(pose) => self.line(pose, &stop),
            Op::Arc(to) => self.arc(to, &stop),
            Op::Hole(pose) => {
                self.not_over_surface("a hole cycle")?;
                self.hole(pose, &stop)
            }
            Op::Thread(thread) => self.thread(thread, &stop),
            _ => Ok(()),
        };
        self.goes_on = match op {
            Op::Line(_) => self.goes_on,
            // It changes nothing but how the control moves.
            Op::Arc(_) => goes_on && done.is_ok(),
            // What others cut straight, they do with a feed or an end of their own.
            _ => false,
        };
        done
    }

    /// Positions are counted from another work offset from here on; the way there leads over the part.
    fn set_work_offset(&mut self, number: u32) -> Done {
        let name = number.to_string();
        let texts = self.machine.words.get(WordName::WorkOffset.name()).map(|word| &word.codes);
        let known = WordName::WorkOffset.codes().position(|code| code == name);
        let Some(index) = known.filter(|_| texts.is_some_and(|texts| texts.contains_key(&name)))
        else {
            let message = format!("the control has no text for work offset {number}");
            let help =
                format!("`{name}` in [words.work_offset] of its file, or another work offset");
            return Err(refuse("unsupported", message).help(help).into());
        };
        self.not_over_surface("another work offset")?;
        self.end_cycle()?;
        self.leave_part()?;
        self.leave_place()?;
        self.work_offset = index;
        self.required(BlockName::WorkOffsetSelect)?;
        self.lose_position();
        Ok(())
    }

    /// How far the source reaches along the unit vector `direction`, mm.
    pub(crate) fn reach(&mut self, direction: Vec3) -> f64 {
        self.statistics.get_or_insert_with(|| Statistics::of(self.source)).reach(direction)
    }

    /// Writes a block, where the machine has it.
    pub(crate) fn block(&mut self, name: BlockName) -> Done {
        self.writer.code(WordName::WorkOffset, self.work_offset);
        match self.templates.lines(name) {
            Some(lines) => self.writer.block(lines),
            None => {
                let scope = Scope { set: self.writer.set_words(), ..self.scope.clone() };
                self.writer.block(&self.templates.render(name, scope)?)
            }
        }
    }

    /// Writes a block that must be there.
    pub(crate) fn required(&mut self, name: BlockName) -> Done {
        if self.templates.has(name) {
            return self.block(name);
        }
        let message = format!("the control has no block `{}`", name.name());
        let help = format!("`{}` in its file, or a toolpath that does without", name.name());
        Err(refuse("missing-block", message).help(help).into())
    }

    fn text(&mut self, name: BlockName, text: &str) -> Done {
        self.scope.text = Value::from(printed(self.machine, text));
        self.block(name)
    }

    /// Everything is said, the control goes off.
    fn end(&mut self) -> Done {
        self.ended = true;
        self.wire_for(false, "the end of the program")?;
        self.uncompensated("the end of the program")?;
        self.end_cycle()?;
        self.leave_place()?;
        if self.compensation != self.active_compensation {
            let message = "cutter compensation is switched here, and no move in the plane follows";
            let found = Diagnostic::warning("compensation-pending", message);
            self.findings.warn(found.line(self.compensation_line));
        }
        self.block(BlockName::ProgramEnd)
    }

    fn dwell(&mut self, seconds: f64) -> Done {
        let positive = seconds > 0.0 && seconds.is_finite();
        if !positive {
            return Err(refuse("dwell", format!("a dwell of {seconds} s")));
        }
        if self.writer.rounded(WordName::P, seconds) == 0.0 {
            let message = format!("a dwell of {seconds} s, written as 0");
            return Err(refuse("dwell", message).help("leave it out, or make it longer").into());
        }
        self.end_cycle()?;
        self.sync_spindle()?;
        self.writer.set(WordName::P, seconds);
        self.required(BlockName::Dwell)
    }

    /// A stop, after which spindle and coolant are told anew: some controls switch both off for it
    /// (HEIDENHAIN's `M0`), and so may the operator.
    fn stop(&mut self, name: BlockName) -> Done {
        self.end_cycle()?;
        if self.wire.is_none() {
            (self.active_spindle, self.active_coolant) = (None, None);
        }
        self.required(name)
    }

    // Tools.

    fn change_tool(&mut self, tool: &Tool) -> Done {
        self.uncompensated("the tool change")?;
        self.end_cycle()?;
        self.leave_place()?;
        self.limits.tool(tool, self.line)?;
        let number = f64::from(tool.number);
        let edge = self.machine.capabilities.length_offset != LengthOffset::ToolNumber;
        if let Some(register) = tool.offset.filter(|_| edge) {
            self.leave_register_out("length", register);
        }
        self.length_offset = match self.machine.capabilities.length_offset {
            LengthOffset::Implicit => None,
            LengthOffset::One => Some(1.0),
            LengthOffset::ToolNumber => Some(tool.offset.map_or(number, f64::from)),
        };
        self.writer.set(WordName::T, number);
        self.writer.forget(LENGTH_OFFSET);
        self.say_length_offset();
        if let Some(speed) = self.coming_speed() {
            self.writer.set(WordName::S, speed);
        }
        self.scope.tool = tool_value(self.machine, tool, self.tool.is_none());
        self.required(BlockName::ToolChange)?;
        self.tool = Some(tool.clone());
        self.writer.forget(POSITION | ORIENTATION | MOTION | bit(WordName::D));
        self.turned_to = None;
        self.located = false;
        (self.active_spindle, self.active_coolant) = (Some(Spindle::Off), Some(Coolant::Off));
        Ok(())
    }

    /// The control has no word for the register that the source names for the `what` of the tool.
    fn leave_register_out(&mut self, what: &str, register: u32) {
        let message = format!(
            "{what} register {register} is left out: the control takes the {what} with the tool"
        );
        self.findings.warn(Diagnostic::warning("register", message).line(self.line));
    }

    /// The speed at which the tool that is called now will cut first.
    fn coming_speed(&self) -> Option<f64> {
        let coming = self.source.records[self.index..].iter().map(|record| &record.op);
        let mut until_cut = coming
            .take_while(|op| !matches!(op, Op::Line(_) | Op::Arc(_) | Op::Thread(_) | Op::Hole(_)));
        let next = until_cut.find_map(|op| match op {
            Op::Spindle(spindle) => speed(*spindle),
            _ => None,
        });
        next.or(speed(self.spindle))
    }

    /// The source calls no tool: the machine file may say which one that means.
    fn default_tool(&mut self) -> Done {
        let number = match self.machine.options.get("default_tool") {
            Some(OptionValue::Number(number)) => *number as u32,
            _ => {
                let help =
                    "LOAD/TOOL in the source, or `default_tool` in the [options] of the machine";
                return Err(Box::new(
                    refuse("no-tool", "the source moves before it calls a tool").help(help),
                ));
            }
        };
        let message = format!("the source calls no tool: tool {number} (`default_tool`) is called");
        self.findings.warn(Diagnostic::warning("no-tool", message).line(self.line));
        self.change_tool(&Tool { number, ..Tool::default() })
    }

    // Spindle and coolant.

    fn set_spindle(&mut self, spindle: Spindle) -> Done {
        self.spindle = spindle;
        match speed(spindle) {
            None => self.sync_spindle(),
            Some(speed) if self.writer.rounded(WordName::S, speed) > 0.0 => {
                self.limits.spindle(spindle, self.line)
            }
            Some(speed) => {
                let help = "SPINDL/OFF where the spindle is to stand";
                let message = format!("spindle speed {speed} 1/min, written as 0");
                Err(refuse("spindle-range", message).help(help).into())
            }
        }
    }

    /// Tells the control the spindle that the source wants.
    pub(crate) fn sync_spindle(&mut self) -> Done {
        if self.active_spindle == Some(self.spindle) {
            return Ok(());
        }
        self.active_spindle = Some(self.spindle);
        if let Some(speed) = speed(self.spindle) {
            self.writer.set(WordName::S, speed);
        }
        let changed = speed(self.spindle) != self.writer.active(WordName::S);
        let counter = matches!(self.spindle, Spindle::CounterClockwise(_));
        self.scope.spindle = spindle_value(changed, !counter);
        self.required(match self.spindle {
            Spindle::Off => BlockName::SpindleOff,
            Spindle::Clockwise(_) => BlockName::SpindleCw,
            Spindle::CounterClockwise(_) => BlockName::SpindleCcw,
        })
    }

    pub(crate) fn sync_coolant(&mut self) -> Done {
        if self.active_coolant == Some(self.coolant) {
            return Ok(());
        }
        self.active_coolant = Some(self.coolant);
        let block = match self.coolant {
            Coolant::Off => BlockName::CoolantOff,
            Coolant::Flood => BlockName::CoolantFlood,
            Coolant::Mist => BlockName::CoolantMist,
            Coolant::FloodAndMist => {
                self.coolant_block(BlockName::CoolantMist)?;
                BlockName::CoolantFlood
            }
            Coolant::Through => BlockName::CoolantThrough,
        };
        self.coolant_block(block)
    }

    /// Coolant that the control does nothing for is none.
    fn coolant_block(&mut self, name: BlockName) -> Done {
        if self.coolant != Coolant::Off && self.machine.leaves_out(name.name()) {
            let message =
                format!("the control has no coolant of this kind: `{}` is empty", name.name());
            let help = "another coolant in the toolpath, or the block in a file of your own";
            return Err(refuse("missing-block", message).help(help).into());
        }
        self.required(name)
    }

    /// Before the tool touches the part: it turns, and coolant runs.
    #[inline]
    pub(crate) fn before_cut(&mut self) -> Done {
        self.wire_for(true, "a cut")?;
        if self.spindle == Spindle::Off && self.wire.is_none() {
            let help = "SPINDL/ with a speed before the first cut";
            return Err(Box::new(
                refuse("spindle-off", "a cut while the spindle stands").help(help),
            ));
        }
        self.sync_spindle()?;
        self.sync_coolant()
    }

    // Cutter compensation: it is switched with the first straight move in the plane, by rapid or in
    // the cut, but not on the way from a place that the program does not know.

    fn set_compensation(&mut self, compensation: Compensation) -> Done {
        if compensation != Compensation::Off && !self.machine.capabilities.compensation {
            // Whether the path is that of the tool's centre or the contour, only its author knows.
            let help = "give the path of the tool's centre: without CUTCOM, or of an NC program with its tool table (--tools)";
            return Err(Box::new(
                refuse("compensation", "the control has no cutter compensation").help(help),
            ));
        }
        if let Compensation::Left(Some(register)) | Compensation::Right(Some(register)) =
            compensation
            && !self.templates.places(BlockName::Linear, WordName::D)
        {
            self.leave_register_out("radius", register);
        }
        self.compensation = compensation;
        self.compensation_line = self.line;
        Ok(())
    }

    /// Says the compensation in the next block, a straight move; one in the plane switches it.
    pub(crate) fn compensate(&mut self) {
        let in_plane = bit(WordName::X) | bit(WordName::Y);
        if self.compensation_pending() && self.writer.changes(in_plane) {
            self.active_compensation = self.compensation;
            let tool = self.tool.as_ref().map(|tool| tool.number);
            match self.compensation {
                Compensation::Left(register) | Compensation::Right(register) => {
                    if let Some(register) = register.or(tool) {
                        self.writer.set(WordName::D, f64::from(register));
                    }
                }
                Compensation::Off => {}
            }
        }
        self.keep_compensation();
    }

    /// Says in the next block the compensation that is active.
    pub(crate) fn keep_compensation(&mut self) {
        self.writer.code(WordName::Compensation, compensation_code(self.active_compensation));
    }

    /// Compensation has to be off before `what`.
    pub(crate) fn uncompensated(&self, what: &str) -> Done {
        if self.active_compensation == Compensation::Off {
            return Ok(());
        }
        let help = "CUTCOM/OFF and a straight move in the plane before it";
        let message = format!("cutter compensation is still on at {what}");
        Err(refuse("compensation-active", message).help(help).into())
    }

    /// Whether the next straight move in the plane switches the compensation.
    pub(crate) fn compensation_pending(&self) -> bool {
        self.compensation != self.active_compensation
    }

    // Feed.

    /// Whether the feed is in inverse time: then the length of a cut counts.
    #[inline]
    pub(crate) fn is_timed(&self) -> bool {
        matches!(self.feed, Some(Feed::InverseTime(_)))
    }

    /// Says the feed of a cut of `length` mm in the next block, one of `pieces` of the source's. With
    /// `turning` the control, which knows nothing of the tool tip, is told the time instead, where it
    /// can be. Answers the feed as it is said.
    #[inline]
    pub(crate) fn say_feed(
        &mut self,
        length: f64,
        pieces: usize,
        turning: bool,
    ) -> Result<f64, Box<Diagnostic>> {
        let Some(mut feed) = self.feed else {
            // The generator of a wire machine holds the gap, and finds the feed by it.
            if self.wire.is_some() {
                return Ok(0.0);
            }
            return Err(refuse("feed-missing", "a cut before the first feed"));
        };
        self.limits.feed(feed, self.spindle, self.line)?;
        if let Feed::InverseTime(rate) = &mut feed {
            // A piece has its part of the time.
            let within = self.whole > 0.0 && length > 0.0;
            *rate *= if within { self.whole / length } else { pieces as f64 };
        }
        let can = &self.machine.capabilities;
        let speed = speed(self.spindle).unwrap_or_default();
        let per_minute = || lowering::feed_per_minute(feed, length, speed);
        let (mode, value) = match feed {
            Feed::PerTurn(value) if can.feed_per_turn && !turning => (feed_mode::PER_TURN, value),
            Feed::InverseTime(value) if can.inverse_time => (feed_mode::INVERSE_TIME, value),
            _ if turning && can.inverse_time && length > 0.0 => {
                (feed_mode::INVERSE_TIME, per_minute() / length)
            }
            _ => (feed_mode::PER_MINUTE, per_minute()),
        };
        match feed {
            Feed::PerTurn(_) if mode == feed_mode::PER_MINUTE => {
                self.findings.lowered("feed-per-turn", "feeds per turn (as mm/min)", self.line, 1);
            }
            Feed::InverseTime(_) if mode == feed_mode::PER_MINUTE => {
                let what = "inverse-time feeds (as mm/min)";
                self.findings.lowered("feed-inverse-time", what, self.line, 1);
            }
            _ => {}
        }
        self.writer.feed_form(match mode {
            feed_mode::PER_TURN => WordName::FeedPerTurn,
            feed_mode::INVERSE_TIME => WordName::FeedInverse,
            _ => WordName::F,
        });
        if mode == feed_mode::INVERSE_TIME {
            // Every block in inverse time has a feed of its own, even an equal one.
            self.writer.forget(bit(WordName::F));
        }
        let written = self.writer.rounded(WordName::F, value);
        let moves = written > 0.0;
        if !moves {
            let message = format!("a cut with a feed of {value}, written as {written}");
            return Err(refuse("feed-zero", message));
        }
        self.writer.set(WordName::F, value);
        self.writer.code(WordName::FeedMode, mode);
        Ok(value)
    }
}

/// An error; its line is that of the record at hand.
pub(crate) fn refuse(rule: &'static str, message: impl Into<String>) -> Box<Diagnostic> {
    Box::new(Diagnostic::error(rule, message))
}

fn speed(spindle: Spindle) -> Option<f64> {
    match spindle {
        Spindle::Off => None,
        Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) => Some(speed),
    }
}

fn compensation_code(compensation: Compensation) -> usize {
    match compensation {
        Compensation::Off => 0,
        Compensation::Left(_) => 1,
        Compensation::Right(_) => 2,
    }
}
