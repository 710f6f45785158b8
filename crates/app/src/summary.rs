//! What a program amounts to, as a machinist reads it and as JSON.

use drawing::walk;
use machine::Unsaid;
use machine::limits::Travel;
use machine::time::Times;
use program::Program;
use program::statistics::Statistics;
use proof::TravelChecked;
use serde::Serialize;

/// Totals of a toolpath, and of each tool.
#[derive(Debug, Serialize)]
pub struct Shape {
    /// The totals.
    #[serde(flatten)]
    statistics: Statistics,
    /// What each tool cuts, in the order of the first calls.
    tool_use: Vec<ToolUse>,
}

/// What one tool does.
#[derive(Debug, Serialize)]
struct ToolUse {
    /// What it is called.
    tool: String,
    /// Length of its cutting moves, mm.
    cutting_length: f64,
}

impl Shape {
    /// Measures `program`.
    pub fn of(program: &Program) -> Shape {
        let mut cutting = Vec::new();
        // Lengths do not depend on the chords; one a third of a turn is enough.
        let names = walk(program, f64::MAX, &mut |segment| {
            if cutting.len() <= segment.tool {
                cutting.resize(segment.tool + 1, 0.0);
            }
            if segment.cuts {
                cutting[segment.tool] += segment.length;
            }
        });
        let lengths = cutting.into_iter().chain(std::iter::repeat(0.0));
        let tool_use = names.into_iter().zip(lengths).enumerate();
        // The first stands for cutting without a tool call: it counts where that happens.
        let tool_use = tool_use.filter(|(i, (_, length))| *i > 0 || *length > 0.0);
        let tool_use =
            tool_use.map(|(_, (tool, cutting_length))| ToolUse { tool, cutting_length }).collect();
        Shape { statistics: Statistics::of(program), tool_use }
    }

    /// The lines of a summary: what, and how much.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let s = &self.statistics;
        let mut rows = Vec::new();
        for (i, used) in self.tool_use.iter().enumerate() {
            let head = if i == 0 { "tools" } else { "" };
            rows.push((head, format!("{}  cuts {}", used.tool, length(used.cutting_length))));
        }
        rows.push((
            "moves",
            format!(
                "{} lines, {} arcs, {} holes, {} rapids{}",
                s.lines,
                s.arcs,
                s.holes,
                s.rapids,
                if s.tilted { ", tool axis tilts" } else { "" }
            ),
        ));
        rows.push(("cutting", length(s.cutting_length)));
        rows.push(("rapid", length(s.rapid_length)));
        rows
    }

    /// The lines of a summary that tell how far the tool tip goes.
    pub fn extents(&self) -> impl Iterator<Item = (&'static str, String)> {
        let (low, high) = (self.statistics.low, self.statistics.high);
        let axes = ["X", "Y", "Z"].into_iter().enumerate();
        axes.map(move |(i, letter)| (letter, extent(low[i], high[i], "mm")))
    }
}

/// A length for a person: mm below ten metres, then metres.
pub fn length(mm: f64) -> String {
    if mm < 10_000.0 { format!("{mm:.1} mm") } else { format!("{:.2} m", mm / 1000.0) }
}

/// What a machine needs for a program.
pub fn time(times: &Times) -> String {
    let (total, cutting) = (duration(times.total()), duration(times.cutting));
    format!("{total}, {cutting} of it cutting")
}

/// A time for a person.
pub fn duration(seconds: f64) -> String {
    let seconds = seconds.round() as u64;
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    match (hours, minutes) {
        (0, 0) => format!("{seconds} s"),
        (0, _) => format!("{minutes} min {seconds:02} s"),
        _ => format!("{hours} h {minutes:02} min"),
    }
}

/// What of the travel of the axes was checked, what was not, and what to do about it.
pub fn travel(travel: &TravelChecked) -> String {
    let checked = match travel.linear {
        Travel::Unlimited => "not checked: the machine file gives no travel",
        Travel::Lengths => "only stroke lengths checked; set work_zero to check positions",
        Travel::MachineCoordinates => "positions checked in machine coordinates",
    };
    if travel.linear == Travel::Unlimited || travel.unsaid.is_empty() {
        return checked.to_owned();
    }
    let missing: Vec<String> = travel.unsaid.iter().map(unchecked).collect();
    format!("{checked}; unchecked: {}", missing.join(", "))
}

/// Positions that were not checked, and what is missing for that.
fn unchecked(unsaid: &Unsaid) -> String {
    match unsaid {
        Unsaid::AxisPoint(letter) => {
            format!("X, Y, Z where {letter} turns (set `point` of {letter})")
        }
        Unsaid::WorkZero => "X, Y, Z where the table turns (set work_zero)".into(),
        Unsaid::ToolLength => {
            "how low Z goes, and X, Y, Z where a head tilts (the source says no tool length: LENGTH in \
             LOAD/TOOL of cutter-location data, --tools with an NC program)"
                .into()
        }
        Unsaid::Solution => "tilted planes that have two solutions (set work_zero)".into(),
    }
}

/// How far something goes.
pub fn extent(low: f64, high: f64, unit: &str) -> String {
    let (low, high, size) = (number(low, 3), number(high, 3), number(high - low, 3));
    format!("{low} ... {high} {unit} ({size})")
}

/// A number with so many decimals, without zeros at its end.
pub fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { String::from("0") } else { text.to_owned() }
}

/// Lines of two columns.
pub fn rows(rows: &[(&str, String)]) -> String {
    let wide = rows.iter().map(|(head, _)| head.len()).max().unwrap_or(0);
    rows.iter().map(|(head, text)| format!("{head:wide$}  {text}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;
    use program::{ArcTo, Circle, Op, Pose, Tool};
    use std::f64::consts::TAU;

    #[test]
    fn times_are_printed_in_the_units_of_a_watch() {
        let printed = [0.4, 59.6, 3599.0, 3661.0].map(duration);
        assert_eq!(printed, ["0 s", "1 min 00 s", "59 min 59 s", "1 h 01 min"]);
    }

    #[test]
    fn numbers_have_no_needless_zeros() {
        let printed = [-0.0001, 100.0, -2.5, 0.12345].map(|value| number(value, 3));
        assert_eq!(printed, ["0", "100", "-2.5", "0.123"]);
    }

    #[test]
    fn each_tool_has_the_length_that_it_cuts() {
        let at = |x: f64, y: f64| Pose::upright(Vec3::new(x, y, 0.0)).unwrap();
        let tool = |number| Op::Tool(Box::new(Tool { number, ..Tool::default() }));
        let mut p = Program::new("t");
        p.push(1, tool(1));
        p.push(2, Op::Rapid(at(10.0, 0.0)));
        let circle =
            ArcTo { end: at(10.0, 0.0), circle: Circle::new(Vec3::ZERO, Vec3::Z, 0).unwrap() };
        p.push(3, Op::Arc(Box::new(circle)));
        p.push(4, tool(2));
        p.push(5, Op::Line(at(10.0, 30.0)));
        p.push(6, tool(1));
        p.push(7, Op::Line(at(15.0, 30.0)));
        let shape = Shape::of(&p);
        let used: Vec<_> =
            shape.tool_use.iter().map(|u| (u.tool.as_str(), u.cutting_length)).collect();
        assert_eq!(used[1], ("T2", 30.0));
        assert_eq!(used[0].0, "T1");
        assert!((used[0].1 - (10.0 * TAU + 5.0)).abs() < 1e-9);
        assert_eq!(used.len(), 2);
    }
}
