//! `toolpost post`: toolpath in, proven program and its report out.

use crate::answer::{Account, Answer, Stop, Verdict};
use crate::args::Post;
use crate::beside::beside;
use crate::files::{self, Target};
use crate::progress::Progress;
use crate::prove;
use crate::report::{self, Digests};
use crate::summary::{Shape, time};
use crate::toolpath::{self, Toolpath};
use ::post::Output;
use machine::Machine;
use machine::time::Times;
use program::{Diagnostic, Op, Program, Purpose, Record};
use proof::Tolerances;
use serde_json::json;
use std::path::Path;

/// Rules whose findings say that the machine cannot do what the toolpath asks for. All others of the
/// writer are mistakes of the input: of the toolpath, or of the machine's file.
const MACHINE_CANNOT: [&str; 18] = [
    "arc-orientation",
    "axis-limit",
    "cycle-missing",
    "cycle-tap",
    "feed-range",
    "line-length",
    "memory",
    "number-range",
    "one-opening",
    "orientation-in-cut",
    "spindle-range",
    "taper",
    "taper-limit",
    "tool-range",
    "unreachable-orientation",
    "unsupported",
    "uv-limit",
    "wire-leans",
];

/// A program that is proven, or is not, and what is told of it.
#[derive(Debug)]
pub struct Posted {
    /// The program. Nobody should have it whose account does not say that it is proven.
    pub text: Vec<u8>,
    /// What is told of it.
    pub account: Account,
}

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
    let toolpath = toolpath::read(
        source,
        args.source.strict,
        &args.source.origin,
        Some(&machine),
        Purpose::Program,
    )?;
    let file = files::name(&args.output);
    let tolerances = args.closeness.tolerances();
    let posted = proven(&toolpath, &machine, &file, &tolerances, &|what| progress.step(what))?;
    let Posted { text, mut account } = posted;
    if account.verdict != Verdict::Done {
        return Ok(account.not_saved());
    }
    spare(&[&target, &report_target], &toolpath, &machine)?;
    progress.step("saving");
    files::save(&[(&report_target, account.report().as_bytes()), (&target, &text)])?;
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

/// Writes the program of `toolpath`, which is called `file`, and proves it; `step` is told what is
/// being done.
///
/// # Errors
/// Why there is no program.
pub fn proven(
    toolpath: &Toolpath,
    machine: &Machine,
    file: &str,
    tolerances: &Tolerances,
    step: &dyn Fn(&'static str),
) -> Result<Posted, Stop> {
    if machine.wire.is_some() {
        let message = format!("`{}` cuts by wire: it has no spindle and no tools", machine.name);
        let help = "`toolpost wire` writes for it";
        return Err(Diagnostic::error("machine-kind", message).help(help).into());
    }
    let mut warnings = toolpath.warnings.clone();
    step("writing");
    let program = &toolpath.program;
    // What is told of the toolpath is found meanwhile.
    let headed = headed(program, tolerances);
    let (output, (shape, times)) = beside(
        || write(headed.as_ref().unwrap_or(program), machine, toolpath, &mut warnings),
        || (Shape::of(program), Times::of(program, machine)),
    );
    let output = output?;
    step("proving");
    let proof = proof::prove(program, machine, file, &output.text, tolerances);
    if !proof.proven {
        let mut account = prove::failed(&proof, toolpath, file);
        account.findings.extend(warnings);
        return Ok(Posted { text: output.text, account });
    }

    warnings.extend(proof.warnings.iter().chain(&proof.accepted).cloned());
    let data = json!({
        "schema": report::SCHEMA,
        "toolpost": env!("CARGO_PKG_VERSION"),
        "sha256": Digests::of(&output.text, toolpath, machine),
        "source": toolpath.describe(&shape),
        "machine": toolpath::describe(machine),
        "program": { "file": file, "blocks": output.blocks, "bytes": output.text.len() },
        "time_s": { "total": times.total(), "cutting": times.cutting, "rapid": times.rapid },
        "proof": proof,
    });
    let mut rows = toolpath.rows(Some(machine));
    rows.extend(shape.rows());
    rows.push(("time", time(&times)));
    rows.extend(prove::rows(&proof, machine));
    let account = Account { verdict: Verdict::Done, rows, data, findings: warnings };
    Ok(Posted { text: output.text, account })
}

/// The program with the rules that are let pass in its head, where there are some.
fn headed(program: &Program, tolerances: &Tolerances) -> Option<Program> {
    let names: Vec<&str> = tolerances.accepted.names().collect();
    if names.is_empty() {
        return None;
    }
    let mut headed = program.clone();
    let op = Op::Comment(format!("accepted for this run: {}", names.join(", ")).into());
    headed.records.insert(0, Record { line: 0, op });
    Some(headed)
}

/// Writes `program`, which came from `toolpath`. What the writer has to say goes behind the warnings that
/// there are, with the text of its lines.
///
/// # Errors
/// The same, where nothing could be written.
pub fn write(
    program: &Program,
    machine: &Machine,
    toolpath: &Toolpath,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Output, Stop> {
    match ::post::write(program, machine) {
        Ok(mut output) => {
            warnings.append(&mut output.warnings);
            toolpath.quote(warnings);
            Ok(output)
        }
        Err(mut findings) => {
            let verdict = verdict(&findings);
            warnings.append(&mut findings);
            toolpath.quote(warnings);
            Err(Stop { verdict, findings: std::mem::take(warnings) })
        }
    }
}

/// Whose fault it is that nothing could be written.
fn verdict(findings: &[Diagnostic]) -> Verdict {
    let mut errors = findings.iter().filter(|finding| finding.is_error());
    match errors.all(|error| MACHINE_CANNOT.contains(&error.rule)) {
        true => Verdict::Failed,
        false => Verdict::Invalid,
    }
}
