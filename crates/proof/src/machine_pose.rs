//! Where the axes of the machine stand for a position of the program, whatever coordinates its blocks give: positions of
//! the axes, tool-centre control by angles, vectors, tilted planes.
//!
//! **Frame.** X, Y and Z are what the control shows in machine coordinates, mm: they count from the machine's zero, and
//! for Z to the gauge line of the spindle, with the head in its zero position. Rotary axes are degrees, in whole turns as
//! far as they are known.
//!
//! **Length.** That of the tool that the source calls, from the gauge line to the tip. Where nobody says it, Z counts to
//! the tip instead; where `work_zero` of the machine's file is missing, X, Y and Z count from the work zero. Differences
//! between two poses of the same tool are right all the same.

use crate::gauge::Gauge;
use crate::tilt::{self, Degrees};
use control::{Orientation, Position, TiltChoice};
use geom::Vec3;
use machine::{Inverse, Machine, Unsaid};

/// Positions of the axes of the machine; NaN where they are not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MachinePose {
    /// X, Y, Z, mm.
    pub linear: Vec3,
    /// A, B, C, degrees.
    pub rotary: [f64; 3],
}

impl Gauge<'_> {
    /// Where the axes stand at a position of the program, with the rotary axes at `rotary` (degrees of A, B, C), which
    /// is one of [`Standing::at`].
    ///
    /// # Errors
    /// The fact on which it hangs, where nobody says it.
    pub fn machine_pose(
        &self,
        position: &Position,
        rotary: [f64; 3],
    ) -> Result<MachinePose, Unsaid> {
        let Gauge { machine, tool_length, .. } = *self;
        let length = tool_length.unwrap_or(0.0);
        let linear = match position.orientation {
            Orientation::Rotary { tool_center: false, .. } => position.point,
            Orientation::Rotary { .. } | Orientation::Axis(_) => {
                if let Some(unsaid) = machine.unsaid(rotary, tool_length) {
                    return Err(unsaid);
                }
                machine.linear_for(position.point, rotary, length)
            }
        };
        let zero = machine.work_zero.unwrap_or_default();
        Ok(MachinePose { linear: linear + Vec3::Z * length + zero, rotary })
    }
}

/// Where the rotary axes stand, as far as the program lets it be known.
///
/// A block that says their positions leaves no question. Of a vector the control takes the solution that is the nearest
/// to where the axes stand, behind an unknown place any that is within the travel; of a tilted plane those that its rule
/// of choice allows ([`crate::tilt`]).
pub(crate) struct Standing<'a> {
    machine: &'a Machine,
    inverse: Inverse<'a>,
    /// Degrees of A, B, C; several where it is not known which the control has taken, none where nothing is known.
    angles: Vec<Degrees>,
    /// The tool axis that they give, where the program has said that.
    axis: Option<Vec3>,
    /// How the control is about to turn to a tilted plane.
    swivels: Option<TiltChoice>,
    /// How it has turned to the one in which it is.
    choice: Option<TiltChoice>,
    /// Angles of the block looked at, and the tool axis for which they were worked out.
    next: Vec<Degrees>,
    next_axis: Option<Vec3>,
}

impl<'a> Standing<'a> {
    /// Before the first block: nowhere that is known.
    pub fn new(machine: &'a Machine) -> Standing<'a> {
        Standing {
            machine,
            inverse: Inverse::of(machine),
            angles: Vec::new(),
            axis: None,
            swivels: None,
            choice: None,
            next: Vec::new(),
            next_axis: None,
        }
    }

    /// The control turns the axes to a tilted plane.
    pub fn swivel(&mut self, choice: TiltChoice) {
        (self.swivels, self.axis, self.next_axis) = (Some(choice), None, None);
    }

    /// What a person can do where several positions are possible.
    pub fn way_out(&self) -> Option<&'static str> {
        tilt::way_out(self.machine, self.swivels.or(self.choice)?)
    }

    /// Whether it has turned them, and no block has moved since.
    pub fn has_swivelled(&self) -> bool {
        self.swivels.is_some()
    }

    /// The axes stand where nobody knows.
    pub fn forget(&mut self) {
        self.angles.clear();
        (self.axis, self.next_axis) = (None, None);
    }

    /// Degrees of A, B, C where the axes stand.
    pub fn here(&self) -> &[Degrees] {
        &self.angles
    }

    /// Degrees of A, B, C for a block that goes to `orientation` from here: several where each is possible, none where
    /// nothing is known.
    #[inline]
    pub fn at(&mut self, orientation: &Orientation) -> &[Degrees] {
        match *orientation {
            Orientation::Rotary { degrees, .. } => {
                self.next.clear();
                self.next.push(degrees);
                self.next_axis = None;
            }
            Orientation::Axis(axis) if self.axis == Some(axis) => return &self.angles,
            Orientation::Axis(axis) if self.next_axis == Some(axis) => {}
            Orientation::Axis(axis) => self.solve(axis),
        }
        &self.next
    }

    /// The axes have turned to `orientation`.
    #[inline]
    pub fn arrive(&mut self, orientation: &Orientation) {
        self.at(orientation);
        match *orientation {
            Orientation::Axis(axis) if self.axis == Some(axis) => return,
            Orientation::Axis(axis) => self.axis = Some(axis),
            Orientation::Rotary { .. } => self.axis = None,
        }
        std::mem::swap(&mut self.angles, &mut self.next);
        (self.choice, self.next_axis) = (self.swivels.take(), None);
    }

    /// Finds where the axes may stand with the tool along `axis`.
    fn solve(&mut self, axis: Vec3) {
        self.next.clear();
        self.next_axis = Some(axis);
        if self.machine.rotary.is_empty() {
            self.next.push([0.0; 3]);
            return;
        }
        let Ok(solutions) = self.inverse.solve(axis) else { return };
        if let Some(choice) = self.swivels {
            tilt::take(self.machine, choice, &self.angles, &solutions, &mut self.next);
            return;
        }
        let is_known =
            !self.angles.is_empty() && self.angles.iter().flatten().all(|at| at.is_finite());
        if !is_known {
            self.next.extend(tilt::all(self.machine, &solutions));
            tilt::keep_within(self.machine, &mut self.next);
            return;
        }
        for from in &self.angles {
            for degrees in tilt::nearest(self.machine, from, &solutions).into_iter().flatten() {
                if !self.next.contains(&degrees) {
                    self.next.push(degrees);
                }
            }
        }
    }
}
