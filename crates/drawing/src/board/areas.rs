//! A board as areas, for who draws it by himself: trapezoids between two lines along X.

use super::{BoardPicture, chords};
use geom::region::{Island, Region, Ring};
use geom::{Element, Vec2};
use pcb::board::Axis;
use pcb::plan::Problem;
use pcb::{Hole, HoleShape};
use std::iter;

/// The most trapezoids of a board.
pub const MOST_AREAS: usize = 250_000;

/// How far chords may be from their arcs at first, mm: less is not seen.
const CHORD: f64 = 0.002;

/// How far they may be at last, where there are too many.
const COARSEST: f64 = 0.05;

/// What corners are rounded to, mm: those that differ by less are equally high.
const STEP: f64 = 1e-4;

/// A part of an area between two heights: `low`, `high` (Y, mm), left and right at `low`, left and right at `high` (X, mm).
pub type Trapezoid = [f64; 6];

/// What an area is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AreaKind {
    /// The board without its copper.
    Board,
    /// Copper that is one conductor.
    Copper,
    /// What stays that should not.
    Rest,
}

/// An area, and which of the trapezoids are its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// What it is.
    pub kind: AreaKind,
    /// The name of its net, where a file says it.
    pub net: Option<String>,
    /// The number of the conductor that it is part of, from 0; islands of one net are one conductor.
    pub conductor: usize,
    /// The first of its trapezoids.
    pub first: usize,
    /// How many they are.
    pub count: usize,
}

/// A board as areas, the lowest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoardAreas {
    /// The areas.
    pub areas: Vec<Area>,
    /// Their trapezoids.
    pub trapezoids: Vec<Trapezoid>,
    /// Holes as strokes with round ends: from X, Y to X, Y, and their width, mm. A round hole begins where it ends.
    pub holes: Vec<[f64; 5]>,
    /// Where tabs stay: from X, Y to X, Y, mm.
    pub tabs: Vec<[f64; 4]>,
    /// Places to look at, the worst first.
    pub problems: Vec<Problem>,
    /// The line about which the board is turned over.
    pub turning: Option<Axis>,
    /// How far the areas may be from what they are of, mm.
    pub chord: f64,
    /// Whether these are all: of a board with more than [`MOST_AREAS`] what comes last is left out.
    pub is_whole: bool,
}

impl BoardAreas {
    /// What a picture has below its cuts.
    pub fn of(picture: &BoardPicture) -> BoardAreas {
        let mut chord = CHORD;
        loop {
            let areas = BoardAreas::within(picture, chord);
            if areas.is_whole || chord >= COARSEST {
                return areas;
            }
            chord = (chord * 3.0).min(COARSEST);
        }
    }

    fn within(picture: &BoardPicture, chord: f64) -> BoardAreas {
        let mut all = BoardAreas { chord, is_whole: true, ..BoardAreas::default() };
        all.problems = picture.problems.to_vec();
        all.turning = picture.turning;
        all.tabs = picture
            .tabs
            .iter()
            .map(|Element { start, end, .. }| [start.x, start.y, end.x, end.y])
            .collect();
        all.holes = picture.holes.iter().flat_map(|hole| strokes(hole, chord)).collect();
        for island in picture.outline.into_iter().flat_map(Region::islands) {
            all.add(AreaKind::Board, None, 0, island);
        }
        if let Some(copper) = picture.copper {
            let nets = copper.nets.iter().map(Option::as_deref).chain(iter::repeat(None));
            let each = copper.region.islands().iter().zip(nets).zip(copper.conductors());
            for ((island, net), conductor) in each {
                all.add(AreaKind::Copper, net, conductor, island);
            }
        }
        for island in picture.rest.iter().flat_map(Region::islands) {
            all.add(AreaKind::Rest, None, 0, island);
        }
        all
    }

    fn add(&mut self, kind: AreaKind, net: Option<&str>, conductor: usize, island: &Island) {
        let first = self.trapezoids.len();
        if !self.is_whole {
            return;
        }
        let rings = iter::once(island.outer()).chain(island.holes());
        trapezoids(rings, self.chord, &mut self.trapezoids);
        if self.trapezoids.len() > MOST_AREAS {
            self.trapezoids.truncate(first);
            self.is_whole = false;
            return;
        }
        let count = self.trapezoids.len() - first;
        self.areas.push(Area { kind, net: net.map(str::to_owned), conductor, first, count });
    }
}

/// A hole as strokes.
fn strokes(hole: &Hole, chord: f64) -> Vec<[f64; 5]> {
    let stroke = |a: Vec2, b: Vec2| [a.x, a.y, b.x, b.y, hole.diameter];
    match &hole.shape {
        HoleShape::Round(at) => vec![stroke(*at, *at)],
        HoleShape::Slot(from, to) => vec![stroke(*from, *to)],
        HoleShape::Route(elements) => {
            let mut all = Vec::new();
            for element in elements {
                let mut from = element.start;
                corners(element, chord, &mut |to| {
                    all.push(stroke(from, to));
                    from = to;
                });
            }
            all
        }
    }
}

/// The ends of the chords of an element.
fn corners(element: &Element, chord: f64, each: &mut dyn FnMut(Vec2)) {
    let pieces = chords(element, chord);
    for i in 1..pieces {
        each(element.at(f64::from(i) / f64::from(pieces)));
    }
    each(element.end);
}

/// A side of an area that is not along X: its lower end comes first.
#[derive(Clone, Copy)]
struct Side {
    low: Vec2,
    high: Vec2,
}

impl Side {
    fn x(&self, y: f64) -> f64 {
        let part = (y - self.low.y) / (self.high.y - self.low.y);
        self.low.x + (self.high.x - self.low.x) * part.clamp(0.0, 1.0)
    }
}

/// Divides what rings enclose, which do not cross each other, into trapezoids: from side to side, as high as both go on with nothing
/// between them. There are fewer than twice as many as corners.
fn trapezoids<'a>(rings: impl Iterator<Item = &'a Ring>, chord: f64, all: &mut Vec<Trapezoid>) {
    let rounded = |point: Vec2| Vec2::new(point.x, (point.y / STEP).round() * STEP);
    let mut sides: Vec<Side> = Vec::new();
    for element in rings.flat_map(Ring::elements) {
        let mut from = rounded(element.start);
        corners(element, chord, &mut |to| {
            let to = rounded(to);
            let (low, high) = if from.y <= to.y { (from, to) } else { (to, from) };
            if low.y < high.y {
                sides.push(Side { low, high });
            }
            from = to;
        });
    }
    sides.sort_by(|a, b| a.low.y.total_cmp(&b.low.y));
    let mut heights: Vec<f64> = sides.iter().flat_map(|side| [side.low.y, side.high.y]).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    // Those that the line at this height crosses, from left to right, and the trapezoids that are open there.
    let mut crossed: Vec<(f64, usize)> = Vec::new();
    let mut open: Vec<(usize, usize, f64)> = Vec::new();
    // Which side is right of a side that is left of something, and from which height on.
    let mut right: Vec<Option<(usize, f64)>> = vec![None; sides.len()];
    let mut next = 0;
    for (at, low) in heights.iter().copied().enumerate() {
        crossed.retain(|(_, side)| sides[*side].high.y > low);
        while sides.get(next).is_some_and(|side| side.low.y <= low) {
            crossed.push((0.0, next));
            next += 1;
        }
        let middle = heights.get(at + 1).map_or(low, |high| low.midpoint(*high));
        for (x, side) in &mut crossed {
            *x = sides[*side].x(middle);
        }
        crossed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut opened = Vec::with_capacity(open.len());
        for pair in crossed.chunks_exact(2) {
            let (left, other) = (pair[0].1, pair[1].1);
            let begun = match right[left] {
                Some((known, begun)) if known == other => begun,
                _ => low,
            };
            opened.push((left, other, begun));
        }
        for (left, ..) in &open {
            right[*left] = None;
        }
        for (left, other, begun) in &opened {
            right[*left] = Some((*other, *begun));
        }
        for (left, other, begun) in open {
            if right[left] != Some((other, begun)) {
                let (a, b) = (&sides[left], &sides[other]);
                all.push([begun, low, a.x(begun), b.x(begun), a.x(low), b.x(low)]);
            }
        }
        open = opened;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::region::Fill;
    use pcb::Copper;
    use pcb::plan::ProblemKind;
    use program::Program;
    use std::f64::consts::PI;

    fn polygon(corners: &[[f64; 2]]) -> Region {
        let corners: Vec<Vec2> = corners.iter().map(|corner| Vec2::from_array(*corner)).collect();
        Region::inside([&Ring::polygon(&corners).unwrap()], Fill::NonZero).unwrap()
    }

    fn divided(region: &Region) -> Vec<Trapezoid> {
        let mut all = Vec::new();
        trapezoids(region.rings(), CHORD, &mut all);
        all
    }

    fn area(all: &[Trapezoid]) -> f64 {
        all.iter().map(|[low, high, a, b, c, d]| (high - low) * (b - a + d - c) / 2.0).sum()
    }

    #[test]
    fn an_area_with_a_hole_is_divided_at_its_corners() {
        let frame = polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
        let hole = polygon(&[[1.0, 1.0], [2.0, 1.0], [2.0, 3.0], [1.0, 3.0]]);
        let all = divided(&frame.difference(&hole).unwrap());
        // Below the hole, left and right of it, above it.
        let mut sorted = all.clone();
        sorted.sort_by(|a, b| (a[0], a[2]).partial_cmp(&(b[0], b[2])).unwrap());
        assert_eq!(
            sorted,
            [
                [0.0, 1.0, 0.0, 4.0, 0.0, 4.0],
                [1.0, 3.0, 0.0, 1.0, 0.0, 1.0],
                [1.0, 3.0, 2.0, 4.0, 2.0, 4.0],
                [3.0, 4.0, 0.0, 4.0, 0.0, 4.0],
            ]
        );
        // A triangle beside a slope: 3 x 2 / 2.
        let slope = divided(&polygon(&[[0.0, 0.0], [3.0, 0.0], [1.0, 2.0]]));
        assert_eq!(slope, [[0.0, 2.0, 0.0, 3.0, 1.0, 1.0]]);
    }

    #[test]
    fn a_disc_and_a_ring_are_as_large_as_they_are() {
        let disc = Region::disc(Vec2::new(3.0, -2.0), 1.5).unwrap();
        let off = area(&divided(&disc)) - PI * 2.25;
        // Chords lie inside, by no more than 0.002 mm all around.
        assert!(off <= 1e-6 && off > -0.002 * 2.0 * PI * 1.5, "{off}");
        let ring = disc.difference(&Region::disc(Vec2::new(3.2, -2.0), 0.5).unwrap()).unwrap();
        assert!((area(&divided(&ring)) - PI * 2.0).abs() < 0.03);
    }

    #[test]
    fn a_board_has_its_copper_by_nets_and_what_is_odd_about_it() {
        let edge = polygon(&[[0.0, 0.0], [9.0, 0.0], [9.0, 5.0], [0.0, 5.0]]);
        let pads = [[1.0, 1.0], [4.0, 1.0], [7.0, 1.0]]
            .map(|[x, y]| polygon(&[[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]]));
        let copper = Copper {
            region: Region::union_of(&pads).unwrap(),
            nets: vec![Some("GND".into()), None, Some("GND".into())],
        };
        let hole = |shape| Hole { shape, diameter: 0.8, plated: None };
        let at = Vec2::new(1.5, 1.5);
        let holes = [hole(HoleShape::Round(at)), hole(HoleShape::Slot(at, at + Vec2::X))];
        let problem =
            Problem { at, kind: ProblemKind::Joined, what: "two nets stay joined".into() };
        let picture = BoardPicture {
            outline: Some(&edge),
            copper: Some(&copper),
            holes: &holes,
            program: &Program::default(),
            widths: &[],
            problems: std::slice::from_ref(&problem),
            rest: &pads[..1],
            turning: Some(Axis::X(4.5)),
            tabs: &[Element::line(at, at + Vec2::Y)],
            stock: None,
        };
        let all = BoardAreas::of(&picture);
        let listed: Vec<_> =
            all.areas.iter().map(|area| (area.kind, area.net.as_deref(), area.conductor)).collect();
        use AreaKind::{Board, Copper as Conductor, Rest};
        assert_eq!(
            listed,
            [
                (Board, None, 0),
                (Conductor, Some("GND"), 0),
                (Conductor, None, 1),
                (Conductor, Some("GND"), 0),
                (Rest, None, 0),
            ]
        );
        assert!(all.is_whole && all.areas.iter().all(|area| area.count == 1));
        assert_eq!(all.trapezoids[2], [1.0, 2.0, 4.0, 5.0, 4.0, 5.0]);
        assert_eq!(all.holes, [[1.5, 1.5, 1.5, 1.5, 0.8], [1.5, 1.5, 2.5, 1.5, 0.8]]);
        assert_eq!(all.tabs, [[1.5, 1.5, 1.5, 2.5]]);
        assert_eq!((all.problems, all.turning), (vec![problem], Some(Axis::X(4.5))));
    }
}
