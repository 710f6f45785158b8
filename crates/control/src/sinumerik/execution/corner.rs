//! Chamfers and arcs between two blocks: `CHF=`, `CHR=`, `RND=`, `RNDM=`, with `FRC=` and `FRCM=`
//! (Programming Manual 11/2006, 4.22).
//!
//! What goes between two blocks is known when the second is. So a block with a corner is held until then,
//! and what is said in between with it.

use super::interpreter::{Interpreter, WaitingCorner};
use crate::event::{Action, ArcTo, Event};
use crate::kernel::Outcome;

use crate::kernel::corner::{self, Element, Joint, Misfit, Shape};
use crate::kernel::source::Source;
use crate::sinumerik::language::block::{Block, Corner};
use geom::Vec3;
use program::{Diagnostic, Feed, Rule};

/// Most events between the two blocks of a corner; our own limit.
const MOST_BETWEEN: usize = 100;

/// Directions that differ by less, radians, make no corner.
const STRAIGHT_ON: f64 = 1e-6;

impl Interpreter<'_, '_> {
    /// Whether a block has to do with a corner.
    #[inline]
    pub fn cornered(&self, block: &Block) -> bool {
        self.held.is_some() || block.rare.is_some() || self.state.modal_round != 0.0
    }

    /// A block goes its way, round the corner of the block before it; it is held where it has one itself.
    #[cold]
    pub fn go_round(
        &mut self,
        source: &Source,
        block: &Block,
        mut element: Element,
        action: Action,
    ) -> Outcome {
        let own = block.rare.as_ref().and_then(|rare| rare.corner);
        let modal = own.is_none();
        let corner =
            own.or((self.state.modal_round > 0.0).then_some(Corner::Round(self.state.modal_round)));
        let mut shortened = false;
        if let Some(held) = self.held.take() {
            shortened = self.join(source, *held, &mut element)?;
        }
        let across = self.state.plane_normal;
        let level = element.start[across] == element.end[across];
        let unit = self.state.unit;
        let corner =
            corner.filter(|_| !modal || element.cut && level && element.start != element.end);
        let Some(corner) = corner else {
            let action = if shortened { self.piece(source, &element)? } else { action };
            return self.emit(source, action);
        };
        if !element.cut
            || !level
            || element.start.is_nan()
            || block.has_rotary()
            || block.has_vector()
        {
            let message = "a corner belongs to a cut in the plane, from a known place, without further \
                           turns";
            return Err(source.block_error(Rule::Corner, message));
        }
        let corner = match corner {
            Corner::Chamfer(length) => Corner::Chamfer(length * unit),
            Corner::ChamferSide(length) => Corner::ChamferSide(length * unit),
            Corner::Round(radius) if modal => Corner::Round(radius),
            Corner::Round(radius) => Corner::Round(radius * unit),
        };
        self.lean_on_plane(source)?;
        let (Corner::Chamfer(size) | Corner::ChamferSide(size) | Corner::Round(size)) = corner;
        if size < 0.0 {
            return Err(source.block_error(Rule::Corner, "the size of a corner has no sign"));
        }
        let feed = block.rare.as_ref().and_then(|rare| rare.corner_feed);
        let feed = feed.or(self.state.corner_feed).filter(|feed| *feed > 0.0);
        let feed = feed.map(|feed| feed * self.state.feed_unit);
        let line = self.line.unwrap_or(source.line);
        self.held = Some(Box::new(WaitingCorner {
            element,
            corner,
            modal,
            feed,
            line,
            between: Vec::new(),
        }));
        Ok(())
    }

    /// An event while a block is held.
    #[cold]
    pub fn keep(&mut self, source: &Source, event: Event) -> Outcome {
        let Some(held) = &mut self.held else { return self.send(event) };
        if corner::may_stand_at(&event.action) && held.between.len() < MOST_BETWEEN {
            held.between.push(event);
            return Ok(());
        }
        let pauses = matches!(
            event.action,
            Action::Stop
                | Action::OptionalStop
                | Action::Dwell(_)
                | Action::Compensation(_)
                | Action::LengthOffset(_)
                | Action::PathMode(_)
        );
        if pauses {
            return Err(no_second_side(source, held.line));
        }
        self.release(source)?;
        self.send(event)
    }

    /// The held block goes all its way, as nothing follows that it could have a corner with.
    pub fn release(&mut self, source: &Source) -> Outcome {
        let Some(held) = self.held.take() else { return Ok(()) };
        if !held.modal {
            return Err(no_second_side(source, held.line));
        }
        let action = self.piece(source, &held.element)?;
        self.send(Event { line: held.line, action })?;
        held.between.into_iter().try_for_each(|event| self.send(event))
    }

    /// Puts the corner of the held block between it and `second`, which then starts behind it; whether
    /// there was one.
    fn join(
        &mut self,
        source: &Source,
        held: WaitingCorner,
        second: &mut Element,
    ) -> Outcome<bool> {
        let across = self.state.plane_normal;
        let level = second.start[across] == second.end[across];
        if !second.cut || !level || second.start == second.end {
            let mut way = second.end - second.start;
            way[across] = 0.0;
            let leaves = second.cut && second.start != second.end && way == Vec3::ZERO;
            if !held.modal || !leaves {
                let message = format!(
                    "the corner of line {} needs a cut in the plane behind it; RNDM=0 ends rounding",
                    held.line
                );
                return Err(source.block_error(Rule::Corner, message));
            }
            self.held = Some(Box::new(held));
            self.release(source)?;
            return Ok(false);
        }
        let joint = self.joint(source, &held, second)?;
        let mut first = held.element;
        if let Some(joint) = &joint {
            first.end = joint.from;
        }
        let action = self.piece(source, &first)?;
        self.send(Event { line: held.line, action })?;
        held.between.into_iter().try_for_each(|event| self.send(event))?;
        let Some(joint) = joint else { return Ok(false) };
        let piece = Element { start: joint.from, end: joint.to, circle: joint.circle, cut: true };
        let action = self.piece(source, &piece)?;
        let active = self.state.active_feed();
        let feed = match (held.feed, active) {
            (Some(feed), Some(Feed::PerMinute(_))) => Some(Feed::PerMinute(feed)),
            (Some(feed), Some(Feed::PerTurn(_))) => Some(Feed::PerTurn(feed)),
            (Some(_), _) => {
                return Err(source.block_error(Rule::Feed, "FRC= needs G94 or G95"));
            }
            (None, _) => None,
        };
        if let Some(feed) = feed {
            self.emit(source, Action::Feed(feed))?;
        }
        self.send(Event { line: held.line, action })?;
        if let (Some(_), Some(active)) = (feed, active) {
            self.emit(source, Action::Feed(active))?;
        }
        second.start = joint.to;
        Ok(true)
    }

    /// The corner between two ways in the plane; none where the second goes straight on.
    fn joint(
        &self,
        source: &Source,
        held: &WaitingCorner,
        second: &Element,
    ) -> Outcome<Option<Joint>> {
        let shape = match held.corner {
            Corner::Chamfer(length) => Shape::Chamfer(length),
            Corner::ChamferSide(back) => Shape::ChamferSide(back),
            Corner::Round(radius) => Shape::Round(radius),
        };
        let (Corner::Chamfer(size) | Corner::ChamferSide(size) | Corner::Round(size)) = held.corner;
        let up = Vec3::AXES[self.state.plane_normal];
        corner::joint(&held.element, second, up, shape, STRAIGHT_ON).map_err(|misfit| {
            let line = held.line;
            let message = match misfit {
                Misfit::TurnsBack => format!("the way turns back at the corner of line {line}"),
                Misfit::ChamferAtArc => String::from(
                    "a chamfer before or behind an arc is not supported; write its line",
                ),
                Misfit::TooLarge => {
                    format!(
                        "the corner of line {line} with {size} mm does not fit between its blocks"
                    )
                }
            };
            source.block_error(Rule::Corner, message)
        })
    }

    /// The event of a way.
    pub fn piece(&self, source: &Source, element: &Element) -> Outcome<Action> {
        let end = self.state.pose(element.end);
        let Some((center, normal)) = element.circle else { return Ok(Action::Line(end)) };
        let Some(normal) = self.state.frames.circle_normal(normal) else {
            let message = "the arc is no arc in this frame: its plane is scaled unevenly";
            return Err(source.block_error(Rule::Arc, message));
        };
        let center = self.state.frames.in_work_frame(center);
        Ok(Action::Arc(ArcTo { end, center, normal, turns: 0 }.into()))
    }
}

fn no_second_side(source: &Source, line: u32) -> Box<Diagnostic> {
    let message =
        format!("the corner of line {line} has no second side: a cut must follow at once");
    source.block_error(Rule::Corner, message)
}
