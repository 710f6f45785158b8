//! The rotary positions of a tilted plane. The control chooses between two solutions; the block says which, where it can,
//! and each that the control may take is within the travel.

use crate::catalogue::{BlockName, WordName};
use crate::coordinate_mode::{Kind, rotary_word};
use crate::sweep::short_way;
use crate::template::ORIENTATION;
use crate::walk::{Outcome, Walk, motion};
use geom::{Arc, Frame, Mat3, Vec3};
use machine::plan::{self, Target, TargetKind};
use machine::{Machine, Mount, RotaryAxis};
use program::Diagnostic;

/// Rotary positions that the control may take for the tilted plane that is on.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// Degrees of A, B, C.
    degrees: [f64; 3],
    /// From the work frame to positions of X, Y and Z, where nothing is missing to check them.
    into_axes: Option<Frame>,
}

/// Positions that differ by less, degrees, are alike.
const ALIKE: f64 = 0.01;

/// Rotary axes turn at most this much between two positions that are checked, degrees.
const SAMPLE: f64 = 3.0;

impl Walk<'_> {
    /// Chooses the rotary positions for a tilted plane along `axis`, and says in the next block which they are, where its
    /// words can. Keeps all that the control may take all the same.
    ///
    /// # Errors
    /// No position within the travel gives that tool axis.
    pub(crate) fn choose_solution(&mut self, axis: Vec3) -> Outcome {
        let target = Target { axis, line: self.line, kind: TargetKind::Rapid };
        let plan = plan::plan(self.machine, self.place.degrees(), [target])?;
        let wanted = plan.iter().next().map_or([0.0; 3], |step| step.degrees);
        let other = self.other_solution(axis, wanted);
        let is_sure = self.says_positions(wanted) || self.says_sequence(wanted, other);
        let is_sure = self.says_direction(wanted, other) || is_sure;
        let others = other.filter(|_| !is_sure);
        let all = [Some(wanted), others].into_iter().flatten();
        let mut solutions: Vec<Solution> = all.map(|degrees| self.solution(degrees)).collect();
        // The stroke of two solutions that are both possible is that of none.
        if self.machine.work_zero.is_none() && solutions.len() > 1 {
            solutions.iter_mut().for_each(|solution| solution.into_axes = None);
        }
        self.place.keep_solutions(solutions);
        Ok(())
    }

    /// The solution besides `wanted` that the control may take too.
    fn other_solution(&self, axis: Vec3, wanted: [f64; 3]) -> Option<[f64; 3]> {
        let solutions = self.inverse.solve(axis).ok()?;
        let apart = |degrees: &[f64; 3]| {
            (0..3).map(|i| short_way(wanted[i], degrees[i]).abs()).fold(0.0, f64::max)
        };
        let [one, two] = solutions.degrees;
        if apart(&one).max(apart(&two)) < ALIKE {
            return None;
        }
        let other = if apart(&one) > apart(&two) { one } else { two };
        let within = other_turns(self.machine, other);
        within.or(self.machine.tilts_blindly().then_some(other))
    }

    /// Turns the axes in the block itself, before it tilts the plane: the control then stays there.
    fn says_positions(&mut self, degrees: [f64; 3]) -> bool {
        let places = |axis: &RotaryAxis| {
            self.templates.places(BlockName::PlaneTilt, rotary_word(axis.index()))
        };
        if !self.machine.rotary.iter().all(places) {
            return false;
        }
        self.writer.forget(ORIENTATION);
        self.say_degrees(degrees);
        self.writer.code(WordName::Motion, motion::RAPID);
        true
    }

    /// Says the sign of the main rotary axis, where another solution has the other sign.
    fn says_sequence(&mut self, wanted: [f64; 3], other: Option<[f64; 3]>) -> bool {
        let Some(other) = other else { return false };
        let main = main_axis(self.machine);
        let (wanted, other) = (wanted[main], other[main]);
        if !self.templates.places(BlockName::PlaneTilt, WordName::Sequence)
            || wanted * other >= -ALIKE
        {
            return false;
        }
        self.writer.code(WordName::Sequence, usize::from(wanted < 0.0));
        true
    }

    /// Says whether the axis to which the swivel data set refers stands lower or higher than in the other solution.
    fn says_direction(&mut self, wanted: [f64; 3], other: Option<[f64; 3]>) -> bool {
        let reference = self.machine.settings.swivel_direction;
        let axis = self.machine.rotary.iter().find(|axis| Some(axis.letter) == reference);
        let axis = axis.filter(|axis| axis.max - axis.min <= 360.0);
        let way = match (axis, other) {
            (Some(axis), Some(other)) => wanted[axis.index()] - other[axis.index()],
            (None, _) | (_, None) => 0.0,
        };
        self.writer.set(WordName::Direction, if way > 0.0 { 1.0 } else { -1.0 });
        way.abs() > ALIKE && self.templates.places(BlockName::PlaneTilt, WordName::Direction)
    }

    fn solution(&self, degrees: [f64; 3]) -> Solution {
        let (machine, length) = (self.machine, self.tool_length());
        let known = machine.unsaid(degrees, length).is_none();
        let at = |tip| machine.linear_for(tip, degrees, length.unwrap_or(0.0));
        let into_axes = known.then(|| {
            let origin = at(Vec3::ZERO);
            let columns = Vec3::AXES.map(|axis| at(axis) - origin);
            Frame::from_mat3_translation(
                Mat3::from_cols(columns[0], columns[1], columns[2]),
                origin,
            )
        });
        Solution { degrees, into_axes }
    }

    /// Checks a tip in a tilted plane against the limits, for each solution that the control may take.
    pub(crate) fn check_in_plane(&mut self, tip: Vec3) -> Outcome {
        let length = self.tool_length();
        for Solution { degrees, into_axes } in self.place.solutions() {
            let linear = into_axes.map_or(Vec3::NAN, |into| into.transform_point3(tip));
            self.limits.position(linear, *degrees, length, self.line)?;
        }
        Ok(())
    }

    /// Checks an arc (work frame) where blocks do not give positions of the axes.
    pub(crate) fn check_arc(&mut self, arc: &Arc) -> Outcome {
        let length = self.tool_length();
        let here;
        let solutions = match self.place.kind {
            Kind::Tilted(..) => self.place.solutions(),
            Kind::ToolCenter | Kind::Vectors => {
                here = [self.solution(self.place.degrees().unwrap_or_default())];
                &here[..]
            }
            Kind::Bare | Kind::Plain | Kind::Machine => return Ok(()),
        };
        for Solution { degrees, into_axes } in solutions {
            let Some(into) = into_axes else { continue };
            let in_axes = Arc {
                start: into.transform_point3(arc.start),
                end: into.transform_point3(arc.end),
                center: into.transform_point3(arc.center),
                normal: into.transform_vector3(arc.normal),
                sweep: arc.sweep,
            };
            self.limits.arc(&in_axes, *degrees, length, self.line)?;
        }
        Ok(())
    }

    /// Checks the way from `from` (tip, and degrees of A, B, C) to here, on which the control moves the linear axes along
    /// with the rotary axes.
    pub(crate) fn check_way(
        &mut self,
        from: (Vec3, [f64; 3]),
        degrees: [f64; 3],
    ) -> Result<(), Box<Diagnostic>> {
        let turned = (0..3).map(|i| (degrees[i] - from.1[i]).abs()).fold(0.0, f64::max);
        if turned <= SAMPLE {
            return Ok(());
        }
        let (machine, length) = (self.machine, self.tool_length());
        let samples = (turned / SAMPLE).ceil().min(360.0) as u32;
        for i in 1..samples {
            let part = f64::from(i) / f64::from(samples);
            let degrees = [0, 1, 2].map(|k| from.1[k] + (degrees[k] - from.1[k]) * part);
            if machine.unsaid(degrees, length).is_none() {
                let tip = from.0.lerp(self.position.tip(), part);
                let linear = machine.linear_for(tip, degrees, length.unwrap_or(0.0));
                self.limits.position(linear, degrees, length, self.line)?;
            }
        }
        Ok(())
    }
}

/// The same positions in whole turns that are within the travel, where there are such.
fn other_turns(machine: &Machine, mut degrees: [f64; 3]) -> Option<[f64; 3]> {
    for axis in &machine.rotary {
        let at = &mut degrees[axis.index()];
        if *at < axis.min - ALIKE || *at > axis.max + ALIKE {
            *at += 360.0 * ((axis.min - ALIKE - *at) / 360.0).ceil();
            if *at > axis.max + ALIKE {
                return None;
            }
        }
        *at = at.clamp(axis.min, axis.max);
    }
    Some(degrees)
}

/// Index (in A, B, C) of the rotary axis whose sign is output to a control: the first from the tool, or the last from the table.
fn main_axis(machine: &Machine) -> usize {
    let head = machine.rotary.iter().rev().find(|axis| axis.on == Mount::Head);
    head.or(machine.rotary.first()).map_or(0, RotaryAxis::index)
}
