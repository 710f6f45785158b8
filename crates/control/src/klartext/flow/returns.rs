//! Where subprograms return to, and what is left of repetitions.

use super::source::BlockLocation;
use crate::kernel::flow;

/// Deepest nesting of subprograms, and of programs (TNC 640; older controls have fewer).
pub(super) const NESTING: usize = 19;

/// Most repetitions that are under way at the same time.
const REPETITIONS: usize = 1000;

/// Where subprograms return to and what is left of repetitions.
pub(super) struct Calls {
    returns: flow::Calls<Return>,
    repetitions: Vec<Repetition>,
}

struct Return {
    to: BlockLocation,
    /// How many repetitions were under way where the call stands.
    repetitions: usize,
}

/// A `CALL LBL REP` that has been reached.
struct Repetition {
    /// Bytes of the text that are repeated: from the label to the call.
    from: usize,
    call: usize,
    left: u32,
    /// Whether a jump has led out of the part that is repeated.
    abandoned: bool,
}

impl Calls {
    pub(super) fn new() -> Calls {
        Calls { returns: flow::Calls::new(NESTING), repetitions: Vec::new() }
    }

    /// A subprogram is called and will return to a place; answers why it cannot be.
    pub(super) fn call(&mut self, to: BlockLocation) -> Result<(), String> {
        let back = Return { to, repetitions: self.repetitions.len() };
        let entered = self.returns.enter(back);
        entered.map_err(|most| format!("subprograms are nested more than {most} deep"))
    }

    /// The end of a subprogram: where it returns to, if it was called.
    pub(super) fn end(&mut self) -> Option<BlockLocation> {
        let back = self.returns.leave()?;
        self.repetitions.truncate(back.repetitions);
        Some(back.to)
    }

    /// Whether a subprogram has not returned yet.
    pub(super) fn is_open(&self) -> bool {
        self.returns.last().is_some()
    }

    /// A `CALL LBL REP` is reached: whether the part from the label to it runs once more. Answers why
    /// that cannot be said.
    pub(super) fn repeat(
        &mut self,
        from: BlockLocation,
        call: BlockLocation,
        times: u32,
    ) -> Result<bool, String> {
        let own = self.returns.last().map_or(0, |back| back.repetitions);
        let active = self.repetitions.iter().skip(own).position(|r| r.call == call.offset);
        let index = match active {
            Some(index) => own + index,
            None if self.repetitions.len() >= REPETITIONS => {
                return Err(format!("more than {REPETITIONS} repetitions are under way"));
            }
            None => {
                let (from, call) = (from.offset, call.offset);
                self.repetitions.push(Repetition { from, call, left: times, abandoned: false });
                self.repetitions.len() - 1
            }
        };
        let Some(repetition) = self.repetitions.get_mut(index) else { return Ok(false) };
        if repetition.abandoned {
            let left = repetition.left;
            return Err(format!(
                "a jump has led out of this repetition with {left} still to go: how many there are now is \
                 not known"
            ));
        }
        if repetition.left == 0 {
            self.repetitions.remove(index);
            return Ok(false);
        }
        repetition.left -= 1;
        Ok(true)
    }

    /// A jump leads to a place.
    pub(super) fn jump(&mut self, to: BlockLocation) {
        let own = self.returns.last().map_or(0, |back| back.repetitions);
        for repetition in self.repetitions.iter_mut().skip(own) {
            if !(repetition.from..=repetition.call).contains(&to.offset) {
                repetition.abandoned = true;
            }
        }
    }
}
