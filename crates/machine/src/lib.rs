//! Machines and controls as data.
//!
//! The crate promises that what a machine file does not state is reported as missing and never taken as zero.
//!
//! A control (a dialect) and a machine (axes, limits, kinematics) are TOML files. A machine extends a
//! control, a control may extend another; loading merges the chain into one [`Machine`], with every
//! mistake reported by file, line and column. The kinematic chain, forward and inverse, is here and nowhere
//! else: the writer uses the inverse, the proof the forward chain, and the inverse only to list which rotary positions a control may take.
//!
//! Lengths are mm, feeds mm/min, angles of rotary axes degrees where they are axis positions
//! (`degrees` in the name) and radians elsewhere. The same files give the same machine, and kinematics the same bits.
//!
//! ```
//! let machine = toolpost_machine::load("sinumerik-840d-table-ac").unwrap();
//! // A table that tilts by A = -30° turns the work, so the tool axis leans by 30° as the work sees it.
//! let axis = machine.axis_at([-30.0, 0.0, 0.0]);
//! assert!((axis.z - 30f64.to_radians().cos()).abs() < 1e-12 && axis.x.abs() < 1e-12);
//! ```
//!
//! It never reads or writes NC text, and it never compares a program with its source.

#![deny(clippy::wildcard_enum_match_arm)]

pub mod axis_motion;
pub mod inverse;
pub mod kinematics;
pub mod library;
pub mod limits;
pub mod linearise;
pub mod linkage;
mod load;
mod model;
mod option;
pub mod plan;
mod sheet;
pub mod starter;
pub mod time;
pub mod upgrade;

pub use inverse::{Inverse, Solutions};
pub use kinematics::{Unsaid, lean};
pub use load::{Reach, is_path, load, load_control, load_origin, load_text};
pub use model::*;
pub use option::OptionKey;
pub use sheet::{Key, keys};
