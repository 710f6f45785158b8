//! Circular pockets and patterns of holes.

use super::motion::Target;
use super::step::Step;
use crate::event::{Action, ArcTo};
use crate::iso::language::Fault;
use crate::iso::language::words::{Group, Pattern};
use geom::Vec3;
use program::Rule;

/// Most holes of a pattern.
const MOST_HOLES: u32 = 9999;

impl Step<'_, '_, '_> {
    /// Mach3 `G12`, `G13`: out along X by I, a full circle about where the tool stood, and back.
    pub(super) fn pocket(&mut self, clockwise: bool) -> Result<(), Fault> {
        self.not_compensated("a circular pocket")?;
        let center = self.state.position;
        if self.state.plane.axes()[2] != 2 {
            return Err(self.block.whole(Rule::Pattern, "a circular pocket lies in the plane G17"));
        }
        if center.is_nan() {
            let message = "a circular pocket, and where the tool stands is not known";
            return Err(self.block.whole(Rule::UnknownPosition, message));
        }
        let Some(radius) = self.take_length(b'I')?.filter(|&radius| radius > 0.0) else {
            return Err(self.block.whole(Rule::Pattern, "a circular pocket needs its radius I"));
        };
        self.feed_for_cut()?;
        let rotary = self.state.rotary;
        let rim = Target { point: center + Vec3::X * radius, rotary, named: 1 };
        self.straight(rim, false)?;
        let normal = if clockwise { Vec3::NEG_Z } else { Vec3::Z };
        self.actions.push(Action::Arc(Box::new(ArcTo {
            end: self.state.pose(rim.point, rotary),
            center: self.state.place.point(center),
            normal: self.state.place.normal(normal),
            turns: 0,
        })));
        self.straight(Target { point: center, ..rim }, false)
    }

    /// Haas `G70` (I radius, J angle of the first, L holes on a circle), `G71` (K angle between holes
    /// of an arc), `G72` (I distance, J angle of a line), about where the tool stands, in the cycle
    /// that is active.
    pub(super) fn pattern(&mut self, pattern: Pattern) -> Result<(), Fault> {
        let start = self.state.position;
        let [first, second, _] = self.state.plane.axes();
        if self.state.cycle.is_none() {
            let message = "a pattern of holes, and no cycle is active";
            return Err(self.block.at_group(Group::OneShot, Rule::Pattern, message));
        }
        let size = self.take_length(b'I')?;
        let angle = self.take_degrees(b'J')?.unwrap_or(0.0);
        let step = match pattern {
            Pattern::Arc => self.take_degrees(b'K')?,
            Pattern::Circle | Pattern::Line => Some(0.0),
        };
        let count = self.take_whole(b'L')?.filter(|count| (1..=MOST_HOLES).contains(count));
        let (Some(size), Some(step), Some(count)) = (size, step, count) else {
            let message = "the pattern needs I, L holes, and on an arc K";
            return Err(self.block.at_group(Group::OneShot, Rule::Pattern, message));
        };
        for n in 0..count {
            let n = f64::from(n);
            let (length, degrees) = match pattern {
                Pattern::Circle => (size, angle + 360.0 * n / f64::from(count)),
                Pattern::Arc => (size, angle + step * n),
                Pattern::Line => (size * n, angle),
            };
            let (sin, cos) = degrees.to_radians().sin_cos();
            let mut place = start;
            place[first] += length * cos;
            place[second] += length * sin;
            self.hole_at(place)?;
        }
        Ok(())
    }
}
