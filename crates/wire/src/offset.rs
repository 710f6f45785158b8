//! The path of the wire's centre: offset from a contour by half the wire's diameter and the spark gap.
//!
//! The crate `cavalier_contours` calculates the offset; its result is measured in both
//! directions: the wire's centre is nowhere nearer to the contour than it must be, it is on
//! the right side, and what of the contour it does not reach is found.

use crate::contour::Contour;
use crate::near::Near;
use cavalier_contours::core::math::Vector2;
use cavalier_contours::polyline::{
    PlineSource, PlineSourceMut, Polyline, seg_arc_radius_and_center,
};
use geom::Vec2;
use program::{Diagnostic, Rule};
use sketch::{Element, SAME, finite};
use std::f64::consts::{PI, TAU};

/// By how much the wire's centre may be off, mm.
pub(crate) const EXACT: f64 = 2e-4;

/// How much material may stay in an inner corner before it is one that the wire does not reach, mm.
const LEFT: f64 = 1e-3;

/// What becomes of inner corners that the wire is too thick for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Corners {
    /// They are an error.
    #[default]
    Refuse,
    /// They become as round as the wire.
    Round,
}

/// An inner corner that the wire does not reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Line of the source of the element at whose start it is, or that is the corner.
    pub line: u32,
    /// Where it is, mm.
    pub place: Vec2,
    /// How much material stays, mm: what the wire is farther away than it should be.
    pub left: f64,
}

/// The path of the wire's centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Offset {
    /// The path; each element has the source line of the element that it is offset from.
    pub contour: Contour,
    /// The inner corners that became round.
    pub rounded: Vec<Corner>,
}

/// The contour `distance` mm to the left of `contour` in its direction of travel; to the right where
/// it is negative. Arcs stay arcs, outer corners become arcs about the corner.
///
/// # Errors
/// `self-crossing` and `too-tangled` of [`Contour::simple`]; `inner-corner` where the wire is too
/// thick and `corners` refuses that; `offset-vanishes` where it has no room at all, `offset-divides`
/// where a neck is too narrow; `offset-unsure` where the result does not hold up when it is measured.
pub fn offset(
    contour: &Contour,
    distance: f64,
    corners: Corners,
) -> Result<Offset, Box<Diagnostic>> {
    finite(&[Vec2::splat(distance)])?;
    contour.simple()?;
    if distance.abs() < SAME {
        return Ok(Offset { contour: contour.clone(), rounded: Vec::new() });
    }
    let mut parallel = polyline(contour).parallel_offset(distance);
    parallel.retain(|line| line.path_length() > 10.0 * EXACT);
    let first = contour.elements().first().map_or(0, |element| element.line);
    let found = match parallel.len() {
        0 => {
            let message = format!("no room for the wire {:.4} mm from the contour", distance.abs());
            let refused = Diagnostic::error(Rule::OffsetVanishes, message);
            return Err(refused.help("take a thinner wire, or the other side").line(first).into());
        }
        1 => elements(&parallel[0]),
        many => {
            let message = format!(
                "the path {:.4} mm from the contour falls into {many} pieces: a neck is too narrow",
                distance.abs()
            );
            let refused = Diagnostic::error(Rule::OffsetDivides, message);
            return Err(refused.help("take a thinner wire").line(first).into());
        }
    };
    let found = Contour::new(verified(contour, found, distance)?, 10.0 * EXACT)?;
    if found.is_closed() != contour.is_closed() {
        return Err(unsure(first, "an open and a closed end"));
    }
    let rounded = unreached(contour, &found, distance.abs());
    match rounded.first() {
        Some(corner) if corners == Corners::Refuse => {
            let message = format!(
                "the wire does not reach the inner corner at X{:.4} Y{:.4}: {:.4} mm stay ({} such \
                 in all)",
                corner.place.x,
                corner.place.y,
                corner.left,
                rounded.len()
            );
            Err(Diagnostic::error(Rule::InnerCorner, message)
                .help("round the corner by the wire's offset or more, or have it rounded by --round-corners")
                .line(corner.line)
                .into())
        }
        _ => Ok(Offset { contour: found, rounded }),
    }
}

/// A contour as the library takes it: no arc of more than half a circle.
fn polyline(contour: &Contour) -> Polyline {
    let mut line = Polyline::new();
    line.set_is_closed(contour.is_closed());
    for element in contour.elements() {
        let sweep = element.turn.map_or(0.0, |turn| turn.sweep);
        let parts = (sweep.abs() / (0.9 * PI)).ceil().max(1.0);
        for i in 0..parts as usize {
            let p = element.at(i as f64 / parts);
            line.add(p.x, p.y, (sweep / parts / 4.0).tan());
        }
    }
    if !contour.is_closed() {
        line.add(contour.end().x, contour.end().y, 0.0);
    }
    line
}

/// The elements of a polyline of the library.
fn elements(line: &Polyline) -> Vec<Element> {
    let point = |p: Vector2<f64>| Vec2::new(p.x, p.y);
    line.iter_segments()
        .map(|(from, to)| {
            let (start, end) = (point(from.pos()), point(to.pos()));
            if from.bulge_is_zero() {
                return Element::line(start, end);
            }
            let center = point(seg_arc_radius_and_center(from, to).1);
            Element::arc(start, end, center, 4.0 * from.bulge.atan())
        })
        .collect()
}

/// Gives each element the source line of the element that it is offset from, joins the pieces of one arc, and checks:
/// nowhere nearer than the offset, in the middle just as far, on the right side.
fn verified(
    contour: &Contour,
    found: Vec<Element>,
    distance: f64,
) -> Result<Vec<Element>, Box<Diagnostic>> {
    let mut near = Near::new(contour.elements());
    let mut joined: Vec<Element> = Vec::with_capacity(found.len());
    for element in found {
        if element.length() < SAME {
            continue;
        }
        let middle = element.at(0.5);
        let Some(nearest) = near.nearest(middle, distance.abs() + EXACT) else { continue };
        let source = &contour.elements()[nearest.element];
        let element = element.from_line(source.line);
        if let Some(least) = near.clearance(&element, distance.abs() - EXACT) {
            return Err(unsure(source.line, &format!("{least:.5} mm from the contour")));
        }
        if nearest.distance > distance.abs() + EXACT {
            return Err(unsure(
                source.line,
                &format!("{:.5} mm from the contour", nearest.distance),
            ));
        }
        let side = source.tangent(nearest.t).perp_dot(middle - source.at(nearest.t));
        let inner = nearest.t > 1e-6 && nearest.t < 1.0 - 1e-6;
        if inner && side.signum() != distance.signum() {
            return Err(unsure(source.line, "the wrong side of the contour"));
        }
        match joined.last_mut() {
            Some(last) if let Some(whole) = one_arc(last, &element) => *last = whole,
            _ => joined.push(element),
        }
    }
    if let [first, .., last] = joined.as_slice()
        && let Some(whole) = one_arc(last, first)
    {
        joined.pop();
        joined[0] = whole;
    }
    Ok(joined)
}

/// Two pieces of one arc as one: the library divides arcs where we did.
fn one_arc(a: &Element, b: &Element) -> Option<Element> {
    let (p, q) = (a.turn?, b.turn?);
    let same = a.line == b.line
        && a.end.distance(b.start) < SAME
        && p.center.distance(q.center) < 1e-6
        && p.sweep.signum() == q.sweep.signum()
        && (a.start.distance(p.center) - b.start.distance(q.center)).abs() < 1e-6;
    let sweep = p.sweep + q.sweep;
    (same && sweep.abs() < TAU + 1e-9)
        .then(|| Element::arc(a.start, b.end, p.center, sweep).from_line(a.line))
}

/// The points of `contour` that are farther from the wire's centre than the offset: of neighbours
/// the farthest.
fn unreached(contour: &Contour, found: &Contour, distance: f64) -> Vec<Corner> {
    let mut near = Near::new(found.elements());
    let mut corners: Vec<Corner> = Vec::new();
    let mut within = false;
    for element in contour.elements() {
        for t in [0.0, 0.25, 0.5, 0.75] {
            let place = element.at(t);
            let left = near
                .nearest(place, distance + LEFT)
                .map_or(f64::INFINITY, |n| n.distance - distance);
            let corner = Corner { line: element.line, place, left };
            match corners.last_mut() {
                _ if left <= LEFT => {}
                Some(last) if within => {
                    if left > last.left {
                        *last = corner;
                    }
                }
                _ => corners.push(corner),
            }
            within = left > LEFT;
        }
    }
    corners
}

fn unsure(line: u32, what: &str) -> Box<Diagnostic> {
    let message = format!("the wire offset did not come out right: {what}");
    Diagnostic::error(Rule::OffsetUnsure, message)
        .help("simplify the contour near this line: very short elements, arcs that nearly touch")
        .line(line)
        .into()
}
