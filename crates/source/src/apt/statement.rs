//! From bytes to statements: lines, `$` continuation, major word and fields.
//!
//! A line ends with LF, CR LF or CR. A statement is a line, and as many more as the `$` at their ends
//! (or a comma at their ends) ask for. `$$` starts a remark. Blanks and control characters between
//! the parts of a statement mean nothing.

use super::number;
use super::report::Fault;
use super::table::takes_text;
use program::{Diagnostic, Rule};

/// The longest line and the longest joined statement, bytes: a thousand times what any CAM system
/// writes, and short enough that a file of one endless line costs no memory.
pub(super) const LONGEST: usize = 1 << 16;

/// A line of the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'t> {
    /// From 1.
    pub(super) number: u32,
    /// Without its end.
    pub(super) text: &'t [u8],
}

/// The lines of a file, one after the other.
#[derive(Clone, Debug)]
pub(super) struct Lines<'t> {
    rest: &'t [u8],
    number: u32,
}

impl<'t> Lines<'t> {
    /// The lines of `text`.
    pub(super) fn of(text: &'t [u8]) -> Lines<'t> {
        Lines { rest: text, number: 0 }
    }
}

impl<'t> Iterator for Lines<'t> {
    type Item = Line<'t>;

    #[inline]
    fn next(&mut self) -> Option<Line<'t>> {
        if self.rest.is_empty() {
            return None;
        }
        let end = memchr::memchr2(b'\n', b'\r', self.rest).unwrap_or(self.rest.len());
        let (text, mut rest) = self.rest.split_at(end);
        rest = match rest {
            [b'\r', b'\n', rest @ ..] | [_, rest @ ..] => rest,
            [] => rest,
        };
        self.rest = rest;
        self.number = self.number.saturating_add(1);
        Some(Line { number: self.number, text })
    }
}

/// The first line of `text` that begins a statement which loads a tool.
pub(super) fn first_load(text: &[u8]) -> Option<u32> {
    let loads = |line: &Line| {
        let first = line.text.iter().find(|c| !is_blank(**c));
        // The first letter decides for most lines.
        if !matches!(first, Some(b'L' | b'l')) {
            return false;
        }
        let (from, to) = head(line.text).major;
        let major = line.text.get(from..to).unwrap_or_default();
        major.eq_ignore_ascii_case(b"LOAD") || major.eq_ignore_ascii_case(b"LOADTL")
    };
    Lines::of(text).find(loads).map(|line| line.number)
}

/// A field of a statement: what stands between two commas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Field {
    /// A number.
    Number(f64),
    /// A word, at these bytes of the statement.
    Word(usize, usize),
    /// Nothing.
    Blank,
}

/// A statement: its major word and the fields after it.
pub(super) struct Statement<'r> {
    /// Line on which it starts.
    pub(super) line: u32,
    /// Its whole text, joined where it ran over several lines.
    pub(super) text: &'r [u8],
    /// The major word, in the case of the file.
    pub(super) major: &'r [u8],
    /// What follows the major word and its slash, as written; where it begins in `text`.
    pub(super) body: (&'r [u8], usize),
    /// The fields of the body; none where the statement is text.
    pub(super) fields: &'r [Field],
    spans: &'r [(usize, usize)],
    pieces: &'r [(usize, Line<'r>)],
}

impl<'r> Statement<'r> {
    /// `line` as a statement that is not taken apart.
    pub(super) fn whole(line: Line<'r>) -> Statement<'r> {
        let body = (line.text, 0);
        let major = b"";
        Statement {
            line: line.number,
            text: line.text,
            major,
            body,
            fields: &[],
            spans: &[],
            pieces: &[],
        }
    }

    /// The word in field `index`, as written.
    pub(super) fn word(&self, index: usize) -> Option<&'r [u8]> {
        match self.fields.get(index)? {
            Field::Word(from, to) => self.text.get(*from..*to),
            _ => None,
        }
    }

    /// Whether field `index` is the word `word` (capitals).
    pub(super) fn is(&self, index: usize, word: &str) -> bool {
        self.word(index).is_some_and(|w| w.eq_ignore_ascii_case(word.as_bytes()))
    }

    /// The number in field `index`.
    ///
    /// # Errors
    /// `malformed` where there is none; `what` says what it should have been.
    pub(super) fn number(&self, index: usize, what: &str) -> Result<f64, Box<Fault>> {
        match self.fields.get(index) {
            Some(Field::Number(value)) => Ok(*value),
            Some(Field::Word(from, to)) => {
                let word = self.text.get(*from..*to).unwrap_or_default();
                Err(Fault::new(Rule::Malformed, not_a_number(word))
                    .help(format!("{what} is a decimal number"))
                    .fields(index, 1))
            }
            _ => Err(Fault::new(Rule::Malformed, format!("{what} is missing"))
                .help("write a decimal number here")
                .fields(index, 1)),
        }
    }

    /// The fields from `first` on as numbers.
    ///
    /// # Errors
    /// `malformed` where one is not a number.
    pub(super) fn numbers<const N: usize>(&self, first: usize) -> Result<[f64; N], Box<Fault>> {
        let mut values = [0.0; N];
        for (i, value) in values.iter_mut().enumerate() {
            *value = self.number(first + i, "a value")?;
        }
        Ok(values)
    }

    /// How many fields there are; fails where it is none of `allowed`.
    ///
    /// # Errors
    /// `malformed`, with `syntax` as the way out.
    pub(super) fn count(&self, allowed: &[usize], syntax: &str) -> Result<usize, Box<Fault>> {
        let count = self.fields.len();
        if allowed.contains(&count) {
            return Ok(count);
        }
        let message = format!("{count} values where this statement takes {}", list(allowed));
        Err(Fault::new(Rule::Malformed, message).help(format!("write {syntax}")).fields(0, count))
    }

    /// `diagnostic` placed at `fields` (first and how many) of this statement, or at the statement as a whole.
    pub(super) fn locate(
        &self,
        diagnostic: Diagnostic,
        fields: Option<(usize, usize)>,
    ) -> Diagnostic {
        let end = self.text.len();
        let (start, end) = match fields {
            None => (0, end),
            Some((first, count)) => {
                let from = self.spans.get(first).map_or(end, |span| span.0);
                let last = self.spans.len().min(first + count.max(1));
                let to = self.spans.get(last.saturating_sub(1)).map_or(end, |span| span.1);
                (from, to.max(from))
            }
        };
        // The statement may have been joined from several lines; the one on which the place begins is
        // shown.
        let piece = self.pieces.iter().rev().find(|(offset, _)| *offset <= start);
        match piece.or(self.pieces.first()) {
            Some((offset, line)) => {
                let trimmed = line.text.trim_ascii_end().len();
                let (start, end) = (start - offset.min(&start), end - offset.min(&end));
                diagnostic.at(line.number, line.text, start.min(trimmed), end.min(trimmed))
            }
            None => diagnostic.line(self.line),
        }
    }
}

/// `3`, `3 or 6`, `1, 3 or 6`.
fn list(counts: &[usize]) -> String {
    let words: Vec<String> = counts.iter().map(usize::to_string).collect();
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, first)) => format!("{} or {last}", first.join(", ")),
        None => String::new(),
    }
}

/// Joins lines to statements and takes them apart; its memory is used again for each.
#[derive(Default)]
pub(super) struct Joiner<'t> {
    joined: Vec<u8>,
    pieces: Vec<(usize, Line<'t>)>,
    fields: Vec<Field>,
    spans: Vec<(usize, usize)>,
}

impl<'t> Joiner<'t> {
    /// The statement that starts on `first`; further lines are taken from `lines` as it asks for them.
    ///
    /// # Errors
    /// `malformed`, `line-too-long`; the place is in the diagnostic.
    pub(super) fn statement<'r>(
        &'r mut self,
        first: Line<'t>,
        lines: &mut Lines<'t>,
    ) -> Result<Statement<'r>, Box<Diagnostic>>
    where
        't: 'r,
    {
        self.pieces.clear();
        self.joined.clear();
        self.fields.clear();
        self.spans.clear();
        too_long(first)?;
        self.pieces.push((0, first));
        let Head { major, body, free_text } = head(first.text);
        let is_text = free_text == Some(true);
        let mut text = first.text;
        if !is_text {
            let (content, continued) = strip(&first.text[body..], lines);
            text = &first.text[..body + content];
            if continued {
                self.joined.extend_from_slice(text);
                self.join(first, lines)?;
                text = &self.joined;
            }
        }
        let mut statement = Statement {
            line: first.number,
            text,
            major: text.get(major.0..major.1).unwrap_or_default(),
            body: (text.get(body..).unwrap_or_default(), body),
            fields: &[],
            spans: &[],
            pieces: &self.pieces,
        };
        if is_text {
            return Ok(statement);
        }
        // In a point a value left out stays, the last one too; elsewhere it is forgotten.
        let is_point = ["GOTO", "FROM", "CUTCOM"];
        let open_end = is_point.iter().any(|w| statement.major.eq_ignore_ascii_case(w.as_bytes()));
        let result = split_fields(text, body, open_end, &mut self.fields, &mut self.spans);
        statement.fields = &self.fields;
        statement.spans = &self.spans;
        match result {
            Ok(()) => Ok(statement),
            // What follows a word that is not known, or a directive, need not be made of fields.
            Err(_) if free_text.is_none() || statement.major == b"$$->" => Ok(statement),
            Err((from, to, message)) => {
                statement.spans = &[];
                let spans = [(from, to)];
                let statement = Statement { spans: &spans, ..statement };
                let error = Diagnostic::error(Rule::Malformed, message)
                    .help("values are decimal numbers and words, with commas between them");
                Err(Box::new(statement.locate(error, Some((0, 1)))))
            }
        }
    }

    /// Appends the continuation lines of the statement that starts on `first`.
    fn join(&mut self, first: Line<'t>, lines: &mut Lines<'t>) -> Result<(), Box<Diagnostic>> {
        loop {
            let Some(next) = lines.next() else {
                let end = first.text.len();
                let error =
                    Diagnostic::error(Rule::Truncated, "the file ends inside this statement")
                        .help("the file is cut off: write it again")
                        .at(first.number, first.text, 0, end);
                return Err(Box::new(error));
            };
            too_long(next)?;
            if self.joined.len() + next.text.len() > LONGEST {
                return Err(Box::new(too_long_error(first)));
            }
            self.pieces.push((self.joined.len(), next));
            let (content, continued) = strip(next.text, lines);
            self.joined.extend_from_slice(&next.text[..content]);
            if !continued {
                return Ok(());
            }
        }
    }
}

fn too_long(line: Line) -> Result<(), Box<Diagnostic>> {
    if line.text.len() <= LONGEST { Ok(()) } else { Err(Box::new(too_long_error(line))) }
}

#[cold]
fn too_long_error(line: Line) -> Diagnostic {
    Diagnostic::error(Rule::LineTooLong, format!("a statement of more than {LONGEST} bytes"))
        .help("this is not cutter-location data in text form")
        .at(line.number, line.text, 0, 1)
}

/// How many bytes of a line belong to its statement, and whether the next line does too. A `$` at the end
/// continues it, `$$` ends it; a comma at the end continues it too, as CATIA's statements are printed,
/// where no statement begins on the next line.
fn strip(text: &[u8], lines: &Lines) -> (usize, bool) {
    let end = memchr::memmem::find(text, b"$$").unwrap_or(text.len());
    let content = trim_end(&text[..end]);
    match text[..content].last() {
        Some(b'$') => (content - 1, true),
        Some(b',') => {
            let next = lines.clone().next().map(|line| head(line.text));
            let begins = |next: Head| next.free_text.is_some() && next.major.0 < next.major.1;
            (content, !next.is_some_and(begins))
        }
        _ => (content, false),
    }
}

/// Length of `text` without the blanks and control characters at its end.
fn trim_end(text: &[u8]) -> usize {
    text.iter().rposition(|c| !is_blank(*c)).map_or(0, |last| last + 1)
}

/// Blanks and control characters.
pub(super) fn is_blank(c: u8) -> bool {
    c <= b' ' || c == 0x7f
}

/// How a line begins.
struct Head {
    /// Where its major word is; empty for a line of coordinates alone.
    major: (usize, usize),
    /// Where its body starts.
    body: usize,
    /// Whether the body is free text; `None` where the word is not known.
    free_text: Option<bool>,
}

/// How `text` begins.
fn head(text: &[u8]) -> Head {
    let start = text.iter().position(|c| !is_blank(*c)).unwrap_or(text.len());
    let head = |end: usize, body| {
        let major = (start, end.max(start));
        Head { major, body, free_text: takes_text(&text[start..end.max(start)]) }
    };
    match text.get(start) {
        Some(b'$') if text[start..].starts_with(b"$$->") => return head(start + 4, start + 4),
        Some(b'$') if text[start..].starts_with(b"$$") => return head(start + 2, start + 2),
        // Coordinates alone: further points of the statement before.
        Some(b'0'..=b'9' | b'-' | b'+' | b'.') => return head(start, start),
        _ => {}
    }
    let slash = memchr::memchr(b'/', text);
    let by_slash = slash.map(|slash| head(trim_end(&text[..slash]), slash + 1));
    if let Some(found @ Head { free_text: Some(_), .. }) = by_slash {
        return found;
    }
    // Words without a slash, and the old form of the text statements: `PARTNO a name`.
    let is_part = |c: &u8| c.is_ascii_alphanumeric() || matches!(c, b'-' | b'_');
    let length = text[start..].iter().position(|c| !is_part(c)).unwrap_or(text.len() - start);
    let by_word = head(start + length.max(1).min(text.len() - start), start + length);
    match (by_slash, by_word.free_text) {
        (Some(by_slash), None | Some(false)) => by_slash,
        _ => by_word,
    }
}

/// Takes `text` from `at` on apart. Commas part the fields; so do the slash after a word and
/// parentheses, which set off a nested definition (`(CIRCLE/...)`). With `open_end` a comma at the end
/// leaves a last field out.
fn split_fields(
    text: &[u8],
    mut at: usize,
    open_end: bool,
    fields: &mut Vec<Field>,
    spans: &mut Vec<(usize, usize)>,
) -> Result<(), (usize, usize, String)> {
    let mut open = 0usize;
    // Whether a field may end here: after a comma, or at the start, what follows is a field.
    let mut expected = false;
    let mut any = false;
    loop {
        // A single `$` inside a line marks where it was continued, in print.
        while at < text.len() && (is_blank(text[at]) || text[at] == b'$') {
            at += 1;
        }
        let Some(&c) = text.get(at) else { break };
        any = true;
        match c {
            b',' => {
                if expected || fields.is_empty() {
                    fields.push(Field::Blank);
                    spans.push((at, at + 1));
                }
                expected = true;
                at += 1;
            }
            b'(' => {
                open += 1;
                at += 1;
                expected = true;
            }
            b')' if open > 0 && !expected => {
                open -= 1;
                at += 1;
            }
            b'-' | b'+' | b'.' | b'0'..=b'9' => {
                let length = text[at..].iter().position(|c| b",)/$(".contains(c) || is_blank(*c));
                let end = length.map_or(text.len(), |n| at + n);
                if !expected && !fields.is_empty() {
                    return Err((at, end, "a comma is missing before this number".into()));
                }
                let after = text[end..].iter().find(|c| !is_blank(**c));
                if after.is_some_and(|c| !b",)$".contains(c)) {
                    return Err((end, end + 1, "a number must end with a comma".into()));
                }
                let field = match number::leading(&text[at..end]) {
                    Some((value, length)) if length == end - at => Field::Number(value),
                    // A word may begin with a digit: `1STPECK`.
                    _ if c.is_ascii_digit() && text[at..end].iter().any(is_letter) => {
                        if exponent_only(&text[at..end]) {
                            return Err((at, end, "this number is too large".into()));
                        }
                        Field::Word(at, end)
                    }
                    _ => return Err((at, end, not_a_number(&text[at..end]))),
                };
                fields.push(field);
                spans.push((at, end));
                at = end;
                expected = false;
            }
            _ if is_word(c) => {
                let length = text[at..].iter().position(|c| !is_word(*c));
                let end = length.map_or(text.len(), |n| at + n);
                fields.push(Field::Word(at, end));
                spans.push((at, end));
                at = end;
                expected = false;
                while at < text.len() && is_blank(text[at]) {
                    at += 1;
                }
                if text.get(at) == Some(&b'/') {
                    at += 1;
                    expected = true;
                }
            }
            _ => return Err((at, at + 1, "this character has no place here".into())),
        }
    }
    if expected && any && text[..at].iter().rev().find(|c| !is_blank(**c)) == Some(&b',') {
        if open_end {
            fields.push(Field::Blank);
            spans.push((at, at));
        } else {
            return Err((
                at.saturating_sub(1),
                at,
                "a value is missing after the last comma".into(),
            ));
        }
    }
    if open > 0 {
        return Err((at.saturating_sub(1), at, "a parenthesis is not closed".into()));
    }
    Ok(())
}

fn is_letter(c: &u8) -> bool {
    c.is_ascii_alphabetic()
}

/// Whether `text` is shaped like a number with an exponent.
fn exponent_only(text: &[u8]) -> bool {
    text.last().is_some_and(u8::is_ascii_digit)
        && text.iter().all(|c| c.is_ascii_digit() || b".eEdD+-".contains(c))
}

/// What to say of `text` where a number should be.
#[cold]
fn not_a_number(text: &[u8]) -> String {
    let shown = text.get(..40).unwrap_or(text);
    format!("{} is not a number", String::from_utf8_lossy(shown))
}

fn is_word(c: u8) -> bool {
    c.is_ascii_alphanumeric() || b"-_.+*#:;&'\"=<>%@!?\\|~^`[]{}".contains(&c) || c >= 0x80
}
