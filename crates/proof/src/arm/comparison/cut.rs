//! What the control has to have been given in a cut: frames, feed, spindle, coolant, corners.

use super::super::expected::{Expected, Step};
use super::super::follow::angle;
use super::{Comparison, Standing, refused};
use control::Dialect;
use control::{ArmMove, Corner, Rounding};
use geom::Frame;
use program::{Coolant, Diagnostic, Outcome, Rule, Spindle};

impl Comparison<'_> {
    /// # Errors
    /// Base and tool are not those of the cell, within the rounding of their words.
    pub(super) fn frames(&self) -> Outcome {
        let length = self.expected.get(self.next).or(self.expected.last());
        let length = length.and_then(|expected| expected.state.tool_length);
        let Some(tool) = self.cell.tool(length) else {
            let message =
                "neither the source nor `tool_length` of the cell states the length of the tool";
            return refused(Rule::ToolLength, message);
        };
        // Poses in the world itself are compared there.
        let in_world = self.running.base == Some(Frame::IDENTITY);
        let base = if in_world { Frame::IDENTITY } else { self.cell.part };
        let asks = Dialect::named(&self.machine.reader).is_some_and(Dialect::asks_for_load);
        let states = self.cell.load_number.is_some() || self.cell.load.is_some();
        if !self.loaded && (asks || states) {
            let message = "the program moves and has not stated the load on the flange";
            return refused(Rule::Payload, message);
        }
        for (name, stated, wanted) in
            [("base", self.running.base, base), ("tool", self.running.tool, tool)]
        {
            let Some(stated) = stated else {
                return refused(
                    Rule::Frame,
                    format!("the program moves and has not stated its {name}"),
                );
            };
            let apart = stated.translation.distance(wanted.translation);
            let turn = angle(&stated.matrix3, &wanted.matrix3).to_degrees();
            if apart > self.report.tolerances.tip_mm || turn > 2e-4 {
                let message = format!(
                    "the {name} of the program is {apart:.4} mm and {turn:.5}° off that of the machine's file"
                );
                return refused(Rule::Frame, message);
            }
        }
        match self.running.on_flange {
            Some(false) => Ok(()),
            Some(true) | None => refused(
                Rule::Frame,
                "the program does not say that the part stands and the tool moves",
            ),
        }
    }

    /// # Errors
    /// Feed, spindle or coolant are not as the source wants them in this cut.
    pub(super) fn in_cut(&self, expected: &Expected) -> Outcome {
        let state = &expected.state;
        let Some(feed) = self.running.feed else {
            return refused(Rule::NoFeed, "the program cuts and has not stated its feed");
        };
        if (feed - state.feed).abs() > self.feed_step.max(self.feed_part * state.feed.abs()) {
            let message = format!("the feed is {feed:.3} mm/min, the source has {:.3}", state.feed);
            let help = "the feed of the source before this motion, in the unit of the language";
            return Err(Diagnostic::error(Rule::Feed, message).help(help).into());
        }
        if !self.turns_as(state.spindle) {
            let message =
                format!("the spindle is {}, the source has {:?}", self.spindle(), state.spindle);
            return refused(Rule::Spindle, message);
        }
        if self.running.is_on && self.running.runs_up > 0.0 {
            let message =
                format!("the cut begins before the spindle has had {} s", self.running.runs_up);
            return refused(Rule::SpindleDwell, message);
        }
        let coolant = match state.coolant {
            Coolant::Off => !self.running.coolant,
            Coolant::Flood => self.running.coolant,
            Coolant::Mist | Coolant::FloodAndMist | Coolant::Through => false,
        };
        match coolant {
            true => Ok(()),
            false => refused(
                Rule::Coolant,
                format!("the coolant is not as the source wants it ({:?})", state.coolant),
            ),
        }
    }

    /// Whether the spindle is as the source has it.
    pub(super) fn turns_as(&self, wanted: Spindle) -> bool {
        match wanted {
            Spindle::Off => !self.running.is_on,
            Spindle::Clockwise(speed) => {
                self.running.is_on
                    && self
                        .running
                        .speed
                        .is_some_and(|own| (own - speed).abs() <= self.speed_step())
            }
            Spindle::CounterClockwise(_) => false,
        }
    }

    /// A step of the output that says the speed, 1/min.
    pub(super) fn speed_step(&self) -> f64 {
        let full = self.cell.spindle_analog.map_or(0.0, |(_, full)| full);
        full * self.machine.words.get("VALUE").map_or(1e-3, machine::Word::resolution)
    }

    /// # Errors
    /// The first motion behind a cut begins in it, and the spindle is neither as in that cut nor as the source has it here.
    pub(super) fn leaves_turning(&mut self, start: &Standing) -> Outcome {
        let at = self.in_part(&start.tool);
        let (tip, axis) = (at.translation, -at.matrix3.z_axis);
        let is_free = tip.dot(axis) > self.cuts.reach(axis) + self.tip(true);
        let as_in_cut = self.turned.take().is_none_or(|turned| turned == self.turns());
        let wanted = self.expected.get(self.next).map(|expected| expected.state.spindle);
        if is_free || as_in_cut || wanted.is_some_and(|wanted| self.turns_as(wanted)) {
            return Ok(());
        }
        let message = format!(
            "the tool leaves a cut with the spindle {}, which is not as in the cut",
            self.spindle()
        );
        let help = "stop the spindle, or change its speed, behind the rapid that takes the tool out of the cut: in the source where that stops it in the cut (SPINDL/OFF)";
        Err(Diagnostic::error(Rule::Spindle, message).help(help).into())
    }

    /// Whether the tool stands where a cut of the source has led it that does not draw it back along its axis.
    pub(super) fn stands_in_cut(&self) -> bool {
        let in_cut = match self.last_motion() {
            Some(Step::Line(from, to)) => {
                let way = to.point() - from.point();
                let aside = way.reject_from_normalized(to.axis()).length();
                way.dot(to.axis()) <= 0.0 || aside > self.report.tolerances.tip_mm
            }
            last => matches!(last, Some(Step::Arc(..) | Step::Contour(_))),
        };
        self.done > 0.0 || (in_cut && !self.is_home)
    }

    /// How the spindle turns, for a message.
    pub(super) fn spindle(&self) -> String {
        match self.running.is_on {
            true => format!("on at {:.0} 1/min", self.running.speed.unwrap_or(0.0)),
            false => String::from("off"),
        }
    }

    /// How the spindle turns: whether, and how fast.
    pub(super) fn turns(&self) -> (bool, Option<f64>) {
        (self.running.is_on, self.running.speed)
    }

    /// # Errors
    /// A corner is left by more than is allowed, overlaps with the one before on a motion of this length, or is passed from a cut to what
    /// is none.
    pub(super) fn corner(
        &mut self,
        motion: &ArmMove,
        (before, length): (Option<Rounding>, f64),
        cuts: bool,
        expected: &Expected,
    ) -> Outcome {
        if before.is_some() && !cuts {
            return refused(Rule::PathTolerance, "the corner between a cut and a rapid is passed");
        }
        let own = match motion.corner {
            Corner::Within(rounding) => Some(rounding),
            Corner::Exact | Corner::Unbounded => None,
        };
        let rounded: f64 = [before, own]
            .into_iter()
            .flatten()
            .filter(|rounding| !rounding.shortened)
            .map(|rounding| rounding.distance)
            .sum();
        if rounded > length {
            let message = format!(
                "the corners at both ends of a motion of {length:.4} mm reach {rounded:.4} mm into it: the controller would skip a point"
            );
            return refused(Rule::PathTolerance, message);
        }
        let rounding = match motion.corner {
            Corner::Exact => return Ok(()),
            Corner::Within(rounding) => rounding,
            Corner::Unbounded => {
                return refused(
                    Rule::PathTolerance,
                    "a corner is passed by an amount that is not stated in mm",
                );
            }
        };
        // Both sides of the corner are left within the distance: no point between is farther from them than half of it.
        let own = self.machine.path_tolerance();
        let allowed = expected.state.corner.map_or(own, |wanted| wanted.min(own));
        let distance = rounding.distance;
        if !cuts || distance / 2.0 > allowed + 1e-9 {
            let message =
                format!("a corner may be left by {} mm, {allowed} mm are allowed", distance / 2.0);
            return refused(Rule::PathTolerance, message);
        }
        self.open = Some(rounding);
        Ok(())
    }
}
