//! Moves in step with the spindle: `G33`, `G33.1`.

use super::step::Step;
use crate::event::{Action, Thread};
use crate::iso::language::Fault;
use program::{Cycle, CycleKind, Rule, Spindle};

impl Step<'_, '_, '_> {
    /// `G33`: a straight line in step with the spindle. LinuxCNC's K counts along the way, FANUC's F
    /// along the longer axis: there one axis at a time.
    pub(super) fn thread(&mut self) -> Result<(), Fault> {
        let target = self.target(false)?;
        if target.named == 0 {
            return self.has_no_axis_word();
        }
        self.not_compensated("a thread")?;
        if target.named >= 8 {
            return Err(self.block.whole(Rule::Thread, "a rotary axis in a thread"));
        }
        if self.facts.motion.threads_along_one_axis && target.named.count_ones() > 1 {
            let message = "a thread along more than one axis";
            return Err(self.block.whole(Rule::Thread, message));
        }
        let pitch = self.pitch(if self.facts.feed.pitch_by_f { b'F' } else { b'K' })?;
        self.spindle_turns()?;
        let end = self.state.pose(target.point, target.rotary);
        self.actions.push(Action::Thread(Box::new(Thread { end, pitch })));
        self.state.arrive(target.point, target.rotary);
        Ok(())
    }

    /// `G33.1`: in and, with the spindle reversed, out again to where it began, which is a tapping
    /// cycle of one hole.
    pub(super) fn rigid_tap(&mut self) -> Result<(), Fault> {
        let target = self.target(false)?;
        if target.named == 0 {
            return self.has_no_axis_word();
        }
        self.not_compensated("tapping")?;
        let pitch = self.pitch(b'K')?;
        let left = self.spindle_turns()?;
        let start = self.state.position;
        let way = start - target.point;
        if start.is_nan() || way.truncate() != geom::Vec3::ZERO.truncate() || way.z <= 0.0 {
            let message = "G33.1 is followed straight down along Z from a known position only";
            return Err(self.block.whole(Rule::Thread, message));
        }
        let cycle = Cycle {
            kind: CycleKind::Tap { pitch, left },
            depth: way.z,
            clearance: 0.0,
            retract: 0.0,
            feed: None,
            dwell: 0.0,
            first_peck: None,
            peck: None,
        };
        self.actions.push(Action::Cycle(Box::new(cycle)));
        self.actions.push(Action::Hole(self.state.pose(start, self.state.rotary)));
        self.actions.push(Action::CycleOff);
        let back = super::motion::Target { point: start, ..target };
        self.state.arrive(back.point, back.rotary);
        Ok(())
    }

    /// The pitch of the block, mm.
    fn pitch(&mut self, letter: u8) -> Result<f64, Fault> {
        match self.take_length(letter)? {
            Some(pitch) if pitch > 0.0 => Ok(pitch),
            _ => {
                let message =
                    format!("a thread needs its pitch {}, greater than 0", char::from(letter));
                Err(self.block.whole(Rule::Thread, message))
            }
        }
    }

    /// Whether the spindle turns counter-clockwise.
    ///
    /// # Errors
    /// It stands.
    fn spindle_turns(&self) -> Result<bool, Fault> {
        match self.state.spindle {
            Spindle::Clockwise(_) => Ok(false),
            Spindle::CounterClockwise(_) => Ok(true),
            Spindle::Off => {
                Err(self.block.whole(Rule::Spindle, "a thread while the spindle stands"))
            }
        }
    }
}
