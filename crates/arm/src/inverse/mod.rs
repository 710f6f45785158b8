//! From the flange to the joints, in closed form.

mod calibrated;
mod spherical;
mod ur;

use crate::arm::{Arm, Joints, Structure};
use crate::posture::Posture;
use geom::{Frame, Vec3};

/// Below this sine of joint 5 axes 4 and 6 are one, and joint 4 may stand anywhere.
const WRIST_FREE: f64 = 1e-9;

/// The joints that put the flange into a frame, one set for each posture that reaches it; each joint is in (-π, π].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solutions([Option<Joints>; 8]);

impl Solutions {
    pub(crate) const NONE: Solutions = Solutions([None; 8]);

    /// The joints in a posture, where it reaches the frame.
    pub fn get(&self, posture: Posture) -> Option<&Joints> {
        self.0[posture.index()].as_ref()
    }

    /// The postures that reach the frame, each with its joints.
    pub fn iter(&self) -> impl Iterator<Item = (Posture, &Joints)> {
        let all = Posture::ALL.into_iter().zip(&self.0);
        all.filter_map(|(posture, joints)| Some((posture, joints.as_ref()?)))
    }

    fn set(&mut self, posture: Posture, joints: Joints) {
        self.0[posture.index()] = Some(joints);
    }
}

impl Arm {
    /// The joints that put the flange into a frame of the controller's world, whether they are within the limits or not.
    /// Where the wrist is stretched its first free joint (4; on Universal Robots 6) takes the position `free`, radians.
    pub fn inverse(&self, flange: &Frame, free: f64) -> Solutions {
        self.solutions(flange, free, None)
    }

    /// Those of [`Arm::inverse`] in one posture, where it reaches the frame.
    pub fn inverse_in(&self, posture: Posture, flange: &Frame, free: f64) -> Option<Joints> {
        self.solutions(flange, free, Some(posture)).get(posture).copied()
    }

    /// The solutions, of one posture or of all.
    fn solutions(&self, flange: &Frame, free: f64, of: Option<Posture>) -> Solutions {
        let foot = flange.translation + Vec3::new(0.0, 0.0, self.world_height);
        match &self.structure {
            Structure::Spherical(arm) => spherical::inverse(arm, &flange.matrix3, foot, (free, of)),
            Structure::Ur(dh, None) => ur::inverse(dh, &flange.matrix3, foot, (free, of)),
            Structure::Ur(dh, Some(_)) => {
                let near = ur::inverse(dh, &flange.matrix3, foot, (free, of));
                calibrated::refine(self, flange, &near)
            }
        }
    }
}

/// The root of a square that rounding has brought just below zero, in the scale of `size`; `None` farther below.
fn root(square: f64, size: f64) -> Option<f64> {
    (square > -1e-12 * size).then(|| square.max(0.0).sqrt())
}
