//! The kinematics of a machine that has two: on a LinuxCNC M functions of the builder choose whether X, Y and Z are the
//! axes, or the tip of the tool in coordinates that turn with the table (`switchkins`; `docs/controls/linuxcnc.md`).

use super::state::{Kinematics, UNKNOWN};
use super::step::Step;
use crate::iso::language::Fault;
use crate::iso::language::words::{G, Group, M, bit};
use program::Rule;

impl Step<'_, '_, '_> {
    /// The M functions that switch. Nothing moves for them, and what stood at one place by the one kinematics stands at
    /// another by the other.
    pub(super) fn kinematics(&mut self) -> Result<(), Fault> {
        let Some(M::FollowTip(follows)) = self.block.m(Group::Kinematics) else { return Ok(()) };
        if self.block.m_count > 1 || !self.block.has_only(b"M", Group::Kinematics) {
            return Err(self.wrong_kinematics("the kinematics are switched by a block of its own"));
        }
        self.not_compensated("a change of the kinematics")?;
        if self.state.cycle.is_some() {
            return Err(self.wrong_kinematics(
                "the kinematics change within a cycle; cancel it with G80 first",
            ));
        }
        let to = if follows { Kinematics::Tip } else { Kinematics::Axes };
        if self.state.kinematics != to {
            self.state.kinematics = to;
            self.state.position = UNKNOWN;
        }
        Ok(())
    }

    /// # Errors
    /// The block names coordinates, and nobody knows whether they are those of the axes or of the tip.
    #[inline]
    pub(super) fn counts_axes(&self) -> Result<(), Fault> {
        if self.state.kinematics != Kinematics::Unknown {
            return Ok(());
        }
        let axes = b"XYZABC@^".iter().fold(0, |bits, &letter| bits | bit(letter));
        let goes_home = matches!(self.block.g(Group::OneShot), Some(G::Home | G::SecondHome));
        if !self.block.has_any(axes) && !goes_home {
            return Ok(());
        }
        let message =
            "which kinematics are on, the program before has left: they are the axes' or the tip's";
        let fault = self.block.whole(Rule::Kinematics, message);
        Err(fault.help("switch to those of the axes at the start of the program").into())
    }

    /// # Errors
    /// Fixed places count from the zero of the machine by the axes alone: by the kinematics of the tip `G53 Z` and `G28`
    /// go along Z of the turned work (measured).
    pub(super) fn counts_machine(&self) -> Result<(), Fault> {
        let what =
            "a fixed position by the kinematics of the tip, where it counts in the turned work";
        self.by_axes(Group::OneShot, what)
    }

    /// # Errors
    /// The axes jump by what another length changes in the kinematics of the tip (measured: 10 mm in a millisecond).
    pub(super) fn keeps_length(&self) -> Result<(), Fault> {
        let what =
            "another tool length by the kinematics of the tip: the axes jump by what it changes";
        self.by_axes(Group::Length, what)
    }

    /// Refuses `what` by the kinematics of the tip: those of the axes come first.
    fn by_axes(&self, group: Group, what: &str) -> Result<(), Fault> {
        if self.state.kinematics != Kinematics::Tip {
            return Ok(());
        }
        let fault = self.block.at_group(group, Rule::Kinematics, what);
        Err(fault.help("switch to the kinematics of the axes first").into())
    }

    fn wrong_kinematics(&self, message: &str) -> Fault {
        self.block.at_group(Group::Kinematics, Rule::Kinematics, message)
    }
}
