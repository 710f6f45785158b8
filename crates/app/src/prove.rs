//! Proving any program, also one edited by hand.

use crate::account::{Account, Stop, Verdict};
use crate::parallel::parallel;
use crate::summary::{self, Shape, number};
use crate::toolpath::{self, Toolpath};
use crate::watch::Watch;
use control::Folders;
use machine::Machine;
use proof::{ArmChecked, Report, Tolerances, Worst};
use serde_json::{Value, json};

/// Proves the program `text`, which is called `file` and may call those of `folders`, against `toolpath`.
///
/// # Errors
/// The caller has ended it.
pub fn compare(
    toolpath: &Toolpath,
    machine: &Machine,
    (file, text, folders): (&str, &[u8], &Folders),
    tolerances: &Tolerances,
    watch: &dyn Watch,
) -> Result<Account, Stop> {
    watch.begin("proving")?;
    let program = &toolpath.program;
    // What is reported of the toolpath is found meanwhile.
    let mut follower = watch.followed(file, program, machine);
    let text_and = (file, text, folders);
    let prove = || proof::prove_files(program, machine, text_and, tolerances, &mut follower);
    let (proof, shape) = parallel(prove, || Shape::of(program));
    watch.go_on()?;
    let mut warnings = toolpath.warnings.clone();
    toolpath.quote(&mut warnings);
    if !proof.proven {
        let mut account = failed(&proof, toolpath, file);
        account.findings.extend(warnings);
        return Ok(account);
    }
    let found = proof.warnings.iter().chain(&proof.accepted);
    let findings = warnings.into_iter().chain(found.cloned()).collect();
    let data = json!({
        "source": toolpath.describe(&shape),
        "machine": toolpath::describe(machine),
        "program": { "file": file, "blocks": proof.program.blocks, "bytes": text.len() },
        "time_s": time(&proof),
        "proof": proof,
    });
    let mut rows = toolpath.rows(Some(machine));
    rows.extend(shape.rows());
    rows.extend(self::rows(&proof, machine));
    Ok(Account { verdict: Verdict::Done, rows, data, findings })
}

/// How long a proven program takes, s, as JSON.
pub(crate) fn time(proof: &Report) -> Value {
    let times = &proof.program.time_s;
    json!({ "total": times.total(), "cutting": times.cutting, "rapid": times.rapid })
}

/// The lines of a summary about a program and its proof, which held.
pub(crate) fn rows(proof: &Report, machine: &Machine) -> Vec<(&'static str, String)> {
    let (program, worst, allowed) = (&proof.program, &proof.deviations, &proof.tolerances);
    let mut rows = Vec::new();
    // A wire has its own, which knows where the feed is not known.
    if machine.wire.is_none() {
        rows.push(("time", summary::time(&program.time_s)));
    }
    rows.push(("program", format!("{} blocks", program.blocks)));
    let linear = ["X", "Y", "Z"].into_iter().zip(program.linear_extents_mm);
    let linear = linear.take(if machine.wire.is_some() { 2 } else { 3 });
    let rotary = ["A", "B", "C"].into_iter().zip(program.rotary_extents_degrees);
    let rotary =
        rotary.filter(|(letter, _)| machine.rotary.iter().any(|r| letter.starts_with(r.letter)));
    let axes = linear.map(|axis| (axis, "mm")).chain(rotary.map(|axis| (axis, "degrees")));
    let leans = |extent: &proof::Extent| extent.min != extent.max || extent.min != Some(0.0);
    let uv = program.uv_extents_mm;
    let uv = ["U", "V"].into_iter().zip(uv).filter(|_| uv.iter().any(leans));
    for ((letter, extent), unit) in axes.chain(uv.map(|axis| (axis, "mm"))) {
        if let (Some(min), Some(max)) = (extent.min, extent.max) {
            rows.push((letter, summary::extent(min, max, unit)));
        }
    }
    match &proof.arm {
        Some(arm) => {
            rows.extend(joints(arm));
            let (count, more) = (proof.compared.slowed, number(arm.slowed_s, 1));
            if count > 0 {
                let text = format!(
                    "not reached in {count} cuts, in which the control turns the tool no faster: they take {more} s longer"
                );
                rows.push(("feed", text));
            }
        }
        None if machine.wire.is_none() => {
            rows.push(("travel", summary::travel(&proof.travel)));
        }
        None => {}
    }
    let compared = &proof.compared;
    let moves = compared.rapids + compared.lines + compared.arcs + compared.holes;
    rows.push(("proof", format!("passed: {moves} moves match the toolpath")));
    if compared.contours > 0 {
        let text = format!("{}, each with the tool on the right side of it", compared.contours);
        rows.push(("contours", text));
    }
    let deviation = |worst: &Worst, allowed: f64, unit: &str| {
        let place = match (worst.program_line, &worst.program_file) {
            (0, _) => String::new(),
            (line, None) => format!(" (line {line})"),
            (line, Some(file)) => format!(" ({file}, line {line})"),
        };
        format!("{} {unit} at most{place}; {} allowed", number(worst.value, 5), number(allowed, 5))
    };
    let axis = &worst.axis_degrees;
    rows.push(("tip deviation", deviation(&worst.tip_mm, allowed.tip_mm, "mm")));
    if axis.value > 0.0 {
        rows.push(("axis deviation", deviation(axis, allowed.axis_degrees, "degrees")));
    }
    let rapid = &worst.rapid_mm;
    if rapid.value > allowed.tip_mm {
        let corridor = machine.capabilities.rapid_corridor;
        rows.push(("rapid deviation", deviation(rapid, corridor, "mm")));
    }
    let speed = &worst.tip_speed_percent;
    if speed.value > 0.0 {
        let slowed = match compared.slowed {
            0 => String::new(),
            count => format!(
                "; slower than its feed in {count} cuts, in which an axis or F goes no faster"
            ),
        };
        let (percent, line) = (number(speed.value, 2), speed.program_line);
        rows.push(("tip speed", format!("off by {percent} % at most (line {line}){slowed}")));
    }
    let most = machine.path_tolerance().max(machine.roughing_tolerance());
    if most > 0.0 {
        let most = number(most, 5);
        let tool = machine.orientation_tolerance();
        let tool = match tool > 0.0 {
            true => format!(", the tool by up to {}°,", number(tool, 5)),
            false => String::new(),
        };
        let text =
            format!("by up to {most} mm{tool} where the program lets it, which no proof sees");
        rows.push(("smoothing", text));
    }
    if !proof.accepted.is_empty() {
        let rules: Vec<&str> = proof.accepted.iter().map(|found| found.rule.name()).collect();
        rows.push(("accepted", format!("{}, which the proof would refuse", rules.join(", "))));
    }
    if compared.excursions > 0 {
        rows.push(("excursions", format!("{}, listed in the report", compared.excursions)));
    }
    rows
}

/// The lines of a summary about the joints of a robot.
fn joints(arm: &ArmChecked) -> Vec<(&'static str, String)> {
    let degrees = |least: Option<f64>| match least {
        Some(least) => format!("{}°", number(least, 1)),
        None => String::from("-"),
    };
    let text = format!(
        "{} from a limit, joint 5 {} from stretched, {:.0} % of a joint's speed in lines and arcs",
        degrees(arm.limit_degrees),
        degrees(arm.wrist_degrees),
        arm.speed_percent
    );
    let not =
        "the arm against itself, the part and the cell; its load; how it brakes and accelerates";
    vec![("joints", text), ("not checked", String::from(not))]
}

/// What is reported of a program whose proof failed: the first mismatch side by side, and all of them as
/// findings.
pub(crate) fn failed(proof: &Report, source: &Toolpath, program: &str) -> Account {
    let mut rows = vec![
        ("proof", String::from("FAILED")),
        ("program", String::from("the motion differs from the source")),
    ];
    if let Some(first) = &proof.first_mismatch {
        // A board has no lines.
        if first.source_line > 0 {
            let (place, text) = source.location(first.source_line);
            rows.push(("source says", format!("{place}  {}", text.trim())));
        }
        let block = first.block.trim();
        let file = first.program_file.as_deref().unwrap_or(program);
        rows.push(("program says", format!("{file}:{}  {block}", first.program_line)));
    }
    let (data, findings) = (json!({ "proof": proof }), proof.mismatches.clone());
    Account { verdict: Verdict::Failed, rows, data, findings }
}
