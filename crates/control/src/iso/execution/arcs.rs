//! `G2` and `G3`.

use super::motion::Target;
use super::state::Tilt;
use super::step::Step;
use crate::event::{Action, ArcTo};
use crate::iso::dialects::facts::OuterCenter;
use crate::iso::language::Fault;
use geom::Vec3;
use program::Rule;

/// The letters of the centre, by axis.
const CENTER: [u8; 3] = *b"IJK";

impl Step<'_, '_, '_> {
    /// An arc or helix to `target`.
    pub(super) fn arc(&mut self, target: Target, clockwise: bool) -> Result<(), Fault> {
        let start = self.state.position;
        let [first, second, third] = self.state.plane.axes();
        self.arc_is_legal(&target)?;
        let center = if self.block.has(b'R') {
            self.center_by_radius(target.point, clockwise)?
        } else {
            self.center_by_words()?
        };
        let radius = |p: Vec3| (p[first] - center[first]).hypot(p[second] - center[second]);
        let (from, to) = (radius(start), radius(target.point));
        let rules = &self.facts.arcs;
        if from < rules.least_radius {
            return Err(self.block.whole(Rule::Arc, "the arc starts on its own centre"));
        }
        let inches = self.state.inches == Some(true);
        if !(rules.is_circle)(inches, from, to) {
            let message = format!(
                "the end is {to:.4} mm from the centre and the start {from:.4} mm: not on one circle"
            );
            return Err(self.block.whole(Rule::Arc, message));
        }
        let turns = self.turns()?;
        self.stood();
        self.switch_compensation();
        let mut axis = Vec3::ZERO;
        axis[third] = if clockwise { -1.0 } else { 1.0 };
        self.actions.push(Action::Arc(Box::new(ArcTo {
            end: self.state.pose(target.point, target.rotary),
            center: self.state.place.point(center),
            normal: self.state.place.normal(axis),
            turns,
        })));
        self.state.arrive(target.point, target.rotary);
        Ok(())
    }

    fn arc_is_legal(&self, target: &Target) -> Result<(), Fault> {
        let start = self.state.position;
        if start.is_nan() || target.point.is_nan() {
            let message = "an arc, and where the tool stands is not known in all of X, Y and Z";
            return Err(self.block.whole(Rule::UnknownPosition, message));
        }
        if let Tilt::Declared(_) = self.state.tilt {
            let message =
                "a move in a tilted plane before G53.1 has brought the tool upright to it";
            return Err(self.block.whole(Rule::TiltedPlane, message));
        }
        if target.named & !7 != 0 {
            let message = "a rotary axis in an arc";
            return Err(self.block.whole(Rule::Arc, message));
        }
        // LinuxCNC may begin it on an arc; where that arc then leads needs the tool's radius.
        let begins = self.facts.arcs.may_compensate && self.state.compensation.is_on();
        if self.compensation_waits() && !begins {
            let message = "radius compensation starts and ends on a straight move, not on an arc";
            return Err(self.block.whole(Rule::Compensation, message));
        }
        let [first, second, _] = self.state.plane.axes();
        let transform = &self.state.frames.transform;
        if transform.factor(first).abs() != transform.factor(second).abs() {
            let message = "an arc while the axes of the plane have two scales is no arc";
            return Err(self.block.whole(Rule::Frame, message));
        }
        if self.facts.arcs.needs_axis && target.named & (1 << first | 1 << second) == 0 {
            let message = "an arc needs an axis word of its plane";
            return Err(self.block.whole(Rule::Arc, message));
        }
        Ok(())
    }

    /// The centre for a radius: positive up to a half circle, negative above.
    fn center_by_radius(&mut self, end: Vec3, clockwise: bool) -> Result<Vec3, Fault> {
        let start = self.state.position;
        let [first, second, _] = self.state.plane.axes();
        if let Some(&letter) = CENTER.iter().find(|&&letter| self.block.has(letter)) {
            let message = format!("an arc by R and by {}: one or the other", char::from(letter));
            return Err(self.block.at_word(letter, Rule::Arc, message));
        }
        let radius = self.take_length(b'R')?.unwrap_or(0.0);
        let (along, across) = (end[first] - start[first], end[second] - start[second]);
        let chord = along.hypot(across);
        if chord < 1e-9 {
            let message = "an arc by R ends where it starts: a full circle needs its centre";
            return Err(self.block.at_word(b'R', Rule::Arc, message));
        }
        if chord / 2.0 > radius.abs() + self.facts.arcs.radius_slack {
            let message = format!(
                "the radius {:.4} mm does not reach: the ends are {chord:.4} mm apart",
                radius.abs()
            );
            return Err(self.block.at_word(b'R', Rule::Arc, message));
        }
        let height = (radius * radius - chord * chord / 4.0).max(0.0).sqrt();
        // Seen along the way, the centre of a short counter-clockwise arc lies on the left.
        let left = if clockwise == (radius < 0.0) { height } else { -height };
        let mut center = start;
        center[first] += along / 2.0 - left * across / chord;
        center[second] += across / 2.0 + left * along / chord;
        Ok(center)
    }

    /// The centre from I, J, K.
    fn center_by_words(&mut self) -> Result<Vec3, Fault> {
        let start = self.state.position;
        let [first, second, third] = self.state.plane.axes();
        self.pass_outer_center(CENTER[third])?;
        let mut center = start;
        let mut given = 0;
        for axis in [first, second] {
            match self.take_length(CENTER[axis])? {
                Some(value) if self.state.centers_absolute => center[axis] = value,
                Some(value) => center[axis] += value,
                None => continue,
            }
            given += 1;
        }
        if given == 0 || self.state.centers_absolute && given < 2 {
            let (i, j) = (char::from(CENTER[first]), char::from(CENTER[second]));
            let message = format!("an arc without its centre ({i}, {j}) and without R");
            return Err(self.block.whole(Rule::Arc, message));
        }
        Ok(center)
    }

    /// The word of the centre along the axis of the arc. GRBL drops it (`gcode.c`, step 20), as the
    /// posts of FreeCAD do; LinuxCNC refuses it (found with `rs274`); that it is 0 says nothing anywhere.
    fn pass_outer_center(&mut self, letter: u8) -> Result<(), Fault> {
        let Some(word) = self.block.take(letter) else { return Ok(()) };
        match self.facts.arcs.outer_center {
            OuterCenter::Ignored => return Ok(()),
            OuterCenter::Zero if word.value == 0.0 => return Ok(()),
            OuterCenter::Zero | OuterCenter::Refused => {}
        }
        let plane = self.state.plane.name();
        let message = format!("{} has no meaning in an arc in {plane}", char::from(letter));
        Err(self.block.at_word(letter, Rule::Arc, message))
    }

    /// LinuxCNC: `P` counts the turns begun, 1 where it is not given.
    fn turns(&mut self) -> Result<u32, Fault> {
        // With G4 the P is that of the dwell, which has taken it.
        if !self.facts.arcs.counts_turns {
            return Ok(0);
        }
        match self.take_whole(b'P')? {
            None => Ok(0),
            Some(0) => Err(self.block.at_word(b'P', Rule::Arc, "P counts turns from 1")),
            Some(turns) => Ok(turns - 1),
        }
    }
}
