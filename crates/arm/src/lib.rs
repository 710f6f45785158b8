//! Six-axis arms with revolute joints: where the flange is for given joints, and which joints put it there.
//!
//! **Units and frames.** Lengths are mm, angles radians, times s. [`Joints`] are *model* joints: each measured against the
//! link before it, with the zero and the sign of the maker. What a controller shows may differ in joint 3
//! ([`Coupling`]); [`Arm::shown`] and [`Arm::model`] go between the two. A flange is a [`Frame`] in the **world of the
//! controller**, whose origin lies [`Arm::world_height`] above the foot of the arm.
//!
//! **Terms.** A [`Posture`] is one of the eight solutions in which an arm reaches a frame: rear or front, elbow below or above, wrist
//! flipped or not. A *turn* is a position of a joint that differs by 360 degrees and leaves the flange where it is.
//!
//! **Both solutions, written apart.** [`Arm::flange`] multiplies the links one after the other. [`Arm::inverse`] is a closed form
//! that solves the equations of the wrist centre. They share no code: a proof by the first of what the second has found is
//! worth something. Every function depends on its arguments alone.
//!
//! ```
//! use toolpost_arm::{Arm, Coupling, Joint, Posture, Spherical, Structure};
//! // KUKA KR 6 R900 sixx: its joints 0, -90, 90, 0, 45, 0 degrees.
//! let lengths = Spherical {
//!     a1: 25.0, a2: -35.0, b: 0.0, c1: 400.0, c2: 455.0, c3: 420.0, c4: 80.0,
//!     offsets: [0.0, -90.0, 0.0, 0.0, 0.0, 0.0].map(f64::to_radians),
//!     signs: [-1.0, 1.0, 1.0, -1.0, 1.0, -1.0],
//! };
//! let joint = Joint { min: -6.0, max: 6.0, speed: 5.0, acceleration: None };
//! let arm = Arm::new(Structure::Spherical(lengths), [joint; 6], Some(Coupling::None), 0.0).unwrap();
//! let joints = [0.0, -90.0, 90.0, 0.0, 45.0, 0.0].map(f64::to_radians);
//! let flange = arm.flange(&joints);
//! assert!((flange.translation.x - 501.5685).abs() < 1e-4);
//! let solutions = arm.inverse(&flange, 0.0);
//! assert_eq!(solutions.iter().count(), 8);
//! let same = solutions.get(Posture::of(false, false, false)).unwrap();
//! assert!(same.iter().zip(&joints).all(|(a, b)| (a - b).abs() < 1e-9));
//! ```
//!
//! What it never does: choose a posture by itself, or report a joint position beyond the limits as one of the arm's
//! ([`Arm::within`]). Collisions of the arm with itself or with the cell are not looked at.

mod arm;
mod forward;
mod inverse;
mod posture;

pub use arm::{
    Arm, Calibration, Coupling, CouplingLimit, Dh, Joint, Joints, Misfit, Spherical, Structure,
};
pub use forward::Axis;
pub use geom::{Frame, Mat3, Vec3};
pub use inverse::Solutions;
pub use posture::{Margins, Posture};
