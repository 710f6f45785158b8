//! Cutter compensation: it is switched with the first straight move in the plane, by rapid or in the cut, but
//! not on the way from a place that the program does not know.

use super::{Done, Walk, refuse};
use crate::catalogue::{BlockName, WordName};
use crate::template::bit;
use geom::Vec3;
use machine::ToolRadius;
use program::{CompensatedPath, Compensation, Diagnostic};

impl Walk<'_> {
    pub(super) fn set_compensation(&mut self, compensation: Compensation) -> Done {
        if compensation != Compensation::Off && self.wire.is_none() && self.leaves_off()? {
            return Ok(());
        }
        if compensation != Compensation::Off && !self.machine.capabilities.compensation {
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

    /// Whether the path is that of the tool's centre and is written without compensation.
    ///
    /// # Errors
    /// What the tool table keeps does not go with the path, or either is not known: the control would offset by the tool once
    /// too often, or not at all.
    fn leaves_off(&mut self) -> Result<bool, Box<Diagnostic>> {
        let table = self.machine.settings.tool_radius;
        match (self.source.compensated_path, table) {
            (None, _) => {
                let message = "nothing in the source shows whether its coordinates with compensation are the path of the \
                               tool's centre or the contour";
                let help = "`--cutcom centre` or `--cutcom contour` (in Python `cutcom`; `path` of a builder's \
                            compensation): look at the setting of the CAM system, or compare with the drawing";
                Err(refuse("compensated-path", message).help(help).into())
            }
            (Some(CompensatedPath::Center), Some(ToolRadius::Wear))
                if self.machine.capabilities.compensation =>
            {
                Ok(false)
            }
            (Some(CompensatedPath::Center), _) => {
                let message = "with compensation the source gives the path of the tool's centre: it is written without \
                               compensation";
                let help = match self.machine.capabilities.compensation {
                    true => {
                        "where the tool table keeps nothing but wear: `tool_radius = \"wear\"` in [settings] of the machine file"
                    }
                    false => "the control has none",
                };
                let found = Diagnostic::warning("compensated-path", message).help(help);
                self.findings.warn(found.line(self.line));
                Ok(true)
            }
            (Some(CompensatedPath::Contour), _) if !self.machine.capabilities.compensation => {
                Ok(false)
            }
            (Some(CompensatedPath::Contour), Some(ToolRadius::Full)) => Ok(false),
            (Some(CompensatedPath::Contour), Some(ToolRadius::Wear)) => {
                let message = "the source gives the contour, and the tool table keeps nothing but wear: the tool would be \
                               off by its radius";
                let help = "give the path of the tool's centre, or a machine whose table keeps the full radius (`tool_radius` \
                            in [settings])";
                Err(refuse("compensated-path", message).help(help).into())
            }
            (Some(CompensatedPath::Contour), None) => {
                let message = "the source gives the contour, and the machine file does not say that the tool table keeps the \
                               radius of the tool";
                let help =
                    "`tool_radius = \"full\"` in [settings] of the machine file, where it does";
                Err(refuse("compensated-path", message).help(help).into())
            }
        }
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

    /// The plane of work for a straight move that may switch compensation, with the tool along `axis`: the control offsets
    /// across Z of the coordinates that blocks have.
    pub(crate) fn switch_plane(&mut self, axis: Vec3) -> Done {
        if !self.compensation_pending() {
            return Ok(());
        }
        if self.compensation != Compensation::Off && !self.is_along_z(axis) {
            let message = "cutter compensation is switched on for a tool that does not stand along Z of the control's coordinates";
            let help = "work in the plane of a set-up (`positioned = \"tilted-plane\"` in the machine file), or give the path of \
                        the tool's centre";
            return Err(refuse("compensation", message).help(help).into());
        }
        self.plane_xy()
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
