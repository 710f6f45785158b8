//! Elements of a contour, and the corners between them.

use super::state::Control;
use super::state::contour::{Bend, Cut, Element, Waiting};
use crate::kernel::Outcome;
use crate::kernel::corner::{self, Misfit, Shape};
use crate::klartext::language::feed::{FeedWord, feed_word};
use crate::klartext::language::scan::Scanner;
use crate::klartext::language::words::{RADIUS, Words, slot};
use geom::Vec3;
use program::{Feed, Rule};

/// Angles, radians, up to which two directions count as the same.
const SMOOTH: f64 = 1e-6;

/// A unit vector in the plane turned to the left.
pub(super) fn left_of(along: Vec3) -> Vec3 {
    Vec3::new(-along.y, along.x, 0.0)
}

/// The element that replaces the corner between two others, or why that cannot be.
fn cut_off(first: &Element, second: &Element, shape: Shape) -> Result<Element, &'static str> {
    if first.tangent_at_end().is_none() || second.tangent_at_start().is_none() {
        return Err("where an element of the corner leads is not known");
    }
    if !first.is_plane() || !second.is_plane() {
        return Err("the elements of the corner must lie in the plane XY");
    }
    let no_corner = "there is no corner: the elements run into each other or back";
    let joint = corner::joint(&first.part(), &second.part(), Vec3::Z, shape, SMOOTH);
    let joint = joint.map_err(|misfit| match misfit {
        Misfit::TurnsBack => no_corner,
        Misfit::ChamferAtArc => "a chamfer stands between two straight lines",
        Misfit::TooLarge => "no such corner fits between its elements: one of them is too short",
    });
    let joint = joint?.ok_or(no_corner)?;
    let arc = joint.circle.map(|(center, turn)| Bend { center, sense: turn.z, turns: 0 });
    Ok(Element { start: joint.from, end: joint.to, arc })
}

impl Control<'_, '_> {
    /// `RND R5 F100`.
    pub(crate) fn rounding(&mut self, s: &mut Scanner) -> Outcome {
        let words = Words::read(s, RADIUS, self)?;
        let radius = words.get(slot::R).filter(|radius| *radius > 0.0);
        let Some(radius) = radius.filter(|_| {
            words.compensation.is_none() && words.functions.is_empty() && !words.is_rapid()
        }) else {
            return Err(s.error_block(Rule::MissingWord, "RND takes R with a radius, and F"));
        };
        self.cut(s, Cut { shape: Shape::Round(radius), feed: words.feed })
    }

    /// `CHF 12 F250`.
    pub(crate) fn chamfer(&mut self, s: &mut Scanner) -> Outcome {
        let length = s.value(&self.registers)? * self.unit;
        let feed = match s.word(&self.registers)? {
            Some(word) => Some(feed_word(s, &word, self.tool_feed)?),
            None => None,
        };
        s.finish()?;
        if length <= 0.0 || feed == Some(FeedWord::Max) {
            return Err(s.error_block(Rule::MissingWord, "CHF takes a length, and F"));
        }
        self.cut(s, Cut { shape: Shape::ChamferSide(length), feed })
    }

    fn cut(&mut self, s: &Scanner, with: Cut) -> Outcome {
        match &mut self.waiting {
            Some(Waiting::Corner { cut: cut @ None, .. }) => {
                *cut = Some(with);
                Ok(())
            }
            _ => {
                let message = "RND and CHF stand directly behind a line or an arc at a feed";
                Err(s.error_block(Rule::Contour, message))
            }
        }
    }

    /// An element that is not rapid leads to `element.end`: it is reported, or waits for its corner.
    pub(super) fn contour_element(
        &mut self,
        s: &Scanner,
        element: Element,
        corner: bool,
    ) -> Outcome {
        if corner {
            self.here = element.end;
            self.waiting = Some(Waiting::Corner { first: element, cut: None });
            return Ok(());
        }
        self.tell(s, element)
    }

    /// The next element of the contour is known: what waits for it is reported, up to where the element
    /// begins then.
    pub(super) fn meet(&mut self, s: &Scanner, next: &Element) -> Outcome {
        let Some(waiting) = self.waiting.take() else { return Ok(()) };
        let (first, cut) = match waiting {
            Waiting::Corner { first, cut: Some(cut) } => (first, cut),
            Waiting::Corner { first, cut: None } => return self.tell(s, first),
            Waiting::Approach(approach) => return self.finish_approach(s, &approach, next),
        };
        let corner = cut_off(&first, next, cut.shape)
            .map_err(|message| s.error_block(Rule::Contour, message))?;
        self.tell(s, Element { end: corner.start, ..first })?;
        let feed = self.feed;
        self.set_feed(s, cut.feed)?;
        self.tell(s, corner)?;
        self.restore_feed(feed)
    }

    /// Another feed from here on.
    pub(super) fn take_feed(&mut self, feed: Feed) -> Outcome {
        if self.feed == Some(feed) {
            return Ok(());
        }
        self.feed = Some(feed);
        self.emit(crate::event::Action::Feed(feed))
    }

    /// Goes back to the feed from before a block with a feed of its own.
    pub(super) fn restore_feed(&mut self, feed: Option<Feed>) -> Outcome {
        match feed {
            Some(feed) => self.take_feed(feed),
            None => {
                self.feed = None;
                Ok(())
            }
        }
    }

    /// A block that is no part of a contour: nothing may wait.
    pub(crate) fn contour_is_closed(&self, s: &Scanner) -> Outcome {
        if self.waiting.is_none() {
            return Ok(());
        }
        let message = "a line or an arc must follow RND, CHF and APPR directly";
        Err(s.error_block(Rule::Contour, message))
    }
}
