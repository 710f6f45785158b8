//! The commands of a job as one text, and which operation each of its lines comes from.

use crate::job::Job;
use program::{Coolant, Diagnostic, Rule};
use std::mem;

/// Bytes that are looked at at once.
const PIECE: usize = 1 << 14;

/// All commands of a job, one a line.
#[derive(Clone, Debug, Default)]
pub struct Listing {
    /// Name of the job's file.
    file: String,
    text: Vec<u8>,
    /// How many lines it has.
    lines: u32,
    /// Whether a command has a word for a rotary axis.
    turns: bool,
    sections: Vec<Section>,
}

/// The lines of an operation.
#[derive(Clone, Debug)]
struct Section {
    label: String,
    /// The line before its first command, counted from 1.
    before: u32,
    /// The line before what the job says of it.
    from: u32,
}

/// The location of a command in its job.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandLocation<'a> {
    /// The file and the operation.
    pub file: String,
    /// Number of the command in its operation, from 1; 0 for a command that the job itself adds.
    pub command: u32,
    /// The command.
    pub text: &'a [u8],
}

impl Listing {
    /// The commands of `job` of the file `file`: they are moved here.
    ///
    /// # Errors
    /// An operation that has not as many lines as commands.
    pub(crate) fn of(file: &str, job: &mut Job) -> Result<Listing, Box<Diagnostic>> {
        let mut listing = Listing {
            file: file.to_owned(),
            text: Vec::new(),
            lines: 0,
            turns: false,
            sections: Vec::with_capacity(job.operations.len()),
        };
        let mut coolant = None;
        for operation in &mut job.operations {
            let from = listing.lines;
            if operation.coolant != coolant {
                // As FreeCAD's own posts do it: on before the operation, off behind it.
                if coolant.is_some() {
                    listing.push("M9".into());
                }
                match operation.coolant {
                    Some(Coolant::Flood) => listing.push("M8".into()),
                    Some(Coolant::Mist) => listing.push("M7".into()),
                    _ => {}
                }
                coolant = operation.coolant;
            }
            let before = listing.lines;
            listing.sections.push(Section { label: operation.label.clone(), before, from });
            listing.push(mem::take(&mut operation.commands));
            let lines = listing.lines - before;
            if let Some(count) = operation.count.filter(|count| *count != lines) {
                let label = &operation.label;
                let message = format!("operation `{label}` has {count} commands on {lines} lines");
                let help = "no name of a command may have a line break: make the operation anew";
                let found = Diagnostic::error(Rule::FreecadLines, message).help(help);
                return Err(found.file(file).into());
            }
        }
        Ok(listing)
    }

    /// Adds commands, one a line.
    fn push(&mut self, commands: String) {
        let (mut names, mut lines) = (false, 0);
        // Each piece stays in the cache while it is examined.
        for piece in commands.as_bytes().chunks(PIECE) {
            names |= names_rotary_axis(piece);
            lines += memchr::memchr_iter(b'\n', piece).count();
        }
        let is_command = |line: &str| !line.starts_with('(');
        self.turns |= names
            && commands.lines().any(|line| is_command(line) && names_rotary_axis(line.as_bytes()));
        let ends = commands.is_empty() || commands.ends_with('\n');
        // One long operation is most of many a job: within its own memory it is moved faster than copied.
        if commands.len() > self.text.len() {
            let before = mem::replace(&mut self.text, commands.into_bytes());
            self.text.splice(..0, before);
        } else {
            self.text.extend_from_slice(commands.as_bytes());
        }
        if !ends {
            self.text.push(b'\n');
            lines += 1;
        }
        self.lines = self.lines.saturating_add(u32::try_from(lines).unwrap_or(u32::MAX));
    }

    /// The text.
    pub fn text(&self) -> &[u8] {
        &self.text
    }

    /// Whether the job turns rotary axes; where it does not, the tool stands upright in it.
    pub(crate) fn turns(&self) -> bool {
        self.turns
    }

    /// The operation, counted from 0, to which a line (from 1) belongs.
    pub(crate) fn operation(&self, line: u32) -> usize {
        self.sections.partition_point(|section| section.from < line).saturating_sub(1)
    }

    /// Where line `line` (from 1) of the listing comes from.
    pub fn location(&self, line: u32) -> CommandLocation<'_> {
        let mut lines = self.text.split(|&byte| byte == b'\n');
        let text = lines.nth(line.saturating_sub(1) as usize).unwrap_or_default();
        let section = self.sections.get(self.operation(line));
        let label = section.map_or("", |section| section.label.as_str());
        let before = section.map_or(0, |section| section.before);
        let file = format!("{}: operation `{label}`", self.file);
        CommandLocation { file, command: line.saturating_sub(before), text }
    }

    /// The finding, which has a line of the listing, with its operation and command.
    pub fn located(&self, mut found: Diagnostic) -> Diagnostic {
        let location = self.location(found.line);
        if found.excerpt.is_empty() {
            found = found.on(location.command, location.text);
        }
        found.line = location.command;
        found.file(location.file)
    }

    /// The operations: label, and the line of the listing before their first command.
    pub fn operations(&self) -> impl Iterator<Item = (&str, u32)> {
        self.sections.iter().map(|section| (section.label.as_str(), section.before))
    }
}

/// Whether one of the letters A, B, C is in a text.
fn names_rotary_axis(text: &[u8]) -> bool {
    // Without a way out of the loop, which the compiler then does for many bytes at once.
    let is = |byte: &u8| byte.to_ascii_uppercase().wrapping_sub(b'A') < 3;
    text.iter().fold(false, |found, byte| found | is(byte))
}
