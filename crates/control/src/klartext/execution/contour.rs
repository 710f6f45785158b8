//! Elements of a contour, and the corners between them.

use super::state::Control;
use crate::klartext::language::scan::{Result, Scanner};
use crate::klartext::language::words::{FeedWord, RADIUS, Words, feed_word, slot};
use geom::{Vec3, direction};
use program::Feed;

/// A straight line or an arc in the plane XY, in the coordinates of the blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Element {
    pub(super) start: Vec3,
    pub(super) end: Vec3,
    /// What makes it an arc.
    pub(super) arc: Option<Bend>,
}

/// How an arc turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bend {
    pub(super) center: Vec3,
    /// 1 counter-clockwise, −1 clockwise.
    pub(super) sense: f64,
    /// Full turns more than the shortest.
    pub(super) turns: u32,
}

/// What waits for the next element of the contour.
#[derive(Clone, Copy)]
pub(super) enum Waiting {
    /// An element up to a corner that is cut off.
    Corner { first: Element, cut: Option<Cut> },
    /// An approach, whose last part depends on where the contour begins.
    Approach(super::approach::Approach),
}

/// How a corner is cut off, and the feed for that.
#[derive(Clone, Copy)]
pub(super) struct Cut {
    kind: CutKind,
    feed: Option<FeedWord>,
}

#[derive(Clone, Copy)]
enum CutKind {
    /// `RND`: by an arc of this radius.
    Rounding(f64),
    /// `CHF`: by a line that begins and ends so far from the corner.
    Chamfer(f64),
}

/// Sines up to which two directions count as the same.
const SMOOTH: f64 = 1e-6;

impl Element {
    /// The direction at the start, a unit vector in the plane; `None` where the element has no length
    /// there or is not known.
    pub(super) fn tangent_at_start(&self) -> Option<Vec3> {
        self.tangent(self.start)
    }

    /// The direction at the end.
    pub(super) fn tangent_at_end(&self) -> Option<Vec3> {
        self.tangent(self.end)
    }

    fn tangent(&self, at: Vec3) -> Option<Vec3> {
        match self.arc {
            None => direction((self.end - self.start).with_z(0.0)),
            Some(Bend { center, sense, .. }) => {
                direction((Vec3::Z * sense).cross((at - center).with_z(0.0)))
            }
        }
    }

    /// Whether it lies in a plane parallel to XY.
    fn is_plane(&self) -> bool {
        self.start.z == self.end.z
    }

    /// The curve at distance `by` to the left.
    fn offset(&self, by: f64) -> Option<Curve> {
        match self.arc {
            None => {
                let along = self.tangent_at_start()?;
                Some(Curve::Line(self.start + left_of(along) * by, along))
            }
            Some(Bend { center, sense, .. }) => {
                let radius = (self.start - center).with_z(0.0).length() - by * sense;
                (radius > 0.0).then_some(Curve::Circle(center, radius))
            }
        }
    }

    /// The point of the element nearest to a point that is beside it.
    fn foot(&self, p: Vec3) -> Option<Vec3> {
        match self.arc {
            None => {
                let along = self.tangent_at_start()?;
                Some(self.start + along * (p - self.start).dot(along))
            }
            Some(Bend { center, .. }) => {
                let center = center.with_z(self.start.z);
                let radius = (self.start - center).length();
                Some(center + direction((p - center).with_z(0.0))? * radius)
            }
        }
    }

    /// How far along the element a point of it is: 0 at the start, 1 at the end.
    fn parameter(&self, p: Vec3) -> f64 {
        let Some(Bend { center, sense, .. }) = self.arc else {
            let way = (self.end - self.start).with_z(0.0);
            return (p - self.start).dot(way) / way.length_squared();
        };
        let angle = |q: Vec3| {
            let (a, b) = ((self.start - center).with_z(0.0), (q - center).with_z(0.0));
            (a.cross(b).z * sense).atan2(a.dot(b)).rem_euclid(std::f64::consts::TAU)
        };
        let whole = angle(self.end);
        angle(p) / if whole < 1e-9 { std::f64::consts::TAU } else { whole }
    }
}

/// What an offset element lies on.
enum Curve {
    /// Through a point along a unit vector.
    Line(Vec3, Vec3),
    Circle(Vec3, f64),
}

/// A unit vector in the plane turned to the left.
pub(super) fn left_of(along: Vec3) -> Vec3 {
    Vec3::new(-along.y, along.x, 0.0)
}

/// Where two curves meet, at most twice; NaN where they do not.
fn meet(a: &Curve, b: &Curve) -> [Vec3; 2] {
    match (a, b) {
        (Curve::Line(p, d), Curve::Line(q, e)) => {
            let along = (*q - *p).cross(*e).z / d.cross(*e).z;
            [*p + *d * along; 2]
        }
        (Curve::Line(p, d), Curve::Circle(center, radius))
        | (Curve::Circle(center, radius), Curve::Line(p, d)) => {
            let middle = *p + *d * (*center - *p).dot(*d);
            let away = (middle - *center).with_z(0.0).length_squared();
            let half = (radius * radius - away).sqrt();
            [middle + *d * half, middle - *d * half]
        }
        (Curve::Circle(p, r), Curve::Circle(q, t)) => {
            let way = (*q - *p).with_z(0.0);
            let apart = way.length();
            let along = (apart * apart + r * r - t * t) / (2.0 * apart);
            let half = (r * r - along * along).sqrt();
            let middle = *p + way * (along / apart);
            let across = left_of(way / apart) * half;
            [middle + across, middle - across]
        }
    }
}

/// The element that replaces the corner between two others, or why that cannot be.
fn cut_off(
    first: &Element,
    second: &Element,
    kind: CutKind,
) -> std::result::Result<Element, String> {
    let (Some(before), Some(after)) = (first.tangent_at_end(), second.tangent_at_start()) else {
        return Err("where an element beside the corner leads is not known".into());
    };
    if !first.is_plane() || !second.is_plane() {
        return Err("the elements beside the corner must lie in the plane XY".into());
    }
    let bend = before.cross(after).z;
    if bend.abs() < SMOOTH {
        return Err("there is no corner: the elements run into each other or back".into());
    }
    let corner = first.end;
    let (from, center, to) = match kind {
        CutKind::Chamfer(_) if first.arc.is_some() || second.arc.is_some() => {
            return Err("a chamfer stands between two straight lines".into());
        }
        CutKind::Chamfer(length) => (corner - before * length, None, corner + after * length),
        CutKind::Rounding(radius) => {
            let side = bend.signum();
            let offset = |element: &Element| {
                element
                    .offset(side * radius)
                    .ok_or("the radius is larger than that of the arc beside it")
            };
            let near = |p: &Vec3| p.distance_squared(corner);
            let center = meet(&offset(first)?, &offset(second)?)
                .into_iter()
                .filter(|p| p.is_finite())
                .min_by(|p, q| near(p).total_cmp(&near(q)))
                .ok_or("no arc of this radius touches both elements")?;
            let feet = first.foot(center).zip(second.foot(center));
            let (from, to) = feet.ok_or("no arc of this radius touches both elements")?;
            (from, Some(Bend { center, sense: side, turns: 0 }), to)
        }
    };
    let fits = |t: f64| (-1e-9..=1.0 + 1e-9).contains(&t);
    if fits(first.parameter(from)) && fits(second.parameter(to)) {
        let arc = center.map(|bend| Bend { center: bend.center.with_z(corner.z), ..bend });
        return Ok(Element { start: from.with_z(corner.z), end: to.with_z(corner.z), arc });
    }
    Err("an element beside the corner is too short for it".into())
}

impl Control<'_, '_> {
    /// `RND R5 F100`.
    pub(crate) fn rounding(&mut self, s: &mut Scanner) -> Result<()> {
        let words = Words::read(s, RADIUS, self)?;
        let radius = words.get(slot::R).filter(|radius| *radius > 0.0);
        let Some(radius) = radius.filter(|_| {
            words.compensation.is_none() && words.functions.is_empty() && !words.is_rapid()
        }) else {
            return Err(s.error_block("missing-word", "RND takes R with a radius, and F"));
        };
        self.cut(s, Cut { kind: CutKind::Rounding(radius), feed: words.feed })
    }

    /// `CHF 12 F250`.
    pub(crate) fn chamfer(&mut self, s: &mut Scanner) -> Result<()> {
        let length = s.value(&self.registers)? * self.unit;
        let feed = match s.word(&self.registers)? {
            Some(word) => Some(feed_word(s, &word, self.tool_feed)?),
            None => None,
        };
        s.finish()?;
        if length <= 0.0 || feed == Some(FeedWord::Max) {
            return Err(s.error_block("missing-word", "CHF takes a length, and F"));
        }
        self.cut(s, Cut { kind: CutKind::Chamfer(length), feed })
    }

    fn cut(&mut self, s: &Scanner, with: Cut) -> Result<()> {
        match &mut self.waiting {
            Some(Waiting::Corner { cut: cut @ None, .. }) => {
                *cut = Some(with);
                Ok(())
            }
            _ => {
                let message = "RND and CHF stand directly behind a line or an arc at a feed";
                Err(s.error_block("contour", message))
            }
        }
    }

    /// An element that is not rapid leads to `element.end`: it is told, or waits for its corner.
    pub(super) fn contour_element(
        &mut self,
        s: &Scanner,
        element: Element,
        corner: bool,
    ) -> Result<()> {
        if corner {
            self.here = element.end;
            self.waiting = Some(Waiting::Corner { first: element, cut: None });
            return Ok(());
        }
        self.tell(s, element)
    }

    /// The next element of the contour is known: what waits for it is told, up to where the element
    /// begins then.
    pub(super) fn meet(&mut self, s: &Scanner, next: &Element) -> Result<()> {
        let Some(waiting) = self.waiting.take() else { return Ok(()) };
        let (first, cut) = match waiting {
            Waiting::Corner { first, cut: Some(cut) } => (first, cut),
            Waiting::Corner { first, cut: None } => return self.tell(s, first),
            Waiting::Approach(approach) => return self.finish_approach(s, &approach, next),
        };
        let corner =
            cut_off(&first, next, cut.kind).map_err(|message| s.error_block("contour", message))?;
        self.tell(s, Element { end: corner.start, ..first })?;
        let feed = self.feed;
        self.set_feed(s, cut.feed)?;
        self.tell(s, corner)?;
        self.restore_feed(feed)
    }

    /// Another feed from here on.
    pub(super) fn take_feed(&mut self, feed: Feed) -> Result<()> {
        if self.feed == Some(feed) {
            return Ok(());
        }
        self.feed = Some(feed);
        self.emit(crate::event::Action::Feed(feed))
    }

    /// Goes back to the feed from before a block with a feed of its own.
    pub(super) fn restore_feed(&mut self, feed: Option<Feed>) -> Result<()> {
        match feed {
            Some(feed) => self.take_feed(feed),
            None => {
                self.feed = None;
                Ok(())
            }
        }
    }

    /// A block that is no part of a contour: nothing may wait.
    pub(crate) fn contour_is_closed(&self, s: &Scanner) -> Result<()> {
        if self.waiting.is_none() {
            return Ok(());
        }
        let message = "a line or an arc must follow RND, CHF and APPR directly";
        Err(s.error_block("contour", message))
    }
}
