//! `toolpost pcb`: a board in; the proven programs that isolate, drill and cut it out, a picture of each
//! and one report out.

mod plan;
mod report;
mod source;

use crate::answer::{Answer, Stop, Verdict};
use crate::args;
use crate::args::pcb::Picture;
use crate::files::{self, Target};
use crate::post::{self, Posted};
use crate::progress::Progress;
use crate::summary::rows;
use crate::toolpath::{self, Toolpath};
use ::pcb::job::{self, Heights};
use drawing::{BoardPicture, Format};
use machine::Machine;
use plan::Job;
use program::{Diagnostic, Program};
use std::path::Path;
use std::thread;

/// Writes the programs, proves them, and only then saves them with their pictures and the report.
pub fn run(args: &args::pcb::Pcb, silent: bool) -> Result<Answer, Stop> {
    let machine = toolpath::machine_with(&args.machine, &args.option)?;
    if machine.wire.is_some() {
        let message = format!("`{}` cuts by wire: it mills and drills nothing", machine.name);
        return Err(Diagnostic::error("machine-kind", message).into());
    }
    files::check_folder(&args.output)?;
    let progress = Progress::new(5, silent);
    progress.step("reading");
    let source = source::read(&args.board)?;
    let mut warnings = toolpath::held(source.warnings, args.strict)?;
    progress.step("planning");
    let planned = plan::of(source.board, args, &machine)?;
    warnings.extend(toolpath::held(planned.warnings, args.strict)?);
    progress.step("writing and proving");
    let made = each(&planned.jobs, |job| make(job, &planned, &machine, args));
    let mut programs = Vec::with_capacity(made.len());
    for made in made {
        let made = made?;
        if made.posted.account.verdict != Verdict::Done {
            return Ok(made.posted.account.not_saved());
        }
        programs.push(made);
    }
    progress.step("saving");
    let report = report::of(&source.layers, &planned, &programs, &machine, &warnings);
    let saved = save(args, &source.files, &programs, &format!("{:#}\n", report.data))?;

    let mut lines = report.rows;
    let folder = args.output.display();
    lines.push(("saved", format!("in {folder}: {}", saved.join(", "))));
    Ok(Answer::summary(Verdict::Done, rows(&lines), report.data).findings(warnings))
}

/// A program that was made.
pub(crate) struct Made<'a> {
    /// What for.
    job: &'a Job,
    /// What it does.
    program: Program,
    posted: Posted,
    picture: Option<Vec<u8>>,
}

/// The program of a job, proven, with its picture.
fn make<'a>(
    job: &'a Job,
    planned: &plan::Plan,
    machine: &Machine,
    args: &args::pcb::Pcb,
) -> Result<Made<'a>, Stop> {
    let heights = Heights { travel: args.running.travel, approach: args.running.approach };
    let name = format!("{} {}", planned.name, job.name);
    let program = job::program(&name, &job.operations, &heights);
    let toolpath = Toolpath::of_program(program, "board");
    let file = format!("{}.nc", job.name);
    let posted = post::proven(&toolpath, machine, &file, &args.closeness.tolerances(), &|_| {})?;
    let format = match args.picture {
        Picture::Svg => Some(Format::Svg),
        Picture::Png => Some(Format::Png),
        Picture::None => None,
    };
    let board = planned.seen_from(job);
    let picture = format.map(|format| {
        let widths: Vec<f64> = job.operations.iter().map(plan::width).collect();
        format.bytes(drawing::board(
            &name,
            &BoardPicture {
                outline: board.outline.as_ref(),
                copper: job.face.and_then(|face| board.side(face).copper.as_ref()),
                holes: &board.holes,
                program: &toolpath.program,
                widths: &widths,
                problems: &job.problems,
            },
        ))
    });
    let picture = picture.transpose()?;
    Ok(Made { job, program: toolpath.program, posted, picture })
}

/// `work` for each job, all at the same time, the answers in the order of the jobs.
fn each<'a, T: Send>(jobs: &'a [Job], work: impl Fn(&'a Job) -> T + Sync) -> Vec<T> {
    let work = &work;
    thread::scope(|scope| {
        let threads: Vec<_> = jobs.iter().map(|job| scope.spawn(move || work(job))).collect();
        let finished = threads.into_iter().map(|thread| thread.join());
        finished.map(|done| done.unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
    })
}

/// Saves everything, or nothing; answers the names of the files.
fn save(
    args: &args::pcb::Pcb,
    inputs: &[std::path::PathBuf],
    programs: &[Made],
    report: &str,
) -> Result<Vec<String>, Stop> {
    let mut contents: Vec<(String, &[u8])> = vec![("report.json".into(), report.as_bytes())];
    let ending = if args.picture == Picture::Png { "png" } else { "svg" };
    for made in programs {
        let name = made.job.name;
        contents.extend(made.picture.as_deref().map(|bytes| (format!("{name}.{ending}"), bytes)));
    }
    for made in programs {
        contents.push((format!("{}.nc", made.job.name), &made.posted.text));
    }
    let inputs: Vec<&Path> = inputs.iter().map(|file| file.as_path()).collect();
    let made = files::folder(&args.output)?;
    let mut targets = Vec::with_capacity(contents.len());
    for (name, _) in &contents {
        targets.push(Target::new(&args.output.join(name), &inputs)?);
    }
    let bytes = contents.iter().map(|(_, bytes)| *bytes);
    files::save(&targets.iter().zip(bytes).collect::<Vec<_>>())?;
    made.keep();
    Ok(contents.into_iter().map(|(name, _)| name).collect())
}
