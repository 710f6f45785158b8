//! The command line of Toolpost.
//!
//! Each command is a function from its arguments to an [`answer::Answer`]; printing and exit codes are
//! the answer's business, files are [`files`]'. Nothing is decided here about toolpaths, machines or
//! proofs: that is what the crates below are for.

mod answer;
mod args;
mod drawing;
mod explain;
mod fcstd;
mod files;
mod machines;
mod post;
mod progress;
mod prove;
mod show;
mod summary;
mod toolpath;
mod walk;
mod wire;

use answer::Answer;
use args::{Command, CommandLine};
use clap::{CommandFactory, Parser};
use serde_json::json;
use std::process::ExitCode;

fn main() -> ExitCode {
    let CommandLine { command, quiet, json } = CommandLine::parse();
    let silent = quiet || json;
    let answer = match command {
        Command::Post(args) => post::run(&args, silent),
        Command::Wire(args) => wire::run(&args, silent),
        Command::Prove(args) => prove::run(&args, silent),
        Command::Machines(command) => machines::run(&command),
        Command::Show(args) => show::run(&args, silent),
        Command::Explain { topic } => explain::run(topic.as_deref()),
        Command::Completions { shell } => Ok(completions(shell)),
    };
    answer.unwrap_or_else(Answer::from).say(quiet, json)
}

fn completions(shell: clap_complete::Shell) -> Answer {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut CommandLine::command(), "toolpost", &mut script);
    let script = String::from_utf8_lossy(&script).into_owned();
    let data = json!({ "shell": shell.to_string(), "script": &script });
    Answer::product(script, data)
}
