//! The travel of the axes: every position of the program, in machine space, is within it.
//!
//! Where the work zero is not known, no linear axis may need more way than its travel is long. What cannot be checked for
//! want of a fact is kept for the report.

use crate::gauge::Gauge;
use crate::machine_pose::MachinePose;
use crate::tilt::SLACK;
use control::{Orientation, Position};
use geom::{Arc, Vec3};
use machine::limits::Travel as Known;
use machine::{Machine, Unsaid};
use program::{Diagnostic, Rule};

/// What rounding may add to the position of a rotary axis that a block says, degrees.
const ROUNDING: f64 = 1e-6;

/// Holds the axes of a machine within their travel.
pub(crate) struct Travel {
    known: Known,
    /// Lowest and highest position of X, Y and Z so far, where only the length of the travel can be checked.
    extent: [[f64; 2]; 3],
    /// Axes whose length is found to be too short.
    short: [bool; 3],
    /// What nobody says, for want of which positions were not checked.
    unsaid: Vec<Unsaid>,
}

impl Travel {
    /// Before the first block.
    pub fn new(machine: &Machine) -> Travel {
        Travel {
            known: Known::of(machine),
            extent: [[f64::INFINITY, f64::NEG_INFINITY]; 3],
            short: [false; 3],
            unsaid: Vec::new(),
        }
    }

    /// How the linear axes are checked.
    pub fn known(&self) -> Known {
        self.known
    }

    /// What nobody says, for want of which positions were not checked.
    pub fn into_unsaid(self) -> Vec<Unsaid> {
        self.unsaid
    }

    /// What is wrong with a position of the program, for any of the `angles` (degrees of A, B, C) at which the rotary axes
    /// may stand; linear axes may be `slack` mm beyond their travel by rounding.
    #[inline]
    pub fn broken_at(
        &mut self,
        gauge: &Gauge,
        angles: &[[f64; 3]],
        position: &Position,
        slack: f64,
    ) -> Option<Diagnostic> {
        let is_said = matches!(position.orientation, Orientation::Rotary { .. });
        let rounding = if is_said { ROUNDING } else { SLACK };
        for angles in angles {
            let found = turned_too_far(gauge.machine, angles, rounding);
            if found.is_some() {
                return found;
            }
        }
        if self.known == Known::Unlimited {
            return None;
        }
        let is_sure = self.known == Known::MachineCoordinates || angles.len() == 1;
        for angles in angles {
            let found = match gauge.machine_pose(position, *angles) {
                Ok(pose) if is_sure => self.too_far(gauge, &pose, slack),
                Ok(_) => self.lack(Unsaid::Solution),
                Err(unsaid) => self.lack(unsaid),
            };
            if found.is_some() {
                return found;
            }
        }
        None
    }

    /// What is wrong with a position of the rotary axes (degrees of A, B, C) on the way of a vector.
    pub fn turned_too_far(&self, gauge: &Gauge, angles: [f64; 3]) -> Option<Diagnostic> {
        turned_too_far(gauge.machine, &angles, SLACK)
    }

    /// The same for every position of an arc (work frame), during which the rotary axes stand.
    pub fn broken_on_arc(
        &mut self,
        gauge: &Gauge,
        angles: &[[f64; 3]],
        arc: &Arc,
        slack: f64,
    ) -> Option<Diagnostic> {
        if self.known == Known::Unlimited || self.known == Known::Lengths && angles.len() > 1 {
            return None;
        }
        for angles in angles {
            let at = |tip: Vec3| {
                let orientation = Orientation::Rotary { degrees: *angles, tool_center: true };
                gauge.machine_pose(&Position { point: tip, orientation }, *angles)
            };
            // What nobody says has been noted at the end of the arc.
            let Ok(center) = at(arc.center) else { continue };
            let (Ok(start), Ok(end), Ok(tip)) =
                (at(arc.start), at(arc.end), at(arc.center + arc.normal))
            else {
                continue;
            };
            let (low, high) = Arc {
                start: start.linear,
                end: end.linear,
                center: center.linear,
                normal: tip.linear - center.linear,
                sweep: arc.sweep,
            }
            .extents();
            for linear in [low, high] {
                let found = self.too_far(gauge, &MachinePose { linear, ..center }, slack);
                if found.is_some() {
                    return found;
                }
            }
        }
        None
    }

    /// What is wrong with the linear axes of a pose. A coordinate that is not known breaks no limit.
    #[inline]
    fn too_far(&mut self, gauge: &Gauge, pose: &MachinePose, slack: f64) -> Option<Diagnostic> {
        let machine = gauge.machine;
        for (i, (axis, letter)) in machine.linear.iter().zip(['X', 'Y', 'Z']).enumerate() {
            let at = pose.linear[i];
            if self.known == Known::Lengths {
                let [low, high] = &mut self.extent[i];
                (*low, *high) = (low.min(at), high.max(at));
                let (way, travel) = (*high - *low, axis.max - axis.min);
                if way > travel + 2.0 * slack && !self.short[i] {
                    self.short[i] = true;
                    let message = format!(
                        "{letter} moves by {way:.4} mm in all, {:.4} mm more than its travel of {travel} mm",
                        way - travel
                    );
                    let help = "lower the clearance planes in the CAM system where only retracts go that far; else divide the work, or take a larger \
                            machine";
                    return Some(Diagnostic::error(Rule::AxisLimit, message).help(help));
                }
                continue;
            }
            // The slide of Z stands above the tip, by how much nobody knows without the length.
            let is_low = i < 2 || gauge.tool_length.is_some() || axis.min.is_infinite();
            if !is_low {
                self.lack(Unsaid::ToolLength);
            }
            let min = if is_low { axis.min } else { f64::NEG_INFINITY };
            let found = beyond(letter, at, [min, axis.max], slack, " mm", [axis.min, axis.max]);
            if found.is_some() {
                return found;
            }
        }
        None
    }

    /// Keeps what nobody says: a position is not checked for want of it.
    #[inline]
    fn lack(&mut self, unsaid: Unsaid) -> Option<Diagnostic> {
        if self.unsaid.last() != Some(&unsaid) && !self.unsaid.contains(&unsaid) {
            self.unsaid.push(unsaid);
        }
        None
    }
}

/// The rotary axis that is beyond its travel.
#[inline]
fn turned_too_far(machine: &Machine, angles: &[f64; 3], rounding: f64) -> Option<Diagnostic> {
    machine.rotary.iter().find_map(|axis| {
        let range = [axis.min, axis.max];
        beyond(axis.letter, angles[axis.index()], range, rounding, "°", range)
    })
}

/// What is wrong with the position of an axis.
#[inline]
fn beyond(
    letter: char,
    at: f64,
    [min, max]: [f64; 2],
    slack: f64,
    unit: &str,
    [low, high]: [f64; 2],
) -> Option<Diagnostic> {
    let (limit, far) = if at > max + slack {
        (max, at - max)
    } else if at < min - slack {
        (min, min - at)
    } else {
        return None;
    };
    let message =
        format!("{letter} at {at:.4}{unit} is {far:.4}{unit} beyond its limit of {limit}{unit}");
    let help = format!("{letter} travels from {low}{unit} to {high}{unit} in machine coordinates");
    Some(Diagnostic::error(Rule::AxisLimit, message).help(help))
}
