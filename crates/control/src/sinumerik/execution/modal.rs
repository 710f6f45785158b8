//! Holes, and what `MCALL` has after each block with a motion.

use super::interpreter::Interpreter;
use super::state::modal::{Drilling, Modal};
use crate::event::Action;
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use crate::sinumerik::language::statement::ProgramCall;
use geom::Vec3;
use program::{Cycle, Rule};

impl Interpreter<'_, '_> {
    pub fn cycle_off(&mut self, source: &Source) -> Outcome {
        if self.reported_cycle.take().is_some() {
            self.emit(source, Action::CycleOff)?;
        }
        Ok(())
    }

    /// What `MCALL` has after a block with a motion: a hole is drilled, a program is due.
    pub fn call_modal(&mut self, source: &Source) -> Outcome {
        match std::mem::replace(&mut self.state.modal, Modal::None) {
            Modal::Cycle(drilling) => {
                self.drill(source, &drilling)?;
                self.state.modal = Modal::Cycle(drilling);
            }
            Modal::Program(call) => self.state.modal = Modal::Due(call),
            other @ (Modal::None | Modal::Due(_) | Modal::Running) => self.state.modal = other,
        }
        Ok(())
    }

    /// `MCALL` of a program.
    pub fn set_modal_program(&mut self, source: &Source, call: ProgramCall) -> Outcome {
        self.may_change_modal(source)?;
        self.state.modal = Modal::Program(call);
        self.cycle_off(source)
    }

    pub fn may_change_modal(&self, source: &Source) -> Outcome {
        if let Modal::Running = self.state.modal {
            let message = "MCALL in a program that MCALL calls";
            return Err(source.block_error(Rule::Call, message));
        }
        Ok(())
    }

    pub fn drill(&mut self, source: &Source, drilling: &Drilling) -> Outcome {
        let state = &self.state;
        if state.plane_normal != 2 {
            let message = "drilling along X or Y (G18, G19) is not supported";
            return Err(source.block_error(Rule::Unsupported, message));
        }
        if !state.frames.moved_only() && state.frames.sense_about(2).is_none() {
            let message = "drilling in a frame that is scaled, or mirrored along the hole";
            return Err(source.block_error(Rule::Unsupported, message));
        }
        if state.position.x.is_nan() || state.position.y.is_nan() {
            let message = "the place of the hole is not known: no block has said X and Y";
            return Err(source.block_error(Rule::UnknownPosition, message));
        }
        self.lean_on_edge(source)?;
        if drilling.needs_feed {
            self.use_feed(source)?;
        }
        if let Some(spindle) = drilling.spindle_before {
            self.report_spindle(source, spindle)?;
        }
        let Some(dwell) = drilling.dwell.seconds(self.state.spindle) else {
            let message = "the dwell counts turns of a spindle that stands";
            return Err(source.block_error(Rule::Dwell, message));
        };
        let mut cycle = Cycle { dwell, ..drilling.cycle };
        if let Some(withdrawal) = cycle.kind.withdrawal() {
            let frames = &self.state.frames;
            let aside = frames.in_work_frame(withdrawal.aside) - frames.in_work_frame(Vec3::ZERO);
            cycle.kind = cycle.kind.with_aside(aside);
        }
        if self.reported_cycle != Some(cycle) {
            self.reported_cycle = Some(cycle);
            self.emit(source, Action::Cycle(cycle.into()))?;
        }
        self.state.position.z = drilling.surface;
        let pose = self.state.pose(self.state.position);
        self.state.position.z = drilling.surface + cycle.retract;
        self.state.programmed.z = self.state.position.z;
        self.emit(source, Action::Hole(pose))?;
        if let Some(spindle) = drilling.spindle_after {
            self.report_spindle(source, spindle)?;
        }
        Ok(())
    }
}
