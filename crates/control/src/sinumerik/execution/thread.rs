//! Threads by G command: `G33`, `G331`, `G332`, `G63`.

use super::interpreter::Interpreter;
use crate::event::{Action, Thread};
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use crate::sinumerik::language::block::Block;
use crate::sinumerik::language::commands::Motion;
use program::{Rule, Spindle};

impl Interpreter<'_, '_> {
    /// `G33`, `G331`, `G332`: a straight way along one axis in step with the spindle; `I J K` is the pitch
    /// along X, Y, Z.
    #[cold]
    pub fn thread(&mut self, source: &Source, block: &Block) -> Outcome {
        let error = |message: &str| Err(source.block_error(Rule::Thread, message));
        let motion = self.state.motion;
        if block.has_rotary() || block.has_vector() || block.has_polar() {
            return error("a thread runs along X, Y or Z");
        }
        self.check_free(source, "a thread")?;
        let mut along = (0..3).filter(|i| block.axes[*i].is_some());
        let (Some(axis), None) = (along.next(), along.next()) else {
            return error("a thread along more than one axis is not supported");
        };
        let pitches = block.center.iter().enumerate().filter(|(_, pitch)| pitch.is_some());
        if pitches.clone().any(|(i, _)| i != axis) {
            return error("the pitch is I for X, J for Y, K for Z");
        }
        if let Some(coordinate) = block.center[axis] {
            self.state.pitch = Some(coordinate.value * self.state.unit);
        }
        let Some(pitch) = self.state.pitch.filter(|pitch| *pitch != 0.0) else {
            return error("the thread has no pitch: give I, J or K");
        };
        let speed = self.state.speed.unwrap_or(0.0);
        let spindle = match (motion, pitch > 0.0) {
            (Motion::TapIn, true) | (Motion::TapOut, false) => Some(Spindle::Clockwise(speed)),
            (Motion::TapIn | Motion::TapOut, _) => Some(Spindle::CounterClockwise(speed)),
            _ => None,
        };
        if spindle.is_some() && speed <= 0.0 {
            return error("tapping needs a speed of the spindle (S)");
        }
        if spindle.is_none() && (pitch < 0.0 || self.state.spindle == Spindle::Off) {
            return error("G33 needs a running spindle, and a pitch above 0");
        }
        if let Some(spindle) = spindle {
            self.report_spindle(source, spindle)?;
        }
        let (position, programmed) = self.target(source, block)?;
        self.state.position = position;
        self.state.programmed = programmed;
        let thread = Thread { end: self.state.pose(position), pitch: pitch.abs() };
        self.emit(source, Action::Thread(thread.into()))?;
        // G331 and G332 hold the spindle in position, where it stays until M3 or M4.
        if motion == Motion::TapOut {
            self.report_spindle(source, Spindle::Off)?;
        }
        Ok(())
    }

    /// `G63`: feed and speed of the spindle are the program's to match.
    #[cold]
    pub fn floating_tap(&mut self, source: &Source, block: &Block) -> Outcome {
        let modal = std::mem::replace(&mut self.state.motion, Motion::Line);
        if self.state.spindle == Spindle::Off {
            let message = "G63 needs a running spindle";
            return Err(source.block_error(Rule::Thread, message));
        }
        self.motion(source, block)?;
        self.state.motion = modal;
        Ok(())
    }
}
