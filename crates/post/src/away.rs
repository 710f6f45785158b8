//! Away from the part: for a stop of the program, for a tool change and at the end; and back to it.

use crate::around::{ends_in_cut, stops_in_cut};
use crate::catalogue::{BlockName, WordName};
use crate::coordinate_mode::{Kind, Stop, rotary_word};
use crate::template::LENGTH_OFFSET;
use crate::walk::{Outcome, Walk, motion};
use crate::words::{Words, bit};
use machine::plan::Step;
use machine::{Mount, RotaryAxis};
use program::{Coolant, Diagnostic, Pose, Spindle};

/// How far the tool is drawn back along its axis before the control stops keeping its tip, mm.
pub(crate) const DRAWN_BACK: f64 = 5.0;

impl Walk<'_> {
    /// A stop, for which somebody opens the door, jogs, or puts his hands in: not every control stops spindle and coolant for it.
    /// So the tool goes home before it, both are off, and what the source does next begins at home.
    pub(crate) fn stop(&mut self, name: BlockName) -> Outcome {
        self.end_cycle()?;
        if self.wire.is_some() {
            return self.required(name);
        }
        if self.stands_in_cut() {
            return Err(stops_in_cut().into());
        }
        self.uncompensated("a stop")?;
        if let Some(back) = self.position.known() {
            self.leave_part()?;
            self.position.leave(Some(back));
        }
        self.halt()?;
        self.required(name)
    }

    /// Spindle and coolant off, where they are not known to be.
    fn halt(&mut self) -> Outcome {
        if !self.sent.has_spindle(Spindle::Off) {
            self.required(BlockName::SpindleOff)?;
            self.sent.switch_spindle(Spindle::Off);
        }
        if !self.sent.has_coolant(Coolant::Off) {
            self.required(BlockName::CoolantOff)?;
            self.sent.switch_coolant(Coolant::Off);
        }
        Ok(())
    }

    /// From home behind a stop back to where the tool has been, before a cut that begins there.
    pub(crate) fn come_back(&mut self, stop: Option<&Stop>) -> Outcome {
        let back = self.position.come_back();
        let (Some(back), Some(stop)) = (back, stop) else { return Ok(()) };
        let held = self.place.degrees().map(|degrees| Step { degrees, rewind: None });
        let held = Stop { step: held.or(stop.step), ..*stop };
        self.spindle_before(&back)?;
        self.settle(&back, &held, false)?;
        self.approach(&back, &held)
    }

    /// Whether the last motion of the source is a cut that has not drawn the tool back along its axis.
    fn stands_in_cut(&mut self) -> bool {
        self.around.stands_in_cut(&self.source().records, self.index)
    }

    pub(crate) fn warn_of_cut(&mut self, ends: &str) {
        if self.wire.is_none() && self.position.is_located() && self.stands_in_cut() {
            self.findings.warn(ends_in_cut(ends).line(self.line));
        }
    }

    /// Out of a cut along the tool axis, while the control keeps the tip: it gives the tip up a little off the wall.
    pub(crate) fn draw_back(&mut self) -> Outcome {
        let keeps_tip = matches!(self.place.kind, Kind::ToolCenter | Kind::Vectors);
        let tables = self.machine.rotary.iter().all(|rotary| rotary.on == Mount::Table);
        let Some(here) = self.position.known().filter(|_| keeps_tip && tables) else {
            return Ok(());
        };
        if !self.stands_in_cut() {
            return Ok(());
        }
        let out = here.at(here.point() + here.axis() * DRAWN_BACK)?;
        self.rapid_out(&out)
    }

    /// By rapid to a place from which the tool goes home, with the rotary axes as they stand.
    pub(crate) fn rapid_out(&mut self, out: &Pose) -> Outcome {
        let (mode, degrees) = (self.machine.orientation.positioned, self.place.degrees());
        let step = degrees.map(|degrees| Step { degrees, rewind: None });
        self.aim(out, &Stop { mode, turning: false, first: false, step });
        self.position.go_to(*out);
        self.check_limits()?;
        self.writer.code(WordName::Motion, motion::RAPID);
        self.keep_compensation();
        self.block(self.straight(BlockName::Rapid))
    }

    /// Where a rotary axis counts as not turned: 0, or on an axis without an end the nearest whole turn, to which nothing
    /// is unwound. `None` where the axis has no end and nobody knows where it stands.
    fn unturned(&self, axis: &RotaryAxis) -> Option<f64> {
        if axis.min.is_finite() || axis.max.is_finite() {
            return Some(0.0);
        }
        let turns = |degrees: [f64; 3]| (degrees[axis.index()] / 360.0).round() * 360.0;
        match self.place.degrees() {
            Some(degrees) => Some(turns(degrees)),
            None => (axis.on == Mount::Head).then_some(0.0),
        }
    }

    /// Degrees of A, B, C with the tool upright, where nothing is unwound.
    pub(crate) fn upright(&self) -> [f64; 3] {
        let mut upright = [0.0; 3];
        for axis in &self.machine.rotary {
            upright[axis.index()] = self.unturned(axis).unwrap_or(0.0);
        }
        upright
    }

    /// Turns the head upright for a tool change whose block does not place the words of its axes. Whether the axes are known
    /// to stand so behind the change.
    pub(crate) fn upright_for_tool(&mut self) -> Result<bool, Box<Diagnostic>> {
        let placed = |axis: &RotaryAxis| {
            self.templates.places(BlockName::ToolChange, rotary_word(axis.index()))
        };
        let machine = self.machine;
        let all_placed = machine.rotary.iter().all(placed);
        let by_hand = machine.rotary.iter().any(|axis| axis.on == Mount::Head && !placed(axis));
        if machine.tools.turns_upright || !by_hand {
            return Ok(all_placed);
        }
        if !self.sent.is_home() {
            self.plane_xy()?;
            self.required(BlockName::Retract)?;
            self.writer.forget(LENGTH_OFFSET);
            self.lose_position();
        }
        self.rotate(Some(self.upright()), false)?;
        Ok(true)
    }

    /// Says the rotary axes that the block `name` places, not turned. Whether one of them has to turn.
    pub(crate) fn say_unturned(&mut self, name: BlockName) -> bool {
        let mut words = Words::NONE;
        for axis in &self.machine.rotary {
            let word = rotary_word(axis.index());
            if let Some(degrees) = self.unturned(axis)
                && self.templates.places(name, word)
            {
                self.writer.set(word, degrees);
                words.add(word);
            }
        }
        self.writer.forget(bit(WordName::Motion));
        self.writer.code(WordName::Motion, motion::RAPID);
        self.writer.changes(words)
    }
}
