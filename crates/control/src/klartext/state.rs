//! What the control holds while a program runs, and how that becomes records.

use super::cycle::Definition;
use super::functions::{Function, Functions, When};
use super::plane::Tilt;
use super::scan::{Result, Scanner};
use super::words::FeedWord;
use crate::Settings;
use crate::compensation::{Compensator, Terms};
use geom::Vec3;
use program::{
    Compensation, Coolant, Cycle, CycleKind, Feed, Op, Orientation, Pose, Record, Spindle,
};

/// The address letters of the axes, in the order of their coordinates.
pub(super) const AXES: [char; 6] = ['X', 'Y', 'Z', 'A', 'B', 'C'];

/// mm/min in the unit of F of an inch program, a tenth of an inch each minute.
pub(super) const TENTH_INCH: f64 = 2.54;

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
pub(super) struct Control<'a, 's> {
    pub(super) settings: &'a Settings,
    path: &'a mut Compensator<'s>,
    /// Line of the block that runs.
    line: u32,
    /// mm in the unit of length of the program.
    pub(super) unit: f64,
    /// Programmed position, mm: after datum shift and tilting, as the blocks count it. NaN where it
    /// is not known.
    pub(super) here: Vec3,
    /// Rotary positions (or spatial angles), degrees; NaN where they are not known.
    pub(super) degrees: [f64; 3],
    /// Tool vector of the last `LN` that gave one, in the coordinates of the block.
    pub(super) vector: Option<Vec3>,
    /// Datum shift of cycle 7, mm, in the untilted frame.
    pub(super) shift: Vec3,
    pub(super) tilt: Option<Tilt>,
    pub(super) tip: Tip,
    pub(super) feed: Option<Feed>,
    pub(super) per_turn: bool,
    pub(super) compensation: Compensation,
    pub(super) speed: Option<f64>,
    pub(super) spindle: Spindle,
    pub(super) coolant: Coolant,
    /// Pole `CC`, mm.
    pub(super) pole: Option<(f64, f64)>,
    pub(super) cycle: Option<Definition>,
    /// The cycle as it was told last.
    told: Option<Cycle>,
    pub(super) calls_modally: bool,
    pub(super) ended: bool,
}

impl<'a, 's> Control<'a, 's> {
    pub(super) fn new(settings: &'a Settings, path: &'a mut Compensator<'s>, unit: f64) -> Self {
        Control {
            settings,
            path,
            line: 0,
            unit,
            here: Vec3::NAN,
            degrees: settings.rotary.map(|exists| if exists { f64::NAN } else { 0.0 }),
            vector: None,
            shift: Vec3::ZERO,
            tilt: None,
            tip: Tip::Free,
            feed: None,
            per_turn: false,
            compensation: Compensation::Off,
            speed: None,
            spindle: Spindle::Off,
            coolant: Coolant::Off,
            pole: None,
            cycle: None,
            told: None,
            calls_modally: false,
            ended: false,
        }
    }

    /// The records from here on come from `line`.
    pub(super) fn at_line(&mut self, line: u32) {
        self.line = line;
    }

    pub(super) fn emit(&mut self, op: Op) -> Result<()> {
        self.path.take(Record { line: self.line, op })
    }

    /// The pose of the tool at a programmed position.
    pub(super) fn pose(&self, programmed: Vec3) -> Pose {
        Pose { point: self.work_point(programmed), orientation: self.orientation() }
    }

    /// A programmed position in the work frame.
    pub(super) fn work_point(&self, programmed: Vec3) -> Vec3 {
        match &self.tilt {
            None => programmed + self.shift,
            Some(tilt) => tilt.turn * (programmed + tilt.shift) + self.shift,
        }
    }

    /// A programmed direction in the work frame.
    pub(super) fn work_direction(&self, programmed: Vec3) -> Vec3 {
        self.tilt.as_ref().map_or(programmed, |tilt| tilt.turn * programmed)
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
                Orientation::Axis(super::plane::spatial(self.degrees).z_axis)
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
    pub(super) fn set_feed(&mut self, s: &Scanner, word: Option<FeedWord>) -> Result<bool> {
        let feed = match word {
            None => return Ok(false),
            Some(FeedWord::Max) => return Ok(true),
            Some(FeedWord::Value(number)) if self.per_turn => {
                Feed::PerTurn(self.feed_value(number))
            }
            Some(FeedWord::Value(number)) => Feed::PerMinute(self.feed_value(number)),
            Some(FeedWord::PerTurn(_)) if self.per_turn => {
                return Err(s.error_block("feed", "FU is not permitted while M136 is active"));
            }
            Some(FeedWord::PerTurn(number)) => Feed::PerTurn(number * self.unit),
        };
        if self.feed != Some(feed) {
            self.feed = Some(feed);
            self.emit(Op::Feed(feed))?;
        }
        Ok(false)
    }

    pub(super) fn set_spindle(&mut self, spindle: Spindle) -> Result<()> {
        if self.spindle != spindle {
            self.spindle = spindle;
            self.emit(Op::Spindle(spindle))?;
        }
        Ok(())
    }

    pub(super) fn set_coolant(&mut self, coolant: Coolant) -> Result<()> {
        if self.coolant != coolant {
            self.coolant = coolant;
            self.emit(Op::Coolant(coolant))?;
        }
        Ok(())
    }

    pub(super) fn set_compensation(&mut self, compensation: Compensation) -> Result<()> {
        if self.compensation != compensation {
            self.compensation = compensation;
            // The plane of work is that of the tool.
            let normal = self.tilt.map_or(Vec3::Z, |tilt| tilt.turn * Vec3::Z);
            let (radius, outer) = (None, None);
            let terms = Terms { normal, tool_axis: normal, radius, outer, around: false };
            self.path.switch(self.line, compensation, terms)?;
        }
        Ok(())
    }

    /// Does the M functions of a block that act at that moment.
    pub(super) fn functions(&mut self, s: &Scanner, all: Functions, when: When) -> Result<()> {
        for function in all.at(when) {
            self.function(s, function)?;
        }
        Ok(())
    }

    fn function(&mut self, s: &Scanner, function: Function) -> Result<()> {
        if self.ended {
            return Err(s.error_block("program-frame", "nothing may follow M2 or M30 in its block"));
        }
        match function {
            Function::Clockwise { coolant } => {
                let speed = self.needs_speed(s)?;
                self.set_spindle(Spindle::Clockwise(speed))?;
                if coolant { self.set_coolant(Coolant::Flood) } else { Ok(()) }
            }
            Function::CounterClockwise { coolant } => {
                let speed = self.needs_speed(s)?;
                self.set_spindle(Spindle::CounterClockwise(speed))?;
                if coolant { self.set_coolant(Coolant::Flood) } else { Ok(()) }
            }
            Function::SpindleStop => self.set_spindle(Spindle::Off),
            Function::Coolant => self.set_coolant(Coolant::Flood),
            Function::CoolantOff => self.set_coolant(Coolant::Off),
            Function::Stop => {
                self.emit(Op::Stop)?;
                self.stop_all()
            }
            Function::OptionalStop => {
                self.emit(Op::OptionalStop)?;
                self.stop_all()
            }
            Function::End => self.end(),
            Function::KeepTip => self.keep_tip(s, Tip::Kept),
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
            Function::Retract(distance, feed) => self.retract(s, distance, feed),
            Function::CallCyclesModally => {
                self.calls_modally = true;
                self.call_cycle(s)
            }
            Function::CallCycle => {
                self.calls_modally = false;
                self.call_cycle(s)
            }
            Function::MachineCoordinates | Function::RotaryWay | Function::Auxiliary => Ok(()),
        }
    }

    /// Spindle and coolant off: what a stop of the program, its end and a tool change bring.
    pub(super) fn stop_all(&mut self) -> Result<()> {
        self.set_spindle(Spindle::Off)?;
        self.set_coolant(Coolant::Off)
    }

    fn needs_speed(&self, s: &Scanner) -> Result<f64> {
        self.speed
            .ok_or_else(|| s.error_block("spindle", "the spindle has no speed yet: no S before"))
    }

    /// Back along the tool axis by `distance` mm; infinite is to the end of the travel.
    fn retract(&mut self, s: &Scanner, distance: f64, feed: Option<FeedWord>) -> Result<()> {
        if distance.is_infinite() {
            self.emit(Op::Home(0b100))?;
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
                return Err(s.error_block("m-function", message).help("use M140 MB MAX").into());
            }
        };
        self.here += axis * distance;
        let pose = self.pose(self.here);
        if matches!(feed, None | Some(FeedWord::Max)) {
            return self.emit(Op::Rapid(pose));
        }
        let path = self.feed;
        self.set_feed(s, feed)?;
        self.emit(Op::Line(pose))?;
        self.feed = path;
        path.map_or(Ok(()), |feed| self.emit(Op::Feed(feed)))
    }

    /// Runs the defined cycle where the tool stands.
    pub(super) fn call_cycle(&mut self, s: &Scanner) -> Result<()> {
        if self.ended {
            return Err(s.error_block("cycle", "no cycle is called where the program ends"));
        }
        let Some(definition) = &self.cycle else {
            return Err(s.error_block("cycle", "no cycle is defined yet"));
        };
        let (mut cycle, surface) = (definition.cycle, definition.surface);
        if self.compensation != Compensation::Off {
            return Err(s.error_block("cycle", "a cycle is called with R0"));
        }
        if self.per_turn {
            return Err(s.error_block("cycle", "a cycle is not called while M136 is active"));
        }
        let running = match self.spindle {
            Spindle::Off => None,
            Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) => Some(speed),
        };
        // Cycle 206 gives the feed: the pitch is what the running spindle makes of it.
        if let (CycleKind::Tap { .. }, Some(Feed::PerMinute(feed))) = (cycle.kind, cycle.feed) {
            let Some(speed) = running.filter(|speed| *speed > 0.0) else {
                return Err(s.error_block("spindle", "cycle 206 needs a turning spindle"));
            };
            let left = matches!(self.spindle, Spindle::CounterClockwise(_));
            cycle.kind = CycleKind::Tap { pitch: feed / speed, left };
        }
        // The cycle drills along Z of the coordinates of the program.
        if self.tip != Tip::Free && self.tilt.is_none() && !self.stands_upright() {
            let message = "with M128 a cycle does not drill along an inclined tool";
            return Err(s.error_block("cycle", message).help("use PLANE SPATIAL").into());
        }
        let hole = self.cutting_pose(s, self.here.with_z(surface))?;
        if self.told != Some(cycle) {
            self.told = Some(cycle);
            self.emit(Op::Cycle(Box::new(cycle)))?;
        }
        self.emit(Op::Hole(hole))?;
        self.here.z = surface + cycle.retract;
        Ok(())
    }
}
