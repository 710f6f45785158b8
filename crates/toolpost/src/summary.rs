//! What a program amounts to, as a machinist reads it and as JSON.

use crate::walk::walk;
use program::Program;
use program::statistics::Statistics;
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
        for (i, letter) in ["X", "Y", "Z"].into_iter().enumerate() {
            let (low, high) = (s.low[i], s.high[i]);
            rows.push((letter, format!("{low:.3} ... {high:.3} mm  ({:.3})", high - low)));
        }
        rows
    }
}

/// A length for a person: mm below ten metres, then metres.
fn length(mm: f64) -> String {
    if mm < 10_000.0 { format!("{mm:.1} mm") } else { format!("{:.2} m", mm / 1000.0) }
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
    use program::{ArcTo, Op, Pose, Tool};
    use std::f64::consts::TAU;

    #[test]
    fn each_tool_has_the_length_that_it_cuts() {
        let at = |x: f64, y: f64| Pose::new(Vec3::new(x, y, 0.0), Vec3::Z);
        let tool = |number| Op::Tool(Box::new(Tool { number, ..Tool::default() }));
        let mut p = Program::new("t");
        p.push(1, tool(1));
        p.push(2, Op::Rapid(at(10.0, 0.0)));
        let circle = ArcTo { end: at(10.0, 0.0), center: Vec3::ZERO, normal: Vec3::Z, turns: 0 };
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
