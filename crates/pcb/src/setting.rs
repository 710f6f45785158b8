//! What a user sets, held against what makes sense.

use crate::report::{Outcome, fault};
use crate::{Cutter, Tool};

/// The longest length that is taken, mm.
const LONGEST: f64 = 1000.0;

/// Refuses what is no length above 0.
///
/// # Errors
/// `length`
pub(crate) fn length(what: &str, mm: f64) -> Outcome {
    if mm > 0.0 && mm <= LONGEST {
        return Ok(());
    }
    let help = format!("give a length above 0 and up to {LONGEST} mm");
    Err(fault("length", format!("{what} is {mm} mm"), &help))
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
            Err(fault("cutter", message, "take an end mill"))
        }
    }
}

/// A number of mm as it is told: to a tenth of a micrometre, without idle zeros.
pub(crate) fn shown(mm: f64) -> f64 {
    (mm * 1e4).round() / 1e4
}
