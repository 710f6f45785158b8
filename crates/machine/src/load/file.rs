//! A machine file: where it is found, and places in it.

use super::{Outcome, Reach, is_path};
use crate::library;
use crate::model::{Block, FileLocation, StatedKey};
use crate::sheet::{Sheet, keys};
use crate::upgrade::{is_header, turns_text};
use program::{Diagnostic, Misread, Rule, encoding, nearest};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Largest file that is read, bytes.
const LARGEST_FILE: u64 = 4 << 20;

/// A file with its text.
#[derive(Clone)]
pub(super) struct SheetFile {
    pub(super) path: PathBuf,
    pub(super) text: String,
    /// Whether it is a file of the user's, not of the library.
    pub(super) own: bool,
    /// Whether findings may quote it. A machine file from a stranger may extend any file of this computer by its path:
    /// what lies outside the folder is not shown.
    pub(super) quoted: bool,
    /// Where its lines begin.
    lines: Vec<usize>,
}

impl SheetFile {
    /// A file whose text may be quoted.
    pub(super) fn new(path: PathBuf, text: String, own: bool) -> SheetFile {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        let lines = std::iter::once(0).chain(ends.map(|(at, _)| at + 1)).collect();
        SheetFile { path, text, own, quoted: true, lines }
    }

    pub(super) fn read(path: &Path, reach: &Reach) -> Outcome<SheetFile> {
        reach.check(path)?;
        let shown = path.display().to_string();
        let fail = |why: String| {
            Diagnostic::error(Rule::MachineUnreadable, why)
                .help("`toolpost machines list` names the machines of the library")
                .file(shown.clone())
        };
        let unreadable = |error: std::io::Error| fail(format!("cannot be read: {error}"));
        // Looked at before it is opened: opening a pipe would wait for ever.
        if !fs::metadata(path).map_err(unreadable)?.is_file() {
            return Err(fail(String::from("cannot be read: it is not a file")).into());
        }
        let mut bytes = Vec::new();
        let file = File::open(path).map_err(unreadable)?;
        file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(unreadable)?;
        if bytes.len() as u64 > LARGEST_FILE {
            let message = format!("more than {} MB are no machine file", LARGEST_FILE >> 20);
            return Err(fail(message).into());
        }
        if encoding::is_utf_16(&bytes) {
            return Err(encoding::utf_16().file(shown).into());
        }
        let text =
            String::from_utf8(bytes).map_err(|_| fail(String::from("this file is not UTF-8")))?;
        Ok(SheetFile::new(path.to_path_buf(), text, true))
    }

    pub(super) fn of_library(name: &str, kinds: &[library::Kind]) -> Outcome<SheetFile> {
        match library::find(name, kinds) {
            Some((path, text)) => Ok(SheetFile::new(PathBuf::from(path), text.to_string(), false)),
            None if library::find(name, library::EVERYTHING).is_some() => {
                let known = builders(name).collect::<Vec<_>>().join(", ");
                let message = format!("`{name}` is a control, not a machine");
                let own = format!("a file of your own that says `extends = \"{name}\"`");
                let help = format!("the machines that build on it are {known}; or {own}");
                Err(Diagnostic::error(Rule::MachineIsControl, message).help(help).into())
            }
            None => {
                let message = format!("`{name}` is not in the library");
                let help = match nearest(name, library::names(kinds)).as_str() {
                    "" => {
                        let known = library::names(kinds).collect::<Vec<_>>().join(", ");
                        format!("there are {known}; or give the path of a file")
                    }
                    meant => format!(
                        "did you mean {meant}? `toolpost machines list` names all; or give the path of a file"
                    ),
                };
                Err(Diagnostic::error(Rule::MachineUnknown, message).help(help).into())
            }
        }
    }

    pub(super) fn parent(&self, parent: &Spanned<String>, reach: &Reach) -> Outcome<SheetFile> {
        let name = parent.get_ref();
        let found = if is_path(name) && self.own {
            self.parent_file(name, reach)
        } else {
            SheetFile::of_library(name, library::EVERYTHING)
        };
        found.map_err(|d| self.at("extends", parent, &d.message).help(d.help).into())
    }

    /// Where the file of that path lies, from the folder of this one.
    pub(super) fn beside(&self, name: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(name)
    }

    /// The file of that path, from the folder of this one.
    fn parent_file(&self, name: &str, reach: &Reach) -> Outcome<SheetFile> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let path = self.beside(name);
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let is_inside = match (fs::canonicalize(&path), fs::canonicalize(folder)) {
            (Ok(file), Ok(folder)) => file.starts_with(folder),
            _ => false,
        };
        if !is_inside && !name.ends_with(".toml") {
            let message = "a file outside the folder of this one, whose name does not end in .toml, is not read";
            let help = "copy it into the folder of this file";
            return Err(Diagnostic::error(Rule::MachineFile, message).help(help).into());
        }
        let quoted = self.quoted && is_inside;
        Ok(SheetFile { quoted, ..SheetFile::read(&path, reach)? })
    }

    pub(super) fn name(&self) -> String {
        self.path.display().to_string()
    }

    pub(super) fn parse(&self) -> Outcome<Sheet> {
        toml::from_str(&self.text).map_err(|e| {
            let span = e.span().unwrap_or(0..0);
            if !self.quoted {
                return self
                    .diagnostic(Rule::MachineFile, "this is no machine file".into(), span)
                    .into();
            }
            let Misread { message, help } = Misread::of(e.message());
            // Of a name that is none, the name itself stands there.
            let name = self.text.get(span.clone()).unwrap_or_default();
            let is_name = e.message().starts_with("unknown field");
            let key = if is_name { String::new() } else { self.key_at(span.start) };
            let moved = self.belongs(span.start, if is_name { name } else { &key });
            let help = match (message.as_str(), moved) {
                ("duplicate key", _) => self.first_of(span.start).unwrap_or(help),
                (_, Some(moved)) => moved,
                (_, None) if help.is_empty() && !key.is_empty() => {
                    format!(
                        "correct the file at the mark; `toolpost explain {key}` says what it takes"
                    )
                }
                (_, None) => help,
            };
            let message = if key.is_empty() { message } else { format!("{key}: {message}") };
            Box::new(self.diagnostic(Rule::MachineFile, message, span).help(help))
        })
    }

    /// The keys that it states, table by table.
    pub(super) fn stated(&self) -> Vec<StatedKey> {
        let Ok(file) = DeTable::parse(&self.text) else { return Vec::new() };
        let place = |at: usize| FileLocation { file: self.name(), line: self.line_of(at) };
        let mut stated = Vec::new();
        for (name, value) in file.get_ref() {
            match value.get_ref().as_table() {
                Some(table) => stated.extend(table.keys().map(|key| StatedKey {
                    table: name.get_ref().to_string(),
                    key: key.get_ref().to_string(),
                    place: place(key.span().start),
                })),
                None => stated.push(StatedKey {
                    table: String::new(),
                    key: name.get_ref().to_string(),
                    place: place(name.span().start),
                }),
            }
        }
        stated
    }

    /// The table whose header stands before a byte, as its header names it; empty at the top of the file.
    fn table_before(&self, at: usize) -> &str {
        let before = self.text.get(..at).unwrap_or_default();
        let header = before.lines().scan(false, |in_text, line| {
            let header = (!*in_text && is_header(line)).then(|| header_of(line));
            *in_text ^= turns_text(line);
            Some(header)
        });
        header.flatten().last().unwrap_or_default()
    }

    /// Where the key that comes a second time at a byte stands first.
    fn first_of(&self, at: usize) -> Option<String> {
        let start = self.text.get(..at)?.rfind('\n').map_or(0, |end| end + 1);
        let line = self.text[start..].lines().next()?;
        let path = match is_header(line) {
            true => String::from(header_of(line)),
            false => format!("{}.{}", self.table_before(start), line.split('=').next()?.trim()),
        };
        let table = DeTable::parse(&self.text[..start]).ok()?;
        let (mut table, mut first) = (table.get_ref(), None);
        for part in path.split('.').map(|part| part.trim().trim_matches(['"', '\''])) {
            if part.is_empty() {
                continue;
            }
            let (key, value) = table.get_key_value(part)?;
            first = Some(key.span().start);
            // Of tables in double brackets the last one is meant.
            let last = || value.get_ref().as_array()?.last()?.get_ref().as_table();
            table = value.get_ref().as_table().or_else(last).unwrap_or(table);
        }
        let first = self.line_of(first?);
        Some(match is_header(line) {
            true => format!("the table stands in line {first} already: put these keys into it"),
            false => format!("the first one stands in line {first}: leave one of them"),
        })
    }

    /// Where `key`, which stands at a byte, belongs; nothing where it is in its table.
    fn belongs(&self, at: usize, key: &str) -> Option<String> {
        let here = self.table_before(at);
        let root = |table: &str| String::from(table.split('.').next().unwrap_or_default().trim());
        let tables: Vec<&str> =
            keys().filter(|known| known.name == key).map(|known| known.table).collect();
        if tables.is_empty() || tables.iter().any(|table| root(table) == root(here)) {
            return None;
        }
        let named = |table: &str| match table {
            "" => String::from("at the top of the file, above all tables"),
            table => format!("below [{table}]"),
        };
        let belongs: Vec<String> = tables.into_iter().map(named).collect();
        let stands = if here.is_empty() { String::from("at the top") } else { named(here) };
        Some(format!(
            "`{key}` belongs {}, and stands {stands} here: move it",
            belongs.join(", or ")
        ))
    }

    /// The key in whose value, or in a list of values, a byte lies; where the text is no TOML, the key before it. Empty where there
    /// is none.
    fn key_at(&self, at: usize) -> String {
        match DeTable::parse(&self.text) {
            Ok(file) => key_in(file.get_ref(), at).unwrap_or_default(),
            Err(_) => String::from(self.key_before(at)),
        }
    }

    /// The key whose value begins at a byte; empty where none stands before it.
    fn key_before(&self, value: usize) -> &str {
        let before = self.text.get(..value).unwrap_or_default();
        let line = before.rsplit('\n').next().unwrap_or_default().trim_end();
        let key = line.strip_suffix('=').unwrap_or_default();
        key.rsplit(['{', ',']).next().unwrap_or_default().trim()
    }

    pub(super) fn at<T>(&self, what: &str, place: &Spanned<T>, message: &str) -> Diagnostic {
        self.diagnostic(Rule::MachineFile, format!("{what}: {message}"), place.span())
    }

    fn diagnostic(&self, rule: Rule, message: String, span: std::ops::Range<usize>) -> Diagnostic {
        let before = &self.text.as_bytes()[..span.start.min(self.text.len())];
        let start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        let line = self.line_of(span.start);
        if !self.quoted {
            return Diagnostic::error(rule, message).file(self.name()).line(line);
        }
        let text = self.text.as_bytes()[start..].split(|&b| b == b'\n').next().unwrap_or_default();
        Diagnostic::error(rule, message).file(self.name()).at(
            line,
            text,
            span.start - start,
            span.end.saturating_sub(start),
        )
    }

    fn line_of(&self, offset: usize) -> u32 {
        self.lines.partition_point(|&start| start <= offset) as u32
    }

    pub(super) fn placed<T>(&self, value: Spanned<T>) -> (T, FileLocation) {
        let place = FileLocation { file: self.name(), line: self.line_of(value.span().start) };
        (value.into_inner(), place)
    }

    /// The block whose TOML value stands at `value`: a text in triple quotes begins on the line after.
    pub(super) fn block(&self, value: Spanned<String>) -> Block {
        let span = value.span();
        let raw = self.text.get(span.clone()).unwrap_or_default();
        let opened = raw.starts_with("\"\"\"\n") || raw.starts_with("'''\n");
        let line = self.line_of(span.start) + u32::from(opened);
        let before = self.text.get(..span.start).unwrap_or_default();
        let indent = before.chars().rev().take_while(|&c| c != '\n').count();
        let quotes = raw.bytes().take_while(|&b| matches!(b, b'"' | b'\'')).count();
        let column = if opened { 1 } else { 1 + indent + quotes.min(3) };
        let column = u32::try_from(column).unwrap_or(u32::MAX);
        Block { text: value.into_inner(), file: self.name(), line, column }
    }
}

/// The key in whose value a byte lies, as far in as there is one.
fn key_in(table: &DeTable, at: usize) -> Option<String> {
    table.iter().find_map(|(key, value)| {
        let own = || value.span().contains(&at).then(|| key.get_ref().to_string());
        key_within(value, at).or_else(own)
    })
}

/// The key within a value in whose value a byte lies.
fn key_within(value: &Spanned<DeValue>, at: usize) -> Option<String> {
    match value.get_ref() {
        DeValue::Table(table) => key_in(table, at),
        DeValue::Array(values) => values.iter().find_map(|value| key_within(value, at)),
        DeValue::String(_)
        | DeValue::Integer(_)
        | DeValue::Float(_)
        | DeValue::Boolean(_)
        | DeValue::Datetime(_) => None,
    }
}

/// The table that a header names.
fn header_of(line: &str) -> &str {
    let name = line.split(']').next().unwrap_or_default();
    name.trim_start().trim_start_matches('[').trim()
}

/// The machines of the library that build on a control, in however many steps.
fn builders(control: &str) -> impl Iterator<Item = &'static str> {
    let parent = |name: &str| {
        let file = SheetFile::of_library(name, library::EVERYTHING).ok()?;
        file.parse().ok()?.extends.map(Spanned::into_inner)
    };
    library::names(library::CONTROLLED).filter(move |name| {
        let mut chain = std::iter::successors(parent(name), |name| parent(name));
        chain.any(|ancestor| ancestor == control)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_place_of_a_text_is_on_the_line_that_counting_gives() {
        for text in ["", "a", "a\n", "\n\nbc\n", "a\r\nb"] {
            let file = SheetFile::new(PathBuf::from("t.toml"), text.into(), true);
            for offset in 0..=text.len() {
                let counted = 1 + text[..offset].matches('\n').count() as u32;
                assert_eq!(file.line_of(offset), counted, "{text:?} at {offset}");
            }
        }
    }
}
