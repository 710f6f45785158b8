//! The motions of the program for whoever follows the proof.

use super::*;
use crate::observer::{
    AxisPositions, Course, Deviation, Motion, MotionKind as Kind, Observer, Stated, ToolPose,
};
use machine::time;
use program::lowering::{self, HoleMove};
use program::{Cycle, CycleKind, Pose};

/// How long the motions take, and what whoever follows the proof is told of them.
#[derive(Default)]
pub(super) struct Motions {
    /// Whether they are told.
    told: bool,
    stated: Stated,
    /// Whether what holds may have changed since it was told.
    restated: bool,
    /// Waiting since the last motion, s.
    waited: f64,
    /// Where the axes stand.
    axes: Option<AxisPositions>,
    /// Where the event at hand begins.
    start: Option<ResolvedPose>,
    /// The arc that it makes.
    pub arc: Option<Arc>,
    /// Whether the tool has been changed since the last motion: where the machine has gone for that is its own.
    changed: bool,
    /// In which coordinates nobody knows where a tip is that the control keeps, behind a home that has moved it in others than those
    /// of its axes.
    adrift: [bool; 3],
    /// The record that it has made.
    made: Option<usize>,
    /// How far it is from the source.
    deviation: Option<Deviation>,
}

/// How a motion goes; an arc is that of [`Motions::arc`].
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Rapid,
    Line,
    Arc,
}

/// Z of the machine points along an axis of the part where its other parts are below this.
const LEVEL: f64 = 1e-9;

/// The axes that a block sends home, or to a position of the machine.
fn sent_home(action: &Action) -> Option<Axes> {
    if let Action::Home(axes) = action {
        Some(*axes)
    } else if let Action::MachineMove(to) = action {
        Some(to.axes())
    } else {
        None
    }
}

impl Motions {
    /// Where the tool is before the event at hand.
    #[inline]
    fn begins(&self, start: &ResolvedPose) -> ToolPose {
        let ToolPose { tip, axis } = self.told_pose(start);
        ToolPose { tip: if self.changed { Vec3::NAN } else { tip }, axis }
    }

    /// Where the tool is as far as it is known.
    #[inline]
    fn told_pose(&self, at: &ResolvedPose) -> ToolPose {
        let mut pose = ToolPose::from(at.place);
        if self.adrift != [false; 3] {
            for i in (0..3).filter(|i| self.adrift[*i]) {
                pose.tip[i] = f64::NAN;
            }
        }
        pose
    }
}

impl Prover<'_> {
    /// The motions of each event are told.
    pub(crate) fn tell_motions(&mut self) {
        (self.motions.told, self.motions.restated) = (true, true);
    }

    /// Before an event.
    #[inline]
    pub(super) fn begin_motion(&mut self) {
        let motions = &mut self.motions;
        (motions.start, motions.arc) = (Some(self.here), None);
        (motions.made, motions.deviation) = (None, None);
    }

    /// The event has been compared with the source: so far, mm and degrees, it is from it.
    #[inline]
    pub(super) fn has_compared(&mut self, apart: (f64, f64)) {
        Deviation::widen(&mut self.motions.deviation, apart);
    }

    /// The event makes the record at hand.
    #[inline]
    pub(super) fn has_arrived(&mut self) {
        self.motions.made = Some(self.cursor.record());
    }

    /// Behind an event that was accepted: counts what it takes, and tells its motions.
    pub(super) fn end_motion(&mut self, event: &Event, observer: &mut dyn Observer) {
        let motions = &mut self.motions;
        let way = match &event.action {
            Action::Rapid(_)
            | Action::Home(_)
            | Action::MachineMove(_)
            | Action::Across(_)
            | Action::Swivel(_) => Way::Rapid,
            Action::Line(_) | Action::Thread(_) | Action::Probe(_) => Way::Line,
            Action::Arc(_) if motions.arc.is_some() => Way::Arc,
            Action::Arc(_) => Way::Line,
            Action::Hole(position) => return self.end_hole(event, position, observer),
            Action::Tool(_) => {
                (motions.changed, motions.restated) = (true, true);
                motions.waited += time::TOOL_CHANGE;
                self.report.program.time_s.tool_change += time::TOOL_CHANGE;
                return;
            }
            Action::Dwell(seconds) => return self.waits(*seconds),
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
        let Some(start) = &motions.start else { return };
        let (from, before) = (motions.begins(start), start.position);
        let to = self.here;
        if to.place.known() {
            self.motions.adrift = [false; 3];
        } else if let Some(axes) = sent_home(&event.action) {
            let moved = self.moved_by(axes);
            self.motions.adrift = [0, 1, 2].map(|i| self.motions.adrift[i] || moved[i]);
        }
        self.end_one(event, way, (from, &before), &to, observer);
    }

    /// Counts what a motion takes from where the tool is, as the control has it before, and tells it.
    #[inline]
    fn end_one(
        &mut self,
        event: &Event,
        way: Way,
        (from, before): (ToolPose, &Position),
        to: &ResolvedPose,
        observer: &mut dyn Observer,
    ) {
        let (axes, end) = (self.axis_positions(&to.position), self.motions.told_pose(to));
        let tool = [from, end];
        let seconds = if let Action::Probe(probe) = &event.action {
            // Where it touches nobody knows: at its end at the latest.
            let last = self.gauge.resolve(event.line, probe.end);
            let axes = self.axis_positions(&last.position);
            self.seconds(event, way, [before, &last.position], &[from, last.place.into()], &axes)
        } else {
            self.seconds(event, way, [before, &to.position], &tool, &axes)
        };
        let time = &mut self.report.program.time_s;
        match way {
            Way::Rapid => time.rapid += seconds,
            Way::Line | Way::Arc => time.cutting += seconds,
        }
        if self.motions.told {
            let course = self.course(way, &to.position);
            self.tell(event, (way, course), tool, (axes, seconds), observer);
        }
        self.motions.axes = Some(axes);
        (self.motions.changed, self.motions.waited) = (false, 0.0);
    }

    /// Tells a motion.
    #[inline]
    fn tell(
        &mut self,
        event: &Event,
        (way, course): (Way, Course),
        tool: [ToolPose; 2],
        (axes, seconds): (AxisPositions, f64),
        observer: &mut dyn Observer,
    ) {
        if std::mem::take(&mut self.motions.restated)
            && let Some(state) = self.motions.stated.news(self.running.state())
        {
            observer.stated(state);
        }
        let motions = &self.motions;
        let kind = match (way, motions.arc) {
            (Way::Rapid, _) => Kind::Rapid,
            (Way::Arc, Some(arc)) => Kind::Arc(Box::new(arc)),
            (Way::Line | Way::Arc, _) => Kind::Line,
        };
        let record = motions.made.unwrap_or_else(|| self.cursor.record());
        observer.moved(&Motion {
            file: None,
            line: event.line,
            record,
            source_line: self.source.records.get(record).map_or(0, |record| record.line),
            kind,
            course,
            tool,
            axes,
            feed: if way == Way::Rapid { self.running.feed } else { self.feed(event) },
            seconds,
            waited: motions.waited,
            deviation: motions.deviation,
        });
    }

    /// How the axes go in a motion to a position.
    #[inline]
    fn course(&self, way: Way, to: &Position) -> Course {
        let gauge = &self.gauge;
        match to.orientation {
            _ if gauge.machine.wire.is_some() => Course::Tool,
            _ if way == Way::Rapid && !gauge.straight_rapids => Course::EachAxis,
            Orientation::Axis(_) => Course::Tool,
            // An arc is one of the tip, whatever turns beside it.
            Orientation::Rotary { tool_center: false, .. } if way != Way::Arc => Course::Axes,
            Orientation::Rotary { .. } => Course::Tip,
        }
    }

    /// The machine waits so many seconds.
    fn waits(&mut self, seconds: f64) {
        self.motions.waited += seconds;
        self.report.program.time_s.dwell += seconds;
    }

    /// The motions of a canned cycle in a hole.
    fn end_hole(&mut self, event: &Event, position: &Position, observer: &mut dyn Observer) {
        let Some(start) = self.motions.start else { return };
        let (mut from, mut before) = (self.motions.begins(&start), start.position);
        let (moves, waited) = self.in_hole(event.line, position, start.place.into());
        for (way, to) in moves {
            self.end_one(event, way, (from, &before), &to, observer);
            (from, before) = (to.place.into(), to.position);
        }
        self.waits(waited);
    }

    /// The moves of a canned cycle in a hole at `position`: across where the tool is above the R plane, down to that, and the
    /// moves of the cycle; and how long it dwells, s. Where the control draws the tool aside in the hole, the way is the one along the
    /// axis.
    fn in_hole(
        &self,
        line: u32,
        position: &Position,
        from: ToolPose,
    ) -> (Vec<(Way, ResolvedPose)>, f64) {
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
            moves.push((Way::Rapid, at(above)));
        }
        moves.push((Way::Rapid, at(cycle.clearance)));
        let pose = Pose::new(hole.tip, hole.axis);
        let lowered =
            pose.ok().and_then(|pose| lowering::hole(&cycle, &pose, self.running.spindle));
        let Some(lowered) = lowered else {
            moves.push((Way::Line, at(-cycle.depth)));
            moves.push((Way::Line, at(cycle.clearance)));
            moves.push((Way::Rapid, at(cycle.retract)));
            return (moves, cycle.dwell);
        };
        let mut waited = 0.0;
        for part in lowered {
            match part {
                HoleMove::Rapid(pose) => moves.push((Way::Rapid, at(hole.above(pose.point()).0))),
                HoleMove::Line(pose) => moves.push((Way::Line, at(hole.above(pose.point()).0))),
                HoleMove::Dwell(seconds) => waited += seconds,
                HoleMove::Spindle(_) => {}
            }
        }
        (moves, waited)
    }

    /// In which coordinates of a block the tool moves where these linear axes of the machine do: in others than theirs where the control
    /// keeps the tip on a table that is turned.
    fn moved_by(&mut self, axes: Axes) -> [bool; 3] {
        let own = [0, 1, 2].map(|i| axes.contains(Axes::linear(i)));
        let here = self.here;
        let keeps_tip =
            matches!(here.position.orientation, Orientation::Rotary { tool_center: true, .. });
        if !keeps_tip || own == [false; 3] {
            return own;
        }
        let ups = self.ups(&here);
        let goes_along = |i: usize| ups.iter().any(|up| up[i].abs() > LEVEL);
        let is_level = !ups.is_empty() && !goes_along(0) && !goes_along(1);
        if is_level {
            own
        } else if ups.is_empty() || own[0] || own[1] {
            [true; 3]
        } else {
            [0, 1, 2].map(goes_along)
        }
    }

    /// How long a motion takes, s, in which the axes go from where they stand to `axes`.
    #[inline]
    fn seconds(
        &self,
        event: &Event,
        way: Way,
        [before, to]: [&Position; 2],
        [from, end]: &[ToolPose; 2],
        axes: &AxisPositions,
    ) -> f64 {
        let (machine, running) = (self.gauge.machine, &self.running);
        let (mut linear, turn) = match (&self.motions.axes, axes) {
            (
                Some(AxisPositions::Mill { linear: a, rotary: from }),
                AxisPositions::Mill { linear: b, rotary: to },
            ) => (*b - *a, [to[0] - from[0], to[1] - from[1], to[2] - from[2]]),
            _ => (Vec3::NAN, [0.0; 3]),
        };
        // Where nobody says how the rotary axes carry the tip, it goes its own way.
        if linear.is_nan() {
            linear = Vec3::select(linear.is_nan_mask(), end.tip - from.tip, linear);
        }
        let length = match (way, &self.motions.arc) {
            (Way::Rapid, _) => return time::rapid(machine, linear, turn),
            (Way::Arc, Some(arc)) => arc.length(),
            _ if matches!(event.action, Action::Hole(_)) => from.tip.distance(end.tip),
            _ if running.feed_path.is_of_tip(before, to) => before.point.distance(to.point),
            _ => {
                let counted = running.feed_path.length(before, to);
                counted.unwrap_or_else(|| from.tip.distance(end.tip))
            }
        };
        let at_feed = match self.feed(event) {
            Some(Feed::PerMinute(feed)) => 60.0 * length / feed,
            Some(Feed::PerTurn(feed)) => 60.0 * length / (feed * state::speed(running.spindle)),
            Some(Feed::InverseTime(rate)) => 60.0 / rate,
            None => 0.0,
        };
        time::cut(machine, linear, turn, at_feed)
    }

    /// The feed of a cut: of a thread in step with the spindle its pitch at the speed of that.
    fn feed(&self, event: &Event) -> Option<Feed> {
        let running = &self.running;
        let in_step = |pitch: f64| Some(Feed::PerMinute(pitch * state::speed(running.spindle)));
        match (&event.action, &running.cycle) {
            (Action::Thread(thread), _) => in_step(thread.pitch),
            (Action::Hole(_), Some(Cycle { kind: CycleKind::Tap { pitch, .. }, .. })) => {
                in_step(*pitch)
            }
            (Action::Hole(_), Some(cycle)) => cycle.feed.or(running.feed),
            (_, _) => running.feed,
        }
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
