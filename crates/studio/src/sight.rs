//! What is seen of a walk in one view: the answer to a view for which the levels of [`crate::geometry`] are too coarse, or would be too many.
//!
//! The moves are drawn as exactly as this view shows it into cells of a third of a pixel, the nearest over the others, and the lines that are seen in at least one
//! cell are answered: as many as the window has cells at the most, however many moves there are. What is out of sight is not followed: chunks and moves by their
//! boxes, arcs by halves. Of turns that lie within `ALIKE` of one another in the picture the nearest alone is drawn. Rapids, which are dashed, hide one another alone.
//!
//! ```text
//! asked     SIZE/PLACE/HIDDEN/MOVES: width and height of the window, pixels (`686,345`); twelve numbers `rx,ry,rz,dx,dy,dz,ax,ay,az,x,y,z` by which
//!           a point p of the walk is (x + r·p) pixels right, (y + d·p) down and (z + a·p) away; a bit for each kind that is not drawn; the moves
//!           that are, half open (`3-4,9-12`), or `all`
//! answered  how many chunks u32; of each its number and how many vertices, 2 u32; then all vertices: as in `geometry`, and x y z are pixels right, down
//!           and away
//! ```

use crate::geometry::{CHUNK, Geometry, MOST_LED};
use crate::packed::Packed;
use crate::walk::{GAP, PULSE, RAPID, Walk};
use geom::{Arc, Vec3};
use std::collections::HashMap;
use std::collections::hash_map::{DefaultHasher, Entry};
use std::f64::consts::TAU;
use std::hash::{Hash, Hasher};
use std::ops::Range;

/// How far a chord may be from its arc, and turns that are left out at their nine points from one that is drawn, pixels.
const NEAR: f64 = 0.1;
const ALIKE: f64 = 0.3;

/// Cells of a pixel along each side: as many as the window has room for, whose pixels are no more than its cells.
const FINE: f64 = 3.0;
const MOST_CELLS: f64 = 16e6;

/// Pixels beside the window in which lines are followed: they are wide, and dashed from where they begin.
const BESIDE: f64 = 8.0;

/// How many sorts of turns are told apart; those of further ones are all drawn.
const MOST_SORTS: usize = 1 << 20;

/// How many pieces of moves are looked at, and how many cells lines go through, at the most: some seconds.
const MOST_PIECES: u32 = 1 << 25;
const MOST_WORK: u64 = 1 << 33;

/// After so many pieces it asks whether to go on.
const LOOK: u32 = 1 << 14;

/// How many moves with marks are seen even where others hide them.
const MOST_MARKED: usize = 1 << 10;

/// The chords of moves in which the axes lead the tip are no finer, mm.
const FINEST: f64 = 1e-6;

/// A view of a walk.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Pixels of the window.
    width: f64,
    height: f64,
    /// Pixels right, down and away of a millimetre along each axis.
    ways: [Vec3; 3],
    /// Where the zero point is, pixels.
    at: Vec3,
    /// Of the kinds a bit for each that is not drawn.
    hidden: u32,
    /// The moves that are drawn; none: all.
    moves: Option<Vec<Range<u32>>>,
}

impl View {
    /// As it is asked for; `None` where that is no view, or one with more cells than there may be.
    pub fn read(size: &str, place: &str, hidden: &str, moves: &str) -> Option<View> {
        let numbers = |text: &str| -> Option<Vec<f64>> {
            let read = text.split(',').map(|number| number.parse().ok());
            read.map(|number: Option<f64>| number.filter(|number| number.is_finite())).collect()
        };
        let [width, height] = numbers(size)?.try_into().ok()?;
        let place = numbers(place)?;
        let is_size = |pixels: f64| pixels >= 1.0 && pixels.fract() == 0.0;
        if !is_size(width) || !is_size(height) || width * height > MOST_CELLS {
            return None;
        }
        let (rows, []) = place.as_chunks::<3>() else { return None };
        let [right, down, away, at] =
            rows.try_into().ok().map(|r: [[f64; 3]; 4]| r.map(Vec3::from_array))?;
        let range = |text: &str| {
            let (from, to) = text.split_once('-')?;
            Some(from.parse().ok()?..to.parse().ok()?)
        };
        let moves = match moves {
            "all" => None,
            ranges => Some(ranges.split(',').map(range).collect::<Option<_>>()?),
        };
        let hidden = hidden.parse().ok()?;
        Some(View { width, height, ways: [right, down, away], at, hidden, moves })
    }

    fn project(&self, point: Vec3) -> Vec3 {
        let [right, down, away] = self.ways;
        self.at + Vec3::new(right.dot(point), down.dot(point), away.dot(point))
    }

    /// A way of the walk in pixels.
    fn turn(&self, way: Vec3) -> Vec3 {
        self.project(way) - self.at
    }

    /// The most pixels that a millimetre has.
    fn scale(&self) -> f64 {
        self.ways.iter().map(|way| way.length()).fold(0.0, f64::max)
    }

    /// Whether anything of a box of pixels may be seen.
    fn sees(&self, low: Vec3, high: Vec3) -> bool {
        let within = |low: f64, high: f64, size: f64| low <= size + BESIDE && high >= -BESIDE;
        within(low.x, high.x, self.width) && within(low.y, high.y, self.height)
    }

    /// Whether anything of a box about a point of the walk may be seen.
    fn sees_box(&self, origin: Vec3, half: Vec3) -> bool {
        let middle = self.project(origin);
        let spread = Vec3::from_array(self.ways.map(|way| way.abs().dot(half)));
        self.sees(middle - spread, middle + spread)
    }

    /// What of a line is within the window, and somewhat beside it.
    fn clipped(&self, [a, b]: [Vec3; 2]) -> Option<[Vec3; 2]> {
        if !self.sees(a.min(b), a.max(b)) {
            return None;
        }
        let way = b - a;
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (a, way, size) in [(a.x, way.x, self.width), (a.y, way.y, self.height)] {
            if way != 0.0 {
                let ends = [(-BESIDE - a) / way, (size + BESIDE - a) / way];
                from = from.max(ends[0].min(ends[1]));
                to = to.min(ends[0].max(ends[1]));
            }
        }
        let begin = if from == 0.0 { a } else { a + way * from };
        let end = if to == 1.0 { b } else { a + way * to };
        (from <= to).then_some([begin, end])
    }

    /// The moves of a chunk that are drawn.
    fn of(&self, moves: Range<u32>) -> impl Iterator<Item = u32> {
        let all = 0..u32::MAX;
        let own = self.moves.as_deref().unwrap_or(std::slice::from_ref(&all));
        let within = own.iter().map(move |own| own.start.max(moves.start)..own.end.min(moves.end));
        within.collect::<Vec<_>>().into_iter().flatten()
    }
}

/// What is seen of a walk in a view, as it is answered, for as long as `goes_on` says so; `None` also where too much is in sight to be looked through.
pub fn sight(walk: (&Walk, &Geometry), view: &View, goes_on: &dyn Fn() -> bool) -> Option<Vec<u8>> {
    let mut sorts = Sorts::default();
    follow(walk, view, goes_on, &mut |of, piece| {
        if let Piece::Round(round) = piece {
            sorts.add(of, &round);
        }
        Some(())
    })?;
    let mut planes = Planes::new(view);
    lines(walk, view, &sorts.are_nearest, goes_on, &mut |of, line| planes.line(of, line))?;
    let mut answer = Answer::default();
    let mut seen = planes.seen().into_iter().peekable();
    let mut number = 0;
    lines(walk, view, &sorts.are_nearest, goes_on, &mut |of, line| {
        number += 1;
        if seen.next_if_eq(&number).is_some() {
            answer.add(of, line);
        }
        Some(())
    })?;
    Some(answer.octets())
}

/// A move in its chunk, and what a vertex says of it.
#[derive(Clone, Copy)]
struct Move {
    chunk: u32,
    packed: Packed,
}

/// What may be in sight of a move, in pixels.
enum Piece {
    Line([Vec3; 2]),
    Round(Round),
}

/// Tells all that may be in sight: each time the same in the same order.
fn follow(
    (walk, geometry): (&Walk, &Geometry),
    view: &View,
    goes_on: &dyn Fn() -> bool,
    tell: &mut impl FnMut(Move, Piece) -> Option<()>,
) -> Option<()> {
    let can_lead = walk.stride() > 3 || !walk.goes_together();
    let mut pieces = 0;
    let mut tell = |of: Move, piece: Piece| {
        pieces += 1;
        (pieces <= MOST_PIECES && (pieces % LOOK != 0 || goes_on())).then_some(())?;
        tell(of, piece)
    };
    for (chunk, (origin, half)) in (0..).zip(geometry.boxes()) {
        if !view.sees_box(origin, half) {
            continue;
        }
        goes_on().then_some(())?;
        let first = chunk * CHUNK;
        let moves = first..first.saturating_add(CHUNK).min(walk.len());
        let (mut arcs, mut starts) = (walk.arcs(moves.clone()), walk.starts(moves.clone()));
        let led = view.of(moves.clone()).filter(|at| can_lead && walk.led(*at).is_some()).count();
        let most_led = (MOST_LED / led.max(1)).max(16);
        for at in view.of(moves) {
            let kind = walk.kind(at);
            let (arc, start) = (of_move(&mut arcs, at), of_move(&mut starts, at));
            let to = walk.behind(at).tip;
            let of = Move { chunk, packed: Packed::of(walk, first, at) };
            let mut line = |a: Vec3, b: Vec3| match view.clipped([a, b]) {
                Some(line) => tell(of, Piece::Line(line)),
                None => Some(()),
            };
            let from = match (start, at.checked_sub(1)) {
                (Some(start), _) => start.tip,
                (None, Some(before)) => walk.behind(before).tip,
                (None, None) => Vec3::NAN,
            };
            // To a pulse no line leads.
            let is_known = to.is_finite() && (from.is_finite() || kind == PULSE);
            if view.hidden >> kind & 1 == 1 || !is_known {
                continue;
            }
            if kind == PULSE {
                line(view.project(to), view.project(to))?;
            } else if let Some(arc) = arc {
                for round in Turns::of(arc, view) {
                    tell(of, Piece::Round(round))?;
                }
            } else if led > 0
                && let Some(motion) = walk.led(at)
            {
                let tool = motion.tool();
                let mut a = view.project(from);
                for part in motion.parts((NEAR / view.scale()).max(FINEST), most_led) {
                    let b = if part < 1.0 { tool(part).0 } else { to };
                    let b = view.project(b);
                    line(a, b)?;
                    a = b;
                }
            } else {
                line(view.project(from), view.project(to))?;
            }
        }
    }
    Some(())
}

/// The entry of a list, ordered by moves, that is of a move; those before it are taken away.
fn of_move<'a, T>(list: &mut &'a [(u32, T)], at: u32) -> Option<&'a T> {
    while let Some(((of, entry), rest)) = list.split_first().filter(|((of, _), _)| *of <= at) {
        *list = rest;
        if *of == at {
            return Some(entry);
        }
    }
    None
}

/// Tells all lines that may be in sight, those of arcs as well, but for turns that are not the nearest of their sort.
fn lines(
    walk: (&Walk, &Geometry),
    view: &View,
    are_nearest: &[bool],
    goes_on: &dyn Fn() -> bool,
    tell: &mut impl FnMut(Move, [Vec3; 2]) -> Option<()>,
) -> Option<()> {
    let mut are_nearest = are_nearest.iter();
    follow(walk, view, goes_on, &mut |of, piece| match piece {
        Piece::Line(line) => tell(of, line),
        Piece::Round(round) if are_nearest.next() == Some(&true) => {
            round.chords(view, &mut |line| tell(of, line))
        }
        Piece::Round(_) => Some(()),
    })
}

/// An arc in pixels: `middle + across cos angle + along sin angle + rise t` at the part `t` of it, whose radius grows by `grows` evenly.
#[derive(Clone, Copy)]
struct Ellipse {
    middle: Vec3,
    across: Vec3,
    along: Vec3,
    rise: Vec3,
    grows: f64,
    sweep: f64,
    radius: f64,
}

impl Ellipse {
    fn of(arc: &Arc, view: &View) -> Ellipse {
        let spoke = (arc.start - arc.center).reject_from_normalized(arc.normal);
        let end = (arc.end - arc.center).reject_from_normalized(arc.normal);
        Ellipse {
            middle: view.project(arc.start - spoke),
            across: view.turn(spoke),
            along: view.turn(arc.normal.cross(spoke)),
            rise: view.turn(arc.normal * arc.rise()),
            grows: end.length() / spoke.length() - 1.0,
            sweep: arc.sweep,
            radius: spoke.length().max(end.length()) * view.scale(),
        }
    }

    fn at(&self, t: f64) -> Vec3 {
        let (sin, cos) = (self.sweep * t).sin_cos();
        let spoke = self.across * cos + self.along * sin;
        self.middle + spoke * (1.0 + self.grows * t) + self.rise * t
    }

    /// The box of a piece of it.
    fn bounds(&self, from: f64, to: f64) -> [Vec3; 2] {
        let most = 1.0 + self.grows.max(0.0);
        let reach = |i: usize| self.across[i].hypot(self.along[i]) * most;
        let reach = Vec3::new(reach(0), reach(1), reach(2));
        let ends = [from, to].map(|t| self.middle + self.rise * t);
        [ends[0].min(ends[1]) - reach, ends[0].max(ends[1]) + reach]
    }
}

/// A piece of an arc, of a turn and a half at the most.
struct Round {
    ellipse: Ellipse,
    from: f64,
    to: f64,
}

impl Round {
    /// Its chords that may be in sight.
    fn chords(&self, view: &View, tell: &mut impl FnMut([Vec3; 2]) -> Option<()>) -> Option<()> {
        let Round { ellipse, from, to } = self;
        // In halves of eighths of a turn, of which no part is far from its chord.
        let count = ((to - from) * ellipse.sweep / (TAU / 8.0)).ceil().max(1.0);
        let part = |number: f64| from + (to - from) * (number / count);
        let mut a = (*from, ellipse.at(*from));
        for number in 1..=count as u32 {
            let t = part(f64::from(number));
            let b = (t, ellipse.at(t));
            halves(ellipse, view, [a, b], tell)?;
            a = b;
        }
        Some(())
    }
}

/// Tells a piece of an arc between two points by its chords, each within [`NEAR`] of it.
fn halves(
    ellipse: &Ellipse,
    view: &View,
    [a, b]: [(f64, Vec3); 2],
    tell: &mut impl FnMut([Vec3; 2]) -> Option<()>,
) -> Option<()> {
    let half = (b.0 - a.0) * ellipse.sweep / 4.0;
    // The height of the arc over its chord: r (1 - cos 2h) = 2 r sin² h. The radius, which grows by rounding alone, leaves it by less.
    let off = 2.0 * ellipse.radius * half.sin().powi(2);
    if !view.sees(a.1.min(b.1) - off, a.1.max(b.1) + off) {
        return Some(());
    }
    let t = (a.0 + b.0) / 2.0;
    // Where halves are no halves any more, the numbers have no more digits.
    if off <= NEAR || t <= a.0 || t >= b.0 {
        return tell([a.1, b.1]);
    }
    let middle = (t, ellipse.at(t));
    halves(ellipse, view, [a, middle], tell)?;
    halves(ellipse, view, [middle, b], tell)
}

/// The pieces of an arc that may be in sight: the whole of it, or of a helix of several turns each turn, without those that lie on others.
struct Turns {
    ellipse: Ellipse,
    /// How many turns it has; 1 where it is taken as a whole.
    count: f64,
    next: f64,
    step: f64,
    last: f64,
}

impl Turns {
    fn of(arc: &Arc, view: &View) -> Turns {
        let ellipse = Ellipse::of(arc, view);
        let count = if ellipse.sweep > 1.5 * TAU { ellipse.sweep / TAU } else { 1.0 };
        let [low, high] = ellipse.bounds(0.0, 1.0 / count);
        let pitch = ellipse.rise / count;
        let (mut next, mut last) = (0.0, count.ceil() - 1.0);
        let sides = [(low.x, high.x, pitch.x, view.width), (low.y, high.y, pitch.y, view.height)];
        for (low, high, pitch, size) in sides {
            // The turns n with low + n pitch <= size and high + n pitch >= 0.
            let (first, behind) = match pitch {
                _ if pitch.abs() * count > 1e-9 => {
                    let ends = [(size + BESIDE - low) / pitch, (-BESIDE - high) / pitch];
                    (ends[0].min(ends[1]).floor(), ends[0].max(ends[1]).ceil())
                }
                _ if low > size + BESIDE || high < -BESIDE => (0.0, -1.0),
                _ => (next, last),
            };
            (next, last) = (f64::max(next, first), f64::min(last, behind));
        }
        // Of turns that are so near to one another the first or the last is the nearest one, and both are drawn.
        let apart = pitch.x.hypot(pitch.y) + ellipse.radius * ellipse.grows.abs() / count;
        let step = (ALIKE / apart).min(count).floor().max(1.0);
        Turns { ellipse, count, next, step, last }
    }
}

impl Iterator for Turns {
    type Item = Round;

    fn next(&mut self) -> Option<Round> {
        let Turns { ellipse, count, next, step, last } = *self;
        if next > last {
            return None;
        }
        self.next = if next < last { (next + step).min(last) } else { f64::INFINITY };
        Some(Round { ellipse, from: next / count, to: ((next + 1.0) / count).min(1.0) })
    }
}

/// Turns by what they look like and where in the picture they go.
#[derive(Default)]
struct Sorts {
    /// Of each piece of an arc whether it is the nearest of its sort.
    are_nearest: Vec<bool>,
    /// Of each sort how far away its nearest piece is, and the place of that.
    nearest: HashMap<[u64; 2], (f64, usize)>,
}

impl Sorts {
    fn add(&mut self, of: Move, round: &Round) {
        let place = self.are_nearest.len();
        self.are_nearest.push(true);
        let Round { ellipse, from, to } = round;
        let points: [Vec3; 9] =
            std::array::from_fn(|i| ellipse.at(from + (to - from) * i as f64 / 8.0));
        let away = points.iter().map(|point| point.z).sum::<f64>();
        // Turns of a sort are as near at all points: none goes through another one.
        let cell = |value: f64, side: f64| (value / side + 0.37).floor() as i64;
        let side = ALIKE / 2f64.sqrt();
        let places =
            points.map(|at| [cell(at.x, side), cell(at.y, side), cell(at.z - points[0].z, 1.0)]);
        let key = [0_u8, 1].map(|number| {
            let mut hasher = DefaultHasher::new();
            (number, of.packed.look(), places).hash(&mut hasher);
            hasher.finish()
        });
        let is_full = self.nearest.len() >= MOST_SORTS;
        match self.nearest.entry(key) {
            Entry::Occupied(mut known) if away <= known.get().0 => {
                let (_, other) = known.insert((away, place));
                self.are_nearest[other] = false;
            }
            Entry::Occupied(_) => self.are_nearest[place] = false,
            Entry::Vacant(_) if is_full => {}
            Entry::Vacant(new) => {
                new.insert((away, place));
            }
        }
    }
}

/// The cells of a window: of each the line that is nearest there, and how far away it is.
struct Plane {
    owners: Vec<u32>,
    away: Vec<f32>,
}

/// What is seen in the cells.
struct Planes {
    /// Cells of a pixel along each side, and of the window.
    fine: f64,
    width: usize,
    height: usize,
    solid: Plane,
    /// That of the rapids, once there are some.
    dashed: Option<Plane>,
    /// How many lines there were.
    lines: u32,
    /// How many cells lines went through.
    work: u64,
    /// Lines that are seen although others hide them, by the cells and the marks that they end with.
    marked: HashMap<(u8, usize), u32>,
}

impl Planes {
    fn new(view: &View) -> Planes {
        let fine = (MOST_CELLS / (view.width * view.height)).sqrt().floor().min(FINE);
        let (width, height) = ((fine * view.width) as usize, (fine * view.height) as usize);
        let solid = Plane::new(width * height);
        Planes {
            fine,
            width,
            height,
            solid,
            dashed: None,
            lines: 0,
            work: 0,
            marked: HashMap::new(),
        }
    }

    fn line(&mut self, of: Move, line: [Vec3; 2]) -> Option<()> {
        // Number 0 is none.
        self.lines = self.lines.checked_add(1)?;
        let Planes { fine, width, height, lines, .. } = *self;
        let cells = width * height;
        let plane = match of.packed.kind() {
            RAPID => self.dashed.get_or_insert_with(|| Plane::new(cells)),
            _ => &mut self.solid,
        };
        let [a, b] = line.map(|at| Vec3::new(at.x * fine, at.y * fine, at.z));
        let place = |at: Vec3| {
            let is_within =
                at.x >= 0.0 && at.y >= 0.0 && at.x < width as f64 && at.y < height as f64;
            is_within.then(|| at.y as usize * width + at.x as usize)
        };
        let way = b - a;
        let steps = way.x.abs().max(way.y.abs()).ceil().max(1.0);
        self.work += steps as u64;
        let step = way / steps;
        let mut at = a;
        for _ in 0..steps as u32 {
            if let Some(cell) = place(at) {
                plane.take(cell, at.z, lines);
            }
            at += step;
        }
        if let Some(cell) = place(b) {
            plane.take(cell, b.z, lines);
            if of.packed.marks() != 0 && self.marked.len() < MOST_MARKED {
                self.marked.entry((of.packed.marks(), cell)).or_insert(lines);
            }
        }
        (self.work <= MOST_WORK).then_some(())
    }

    /// The numbers of the lines that are seen, from 1 on.
    fn seen(self) -> Vec<u32> {
        let mut seen = self.solid.owners;
        seen.extend(self.dashed.into_iter().flat_map(|plane| plane.owners));
        seen.retain(|number| *number != 0);
        seen.extend(self.marked.into_values());
        seen.sort_unstable();
        seen.dedup();
        seen
    }
}

impl Plane {
    fn new(cells: usize) -> Plane {
        Plane { owners: vec![0; cells], away: vec![f32::INFINITY; cells] }
    }

    fn take(&mut self, cell: usize, away: f64, line: u32) {
        let away = away as f32;
        if away <= self.away[cell] {
            (self.away[cell], self.owners[cell]) = (away, line);
        }
    }
}

/// The lines that are seen, chunk by chunk.
#[derive(Default)]
struct Answer {
    /// The number of each chunk, and how many vertices it has.
    chunks: Vec<[u32; 2]>,
    vertices: Vec<[u32; 4]>,
}

impl Answer {
    fn add(&mut self, of: Move, line: [Vec3; 2]) {
        let vertex = |at: Vec3, packed: Packed| {
            let [x, y, z] = at.to_array().map(|value| (value as f32).to_bits());
            [x, y, z, packed.word()]
        };
        let [a, b] = line;
        let begin = vertex(a, of.packed.with_kind(GAP));
        let is_new = self.chunks.last().is_none_or(|[chunk, _]| *chunk != of.chunk);
        if is_new {
            self.chunks.push([of.chunk, 0]);
        }
        let goes_on = of.packed.kind() == PULSE
            || self.vertices.last().is_some_and(|last| last[..3] == begin[..3]);
        let before = self.vertices.len();
        if is_new || !goes_on {
            self.vertices.push(begin);
        }
        self.vertices.push(vertex(b, of.packed));
        if let Some([_, count]) = self.chunks.last_mut() {
            *count += (self.vertices.len() - before) as u32;
        }
    }

    fn octets(self) -> Vec<u8> {
        let head = [self.chunks.len() as u32].into_iter().chain(self.chunks.into_iter().flatten());
        let mut bytes: Vec<u8> = head.flat_map(u32::to_le_bytes).collect();
        bytes.reserve(self.vertices.len() * 16);
        for vertex in self.vertices {
            bytes.extend_from_slice(vertex.map(u32::to_le_bytes).as_flattened());
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Exact;
    use crate::geometry::tests::walk;
    use crate::walk::ARC;
    use proof::MotionKind;

    fn geometry(walk: &Walk) -> Geometry {
        let mut geometry = Geometry::default();
        for chunk in 0..walk.len().div_ceil(CHUNK) {
            geometry.add(Exact::of(walk, chunk), &mut || true).unwrap();
        }
        geometry
    }

    /// Looks from a direction at a point in the middle of a window of 400 by 300 pixels.
    fn view(turn: f64, height: f64, scale: f64, middle: Vec3) -> View {
        let ((s, c), (sh, ch)) = (turn.to_radians().sin_cos(), height.to_radians().sin_cos());
        let (right, away) = (Vec3::new(c, s, 0.0), Vec3::new(-s * ch, c * ch, -sh));
        let ways = [right * scale, right.cross(away) * -scale, away * scale];
        let at = Vec3::new(200.0, 150.0, 0.0) - Vec3::from_array(ways.map(|way| way.dot(middle)));
        View { width: 400.0, height: 300.0, ways, at, hidden: 0, moves: None }
    }

    /// The lines that are answered: each with its move and its kind, and where it goes, pixels.
    fn lines(octets: &[u8]) -> Vec<(u32, u8, [Vec3; 2])> {
        let word = |at: usize| u32::from_le_bytes(octets[4 * at..][..4].try_into().unwrap());
        let number = |at: usize| f64::from(f32::from_bits(word(at)));
        let chunks = word(0) as usize;
        let mut at = 1 + 2 * chunks;
        let mut lines = Vec::new();
        for chunk in 0..chunks {
            let (first, count) = (word(1 + 2 * chunk) * CHUNK, word(2 + 2 * chunk) as usize);
            let vertex = |place: usize| {
                let at = at + 4 * place;
                (Vec3::new(number(at), number(at + 1), number(at + 2)), word(at + 3))
            };
            for place in 1..count {
                let ((a, _), (b, packed)) = (vertex(place - 1), vertex(place));
                let kind = (packed >> 12 & 15) as u8;
                if kind == ARC {
                    lines.push((first + (packed & 4095), kind, [a, b]));
                }
            }
            at += 4 * count;
        }
        assert_eq!(4 * at, octets.len());
        lines
    }

    fn off(point: Vec3, [a, b]: [Vec3; 2]) -> f64 {
        let flat = |at: Vec3| at.truncate();
        let (point, a, b) = (flat(point), flat(a), flat(b));
        let along = b - a;
        let t = ((point - a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
        point.distance(a + along * t)
    }

    /// How far each of some points is from the nearest of some lines, at the most, pixels: looked for in squares of 8 pixels, and those beside them.
    fn furthest(points: impl Iterator<Item = Vec3>, lines: impl Iterator<Item = [Vec3; 2]>) -> f64 {
        let square = |pixel: f64| (pixel.clamp(-9.0, 409.0) / 8.0).floor() as i32;
        let mut near: HashMap<(i32, i32), Vec<[Vec3; 2]>> = HashMap::new();
        for [a, b] in lines {
            let (low, high) = (a.min(b), a.max(b));
            for x in square(low.x) - 1..=square(high.x) + 1 {
                for y in square(low.y) - 1..=square(high.y) + 1 {
                    near.entry((x, y)).or_default().push([a, b]);
                }
            }
        }
        let of = |at: Vec3| {
            let lines = near.get(&(square(at.x), square(at.y))).into_iter().flatten();
            lines.map(|line| off(at, *line)).fold(f64::MAX, f64::min)
        };
        points.map(of).fold(0.0, f64::max)
    }

    /// How far the points of a path that are in the window are from all that is answered, and how far what is answered is from the path, pixels.
    fn compared(path: &[Vec3], view: &View, lines: &[(u32, u8, [Vec3; 2])]) -> [f64; 2] {
        let path: Vec<Vec3> = path.iter().map(|at| view.project(*at)).collect();
        let is_within =
            |at: &Vec3| (0.0..view.width).contains(&at.x) && (0.0..view.height).contains(&at.y);
        let drawn = lines.iter().map(|(_, _, ends)| *ends);
        let ways = path.windows(2).filter(|ends| ends.iter().any(is_within));
        let middles = drawn.clone().map(|[a, b]| (a + b) / 2.0).filter(is_within);
        [
            furthest(path.iter().copied().filter(is_within).step_by(7), drawn),
            furthest(middles, ways.map(|ends| [ends[0], ends[1]])),
        ]
    }

    /// A path as a list of points, worked out here; and the same as arcs of a turn each, or of all turns.
    fn helix(
        turns: u32,
        radius: f64,
        pitch: f64,
        each: u32,
    ) -> (Walk, impl Fn(Range<u32>, u32) -> Vec<Vec3>) {
        let start = |turn: u32| Vec3::new(radius, 0.0, -pitch * f64::from(turn));
        let moves = (0..turns / each).map(|number| {
            let (from, to) = (start(number * each), start((number + 1) * each));
            let center = Vec3::new(0.0, 0.0, from.z);
            let arc = Arc::new(from, to, center, Vec3::Z, each - 1, 1e-6).unwrap();
            (MotionKind::Arc(Box::new(arc)), to)
        });
        let begin = [(MotionKind::Line, start(0))];
        let path = move |turns: Range<u32>, sides: u32| {
            let point = |i: u32| {
                let turn = f64::from(i) / f64::from(sides);
                let (sin, cos) = (turn * TAU).sin_cos();
                Vec3::new(radius * cos, radius * sin, -pitch * turn)
            };
            (turns.start * sides..=turns.end * sides).map(point).collect()
        };
        (walk(begin.into_iter().chain(moves)), path)
    }

    /// Turns of 50 mm, 0.2 mm apart: from above they are one circle; from beside, oblique and close they are not.
    #[test]
    fn each_turn_of_a_helix_is_where_it_is_or_near_one_that_is() {
        for each in [1, 100] {
            let (walk, path) = helix(100, 50.0, 0.2, each);
            let geometry = geometry(&walk);
            let rim = Vec3::new(30.0, 40.0, -10.0);
            // Within 0.1 pixels a turn of 125 pixels has 79 chords; in halves of eighths, or by rounding of ninths, 144.
            for (view, turns, sides, most) in [
                (view(0.0, 90.0, 2.5, Vec3::ZERO), 0..100, 300, 300),
                (view(0.0, 0.0, 2.5, Vec3::new(0.0, 0.0, -10.0)), 0..100, 300, 14_401),
                (view(-45.0, 35.264, 2.5, Vec3::new(0.0, 0.0, -10.0)), 0..100, 300, 14_401),
                (view(20.0, 60.0, 100.0, rim), 0..100, 2_000, 2_000),
                (view(20.0, 90.0, 4000.0, rim), 49..51, 20_000, 100),
            ] {
                let lines = lines(&sight((&walk, &geometry), &view, &|| true).unwrap());
                assert!(!lines.is_empty() && lines.len() < most, "{} {view:?}", lines.len());
                let [missed, wrong] = compared(&path(turns, sides), &view, &lines);
                assert!(missed < 0.5 && wrong < 0.5, "{each}: {missed} {wrong} {view:?}");
            }
        }
    }

    /// Half circles whose radius grows by 0.01 mm each: at 5 pixels a millimetre some of them stand for all, and at 400 each is seen.
    #[test]
    fn the_turns_of_a_spiral_are_apart_where_one_looks_close() {
        let radius = |half: u32| 5.0 + 0.01 * f64::from(half);
        let end =
            |half: u32| Vec3::X * if half.is_multiple_of(2) { radius(half) } else { -radius(half) };
        let moves = (0..1_000).map(|half| {
            let (from, to) = (end(half), end(half + 1));
            let arc = Arc::new(from, to, (from + to) / 2.0, Vec3::Z, 0, 1e-6).unwrap();
            (MotionKind::Arc(Box::new(arc)), to)
        });
        let walk = walk([(MotionKind::Line, end(0))].into_iter().chain(moves));
        let geometry = geometry(&walk);
        let path = |halves: Range<u32>, sides: u32| -> Vec<Vec3> {
            let point = |i: u32| {
                let (half, part) = (i / sides, f64::from(i % sides) / f64::from(sides));
                let (from, to) = (end(half), end(half + 1));
                let (sin, cos) = (part * TAU / 2.0).sin_cos();
                (from + to) / 2.0 + (from - to) / 2.0 * cos + Vec3::Z.cross(from - to) / 2.0 * sin
            };
            (halves.start * sides..halves.end * sides).map(point).collect()
        };
        let far = view(0.0, 90.0, 5.0, Vec3::ZERO);
        let some = lines(&sight((&walk, &geometry), &far, &|| true).unwrap());
        let [missed, wrong] = compared(&path(0..1_000, 100), &far, &some);
        assert!(missed < 0.5 && wrong < 0.5, "{missed} {wrong}");
        let near = view(0.0, 90.0, 400.0, Vec3::new(0.0, 10.0, 0.0));
        let all = lines(&sight((&walk, &geometry), &near, &|| true).unwrap());
        let [missed, wrong] = compared(&path(400..600, 3_000), &near, &all);
        assert!(missed < 0.5 && wrong < 0.5, "{missed} {wrong}");
        // The window is 0.75 mm high: of every second half one is in it each 0.02 mm.
        let moves: std::collections::BTreeSet<u32> = all.iter().map(|(at, _, _)| *at).collect();
        assert!((36..=40).contains(&moves.len()), "{}", moves.len());
    }

    /// A rapid over a cut does not hide it, one that is not drawn is not answered, and moves that are asked for are answered alone, also where they are hidden.
    #[test]
    fn rapids_hide_nothing_and_single_moves_are_seen_alone() {
        let at = |x: f64, z: f64| Vec3::new(x, 0.0, z);
        let walk = walk([
            (MotionKind::Rapid, at(-50.0, 0.0)),
            (MotionKind::Line, at(50.0, 0.0)),
            (MotionKind::Rapid, at(50.0, 9.0)),
            (MotionKind::Rapid, at(-50.0, 9.0)),
            (MotionKind::Line, at(-50.0, 5.0)),
            (MotionKind::Line, at(50.0, 5.0)),
        ]);
        let geometry = geometry(&walk);
        let above = view(0.0, 90.0, 3.0, Vec3::ZERO);
        let answer = |view: &View| sight((&walk, &geometry), view, &|| true).unwrap();
        let moves = |view: &View| -> Vec<u32> {
            let octets = answer(view);
            let [count] = octets[..4].as_chunks::<4>().0 else { panic!() };
            assert_eq!(u32::from_le_bytes(*count), 1);
            let words = octets[12..]
                .chunks(16)
                .map(|vertex| u32::from_le_bytes(vertex[12..].try_into().unwrap()));
            words.filter(|word| word >> 12 & 15 != u32::from(GAP)).map(|word| word & 4095).collect()
        };
        // The lower cut is below the upper one, but this one is seen below a rapid, that on the way to it where it ends, and the first rapid is below the third.
        assert_eq!(moves(&above), [3, 4, 5]);
        let hidden = 1 << RAPID;
        assert_eq!(moves(&View { hidden, ..above.clone() }), [4, 5]);
        let alone = |moves| View { moves: Some([moves].into()), ..above.clone() };
        assert_eq!(moves(&alone(1..2)), [1]);
        assert_eq!(answer(&alone(7..9)), [0; 4]);
        let beside = view(0.0, 90.0, 3.0, Vec3::new(0.0, 999.0, 0.0));
        assert_eq!(answer(&beside), [0; 4]);
    }

    #[test]
    fn a_view_is_read_or_refused() {
        let place = "1,0,0,0,-1,0,0,0,-1,200,150,0";
        let read = View::read("400,300", place, "0", "all").unwrap();
        assert_eq!(read.project(Vec3::new(3.0, 4.0, 5.0)), Vec3::new(203.0, 146.0, -5.0));
        let some = View::read("400,300", place, "2", "3-5,9-10").unwrap();
        assert_eq!((some.hidden, some.moves), (2, Some(vec![3..5, 9..10])));
        for (size, place, hidden, moves) in [
            ("400", place, "0", "all"),
            ("0,300", place, "0", "all"),
            ("400.5,300", place, "0", "all"),
            ("40000,30000", place, "0", "all"),
            ("400,300", "1,0,0", "0", "all"),
            ("400,300", "NaN,0,0,0,-1,0,0,0,-1,200,150,0", "0", "all"),
            ("400,300", place, "-1", "all"),
            ("400,300", place, "0", "3"),
            ("400,300", place, "0", ""),
        ] {
            assert_eq!(
                View::read(size, place, hidden, moves),
                None,
                "{size} {place} {hidden} {moves}"
            );
        }
    }

    /// Looked for by whoever waits: it ends where nobody does any more.
    #[test]
    fn it_ends_where_nobody_waits() {
        let (walk, _) = helix(1, 50.0, 0.2, 1);
        let geometry = geometry(&walk);
        let above = view(0.0, 90.0, 2.5, Vec3::ZERO);
        assert_eq!(sight((&walk, &geometry), &above, &|| false), None);
    }
}
