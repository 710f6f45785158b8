//! What is reported of the programs of a board.

use super::{Made, PROBE, Program};
use crate::summary::{duration, length, number};
use crate::toolpath;
use machine::Machine;
use pcb::board::{Axis, Face};
use pcb::plan::{Part, Problem, Settings, Setup};
use program::Diagnostic;
use serde_json::{Value, json};

/// The most problems that a summary lists.
const MOST_PROBLEMS: usize = 10;

/// What is reported: in rows for a person, in JSON for a machine.
pub struct Report {
    pub rows: Vec<(&'static str, String)>,
    pub data: Value,
}

/// The report of programs that are all proven.
pub fn of(made: &Made, settings: &Settings, machine: &Machine, warnings: &[Diagnostic]) -> Report {
    let Made { layers, setups: [Setup { board, axis, .. }, _], programs, .. } = made;
    let (low, high) = board.extents().unwrap_or_default();
    let size = high - low;
    let mut rows = vec![
        ("board", board.name.clone()),
        (
            "size",
            format!(
                "{} x {} mm, {} holes",
                number(size.x, 3),
                number(size.y, 3),
                board.holes.len()
            ),
        ),
    ];
    rows.extend(layers.iter().map(|(file, layer)| ("read", format!("{file}: {layer}"))));
    let missing = missing(made, settings);
    rows.extend(missing.iter().map(|what| ("missing", (*what).to_owned())));
    rows.push(("machine", format!("{} ({})", machine.title, machine.name)));
    let mut up = Face::Front;
    for program in programs {
        if let Some(face) = program.up.filter(|face| *face != up) {
            let (along, across, at) = turning(*axis);
            let text = format!(
                "the board over, about the line {across} {} (along {along}): its {face} is up",
                number(at, 3)
            );
            rows.push(("turn", text));
            up = face;
        }
        rows.extend(program.rows());
    }
    rows.extend(made.left_out.iter().map(|left| {
        let why = left.findings().next().map_or_else(String::new, |found| found.message);
        ("left out", format!("{}: {why}", left.file))
    }));
    let problems = programs
        .iter()
        .flat_map(|made| made.work.problems.iter().map(|problem| (made.name.as_str(), problem)));
    let shown = |(name, Problem { at, what, .. }): (&str, &Problem)| {
        format!("{name}, X{:.3} Y{:.3}: {what}", at.x, at.y)
    };
    rows.extend(problems.clone().take(MOST_PROBLEMS).map(|problem| ("look at", shown(problem))));
    let more = problems.clone().count().saturating_sub(MOST_PROBLEMS);
    if more > 0 {
        rows.push(("", format!("{more} places more, in the report and the pictures")));
    }
    let (along, _, at) = turning(*axis);
    let data = json!({
        "toolpost": env!("CARGO_PKG_VERSION"),
        "board": {
            "name": board.name,
            "files": layers.iter().map(|(file, layer)| json!({ "file": file, "layer": layer })).collect::<Vec<_>>(),
            "low_mm": low.to_array(),
            "high_mm": high.to_array(),
            "holes": board.holes.len(),
            "missing": missing,
            "turning_line": { "along": along, "at_mm": at },
        },
        "machine": toolpath::describe(machine),
        "programs": programs.iter().map(Program::describe).collect::<Vec<_>>(),
        "left_out": made.left_out.iter().map(|left| json!({
            "name": left.part.name(),
            "errors": left.findings().collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "warnings": warnings,
    });
    Report { rows, data }
}

/// The line about which the board is turned over: the axis along which it runs, the other one, and where it is on that, mm.
fn turning(axis: Axis) -> (&'static str, &'static str, f64) {
    match axis {
        Axis::X(at) => ("Y", "X", at),
        Axis::Y(at) => ("X", "Y", at),
    }
}

/// What a board lacks that boards have, where nobody has said which programs are made: a file that was not exported, or not
/// taken for what it is, leaves out a program without an error.
fn missing(made: &Made, settings: &Settings) -> Vec<&'static str> {
    let is_left_out = |part: Part| made.left_out.iter().any(|left| left.part == part);
    let is_made = |part: Part| made.programs.iter().any(|made| made.part == Some(part));
    let has = |part: Part| is_made(part) || is_left_out(part);
    let all = [
        (has(Part::Front) || has(Part::Back), "copper: no file has any, and nothing is isolated"),
        (has(Part::Drill), "holes: no file has any, and nothing is drilled"),
        (
            has(Part::Outline),
            "the outline: no file has the edge of the board, and nothing cuts it out (--board-margin 2 makes a rectangle)",
        ),
    ];
    let lacks = all.into_iter().filter(|(has, _)| !has && settings.only.is_empty());
    lacks.map(|(_, what)| what).collect()
}

impl Program {
    /// A line for each tool, and what the program amounts to.
    fn rows(&self) -> Vec<(&'static str, String)> {
        let account = &self.posted.account;
        let data = &account.data;
        let measures = &data["source"]["measures"];
        let measured = |value: &Value| value.as_f64().unwrap_or_default();
        let operations: Vec<&str> =
            self.work.operations.iter().map(|operation| operation.name.as_str()).collect();
        let part = self.part.map_or(PROBE, Part::name);
        let cuts = operations.join(", ");
        // One of several programs of a part has a name of its own.
        let cuts = if self.name == part { cuts } else { format!("{}: {cuts}", self.file) };
        let mut rows = vec![
            (part, cuts),
            (
                "",
                format!(
                    "{} blocks, cuts {}, rapid {}, {}; proven, off by {} mm at most",
                    data["program"]["blocks"],
                    length(measured(&measures["cutting_length"])),
                    length(measured(&measures["rapid_length"])),
                    duration(measured(&data["time_s"]["total"])),
                    number(measured(&data["proof"]["deviations"]["tip_mm"]["value"]), 5),
                ),
            ),
        ];
        if let (Some([wide, deep]), Some(operation)) = (self.probes, self.work.operations.first()) {
            let tool = &operation.tool.name;
            let text = format!(
                "first measures {wide} x {deep} heights with {tool}: set Z 0 on the copper, \
                 clip the probe to board and tool when it stops, and off when it stops again"
            );
            rows.push(("", text));
        }
        // What the writer says is no fault of the board.
        rows.extend(account.findings.iter().map(|found| ("", found.message.clone())));
        rows
    }

    fn describe(&self) -> Value {
        let problem = |Problem { at, kind, what }: &Problem| json!({ "x": at.x, "y": at.y, "kind": kind.name(), "what": what });
        let account = &self.posted.account;
        let mut data = account.data.clone();
        if let Some(data) = data.as_object_mut() {
            // Reported once for all programs.
            data.retain(|key, _| key != "toolpost" && key != "machine");
        }
        data["name"] = json!(self.name);
        data["file"] = json!(self.file);
        data["up"] = json!(self.up.map(|face| face.to_string()));
        if let Some([columns, rows]) = self.probes {
            data["measures_heights"] = json!({ "columns": columns, "rows": rows });
        }
        data["operations"] =
            json!(self.work.operations.iter().map(|operation| &operation.name).collect::<Vec<_>>());
        data["places"] = self.work.problems.iter().map(problem).collect();
        data["warnings"] = json!(account.findings);
        data
    }
}
