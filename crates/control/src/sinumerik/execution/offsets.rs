//! The settable work offsets (`G54` and on): what is known of their values.

use super::interpreter::Interpreter;
use super::state::{Modes, place};
use crate::event::Action;
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use geom::Vec3;
use program::{Compensation, Rule, WorkOffset};

impl Interpreter<'_, '_> {
    /// Activates a settable work offset. Where the values of the old and the new one are known, so is
    /// where the tool is in the new one.
    pub fn work_offset(&mut self, source: &Source, number: u32) -> Outcome {
        let state = &mut self.state;
        let value = state.work_offsets.get(number);
        let changed = (0..3).any(|i| !(value[i] == state.active_offset[i] || value[i].is_nan()));
        let other = number != state.work_offset;
        if !other && !changed {
            return Ok(());
        }
        let before = state.work_offsets.first(state.work_offset).unwrap_or(state.active_offset);
        let machine = state.frames.in_work_frame(state.position) + before;
        let first = state.work_offsets.first(number).unwrap_or(value);
        if (0..3).any(|i| first[i].is_nan() && !value[i].is_nan()) {
            let message = format!(
                "work offset {number} has been moved in with a value that is not known, and is now \
                 changed"
            );
            let mut error = source.block_error(Rule::WorkOffset, message);
            error.help = "write its value before the first move in it".into();
            return Err(error);
        }
        let change = Vec3::from_array(std::array::from_fn(|i| {
            if first[i].is_nan() { 0.0 } else { value[i] - first[i] }
        }));
        state.work_offset = number;
        state.active_offset = value;
        state.moved = false;
        state.frames.set_offset_change(change);
        state.position = state.frames.in_program(machine - first);
        for i in 0..3 {
            if state.position[i].is_nan() {
                state.programmed[i] = f64::NAN;
            }
        }
        match WorkOffset::numbered(place(number)).filter(|_| other) {
            Some(offset) => self.emit(source, Action::WorkOffset(offset)),
            None => Ok(()),
        }
    }

    /// Back to the modal commands and the frame of the caller of a program with `SAVE`.
    pub fn restore(&mut self, source: &Source, modes: Modes) -> Outcome {
        self.release(source)?;
        let state = &mut self.state;
        let frame = (state.frames.programmable(), state.frames.fine()) != modes.programmable;
        if state.compensation_in_effect != Compensation::Off
            && (frame
                || modes.plane_normal != state.plane_normal
                || (modes.corner, modes.goes_around) != (state.corner, state.goes_around))
        {
            let message = "the return of a program with SAVE changes frame, plane or corners while \
                           cutter radius compensation is active";
            return Err(source.block_error(Rule::Compensation, message));
        }
        if modes.feed_type != state.feed_type || modes.units.1 != state.feed_unit {
            state.feed = None;
        }
        (state.said, state.sure) = (modes.said, modes.sure);
        state.motion = modes.motion;
        state.select_plane(modes.plane_normal);
        (state.unit, state.feed_unit) = modes.units;
        state.absolute = modes.absolute;
        state.diameter = modes.diameter;
        state.feed_type = modes.feed_type;
        state.vectors_in_work_frame = modes.vectors_in_work_frame;
        state.turning = modes.turning;
        state.smoothed = state.smoothed.with_modes_of(modes.smoothed);
        state.rapids_together = modes.rapids_together;
        (state.corner, state.goes_around) = (modes.corner, modes.goes_around);
        state.compensation = modes.compensation;
        if frame {
            let (frame, fine) = modes.programmable;
            state.change_frames(|frames| frames.set_programmable(frame, fine));
        }
        self.report_rapids(source)?;
        // With the same G command the offset stays as it is now.
        if modes.work_offset == self.state.work_offset {
            return Ok(());
        }
        self.work_offset(source, modes.work_offset)
    }
}
