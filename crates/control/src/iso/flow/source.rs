//! The files of a run: the program and those it calls, each read once, with the places to jump to.

use super::numbers::Numbers;
use super::owords::OWords;
use crate::iso::language::Fault;
use crate::kernel::flow;
use crate::kernel::folders::Folders;
use program::Diagnostic;
use std::borrow::Cow;
use std::cell::OnceCell;

/// The most files of a run.
const MOST_FILES: usize = 200;

/// A file. The files that are opened after it hang on it, so that they stay where they are while a
/// block points into them.
pub(crate) struct Source<'t> {
    /// Its name; empty for the program itself, whose name the caller knows.
    pub name: String,
    pub text: Cow<'t, [u8]>,
    numbers: OnceCell<Numbers>,
    o_words: OnceCell<OWords>,
    next: OnceCell<Box<Source<'t>>>,
}

/// Where a run is in a file: the next line.
#[derive(Clone, Copy)]
pub(crate) struct SourceLocation<'a> {
    pub source: &'a Source<'a>,
    /// Byte where the line begins.
    pub at: usize,
    /// Its number less 1: that of the line before.
    pub line: u32,
    /// How many lines with `%` have gone by.
    pub percent_signs: u8,
}

impl<'t> Source<'t> {
    /// The program itself.
    pub(crate) fn program(text: &'t [u8]) -> Source<'t> {
        Source::new(String::new(), text.into())
    }

    fn new(name: String, text: Cow<'t, [u8]>) -> Source<'t> {
        let (numbers, o_words, next) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        Source { name, text, numbers, o_words, next }
    }

    /// The first of the files `names` that the folders have; read where it has not been before.
    ///
    /// # Errors
    /// There is none, or there are too many files already.
    pub(super) fn open(&self, folders: &Folders, names: &[String]) -> Result<&Source<'t>, String> {
        let (mut last, mut count) = (self, 1);
        loop {
            if names.contains(&last.name) {
                return Ok(last);
            }
            match last.next.get() {
                Some(next) => (last, count) = (next, count + 1),
                None => break,
            }
        }
        if count >= MOST_FILES {
            return Err(format!("more than {MOST_FILES} files are called"));
        }
        let mut missing = String::new();
        for name in names {
            match folders.open(name) {
                Ok(text) => {
                    let fresh = || Box::new(Source::new(name.clone(), text.into()));
                    return Ok(last.next.get_or_init(fresh));
                }
                Err(error) if missing.is_empty() => missing = error,
                Err(_) => {}
            }
        }
        Err(missing)
    }

    /// The O-words of the file; with `deletes` those in blocks with `/` are none.
    ///
    /// # Errors
    /// They do not fit together.
    pub(super) fn o_words(&self, deletes: bool) -> Result<&OWords, Fault> {
        if let Some(words) = self.o_words.get() {
            return Ok(words);
        }
        let words = OWords::of(&self.text, deletes).map_err(|fault| self.located(fault))?;
        Ok(self.o_words.get_or_init(|| words))
    }

    /// The numbers of programs and blocks and the loops of macro B in the file; with `deletes` but for
    /// those in blocks with `/`.
    ///
    /// # Errors
    /// They do not fit together.
    pub(super) fn numbers(&self, deletes: bool) -> Result<&Numbers, Fault> {
        if let Some(numbers) = self.numbers.get() {
            return Ok(numbers);
        }
        let numbers = Numbers::of(&self.text, deletes).map_err(|fault| self.located(fault))?;
        Ok(self.numbers.get_or_init(|| numbers))
    }

    /// The finding with the name of this file.
    pub(super) fn located(&self, fault: Fault) -> Fault {
        if self.name.is_empty() || !fault.file.is_empty() {
            return fault;
        }
        let fault: Diagnostic = *fault;
        fault.file(self.name.clone()).into()
    }
}

impl<'a> SourceLocation<'a> {
    /// A block to which a call goes.
    pub(super) fn called(source: &'a Source<'a>, to: flow::BlockLocation) -> SourceLocation<'a> {
        SourceLocation { source, at: to.at, line: to.line - 1, percent_signs: 1 }
    }

    /// The next line and its number; how many bytes it has may be known.
    pub(super) fn next(&mut self, length: Option<usize>) -> (&'a [u8], u32) {
        let rest = self.source.text.get(self.at..).unwrap_or_default();
        let end = length.or_else(|| memchr::memchr(b'\n', rest)).unwrap_or(rest.len());
        let line = rest.get(..end).unwrap_or(rest);
        self.at += rest.len().min(end + 1);
        self.line = self.line.saturating_add(1);
        (line.strip_suffix(b"\r").unwrap_or(line), self.line)
    }
}
