//! The command line of Toolpost: arguments, files to write, answers on the terminal.
//!
//! Each command is a function from its arguments to an [`answer::Answer`]; printing and exit codes are the answer's
//! business. Nothing is decided here about toolpaths, machines or proofs: what every front end does (open a source,
//! write, prove, plan a wire or a board) is the crate `app`, which has no command line.
//!
//! ```
//! let words = ["toolpost", "--quiet", "machines", "show", "iso"];
//! assert_eq!(toolpost::run(words.map(Into::into), None), 0);
//! ```

pub mod answer;
mod args;
mod arms;
mod explain;
mod fit;
mod glass;
mod machines;
mod pcb;
mod post;
mod progress;
mod prove;
mod settings;
mod show;
mod studio;
mod wire;

use answer::Answer;
use app::helper::{self, Launcher};
use app::{Stop, files};
use args::{Command, CommandLine};
use clap::error::ContextValue;
use clap::{CommandFactory, Parser};
use program::{Diagnostic, Rule};
use serde_json::json;
use std::ffi::OsString;
use std::io::Write;

/// Has Ctrl-C, and whatever else asks the process to end, wait until files that are being saved are whole.
fn end_cleanly() {
    // A process that has a handler of its own keeps it.
    let _ = ctrlc::set_handler(|| {
        let _whole = files::saved();
        files::remove_left();
        // Where this cannot be printed, nobody is left to read it, and the process ends all the same.
        let _ = writeln!(std::io::stderr(), "\ninterrupted");
        std::process::exit(INTERRUPTED.into());
    });
}

/// The exit code of a command that was interrupted: 128 and the number of the signal, as shells have it.
const INTERRUPTED: u8 = 130;

/// The command by which a program is a helper of another ([`app::helper`]).
pub const HELPER: &str = "helper";

/// Obeys a command line, whose first word is the name of the command, and answers the exit code. The studio starts its helpers by `helper`, which
/// gives such a program the word [`HELPER`]; without it, steps that cannot be ended in their middle go on to their end.
pub fn run(words: impl IntoIterator<Item = OsString>, helper: Option<Launcher>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    // Nobody types it, so that it is in no help.
    if words.get(1).is_some_and(|word| word == HELPER) {
        return helper::serve().is_err().into();
    }
    let (is_quiet, is_json) = said_first(&words);
    let settings::Expanded { words, found, origins, .. } = match settings::expanded(words) {
        Ok(expanded) => expanded,
        Err(stop) => return Answer::from(stop).say(is_quiet, is_json),
    };
    let CommandLine { mut command, quiet, json } = match CommandLine::try_parse_from(&words) {
        Ok(line) => line,
        Err(usage) => {
            if is_json && usage.use_stderr() {
                let help = "`toolpost --help`, or with a command before it, lists what it takes";
                let found = misused(usage, Rule::Argument).help(help);
                return Answer::from(Stop::from(found)).say(is_quiet, is_json);
            }
            let usage = shortened(usage);
            // Where this cannot be printed, nobody is left to read it.
            let _ = usage.print();
            return u8::try_from(usage.exit_code()).unwrap_or(u8::MAX);
        }
    };
    if let Command::Pcb(args) = &mut command {
        (args.found, args.origins) = (found, origins);
        args.options = settings::options(&words);
    }
    end_cleanly();
    let silent = quiet || json;
    let answer = match command {
        Command::Post(args) => post::run(&args, silent),
        Command::Wire(args) => wire::run(&args, silent),
        Command::Pcb(args) => pcb::run(&args, silent),
        Command::Glass(args) => glass::run(&args, silent),
        Command::Prove(args) => prove::run(&args, silent),
        Command::Machines(command) => machines::run(&command),
        Command::Show(args) => show::run(&args, silent),
        Command::Fit(args) => fit::run(&args, silent),
        Command::Studio(args) => studio::run(&args, json, helper),
        Command::Explain { topic } => explain::run(topic.as_deref()),
        Command::Completions { shell } => Ok(completions(shell)),
    };
    answer.unwrap_or_else(Answer::from).say(quiet, json)
}

/// Whether `--quiet` and `--json` are among the words of a command line.
fn said_first(words: &[OsString]) -> (bool, bool) {
    let has = |word: &str| words.iter().any(|said| said == word);
    (has("--quiet") || has("-q"), has("--json"))
}

/// The most characters of an argument that is wrong that are printed.
const MOST_SHOWN: usize = 80;

/// The same without the rest of an argument that fills the terminal.
fn shortened(mut usage: clap::Error) -> clap::Error {
    let long: Vec<_> = usage
        .context()
        .filter_map(|(kind, value)| match value {
            ContextValue::String(text) if text.chars().count() > MOST_SHOWN => {
                Some((kind, text.clone()))
            }
            _ => None,
        })
        .collect();
    for (kind, text) in long {
        let start: String = text.chars().take(MOST_SHOWN).collect();
        usage.insert(kind, ContextValue::String(format!("{start}...")));
    }
    usage
}

/// What is wrong with a command line, as a finding of this rule.
fn misused(usage: clap::Error, rule: Rule) -> Diagnostic {
    let message = shortened(usage).render().to_string();
    let first = message.split("\n\n").next().unwrap_or_default();
    let words: Vec<&str> = first.trim_start_matches("error: ").split_whitespace().collect();
    Diagnostic::error(rule, words.join(" "))
}

fn completions(shell: clap_complete::Shell) -> Answer {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut CommandLine::command(), "toolpost", &mut script);
    let script = String::from_utf8_lossy(&script).into_owned();
    let data = json!({ "shell": shell.to_string(), "script": &script });
    Answer::product(script, data)
}
