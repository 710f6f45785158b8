//! Long work that somebody waits for, and may end.

use crate::{Diagnostic, Outcome, Rule};

/// Who waits for a piece of work. `()` waits for as long as it takes.
pub trait Progress: Sync {
    /// So much of the work is done, 0 to 1: whether it goes on. Asked every few milliseconds.
    fn reached(&self, part: f64) -> bool;
}

impl Progress for () {
    fn reached(&self, _part: f64) -> bool {
        true
    }
}

impl<F: Fn(f64) -> bool + Sync> Progress for F {
    fn reached(&self, part: f64) -> bool {
        self(part)
    }
}

/// Asks who waits, every so many steps of a work.
pub struct Pulse<'a> {
    progress: &'a dyn Progress,
    /// How much there is to do.
    whole: usize,
    every: u32,
    steps: u32,
}

impl<'a> Pulse<'a> {
    /// Of a work of this size, which asks every so many steps.
    pub fn new(progress: &'a dyn Progress, whole: usize, every: u32) -> Pulse<'a> {
        Pulse { progress, whole, every, steps: 0 }
    }

    /// The next step, with which so much is `done` of the whole.
    ///
    /// # Errors
    /// The work shall end (`cancelled`).
    #[inline]
    pub fn step(&mut self, done: usize) -> Outcome {
        self.steps += 1;
        if self.steps < self.every {
            return Ok(());
        }
        self.steps = 0;
        self.ask(done)
    }

    #[cold]
    fn ask(&self, done: usize) -> Outcome {
        let part = done.min(self.whole) as f64 / self.whole.max(1) as f64;
        if self.progress.reached(part) { Ok(()) } else { Err(cancelled().into()) }
    }
}

/// What work answers that somebody has ended.
pub fn cancelled() -> Diagnostic {
    Diagnostic::error(Rule::Cancelled, "the work was cancelled: there is no result")
        .help("start it again for one")
}
