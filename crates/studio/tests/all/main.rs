//! The server as a page talks with it, and as nobody should.

mod bad_input;
mod boards;
mod client;
mod closed;
mod glass;
mod jobs;
mod parts;
mod process;
