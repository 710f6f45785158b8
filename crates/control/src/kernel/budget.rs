//! How far a program may run: loops, calls and jumps end, whatever is written.

use crate::event::Action;
use program::Rule;

/// Most jumps and calls between two places that the tool goes to: a loop that goes nowhere for so long
/// is taken as endless.
const IDLE: u32 = 200_000;

/// Most jumps and calls of a run: an endless loop that moves is refused after about 3 s and 200 MB.
const MOST: u64 = 2_000_000;

/// So much text is read in the time of a jump.
const BYTES_IN_A_TURN: usize = 16;

/// Counts the jumps of a run.
#[derive(Debug, Default)]
pub struct Budget {
    idle: u32,
    all: u64,
    /// Bits of the last place that was gone to after a jump.
    place: Option<[u64; 3]>,
}

impl Budget {
    /// A jump, a call, or another turn of a loop.
    ///
    /// # Errors
    /// What to say of a program that jumps without end.
    pub fn jump(&mut self) -> Result<(), String> {
        self.spend(1)
    }

    /// A call within so many others.
    ///
    /// # Errors
    /// They nest deeper than `most`, or as [`Budget::jump`].
    pub(crate) fn call(&mut self, depth: usize, most: usize) -> Result<(), (Rule, String)> {
        if depth >= most {
            return Err((Rule::Nesting, format!("calls nest deeper than {most}")));
        }
        self.jump().map_err(|message| (Rule::Endless, message))
    }

    /// So many bytes are read, again or behind a call. Once alone that is never endless, however long.
    ///
    /// # Errors
    /// As [`Budget::jump`].
    pub fn read(&mut self, bytes: usize) -> Result<(), String> {
        self.spend((bytes / BYTES_IN_A_TURN).min(IDLE as usize / 10))
    }

    /// A jump back, or a call: so many bytes are read again.
    ///
    /// # Errors
    /// As [`Budget::jump`].
    pub fn again(&mut self, bytes: usize) -> Result<(), String> {
        self.jump()?;
        self.read(bytes)
    }

    /// Something that takes as long as so many jumps.
    ///
    /// # Errors
    /// As [`Budget::jump`].
    pub fn spend(&mut self, turns: usize) -> Result<(), String> {
        let turns = u32::try_from(turns).unwrap_or(u32::MAX);
        self.idle = self.idle.saturating_add(turns);
        self.all += u64::from(turns);
        if self.idle > IDLE {
            return Err(format!("{IDLE} jumps without a move: the program never ends"));
        }
        if self.all > MOST {
            return Err(format!(
                "{MOST} jumps and calls: a loop that does not end, or a program too long to follow"
            ));
        }
        Ok(())
    }

    /// Something has happened. What does not lead the tool elsewhere is nothing.
    #[inline]
    pub(crate) fn note(&mut self, action: &Action) {
        if self.idle > 0 {
            self.after_a_jump(action);
        }
    }

    fn after_a_jump(&mut self, action: &Action) {
        let place = action.position().map(|pose| pose.point.to_array().map(f64::to_bits));
        if place.is_some() && place != self.place {
            (self.idle, self.place) = (0, place);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::Position;
    use geom::Vec3;

    #[test]
    fn a_loop_that_goes_nowhere_ends_and_one_that_moves_goes_on() {
        let to = |x: f64| Action::Rapid(Position::new(Vec3::new(x, 0.0, f64::NAN), Vec3::Z));
        let mut budget = Budget::default();
        for x in [1.0, 2.0, 1.0] {
            assert!(budget.spend(IDLE as usize).is_ok());
            budget.note(&to(x));
        }
        // What is only said, a stop, and a way to where the tool is already.
        assert!((0..IDLE).all(|_| budget.jump().is_ok()));
        for action in [Action::Comment("on the way".into()), Action::Stop, to(1.0)] {
            budget.note(&action);
        }
        assert!(budget.jump().is_err());
    }
}
