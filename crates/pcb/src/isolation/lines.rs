//! All lines between conductors that come near each other: where they begin, and where they branch.
//!
//! Where two conductors are nearest to each other, and nothing is between them, a line begins. It ends
//! where they are too far apart, or in a corner that is as far from a third: there the lines to that one
//! begin. So every line is found: along it the two come nearest somewhere, or nearer and nearer towards a
//! corner, and from there so do others.

use super::field::{Field, Foot};
use super::middle::{CHORD, End, LinePoint, Middle};
use geom::ending::go_on;
use geom::{Element, Vec2};
use static_aabb2d_index::{StaticAABB2DIndex, StaticAABB2DIndexBuilder};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// So many pairs of edges are looked at, and so many places taken, at most: some seconds.
const MOST: usize = 1 << 23;

/// What is farther than the nearest by no more than this is as far, mm; corners nearer to each other than
/// this are one.
const SAME: f64 = 1e-5;

/// The line between two conductors, or a piece of it.
#[derive(Clone, Debug)]
pub(super) struct Line {
    /// The two conductors.
    pub pair: [usize; 2],
    /// At least one place; the last is the first where it is closed.
    pub points: Vec<LinePoint>,
}

/// More is near each other than can be looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TooMany;

/// All lines along which two conductors are up to `limit` mm away.
pub(super) fn lines(field: &Field, limit: f64) -> Result<Vec<Line>, TooMany> {
    let mut lines = Lines::new(field, limit)?;
    for i in 0..lines.seeds.len() {
        lines.follow_seed(i)?;
        while let Some((corner, branch)) = lines.open.pop() {
            go_on();
            lines.follow_branch(corner, branch)?;
        }
    }
    Ok(lines.lines)
}

/// Where two conductors are nearest to each other.
struct Seed {
    pair: [usize; 2],
    point: LinePoint,
    /// Whether a line goes through it.
    is_passed: bool,
}

/// A place that is as far from three conductors or more.
struct Corner {
    point: LinePoint,
    branches: Vec<Branch>,
}

/// A line that ends in a corner.
struct Branch {
    pair: [usize; 2],
    /// Its direction away from the corner.
    along: Vec2,
    is_known: bool,
}

struct Lines<'f, 'a> {
    field: &'f Field<'a>,
    limit: f64,
    seeds: Vec<Seed>,
    seeds_at: Option<StaticAABB2DIndex<f64>>,
    corners: Vec<Corner>,
    corners_at: BTreeMap<[i64; 2], usize>,
    /// Corners and their branches that may not be known yet.
    open: Vec<(usize, usize)>,
    lines: Vec<Line>,
    /// How many places have been taken.
    taken: usize,
}

impl<'f, 'a> Lines<'f, 'a> {
    fn new(field: &'f Field<'a>, limit: f64) -> Result<Self, TooMany> {
        let seeds = seeds(field, limit)?;
        let mut tree = StaticAABB2DIndexBuilder::new(seeds.len());
        for Seed { point: LinePoint { at, .. }, .. } in &seeds {
            tree.add(at.x, at.y, at.x, at.y);
        }
        Ok(Lines {
            field,
            limit,
            seeds,
            seeds_at: tree.build().ok(),
            corners: Vec::new(),
            corners_at: BTreeMap::new(),
            open: Vec::new(),
            lines: Vec::new(),
            taken: 0,
        })
    }

    /// In both directions from a seed, if no line has come through it.
    fn follow_seed(&mut self, seed: usize) -> Result<(), TooMany> {
        let Some(&Seed { pair, point, is_passed: false }) = self.seeds.get(seed) else {
            return Ok(());
        };
        let mut middle = Middle::new(self.field, pair, self.limit, point);
        let mut points = vec![point];
        if let Some(along) = middle.direction(point.at) {
            let (on, end) = middle.walk(point, along);
            self.arrive(&on, point, pair, end);
            points.extend(on);
            if end != End::Closed {
                let (back, end) = middle.walk(point, -along);
                self.arrive(&back, point, pair, end);
                points.splice(0..0, back.into_iter().rev());
            }
            // In a corner another line has been there before, or comes there from here.
            if end == End::Corner && is_short(&points) {
                return Ok(());
            }
        }
        self.add(points, pair)
    }

    /// From a corner along one of its branches, if that is not known.
    fn follow_branch(&mut self, corner: usize, branch: usize) -> Result<(), TooMany> {
        let Some(Corner { point, branches }) = self.corners.get_mut(corner) else {
            return Ok(());
        };
        let point = *point;
        let Some(Branch { pair, along, is_known: is_known @ false }) = branches.get_mut(branch)
        else {
            return Ok(());
        };
        *is_known = true;
        let (pair, along) = (*pair, *along);
        let mut middle = Middle::new(self.field, pair, self.limit, point);
        let (on, end) = middle.walk(point, along);
        self.arrive(&on, point, pair, end);
        let points: Vec<LinePoint> = [point].into_iter().chain(on).collect();
        if is_short(&points) { Ok(()) } else { self.add(points, pair) }
    }

    /// Adds a line, and marks the seeds that it passes; where they are narrower than their neighbours,
    /// they become places of it.
    fn add(&mut self, points: Vec<LinePoint>, pair: [usize; 2]) -> Result<(), TooMany> {
        self.taken += points.len();
        if self.taken > MOST {
            return Err(TooMany);
        }
        // Of each seed the chord that is nearest, and the place along it.
        let mut passed: BTreeMap<usize, (f64, usize, f64)> = BTreeMap::new();
        for (i, ends) in points.windows(2).enumerate() {
            go_on();
            let chord = Element::line(ends[0].at, ends[1].at);
            let (low, high) = chord.extents();
            let (low, high) = (low - CHORD, high + CHORD);
            let trees = self.seeds_at.iter();
            for seed in trees.flat_map(|tree| tree.query(low.x, low.y, high.x, high.y)) {
                let Some(Seed { pair: of, point, .. }) = self.seeds.get(seed) else { continue };
                let (t, off) = chord.nearest(point.at);
                let is_nearest = passed.get(&seed).is_none_or(|(least, ..)| off < *least);
                if *of == pair && off <= CHORD && is_nearest {
                    passed.insert(seed, (off, i, t));
                }
            }
        }
        let mut places: Vec<(usize, f64, LinePoint)> =
            points.iter().enumerate().map(|(i, point)| (i, 0.0, *point)).collect();
        for (seed, (_, i, t)) in passed {
            let Some(seed) = self.seeds.get_mut(seed) else { continue };
            seed.is_passed = true;
            let neighbours = points.iter().skip(i).take(2).map(|point| point.away);
            if seed.point.away < neighbours.fold(f64::INFINITY, f64::min) {
                places.push((i, t, seed.point));
            }
        }
        places.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let points = places.into_iter().map(|(_, _, point)| point).collect();
        self.lines.push(Line { pair, points });
        Ok(())
    }

    /// Notes that a line comes to its end, from `start` by `on`.
    fn arrive(&mut self, on: &[LinePoint], start: LinePoint, pair: [usize; 2], end: End) {
        let (End::Corner, Some(last)) = (end, on.last()) else { return };
        let before = on.iter().rev().nth(1).map_or(start, |point| *point);
        let corner = self.corner_at(*last);
        let Some(Corner { branches, .. }) = self.corners.get_mut(corner) else { return };
        let back = before.at - last.at;
        let mut same = branches.iter_mut().filter(|branch| branch.pair == pair);
        let first = same.next();
        let best = same.fold(first, |best, branch| match best {
            Some(best) if best.along.dot(back) >= branch.along.dot(back) => Some(best),
            _ => Some(branch),
        });
        if let Some(branch) = best {
            branch.is_known = true;
        }
    }

    /// The corner at a place, with all its branches.
    fn corner_at(&mut self, point: LinePoint) -> usize {
        let cell = (point.at / (2.0 * SAME)).round();
        let cell = [cell.x as i64, cell.y as i64];
        for dx in -1..=1 {
            for dy in -1..=1 {
                let neighbour = [cell[0].saturating_add(dx), cell[1].saturating_add(dy)];
                let Some(&known) = self.corners_at.get(&neighbour) else { continue };
                let is_here = |corner: &Corner| corner.point.at.distance(point.at) < SAME;
                if self.corners.get(known).is_some_and(is_here) {
                    return known;
                }
            }
        }
        let window = self.field.window(point.at, point.away + SAME);
        let branches = branches(point.at, window.nearest(point.at, SAME));
        let corner = self.corners.len();
        self.open.extend((0..branches.len()).map(|branch| (corner, branch)));
        self.corners.push(Corner { point, branches });
        self.corners_at.insert(cell, corner);
        corner
    }
}

/// Whether places are all about one.
fn is_short(points: &[LinePoint]) -> bool {
    let ends = points.first().zip(points.last());
    ends.is_none_or(|(first, last)| points.len() <= 4 && first.at.distance(last.at) < 10.0 * SAME)
}

/// The lines that end in a corner: between each two of its feet that are next to each other around it.
fn branches(corner: Vec2, feet: Vec<Foot>) -> Vec<Branch> {
    let mut around: Vec<(f64, usize)> =
        feet.iter().map(|foot| ((foot.at - corner).to_angle(), foot.edge.conductor)).collect();
    around.sort_by(|a, b| a.0.total_cmp(&b.0));
    let nexts = around.iter().cycle().skip(1);
    let pairs = around.iter().zip(nexts).filter(|((_, first), (_, second))| first != second);
    pairs
        .map(|(&(from, first), &(to, second))| {
            let between = (to - from).rem_euclid(TAU);
            Branch {
                pair: [first.min(second), first.max(second)],
                along: Vec2::from_angle(from + between / 2.0),
                is_known: false,
            }
        })
        .collect()
}

/// The places where two conductors are nearest to each other, up to twice `limit` mm apart, and nothing is
/// between them.
fn seeds(field: &Field, limit: f64) -> Result<Vec<Seed>, TooMany> {
    let mut seeds = Vec::new();
    let mut looked_at = 0;
    for edge in field.edges() {
        go_on();
        let (low, high) = edge.element.extents();
        for other in field.within(low - 2.0 * limit, high + 2.0 * limit) {
            looked_at += 1;
            // Each pair is met from both sides.
            if other.conductor <= edge.conductor {
                continue;
            }
            let (a, b) = edge.element.closest(other.element);
            let point = LinePoint { at: a.midpoint(b), away: a.distance(b) / 2.0 };
            let is_outside = edge.is_left_towards(b) && other.is_left_towards(a);
            let is_near = point.away < limit && (is_outside || point.away < SAME);
            if is_near && field.is_free(point.at, point.away - SAME) {
                let pair = [edge.conductor, other.conductor];
                seeds.push(Seed { pair, point, is_passed: false });
            }
        }
        if looked_at > MOST {
            return Err(TooMany);
        }
    }
    Ok(seeds)
}
