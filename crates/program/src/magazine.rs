//! Which tools a program calls by which number.

use crate::{Diagnostic, Op, Program, Record, Rule, Tool};
use std::collections::HashMap;

/// Two sizes of one tool that differ by less are one, mm.
const SAME_SIZE: f64 = 1e-4;

impl Program {
    /// Whether it calls tools of more than one number.
    pub fn calls_several_tools(&self) -> bool {
        let number = |record: &Record| {
            let Op::Tool(tool) = &record.op else { return None };
            Some(tool.number)
        };
        let mut numbers = self.records.iter().filter_map(number);
        numbers.next().is_some_and(|first| numbers.any(|number| number != first))
    }

    /// Two different tools under one number: the change from the one to the other is a change of a number against itself, which
    /// a control skips, and the first of them goes on. An error, at the second of them, where a size that both have differs; a
    /// warning where they have no size in common and their names differ. One for each number.
    pub fn tools_under_one_number(&self) -> Vec<Diagnostic> {
        let mut first: HashMap<u32, (u32, &Tool)> = HashMap::new();
        let (mut found, mut reported) = (Vec::new(), Vec::new());
        for record in &self.records {
            let Op::Tool(tool) = &record.op else { continue };
            if tool.number == 0 || reported.contains(&tool.number) {
                continue;
            }
            let (line, other) = *first.entry(tool.number).or_insert((record.line, tool));
            let Some((differs, is_sure)) = difference(other, tool) else { continue };
            reported.push(tool.number);
            let message = format!(
                "two tools have the number {}: {differs} (the first is in line {line})",
                tool.number
            );
            let new = if is_sure { Diagnostic::error } else { Diagnostic::warning };
            found.push(new(Rule::ToolTwice, message).line(record.line));
        }
        found
    }
}

/// How two tools differ, and whether in a size.
fn difference(a: &Tool, b: &Tool) -> Option<(String, bool)> {
    let sizes = [
        ("diameter", a.diameter, b.diameter),
        ("corner radius", a.corner_radius, b.corner_radius),
        ("length", a.length, b.length),
    ];
    let both = |(name, a, b): (&'static str, Option<f64>, Option<f64>)| Some((name, a?, b?));
    let mut common = false;
    for (name, a, b) in sizes.into_iter().filter_map(both) {
        common = true;
        if (a - b).abs() > SAME_SIZE {
            return Some((format!("a {name} of {a} mm and one of {b} mm"), true));
        }
    }
    let (this, other) = (a.name.trim(), b.name.trim());
    let renamed = !common && !this.is_empty() && !other.is_empty() && this != other;
    renamed.then(|| (format!("{} and {}", shown(this), shown(other)), false))
}

/// A name in quotes, of which a long one is cut.
fn shown(name: &str) -> String {
    let start: String = name.chars().take(40).collect();
    format!("\"{start}\"")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Severity;

    fn found(tools: &[Tool]) -> Vec<(Severity, u32)> {
        let mut program = Program::new("tools");
        for (line, tool) in (1..).zip(tools) {
            program.push(10 * line, Op::Tool(Box::new(tool.clone())));
        }
        let found = program.tools_under_one_number();
        found.iter().map(|found| (found.severity, found.line)).collect()
    }

    fn tool(number: u32, name: &str, diameter: Option<f64>) -> Tool {
        Tool { number, name: name.into(), diameter, ..Tool::default() }
    }

    #[test]
    fn two_sizes_under_one_number_are_an_error_at_the_second() {
        let (ten, six) = (tool(1, "A", Some(10.0)), tool(1, "A", Some(6.0)));
        let error = [(Severity::Error, 20)];
        assert_eq!(found(&[ten.clone(), six.clone()]), error);
        assert_eq!(found(&[ten.clone(), six.clone(), ten.clone(), six.clone()]), error);
        assert_eq!(found(&[ten.clone(), ten.clone()]), []);
        assert_eq!(found(&[ten.clone(), tool(2, "A", Some(6.0))]), []);
        let long = |length| Tool { length: Some(length), ..ten.clone() };
        assert_eq!(found(&[long(80.0), long(90.0)]), error);
        // What one of them does not say differs in nothing.
        assert_eq!(found(&[ten.clone(), tool(1, "A", None)]), []);
        assert_eq!(found(&[long(80.0), ten.clone()]), []);
        assert_eq!(found(&[tool(0, "A", Some(10.0)), tool(0, "B", Some(6.0))]), []);
    }

    #[test]
    fn two_names_under_one_number_are_a_warning_where_no_size_says_more() {
        let warning = [(Severity::Warning, 20)];
        assert_eq!(found(&[tool(1, "DRILL 8", None), tool(1, "DRILL 10", None)]), warning);
        assert_eq!(found(&[tool(1, "DRILL", Some(8.0)), tool(1, "BOHRER", Some(8.0))]), []);
        assert_eq!(found(&[tool(1, "DRILL 8", None), tool(1, "", None)]), []);
    }
}
