//! A program that was edited by hand: the files that it has, and which of their lines are still those that were posted.

use crate::job::Job;
use crate::lines::Lines;
use ::post::Origins;
use app::Stop;
use program::{Diagnostic, Rule, encoding};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// So many lines, of both texts together, are looked at behind a difference for where they are alike again.
const AHEAD: usize = 64;

/// So many lines have to be alike there.
const ALIKE: usize = 3;

/// So many lines are compared behind differences; what follows is not known to be alike.
const MOST_COMPARED: usize = 1 << 22;

/// A text, and where its lines come from.
#[derive(Debug, Default)]
pub(crate) struct Text {
    pub(crate) lines: Lines,
    pub(crate) origins: Origins,
}

impl Text {
    /// Of a text whose lines come from there.
    pub(crate) fn of(text: Vec<u8>, origins: Origins) -> Arc<Text> {
        Arc::new(Text { lines: Lines::of(text), origins })
    }

    /// How much memory it takes, bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.lines.bytes() + 5 * self.origins.lines()
    }

    /// The same text with the origins that its lines have in `posted`, of which it is an edit.
    fn from(self: &Arc<Text>, posted: &Text) -> Arc<Text> {
        let text = self.lines.text();
        let lines = unedited(posted.lines.text(), text);
        Text::of(text.to_vec(), posted.origins.carried(lines))
    }
}

/// The files of a program.
#[derive(Clone, Debug)]
pub(crate) struct Files {
    /// The program itself.
    pub(crate) program: Arc<Text>,
    /// The files that it calls, by their names.
    pub(crate) parts: BTreeMap<String, Arc<Text>>,
}

impl Files {
    /// The file of this name; none: the program itself.
    pub(crate) fn get(&self, file: Option<&str>) -> Option<&Arc<Text>> {
        match file {
            None => Some(&self.program),
            Some(file) => self.parts.get(file),
        }
    }

    /// How much memory they take, bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.program.bytes() + self.parts.values().map(|part| part.bytes()).sum::<usize>()
    }

    /// The same as an edit of `before`, whose texts it has in common; where `origins` count, lines come from where they come from in `posted`.
    pub(crate) fn edited(mut self, before: &Files, posted: &Files, origins: bool) -> Files {
        let taken = |file: Option<&str>, text: &Arc<Text>| {
            let same = |other: &&Arc<Text>| other.lines.text() == text.lines.text();
            match (before.get(file).filter(same), posted.get(file)) {
                (Some(same), _) if origins => Arc::clone(same),
                (_, Some(posted)) if origins => text.from(posted),
                _ => Arc::clone(text),
            }
        };
        self.program = taken(None, &self.program);
        for (file, text) in &mut self.parts {
            *text = taken(Some(file), text);
        }
        self
    }
}

/// A program that is there already.
#[derive(Debug)]
pub struct Existing {
    /// Its text.
    pub(crate) text: Vec<u8>,
    /// Files that it calls, by their names: those of `folders` are looked for where it has none.
    pub(crate) called: BTreeMap<String, Vec<u8>>,
    /// Where the programs are that it calls: a robot has them in the folder of the program.
    pub(crate) folders: Vec<PathBuf>,
    /// The job of which it is an edit.
    pub(crate) of: Option<Arc<Job>>,
}

impl Existing {
    /// A program by itself, and the folders where those are that it calls.
    pub fn new(text: Vec<u8>, folders: Vec<PathBuf>) -> Existing {
        Existing { text, called: BTreeMap::new(), folders, of: None }
    }

    /// The program of a job, of which `files` were edited: each by its name, none for the program itself, and how many bytes it has of `text`, in
    /// which they stand one behind the other. No file of it is looked for anywhere else.
    ///
    /// # Errors
    /// The program has no such file, or the bytes are not those of the text.
    pub fn edited(
        of: Arc<Job>,
        files: &[(Option<String>, u64)],
        text: &[u8],
    ) -> Result<Existing, Stop> {
        let refused = |message: String| Stop::from(Diagnostic::error(Rule::StudioAsk, message));
        let own = of.files();
        let mut texts: BTreeMap<Option<&str>, Vec<u8>> = BTreeMap::new();
        let mut rest = text;
        for (file, bytes) in files {
            let file = file.as_deref().filter(|file| *file != of.file());
            let before = own.get(file).ok_or_else(|| {
                refused(format!("the program has no file {:?}", file.unwrap_or_default()))
            })?;
            let split = usize::try_from(*bytes).ok().and_then(|bytes| rest.split_at_checked(bytes));
            let (text, behind) =
                split.ok_or_else(|| refused("the text is shorter than its files".to_owned()))?;
            rest = behind;
            if encoding::is_utf_16(text) {
                return Err(encoding::utf_16().file(file.unwrap_or(of.file())).into());
            }
            let text = match file {
                None => text,
                // As a file of a folder is read.
                Some(_) => encoding::without_mark(text),
            };
            if texts.insert(file, ended_as(before.lines.text(), text)).is_some() {
                return Err(refused("a file of the program has two texts".to_owned()));
            }
        }
        if !rest.is_empty() {
            return Err(refused("the text is longer than its files".to_owned()));
        }
        let mut take = |file| match texts.remove(&file) {
            Some(text) => text,
            None => own.get(file).map(|own| own.lines.text().to_vec()).unwrap_or_default(),
        };
        let text = take(None);
        let called = own.parts.keys().map(|file| (file.clone(), take(Some(file)))).collect();
        Ok(Existing { text, called, folders: Vec::new(), of: Some(Arc::clone(&of)) })
    }
}

/// A text whose lines end with CR LF where those of the text before do: the page has none of it.
fn ended_as(before: &[u8], text: &[u8]) -> Vec<u8> {
    let first = memchr::memchr(b'\n', before);
    let ends = first.is_some_and(|at| at > 0 && before[at - 1] == b'\r');
    if !ends || text.contains(&b'\r') {
        return text.to_vec();
    }
    let mut ended = Vec::with_capacity(text.len() + text.len() / 16);
    for line in text.split_inclusive(|byte| *byte == b'\n') {
        match line.strip_suffix(b"\n") {
            Some(line) => ended.extend([line, b"\r\n"].concat()),
            None => ended.extend(line),
        }
    }
    ended
}

/// For each line of a text the line of the text before, from 1, that it still is; none where it was edited.
fn unedited(before: &[u8], after: &[u8]) -> Vec<Option<u32>> {
    let (before, after) = (lines(before), lines(after));
    let mut kept = vec![None; after.len()];
    let (mut from, mut to, mut compared) = (0, 0, 0);
    let number = |line: usize| u32::try_from(line + 1).ok();
    while from < before.len() && to < after.len() {
        if before[from] == after[to] {
            kept[to] = number(from);
            (from, to) = (from + 1, to + 1);
            continue;
        }
        let alike = |left: usize, new: usize| {
            let (old, new) = (&before[from + left..], &after[to + new..]);
            let count = ALIKE.min(old.len()).min(new.len());
            // Up to both ends nothing is left to be alike.
            old[..count] == new[..count] && (count > 0 || old.len() == new.len())
        };
        let mut ways = (1..=AHEAD).flat_map(|both| {
            // First as many lines left out as are new: lines that were edited.
            let half = both / 2;
            let others = (0..=both).filter(move |left| *left != half);
            [half].into_iter().chain(others).map(move |left| (left, both - left))
        });
        let found = ways.find(|(left, new)| {
            compared += 1;
            from + left <= before.len() && to + new <= after.len() && alike(*left, *new)
        });
        if compared > MOST_COMPARED {
            break;
        }
        let (left, new) = found.unwrap_or((1, 1));
        (from, to) = (from + left, to + new);
    }
    kept
}

/// The lines of a text, without their ends.
fn lines(text: &[u8]) -> Vec<&[u8]> {
    let text = text.strip_suffix(b"\n").unwrap_or(text);
    text.split(|byte| *byte == b'\n').map(|line| line.strip_suffix(b"\r").unwrap_or(line)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(before: &str, after: &str) -> Vec<u32> {
        let lines = |text: &str| text.replace(' ', "\n").into_bytes();
        let kept = unedited(&lines(before), &lines(after));
        kept.into_iter().map(Option::unwrap_or_default).collect()
    }

    #[test]
    fn lines_that_were_not_edited_are_found_where_they_have_moved() {
        assert_eq!(kept("a b c", "a b c"), [1, 2, 3]);
        assert_eq!(kept("a b c d e", "a b x d e"), [1, 2, 0, 4, 5]);
        assert_eq!(kept("a b c d e", "a b x y c d e"), [1, 2, 0, 0, 3, 4, 5]);
        assert_eq!(kept("a b c d e f", "a e f"), [1, 5, 6]);
        assert_eq!(kept("a b c d e f g h", "x b c d e f y z h"), [0, 2, 3, 4, 5, 6, 0, 0, 8]);
        // A line that stands often is the one that was there.
        assert_eq!(kept("a z b z c z d z", "a z b z k z d z"), [1, 2, 3, 4, 0, 6, 7, 8]);
        assert_eq!(kept("a z b z c z d z", "a z b z z c z d z"), [1, 2, 3, 4, 0, 5, 6, 7, 8]);
        assert_eq!(kept("a b", "a b c"), [1, 2, 0]);
        assert_eq!(kept("a b c", "c"), [3]);
        assert_eq!(kept("a", ""), [0]);
    }

    #[test]
    fn the_lines_of_an_edit_end_as_those_that_were_there() {
        assert_eq!(ended_as(b"a\r\nb\r\n", b"a\nc"), b"a\r\nc");
        assert_eq!(ended_as(b"a\r\nb\r\n", b"a\n\nc\n"), b"a\r\n\r\nc\r\n");
        assert_eq!(ended_as(b"a\nb\n", b"a\nc\n"), b"a\nc\n");
        assert_eq!(ended_as(b"a\r\nb\r\n", b"a\nc\r\n"), b"a\nc\r\n");
        assert_eq!(ended_as(b"", b"a\n"), b"a\n");
    }

    #[test]
    fn texts_that_have_nothing_in_common_end_in_time() {
        let text = |sign: char| (0..200_000).map(|at| format!("{sign}{at}\n")).collect::<String>();
        let kept = unedited(text('a').as_bytes(), text('b').as_bytes());
        assert!(kept.iter().all(Option::is_none));
    }
}
