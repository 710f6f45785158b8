//! What every language needs: the kernel under the controls. It knows no language and no word of one.
//!
//! A new language is a grammar on top of it: what stands in a block, and what that does. Its text is taken apart with
//! [`flow::lines`], [`scan`] and [`decimal`]; its formulas are a [`formula`] of typed values, or a
//! [`Grammar`](expression::Grammar) of operands and ranks of its own; its jumps, loops and calls are looked up in the tables of
//! [`flow`]; its arcs come from [`arc`], its chamfers and rounded corners from `corner`. [`run`] gives it a [`Channel`] for its
//! events, which leads the tool's centre where compensation is resolved, ends loops that never move (the [`budget`]), and hands
//! over what a long program does while it is read. Called programs are looked for in [`Folders`](crate::Folders).
//!
//! `tests/all/fourth_language.rs` is a whole language of this kind: labels, variables, a loop, subprograms, arcs by a point between
//! their ends. Lengths are mm, angles degrees where a text says them; a coordinate that nobody knows is NaN.

pub mod arc;
pub(crate) mod arm;
pub mod budget;
mod channel;
pub(crate) mod compensation;
pub(crate) mod coolant;
pub(crate) mod corner;
pub mod decimal;
pub mod expression;
pub mod flow;
pub(crate) mod folders;
pub mod formula;
pub(crate) mod modulo;
pub(crate) mod queue;
mod relay;
pub mod scan;
pub mod source;

pub(crate) use channel::LONG;
pub use channel::{Channel, run};
pub use program::Outcome;
