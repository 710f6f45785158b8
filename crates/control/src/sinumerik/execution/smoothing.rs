//! By how much the control may leave the path: `CTOL=`, `ADIS=`, `ADISPOS=`, and the modes that smooth it (`G642` to `G645`,
//! the compressors).

use super::interpreter::Interpreter;
use crate::event::{Action, Risk};
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use crate::sinumerik::language::block::{Block, TOLERANCES};
use crate::sinumerik::language::commands::{Code, Smoothing};
use program::Rule;

/// What a program has said of the smoothing of the path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Smoothed {
    /// G group 10: between blocks.
    rounding: Smoothing,
    /// G group 30: of the blocks themselves.
    compressor: Smoothing,
    /// Whether the program says the tolerance (`CTOL`, `CYCLE832`).
    is_bounded: bool,
    /// Whether `ADIS` and `ADISPOS` are above 0.
    is_rounded: [bool; 2],
    /// Whether `OTOL` says by how much the control may turn the tool.
    is_turned: bool,
    /// Whether it has been reported that the machine data say it.
    is_reported: bool,
}

impl Smoothed {
    /// Whether machine data say by how much the control leaves the path, which has not been reported.
    pub fn is_loose(&self) -> bool {
        let loose = |mode| match mode {
            Smoothing::Off => false,
            Smoothing::Programmed => !self.is_bounded,
            Smoothing::MachineData => true,
        };
        !self.is_reported && (loose(self.rounding) || loose(self.compressor))
    }

    /// Whether a tolerance of the program holds (`CYCLE832`, `CTOL`, `OTOL`), or a distance (`ADIS`, `ADISPOS`).
    pub fn is_programmed(&self) -> bool {
        self.is_bounded || self.is_turned || self.is_rounded.contains(&true)
    }

    /// `OTOL=`, degrees; below 0 it takes back what was programmed.
    pub fn turn(&mut self, degrees: f64) {
        self.is_turned = degrees >= 0.0;
    }

    /// The program says a tolerance, or takes it back.
    fn bound(&mut self, is_bounded: bool) {
        *self = Smoothed { is_bounded, is_reported: false, ..*self };
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

impl Interpreter<'_, '_> {
    /// Reports where the path of the block is smoothed and the program does not say by how much. Machine data do (MD33100,
    /// MD33120): they are not known, and so not 0.
    #[cold]
    pub fn hold_smoothing(&mut self, source: &Source, block: &Block) -> Outcome {
        if !(block.has_position() || block.has_arc_word()) {
            return Ok(());
        }
        self.state.smoothed.is_reported = true;
        self.emit(source, Action::Risk(Risk::SMOOTHING.into()))
    }

    /// `CTOL=`, `ADIS=`, `ADISPOS=`: the tolerances of a block, mm. `CTOL` below 0 takes back what was programmed (B1,
    /// "Contour/Orientation tolerance").
    pub fn tolerances(&mut self, source: &Source, named: [Option<f64>; 3]) -> Outcome {
        for (name, value) in TOLERANCES.into_iter().zip(named) {
            let Some(value) = value.map(|value| value * self.state.unit) else { continue };
            let takes_back = value < 0.0 && name == TOLERANCES[CONTOUR];
            if value < 0.0 && !takes_back {
                return Err(source.block_error(Rule::Number, format!("{name}= has no sign")));
            }
            let smoothed = &mut self.state.smoothed;
            match name {
                _ if name == TOLERANCES[CONTOUR] => smoothed.bound(!takes_back),
                _ if name == TOLERANCES[CONTOUR + 1] => smoothed.is_rounded[0] = value > 0.0,
                _ => smoothed.is_rounded[1] = value > 0.0,
            }
            self.path_tolerance(source, name, value)?;
        }
        Ok(())
    }

    /// `CYCLE832` with that tolerance, mm: it switches the smoothing on and says by how much, or, with 0, off.
    pub fn cycle_tolerance(&mut self, source: &Source, name: &str, mm: f64) -> Outcome {
        if mm < 0.0 {
            let message = format!("{name}: the tolerance has no sign");
            let error = source.block_error(Rule::CycleParameter, message);
            return Err(error.help("write a tolerance above 0, or CYCLE832(0,_OFF,1)").into());
        }
        self.path_tolerance(source, name, mm)?;
        self.state.smoothed.bound(mm > 0.0);
        Ok(())
    }

    /// How far the control may leave the path, mm: what it then does is not seen here.
    fn path_tolerance(&self, source: &Source, name: &str, tolerance: f64) -> Outcome {
        let most = self.settings.path_tolerance;
        if tolerance <= most {
            return Ok(());
        }
        let message = format!(
            "{name} lets the control leave the path by {tolerance} mm, the machine file allows {most} \
             mm"
        );
        let mut error = source.block_error(Rule::PathTolerance, message);
        error.help = "path_tolerance in [options] of the machine file says how far".into();
        Err(error)
    }
}

/// Index of `CTOL` among [`TOLERANCES`].
const CONTOUR: usize = 0;
