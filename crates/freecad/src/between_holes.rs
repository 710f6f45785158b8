//! Moves from hole to hole, which the cycle makes by itself.
//!
//! Between two holes of one cycle FreeCAD writes a rapid to the point above the next one. The cycle of a control makes this
//! move by itself and stays on. So does the cycle of the neutral program.

use geom::Vec3;
use program::{Cycle, Op, Pose, Record};

/// Holds back the records between two holes until it is known whether the cycle goes on.
#[derive(Debug, Default)]
pub(crate) struct BetweenHoles {
    /// The position of the tool, where the last record determines it.
    here: Option<Pose>,
    /// The cycle that is on.
    cycle: Option<Cycle>,
    /// The cycle has been switched off above this point, and only moves to the next hole have followed.
    left: Option<Vec3>,
    held: Vec<Record>,
}

impl BetweenHoles {
    /// Adds the next record to `records`.
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

    /// Whether the held records lead to the point above the hole `to`, and the same cycle drills it.
    fn goes_to(&self, to: &Pose) -> bool {
        let (Some(left), Some(cycle)) = (self.left, self.cycle) else { return false };
        let over = to.point() + Vec3::Z * cycle.retract;
        let same = self.held.iter().any(|record| matches!(record.op, Op::Cycle(_)));
        let mut stops = self.held.iter().filter_map(|record| record.op.pose());
        same && over.z == left.z && stops.all(|stop| stop.point() == over)
    }

    /// Adds the held records: something else follows.
    pub(crate) fn end(&mut self, records: &mut Vec<Record>) {
        records.append(&mut self.held);
        self.left = None;
    }
}
