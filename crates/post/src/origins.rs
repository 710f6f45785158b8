//! Where each line of a program comes from: which template wrote it, for which record of the source.

use crate::catalogue::BlockName;
use machine::{Block, Machine};
use program::{Program, Record};

/// What stands for no record.
const NONE: u32 = u32::MAX;

/// Where each line of a text comes from: 5 bytes a line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origins {
    blocks: Vec<u8>,
    records: Vec<u32>,
}

/// Where a line comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The name of the block (template) that wrote it.
    pub block: &'static str,
    /// The record of the source for which it was written: its place in [`program::Program::records`]. None of what begins and
    /// ends a program by itself.
    pub record: Option<usize>,
}

impl Origin {
    /// The template, with its place in the machine's files.
    pub fn template<'m>(&self, machine: &'m Machine) -> Option<&'m Block> {
        machine.blocks.get(self.block)
    }
}

impl Origins {
    /// Of a line of the text, from 1.
    pub fn of(&self, line: u32) -> Option<Origin> {
        let index = line.checked_sub(1)? as usize;
        let (block, record) = (*self.blocks.get(index)?, *self.records.get(index)?);
        let record = (record != NONE).then_some(record as usize);
        Some(Origin { block: BlockName::ALL.get(usize::from(block))?.name(), record })
    }

    /// How many lines there are.
    pub fn lines(&self) -> usize {
        self.blocks.len()
    }

    /// The same, of records that have other places in another program; `None` where they have none there.
    #[must_use]
    pub fn moved(mut self, place: impl Fn(usize) -> Option<usize>) -> Origins {
        for record in self.records.iter_mut().filter(|record| **record != NONE) {
            *record = number(place(*record as usize));
        }
        self
    }

    /// Those of a text whose lines are lines of this one, from 1, or, where they are none, come from no template.
    #[must_use]
    pub fn carried(&self, lines: impl IntoIterator<Item = Option<u32>>) -> Origins {
        let mut carried = Origins::default();
        for line in lines {
            let at = line.and_then(|line| line.checked_sub(1)).map(|line| line as usize);
            let own = at.and_then(|at| Some((*self.blocks.get(at)?, *self.records.get(at)?)));
            let (block, record) = own.unwrap_or((u8::MAX, NONE));
            carried.blocks.push(block);
            carried.records.push(record);
        }
        carried
    }

    #[inline]
    pub(crate) fn push(&mut self, block: BlockName, record: u32) {
        self.blocks.push(block as u8);
        self.records.push(record);
    }

    /// Takes the last lines away.
    pub(crate) fn split_off(&mut self, from: usize) -> Origins {
        Origins { blocks: self.blocks.split_off(from), records: self.records.split_off(from) }
    }

    /// Puts lines at a place.
    pub(crate) fn insert(&mut self, at: usize, lines: Origins) {
        self.blocks.splice(at..at, lines.blocks);
        self.records.splice(at..at, lines.records);
    }
}

/// So far ahead a record is looked for on whose line another one stands.
const AHEAD: usize = 1000;

/// For each record of `made`, which goes along `source` in the same order, its place there: the record itself, or the first on its line.
pub fn places(source: &Program, made: &Program) -> Vec<usize> {
    let mut at = 0;
    let mut places = Vec::with_capacity(made.records.len());
    for record in &made.records {
        let ahead = source.records.get(at..).unwrap_or_default();
        let same = |other: &&Record| other.line == record.line;
        if let Some(first) = ahead.iter().take(AHEAD).position(|other| same(&other)) {
            at += first;
            let mut on_line = ahead[first..].iter().take_while(same);
            at += on_line.position(|other| other == record).unwrap_or(0);
        }
        places.push(at);
    }
    places
}

/// A record as it is kept.
#[inline]
pub(crate) fn number(record: Option<usize>) -> u32 {
    record.and_then(|record| u32::try_from(record).ok()).unwrap_or(NONE)
}

// The last number is that of no block.
const _: () = assert!(BlockName::COUNT < 1 << u8::BITS);
