//! What a vertex says of the move that it is drawn for, in one word.

use crate::walk::Walk;

/// A move in its chunk (12 bits), its kind (4), its tool (8) and its marks (8), the first of them the lowest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Packed(u32);

/// Where the kind begins.
const KIND: u32 = 12;

impl Packed {
    /// That of a move of a chunk that begins at `first`.
    pub fn of(walk: &Walk, first: u32, at: u32) -> Packed {
        let (tool, marks) = (u32::from(walk.tool(at)), u32::from(walk.marks(at)));
        Packed((at - first) | tool << 16 | marks << 24).with_kind(walk.kind(at))
    }

    /// The same of another kind.
    pub fn with_kind(self, kind: u8) -> Packed {
        Packed(self.0 & !(15 << KIND) | u32::from(kind) << KIND)
    }

    /// As it is sent.
    pub fn word(self) -> u32 {
        self.0
    }

    /// Which move of the chunk it is.
    #[cfg(test)]
    pub fn place(self) -> u32 {
        self.0 & ((1 << KIND) - 1)
    }

    pub fn kind(self) -> u8 {
        (self.0 >> KIND & 15) as u8
    }

    /// What moves must have in common to be drawn as one, or one for the other.
    pub fn look(self) -> u32 {
        self.0 >> KIND
    }

    pub fn marks(self) -> u8 {
        (self.0 >> 24) as u8
    }
}
