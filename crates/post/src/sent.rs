//! What the control has been sent: the states that it is in behind the last block. What the value of a word is, the writer
//! keeps; here is what follows from blocks. A state that no block has set, or that a block leaves open, is not known.

use crate::cycles::Open;
use program::{Compensation, Coolant, Spindle};

/// The states that the control is in.
#[derive(Debug)]
pub(crate) struct Sent {
    spindle: Option<Spindle>,
    speed_changed: bool,
    coolant: Option<Coolant>,
    last_coolant: Coolant,
    compensation: Compensation,
    cycle: Option<Open>,
    looks_ahead: bool,
    path_tolerance: f64,
    clamps_closed: Option<bool>,
    length_register: Option<f64>,
    work_offset: usize,
    is_home: bool,
}

impl Sent {
    /// Behind `program_start`, which lets the control leave the path by `path_tolerance`, mm.
    pub(crate) fn at_start(path_tolerance: f64) -> Sent {
        Sent {
            spindle: Some(Spindle::Off),
            speed_changed: true,
            coolant: Some(Coolant::Off),
            last_coolant: Coolant::Off,
            compensation: Compensation::Off,
            cycle: None,
            looks_ahead: false,
            path_tolerance,
            clamps_closed: None,
            length_register: None,
            work_offset: 0,
            is_home: false,
        }
    }

    /// Whether the spindle is known to be in this state.
    #[inline]
    pub(crate) fn has_spindle(&self, spindle: Spindle) -> bool {
        self.spindle == Some(spindle)
    }

    /// The next block switches the spindle; `speed_changed` where its S differs from the last one.
    pub(crate) fn say_speed_change(&mut self, speed_changed: bool) {
        self.speed_changed = speed_changed;
    }

    /// Whether the speed was another than the one before when the spindle was last switched.
    pub(crate) fn speed_changed(&self) -> bool {
        self.speed_changed
    }

    /// The spindle has been switched. Whether it now has to run up: from a stand, from an unknown state, or the other
    /// way round.
    pub(crate) fn switch_spindle(&mut self, spindle: Spindle) -> bool {
        let before = self.spindle.replace(spindle);
        !matches!(
            (before, spindle),
            (_, Spindle::Off)
                | (Some(Spindle::Clockwise(_)), Spindle::Clockwise(_))
                | (Some(Spindle::CounterClockwise(_)), Spindle::CounterClockwise(_))
        )
    }

    /// Nobody knows whether the spindle turns: a block has left it open.
    pub(crate) fn lose_spindle(&mut self) {
        self.spindle = None;
    }

    /// Whether the coolant is known to be this one.
    #[inline]
    pub(crate) fn has_coolant(&self, coolant: Coolant) -> bool {
        self.coolant == Some(coolant)
    }

    /// The coolant that has been switched last, whether or not it still runs.
    pub(crate) fn last_coolant(&self) -> Coolant {
        self.last_coolant
    }

    /// Whether coolant has to go off before it becomes `next`: where another one may still run, some controls let both run
    /// (LinuxCNC), and others leave it to the builder (FANUC).
    pub(crate) fn mixes_coolant(&self, next: Coolant) -> bool {
        let goes_with = match (self.last_coolant, next) {
            (Coolant::Off, _) | (_, Coolant::Off) => true,
            (Coolant::Flood | Coolant::Mist, Coolant::FloodAndMist) => true,
            (last, next) => last == next,
        };
        !goes_with && !self.has_coolant(Coolant::Off)
    }

    /// The coolant has been switched.
    pub(crate) fn switch_coolant(&mut self, coolant: Coolant) {
        (self.coolant, self.last_coolant) = (Some(coolant), coolant);
    }

    /// The tool has been changed: the machine stops spindle and coolant for it.
    pub(crate) fn change_tool(&mut self) {
        (self.spindle, self.coolant) = (Some(Spindle::Off), Some(Coolant::Off));
    }

    /// The register of the length offset of the tool, where the control wants one.
    pub(crate) fn length_register(&self) -> Option<f64> {
        self.length_register
    }

    /// From the next tool change on the length offset has this register.
    pub(crate) fn set_length_register(&mut self, register: Option<f64>) {
        self.length_register = register;
    }

    /// The cutter compensation that is active.
    #[inline]
    pub(crate) fn compensation(&self) -> Compensation {
        self.compensation
    }

    /// The next block switches the compensation.
    pub(crate) fn switch_compensation(&mut self, compensation: Compensation) {
        self.compensation = compensation;
    }

    /// The definition of the cycle that is on.
    pub(crate) fn cycle(&self) -> Option<Open> {
        self.cycle
    }

    /// A cycle is on.
    pub(crate) fn define_cycle(&mut self, open: Open) {
        self.cycle = Some(open);
    }

    /// No cycle is on any more; the one that was.
    #[inline]
    pub(crate) fn end_cycle(&mut self) -> Option<Open> {
        self.cycle.take()
    }

    /// Look-ahead goes on or off. Whether that is a change.
    #[inline]
    pub(crate) fn look_ahead(&mut self, on: bool) -> bool {
        std::mem::replace(&mut self.looks_ahead, on) != on
    }

    /// How far the control may leave the path by the block that said so last, mm.
    #[inline]
    pub(crate) fn path_tolerance(&self) -> f64 {
        self.path_tolerance
    }

    /// The next block says how far the control may leave the path, mm.
    pub(crate) fn set_path_tolerance(&mut self, tolerance: f64) {
        self.path_tolerance = tolerance;
    }

    /// The clamps of the rotary axes close, or open. Whether that is a change, or may be one.
    pub(crate) fn clamp(&mut self, closed: bool) -> bool {
        self.clamps_closed.replace(closed) != Some(closed)
    }

    /// Whether a block has opened the clamps.
    pub(crate) fn clamps_are_open(&self) -> bool {
        self.clamps_closed == Some(false)
    }

    /// Entry of the code word `work_offset` that is active.
    #[inline]
    pub(crate) fn work_offset(&self) -> usize {
        self.work_offset
    }

    /// The next block selects this work offset.
    pub(crate) fn select_work_offset(&mut self, index: usize) {
        self.work_offset = index;
    }

    /// Whether Z is home: since a retract, or a tool change.
    pub(crate) fn is_home(&self) -> bool {
        self.is_home
    }

    /// Z has gone home, or away from there.
    #[inline]
    pub(crate) fn set_home(&mut self, is_home: bool) {
        self.is_home = is_home;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spindle_runs_up_from_a_stand_and_the_other_way_round() {
        let mut sent = Sent::at_start(0.01);
        assert!(sent.switch_spindle(Spindle::Clockwise(1000.0)));
        assert!(!sent.switch_spindle(Spindle::Clockwise(2000.0)));
        assert!(sent.switch_spindle(Spindle::CounterClockwise(2000.0)));
        sent.lose_spindle();
        assert!(
            sent.switch_spindle(Spindle::CounterClockwise(2000.0)),
            "nobody knows that it turns"
        );
        sent.change_tool();
        assert!(sent.has_spindle(Spindle::Off) && sent.has_coolant(Coolant::Off));
    }

    #[test]
    fn coolant_goes_off_before_another_that_it_would_run_with() {
        let mut sent = Sent::at_start(0.01);
        assert!(!sent.mixes_coolant(Coolant::Flood));
        sent.switch_coolant(Coolant::Flood);
        assert!(!sent.mixes_coolant(Coolant::FloodAndMist) && !sent.mixes_coolant(Coolant::Off));
        assert!(sent.mixes_coolant(Coolant::Mist) && sent.mixes_coolant(Coolant::Through));
        sent.change_tool();
        assert!(!sent.mixes_coolant(Coolant::Mist), "it is off");
    }

    #[test]
    fn clamps_that_no_block_has_moved_may_stand_either_way() {
        let mut sent = Sent::at_start(0.01);
        assert!(!sent.clamps_are_open());
        assert!(sent.clamp(false) && !sent.clamp(false) && sent.clamps_are_open());
        assert!(sent.clamp(true) && !sent.clamps_are_open());
    }
}
