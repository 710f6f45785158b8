//! Boards, from their files to programs that are read back.

mod bad_input;
mod recut;
mod scanlines;
