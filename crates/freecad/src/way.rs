//! The way from hole to hole, which the cycle goes by itself.
//!
//! Between two holes of one cycle FreeCAD goes by rapid to the place over the next one. A control does
//! that without being told, and its cycle stays on. So does the neutral program.

use geom::Vec3;
use program::{Cycle, Op, Pose, Record};

/// What of the records on their way is held back: those between two holes.
#[derive(Debug, Default)]
pub(crate) struct Way {
    /// Where the tool is, as far as the last record says it.
    here: Option<Pose>,
    /// The cycle that is on.
    cycle: Option<Cycle>,
    /// The cycle has been switched off over this place, and nothing but the way to the next has followed.
    left: Option<Vec3>,
    held: Vec<Record>,
}

impl Way {
    /// Puts the next record to `records`.
    pub(crate) fn push(&mut self, records: &mut Vec<Record>, record: Record) {
        match &record.op {
            // To where it is.
            Op::Rapid(pose) if self.here == Some(*pose) => return,
            Op::CycleOff if self.here.is_some() && self.held.is_empty() => {
                self.left = self.here.map(|here| here.point());
                self.held.push(record);
                return;
            }
            Op::Rapid(pose) if self.left.is_some_and(|left| left.z == pose.point().z) => {
                self.here = Some(*pose);
                self.held.push(record);
                return;
            }
            Op::Cycle(cycle) if self.left.is_some() && self.cycle == Some(**cycle) => {
                self.held.push(record);
                return;
            }
            Op::Hole(pose) if self.goes_to(pose) => self.held.clear(),
            _ => {}
        }
        self.end(records);
        match &record.op {
            Op::Cycle(cycle) => self.cycle = Some(**cycle),
            Op::Hole(pose) => {
                let over = self
                    .cycle
                    .and_then(|cycle| pose.at(pose.point() + Vec3::Z * cycle.retract).ok());
                let upright = pose.axis() == Vec3::Z;
                self.here = over.filter(|_| upright);
            }
            Op::Tool(_) | Op::Home | Op::WorkOffset(_) | Op::Probe(_) => self.here = None,
            op => self.here = op.pose().copied().or(self.here),
        }
        records.push(record);
    }

    /// Whether what is held back leads to the place over the hole `to`, and the same cycle drills it.
    fn goes_to(&self, to: &Pose) -> bool {
        let (Some(left), Some(cycle)) = (self.left, self.cycle) else { return false };
        let over = to.point() + Vec3::Z * cycle.retract;
        let same = self.held.iter().any(|record| matches!(record.op, Op::Cycle(_)));
        let mut stops = self.held.iter().filter_map(|record| record.op.pose());
        same && over.z == left.z && stops.all(|stop| stop.point() == over)
    }

    /// What has been held back goes on: something else follows.
    pub(crate) fn end(&mut self, records: &mut Vec<Record>) {
        records.append(&mut self.held);
        self.left = None;
    }
}
