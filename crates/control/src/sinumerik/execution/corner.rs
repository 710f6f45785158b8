//! Chamfers and arcs between two blocks: `CHF=`, `CHR=`, `RND=`, `RNDM=`, with `FRC=` and `FRCM=`
//! (Programming Manual 11/2006, 4.22).
//!
//! What goes between two blocks is known when the second is. So a block with a corner is held until then,
//! and what is said in between with it.

use super::interpreter::Interpreter;
use crate::event::{Action, ArcTo, Event};
use crate::sinumerik::Fallible;
use crate::sinumerik::language::block::{Block, Corner};
use crate::sinumerik::language::scan::Source;
use geom::{Arc, Vec3};
use program::{Diagnostic, Feed};

/// Most records between the two blocks of a corner; our own limit.
const MOST_BETWEEN: usize = 100;

/// Directions that differ by less, radians, make no corner.
const STRAIGHT_ON: f64 = 1e-6;

/// The way of a block in the coordinates of the program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Element {
    /// Where it starts.
    pub start: Vec3,
    /// Where it ends.
    pub end: Vec3,
    /// Centre and direction of an arc.
    pub circle: Option<(Vec3, Vec3)>,
    /// Whether it can have a corner: a cut without further turns.
    pub cut: bool,
}

/// A block whose corner waits for the next one.
pub(crate) struct Held {
    element: Element,
    corner: Corner,
    /// Whether every block has such a corner (`RNDM`), so that there need not be one here.
    modal: bool,
    feed: Option<f64>,
    line: u32,
    /// What has been said since.
    between: Vec<Event>,
}

/// Where a corner leaves the first block, where it meets the second, and its arc.
struct Joint {
    from: Vec3,
    to: Vec3,
    circle: Option<(Vec3, Vec3)>,
}

impl Element {
    /// The direction at the start (false) or the end (true), a unit vector.
    fn direction(&self, end: bool) -> Vec3 {
        match self.circle {
            None => (self.end - self.start).normalize_or_zero(),
            Some((center, normal)) => {
                let point = if end { self.end } else { self.start };
                normal.cross(point - center).normalize_or_zero()
            }
        }
    }

    /// Whether `point`, which lies on its line or circle, is within it.
    fn passes(&self, point: Vec3) -> bool {
        match self.circle {
            None => {
                let way = self.end - self.start;
                let t = (point - self.start).dot(way) / way.length_squared();
                (-1e-9..=1.0 + 1e-9).contains(&t)
            }
            Some((center, normal)) => {
                Arc::new(self.start, self.end, center, normal, 0, f64::INFINITY)
                    .is_ok_and(|arc| arc.nearest(point).1 < 1e-6)
            }
        }
    }

    /// Where centres of arcs of `radius` lie that touch it on its left (1) or right (-1) side: a line by a
    /// point and its direction, or a circle by its centre and radius.
    fn beside(&self, up: Vec3, radius: f64, side: f64) -> Locus {
        match self.circle {
            None => {
                let way = self.direction(true);
                Locus::Line(self.end + up.cross(way) * (side * radius), way)
            }
            Some((center, normal)) => {
                let turn = normal.dot(up).signum();
                let own = (self.end - center).length();
                Locus::Circle(center, own - side * turn * radius)
            }
        }
    }

    /// Where an arc about `center` touches it.
    fn touched(&self, center: Vec3) -> Vec3 {
        match self.circle {
            None => {
                let way = self.direction(true);
                self.end + way * (center - self.end).dot(way)
            }
            Some((own, _)) => own + (center - own).normalize_or_zero() * (self.end - own).length(),
        }
    }
}

/// A line or a circle in the plane.
#[derive(Clone, Copy)]
enum Locus {
    Line(Vec3, Vec3),
    Circle(Vec3, f64),
}

impl Locus {
    /// The point of both that is nearest to `corner`.
    fn meet(self, other: Locus, up: Vec3, corner: Vec3) -> Option<Vec3> {
        let nearest = |a: Vec3, b: Vec3| {
            if a.distance_squared(corner) <= b.distance_squared(corner) { a } else { b }
        };
        match (self, other) {
            (Locus::Line(a, u), Locus::Line(b, v)) => {
                let cross = up.dot(u.cross(v));
                (cross.abs() > 1e-12).then(|| a + u * (up.dot((b - a).cross(v)) / cross))
            }
            (Locus::Line(a, u), Locus::Circle(c, r)) | (Locus::Circle(c, r), Locus::Line(a, u)) => {
                let foot = a + u * (c - a).dot(u);
                let half = r * r - foot.distance_squared(c);
                (r > 0.0 && half >= 0.0)
                    .then(|| nearest(foot + u * half.sqrt(), foot - u * half.sqrt()))
            }
            (Locus::Circle(c, r), Locus::Circle(d, s)) => {
                let way = d - c;
                let apart = way.length();
                if r <= 0.0 || s <= 0.0 || apart <= 1e-12 {
                    return None;
                }
                let along = (apart * apart + r * r - s * s) / (2.0 * apart);
                let half = r * r - along * along;
                let foot = c + way / apart * along;
                let aside = up.cross(way / apart);
                (half >= 0.0)
                    .then(|| nearest(foot + aside * half.sqrt(), foot - aside * half.sqrt()))
            }
        }
    }
}

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
    ) -> Fallible<()> {
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
            return Err(source.block_error("corner", message));
        }
        let corner = match corner {
            Corner::Chamfer(length) => Corner::Chamfer(length * unit),
            Corner::ChamferSide(length) => Corner::ChamferSide(length * unit),
            Corner::Round(radius) if modal => Corner::Round(radius),
            Corner::Round(radius) => Corner::Round(radius * unit),
        };
        let (Corner::Chamfer(size) | Corner::ChamferSide(size) | Corner::Round(size)) = corner;
        if size < 0.0 {
            return Err(source.block_error("corner", "the size of a corner has no sign"));
        }
        let feed = block.rare.as_ref().and_then(|rare| rare.corner_feed);
        let feed = feed.or(self.state.corner_feed).filter(|feed| *feed > 0.0);
        let feed = feed.map(|feed| feed * self.state.feed_unit);
        let line = self.line.unwrap_or(source.line);
        self.held =
            Some(Box::new(Held { element, corner, modal, feed, line, between: Vec::new() }));
        Ok(())
    }

    /// A record while a block is held.
    #[cold]
    pub fn keep(&mut self, source: &Source, record: Event) -> Fallible<()> {
        let Some(held) = &mut self.held else { return self.send(record) };
        let said = matches!(
            record.action,
            Action::Feed(_)
                | Action::Spindle(_)
                | Action::Coolant(_)
                | Action::Comment(_)
                | Action::Message(_)
                | Action::Risk(_)
        );
        if said && held.between.len() < MOST_BETWEEN {
            held.between.push(record);
            return Ok(());
        }
        let pauses = matches!(
            record.action,
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
        self.send(record)
    }

    /// The held block goes all its way, as nothing follows that it could have a corner with.
    pub fn release(&mut self, source: &Source) -> Fallible<()> {
        let Some(held) = self.held.take() else { return Ok(()) };
        if !held.modal {
            return Err(no_second_side(source, held.line));
        }
        let action = self.piece(source, &held.element)?;
        self.send(Event { line: held.line, action })?;
        held.between.into_iter().try_for_each(|record| self.send(record))
    }

    /// Puts the corner of the held block between it and `second`, which then starts behind it; whether
    /// there was one.
    fn join(&mut self, source: &Source, held: Held, second: &mut Element) -> Fallible<bool> {
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
                return Err(source.block_error("corner", message));
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
        held.between.into_iter().try_for_each(|record| self.send(record))?;
        let Some(joint) = joint else { return Ok(false) };
        let piece = Element { start: joint.from, end: joint.to, circle: joint.circle, cut: true };
        let action = self.piece(source, &piece)?;
        let active = self.state.active_feed();
        let feed = match (held.feed, active) {
            (Some(feed), Some(Feed::PerMinute(_))) => Some(Feed::PerMinute(feed)),
            (Some(feed), Some(Feed::PerTurn(_))) => Some(Feed::PerTurn(feed)),
            (Some(_), _) => {
                return Err(source.block_error("feed", "FRC= needs G94 or G95"));
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
    fn joint(&self, source: &Source, held: &Held, second: &Element) -> Fallible<Option<Joint>> {
        let error = |message: String| Err(source.block_error("corner", message));
        let first = &held.element;
        let up = Vec3::AXES[self.state.plane_normal];
        let corner = first.end;
        let (before, behind) = (first.direction(true), second.direction(false));
        let turn = up.dot(before.cross(behind)).atan2(before.dot(behind));
        let (Corner::Chamfer(size) | Corner::ChamferSide(size) | Corner::Round(size)) = held.corner;
        if turn.abs() < STRAIGHT_ON || size == 0.0 {
            return Ok(None);
        }
        if turn.abs() > std::f64::consts::PI - STRAIGHT_ON {
            return error(format!("the way turns back at the corner of line {}", held.line));
        }
        let side = turn.signum();
        let joint = match held.corner {
            Corner::Round(radius) => {
                let one = first.beside(up, radius, side);
                let other = second.beside(up, radius, side);
                one.meet(other, up, corner).map(|center| Joint {
                    from: first.touched(center),
                    to: second.touched(center),
                    circle: Some((center, up * side)),
                })
            }
            _ if first.circle.is_some() || second.circle.is_some() => {
                return error("a chamfer beside an arc is not supported; write its line".into());
            }
            Corner::Chamfer(length) => {
                let back = length / (2.0 * (turn / 2.0).cos());
                Some(Joint {
                    from: corner - before * back,
                    to: corner + behind * back,
                    circle: None,
                })
            }
            Corner::ChamferSide(back) => Some(Joint {
                from: corner - before * back,
                to: corner + behind * back,
                circle: None,
            }),
        };
        match joint.filter(|joint| first.passes(joint.from) && second.passes(joint.to)) {
            Some(joint) => Ok(Some(joint)),
            None => error(format!(
                "the corner of line {} with {size} mm does not fit between its blocks",
                held.line
            )),
        }
    }

    /// The record of a way.
    pub fn piece(&self, source: &Source, element: &Element) -> Fallible<Action> {
        let end = self.state.pose(element.end);
        let Some((center, normal)) = element.circle else { return Ok(Action::Line(end)) };
        let Some(normal) = self.state.frames.circle_normal(normal) else {
            let message = "the arc is no arc in this frame: its plane is scaled unevenly";
            return Err(source.block_error("arc", message));
        };
        let center = self.state.frames.in_work_frame(center);
        Ok(Action::Arc(ArcTo { end, center, normal, turns: 0 }.into()))
    }
}

fn no_second_side(source: &Source, line: u32) -> Box<Diagnostic> {
    let message =
        format!("the corner of line {line} has no second side: a cut must follow at once");
    source.block_error("corner", message)
}
