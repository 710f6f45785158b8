//! Boards that are written by hand, or by a program: nodes, tracks, pads, holes and groups of them, as TOML
//! or JSON.
//!
//! ```text
//!   TOML ─────────────▶ tree ──sheet──▶ Group ──scope──▶ nodes in their places ──build──▶ Board
//!   JSON ────json─────▶
//! ```
//!
//! Both are read into the same tree, in which every value knows its location in the text; `sheet` has all that
//! may be said. `scope` finds what a name means in a group, `build` makes shapes, and `net` says which of them
//! are joined. What the form is, with an example: `docs/sources/board.md`.

mod build;
mod json;
mod net;
mod scope;
mod sheet;

use crate::board::{Artwork, Board};
use crate::report::{Location, Report};
use program::{Diagnostic, Misread, Rule, nearest};
use serde::Deserialize;
use sheet::{Group, KEYS};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

pub use scope::DEEPEST;

/// The longest text of a board, bytes: two hundred thousand elements.
pub const LONGEST: usize = 16 << 20;

/// What a text gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The board.
    pub board: Board,
    /// What is odd about it.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a board in TOML, or in JSON where the text begins with `{`. `file_name` is for the messages, and
/// without its folders and its ending for the name of a board that has none.
///
/// # Errors
/// Every error found, at most twenty: `board-file` for what is no such text, with the keys that a wrong
/// one is near to; `node-unknown`, `node`, `group`, `width`, `angle`, `net-twice`, `no-board`, `layers-apart`, and
/// what [`outline::of_lines`](crate::board::outline::of_lines) and [`Artwork::united`] refuse. There is no
/// partial board.
pub fn read(file_name: &str, text: &[u8]) -> Result<Reading, Vec<Diagnostic>> {
    let (board, warnings) = artwork(file_name, text)?.united()?;
    Ok(Reading { board, warnings })
}

/// The same, with copper that is still to be united.
///
/// # Errors
/// As [`read`].
pub fn artwork(file_name: &str, text: &[u8]) -> Result<Artwork, Vec<Diagnostic>> {
    let mut findings = Findings::new(file_name, text);
    let root = match parse(text) {
        Ok(root) => root,
        Err(Mistake { message, help, span }) => {
            findings.error(span, Diagnostic::error(Rule::BoardFile, message).help(help));
            return Err(findings.report.errors);
        }
    };
    let mut artwork = build::artwork(&root, file_name, &mut findings);
    let Report { errors, warnings, .. } = findings.report;
    let placed = |found: Vec<Diagnostic>| -> Vec<Diagnostic> {
        found.into_iter().map(|found| found.file(file_name)).collect()
    };
    if !errors.is_empty() {
        return Err(placed(errors));
    }
    let file = file_name.rsplit(['/', '\\']).next().unwrap_or(file_name);
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    artwork.board.name = root.into_inner().name.unwrap_or_else(|| stem.into());
    artwork.file = Some(file_name.to_owned());
    artwork.warnings = placed(warnings);
    artwork.whole()
}

/// Why a text is no board, and where.
struct Mistake {
    message: String,
    help: String,
    span: Range<usize>,
}

impl Mistake {
    fn new(message: impl Into<String>, help: impl Into<String>, span: Range<usize>) -> Mistake {
        Mistake { message: message.into(), help: help.into(), span }
    }
}

/// The outermost group.
fn parse(text: &[u8]) -> Result<Spanned<Group>, Mistake> {
    if text.len() > LONGEST {
        let message = format!("{} bytes are no board; {LONGEST} are the most", text.len());
        return Err(Mistake::new(
            message,
            "draw it in a CAD system, and give its Gerber files",
            0..0,
        ));
    }
    let text = std::str::from_utf8(text).map_err(|error| {
        let at = error.valid_up_to();
        Mistake::new("this is not UTF-8", "save the file as UTF-8", at..at + 1)
    })?;
    let tree = match text.trim_start().starts_with('{') {
        true => json::tree(text)?,
        false => {
            let root = DeTable::parse(text).map_err(|error| of_toml(&error, text))?;
            let span = root.span();
            Spanned::new(span, DeValue::Table(root.into_inner()))
        }
    };
    Spanned::deserialize(ValueDeserializer::from(tree)).map_err(|error| of_toml(&error, text))
}

fn of_toml(error: &toml::de::Error, text: &str) -> Mistake {
    let span = error.span().unwrap_or(0..0);
    let Misread { message, help } = Misread::of(error.message());
    let meant = match error.message().starts_with("unknown field") {
        true => {
            nearest(text.get(span.clone()).unwrap_or_default().trim_matches('"'), KEYS.into_iter())
        }
        false => String::new(),
    };
    let help = match meant.as_str() {
        "" if help.is_empty() => String::from("docs/sources/board.md shows how a board is written"),
        "" => help,
        meant => format!("did you mean {meant}?"),
    };
    Mistake::new(message, help, span)
}

/// Where what is wrong with a board gathers.
struct Findings<'a> {
    report: Report<'a>,
    text: &'a [u8],
    /// Where each line ends.
    ends: Vec<usize>,
}

impl<'a> Findings<'a> {
    fn new(file_name: &'a str, text: &'a [u8]) -> Findings<'a> {
        let ends = memchr::memchr_iter(b'\n', text).collect();
        Findings { report: Report::new(file_name, text), text, ends }
    }

    /// An error about the value at `span`.
    #[cold]
    fn error(&mut self, span: Range<usize>, found: Diagnostic) {
        // Of what goes over several lines, the first one is shown.
        let rest = self.text.get(span.clone()).unwrap_or_default();
        let length = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let end = length.map_or(span.end, |length| span.start + length);
        let location = Location { line: self.line(&span), start: span.start, end };
        self.report.error(location, found);
    }

    /// The line (from 1) on which a value begins.
    fn line(&self, span: &Range<usize>) -> u32 {
        let before = self.ends.partition_point(|end| *end < span.start);
        u32::try_from(before + 1).unwrap_or(u32::MAX)
    }
}
