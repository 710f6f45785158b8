//! The programmable frame: `TRANS`, `ROT`, `SCALE`, `MIRROR`, their additive forms, `G58` and `G59`.

use super::frames::{about, roll_pitch_yaw};
use super::interpreter::{Interpreter, plain_values};
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use crate::sinumerik::language::block::Block;
use crate::sinumerik::language::commands::{Diameter, FrameCommand};
use geom::{Frame, Vec3};
use program::{Compensation, Rule};

impl Interpreter<'_, '_> {
    /// A command of the programmable frame, in a block of its own. The absolute ones delete what is
    /// there, with or without values; the additive ones go on top of it.
    pub fn frame_command(
        &mut self,
        source: &Source,
        block: &Block,
        command: FrameCommand,
    ) -> Outcome {
        let name = block.command(3);
        let error = |rule, message: String| Err(source.block_error(rule, message));
        if !block.only_group(3)
            || block.feed.is_some()
            || block.speed.is_some()
            || block.has_rotary()
        {
            return error(Rule::Frame, format!("{name} stands in a block of its own with X, Y, Z"));
        }
        if self.state.compensation_in_effect != Compensation::Off {
            let message = format!("{name} while cutter radius compensation is active");
            return error(Rule::Compensation, message);
        }
        if self.state.diameter != Diameter::Off && block.axes[0].is_some() {
            return error(Rule::Unsupported, format!("{name} of X while X is a diameter"));
        }
        if block.rotation.is_some() && !matches!(command, FrameCommand::Rotate(_)) {
            return error(Rule::Frame, "RPL= belongs to ROT and AROT".into());
        }
        let values = plain_values(source, block)?;
        let vector = |unit: f64, missing: f64| {
            Vec3::from_array(values.map(|value| value.map_or(missing, |value| value * unit)))
        };
        let (change, on_top) = match command {
            FrameCommand::Translate(on_top) => {
                (Frame::from_translation(vector(self.state.unit, 0.0)), on_top)
            }
            FrameCommand::Rotate(on_top) => {
                let turned = match block.rotation {
                    Some(_) if block.has_linear() => {
                        return error(Rule::Frame, "RPL= and X, Y, Z in one rotation".into());
                    }
                    Some(degrees) => {
                        self.lean_on_plane(source)?;
                        about(self.state.plane_normal, degrees)
                    }
                    None => roll_pitch_yaw(vector(1.0, 0.0)),
                };
                (Frame::from_mat3(turned), on_top)
            }
            FrameCommand::Scale(on_top) => {
                let factors = vector(1.0, 1.0);
                if factors.min_element() <= 0.0 {
                    return error(Rule::Frame, format!("{name}: a factor is above 0"));
                }
                (Frame::from_scale(factors), on_top)
            }
            FrameCommand::Mirror(on_top) => {
                let signs = values.map(|value| if value.is_some() { -1.0 } else { 1.0 });
                (Frame::from_scale(Vec3::from_array(signs)), on_top)
            }
            FrameCommand::Coarse | FrameCommand::Fine => {
                return self.axial_offset(source, values, command == FrameCommand::Coarse);
            }
        };
        let frames = &self.state.frames;
        let (base, fine) = match (on_top, command) {
            (false, _) => (Frame::IDENTITY, Vec3::ZERO),
            (true, FrameCommand::Translate(_)) => {
                (frames.programmable(), frames.fine() + change.translation)
            }
            (true, _) => (frames.programmable(), frames.fine()),
        };
        self.state.change_frames(|frames| frames.set_programmable(base * change, fine));
        Ok(())
    }

    /// `G58`, `G59`: the absolute or the added part of the translation of single axes.
    fn axial_offset(&mut self, source: &Source, values: [Option<f64>; 3], coarse: bool) -> Outcome {
        let mut frame = self.state.frames.programmable();
        let mut fine = self.state.frames.fine();
        if frame.matrix3 != geom::Mat3::IDENTITY {
            let message = "G58 and G59 in a turned, scaled or mirrored frame";
            return Err(source.block_error(Rule::Unsupported, message));
        }
        for (i, value) in values.iter().enumerate() {
            let Some(value) = value.map(|value| value * self.state.unit) else { continue };
            if coarse {
                frame.translation[i] = value + fine[i];
            } else {
                frame.translation[i] += value - fine[i];
                fine[i] = value;
            }
        }
        self.state.change_frames(|frames| frames.set_programmable(frame, fine));
        Ok(())
    }
}
