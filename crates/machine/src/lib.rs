//! Machines and controls as data.
//!
//! A control (a dialect) and a machine (axes, limits, kinematics) are TOML files. A machine extends a
//! control, a control may extend another; loading merges the chain into one [`Machine`], with every
//! mistake told by file, line and column. The kinematic chain, both ways, lives here and nowhere
//! else: writers use the inverse, the proof uses the forward, and neither shares more than that.
//!
//! Lengths are mm, feeds mm/min, angles of rotary axes degrees where they are axis positions
//! (`degrees` in the name) and radians elsewhere.

#![deny(clippy::wildcard_enum_match_arm)]

pub mod inverse;
pub mod kinematics;
pub mod library;
pub mod limits;
pub mod linearise;
mod load;
mod model;
pub mod plan;
mod sheet;
pub mod time;
pub mod upgrade;

pub use inverse::{Inverse, Solutions};
pub use kinematics::{Unsaid, lean};
pub use load::{Reach, is_path, load, load_control, load_origin, load_text};
pub use model::*;
pub use sheet::{Key, keys};
