//! The language: a block's words, functions and formulas.
//!
//! A line becomes words ([`scan`]); those of a positioning block are read and checked together
//! ([`words`]), with its [`feed`] and its M functions ([`functions`]). Q parameters ([`registers`]) stand for numbers and
//! take what a [`formula`] gives.

pub(super) mod feed;
pub(super) mod formula;
pub(super) mod functions;
pub(super) mod registers;
pub(super) mod scan;
pub(super) mod words;
