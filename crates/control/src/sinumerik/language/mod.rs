//! The language: a text becomes a block, with every word looked up and every expression evaluated.
//!
//! Characters become names, numbers and texts ([`scan`]), and these the [`words`] of a [`block`]: G
//! [`commands`], [`call`]s with arguments, [`definition`]s, or a [`statement`] on the order of blocks.
//! Behind `=` stands an [`expression`] of [`operators`] and [`functions`] over [`value`]s,
//! [`variables`] and what the control says of itself ([`system`]).

pub(super) mod block;
pub(super) mod call;
pub(super) mod commands;
pub(super) mod definition;
pub(super) mod expression;
mod functions;
mod operators;
pub(super) mod scan;
pub(super) mod statement;
mod system;
pub(super) mod value;
pub(super) mod variables;
mod words;
