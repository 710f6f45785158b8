//! Where jumps go: the labels and block numbers of a program, and its control structures.

use super::library::Program;
use crate::sinumerik::Fallible;
use crate::sinumerik::language::scan::{Name, Scanner, Source};
use crate::sinumerik::language::structure::Word;
use std::collections::HashMap;

/// How deep control structures nest on each level (Job Planning 04.00, 1.13).
const DEEPEST: usize = 16;

/// Where a block starts: its byte in the program, and its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    /// Byte within the text of the program.
    pub at: usize,
    /// Line within the file.
    pub line: u32,
}

/// A block that is part of a control structure.
struct Mark {
    place: Place,
    /// The block behind it.
    after: Place,
    word: Word,
    /// The next block of the same structure; for the last one, the first.
    partner: usize,
    /// The structure that the blocks behind it stand in, by its last word before them.
    inside: Option<usize>,
}

/// What is known of a program's blocks without running them.
pub(crate) struct Outline {
    labels: HashMap<Name, Vec<Place>>,
    numbers: HashMap<u32, Vec<Place>>,
    /// In the order of the program.
    marks: Vec<Mark>,
}

impl Outline {
    /// Reads the beginning of every block.
    ///
    /// # Errors
    /// Control structures that do not fit together.
    pub fn of(program: &Program) -> Fallible<Outline> {
        let mut outline =
            Outline { labels: HashMap::new(), numbers: HashMap::new(), marks: Vec::new() };
        let mut open: Vec<usize> = Vec::new();
        let mut place = Place { at: 0, line: program.first_line };
        while let Some((source, next)) = program.block(place.at, place.line) {
            let after = Place { at: next, line: place.line.saturating_add(1) };
            outline.add(&source, place, after, &mut open)?;
            place = after;
        }
        let Some(mark) = open.last().and_then(|index| outline.marks.get(*index)) else {
            return Ok(outline);
        };
        let text = program.block(mark.place.at, mark.place.line).map_or(&[][..], |b| b.0.text);
        let source = Source { line: mark.place.line, text };
        let message = format!("{} has no end (alarm 12640)", mark.word.name());
        Err(source.block_error("control-structure", message))
    }

    fn add(
        &mut self,
        source: &Source,
        place: Place,
        after: Place,
        open: &mut Vec<usize>,
    ) -> Fallible<()> {
        let mut scanner = Scanner::new(*source);
        // What is wrong with a block that is never run is nobody's business.
        let Ok(head) = scanner.head() else { return Ok(()) };
        if let Some(number) = head.number {
            self.numbers.entry(number).or_default().push(place);
        }
        if let Some(label) = head.label {
            self.labels.entry(label).or_default().push(place);
        }
        scanner.blanks();
        if !scanner.name_next() {
            return Ok(());
        }
        let Some(word) = scanner.name().ok().and_then(|name| Word::named(name.as_str())) else {
            return Ok(());
        };
        let jump = word == Word::If && has_jump(&mut scanner);
        let section = word == Word::Repeat && !scanner.rests();
        if jump || section {
            return Ok(());
        }
        let error = |message: String| Err(source.block_error("control-structure", message));
        let index = self.marks.len();
        let mut mark = Mark { place, after, word, partner: index, inside: Some(index) };
        if let Some(opener) = word.opener() {
            let before = open.pop().and_then(|index| self.marks.get_mut(index).map(|m| (index, m)));
            let fits = |m: &Mark| m.word == opener || word == Word::EndIf && m.word == Word::Else;
            let Some((before, last)) = before.filter(|(_, m)| fits(m)) else {
                let message =
                    format!("{} without its {} (alarm 12640)", word.name(), opener.name());
                return error(message);
            };
            let first = if last.word == Word::Else { last.partner } else { before };
            last.partner = index;
            mark.partner = first;
            if word == Word::Else {
                open.push(index);
            } else {
                mark.inside = open.last().copied();
            }
        } else {
            if open.len() >= DEEPEST {
                return error(format!("control structures nest deeper than {DEEPEST}"));
            }
            open.push(index);
        }
        self.marks.push(mark);
        Ok(())
    }

    fn mark(&self, at: usize) -> Option<&Mark> {
        let index = self.marks.binary_search_by_key(&at, |mark| mark.place.at).ok()?;
        self.marks.get(index)
    }

    /// The block of the control structure behind the one at `at`: `ELSE` or `ENDIF` behind `IF`, the
    /// end behind the beginning, the beginning behind the end.
    pub fn partner(&self, at: usize) -> Option<(Place, Place)> {
        let partner = self.marks.get(self.mark(at)?.partner)?;
        Some((partner.place, partner.after))
    }

    /// The structures that the block at `at` stands in, from the inmost to the outmost, by their last
    /// words before it.
    fn around(&self, at: usize) -> impl Iterator<Item = usize> {
        let before = self.marks.partition_point(|mark| mark.place.at < at);
        let mut inside = before.checked_sub(1).and_then(|i| self.marks.get(i)?.inside);
        std::iter::from_fn(move || {
            let index = inside?;
            // What is around a structure is what its first word stands in.
            let mark = self.marks.get(index)?;
            let first = if mark.word == Word::Else { self.first_of(index) } else { index };
            inside = first.checked_sub(1).and_then(|i| self.marks.get(i)?.inside);
            Some(index)
        })
    }

    /// The `IF` of an `ELSE`.
    fn first_of(&self, otherwise: usize) -> usize {
        let end = self.marks.get(otherwise).map_or(otherwise, |mark| mark.partner);
        self.marks.get(end).map_or(otherwise, |mark| mark.partner)
    }

    /// Whether a jump from the block at `from` to the one at `to` enters no control structure.
    pub fn may_jump(&self, from: usize, to: usize) -> bool {
        match self.around(to).next() {
            None => true,
            Some(inmost) => self.around(from).any(|index| index == inmost),
        }
    }

    /// The blocks with that label, in the order of the program.
    pub fn labelled(&self, name: &Name) -> &[Place] {
        self.labels.get(name).map_or(&[], Vec::as_slice)
    }

    /// The blocks with that number, in the order of the program.
    pub fn numbered(&self, number: u32) -> &[Place] {
        self.numbers.get(&number).map_or(&[], Vec::as_slice)
    }
}

/// Whether a jump stands behind a condition, which makes no control structure of it.
fn has_jump(scanner: &mut Scanner) -> bool {
    let (mut quoted, mut inside_name) = (false, false);
    while scanner.at < scanner.source.text.len() {
        let byte = scanner.peek();
        if byte == b'"' {
            quoted = !quoted;
        } else if byte == b';' && !quoted {
            return false;
        } else if byte == b'G' && !quoted && !inside_name {
            let goes = ["GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS"];
            if goes.iter().any(|word| scanner.take_word(word)) {
                return true;
            }
        }
        inside_name = scanner.name_goes_on();
        scanner.at += 1;
    }
    false
}
