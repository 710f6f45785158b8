//! Shells: copies of a surface within the body, a distance apart.
//!
//! A shell is made of the body's triangles, whose corners are moved inwards so that all faces around a corner move by the distance.
//! Where the body is thin or hollow a shell made so crosses itself or the surface. A place of it belongs to the shell only where no part
//! of the whole surface is nearer than the distance ([`Depth`]): what has crossed is nearer, and is left out.

use crate::mesh::Mesh;
use geom::ending::go_on;
use glam::{DMat3, DVec3};
use std::collections::HashMap;

impl Mesh {
    /// Its surface moved inwards by `distance` mm; where it is inside out, outwards of what it says.
    pub fn shell(&self, distance: f64) -> Mesh {
        let same = self.same_places();
        let inwards = if self.health().volume < 0.0 { distance } else { -distance };
        // Of each corner the sums of its faces' normals and of their squares, each weighed by the face's angle there.
        let mut sums = vec![(DMat3::ZERO, DVec3::ZERO); self.vertices.len()];
        for triangle in 0..self.triangles.len() as u32 {
            go_on();
            let corners = self.corners(triangle);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let Some(normal) = normal.try_normalize() else { continue };
            for i in 0..3 {
                let [here, next, last] = [0, 1, 2].map(|j| corners[(i + j) % 3]);
                let weight = (next - here).angle_between(last - here);
                let (squares, normals) =
                    &mut sums[same[self.triangles[triangle as usize][i] as usize] as usize];
                let square =
                    DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
                *squares += square * weight;
                *normals += normal * weight;
            }
        }
        let moved = |(i, place): (usize, &DVec3)| {
            go_on();
            let (squares, normals) = sums[same[i] as usize];
            *place + inwards * solved(squares, normals)
        };
        let vertices = self.vertices.iter().enumerate().map(moved).collect();
        Mesh { vertices, triangles: self.triangles.clone(), ..Mesh::default() }
    }
}

/// The shortest way by which all faces move by 1 whose normals and their squares have these sums; as good as can be where there are
/// more than three.
fn solved(squares: DMat3, normals: DVec3) -> DVec3 {
    let trace = squares.x_axis.x + squares.y_axis.y + squares.z_axis.z;
    if trace == 0.0 {
        return DVec3::ZERO;
    }
    // A little more on the diagonal, so that one plane alone can be solved; what that takes comes back step by step.
    let inverse = (squares + DMat3::from_diagonal(DVec3::splat(1e-3 * trace))).inverse();
    let mut way = DVec3::ZERO;
    for _ in 0..STEPS {
        way += inverse * (normals - squares * way);
    }
    // A spike would go far out of the body.
    way.clamp_length_max(LONGEST)
}

/// Steps of [`solved`]: each leaves a thousandth of what is missing on one plane, and some tenth at a corner of 10°.
const STEPS: u32 = 30;

/// How far a corner moves at most, distances: that of a cube moves by the root of 3, that of a pyramid of 45° by 4.
const LONGEST: f64 = 8.0;

/// How far places are from a surface.
#[derive(Debug)]
pub struct Depth<'m> {
    mesh: &'m Mesh,
    /// Side of a cube, mm.
    side: f64,
    /// The triangles that may reach into each cube.
    cubes: HashMap<[i32; 3], Vec<u32>>,
}

impl<'m> Depth<'m> {
    /// For distances up to `most` mm (more than 0).
    pub fn new(mesh: &'m Mesh, most: f64) -> Depth<'m> {
        // Large triangles would lie in very many small cubes.
        let (low, high) = mesh.bounds().unwrap_or_default();
        let side = most.max((high - low).max_element() / 200.0);
        let mut depth = Depth { mesh, side, cubes: HashMap::new() };
        for triangle in 0..mesh.triangles.len() as u32 {
            let [a, b, c] = mesh.corners(triangle);
            let [from, to] = [a.min(b).min(c), a.max(b).max(c)].map(|place| depth.cube(place));
            for z in from[2]..=to[2] {
                for y in from[1]..=to[1] {
                    go_on();
                    for x in from[0]..=to[0] {
                        depth.cubes.entry([x, y, z]).or_default().push(triangle);
                    }
                }
            }
        }
        depth
    }

    fn cube(&self, place: DVec3) -> [i32; 3] {
        (place / self.side).to_array().map(|value| value.floor() as i32)
    }

    /// Whether no part of the surface is nearer to `place` than `distance` mm, which is no more than was said.
    pub fn is_within(&self, place: DVec3, distance: f64) -> bool {
        let reach = DVec3::splat(distance);
        let [from, to] = [place - reach, place + reach].map(|corner| self.cube(corner));
        let rows = (from[2]..=to[2]).flat_map(|z| (from[1]..=to[1]).map(move |y| (y, z)));
        let mut cubes = rows.flat_map(|(y, z)| (from[0]..=to[0]).map(move |x| [x, y, z]));
        cubes.all(|cube| {
            let near = self.cubes.get(&cube).map_or(&[][..], |near| near);
            near.iter().all(|&triangle| {
                let nearest = nearest(place, self.mesh.corners(triangle));
                nearest.distance_squared(place) >= distance * distance
            })
        })
    }
}

/// The place of a triangle that is nearest to `from`: within it, on a side, or a corner.
fn nearest(from: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let is_left = |from_corner: DVec3, to: DVec3| {
        (to - from_corner).cross(from - from_corner).dot(normal) >= 0.0
    };
    if normal != DVec3::ZERO && is_left(a, b) && is_left(b, c) && is_left(c, a) {
        return from - normal * ((from - a).dot(normal) / normal.length_squared());
    }
    let on_side = |a: DVec3, b: DVec3| {
        let way = b - a;
        let part = (from - a).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
        a + way * part.clamp(0.0, 1.0)
    };
    let sides = [on_side(a, b), on_side(b, c), on_side(c, a)];
    let far = |place: &DVec3| place.distance_squared(from);
    sides.into_iter().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(a)
}
