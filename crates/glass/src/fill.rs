//! How bodies become points: surfaces by Poisson disks ([`crate::sample`]), solids, and the three ways of the source (spec 4.2 to 4.4): sections,
//! triangle filling, and parallel rays.
//!
//! Rays and solids look along a direction at nodes of a grid. Which triangles a node lies in is decided by edges that two neighbours
//! compute with the same numbers, so that a ray goes between no two of them and meets no edge twice.

use crate::cloud::{self, Point};
use crate::mesh::{Depth, Mesh};
use crate::sample::{self, Apart, Dice};
use geom::ending::{go_on, is_ended};
use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;
use std::collections::HashMap;

/// How bodies become points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fill {
    /// Points all over the surface.
    Surface,
    /// Points all over the surface, the denser the brighter it is; with this set, the denser the darker.
    Shaded(bool),
    /// Points all over the surface and within.
    Solid,
    /// Points along the contours of parallel sections.
    Sections(Sections),
    /// Points in a grid in each triangle; where none is within it, in its middle if this is set.
    Triangles(bool),
    /// Where parallel rays meet the surface.
    Rays,
}

/// How bodies are cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sections {
    /// Distance of the planes, mm; without, that of the points.
    pub layer: Option<f64>,
    /// Distance of the first and the last plane from the ends of the body, mm.
    pub first: f64,
    /// How much each contour begins later than that of the layer before, as a part of the distance of points.
    pub twist: f64,
    /// Whether an open contour has a point at its end.
    pub ends: bool,
}

/// How bodies become points, how far apart, and in which direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filling {
    /// How.
    pub fill: Fill,
    /// Distance of the points along contours, in triangles and of rays, mm; without, the smallest that keeps the spacing.
    pub step: Option<f64>,
    /// Across the planes, along the rays; of length 1.
    pub direction: DVec3,
}

/// Copies of the surface within a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shells {
    /// How many surfaces there are, the body's own among them; 1 at least.
    pub count: u32,
    /// From each to the next, mm; without, the smallest distance of points and half as much again.
    pub distance: Option<f64>,
}

/// What was left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Left {
    /// Triangles in which no point of the grid lies.
    pub triangles: u64,
    /// Triangles that lie along the planes, or along the rays, and get no points of their own.
    pub along: u64,
    /// Columns of a solid that enter the body more often than they leave it: it is open there.
    pub columns: u64,
    /// Where the first of them enters it, mm.
    pub first_column: Option<[f64; 3]>,
}

/// Points that a body becomes.
#[derive(Clone, Debug, Default)]
pub struct Points {
    /// Points of the surface that are a spacing apart.
    pub sampled: Vec<Point>,
    /// Others. They may be too close to each other, but for those of a filling that [`Filling::keeps`] the distance.
    pub others: Vec<Point>,
    /// What was left out.
    pub left: Left,
}

/// The points of `mesh` (mm).
pub fn points(mesh: &Mesh, filling: &Filling, apart: Apart, seed: u64) -> Points {
    let step = filling.step.unwrap_or(apart.rounded());
    let sampled = match filling.fill {
        Fill::Surface | Fill::Solid => sample::surface(mesh, apart, seed),
        Fill::Shaded(invert) => shaded(mesh, apart, seed, invert),
        Fill::Sections(_) | Fill::Triangles(_) | Fill::Rays => Vec::new(),
    };
    let (others, left) = match filling.fill {
        Fill::Surface | Fill::Shaded(_) => Default::default(),
        Fill::Solid => solid(mesh, step, seed),
        Fill::Sections(how) => sections(mesh, &how, step, filling.direction),
        Fill::Triangles(full) => triangles(mesh, step, full),
        Fill::Rays => rays(mesh, step, filling.direction),
    };
    Points { sampled, others, left }
}

impl Filling {
    /// Whether the points that are not sampled are as far from each other as `apart` says.
    pub fn keeps(&self, apart: Apart) -> bool {
        match self.fill {
            Fill::Surface | Fill::Shaded(_) => true,
            Fill::Solid => self.step.is_none_or(|step| step >= apart.rounded()),
            Fill::Sections(_) | Fill::Triangles(_) | Fill::Rays => false,
        }
    }

    /// Some more points than `mesh` becomes, where points may not be nearer than `spacing` (µm) on its surface.
    pub fn expected(&self, mesh: &Mesh, spacing: u32) -> f64 {
        let spacing = f64::from(spacing) * 1e-3;
        let step = self.step.unwrap_or(spacing);
        let area = mesh.area();
        match self.fill {
            Fill::Surface | Fill::Shaded(_) => area / (spacing * spacing),
            Fill::Solid => area / (spacing * spacing) + mesh.health().volume.abs() / step.powi(3),
            Fill::Sections(how) => area / (step * how.layer.unwrap_or(step)),
            Fill::Triangles(_) | Fill::Rays => area / (step * step),
        }
    }
}

/// What part of its depth the distance of a shell from the surface may miss, where the surface is curved or has many corners.
const MISSED: f64 = 0.05;

/// The points of the shells within a body: on each as far apart as those of its surface, and no part of the surface nearer than the
/// shell is deep.
pub fn shells(mesh: &Mesh, shells: Shells, apart: Apart, seed: u64) -> Vec<Point> {
    let distance = shells.distance.unwrap_or(1.5 * apart.rounded());
    let depths = (1..shells.count).map(|number| f64::from(number) * distance);
    let Some(deepest) = depths.clone().next_back() else { return Vec::new() };
    let depth = Depth::new(mesh, deepest);
    let of = |own: f64| {
        let points = sample::surface(&mesh.shell(own), apart, seed.wrapping_add(own.to_bits()));
        let is_in = |point: &Point| {
            !is_ended() && depth.is_within(cloud::place(*point), own * (1.0 - MISSED))
        };
        let within = points.into_par_iter().filter(is_in).collect::<Vec<Point>>();
        go_on();
        within
    };
    depths.flat_map(of).collect()
}

/// Points of the surface by their rank ([`sample::ranked`]), as far as it is bright there: as many of them as its light says.
fn shaded(mesh: &Mesh, apart: Apart, seed: u64, invert: bool) -> Vec<Point> {
    let (points, triangles): (Vec<Point>, Vec<u32>) =
        sample::on_triangles(mesh, apart, seed).into_iter().flatten().unzip();
    let ranked = sample::ranked(&points, apart.spacing, seed);
    let count = ranked.len() as f64;
    let is_made = |(rank, &i): (usize, &u32)| {
        let (point, triangle) = (points[i as usize], triangles[i as usize]);
        go_on();
        let light = mesh.light(triangle, cloud::place(point));
        let part = if invert { 1.0 - light } else { light };
        (rank as f64 + 0.5 < part * count).then_some(point)
    };
    ranked.iter().enumerate().filter_map(is_made).collect()
}

/// The axis X, Y or Z (0 to 2) turned about X, then Y, then Z by so many degrees.
pub fn direction(axis: usize, tilt: [f64; 3]) -> DVec3 {
    let [x, y, z] = tilt.map(f64::to_radians);
    let turn = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
    turn * DVec3::AXES[axis.min(2)]
}

/// Two directions across `along`.
fn across(along: DVec3) -> [DVec3; 2] {
    let first = along.any_orthonormal_vector();
    [first, along.cross(first)]
}

/// A triangle lies along a plane or a ray where the sine of their angle is below this: 1 in 100.
const FLAT: f64 = 0.01;

/// How many triangles stand so that `is_along` says of the part of their normal that points along `direction`.
fn lying(mesh: &Mesh, direction: DVec3, is_along: impl Fn(f64) -> bool) -> u64 {
    let lies = |&triangle: &u32| {
        go_on();
        let [a, b, c] = mesh.corners(triangle);
        is_along((b - a).cross(c - a).normalize_or_zero().dot(direction).abs())
    };
    (0..mesh.triangles.len() as u32).filter(lies).count() as u64
}

/// A crossing of a plane and an edge: the numbers of its corners, the smaller first.
type Crossing = (u32, u32);

fn sections(mesh: &Mesh, how: &Sections, step: f64, direction: DVec3) -> (Vec<Point>, Left) {
    let same = mesh.same_places();
    let height: Vec<f64> = mesh.vertices.iter().map(|place| place.dot(direction)).collect();
    let used = mesh.triangles.iter().flatten().map(|&corner| height[corner as usize]);
    let (low, high) = used.fold((f64::MAX, f64::MIN), |(low, high), h| (low.min(h), high.max(h)));
    let (first, last) = (low + how.first, high - how.first);
    let layer = how.layer.unwrap_or(step);
    let count = if first <= last { ((last - first) / layer + 1e-9).floor() as u32 + 1 } else { 0 };
    // The planes that each triangle crosses, in the order of planes and triangles.
    let of = |triangle: u32| {
        let heights =
            mesh.triangles[triangle as usize].map(|corner| height[same[corner as usize] as usize]);
        let [a, b, c] = heights.map(|h| ((h - first) / layer).floor());
        // One more at the end, for rounding: a plane that does not cut it leaves no piece.
        let (from, to) = (a.min(b).min(c).max(0.0), (a.max(b).max(c) + 2.0).max(0.0));
        (from as u32..(to as u32).min(count))
            .take_while(|_| !is_ended())
            .map(move |plane| (plane, triangle))
    };
    let all = 0..mesh.triangles.len() as u32;
    let mut crossed: Vec<(u32, u32)> = all.into_par_iter().flat_map_iter(of).collect();
    go_on();
    crossed.par_sort_unstable();
    let planes: Vec<&[(u32, u32)]> = crossed.chunk_by(|a, b| a.0 == b.0).collect();
    let of = |plane: &&[(u32, u32)]| {
        if is_ended() {
            return Vec::new();
        }
        let number = plane[0].0;
        let at = first + f64::from(number) * layer;
        let phase = (f64::from(number) * how.twist).fract() * step;
        let own = |&(_, triangle): &(u32, u32)| {
            mesh.triangles[triangle as usize].map(|corner| same[corner as usize])
        };
        let is_above = |corner: u32| height[corner as usize] >= at;
        let place = |(a, b): Crossing| {
            let part = (at - height[a as usize]) / (height[b as usize] - height[a as usize]);
            mesh.vertices[a as usize].lerp(mesh.vertices[b as usize], part)
        };
        let pieces: Vec<[Crossing; 2]> =
            plane.iter().filter_map(|crossed| piece(own(crossed), is_above)).collect();
        let mut points = Vec::new();
        for (contour, is_closed) in contours(&pieces) {
            let corners: Vec<DVec3> = contour.into_iter().map(place).collect();
            along(&corners, is_closed, step, phase, how.ends, &mut points);
        }
        points
    };
    let points: Vec<Vec<Point>> = planes.par_iter().map(of).collect();
    go_on();
    let along = lying(mesh, direction, |part| part > 1.0 - FLAT * FLAT / 2.0);
    (points.concat(), Left { along, ..Left::default() })
}

/// Where a plane cuts a triangle: the two edges that go from below it to above.
fn piece(corners: [u32; 3], is_above: impl Fn(u32) -> bool) -> Option<[Crossing; 2]> {
    let edges = [0, 1, 2].map(|i| (corners[i], corners[(i + 1) % 3]));
    let mut cut = edges.into_iter().filter(|&(a, b)| is_above(a) != is_above(b));
    let sorted = |(a, b): (u32, u32)| (a.min(b), a.max(b));
    Some([sorted(cut.next()?), sorted(cut.next()?)])
}

/// Links pieces to contours, each with whether it is closed; open ones come first.
fn contours(pieces: &[[Crossing; 2]]) -> Vec<(Vec<Crossing>, bool)> {
    let mut at: HashMap<Crossing, Vec<u32>> = HashMap::new();
    for (i, piece) in pieces.iter().enumerate() {
        go_on();
        piece.iter().for_each(|end| at.entry(*end).or_default().push(i as u32));
    }
    let mut is_done = vec![false; pieces.len()];
    let mut contours = Vec::new();
    let is_open = |end: &Crossing| at[end].len() != 2;
    for open in [true, false] {
        for start in 0..pieces.len() {
            let [a, b] = pieces[start];
            let begins = if is_open(&b) && !is_open(&a) { b } else { a };
            if is_done[start] || (open && !is_open(&begins)) {
                continue;
            }
            let mut contour = vec![begins];
            let mut next = Some(start as u32);
            while let Some(piece) = next {
                go_on();
                is_done[piece as usize] = true;
                let [a, b] = pieces[piece as usize];
                let last = *contour.last().unwrap_or(&a);
                let end = if a == last { b } else { a };
                contour.push(end);
                let ends_here = is_open(&end);
                let waiting = at[&end].iter().copied().find(|&other| !is_done[other as usize]);
                next = waiting.filter(|_| !ends_here);
            }
            let is_closed = contour.len() > 2 && contour.first() == contour.last();
            contours.push((contour, is_closed));
        }
    }
    contours
}

/// Points every `step` mm along `corners`, the first one `phase` mm after their begin. On a closed contour the step is as much
/// longer as makes it come out even.
fn along(
    corners: &[DVec3],
    is_closed: bool,
    step: f64,
    phase: f64,
    ends: bool,
    points: &mut Vec<Point>,
) {
    let length: f64 = corners.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    // 20 mm are 20 steps of 1 mm, whatever the rounding of the sum.
    let step = match (length / step + 1e-9).floor() {
        count if is_closed && count >= 1.0 => length / count,
        _ => step,
    };
    let mut next = phase;
    let mut passed = 0.0;
    for pair in corners.windows(2) {
        let own = pair[0].distance(pair[1]);
        // The end of a closed contour is its begin.
        while next <= passed + own && next < length - if is_closed { 1e-6 } else { 0.0 } {
            go_on();
            points.extend(cloud::point(pair[0].lerp(pair[1], (next - passed) / own)));
            next += step;
        }
        passed += own;
    }
    if let (true, false, Some(&last)) = (ends, is_closed, corners.last()) {
        points.extend(cloud::point(last));
    }
}

/// A square grid in each triangle, from its first corner along its first edge.
fn triangles(mesh: &Mesh, step: f64, full: bool) -> (Vec<Point>, Left) {
    let of = |triangle: u32| {
        let [a, b, c] = mesh.corners(triangle);
        let right = (b - a).normalize_or_zero();
        let up = (b - a).cross(c - a).cross(b - a).normalize_or_zero();
        let [q, r] = [b, c].map(|corner| DVec2::new((corner - a).dot(right), (corner - a).dot(up)));
        let mut points = Vec::new();
        for row in 0..=(r.y / step).floor() as u32 {
            if is_ended() {
                break;
            }
            let y = f64::from(row) * step;
            // The sides that go up from both ends of the first edge.
            let part = if r.y > 0.0 { y / r.y } else { 0.0 };
            let (from, to) = (r.x * part, q.x + (r.x - q.x) * part);
            let mut column = (from / step - 1e-9).ceil();
            while column * step <= to + 1e-9 * step {
                points.extend(cloud::point(a + right * (column * step) + up * y));
                column += 1.0;
            }
        }
        // The corner where the grid begins belongs to the neighbours too: alone it fills nothing.
        let is_rejected = points.len() <= 1;
        if is_rejected {
            points.clear();
            if full {
                points.extend(cloud::point((a + b + c) / 3.0));
            }
        }
        (points, is_rejected)
    };
    let count = mesh.triangles.len() as u32;
    let all: Vec<(Vec<Point>, bool)> = (0..count).into_par_iter().map(of).collect();
    go_on();
    let rejected = all.iter().filter(|(_, rejected)| *rejected).count() as u64;
    let points = all.into_iter().flat_map(|(points, _)| points).collect();
    (points, Left { triangles: rejected, ..Left::default() })
}

/// A node of a grid: its row, and its place in the row.
type Node = (i32, i32);

/// A grid across a direction.
struct Raster {
    along: DVec3,
    across: [DVec3; 2],
    /// Distance of nodes in a row, and of rows, mm.
    step: [f64; 2],
    /// Whether every other row is shifted by half a step.
    is_hexagonal: bool,
}

/// Where a ray through a node meets the surface.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    node: Node,
    /// How far along the ray, mm.
    at: f64,
    /// 1 where the ray enters there, -1 where it leaves.
    enters: i32,
}

impl Raster {
    fn flat(&self, place: DVec3) -> DVec2 {
        DVec2::new(place.dot(self.across[0]), place.dot(self.across[1]))
    }

    fn shift(&self, row: i32) -> f64 {
        if self.is_hexagonal && row.rem_euclid(2) == 1 { 0.5 * self.step[0] } else { 0.0 }
    }

    fn node(&self, (row, column): Node) -> DVec2 {
        let x = f64::from(column) * self.step[0] + self.shift(row);
        DVec2::new(x, f64::from(row) * self.step[1])
    }

    fn place(&self, node: Node, at: f64) -> DVec3 {
        let flat = self.node(node);
        self.across[0] * flat.x + self.across[1] * flat.y + self.along * at
    }

    /// All meetings of rays with `mesh`, ray by ray and along each.
    fn meetings(&self, mesh: &Mesh) -> Vec<Meeting> {
        let same = mesh.same_places();
        let of = |triangle: u32| {
            let numbers = mesh.triangles[triangle as usize].map(|corner| same[corner as usize]);
            let corners = numbers.map(|number| mesh.vertices[number as usize]);
            self.inside(numbers, corners)
        };
        let all = 0..mesh.triangles.len() as u32;
        let mut met: Vec<Meeting> = all.into_par_iter().flat_map_iter(of).collect();
        go_on();
        met.par_sort_by(|a, b| {
            a.node.cmp(&b.node).then(a.at.total_cmp(&b.at)).then(b.enters.cmp(&a.enters))
        });
        met
    }

    /// The meetings with one triangle, whose corners have these numbers.
    fn inside(&self, numbers: [u32; 3], corners: [DVec3; 3]) -> Vec<Meeting> {
        let [a, b, c] = corners;
        let flat = corners.map(|corner| self.flat(corner));
        let area = (flat[1] - flat[0]).perp_dot(flat[2] - flat[0]);
        let normal = (b - a).cross(c - a);
        let slope = normal.dot(self.along);
        if area == 0.0 || slope == 0.0 {
            return Vec::new();
        }
        let low = flat[0].min(flat[1]).min(flat[2]);
        let high = flat[0].max(flat[1]).max(flat[2]);
        let mut met = Vec::new();
        for row in (low.y / self.step[1]).floor() as i32..=(high.y / self.step[1]).ceil() as i32 {
            if is_ended() {
                break;
            }
            let shift = self.shift(row);
            let from = ((low.x - shift) / self.step[0]).floor() as i32;
            let to = ((high.x - shift) / self.step[0]).ceil() as i32;
            for column in from..=to {
                let node = self.node((row, column));
                let turns = area > 0.0;
                let within = |i: usize| {
                    let j = (i + 1) % 3;
                    left_of(node, (numbers[i], flat[i]), (numbers[j], flat[j])) == turns
                };
                if (0..3).all(within) {
                    let on_plane = self.place((row, column), 0.0);
                    let at = normal.dot(a - on_plane) / slope;
                    met.push(Meeting {
                        node: (row, column),
                        at,
                        enters: if slope < 0.0 { 1 } else { -1 },
                    });
                }
            }
        }
        met
    }
}

/// Whether `node` lies to the left of the edge between two corners. Both triangles of an edge compute it with its corners in the
/// same order, so that one of them has the node, also where it lies on the edge.
fn left_of(node: DVec2, from: (u32, DVec2), to: (u32, DVec2)) -> bool {
    let is_turned = from.0 > to.0;
    let (a, b) = if is_turned { (to.1, from.1) } else { (from.1, to.1) };
    ((b - a).perp_dot(node - a) >= 0.0) != is_turned
}

fn rays(mesh: &Mesh, step: f64, direction: DVec3) -> (Vec<Point>, Left) {
    let across = across(direction);
    let raster = Raster { along: direction, across, step: [step, step], is_hexagonal: false };
    let met = raster.meetings(mesh);
    let points = met.iter().filter_map(|met| cloud::point(raster.place(met.node, met.at)));
    let along = lying(mesh, direction, |part| part < FLAT);
    (points.collect(), Left { along, ..Left::default() })
}

/// The columns of a solid are as steep as no side of a block: along none of them does the eye look in straight lines.
const COLUMNS: DVec3 = DVec3::new(0.35, 0.52, 0.78);

/// Points within a body: in columns as far apart as the step, every step along each, begun by chance.
fn solid(mesh: &Mesh, step: f64, seed: u64) -> (Vec<Point>, Left) {
    let along = COLUMNS.normalize();
    let raster = Raster {
        along,
        across: across(along),
        step: [step, 0.75f64.sqrt() * step],
        is_hexagonal: true,
    };
    let met = raster.meetings(mesh);
    let mut left = Left::default();
    let mut points = Vec::new();
    for column in met.chunk_by(|a, b| a.node == b.node) {
        go_on();
        let node = column[0].node;
        if column.iter().map(|met| met.enters).sum::<i32>() != 0 {
            left.columns += 1;
            left.first_column =
                left.first_column.or(Some(raster.place(node, column[0].at).to_array()));
            continue;
        }
        let number = (u64::from(node.0 as u32) << 32) | u64::from(node.1 as u32);
        let phase = Dice(seed ^ number).part();
        let mut depth = 0;
        for pair in column.windows(2) {
            depth += pair[0].enters;
            // Also of a body that is inside out.
            if depth == 0 {
                continue;
            }
            let mut number = (pair[0].at / step - phase).ceil();
            while (number + phase) * step < pair[1].at {
                points.extend(cloud::point(raster.place(node, (number + phase) * step)));
                number += 1.0;
            }
        }
    }
    (points, left)
}
