//! What is active, and what each instruction does.

mod motion;
mod state;

pub(super) use state::State;
