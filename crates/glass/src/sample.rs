//! Points on the surface of a mesh: no two nearer than a spacing, and no place of the surface farther than 1.3 spacings
//! from a point.
//!
//! The surface is cut into patches, which are filled one after another in an order by chance. Darts are thrown into cells of a patch,
//! triangles at most one and a quarter spacings long. A dart that hits nothing within a spacing becomes a point, which then covers
//! its cell. Where it hits something, the cell is halved, unless a point covers it whole. A cell of at most `FINEST` spacings is given up: its dart lies within a spacing of a point, so all of it lies
//! within 1 + `FINEST` spacings. That is the bound of the largest gap.
//!
//! **Border rule of tiles.** Space is divided into cubes of `TILE` spacings. A patch belongs to the cube that holds its centroid.
//! Cubes are worked on in eight turns, by whether their three numbers are odd or even: two cubes of a turn are a whole cube
//! apart, farther than a spacing and two halves of a patch, so neither sees the other's points; a cube sees the points of all earlier
//! turns. The result depends on neither the threads nor who works on which cube.

use crate::cloud::Point;
use crate::mesh::Mesh;
use crate::weld::Kept;
use geom::ending::{go_on, is_ended};
use glam::{DVec3, IVec3, Vec3A, Vec4};
use rayon::prelude::*;

/// Longest edge of a cell that darts are thrown into first, spacings.
const COARSEST: f64 = 1.25;

/// Longest edge of a piece of the surface whose neighbours are looked up together, spacings.
const PATCH: f64 = 2.0 * COARSEST;

/// Longest edge of a cell that is given up, spacings.
const FINEST: f64 = 0.25;

/// The largest distance of a place of the surface from a point, spacings, but for the rounding of points to whole µm and what
/// [`Apart::lost`] adds.
pub const LARGEST_GAP: f64 = 1.0 + FINEST;

/// Side of a tile, spacings.
const TILE: f64 = 16.0;

/// How far from its tile a patch's points may be, and how far those may be that they must see, spacings.
const BORDER: f64 = PATCH + 1.0;

/// Cells of the look-up grid of a tile along each axis: as large as a spacing.
const CELLS: usize = (TILE + 2.0 * BORDER) as usize + 2;

/// How far from the origin the body may be, µm.
const FARTHEST: i32 = 1 << 22;

type Triangle = [DVec3; 3];

/// How far points are to stay apart.
#[derive(Clone, Copy, Debug)]
pub struct Apart {
    /// The smallest distance, µm, 1 at least.
    pub spacing: u32,
    /// By how much less the heights of two points may differ in the glass than in the cloud, µm: what a program's rounding of the
    /// drive takes. Points keep their distance all the same.
    pub lost: f64,
}

impl Apart {
    /// A distance that keeps the smallest one whatever is rounded, of points to whole µm and of the drive: mm.
    pub fn rounded(&self) -> f64 {
        (f64::from(self.spacing) + self.lost.ceil() + 1.0) * 1e-3
    }

    /// The square of the least distance that two places so far apart may come to, µm².
    pub(crate) fn squared(&self, way: DVec3) -> f64 {
        let height = (way.z.abs() - self.lost).max(0.0);
        way.x * way.x + way.y * way.y + height * height
    }
}

/// Points on all faces of `mesh` (mm), as far apart as `apart` says. Another `seed` gives other points.
pub fn surface(mesh: &Mesh, apart: Apart, seed: u64) -> Vec<Point> {
    let of_tile = |points: Vec<(Point, u32)>| points.into_iter().map(|(point, _)| point);
    on_triangles(mesh, apart, seed).into_iter().flat_map(of_tile).collect()
}

/// The points of [`surface`] tile by tile, each with the triangle that it lies on.
pub(crate) fn on_triangles(mesh: &Mesh, apart: Apart, seed: u64) -> Vec<Vec<(Point, u32)>> {
    let spacing = f64::from(apart.spacing.max(1));
    let tiles = tiles(mesh, spacing);
    let mut done: Vec<Vec<(Point, u32)>> = vec![Vec::new(); tiles.len()];
    for turn in 0..8 {
        let in_turn = |at: &usize| {
            let odd = tiles[*at].0.map(|number| number.rem_euclid(2));
            odd[0] + 2 * odd[1] + 4 * odd[2] == turn
        };
        let turn: Vec<usize> = (0..tiles.len()).filter(in_turn).collect();
        let work = |room: &mut Room, &at: &usize| {
            let (tile, triangles) = &tiles[at];
            if is_ended() {
                return (at, Vec::new());
            }
            room.enter(*tile, apart);
            for near in around(*tile) {
                if let Ok(near) = tiles.binary_search_by_key(&near, |(tile, _)| *tile) {
                    done[near].iter().for_each(|(point, _)| room.see(room.place(*point)));
                }
            }
            (at, room.fill(mesh, triangles, seed))
        };
        let new: Vec<_> = turn.par_iter().map_init(Room::default, work).collect();
        go_on();
        new.into_iter().for_each(|(at, points)| done[at] = points);
    }
    done
}

/// The tiles that triangles of `mesh` may reach into, in order, with those triangles.
fn tiles(mesh: &Mesh, spacing: f64) -> Vec<([i32; 3], Vec<u32>)> {
    let side = TILE * spacing;
    let number = |value: f64| (value / side).floor() as i32;
    let of = |triangle: u32| {
        let corners = mesh.corners(triangle).map(|corner| corner * 1e3);
        let (low, high) = box_of(&corners);
        let [from, to] = [low, high].map(|corner| corner.to_array().map(number));
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let crossed = move |tile: &[i32; 3]| {
            let middle = (DVec3::from_array(tile.map(f64::from)) + 0.5) * side;
            // Half the diagonal of a tile, and some for rounding.
            normal.dot(middle - corners[0]).abs() <= 0.9 * side
        };
        let rows = (from[2]..=to[2]).flat_map(move |z| (from[1]..=to[1]).map(move |y| (y, z)));
        let all = rows.flat_map(move |(y, z)| (from[0]..=to[0]).map(move |x| [x, y, z]));
        all.take_while(|_| !is_ended()).filter(crossed).map(move |tile| (tile, triangle))
    };
    let count = mesh.triangles.len() as u32;
    let mut all: Vec<([i32; 3], u32)> = (0..count).into_par_iter().flat_map_iter(of).collect();
    go_on();
    all.par_sort_unstable();
    let same = |a: &([i32; 3], u32), b: &([i32; 3], u32)| a.0 == b.0;
    all.chunk_by(same)
        .map(|of| (of[0].0, of.iter().map(|(_, triangle)| *triangle).collect()))
        .collect()
}

/// The 26 tiles that touch one.
fn around(tile: [i32; 3]) -> impl Iterator<Item = [i32; 3]> {
    let ways = (0..27).filter(|&i| i != 13);
    ways.map(move |i| [tile[0] + i % 3 - 1, tile[1] + i / 3 % 3 - 1, tile[2] + i / 9 - 1])
}

fn box_of(corners: &Triangle) -> (DVec3, DVec3) {
    let [a, b, c] = *corners;
    (a.min(b).min(c), a.max(b).max(c))
}

/// The longest edge of a triangle: its square, and the number of the corner opposite to it.
fn longest(&[a, b, c]: &Triangle) -> (f64, usize) {
    let edges = [b.distance_squared(c), c.distance_squared(a), a.distance_squared(b)];
    let at = if edges[0] >= edges[1] && edges[0] >= edges[2] {
        0
    } else if edges[1] >= edges[2] {
        1
    } else {
        2
    };
    (edges[at], at)
}

/// Both halves of a triangle, cut from corner `at` to the middle of its edge. The same two corners give the same middle in
/// whichever order they come.
fn halves(triangle: &Triangle, at: usize) -> [Triangle; 2] {
    let [a, b, c] = [0, 1, 2].map(|i| triangle[(at + i) % 3]);
    let middle = (b + c) * 0.5;
    [[a, b, middle], [a, middle, c]]
}

/// A tile being filled: the points that its darts must see, in cubes as large as darts see.
///
/// Places in it are µm from its origin, in 24 bits: exact where they are whole.
struct Room {
    apart: Apart,
    spacing: f64,
    /// How far a dart sees, µm: a spacing, and in height what is lost as well.
    sees: Vec3A,
    /// Corner of the look-up grid.
    low: Vec3A,
    /// A whole µm near the tile.
    origin: IVec3,
    /// The tile's own box, µm.
    tile: (DVec3, DVec3),
    number: [i32; 3],
    /// The last point of each cube; 0 is none, 1 the first point.
    ///
    /// Numbers have 16 bits. Around each point a ball of half a spacing, drawn out upright by what is lost, is free of the others': of a
    /// spacing s and a loss l it takes π s² (s / 6 + l / 4). The room with half of one beyond each face has 26³ s² (s + l), so that it
    /// holds no more than 26³ × 6 / π = 33,567 points.
    last: Vec<u16>,
    /// Of each row of cubes along X those that hold points, bit by bit.
    rows: Vec<u32>,
    points: Vec<Seen>,
    /// Room for the points near a cell, and for its halves.
    near: Near,
    open: Vec<Cell>,
}

/// A point that darts see.
#[derive(Clone, Copy)]
struct Seen {
    place: Vec3A,
    /// The one before it in its cube, as in [`Room::last`].
    before: u16,
}

impl Default for Room {
    fn default() -> Room {
        Room {
            apart: Apart { spacing: 1, lost: 0.0 },
            spacing: 1.0,
            sees: Vec3A::ONE,
            low: Vec3A::ZERO,
            origin: IVec3::ZERO,
            tile: (DVec3::ZERO, DVec3::ZERO),
            number: [0; 3],
            last: vec![0; CELLS * CELLS * CELLS],
            rows: vec![0; CELLS * CELLS],
            points: Vec::new(),
            near: Near::default(),
            open: Vec::new(),
        }
    }
}

impl Room {
    fn enter(&mut self, number: [i32; 3], apart: Apart) {
        let spacing = f64::from(apart.spacing.max(1));
        for i in 0..self.points.len() {
            if let Some(cube) = self.cube(self.points[i].place) {
                self.last[cube] = 0;
                self.rows[cube / CELLS] = 0;
            }
        }
        self.points.clear();
        let corner = DVec3::from_array(number.map(f64::from)) * (TILE * spacing);
        self.tile = (corner, corner + TILE * spacing);
        (self.apart, self.spacing, self.number) = (apart, spacing, number);
        let side = DVec3::new(spacing, spacing, spacing + apart.lost);
        self.sees = side.as_vec3a();
        let farthest = DVec3::splat(f64::from(FARTHEST));
        let origin = corner.clamp(-farthest, farthest);
        self.origin = origin.as_ivec3();
        // One cube more below, so that the cubes around a dart are all there.
        self.low = (corner - (BORDER + 1.0) * side - origin).as_vec3a();
    }

    /// The cube of a place that darts can see.
    fn cube(&self, place: Vec3A) -> Option<usize> {
        let cell = (place - self.low) / self.sees;
        let inside = cell.cmpge(Vec3A::ZERO) & cell.cmplt(Vec3A::splat(CELLS as f32));
        inside.all().then(|| {
            let [x, y, z] = cell.to_array().map(|number| number as i32 as usize);
            (z * CELLS + y) * CELLS + x
        })
    }

    fn see(&mut self, place: Vec3A) {
        if let Some(cube) = self.cube(place) {
            self.points.push(Seen { place, before: self.last[cube] });
            self.last[cube] = self.points.len() as u16;
            self.rows[cube / CELLS] |= 1 << (cube % CELLS);
        }
    }

    /// Where a point is.
    fn place(&self, point: Point) -> Vec3A {
        (IVec3::from_array(point) - self.origin).as_vec3a()
    }

    /// Throws darts into the patches of `triangles` that belong to this tile; answers the points that they left.
    fn fill(&mut self, mesh: &Mesh, triangles: &[u32], seed: u64) -> Vec<(Point, u32)> {
        let seed = self.number.iter().fold(seed, |seed, number| mixed(seed ^ *number as u64));
        let mut dice = Dice(seed);
        let mut patches = Vec::new();
        for &triangle in triangles {
            let corners = mesh.corners(triangle).map(|corner| corner * 1e3);
            self.divide(corners, |patch| patches.push((patch, triangle)));
        }
        dice.shuffle(&mut patches);
        let mut points = Vec::new();
        for (patch, triangle) in patches {
            self.throw(&patch, &mut dice, |point| points.push((point, triangle)));
        }
        points
    }

    /// Throws darts into a patch, cell by cell, until all of it is covered or given up.
    fn throw(&mut self, patch: &Triangle, dice: &mut Dice, mut found: impl FnMut(Point)) {
        let [coarsest, finest] =
            [COARSEST, FINEST].map(|part| (part * self.spacing).powi(2) as f32);
        let square = self.spacing.powi(2) as f32;
        let origin = self.origin.as_dvec3();
        let corners = patch.map(|corner| (corner - origin).as_vec3a());
        let mut near = self.near(&corners);
        let mut open = std::mem::take(&mut self.open);
        let [a, b, c] = corners;
        open.push(Cell {
            corners,
            edges: [b.distance_squared(c), c.distance_squared(a), a.distance_squared(b)],
            near: corners.map(|corner| near.around(corner, square)),
        });
        while let Some(cell) = open.pop() {
            go_on();
            if cell.is_covered() {
                continue;
            }
            let chance = dice.roll();
            let at = cell.longest();
            let edge = cell.edges[at];
            if edge <= coarsest {
                let dart = cell.dart(chance);
                // More than rounding adds to a square.
                if !near.hits(dart, square * (1.0 + 1e-6)) {
                    self.see(dart);
                    let bit = near.push(dart);
                    for cell in &mut open {
                        for (corner, own) in cell.corners.iter().zip(&mut cell.near) {
                            *own |= if near.squared(*corner - dart) < square { bit } else { 0 };
                        }
                    }
                    found((dart.as_ivec3() + self.origin).to_array());
                    continue;
                }
                if edge <= finest {
                    continue;
                }
            }
            // Neither half comes first every time.
            let halves = cell.halves(at, chance & 1 == 0, |middle| near.around(middle, square));
            for half in halves {
                if !half.is_covered() {
                    open.push(half);
                }
            }
        }
        (self.near, self.open) = (near, open);
    }

    /// The points that a dart in `patch` may hit.
    fn near(&mut self, patch: &[Vec3A; 3]) -> Near {
        let mut near = std::mem::take(&mut self.near);
        near.clear(self.apart.lost);
        let middle = (patch[0] + patch[1] + patch[2]) / 3.0;
        let far = patch.iter().map(|corner| corner.distance(middle)).fold(0.0, f32::max);
        // As far from the middle as a dart sees from a corner, half a µm for its rounding, and more than rounding takes.
        let reach = (far + self.sees.z) * (1.0 + 1e-4) + 1.0;
        let [low, high] = [-reach, reach].map(|reach| (middle + reach - self.low) / self.sees);
        let most = (CELLS - 1) as f32;
        let [from, to] = [low, high].map(|cell| {
            cell.clamp(Vec3A::ZERO, Vec3A::splat(most))
                .to_array()
                .map(|number| number as i32 as usize)
        });
        let columns = (u32::MAX << from[0]) & (u32::MAX >> (31 - to[0]));
        for z in from[2]..to[2] + 1 {
            let (first, last) = (z * CELLS + from[1], z * CELLS + to[1]);
            for (row, columns_taken) in (first..).zip(&self.rows[first..=last]) {
                let mut taken = columns_taken & columns;
                while taken > 0 {
                    let mut at = self.last[row * CELLS + taken.trailing_zeros() as usize];
                    taken &= taken - 1;
                    while at > 0 {
                        let Seen { place, before } = self.points[at as usize - 1];
                        if place.distance_squared(middle) < reach * reach {
                            near.push(place);
                        }
                        at = before;
                    }
                }
            }
        }
        near
    }

    /// The patches of `triangle` whose centroids are in this tile.
    fn divide(&self, triangle: Triangle, mut found: impl FnMut(Triangle)) {
        let coarsest = (PATCH * self.spacing).powi(2);
        let mut open = vec![triangle];
        while let Some(triangle) = open.pop() {
            go_on();
            let (low, high) = box_of(&triangle);
            if high.cmplt(self.tile.0).any() || low.cmpgt(self.tile.1).any() {
                continue;
            }
            let (edge, at) = longest(&triangle);
            if edge > coarsest {
                open.extend(halves(&triangle, at));
                continue;
            }
            let middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
            if middle.cmpge(self.tile.0).all() && middle.cmplt(self.tile.1).all() {
                found(triangle);
            }
        }
    }
}

/// Points that darts in a patch may hit.
#[derive(Debug, Default)]
struct Near {
    /// Their X, Y and Z, four points by four.
    fours: Vec<[Vec4; 3]>,
    count: usize,
    /// As of [`Apart`].
    lost: f32,
}

impl Near {
    fn clear(&mut self, lost: f64) {
        self.fours.clear();
        (self.count, self.lost) = (0, lost as f32);
    }

    /// Takes a point in; answers its bit, none of those beyond the last bit.
    fn push(&mut self, point: Vec3A) -> u64 {
        // No dart comes near those that are not taken yet.
        const NOWHERE: Vec4 = Vec4::splat(1e12);
        let (four, lane) = (self.count / 4, self.count % 4);
        if lane == 0 {
            self.fours.push([NOWHERE; 3]);
        }
        for (axis, value) in point.to_array().into_iter().enumerate() {
            self.fours[four][axis][lane] = value;
        }
        let bit = 1u64.checked_shl(self.count as u32).unwrap_or(0);
        self.count += 1;
        bit
    }

    /// What [`Apart::squared`] says of the way between two places.
    fn squared(&self, way: Vec3A) -> f32 {
        (way.abs() - Vec3A::Z * self.lost).max(Vec3A::ZERO).length_squared()
    }

    /// The points within the distance of `place` whose square is given: four bits of each four points.
    fn within(&self, place: Vec3A, square: f32) -> impl Iterator<Item = u32> {
        let [x, y, z] = place.to_array().map(Vec4::splat);
        let (lost, square) = (Vec4::splat(self.lost), Vec4::splat(square));
        self.fours.iter().map(move |four| {
            let [x, y] = [four[0] - x, four[1] - y];
            let height = ((four[2] - z).abs() - lost).max(Vec4::ZERO);
            (x * x + y * y + height * height).cmplt(square).bitmask()
        })
    }

    /// Whether a dart hits a point within the distance whose square is given.
    fn hits(&self, dart: Vec3A, square: f32) -> bool {
        self.within(dart, square).any(|four| four != 0)
    }

    /// The bits of the points around `place` within the distance whose square is given.
    fn around(&self, place: Vec3A, square: f32) -> u64 {
        let fours = self.within(place, square).take(16).enumerate();
        fours.fold(0, |near, (i, four)| near | u64::from(four) << (4 * i))
    }
}

/// A cell of a patch.
#[derive(Clone, Copy, Debug)]
struct Cell {
    corners: [Vec3A; 3],
    /// The square of the edge opposite to each corner, µm².
    edges: [f32; 3],
    /// Of each corner the bits of the points within a spacing.
    near: [u64; 3],
}

impl Cell {
    /// Whether one point covers all of it: places that are near a point are a convex set, which holds a cell where it holds its
    /// corners.
    fn is_covered(&self) -> bool {
        self.near[0] & self.near[1] & self.near[2] != 0
    }

    /// The number of the corner opposite to the longest edge.
    fn longest(&self) -> usize {
        let [a, b, c] = self.edges;
        if a >= b && a >= c {
            0
        } else if b >= c {
            1
        } else {
            2
        }
    }

    /// The whole µm nearest to a place in it, every one as likely as every other.
    fn dart(&self, chance: u64) -> Vec3A {
        let part = |bits: u64| (bits & 0xff_ffff) as f32 / 16_777_216.0;
        let (u, v) = (part(chance >> 40), part(chance >> 16));
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let [a, b, c] = self.corners;
        (a + (b - a) * u + (c - a) * v).round()
    }

    /// Both halves, cut from corner `at` to the middle of its edge, in the order of the corners or turned; `around` says which
    /// points are near the middle.
    fn halves(&self, at: usize, turned: bool, around: impl FnOnce(Vec3A) -> u64) -> [Cell; 2] {
        let [a, b, c] = match (at, turned) {
            (0, false) => [0, 1, 2],
            (0, true) => [0, 2, 1],
            (1, false) => [1, 2, 0],
            (1, true) => [1, 0, 2],
            (_, false) => [2, 0, 1],
            (_, true) => [2, 1, 0],
        };
        let middle = (self.corners[b] + self.corners[c]) * 0.5;
        let near = around(middle);
        let quarter = 0.25 * self.edges[a];
        // Apollonius: the square of the median.
        let cut = 0.5 * (self.edges[b] + self.edges[c]) - quarter;
        let half = |corner: usize, other: usize| Cell {
            corners: [self.corners[a], self.corners[corner], middle],
            edges: [quarter, cut, self.edges[other]],
            near: [self.near[a], self.near[corner], near],
        };
        [half(b, c), half(c, b)]
    }
}

/// The numbers of `points`, which are at least `spacing` µm apart, in an order in which the first ones always lie as far apart as that
/// many can: those that are farther from all before them than a distance that shrinks turn by turn.
pub(crate) fn ranked(points: &[Point], spacing: u32, seed: u64) -> Vec<u32> {
    let mut waiting: Vec<u32> = (0..points.len() as u32).collect();
    Dice(seed).shuffle(&mut waiting);
    let mut ranked: Vec<u32> = Vec::with_capacity(points.len());
    let spacing = f64::from(spacing);
    let mut distance = spacing * (points.len() as f64).sqrt().max(1.0);
    while !waiting.is_empty() && distance > spacing {
        distance = (distance * SHRINK).max(spacing);
        let mut near = Kept::new(distance.ceil() as i64);
        for &i in &ranked {
            go_on();
            near.push(points[i as usize]);
        }
        waiting.retain(|&i| {
            go_on();
            let waits = near.is_near(points[i as usize]);
            if !waits {
                near.push(points[i as usize]);
                ranked.push(i);
            }
            waits
        });
    }
    ranked.extend(waiting);
    ranked
}

/// By how much the distance of points shrinks from turn to turn as they are ranked.
pub(crate) const SHRINK: f64 = 0.93;

/// Numbers that look like chance and are the same in every run (splitmix64).
pub struct Dice(
    /// Where the numbers begin.
    pub u64,
);

/// One step of splitmix64.
fn mixed(seed: u64) -> u64 {
    let mut z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Dice {
    /// Any number.
    pub fn roll(&mut self) -> u64 {
        let rolled = mixed(self.0);
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        rolled
    }

    /// From 0 to 1, 1 left out.
    pub fn part(&mut self) -> f64 {
        (self.roll() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// From 0 to `count` (1 at least), `count` left out.
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.roll()) * count as u128) >> 64) as usize
    }

    /// Puts `all` in another order, every one as likely as every other.
    pub fn shuffle<T>(&mut self, all: &mut [T]) {
        for i in (1..all.len()).rev() {
            all.swap(i, self.below(i + 1));
        }
    }
}
