//! What is active, and what each statement does.

mod motion;
mod state;

pub(super) use state::{Data, State};
