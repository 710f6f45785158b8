//! Engraving inside glass: a laser fires at a constant rate, and three axes bring its focus from point to point.
//!
//! Lengths are mm and points whole µm, times s, angles radians, unless a name says otherwise. The block's frame has its origin in a lower
//! corner of the block; Z points up, against the beam. The same input gives the same result on any number of threads.
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

pub mod clock;
pub mod cloud;
pub mod comparison;
pub mod mesh;
pub mod polar;
pub mod profile;
pub mod sample;
pub mod source;
