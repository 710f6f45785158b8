//! Sets of words.

use crate::catalogue::WordName;
use std::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, Not};

const PARTS: usize = WordName::COUNT.div_ceil(64);

/// A set of words, one bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Words([u64; PARTS]);

impl Words {
    pub(crate) const NONE: Words = Words([0; PARTS]);
    pub(crate) const ALL: Words = Words([u64::MAX; PARTS]);

    /// The set of these.
    pub(crate) const fn of(words: &[WordName]) -> Words {
        let mut all = Words::NONE;
        let mut i = 0;
        while i < words.len() {
            all.0[words[i] as usize / 64] |= 1 << (words[i] as usize % 64);
            i += 1;
        }
        all
    }

    #[inline]
    pub(crate) const fn has(&self, word: WordName) -> bool {
        self.0[word as usize / 64] >> (word as usize % 64) & 1 != 0
    }

    #[inline]
    pub(crate) fn add(&mut self, word: WordName) {
        self.0[word as usize / 64] |= 1 << (word as usize % 64);
    }

    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        *self == Words::NONE
    }

    /// Whether `is` says so of any of them, by the number of each.
    #[inline]
    pub(crate) fn any(&self, mut is: impl FnMut(usize) -> bool) -> bool {
        for (part, mut rest) in self.0.into_iter().enumerate() {
            while rest != 0 {
                if is(64 * part + rest.trailing_zeros() as usize) {
                    return true;
                }
                rest &= rest - 1;
            }
        }
        false
    }
}

/// The set of one word.
pub(crate) const fn bit(word: WordName) -> Words {
    Words::of(&[word])
}

impl FromIterator<WordName> for Words {
    fn from_iter<I: IntoIterator<Item = WordName>>(words: I) -> Words {
        let mut all = Words::NONE;
        words.into_iter().for_each(|word| all.add(word));
        all
    }
}

impl BitOr for Words {
    type Output = Words;
    #[inline]
    fn bitor(mut self, other: Words) -> Words {
        self |= other;
        self
    }
}

impl BitOrAssign for Words {
    #[inline]
    fn bitor_assign(&mut self, other: Words) {
        for (part, other) in self.0.iter_mut().zip(other.0) {
            *part |= other;
        }
    }
}

impl BitAnd for Words {
    type Output = Words;
    #[inline]
    fn bitand(mut self, other: Words) -> Words {
        self &= other;
        self
    }
}

impl BitAndAssign for Words {
    #[inline]
    fn bitand_assign(&mut self, other: Words) {
        for (part, other) in self.0.iter_mut().zip(other.0) {
            *part &= other;
        }
    }
}

impl Not for Words {
    type Output = Words;
    #[inline]
    fn not(self) -> Words {
        Words(self.0.map(|part| !part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_has_what_was_put_into_it_in_each_of_its_parts() {
        let last = WordName::ALL[WordName::COUNT - 1];
        let set: Words = [WordName::X, last].into_iter().collect();
        assert!(set.has(WordName::X) && set.has(last) && !set.has(WordName::Y));
        assert_eq!(set, Words::of(&[last, WordName::X]));
        assert_eq!(set & !bit(WordName::X), bit(last));
        assert!((set & bit(WordName::Y)).is_empty());
        let mut seen = Vec::new();
        assert!(!set.any(|word| {
            seen.push(word);
            false
        }));
        assert_eq!(seen, [WordName::X as usize, last as usize]);
    }
}
