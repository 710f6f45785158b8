//! `toolpost prove`: any program, also one edited by hand, compared with the toolpath it should make.

use crate::answer::Answer;
use crate::args::{Command, CommandLine, Prove};
use crate::progress::Progress;
use app::pcb::Job;
use app::prove::compare;
use app::report::{self, Digests};
use app::{Source, Stop, Watch, files, toolpath};
use clap::Parser;
use control::Folders;
use machine::Machine;
use program::{Diagnostic, Purpose, Rule, encoding};
use serde_json::Value;
use std::path::Path;

/// Runs the program on the virtual control of the machine and compares.
pub fn run(args: &Prove, silent: bool) -> Result<Answer, Stop> {
    let machine = toolpath::machine_with(&args.machine, &args.option)?;
    if let Some(options) = board_options(args)? {
        return board(args, &machine, &options, silent);
    }
    let progress = Progress::new(2, silent);
    progress.step("reading");
    let against = args.against.as_path().into();
    let toolpath =
        toolpath::read(&against, false, &args.origin.origin(), Some(&machine), Purpose::Program)?;
    let text = files::read(&args.program)?;
    let file = files::name(&args.program);
    if encoding::is_utf_16(&text) {
        return Err(encoding::utf_16().file(file).into());
    }
    let read = encoding::without_mark(&text);
    let tolerances = args.closeness.tolerances();
    let folders = beside(&args.program, &machine);
    let program = (&*file, read, &folders);
    let mut account = compare(&toolpath, &machine, program, &tolerances, &progress)?;
    let called = report::called(&folders)?;
    let called: Vec<&[u8]> = called.iter().map(Vec::as_slice).collect();
    match report::pair(&args.program, || Digests::of(&text, &called, &toolpath, &machine)) {
        Ok(pair) => account.rows.extend(pair.map(|text| ("report", text))),
        Err(found) => account.findings.push(*found),
    }
    Ok(account.into())
}

/// Where the programs are that a program calls: a robot has them in the folder of the program.
fn beside(program: &Path, machine: &Machine) -> Folders {
    let folder = match program.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    match machine.arm {
        Some(_) => vec![folder.to_owned()].into(),
        None => Folders::default(),
    }
}

/// The report of a board's programs, which lies beside them.
const REPORT: &str = "report.json";

/// The options with which the board was made that the program is compared with; `None` where that is no board.
///
/// # Errors
/// `report` where it is one, and nothing beside the program says with which options it was made.
fn board_options(args: &Prove) -> Result<Option<Vec<String>>, Stop> {
    let against = &args.against;
    let is_board = against.is_dir()
        || against.extension().is_some_and(|ending| ending == "kicad_pcb" || ending == "toml");
    if !is_board {
        return Ok(None);
    }
    let file = args.program.with_file_name(REPORT);
    let wrong = |message: &str| {
        let help = "the report.json that `toolpost pcb` saves with its programs has the options with which the board was made";
        Diagnostic::error(Rule::ReportPair, message).help(help).file(file.display().to_string())
    };
    let text = files::read(&file).map_err(|found| wrong(&found.message))?;
    let report: Value =
        serde_json::from_slice(&text).map_err(|_| wrong("this is no report of `toolpost pcb`"))?;
    let options = report["options"].as_array().ok_or_else(|| wrong("the report has no options"))?;
    Ok(Some(options.iter().filter_map(Value::as_str).map(str::to_owned).collect()))
}

/// Compares the program of a board with what the board gives.
fn board(
    args: &Prove,
    machine: &Machine,
    options: &[String],
    silent: bool,
) -> Result<Answer, Stop> {
    let words = ["toolpost", "pcb", "--machine=m", "--output=o"].map(str::to_owned);
    let board = args.against.display().to_string();
    let words = words.into_iter().chain(options.iter().cloned()).chain([String::from("--"), board]);
    let parsed = CommandLine::try_parse_from(words).map(|line| line.command);
    let Ok(Command::Pcb(made)) = parsed else {
        let message = "the options of the report are none of `toolpost pcb`";
        let help = "make the programs anew";
        return Err(Diagnostic::error(Rule::ReportPair, message).help(help).into());
    };
    let (settings, tolerances) = (made.plan(), args.closeness.tolerances());
    let mut job = Job::new(machine, &settings, &tolerances)?;
    job.surface = made.running.heights.clone().map(Source::File);
    let named = made.files.named().into_iter();
    job.named = named.map(|(file, layer)| (Source::File(file), layer)).collect();
    let progress = Progress::new(4, silent);
    let sources: Vec<Source> = made.board.iter().cloned().map(Source::File).collect();
    let text = files::read(&args.program)?;
    let file = files::name(&args.program);
    let name = args.program.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let read = encoding::without_mark(&text);
    let folders = beside(&args.program, machine);
    Ok(job.prove(&sources, (&name, &file), (read, &folders), &progress)?.account.into())
}
