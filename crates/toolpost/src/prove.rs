//! `toolpost prove`: any program, also one edited by hand, held against the toolpath it should make.

use crate::answer::{Answer, Stop, Verdict};
use crate::args::{Closeness, Prove};
use crate::progress::Progress;
use crate::{files, summary, toolpath};
use proof::{Report, Tolerances};
use serde_json::json;

/// Runs the program on the virtual control of the machine and compares.
pub fn run(args: &Prove, silent: bool) -> Result<Answer, Stop> {
    let machine = toolpath::machine(&args.machine)?;
    let progress = Progress::new(2, silent);
    progress.step("reading");
    let toolpath = toolpath::read(&args.against, false)?;
    let text = files::read(&args.program)?;
    progress.step("proving");
    let program_file = files::name(&args.program);
    let tolerances = args.closeness.tolerances();
    let report = proof::prove(&toolpath.program, &machine, &program_file, &text, &tolerances);
    if !report.proven {
        return Ok(failed(&report, "").findings(toolpath.warnings));
    }
    let mut lines = vec![
        ("toolpath", format!("{} ({})", toolpath.file, toolpath.dialect)),
        ("program", program_file.clone()),
        ("machine", format!("{} ({})", machine.title, machine.name)),
    ];
    lines.extend(rows(&report));
    let data = json!({
        "toolpath": toolpath.file,
        "program": program_file,
        "machine": machine.name,
        "proof": report,
    });
    let mut warnings = toolpath.warnings;
    warnings.extend(report.warnings);
    Ok(Answer::summary(Verdict::Done, summary::rows(&lines), data).findings(warnings))
}

impl Closeness {
    /// As the proof takes it.
    pub fn tolerances(&self) -> Tolerances {
        Tolerances { position: self.tolerance, angle: None }
    }
}

/// The lines of a summary that tell of a proof that held.
pub fn rows(_report: &Report) -> Vec<(&'static str, String)> {
    vec![("proof", String::from("the program makes the motion of the toolpath"))]
}

/// The answer of a proof that failed: the mismatches, first to last.
pub fn failed(report: &Report, consequence: &str) -> Answer {
    let data = json!({ "proof": report });
    let text = rows_of_failure(consequence);
    Answer::summary(Verdict::Failed, text, data).findings(report.mismatches.clone())
}

fn rows_of_failure(consequence: &str) -> String {
    let mut lines = vec![("proof", String::from("failed"))];
    if !consequence.is_empty() {
        lines.push(("saved", consequence.to_owned()));
    }
    summary::rows(&lines)
}
