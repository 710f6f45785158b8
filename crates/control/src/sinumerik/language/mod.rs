//! The language: a text becomes a block, with every word looked up and every expression evaluated.
//!
//! Characters become names, numbers and texts ([`scan`]), and these the [`words`] of a [`block`]: G
//! [`commands`], addresses with an `=` ([`settings`]), [`call`]s with arguments ([`forms`]),
//! [`definition`]s, or a [`statement`] on the order of blocks, perhaps of a control [`structure`]. Behind
//! `=` stands an [`expression`] of [`operators`] and [`functions`] over [`value`]s and what is [`named`]:
//! [`variables`] and what the control says of itself ([`system`]).

pub(super) mod axis;
pub(super) mod block;
pub(super) mod call;
pub(super) mod commands;
pub(super) mod definition;
pub(super) mod expression;
pub(super) mod forms;
mod functions;
mod named;
mod operators;
pub(super) mod scan;
mod settings;
pub(super) mod statement;
pub(super) mod structure;
pub(super) mod system;
pub(super) mod value;
pub(super) mod variables;
mod words;

/// The names of its tables, with a value where one is needed.
pub(super) fn vocabulary() -> Vec<String> {
    let commands = commands::COMMANDS.iter().map(|command| command.name.to_owned());
    commands.chain(settings::vocabulary()).chain(call::vocabulary()).collect()
}
