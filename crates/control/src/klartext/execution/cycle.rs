//! Cycles: what `CYCL DEF` says, and how they are called.

use super::hole::RAPID_FEED;
use super::layout;
use super::state::cycle::{Defined, Definition};
use super::state::transforms::Transforms;
use super::state::{Control, Tip};
use crate::event::{Action, Risk};
use crate::kernel::Outcome;
use crate::klartext::language::functions::When;
use crate::klartext::language::registers::Parameter;
use crate::klartext::language::scan::{Scanner, Word};
use crate::klartext::language::words::{LINEAR, Words, slot};
use geom::Vec3;
use program::{Compensation, CycleKind, Diagnostic, Feed, PathMode, Rule, Spindle, WorkOffset};

/// Highest number of a cycle and of its parts.
const MOST: u32 = 999;

/// The parts `7` and `1` of `7.1`, or a number alone.
pub(crate) struct Designation {
    pub(crate) cycle: u32,
    pub(crate) part: Option<u32>,
}

impl Designation {
    pub(crate) fn read(s: &mut Scanner) -> Outcome<Designation> {
        s.is_done();
        let start = s.at();
        let cycle = s.digits(MOST)?;
        let mut complete = s.is_between_words();
        // Some write `9 .0`.
        let part = s.take_symbol(b".").then(|| s.digits(MOST)).transpose()?;
        if part.is_some() {
            complete = s.is_between_words();
        }
        if complete {
            return Ok(Designation { cycle, part });
        }
        Err(s.error(Rule::Syntax, (start, s.at()), "the number of a cycle is expected here"))
    }
}

impl Control<'_, '_> {
    /// The defined cycle that says by itself where its surface is.
    pub(super) fn definition(&self, s: &Scanner) -> Outcome<&Definition> {
        match &self.cycle {
            Some(Defined::Parameters(definition)) => Ok(definition),
            Some(Defined::Older(_)) => {
                let message =
                    "the older cycles start where the tool stands: they are not called at points";
                Err(s.error_block(Rule::Cycle, message))
            }
            None => Err(s.error_block(Rule::Cycle, "no cycle is defined yet")),
        }
    }

    /// `CYCL DEF 2xx NAME`, from behind the number up to its parameters.
    pub(crate) fn open_cycle(
        &self,
        s: &mut Scanner,
        number: u32,
        span: (usize, usize),
    ) -> Outcome<Definition> {
        let layout = layout::layout(number)
            .ok_or_else(|| s.error(Rule::Unsupported, span, layout::refusal(number)))?;
        while !matches!(s.peek(), [] | [b'Q', b'0'..=b'9', ..]) {
            s.token();
        }
        Ok(Definition { layout, given: Vec::with_capacity(16), unit: self.unit })
    }

    /// The parameters `Q200=+2` in one line of a cycle that is being read.
    pub(crate) fn cycle_line(&mut self, s: &mut Scanner, open: &mut Definition) -> Outcome {
        while !s.is_done() {
            let from = *s;
            let parameter = s.parameter()?;
            let (Some(Parameter::Global(q)), true) = (parameter, s.take_symbol(b"=")) else {
                let message = "a parameter of the cycle (Q200=...) is expected here";
                return Err(from.clone().error_here(Rule::Syntax, message));
            };
            let span = (from.at(), s.at());
            let known = open.layout.needs.contains(&q) || open.layout.takes.contains(&q);
            if !known {
                let message = format!("cycle {} has no parameter Q{q}", open.layout.number);
                return Err(s.error(Rule::CycleParameter, span, message));
            }
            if open.given.contains(&q) {
                return Err(s.error(Rule::RepeatedWord, span, format!("Q{q} is given twice")));
            }
            let value = match s.peek() {
                b"MAX" | b"FMAX" if matches!(q, 208 | 253) => {
                    s.token();
                    RAPID_FEED
                }
                _ => s.value(&self.registers)?,
            };
            open.given.push(q);
            let assigned = self.registers.assign(Parameter::Global(q), value);
            assigned.map_err(|message| s.error(Rule::CycleParameter, span, message))?;
        }
        Ok(())
    }

    /// The last parameter is read: the cycle is checked as a whole. 220, 221 and 247 act at once.
    pub(crate) fn close_cycle(&mut self, s: &Scanner, open: Definition) -> Outcome {
        let number = open.layout.number;
        if let Some(q) = open.layout.needs.iter().find(|q| !open.given.contains(q)) {
            let message = format!("cycle {number} lacks its parameter Q{q}");
            let help = "parameters stand in its line and, where that ends in ~, in the next ones";
            let error: Box<Diagnostic> = s.error_block(Rule::CycleParameter, message);
            return Err(error.help(help).into());
        }
        match number {
            247 => {
                let preset = open.hole(&self.registers).get(339);
                self.set_datum(s, preset)
            }
            220 | 221 => self.point_pattern(s, &open),
            208 => {
                let checked = open.hole(&self.registers).helix(None);
                self.keep(s, open, checked.map(|_| ()))
            }
            _ => {
                let checked = open.hole(&self.registers).cycle();
                self.keep(s, open, checked.map(|_| ()))
            }
        }
    }

    /// A cycle that is ready to be called, if it was `checked` well.
    fn keep(&mut self, s: &Scanner, open: Definition, checked: Result<(), String>) -> Outcome {
        checked.map_err(|message| {
            s.error_block(Rule::CycleParameter, format!("cycle {}: {message}", open.number()))
        })?;
        self.cycle = Some(Defined::Parameters(open));
        self.calls_modally = false;
        Ok(())
    }

    /// Cycle 247: a preset becomes the datum, and the datum shift ends.
    fn set_datum(&mut self, s: &Scanner, preset: f64) -> Outcome {
        if preset.fract() != 0.0 || !(0.0..=9999.0).contains(&preset) {
            return Err(s.error_block(Rule::CycleParameter, "Q339 is the number of a preset"));
        }
        if self.tilt.is_some() {
            return Err(s.error_block(Rule::TiltedPlane, "the datum is set in the untilted plane"));
        }
        if self.outside.is_more_than_a_shift() {
            let message =
                "what a preset does to mirrored, rotated or scaled coordinates is not known";
            return Err(s.error_block(Rule::Transformation, message));
        }
        self.outside = Transforms::default();
        self.forget_position();
        let Some(offset) = WorkOffset::at(preset as u32) else { return Ok(()) };
        self.emit(Action::WorkOffset(offset))
    }

    /// `CYCL CALL`, from behind it.
    pub(crate) fn cycle_call(&mut self, s: &mut Scanner) -> Outcome {
        if s.take(b"PAT") {
            return self.pattern_call(s);
        }
        if s.take(b"POS") {
            return self.cycle_call_at(s);
        }
        let words = Words::read(s, 0, self)?;
        self.functions(s, words.functions, When::Start)?;
        self.call_cycle(s)?;
        self.calls_modally = false;
        self.functions(s, words.functions, When::End)
    }

    /// `CYCL CALL POS X Y Z`: the tool goes there, first in the plane where it is above the surface;
    /// Z adds to the surface of the cycle.
    fn cycle_call_at(&mut self, s: &mut Scanner) -> Outcome {
        let words = Words::read(s, LINEAR, self)?;
        if !words.has_all(LINEAR) || words.is_incremental(LINEAR) {
            let message = "CYCL CALL POS needs X, Y and Z, absolute";
            return Err(s.error_block(Rule::MissingWord, message));
        }
        let at = |slot| words.target(slot, f64::NAN);
        self.functions(s, words.functions, When::Start)?;
        let rapid = self.set_feed(s, words.feed)?;
        if !rapid {
            let message = "CYCL CALL POS is approached with FMAX here";
            return Err(s.error_block(Rule::Unsupported, message));
        }
        let hole = self.definition(s)?.hole(&self.registers);
        let (surface, clearance) = (hole.surface() + at(slot::Z), hole.get(200));
        if self.here.z < surface {
            self.here.z = surface + clearance;
            self.emit(Action::Rapid(self.pose(self.here)))?;
        }
        self.here = Vec3::new(at(slot::X), at(slot::Y), self.here.z);
        self.emit(Action::Rapid(self.pose(self.here)))?;
        self.drill(s, at(slot::Z), None)?;
        self.functions(s, words.functions, When::End)
    }

    /// Runs the defined cycle where the tool stands.
    pub(super) fn call_cycle(&mut self, s: &Scanner) -> Outcome {
        self.drill(s, 0.0, None)
    }

    /// Runs the defined cycle where the tool stands, with its surface higher by `rise` mm; `level` is
    /// the height at which the tool ends where that is not the matter of the cycle.
    pub(super) fn drill(&mut self, s: &Scanner, rise: f64, level: Option<f64>) -> Outcome {
        if self.ended {
            return Err(s.error_block(Rule::Cycle, "no cycle is called where the program ends"));
        }
        self.may_call(s)?;
        if let Some(Defined::Parameters(definition)) = &self.cycle
            && definition.number() == 208
        {
            return self.mill_bore(s, rise, level);
        }
        let (cycle, point) = match &self.cycle {
            Some(Defined::Older(older)) if level.is_none() => {
                (older.cycle(), self.here.z - older.clearance())
            }
            _ => {
                let hole = self.definition(s)?.hole(&self.registers);
                (hole.cycle(), hole.point() + rise)
            }
        };
        let mut cycle = cycle.map_err(|message| s.error_block(Rule::CycleParameter, message))?;
        let risk = match &self.cycle {
            Some(Defined::Parameters(definition)) => definition.hole(&self.registers).risk(&cycle),
            Some(Defined::Older(_)) | None => None,
        };
        if let Some(risk) = risk {
            self.emit(Action::Risk(risk.into()))?;
        }
        if let Some(level) = level {
            cycle.retract = level - point;
        }
        if let Some(withdrawal) = cycle.kind.withdrawal() {
            if self.transforms().is_more_than_a_shift() {
                let message = "which way the tool goes aside is not known in mirrored, rotated or \
                               scaled coordinates";
                return Err(s.error_block(Rule::Transformation, message));
            }
            cycle.kind = cycle.kind.with_aside(self.work_direction(withdrawal.aside));
        }
        let running = match self.spindle {
            Spindle::Off => None,
            Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) => Some(speed),
        };
        // Cycle 206 gives the feed: the pitch is what the running spindle makes of it.
        if let (CycleKind::Tap { .. }, Some(Feed::PerMinute(feed))) = (cycle.kind, cycle.feed) {
            let Some(speed) = running.filter(|speed| *speed > 0.0) else {
                return Err(s.error_block(Rule::Spindle, "cycle 206 needs a turning spindle"));
            };
            let left = matches!(self.spindle, Spindle::CounterClockwise(_));
            cycle.kind = CycleKind::Tap { pitch: feed / speed, left };
        }
        let hole = self.cutting_pose(s, self.here.with_z(point))?;
        if self.reported != Some(cycle) {
            self.reported = Some(cycle);
            self.emit(Action::Cycle(Box::new(cycle)))?;
        }
        self.emit(Action::Hole(hole))?;
        self.here.z = point + cycle.retract;
        self.path = None;
        Ok(())
    }

    /// Whether a cycle can be called as things stand.
    fn may_call(&self, s: &Scanner) -> Outcome {
        if self.compensation != Compensation::Off {
            return Err(s.error_block(Rule::Cycle, "a cycle is called with R0"));
        }
        if self.per_turn {
            return Err(s.error_block(Rule::Cycle, "a cycle is not called while M136 is active"));
        }
        self.transforms_are_clear(s)?;
        if self.transforms().scales() {
            let message = "scaling changes the dimensions of cycles too, which is not followed";
            return Err(s.error_block(Rule::Transformation, message));
        }
        // The cycle drills along Z of the coordinates of the program.
        if self.tip != Tip::Free && self.tilt.is_none() && !self.stands_upright() {
            let message = "with M128 a cycle does not drill along an inclined tool";
            return Err(s.error_block(Rule::Cycle, message).help("use PLANE SPATIAL").into());
        }
        Ok(())
    }

    /// `CYCL DEF 7.0` and the like, from behind it; the name that follows says nothing.
    pub(crate) fn begin_cycle_parts(
        &self,
        s: &mut Scanner,
        cycle: u32,
        span: (usize, usize),
    ) -> Outcome {
        if matches!(cycle, 1 | 2 | 7..=11 | 17 | 19 | 26 | 32) {
            s.skip();
            return Ok(());
        }
        Err(s.error(Rule::Unsupported, span, layout::refusal(cycle)))
    }

    /// A numbered part of an older cycle: `7.1 X+60`, `9.1 DWELL 1.5`, `32.1 T0.01`.
    pub(crate) fn cycle_part(&mut self, s: &mut Scanner, cycle: u32, part: u32) -> Outcome {
        match (cycle, part) {
            (1 | 2 | 17, _) => {
                if let Some(older) = self.older_part(s, cycle, part)? {
                    self.cycle = Some(Defined::Older(older));
                    self.calls_modally = false;
                }
                Ok(())
            }
            (7, _) => self.datum_shift(s),
            (8, 1) => self.mirror(s),
            (9, 1) => self.dwell(s),
            (10, 1) => self.rotation(s),
            (11, 1) => self.scale(s),
            (19, 1) => self.working_plane(s),
            (26, 1) => self.axis_scale(s),
            (32, 1 | 2) => self.tolerance(s),
            _ => Err(s.error_block(Rule::CycleParameter, "the cycle has no such part")),
        }
    }

    /// `DWELL 1.5`, in whatever language: seconds.
    fn dwell(&mut self, s: &mut Scanner) -> Outcome {
        s.take_text();
        let seconds = s.value(&self.registers)?;
        s.finish()?;
        if seconds < 0.0 {
            return Err(s.error_block(Rule::Dwell, "a dwell is not negative"));
        }
        self.emit(Action::Dwell(seconds))
    }

    /// `FUNCTION DWELL TIME10`, from behind `DWELL`.
    pub(super) fn function_dwell(&mut self, s: &mut Scanner) -> Outcome {
        let seconds = s.take_symbol(b"TIME").then(|| s.value(&self.registers)).transpose()?;
        s.finish()?;
        match seconds.filter(|seconds| *seconds >= 0.0) {
            Some(seconds) => self.emit(Action::Dwell(seconds)),
            None => Err(s.error_block(Rule::Dwell, "FUNCTION DWELL takes TIME with seconds")),
        }
    }

    /// `T0.01`, by which the path may be left, or `HSC-MODE:1 TA0.5`, or nothing, which ends the tolerance.
    fn tolerance(&mut self, s: &mut Scanner) -> Outcome {
        let first = s.is_done();
        let mut mode = first.then_some(PathMode::AsSetUp);
        self.turns_unsaid &= !first;
        while !s.is_done() {
            if s.take(b"HSC-MODE:0") || s.take(b"HSC-MODE:1") {
                continue;
            }
            match s.word(&self.registers)? {
                Some(Word { address: b"T", number: Some(number), .. }) if number >= 0.0 => {
                    mode = Some(PathMode::Blend(number * self.unit));
                    self.turns_unsaid = number > 0.0;
                }
                Some(Word { address: b"TA", number: Some(degrees), .. }) if degrees >= 0.0 => {
                    self.turns_unsaid = false;
                    self.hold_orientation(degrees)?;
                }
                _ => {
                    let message = "cycle 32 takes T, HSC-MODE and TA";
                    return Err(s.error_block(Rule::CycleParameter, message));
                }
            }
        }
        mode.map_or(Ok(()), |mode| self.emit(Action::PathMode(mode)))
    }

    /// Tells where the control may turn the tool by so many degrees out of its orientation, which is more than it may.
    fn hold_orientation(&mut self, degrees: f64) -> Outcome {
        let turns = self.settings.rotary.contains(&true);
        if !turns || degrees <= self.settings.orientation_tolerance {
            return Ok(());
        }
        self.emit(Action::Risk(Risk::ORIENTATION_TOLERANCE.into()))
    }
}
