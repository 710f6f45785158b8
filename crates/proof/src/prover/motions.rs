//! The motions of the program for whoever follows the proof.

use super::*;
use crate::observer::{AxisPositions, Motion, MotionKind as Kind, ToolPose};
use program::Pose;
use program::lowering::{self, HoleMove};

/// Motions since they were taken last.
#[derive(Default)]
pub(super) struct Motions {
    kept: Vec<Motion>,
    /// Where the event at hand begins.
    start: Option<ToolPose>,
    /// Whether the tool has been changed since the last motion: where the machine has gone for that is its own.
    changed: bool,
    /// The record that it has made.
    made: Option<usize>,
}

impl Prover<'_> {
    /// Keeps the motions of each event until they are taken.
    pub(crate) fn keep_motions(&mut self) {
        self.motions = Some(Motions::default());
    }

    /// Takes the motions of the last event.
    pub(crate) fn take_motions(&mut self, mut told: impl FnMut(&Motion)) {
        if let Some(motions) = &mut self.motions {
            motions.kept.drain(..).for_each(|motion| told(&motion));
        }
    }

    /// Before an event.
    pub(super) fn begin_motion(&mut self) {
        if let Some(motions) = &mut self.motions {
            (motions.start, motions.made) = (Some(self.here.place.into()), None);
        }
    }

    /// The event makes the record at hand.
    pub(super) fn has_arrived(&mut self) {
        if let Some(motions) = &mut self.motions {
            motions.made = Some(self.cursor.record());
        }
    }

    /// Behind an event that was accepted.
    pub(super) fn end_motion(&mut self, event: &Event) {
        let Some(motions) = &mut self.motions else { return };
        let Some(start) = motions.start.take() else { return };
        let record = motions.made.unwrap_or_else(|| self.cursor.record());
        let source_line = self.source.records.get(record).map_or(0, |record| record.line);
        let mut from = match motions.changed {
            true => ToolPose { tip: Vec3::NAN, ..start },
            false => start,
        };
        let mut moved = |prover: &mut Self, kind: Kind, to: &ResolvedPose| {
            let (axes, end) = (prover.axis_positions(&to.position), ToolPose::from(to.place));
            let motion = Motion {
                file: None,
                line: event.line,
                record,
                source_line,
                kind,
                tool: [from, end],
                axes,
            };
            from = end;
            if let Some(motions) = &mut prover.motions {
                motions.kept.push(motion);
                motions.changed = false;
            }
        };
        let here = self.here;
        match &event.action {
            Action::Rapid(_)
            | Action::Home(_)
            | Action::MachineMove(_)
            | Action::Across(_)
            | Action::Swivel(_) => moved(self, Kind::Rapid, &here),
            Action::Line(_) | Action::Thread(_) | Action::Probe(_) => {
                moved(self, Kind::Line, &here);
            }
            Action::Arc(to) => {
                let before = ResolvedPose { place: start.into(), ..here };
                let arc = arc::of_block(&self.gauge, &before, to);
                moved(self, arc.map_or(Kind::Line, |arc| Kind::Arc(Box::new(arc))), &here);
            }
            Action::Hole(position) => {
                for (kind, to) in self.in_hole(event.line, position, start) {
                    moved(self, kind, &to);
                }
            }
            Action::Tool(_) => motions.changed = true,
            Action::TouchOff(_)
            | Action::Arm(_)
            | Action::Dwell(_)
            | Action::Stop
            | Action::OptionalStop
            | Action::ThreadWire
            | Action::CutWire
            | Action::Output(_)
            | Action::Input(_)
            | Action::Auxiliary(_)
            | Action::WorkOffsetData(_)
            | Action::Feed(_)
            | Action::FeedPath(_)
            | Action::RapidsTogether(_)
            | Action::Spindle(_)
            | Action::SurfaceSpeed(_)
            | Action::Coolant(_)
            | Action::Preselect(_)
            | Action::LengthOffset(_)
            | Action::Compensation(_)
            | Action::WorkOffset(_)
            | Action::PathMode(_)
            | Action::Taper(_)
            | Action::Cycle(_)
            | Action::CycleOff
            | Action::Risk(_)
            | Action::Comment(_)
            | Action::Message(_)
            | Action::End => {}
        }
    }

    /// The moves of a canned cycle in a hole at `position`: across where the tool is above the R plane, down to that, and the
    /// moves of the cycle. Where the control draws the tool aside in the hole, the way is the one along the axis.
    fn in_hole(&self, line: u32, position: &Position, from: ToolPose) -> Vec<(Kind, ResolvedPose)> {
        let Some(cycle) = self.running.cycle else { return Vec::new() };
        let along = Drilled::along(&self.gauge, position);
        let at = |height: f64| {
            self.gauge
                .resolve(line, Position { point: position.point + along * height, ..*position })
        };
        let hole = at(0.0).place;
        let mut moves = Vec::new();
        let above = hole.above(from.tip).0;
        if above > cycle.clearance {
            moves.push((Kind::Rapid, at(above)));
        }
        moves.push((Kind::Rapid, at(cycle.clearance)));
        let pose = Pose::new(hole.tip, hole.axis);
        let lowered =
            pose.ok().and_then(|pose| lowering::hole(&cycle, &pose, self.running.spindle));
        let Some(lowered) = lowered else {
            moves.push((Kind::Line, at(-cycle.depth)));
            moves.push((Kind::Line, at(cycle.clearance)));
            moves.push((Kind::Rapid, at(cycle.retract)));
            return moves;
        };
        moves.extend(lowered.into_iter().filter_map(|part| match part {
            HoleMove::Rapid(pose) => Some((Kind::Rapid, at(hole.above(pose.point()).0))),
            HoleMove::Line(pose) => Some((Kind::Line, at(hole.above(pose.point()).0))),
            HoleMove::Dwell(_) | HoleMove::Spindle(_) => None,
        }));
        moves
    }

    /// Where the axes stand at a position to which they have turned.
    fn axis_positions(&self, position: &Position) -> AxisPositions {
        let machine = self.gauge.machine;
        if let Some(wire) = machine.wire {
            let lean = position.axis().and_then(|axis| wire.lean(axis));
            return AxisPositions::Wire {
                guide: position.point,
                lean: lean.map_or([f64::NAN; 2], Into::into),
            };
        }
        let unknown = [f64::NAN; 3];
        let [rotary] = self.standing.here() else {
            return AxisPositions::Mill { linear: Vec3::NAN, rotary: unknown };
        };
        let pose = self.gauge.machine_pose(position, *rotary);
        let linear = pose.map_or(Vec3::NAN, |pose| pose.linear);
        AxisPositions::Mill { linear, rotary: *rotary }
    }
}
