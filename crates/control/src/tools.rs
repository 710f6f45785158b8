//! Tool tables as LinuxCNC keeps them: a tool a line, `T1 P1 Z25 D6 ;end mill`.
//!
//! LinuxCNC documentation, "Tool Table Format": T is the number of the tool, P its pocket, Z its
//! length, D its diameter, I J Q are for lathes; what is left out is 0, and words follow a semicolon. The
//! table counts in the machine's units, here mm. The words are taken for the tool's name, by which other
//! controls call it.

use crate::ToolData;
use crate::kernel::decimal;
use program::{Diagnostic, Rule};

/// Offsets along and about the axes other than Z: a tool that has one is no mill on the spindle's axis.
const ASIDE: &[u8] = b"XYABCUVW";

/// The tools of a table, in its order.
///
/// # Errors
/// The first line that is not understood: a word that no table has, a number that is none, no T, a tool
/// that is there already, an offset aside from the axis of the spindle.
pub fn read(text: &[u8]) -> Result<Vec<ToolData>, Box<Diagnostic>> {
    let mut tools: Vec<ToolData> = Vec::new();
    let mut numbers = std::collections::HashSet::new();
    for (index, line) in text.split(|&byte| byte == b'\n').enumerate() {
        let line = Line { number: u32::try_from(index + 1).unwrap_or(u32::MAX), text: line };
        let Some(tool) = line.tool()? else { continue };
        if !numbers.insert(tool.number) {
            let message = format!("tool {} is in the table already", tool.number);
            return Err(line.error(0, message));
        }
        tools.push(tool);
    }
    Ok(tools)
}

/// A line of a table.
struct Line<'a> {
    number: u32,
    text: &'a [u8],
}

impl Line<'_> {
    /// The tool of the line; none where there are words only.
    fn tool(&self) -> Result<Option<ToolData>, Box<Diagnostic>> {
        let end = memchr::memchr(b';', self.text).unwrap_or(self.text.len());
        let (words, comment) = self.text.split_at(end);
        let comment = comment.strip_prefix(b";").unwrap_or_default().trim_ascii();
        let name = String::from_utf8_lossy(comment).into_owned();
        let (mut seen, mut at) = (Vec::new(), 0);
        let (mut number, mut length, mut diameter) = (None, 0.0, 0.0);
        while let Some(rest) = words.get(at..)
            && let Some(blanks) = rest.iter().position(|byte| !byte.is_ascii_whitespace())
        {
            at += blanks;
            let letter = words.get(at).map_or(b' ', u8::to_ascii_uppercase);
            let value = decimal::parse(words.get(at + 1..).unwrap_or_default());
            let Some(value) = value.filter(|value| value.value.is_finite()) else {
                return Err(self.error(at, "a letter and its number are needed here"));
            };
            if seen.contains(&letter) {
                return Err(self.error(at, format!("a second {}", char::from(letter))));
            }
            seen.push(letter);
            match letter {
                b'T' if value.value >= 0.0 && value.value.fract() == 0.0 => {
                    number = Some(value.value as u32);
                }
                b'T' => return Err(self.error(at, "T is a whole number from 0")),
                b'Z' => length = value.value,
                b'D' => diameter = value.value,
                b'P' | b'I' | b'J' | b'Q' => {}
                _ if ASIDE.contains(&letter) && value.value == 0.0 => {}
                _ if ASIDE.contains(&letter) => {
                    let letter = char::from(letter);
                    let message = format!("a tool with an offset in {letter} is not followed");
                    return Err(self.error(at, message));
                }
                _ => return Err(self.error(at, "a word that no tool table has")),
            }
            at += 1 + value.len;
        }
        match number {
            Some(number) => Ok(Some(ToolData { number, name, radius: diameter / 2.0, length })),
            None if seen.is_empty() => Ok(None),
            None => Err(self.error(0, "a line without T: which tool is it?")),
        }
    }

    fn error(&self, at: usize, message: impl Into<String>) -> Box<Diagnostic> {
        Diagnostic::error(Rule::ToolTable, message)
            .help("a line is like `T1 P1 Z25 D6 ;end mill`, lengths in mm")
            .at(self.number, self.text, at, at + 1)
            .into()
    }
}
