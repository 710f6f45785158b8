//! Which kinematics are on.

use crate::Settings;
use crate::iso::dialects::facts::Facts;

/// What X, Y and Z are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kinematics {
    /// The axes: the machine has nothing to switch.
    Single,
    /// Whatever the program before has left: neither the end of a program nor a reset switches.
    Unknown,
    /// The axes.
    Axes,
    /// The tip of the tool in the work frame.
    Tip,
}

impl Kinematics {
    /// At the start of a program.
    pub(crate) fn at_start(facts: &Facts, settings: &Settings) -> Kinematics {
        match settings.kinematics {
            Some(_) if facts.syntax.extended_m => Kinematics::Unknown,
            _ => Kinematics::Single,
        }
    }
}
