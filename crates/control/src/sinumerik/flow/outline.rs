//! Where jumps go: the labels and block numbers of a program, and its control structures.

use crate::kernel::Outcome;
use crate::kernel::flow::{BlockLocation, Labels, Structures};
use crate::kernel::source::Source;
use crate::sinumerik::language::scan::{Name, Scanner};
use crate::sinumerik::language::structure::Word;
use program::Rule;

/// How deep control structures nest on each level (Job Planning 04.00, 1.13).
const DEEPEST: usize = 16;

/// What is known of a program's blocks without running them.
#[derive(Default)]
pub(crate) struct Outline {
    /// The blocks with labels.
    pub labels: Labels<Name>,
    /// The blocks with numbers.
    pub numbers: Labels<u32>,
    /// The control structures.
    pub structures: Structures<Word>,
}

/// The block of `text` that starts at byte `at` on that line, and where the next one starts.
#[inline]
pub fn block(text: &[u8], at: usize, line: u32) -> Option<(Source<'_>, usize)> {
    let rest = text.get(at..).filter(|rest| !rest.is_empty())?;
    let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
    let piece = rest.get(..length).unwrap_or(rest);
    let piece = piece.strip_suffix(b"\r").unwrap_or(piece);
    Some((Source { line, text: piece }, at + length + 1))
}

impl Outline {
    /// Reads the beginning of every block of `text`, whose first one is at `start`.
    ///
    /// # Errors
    /// Control structures that do not fit together.
    pub fn of(text: &[u8], start: BlockLocation) -> Outcome<Outline> {
        let mut outline = Outline::default();
        let mut place = start;
        while let Some((source, next)) = block(text, place.at, place.line) {
            let after = BlockLocation { at: next, line: place.line.saturating_add(1) };
            outline.add(&source, place, after)?;
            place = after;
        }
        let Some([_, index]) = outline.structures.unclosed().next_back() else {
            return Ok(outline);
        };
        let mark = &outline.structures[index];
        let text = block(text, mark.place.at, mark.place.line).map_or(&[][..], |b| b.0.text);
        let source = Source { line: mark.place.line, text };
        let message = format!("{} has no end (alarm 12640)", mark.word.name());
        Err(source.block_error(Rule::ControlStructure, message))
    }

    fn add(&mut self, source: &Source, place: BlockLocation, after: BlockLocation) -> Outcome {
        let mut scanner = Scanner::new(*source);
        // What is wrong with a block that is never run is nobody's business.
        let Ok(head) = scanner.head() else { return Ok(()) };
        if let Some(number) = head.number {
            self.numbers.add(number, place);
        }
        if let Some(label) = head.label {
            self.labels.add(label, place);
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
        let error = |message: String| Err(source.block_error(Rule::ControlStructure, message));
        let (structures, places) = (&mut self.structures, [place, after]);
        let Some(opener) = word.opener() else {
            if structures.unclosed().len() >= DEEPEST {
                return error(format!("control structures nest deeper than {DEEPEST}"));
            }
            structures.open(word, places);
            return Ok(());
        };
        let before = structures.unclosed().next_back().map(|[_, last]| structures[last].word);
        if before != Some(opener) && (word, before) != (Word::EndIf, Some(Word::Else)) {
            return error(format!("{} without its {} (alarm 12640)", word.name(), opener.name()));
        }
        match word {
            Word::Else => structures.clause(word, places),
            _ => structures.close(word, places),
        };
        Ok(())
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
