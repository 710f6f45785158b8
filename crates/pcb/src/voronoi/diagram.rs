//! The Voronoi diagram of the conductors: all points that are as near to one conductor as to another.
//!
//! The diagram of points on the boundaries has the right chains of edges, in the right order round each
//! conductor, and nearly in the right place: each of its vertices is then moved to where it is equally far
//! from the boundaries themselves.

use super::samples::{Boundary, Sample};
use geom::Vec2;
use geom::ending::go_on;
use geom::region::Index;
use spade::handles::{FaceHandle, InnerTag};
use spade::{DelaunayTriangulation, InsertionError, Triangulation};

/// How much nearer to the conductors a chain may come between two vertices, as a part of their clearance, before a
/// vertex is added there.
const NARROWER: f64 = 0.01;

/// How often a vertex is moved towards where it is equally far from everything.
const TRIES: usize = 8;

/// A point of the diagram.
#[derive(Clone, Copy, Debug)]
pub(super) struct DiagramPoint {
    pub(super) at: Vec2,
    /// How far it is from the nearest conductor, mm.
    pub(super) clearance: f64,
    /// Two islands that are this near.
    pub(super) islands: [usize; 2],
}

/// A vertex and the neighbours that edges lead to.
struct Vertex {
    /// None where it is lost between conductors that nearly touch.
    place: Option<DiagramPoint>,
    links: [Option<u32>; 3],
}

type Triangle<'a> = FaceHandle<'a, InnerTag, Sample, (), (), ()>;

/// The chains of edges between `samples` of different conductors, each from where three or more meet to
/// the next such vertex, or closed.
///
/// # Errors
/// Where a sample is no place.
pub(super) fn chains(
    boundary: &Boundary,
    samples: Vec<Sample>,
    copper: &Index,
) -> Result<Vec<Vec<DiagramPoint>>, InsertionError> {
    let triangles = DelaunayTriangulation::<Sample>::bulk_load(samples)?;
    // The middles of the circles about the triangles, where these have several conductors.
    let mut vertices: Vec<Vertex> = Vec::new();
    let mut of_triangle = vec![None; triangles.num_all_faces()];
    for edge in triangles.undirected_edges() {
        let [one, other] = edge.vertices().map(|vertex| boundary.conductor(vertex.data()));
        if one.is_none() || other.is_none() || one == other {
            continue;
        }
        go_on();
        let edge = edge.as_directed();
        let sides = [edge.face().as_inner(), edge.rev().face().as_inner()];
        // Around everything is the frame, so that both are triangles.
        let [Some(left), Some(right)] = sides.map(|side| {
            let side = side?;
            let known = of_triangle.get_mut(side.index())?;
            *known.get_or_insert_with(|| {
                let corners = side.vertices().map(|vertex| *vertex.data());
                vertices.push(Vertex {
                    place: place(side, corners, boundary, copper),
                    links: [None; 3],
                });
                u32::try_from(vertices.len() - 1).ok()
            })
        }) else {
            continue;
        };
        let corners = edge.vertices().map(|vertex| *vertex.data());
        match waist(&vertices, [left, right], &corners, boundary) {
            Some(waist) => {
                let middle = vertices.len() as u32;
                vertices.push(Vertex { place: Some(waist), links: [None; 3] });
                link(&mut vertices, left, middle);
                link(&mut vertices, middle, right);
            }
            None => link(&mut vertices, left, right),
        }
    }
    Ok(chains_of(&mut vertices))
}

/// Links two vertices.
fn link(vertices: &mut [Vertex], one: u32, other: u32) {
    for (from, to) in [(one, other), (other, one)] {
        let links = vertices.get_mut(from as usize).map(|vertex| &mut vertex.links);
        if let Some(free) = links.into_iter().flatten().find(|link| link.is_none()) {
            *free = Some(to);
        }
    }
}

/// The narrowest point of the edge between two vertices, which separates two samples, where both vertices have more
/// room: between two corners the edge has no other vertex.
fn waist(
    vertices: &[Vertex],
    ends: [u32; 2],
    samples: &[Sample; 2],
    boundary: &Boundary,
) -> Option<DiagramPoint> {
    let [left, right] = ends.map(|end| vertices.get(end as usize)?.place);
    let (left, right) = (left?, right?);
    let [one, other] = samples;
    let candidate = settled((one.at + other.at) / 2.0, samples, boundary);
    let between = (left.at - candidate.at).dot(right.at - candidate.at) < 0.0;
    let narrower = candidate.nearest < left.clearance.min(right.clearance) * (1.0 - NARROWER);
    let islands = [boundary.island(one)?, boundary.island(other)?];
    (between && narrower).then_some(DiagramPoint {
        at: candidate.at,
        clearance: candidate.nearest,
        islands,
    })
}

/// The point in the middle of a triangle.
fn place(
    triangle: Triangle,
    corners: [Sample; 3],
    boundary: &Boundary,
    copper: &Index,
) -> Option<DiagramPoint> {
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
    let candidate = settled(at, &nearest, boundary);
    // Where conductors nearly touch, the points of one do not keep the circle out of it.
    let lost =
        corners.iter().any(|corner| corner.touches) && copper.island_at(candidate.at).is_some();
    if lost {
        return None;
    }
    let mut islands = nearest.iter().filter_map(|sample| boundary.island(sample));
    let islands = [islands.next()?, islands.next()?];
    Some(DiagramPoint { at: candidate.at, clearance: candidate.nearest, islands })
}

/// The point near `at` that is equally far from the boundaries around all of `samples`.
fn settled(at: Vec2, samples: &[Sample], boundary: &Boundary) -> Candidate {
    // Samples are near each other compared with the gap, so the point is near.
    let reach = samples.first().map_or(0.0, |sample| sample.at.distance(at) / 2.0);
    let mut best = Candidate::at(at, samples, boundary);
    for _ in 0..TRIES {
        let guess = match best.feet[..] {
            [a, b] => between(best.at, a, b),
            [a, b, c] => amid(a, b, c),
            _ => None,
        };
        let Some(next) = guess.map(|at| Candidate::at(at, samples, boundary)) else { break };
        let better = next.farthest - next.nearest < best.farthest - best.nearest;
        if !better || next.at.distance(at) > reach {
            break;
        }
        best = next;
    }
    best
}

/// A point, and the nearest point of each conductor around it.
struct Candidate {
    at: Vec2,
    feet: Vec<Vec2>,
    nearest: f64,
    farthest: f64,
}

impl Candidate {
    fn at(at: Vec2, samples: &[Sample], boundary: &Boundary) -> Candidate {
        let feet: Vec<Vec2> = samples.iter().map(|sample| boundary.foot(sample, at)).collect();
        let away = || feet.iter().map(|foot| foot.distance(at));
        let (nearest, farthest) =
            (away().fold(f64::INFINITY, f64::min), away().fold(0.0, f64::max));
        Candidate { at, feet, nearest, farthest }
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

/// The chains between vertices; their links are used up.
fn chains_of(vertices: &mut [Vertex]) -> Vec<Vec<DiagramPoint>> {
    let links = |vertex: &Vertex| vertex.links.iter().flatten().count();
    let ends: Vec<u32> =
        (0..).zip(&*vertices).filter(|(_, k)| links(k) != 2).map(|(i, _)| i).collect();
    let all = 0..vertices.len() as u32;
    let is_end: Vec<bool> = vertices.iter().map(|vertex| links(vertex) != 2).collect();
    let mut chains = Vec::new();
    // What is closed has no end to begin with.
    for from in ends.into_iter().chain(all) {
        while let Some(chain) = chain(vertices, from, &is_end) {
            go_on();
            chains.push(chain);
        }
    }
    chains
}

/// The chain from a vertex to the next end, or back to it; `None` where none is left.
fn chain(vertices: &mut [Vertex], from: u32, is_end: &[bool]) -> Option<Vec<DiagramPoint>> {
    let mut at = from;
    let mut chain = Vec::new();
    while let Some(next) = take_link(vertices, at) {
        chain.push(at);
        at = next;
        if at == from || is_end.get(at as usize) == Some(&true) {
            break;
        }
    }
    chain.push(at);
    let place = |vertex: u32| vertices.get(vertex as usize)?.place;
    (chain.len() > 1).then(|| chain.into_iter().filter_map(place).collect())
}

/// Removes one link of a vertex; the answer is where it led to.
fn take_link(vertices: &mut [Vertex], at: u32) -> Option<u32> {
    let to = vertices.get_mut(at as usize)?.links.iter_mut().find_map(Option::take)?;
    let mut back = vertices.get_mut(to as usize)?.links.iter_mut();
    *back.find(|link| **link == Some(at))? = None;
    Some(to)
}
