//! The web of all places that are as near to one conductor as to another.
//!
//! The Voronoi diagram of points on the boundaries has the right threads, in the right order round each
//! conductor, and nearly in the right place: each of its corners is then moved to where it is equally far
//! from the boundaries themselves.

use super::samples::{Boundary, Sample};
use geom::Vec2;
use geom::region::Index;
use spade::handles::{FaceHandle, InnerTag};
use spade::{DelaunayTriangulation, InsertionError, Triangulation};

/// How much nearer to the conductors a thread may come between two places, of what they have, before it has
/// a place there.
const NARROWER: f64 = 0.01;

/// How often a place is moved towards where it is equally far from everything.
const TRIES: usize = 8;

/// A place of the web.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) at: Vec2,
    /// How far it is from the nearest conductor, mm.
    pub(super) clearance: f64,
    /// Two islands that are this near.
    pub(super) islands: [usize; 2],
}

/// A place and the neighbours that threads lead to.
struct Knot {
    /// None where it is lost between conductors that all but touch.
    place: Option<Place>,
    links: [Option<u32>; 3],
}

type Triangle<'a> = FaceHandle<'a, InnerTag, Sample, (), (), ()>;

/// The threads of the web between `samples` of different conductors, each from where three or more meet to
/// the next such place, or closed.
///
/// # Errors
/// Where a sample is no place.
pub(super) fn threads(
    boundary: &Boundary,
    samples: Vec<Sample>,
    copper: &Index,
) -> Result<Vec<Vec<Place>>, InsertionError> {
    let triangles = DelaunayTriangulation::<Sample>::bulk_load(samples)?;
    // The middles of the circles about the triangles, where these have several conductors.
    let mut knots: Vec<Knot> = Vec::new();
    let mut of_triangle = vec![None; triangles.num_all_faces()];
    for edge in triangles.undirected_edges() {
        let [one, other] = edge.vertices().map(|vertex| boundary.conductor(vertex.data()));
        if one.is_none() || other.is_none() || one == other {
            continue;
        }
        let edge = edge.as_directed();
        let sides = [edge.face().as_inner(), edge.rev().face().as_inner()];
        // Around everything is the frame, so that both are triangles.
        let [Some(left), Some(right)] = sides.map(|side| {
            let side = side?;
            let known = of_triangle.get_mut(side.index())?;
            *known.get_or_insert_with(|| {
                let corners = side.vertices().map(|vertex| *vertex.data());
                knots
                    .push(Knot { place: place(side, corners, boundary, copper), links: [None; 3] });
                u32::try_from(knots.len() - 1).ok()
            })
        }) else {
            continue;
        };
        let corners = edge.vertices().map(|vertex| *vertex.data());
        match waist(&knots, [left, right], &corners, boundary) {
            Some(waist) => {
                let middle = knots.len() as u32;
                knots.push(Knot { place: Some(waist), links: [None; 3] });
                link(&mut knots, left, middle);
                link(&mut knots, middle, right);
            }
            None => link(&mut knots, left, right),
        }
    }
    Ok(unravelled(&mut knots))
}

/// Ties two knots.
fn link(knots: &mut [Knot], one: u32, other: u32) {
    for (from, to) in [(one, other), (other, one)] {
        let links = knots.get_mut(from as usize).map(|knot| &mut knot.links);
        if let Some(free) = links.into_iter().flatten().find(|link| link.is_none()) {
            *free = Some(to);
        }
    }
}

/// The narrowest place of the thread between two knots, which part two samples, where both knots have more
/// room: between two corners the thread has no other place.
fn waist(
    knots: &[Knot],
    ends: [u32; 2],
    samples: &[Sample; 2],
    boundary: &Boundary,
) -> Option<Place> {
    let [left, right] = ends.map(|end| knots.get(end as usize)?.place);
    let (left, right) = (left?, right?);
    let [one, other] = samples;
    let stand = settled((one.at + other.at) / 2.0, samples, boundary);
    let between = (left.at - stand.at).dot(right.at - stand.at) < 0.0;
    let narrower = stand.nearest < left.clearance.min(right.clearance) * (1.0 - NARROWER);
    let islands = [boundary.island(one)?, boundary.island(other)?];
    (between && narrower).then_some(Place { at: stand.at, clearance: stand.nearest, islands })
}

/// The place in the middle of a triangle.
fn place(
    triangle: Triangle,
    corners: [Sample; 3],
    boundary: &Boundary,
    copper: &Index,
) -> Option<Place> {
    let center = triangle.circumcenter();
    let mut at = Vec2::new(center.x, center.y);
    if !at.is_finite() {
        at = corners.iter().map(|corner| corner.at).sum::<Vec2>() / 3.0;
    }
    // One for each conductor.
    let mut nearest: Vec<Sample> = Vec::with_capacity(3);
    for corner in corners {
        let Some(own) = boundary.conductor(&corner) else { continue };
        let away = |sample: &Sample| boundary.foot(sample, at).distance(at);
        match nearest.iter_mut().find(|sample| boundary.conductor(sample) == Some(own)) {
            Some(known) if away(&corner) < away(known) => *known = corner,
            Some(_) => {}
            None => nearest.push(corner),
        }
    }
    let stand = settled(at, &nearest, boundary);
    // Where conductors all but touch, the points of one do not keep the circle out of it.
    let lost = corners.iter().any(|corner| corner.touches) && copper.island_at(stand.at).is_some();
    if lost {
        return None;
    }
    let mut islands = nearest.iter().filter_map(|sample| boundary.island(sample));
    let islands = [islands.next()?, islands.next()?];
    Some(Place { at: stand.at, clearance: stand.nearest, islands })
}

/// The place near `at` that is equally far from what is about all of some samples.
fn settled(at: Vec2, samples: &[Sample], boundary: &Boundary) -> Stand {
    // Points are near to each other for the gap, and so the place is near by.
    let reach = samples.first().map_or(0.0, |sample| sample.at.distance(at) / 2.0);
    let mut best = Stand::at(at, samples, boundary);
    for _ in 0..TRIES {
        let guess = match best.feet[..] {
            [a, b] => between(best.at, a, b),
            [a, b, c] => amid(a, b, c),
            _ => None,
        };
        let Some(next) = guess.map(|at| Stand::at(at, samples, boundary)) else { break };
        let better = next.farthest - next.nearest < best.farthest - best.nearest;
        if !better || next.at.distance(at) > reach {
            break;
        }
        best = next;
    }
    best
}

/// A place, and the nearest of each conductor about it.
struct Stand {
    at: Vec2,
    feet: Vec<Vec2>,
    nearest: f64,
    farthest: f64,
}

impl Stand {
    fn at(at: Vec2, samples: &[Sample], boundary: &Boundary) -> Stand {
        let feet: Vec<Vec2> = samples.iter().map(|sample| boundary.foot(sample, at)).collect();
        let away = || feet.iter().map(|foot| foot.distance(at));
        let (nearest, farthest) =
            (away().fold(f64::INFINITY, f64::min), away().fold(0.0, f64::max));
        Stand { at, feet, nearest, farthest }
    }
}

/// The point nearest to `at` that is as far from `a` as from `b`; `None` where these are one.
fn between(at: Vec2, a: Vec2, b: Vec2) -> Option<Vec2> {
    let across = (b - a).try_normalize()?;
    Some(at + across * ((a + b) / 2.0 - at).dot(across))
}

/// The point that is equally far from three; `None` where these are in a line.
fn amid(a: Vec2, b: Vec2, c: Vec2) -> Option<Vec2> {
    let (b, c) = (b - a, c - a);
    let middle = (b * c.length_squared() - c * b.length_squared()).perp() / (2.0 * b.perp_dot(c));
    middle.is_finite().then_some(a + middle)
}

/// The threads between knots, which lose their links.
fn unravelled(knots: &mut [Knot]) -> Vec<Vec<Place>> {
    let links = |knot: &Knot| knot.links.iter().flatten().count();
    let ends: Vec<u32> =
        (0..).zip(&*knots).filter(|(_, k)| links(k) != 2).map(|(i, _)| i).collect();
    let all = 0..knots.len() as u32;
    let is_end: Vec<bool> = knots.iter().map(|knot| links(knot) != 2).collect();
    let mut threads = Vec::new();
    // What is closed has no end to begin with.
    for from in ends.into_iter().chain(all) {
        while let Some(thread) = thread(knots, from, &is_end) {
            threads.push(thread);
        }
    }
    threads
}

/// The thread that begins at a knot, to the next end or back; `None` where none is left.
fn thread(knots: &mut [Knot], from: u32, is_end: &[bool]) -> Option<Vec<Place>> {
    let mut at = from;
    let mut thread = Vec::new();
    while let Some(next) = untie(knots, at) {
        thread.push(at);
        at = next;
        if at == from || is_end.get(at as usize) == Some(&true) {
            break;
        }
    }
    thread.push(at);
    let place = |knot: u32| knots.get(knot as usize)?.place;
    (thread.len() > 1).then(|| thread.into_iter().filter_map(place).collect())
}

/// Takes one link of a knot away, and tells where it led to.
fn untie(knots: &mut [Knot], at: u32) -> Option<u32> {
    let to = knots.get_mut(at as usize)?.links.iter_mut().find_map(Option::take)?;
    let mut back = knots.get_mut(to as usize)?.links.iter_mut();
    *back.find(|link| **link == Some(at))? = None;
    Some(to)
}
