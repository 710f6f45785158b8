//! What is known of the settable work offsets.

use geom::Vec3;
use std::collections::HashMap;

/// `G500`: none, in the reset state that the maker delivers.
pub const WORK_OFFSET_AT_RESET: u32 = 500;

/// Values of the settable work offsets, mm; NaN where a component is not known.
pub(crate) struct WorkOffsets {
    /// What a component counts that the program has not written.
    unwritten: f64,
    written: HashMap<u32, Vec3>,
    /// Values at the first move in each.
    first: HashMap<u32, Vec3>,
}

impl WorkOffsets {
    /// All 0 where `known`; else only `G500` is, which is none.
    pub fn new(known: bool) -> WorkOffsets {
        WorkOffsets {
            unwritten: if known { 0.0 } else { f64::NAN },
            written: HashMap::new(),
            first: HashMap::new(),
        }
    }

    /// The value of an offset.
    pub fn get(&self, number: u32) -> Vec3 {
        let unwritten = if number == WORK_OFFSET_AT_RESET { 0.0 } else { self.unwritten };
        self.written.get(&number).copied().unwrap_or(Vec3::splat(unwritten))
    }

    /// Writes a component. It counts when the offset is activated the next time.
    pub fn set(&mut self, number: u32, axis: usize, value: f64) {
        let mut offset = self.get(number);
        offset[axis.min(2)] = value;
        self.written.insert(number, offset);
    }

    /// The program moves in an offset of that value.
    pub fn use_first(&mut self, number: u32, value: Vec3) {
        self.first.entry(number).or_insert(value);
    }

    /// The value of an offset when the program first moved in it, where it has.
    pub fn first(&self, number: u32) -> Option<Vec3> {
        self.first.get(&number).copied()
    }
}
