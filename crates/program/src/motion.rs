//! What motions need in addition to the pose where they end.

use crate::pose::is_unit;
use crate::{Axes, Diagnostic, FullPose, NoPose, Pose, Rule};
use geom::{Arc, ArcError, Vec3};

/// An arc or helix from where the tool is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcTo {
    /// Where it ends. The orientation holds during the arc.
    pub end: Pose,
    /// The circle that it follows.
    pub circle: Circle,
}

/// The circle of an arc, and how often the arc goes round it. Every number is finite, and the normal is a unit
/// vector. How far the arc goes, and how high a helix rises, its start and its end say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    center: Vec3,
    normal: Vec3,
    turns: u32,
}

impl Circle {
    /// The circle about the axis through `center`, mm, along the unit vector `normal`, about which an arc turns
    /// counter-clockwise, with `turns` full turns more than the shortest.
    ///
    /// # Errors
    /// A number that is not finite, or a normal whose length is not 1.
    pub fn new(center: Vec3, normal: Vec3, turns: u32) -> Result<Circle, NoPose> {
        match center.is_finite() && is_unit(normal) {
            true => Ok(Circle { center, normal, turns }),
            false => Err(NoPose::of(center, normal)),
        }
    }

    /// The arc on it from `start` to `end`, whose distances from the axis differ by `tolerance` at most, all in mm.
    ///
    /// # Errors
    /// As [`Arc::new`].
    pub fn arc(&self, start: Vec3, end: Vec3, tolerance: f64) -> Result<Arc, ArcError> {
        Arc::new(start, end, self.center, self.normal, self.turns, tolerance)
    }

    /// A point of the axis, mm.
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// Unit vector about which an arc turns counter-clockwise.
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Full turns more than the shortest.
    pub fn turns(&self) -> u32 {
        self.turns
    }
}

/// A thread from where the tool is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thread {
    /// Where it ends.
    pub end: Pose,
    pitch: f64,
}

impl Thread {
    /// The thread that ends at `end`, with `pitch` mm along the way for each turn of the spindle.
    ///
    /// # Errors
    /// `thread` where the pitch is not finite, or not above 0.
    pub fn new(end: Pose, pitch: f64) -> Result<Thread, Box<Diagnostic>> {
        match pitch.is_finite() && pitch > 0.0 {
            true => Ok(Thread { end, pitch }),
            false => {
                let message = format!("a thread with a pitch of {pitch} mm");
                Err(Diagnostic::error(Rule::Thread, message).into())
            }
        }
    }

    /// mm along the way for each turn of the spindle, above 0.
    pub fn pitch(&self) -> f64 {
        self.pitch
    }
}

/// A probing move from where the tool is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe<P = Pose> {
    /// Where it ends at the latest.
    pub end: P,
    /// Whether it ends where the probe lets go of the part (`G38.4`, `G38.5`), and not where it touches
    /// it.
    pub away: bool,
    /// Whether a probe that has not answered on the way stops the program (`G38.2`, `G38.4`).
    pub must_answer: bool,
    /// The place of a [`Surface`](crate::Surface) whose height is kept where it answers, counted from 0 row by row.
    pub place: Option<u32>,
}

/// A motion to a full orientation of the tool, as a robot makes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Oriented {
    /// Where it ends.
    pub end: FullPose,
    /// How it goes there.
    pub course: Course,
    /// In which of the ways that reach the pose the arm ends; `None` leaves it to the writer.
    pub configuration: Option<Configuration>,
    /// Positions of the external axes where it ends, mm or degrees; none for those that stay.
    pub external: Vec<f64>,
}

/// How an oriented motion goes to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// Joint by joint, all at the same time: the way is the arm's own.
    Rapid,
    /// Straight at the active feed.
    Line,
    /// On an arc at the active feed.
    Arc(Circle),
}

/// In which of the ways that reach a pose an arm stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration {
    /// Whether the arm reaches over its first axis, backwards.
    pub backward: bool,
    /// Whether the elbow is below the line from shoulder to wrist.
    pub elbow_down: bool,
    /// Whether the fifth joint is below 0.
    pub flipped: bool,
    /// Full turns of the first, the fourth and the sixth joint beyond ±180 degrees.
    pub turns: [i8; 3],
}

/// A motion of the joints of an arm, all at the same time, to positions that are given.
#[derive(Clone, Debug, PartialEq)]
pub struct JointMove {
    /// Where each joint ends, degrees.
    pub degrees: [f64; 6],
    /// Positions of the external axes, mm or degrees.
    pub external: Vec<f64>,
}

/// A rapid of some axes to positions that count from the zero of the machine (`G53`, `SUPA`, `M91`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MachineMove {
    /// Where X, Y and Z go, mm; `None` for an axis that stays.
    pub linear: [Option<f64>; 3],
    /// Where A, B and C go, degrees; `None` for an axis that stays.
    pub rotary: [Option<f64>; 3],
}

impl MachineMove {
    /// The axes that move.
    pub fn axes(&self) -> Axes {
        let ([x, y, z], [a, b, c]) = (self.linear, self.rotary);
        Axes::of([x, y, z, a, b, c].map(|to| to.is_some()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_of_finite_numbers_about_a_unit_vector() {
        assert!(Circle::new(Vec3::ZERO, Vec3::NEG_Z, 2).is_ok());
        for center in [Vec3::NAN, Vec3::INFINITY] {
            assert!(Circle::new(center, Vec3::Z, 0).is_err(), "{center}");
        }
        for normal in [Vec3::ZERO, Vec3::splat(1.0), Vec3::NAN, Vec3::Z * 1.001] {
            assert!(Circle::new(Vec3::ZERO, normal, 0).is_err(), "{normal}");
        }
    }
}
