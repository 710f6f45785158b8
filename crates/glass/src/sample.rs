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
use glam::DVec3;
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
            room.enter(*tile, apart);
            for near in around(*tile) {
                if let Ok(near) = tiles.binary_search_by_key(&near, |(tile, _)| *tile) {
                    done[near].iter().for_each(|(point, _)| room.see(*point));
                }
            }
            (at, room.fill(mesh, triangles, seed))
        };
        let new: Vec<_> = turn.par_iter().map_init(Room::default, work).collect();
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
        all.filter(crossed).map(move |tile| (tile, triangle))
    };
    let count = mesh.triangles.len() as u32;
    let mut all: Vec<([i32; 3], u32)> = (0..count).into_par_iter().flat_map_iter(of).collect();
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
struct Room {
    apart: Apart,
    spacing: f64,
    /// Side of a cube, µm: as far as a dart sees.
    side: f64,
    /// Corner of the look-up grid, µm.
    low: DVec3,
    /// The tile's own box, µm.
    tile: (DVec3, DVec3),
    number: [i32; 3],
    /// The last point of each cube; 0 is none, 1 the first point. At their distance no more than 25,000 points are in a room
    /// of 25 spacings.
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
    /// µm.
    place: DVec3,
    /// The one before it in its cube, as in [`Room::last`].
    before: u16,
}

impl Default for Room {
    fn default() -> Room {
        Room {
            apart: Apart { spacing: 1, lost: 0.0 },
            spacing: 1.0,
            side: 1.0,
            low: DVec3::ZERO,
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
        self.side = spacing + apart.lost;
        // One cube more below, so that the cubes around a dart are all there.
        self.low = corner - (BORDER + 1.0) * self.side;
    }

    /// The cube of a place that darts can see.
    fn cube(&self, place: DVec3) -> Option<usize> {
        let cell = (place - self.low) / self.side;
        let inside = cell.min_element() >= 0.0 && cell.max_element() < CELLS as f64;
        inside.then(|| (cell.z as usize * CELLS + cell.y as usize) * CELLS + cell.x as usize)
    }

    fn see(&mut self, point: Point) {
        let place = DVec3::from_array(point.map(f64::from));
        if let Some(cube) = self.cube(place) {
            self.points.push(Seen { place, before: self.last[cube] });
            self.last[cube] = self.points.len() as u16;
            self.rows[cube / CELLS] |= 1 << (cube % CELLS);
        }
    }

    /// Throws darts into the cells of `triangles` that belong to this tile; answers the points that they left.
    fn fill(&mut self, mesh: &Mesh, triangles: &[u32], seed: u64) -> Vec<(Point, u32)> {
        let seed = self.number.iter().fold(seed, |seed, number| mixed(seed ^ *number as u64));
        let mut dice = Dice(seed);
        let mut cells = Vec::new();
        for &triangle in triangles {
            let corners = mesh.corners(triangle).map(|corner| corner * 1e3);
            self.divide(corners, |cell| cells.push((cell, triangle)));
        }
        dice.shuffle(&mut cells);
        let mut points = Vec::new();
        for (cell, triangle) in cells {
            self.throw(cell, &mut dice, |point| points.push((point, triangle)));
        }
        points
    }

    /// Throws darts into a cell and its halves until all of it is covered or given up.
    fn throw(&mut self, corners: Triangle, dice: &mut Dice, mut found: impl FnMut(Point)) {
        let [square, coarsest, finest] =
            [1.0, COARSEST, FINEST].map(|part| (part * self.spacing).powi(2));
        let mut near = self.near(&corners);
        let mut open = std::mem::take(&mut self.open);
        open.push(Cell { corners, near: corners.map(|corner| near.around(corner, square)) });
        while let Some(cell) = open.pop() {
            // Places that are near a point are a convex set, which holds a cell where it holds its corners.
            if cell.near[0] & cell.near[1] & cell.near[2] != 0 {
                continue;
            }
            let (edge, at) = longest(&cell.corners);
            if edge <= coarsest {
                let dart = dice.within(&cell.corners).to_array().map(whole);
                let place = DVec3::from_array(dart.map(f64::from));
                if !near.hits(place, square) {
                    self.see(dart);
                    let bit = near.push(place);
                    for cell in &mut open {
                        for (corner, own) in cell.corners.iter().zip(&mut cell.near) {
                            let is_near = self.apart.squared(*corner - place) < square;
                            *own |= if is_near { bit } else { 0 };
                        }
                    }
                    found(dart);
                    continue;
                }
                if edge <= finest {
                    continue;
                }
            }
            let [a, b, c] = [0, 1, 2].map(|i| (at + i) % 3);
            let middle = (cell.corners[b] + cell.corners[c]) * 0.5;
            let around = near.around(middle, square);
            let half = |corner: usize| Cell {
                corners: [cell.corners[a], cell.corners[corner], middle],
                near: [cell.near[a], cell.near[corner], around],
            };
            // Neither half comes first every time.
            open.extend(if dice.below(2) == 0 { [half(b), half(c)] } else { [half(c), half(b)] });
        }
        (self.near, self.open) = (near, open);
    }

    /// The points that a dart in `cell` may hit.
    fn near(&mut self, cell: &Triangle) -> Near {
        let mut near = std::mem::take(&mut self.near);
        near.clear(self.apart.lost);
        let middle = (cell[0] + cell[1] + cell[2]) / 3.0;
        let far = cell.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
        // As far from the middle as a dart sees from a corner, and half a µm for its rounding.
        let reach = far + self.side + 1.0;
        let [low, high] = [-reach, reach].map(|reach| (middle + reach - self.low) / self.side);
        let most = (CELLS - 1) as f64;
        let from = low.clamp(DVec3::ZERO, DVec3::splat(most));
        let to = high.clamp(DVec3::ZERO, DVec3::splat(most));
        let columns = (u32::MAX << from.x as u32) & (u32::MAX >> (31 - to.x as u32));
        for z in from.z as usize..=to.z as usize {
            for y in from.y as usize..=to.y as usize {
                let row = z * CELLS + y;
                let mut taken = self.rows[row] & columns;
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

    /// The cells of `triangle` whose centroids are in this tile.
    fn divide(&self, triangle: Triangle, mut found: impl FnMut(Triangle)) {
        let coarsest = (PATCH * self.spacing).powi(2);
        let mut open = vec![triangle];
        while let Some(triangle) = open.pop() {
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

/// Points that darts in a cell may hit, µm.
#[derive(Debug, Default)]
struct Near {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// As of [`Apart`].
    lost: f64,
}

impl Near {
    fn clear(&mut self, lost: f64) {
        [&mut self.x, &mut self.y, &mut self.z].into_iter().for_each(Vec::clear);
        self.lost = lost;
    }

    /// Takes a point in; answers its bit, none of those beyond the last bit.
    fn push(&mut self, point: DVec3) -> u64 {
        let bit = 1u64.checked_shl(self.x.len() as u32).unwrap_or(0);
        self.x.push(point.x);
        self.y.push(point.y);
        self.z.push(point.z);
        bit
    }

    /// What [`Apart::squared`] says of each point and `place`.
    fn squares(&self, place: DVec3) -> impl Iterator<Item = f64> {
        let square = move |((x, y), z): ((&f64, &f64), &f64)| {
            let height = ((place.z - z).abs() - self.lost).max(0.0);
            (place.x - x) * (place.x - x) + (place.y - y) * (place.y - y) + height * height
        };
        self.x.iter().zip(&self.y).zip(&self.z).map(square)
    }

    /// Whether a dart hits a point within the distance whose square is given. Darts and points are whole µm: the comparison is exact.
    fn hits(&self, dart: DVec3, square: f64) -> bool {
        self.squares(dart).any(|own| own < square)
    }

    /// The bits of the points around `place` within the distance whose square is given.
    fn around(&self, place: DVec3, square: f64) -> u64 {
        let bits = self.squares(place).take(64).enumerate();
        bits.fold(0, |near, (i, own)| near | u64::from(own < square) << i)
    }
}

/// A cell, and of each of its corners the bits of the points within a spacing.
#[derive(Clone, Copy, Debug)]
struct Cell {
    corners: Triangle,
    near: [u64; 3],
}

/// The nearest whole number, of those within 4 m in µm.
fn whole(value: f64) -> i32 {
    const OFF: i32 = 1 << 22;
    (value + (f64::from(OFF) + 0.5)) as i32 - OFF
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
        ranked.iter().for_each(|&i| near.push(points[i as usize]));
        waiting.retain(|&i| {
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

    /// A place in a triangle, every one as likely as every other.
    fn within(&mut self, &[a, b, c]: &Triangle) -> DVec3 {
        let (u, v) = (self.part(), self.part());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        a + (b - a) * u + (c - a) * v
    }
}
