//! The wire of a wire-EDM machine: where it is threaded and cut, and how U and V lean it.

use super::block::Fault;
use super::execute::Step;
use super::words::{Group, M, Motion};
use crate::Settings;
use geom::{Vec3, direction};
use program::{Op, Orientation};

/// The wire as the control knows it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wire {
    /// Height at which U and V are counted, mm.
    upper_plane: Option<f64>,
    /// How far the wire is beside X and Y there, mm.
    u: f64,
    v: f64,
    /// Where that points it: it is set up upright.
    axis: Vec3,
}

/// What [`super::motion::Target::named`] says of a block with U or V.
pub(super) const LEANS: u8 = 1 << 6;

impl Wire {
    /// Upright.
    pub(super) fn new(settings: &Settings) -> Wire {
        Wire { upper_plane: settings.wire.height, u: 0.0, v: 0.0, axis: Vec3::Z }
    }

    /// Where it points.
    pub(super) fn orientation(&self) -> Orientation {
        Orientation::Axis(self.axis)
    }
}

impl Step<'_, '_, '_> {
    /// What a wire machine does before it moves. It has no Z, and its generator's conditions move
    /// nothing.
    pub(super) fn wire(&mut self) -> Result<(), Fault> {
        if self.state.wire.is_none() {
            return Ok(());
        }
        self.state.position.z = 0.0;
        self.block.pass(self.flavor.conditions());
        let op = match self.block.m(Group::Wire) {
            None => return Ok(()),
            Some(M::ThreadWire) => Op::ThreadWire,
            Some(_) => Op::CutWire,
        };
        if b"XYUV".iter().any(|&letter| self.block.has(letter)) {
            let message = "the wire is threaded or cut in a block that moves: before or after it?";
            return Err(self.block.at_group(Group::Wire, "nc-wire", message));
        }
        if op == Op::CutWire {
            self.not_compensated("the end of the wire")?;
        }
        self.ops.push(op);
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
        let refused = |message| Err(self.block.whole("nc-wire", message));
        let Some(height) = wire.upper_plane else {
            return refused("U and V, and the height of the upper plane is not known");
        };
        let Some(axis) = direction(Vec3::new(wire.u, wire.v, height)) else {
            return refused("U and V lie so far out that the wire has no direction");
        };
        if matches!(self.state.motion, Some(Motion::Arc { .. })) {
            return refused("U or V beside an arc: the upper end would not go along an arc");
        }
        self.state.wire = Some(Wire { axis, ..wire });
        Ok(named)
    }
}
