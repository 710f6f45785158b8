//! Work that somebody watches, and may end.

use crate::account::Stop;

/// Who watches a piece of work. `()` watches nothing and never ends it.
pub trait Watch: Sync {
    /// The next step begins: `reading`, `writing`, `proving`.
    fn step(&self, _what: &'static str) {}

    /// Whether the work shall end. It is asked before each step and while a program is proven; work that ends so
    /// answers a [`Stop`] whose verdict is [`crate::Verdict::Cancelled`], and has saved nothing.
    fn is_cancelled(&self) -> bool {
        false
    }
}

impl Watch for () {}

impl dyn Watch + '_ {
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
