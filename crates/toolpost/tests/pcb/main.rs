//! Boards, from their files to programs that are read back.

mod bad_input;
mod board;
#[path = "../folder/mod.rs"]
mod folder;
mod programs;
mod recut;
mod scanlines;
mod settings;
