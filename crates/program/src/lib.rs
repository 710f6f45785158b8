//! The neutral program: what every reader ends in and every writer starts from.
//!
//! A [`Program`] is a flat list of [`Record`]s in the order in which they happen, each with the line
//! of the source it came from. Its vocabulary is that of cutter-location data (ISO 4343): rapid,
//! line, arc, hole, tool, spindle, feed, coolant, compensation, frame, comment.
//!
//! Lengths are mm, feeds mm/min, times s, spindle speeds 1/min. A [`Pose`] is a tool tip and a tool axis in the
//! frame of the part (the work frame): every number of it is finite, and the axis is a unit vector. What a virtual
//! control reports, with coordinates that nobody knows and positions of rotary axes, is no program: `control` has
//! its own records, and `nc` makes a program of them.
//!
//! ```
//! use toolpost_program::{Builder, Feed, Op, Pose, Tool};
//!
//! let mut builder = Builder::new("slot");
//! builder.tool(Tool { number: 1, ..Tool::default() })?;
//! builder.rapid([0.0, 0.0, 5.0], None)?;
//! builder.feed(Feed::PerMinute(300.0))?;
//! builder.line([0.0, 0.0, -1.0], None)?;
//! let program = builder.build();
//! let cuts = program.records.iter().filter(|record| matches!(record.op, Op::Line(_)));
//! assert_eq!(cuts.count(), 1);
//! // What is no number is no pose.
//! assert!(Pose::upright([f64::NAN, 0.0, 0.0].into()).is_err());
//! # Ok::<(), Box<toolpost_program::Diagnostic>>(())
//! ```
//!
//! A program never holds the words of a control, and nothing here reads or writes files.

#![deny(clippy::wildcard_enum_match_arm)]

mod builder;
mod compensated;
mod counted;
mod cut_box;
mod cycle;
pub mod diagnostic;
mod digest;
pub mod encoding;
pub mod heights;
pub mod lowering;
mod magazine;
mod misread;
mod motion;
mod pose;
mod progress;
mod purpose;
mod record;
mod rule;
pub mod statistics;
mod surface;
mod technology;
mod tops;

pub use builder::Builder;
pub use compensated::{CompensatedPath, PathEvidence};
pub use counted::Findings;
pub use cut_box::CutBox;
pub use cycle::*;
pub use diagnostic::{
    Diagnostic, LEAST_SETTING, MOST_PLACES, MOST_SETTING, Outcome, Severity, line_of, nearest,
    needs, not_both, within,
};
pub use digest::Digest;
pub use misread::Misread;
pub use motion::*;
pub use pose::{FullPose, NoPose, Pose};
pub use progress::{Progress, Pulse, cancelled};
pub use purpose::Purpose;
pub use record::*;
pub use rule::Rule;
pub use surface::Surface;
pub use technology::*;
pub use tops::{LYING, Tops};
