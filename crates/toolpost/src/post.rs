//! `toolpost post`: toolpath in, proven program and its report out.

use crate::answer::{Answer, not_saved};
use crate::args::Post;
use crate::progress::Progress;
use app::files::{self, Target};
use app::post::{Posted, proven};
use app::toolpath::{self, Toolpath};
use app::{Stop, Verdict, Watch};
use machine::Machine;
use program::Purpose;
use std::path::Path;

/// Writes the program, proves it, and only then saves it with its report.
pub fn run(args: &Post, silent: bool) -> Result<Answer, Stop> {
    let source = &args.source.path;
    let inputs = [source.as_path(), Path::new(&args.machine)];
    let report_path = files::report_of(&args.output);
    let target = Target::new(&args.output, &inputs)?;
    let report_target = Target::new(&report_path, &inputs)?;
    let machine = toolpath::machine_with(&args.machine, &args.option)?;
    let progress = Progress::new(4, silent);
    progress.step("reading");
    let origin = args.source.origin.origin();
    let toolpath = toolpath::read(
        &source.as_path().into(),
        args.source.strict,
        &origin,
        Some(&machine),
        Purpose::Program,
    )?;
    let file = files::name(&args.output);
    if machine.cell.is_some() {
        files::is_no_part(&args.output)?;
    }
    let tolerances = args.closeness.tolerances();
    let posted = proven(&toolpath, &machine, &file, &tolerances, &progress)?;
    if posted.account.verdict != Verdict::Done {
        return Ok(not_saved(posted.account));
    }
    let parts = posted
        .parts
        .iter()
        .map(|part| Target::new(&args.output.with_file_name(&part.file), &inputs));
    let parts = parts.collect::<Result<Vec<_>, _>>()?;
    let files: Vec<&str> = posted.parts.iter().map(|part| &*part.file).collect();
    files::are_own(&args.output, &files)?;
    let left = files::parts_left(&args.output, &files);
    let targets: Vec<&Target> = parts.iter().chain([&target, &report_target]).collect();
    spare(&targets, &toolpath, &machine)?;
    progress.step("saving");
    let report = posted.account.report();
    let called = parts.iter().zip(posted.called()).map(|(target, (_, text))| (target, text));
    let mut saved: Vec<(&Target, &[u8])> = vec![(&report_target, report.as_bytes())];
    saved.extend(called);
    saved.push((&target, &posted.text));
    files::save(&saved)?;
    let Posted { mut account, .. } = posted;
    account.findings.extend(left);
    account.rows.push(("saved", args.output.display().to_string()));
    account.rows.push(("", report_path.display().to_string()));
    Ok(account.into())
}

/// Checks that none of `targets` is one of the files that have been read.
///
/// # Errors
/// The one that is.
pub fn spare(targets: &[&Target], toolpath: &Toolpath, machine: &Machine) -> Result<(), Stop> {
    for target in targets {
        target.spare(&toolpath.files())?;
        target.spare(&machine.loaded_from.files)?;
    }
    Ok(())
}
