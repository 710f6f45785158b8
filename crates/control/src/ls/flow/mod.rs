//! Through a file: its instructions, and the programs of other files that are called.

use super::execution::State;
use super::language::{Position, Scan, Statement, positions, read};
use crate::event::Action;
use crate::kernel::Channel;
use crate::kernel::flow::lines;
use crate::kernel::source::Source;
use crate::{ArmAction, Settings};
use program::{Diagnostic, Outcome, Rule};
use std::collections::HashMap;

/// Most calls within calls: no manual at hand states a number.
const DEEPEST: usize = 10;

/// Most letters of a program's name (R-30iB; older controllers take 8).
const LONGEST: usize = 36;

/// Most lines of a program (R-30iB: 9999).
const MOST_LINES: u32 = 9_999;

/// A program: where its instructions stand, and its positions.
struct File<'t> {
    name: &'t str,
    /// The lines of `/MN`.
    instructions: Vec<(u32, &'t [u8])>,
    positions: HashMap<u32, Position>,
}

/// Runs a program.
pub(super) fn run(settings: &Settings, text: &[u8], channel: &mut Channel) -> Outcome {
    let file = File::of(text)?;
    let mut run = Run { settings, state: State::new(settings), channel };
    run.state.begins(1, run.channel)?;
    let end = run.routine(&file, None, 0)?;
    run.channel.report(end, Action::End)
}

/// The parts of a listing.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Head,
    Instructions,
    Positions,
    Behind,
}

impl<'t> File<'t> {
    /// # Errors
    /// A part is missing, or a position is not understood.
    fn of(text: &'t [u8]) -> Outcome<File<'t>> {
        let mut part = Part::Head;
        let mut name = None;
        let mut instructions = Vec::new();
        let mut behind = Vec::new();
        for (place, _, line) in lines(text) {
            let trimmed = line.trim_ascii();
            let scan = Scan::new(Source { line: place.line, text: line });
            if let Some(rest) = trimmed.strip_prefix(b"/PROG") {
                let word = rest.split(u8::is_ascii_whitespace).find(|word| !word.is_empty());
                name = word.and_then(|word| std::str::from_utf8(word).ok());
                continue;
            }
            if let Some(groups) = trimmed.strip_prefix(b"DEFAULT_GROUP") {
                let first =
                    groups.iter().find(|byte| !byte.is_ascii_whitespace() && **byte != b'=');
                if first != Some(&b'1') {
                    let message =
                        "the program has no motion group 1 (DEFAULT_GROUP): it cannot move the arm";
                    return Err(scan.since(0, Rule::ProgramFrame, message));
                }
            }
            part = match (part, trimmed) {
                (Part::Head, b"/MN") => Part::Instructions,
                (Part::Instructions, b"/POS") => Part::Positions,
                (Part::Instructions | Part::Positions, b"/END") => Part::Behind,
                (Part::Behind, b"") | (Part::Head, _) => continue,
                (Part::Behind, _) => {
                    let message = "something stands behind /END";
                    return Err(scan.since(0, Rule::AfterEnd, message));
                }
                (Part::Instructions, _) => {
                    instructions.push((place.line, line));
                    continue;
                }
                (Part::Positions, _) => {
                    behind.push((place.line, line));
                    continue;
                }
            };
        }
        let missing = |what: &str| {
            let message = format!("the listing has no {what}");
            Diagnostic::error(Rule::ProgramFrame, message).line(1)
        };
        let Some(name) = name else { return Err(missing("/PROG with a name").into()) };
        let first = name.bytes().next().is_some_and(|byte| byte.is_ascii_alphabetic());
        let allowed = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
        if !first || name.len() > LONGEST || !name.bytes().all(allowed) {
            let message = format!(
                "a program has a name of up to {LONGEST} letters, digits and _, a letter first"
            );
            return Err(Diagnostic::error(Rule::ProgramFrame, message).line(1).into());
        }
        if part != Part::Behind {
            return Err(missing("/MN, or no /END behind it").into());
        }
        Ok(File { name, instructions, positions: positions(behind.into_iter())? })
    }

    /// The next instruction from line `at` of them on: without its number and `;`, with the lines in which it goes on; its line, and
    /// where the next one begins.
    fn instruction(&self, at: usize) -> Outcome<Option<(u32, Vec<u8>, usize)>> {
        let Some((line, first)) = self.instructions.get(at) else { return Ok(None) };
        let scan = Scan::new(Source { line: *line, text: first });
        let Some(colon) = first.iter().position(|byte| *byte == b':') else {
            return match first.trim_ascii().is_empty() {
                true => Ok(Some((*line, Vec::new(), at + 1))),
                false => Err(scan.wrong("an instruction begins with its number and a colon")),
            };
        };
        let number = std::str::from_utf8(first[..colon].trim_ascii()).unwrap_or("?");
        if number.parse::<u32>().map_or(true, |number| number == 0 || number > MOST_LINES) {
            let message = format!("the number of an instruction is 1 to {MOST_LINES}");
            return Err(scan.since(0, Rule::Syntax, message));
        }
        let mut text = first[colon + 1..].to_vec();
        let mut next = at + 1;
        // It goes on in lines that have no number.
        while let Some((_, more)) = self.instructions.get(next) {
            let Some(more) = more.trim_ascii_start().strip_prefix(b":") else { break };
            text.push(b' ');
            text.extend_from_slice(more);
            next += 1;
        }
        let trimmed = text.trim_ascii();
        let text = match trimmed.strip_suffix(b";") {
            Some(text) => text.trim_ascii().to_vec(),
            None if trimmed.is_empty() => Vec::new(),
            None => return Err(scan.wrong("the instruction has no end: ;")),
        };
        Ok(Some((*line, text, next)))
    }
}

struct Run<'r, 'c> {
    settings: &'r Settings,
    state: State,
    channel: &'r mut Channel<'c>,
}

impl Run<'_, '_> {
    /// Runs a program to its end; the line of that. `own` is the name of the file of a called one.
    fn routine(&mut self, file: &File, own: Option<&str>, depth: usize) -> Outcome<u32> {
        let (mut at, mut last) = (0, 1);
        while let Some((line, text, next)) = file.instruction(at)? {
            last = line;
            let mut scan = Scan::new(Source { line, text: &text });
            let statement = read(&mut scan)?;
            match &statement {
                Statement::End => return Ok(last),
                Statement::Motion(motion) => {
                    self.state.go(&scan, motion, &file.positions, self.channel)?;
                }
                Statement::Call(name, arguments) => {
                    if !self.state.called(&scan, name, arguments, self.channel)? {
                        self.call(own, &scan, (name, arguments.is_empty()), depth)?;
                    }
                }
                other => self.state.instruction(&scan, other, self.channel)?,
            }
            at = next;
        }
        Ok(last)
    }

    /// A call of the program of another file; whether it is called without arguments.
    fn call(
        &mut self,
        from: Option<&str>,
        scan: &Scan,
        (name, plain): (&str, bool),
        depth: usize,
    ) -> Outcome {
        let refused = |rule: Rule, message: String| scan.since(0, rule, message);
        if !plain {
            let message = format!("{name} is called with arguments, which is not followed");
            return Err(refused(Rule::Argument, message));
        }
        let counted = self.channel.budget.call(depth, DEEPEST);
        counted.map_err(|(rule, message)| refused(rule, message))?;
        let called = self.settings.setup.folders.called(name, "LS");
        let called = called.map_err(|message| refused(Rule::CalledProgram, message));
        let Some(called) = called? else {
            let message = format!("the called program {name} is in no folder for called programs");
            return Err(refused(Rule::CalledProgram, message));
        };
        let inside = |found: Box<Diagnostic>| called.inside(found);
        let file = File::of(&called.text).map_err(inside)?;
        if !file.name.eq_ignore_ascii_case(name) {
            let message = format!("{} has the program {}", called.name, file.name);
            return Err(refused(Rule::CalledProgram, message));
        }
        let own = Some(called.name.as_str());
        self.channel.arm(scan.line, ArmAction::File(own.map(Box::from)))?;
        let end = self.routine(&file, own, depth + 1).map_err(inside)?;
        self.channel.arm(end, ArmAction::File(from.map(Box::from))).map_err(inside)
    }
}
