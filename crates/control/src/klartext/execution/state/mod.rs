//! What the control holds while a program runs, and how that becomes events.

pub(super) mod contour;
pub(super) mod cycle;
pub(in crate::klartext) mod older;
pub(super) mod tilt;
pub(super) mod transforms;

use super::layout::TENTH_INCH;
use crate::Settings;
use crate::ToolData;
use crate::event::{Action, Orientation, Position, Risk};
use crate::kernel::compensation::Terms;
use crate::kernel::coolant::{Coolants, Doubtful};
use crate::kernel::{Channel, Outcome};
use crate::klartext::language::feed::{FeedWord, Readable};
use crate::klartext::language::functions::{Function, Functions, When};
use crate::klartext::language::registers::Registers;
use crate::klartext::language::scan::Scanner;
use contour::{Element, Waiting};
use cycle::Defined;
use geom::Vec3;
use older::Older;
use program::{
    Auxiliary, Axes, Compensation, Coolant, CoolantFunctions, CoolantSwitch, Cycle, Feed, Rule,
    Spindle,
};
use tilt::Tilt;
use transforms::Transforms;

use std::collections::HashMap;

/// The address letters of the axes, in the order of their coordinates.
pub(super) const AXES: [char; 6] = ['X', 'Y', 'Z', 'A', 'B', 'C'];

/// Whether the control keeps the tool tip, and what the rotary words then mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tip {
    /// The words are positions of the axes, the tip goes where the kinematics take it.
    Free,
    /// `M128`, `FUNCTION TCPM ... AXIS POS`: rotary words are positions of the axes.
    Kept,
    /// `FUNCTION TCPM ... AXIS SPAT`: rotary words are spatial angles.
    KeptSpatial,
}

/// The state of the control.
pub(crate) struct Control<'a, 's> {
    pub(crate) settings: &'a Settings,
    channel: &'a mut Channel<'s>,
    /// Line of the block that runs.
    line: u32,
    /// mm in the unit of length of the program.
    pub(crate) unit: f64,
    /// Programmed position, mm: after datum shift and tilting, as the blocks count it. NaN where it
    /// is not known.
    pub(super) here: Vec3,
    /// Rotary positions (or spatial angles), degrees; NaN where they are not known.
    pub(super) degrees: [f64; 3],
    /// Tool vector of the last `LN` that gave one, in the coordinates of the block.
    pub(super) vector: Option<Vec3>,
    /// Transformations outside of a tilted plane.
    pub(super) outside: Transforms,
    pub(super) tilt: Option<Tilt>,
    pub(super) tip: Tip,
    /// `PATHCTRL VECTOR`: the tool turns on the great circle between its ends, and not as its axes turn evenly.
    pub(super) great_circle: bool,
    pub(super) feed: Option<Feed>,
    /// Feed of the last TOOL CALL, for `F AUTO`.
    pub(crate) tool_feed: Option<FeedWord>,
    /// Tools that the program itself defines, by number.
    pub(super) defined_tools: HashMap<u32, ToolData>,
    /// Number of the tool, where it is known.
    pub(super) tool_number: Option<u32>,
    /// Whether a tool has been called, and with it the tool axis.
    pub(super) has_tool: bool,
    /// Whether a tool has been called and nothing has been cut since.
    pub(super) tool_is_due: bool,
    /// Whether cycle 32 lets the path be left (`T`) and does not say by how much the tool may be turned (`TA`).
    pub(super) turns_unsaid: bool,
    /// Radius of the tool in the tool table, mm.
    pub(super) tool_radius: Option<f64>,
    pub(super) per_turn: bool,
    /// `M126`: rotary axes go the shorter way. `M127` and the end of the program end it.
    pub(super) shorter_way: bool,
    pub(super) compensation: Compensation,
    pub(super) speed: Option<f64>,
    pub(super) spindle: Spindle,
    pub(super) coolant: Coolant,
    /// Pole `CC`, mm.
    pub(super) pole: Option<(f64, f64)>,
    /// The MIN point of the blank, in the unit of the program as `Words` gives it, while its MAX point is to come.
    pub(super) blank_low: Option<Vec3>,
    /// The last motion, for those that go on in its direction.
    pub(super) path: Option<Element>,
    /// Whether the last positioning was at rapid.
    pub(super) rapid: bool,
    /// What is not reported before the next element of the contour is known.
    pub(super) waiting: Option<Waiting>,
    pub(super) cycle: Option<Defined>,
    /// An older hole cycle that is being defined.
    pub(super) older: Older,
    /// Points of the last `PATTERN DEF`, mm.
    pub(super) pattern: Vec<Vec3>,
    /// The cycle as it was reported last.
    pub(super) reported: Option<Cycle>,
    pub(super) calls_modally: bool,
    pub(crate) ended: bool,
    pub(crate) registers: Registers,
    /// How many called programs run within each other.
    called: usize,
}

impl Readable for Control<'_, '_> {
    fn registers(&self) -> &Registers {
        &self.registers
    }

    fn unit(&self) -> f64 {
        self.unit
    }

    fn tool_feed(&self) -> Option<FeedWord> {
        self.tool_feed
    }

    fn auxiliary(&self) -> &[u32] {
        &self.settings.auxiliary
    }

    fn coolant_functions(&self) -> CoolantFunctions {
        self.settings.coolant
    }
}

impl<'a, 's> Control<'a, 's> {
    pub(crate) fn new(settings: &'a Settings, channel: &'a mut Channel<'s>) -> Self {
        Control {
            settings,
            channel,
            line: 0,
            unit: 1.0,
            here: settings.setup.position_at_start(),
            degrees: settings.rotary.map(|exists| if exists { f64::NAN } else { 0.0 }),
            vector: None,
            outside: Transforms::default(),
            tilt: None,
            tip: Tip::Free,
            great_circle: false,
            feed: None,
            tool_feed: None,
            defined_tools: HashMap::new(),
            tool_number: None,
            has_tool: false,
            tool_is_due: false,
            turns_unsaid: false,
            tool_radius: None,
            per_turn: false,
            shorter_way: false,
            compensation: Compensation::Off,
            speed: None,
            spindle: Spindle::Off,
            coolant: Coolant::Off,
            pole: None,
            path: None,
            blank_low: None,
            rapid: false,
            waiting: None,
            cycle: None,
            older: Older::default(),
            pattern: Vec::new(),
            reported: None,
            calls_modally: false,
            ended: false,
            registers: Registers::new(),
            called: 0,
        }
    }

    /// The events from here on come from `line` of the main program.
    pub(crate) fn at_line(&mut self, line: u32) {
        if self.called == 0 {
            self.line = line;
        }
        self.settings.setup.flatten(&mut self.here);
    }

    pub(crate) fn emit(&mut self, action: Action) -> Outcome {
        self.channel.report(self.line, action)
    }

    /// A jump, a call or a return, after which so many bytes are read again: programs that never end
    /// are refused.
    pub(crate) fn count_jump(&mut self, s: &Scanner, bytes: usize) -> Outcome {
        let counted = self.channel.budget.again(bytes);
        counted.map_err(|message| s.error_block(Rule::Endless, message))
    }

    /// A called program begins; answers how many there are within each other.
    pub(crate) fn enter_program(&mut self) -> usize {
        self.called += 1;
        self.called
    }

    /// A called program has ended.
    pub(crate) fn leave_program(&mut self) {
        self.called -= 1;
    }

    /// Whether the program that runs is a called one.
    pub(crate) fn is_called(&self) -> bool {
        self.called > 0
    }

    /// The unit of length of the program that runs, in mm.
    pub(crate) fn set_unit(&mut self, unit: f64) {
        self.unit = unit;
        if self.called == 0 {
            self.registers.preassign(113, f64::from(unit != 1.0));
        }
    }

    /// The pose of the tool at a programmed position.
    pub(super) fn pose(&self, programmed: Vec3) -> Position {
        Position { point: self.work_point(programmed), orientation: self.orientation() }
    }

    /// A programmed position in the work frame.
    pub(super) fn work_point(&self, programmed: Vec3) -> Vec3 {
        self.outside.apply(match &self.tilt {
            None => programmed,
            Some(tilt) => tilt.turn * tilt.inside.apply(programmed),
        })
    }

    /// A programmed direction in the work frame.
    pub(super) fn work_direction(&self, programmed: Vec3) -> Vec3 {
        self.outside.direct(match &self.tilt {
            None => programmed,
            Some(tilt) => tilt.turn * tilt.inside.direct(programmed),
        })
    }

    /// Whether the coordinates of the blocks are mirrored.
    pub(super) fn mirrors(&self) -> bool {
        self.outside.mirrors() != self.tilt.as_ref().is_some_and(|tilt| tilt.inside.mirrors())
    }

    fn orientation(&self) -> Orientation {
        if let Some(vector) = self.vector {
            return Orientation::Axis(self.work_direction(vector));
        }
        match &self.tilt {
            Some(tilt) if tilt.turned => Orientation::Axis(tilt.turn.z_axis),
            // The rotary axes were put by words into a plane that is only declared: the control
            // reckons with where they stand.
            Some(_) => Orientation::Rotary { degrees: self.degrees, tool_center: true },
            None if self.tip == Tip::KeptSpatial => {
                Orientation::Axis(tilt::spatial(self.degrees).z_axis)
            }
            None => {
                Orientation::Rotary { degrees: self.degrees, tool_center: self.tip == Tip::Kept }
            }
        }
    }

    /// Whether the tool stands along Z of the coordinates that the blocks give.
    pub(super) fn stands_upright(&self) -> bool {
        match &self.tilt {
            Some(tilt) => tilt.turned,
            None => self.vector.is_none() && self.degrees == [0.0; 3],
        }
    }

    /// Whether the tool may stand otherwise than along Z of the machine: an axis of the head may have turned.
    fn may_lean_in_head(&self) -> bool {
        let stands = self.vector.is_none() && self.tilt.is_none() && self.tip != Tip::KeptSpatial;
        let (rotary, table) = (self.settings.rotary, self.settings.table);
        (0..3).any(|i| rotary[i] && !table[i] && !(stands && self.degrees[i] == 0.0))
    }

    /// The position of the linear axes is not known any more.
    pub(super) fn forget_position(&mut self) {
        self.here = Vec3::NAN;
    }

    /// The positions of the rotary axes are not known any more.
    pub(super) fn forget_rotary(&mut self) {
        self.vector = None;
        self.degrees = self.settings.rotary.map(|exists| if exists { f64::NAN } else { 0.0 });
    }

    /// mm/min (or mm a turn) of a number behind F.
    pub(super) fn feed_value(&self, number: f64) -> f64 {
        match (self.unit == 1.0, self.per_turn) {
            (true, _) => number,
            (false, true) => number * self.unit,
            (false, false) => number * TENTH_INCH,
        }
    }

    /// Takes over the F word of a block; answers whether the block is a rapid.
    pub(super) fn set_feed(&mut self, s: &Scanner, word: Option<FeedWord>) -> Outcome<bool> {
        let feed = match word {
            None => return Ok(false),
            Some(FeedWord::Max) => return Ok(true),
            Some(FeedWord::Value(number)) if self.per_turn => {
                Feed::PerTurn(self.feed_value(number))
            }
            Some(FeedWord::Value(number)) => Feed::PerMinute(self.feed_value(number)),
            Some(FeedWord::PerTurn(_)) if self.per_turn => {
                return Err(s.error_block(Rule::Feed, "FU is not permitted while M136 is active"));
            }
            Some(FeedWord::PerTurn(number)) => Feed::PerTurn(number * self.unit),
        };
        self.take_feed(feed)?;
        Ok(false)
    }

    pub(super) fn set_spindle(&mut self, spindle: Spindle) -> Outcome {
        let code = match (spindle, self.spindle) {
            (Spindle::Clockwise(_), _) => Some(0.0),
            (Spindle::CounterClockwise(_), _) => Some(1.0),
            (Spindle::Off, Spindle::Clockwise(_)) => Some(2.0),
            (Spindle::Off, Spindle::CounterClockwise(_)) => Some(3.0),
            (Spindle::Off, Spindle::Off) => None,
        };
        if let Some(code) = code {
            self.registers.preassign(110, code);
        }
        if self.spindle != spindle {
            self.spindle = spindle;
            self.emit(Action::Spindle(spindle))?;
        }
        Ok(())
    }

    /// How the coolants of the machine go with each other.
    pub(super) fn coolants(&self) -> Coolants {
        Coolants { functions: self.settings.coolant, adds: false, ends_through: None }
    }

    fn switch_coolant(&mut self, s: &Scanner, switch: CoolantSwitch) -> Outcome {
        let doubt = |doubt: Doubtful| s.error_block(Rule::Coolant, doubt.message).help(doubt.help);
        self.set_coolant(self.coolants().behind(self.coolant, switch).map_err(doubt)?)
    }

    fn set_coolant(&mut self, coolant: Coolant) -> Outcome {
        self.registers.preassign(111, f64::from(coolant != Coolant::Off));
        if self.coolant != coolant {
            self.coolant = coolant;
            self.emit(Action::Coolant(coolant))?;
        }
        Ok(())
    }

    pub(super) fn set_compensation(&mut self, compensation: Compensation) -> Outcome {
        if self.compensation == compensation {
            return Ok(());
        }
        self.compensation = compensation;
        // What is left in mirrored coordinates is right of the path that is reported.
        let side = match (compensation, self.mirrors()) {
            (Compensation::Left(_), true) => Compensation::Right(None),
            (Compensation::Right(_), true) => Compensation::Left(None),
            _ => compensation,
        };
        let terms = Terms {
            normal: self.work_direction(Vec3::Z).normalize_or(Vec3::Z),
            across_tool: true,
            radius: None,
            outer: None,
            around: false,
        };
        self.channel.switch(self.line, side, terms)
    }

    /// Does the M functions of a block that act at that moment.
    pub(crate) fn functions(&mut self, s: &Scanner, all: Functions, when: When) -> Outcome {
        if all.is_empty() {
            return Ok(());
        }
        for function in all.at(when) {
            self.function(s, function)?;
        }
        Ok(())
    }

    fn function(&mut self, s: &Scanner, function: Function) -> Outcome {
        if self.ended {
            return Err(
                s.error_block(Rule::ProgramFrame, "nothing may follow M2 or M30 in its block")
            );
        }
        match function {
            Function::Clockwise { coolant } => {
                let speed = self.needs_speed(s)?;
                self.set_spindle(Spindle::Clockwise(speed))?;
                coolant.map_or(Ok(()), |coolant| self.switch_coolant(s, coolant))
            }
            Function::CounterClockwise { coolant } => {
                let speed = self.needs_speed(s)?;
                self.set_spindle(Spindle::CounterClockwise(speed))?;
                coolant.map_or(Ok(()), |coolant| self.switch_coolant(s, coolant))
            }
            Function::SpindleStop => self.set_spindle(Spindle::Off),
            Function::ToolChange if !self.tool_is_due => {
                let message = "M6 without a TOOL CALL since the last cut: it stops the program or changes to a tool that nobody has called";
                let help = "call the tool before it, or leave M6 out";
                Err(s.error_block(Rule::MFunction, message).help(help).into())
            }
            Function::ToolChange => self.set_spindle(Spindle::Off),
            Function::Coolant(switch) => self.switch_coolant(s, switch),
            Function::Stop => {
                // On every TNC it stops the spindle; the coolant on the older ones (TNC 360, 640: "M0").
                self.stops_while(self.coolant != Coolant::Off)?;
                self.emit(Action::Stop)?;
                self.stop_all()
            }
            Function::ProgramStop => {
                self.stops_while(self.spindle != Spindle::Off || self.coolant != Coolant::Off)?;
                self.emit(Action::Stop)
            }
            Function::OptionalStop => {
                self.stops_while(self.spindle != Spindle::Off || self.coolant != Coolant::Off)?;
                self.emit(Action::OptionalStop)?;
                self.stop_all()
            }
            Function::End if self.is_called() => {
                let message = "a called program ends with END PGM: M2 and M30 would end all";
                Err(s.error_block(Rule::ProgramFrame, message))
            }
            Function::End => {
                self.report_left_on()?;
                self.stop_all()?;
                self.finish()
            }
            Function::KeepTip => {
                self.great_circle = false;
                self.keep_tip(s, Tip::Kept)
            }
            Function::ReleaseTip => {
                self.release_tip();
                Ok(())
            }
            Function::FeedPerTurn(per_turn) => {
                // F keeps its number but not its meaning: it has to be given anew.
                if self.per_turn != per_turn {
                    self.per_turn = per_turn;
                    self.feed = None;
                }
                Ok(())
            }
            Function::ShorterWay(on) => {
                self.shorter_way = on;
                Ok(())
            }
            Function::Retract(distance, feed) => self.retract(s, distance, feed),
            Function::CallCyclesModally => {
                self.calls_modally = true;
                self.call_cycle(s)
            }
            Function::CallCycle => {
                self.calls_modally = false;
                self.call_cycle(s)
            }
            Function::Auxiliary(number) => self.emit(Action::Auxiliary(Auxiliary::of(number))),
            Function::MonitoringOff => self.emit(Action::Risk(Risk::MONITORING_OFF.into())),
            Function::ReplacesTool => self.emit(Action::Risk(Risk::REPLACEMENT_TOOL.into())),
            Function::LiftsOff => self.emit(Action::Risk(Risk::STOP_RETRACT.into())),
            Function::MachineCoordinates { .. } | Function::Nothing => Ok(()),
        }
    }

    /// Tells of a stop while something may be running.
    fn stops_while(&mut self, running: bool) -> Outcome {
        if running { self.emit(Action::Risk(Risk::STOP_RUNNING.into())) } else { Ok(()) }
    }

    /// Spindle and coolant off: what a stop of the program, its end and a tool change bring.
    pub(super) fn stop_all(&mut self) -> Outcome {
        self.set_spindle(Spindle::Off)?;
        self.set_coolant(self.coolants().behind_reset(self.coolant))
    }

    fn needs_speed(&self, s: &Scanner) -> Outcome<f64> {
        self.speed.ok_or_else(|| {
            s.error_block(Rule::Spindle, "the spindle has no speed yet: no S before")
        })
    }

    /// Back along the tool axis by `distance` mm; infinite is to the end of the travel.
    fn retract(&mut self, s: &Scanner, distance: f64, feed: Option<FeedWord>) -> Outcome {
        if !self.has_tool {
            let message =
                "M140 before the first TOOL CALL: along which axis it goes is not defined";
            return Err(s.error_block(Rule::MFunction, message).help("call the tool first").into());
        }
        if distance.is_infinite() {
            if self.may_lean_in_head() {
                self.emit(Action::Risk(Risk::LEANING_RETRACT.into()))?;
            }
            self.emit(Action::Home(Axes::Z))?;
            if self.tilt.is_none() && self.stands_upright() {
                self.here.z = f64::NAN;
            } else {
                self.forget_position();
            }
            return Ok(());
        }
        let axis = match self.vector {
            Some(vector) => vector,
            None if self.stands_upright() => Vec3::Z,
            None => {
                let message = "the direction of the tool axis is not known";
                return Err(s.error_block(Rule::MFunction, message).help("use M140 MB MAX").into());
            }
        };
        self.here += axis * distance;
        let pose = self.pose(self.here);
        if matches!(feed, None | Some(FeedWord::Max)) {
            return self.emit(Action::Rapid(pose));
        }
        let path = self.feed;
        self.set_feed(s, feed)?;
        self.emit(Action::Line(pose))?;
        self.feed = path;
        path.map_or(Ok(()), |feed| self.emit(Action::Feed(feed)))
    }

    /// `END PGM` of a program without `M2` and `M30`. No manual says that it stops the spindle and the coolant.
    pub(crate) fn end(&mut self) -> Outcome {
        self.report_left_on()?;
        self.finish()
    }

    /// The end of the program.
    fn finish(&mut self) -> Outcome {
        self.ended = true;
        self.emit(Action::End)
    }

    /// `FN 18: SYSREAD`, from behind its `=`: `ID270 NR1 IDX1`. Lengths are mm in every program.
    pub(crate) fn system_datum(&self, s: &mut Scanner) -> Outcome<f64> {
        let from = *s;
        let [mut id, mut number, mut index] = [None; 3];
        while let Some(word) = s.word(&self.registers)? {
            match word.address {
                b"ID" => id = word.number,
                b"NR" => number = word.number,
                b"IDX" => index = word.number,
                _ => return Err(crate::klartext::language::feed::unknown(s, &word)),
            }
        }
        let axis = index.and_then(|index| (0..3usize).find(|i| *i as f64 + 1.0 == index));
        let whole = |value: Option<f64>| value.filter(|v| v.fract() == 0.0).map(|v| v as i64);
        let known = match (whole(id), whole(number), axis) {
            (Some(20), Some(1), _) => self.tool_number.map(f64::from),
            (Some(210), Some(2), _) => Some(self.transforms().rotation()),
            (Some(220), Some(2), Some(axis)) => Some(self.transforms().shift()[axis]),
            (Some(270), Some(1), Some(axis)) => Some(self.here[axis]),
            (Some(280), Some(1), _) => Some(if self.tip == Tip::Free { 0.0 } else { -1.0 }),
            _ => {
                let message = "this datum of the control is not supported";
                return Err(s.error(Rule::Parameter, (from.at(), s.at()), message));
            }
        };
        known.filter(|value| value.is_finite()).ok_or_else(|| {
            let message = "what it is depends on what the operator or the machine has done";
            let error = s.error(Rule::Parameter, (from.at(), s.at()), message);
            error.help("write the value that it had at the machine in its place").into()
        })
    }
}
