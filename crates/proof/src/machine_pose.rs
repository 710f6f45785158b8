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
use control::{Orientation, Position};
use geom::Vec3;
use machine::{Inverse, Machine, Solutions, Unsaid};

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

/// Positions at which an axis that is free in a singular pose may stand, as parts of a turn.
const FREE_POSITIONS: u32 = 32;

/// Turns that differ by less, degrees, are as long as each other.
const SAME_TURN: f64 = 0.01;

/// Where the rotary axes stand, as far as the program lets it be known.
///
/// A block that says their positions leaves no question. Of a vector the control takes the solution that is the nearest
/// to where the axes stand; of a tilted plane, and of a vector behind an unknown place, each solution within the travel is
/// possible.
pub(crate) struct Standing<'a> {
    machine: &'a Machine,
    inverse: Inverse<'a>,
    /// Degrees of A, B, C; several where it is not known which the control has taken, none where nothing is known.
    angles: Vec<[f64; 3]>,
    /// The tool axis that they give, where the program has said that.
    axis: Option<Vec3>,
    /// Whether the control is about to turn to a tilted plane by a choice of its own.
    swivels: bool,
    /// Angles of the block looked at, and the tool axis for which they were worked out.
    next: Vec<[f64; 3]>,
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
            swivels: false,
            next: Vec::new(),
            next_axis: None,
        }
    }

    /// The control turns the axes to a tilted plane.
    pub fn swivel(&mut self) {
        (self.swivels, self.axis, self.next_axis) = (true, None, None);
    }

    /// The axes stand where nobody knows.
    pub fn forget(&mut self) {
        self.angles.clear();
        (self.axis, self.next_axis) = (None, None);
    }

    /// Degrees of A, B, C where the axes stand.
    pub fn here(&self) -> &[[f64; 3]] {
        &self.angles
    }

    /// Degrees of A, B, C for a block that goes to `orientation` from here: several where each is possible, none where
    /// nothing is known.
    #[inline]
    pub fn at(&mut self, orientation: &Orientation) -> &[[f64; 3]] {
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
        (self.swivels, self.next_axis) = (false, None);
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
        let is_known = |angles: &[f64; 3]| angles.iter().all(|degrees| degrees.is_finite());
        if !self.swivels && !self.angles.is_empty() && self.angles.iter().all(is_known) {
            for from in &self.angles {
                let nearest = nearest(self.machine, from, &solutions);
                self.next.extend(nearest.into_iter().flatten());
            }
            return;
        }
        self.next.extend(all(solutions).map(|angles| within_travel(self.machine, angles)));
        if self.next.iter().any(|angles| is_within_travel(self.machine, angles)) {
            self.next.retain(|angles| is_within_travel(self.machine, angles));
        }
    }
}

/// The solutions to which the axes turn least from `from`; a free axis stands still.
fn nearest(machine: &Machine, from: &[f64; 3], solutions: &Solutions) -> [Option<[f64; 3]>; 2] {
    let ways = solutions.degrees.map(|mut degrees| {
        if let Some(free) = solutions.free {
            degrees[free] = from[free];
        }
        let mut turn = 0f64;
        for axis in &machine.rotary {
            let i = axis.index();
            let way = degrees[i] - from[i];
            let way = way - 360.0 * (way / 360.0).round();
            degrees[i] = from[i] + way;
            turn = turn.max(way.abs());
        }
        (degrees, turn)
    });
    let least = ways[0].1.min(ways[1].1);
    let mut taken = ways.map(|(degrees, turn)| (turn <= least + SAME_TURN).then_some(degrees));
    if taken[0] == taken[1] {
        taken[1] = None;
    }
    taken
}

/// All solutions, with a free axis anywhere.
fn all(solutions: Solutions) -> impl Iterator<Item = [f64; 3]> {
    let count = if solutions.degrees[0] == solutions.degrees[1] { 1 } else { 2 };
    let stands = if solutions.free.is_some() { FREE_POSITIONS } else { 1 };
    solutions.degrees.into_iter().take(count).flat_map(move |degrees| {
        (0..stands).map(move |k| {
            let mut degrees = degrees;
            if let Some(free) = solutions.free {
                degrees[free] += 360.0 * f64::from(k) / f64::from(stands);
            }
            degrees
        })
    })
}

/// The same positions in whole turns that are within the travel, where there are such.
fn within_travel(machine: &Machine, mut degrees: [f64; 3]) -> [f64; 3] {
    for axis in &machine.rotary {
        let at = &mut degrees[axis.index()];
        let turns = ((axis.min - SLACK - *at) / 360.0).ceil();
        if *at < axis.min - SLACK || *at > axis.max + SLACK {
            let first = *at + 360.0 * turns;
            if first <= axis.max + SLACK {
                *at = first;
            }
        }
    }
    degrees
}

/// What a position that was worked out of a tool axis may be beyond its travel, degrees: the rounding of the words.
pub(crate) const SLACK: f64 = 2e-3;

/// Whether the rotary axes stand within their travel.
fn is_within_travel(machine: &Machine, degrees: &[f64; 3]) -> bool {
    machine.rotary.iter().all(|axis| {
        let at = degrees[axis.index()];
        at >= axis.min - SLACK && at <= axis.max + SLACK
    })
}
