//! The technology of the walk: tools, spindle, coolant and feed, output when they are needed.

use super::{MOTION, Outcome, Walk, refuse};
use crate::catalogue::{BlockName, WordName};
use crate::template::{LENGTH_OFFSET, ORIENTATION, POSITION, cut_value, tool_value};
use crate::words::bit;
use geom::Vec3;
use machine::{LengthOffset, Machine, OptionKey, OptionValue};
use minijinja::Value;
use program::{Compensation, Coolant, Diagnostic, Feed, PathMode, Rule, Spindle, Tool, lowering};

/// Entries of the code word `feed_mode`.
pub(super) mod feed_mode {
    pub(crate) const PER_MINUTE: usize = 0;
    pub(crate) const PER_TURN: usize = 1;
    pub(crate) const INVERSE_TIME: usize = 2;
}

/// What a cut is to the feed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cut {
    Straight,
    Arc,
    /// Rotary axes turn by so much, and the control knows nothing of the tool tip.
    Turning(AxisPositions),
}

/// Positions of the axes without tool-centre control, or the way between two of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AxisPositions {
    /// X, Y and Z, mm.
    pub linear: Vec3,
    /// A, B and C, degrees.
    pub degrees: [f64; 3],
}

impl AxisPositions {
    /// The way to another position.
    pub fn to(&self, there: &AxisPositions) -> AxisPositions {
        let degrees = [0, 1, 2].map(|i| there.degrees[i] - self.degrees[i]);
        AxisPositions { linear: there.linear - self.linear, degrees }
    }

    /// What the slowest axis takes at its rapid, minutes, and its name.
    fn least(&self, machine: &Machine) -> (f64, char) {
        let linear = ['X', 'Y', 'Z'].into_iter().zip(&machine.linear).zip(self.linear.to_array());
        let linear = linear
            .map(|((name, axis), way)| (axis.rapid.map_or(0.0, |rapid| way.abs() / rapid), name));
        let rotary = machine.rotary.iter();
        let rotary =
            rotary.map(|axis| (self.degrees[axis.index()].abs() / axis.rapid, axis.letter));
        linear.chain(rotary).fold((0.0, 'X'), |most, one| if one.0 > most.0 { one } else { most })
    }
}

/// The least tolerance that is written, mm: below it the control is asked for the exact path.
const CLOSEST: f64 = 0.001;

/// A way of the tip below this, mm, is none: the tool turns about its tip, and F is the speed of its axes.
const STANDS: f64 = 1e-6;

impl Walk<'_> {
    /// How closely the source wants its path to be followed in the cuts to come. A control that can be given that is given it, and no
    /// more than the machine's file allows; where it cannot, a warning says so.
    pub(crate) fn path_mode(&mut self, mode: PathMode) {
        let own = self.machine.path_tolerance();
        let most = own.max(self.machine.roughing_tolerance());
        let asked = match mode {
            PathMode::AsSetUp => own,
            PathMode::ExactStop | PathMode::ExactPath => 0.0,
            PathMode::Blend(asked) => asked.min(most),
        };
        let says = self.templates.places(BlockName::LookAheadOn, WordName::Tolerance);
        let says_exact = self.templates.says_exact(BlockName::LookAheadOn);
        let allowed = match () {
            () if says && asked >= CLOSEST => asked,
            () if says_exact && asked < own => 0.0,
            () if says => CLOSEST.min(own),
            () => own,
        };
        self.wanted.set_path_tolerance(allowed);
        let has_no_word = self.templates.has(BlockName::LookAheadOn) && !says && !says_exact;
        if has_no_word && allowed == 0.0 && mode != PathMode::AsSetUp {
            let message = "the source says how closely its path is followed: this control has no word for \
                           it, its parameters say how far it leaves corners";
            let message = Diagnostic::warning(Rule::PathMode, message.to_owned());
            self.findings.warn(message.line(self.line));
        }
        if allowed <= asked.max(CLOSEST) {
            return;
        }
        let less = match mode {
            PathMode::ExactStop => "the source stops at each corner".to_owned(),
            PathMode::ExactPath => "the source keeps to the path".to_owned(),
            PathMode::AsSetUp | PathMode::Blend(_) => {
                format!("the source leaves the path by {asked} mm at corners")
            }
        };
        let message = format!("{less}: this control leaves it by {allowed} mm at the most there");
        self.findings.warn(Diagnostic::warning(Rule::PathMode, message).line(self.line));
    }

    /// The cuts to come, as templates see them.
    pub(super) fn cut_value(&self) -> Value {
        let tolerance = self.wanted.path_tolerance();
        cut_value(tolerance == 0.0, tolerance > self.machine.path_tolerance())
    }

    pub(super) fn change_tool(&mut self, tool: &Tool) -> Outcome {
        self.uncompensated("the tool change")?;
        self.end_cycle()?;
        self.look_ahead(false)?;
        self.warn_of_cut("changes the tool");
        self.leave_place()?;
        self.clamp_again()?;
        self.limits.tool(tool, self.line)?;
        let number = f64::from(tool.number);
        let edge = self.machine.capabilities.length_offset != LengthOffset::ToolNumber;
        if let Some(register) = tool.offset.filter(|_| edge) {
            self.leave_register_out("length", register);
        }
        self.sent.set_length_register(match self.machine.capabilities.length_offset {
            LengthOffset::Implicit => None,
            LengthOffset::One => Some(1.0),
            LengthOffset::ToolNumber => Some(tool.offset.map_or(number, f64::from)),
        });
        let stands_upright = self.upright_for_tool()?;
        // The plane may say along which axis the length counts.
        self.plane_xy()?;
        self.writer.set(WordName::T, number);
        self.writer.forget(LENGTH_OFFSET);
        self.say_length_offset();
        if let Some(speed) = self.coming_speed() {
            self.writer.set(WordName::S, speed);
        }
        let next = self.around.other_tool(&self.source.records, self.index, tool.number);
        self.scope.tool = tool_value(self.machine, tool, self.wanted.tool().is_none(), next);
        let upright = self.upright();
        self.place.turned = self.say_unturned(BlockName::ToolChange);
        self.required(BlockName::ToolChange)?;
        self.wanted.call_tool(tool.clone());
        self.position.leave(None);
        self.writer.forget(POSITION | MOTION | bit(WordName::D));
        if stands_upright {
            self.place.turn_to(upright);
        } else {
            self.writer.forget(ORIENTATION);
        }
        if self.machine.capabilities.length_offset == LengthOffset::One
            && self.machine.settings.edge_at_change == Some(1)
        {
            self.writer.is_at(WordName::H, 1.0);
        }
        self.position.change_tool();
        self.sent.change_tool();
        Ok(())
    }

    /// Whether the source calls tool `number` before it moves again: made ready, it would be called at once.
    pub(super) fn calls_next(&mut self, number: u32) -> bool {
        self.around.tool_before_motion(&self.source.records, self.index) == Some(number)
    }

    /// The control has no word for the register that the source names for the `what` of the tool.
    pub(super) fn leave_register_out(&mut self, what: &str, register: u32) {
        let message = format!(
            "{what} register {register} is left out: the control takes the {what} with the tool"
        );
        self.findings.warn(Diagnostic::warning(Rule::Register, message).line(self.line));
    }

    /// The speed at which the tool that is called now will cut first.
    fn coming_speed(&mut self) -> Option<f64> {
        let coming = self.around.spindle_before_cut(&self.source.records, self.index);
        speed(coming.unwrap_or(self.wanted.spindle()))
    }

    /// The source calls no tool: the machine file may say which one that means.
    pub(super) fn default_tool(&mut self) -> Outcome {
        let number = match self.machine.option(OptionKey::DefaultTool) {
            Some(OptionValue::Number(number)) => *number as u32,
            _ => {
                let help =
                    "LOAD/TOOL in the source, or `default_tool` in the [options] of the machine";
                return Err(Box::new(
                    refuse(Rule::NoTool, "the source moves before it calls a tool").help(help),
                ));
            }
        };
        let message = format!("the source calls no tool: tool {number} (`default_tool`) is called");
        self.findings.warn(Diagnostic::warning(Rule::NoTool, message).line(self.line));
        self.change_tool(&Tool { number, ..Tool::default() })
    }

    pub(super) fn set_spindle(&mut self, spindle: Spindle) -> Outcome {
        self.wanted.set_spindle(spindle);
        match speed(spindle) {
            None => self.sync_spindle(),
            Some(speed) if self.writer.rounded(WordName::S, speed) > 0.0 => {
                self.limits.spindle(spindle, self.line)
            }
            Some(speed) => {
                let help = "SPINDL/OFF where the spindle is to stand";
                let message = format!("spindle speed {speed} 1/min, written as 0");
                Err(refuse(Rule::SpindleRange, message).help(help).into())
            }
        }
    }

    /// Switches the spindle as the source wants it, where something needs it before it stops again.
    pub(crate) fn expect_spindle(&mut self) -> Outcome {
        if self.wanted.spindle() == Spindle::Off
            || self.around.needs_spindle(&self.source.records, self.index)
        {
            return self.sync_spindle();
        }
        Ok(())
    }

    /// Switches the spindle as the source wants it.
    pub(crate) fn sync_spindle(&mut self) -> Outcome {
        let spindle = self.wanted.spindle();
        if self.sent.has_spindle(spindle) {
            return Ok(());
        }
        if let Some(speed) = speed(spindle) {
            self.writer.set(WordName::S, speed);
        }
        self.sent.say_speed_change(speed(spindle) != self.writer.active(WordName::S));
        self.required(match spindle {
            Spindle::Off => BlockName::SpindleOff,
            Spindle::Clockwise(_) => BlockName::SpindleCw,
            Spindle::CounterClockwise(_) => BlockName::SpindleCcw,
        })?;
        let runs_up = self.sent.switch_spindle(spindle);
        let dwell = self.machine.spindle.dwell;
        if runs_up && dwell != 0.0 { self.write_dwell(dwell) } else { Ok(()) }
    }

    pub(crate) fn sync_coolant(&mut self) -> Outcome {
        let coolant = self.wanted.coolant();
        if self.sent.has_coolant(coolant) {
            return Ok(());
        }
        if self.sent.mixes_coolant(coolant) {
            self.required(BlockName::CoolantOff)?;
        }
        self.coolant_block(match coolant {
            Coolant::Off => BlockName::CoolantOff,
            Coolant::Flood => BlockName::CoolantFlood,
            Coolant::Mist => BlockName::CoolantMist,
            Coolant::FloodAndMist => BlockName::CoolantFloodAndMist,
            Coolant::Through => BlockName::CoolantThrough,
        })?;
        self.sent.switch_coolant(coolant);
        Ok(())
    }

    /// Coolant that the control does nothing for is none.
    fn coolant_block(&mut self, name: BlockName) -> Outcome {
        if self.wanted.coolant() != Coolant::Off && self.machine.leaves_out(name.name()) {
            let message =
                format!("the control has no coolant of this kind: `{}` is empty", name.name());
            let help = "another coolant in the toolpath, or the block in a file of your own";
            return Err(refuse(Rule::MissingBlock, message).help(help).into());
        }
        self.required(name)
    }

    /// Before the tool touches the part: it turns, and coolant runs.
    #[inline]
    pub(crate) fn before_cut(&mut self) -> Outcome {
        self.wire_for(true, "a cut")?;
        if self.wanted.spindle() == Spindle::Off && self.wire.is_none() {
            let help = "SPINDL/ with a speed before the first cut";
            return Err(Box::new(
                refuse(Rule::SpindleOff, "a cut while the spindle stands").help(help),
            ));
        }
        self.sync_spindle()?;
        self.sync_coolant()
    }

    /// Look-ahead goes on or off, where the machine's file has the blocks for it.
    #[inline]
    pub(crate) fn look_ahead(&mut self, on: bool) -> Outcome {
        let tolerance = self.wanted.path_tolerance();
        let differs = on && self.sent.path_tolerance() != tolerance;
        if !self.sent.look_ahead(on) && !differs {
            return Ok(());
        }
        if !on {
            let ends = self.templates.has(BlockName::LookAheadOff);
            return if ends { self.block(BlockName::LookAheadOff) } else { Ok(()) };
        }
        self.sent.set_path_tolerance(tolerance);
        if !self.templates.has(BlockName::LookAheadOn) {
            return Ok(());
        }
        let places = self.templates.places(BlockName::LookAheadOn, WordName::Tolerance);
        if places || self.templates.says_exact(BlockName::LookAheadOn) {
            // What `program_start` has said, or this block before, still holds where nothing takes it back.
            if !differs && !self.templates.has(BlockName::LookAheadOff) {
                return Ok(());
            }
            if places {
                self.writer.set(WordName::Tolerance, tolerance);
            }
        }
        self.block(BlockName::LookAheadOn)
    }

    /// Look-ahead goes on before a cut, unless the control compensates already: then it follows with the next contour.
    #[inline]
    pub(crate) fn look_ahead_in_cuts(&mut self) -> Outcome {
        let compensates = self.sent.compensation() != Compensation::Off;
        if compensates { Ok(()) } else { self.look_ahead(true) }
    }

    /// Whether the feed is in inverse time: then the length of a cut counts.
    #[inline]
    pub(crate) fn is_timed(&self) -> bool {
        matches!(self.wanted.feed(), Some(Feed::InverseTime(_)))
    }

    /// Says the feed of a cut of `length` mm in the next block, one of `pieces` of the source's. Answers the feed as it
    /// is said.
    #[inline]
    pub(crate) fn say_feed(
        &mut self,
        length: f64,
        pieces: usize,
        cut: Cut,
    ) -> Result<f64, Box<Diagnostic>> {
        let Some(mut feed) = self.wanted.feed() else {
            // The generator of a wire machine holds the gap, and finds the feed by it.
            if self.wire.is_some() {
                return Ok(0.0);
            }
            return Err(refuse(Rule::NoFeed, "a cut before the first feed"));
        };
        self.limits.feed(feed, self.wanted.spindle(), self.line)?;
        if let Feed::InverseTime(rate) = &mut feed {
            // A piece has its part of the time.
            let whole = self.position.cut_length();
            let within = whole > 0.0 && length > 0.0;
            *rate *= if within { whole / length } else { pieces as f64 };
        }
        let can = &self.machine.capabilities;
        // Around the corners of a contour the control adds moves, whose time nobody gives.
        let timed = can.inverse_time
            && (cut != Cut::Arc || can.inverse_time_arcs)
            && !(self.wire.is_none() && self.offsets());
        let speed = speed(self.wanted.spindle()).unwrap_or_default();
        let per_minute = || lowering::feed_per_minute(feed, length, speed);
        let (mode, value) = match (feed, cut) {
            (_, Cut::Turning(turn)) => self.feed_of_turn(feed, length, &turn)?,
            (Feed::PerTurn(value), _) if can.feed_per_turn => (feed_mode::PER_TURN, value),
            (Feed::InverseTime(value), _) if timed => (feed_mode::INVERSE_TIME, value),
            (Feed::PerMinute(_) | Feed::PerTurn(_) | Feed::InverseTime(_), _) => {
                (feed_mode::PER_MINUTE, per_minute())
            }
        };
        match feed {
            Feed::PerTurn(_) if mode == feed_mode::PER_MINUTE => {
                self.findings.lowered(
                    Rule::FeedPerTurn,
                    "feeds per turn (as mm/min)",
                    self.line,
                    1,
                );
            }
            Feed::InverseTime(_) if mode == feed_mode::PER_MINUTE => {
                let what = "inverse-time feeds (as mm/min)";
                self.findings.lowered(Rule::FeedInverseTime, what, self.line, 1);
            }
            Feed::PerMinute(_) | Feed::PerTurn(_) | Feed::InverseTime(_) => {}
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
            return Err(refuse(Rule::FeedZero, message));
        }
        self.writer.set(WordName::F, value);
        self.writer.code(WordName::FeedMode, mode);
        Ok(value)
    }
}

impl Walk<'_> {
    /// The feed by which the tip goes `length` mm at the speed of the source while rotary axes turn without tool-centre
    /// control: as the time that takes where the control has it, otherwise as a number that counts what the control counts.
    /// No axis is asked to go faster than its rapid, and F is no more than `feed_max`: then the tip is slower.
    fn feed_of_turn(
        &mut self,
        feed: Feed,
        length: f64,
        turn: &AxisPositions,
    ) -> Result<(usize, f64), Box<Diagnostic>> {
        let speed = speed(self.wanted.spindle()).unwrap_or_default();
        let inverse = self.machine.capabilities.inverse_time;
        let wanted = match feed {
            Feed::InverseTime(rate) => 1.0 / rate,
            Feed::PerMinute(_) | Feed::PerTurn(_) => {
                let per_minute = lowering::feed_per_minute(feed, length, speed);
                if length <= STANDS {
                    return Ok((feed_mode::PER_MINUTE, per_minute));
                }
                length / per_minute
            }
        };
        let (least, axis) = turn.least(self.machine);
        let minutes = wanted.max(least);
        if wanted < least {
            self.slowed(&format!("{axis} goes no faster than its rapid"));
        }
        let counts = self.machine.settings.rotary_feed;
        let most = |word: WordName| {
            self.machine.words.get(word.name()).map_or(f64::INFINITY, |word| word.max)
        };
        let (mode, value, most) = match counts {
            // A block that is too short for inverse time may still have an F that counts.
            _ if inverse && (counts.is_none() || 1.0 / minutes <= most(WordName::FeedInverse)) => {
                (feed_mode::INVERSE_TIME, 1.0 / minutes, most(WordName::FeedInverse))
            }
            Some(counts) => {
                let value = counts.counted(turn.linear, turn.degrees) / minutes;
                (feed_mode::PER_MINUTE, value, most(WordName::F).min(self.machine.feed_max))
            }
            None => {
                let message = "rotary axes turn in a cut, the control has no inverse-time feed, and nobody says what F counts there";
                let help = "`rotary_feed = \"all-axes\"` in [settings] of the machine file where F counts a degree like a mm, \
                            `\"linear-axes\"` where it counts X, Y and Z alone";
                return Err(refuse(Rule::RotaryFeed, message).help(help).into());
            }
        };
        if value > most {
            self.slowed(&format!("F is {most} at the most"));
        }
        Ok((mode, value.min(most)))
    }

    /// The tip is slower than the source wants it.
    fn slowed(&mut self, why: &str) {
        let message =
            format!("the tip is slower than the feed of the source where rotary axes turn: {why}");
        self.findings.warn(Diagnostic::warning(Rule::FeedLimited, message).line(self.line));
    }
}

fn speed(spindle: Spindle) -> Option<f64> {
    match spindle {
        Spindle::Off => None,
        Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) => Some(speed),
    }
}
