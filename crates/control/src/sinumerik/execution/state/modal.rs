//! What `MCALL` has, and a cycle that is ready to drill.

use crate::event::Risk;
use crate::sinumerik::language::statement::ProgramCall;
use program::{Cycle, Spindle};

/// What `MCALL` has after each block with a motion.
pub(crate) enum Modal {
    None,
    /// A cycle.
    Cycle(Drilling),
    /// A program.
    Program(ProgramCall),
    /// A program; the block that moved has just been.
    Due(ProgramCall),
    /// A program that runs; its own blocks do not call it.
    Running,
}

impl Modal {
    /// Whether the next motion has something behind it.
    pub(crate) fn waits(&self) -> bool {
        matches!(self, Modal::Cycle(_) | Modal::Program(_))
    }
}

/// How long a pause lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Pause {
    /// Seconds.
    Seconds(f64),
    /// Turns of the spindle.
    Turns(f64),
}

impl Pause {
    /// `DTB` and its kin: positive seconds, negative turns.
    pub fn signed(value: f64) -> Pause {
        if value < 0.0 { Pause::Turns(-value) } else { Pause::Seconds(value) }
    }

    /// Seconds at a spindle speed (1/min); nothing where turns are asked of a spindle that stands.
    pub fn seconds(self, spindle: Spindle) -> Option<f64> {
        match (self, spindle) {
            (Pause::Seconds(seconds), _) => Some(seconds),
            (Pause::Turns(turns), Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed))
                if speed > 0.0 =>
            {
                Some(turns / speed * 60.0)
            }
            _ => None,
        }
    }
}

/// A cycle that is ready to drill. Heights and ways in mm in the program's coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drilling {
    /// What happens, but for the dwell.
    pub cycle: Cycle,
    /// Dwell at the bottom.
    pub dwell: Pause,
    /// Height of the reference plane.
    pub surface: f64,
    /// What the cycle makes of the spindle before it drills.
    pub spindle_before: Option<Spindle>,
    /// What the cycle makes of the spindle afterwards.
    pub spindle_after: Option<Spindle>,
    /// Whether it drills at the active feed.
    pub needs_feed: bool,
    /// What the call asks for that a source cannot say.
    pub risks: Vec<Risk>,
}
