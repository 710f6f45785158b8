//! Registers of tools.

use crate::ToolData;

/// What the program can know of the tool registers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Registers {
    /// Lengths by register, mm; NaN where the program has changed one that is not known.
    lengths: Vec<(u32, f64)>,
    /// Registers whose radius the program has written.
    pub radii: Vec<u32>,
    /// The last D and the last H, where the dialect remembers them.
    pub d: Option<u32>,
    pub h: Option<u32>,
}

impl Registers {
    pub(crate) fn new(tools: &[ToolData]) -> Registers {
        let lengths = tools.iter().map(|tool| (tool.number, tool.length)).collect();
        Registers { lengths, ..Registers::default() }
    }

    /// The length in a register, NaN where it is not known.
    pub(crate) fn length(&self, register: u32) -> f64 {
        let found = self.lengths.iter().rev().find(|(number, _)| *number == register);
        found.map_or(f64::NAN, |(_, length)| *length)
    }

    pub(crate) fn write_length(&mut self, register: u32, length: f64) {
        self.lengths.retain(|(number, _)| *number != register);
        self.lengths.push((register, length));
    }
}
