//! FreeCAD's dump of a job: what its post-processor `dumper` shows.

use crate::job::{Job, Operation, Tool};
use program::{Diagnostic, Rule};
use std::fmt::Write;

/// How the lines of a dump begin.
const HEADING: &[u8] = b"(This output produced with the dump post processor)";
/// What editors on Windows put before a text.
const BOM: &[u8] = b"\xEF\xBB\xBF";
const PATH: &str = "(Path: ";
const COMMAND: &str = "Command ";

/// Whether `text` begins as a dump does.
pub(crate) fn begins(text: &[u8]) -> bool {
    let text = text.strip_prefix(BOM).unwrap_or(text).trim_ascii_start();
    [HEADING, PATH.as_bytes(), COMMAND.as_bytes()].iter().any(|start| text.starts_with(start))
}

/// Reads a dump. An object that changes the tool is a tool controller, and its label the name of the
/// tool.
pub(crate) fn read(text: &[u8]) -> Result<Job, Box<Diagnostic>> {
    let text = String::from_utf8_lossy(text.strip_prefix(BOM).unwrap_or(text));
    let mut job = Job::default();
    let mut lines = text.lines().zip(1u32..).map(|(line, number)| (line.trim(), number));
    // A command whose line is broken in print ends with the bracket.
    let mut joined = String::new();
    while let Some((line, number)) = lines.next() {
        if let Some(label) = line.strip_prefix(PATH) {
            let label = label.strip_suffix(')').unwrap_or(label).to_owned();
            job.operations.push(Operation { label, ..Operation::default() });
            continue;
        }
        let Some(rest) = line.strip_prefix(COMMAND) else {
            // Remarks stand before the first object only.
            if line.is_empty() || job.operations.is_empty() && line.starts_with('(') {
                continue;
            }
            let message = "this is no line of a dump";
            let help = "a line is `(Path: label)` or `Command NAME [ LETTER:NUMBER ... ]`";
            return Err(wrong(message, line, number).help(help).into());
        };
        joined.clear();
        joined.push_str(rest);
        while !joined.ends_with(']') {
            match lines.next() {
                Some((more, _)) if !more.starts_with(COMMAND) && !more.starts_with(PATH) => {
                    joined.push(' ');
                    joined.push_str(more);
                }
                _ => return Err(wrong("the command has no end: ] is missing", line, number).into()),
            }
        }
        let Some(operation) = job.operations.last_mut() else {
            let help = "`(Path: label)` stands before the commands of an object";
            return Err(wrong("a command of no object", line, number).help(help).into());
        };
        let tool = command(&joined, &mut operation.commands)
            .map_err(|message| wrong(&message, line, number))?;
        if let Some(number) = tool {
            job.tools.push(Tool { number, name: operation.label.clone(), ..Tool::default() });
        }
    }
    Ok(job)
}

fn wrong(message: &str, line: &str, number: u32) -> Diagnostic {
    Diagnostic::error(Rule::FreecadDump, message).on(number, line.as_bytes())
}

/// Adds `NAME [ LETTER:NUMBER ... ]` to `commands` as it stands in a program; the number of the tool
/// that it changes to.
fn command(text: &str, commands: &mut String) -> Result<Option<u32>, String> {
    let parts = text.strip_suffix(']').and_then(|text| text.rsplit_once('['));
    let (name, parameters) = parts.ok_or("a command is NAME [ LETTER:NUMBER ... ]")?;
    let name = name.trim();
    commands.push_str(name);
    let mut tool = None;
    for parameter in parameters.split_whitespace() {
        let is_letter = |text: &str| text.len() == 1 && text.as_bytes()[0].is_ascii_alphabetic();
        let pair = parameter.split_once(':').filter(|(letter, _)| is_letter(letter));
        let (letter, number) = pair.ok_or_else(|| format!("`{parameter}` is no LETTER:NUMBER"))?;
        let value: f64 = number.parse().map_err(|_| format!("{parameter}: this is no number"))?;
        if !value.is_finite() {
            return Err(format!("{parameter}: FreeCAD writes what it could not work out so"));
        }
        if (name, letter) == ("M6", "T") && (1.0..1e6).contains(&value) {
            tool = Some(value as u32);
        }
        commands.push(' ');
        commands.push_str(letter);
        // Programs know no exponents.
        let _ = match number.contains(['e', 'E']) {
            true => write!(commands, "{value}"),
            false => write!(commands, "{number}"),
        };
    }
    commands.push('\n');
    Ok(tool)
}
