//! Symbolic expressions: lists of words and lists, each with its location in the file.

use crate::decimal::{decimal, whole};
use crate::report::{self, Location};
use geom::Vec2;
use program::Rule;

/// How deep lists may stand in each other: boards go seven deep.
const MAX_DEPTH: usize = 64;

/// The largest number that is taken: coordinates of KiCad's are 32-bit nanometres.
const MAX_NUMBER: f64 = 2_147.483_648;

/// An error with its location.
pub(super) struct Fault {
    pub(super) location: Location,
    pub(super) what: report::Fault,
}

/// What a handler gives back.
pub(super) type Outcome<T = ()> = Result<T, Fault>;

/// A file: its lists and words in the order in which they begin.
pub(super) struct Tree<'a> {
    text: &'a [u8],
    entries: Vec<Entry>,
}

/// A list or a word. What is in a list follows it.
struct Entry {
    start: u32,
    end: u32,
    line: u32,
    /// Index of the entry behind it and all that is in it.
    next: u32,
}

/// A list or a word of a tree.
#[derive(Clone, Copy)]
pub(super) struct Node<'t> {
    tree: &'t Tree<'t>,
    index: usize,
}

impl<'a> Tree<'a> {
    /// The one list that the file is.
    ///
    /// # Errors
    /// `file-size`, `list-open`, `list-closed`, `list-depth`, `text-open`, and `not-kicad` where there is no list.
    pub(super) fn new(text: &'a [u8]) -> Outcome<Tree<'a>> {
        let start = Location { line: 1, start: 0, end: 0 };
        if u32::try_from(text.len()).is_err() {
            let message = format!("{} bytes are more than this reader counts", text.len());
            return Err(fault(start, Rule::FileSize, message, "files of up to 4 GiB are read"));
        }
        let mut tree = Tree { text, entries: Vec::new() };
        // Lists that are not closed yet.
        let mut open: Vec<usize> = Vec::new();
        let (mut at, mut line) = (0, 1);
        while let Some(byte) = text.get(at) {
            let location = Location { line, start: at, end: at + 1 };
            match byte {
                b'\n' => (at, line) = (at + 1, line + 1),
                byte if byte.is_ascii_whitespace() => at += 1,
                b')' => {
                    let Some(list) = open.pop() else {
                        let message = "a parenthesis closes what was never opened";
                        return Err(fault(location, Rule::ListClosed, message, DAMAGED));
                    };
                    at += 1;
                    tree.close(list, at);
                }
                _ if open.is_empty() && (*byte != b'(' || !tree.entries.is_empty()) => {
                    let message = "there is something outside the one list that a board is";
                    return Err(fault(location, Rule::NotKicad, message, NO_BOARD));
                }
                b'(' => {
                    if open.len() == MAX_DEPTH {
                        let message = format!("more than {MAX_DEPTH} lists in each other");
                        return Err(fault(location, Rule::ListDepth, message, DAMAGED));
                    }
                    open.push(tree.entries.len());
                    tree.push(location);
                    at += 1;
                }
                b'"' => {
                    let Some(end) = closing_quote(text, at) else {
                        return Err(fault(
                            location,
                            Rule::TextOpen,
                            "a text is not closed",
                            DAMAGED,
                        ));
                    };
                    tree.push(Location { end, ..location });
                    let inside = text.get(at..end).unwrap_or_default();
                    line += memchr::memchr_iter(b'\n', inside).count() as u32;
                    at = end;
                }
                _ => {
                    let rest = text.get(at..).unwrap_or_default();
                    let ends = |b: &u8| b.is_ascii_whitespace() || matches!(b, b'(' | b')' | b'"');
                    let end = at + rest.iter().position(ends).unwrap_or(rest.len());
                    tree.push(Location { end, ..location });
                    at = end;
                }
            }
        }
        if let Some(entry) = open.last().and_then(|list| tree.entries.get(*list)) {
            let message = "this list is not closed: the end of the file is missing";
            return Err(fault(entry.location(), Rule::ListOpen, message, DAMAGED));
        }
        if tree.entries.is_empty() {
            return Err(fault(start, Rule::NotKicad, "there is nothing in the file", NO_BOARD));
        }
        Ok(tree)
    }

    fn push(&mut self, location: Location) {
        // The text is shorter than 2³² bytes, and an entry takes at least one.
        let next = self.entries.len() as u32 + 1;
        let (start, end) = (location.start as u32, location.end as u32);
        self.entries.push(Entry { start, end, line: location.line, next });
    }

    fn close(&mut self, list: usize, end: usize) {
        let next = self.entries.len() as u32;
        if let Some(entry) = self.entries.get_mut(list) {
            (entry.end, entry.next) = (end as u32, next);
        }
    }

    /// The list that the file is.
    pub(super) fn root(&self) -> Node<'_> {
        Node { tree: self, index: 0 }
    }
}

const DAMAGED: &str = "the file is damaged: save it again in KiCad";
const NO_BOARD: &str = "a board of KiCad 6 to 9 begins with \"(kicad_pcb\" (.kicad_pcb)";

impl Entry {
    fn location(&self) -> Location {
        Location { line: self.line, start: self.start as usize, end: self.end as usize }
    }
}

/// Behind the quote that closes the text which begins at `start`.
fn closing_quote(text: &[u8], start: usize) -> Option<usize> {
    let mut at = start + 1;
    loop {
        at += memchr::memchr2(b'"', b'\\', text.get(at..)?)?;
        match text.get(at) {
            Some(b'"') => return Some(at + 1),
            _ => at += 2,
        }
    }
}

#[cold]
fn fault(location: Location, rule: Rule, message: impl Into<String>, help: &str) -> Fault {
    Fault { location, what: report::fault(rule, message, help) }
}

impl<'t> Node<'t> {
    fn entry(&self) -> &'t Entry {
        const NOTHING: &Entry = &Entry { start: 0, end: 0, line: 0, next: 0 };
        self.tree.entries.get(self.index).unwrap_or(NOTHING)
    }

    /// Where it is: of a list the parenthesis and the name.
    pub(super) fn location(&self) -> Location {
        let whole = self.entry().location();
        match self.is_list() {
            true => Location {
                end: self.children().next().map_or(whole.end, |n| n.location().end),
                ..whole
            },
            false => whole,
        }
    }

    /// An error here.
    #[cold]
    pub(super) fn fault(&self, rule: Rule, message: impl Into<String>, help: &str) -> Fault {
        fault(self.location(), rule, message, help)
    }

    fn bytes(&self) -> &'t [u8] {
        let range = self.entry().location();
        self.tree.text.get(range.start..range.end).unwrap_or_default()
    }

    /// Whether it is a list.
    pub(super) fn is_list(&self) -> bool {
        self.bytes().starts_with(b"(")
    }

    /// Whether it is a word in quotes.
    pub(super) fn is_quoted(&self) -> bool {
        self.bytes().starts_with(b"\"")
    }

    /// Everything in a list, its name included.
    fn children(self) -> impl Iterator<Item = Node<'t>> {
        let end = if self.is_list() { self.entry().next as usize } else { 0 };
        let mut index = self.index + 1;
        std::iter::from_fn(move || {
            let child = (index < end).then_some(Node { index, ..self })?;
            index = child.entry().next as usize;
            Some(child)
        })
    }

    /// What is in a list behind its name.
    pub(super) fn items(self) -> impl Iterator<Item = Node<'t>> {
        self.children().skip(1)
    }

    /// The name of a list: its first word.
    pub(super) fn name(&self) -> &'t [u8] {
        self.children().next().map_or(b"", |first| first.word())
    }

    /// A word as it is written, without quotes; empty for a list.
    pub(super) fn word(&self) -> &'t [u8] {
        match self.bytes() {
            [b'(', ..] => b"",
            [b'"', inside @ .., b'"'] => inside,
            word => word,
        }
    }

    /// A word as it is meant.
    pub(super) fn text(&self) -> String {
        let word = self.word();
        let mut meant = Vec::with_capacity(word.len());
        let mut bytes = word.iter();
        while let Some(byte) = bytes.next() {
            meant.push(match byte {
                b'\\' => match bytes.next() {
                    Some(b'n') => b'\n',
                    Some(b't') => b'\t',
                    Some(b'r') => b'\r',
                    Some(other) => *other,
                    None => b'\\',
                },
                byte => *byte,
            });
        }
        String::from_utf8_lossy(&meant).into_owned()
    }

    /// Item `index` behind the name.
    pub(super) fn item(self, index: usize) -> Option<Node<'t>> {
        self.items().nth(index)
    }

    /// The first list of this name in the list.
    pub(super) fn find(self, name: &str) -> Option<Node<'t>> {
        self.all(name).next()
    }

    /// The lists of this name in the list.
    pub(super) fn all(self, name: &str) -> impl Iterator<Item = Node<'t>> {
        self.items().filter(move |item| item.is_list() && item.name() == name.as_bytes())
    }

    /// Whether it says `name`, `(name)` or `(name yes)`: versions write the same differently.
    pub(super) fn says(self, name: &str) -> bool {
        let word = |item: Node| !item.is_list() && item.word() == name.as_bytes();
        match self.find(name) {
            Some(list) => list.item(0).is_none_or(|value| value.word() != b"no"),
            None => self.items().any(word),
        }
    }

    /// The first list of this name in the list.
    ///
    /// # Errors
    /// `missing`.
    pub(super) fn need(self, name: &str) -> Outcome<Node<'t>> {
        self.find(name).ok_or_else(|| self.lacks(&format!("({name} …)")))
    }

    #[cold]
    fn lacks(&self, what: &str) -> Fault {
        let own = String::from_utf8_lossy(self.name()).into_owned();
        self.fault(Rule::Missing, format!("\"{own}\" has no {what}"), DAMAGED)
    }

    /// The number at `index`: mm or degrees.
    ///
    /// # Errors
    /// `missing`, `not-a-number`.
    pub(super) fn number(self, index: usize) -> Outcome<f64> {
        let Some(item) = self.item(index) else {
            return Err(self.lacks(&format!("value {}", index + 1)));
        };
        match decimal(item.word()) {
            Some(value) if value.abs() <= MAX_NUMBER => Ok(value),
            Some(value) => {
                let message = format!("{value} is beyond ±{MAX_NUMBER}");
                let help = "KiCad has no coordinates beyond 2147 mm";
                Err(item.fault(Rule::NotANumber, message, help))
            }
            None => {
                let shown = String::from_utf8_lossy(item.word()).into_owned();
                let message = format!("\"{shown}\" is not a decimal number");
                Err(item.fault(Rule::NotANumber, message, DAMAGED))
            }
        }
    }

    /// The number at `index`, which is a length.
    ///
    /// # Errors
    /// As [`Node::number`], and `not-a-length` where it is below 0.
    pub(super) fn length(self, index: usize) -> Outcome<f64> {
        let value = self.number(index)?;
        if value < 0.0 {
            let message = format!("a length of {value} mm");
            return Err(self.fault(Rule::NotALength, message, "lengths are 0 or greater"));
        }
        Ok(value)
    }

    /// The whole number at `index`.
    pub(super) fn whole(self, index: usize) -> Option<u32> {
        self.item(index).and_then(|item| whole(item.word()))
    }

    /// Width and height.
    ///
    /// # Errors
    /// As [`Node::length`].
    pub(super) fn size(self) -> Outcome<Vec2> {
        Ok(Vec2::new(self.length(0)?, self.length(1)?))
    }

    /// A point: X to the right, Y up. In the file Y points down.
    ///
    /// # Errors
    /// As [`Node::number`].
    pub(super) fn point(self) -> Outcome<Vec2> {
        Ok(Vec2::new(self.number(0)?, -self.number(1)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_words_and_texts() {
        let text = b"(a \"b (c) \\\"d\\n\\\\\"(e -1.5 2)f\n(e yes)(g)\n(h no)())";
        let tree = Tree::new(text).ok().unwrap();
        let root = tree.root();
        assert_eq!(root.name(), b"a");
        let quoted = root.item(0).unwrap();
        assert!(quoted.is_quoted() && !quoted.is_list());
        assert_eq!(quoted.text(), "b (c) \"d\n\\");
        assert_eq!(root.items().count(), 7);
        assert_eq!(root.need("e").ok().unwrap().point().ok(), Some(Vec2::new(-1.5, -2.0)));
        assert_eq!(root.all("e").count(), 2);
        assert!(root.says("f") && root.says("e") && root.says("g"));
        assert!(!root.says("h") && !root.says("c") && !root.says("yes"));
        assert_eq!(root.item(5).map(|h| h.location().line), Some(3));
        assert_eq!(root.item(6).map(|empty| empty.name()), Some(&b""[..]));
        assert_eq!((root.item(7).is_none(), root.find("c").is_none()), (true, true));
    }
}
