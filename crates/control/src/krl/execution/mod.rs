//! What is active, and what each statement does.

mod motion;
mod state;
mod system;

pub(super) use state::State;
