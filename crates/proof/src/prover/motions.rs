//! The motions of the program for whoever follows the proof.

use super::*;
use crate::observer::{
    AxisPositions, Deviation, Motion, MotionKind as Kind, Observer, Stated, ToolPose,
};
use machine::time;
use program::lowering::{self, HoleMove};
use program::{Cycle, CycleKind, Pose};

/// What whoever follows the proof is told of its motions.
#[derive(Default)]
pub(super) struct Motions {
    stated: Stated,
    /// Whether what holds may have changed since it was told.
    restated: bool,
    /// Waiting since the last motion, s.
    waited: f64,
    /// Where the axes stand.
    axes: Option<AxisPositions>,
    /// Where the event at hand begins.
    start: Option<ResolvedPose>,
    /// Whether the tool has been changed since the last motion: where the machine has gone for that is its own.
    changed: bool,
    /// The record that it has made.
    made: Option<usize>,
    /// How far it is from the source.
    deviation: Option<Deviation>,
}

impl Motions {
    /// Where the tool is before the event at hand.
    #[inline]
    fn begins(&self, start: &ResolvedPose) -> ToolPose {
        let ToolPose { tip, axis } = start.place.into();
        ToolPose { tip: if self.changed { Vec3::NAN } else { tip }, axis }
    }
}

impl Prover<'_> {
    /// The motions of each event are told.
    pub(crate) fn tell_motions(&mut self) {
        self.motions = Some(Motions { restated: true, ..Motions::default() });
    }

    /// Before an event.
    #[inline]
    pub(super) fn begin_motion(&mut self) {
        if let Some(motions) = &mut self.motions {
            (motions.start, motions.made, motions.deviation) = (Some(self.here), None, None);
        }
    }

    /// The event has been compared with the source: so far, mm and degrees, it is from it.
    #[inline]
    pub(super) fn has_compared(&mut self, apart: (f64, f64)) {
        if let Some(motions) = &mut self.motions {
            Deviation::widen(&mut motions.deviation, apart);
        }
    }

    /// The event makes the record at hand.
    #[inline]
    pub(super) fn has_arrived(&mut self) {
        if let Some(motions) = &mut self.motions {
            motions.made = Some(self.cursor.record());
        }
    }

    /// Behind an event that was accepted: tells its motions.
    pub(super) fn end_motion(&mut self, event: &Event, observer: &mut dyn Observer) {
        let Some(motions) = &mut self.motions else { return };
        let kind = match &event.action {
            Action::Rapid(_)
            | Action::Home(_)
            | Action::MachineMove(_)
            | Action::Across(_)
            | Action::Swivel(_) => Kind::Rapid,
            Action::Line(_) | Action::Thread(_) | Action::Probe(_) => Kind::Line,
            Action::Arc(to) => {
                let arc = motions.start.and_then(|start| arc::of_block(&self.gauge, &start, to));
                arc.map_or(Kind::Line, |arc| Kind::Arc(Box::new(arc)))
            }
            Action::Hole(position) => return self.tell_hole(event, position, observer),
            Action::Tool(_) => {
                (motions.changed, motions.restated) = (true, true);
                motions.waited += time::TOOL_CHANGE;
                return;
            }
            Action::Dwell(seconds) => {
                motions.waited += seconds;
                return;
            }
            Action::Spindle(_)
            | Action::SurfaceSpeed(_)
            | Action::Coolant(_)
            | Action::LengthOffset(_)
            | Action::Compensation(_)
            | Action::WorkOffset(_)
            | Action::PathMode(_)
            | Action::Taper(_)
            | Action::Cycle(_)
            | Action::CycleOff => {
                motions.restated = true;
                return;
            }
            Action::TouchOff(_)
            | Action::Arm(_)
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
            | Action::Preselect(_)
            | Action::Risk(_)
            | Action::Comment(_)
            | Action::Message(_)
            | Action::End => return,
        };
        self.tell_state(observer);
        let Some(motions @ Motions { start: Some(start), .. }) = &self.motions else { return };
        let from = motions.begins(start);
        let motion = self.motion_of(event, kind, (from, &start.position), &self.here, motions);
        observer.moved(&motion);
        self.has_told(motion.axes);
    }

    /// Tells what holds from here on, where it has changed.
    fn tell_state(&mut self, observer: &mut dyn Observer) {
        if let Some(motions) = &mut self.motions
            && std::mem::take(&mut motions.restated)
            && let Some(state) = motions.stated.news(self.running.state())
        {
            observer.stated(state);
        }
    }

    /// A motion has been told, behind which the axes stand there.
    #[inline]
    fn has_told(&mut self, axes: AxisPositions) {
        if let Some(motions) = &mut self.motions {
            (motions.axes, motions.changed, motions.waited) = (Some(axes), false, 0.0);
        }
    }

    /// A motion of the event from where the tool is, as the control has it before.
    #[inline(always)]
    fn motion_of(
        &self,
        event: &Event,
        kind: Kind,
        (from, before): (ToolPose, &Position),
        to: &ResolvedPose,
        motions: &Motions,
    ) -> Motion {
        let (axes, end) = (self.axis_positions(&to.position), ToolPose::from(to.place));
        let record = motions.made.unwrap_or_else(|| self.cursor.record());
        let (ends, stand) = ([before, &to.position], [motions.axes.as_ref(), Some(&axes)]);
        let seconds = self.seconds(event, &kind, ends, [&from, &end], stand);
        Motion {
            file: None,
            line: event.line,
            record,
            source_line: self.source.records.get(record).map_or(0, |record| record.line),
            kind,
            tool: [from, end],
            axes,
            feed: self.running.feed,
            seconds,
            waited: motions.waited,
            deviation: motions.deviation,
        }
    }

    /// Tells the motions of a canned cycle in a hole.
    fn tell_hole(&mut self, event: &Event, position: &Position, observer: &mut dyn Observer) {
        self.tell_state(observer);
        let Some(motions @ Motions { start: Some(start), .. }) = &self.motions else { return };
        let (mut from, mut before) = (motions.begins(start), start.position);
        let (moves, waited) = self.in_hole(event.line, position, start.place.into());
        for (kind, to) in moves {
            let Some(motions) = &self.motions else { return };
            let motion = self.motion_of(event, kind, (from, &before), &to, motions);
            observer.moved(&motion);
            self.has_told(motion.axes);
            (from, before) = (to.place.into(), to.position);
        }
        if let Some(motions) = &mut self.motions {
            motions.waited += waited;
        }
    }

    /// The moves of a canned cycle in a hole at `position`: across where the tool is above the R plane, down to that, and the
    /// moves of the cycle; and how long it dwells, s. Where the control draws the tool aside in the hole, the way is the one along the
    /// axis.
    fn in_hole(
        &self,
        line: u32,
        position: &Position,
        from: ToolPose,
    ) -> (Vec<(Kind, ResolvedPose)>, f64) {
        let Some(cycle) = self.running.cycle else { return Default::default() };
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
            return (moves, cycle.dwell);
        };
        let mut waited = 0.0;
        for part in lowered {
            match part {
                HoleMove::Rapid(pose) => moves.push((Kind::Rapid, at(hole.above(pose.point()).0))),
                HoleMove::Line(pose) => moves.push((Kind::Line, at(hole.above(pose.point()).0))),
                HoleMove::Dwell(seconds) => waited += seconds,
                HoleMove::Spindle(_) => {}
            }
        }
        (moves, waited)
    }

    /// How long a motion takes, s, in which the axes go from where they stand to where they go.
    #[inline]
    fn seconds(
        &self,
        event: &Event,
        kind: &Kind,
        [before, to]: [&Position; 2],
        [from, end]: [&ToolPose; 2],
        stand: [Option<&AxisPositions>; 2],
    ) -> f64 {
        let (machine, running) = (self.gauge.machine, &self.running);
        let (mut way, turn) = match stand {
            [
                Some(AxisPositions::Mill { linear: a, rotary: from }),
                Some(AxisPositions::Mill { linear: b, rotary: to }),
            ] => (*b - *a, [to[0] - from[0], to[1] - from[1], to[2] - from[2]]),
            _ => (Vec3::NAN, [0.0; 3]),
        };
        // Where nobody says how the rotary axes carry the tip, it goes its own way.
        if way.is_nan() {
            way = Vec3::select(way.is_nan_mask(), end.tip - from.tip, way);
        }
        let length = match kind {
            Kind::Rapid | Kind::Joints => return time::rapid(machine, way, turn),
            Kind::Arc(arc) => arc.length(),
            Kind::Line if matches!(event.action, Action::Hole(_)) => from.tip.distance(end.tip),
            Kind::Line if running.feed_path.is_of_tip(before, to) => {
                before.point.distance(to.point)
            }
            Kind::Line => {
                let counted = running.feed_path.length(before, to);
                counted.unwrap_or_else(|| from.tip.distance(end.tip))
            }
        };
        let feed = match (&event.action, &running.cycle) {
            (Action::Thread(thread), _) => Some(Feed::PerTurn(thread.pitch)),
            (Action::Hole(_), Some(Cycle { kind: CycleKind::Tap { pitch, .. }, .. })) => {
                Some(Feed::PerTurn(*pitch))
            }
            (Action::Hole(_), Some(cycle)) => cycle.feed.or(running.feed),
            (_, _) => running.feed,
        };
        let at_feed = match feed {
            Some(Feed::PerMinute(feed)) => 60.0 * length / feed,
            Some(Feed::PerTurn(feed)) => 60.0 * length / (feed * state::speed(running.spindle)),
            Some(Feed::InverseTime(rate)) => 60.0 / rate,
            None => 0.0,
        };
        time::cut(machine, way, turn, at_feed)
    }

    /// Where the axes stand at a position to which they have turned.
    #[inline]
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
