//! Cutter compensation: it is switched with the first straight move in the plane, by rapid or in the cut, but
//! not on the way from a place that the program does not know.

use super::{Outcome, Walk, refuse};
use crate::catalogue::{BlockName, WordName};
use crate::contour::Contour;
use crate::words::bit;
use geom::{Turn, Vec2, Vec3};
use machine::ToolRadius;
use program::{CompensatedPath, Compensation, Diagnostic, Op, Record, Rule};
use std::collections::BTreeMap;

impl Walk<'_> {
    pub(super) fn set_compensation(&mut self, compensation: Compensation) -> Outcome {
        if compensation != Compensation::Off && self.wire.is_none() && self.leaves_off()? {
            return Ok(());
        }
        if compensation != Compensation::Off && !self.machine.capabilities.compensation {
            let help = "give the path of the tool's centre: without CUTCOM, or of an NC program with its tool table (--tools)";
            return Err(Box::new(
                refuse(Rule::Compensation, "the control has no cutter compensation").help(help),
            ));
        }
        if let Compensation::Left(Some(register)) | Compensation::Right(Some(register)) =
            compensation
            && !self.templates.places(BlockName::Linear, WordName::D)
        {
            self.leave_register_out("radius", register);
        }
        self.wanted.set_compensation(compensation, self.line);
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
                Err(refuse(Rule::CompensatedPath, message).help(help).into())
            }
            (Some(CompensatedPath::Center), Some(ToolRadius::Wear))
                if self.machine.capabilities.compensation =>
            {
                Ok(false)
            }
            (Some(CompensatedPath::Center), _) => {
                let message = "the source gives the path of the tool's centre: it is written without radius \
                               compensation, and offsets at the control do not change the size of what is cut";
                let help = match self.machine.capabilities.compensation {
                    true => {
                        "if the tool table of the control keeps wear alone, `tool_radius = \"wear\"` in [settings] of the machine \
                         file: compensation is written then"
                    }
                    false => "the control has no compensation",
                };
                let found = Diagnostic::warning(Rule::CompensatedPath, message).help(help);
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
                Err(refuse(Rule::CompensatedPath, message).help(help).into())
            }
            (Some(CompensatedPath::Contour), None) => {
                let message = "the source gives the contour, and the machine file does not say that the tool table keeps the \
                               radius of the tool";
                let help =
                    "`tool_radius = \"full\"` in [settings] of the machine file, where it does";
                Err(refuse(Rule::CompensatedPath, message).help(help).into())
            }
        }
    }

    /// Says the compensation in the next block, a straight move; one in the plane switches it.
    ///
    /// # Errors
    /// The control cannot begin or end a contour so.
    pub(crate) fn compensate(&mut self) -> Outcome {
        let in_plane = bit(WordName::X) | bit(WordName::Y);
        if self.compensation_pending() && self.writer.changes(in_plane) {
            self.turn_contour()?;
            self.sent.switch_compensation(self.wanted.compensation());
            let tool = self.wanted.tool().map(|tool| tool.number);
            match self.wanted.compensation() {
                Compensation::Left(register) | Compensation::Right(register) => {
                    if let Some(register) = register.or(tool) {
                        self.writer.set(WordName::D, f64::from(register));
                    }
                }
                Compensation::Off => {}
            }
        }
        self.keep_compensation();
        Ok(())
    }

    /// The next block begins a contour, or ends one.
    fn turn_contour(&mut self) -> Outcome {
        let (contour, to) = (self.contour.take(), self.in_plane(self.position.said()));
        let side = match self.wanted.compensation() {
            Compensation::Off => return contour.map_or(Ok(()), |contour| contour.leave(to)),
            Compensation::Left(_) => 1.0,
            Compensation::Right(_) => -1.0,
        };
        if self.is_compensating() && self.wire.is_none() {
            let message = "cutter compensation changes its side or its register while it is on";
            let help = "CUTCOM/OFF and a straight move in the plane before it";
            return Err(refuse(Rule::CompensationChange, message).help(help).into());
        }
        let from = [WordName::X, WordName::Y].map(|word| self.writer.active(word));
        let from = match (from, self.position.turned_to()) {
            (_, Some(at)) => Some(at.truncate()),
            ([Some(x), Some(y)], None) => Some(Vec2::new(x, y)),
            _ => None,
        };
        if let (Some(from), Some(radius)) = (from, self.contour_radius()?) {
            self.contour = Some(Box::new(Contour::new(self.machine, from, radius, side)));
        }
        Ok(())
    }

    /// The radius by which the control offsets the contour, mm; nothing where that is not known.
    ///
    /// # Errors
    /// The source names the register of another tool.
    fn contour_radius(&self) -> Result<Option<f64>, Box<Diagnostic>> {
        let Some(tool) = self.wanted.tool().filter(|_| self.wire.is_none()) else {
            return Ok(None);
        };
        let Some(radius) = tool.cutting_radius() else { return Ok(None) };
        let named = match self.wanted.compensation() {
            Compensation::Left(register) | Compensation::Right(register) => register,
            Compensation::Off => None,
        };
        let named = named.filter(|number| {
            *number != tool.number && self.templates.places(BlockName::Linear, WordName::D)
        });
        let Some(named) = named else {
            let keeps_wear = self.source.compensated_path == Some(CompensatedPath::Center);
            return Ok(Some(if keeps_wear { 0.0 } else { radius }));
        };
        match self.radii().get(&named) {
            Some(&other) if other != radius => {
                let message = format!(
                    "the source names register {named}, in which the radius of another tool stands: {other} mm, and tool {} has {radius} mm",
                    tool.number
                );
                let help = "the register of the tool itself, or none";
                Err(refuse(Rule::Compensation, message).help(help).into())
            }
            _ => Ok(None),
        }
    }

    /// The radii of the source's tools, mm, by their numbers.
    fn radii(&self) -> &BTreeMap<u32, f64> {
        self.radii.get_or_init(|| {
            let radius = |record: &Record| {
                let Op::Tool(tool) = &record.op else { return None };
                Some((tool.number, tool.cutting_radius()?))
            };
            self.source.records.iter().filter_map(radius).collect()
        })
    }

    /// The block that has been written, a straight one, goes on with the contour.
    #[inline]
    pub(crate) fn follow(&mut self, rapid: bool) -> Outcome {
        match self.contour {
            Some(_) => self.follow_to(self.in_plane(self.position.said()), None, rapid),
            None => Ok(()),
        }
    }

    /// The same for an arc about +Z through `sweep` radians.
    pub(crate) fn follow_arc(&mut self, end: Vec3, center: Vec3, sweep: f64) -> Outcome {
        self.follow_to(end.truncate(), Some(Turn { center: center.truncate(), sweep }), false)
    }

    fn follow_to(&mut self, to: Vec2, turn: Option<Turn>, rapid: bool) -> Outcome {
        let Some(mut contour) = self.contour.take() else { return Ok(()) };
        contour.go(to, turn, rapid)?;
        self.contour = Some(contour);
        Ok(())
    }

    /// A place in the plane as its words say it.
    fn in_plane(&self, at: Vec3) -> Vec2 {
        Vec2::new(self.writer.rounded(WordName::X, at.x), self.writer.rounded(WordName::Y, at.y))
    }

    /// Whether the control offsets the next move, or may.
    pub(super) fn offsets(&self) -> bool {
        self.is_compensating() || self.wanted.compensation() != Compensation::Off
    }

    /// Says in the next block the compensation that is active.
    pub(crate) fn keep_compensation(&mut self) {
        self.writer.code(WordName::Compensation, compensation_code(self.sent.compensation()));
    }

    /// Compensation has to be off before `what`.
    pub(crate) fn uncompensated(&self, what: &str) -> Outcome {
        if !self.is_compensating() {
            return Ok(());
        }
        let help = "CUTCOM/OFF and a straight move in the plane before it";
        let message = format!("cutter compensation is still on at {what}");
        Err(refuse(Rule::CompensationActive, message).help(help).into())
    }

    /// The plane of work for a straight move that may switch compensation, with the tool along `axis`: the control offsets
    /// across Z of the coordinates that blocks have.
    pub(crate) fn switch_plane(&mut self, axis: Vec3) -> Outcome {
        if !self.compensation_pending() {
            return Ok(());
        }
        if self.wanted.compensation() != Compensation::Off && !self.is_along_z(axis) {
            let message = "cutter compensation is switched on for a tool that does not stand along Z of the control's coordinates";
            let help = "work in the plane of a set-up (`positioned = \"tilted-plane\"` in the machine file), or give the path of \
                        the tool's centre";
            return Err(refuse(Rule::Compensation, message).help(help).into());
        }
        self.plane_xy()
    }

    /// Whether cutter compensation is on.
    pub(crate) fn is_compensating(&self) -> bool {
        self.sent.compensation() != Compensation::Off
    }

    /// Whether the next straight move in the plane switches the compensation.
    pub(crate) fn compensation_pending(&self) -> bool {
        self.wanted.compensation() != self.sent.compensation()
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
