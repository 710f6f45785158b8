//! The wire of a wire-EDM machine.

use crate::Settings;
use crate::event::Orientation;
use geom::Vec3;

/// The wire as the control knows it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wire {
    /// Height at which U and V are counted, mm.
    pub upper_plane: Option<f64>,
    /// How far the wire is from X and Y there, mm.
    pub u: f64,
    pub v: f64,
    /// Where that points it: it is set up upright.
    pub axis: Vec3,
    /// By how much the control leans it, as [`crate::Action::Taper`] says it.
    pub taper: f64,
}

impl Wire {
    /// Upright.
    pub(crate) fn new(settings: &Settings) -> Wire {
        Wire { upper_plane: settings.wire.height, u: 0.0, v: 0.0, axis: Vec3::Z, taper: 0.0 }
    }

    /// Where it points.
    pub(crate) fn orientation(&self) -> Orientation {
        Orientation::Axis(self.axis)
    }
}
