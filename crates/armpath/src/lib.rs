//! Along a path that says where the tool tip is and where its axis points, an arm is free to turn the tool about that axis, and to
//! choose its posture: [`choose`] picks both for the whole path, so that no limit, no singularity and no joint that is too slow
//! falls into a cut.
//!
//! **Units and frames.** Lengths are mm, angles radians, times s, feeds mm/min. The axis points from the tip to the spindle, as
//! everywhere; the Z of the tool frame points the opposite direction, from the flange towards the tip and beyond.
//!
//! **How.** A cut is a *section*: points that follow each other by straight lines. In it the posture stays, and the turn changes by
//! at most [`Settings::turn_rate`]. The turns are divided into [`Settings::turns`] steps, and time into intervals long enough for one
//! step. First every step and posture is followed through each interval; then the cheapest sequence of steps is found,
//! from each step to itself or to a neighbour (dynamic programming); then that sequence is followed exactly, with the turn changing
//! evenly within an interval, and every figure is checked at each point and between points ([`SPACING`]). Where points are nearer to each other
//! than that, and the tool turns by less than a degree, an interval has several of them, and the first two steps look at its end alone. Between sections the arm
//! is free to take another posture. Where no sequence passes a whole section it is divided: the arm draws back, turns and enters
//! again ([`Section::reentry`]), at a point that allows it ([`Point::inside`]). Memory is some 300 bytes an interval; the result depends on the arguments alone, whatever the
//! number of threads.
//!
//! ```
//! use arm::{Arm, Coupling, Dh, Frame, Joint, Structure, Vec3};
//! use toolpost_armpath::{Cell, Point, Settings, choose};
//! let ur5e = Dh { d1: 162.5, a2: -425.0, a3: -392.2, d4: 133.3, d5: 99.7, d6: 99.6 };
//! let joint = Joint { min: -6.28, max: 6.28, speed: 3.14, acceleration: None };
//! let arm = Arm::new(Structure::Ur(ur5e, None), [joint; 6], Some(Coupling::None), 0.0).unwrap();
//! let cell = Cell {
//!     tool: Frame::from_translation(Vec3::new(0.0, 0.0, 150.0)),
//!     part: Frame::from_translation(Vec3::new(450.0, 0.0, 150.0)),
//! };
//! let point = |x: f64, cut: bool| Point { tip: Vec3::new(x, 0.0, 0.0), axis: Vec3::Z, side: None, cut, feed: 1200.0, inside: false };
//! let path = [point(0.0, false), point(60.0, true), point(120.0, true)];
//! let choice = choose(&arm, &cell, &path, &Settings::default()).unwrap();
//! assert_eq!(choice.sections.len(), 1);
//! let end = arm.flange(&choice.sections[0].positions[2].joints) * cell.tool;
//! assert!(end.translation.distance(Vec3::new(570.0, 0.0, 150.0)) < 1e-6);
//! // Ten metres away nothing reaches.
//! let far = choose(&arm, &cell, &[point(10_000.0, false)], &Settings::default()).unwrap_err();
//! assert!(far.to_string().contains("out of reach"));
//! ```
//!
//! **What is not done.** Collisions are not looked at. Nor is the path of the arm between two sections. The cost of a
//! section counts from the cheapest end of the one before, not from all its ends.

mod ease;
mod follow;
mod grid;
mod samples;
mod search;

pub use ease::{ease_of, stand};

use arm::{Arm, Frame, Joints, Posture, Vec3};
use std::fmt;

/// A point is checked at least every so many mm, and every 2 degrees of the tool axis.
pub const SPACING: f64 = 5.0;

/// A point of a path, in the frame of the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The tool tip, mm.
    pub tip: Vec3,
    /// Unit vector from the tip towards the spindle.
    pub axis: Vec3,
    /// Unit vector of the tool's own X, where the source says how the tool is turned; else the turn is free.
    pub side: Option<Vec3>,
    /// Whether the tool cuts on the way to this point, straight and at `feed`; else the arm comes here from outside.
    pub cut: bool,
    /// Feed on the way to this point, mm/min.
    pub feed: f64,
    /// Whether it is within a motion, an arc: no cut is divided there.
    pub inside: bool,
}

/// Where the tool and the part are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The tool in the frame of the flange: its tip, and its Z out of the tool.
    pub tool: Frame,
    /// The part in the world of the controller.
    pub part: Frame,
}

/// What is asked of a choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Steps of the turn about the tool axis, 1 to 360.
    pub turns: u16,
    /// Fastest turn about the tool's axis that is chosen in a cut, radians/s.
    pub turn_rate: f64,
    /// Fastest turn of the tool, its axis and about it together, that the controller makes, radians/s: where the path turns it faster at
    /// its feed the arm goes slower. `None` where the controller keeps the feed.
    pub slows_at: Option<f64>,
    /// Least distance of joint 5 from stretched or folded, radians.
    pub wrist: f64,
    /// Least distance of the wrist from axis 1, mm.
    pub shoulder: f64,
    /// Least distance of the elbow from stretched or folded, radians.
    pub elbow: f64,
    /// Least distance of each joint from its limits, radians.
    pub limit: f64,
    /// Largest part of a joint's speed that a cut may use, above 0, at most 1.
    pub speed: f64,
    /// Where the arm stands before the path: of two postures that pass it about as well the one in which it stands there is taken. Later
    /// sections keep near to the one before them, so it comes back in it, too.
    pub home: Option<Joints>,
    /// Whether the arm leaves the posture of `home` only where no path keeps it.
    pub keeps_posture: bool,
}

impl Default for Settings {
    /// Steps of 10 degrees, turned at most 60 degrees/s; 5 degrees and 20 mm from singularities; 1 degree from limits; 90 % of the
    /// speeds.
    fn default() -> Settings {
        Settings {
            turns: 36,
            turn_rate: 60_f64.to_radians(),
            slows_at: None,
            wrist: 5_f64.to_radians(),
            shoulder: 20.0,
            elbow: 5_f64.to_radians(),
            limit: 1_f64.to_radians(),
            speed: 0.9,
            home: None,
            keeps_posture: false,
        }
    }
}

/// The position of the arm at a point of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Its joints, without jumps within a section and within the limits.
    pub joints: Joints,
    /// Unit vector of the tool's own X, in the frame of the part.
    pub side: Vec3,
}

/// Points that the arm passes in one posture without leaving the path.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// The number of its first point.
    pub first: usize,
    /// Its posture.
    pub posture: Posture,
    /// Its position at each point, from the first on.
    pub positions: Vec<Position>,
    /// Where it begins at the end of the section before it, within a cut: what ends that, so that the arm draws back there, turns and
    /// enters again.
    pub reentry: Option<Why>,
}

/// The least margins, and where they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Of joint 5 from stretched or folded, radians, and at which point.
    pub wrist: (f64, usize),
    /// Of the wrist from axis 1, mm, and at which point.
    pub shoulder: (f64, usize),
    /// Of the elbow from stretched or folded, radians, and at which point.
    pub elbow: (f64, usize),
    /// Of a joint from its limit, radians, and at which point.
    pub limit: (f64, usize),
    /// The largest part of a joint's speed in a cut, and at which point.
    pub speed: (f64, usize),
}

/// What is chosen for a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Its sections, which have every point; one at which the arm enters again is in two of them.
    pub sections: Vec<Section>,
    /// Its least margins.
    pub worst: Worst,
}

/// Why nothing can be chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocked {
    /// The number of the point at which it ends, or on the way to which.
    pub point: usize,
    /// Where within the motion to its end that is; `None` at its end, or where nothing says where.
    pub within: Option<Within>,
    /// What ends it in the turn and posture that come nearest.
    pub why: Why,
}

/// A place within a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Within {
    /// The tool tip in the frame of the part, mm.
    pub tip: Vec3,
    /// What keeps the arm from the end of the motion, where that is not reached either.
    pub end: Option<Why>,
}

/// What ends a section of which nothing is left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Why {
    /// No posture reaches the point, whatever the turn: how much too far it is from the shoulder, mm; negative where it is too
    /// near.
    Reach(f64),
    /// A joint would be beyond its limit (number from 1; radians; the margin that is asked for counts).
    Limit(usize, f64),
    /// Joint 5 would be this near to stretched or folded, radians.
    Wrist(f64),
    /// The wrist would be this near to axis 1, mm.
    Shoulder(f64),
    /// The elbow would be this near to stretched or folded, radians.
    Elbow(f64),
    /// A joint would need this part of its speed (number from 1), and that part a cut may use.
    Speed(usize, f64, f64),
    /// A joint (number from 1) would leave its range, through which it has turned on the way.
    Range(usize),
    /// Single points are reached, but no turn and posture leads from one to the next.
    Apart,
    /// The point, the feed or the settings are no numbers that make sense.
    Numbers,
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let degrees = |angle: f64| angle.to_degrees();
        match *self {
            Why::Reach(mm) if mm < 0.0 => {
                write!(f, "the tool is {:.1} mm too near to the arm", -mm)
            }
            Why::Reach(mm) => write!(f, "the tool is {mm:.1} mm out of reach"),
            Why::Limit(joint, by) => {
                write!(f, "joint {joint} would be {:.2} degrees beyond its limit", degrees(by))
            }
            Why::Wrist(angle) => {
                write!(f, "joint 5 would be {:.2} degrees from stretched", degrees(angle))
            }
            Why::Shoulder(mm) => write!(f, "the wrist would be {mm:.1} mm from axis 1"),
            Why::Elbow(angle) => {
                write!(f, "the elbow would be {:.2} degrees from stretched", degrees(angle))
            }
            // It turns where the tip stays.
            Why::Speed(joint, share, _) if share.is_infinite() => {
                write!(
                    f,
                    "joint {joint} would have no time for its turn: the path is a point, and nothing states how fast the tool turns"
                )
            }
            Why::Speed(joint, share, most) => {
                write!(
                    f,
                    "joint {joint} would need {:.0} % of its speed at this feed, and a cut may use {:.0} %",
                    100.0 * share,
                    100.0 * most
                )
            }
            Why::Range(joint) => {
                write!(f, "joint {joint} would have turned through all of its range")
            }
            Why::Apart => {
                f.write_str("no turn about the tool and no posture leads on from the point before")
            }
            Why::Numbers => f.write_str("its numbers make no point of a path"),
        }
    }
}

impl fmt::Display for Blocked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(Within { tip, end }) = self.within else { return self.why.fmt(f) };
        // Without the sign of what rounds to 0.
        let [x, y, z] = tip.to_array().map(|mm| (mm * 10.0).round() / 10.0 + 0.0);
        write!(f, "at X{x} Y{y} Z{z}, before the end of the motion, {}", self.why)?;
        match end {
            Some(end) => write!(f, "; at the end {end}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Blocked {}

/// The turns about the tool and the postures with which an arm follows a path.
///
/// # Errors
/// The first point that cannot be reached, or on the way to which nothing leads.
pub fn choose(
    arm: &Arm,
    cell: &Cell,
    points: &[Point],
    settings: &Settings,
) -> Result<Choice, Blocked> {
    let job = samples::Job::new(arm, cell, points, settings)?;
    search::search(&job)
}
