//! Tilted planes of work and the keeping of the tool tip.

use super::state::tilt::{Tilt, spatial};
use super::state::transforms::Transforms;
use super::state::{Control, Tip};
use crate::event::{Action, Risk, TiltChoice};
use crate::kernel::Outcome;
use crate::klartext::language::feed::feed_word;
use crate::klartext::language::scan::Scanner;
use crate::klartext::language::words::{ROTARY, Words, slot};
use geom::{Mat3, Vec3, direction};
use program::{Axes, Rule};

/// Cosine up to which two vectors, written with a few decimals, count as being at right angles.
const SQUARE: f64 = 1e-4;

/// What the rotary axes do when a plane is declared.
enum Positioning {
    /// By `MOVE` X, Y and Z go along, so that the tip stays where it is on the part.
    Turn {
        rapid: bool,
        retract: bool,
        moves: bool,
        choice: TiltChoice,
    },
    Stay,
}

impl Control<'_, '_> {
    /// A `PLANE` block, from behind the keyword.
    pub(crate) fn plane(&mut self, s: &mut Scanner) -> Outcome {
        let (kind, span) = s.token();
        let turn = match kind {
            b"SPATIAL" => Some(spatial(self.numbers(s, [b"SPA", b"SPB", b"SPC"])?)),
            // Precession about Z, nutation about the X turned by it, rotation about the new Z.
            b"EULER" => {
                let angles = self.numbers(s, [b"EULPR", b"EULNU", b"EULROT"])?;
                Some(geom::Euler::MovingZxz.matrix(angles.map(f64::to_radians)))
            }
            b"VECTOR" => {
                let base = Vec3::from(self.numbers(s, [b"BX", b"BY", b"BZ"])?);
                let normal = Vec3::from(self.numbers(s, [b"NX", b"NY", b"NZ"])?);
                Some(upright(base, normal).ok_or_else(|| {
                    s.error_block(
                        Rule::TiltedPlane,
                        "the base and the normal vector must be at right angles",
                    )
                })?)
            }
            b"POINTS" => {
                let first = Vec3::from(self.numbers(s, [b"P1X", b"P1Y", b"P1Z"])?);
                let second = Vec3::from(self.numbers(s, [b"P2X", b"P2Y", b"P2Z"])?);
                let third = Vec3::from(self.numbers(s, [b"P3X", b"P3Y", b"P3Z"])?);
                Some(through(first, second, third).ok_or_else(|| {
                    s.error_block(Rule::TiltedPlane, "the three points lie on a line")
                })?)
            }
            b"RELATIV" => {
                let turn = self.relative(s)?;
                let active = self.tilt.as_ref().map_or(Mat3::IDENTITY, |tilt| tilt.turn);
                Some(active * turn)
            }
            b"RESET" => None,
            b"PROJECTED" | b"AXIAL" => {
                let message = match kind {
                    b"AXIAL" => "the plane of axis angles follows from the machine's kinematics",
                    _ => "PLANE PROJECTED is not supported",
                };
                return Err(s
                    .error(Rule::Unsupported, span, message)
                    .help("use PLANE SPATIAL")
                    .into());
            }
            _ => return Err(s.error(Rule::UnknownWord, span, "this kind of PLANE is not known")),
        };
        let positioning = self.positioning_of_plane(s)?;
        self.may_tilt(s)?;
        self.tilt_to(turn, positioning)
    }

    /// Whether a plane can be tilted as things stand.
    fn may_tilt(&self, s: &Scanner) -> Outcome {
        if self.compensation != program::Compensation::Off {
            return Err(s.error_block(Rule::TiltedPlane, "a plane is tilted with R0"));
        }
        if !self.settings.rotary.contains(&true) {
            return Err(s.error_block(Rule::TiltedPlane, "the machine has no rotary axes"));
        }
        if self.outside.is_more_than_a_shift() {
            let message = "how mirrored, rotated or scaled coordinates are tilted is not known";
            let help = "set cycles 8, 10, 11 and 26 back before PLANE";
            return Err(s.error_block(Rule::Transformation, message).help(help).into());
        }
        if self.tilt.as_ref().is_some_and(|tilt| !tilt.inside.is_empty()) {
            let message = "the coordinates are transformed within the plane that is left";
            let help = "set the datum shift and cycles 8, 10, 11 and 26 back first";
            return Err(s.error_block(Rule::TiltedPlane, message).help(help).into());
        }
        Ok(())
    }

    /// `CYCL DEF 19.1 A B C`: the plane of one spatial angle, or without an angle the plane of the machine.
    /// Whether the rotary axes turn at once is up to the machine, so where they are is not known.
    pub(super) fn working_plane(&mut self, s: &mut Scanner) -> Outcome {
        let words = Words::read(s, ROTARY, self)?;
        let bad = |message| Err(s.error_block(Rule::TiltedPlane, message));
        if !words.is_plain() || words.is_incremental(ROTARY) {
            return bad("cycle 19 takes A, B and C here, absolute");
        }
        let angles = [0, 1, 2].map(|axis| words.get(slot::A + axis).unwrap_or(0.0));
        let tilted = angles.iter().filter(|angle| **angle != 0.0).count();
        if tilted > 1 {
            let message = "whether several angles are spatial angles or positions of the rotary axes is \
                           up to the machine";
            return Err(s.error_block(Rule::Unsupported, message).help("use PLANE SPATIAL").into());
        }
        self.may_tilt(s)?;
        // The positions that give the plane: that of the axis that it is tilted about.
        let reached = (0..3).all(|axis| angles[axis] == 0.0 || self.settings.rotary[axis]);
        for (q, angle) in (120..).zip(angles) {
            self.registers.preassign(q, if reached { angle } else { f64::NAN });
        }
        self.tilt_to((tilted > 0).then(|| spatial(angles)), Positioning::Stay)
    }

    /// Three words that must stand in this order, each with a number.
    fn numbers(&self, s: &mut Scanner, addresses: [&[u8]; 3]) -> Outcome<[f64; 3]> {
        let mut values = [0.0; 3];
        for (value, address) in values.iter_mut().zip(addresses) {
            let given = s.take_symbol(address).then(|| s.value(&self.registers)).transpose()?;
            let Some(given) = given else {
                let address = String::from_utf8_lossy(address);
                return Err(s.error_block(
                    Rule::TiltedPlane,
                    format!("{address} with a number is missing"),
                ));
            };
            *value = given;
        }
        Ok(values)
    }

    /// `PLANE RELATIV SPB+45`: one spatial angle in the active plane.
    fn relative(&self, s: &mut Scanner) -> Outcome<Mat3> {
        for (i, address) in [b"SPA", b"SPB", b"SPC"].into_iter().enumerate() {
            if s.take_symbol(address) {
                let mut angles = [0.0; 3];
                angles[i] = s.value(&self.registers)?;
                return Ok(spatial(angles));
            }
        }
        Err(s.error_here(Rule::TiltedPlane, "SPA, SPB or SPC with a number is missing"))
    }

    fn tilt_to(&mut self, turn: Option<Mat3>, positioning: Positioning) -> Outcome {
        let turned = matches!(positioning, Positioning::Turn { .. });
        self.forget_position();
        self.forget_rotary();
        self.pole = None;
        let inside = Transforms::default();
        self.tilt = turn.map(|turn| Tilt { turn, inside, turned });
        if let Positioning::Turn { rapid, retract, moves, choice } = positioning {
            if retract {
                self.emit(Action::Home(Axes::Z))?;
            }
            if moves {
                self.emit(Action::Risk(Risk::PLANE_MOVE.into()))?;
            }
            if self.tilt.is_none() {
                self.degrees = [0.0; 3];
            }
            self.emit(Action::Swivel(choice))?;
            let pose = self.pose(self.here);
            self.emit(if rapid { Action::Rapid(pose) } else { Action::Line(pose) })?;
        }
        Ok(())
    }

    /// The end of a PLANE block: what the rotary axes do, and which solution they take.
    fn positioning_of_plane(&self, s: &mut Scanner) -> Outcome<Positioning> {
        let (mut positioning, mut taken) = (None, TiltChoice::ShorterWithin);
        while !s.is_done() {
            let (token, span) = s.token();
            let known = match token {
                b"TURN" | b"MOVE" if positioning.is_none() => {
                    positioning = Some(self.turning(s, token == b"MOVE")?);
                    true
                }
                b"STAY" if positioning.is_none() => {
                    positioning = Some(Positioning::Stay);
                    true
                }
                b"SEQ+" | b"SEQ-" if taken == TiltChoice::ShorterWithin => {
                    taken = TiltChoice::Sequence(token == b"SEQ+");
                    true
                }
                b"SYM+" | b"SYM-" if taken == TiltChoice::ShorterWithin => {
                    taken = TiltChoice::Symmetry;
                    true
                }
                // What a free C axis does: it does not change the plane.
                b"TABLE" | b"COORD" => s.take(b"ROT"),
                _ => false,
            };
            if !known {
                return Err(s.error(
                    Rule::UnknownWord,
                    span,
                    "this word is not understood in a PLANE block",
                ));
            }
        }
        if let Some(Positioning::Turn { choice, .. }) = &mut positioning {
            *choice = taken;
        }
        positioning.ok_or_else(|| {
            let message = "the block must say what the rotary axes do";
            s.error_block(Rule::TiltedPlane, message).help("TURN FMAX, MOVE FMAX or STAY").into()
        })
    }

    /// Behind TURN or MOVE: `MB MAX` and the feed, in any order.
    fn turning(&self, s: &mut Scanner, moves: bool) -> Outcome<Positioning> {
        let (mut rapid, mut retract) = (None, false);
        loop {
            if s.peek().starts_with(b"F") && rapid.is_none() {
                let Some(word) = s.word(&self.registers)? else { break };
                rapid = Some(
                    feed_word(s, &word, self.tool_feed)?
                        == crate::klartext::language::feed::FeedWord::Max,
                );
            } else if s.take_symbol(b"DIST") {
                // About which point MOVE turns; where the tool is then is not known anyway.
                s.value(&self.registers)?;
            } else if s.peek() == b"MB" && !retract {
                s.expect(b"MB")?;
                s.expect(b"MAX")?;
                retract = true;
            } else {
                break;
            }
        }
        let rapid = rapid.ok_or_else(|| {
            s.error_block(Rule::Feed, "the turning of the rotary axes needs F or FMAX")
        })?;
        Ok(Positioning::Turn { rapid, retract, moves, choice: TiltChoice::ShorterWithin })
    }

    /// A `FUNCTION` block, from behind the keyword.
    pub(crate) fn function_block(&mut self, s: &mut Scanner) -> Outcome {
        if s.take(b"RESET") {
            s.expect(b"TCPM")?;
            s.finish()?;
            self.release_tip();
            return Ok(());
        }
        if s.take(b"MODE") {
            s.expect(b"MILL")?;
            return s.finish();
        }
        if s.take(b"DWELL") {
            return self.function_dwell(s);
        }
        if !s.take(b"TCPM") {
            let message = "of FUNCTION blocks only TCPM, DWELL TIME and MODE MILL are supported";
            return Err(s.error_here(Rule::Unsupported, message));
        }
        s.expect(b"F")?;
        if s.take(b"CONT") {
            let message = "F CONT (feed of the axes as programmed) is not supported yet";
            return Err(s.error_block(Rule::Unsupported, message).help("use F TCP").into());
        }
        s.expect(b"TCP")?;
        s.expect(b"AXIS")?;
        let tip = match s.token() {
            (b"POS", _) => Tip::Kept,
            (b"SPAT", _) => Tip::KeptSpatial,
            (_, span) => return Err(s.error(Rule::UnknownWord, span, "AXIS takes POS or SPAT")),
        };
        s.expect(b"PATHCTRL")?;
        let great_circle = !s.take(b"AXIS");
        if great_circle {
            s.expect(b"VECTOR")?;
        }
        // Which point of the tool is kept (newer software); the tip is also what is kept without.
        if s.take(b"REFPNT") {
            s.expect(b"TIP-TIP")?;
        }
        if s.peek().starts_with(b"F")
            && let Some(word) = s.word(&self.registers)?
        {
            feed_word(s, &word, self.tool_feed)?;
        }
        s.finish()?;
        self.great_circle = great_circle;
        self.keep_tip(s, tip)
    }

    pub(super) fn keep_tip(&mut self, s: &Scanner, tip: Tip) -> Outcome {
        if !self.settings.rotary.contains(&true) {
            return Err(s.error_block(Rule::ToolCenter, "the machine has no rotary axes"));
        }
        self.change_tip(tip);
        Ok(())
    }

    pub(super) fn release_tip(&mut self) {
        self.change_tip(Tip::Free);
    }

    /// With turned rotary axes the same place has other coordinates with and without M128; a vector
    /// or spatial angles leave the axes where only the kinematics know.
    fn change_tip(&mut self, tip: Tip) {
        if self.tip == tip {
            return;
        }
        let upright = self.vector.is_none() && self.degrees == [0.0; 3];
        if !upright && self.tilt.is_none() {
            self.forget_position();
        }
        if !upright
            && (self.vector.is_some() || Tip::KeptSpatial == tip || Tip::KeptSpatial == self.tip)
        {
            self.forget_rotary();
        }
        self.tip = tip;
    }
}

/// The frame whose Z is along `normal` and whose X is along `base`, which must be at right angles: what
/// a control does with a base that is not is a matter of its machine parameters.
fn upright(base: Vec3, normal: Vec3) -> Option<Mat3> {
    let z = direction(normal)?;
    let base = direction(base)?;
    let x = direction(base.reject_from_normalized(z))?;
    (base.dot(z).abs() < SQUARE).then(|| Mat3::from_cols(x, z.cross(x), z))
}

/// The frame through three points: X from the first to the second, the third on the side of Y (the
/// normal is that of a right-handed turn from the first by the second to the third).
fn through(first: Vec3, second: Vec3, third: Vec3) -> Option<Mat3> {
    let x = direction(second - first)?;
    let z = direction(x.cross(third - first))?;
    Some(Mat3::from_cols(x, z.cross(x), z))
}
