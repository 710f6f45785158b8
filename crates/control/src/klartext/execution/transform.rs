//! Shifts, mirrors, rotations and scales of the coordinates.

use super::state::Control;
use super::state::transforms::{Step, Transforms};
use crate::kernel::Outcome;
use crate::klartext::language::scan::Scanner;
use crate::klartext::language::words::{LINEAR, Words};
use geom::Vec3;
use program::{Compensation, Rule};

impl Control<'_, '_> {
    /// The transformations that blocks change: those within a tilted plane where there is one.
    pub(super) fn transforms(&self) -> &Transforms {
        self.tilt.as_ref().map_or(&self.outside, |tilt| &tilt.inside)
    }

    fn transform(&mut self, s: &Scanner, step: Step) -> Outcome {
        if self.compensation != Compensation::Off {
            let message = "coordinates are transformed with R0";
            return Err(s.error_block(Rule::Compensation, message));
        }
        if self.tilt.is_some() && !self.outside.is_empty() && matches!(step, Step::Shift(_)) {
            let message = "the datum was already shifted before the plane was tilted";
            let help = "shift the datum before PLANE";
            return Err(s.error_block(Rule::TiltedPlane, message).help(help).into());
        }
        let transforms = self.tilt.as_mut().map_or(&mut self.outside, |tilt| &mut tilt.inside);
        let place = transforms.apply(self.here);
        let before = transforms.clone();
        transforms.set(step);
        if *transforms != before {
            // A shift alone counts on exactly, without the rounding of there and back.
            self.here = match (before.is_more_than_a_shift(), step) {
                (false, Step::Shift(_)) => self.here + before.shift() - transforms.shift(),
                _ => transforms.undo(place),
            };
            // Whether the pole stays where it was or goes with the coordinates is not said.
            self.pole = None;
            self.path = None;
        }
        Ok(())
    }

    /// Nothing moves while it is not clear in which order transformations act.
    #[inline]
    pub(super) fn transforms_are_clear(&self, s: &Scanner) -> Outcome {
        if !self.transforms().is_unclear() {
            return Ok(());
        }
        let message = "a transformation was changed while a later one is active: in which order they \
                       act is not known";
        let help = "set the later ones (mirror, rotation, scale) back before, and anew afterwards";
        Err(s.error_block(Rule::Transformation, message).help(help).into())
    }

    /// `CYCL DEF 7.n`: `X+60`, `IY-5`.
    pub(super) fn datum_shift(&mut self, s: &mut Scanner) -> Outcome {
        if s.peek().starts_with(b"#") {
            let message = "the datum is in a table of the control, which is not at hand";
            return Err(s.error_here(Rule::Unsupported, message));
        }
        let words = Words::read(s, LINEAR, self)?;
        if !words.has(LINEAR) || !words.is_plain() {
            return Err(s.error_block(Rule::CycleParameter, "cycle 7 takes X, Y or Z here"));
        }
        self.shift_datum(s, &words)
    }

    fn shift_datum(&mut self, s: &Scanner, words: &Words) -> Outcome {
        let old = self.transforms().shift();
        let shift = Vec3::from([0, 1, 2].map(|i| words.target(i, old[i])));
        self.transform(s, Step::Shift(shift))
    }

    /// `CYCL DEF 8.1`: the axes that are mirrored; none ends it.
    pub(super) fn mirror(&mut self, s: &mut Scanner) -> Outcome {
        let mut signs = Vec3::ONE;
        while !s.is_done() {
            match s.token() {
                (b"X", _) if signs.x > 0.0 => signs.x = -1.0,
                (b"Y", _) if signs.y > 0.0 => signs.y = -1.0,
                (_, span) => {
                    return Err(s.error(Rule::Unsupported, span, "only X and Y are mirrored here"));
                }
            }
        }
        self.transform(s, Step::Mirror(signs))
    }

    /// `CYCL DEF 10.1 ROT+35`.
    pub(super) fn rotation(&mut self, s: &mut Scanner) -> Outcome {
        let degrees = match s.word(&self.registers)? {
            Some(word) if word.address == b"ROT" => word.number,
            Some(word) if word.address == b"IROT" => {
                word.number.map(|step| self.transforms().rotation() + step)
            }
            _ => None,
        };
        s.finish()?;
        let degrees = degrees.ok_or_else(|| {
            s.error_block(Rule::CycleParameter, "cycle 10 takes ROT with an angle")
        })?;
        self.transform(s, Step::Rotation(degrees % 360.0))
    }

    /// `CYCL DEF 11.1 SCL0.99`.
    pub(super) fn scale(&mut self, s: &mut Scanner) -> Outcome {
        let factor = match s.word(&self.registers)? {
            Some(word) if word.address == b"SCL" && word.number.is_none() => {
                Some(s.value(&self.registers)?)
            }
            Some(word) if word.address == b"SCL" => word.number,
            _ => None,
        };
        s.finish()?;
        let factor = factor.filter(|factor| FACTORS.contains(factor));
        let factor = factor.ok_or_else(|| {
            s.error_block(Rule::CycleParameter, "cycle 11 takes SCL with a factor")
        })?;
        self.transform(s, Step::Scale(factor))
    }

    /// `CYCL DEF 26.1 X1.4 Y0.6 CCX+15 CCY+20`.
    pub(super) fn axis_scale(&mut self, s: &mut Scanner) -> Outcome {
        let (mut factor, mut center) = (Vec3::ONE, Vec3::ZERO);
        while let Some(word) = s.word(&self.registers)? {
            let (address, place) = match word.address {
                [b'C', b'C', axis @ b'X'..=b'Z'] => (axis, Some(&mut center)),
                [axis @ b'X'..=b'Z'] => (axis, None),
                _ => return Err(crate::klartext::language::feed::unknown(s, &word)),
            };
            let axis = usize::from(address - b'X');
            match (place, word.number) {
                (Some(center), Some(number)) => center[axis] = number * self.unit,
                (None, Some(number)) if FACTORS.contains(&number) => factor[axis] = number,
                _ => {
                    return Err(s.error(
                        Rule::CycleParameter,
                        word.span,
                        "a factor is expected here",
                    ));
                }
            }
        }
        self.transform(s, Step::AxisScale { factor, center })
    }

    /// `TRANS DATUM`, from behind `TRANS`.
    pub(crate) fn transformation(&mut self, s: &mut Scanner) -> Outcome {
        let (kind, span) = s.token();
        if kind != b"DATUM" {
            return Err(s.error(Rule::Unsupported, span, "only TRANS DATUM is supported"));
        }
        if s.take(b"RESET") {
            s.finish()?;
            return self.transform(s, Step::Shift(Vec3::ZERO));
        }
        if !s.take(b"AXIS") {
            let message = "the datum is in a table of the control, which is not at hand";
            return Err(s
                .error_here(Rule::Unsupported, message)
                .help("use TRANS DATUM AXIS")
                .into());
        }
        let words = Words::read(s, LINEAR, self)?;
        let old = self.transforms().shift();
        let kept = (0..3).any(|i| old[i] != 0.0 && !words.has(1 << i));
        if !words.has(LINEAR) || !words.is_plain() || kept {
            let message = "TRANS DATUM AXIS must say every axis that is shifted";
            return Err(s.error_block(Rule::MissingWord, message).help("give X, Y and Z").into());
        }
        self.shift_datum(s, &words)
    }
}

/// The factors of cycles 11 and 26.
const FACTORS: std::ops::RangeInclusive<f64> = 0.000_001..=99.999_999;
