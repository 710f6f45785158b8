//! What is drawn: chunks of moves, each as a polyline, in levels of detail.
//!
//! A chunk has 4,096 moves. Its polyline begins where its first move begins; each further vertex ends a segment that belongs to the
//! vertex's move, or, of kind `gap`, draws no line: the tool has gone there by a way that is not known. Level 0 is exact, arcs, and moves
//! in which the axes lead the tip, as chords within [`EXACT`]; a line of level `n` is nowhere further from that than `EXACT` times 4 to
//! the power of `n`; moves that go round, and lie as near to one that is drawn, are left out of it, and one that ends near where it began stays a polygon. Only the coarsest level is kept; the others are made of the walk when they are asked for. Of kind `pulse` a vertex is a
//! point and no line leads to it; a level leaves out points that are as near to one that it has.
//!
//! ```text
//! vertex  16 bytes  x y z f32 from the chunk's origin, mm; u32: move in the chunk (12 bits), kind (4), tool (8), marks (8)
//! index   64 bytes  a chunk: origin 3 f64, half box 3 f32, first move u32, its begin f32 s, its block u32, vertices of levels 0 to 2
//!                   3 u32, flags u32 (1: nothing of it is drawn, 2: its arcs are coarser than the levels say)
//! row     20 bytes  a move: its end f32 s from the chunk's begin, block u32, source line u32, feed f32 (NaN: not known);
//!         40 bytes  where any tool leans: then the tool axis 3 f32, and the first two rotary axes 2 f32, degrees;
//!                   at the end of both its deviation from the source f32 mm (NaN: not compared)
//! several           chunks in one answer, from the first that is asked for: how many u32, the vertices of each u32, then all vertices
//! ```
//! All little-endian.

use crate::packed::Packed;
use crate::walk::{GAP, PULSE, Walk};
use geom::Vec3;
use program::Feed;
use std::collections::HashSet;
use std::f64::consts::TAU;
use std::ops::Range;

/// How many moves a chunk has.
pub const CHUNK: u32 = 4096;

/// How far a chord may be from its arc at level 0, mm.
pub const EXACT: f64 = 0.002;

/// How many vertices the coarsest level has, where it can be made of so few.
pub const COARSEST: usize = 250_000;

/// How many levels there are at most: the last one is within half a metre.
const MOST_LEVELS: usize = 10;

/// How near a move that goes round is to one that is drawn where it is left out, as a part of the error of the level; and how much further it is
/// from it between the points that are compared.
const LEFT_OUT: f64 = 0.4;
const WIDER: f64 = 1.25;

/// The size of a turn over how far the sides of its polygon may be from it: five sides of a circle.
const POLYGON: f64 = 12.0;

/// So many vertices are thinned at a time: how long that takes grows with their square where a line winds.
const STRETCH: usize = 64;

/// How many vertices the arcs of a chunk are drawn with at most. With more the chunk is crowded: its arcs are coarser than its levels say, and of turns on
/// one another some are left out; exactly it is drawn by [`crate::sight`].
const MOST_VERTICES: usize = 1 << 18;

/// How many sides a turn has at the least.
const LEAST_SIDES: usize = 32;

/// The same of the moves in which the axes lead the tip, of which each vertex is worked out through the chain of the axes.
pub const MOST_LED: usize = 1 << 17;

/// A point of the drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Vertex {
    at: Vec3,
    packed: Packed,
}

/// The levels of a walk.
#[derive(Debug)]
pub struct Geometry {
    chunks: Vec<Chunk>,
    /// How many vertices each level has.
    levels: Vec<usize>,
    bounds: Option<[Vec3; 2]>,
}

/// A chunk as exact as it is drawn.
#[derive(Debug)]
pub struct Exact {
    /// Its first move.
    pub first: u32,
    /// How many moves it has.
    pub moves: u32,
    /// When the move before it is over, and when its last one is, s.
    begin: f64,
    /// The same of its last one.
    pub end: f64,
    /// The line of its first block.
    line: u32,
    vertices: Vec<Vertex>,
    bounds: Option<[Vec3; 2]>,
    is_crowded: bool,
}

impl Exact {
    /// A chunk of a walk.
    pub fn of(walk: &Walk, chunk: u32) -> Exact {
        let moves = moves(walk, chunk).unwrap_or_default();
        let line = if moves.is_empty() { 0 } else { walk.line(moves.start) };
        let vertices = polyline(walk, chunk, EXACT);
        let arcs = walk.arcs(moves.clone());
        // Arcs go out beyond their chords.
        let bounds = bounds_of(&vertices).map(|bounds| {
            arcs.iter()
                .map(|(_, arc)| arc.extents())
                .filter(|(low, high)| low.is_finite() && high.is_finite())
                .fold(bounds, |[low, high], (l, h)| [low.min(l), high.max(h)])
        });
        let most = most_chords(arcs.len());
        Exact {
            first: moves.start,
            moves: moves.len() as u32,
            begin: walk.end_before(moves.start),
            end: walk.end_before(moves.end),
            line,
            vertices,
            bounds,
            is_crowded: arcs.iter().any(|(_, arc)| arc.chords(EXACT) > most),
        }
    }
}

/// A chunk in the levels of detail that have been made of it.
#[derive(Clone, Debug)]
pub struct Chunk {
    begin: f64,
    line: u32,
    origin: Vec3,
    half: Vec3,
    is_crowded: bool,
    /// How many vertices each level has.
    counts: Vec<u32>,
    /// Those of the coarsest level.
    coarsest: Vec<Vertex>,
}

impl Chunk {
    fn of(exact: Exact) -> Chunk {
        let Exact { begin, line, vertices, bounds, is_crowded, .. } = exact;
        let [low, high] = bounds.unwrap_or_default();
        let counts = vec![vertices.len() as u32];
        let (origin, half) = ((low + high) / 2.0, (high - low) / 2.0);
        Chunk { begin, line, origin, half, is_crowded, counts, coarsest: vertices }
    }

    /// Its box; none where nothing of it is drawn.
    fn bounds(&self) -> Option<[Vec3; 2]> {
        (self.counts[0] > 0).then_some([self.origin - self.half, self.origin + self.half])
    }

    /// Makes it one level coarser.
    fn coarsen(&mut self) {
        let level = self.counts.len();
        self.coarsest = simplified(&self.coarsest, level);
        self.counts.push(self.coarsest.len() as u32);
    }

    /// Its entry of the index, where its first move is this one.
    pub fn entry(&self, first: u32) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(64);
        bytes.extend(self.origin.to_array().iter().flat_map(|value| value.to_le_bytes()));
        bytes.extend(self.half.to_array().iter().flat_map(|v| (*v as f32).to_le_bytes()));
        bytes.extend(first.to_le_bytes());
        bytes.extend((self.begin as f32).to_le_bytes());
        bytes.extend(self.line.to_le_bytes());
        let counts = [0, 1, 2].map(|level| self.counts.get(level).copied().unwrap_or(0));
        bytes.extend(counts.iter().flat_map(|count| count.to_le_bytes()));
        let flags = u32::from(self.counts[0] == 0) | u32::from(self.is_crowded) << 1;
        bytes.extend(flags.to_le_bytes());
        bytes
    }

    /// The vertices of its coarsest level.
    pub fn octets(&self) -> Vec<u8> {
        octets(&self.coarsest, self.origin)
    }
}

/// Vertices from an origin.
fn octets(vertices: &[Vertex], origin: Vec3) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(vertices.len() * 16);
    for Vertex { at, packed } in vertices {
        let [x, y, z] = (*at - origin).to_array().map(|value| (value as f32).to_bits());
        let words = [x, y, z, packed.word()].map(u32::to_le_bytes);
        bytes.extend_from_slice(words.as_flattened());
    }
    bytes
}

/// Of no moves.
impl Default for Geometry {
    fn default() -> Geometry {
        Geometry { chunks: Vec::new(), levels: vec![0], bounds: None }
    }
}

impl Geometry {
    /// Adds the next chunk, for as long as `goes_on` says so.
    pub fn add(&mut self, exact: Exact, goes_on: &mut impl FnMut() -> bool) -> Option<()> {
        let chunk = self.levelled(exact, goes_on)?;
        self.bounds = match (self.bounds, chunk.bounds()) {
            (Some([a, b]), Some([c, d])) => Some([a.min(c), b.max(d)]),
            (one, other) => one.or(other),
        };
        for (level, count) in self.levels.iter_mut().zip(&chunk.counts) {
            *level += *count as usize;
        }
        self.chunks.push(chunk);
        self.coarsen(goes_on)
    }

    /// Takes a chunk for the one of this number, which has the same moves and other marks.
    pub fn again(
        &mut self,
        number: u32,
        exact: Exact,
        goes_on: &mut impl FnMut() -> bool,
    ) -> Option<()> {
        let chunk = self.levelled(exact, goes_on)?;
        let before = self.chunks.get_mut(number as usize)?;
        for (level, (before, now)) in
            self.levels.iter_mut().zip(before.counts.iter().zip(&chunk.counts))
        {
            *level = *level - *before as usize + *now as usize;
        }
        *before = chunk;
        self.coarsen(goes_on)
    }

    /// A chunk with the levels that the others have.
    fn levelled(&self, exact: Exact, goes_on: &mut impl FnMut() -> bool) -> Option<Chunk> {
        let mut chunk = Chunk::of(exact);
        while chunk.counts.len() < self.levels.len() {
            goes_on().then_some(())?;
            chunk.coarsen();
        }
        goes_on().then_some(chunk)
    }

    /// While all are more than the coarsest level may have, all become coarser, for as long as `goes_on` says so, which is asked for each of them.
    fn coarsen(&mut self, goes_on: &mut impl FnMut() -> bool) -> Option<()> {
        while self.levels.len() < MOST_LEVELS && self.levels.last().is_some_and(|l| *l > COARSEST) {
            let vertices = self.chunks.iter_mut().map(|chunk| {
                goes_on().then(|| {
                    chunk.coarsen();
                    chunk.coarsest.len()
                })
            });
            let vertices: Option<usize> = vertices.sum();
            self.levels.push(vertices?);
        }
        Some(())
    }

    /// A chunk that has so many vertices, or as few as it can, with one level alone.
    pub fn piece(&self, number: u32, budget: usize) -> Chunk {
        let mut piece = self.chunks[number as usize].clone();
        while piece.coarsest.len() > budget && piece.counts.len() < MOST_LEVELS {
            piece.coarsen();
        }
        piece.counts = vec![piece.coarsest.len() as u32];
        piece
    }

    /// How many chunks there are.
    pub fn chunks(&self) -> usize {
        self.chunks.len()
    }

    /// Of each level how far its lines may be from the exact ones, mm, and how many vertices it has.
    pub fn levels(&self) -> impl Iterator<Item = (f64, usize)> {
        self.levels.iter().enumerate().map(|(level, vertices)| (error(level), *vertices))
    }

    /// The box of all that is drawn, mm.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        self.bounds
    }

    /// The box of each chunk: its middle, and half of its sides, mm.
    pub fn boxes(&self) -> impl Iterator<Item = (Vec3, Vec3)> {
        self.chunks.iter().map(|chunk| (chunk.origin, chunk.half))
    }

    /// How much memory it takes, bytes.
    pub fn bytes(&self) -> usize {
        let of = |chunk: &Chunk| size_of::<Chunk>() + chunk.coarsest.len() * size_of::<Vertex>();
        self.chunks.iter().map(of).sum()
    }

    /// The index of all chunks.
    pub fn index(&self) -> Vec<u8> {
        let entries = self.chunks.iter().zip(0..);
        entries.flat_map(|(chunk, number)| chunk.entry(number * CHUNK)).collect()
    }

    /// The vertices of a chunk at a level; `None` where there is no such chunk or level.
    pub fn vertices(&self, walk: &Walk, level: usize, chunk: usize) -> Option<Vec<u8>> {
        let kept = self.chunks.get(chunk).filter(|_| level < self.levels.len())?;
        if level + 1 == self.levels.len() {
            return Some(kept.octets());
        }
        let made = match level.checked_sub(1) {
            None => polyline(walk, chunk as u32, EXACT),
            // Chords as coarse as the finer level, of which this one is made: all of that need not be made before.
            Some(finer) => simplified(&polyline(walk, chunk as u32, error(finer)), level),
        };
        Some(octets(&made, kept.origin))
    }
}

/// Several chunks in one answer: the first, and of those behind it as many as there are bytes for. `None` where there is none.
pub fn several(chunks: impl Iterator<Item = Vec<u8>>, most: usize) -> Option<Vec<u8>> {
    let (mut counts, mut vertices) = (Vec::new(), Vec::new());
    for chunk in chunks {
        let is_first = counts.is_empty();
        if !is_first && vertices.len() + chunk.len() > most {
            break;
        }
        counts.push((chunk.len() / 16) as u32);
        vertices.extend(chunk);
    }
    let head = [counts.len() as u32].into_iter().chain(counts.iter().copied());
    let head = head.flat_map(u32::to_le_bytes);
    (!counts.is_empty()).then(|| head.chain(vertices).collect())
}

/// The rows of the moves of a chunk.
pub fn rows(walk: &Walk, chunk: u32) -> Option<Vec<u8>> {
    let moves = moves(walk, chunk)?;
    let begin = walk.end_before(moves.start);
    let mut bytes = Vec::with_capacity(moves.len() * row_bytes(walk));
    for at in moves {
        bytes.extend(((walk.end(at) - begin) as f32).to_le_bytes());
        bytes.extend(walk.line(at).to_le_bytes());
        bytes.extend(walk.source_line(at).to_le_bytes());
        let feed = match walk.feed(at) {
            Some(Feed::PerMinute(feed)) => feed as f32,
            Some(Feed::PerTurn(_) | Feed::InverseTime(_)) | None => f32::NAN,
        };
        bytes.extend(feed.to_le_bytes());
        if walk.leans() {
            let axis = walk.behind(at).axis.to_array();
            let rotary = |place: usize| walk.positions(at).get(place).copied().unwrap_or(f64::NAN);
            let values = axis.into_iter().chain([rotary(3), rotary(4)]);
            bytes.extend(values.flat_map(|value| (value as f32).to_le_bytes()));
        }
        bytes.extend(walk.deviation(at).to_le_bytes());
    }
    Some(bytes)
}

/// How many bytes the row of a move has.
pub fn row_bytes(walk: &Walk) -> usize {
    if walk.leans() { 40 } else { 20 }
}

/// The moves of a chunk.
fn moves(walk: &Walk, chunk: u32) -> Option<Range<u32>> {
    let first = chunk.checked_mul(CHUNK).filter(|first| *first < walk.len())?;
    Some(first..first.saturating_add(CHUNK).min(walk.len()))
}

/// How far the lines of a level may be from the exact ones, mm.
fn error(level: usize) -> f64 {
    if level == 0 { EXACT } else { EXACT * 4f64.powi(level as i32) }
}

/// The polyline of a chunk with chords as near to their arcs, mm.
fn polyline(walk: &Walk, chunk: u32, near: f64) -> Vec<Vertex> {
    let Some(moves) = moves(walk, chunk) else { return Vec::new() };
    let mut arcs = walk.arcs(moves.clone()).iter().peekable();
    let mut starts = walk.starts(moves.clone()).iter().peekable();
    let can_lead = walk.stride() > 3 || !walk.goes_together();
    let led = moves.clone().filter(|at| can_lead && walk.led(*at).is_some()).count();
    let most_chords = most_chords(arcs.len());
    let most_led = (MOST_LED / led.max(1)).max(16);
    let mut vertices = Vec::with_capacity(moves.len() + 1);
    let first = moves.start;
    let mut before = walk.before(first).tip;
    for at in moves {
        let packed = |kind: u8| Packed::of(walk, first, at).with_kind(kind);
        let behind = walk.behind(at).tip;
        let start = starts.next_if(|(of, _)| *of == at);
        let arc = arcs.next_if(|(of, _)| *of == at);
        let from = start.map_or(before, |(_, start)| start.tip);
        before = behind;
        if !behind.is_finite() {
            continue;
        }
        if walk.kind(at) == PULSE {
            if vertices.is_empty() {
                vertices.push(Vertex { at: behind, packed: packed(GAP) });
            }
            vertices.push(Vertex { at: behind, packed: packed(PULSE) });
            continue;
        }
        let is_drawn = from.is_finite();
        let goes_on = start.is_none() && !vertices.is_empty();
        if is_drawn && !goes_on {
            vertices.push(Vertex { at: from, packed: packed(GAP) });
        }
        let kind = packed(if is_drawn { walk.kind(at) } else { GAP });
        if let Some((_, arc)) = arc.filter(|_| is_drawn) {
            let chords = arc.chords(near).min(most_chords);
            let mut add = |t: f64, packed: Packed| {
                let at = arc.at(t);
                vertices.extend(at.is_finite().then_some(Vertex { at, packed }));
            };
            let turns = arc.sweep / TAU;
            if chords as f64 >= turns * LEAST_SIDES as f64 {
                (1..=chords).for_each(|i| add(i as f64 / chords as f64, kind));
            } else {
                // Some of the turns, the first and the last one among them.
                let last = (most_chords / (LEAST_SIDES + 1)).max(2) - 1;
                for number in 0..=last {
                    let turn = (turns - 1.0) * (number as f64 / last as f64);
                    let side = |side: usize| (turn + side as f64 / LEAST_SIDES as f64) / turns;
                    if number > 0 {
                        add(side(0), packed(GAP));
                    }
                    (1..=LEAST_SIDES).for_each(|i| add(side(i), kind));
                }
            }
            continue;
        }
        if led > 0
            && is_drawn
            && let Some(motion) = walk.led(at)
        {
            let parts = motion.parts(near, most_led);
            // Most cuts are so short that the tip goes straight all but.
            if let [between @ .., _] = &parts[..]
                && !between.is_empty()
            {
                let tool = motion.tool();
                let points = between.iter().map(|part| tool(*part).0);
                vertices.extend(points.map(|at| Vertex { at, packed: kind }));
            }
        }
        vertices.push(Vertex { at: behind, packed: kind });
    }
    vertices
}

/// How many chords each of so many arcs of a chunk is drawn with at most.
fn most_chords(arcs: usize) -> usize {
    (MOST_VERTICES / arcs.max(1)).max(LEAST_SIDES)
}

fn bounds_of(vertices: &[Vertex]) -> Option<[Vec3; 2]> {
    vertices.iter().fold(None, |bounds: Option<[Vec3; 2]>, vertex| {
        let [low, high] = bounds.unwrap_or([vertex.at; 2]);
        Some([low.min(vertex.at), high.max(vertex.at)])
    })
}

/// The vertices of a level, made of those of the finer one (Douglas and Peucker). Where segments look otherwise, their common end stays.
fn simplified(finer: &[Vertex], level: usize) -> Vec<Vertex> {
    // The errors of all levels add up to no more than that of this one: 3/4 (1 + 1/4 + 1/16 ...) = 1. What is left out is off by both.
    let rounds = rounds(finer);
    let (fewer, most) = match apart(finer, &rounds, LEFT_OUT * error(level)) {
        Some(fewer) => (Some(fewer), (0.75 - LEFT_OUT * WIDER) * error(level)),
        None => (None, 0.75 * error(level)),
    };
    let rounds = fewer.as_deref().map_or(rounds, crate::geometry::rounds);
    let finer = fewer.as_deref().unwrap_or(finer);
    let mut turns = rounds.into_iter().filter(|round| round.is_turn(most)).peekable();
    let mut kept = Vec::new();
    let mut from = 0;
    while let Some(first) = finer.get(from) {
        if let Some(turn) = turns.next_if(|turn| turn.from == from) {
            while from < turn.to {
                let to = turn.to.min(from + STRETCH);
                thin(&finer[from - 1..to], most.min(turn.size / POLYGON), &mut kept);
                from = to;
            }
            continue;
        }
        if first.packed.kind() == PULSE {
            let points = finer[from..].iter().take_while(|vertex| vertex.packed.kind() == PULSE);
            from += points.clone().count();
            sparse(points, most, &mut kept);
            continue;
        }
        // A stretch of segments that look alike, from the vertex before it.
        let alike = |vertex: &&Vertex| {
            vertex.packed.look() == first.packed.look() && vertex.packed.kind() != GAP
        };
        let end = turns.peek().map_or(finer.len(), |turn| turn.from);
        let to = from + finer[from..end].iter().take(STRETCH).take_while(alike).count().max(1);
        match from.checked_sub(1).filter(|_| to - from > 1) {
            Some(anchor) => thin(&finer[anchor..to], most, &mut kept),
            None => kept.extend_from_slice(&finer[from..to]),
        }
        from = to;
    }
    kept
}

/// A move that goes round: by several vertices.
struct Round {
    /// Its first vertex, behind the one where it begins, and the one behind its last.
    from: usize,
    to: usize,
    /// The diagonal of its box, mm.
    size: f64,
    /// How long it is, mm.
    length: f64,
    /// How far its end is from its begin, mm.
    open: f64,
}

impl Round {
    /// Whether it comes back, so far that chords within `most` would go through its middle.
    fn is_turn(&self, most: f64) -> bool {
        self.open < 0.5 * self.size && self.size > 2.0 * most
    }

    /// What it looks like and where it goes: nine points of it in cubes of such a side, and its length.
    fn key(&self, line: &[Vertex], side: f64) -> (u32, i64, [[i64; 3]; 9]) {
        // No coordinate that programs have is the face of a cube.
        let cube = |at: Vec3| at.to_array().map(|value| (value / side + 0.37).floor() as i64);
        let mut places = [[0; 3]; 9];
        let (mut at, mut behind) = (self.from - 1, 0.0);
        let mut step = line[at].at.distance(line[at + 1].at);
        for (number, place) in places.iter_mut().enumerate() {
            let wanted = self.length * number as f64 / 8.0;
            while behind + step < wanted && at + 2 < self.to {
                (at, behind) = (at + 1, behind + step);
                step = line[at].at.distance(line[at + 1].at);
            }
            let part = if step > 0.0 { ((wanted - behind) / step).min(1.0) } else { 0.0 };
            *place = cube(line[at].at.lerp(line[at + 1].at, part));
        }
        (line[self.from].packed.look(), (self.length / (8.0 * side)) as i64, places)
    }
}

/// The moves of a line that go round.
fn rounds(line: &[Vertex]) -> Vec<Round> {
    let mut rounds = Vec::new();
    let mut from = 1;
    while from < line.len() {
        let own = line[from].packed;
        let is_drawn = ![GAP, PULSE].contains(&line[from].packed.kind());
        let more = line[from + 1..].iter().take_while(|vertex| vertex.packed == own);
        let to = from + 1 + if is_drawn { more.count() } else { 0 };
        if to - from >= 3 {
            let own = &line[from - 1..to];
            let [low, high] = bounds_of(own).unwrap_or_default();
            let length = own.windows(2).map(|ends| ends[0].at.distance(ends[1].at)).sum();
            let open = own[0].at.distance(own[own.len() - 1].at);
            rounds.push(Round { from, to, size: low.distance(high), length, open });
        }
        from = to;
    }
    rounds
}

/// The line without the moves that go round within `most` of one before them; `None` where there are none. One that goes round often may have the same nine
/// points as one that does not: it is none of them.
fn apart(line: &[Vertex], rounds: &[Round], most: f64) -> Option<Vec<Vertex>> {
    let side = most / 3f64.sqrt();
    let mut drawn = HashSet::new();
    let once = rounds.iter().filter(|round| round.length < 3.0 * round.size);
    let mut left = once.filter(|round| !drawn.insert(round.key(line, side))).peekable();
    left.peek()?;
    let (mut kept, mut at) = (Vec::with_capacity(line.len()), 0);
    for Round { from, to, .. } in left {
        kept.extend_from_slice(&line[at..*from]);
        let Vertex { at: end, packed } = line[to - 1];
        if kept.last().is_some_and(|last: &Vertex| last.at != end) {
            // What follows begins there.
            kept.pop_if(|last| last.packed.kind() == GAP && *from > 1);
            kept.push(Vertex { at: end, packed: packed.with_kind(GAP) });
        }
        at = *to;
    }
    kept.extend_from_slice(&line[at..]);
    Some(kept)
}

/// Keeps of points those of which none before is within a cube whose diagonal is `most`.
fn sparse<'v>(points: impl Iterator<Item = &'v Vertex>, most: f64, kept: &mut Vec<Vertex>) {
    let side = most / 3f64.sqrt();
    let mut taken = HashSet::new();
    let cube = |vertex: &Vertex| vertex.at.to_array().map(|value| (value / side).floor() as i64);
    kept.extend(points.filter(|vertex| taken.insert((vertex.packed.look(), cube(vertex)))));
}

/// Keeps of a line, without its first point, what no chord may leave out.
fn thin(line: &[Vertex], most: f64, kept: &mut Vec<Vertex>) {
    let mut open = vec![line.len() - 1];
    let mut anchor = 0;
    while let Some(end) = open.last().copied() {
        let (a, b) = (line[anchor].at, line[end].at);
        let between = line[anchor + 1..end].iter().map(|vertex| distance(vertex.at, a, b));
        let furthest = between.enumerate().fold((0, 0.0), |furthest, (i, distance)| {
            if distance > furthest.1 { (anchor + 1 + i, distance) } else { furthest }
        });
        if furthest.1 > most {
            open.push(furthest.0);
        } else {
            kept.push(line[end]);
            anchor = end;
            open.pop();
        }
    }
}

/// Distance of a point from a segment.
fn distance(point: Vec3, a: Vec3, b: Vec3) -> f64 {
    let along = b - a;
    let length = along.length_squared();
    let t = if length > 0.0 { ((point - a).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
    point.distance(a + along * t)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::walk::{Follower, Pulse, Slot};
    use geom::Arc;
    use geom::ending::Ended;
    use machine::Machine;
    use program::Program;
    use proof::{AxisPositions, Course, Motion, MotionKind, Observer, Report, ToolPose};

    /// Points by chance and in rows, in three chunks: each level has one within its error of each of them, and the coarsest has few.
    #[test]
    fn of_points_each_level_has_one_near_each_of_them() {
        let mut seed = 7_u64;
        let mut chance = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 40) as f64 / f64::from(1 << 24)
        };
        let point = |number: u32| match number % 2 {
            0 => Vec3::new(chance(), chance(), 0.1 * chance()) * 20.0,
            _ => Vec3::new(0.1 * f64::from(number % 200), 0.05 * f64::from(number / 200), 0.0),
        };
        let points: Vec<Vec3> = (0..10_000).map(point).collect();
        let pulse = |(number, at): (usize, &Vec3)| Pulse {
            line: number as u32 + 1,
            at: *at,
            positions: at.to_array().to_vec(),
            end: number as f64,
            source_line: 0,
            operation: None,
        };
        let walk = Walk::of_pulses(points.iter().enumerate().map(pulse), &|| true).unwrap();
        let chunks: Vec<Vec<Vertex>> = (0..3).map(|chunk| polyline(&walk, chunk, EXACT)).collect();
        assert_eq!(chunks.iter().map(Vec::len).sum::<usize>(), 10_000 + 3);
        let mut levels = chunks.clone();
        let mut counts = Vec::new();
        for level in 1..MOST_LEVELS {
            levels = levels.iter().map(|finer| simplified(finer, level)).collect();
            counts.push(levels.iter().map(Vec::len).sum::<usize>());
            for (chunk, kept) in chunks.iter().zip(&levels) {
                assert_eq!(kept[0].packed.kind(), GAP);
                assert!(kept.is_sorted_by_key(|vertex| vertex.packed.place()));
                let far = |vertex: &Vertex| {
                    let own = kept[1..].iter().map(|kept| kept.at.distance_squared(vertex.at));
                    own.fold(f64::MAX, f64::min).sqrt()
                };
                let most = chunk[1..].iter().step_by(7).map(far).fold(0.0, f64::max);
                assert!(most <= error(level), "{level}: {most}");
            }
        }
        assert!(counts.is_sorted_by(|a, b| a >= b), "{counts:?}");
        assert!(counts[MOST_LEVELS - 2] <= 3 * 10, "{counts:?}");
    }

    /// A walk of moves that each end at a point; an arc goes there where one is given.
    pub(crate) fn walk(moves: impl IntoIterator<Item = (MotionKind, Vec3)>) -> Walk {
        let machine = machine::load("generic-3axis-linuxcnc").unwrap();
        let moves = moves.into_iter().map(|(kind, tip)| (kind, Course::Axes, tip, 0.0, tip));
        walk_on(&machine, moves)
    }

    /// The same on a machine: how each goes, where X, Y, Z and C go, and where the tip is then.
    pub(crate) fn walk_on(
        machine: &Machine,
        moves: impl IntoIterator<Item = (MotionKind, Course, Vec3, f64, Vec3)>,
    ) -> Walk {
        let moves = moves.into_iter().map(|(kind, course, linear, c, tip)| {
            let behind = ToolPose { tip, axis: Vec3::Z };
            (kind, course, AxisPositions::Mill { linear, rotary: [0.0, 0.0, c] }, behind)
        });
        walk_of(machine, moves)
    }

    /// A walk of moves of a second each: how each goes, and where axes and tool are behind it.
    pub(crate) fn walk_of(
        machine: &Machine,
        moves: impl IntoIterator<Item = (MotionKind, Course, AxisPositions, ToolPose)>,
    ) -> Walk {
        let (source, ended, handed) = (Program::new("x"), Ended::default(), Slot::default());
        let to = Slot::clone(&handed);
        let mut follower = Follower::new("x.nc", &source, machine, (&(), &ended), to);
        let mut before = ToolPose { tip: Vec3::ZERO, axis: Vec3::Z };
        for (line, (kind, course, axes, behind)) in (1..).zip(moves) {
            follower.moved(&Motion {
                file: None,
                line,
                record: 0,
                source_line: line,
                kind,
                course,
                tool: [before, behind],
                axes,
                feed: None,
                seconds: 1.0,
                waited: 0.0,
                deviation: None,
            });
            before = behind;
        }
        follower.ended(&Report::default());
        handed.lock().unwrap().take().unwrap().walk
    }

    /// A mill with C on the table about the work zero: at C 90 the tip at X 100 of the machine is at Y 100 of the part.
    pub(crate) fn turning_table() -> Machine {
        let text = "reader = \"fanuc\"\nwork_zero = [0, 0, 0]\n[orientation]\nsimultaneous = \"machine-angles\"\ntolerance = 0.01\n\
                    [words]\nX = { decimals = 3 }\nC = { decimals = 3 }\n\
                    [[rotary]]\nletter = \"C\"\non = \"table\"\naxis = [0, 0, 1]\npoint = [0, 0, 0]\nsign = -1\nrapid = 1e4\n\
                    acceleration = 100\n";
        machine::load_text("shop.toml", text).unwrap()
    }

    /// The geometry of a walk, for as long as `goes_on` says so.
    fn made(walk: &Walk, mut goes_on: impl FnMut() -> bool) -> Option<Geometry> {
        let mut geometry = Geometry::default();
        for chunk in 0..walk.len().div_ceil(CHUNK) {
            geometry.add(Exact::of(walk, chunk), &mut goes_on)?;
        }
        Some(geometry)
    }

    fn points(geometry: &Geometry, walk: &Walk, level: usize, chunk: usize) -> Vec<Vec3> {
        let origin = geometry.chunks[chunk].origin;
        let bytes = geometry.vertices(walk, level, chunk).unwrap();
        let point = |vertex: &[u8]| {
            let [x, y, z] = [0, 4, 8]
                .map(|at| f64::from(f32::from_le_bytes(vertex[at..at + 4].try_into().unwrap())));
            origin + Vec3::new(x, y, z)
        };
        bytes.chunks(16).map(point).collect()
    }

    fn furthest(points: &[Vec3], line: &[Vec3]) -> f64 {
        let nearest = |point: &Vec3| {
            let segments = line.windows(2).map(|ends| distance(*point, ends[0], ends[1]));
            segments.fold(f64::INFINITY, f64::min)
        };
        points.iter().map(nearest).fold(0.0, f64::max)
    }

    /// On a circle of 100 mm a chord over a quarter is off by 29 mm, and one of 125 by 0.002 mm.
    #[test]
    fn where_the_axes_lead_the_tip_it_is_drawn_as_they_do() {
        let machine = turning_table();
        let (begin, end) = (Vec3::new(100.0, 0.0, 0.0), Vec3::new(0.0, 100.0, 0.0));
        let on_the_way = |course| {
            let moves = [
                (MotionKind::Rapid, course, begin, 0.0, begin),
                (MotionKind::Rapid, course, begin, 90.0, end),
            ];
            let walk = walk_on(&machine, moves);
            let at = crate::place::At { r#move: 1, part: 0.5, seconds: 0.0 };
            let stand = crate::place::stand(&walk, &machine, at);
            let geometry = made(&walk, || true).unwrap();
            (points(&geometry, &walk, 0, 0), stand)
        };
        let (line, stand) = on_the_way(Course::Axes);
        assert!((125..250).contains(&line.len()), "{}", line.len());
        for pair in line[1..].windows(2) {
            let middle = (pair[0] + pair[1]) / 2.0;
            assert!((100.0 - middle.length()) < 0.0021, "{middle}");
        }
        let diagonal = 100.0 * std::f64::consts::FRAC_1_SQRT_2;
        let half = Vec3::new(diagonal, diagonal, 0.0);
        assert!(stand.tip.distance(half) < 1e-9 && stand.positions == [100.0, 0.0, 0.0, 45.0]);
        // Where the control keeps the tip on its line, X and Y go with C: half way the tip is at 50, 50, which C 45 has turned there from X 70.7.
        let (line, stand) = on_the_way(Course::Tip);
        assert_eq!(line.len(), 3);
        assert!(stand.tip.distance(Vec3::new(50.0, 50.0, 0.0)) < 1e-9, "{stand:?}");
        assert!((stand.positions[0] - diagonal).abs() < 1e-9 && stand.positions[1].abs() < 1e-9);
        assert_eq!(stand.positions[2..], [0.0, 45.0]);
    }

    #[test]
    fn no_chord_leaves_its_arc_and_its_ends_are_those_of_the_move() {
        let (start, end) = (Vec3::ZERO, Vec3::new(20.0, 0.0, 5.0));
        let arc = Arc::new(start, end, Vec3::new(10.0, 0.0, 0.0), -Vec3::Z, 2, 1e-6).unwrap();
        let walk = walk([(MotionKind::Arc(Box::new(arc)), end)]);
        let geometry = made(&walk, || true).unwrap();
        let points = points(&geometry, &walk, 0, 0);
        // By hand: a chord of a circle of 10 mm that leaves it by 0.002 mm spans 2 acos(1 - 0.0002) = 0.0400 rad; 2.5 turns take 393.
        assert_eq!(points.len(), 1 + (2.5 * TAU / 0.040_000_7_f64).ceil() as usize);
        let exact: Vec<Vec3> = (0..=10_000).map(|i| arc.at(f64::from(i) / 1e4)).collect();
        assert!(furthest(&exact, &points) < EXACT + 1e-5);
        assert!(points.last().unwrap().distance(end) < 1e-5);
        assert_eq!(geometry.bounds().unwrap()[0].z, 0.0);
    }

    /// A spiral of small steps: as many vertices as the coarsest level may have, and half of that more.
    #[test]
    fn the_lines_of_a_level_are_no_further_off_than_it_says() {
        let spiral = |i: u32| {
            let t = f64::from(i) * 0.002;
            (MotionKind::Line, Vec3::new(t.cos(), t.sin(), 0.0) * (10.0 + t / 50.0))
        };
        let walk = walk((0..375_000).map(spiral));
        let geometry = made(&walk, || true).unwrap();
        let levels: Vec<(f64, usize)> = geometry.levels().collect();
        assert!(levels.len() > 1 && levels.len() < MOST_LEVELS, "{levels:?}");
        assert!(levels.last().unwrap().1 <= COARSEST);
        assert_eq!(levels[0].1, 375_000 + geometry.chunks());
        for chunk in [0, 40, geometry.chunks() - 1] {
            let exact = points(&geometry, &walk, 0, chunk);
            for (level, (error, _)) in levels.iter().enumerate().skip(1) {
                let coarse = points(&geometry, &walk, level, chunk);
                assert!(coarse.len() < exact.len());
                assert!(furthest(&exact, &coarse) <= error + 1e-4, "level {level}");
                assert_eq!((coarse.first(), coarse.last()), (exact.first(), exact.last()));
            }
        }
    }

    /// Turns of 6 mm, each 0.001 mm below the one before: a level leaves out those that lie on one another, and shows no chord through the middle.
    #[test]
    fn of_turns_on_one_another_a_level_has_those_that_are_apart() {
        let turn = |i: u32| {
            let z = -0.001 * f64::from(i / 2);
            let at = Vec3::new(6.0, 0.0, z);
            let arc = Arc::new(at, at, Vec3::new(0.0, 0.0, z), Vec3::Z, 0, 1e-6).unwrap();
            match i % 2 {
                0 => (MotionKind::Line, at),
                _ => (MotionKind::Arc(Box::new(arc)), at),
            }
        };
        let walk = walk((0..10_000).map(turn));
        let geometry = made(&walk, || true).unwrap();
        let levels: Vec<(f64, usize)> = geometry.levels().collect();
        // By hand: a chord within 0.002 mm spans 2 acos(1 - 0.002 / 6) = 0.0516 rad, 122 for a turn.
        assert_eq!(levels[0].1, 122 * 5_000 + 5_000 + geometry.chunks());
        // Within 0.032 mm: of turns in cubes of 0.0128 mm / √3 = 7.4 of them one is drawn, within 0.008 mm by 61 chords.
        assert!(levels.len() == 3 && (41_000..50_000).contains(&levels[2].1), "{levels:?}");
        let middles = |line: &[Vertex]| -> Vec<Vec3> {
            let drawn = line.windows(2).filter(|ends| ends[1].packed.kind() != GAP);
            drawn.map(|ends| (ends[0].at + ends[1].at) / 2.0).collect()
        };
        let exact = polyline(&walk, 1, EXACT);
        let mut made = exact.clone();
        for level in 1..MOST_LEVELS {
            made = simplified(&made, level);
            // What is drawn is there, and what is there is drawn: beside the circle and up and down.
            let drawn = middles(&made);
            let radius = |at: &Vec3| at.x.hypot(at.y);
            for at in &drawn {
                assert!(6.0 - radius(at) <= error(level) + 1e-9, "{level}: {at}");
                assert!(radius(at) > 4.2, "{level}: {at}");
            }
            let mut heights: Vec<f64> = drawn.iter().map(|at| at.z).collect();
            heights.sort_by(f64::total_cmp);
            let widest = heights.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
            assert!(widest <= 2.0 * error(level), "{level}: {widest}");
            for at in exact.iter().step_by(4999) {
                let segments = made.windows(2).filter(|ends| ends[1].packed.kind() != GAP);
                let off = segments.map(|ends| distance(at.at, ends[0].at, ends[1].at));
                let off = off.fold(f64::INFINITY, f64::min);
                assert!(off <= error(level) + 1e-9, "{level}: {off}");
            }
        }
    }

    /// Two turns up to the same height, and one turn: each is drawn.
    #[test]
    fn what_goes_round_otherwise_is_no_copy() {
        let helix = |turns: u32, from: Vec3, to: Vec3| {
            let center = Vec3::new(0.0, 0.0, from.z);
            let arc = Arc::new(from, to, center, Vec3::Z, turns, 1e-6).unwrap();
            (MotionKind::Arc(Box::new(arc)), to)
        };
        let (low, high) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 20.0));
        let back = || (MotionKind::Line, low);
        let walk = walk([
            back(),
            helix(1, low, high),
            back(),
            helix(9, low, high),
            back(),
            helix(1, low, high),
        ]);
        let made = (1..4).fold(polyline(&walk, 0, EXACT), |finer, level| simplified(&finer, level));
        let moves: std::collections::BTreeSet<u32> = made
            .iter()
            .filter(|vertex| vertex.packed.kind() == crate::walk::ARC)
            .map(|vertex| vertex.packed.place())
            .collect();
        assert_eq!(moves.into_iter().collect::<Vec<_>>(), [1, 3]);
    }

    /// Chunks of 4,097 vertices: with the 62nd there are more than 250,000, and all become coarser, each between two asks;
    /// so do the twelve behind it.
    #[test]
    fn it_ends_between_two_chunks_that_become_coarser() {
        let walk =
            walk((0..300_000).map(|i| (MotionKind::Line, Vec3::new(f64::from(i), 0.0, 0.0))));
        let asks = |most: u32| {
            let mut asked = 0;
            let made = made(&walk, || {
                asked += 1;
                asked <= most
            });
            (asked, made.is_some())
        };
        assert_eq!(asks(u32::MAX), (74 + 62 + 12, true));
        assert_eq!(asks(100), (101, false));
    }

    #[test]
    fn several_chunks_are_as_many_as_there_are_bytes_for_and_one_at_least() {
        let chunks = || [vec![1; 32], vec![2; 16], vec![3; 48]].into_iter();
        let heads = |most| {
            let bytes = several(chunks(), most).unwrap();
            let (heads, _) = bytes.as_chunks();
            let count = u32::from_le_bytes(heads[0]) as usize;
            (heads[..=count].iter().map(|head| u32::from_le_bytes(*head)).collect(), bytes.len())
        };
        assert_eq!(heads(0), (vec![1, 2], 8 + 32));
        assert_eq!(heads(95), (vec![2, 2, 1], 12 + 48));
        assert_eq!(heads(96), (vec![3, 2, 1, 3], 16 + 96));
        assert_eq!(several(std::iter::empty(), 99), None);
    }

    #[test]
    fn rapids_and_cuts_are_not_drawn_as_one() {
        let step = |i: u32| {
            let kind = if i.is_multiple_of(2) { MotionKind::Rapid } else { MotionKind::Line };
            (kind, Vec3::new(f64::from(i) * 1e-6, 0.0, 0.0))
        };
        let vertices = polyline(&walk((0..100).map(step)), 0, EXACT);
        assert_eq!(simplified(&vertices, 5), vertices);
    }

    #[test]
    fn what_is_not_known_or_far_away_is_not_drawn_or_drawn_far_away() {
        let walk = walk([
            (MotionKind::Line, Vec3::new(1.0, 0.0, 0.0)),
            (MotionKind::Rapid, Vec3::NAN),
            (MotionKind::Rapid, Vec3::new(1e9, 0.0, 0.0)),
            (MotionKind::Line, Vec3::new(1e9, 1.0, 0.0)),
        ]);
        let vertices = polyline(&walk, 0, EXACT);
        let kinds: Vec<u8> = vertices.iter().map(|vertex| vertex.packed.kind()).collect();
        assert_eq!(kinds, [GAP, crate::walk::FEED, GAP, crate::walk::FEED]);
        let geometry = made(&walk, || true).unwrap();
        let flags = geometry.index();
        assert_eq!((flags.len(), flags[60]), (64, 0));
        let nothing = made(&Walk::default(), || true).unwrap();
        assert_eq!((nothing.chunks(), nothing.bounds(), nothing.levels().count()), (0, None, 1));
    }

    #[test]
    fn a_helix_of_a_hundred_thousand_turns_has_no_more_vertices_than_there_is_room_for() {
        let end = Vec3::new(0.0, 0.0, -100.0);
        let helix = Arc::new(Vec3::ZERO, end, Vec3::new(10.0, 0.0, 0.0), Vec3::Z, 100_000, 1e-6);
        let arc = MotionKind::Arc(Box::new(helix.unwrap()));
        let vertices = polyline(&walk([(arc.clone(), end), (arc, end)]), 0, EXACT);
        assert!(vertices.len() <= MOST_VERTICES + 3, "{}", vertices.len());
        // Some of the turns, and each of them as one; the second move begins where the first one has begun.
        let drawn = vertices.windows(2).filter(|ends| ends[1].packed.kind() != GAP);
        let long = drawn.filter(|ends| ends[0].at.distance(ends[1].at) > 2.0);
        assert_eq!(long.count(), 1);
    }
}
