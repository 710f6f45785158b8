//! Polar coordinates: `AP=` and `RP=` about the pole of `G110`, `G111`, `G112` (Programming Manual
//! 12/2019, 2.9.3).

use super::interpreter::Interpreter;
use super::interpreter::plain_values;
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use crate::sinumerik::language::block::{Block, Count};
use crate::sinumerik::language::commands::{Diameter, Origin};
use geom::Vec3;
use program::Rule;

/// The two axes of the plane, the first and the second, by the axis perpendicular to it.
pub(super) fn axes_of_plane(normal: usize) -> (usize, usize) {
    match normal {
        2 => (0, 1),
        1 => (2, 0),
        _ => (1, 2),
    }
}

impl Interpreter<'_, '_> {
    /// `G110`, `G111`, `G112` with X, Y, Z, in a block of its own. The polar angle is forgotten.
    pub fn pole(&mut self, source: &Source, block: &Block, origin: Origin) -> Outcome {
        let name = block.command(3);
        if !block.only_group(3) || block.feed.is_some() || block.speed.is_some() {
            let message = format!("{name} stands in a block of its own with X, Y, Z");
            return Err(source.block_error(Rule::Polar, message));
        }
        let values = plain_values(source, block)?;
        let from = match origin {
            Origin::Position => self.state.programmed,
            Origin::Zero => Vec3::ZERO,
            Origin::Pole => self.state.pole,
        };
        let by = Vec3::from_array(values.map(|value| value.unwrap_or(0.0) * self.state.unit));
        self.state.pole = from + by;
        self.state.polar.1 = None;
        Ok(())
    }

    /// The place in the plane that `AP=` and `RP=` say, put into `position`.
    #[cold]
    pub fn polar_target(&mut self, source: &Source, block: &Block, position: &mut Vec3) -> Outcome {
        let error = |message: &str| Err(source.block_error(Rule::Polar, message));
        let Some(rare) = &block.rare else { return Ok(()) };
        self.lean_on_plane(source)?;
        let (first, second) = axes_of_plane(self.state.plane_normal);
        if block.axes[first].is_some() || block.axes[second].is_some() {
            return error("polar coordinates and coordinates of the plane in one block");
        }
        if self.state.diameter != Diameter::Off {
            return error("polar coordinates while X is a diameter");
        }
        let (mut radius, mut angle) = self.state.polar;
        if let Some(coordinate) = rare.polar_radius {
            if coordinate.value < 0.0 || matches!(coordinate.count, Count::Incremental) {
                return error("the polar radius RP= is absolute and has no sign");
            }
            radius = Some(coordinate.value * self.state.unit);
        }
        if let Some(coordinate) = rare.polar_angle {
            angle = match (coordinate.count, angle) {
                (Count::Absolute, _) => Some(coordinate.value),
                (Count::Modal, _) if self.state.absolute => Some(coordinate.value),
                (Count::Modal, _) => {
                    return error("under G91 the polar angle is AP=AC() or AP=IC()");
                }
                (Count::Incremental, Some(before)) => Some(before + coordinate.value),
                (Count::Incremental, None) => {
                    return error("AP=IC(), and no polar angle before it");
                }
                _ => return error("the polar angle takes AC() or IC()"),
            };
        }
        let (Some(radius), Some(angle)) = (radius, angle) else {
            return error("polar coordinates need AP= and RP=, here or in a block before");
        };
        if self.state.pole[first].is_nan() || self.state.pole[second].is_nan() {
            return error("the pole is not known: give it in this plane (G110, G111, G112)");
        }
        let (sin, cos) = angle.to_radians().sin_cos();
        position[first] = self.state.pole[first] + radius * cos;
        position[second] = self.state.pole[second] + radius * sin;
        self.state.polar = (Some(radius), Some(angle));
        Ok(())
    }
}
