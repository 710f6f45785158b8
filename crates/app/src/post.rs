//! Writing a program, and proving it.

use crate::account::{Account, Stop, Verdict};
use crate::parallel::parallel;
use crate::prove;
use crate::report::{self, Digests};
use crate::summary::Shape;
use crate::toolpath::{self, Toolpath};
use crate::watch::{Waits, Watch};
use ::post::{Origins, Output, Part};
use control::{Dialect, Folders};
use machine::Machine;
use program::{Diagnostic, Op, Program, Record, Rule};
use proof::Tolerances;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Rules whose findings say that the machine cannot do what the toolpath asks for. All others of the
/// writer are mistakes of the input: of the toolpath, or of the machine's file.
const MACHINE_CANNOT: [Rule; 23] = [
    Rule::ArcOrientation,
    Rule::ArmPath,
    Rule::AxisLimit,
    Rule::NoCycle,
    Rule::CycleTap,
    Rule::Feed,
    Rule::FeedRange,
    Rule::LineLength,
    Rule::Linearisation,
    Rule::Memory,
    Rule::NumberRange,
    Rule::OneOpening,
    Rule::OrientationInCut,
    Rule::Posture,
    Rule::RapidPath,
    Rule::SpindleRange,
    Rule::Taper,
    Rule::TaperLimit,
    Rule::ToolRange,
    Rule::UnreachableOrientation,
    Rule::Unsupported,
    Rule::UvLimit,
    Rule::WireLeans,
];

/// A program that is proven, or is not, and what is reported of it.
#[derive(Debug)]
pub struct Posted {
    /// The program. Nobody should have it whose account does not say that it is proven.
    pub text: Vec<u8>,
    /// Which template wrote each line of it, for which record of the program that its proof compares it with, which whoever watches
    /// is given ([`Watch::follow`]).
    pub origins: Origins,
    /// The files that it calls, which lie beside it; none where it is whole.
    pub parts: Vec<Part>,
    /// What is reported of it.
    pub account: Account,
}

impl Posted {
    /// The files that it calls, by their names.
    pub fn called(&self) -> Vec<(&str, &[u8])> {
        self.parts.iter().map(|part| (&*part.file, &part.text[..])).collect()
    }
}

/// Writes the program of `toolpath`, which is called `file`, and proves it.
///
/// # Errors
/// Why there is no program.
pub fn proven(
    toolpath: &Toolpath,
    machine: &Machine,
    file: &str,
    tolerances: &Tolerances,
    watch: &dyn Watch,
) -> Result<Posted, Stop> {
    if machine.wire.is_some() {
        let message = format!("`{}` cuts by wire: it has no spindle and no tools", machine.name);
        let help = "`toolpost wire` writes for it";
        return Err(Diagnostic::error(Rule::MachineKind, message).help(help).into());
    }
    if let Some(dialect) = Dialect::named(&machine.reader) {
        control::check_file_name(dialect, file)?;
    }
    let mut warnings = toolpath.warnings.clone();
    watch.begin("writing")?;
    let program = &toolpath.program;
    // What is reported of the toolpath is found meanwhile.
    let headed = headed(program, tolerances);
    let (output, shape) = parallel(
        || {
            let program = headed.as_ref().unwrap_or(program);
            write((program, file), machine, toolpath, &mut warnings, watch)
        },
        || Shape::of(program),
    );
    watch.go_on()?;
    let mut output = output?;
    if headed.is_some() {
        // The records of the toolpath stand behind the one that its head has more.
        let place = |record: usize| record.checked_sub(1);
        output.origins = output.origins.moved(place);
        for part in &mut output.parts {
            part.origins = std::mem::take(&mut part.origins).moved(place);
        }
    }
    watch.begin("proving")?;
    let mut follower = watch.followed(file, program, machine);
    let parts: BTreeMap<String, Vec<u8>> =
        output.parts.iter().map(|part| (part.file.clone(), part.text.clone())).collect();
    let folders = Folders::from(parts);
    let text = (file, &output.text[..], &folders);
    let proof = proof::prove_files(program, machine, text, tolerances, &mut follower);
    watch.go_on()?;
    if !proof.proven {
        let mut account = prove::failed(&proof, toolpath, file);
        account.findings.extend(warnings);
        let Output { text, origins, parts, .. } = output;
        return Ok(Posted { text, origins, parts, account });
    }

    warnings.extend(proof.warnings.iter().chain(&proof.accepted).cloned());
    let data = json!({
        "schema": report::SCHEMA,
        "toolpost": env!("CARGO_PKG_VERSION"),
        "sha256": Digests::of(&output.text, &texts(&output.parts), toolpath, machine),
        "source": toolpath.describe(&shape),
        "machine": toolpath::describe(machine),
        "program": about(file, &output),
        "time_s": prove::time(&proof),
        "proof": proof,
    });
    let mut rows = toolpath.rows(Some(machine));
    rows.extend(shape.rows());
    rows.extend(prove::rows(&proof, machine));
    rows.extend(files(&output).map(|text| ("files", text)));
    let account = Account { verdict: Verdict::Done, rows, data, findings: warnings };
    let Output { text, origins, parts, .. } = output;
    Ok(Posted { text, origins, parts, account })
}

/// The texts of parts, in the order of the names of their files.
fn texts(parts: &[Part]) -> Vec<&[u8]> {
    let mut parts: Vec<&Part> = parts.iter().collect();
    parts.sort_by_key(|part| &part.file);
    parts.into_iter().map(|part| &part.text[..]).collect()
}

/// The size of a program, of all its files together, bytes.
fn bytes(output: &Output) -> usize {
    output.text.len() + output.parts.iter().map(|part| part.text.len()).sum::<usize>()
}

/// What a report says of a program and the files that it calls.
fn about(file: &str, output: &Output) -> Value {
    let bytes = output.text.len();
    let mut about = json!({ "file": file, "blocks": output.blocks, "bytes": bytes });
    report::set_parts(&mut about, output.parts.iter().map(|part| (&*part.file, &part.text[..])));
    about
}

/// What a summary says of the files of a program that is divided.
fn files(output: &Output) -> Option<String> {
    let [first, .., last] = &output.parts[..] else { return None };
    let count = output.parts.len();
    let largest = output.parts.iter().map(|part| part.text.len()).max().unwrap_or_default();
    Some(format!(
        "{} of {} bytes together: the main program calls {count} parts, {} to {}, of {largest} bytes at most",
        count + 1,
        bytes(output),
        first.file,
        last.file,
    ))
}

/// The program with the rules that are let pass in its head, where there are some.
fn headed(program: &Program, tolerances: &Tolerances) -> Option<Program> {
    let names: Vec<&str> = tolerances.accepted.rules().map(Rule::name).collect();
    if names.is_empty() {
        return None;
    }
    let mut headed = program.clone();
    let op = Op::Comment(format!("accepted for this run: {}", names.join(", ")).into());
    headed.records.insert(0, Record { line: 0, op });
    Some(headed)
}

/// Writes `program`, which came from `toolpath`, for the file of this name. What the writer has to say goes behind the warnings that
/// there are, with the text of its lines.
///
/// # Errors
/// The same, where nothing could be written.
pub(crate) fn write(
    (program, file): (&Program, &str),
    machine: &Machine,
    toolpath: &Toolpath,
    warnings: &mut Vec<Diagnostic>,
    watch: &dyn Watch,
) -> Result<Output, Stop> {
    match ::post::write_named(program, machine, file, &Waits(watch)) {
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
pub fn verdict(findings: &[Diagnostic]) -> Verdict {
    let mut errors = findings.iter().filter(|finding| finding.is_error());
    match errors.all(|error| MACHINE_CANNOT.contains(&error.rule)) {
        true => Verdict::Failed,
        false => Verdict::Invalid,
    }
}
