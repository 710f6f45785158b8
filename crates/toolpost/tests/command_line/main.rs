//! The command line as its users meet it: the program is run, in a folder of its own.

mod arms;
mod bad_input;
mod commands;
mod fit;
#[path = "../folder/mod.rs"]
mod folder;
mod freecad;
mod glass;
mod helper;
mod import;
mod nc;
mod questions;
mod readme;
mod saving;
mod wire;
