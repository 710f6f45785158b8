//! What is active, and what each statement does.

mod arguments;
mod command;
mod motion;
mod state;

pub(super) use state::State;
