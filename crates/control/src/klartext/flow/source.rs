//! The text of a program: its blocks one after the other, and where its labels are.

use crate::kernel::Outcome;
use crate::klartext::language::scan::Scanner;
use program::{Diagnostic, Rule};
use std::borrow::Cow;
use std::collections::HashMap;

/// Where a block begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BlockLocation {
    /// Byte of the text.
    pub(super) offset: usize,
    /// Lines before it.
    line: u32,
    /// The least number that the block may have.
    number: u32,
}

/// A line of a block, the first one from behind its number.
#[derive(Clone, Copy)]
pub(super) struct Line<'t> {
    pub(super) scanner: Scanner<'t>,
    /// Whether the block goes on in the next line.
    pub(super) continued: bool,
}

/// What stands behind `LBL`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Label<'t> {
    Number(u32),
    Name(Cow<'t, [u8]>),
}

impl std::fmt::Display for Label<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Label::Number(number) => write!(f, "{number}"),
            Label::Name(name) => write!(f, "\"{}\"", String::from_utf8_lossy(name)),
        }
    }
}

/// Highest number of a label.
pub(super) const LAST_LABEL: u32 = 65_535;

/// A program on its way through its text.
///
/// Labels are noted as the program passes them; one that is called before that is looked for in what
/// has not been passed. So every block is looked at once for a label, and a jump takes no search.
pub(super) struct Source<'t> {
    text: Text<'t>,
    /// The next block.
    at: BlockLocation,
    /// The first block that has not been looked at for a label.
    unseen: BlockLocation,
    labels: HashMap<Label<'t>, BlockLocation>,
    /// Whether any corner is cut off: most programs have none to look for.
    corners: bool,
}

/// The lines of a text, ended by LF, CR LF or CR.
#[derive(Clone, Copy)]
struct Text<'t> {
    /// Name of a called file; empty for the main program.
    file: &'t str,
    bytes: &'t [u8],
    /// Whether the blocks have numbers: all of them, or none.
    numbered: bool,
    /// Whether blocks that begin with `/` are skipped.
    block_delete: bool,
}

impl<'t> Text<'t> {
    /// The line at a place, which goes on to the next one.
    fn line(&self, at: &mut BlockLocation) -> Option<Scanner<'t>> {
        let rest = self.bytes.get(at.offset..).filter(|rest| !rest.is_empty())?;
        let length = memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
        let (line, ending) = rest.split_at(length);
        at.offset += length + if ending.starts_with(b"\r\n") { 2 } else { ending.len().min(1) };
        at.line = at.line.saturating_add(1);
        Some(Scanner::new(self.file, at.line, line))
    }

    /// The block at a place, which goes on behind its first line. `None` at the end.
    fn block(&self, at: &mut BlockLocation) -> Outcome<Option<Line<'t>>> {
        loop {
            let Some(mut s) = self.line(at) else { return Ok(None) };
            if s.is_blank() {
                continue;
            }
            let continued = s.take_continuation();
            let optional = s.take_slash();
            if self.numbered {
                block_number(&mut s, &mut at.number)?;
            }
            s.begin_block();
            if !(optional && self.skips(s)) {
                return Ok(Some(Line { scanner: s, continued }));
            }
            self.pass(at, continued);
        }
    }

    /// Whether a block that begins with `/` is skipped. The function does not work for TOOL DEF.
    fn skips(&self, mut block: Scanner) -> bool {
        self.block_delete && !(block.take(b"TOOL") && block.take(b"DEF"))
    }

    /// Passes the further lines of a block.
    fn pass(&self, at: &mut BlockLocation, mut continued: bool) {
        while continued {
            continued = self.continuation(at).is_some_and(|line| line.continued);
        }
    }

    /// A further line of a block.
    fn continuation(&self, at: &mut BlockLocation) -> Option<Line<'t>> {
        let mut scanner = self.line(at)?;
        let continued = scanner.take_continuation();
        Some(Line { scanner, continued })
    }
}

impl<'t> Source<'t> {
    /// At the start of a text.
    pub(super) fn new(file: &'t str, bytes: &'t [u8], block_delete: bool) -> Source<'t> {
        let numbered = bytes.trim_ascii_start().first().is_none_or(u8::is_ascii_digit);
        let start = BlockLocation { offset: 0, line: 0, number: 0 };
        let text = Text { file, bytes, numbered, block_delete };
        let has = |word: &[u8]| memchr::memmem::find(bytes, word).is_some();
        let corners = has(b"RND") || has(b"CHF");
        Source { text, at: start, unseen: start, labels: HashMap::new(), corners }
    }

    /// Takes the next block; `None` where the text ends.
    #[inline]
    pub(super) fn next(&mut self) -> Outcome<Option<Line<'t>>> {
        let place = self.at;
        let block = self.text.block(&mut self.at)?;
        if place.offset == self.unseen.offset
            && let Some(block) = &block
        {
            self.note(place, &block.scanner)?;
            // Its further lines are no blocks; most blocks have none.
            let mut end = self.at;
            self.text.pass(&mut end, block.continued);
            self.unseen = end;
        }
        Ok(block)
    }

    /// Takes a further line of a block; `None` where the text ends.
    pub(super) fn continuation(&mut self) -> Option<Line<'t>> {
        self.text.continuation(&mut self.at)
    }

    /// The next block.
    pub(super) fn place(&self) -> BlockLocation {
        self.at
    }

    /// The line at a place; an empty one behind the last.
    pub(super) fn line_at(&self, place: BlockLocation) -> Scanner<'t> {
        let line = self.text.line(&mut place.clone());
        line.unwrap_or(Scanner::new(self.text.file, place.line, b""))
    }

    /// Goes on from a place.
    pub(super) fn jump(&mut self, to: BlockLocation) {
        self.at = to;
    }

    /// Where a label is.
    pub(super) fn label(&mut self, label: &Label) -> Outcome<Option<BlockLocation>> {
        while !self.labels.contains_key(label) {
            let place = self.unseen;
            let mut end = place;
            let Some(block) = self.text.block(&mut end)? else { return Ok(None) };
            self.note(place, &block.scanner)?;
            self.text.pass(&mut end, block.continued);
            self.unseen = end;
        }
        Ok(self.labels.get(label).copied())
    }

    /// The first word of the next block that is no comment.
    fn upcoming(&self) -> &'t [u8] {
        let mut at = self.at;
        loop {
            match self.text.block(&mut at) {
                Ok(Some(mut block)) => match block.scanner.peek() {
                    b"" | b"*" => self.text.pass(&mut at, block.continued),
                    word => return word,
                },
                _ => return b"",
            }
        }
    }

    /// Whether the next block rounds or chamfers the corner at which the tool is.
    pub(super) fn corner_follows(&self) -> bool {
        self.corners && matches!(self.upcoming(), b"RND" | b"CHF")
    }

    /// The program is closed: only blank lines follow.
    pub(super) fn close(&mut self) -> Outcome {
        while let Some(line) = self.text.line(&mut self.at) {
            if !line.rest().is_empty() {
                return Err(line.error_block(Rule::ProgramFrame, "nothing may follow END PGM"));
            }
        }
        Ok(())
    }

    /// Notes the label of a block, if it has one.
    #[inline(always)]
    fn note(&mut self, place: BlockLocation, s: &Scanner<'t>) -> Outcome {
        if s.is_at_label() { self.note_label(place, *s) } else { Ok(()) }
    }

    fn note_label(&mut self, place: BlockLocation, mut s: Scanner<'t>) -> Outcome {
        s.take_symbol(b"LBL");
        let label = written_label(&mut s)?;
        if label != Label::Number(0) && self.labels.contains_key(&label) {
            let message = format!("label {label} is set twice in this program");
            return Err(s.error_block(Rule::Label, message));
        }
        self.labels.insert(label, place);
        Ok(())
    }
}

/// A label that is written as it is: `5`, `"NAME"`.
pub(super) fn written_label<'t>(s: &mut Scanner<'t>) -> Outcome<Label<'t>> {
    if s.peek().starts_with(b"\"") {
        return s.quoted().map(|name| Label::Name(Cow::Borrowed(name)));
    }
    s.digits(LAST_LABEL).map(Label::Number)
}

/// The number at the start of a block. It says nothing to the control, which numbers the blocks anew; but
/// one that does not ascend tells of blocks that have changed places.
#[inline]
fn block_number(s: &mut Scanner, least: &mut u32) -> Outcome {
    let before = *s;
    match s.whole_number() {
        Some(number) if number >= *least => {
            *least = number.saturating_add(1);
            Ok(())
        }
        _ => Err(wrong_number(before, *least)),
    }
}

#[cold]
fn wrong_number(mut s: Scanner, least: u32) -> Box<Diagnostic> {
    let (_, span) = s.token();
    let message = format!("a block number of at least {least} is expected here");
    let help = "number the blocks ascending, or leave all numbers out";
    let error: Box<Diagnostic> = s.error(Rule::BlockNumber, span, message);
    error.help(help).into()
}
