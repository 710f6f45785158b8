//! What can be typed after `glass`.

use clap::{Args, Subcommand};

/// Arguments of `glass`.
#[derive(Debug, Args)]
pub struct Glass {
    /// What to do.
    #[command(subcommand)]
    pub command: GlassCommand,
}

/// Commands of `glass`.
#[derive(Debug, Subcommand)]
pub enum GlassCommand {
    /// Print the tables of the source of the models next to ours, its test vectors, and its known slips.
    Tables,
}
