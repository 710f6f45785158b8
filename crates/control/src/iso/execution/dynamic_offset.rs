//! The work zero that turns with the table: Haas `G254`, "Dynamic Work Offset" (`docs/controls/haas.md`).
//!
//! The control has measured where the table turns, and carries the zero of the active work offset along with it. X, Y and
//! Z count along the axes of the machine from where the table has brought the zero.

use super::state::{Length, UNKNOWN};
use super::step::Step;
use crate::TableAxis;
use crate::iso::language::Fault;
use crate::iso::language::words::{G, Group};
use geom::{Vec3, rotate};
use program::{Rule, WorkOffset};

/// What may not happen while the zero is carried along, by the group of its word.
const NOT_UNDER_IT: [(Group, &str); 4] = [
    (Group::WorkOffset, "another work offset"),
    (Group::Tilt, "turned coordinates"),
    (Group::Scaling, "scaled coordinates"),
    (Group::Mirror, "mirrored coordinates"),
];

impl Step<'_, '_, '_> {
    /// `G254` and `G255`. Nothing moves for them; X, Y and Z of before say nothing of
    /// those behind it.
    pub(super) fn dynamic_offset(&mut self) -> Result<(), Fault> {
        let Some(G::DynamicOffset(goes_on)) = self.block.g(Group::DynamicOffset) else {
            return Ok(());
        };
        if !self.block.has_only(b"", Group::DynamicOffset) {
            return Err(self.wrong_offset("G254 and G255 stand in a block of their own"));
        }
        self.not_compensated("a change of the dynamic work offset")?;
        if self.state.cycle.is_some() {
            let message =
                "the dynamic work offset changes within a cycle; cancel it with G80 first";
            return Err(self.wrong_offset(message));
        }
        let carried = if goes_on { Some(self.carried()?) } else { None };
        if carried != self.state.frames.carried {
            self.state.frames.carried = carried;
            self.state.place = self.state.frames.place();
            self.state.position = UNKNOWN;
        }
        Ok(())
    }

    /// By how much the table has moved the zero from where it was set up, mm.
    fn carried(&self) -> Result<Vec3, Fault> {
        self.has_rotary_axes(Group::DynamicOffset)?;
        let state = &*self.state;
        if matches!(state.length, Length::Center(_)) {
            return Err(self.wrong_offset("G254 while G234 keeps the tip; write G49 first"));
        }
        if !state.frames.is_plain() {
            let message = "G254 with coordinates that the program has shifted, turned or scaled";
            return Err(self.wrong_offset(message));
        }
        if state.frames.active() != WorkOffset::FIRST.number() {
            let message =
                "where the zero of this work offset lies from the axes of the table is not known";
            return Err(self.wrong_offset(message));
        }
        let Some(axes) = &state.table_axes else {
            let message = "where the table turns is not known: the machine file states no `work_zero`, or no `point` \
                           of an axis, or an axis turns the head";
            return Err(self.wrong_offset(message));
        };
        if axes.iter().any(|axis| state.rotary[axis.index].is_nan()) {
            let message = "G254 while nobody knows how the table stands; turn its axes first";
            return Err(self.wrong_offset(message));
        }
        let turned = |at: Vec3, axis: &TableAxis| {
            let angle = (state.rotary[axis.index] - axis.offset).to_radians();
            axis.point + rotate(at - axis.point, axis.axis, angle)
        };
        Ok(axes.iter().fold(Vec3::ZERO, turned))
    }

    /// # Errors
    /// The coordinates change while the zero is carried along.
    #[inline]
    pub(super) fn keeps_dynamic_offset(&self) -> Result<(), Fault> {
        if self.state.frames.carried.is_none() {
            return Ok(());
        }
        if let Some(&letter) = b"ABC".iter().find(|&&letter| self.block.has(letter)) {
            let message =
                "a turn under G254, which takes the table as it stood then; write G255 first";
            return Err(self.block.at_word(letter, Rule::DynamicOffset, message));
        }
        let refused = |group, what: &str| {
            let message = format!("{what} under G254; write G255 first");
            Err(self.block.at_group(group, Rule::DynamicOffset, message))
        };
        for (group, what) in NOT_UNDER_IT {
            if self.block.g(group).is_some() {
                return refused(group, what);
            }
        }
        if self.block.g(Group::Length) == Some(G::ToolCenter) {
            return refused(Group::Length, "G234");
        }
        match self.block.g(Group::OneShot) {
            Some(G::WriteData | G::ShiftHere | G::ShiftTo) => {
                refused(Group::OneShot, "shifted coordinates")
            }
            // "It is strongly recommended not to use G28 or G29" while it is on.
            Some(G::Home | G::SecondHome | G::FromHome) => {
                refused(Group::OneShot, "a way home by G28")
            }
            _ => Ok(()),
        }
    }

    fn wrong_offset(&self, message: &str) -> Fault {
        self.block.at_group(Group::DynamicOffset, Rule::DynamicOffset, message)
    }
}
