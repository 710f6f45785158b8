//! `toolpost pcb`: a board in; the proven programs that isolate, drill and cut it out, a picture of each
//! and one report out.

use crate::answer::{Answer, not_saved};
use crate::args::pcb::Pcb;
use crate::progress::Progress;
use crate::settings::placed;
use app::pcb::{Job, older, other_files};
use app::{Source, Stop, Verdict, Watch, files, toolpath};
use program::{Diagnostic, Rule};
use std::path::Path;

/// Writes the programs, proves them, and only then saves them with their pictures and the report.
pub fn run(args: &Pcb, silent: bool) -> Result<Answer, Stop> {
    made(args, silent).map_err(|stop| placed(stop, &args.origins))
}

fn made(args: &Pcb, silent: bool) -> Result<Answer, Stop> {
    let machine = toolpath::machine_with(&args.machine, &args.option)?;
    let (settings, tolerances) = (args.plan(), args.closeness.tolerances());
    let mut job = Job::new(&machine, &settings, &tolerances)?;
    job.surface = args.running.heights.clone().map(Source::File);
    let named = args.files.named().into_iter();
    job.named = named.map(|(file, layer)| (Source::File(file), layer)).collect();
    (job.picture, job.strict) = (args.picture, args.strict);
    job.options = args.options.clone();
    files::check_folder(&args.output)?;
    not_among_inputs(args)?;
    let progress = Progress::new(4, silent);
    let board: Vec<Source> = args.board.iter().cloned().map(Source::File).collect();
    let made = job.make(&board, &progress)?;
    let others = other_files(&machine, &made.programs);
    let found = older(&others, &args.output).into_iter().chain(args.found.clone());
    let mut account = made.account(&job, found.collect());
    if !matches!(account.verdict, Verdict::Done | Verdict::Partly) {
        return Ok(not_saved(account));
    }
    progress.step("saving");
    let inputs: Vec<&Path> = made.files.iter().filter_map(Source::file).collect();
    let report = format!("{:#}\n", account.data);
    let contents = made.contents(&job, &report);
    files::save_in(&args.output, &contents, &inputs)?;
    let saved: Vec<String> = contents.into_iter().map(|(name, _)| name).collect();
    let folder = args.output.display();
    account.rows.push(("saved", format!("in {folder}: {}", saved.join(", "))));
    Ok(account.into())
}

/// Refuses a folder of output that is the board's own: what is saved there would be read as the board's the
/// next time, and takes the place of what its owner has there.
fn not_among_inputs(args: &Pcb) -> Result<(), Stop> {
    let whole = |path: &Path| std::fs::canonicalize(path).ok();
    let output = whole(&args.output);
    let folder_of = |path: &Path| match path.parent() {
        _ if path.is_dir() => whole(path),
        Some(folder) if !folder.as_os_str().is_empty() => whole(folder),
        _ => whole(Path::new(".")),
    };
    if output.is_some() && args.board.iter().any(|path| folder_of(path) == output) {
        let message = "the programs would be saved among the files of the board";
        let found = Diagnostic::error(Rule::OutputFolder, message).help("give a folder of its own");
        return Err(found.file(args.output.display().to_string()).into());
    }
    Ok(())
}
