//! What each statement of cutter-location data means, one by one; real files; bad input; any program written
//! and read back. Expected values are worked out by hand from the statement's definition, whose source is in
//! `docs/sources/apt.md`.

mod arcs;
mod bad_input;
mod compensated;
mod cycles;
mod files;
mod frames;
mod motion;
mod round_trip;
mod support;
mod technology;
mod words;
