//! `toolpost fit`: places of the part at which a robot can make a toolpath.

use crate::answer::Answer;
use crate::args::Fit;
use crate::progress::Progress;
use app::fit::search;
use app::summary::{number, rows};
use app::toolpath::{self, describe};
use app::{Stop, Verdict, Watch};
use post::ArmMargins;
use program::{Diagnostic, Purpose};
use serde_json::{Value, json};

/// So many places at which nothing can be made are printed.
const MOST_REFUSED: usize = 3;

/// Looks for places, and prints them with their margins.
pub fn run(args: &Fit, silent: bool) -> Result<Answer, Stop> {
    let machine = toolpath::machine_with(&args.machine, &args.option)?;
    let progress = Progress::new(4, silent);
    progress.step("reading");
    let (source, origin) = (args.source.path.as_path().into(), args.source.origin.origin());
    let toolpath =
        toolpath::read(&source, args.source.strict, &origin, Some(&machine), Purpose::Program)?;
    let fit = search(&toolpath, &machine, args.within, &progress)?;
    let mut lines = toolpath.rows(Some(&machine));
    let (at, here) = &fit.here;
    lines.push(("here", format!("part = {}", numbers(at))));
    lines.push(("", here.as_ref().map_or_else(|found| refusal(found), margins)));
    let [looked, stood] = fit.looked;
    let text = format!(
        "{looked} places within {} mm, turned by quarters: at {stood} the arm stands at the points that were looked at",
        number(args.within, 1)
    );
    lines.push(("looked at", text));
    for place in &fit.places {
        lines.push(("place", format!("part = {}", numbers(&place.part))));
        lines.push(("", margins(&place.margins)));
    }
    if fit.places.is_empty() {
        lines.push((
            "place",
            String::from(
                "none: a larger --within, another robot, or a spindle that is tilted on the flange",
            ),
        ));
    }
    for (part, found) in fit.refused.iter().take(MOST_REFUSED) {
        lines.push(("not at", format!("part = {}", numbers(part))));
        lines.push(("", refusal(found)));
    }
    lines.push((
        "not checked",
        String::from("the arm against itself, the part and the cell; what carries the part there"),
    ));
    let placed =
        |part: &[f64; 6], margins: &ArmMargins| json!({ "part": part, "margins": data(margins) });
    let data = json!({
        "machine": describe(&machine),
        "here": match here {
            Ok(margins) => placed(at, margins),
            Err(found) => json!({ "part": at, "refused": found }),
        },
        "looked_at": looked,
        "stands_at": stood,
        "refused": fit.refused.iter().map(|(part, found)| json!({ "part": part, "refused": found })).collect::<Vec<_>>(),
        "places": fit.places.iter().map(|place| placed(&place.part, &place.margins)).collect::<Vec<_>>(),
    });
    let verdict = if fit.places.is_empty() { Verdict::Failed } else { Verdict::Done };
    Ok(Answer::product(rows(&lines), data).ending(verdict).findings(toolpath.warnings))
}

fn numbers(part: &[f64; 6]) -> String {
    let numbers: Vec<String> = part.iter().map(|value| number(*value, 4)).collect();
    format!("[{}]", numbers.join(", "))
}

/// Margins for a person.
pub fn margins(margins: &ArmMargins) -> String {
    let ArmMargins { limit, wrist, elbow, shoulder, speed, ease, reentries } = margins;
    let left = match reentries {
        0 => String::new(),
        1 => String::from("; a cut is left once and entered again"),
        times => format!("; cuts are left and entered again {times} times"),
    };
    format!(
        "margin {:.0} %: {limit:.1}° from a limit, joint 5 {wrist:.1}° and the elbow {elbow:.1}° from stretched, the wrist {shoulder:.0} mm from \
         axis 1, {speed:.0} % of a joint's speed{left}",
        100.0 * ease
    )
}

fn refusal(found: &Diagnostic) -> String {
    format!("refused: {} (line {})", found.message, found.line)
}

/// Margins for a machine.
pub fn data(margins: &ArmMargins) -> Value {
    json!({
        "limit_degrees": margins.limit,
        "wrist_degrees": margins.wrist,
        "elbow_degrees": margins.elbow,
        "shoulder_mm": margins.shoulder,
        "speed_percent": margins.speed,
        "margin_percent": 100.0 * margins.ease,
        "reentries": margins.reentries,
    })
}
