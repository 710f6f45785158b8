//! The words of a positioning block, read and checked before anything moves.

use super::feed::{FeedWord, Readable, feed_word, unknown};
use super::functions::{Function, Functions};
use super::scan::{Scanner, Word};
use crate::kernel::Outcome;
use program::{Compensation, Rule};

/// Where a word's value is kept. The first six are the axes in the order of their coordinates.
pub(crate) mod slot {
    /// X, the first of the linear axes.
    pub(crate) const X: usize = 0;
    /// Y.
    pub(crate) const Y: usize = 1;
    /// Z.
    pub(crate) const Z: usize = 2;
    /// A, the first of the rotary axes.
    pub(crate) const A: usize = 3;
    /// Polar radius.
    pub(crate) const PR: usize = 6;
    /// Polar angle.
    pub(crate) const PA: usize = 7;
    /// Radius of `CR`.
    pub(crate) const R: usize = 8;
    /// First of the surface normal NX NY NZ.
    pub(crate) const NX: usize = 9;
    /// First of the tool vector TX TY TZ.
    pub(crate) const TX: usize = 12;
    /// Length of a straight approach or departure.
    pub(crate) const LEN: usize = 15;
    /// Angle of an approach or a departure on an arc.
    pub(crate) const CCA: usize = 16;
    /// How many there are.
    pub(crate) const COUNT: usize = 17;
}

/// X, Y and Z.
pub(crate) const LINEAR: u32 = 0b111;
/// A, B and C.
pub(crate) const ROTARY: u32 = 0b111 << slot::A;
/// NX NY NZ and TX TY TZ.
pub(crate) const VECTORS: u32 = 0b11_1111 << slot::NX;
/// Polar radius.
pub(crate) const PR: u32 = 1 << slot::PR;
/// Polar angle.
pub(crate) const PA: u32 = 1 << slot::PA;
/// Radius of `CR`.
pub(crate) const RADIUS: u32 = 1 << slot::R;
/// Sense of rotation `DR+`, `DR-`.
pub(crate) const TURN: u32 = 1 << slot::COUNT;
/// Length of a straight approach or departure.
pub(crate) const LEN: u32 = 1 << slot::LEN;
/// Angle of an approach or a departure on an arc.
pub(crate) const CCA: u32 = 1 << slot::CCA;

/// The words of one block. Lengths are mm.
#[derive(Default)]
pub(crate) struct Words {
    value: [f64; slot::COUNT],
    given: u32,
    incremental: u32,
    /// Sense of rotation: 1 counter-clockwise, −1 clockwise; 0 where the block does not say.
    pub(crate) turn: f64,
    /// F, FU or FMAX.
    pub(crate) feed: Option<FeedWord>,
    /// R0, RL or RR.
    pub(crate) compensation: Option<Compensation>,
    /// M functions.
    pub(crate) functions: Functions,
}

impl Words {
    /// Reads words to the end of the block. Those of `allowed` may stand there, besides feed, radius
    /// compensation and M functions.
    pub(crate) fn read(s: &mut Scanner, allowed: u32, control: &dyn Readable) -> Outcome<Words> {
        let mut words = Words::default();
        while let Some(word) = s.word(control.registers())? {
            words.add(s, &word, allowed, control)?;
        }
        Ok(words)
    }

    /// The value of a slot, where the block gives one.
    pub(crate) fn get(&self, slot: usize) -> Option<f64> {
        self.has(1 << slot).then(|| self.value[slot])
    }

    /// Puts an absolute value in the place of a word that the block gave in another way.
    pub(crate) fn set(&mut self, slot: usize, value: f64) {
        self.value[slot] = value;
        self.given |= 1 << slot;
    }

    /// Whether any of a set of words stands in the block.
    pub(crate) fn has(&self, set: u32) -> bool {
        self.given & set != 0
    }

    /// Whether all of a set of words stand in the block.
    pub(crate) fn has_all(&self, set: u32) -> bool {
        self.given & set == set
    }

    /// Whether any of a set of words is incremental.
    pub(crate) fn is_incremental(&self, set: u32) -> bool {
        self.incremental & set != 0
    }

    /// Whether the motion is at rapid.
    pub(crate) fn is_rapid(&self) -> bool {
        self.feed == Some(FeedWord::Max)
    }

    /// Whether coordinates stand there alone.
    pub(crate) fn is_plain(&self) -> bool {
        self.feed.is_none() && self.compensation.is_none() && self.functions.is_empty()
    }

    /// Where a coordinate goes that is at `here` now.
    pub(crate) fn target(&self, slot: usize, here: f64) -> f64 {
        match self.get(slot) {
            Some(step) if self.is_incremental(1 << slot) => here + step,
            Some(value) => value,
            None => here,
        }
    }

    fn add(
        &mut self,
        s: &mut Scanner,
        word: &Word,
        allowed: u32,
        control: &dyn Readable,
    ) -> Outcome {
        let unit = control.unit();
        let (incremental, address) = match word.address {
            [b'I', rest @ ..] if !rest.is_empty() => (true, rest),
            address => (false, address),
        };
        let found = match address {
            [axis @ b'X'..=b'Z'] => (slot::X + usize::from(axis - b'X'), unit),
            [axis @ b'A'..=b'C'] => (slot::A + usize::from(axis - b'A'), 1.0),
            b"PR" => (slot::PR, unit),
            b"PA" => (slot::PA, 1.0),
            _ if incremental => return Err(unknown(s, word)),
            [b'F', ..] => {
                let feed = feed_word(s, word, control.tool_feed())?;
                return once(s, word, &mut self.feed, feed);
            }
            b"M" => return self.add_function(s, word, control),
            b"R" if allowed & RADIUS != 0 && (word.sign != 0.0 || word.number != Some(0.0)) => {
                (slot::R, unit)
            }
            b"LEN" => (slot::LEN, unit),
            b"CCA" => (slot::CCA, 1.0),
            b"R" if word.sign == 0.0 && word.number == Some(0.0) => {
                return once(s, word, &mut self.compensation, Compensation::Off);
            }
            b"RL" if word.number.is_none() => {
                return once(s, word, &mut self.compensation, Compensation::Left(None));
            }
            b"RR" if word.number.is_none() => {
                return once(s, word, &mut self.compensation, Compensation::Right(None));
            }
            b"DR" if allowed & TURN != 0 && word.sign != 0.0 && word.number.is_none() => {
                if self.turn != 0.0 {
                    return Err(twice(s, word));
                }
                self.turn = word.sign;
                return Ok(());
            }
            [b'N', axis @ b'X'..=b'Z'] => (slot::NX + usize::from(axis - b'X'), 1.0),
            [b'T', axis @ b'X'..=b'Z'] => (slot::TX + usize::from(axis - b'X'), 1.0),
            _ => return Err(unknown(s, word)),
        };
        let (slot, scale) = found;
        let Some(number) = word.number.filter(|_| allowed & (1 << slot) != 0) else {
            return Err(unknown(s, word));
        };
        if self.has(1 << slot) {
            return Err(twice(s, word));
        }
        self.value[slot] = number * scale;
        self.given |= 1 << slot;
        self.incremental |= u32::from(incremental) << slot;
        Ok(())
    }

    fn add_function(&mut self, s: &mut Scanner, word: &Word, control: &dyn Readable) -> Outcome {
        let function = Function::read(s, word, control)?;
        self.functions
            .push(function)
            .map_err(|message| s.error(Rule::MFunction, word.span, message))
    }
}

fn once<T>(s: &Scanner, word: &Word, place: &mut Option<T>, value: T) -> Outcome {
    match place.replace(value) {
        None => Ok(()),
        Some(_) => Err(twice(s, word)),
    }
}

fn twice(s: &Scanner, word: &Word) -> Box<program::Diagnostic> {
    let address = String::from_utf8_lossy(word.address);
    s.error(Rule::RepeatedWord, word.span, format!("{address} stands twice in the block"))
}
