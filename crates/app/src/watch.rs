//! Work that somebody watches, and may end.

use crate::account::Stop;
use machine::Machine;
use program::{Program, Progress};
use proof::{MachineState, Motion, Observer, Report};
use std::path::Path;

/// Who watches a piece of work. `()` watches nothing and never ends it.
pub trait Watch: Sync {
    /// The next step begins: `reading`, `writing`, `proving`.
    fn step(&self, _what: &'static str) {}

    /// So much of the step is done, 0 to 1: of what is read, of the records that are written, of the lines of the program that are
    /// proven, of a board of its programs that are made. Not every step tells it.
    fn reached(&self, _part: f64) {}

    /// What lies there was read beside the source, or a file was looked for in this folder and not found; work that fails tells it too.
    fn has_read(&self, _path: &Path) {}

    /// Whether the work shall end. It is asked before each step, and every few milliseconds while a source is read and a program is
    /// written and proven; work that ends so answers a [`Stop`] whose verdict is [`crate::Verdict::Cancelled`], and has saved nothing.
    fn is_cancelled(&self) -> bool {
        false
    }

    /// Who follows the proof of the program that is called `file`, which is to make the motions of `source` on `machine`: it is
    /// told each motion as the proof walks it, the first mismatch, and the end. `()` follows nothing. Of several programs, as
    /// of a board, each proof is followed by somebody of its own, several at the same time.
    fn follow<'a>(
        &'a self,
        _file: &str,
        _source: &'a Program,
        _machine: &'a Machine,
    ) -> Box<dyn Observer + 'a> {
        Box::new(())
    }
}

impl Watch for () {}

/// Whoever follows a proof, which goes on for as long as the caller says so too.
pub(crate) struct Followed<'a> {
    watch: &'a dyn Watch,
    observer: Box<dyn Observer + 'a>,
}

impl Observer for Followed<'_> {
    fn reached(&mut self, part: f64) -> bool {
        self.watch.reached(part);
        !self.watch.is_cancelled() && self.observer.reached(part)
    }

    fn wants_motions(&self) -> bool {
        self.observer.wants_motions()
    }

    fn moved(&mut self, motion: &Motion) {
        self.observer.moved(motion);
    }

    fn stated(&mut self, state: &MachineState) {
        self.observer.stated(state);
    }

    fn mismatched(&mut self, found: &program::Diagnostic) {
        self.observer.mismatched(found);
    }

    fn ended(&mut self, report: &Report) {
        self.observer.ended(report);
    }
}

/// Who watches waits for a step.
pub(crate) struct Waits<'a>(pub &'a dyn Watch);

impl Progress for Waits<'_> {
    fn reached(&self, part: f64) -> bool {
        self.0.reached(part);
        !self.0.is_cancelled()
    }
}

impl<'w> dyn Watch + 'w {
    /// Whoever follows the proof of a program: [`Watch::follow`].
    pub(crate) fn followed<'a>(
        &'a self,
        file: &str,
        source: &'a Program,
        machine: &'a Machine,
    ) -> Followed<'a>
    where
        'w: 'a,
    {
        Followed { watch: self, observer: self.follow(file, source, machine) }
    }

    /// Begins a step.
    ///
    /// # Errors
    /// The work shall end.
    pub(crate) fn begin(&self, what: &'static str) -> Result<(), Stop> {
        self.go_on()?;
        self.step(what);
        Ok(())
    }

    /// # Errors
    /// The work shall end.
    pub(crate) fn go_on(&self) -> Result<(), Stop> {
        if self.is_cancelled() { Err(Stop::cancelled()) } else { Ok(()) }
    }
}
