//! Work that somebody watches, and may end.

use program::{Diagnostic, cancelled};

/// Who watches. `()` watches nothing and ends nothing.
pub trait Watch: Sync {
    /// The next step begins: `ordering`, `proving`.
    fn step(&self, _what: &'static str) {}

    /// How many pulses there is memory for.
    fn most_pulses(&self) -> u64 {
        u64::MAX
    }

    /// Whether the work shall end. It is asked often, from many threads.
    fn is_ended(&self) -> bool {
        false
    }
}

impl Watch for () {}

impl dyn Watch + '_ {
    /// # Errors
    /// The work shall end.
    pub(crate) fn go_on(&self) -> Result<(), Vec<Diagnostic>> {
        if self.is_ended() { Err(vec![cancelled()]) } else { Ok(()) }
    }
}
