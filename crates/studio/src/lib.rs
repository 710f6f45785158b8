//! The studio: a server on this computer, and a page in the browser that shows source, program, machine and proof in one window.
//!
//! The server listens on 127.0.0.1 alone, reads and writes one folder alone, and answers whoever has the token of its link. It parses
//! no NC, no TOML and no board: what it shows is what the crate [`app`] reads, writes and proves, and the motions are those that the
//! proof has walked. Lengths are mm, feeds mm/min, times s, angles of axes degrees.
//!
//! ```no_run
//! use toolpost_studio::{Server, Settings};
//!
//! let server = Server::bind(&Settings { folder: ".".into(), ..Settings::default() }).unwrap();
//! println!("{}", server.link());
//! server.run();
//! ```
//!
//! # What goes over the socket
//!
//! Frames of [`message`]: first the token, then asks and their answers, whose types are those of [`ask`]; while a proof runs, what it has walked so far
//! ([`ask::Walked`]). What is large goes by HTTP, with the token in the header
//! `x-toolpost-token`: `PUT /upload/NAME`, `GET /geometry/REVISION/index`, `GET /geometry/REVISION/LEVEL/CHUNK`
//! (several chunks: `FROM-TO`, half open) and `GET /moves/REVISION/CHUNK`, whose octets [`geometry`] describes; `GET /geometry/REVISION/sight/...`, which
//! [`sight`] describes.
//!
//! # What it never does
//!
//! It never listens on another address, never opens a file outside its folder, never saves a program that is not proven or whose files have changed since, and never sends
//! what a file says as markup.

pub mod ask;
pub mod board;
pub mod drawing;
mod edit;
pub mod folder;
pub mod geometry;
pub mod glass;
mod index;
pub mod inputs;
pub mod job;
pub mod jobs;
pub mod lines;
pub mod machines;
pub mod message;
mod origin;
mod packed;
mod page;
pub mod place;
pub mod plots;
pub mod server;
pub mod sight;
mod sketch;
pub mod walk;

pub use job::Options;
pub use page::is_built as has_page;
pub use server::{Server, Settings};
