//! What is loaded for the objects that come next (section 4.9): polarity, and how apertures are transformed.

use crate::Transform;
use crate::decimal::decimal;
use crate::report::{Outcome, fault};
use program::Rule;

/// Polarity, mirroring, rotation and scaling.
pub(super) struct Loaded {
    pub(super) dark: bool,
    /// Left to right, and top to bottom.
    mirrored: (bool, bool),
    /// Degrees.
    rotation: f64,
    scale: f64,
}

impl Default for Loaded {
    fn default() -> Loaded {
        Loaded { dark: true, mirrored: (false, false), rotation: 0.0, scale: 1.0 }
    }
}

impl Loaded {
    /// Obeys `LP`, `LM`, `LR` or `LS`, of which `letter` is the second one.
    ///
    /// # Errors
    /// `load`
    pub(super) fn load(&mut self, letter: u8, value: &[u8]) -> Outcome {
        let odd = |what: &str, help: &str| Err(fault(Rule::Load, what, help));
        let value = value.trim_ascii();
        match (letter, value, decimal(value)) {
            (b'P', b"D", _) => self.dark = true,
            (b'P', b"C", _) => self.dark = false,
            (b'P', ..) => return odd("not a polarity", "say %LPD*% or %LPC*%"),
            (b'M', b"N", _) => self.mirrored = (false, false),
            (b'M', b"X", _) => self.mirrored = (true, false),
            (b'M', b"Y", _) => self.mirrored = (false, true),
            (b'M', b"XY", _) => self.mirrored = (true, true),
            (b'M', ..) => return odd("not a mirroring", "it is N, X, Y or XY: %LMX*%"),
            (b'R', _, Some(degrees)) => self.rotation = degrees,
            (b'R', ..) => return odd("not a rotation", "it is in degrees: %LR45.0*%"),
            (_, _, Some(scale)) if (1e-6..=1e6).contains(&scale) => self.scale = scale,
            _ => return odd("not a scale", "it is a number above 0: %LS0.8*%"),
        }
        Ok(())
    }

    /// How apertures are transformed: mirrored, then turned and scaled.
    pub(super) fn transform(&self) -> Transform {
        let (x, y) = self.mirrored;
        // Top to bottom is left to right, turned by half a turn.
        let turned = if y { self.rotation + 180.0 } else { self.rotation };
        Transform::new(x != y, turned, self.scale)
    }
}
