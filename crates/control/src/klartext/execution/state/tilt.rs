//! The tilted plane of work.

use super::transforms::Transforms;
use geom::Mat3;

/// A tilted plane of work.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tilt {
    /// From the tilted coordinates to the work frame.
    pub turn: Mat3,
    /// Transformations within the plane.
    pub inside: Transforms,
    /// Whether the control has put the rotary axes there (`TURN`, `MOVE`).
    pub turned: bool,
}

/// The frame of spatial angles in degrees: about the fixed axes, first A, then B, then C (TNC 640
/// manual, PLANE SPATIAL).
pub(crate) fn spatial([a, b, c]: [f64; 3]) -> Mat3 {
    Mat3::from_rotation_z(c.to_radians())
        * Mat3::from_rotation_y(b.to_radians())
        * Mat3::from_rotation_x(a.to_radians())
}
