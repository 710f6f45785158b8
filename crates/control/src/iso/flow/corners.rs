//! Corners between two blocks of a FANUC or Haas: `,C` cuts one off, `,R` rounds it (B-64484EN-2, "Optional chamfering and
//! corner R").
//!
//! What goes between two blocks is known when the second is. So a block with a corner is held until then.

use super::run::{Run, WaitingCorner};
use crate::WholeNumbers;
use crate::event::{Action, ArcTo, Position};
use crate::iso::dialects::facts::CornerWords;
use crate::iso::execution::state::Tilt;
use crate::iso::language::Fault;
use crate::iso::language::block::Word;
use crate::iso::language::words::WHOLE_NUMBERS_HELP;
use crate::kernel::corner::{self, Element, Misfit, Shape};
use geom::Vec3;
use program::{Diagnostic, Feed, Rule};

/// Two ways whose directions differ by less make no corner, degrees (the same chapter, "Travel distance 0").
const STRAIGHT_ON: f64 = 1.0;

impl Run<'_, '_> {
    /// The cut of the block that has been executed, from `start`, goes round the corner of the block before it; it is held
    /// where it has a corner itself.
    pub(super) fn go_round(&mut self, start: Vec3, word: Option<Word>) -> Result<(), Fault> {
        let line = self.caller.unwrap_or(self.text.1);
        let held = self.held.take();
        let actions = std::mem::take(&mut self.actions);
        let cuts = actions.iter().filter(|action| cut(action).is_some()).count();
        let others =
            actions.iter().all(|action| cut(action).is_some() || corner::may_stand_at(action));
        if cuts != 1 || !others {
            return Err(self.no_cut(held.as_ref()));
        }
        for action in actions {
            let Some((end, circle)) = cut(&action) else {
                let is_feed = matches!(action, Action::Feed(_));
                if let Some(held) = held.as_ref().filter(|_| is_feed) {
                    let message = format!(
                        "F changes behind the corner of line {}: how fast that is cut is not known",
                        held.line
                    );
                    let fault = self.block.whole(Rule::Corner, message);
                    return Err(fault.help("write F in the block with the corner").into());
                }
                self.actions.push(action);
                continue;
            };
            let mut element = Element { start, end: end.point, circle, cut: true };
            let up = self.across();
            self.has_a_plane(&element, up)?;
            if let Some(held) = &held {
                self.join(held, &mut element, end, up)?;
            }
            match word {
                Some(word) => {
                    let shape = self.shape(word)?;
                    self.held = Some(WaitingCorner { action, element, up, shape, line });
                }
                None => self.actions.push(action),
            }
        }
        Ok(())
    }

    /// Sends the held cut up to its corner, and the corner; `second`, which ends at `end`, then starts behind it.
    fn join(
        &mut self,
        held: &WaitingCorner,
        second: &mut Element,
        end: &Position,
        up: Vec3,
    ) -> Result<(), Fault> {
        let (mut first, line) = (held.action.clone(), held.line);
        let fault = |run: &Self, message: String| run.block.whole(Rule::Corner, message);
        if up != held.up || cut(&first).is_none_or(|(at, _)| at.orientation != end.orientation) {
            let message = format!(
                "the plane or the tool axis changes at the corner of line {line} (alarm PS0051)"
            );
            return Err(fault(self, message));
        }
        let straight_on = STRAIGHT_ON.to_radians();
        let joint = corner::joint(&held.element, second, up, held.shape, straight_on);
        let joint = joint.map_err(|misfit| {
            let message = match misfit {
                Misfit::TurnsBack => format!("the way turns back at the corner of line {line}"),
                Misfit::ChamferAtArc => {
                    format!("the chamfer of line {line} lies at an arc: write its line")
                }
                Misfit::TooLarge => format!(
                    "the corner of line {line} does not fit between its blocks (alarm PS0055)"
                ),
            };
            fault(self, message)
        })?;
        let Some(joint) = joint else { return self.send(line, first) };
        if let Action::Line(to) = &mut first {
            to.point = joint.from;
        } else if let Action::Arc(to) = &mut first {
            to.end.point = joint.from;
        }
        self.send(line, first)?;
        let to = Position { point: joint.to, ..*end };
        let piece = match joint.circle {
            None => Action::Line(to),
            Some((center, normal)) => {
                Action::Arc(Box::new(ArcTo { end: to, center, normal, turns: 0 }))
            }
        };
        self.send(line, piece)?;
        second.start = joint.to;
        Ok(())
    }

    /// Reports what happens in line `line`.
    fn send(&mut self, line: u32, action: Action) -> Result<(), Fault> {
        self.channel.report(line, action)
    }

    /// The unit vector across the plane, in the work frame.
    fn across(&self) -> Vec3 {
        let state = &self.control.state;
        state.place.normal(Vec3::AXES[state.plane.axes()[2]])
    }

    /// # Errors
    /// A block of a corner leaves the plane, or comes from nowhere, or counts in coordinates that are turned or scaled.
    fn has_a_plane(&self, element: &Element, up: Vec3) -> Result<(), Fault> {
        let state = &self.control.state;
        let transform = &state.frames.transform;
        let fault = |message: &str| Err(self.block.whole(Rule::Corner, message));
        if transform.turn.is_some()
            || transform.scale.is_some()
            || transform.mirror.iter().any(Option::is_some)
            || state.tilt != Tilt::None
        {
            return fault(
                "a corner (,C ,R) in turned, scaled, mirrored or tilted coordinates is not followed",
            );
        }
        let is_arc = element.circle.is_some() && self.facts.syntax.corners == CornerWords::AtLines;
        if is_arc {
            return fault("a Haas puts corners (,C ,R) between straight cuts only: write the arc");
        }
        if matches!(state.feed, Some(Feed::InverseTime(_))) {
            return fault("a corner (,C ,R) in G93: how long each part takes is not known");
        }
        let rises = (element.end - element.start).dot(up);
        if rises.is_nan() || rises.abs() > 1e-9 || element.start.is_nan() {
            return fault("a corner (,C ,R) needs a cut in the plane, from a known place");
        }
        Ok(())
    }

    /// What `,C` or `,R` asks for.
    fn shape(&self, word: Word) -> Result<Shape, Fault> {
        let (text, line) = self.text;
        let at = |rule, message: &str| -> Fault {
            let fault = Diagnostic::error(rule, message);
            fault.at(line, text, word.start as usize, word.end as usize).into()
        };
        if word.value < 0.0 {
            return Err(at(Rule::Corner, "the size of a corner has no sign"));
        }
        let Some(inches) = self.control.state.inches else {
            let fault = at(Rule::Units, "a length, and neither G20 nor G21 has been given");
            return Err(fault.help("write G20 or G21").into());
        };
        let whole_numbers = self.settings.setup.whole_numbers;
        let increment = match whole_numbers {
            _ if word.is_in_units() || word.value == 0.0 => 1.0,
            WholeNumbers::Units => 1.0,
            WholeNumbers::Increments if inches => 1e-4,
            WholeNumbers::Increments => 1e-3,
            WholeNumbers::Unknown => {
                let message = "the corner has no decimal point: units or least increments, as the \
                               machine is set";
                let fault = at(Rule::DecimalPoint, message);
                let help = WHOLE_NUMBERS_HELP;
                return Err(fault.help(help).into());
            }
        };
        let size = word.value * increment * if inches { geom::INCH } else { 1.0 };
        Ok(if word.letter == b'C' { Shape::ChamferSide(size) } else { Shape::Round(size) })
    }

    /// What to say of a block that makes no cut where a corner wants one.
    fn no_cut(&self, held: Option<&WaitingCorner>) -> Fault {
        let message = match held {
            Some(held) => format!(
                "the corner of line {} has no second side: a cut (G1, G2, G3) must follow at once (alarm \
                 PS0051)",
                held.line
            ),
            None => String::from("a corner (,C ,R) belongs to a cut: G1, G2 or G3"),
        };
        self.block.whole(Rule::Corner, message)
    }
}

/// Where a cut that may have a corner ends, and centre and direction of its arc.
fn cut(action: &Action) -> Option<(&Position, Option<(Vec3, Vec3)>)> {
    if let Action::Line(end) = action {
        return Some((end, None));
    }
    let Action::Arc(to) = action else { return None };
    (to.turns == 0).then_some((&to.end, Some((to.center, to.normal))))
}
