//! `toolpost post`: toolpath in, proven program and its report out.

use crate::answer::{Answer, Stop, Verdict};
use crate::args::Post;
use crate::files::{self, Target};
use crate::progress::Progress;
use crate::summary::{Shape, rows, time, travel};
use crate::{prove, toolpath};
use machine::limits::Travel;
use machine::time::Times;
use program::Diagnostic;
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

/// Writes the program, proves it, and only then saves it with its report.
pub fn run(args: &Post, silent: bool) -> Result<Answer, Stop> {
    let source = &args.source.path;
    let inputs = [source.as_path(), Path::new(&args.machine)];
    let report_path = args.output.with_extension("report.json");
    let target = Target::new(&args.output, &inputs)?;
    let report_target = Target::new(&report_path, &inputs)?;
    let mut machine = toolpath::machine(&args.machine)?;
    for (name, value) in &args.option {
        machine.set_option(name, value)?;
    }
    if machine.wire.is_some() {
        let message = format!("`{}` cuts by wire: it has no spindle and no tools", machine.name);
        let help = "`toolpost wire` writes for it";
        return Err(Diagnostic::error("machine-kind", message).help(help).into());
    }

    let progress = Progress::new(4, silent);
    progress.step("reading");
    let mut toolpath =
        toolpath::read(source, args.source.strict, &args.source.origin, Some(&machine))?;
    let mut warnings = std::mem::take(&mut toolpath.warnings);
    progress.step("writing");
    let output = post::write(&toolpath.program, &machine).map_err(|mut findings| {
        toolpath.quote(&mut findings);
        let verdict = verdict(&findings);
        findings.splice(0..0, std::mem::take(&mut warnings));
        Stop { verdict, findings }
    })?;
    warnings.extend(output.warnings);
    toolpath.quote(&mut warnings);
    progress.step("proving");
    let file = files::name(&args.output);
    let tolerances = args.closeness.tolerances();
    let proof = proof::prove(&toolpath.program, &machine, &file, &output.text, &tolerances);
    if !proof.proven {
        let failed = prove::failed(&proof, &toolpath, &file, "not saved: nothing was changed");
        return Ok(failed.findings(warnings));
    }

    progress.step("saving");
    warnings.extend(proof.warnings.iter().cloned());
    let shape = Shape::of(&toolpath.program);
    let times = Times::of(&toolpath.program, &machine);
    let data = json!({
        "toolpost": env!("CARGO_PKG_VERSION"),
        "source": toolpath.describe(&shape),
        "machine": toolpath::describe(&machine),
        "program": { "file": file, "blocks": output.blocks, "bytes": output.text.len() },
        "travel": Travel::of(&machine),
        "time_s": { "total": times.total(), "cutting": times.cutting, "rapid": times.rapid },
        "proof": proof,
    });
    let mut report = data.clone();
    report["warnings"] = json!(warnings);
    let report = format!("{report:#}\n");
    files::save(&[(&report_target, report.as_bytes()), (&target, &output.text)])?;

    let mut lines = toolpath.rows(Some(&machine));
    lines.extend(shape.rows());
    lines.push(("time", time(&times)));
    lines.push(("travel", travel(Travel::of(&machine))));
    lines.extend(prove::rows(&proof, &machine));
    lines.push(("saved", args.output.display().to_string()));
    lines.push(("", report_path.display().to_string()));
    Ok(Answer::summary(Verdict::Done, rows(&lines), data).findings(warnings))
}

/// Whose fault it is that nothing could be written.
pub fn verdict(findings: &[Diagnostic]) -> Verdict {
    let mut errors = findings.iter().filter(|finding| finding.is_error());
    match errors.all(|error| MACHINE_CANNOT.contains(&error.rule)) {
        true => Verdict::Failed,
        false => Verdict::Invalid,
    }
}
