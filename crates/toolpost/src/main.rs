//! The `toolpost` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    toolpost::run(std::env::args_os()).into()
}
