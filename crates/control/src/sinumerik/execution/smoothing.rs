//! By how much the control may leave the path: `CYCLE832`, `CTOL=`, `ADIS=`, `ADISPOS=`, and the modes that smooth it (`G642` to
//! `G645`, the compressors).

use super::interpreter::Interpreter;
use crate::event::{Action, Risk};
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use crate::sinumerik::language::block::{Block, TOLERANCES};
use program::{PathMode, Rule};

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
        let before = self.state.smoothed.path();
        for (place, value) in named.into_iter().enumerate() {
            let Some(value) = value.map(|value| value * self.state.unit) else { continue };
            let name = TOLERANCES[place];
            let takes_back = value < 0.0 && place == CONTOUR;
            if value < 0.0 && !takes_back {
                return Err(source.block_error(Rule::Number, format!("{name}= has no sign")));
            }
            let smoothed = &mut self.state.smoothed;
            match place {
                CONTOUR => smoothed.bound((!takes_back).then_some(value)),
                _ => smoothed.distances[place - 1] = value,
            }
            if place == RAPIDS {
                self.rapid_distance(source, name, value)?;
            }
        }
        self.report_path(source, before)
    }

    /// `CYCLE832` with that tolerance, mm: it switches the smoothing on and says by how much, or, with 0, off.
    pub fn cycle_tolerance(&mut self, source: &Source, name: &str, mm: f64) -> Outcome {
        if mm < 0.0 {
            let message = format!("{name}: the tolerance has no sign");
            let error = source.block_error(Rule::CycleParameter, message);
            return Err(error.help("write a tolerance above 0, or CYCLE832(0,_OFF,1)").into());
        }
        let before = self.state.smoothed.path();
        self.state.smoothed.bound((mm > 0.0).then_some(mm));
        self.report_path(source, before)
    }

    pub(super) fn report_path(&mut self, source: &Source, before: PathMode) -> Outcome {
        match self.state.smoothed.path() {
            path if path == before => Ok(()),
            path => self.emit(source, Action::PathMode(path)),
        }
    }

    /// How far from its ends the control may leave a rapid, mm.
    fn rapid_distance(&self, source: &Source, name: &str, distance: f64) -> Outcome {
        let most = self.settings.path_tolerance;
        if distance <= most {
            return Ok(());
        }
        let message = format!(
            "{name} lets the control leave the path of rapids by {distance} mm, the machine file allows \
             {most} mm"
        );
        let mut error = source.block_error(Rule::PathTolerance, message);
        error.help = "path_tolerance in [options] of the machine file says how far".into();
        Err(error)
    }
}

/// Index of `CTOL` among [`TOLERANCES`].
const CONTOUR: usize = 0;

/// Index of `ADISPOS` among [`TOLERANCES`].
const RAPIDS: usize = 2;
