//! The swivelled plane and the transformation for five axes.

use super::frames::{swivel_order, swivelled};
use super::interpreter::Interpreter;
use super::state::ToolAxis;
use crate::event::{Action, Risk, TiltChoice};
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use crate::sinumerik::language::call::{Argument, Call};
use geom::{Frame, Vec3};
use program::{Axes, Compensation, Rule};

/// Places of the parameters of `CYCLE800`: `_FR _TC _ST _MODE _X0 _Y0 _Z0 _A _B _C _X1 _Y1 _Z1 _DIR
/// _FR_I _DMODE`.
const RETRACT: usize = 0;
const DATA_SET: usize = 1;
const STATE: usize = 2;
const MODE: usize = 3;
const BEFORE: usize = 4;
const ANGLES: usize = 7;
const AFTER: usize = 10;
const DIRECTION: usize = 13;
const DISPLAY: usize = 15;
const PARAMETERS: usize = 16;

impl Interpreter<'_, '_> {
    /// `TRAORI`, `TRAORI(1)`: the linear axes now give the tool tip, which was elsewhere before.
    pub fn traori(&mut self, source: &Source, call: &Call) -> Outcome {
        let plain = match call.arguments.as_slice() {
            [] => true,
            [Argument::Number(number)] => *number == 1.0,
            _ => false,
        };
        if !plain {
            let message = "TRAORI is supported without arguments and as TRAORI(1)";
            return Err(source.block_error(Rule::Unsupported, message));
        }
        if !self.settings.rotary.contains(&true) {
            let message = "TRAORI on a machine without rotary axes";
            return Err(source.block_error(Rule::Orientation, message));
        }
        self.check_compensation_off(source, call.name)?;
        if !self.state.tool_center {
            self.state.tool_center = true;
            self.state.lose_position();
        }
        self.report_rapids(source)
    }

    /// `TRAFOOF`: positions are those of the axes again; where those stand is not known.
    pub fn trafoof(&mut self, source: &Source) -> Outcome {
        self.check_compensation_off(source, "TRAFOOF")?;
        if self.state.tool_center {
            self.state.tool_center = false;
            self.state.lose_position();
            if self.state.frames.swivel().is_none() {
                self.state.tool_axis = ToolAxis::Rotary;
            }
        }
        self.report_rapids(source)
    }

    fn check_compensation_off(&self, source: &Source, name: &str) -> Outcome {
        if self.state.compensation == Compensation::Off
            && self.state.compensation_in_effect == Compensation::Off
        {
            return Ok(());
        }
        let message = format!("{name} while cutter radius compensation is active");
        Err(source.block_error(Rule::Compensation, message))
    }

    /// `CYCLE800`: turns the plane and the machine's rotary axes with it. Where the axes are then is
    /// the machine's kinematics, so that the position is not known until blocks say it.
    pub fn swivel(&mut self, source: &Source, call: &Call) -> Outcome {
        let error = |rule, message: &str| Err(source.block_error(rule, message));
        self.check_compensation_off(source, call.name)?;
        if self.state.modal.waits() {
            return error(Rule::Cycle, "CYCLE800 while MCALL is active");
        }
        self.check_programmable_off(source)?;
        if call.arguments.is_empty() {
            return self.end_swivel();
        }
        if call.arguments.len() > PARAMETERS {
            return error(Rule::CycleParameter, "CYCLE800 has at most 16 parameters");
        }
        let number =
            |index: usize| -> Outcome<f64> { Ok(call.number(source, index)?.unwrap_or(0.0)) };
        let vector = |index: usize, unit: f64| -> Outcome<Vec3> {
            Ok(Vec3::new(number(index)?, number(index + 1)?, number(index + 2)?) * unit)
        };
        match call.arguments.get(DATA_SET) {
            Some(Argument::Text(name)) if name == "0" => return self.end_swivel(),
            None | Some(Argument::None | Argument::Text(_)) => {}
            Some(Argument::Number(_)) => {
                return error(Rule::CycleParameter, "_TC is a name in quotes");
            }
        }
        let whole = |index: usize, name: &str| -> Outcome<u32> {
            let value = number(index)?;
            if value.fract() == 0.0 && (0.0..1e9).contains(&value) {
                return Ok(value as u32);
            }
            let message = format!("{name} = {value} is not a whole number from 0");
            Err(source.block_error(Rule::CycleParameter, message))
        };
        let Some(order) = swivel_order(whole(MODE, "_MODE")?) else {
            return error(
                Rule::Unsupported,
                "_MODE of CYCLE800 must swivel axis by axis (57 is X Y Z, 27 is Z Y X)",
            );
        };
        let direction = number(DIRECTION)?;
        if !matches!(direction, -1.0 | 1.0) {
            let message = "_DIR of CYCLE800 must be -1 or 1: without it only the frame turns, not the \
                           machine";
            return error(Rule::Unsupported, message);
        }
        let status = whole(STATE, "_ST")?;
        let on_top = match status % 100_000 {
            0 | 10 => false,
            1 | 11 => true,
            _ => {
                let message = format!(
                    "_ST = {status} of CYCLE800 is not supported: new (0) or additive (1) in the ones, the tip tracked (0, 1) in the \
                     tens, and the direction in the hundred thousands"
                );
                return Err(source.block_error(Rule::Unsupported, message));
            }
        };
        let directions = match status / 100_000 {
            0 => direction,
            1 => -1.0,
            2 => 1.0,
            _ => f64::NAN,
        };
        if directions != direction {
            let message = format!(
                "_ST = {status} of CYCLE800 says another direction than _DIR = {direction}: its hundred thousands are 1 for minus, 2 for \
                 plus, or 0"
            );
            return Err(source.block_error(Rule::Unsupported, message));
        }
        if self.state.plane_normal != 2 || !matches!(whole(DISPLAY, "_DMODE")?, 0 | 1) {
            let message = "CYCLE800 in another plane than G17 (_DMODE 0 is the plane that is active, 1 is G17)";
            return error(Rule::Unsupported, message);
        }
        let retract = whole(RETRACT, "_FR")?;
        let home = match retract {
            // None; along the tool by _FR_I: where the axes then are the block does not say.
            0 | 5 => Axes::NONE,
            // Z of the machine; along the tool to the end of travel.
            1 | 4 => Axes::Z,
            // Z, then X and Y.
            2 => Axes::LINEAR,
            other => {
                let message = format!("_FR = {other} of CYCLE800 is not supported");
                return Err(source.block_error(Rule::Unsupported, message));
            }
        };
        let data_set = match call.arguments.get(DATA_SET) {
            Some(Argument::Text(name)) => name.as_str(),
            _ => "",
        };
        if data_set != self.settings.swivel_data && self.settings.rotary.contains(&true) {
            self.emit(source, Action::Risk(Risk::SWIVEL_DATA.into()))?;
        }
        if retract == 4 && self.may_lean_in_head() {
            self.emit(source, Action::Risk(Risk::LEANING_RETRACT.into()))?;
        }
        let unit = self.state.unit;
        let angles = vector(ANGLES, 1.0)?.to_array();
        let plane = swivelled(vector(BEFORE, unit)?, order, angles, vector(AFTER, unit)?);
        let base = self.state.frames.swivel().filter(|_| on_top).unwrap_or(Frame::IDENTITY);
        self.state.lose_position();
        self.state.lose_rotary(self.settings.rotary);
        let plane = base * plane;
        self.state.frames.set_swivel(Some(plane));
        self.state.tool_axis = ToolAxis::Vector(plane.matrix3.z_axis);
        if !home.is_empty() {
            self.emit(source, Action::Home(home))?;
        }
        self.emit(source, Action::Swivel(TiltChoice::Higher(direction > 0.0)))
    }

    /// Operating manual *Milling*, "Swivel plane (CYCLE800)": a new plane deletes the programmable frame; an additive one turns on
    /// top of it. So where the tool goes behind the cycle depends on what the cycle of this control does with the frame.
    fn check_programmable_off(&self, source: &Source) -> Outcome {
        if self.state.frames.programmable() == Frame::IDENTITY {
            return Ok(());
        }
        let message = "CYCLE800 while a programmable frame is active (TRANS, ROT, SCALE, MIRROR, G58, G59): what becomes of \
                       the frame depends on the cycle";
        let help = "write TRANS alone before CYCLE800, and the frame anew behind it where the program needs it";
        Err(Box::new(source.block_error(Rule::TiltedPlane, message).help(help)))
    }

    /// Whether the tool may stand otherwise than along Z of the machine: an axis of the head may have turned.
    fn may_lean_in_head(&self) -> bool {
        let stands = matches!(self.state.tool_axis, ToolAxis::Rotary);
        let (rotary, table) = (self.settings.rotary, self.settings.table);
        (0..3).any(|i| rotary[i] && !table[i] && !(stands && self.state.rotary[i] == 0.0))
    }

    /// `CYCLE800()`: no plane. Where the axes are left is the business of the machine's builder, whose `CUST_800` runs in the cycle;
    /// rotary axes that nothing has swivelled stay.
    fn end_swivel(&mut self) -> Outcome {
        self.state.lose_position();
        if self.state.frames.swivel().is_some() {
            self.state.lose_rotary(self.settings.rotary);
            self.state.frames.set_swivel(None);
        }
        Ok(())
    }
}
