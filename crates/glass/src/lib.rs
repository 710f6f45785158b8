//! Engraving inside glass: a laser fires at a constant rate, and three axes bring its focus from point to point.
//!
//! The crate promises that no two points are closer than the spacing, that no finished point shadows one below it, and that each
//! pulse of a program lies within the spot of its point; a program that breaks one of these is refused.
//!
//! Lengths are mm and points whole µm, times s, angles radians, unless a name says otherwise. The block's frame has its origin in a lower
//! corner of the block; Z points up, against the beam. The same input gives the same result on any number of threads.
//!
//! A body ([`mesh`]), a [`picture`], a drawing of curves ([`curve`]) or a list of points is placed in a block and becomes a cloud ([`fill`], [`sample`], [`weld`]), whose minimum distance
//! [`cloud`] proves. [`order`] puts it in an order that shadows no point and takes few laser ticks ([`clock`], [`profile`]),
//! [`optics`] corrects for refraction, [`post`] writes the program. [`control`] reads it back, and [`proof`] compares its pulses
//! with the cloud: those two share nothing with the writer but the [`machine`]'s description. [`job`] does all of it.
//!
//! ```
//! use toolpost_glass::clock::Clock;
//! use toolpost_glass::profile::{Limits, Profile};
//!
//! // 7.5 m/s², 0.1 m/s, 100 Hz: 0.1875 mm is one tick.
//! let clock = Clock::new(100.0, Profile::Triangle, [Limits::metric(7.5, 0.1); 3]);
//! assert_eq!(clock.step([0, 0, 0], [187, 187, -187]), 1);
//! assert_eq!(clock.step([0, 0, 0], [188, 0, 0]), 2);
//! ```

pub mod chain;
pub mod clock;
pub mod cloud;
pub mod comparison;
pub mod control;
pub mod curve;
pub mod engraver;
pub mod fill;
pub mod fly;
pub mod job;
pub mod list;
pub mod machine;
pub mod material;
pub mod mesh;
pub mod optics;
pub mod order;
pub mod origin;
mod pcx;
pub mod picture;
pub mod polar;
pub mod post;
pub mod profile;
pub mod proof;
pub mod sample;
pub mod scenario;
pub mod simulate;
pub mod source;
pub mod stitch;
pub mod watch;
pub mod weld;
