//! The wire of a wire-EDM machine: where it is threaded and cut, and what leans it.

use super::state::Wire;
use super::step::Step;
use crate::event::Action;
use crate::iso::language::Fault;
use crate::iso::language::words::{G, Group, M, Motion, Side};
use geom::{Vec3, direction};
use program::Rule;

/// What [`super::motion::Target::named`] says of a block with U or V.
pub(super) const LEANS: u8 = 1 << 6;

impl Step<'_, '_, '_> {
    /// What a wire machine does before it moves. It has no Z, and its generator's conditions move
    /// nothing.
    pub(super) fn wire(&mut self) -> Result<(), Fault> {
        let Some(rules) = &self.facts.wire else { return Ok(()) };
        self.state.position.z = 0.0;
        self.taper(rules.taper_letter)?;
        self.block.pass(rules.conditions);
        let action = match self.block.m(Group::Wire) {
            None => return Ok(()),
            Some(M::ThreadWire) => Action::ThreadWire,
            Some(_) => Action::CutWire,
        };
        if b"XYUV".iter().any(|&letter| self.block.has(letter)) {
            let message = "the wire is threaded or cut in a block that moves: before or after it?";
            return Err(self.block.at_group(Group::Wire, Rule::Wire, message));
        }
        if action == Action::CutWire {
            self.not_compensated("the end of the wire")?;
            if self.state.wire.is_some_and(|wire| wire.taper != 0.0) {
                let message = "the end of the wire while the control leans it; write G50 first";
                return Err(self.block.at_group(Group::Wire, Rule::Taper, message));
            }
        }
        self.stood();
        self.actions.push(action);
        Ok(())
    }

    /// `G50` to `G52`.
    fn taper(&mut self, letter: u8) -> Result<(), Fault> {
        let Some(G::Taper(side)) = self.block.g(Group::Taper) else { return Ok(()) };
        let mut angle = 0.0;
        if side != Side::Off {
            angle = match self.take_degrees(letter)? {
                Some(angle) if angle > 0.0 && angle < 90.0 => angle,
                _ => {
                    let letter = char::from(letter);
                    let message = format!("G51 and G52 need their angle {letter}, 0 to 90 degrees");
                    return Err(self.block.at_group(Group::Taper, Rule::Taper, message));
                }
            };
        }
        let angle = if side == Side::Right { -angle } else { angle };
        if let Some(wire) = &mut self.state.wire
            && wire.taper != angle
        {
            wire.taper = angle;
            self.actions.push(Action::Taper(angle));
        }
        Ok(())
    }

    /// The words U and V; what the block then names.
    pub(super) fn lean(&mut self) -> Result<u8, Fault> {
        let Some(mut wire) = self.state.wire else { return Ok(0) };
        let mut named = 0;
        for (letter, place) in [(b'U', &mut wire.u), (b'V', &mut wire.v)] {
            if let Some(value) = self.take_length(letter)? {
                *place = self.advance(*place, value, letter, false)?;
                named = LEANS;
            }
        }
        if named == 0 {
            return Ok(0);
        }
        let refused = |message| Err(self.block.whole(Rule::Wire, message));
        let Some(height) = wire.upper_plane else {
            let message = "U and V, and the height of the upper plane is not known";
            return Err(self.block.whole(Rule::UpperPlane, message));
        };
        let Some(axis) = direction(Vec3::new(wire.u, wire.v, height)) else {
            return refused("U and V lie so far out that the wire has no direction");
        };
        if wire.taper != 0.0 {
            return refused("U or V while the control leans the wire");
        }
        if matches!(self.state.motion, Some(Motion::Arc { .. })) {
            return refused(
                "U or V in the block of an arc: the upper end would not go along an arc",
            );
        }
        self.state.wire = Some(Wire { axis, ..wire });
        Ok(named)
    }
}
