//! The modes that LinuxCNC keeps and brings back: `M70` to `M73`.

use super::frame::Modes;
use super::run::Run;
use crate::iso::execution::state::Length;
use crate::iso::language::Fault;
use crate::iso::language::words::{G, Group, M, Side};
use program::{Compensation, Coolant, Rule, Spindle};

impl Run<'_, '_> {
    /// `M70` to `M73`.
    pub(super) fn modes(&mut self) -> Result<(), Fault> {
        match self.block.m(Group::Modes) {
            Some(M::SaveModes { until_return }) => {
                self.frame().modes = Some(Modes::of(&self.control.state, until_return));
            }
            Some(M::ForgetModes) => self.frame().modes = None,
            Some(M::RestoreModes) => match self.frame().modes {
                Some(modes) => self.restore(&modes)?,
                None => {
                    let message = "M72, and no M70 or M73 has kept the modes";
                    return Err(self.block.at_group(Group::Modes, Rule::Modes, message));
                }
            },
            _ => {}
        }
        Ok(())
    }

    /// The modes become what they were, as by words in two blocks: the modes first, then the numbers
    /// in their units.
    pub(super) fn restore(&mut self, kept: &Modes) -> Result<(), Fault> {
        let (line, text) = (self.block.line, self.block.text);
        let now = Modes::of(&self.control.state, kept.until_return);
        let lost = match () {
            _ if now.compensation != kept.compensation
                && kept.compensation != Compensation::Off =>
            {
                Some("radius compensation")
            }
            _ if now.length != kept.length && kept.length != Length::None => {
                Some("the length offset")
            }
            _ if now.surface != kept.surface => Some("the spindle mode (G96, G97)"),
            _ => None,
        };
        if let Some(lost) = lost {
            let message = format!("{lost} has changed since it was kept, and is not brought back");
            return Err(self.block.whole(Rule::Modes, message));
        }
        self.block.clear(line, text);
        let block = &mut self.block;
        if let Some(inches) = kept.inches {
            block.put_g(Group::Units, G::Inches(inches));
        }
        block.put_g(Group::Plane, G::Plane(kept.plane));
        block.put_g(Group::Distance, G::Incremental(kept.incremental));
        block.put_g(Group::ArcDistance, G::CentersAbsolute(kept.centers_absolute));
        block.put_g(Group::FeedMode, G::FeedMode(kept.feed_mode));
        if let Some(to_r) = kept.return_to_r {
            block.put_g(Group::Return, G::ReturnToR(to_r));
        }
        if now.work_offset != kept.work_offset {
            block.put_g(Group::WorkOffset, G::WorkOffset(kept.work_offset));
        }
        if now.compensation != kept.compensation {
            block.put_g(Group::Compensation, G::Compensation(Side::Off));
        }
        if now.length != kept.length {
            block.put_g(Group::Length, G::CancelLength);
        }
        self.control.execute(&mut self.block, &mut self.actions)?;
        // What had not been said then is not said by coming back.
        self.control.state.sure = kept.sure;
        self.control.state.frames.unsaid = kept.unsaid;
        self.block.clear(line, text);
        let block = &mut self.block;
        if let Some(f) = kept.f {
            block.put(b'F', f);
        }
        if let Some(speed) = kept.speed {
            block.put(b'S', speed);
        }
        block.put_m(
            Group::Spindle,
            match kept.spindle {
                Spindle::Off => M::SpindleOff,
                Spindle::Clockwise(_) => M::Clockwise,
                Spindle::CounterClockwise(_) => M::CounterClockwise,
            },
        );
        block.put_m(
            Group::Coolant,
            match kept.coolant {
                Coolant::Mist => M::Mist,
                Coolant::Flood | Coolant::FloodAndMist => M::Flood,
                Coolant::Through => M::Through,
                Coolant::Off => M::CoolantOff,
            },
        );
        self.control.execute(&mut self.block, &mut self.actions)
    }
}
