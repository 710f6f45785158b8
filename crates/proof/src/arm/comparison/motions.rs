//! The motions of the program for whoever follows the proof.

use super::super::follow::angle;
use super::{Comparison, Running, Standing, arc_through};
use crate::observer::{
    AxisPositions, Course, MachineState, Motion, MotionKind, Observer, SpindleState, ToolPose, Walk,
};
use control::{Action, ArmAction, ArmPath, Event};
use geom::{Frame, Vec3};
use machine::time;
use program::{Compensation, Coolant, Feed, PathMode, Tool};

impl Comparison<'_> {
    /// Keeps the motions of each event until they are taken.
    pub(in super::super) fn keep_motions(&mut self) {
        self.motions = Some(Walk::default());
    }

    /// Tells the motions since the last time: several behind the last block of a contour.
    pub(in super::super) fn tell_motions(&mut self, observer: &mut dyn Observer) {
        if let Some(motions) = &mut self.motions {
            motions.tell(observer);
        }
    }

    /// Which record of the source is the next step; the one behind the last where there is none.
    fn record(&self) -> usize {
        let next = self.expected.get(self.next).map(|expected| expected.record);
        next.or_else(|| Some(self.expected.last()?.record + 1)).unwrap_or_default()
    }

    /// Behind an event that was accepted, the arm stood `before` it: counts what it takes, and keeps its motion.
    pub(super) fn keep_motion(&mut self, event: &Event, before: Option<Standing>) {
        let times = &mut self.report.program.time_s;
        if let Action::Dwell(seconds) = &event.action {
            times.dwell += seconds;
            self.keep_wait(*seconds);
        } else if matches!(event.action, Action::Tool(_)) {
            times.tool_change += time::TOOL_CHANGE;
            self.keep_wait(time::TOOL_CHANGE);
        }
        let Action::Arm(ArmAction::Move(motion)) = &event.action else { return };
        let Some(now) = &self.standing else { return };
        let unknown = ToolPose { tip: Vec3::NAN, axis: Vec3::NAN };
        let start = before.map_or(unknown, |before| self.tool_pose(&before.tool));
        let end = self.tool_pose(&now.tool);
        let kind = match &motion.path {
            ArmPath::Joints(_) | ArmPath::Point(_) => MotionKind::Joints,
            ArmPath::Line(_) => MotionKind::Line,
            ArmPath::Arc { via, .. } => {
                let via = self.in_part(via).translation;
                arc_through([start.tip, via, end.tip])
                    .map_or(MotionKind::Line, |arc| MotionKind::Arc(Box::new(arc)))
            }
        };
        let seconds = self.seconds(&kind, before.as_ref(), [start, end]);
        let times = &mut self.report.program.time_s;
        *(if self.is_cut { &mut times.cutting } else { &mut times.rapid }) += seconds;
        if self.motions.is_none() {
            return;
        }
        let shown = self.arm.shown(&now.joints).unwrap_or([f64::NAN; 6]);
        let joints = shown.map(f64::to_degrees);
        let rail = self.cell.rail.as_ref().map(|_| now.rail);
        let record = self.made.unwrap_or_else(|| self.record());
        let motion = Motion {
            file: self.file.clone(),
            line: event.line,
            record,
            source_line: self.source.records.get(record).map_or(0, |record| record.line),
            course: if kind == MotionKind::Joints { Course::Axes } else { Course::Tool },
            kind,
            tool: [start, end],
            axes: AxisPositions::Arm { joints, rail },
            feed: self.running.feed.map(Feed::PerMinute),
            seconds,
            waited: 0.0,
            deviation: self.deviation.filter(|_| !self.follows_contour),
        };
        let state = self.state();
        if let Some(motions) = &mut self.motions {
            motions.state(state);
            motions.moved(motion);
        }
    }

    /// The arm waits so many seconds before its next motion.
    fn keep_wait(&mut self, seconds: f64) {
        if let Some(motions) = &mut self.motions {
            motions.waited += seconds;
        }
    }

    /// How long a motion takes, s: of the joints as the slowest, at the part of its speed that the program has set.
    fn seconds(&self, kind: &MotionKind, before: Option<&Standing>, tool: [ToolPose; 2]) -> f64 {
        let length = match kind {
            MotionKind::Rapid | MotionKind::Joints => {
                let (Some(before), Some(now)) = (before, &self.standing) else { return 0.0 };
                let part = self.running.joint_speed.unwrap_or(100.0) / 100.0;
                let turns = before.joints.iter().zip(now.joints).zip(self.arm.joints());
                let turns = turns.map(|((a, b), joint)| (b - a).abs() / (part * joint.speed));
                let rail =
                    self.running.rail_speed.map(|speed| (now.rail - before.rail).abs() / speed);
                return turns.chain(rail).fold(0.0, f64::max);
            }
            MotionKind::Line => tool[0].tip.distance(tool[1].tip),
            MotionKind::Arc(arc) => arc.length(),
        };
        let turn = before
            .zip(self.standing.as_ref())
            .map_or(0.0, |(before, now)| angle(&before.tool.matrix3, &now.tool.matrix3));
        // A way or a feed that is not known takes nothing.
        let at_feed = self.running.feed.map_or(0.0, |feed| (60.0 * length / feed).max(0.0));
        at_feed.max(self.turning_time(turn))
    }

    /// What holds while the arm moves.
    fn state(&self) -> MachineState {
        let Running { is_on, speed, coolant, joint_speed, .. } = self.running;
        let tool = self.changes.held.map(|number| Tool { number, ..Tool::default() });
        MachineState {
            spindle: match is_on {
                true => SpindleState::On(speed),
                false => SpindleState::Off,
            },
            surface_speed: None,
            coolant: if coolant { Coolant::Flood } else { Coolant::Off },
            tool,
            compensation: Compensation::Off,
            length_offset: None,
            work_offset: None,
            cycle: None,
            path: PathMode::AsSetUp,
            taper: 0.0,
            joint_speed,
        }
    }

    /// The tool in the frame of the source.
    fn tool_pose(&self, tool: &Frame) -> ToolPose {
        let tool = self.in_part(tool);
        ToolPose { tip: tool.translation, axis: -tool.matrix3.z_axis }
    }
}
