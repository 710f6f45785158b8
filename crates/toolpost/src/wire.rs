//! `toolpost wire`: a contour in, the proven program of a wire-EDM machine and its report out.

mod cutting;
mod leg;
mod proof;
mod report;
mod source;

use crate::answer::{Answer, Stop, Verdict};
use crate::args::{self, Division};
use crate::files::{self, Target};
use crate::progress::Progress;
use crate::report::Digests;
use crate::summary::rows;
use crate::{post, prove, toolpath};
use ::wire::Contour;
use ::wire::points::{Refusal, Step, points};
use drawing::Format;
use leg::Leg;
use machine::{Machine, Wire};
use program::Diagnostic;
use report::Cut;
use serde_json::json;
use source::Source;

/// Writes the program, proves it, and only then saves it with its report and its picture.
pub fn run(args: &args::Wire, silent: bool) -> Result<Answer, Stop> {
    let path = &args.source.path;
    let mut inputs = vec![path.as_path(), std::path::Path::new(&args.machine)];
    inputs.extend(args.ends.upper.as_deref());
    let report_path = files::report_of(&args.output);
    let target = Target::new(&args.output, &inputs)?;
    let report_target = Target::new(&report_path, &inputs)?;
    let picture = match &args.picture {
        Some(file) => Some((Target::new(file, &inputs)?, Format::of(file)?)),
        None => None,
    };
    let mut machine = toolpath::machine(&args.machine)?;
    set_up(&mut machine, args)?;

    let progress = Progress::new(if picture.is_some() { 5 } else { 4 }, silent);
    progress.step("reading");
    let Source { mut toolpath, paths, beside, height } = Source::read(args)?;
    let mut warnings = std::mem::take(&mut toolpath.warnings);
    progress.step("writing");
    let planned = cutting::legs(paths, &beside, &args.cutting, height);
    let (mut legs, rounded) = planned.map_err(|found| toolpath.refused(*found))?;
    warnings.extend(rounded);
    divide(&mut legs, &args.division, &machine)?;
    let cut = Cut::of(legs, height, &machine);
    let program = cut.program(&toolpath.program.name).map_err(Box::<Diagnostic>::from)?;
    let output = post::write(&program, &machine, &toolpath, &mut warnings)?;
    progress.step("proving");
    if cut.points().is_some() {
        // Chords may leave their arcs by what the conversion has made of them, and by no more.
        machine.capabilities.lowering_tolerance = cut.chord_error();
    }
    let file = files::name(&args.output);
    let tolerances = args.closeness.tolerances();
    let proof = proof::of(&cut, &machine, &toolpath.program.name, &file, &output.text, &tolerances)
        .map_err(Box::<Diagnostic>::from)?;
    if !proof.proven {
        let mut failed = prove::failed(&proof, &toolpath, &file);
        failed.findings.extend(warnings);
        return Ok(failed.not_saved());
    }

    warnings.extend(proof.warnings.iter().cloned());
    let data = json!({
        "schema": crate::report::SCHEMA,
        "toolpost": env!("CARGO_PKG_VERSION"),
        "sha256": Digests::of(&output.text, &toolpath, &machine),
        "source": { "file": toolpath.file, "dialect": toolpath.dialect },
        "machine": toolpath::describe(&machine),
        "program": { "file": file, "blocks": output.blocks, "bytes": output.text.len() },
        "wire": cut.summary(args.select),
        "proof": proof,
    });
    let mut report = data.clone();
    report["instructions"] = cut.instructions();
    report["warnings"] = json!(warnings);
    let report = format!("{report:#}\n");
    let drawn = match &picture {
        Some((_, format)) => {
            progress.step("drawing");
            Some(format.bytes(drawing::wire_path(&toolpath.file, &cut.picture(args.select)))?)
        }
        None => None,
    };
    let picture_target = picture.iter().map(|(target, _)| target);
    let targets: Vec<&Target> = picture_target.chain([&target, &report_target]).collect();
    post::spare(&targets, &toolpath, &machine)?;
    progress.step("saving");
    let mut saved = vec![(&report_target, report.as_bytes())];
    if let (Some((target, _)), Some(bytes)) = (&picture, &drawn) {
        saved.push((target, bytes));
    }
    saved.push((&target, &output.text));
    files::save(&saved)?;

    let mut lines = toolpath.rows(Some(&machine));
    lines.extend(cut.rows(args.select));
    lines.extend(prove::rows(&proof, &machine));
    lines.push(("saved", args.output.display().to_string()));
    lines.push(("", report_path.display().to_string()));
    lines.extend(args.picture.as_ref().map(|file| ("", file.display().to_string())));
    Ok(Answer::summary(Verdict::Done, rows(&lines), data).findings(warnings))
}

/// The machine with what the call says of it.
fn set_up(machine: &mut Machine, args: &args::Wire) -> Result<(), Stop> {
    let Some(wire) = machine.wire else {
        let message = format!("`{}` is a mill: its file has no [wire] table", machine.name);
        let help = "`toolpost post` writes for mills; `toolpost machines list` names the machines";
        return Err(Diagnostic::error("machine-kind", message).help(help).into());
    };
    if args.cutting.by_control && !machine.capabilities.compensation {
        let message = format!("the control of `{}` offsets no wire", machine.name);
        let help = "leave --by-control out: the way of the wire's centre is then worked out here";
        return Err(Diagnostic::error("by-control", message).help(help).into());
    }
    if args.cutting.tab.is_some() && !machine.blocks.contains_key("stop") {
        let message = format!(
            "a tab is cut while the operator holds the part, and `{}` has no block `stop`",
            machine.name
        );
        let help = "leave --tab out, or write how the control stops into the machine's file";
        return Err(Diagnostic::error("tab", message).help(help).into());
    }
    let height = match (wire.height, args.ends.uv_height) {
        (Some(own), Some(said)) if own != said => {
            let message = format!(
                "`{}` counts U and V in a plane {own} mm up, and --uv-height says {said} mm",
                machine.name
            );
            let help = "leave --uv-height out, or change `height` in [wire] of the machine's file";
            return Err(Diagnostic::error("wire-height", message).help(help).into());
        }
        (own, said) => own.or(said),
    };
    machine.wire = Some(Wire { height, memory: args.division.memory.or(wire.memory), ..wire });
    Ok(())
}

/// Makes points of the ways, where the control cannot cut all of them as they are, and where a step is
/// asked for.
fn divide(legs: &mut [Leg], how: &Division, machine: &Machine) -> Result<(), Stop> {
    let asked = match (how.step, how.chord_error, how.fit) {
        (Some(step), ..) => Some(Step::Length(step)),
        (_, Some(error), _) => Some(Step::ChordError(error)),
        (.., true) => Some(Step::Fit),
        _ => None,
    };
    let arcs = |contour: &Contour| contour.elements().iter().any(|e| e.turn.is_some());
    let no_arcs = machine.capabilities.arcs.is_empty();
    let cannot = |leg: &Leg| leg.leans() || (no_arcs && arcs(leg.path.lower()));
    if asked.is_none() && !legs.iter().any(cannot) {
        return Ok(());
    }
    let step = asked.unwrap_or(Step::ChordError(machine.capabilities.lowering_tolerance));
    let memory = machine.wire.and_then(|wire| wire.memory);
    let paths: Vec<_> = legs.iter().map(|leg| &leg.path).collect();
    let all = points(&paths, step, memory).map_err(refused)?;
    for (leg, points) in legs.iter_mut().zip(all) {
        leg.points = Some(points);
    }
    Ok(())
}

/// Why there are no points, with the step that would do where one would.
fn refused(Refusal { diagnostic, offer }: Refusal) -> Stop {
    let finest = |mm: f64| (mm * 1e6).ceil() / 1e6;
    let way_out = match offer {
        Some(Step::Length(mm)) => {
            format!("--step {} is the finest that fits, or --fit", finest(mm))
        }
        Some(Step::ChordError(mm)) => {
            format!("--chord-error {} is the smallest that fits, or --fit", finest(mm))
        }
        _ => diagnostic.help.clone(),
    };
    let verdict = if diagnostic.rule == "memory" { Verdict::Failed } else { Verdict::Invalid };
    Stop { verdict, findings: vec![diagnostic.help(way_out)] }
}
