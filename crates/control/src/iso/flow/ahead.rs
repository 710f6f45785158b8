//! Plain lines of a long program, taken apart in a thread of their own ahead of their run.

use super::source::SourceLocation;
use crate::iso::language::block::Word;
use crate::iso::language::plain;
use crate::kernel::LONG;
use crate::kernel::queue::{QueueReceiver, QueueSender, bounded};
use std::ops::Range;
use std::{mem, thread};

/// Lines that are handed over at once.
const BATCH: usize = 1024;

/// Plain lines in the order of the text, and their words one behind the other.
#[derive(Debug, Default)]
struct Batch {
    lines: Vec<Line>,
    words: Vec<Word>,
}

#[derive(Debug)]
struct Line {
    /// The byte where it begins, and that where it ends.
    bytes: Range<usize>,
    /// Its words.
    words: Range<usize>,
}

/// What has been read ahead.
#[derive(Debug, Default)]
pub(crate) struct Ahead {
    batches: Option<QueueReceiver<Batch>>,
    batch: Batch,
    /// The next line of the batch.
    next: usize,
    /// The words of the line at hand: those of the batch, or where it has not been read ahead its own.
    here: Option<Range<usize>>,
    words: Vec<Word>,
}

impl Ahead {
    /// Gives `run` what is read ahead of it in `text`.
    pub(crate) fn of<T>(text: &[u8], run: impl FnOnce(Ahead) -> T) -> T {
        if text.len() < LONG {
            return run(Ahead::default());
        }
        let (feed, batches) = bounded();
        thread::scope(|scope| {
            scope.spawn(move || read(text, &feed));
            run(Ahead { batches: Some(batches), ..Ahead::default() })
        })
    }

    /// How many bytes the line at `place` has, where it is plain; `is_main` in the program itself.
    pub(super) fn line(&mut self, place: &SourceLocation, is_main: bool) -> Option<usize> {
        if is_main && self.has(place.at) {
            let line = self.batch.lines.get(self.next)?;
            self.next += 1;
            self.here = Some(line.words.clone());
            return Some(line.bytes.len());
        }
        self.here = None;
        self.words.clear();
        let end = plain::line(&place.source.text, place.at, &mut self.words)?;
        Some(end - place.at)
    }

    /// The words of that line.
    pub(super) fn words(&self) -> &[Word] {
        match &self.here {
            Some(words) => self.batch.words.get(words.clone()).unwrap_or_default(),
            None => &self.words,
        }
    }

    /// Whether the next line is that which begins at byte `at`; those before it have been jumped over.
    fn has(&mut self, at: usize) -> bool {
        let Some(batches) = &self.batches else { return false };
        loop {
            match self.batch.lines.get(self.next) {
                Some(line) if line.bytes.start < at => self.next += 1,
                Some(line) => return line.bytes.start == at,
                None => {
                    let Some(next) = batches.take() else { return false };
                    let mut last = mem::replace(&mut self.batch, next);
                    last.clear();
                    batches.give_back(last);
                    self.next = 0;
                }
            }
        }
    }
}

impl Batch {
    fn clear(&mut self) {
        self.lines.clear();
        self.words.clear();
    }
}

/// Lays the plain lines of `text` on, until nobody takes them.
fn read(text: &[u8], feed: &QueueSender<Batch>) {
    let (mut batch, mut at) = (Batch::default(), 0);
    while at < text.len() {
        let from = batch.words.len();
        match plain::line(text, at, &mut batch.words) {
            Some(end) => {
                batch.lines.push(Line { bytes: at..end, words: from..batch.words.len() });
                at = end + 1;
            }
            None => {
                batch.words.truncate(from);
                let rest = text.get(at..).unwrap_or_default();
                at += memchr::memchr(b'\n', rest).unwrap_or(rest.len()) + 1;
            }
        }
        if batch.lines.len() == BATCH {
            match feed.lay(mem::take(&mut batch)) {
                Some(empty) => batch = empty,
                None => return,
            }
        }
    }
    feed.lay(batch);
}
