//! The upper contour of a wire that leans by an angle.

use crate::contour::Contour;
use crate::offset::EXACT;
use geom::{Turn, Vec2, turn_angle};
use program::{Diagnostic, Rule};
use sketch::{Element, SAME};
use std::f64::consts::{PI, TAU};

/// The widest corner whose radius can stay the same: beyond it the two sides nearly face each other.
const WIDEST: f64 = 5.0 / 6.0 * PI;

/// How far an arc may be from tangent to a line that it rounds: radians; or mm, by which ends in three decimals may be off, and
/// radians at most.
const SMOOTH: (f64, f64, f64) = (1e-4, 2e-3, 0.2);

/// What becomes of rounded corners between the lower and the upper contour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rounding {
    /// Their radius grows or shrinks with the lean: every corner is a piece of a cone.
    #[default]
    Conical,
    /// An arc that is tangent to the lines before and after it, and turns by at most 150°, keeps its
    /// radius: such a corner is a piece of a leaning cylinder. Other arcs are conical.
    Constant,
}

/// The contour that shall remain on the lower face, and how far to its left the wire's centre runs, mm.
#[derive(Clone, Copy, Debug)]
pub struct Remains<'a> {
    /// The contour.
    pub contour: &'a Contour,
    /// To its right where it is negative.
    pub distance: f64,
}

/// The contour that lies `distance` mm to the left of `lower`, element by element: each keeps its
/// partner, lines meet where they cross. To the right where it is negative.
///
/// Where `lower` is the path of a wire offset from a contour that `remains`, an arc about a sharp corner of that contour is
/// no radius of the part: above it runs about the upper corner, with the radius that it has below.
///
/// # Errors
/// `taper-corner` where an element has no partner: an arc whose radius would pass zero, a side that
/// would turn round, neighbours that no longer meet.
pub fn lean(
    lower: &Contour,
    distance: f64,
    rounding: Rounding,
    remains: Option<Remains>,
) -> Result<Contour, Box<Diagnostic>> {
    let elements = lower.elements();
    let n = elements.len();
    let before = |i: usize| (lower.is_closed() || i > 0).then(|| (i + n - 1) % n);
    let kept = Kept { lower, distance, rounding, remains };
    let kept = (0..n).map(|i| kept.above(i)).collect::<Result<Vec<_>, _>>()?;
    let moved = elements.iter().zip(&kept).map(|(element, kept)| match kept {
        Some(kept) => Ok(element.shaped(*kept)),
        None => aside(element, distance),
    });
    let moved: Vec<Element> = moved.collect::<Result<_, _>>()?;
    // The start of each element; after the last of an open contour, its end.
    let joint = |i: usize| -> Result<Vec2, Box<Diagnostic>> {
        let element = &elements[i];
        let Some(before) = before(i) else { return Ok(moved[i].start) };
        match (kept[before], kept[i]) {
            (Some(arc), _) => Ok(arc.end),
            (None, Some(arc)) => Ok(arc.start),
            (None, None) => meeting(&moved[before], &moved[i]).ok_or_else(|| {
                refused(element, "neighbours part from each other", "round the corner")
            }),
        }
    };
    let mut joints = (0..n).map(joint).collect::<Result<Vec<_>, _>>()?;
    let closing = if lower.is_closed() { joints.first() } else { moved.last().map(|e| &e.end) };
    joints.push(closing.copied().unwrap_or_default());
    let mut upper = Vec::with_capacity(n);
    for (i, ends) in joints.windows(2).enumerate() {
        upper.push(match kept[i] {
            Some(arc) => elements[i].shaped(geom::Element { start: ends[0], end: ends[1], ..arc }),
            None => trimmed(&elements[i], &moved[i], ends[0], ends[1])?,
        });
    }
    Contour::joined(upper, SAME)
}

/// Arcs that keep their radius on the upper contour: those about a sharp corner of the part, and where corners are
/// [`Rounding::Constant`] those between two lines.
struct Kept<'a> {
    lower: &'a Contour,
    distance: f64,
    rounding: Rounding,
    remains: Option<Remains<'a>>,
}

impl Kept<'_> {
    /// The partner of element `i`, where its radius stays. An arc that the start of the contour divides is one arc.
    fn above(&self, i: usize) -> Result<Option<geom::Element>, Box<Diagnostic>> {
        let elements = self.lower.elements();
        let Some(Turn { center, sweep }) = elements[i].turn else { return Ok(None) };
        let same = |j: usize| {
            let turn = elements[j].turn.filter(|turn| turn.center.distance(center) < 1e-6);
            turn.filter(|turn| turn.sweep.signum() == sweep.signum()).map(|turn| turn.sweep)
        };
        let (Some((first, covered)), Some((last, rest))) =
            (self.beyond(i, false, same), self.beyond(i, true, same))
        else {
            return Ok(None);
        };
        let (first, last) = (&elements[first], &elements[last]);
        let whole = covered + sweep + rest;
        let radius = elements[i].start.distance(center);
        let sharp = self.is_sharp(center, radius, sweep);
        if !sharp && !self.is_rounding(first, &elements[i], last, whole) {
            return Ok(None);
        }
        // The centre lies where both neighbours meet, moved until they run through it.
        let through = self.distance + radius * sweep.signum();
        let above = match (first.turn, last.turn) {
            (None, None) => {
                let (p, q) = (first.tangent(1.0).perp(), last.tangent(0.0).perp());
                Some(center + (p + q) * (self.distance / (1.0 + p.dot(q))))
            }
            _ => meeting(&aside(first, through)?, &aside(last, through)?),
        };
        let lost = || refused(&elements[i], "the corner has no partner", "lean less");
        let above = above.ok_or_else(lost)?;
        let (start, end) = (self.foot(first, above)?, self.foot(last, above)?);
        let turned = turn_angle(start - above, end - above);
        // Half a turn may come out on either side.
        let turned = match turned * sweep < 0.0 && turned.abs() > 3.0 {
            true => turned + TAU.copysign(sweep),
            false => turned,
        };
        if turned * sweep < 0.0 && turned.abs() > 1e-6 {
            return Err(lost());
        }
        let arc = geom::Element::arc(start, end, above, turned);
        Ok(Some(arc.part(covered / whole, (covered + sweep) / whole)))
    }

    /// The first element beyond the arc of `i`, and the sweep of what of the arc lies between.
    fn beyond(
        &self,
        i: usize,
        forward: bool,
        same: impl Fn(usize) -> Option<f64>,
    ) -> Option<(usize, f64)> {
        let n = self.lower.elements().len();
        let mut between = 0.0;
        for away in 1..n {
            let j = if forward { i + away } else { i + n - away };
            if !self.lower.is_closed() && (n > j) != forward {
                return None;
            }
            match same(j % n) {
                Some(sweep) => between += sweep,
                None => return Some((j % n, between)),
            }
        }
        None
    }

    /// Whether an arc of the wire goes about a sharp corner of what remains.
    fn is_sharp(&self, center: Vec2, radius: f64, sweep: f64) -> bool {
        let Some(Remains { contour, distance }) = self.remains else { return false };
        let about = (radius - distance.abs()).abs() < EXACT && sweep * distance < 0.0;
        about && contour.elements().iter().any(|side| side.start.distance(center) < EXACT)
    }

    /// Whether it rounds the corner between two lines: tangent to both, as far as their places are exact.
    fn is_rounding(&self, before: &Element, arc: &Element, after: &Element, sweep: f64) -> bool {
        let Some(turn) = arc.turn.filter(|_| self.rounding == Rounding::Constant) else {
            return false;
        };
        let radius = arc.start.distance(turn.center);
        let smooth = |line: &Element, place: Vec2| {
            let (along, inward) = (line.tangent(0.0), (turn.center - place) / radius);
            let off = inward.dot(along).abs();
            let near = off < SMOOTH.0 || (off * radius < SMOOTH.1 && off < SMOOTH.2);
            near && along.perp_dot(inward) * turn.sweep > 0.0
        };
        let lines = before.turn.is_none() && after.turn.is_none();
        lines && sweep.abs() <= WIDEST && smooth(before, before.end) && smooth(after, after.start)
    }

    /// Where the partner of `neighbour` is nearest to `point`.
    fn foot(&self, neighbour: &Element, point: Vec2) -> Result<Vec2, Box<Diagnostic>> {
        let moved = aside(neighbour, self.distance)?;
        Ok(match moved.turn {
            Some(Turn { center, .. }) => {
                center + (point - center).normalize_or_zero() * moved.start.distance(center)
            }
            // The tip of a cone.
            None if neighbour.turn.is_some() => moved.start,
            None => {
                let along = neighbour.tangent(0.0);
                moved.start + along * (point - moved.start).dot(along)
            }
        })
    }
}

/// A whole element `distance` to its left.
fn aside(element: &Element, distance: f64) -> Result<Element, Box<Diagnostic>> {
    if let Some(Turn { center, sweep }) = element.turn {
        let radius = element.start.distance(center);
        let rest = radius - distance * sweep.signum();
        if rest < -SAME {
            let what = format!("the radius {radius:.4} mm would become {rest:.4} mm");
            let way_out = "lean less, take a larger radius, or let corners between lines keep theirs \
                           (--rounding constant)";
            return Err(refused(element, &what, way_out));
        }
        if rest <= SAME {
            return Ok(element.shaped(geom::Element::line(center, center)));
        }
    }
    // Without length it stays where it is: its neighbours say whether they still meet.
    Ok(element.shaped(element.parallel(distance).unwrap_or(element.shape)))
}

/// Where two moved neighbours meet: of the crossings of their whole lines and circles the nearest.
fn meeting(before: &Element, after: &Element) -> Option<Vec2> {
    let middle = (before.end + after.start) / 2.0;
    let apart = before.end.distance(after.start);
    if apart < 10.0 * SAME {
        return Some(middle);
    }
    let places = before.whole_crossings(after, 1e-6).into_iter().flatten();
    let nearest =
        places.min_by(|p, q| p.distance_squared(middle).total_cmp(&q.distance_squared(middle)));
    // Circles that hardly part are joined in the middle: the source is no more exact.
    nearest.or_else(|| (apart < 1e-3).then_some(middle))
}

/// The moved element between new ends; it must still run in the direction of the one below.
fn trimmed(
    below: &Element,
    moved: &Element,
    start: Vec2,
    end: Vec2,
) -> Result<Element, Box<Diagnostic>> {
    let vanishes = || refused(below, "the element would turn round", "lean less");
    let Some(turn) = moved.turn else {
        if (end - start).dot(below.tangent(0.0)) < -SAME && below.turn.is_none() {
            return Err(vanishes());
        }
        return Ok(moved.shaped(geom::Element { start, end, turn: None }));
    };
    let turned = |from: Vec2, to: Vec2| turn_angle(from - turn.center, to - turn.center);
    let sweep = turn.sweep - turned(moved.start, start) + turned(moved.end, end);
    if sweep * turn.sweep.signum() < 0.0 || sweep.abs() > TAU + 1e-9 {
        return Err(vanishes());
    }
    Ok(moved.shaped(geom::Element { start, end, turn: Some(Turn { sweep, ..turn }) }))
}

fn refused(element: &Element, what: &str, way_out: &str) -> Box<Diagnostic> {
    let place = element.start;
    let message = format!("no upper contour at X{:.4} Y{:.4}: {what}", place.x, place.y);
    Diagnostic::error(Rule::TaperCorner, message).help(way_out).line(element.line).into()
}
