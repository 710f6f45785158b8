//! The motions of the program for whoever follows the proof.

use super::{Comparison, Standing, arc_through};
use crate::observer::{AxisPositions, Motion, MotionKind, ToolPose};
use control::{Action, ArmAction, ArmPath, Event};
use geom::{Frame, Vec3};

impl Comparison<'_> {
    /// Keeps the motions of each event until they are taken.
    pub(in super::super) fn keep_motions(&mut self) {
        self.motions = Some(Vec::new());
    }

    /// Takes the motions since the last time: several behind the last block of a contour.
    pub(in super::super) fn take_motions(&mut self, mut told: impl FnMut(&Motion)) {
        if let Some(motions) = &mut self.motions {
            motions.drain(..).for_each(|motion| told(&motion));
        }
    }

    /// Which record of the source is the next step; the one behind the last where there is none.
    fn record(&self) -> usize {
        let next = self.expected.get(self.next).map(|expected| expected.record);
        next.or_else(|| Some(self.expected.last()?.record + 1)).unwrap_or_default()
    }

    /// Behind an event that was accepted: the arm stood `before` it.
    pub(super) fn keep_motion(&mut self, event: &Event, before: Option<Standing>) {
        let Action::Arm(ArmAction::Move(motion)) = &event.action else { return };
        let (Some(_), Some(now)) = (&self.motions, &self.standing) else { return };
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
        let shown = self.arm.shown(&now.joints).unwrap_or([f64::NAN; 6]);
        let joints = shown.map(f64::to_degrees);
        let axes = AxisPositions::Arm { joints, rail: self.cell.rail.as_ref().map(|_| now.rail) };
        let record = self.made.unwrap_or_else(|| self.record());
        let source_line = self.source.records.get(record).map_or(0, |record| record.line);
        let (file, line) = (self.file.clone(), event.line);
        let motion = Motion { file, line, record, source_line, kind, tool: [start, end], axes };
        self.motions.iter_mut().for_each(|motions| motions.push(motion.clone()));
    }

    /// The tool in the frame of the source.
    fn tool_pose(&self, tool: &Frame) -> ToolPose {
        let tool = self.in_part(tool);
        ToolPose { tip: tool.translation, axis: -tool.matrix3.z_axis }
    }
}
