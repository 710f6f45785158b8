//! The upper contour of a wire that leans by an angle.

use crate::contour::Contour;
use crate::element::{Element, SAME};
use geom::{Turn, Vec2, turn_angle};
use program::Diagnostic;
use std::f64::consts::{PI, TAU};

/// The widest corner whose radius can stay the same: beyond it the two sides nearly face each other.
const WIDEST: f64 = 5.0 / 6.0 * PI;

/// What becomes of rounded corners on the way up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rounding {
    /// Their radius grows or shrinks with the lean: every corner is a piece of a cone.
    #[default]
    Conical,
    /// An arc that is tangent to the lines before and after it, and turns by at most 150°, keeps its
    /// radius: such a corner is a piece of a leaning cylinder. Other arcs are conical.
    Constant,
}

/// The contour that lies `distance` mm to the left of `lower`, element by element: each keeps its
/// partner, lines meet where they cross. To the right where it is negative.
///
/// # Errors
/// `taper-corner` where an element has no partner: an arc whose radius would pass zero, a side that
/// would turn round, neighbours that no longer meet.
pub fn lean(
    lower: &Contour,
    distance: f64,
    rounding: Rounding,
) -> Result<Contour, Box<Diagnostic>> {
    let elements = lower.elements();
    let n = elements.len();
    let neighbour = |i: usize, step: usize| -> Option<usize> {
        let j = i + step;
        (lower.is_closed() || (1..=n).contains(&j)).then(|| (j + n - 1) % n)
    };
    let corner = |i: usize| -> Option<Vec2> {
        let (before, after) = (neighbour(i, 0)?, neighbour(i, 2)?);
        shift(elements.get(before)?, elements.get(i)?, elements.get(after)?, distance)
            .filter(|_| rounding == Rounding::Constant && before != after)
    };
    let shifts: Vec<Option<Vec2>> = (0..n).map(corner).collect();
    let moved = elements.iter().zip(&shifts).map(|(element, shift)| match shift {
        Some(_) => Ok(*element),
        None => aside(element, distance),
    });
    let moved: Vec<Element> = moved.collect::<Result<_, _>>()?;
    // The start of each element; after the last of an open contour, its end.
    let joint = |i: usize| -> Result<Vec2, Box<Diagnostic>> {
        let element = &elements[i];
        let Some(before) = neighbour(i, 0) else { return Ok(moved[i].start) };
        match (shifts[i], shifts[before]) {
            (Some(shift), _) | (None, Some(shift)) => Ok(element.start + shift),
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
        let (below, beside) = (&elements[i], &moved[i]);
        let element = match shifts[i] {
            Some(shift) => {
                let turn = below.turn.map(|turn| Turn { center: turn.center + shift, ..turn });
                below.shaped(geom::Element { start: ends[0], end: ends[1], turn })
            }
            None => trimmed(below, beside, ends[0], ends[1])?,
        };
        upper.push(element);
    }
    Contour::joined(upper, SAME)
}

/// A whole element `distance` to its left.
fn aside(element: &Element, distance: f64) -> Result<Element, Box<Diagnostic>> {
    if let Some(Turn { center, sweep }) = element.turn {
        let radius = element.start.distance(center);
        let rest = radius - distance * sweep.signum();
        if rest < -SAME {
            let what = format!("the radius {radius:.4} mm would become {rest:.4} mm");
            return Err(refused(element, &what, "let corners keep their radius, or lean less"));
        }
        if rest <= SAME {
            return Ok(element.shaped(geom::Element::line(center, center)));
        }
    }
    // Without length it stays where it is: its neighbours say whether they still meet.
    Ok(element.shaped(element.parallel(distance).unwrap_or(element.shape)))
}

/// By how much a corner between two lines moves, where the arc is one: tangent to both.
fn shift(before: &Element, arc: &Element, after: &Element, distance: f64) -> Option<Vec2> {
    let turn = arc.turn?;
    let lines = before.turn.is_none() && after.turn.is_none();
    let smooth = |a: &Element, b: &Element| turn_angle(a.tangent(1.0), b.tangent(0.0)).abs() < 1e-4;
    if !lines || turn.sweep.abs() > WIDEST || !smooth(before, arc) || !smooth(arc, after) {
        return None;
    }
    let (p, q) = (before.tangent(1.0).perp(), after.tangent(0.0).perp());
    Some((p + q) * (distance / (1.0 + p.dot(q))))
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

/// The moved element between new ends; it must still go the way of the one below.
fn trimmed(
    below: &Element,
    beside: &Element,
    start: Vec2,
    end: Vec2,
) -> Result<Element, Box<Diagnostic>> {
    let vanishes = || refused(below, "the element would turn round", "lean less");
    let Some(turn) = beside.turn else {
        if (end - start).dot(below.tangent(0.0)) < -SAME && below.turn.is_none() {
            return Err(vanishes());
        }
        return Ok(beside.shaped(geom::Element { start, end, turn: None }));
    };
    let turned = |from: Vec2, to: Vec2| turn_angle(from - turn.center, to - turn.center);
    let sweep = turn.sweep - turned(beside.start, start) + turned(beside.end, end);
    if sweep * turn.sweep.signum() < 0.0 || sweep.abs() > TAU + 1e-9 {
        return Err(vanishes());
    }
    Ok(beside.shaped(geom::Element { start, end, turn: Some(Turn { sweep, ..turn }) }))
}

fn refused(element: &Element, what: &str, way_out: &str) -> Box<Diagnostic> {
    let place = element.start;
    let message = format!("no upper contour at X{:.4} Y{:.4}: {what}", place.x, place.y);
    Diagnostic::error("taper-corner", message).help(way_out).line(element.line).into()
}
