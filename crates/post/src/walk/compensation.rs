//! Cutter compensation: it is switched with the first straight move in the plane, by rapid or in the cut, but
//! not on the way from a place that the program does not know.

use super::{Done, Walk, refuse};
use crate::catalogue::{BlockName, WordName};
use crate::template::bit;
use program::Compensation;

impl Walk<'_> {
    pub(super) fn set_compensation(&mut self, compensation: Compensation) -> Done {
        if compensation != Compensation::Off && !self.machine.capabilities.compensation {
            // Whether the path is that of the tool's centre or the contour, only its author knows.
            let help = "give the path of the tool's centre: without CUTCOM, or of an NC program with its tool table (--tools)";
            return Err(Box::new(
                refuse("compensation", "the control has no cutter compensation").help(help),
            ));
        }
        if let Compensation::Left(Some(register)) | Compensation::Right(Some(register)) =
            compensation
            && !self.templates.places(BlockName::Linear, WordName::D)
        {
            self.leave_register_out("radius", register);
        }
        self.compensation = compensation;
        self.compensation_line = self.line;
        Ok(())
    }

    /// Says the compensation in the next block, a straight move; one in the plane switches it.
    pub(crate) fn compensate(&mut self) {
        let in_plane = bit(WordName::X) | bit(WordName::Y);
        if self.compensation_pending() && self.writer.changes(in_plane) {
            self.active_compensation = self.compensation;
            let tool = self.tool.as_ref().map(|tool| tool.number);
            match self.compensation {
                Compensation::Left(register) | Compensation::Right(register) => {
                    if let Some(register) = register.or(tool) {
                        self.writer.set(WordName::D, f64::from(register));
                    }
                }
                Compensation::Off => {}
            }
        }
        self.keep_compensation();
    }

    /// Says in the next block the compensation that is active.
    pub(crate) fn keep_compensation(&mut self) {
        self.writer.code(WordName::Compensation, compensation_code(self.active_compensation));
    }

    /// Compensation has to be off before `what`.
    pub(crate) fn uncompensated(&self, what: &str) -> Done {
        if !self.is_compensating() {
            return Ok(());
        }
        let help = "CUTCOM/OFF and a straight move in the plane before it";
        let message = format!("cutter compensation is still on at {what}");
        Err(refuse("compensation-active", message).help(help).into())
    }

    /// Whether cutter compensation is on.
    pub(crate) fn is_compensating(&self) -> bool {
        self.active_compensation != Compensation::Off
    }

    /// Whether the next straight move in the plane switches the compensation.
    pub(crate) fn compensation_pending(&self) -> bool {
        self.compensation != self.active_compensation
    }
}

/// Entry of the code word `compensation`.
pub(super) fn compensation_code(compensation: Compensation) -> usize {
    match compensation {
        Compensation::Off => 0,
        Compensation::Left(_) => 1,
        Compensation::Right(_) => 2,
    }
}
