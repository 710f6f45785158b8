//! `toolpost wire`: a contour in, the proven program of a wire-EDM machine and its report out.

use crate::answer::{Answer, not_saved};
use crate::args;
use crate::post::spare;
use crate::progress::Progress;
use app::files::{self, Target};
use app::{Stop, Verdict, Watch, toolpath, wire};
use drawing::Format;
use std::path::Path;

/// Writes the program, proves it, and only then saves it with its report and its picture.
pub fn run(args: &args::Wire, silent: bool) -> Result<Answer, Stop> {
    let (path, settings) = (&args.source.path, args.settings()?);
    let mut inputs = vec![path.as_path(), Path::new(&args.machine)];
    inputs.extend(args.ends.upper.as_deref());
    let report_path = files::report_of(&args.output);
    let target = Target::new(&args.output, &inputs)?;
    let report_target = Target::new(&report_path, &inputs)?;
    let picture = match &args.picture {
        Some(file) => Some((Target::new(file, &inputs)?, Format::of(file)?)),
        None => None,
    };
    let machine = toolpath::machine(&args.machine)?;
    let progress = Progress::new(if picture.is_some() { 5 } else { 4 }, silent);
    let made = wire::make(
        &path.as_path().into(),
        args.source.strict,
        &args.source.origin.origin(),
        machine.clone(),
        &settings,
        &files::name(&args.output),
        &args.closeness.tolerances(),
        &progress,
    )?;
    if made.posted.account.verdict != Verdict::Done {
        return Ok(not_saved(made.posted.account));
    }
    let drawn = match &picture {
        Some((_, format)) => {
            progress.step("drawing");
            Some(format.bytes(made.picture())?)
        }
        None => None,
    };
    let picture_target = picture.iter().map(|(target, _)| target);
    let targets: Vec<&Target> = picture_target.chain([&target, &report_target]).collect();
    spare(&targets, &made.toolpath, &machine)?;
    progress.step("saving");
    let report = made.report();
    let mut saved = vec![(&report_target, report.as_bytes())];
    if let (Some((target, _)), Some(bytes)) = (&picture, &drawn) {
        saved.push((target, bytes));
    }
    saved.push((&target, &made.posted.text));
    files::save(&saved)?;

    let mut account = made.posted.account;
    account.rows.push(("saved", args.output.display().to_string()));
    account.rows.push(("", report_path.display().to_string()));
    account.rows.extend(args.picture.as_ref().map(|file| ("", file.display().to_string())));
    Ok(account.into())
}
