//! `toolpost post`: toolpath in, proven program and its report out.

use crate::answer::{Answer, Stop, Verdict};
use crate::args::Post;
use crate::files::{self, Target};
use crate::progress::Progress;
use crate::summary::{Shape, rows};
use crate::{prove, toolpath};
use serde_json::json;
use std::path::Path;

/// Writes the program, proves it, and only then saves it with its report.
pub fn run(args: &Post, silent: bool) -> Result<Answer, Stop> {
    let source = &args.source.path;
    let inputs = [source.as_path(), Path::new(&args.machine)];
    let report_path = args.output.with_extension("report.json");
    let target = Target::new(&args.output, &inputs)?;
    let report_target = Target::new(&report_path, &inputs)?;
    let machine = toolpath::machine(&args.machine)?;

    let progress = Progress::new(4, silent);
    progress.step("reading");
    let toolpath = toolpath::read(source, args.source.strict)?;
    progress.step("writing");
    let output = post::write(&toolpath.program, &machine)
        .map_err(|findings| Stop { verdict: Verdict::Failed, findings })?;
    progress.step("proving");
    let program_file = files::name(&args.output);
    let proof = proof::prove(
        &toolpath.program,
        &machine,
        &program_file,
        &output.text,
        &args.closeness.tolerances(),
    );
    let mut warnings = toolpath.warnings;
    warnings.extend(output.warnings);
    if !proof.proven {
        let stop = prove::failed(&proof, "nothing was saved");
        return Ok(stop.findings(warnings));
    }

    progress.step("saving");
    let shape = Shape::of(&toolpath.program);
    warnings.extend(proof.warnings.iter().cloned());
    let data = json!({
        "toolpost": env!("CARGO_PKG_VERSION"),
        "toolpath": toolpath.file,
        "dialect": toolpath.dialect,
        "machine": { "name": machine.name, "title": machine.title, "control": machine.control },
        "program": program_file,
        "blocks": output.blocks,
        "bytes": output.text.len(),
        "shape": shape,
        "proof": proof,
        "warnings": warnings,
    });
    let mut report = serde_json::to_vec_pretty(&data).unwrap_or_default();
    report.push(b'\n');
    files::save(&[(&report_target, &report), (&target, &output.text)])?;

    let mut lines = vec![
        ("toolpath", format!("{} ({})", toolpath.file, toolpath.dialect)),
        ("machine", format!("{} ({})", machine.title, machine.name)),
    ];
    lines.extend(shape.rows());
    lines.push(("program", format!("{} blocks", output.blocks)));
    lines.extend(prove::rows(&proof));
    lines.push(("saved", args.output.display().to_string()));
    lines.push(("report", report_path.display().to_string()));
    Ok(Answer::summary(Verdict::Done, rows(&lines), data).findings(warnings))
}
