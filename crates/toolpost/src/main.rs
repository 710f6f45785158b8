//! The `toolpost` command.

use app::helper::Launcher;
use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    toolpost::run(std::env::args_os(), helper()).into()
}

/// This program as a helper of its own.
fn helper() -> Option<Launcher> {
    let program = match cfg!(target_os = "linux") {
        // What runs here, also where another version has taken the place of its file meanwhile.
        true => PathBuf::from("/proc/self/exe"),
        false => std::env::current_exe().ok()?,
    };
    Some(Launcher::new(program, [toolpost::HELPER.into()]))
}
