//! A machine file: where it is found, and places in it.

use super::{Result, is_path};
use crate::library;
use crate::model::{Block, Place};
use crate::sheet::Sheet;
use program::{Diagnostic, nearest};
use std::path::{Path, PathBuf};
use toml::Spanned;

/// Largest file that is read, bytes.
const LARGEST_FILE: u64 = 4 << 20;

/// A file with its text.
pub(super) struct SheetFile {
    pub(super) path: PathBuf,
    pub(super) text: String,
    /// Whether it is a file of the user's, not of the library.
    pub(super) own: bool,
}

impl SheetFile {
    pub(super) fn read(path: &Path) -> Result<SheetFile> {
        let shown = path.display().to_string();
        let fail = |why: String| {
            Diagnostic::error("machine-unreadable", why)
                .help("`toolpost machines list` names the machines of the library")
                .file(shown.clone())
        };
        let size = std::fs::metadata(path).map_err(|e| fail(format!("cannot be read: {e}")))?.len();
        if size > LARGEST_FILE {
            return Err(fail(format!("{size} bytes are no machine file")).into());
        }
        let text =
            std::fs::read_to_string(path).map_err(|e| fail(format!("cannot be read: {e}")))?;
        Ok(SheetFile { path: path.to_path_buf(), text, own: true })
    }

    pub(super) fn of_library(name: &str, kinds: &[library::Kind]) -> Result<SheetFile> {
        match library::find(name, kinds) {
            Some((path, text)) => {
                Ok(SheetFile { path: PathBuf::from(path), text: text.to_string(), own: false })
            }
            None if library::find(name, library::EVERYTHING).is_some() => {
                let known = builders(name).collect::<Vec<_>>().join(", ");
                let message = format!("`{name}` is a control, not a machine");
                let own = format!("a file of your own that says `extends = \"{name}\"`");
                let help = format!("the machines that build on it are {known}; or {own}");
                Err(Diagnostic::error("machine-is-control", message).help(help).into())
            }
            None => {
                let known = library::names(kinds).collect::<Vec<_>>().join(", ");
                let message = format!("`{name}` is not in the library");
                let meant = match nearest(name, library::names(kinds)).as_str() {
                    "" => String::new(),
                    meant => format!("did you mean {meant}? "),
                };
                let help = format!("{meant}There are {known}; or give the path of a file");
                Err(Diagnostic::error("machine-unknown", message).help(help).into())
            }
        }
    }

    pub(super) fn parent(&self, parent: &Spanned<String>) -> Result<SheetFile> {
        let name = parent.get_ref();
        let found = if is_path(name) && self.own {
            let folder = self.path.parent().unwrap_or(Path::new(""));
            SheetFile::read(&folder.join(name))
        } else {
            SheetFile::of_library(name, library::EVERYTHING)
        };
        found.map_err(|d| self.at("extends", parent, &d.message).help(d.help).into())
    }

    pub(super) fn name(&self) -> String {
        self.path.display().to_string()
    }

    pub(super) fn parse(&self) -> Result<Sheet> {
        toml::from_str(&self.text).map_err(|e| {
            let span = e.span().unwrap_or(0..0);
            let message = e.message().trim().replace('\n', "; ");
            self.diagnostic("machine-file", message, span).into()
        })
    }

    pub(super) fn at<T>(&self, what: &str, place: &Spanned<T>, message: &str) -> Diagnostic {
        self.diagnostic("machine-file", format!("{what}: {message}"), place.span())
    }

    fn diagnostic(
        &self,
        rule: &'static str,
        message: String,
        span: std::ops::Range<usize>,
    ) -> Diagnostic {
        let before = &self.text.as_bytes()[..span.start.min(self.text.len())];
        let start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        let line = self.line_of(span.start);
        let text = self.text.as_bytes()[start..].split(|&b| b == b'\n').next().unwrap_or_default();
        Diagnostic::error(rule, message).file(self.name()).at(
            line,
            text,
            span.start - start,
            span.end.saturating_sub(start),
        )
    }

    fn line_of(&self, offset: usize) -> u32 {
        let before = &self.text.as_bytes()[..offset.min(self.text.len())];
        1 + before.iter().filter(|&&b| b == b'\n').count() as u32
    }

    pub(super) fn placed<T>(&self, value: Spanned<T>) -> (T, Place) {
        let place = Place { file: self.name(), line: self.line_of(value.span().start) };
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

/// The machines of the library that build on a control, in however many steps.
fn builders(control: &str) -> impl Iterator<Item = &'static str> {
    let parent = |name: &str| {
        let file = SheetFile::of_library(name, library::EVERYTHING).ok()?;
        file.parse().ok()?.extends.map(Spanned::into_inner)
    };
    library::names(library::MACHINES).filter(move |name| {
        let mut chain = std::iter::successors(parent(name), |name| parent(name));
        chain.any(|ancestor| ancestor == control)
    })
}
