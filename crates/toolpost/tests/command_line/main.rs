//! The command line as its users meet it: the program is run, in a folder of its own.

mod bad_input;
mod commands;
mod folder;
mod freecad;
mod import;
mod nc;
mod saving;
mod wire;
