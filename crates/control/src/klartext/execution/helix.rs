//! Cycle 208: a bore that is milled on a helix.

use super::hole::Hole;
use super::state::Control;
use super::state::contour::{Bend, Element};
use crate::event::Action;
use crate::kernel::Outcome;
use crate::klartext::language::scan::Scanner;
use geom::Vec3;
use program::{Feed, Rule, Spindle};

/// The most turns of one bore.
const MOST_TURNS: f64 = 10_000.0;

/// How a bore is milled. Lengths are mm.
pub(super) struct Helix {
    /// Height of the surface, and how far above and below it the helix begins and ends.
    surface: f64,
    clearance: f64,
    depth: f64,
    /// Height above the surface at which the cycle ends.
    retract: f64,
    /// Radius of the way of the tool's center; 0 where the tool is as wide as the bore.
    radius: f64,
    turns: f64,
    /// 1 counter-clockwise, −1 clockwise.
    sense: f64,
    feed: f64,
}

impl Hole<'_> {
    /// Cycle 208, or why it cannot be milled; the radius of the tool is looked at where it is given.
    pub(super) fn helix(&self, tool_radius: Option<f64>) -> Result<Helix, String> {
        let (clearance, depth, pitch) = (self.get(200), -self.get(201), self.get(334));
        if !(depth > 0.0 && clearance >= 0.0 && self.get(204) >= 0.0) {
            return Err("the depth Q201 must be negative, Q200 and Q204 must not be".into());
        }
        if !(pitch > 0.0 && self.get(206) > 0.0 && self.get(335) > 0.0) {
            return Err("Q334, Q206 and Q335 must be greater than 0".into());
        }
        // 4.2 / 0.7 is a hair above 6 in doubles: that is no turn of its own.
        let turns = (depth + clearance) / pitch;
        let whole = turns.round().max(1.0);
        let turns = if (turns - whole).abs() < 1e-9 { whole } else { turns };
        if turns > MOST_TURNS {
            return Err(format!("a helix of {turns:.0} turns, at most {MOST_TURNS} are supported"));
        }
        let bored = self.get(342);
        if !(0.0..self.get(335)).contains(&bored) {
            return Err("the roughing diameter Q342 is from 0 to less than Q335".into());
        }
        let mut radius = 0.0;
        if let Some(tool) = tool_radius {
            radius = self.get(335) / 2.0 - tool;
            if radius < 0.0 {
                return Err(format!("the tool of {} mm is wider than the bore", 2.0 * tool));
            }
            if bored == 0.0 && radius > tool {
                let message =
                    "the bore is more than twice as wide as the tool, and not roughed (Q342)";
                return Err(message.into());
            }
        }
        let sense = match self.find(351) {
            None | Some(1.0) => 1.0,
            Some(-1.0) => -1.0,
            Some(_) => return Err("Q351 is 1 (climb) or -1 (up-cut)".into()),
        };
        let (surface, feed) = (self.surface(), self.get(206));
        let retract = clearance.max(self.get(204));
        Ok(Helix { surface, clearance, depth, retract, radius, turns, sense, feed })
    }
}

impl Control<'_, '_> {
    /// Runs cycle 208 where the tool stands: over the surface to the wall on an arc that touches it, down
    /// on the helix, once round at the bottom, to the axis and out by rapid.
    pub(super) fn mill_bore(&mut self, s: &Scanner, rise: f64, level: Option<f64>) -> Outcome {
        let bad = |message| s.error_block(Rule::CycleParameter, message);
        let tool_radius = self.tool_radius.ok_or_else(|| {
            let error = bad("how wide the helix is depends on the tool, which is not known");
            error.help("give the tool in the tool table")
        })?;
        if !matches!(self.spindle, Spindle::Clockwise(_)) {
            return Err(s.error_block(Rule::Spindle, "cycle 208 counts climb and up-cut with M3"));
        }
        let hole = self.definition(s)?.hole(&self.registers);
        let helix = hole.helix(Some(tool_radius)).map_err(|message| {
            s.error_block(Rule::CycleParameter, format!("cycle 208: {message}"))
        })?;
        let surface = helix.surface + rise;
        let axis = self.here.with_z(surface);
        let at = |height: f64| axis + Vec3::Z * height;
        self.here = at(helix.clearance);
        self.cutting_pose(s, self.here)?;
        self.emit(Action::Rapid(self.pose(self.here)))?;
        let before = self.feed;
        self.take_feed(Feed::PerMinute(helix.feed))?;
        if helix.radius == 0.0 {
            self.tell(s, Element { start: self.here, end: at(-helix.depth), arc: None })?;
        } else {
            self.helix(s, &helix, axis)?;
        }
        self.restore_feed(before)?;
        self.here = at(level.map_or(helix.retract, |level| level - surface));
        self.path = None;
        self.emit(Action::Rapid(self.pose(self.here)))
    }

    /// The ways at the feed, from the axis above the bore to the axis at its bottom.
    fn helix(&mut self, s: &Scanner, helix: &Helix, axis: Vec3) -> Outcome {
        let &Helix { radius, sense, turns, .. } = helix;
        let wall = |turned: f64, height: f64| {
            let (sin, cos) = (turned.fract() * sense * std::f64::consts::TAU).sin_cos();
            axis + Vec3::new(radius * cos, radius * sin, height)
        };
        let (top, bottom) = (wall(0.0, helix.clearance), wall(turns, -helix.depth));
        let middle = |end: Vec3| (axis.with_z(end.z) + end) / 2.0;
        let mut to = |end: Vec3, center: Vec3, turns: f64| {
            let bend = Bend { center, sense, turns: turns as u32 };
            self.tell(s, Element { start: self.here, end, arc: Some(bend) })
        };
        to(top, middle(top), 0.0)?;
        // What is left of a whole number of turns is a full turn.
        to(bottom, axis, turns.ceil() - 1.0)?;
        to(bottom, axis, 0.0)?;
        to(axis.with_z(bottom.z), middle(bottom), 0.0)
    }
}
