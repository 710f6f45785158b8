//! What a program has said of the smoothing of the path.

use crate::sinumerik::language::block::Block;
use crate::sinumerik::language::commands::{Code, Smoothing};
use program::PathMode;

/// What a program has said of the smoothing of the path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Smoothed {
    /// G group 10: between blocks.
    pub rounding: Smoothing,
    /// G group 30: of the blocks themselves.
    pub compressor: Smoothing,
    /// The tolerance of the path, mm, where the program says it (`CTOL`, `CYCLE832`).
    pub contour: Option<f64>,
    /// `ADIS` and `ADISPOS`, mm.
    pub distances: [f64; 2],
    /// Whether `OTOL` says by how much the control may turn the tool.
    pub is_turned: bool,
    /// Whether `CYCLE832` has left that to setting data, which has not been reported.
    pub turns_unsaid: bool,
    /// Whether it has been reported that the machine data say it.
    pub is_reported: bool,
}

impl Smoothed {
    /// Whether machine data say by how much the control leaves the path, which has not been reported.
    pub fn is_loose(&self) -> bool {
        let loose = |mode| match mode {
            Smoothing::Off | Smoothing::ExactStop => false,
            Smoothing::Programmed => self.contour.is_none(),
            Smoothing::MachineData => true,
        };
        !self.is_reported && (loose(self.rounding) || loose(self.compressor))
    }

    /// Whether a tolerance of the program holds (`CYCLE832`, `CTOL`, `OTOL`), or a distance (`ADIS`, `ADISPOS`).
    pub fn is_programmed(&self) -> bool {
        self.contour.is_some() || self.is_turned || self.distances.iter().any(|mm| *mm > 0.0)
    }

    /// `OTOL=`, degrees; below 0 it takes back what was programmed.
    pub fn turn(&mut self, degrees: f64) {
        self.is_turned = degrees >= 0.0;
        self.turns_unsaid &= !self.is_turned;
    }

    /// `CYCLE832` that smooths the path, or not, and says the tolerance of the orientation, or not.
    pub fn turn_by_cycle(&mut self, smooths: bool, says: bool) {
        self.turns_unsaid = smooths && !says;
    }

    /// Whether setting data say by how much the control may turn the tool, which has not been reported.
    pub fn turns_unsaid(&self) -> bool {
        self.turns_unsaid
    }

    /// That has been reported.
    pub fn note_unsaid_turn(&mut self) {
        self.turns_unsaid = false;
    }

    /// The program says a tolerance, mm, or takes it back.
    pub fn bound(&mut self, contour: Option<f64>) {
        *self = Smoothed { contour, is_reported: false, ..*self };
    }

    /// By how much the control may leave the path in cuts, where the program says it.
    pub fn path(&self) -> PathMode {
        let [distance, _] = self.distances;
        if self.rounding == Smoothing::ExactStop && self.compressor == Smoothing::Off {
            return PathMode::ExactStop;
        }
        match self.contour {
            Some(tolerance) => PathMode::Blend(tolerance.max(distance)),
            None if distance > 0.0 => PathMode::Blend(distance),
            None => PathMode::AsSetUp,
        }
    }

    /// The modes of a block.
    pub fn switch(&mut self, block: &Block) {
        let before = *self;
        if let Some(Code::Smoothing(rounding)) = block.code(10) {
            self.rounding = rounding;
        }
        if let Some(Code::Smoothing(compressor)) = block.code(30) {
            self.compressor = compressor;
        }
        self.is_reported &= *self == before;
    }

    /// The modes of `other`, with the tolerance as it is now.
    pub fn with_modes_of(self, other: Smoothed) -> Smoothed {
        Smoothed {
            rounding: other.rounding,
            compressor: other.compressor,
            is_reported: false,
            ..self
        }
    }
}
