//! `toolpost glass`: engraving inside glass.

use crate::answer::Answer;
use crate::args::glass::{Glass, GlassCommand};
use app::Stop;
use serde_json::json;

/// Obeys the command.
pub fn run(args: &Glass) -> Result<Answer, Stop> {
    match args.command {
        GlassCommand::Tables => Ok(tables()),
    }
}

/// The tables of the source next to ours.
fn tables() -> Answer {
    let data = json!({ "series": ::glass::source::series(), "checks": ::glass::source::checks() });
    Answer::product(::glass::source::report(), data)
}
