//! Addresses of several letters: `CR=`, `RND=`, `POS[X]=` and their kin.

use super::block::{Block, Corner, Rare, TOLERANCES};
use super::expression::Evaluator;
use super::value::Value;
use super::words::Reader;
use crate::kernel::Outcome;
use program::Rule;

/// An address of several letters.
#[derive(Clone, Copy)]
pub(super) enum Setting {
    Radius,
    Opening,
    Turns,
    Rotation,
    FixedPoint,
    PolarAngle,
    PolarRadius,
    Angle,
    Corner(fn(f64) -> Corner),
    ModalRound,
    CornerFeed,
    ModalCornerFeed,
    SpindlePosition,
    Position,
    /// The radius at which a degree of a rotary axis counts for the feed.
    FeedReference,
    /// How far an outer corner is from an arc.
    Peak,
    /// By how much the control may leave the path, by its place among the tolerances of a block.
    PathTolerance(usize),
    /// `OTOL=`: by how much the control may turn the tool out of its orientation.
    OrientationTolerance,
    /// By how much an axis accelerates, jerks or is fast, percent.
    Dynamics,
    /// Where an axis goes when the program is stopped, how far and which way.
    RetractTo,
    Retract,
}

/// The addresses of several letters.
const SETTINGS: &[(&str, Setting)] = &[
    ("CR", Setting::Radius),
    ("AR", Setting::Opening),
    ("TURN", Setting::Turns),
    ("RPL", Setting::Rotation),
    ("FP", Setting::FixedPoint),
    ("AP", Setting::PolarAngle),
    ("RP", Setting::PolarRadius),
    ("ANG", Setting::Angle),
    ("CHF", Setting::Corner(Corner::Chamfer)),
    ("CHR", Setting::Corner(Corner::ChamferSide)),
    ("RND", Setting::Corner(Corner::Round)),
    ("RNDM", Setting::ModalRound),
    ("FRC", Setting::CornerFeed),
    ("FRCM", Setting::ModalCornerFeed),
    ("SPOS", Setting::SpindlePosition),
    ("POS", Setting::Position),
    ("FGREF", Setting::FeedReference),
    (TOLERANCES[0], Setting::PathTolerance(0)),
    (TOLERANCES[1], Setting::PathTolerance(1)),
    (TOLERANCES[2], Setting::PathTolerance(2)),
    ("OTOL", Setting::OrientationTolerance),
    ("DISC", Setting::Peak),
    ("ACC", Setting::Dynamics),
    ("ACCLIMA", Setting::Dynamics),
    ("JERKLIMA", Setting::Dynamics),
    ("VELOLIMA", Setting::Dynamics),
    ("POLF", Setting::RetractTo),
    ("DILF", Setting::Retract),
    ("ALF", Setting::Retract),
];

/// Each address with a value.
pub(super) fn vocabulary() -> impl Iterator<Item = String> {
    SETTINGS.iter().map(|(name, setting)| match setting {
        Setting::Position | Setting::Dynamics | Setting::RetractTo => format!("{name}[X]=150"),
        Setting::FeedReference => format!("{name}[C]=150"),
        _ => format!("{name}=1"),
    })
}

/// The address of that name, as the language has it.
pub(super) fn named(name: &str) -> Option<(&'static str, Setting)> {
    SETTINGS.iter().find(|(n, _)| *n == name).copied()
}

impl Reader<'_, '_> {
    /// `CR=...` and its kin.
    pub(super) fn setting(
        &mut self,
        start: usize,
        said: &'static str,
        setting: Setting,
    ) -> Outcome {
        match setting {
            Setting::Position => return self.positioning(start),
            Setting::FeedReference => return self.feed_reference(start),
            Setting::Dynamics => return self.dynamics(start, said),
            Setting::RetractTo => {
                self.indexed_axis()?;
                // Absolute or by an increment: it moves nothing.
                self.counted(false)?;
                self.block.rare.get_or_insert_default().retracts = true;
                return Ok(());
            }
            _ => {}
        }
        self.scanner.expect(b'=')?;
        if let Setting::PolarAngle | Setting::PolarRadius = setting {
            let coordinate = self.counted(false)?;
            let rare = self.block.rare.get_or_insert_default();
            let place = match setting {
                Setting::PolarAngle => &mut rare.polar_angle,
                _ => &mut rare.polar_radius,
            };
            let repeated = place.replace(coordinate).is_some();
            return self.once(start, repeated);
        }
        let value = self.expression()?;
        let block = &mut *self.block;
        let rare = |block: &mut Block, place: fn(&mut Rare) -> &mut Option<f64>| {
            place(block.rare.get_or_insert_default()).replace(value).is_some()
        };
        let repeated = match setting {
            Setting::Radius => block.radius.replace(value).is_some(),
            Setting::Opening => block.opening.replace(value).is_some(),
            Setting::Turns => block.turns.replace(value).is_some(),
            Setting::Rotation => block.rotation.replace(value).is_some(),
            Setting::FixedPoint => block.fixed_point.replace(value).is_some(),
            Setting::PathTolerance(place) => {
                let rare = block.rare.get_or_insert_default();
                rare.tolerances.get_mut(place).is_some_and(|p| p.replace(value).is_some())
            }
            Setting::OrientationTolerance => block.orientation_tolerance.replace(value).is_some(),
            Setting::Corner(corner) => {
                let rare = block.rare.get_or_insert_default();
                rare.corner.replace(corner(value)).is_some()
            }
            Setting::Peak => rare(block, |r| &mut r.peak),
            Setting::Retract => {
                block.rare.get_or_insert_default().retracts = true;
                false
            }
            Setting::Angle => rare(block, |r| &mut r.angle),
            Setting::ModalRound => rare(block, |r| &mut r.modal_round),
            Setting::CornerFeed => rare(block, |r| &mut r.corner_feed),
            Setting::ModalCornerFeed => rare(block, |r| &mut r.modal_corner_feed),
            Setting::SpindlePosition => rare(block, |r| &mut r.spindle_position),
            Setting::Position
            | Setting::FeedReference
            | Setting::Dynamics
            | Setting::RetractTo
            | Setting::PolarAngle
            | Setting::PolarRadius => false,
        };
        self.once(start, repeated)
    }

    /// `[X]=` behind an address that each axis has.
    fn indexed_axis(&mut self) -> Outcome<usize> {
        self.scanner.expect(b'[')?;
        self.scanner.blanks();
        let at = self.scanner.at;
        let evaluator = Evaluator::new(self.state, &self.block.assigned);
        let Value::Axis(axis) = evaluator.value(&mut self.scanner)? else {
            return Err(self.scanner.error_since(at, Rule::Type, "an axis must stand here"));
        };
        self.scanner.expect(b']')?;
        self.scanner.expect(b'=')?;
        Ok(axis)
    }

    /// `FGREF[A]=...`.
    fn feed_reference(&mut self, start: usize) -> Outcome {
        let axis = self.indexed_axis()?;
        let radius = self.expression()?;
        let Some(axis) = axis.checked_sub(3) else {
            let message = "FGREF is the radius of a rotary axis";
            return Err(self.scanner.error_since(start, Rule::FeedGroup, message));
        };
        if radius <= 0.0 {
            let message = "the radius of FGREF must be above 0";
            return Err(self.scanner.error_since(start, Rule::FeedGroup, message));
        }
        let place = self.block.rare.get_or_insert_default().feed_reference.get_mut(axis);
        let repeated = place.is_some_and(|place| place.replace(radius).is_some());
        self.once(start, repeated)
    }

    /// `ACC[X]=80`: percent of what the machine data let the axis do; the path stays what it is (Programming Manual 12/2019,
    /// "Percentage acceleration override", "Influence of acceleration on following axes").
    fn dynamics(&mut self, start: usize, said: &str) -> Outcome {
        self.indexed_axis()?;
        let percent = self.expression()?;
        if percent > 0.0 && percent <= 200.0 {
            self.block.rare.get_or_insert_default().is_dynamic |= percent > 100.0;
            return Ok(());
        }
        let message = format!("{said}[] takes more than 0 and at most 200 percent");
        Err(self.scanner.error_since(start, Rule::Number, message))
    }

    /// `POS[X]=...`.
    fn positioning(&mut self, start: usize) -> Outcome {
        let axis = self.indexed_axis()?;
        let coordinate = self.counted(axis >= 3)?;
        let place = self.block.rare.get_or_insert_default().positioned.get_mut(axis);
        let repeated = place.is_some_and(|place| place.replace(coordinate).is_some());
        self.once(start, repeated)
    }
}
