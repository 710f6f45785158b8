//! Where a program goes: the places of its blocks, its labels, its control structures, and calls.
//!
//! What jumps, loops and calls mean is the language's; [`Budget`](super::budget::Budget) ends those that never do.

use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Index;

/// Where a block begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockLocation {
    /// Byte of the text.
    pub at: usize,
    /// Line of the file, from 1.
    pub line: u32,
}

/// The line at a place of a text, ended by LF or CR LF, and where the next one begins; `None` behind the last.
pub fn line(text: &[u8], place: BlockLocation) -> Option<(&[u8], BlockLocation)> {
    let rest = text.get(place.at..).filter(|rest| !rest.is_empty())?;
    let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
    let at = (place.at + length + 1).min(text.len());
    let line = rest.get(..length).unwrap_or(rest);
    let next = BlockLocation { at, line: place.line.saturating_add(1) };
    Some((line.strip_suffix(b"\r").unwrap_or(line), next))
}

/// The lines of a text: where each begins, where the next one does, and what it says.
pub fn lines(text: &[u8]) -> impl Iterator<Item = (BlockLocation, BlockLocation, &[u8])> {
    let mut place = BlockLocation { at: 0, line: 1 };
    std::iter::from_fn(move || {
        let (line, next) = line(text, place)?;
        Some((std::mem::replace(&mut place, next), next, line))
    })
}

/// The places to which jumps and calls go, by their names or numbers.
#[derive(Debug)]
pub struct Labels<K> {
    places: HashMap<K, Vec<BlockLocation>>,
}

impl<K> Default for Labels<K> {
    fn default() -> Labels<K> {
        Labels { places: HashMap::new() }
    }
}

impl<K: Eq + Hash> Labels<K> {
    /// Adds a place behind those that have been added; whether it is the first of that label.
    pub fn add(&mut self, label: K, place: BlockLocation) -> bool {
        let places = self.places.entry(label).or_default();
        places.push(place);
        places.len() == 1
    }

    /// The first place of that label.
    pub fn first(&self, label: &K) -> Option<BlockLocation> {
        self.places.get(label)?.first().copied()
    }

    /// The first place of that label at byte `at` or behind it.
    pub fn behind(&self, label: &K, at: usize) -> Option<BlockLocation> {
        let places = self.places.get(label)?;
        places.get(places.partition_point(|place| place.at < at)).copied()
    }

    /// The last place of that label before byte `at`.
    pub fn before(&self, label: &K, at: usize) -> Option<BlockLocation> {
        let places = self.places.get(label)?;
        places.partition_point(|place| place.at < at).checked_sub(1).map(|index| places[index])
    }
}

/// A block that is part of a control structure, as `IF`, `ELSE`, `ENDIF`.
#[derive(Debug)]
pub struct Mark<W> {
    /// What it says.
    pub word: W,
    /// Where it stands.
    pub place: BlockLocation,
    /// The block behind it.
    pub after: BlockLocation,
    /// The next block of the same structure; of its last one, the first.
    pub partner: usize,
    /// The first block of the structure, and there the last one.
    first: usize,
    last: usize,
    /// The structure in which the blocks behind it stand, by its last mark before them.
    inside: Option<usize>,
}

/// The control structures of a text. Their blocks are added in the order of the text; which word may follow which is for the
/// language to say.
#[derive(Debug)]
pub struct Structures<W> {
    marks: Vec<Mark<W>>,
    /// The last mark of each structure that has no end yet, the inmost last.
    open: Vec<usize>,
}

impl<W> Default for Structures<W> {
    fn default() -> Structures<W> {
        Structures { marks: Vec::new(), open: Vec::new() }
    }
}

impl<W> Index<usize> for Structures<W> {
    type Output = Mark<W>;

    fn index(&self, index: usize) -> &Mark<W> {
        &self.marks[index]
    }
}

impl<W> Structures<W> {
    fn add(&mut self, word: W, [place, after]: [BlockLocation; 2]) -> usize {
        let (index, inside) = (self.marks.len(), self.open.last().copied());
        let (partner, first, last) = (index, index, index);
        self.marks.push(Mark { word, place, after, partner, first, last, inside });
        index
    }

    /// Adds a block that is no part of a structure but is found like one, with its `partner`, if it has one; answers its
    /// index. `place` is where it stands and where the next block does.
    pub fn single(&mut self, word: W, place: [BlockLocation; 2], partner: Option<usize>) -> usize {
        let index = self.add(word, place);
        self.marks[index].partner = partner.unwrap_or(index);
        index
    }

    /// Adds the block with which a structure begins.
    pub fn open(&mut self, word: W, place: [BlockLocation; 2]) -> usize {
        let index = self.add(word, place);
        self.marks[index].inside = Some(index);
        self.open.push(index);
        index
    }

    /// Adds the next clause of the inmost structure that has no end, as `ELSE`; `None` where there is none.
    pub fn clause(&mut self, word: W, place: [BlockLocation; 2]) -> Option<usize> {
        let before = self.open.pop()?;
        let index = self.open(word, place);
        self.marks[index].first = self.marks[before].first;
        self.marks[before].partner = index;
        Some(index)
    }

    /// Adds the end of the inmost structure that has none; `None` where there is none.
    pub fn close(&mut self, word: W, place: [BlockLocation; 2]) -> Option<usize> {
        let before = self.open.pop()?;
        let index = self.add(word, place);
        let first = self.marks[before].first;
        self.marks[before].partner = index;
        self.marks[first].last = index;
        (self.marks[index].first, self.marks[index].partner) = (first, first);
        Some(index)
    }

    /// The structures that have no end yet, the inmost last: the first mark of each, and its last one so far.
    pub fn unclosed(&self) -> impl DoubleEndedIterator<Item = [usize; 2]> + ExactSizeIterator {
        self.open.iter().map(|last| [self.marks[*last].first, *last])
    }

    /// The mark of the block that begins at byte `at`.
    pub fn find(&self, at: usize) -> Option<usize> {
        self.marks.binary_search_by_key(&at, |mark| mark.place.at).ok()
    }

    /// The mark that belongs to the one at byte `at`: the next clause or the end behind a beginning, the beginning behind the
    /// end.
    pub fn partner(&self, at: usize) -> Option<&Mark<W>> {
        self.marks.get(self.marks[self.find(at)?].partner)
    }

    /// The end of the structure of the mark `index`.
    pub fn end(&self, index: usize) -> usize {
        self.marks[self.marks[index].first].last
    }

    /// The structures in which the block at byte `at` stands, from the inmost to the outmost: the last mark of each before it.
    fn around(&self, at: usize) -> impl Iterator<Item = usize> {
        let inside = |mark: Option<usize>| self.marks.get(mark?)?.inside;
        let before = self.marks.partition_point(|mark| mark.place.at < at).checked_sub(1);
        std::iter::successors(inside(before), move |index| {
            inside(self.marks[*index].first.checked_sub(1))
        })
    }

    /// Whether a jump from the block at byte `from` to the one at byte `to` enters no control structure, nor another clause
    /// of one.
    pub fn may_jump(&self, from: usize, to: usize) -> bool {
        self.around(to).next().is_none_or(|inmost| self.around(from).any(|index| index == inmost))
    }
}

/// What is under way and comes back to: callers, the inmost last. Calls nest no deeper than the control lets them.
#[derive(Debug)]
pub struct Calls<T> {
    callers: Vec<T>,
    most: usize,
}

impl<T> Calls<T> {
    /// Without a call; `most` may nest.
    pub fn new(most: usize) -> Calls<T> {
        Calls { callers: Vec::new(), most }
    }

    /// A call; `caller` is what goes on behind it.
    ///
    /// # Errors
    /// Calls nest too deep: how many may.
    pub fn enter(&mut self, caller: T) -> Result<(), usize> {
        if self.callers.len() >= self.most {
            return Err(self.most);
        }
        self.callers.push(caller);
        Ok(())
    }

    /// What has been called is at its end: what goes on; `None` where nothing has been called.
    pub fn leave(&mut self) -> Option<T> {
        self.callers.pop()
    }

    /// The last caller.
    pub fn last(&self) -> Option<&T> {
        self.callers.last()
    }
}
