//! Settings of a user, checked against their ranges.

use crate::report::{Outcome, fault};
use crate::{Cutter, Tool};
use program::Rule;

/// The longest length that is taken, mm.
const LONGEST: f64 = 1000.0;

/// More levels than this nobody cuts.
const MOST_LEVELS: f64 = 1000.0;

/// Refuses what is no length above 0.
///
/// # Errors
/// `length`
pub(crate) fn length(what: &str, mm: f64) -> Outcome {
    if mm > 0.0 && mm <= LONGEST {
        return Ok(());
    }
    let help = format!("give a length above 0 and up to {LONGEST} mm");
    Err(fault(Rule::Length, format!("{what} is {mm} mm"), &help))
}

/// Refuses what is no step down to `depth` mm, or takes too many steps.
///
/// # Errors
/// `length`, `step`
pub fn step(what: &str, mm: f64, depth: f64) -> Outcome {
    length(what, mm)?;
    if depth <= mm * MOST_LEVELS {
        return Ok(());
    }
    let message = format!("{what} is {mm} mm: more than {MOST_LEVELS} levels down to {depth} mm");
    Err(fault(Rule::Step, message, &format!("give a step of at least {} mm", depth / MOST_LEVELS)))
}

/// The diameter of a tool that cuts upright walls, mm.
///
/// # Errors
/// `length`, and `cutter` where it is a V-bit.
pub(crate) fn diameter(tool: &Tool) -> Outcome<f64> {
    match tool.cutter {
        Cutter::Cylinder { diameter } => {
            length(&format!("the diameter of `{}`", tool.name), diameter)?;
            Ok(diameter)
        }
        Cutter::Vee { .. } => {
            let message = format!("`{}` is a V-bit, which cuts no upright wall", tool.name);
            Err(fault(Rule::Cutter, message, "take an end mill"))
        }
    }
}

/// A number of mm as it is printed: to a tenth of a micrometre, without trailing zeros.
pub(crate) fn shown(mm: f64) -> f64 {
    (mm * 1e4).round() / 1e4
}
