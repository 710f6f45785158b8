//! Areas as scan lines, a test's own description of what is copper and what a tool cuts: it shares nothing
//! with the regions of the program.

use geom::{Element, Vec2};
use pcb::gerber::Image;
use std::collections::BTreeMap;

/// An area: of lines at equal distances, what of each is in it.
#[derive(Clone)]
pub struct Lines {
    /// Height of the lowest line, mm.
    low: f64,
    /// From line to line, mm.
    step: f64,
    /// From left to right, apart from each other: from where to where, mm.
    pub lines: Vec<Vec<(f64, f64)>>,
}

impl Lines {
    /// Nothing, on lines from `low` to `high`.
    pub fn none(low: f64, high: f64, step: f64) -> Lines {
        Lines { low, step, lines: vec![Vec::new(); ((high - low) / step).ceil() as usize] }
    }

    /// Everything from `left` to `right`.
    pub fn filled(&self, left: f64, right: f64) -> Lines {
        Lines { lines: vec![vec![(left, right)]; self.lines.len()], ..*self }
    }

    /// Height of a line, mm.
    pub fn y(&self, line: usize) -> f64 {
        self.low + (line as f64 + 0.5) * self.step
    }

    /// The lines between two heights.
    fn between(&self, low: f64, high: f64) -> std::ops::Range<usize> {
        let line = |y: f64| ((y - self.low) / self.step - 0.5).ceil().max(0.0) as usize;
        line(low).min(self.lines.len())..line(high).min(self.lines.len())
    }

    /// The copper of an image: its objects painted in their order.
    pub fn paint(&mut self, image: &Image) {
        for run in image.objects.chunk_by(|a, b| a.dark == b.dark) {
            let mut painted = Lines::none(self.low, self.y(self.lines.len()), self.step);
            painted.lines.resize(self.lines.len(), Vec::new());
            for object in run {
                let mut shape = BTreeMap::new();
                for piece in image.pieces(object) {
                    let elements = piece.contours.iter().flat_map(|contour| contour.elements());
                    self.add(&mut shape, elements.copied(), piece.solid);
                }
                for (line, spans) in shape {
                    painted.lines[line].extend(spans);
                }
            }
            painted.tidy();
            for (line, spans) in self.lines.iter_mut().zip(painted.lines) {
                if run[0].dark {
                    line.extend(spans);
                    *line = merged(std::mem::take(line));
                } else {
                    *line = without(line, &spans);
                }
            }
        }
    }

    /// Adds to a shape (or takes from it) what closed contours wind around.
    fn add(
        &self,
        shape: &mut BTreeMap<usize, Vec<(f64, f64)>>,
        elements: impl Iterator<Item = Element>,
        solid: bool,
    ) {
        let mut crossings: BTreeMap<usize, Vec<(f64, i32)>> = BTreeMap::new();
        for element in elements {
            let mut from = element.start;
            for to in chords(&element) {
                let (up, a, b) = if from.y < to.y { (1, from, to) } else { (-1, to, from) };
                for line in self.between(a.y, b.y) {
                    let x = a.x + (b.x - a.x) * (self.y(line) - a.y) / (b.y - a.y);
                    crossings.entry(line).or_default().push((x, up));
                }
                from = to;
            }
        }
        for (line, mut crossings) in crossings {
            crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut winding = 0;
            let mut spans = Vec::new();
            for pair in crossings.windows(2) {
                winding += pair[0].1;
                if winding != 0 && pair[0].0 < pair[1].0 {
                    spans.push((pair[0].0, pair[1].0));
                }
            }
            let under = shape.entry(line).or_default();
            if solid {
                under.extend(spans);
            } else {
                *under = without(&merged(std::mem::take(under)), &merged(spans));
            }
        }
    }

    /// Adds what a disc covers along a straight line.
    pub fn sweep(&mut self, from: Vec2, to: Vec2, radius: f64) {
        for line in self.between(from.y.min(to.y) - radius, from.y.max(to.y) + radius) {
            let y = self.y(line);
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            let mut take = |x: f64| (left, right) = (left.min(x), right.max(x));
            for end in [from, to] {
                let above = y - end.y;
                if above.abs() <= radius {
                    let half = (radius * radius - above * above).sqrt();
                    take(end.x - half);
                    take(end.x + half);
                }
            }
            if let Some(along) = (to - from).try_normalize() {
                for side in [along.perp() * radius, -along.perp() * radius] {
                    let (a, b) = (from + side, to + side);
                    let t = (y - a.y) / (b.y - a.y);
                    if (0.0..=1.0).contains(&t) {
                        take(a.x + (b.x - a.x) * t);
                    }
                }
            }
            if left < right {
                self.lines[line].push((left, right));
            }
        }
    }

    /// Joins what touches.
    pub fn tidy(&mut self) {
        for line in &mut self.lines {
            *line = merged(std::mem::take(line));
        }
    }

    /// What is not in `other`.
    pub fn without(&self, other: &Lines) -> Lines {
        let lines = self.lines.iter().zip(&other.lines).map(|(a, b)| without(a, b)).collect();
        Lines { lines, ..*self }
    }

    /// What is in `other` too.
    pub fn within(&self, other: &Lines) -> Lines {
        self.without(&self.without(other))
    }

    /// The area, mm².
    pub fn area(&self) -> f64 {
        self.lines.iter().flatten().map(|(from, to)| to - from).sum::<f64>() * self.step
    }

    /// The middle of its first span.
    pub fn first(&self) -> Option<Vec2> {
        let (line, spans) = self.lines.iter().enumerate().find(|(_, spans)| !spans.is_empty())?;
        Some(Vec2::new((spans[0].0 + spans[0].1) / 2.0, self.y(line)))
    }

    /// Of each span the number of the piece that it is part of: spans of neighbouring lines that lie over
    /// each other are in one piece.
    pub fn pieces(&self) -> Pieces {
        let starts: Vec<usize> = self
            .lines
            .iter()
            .scan(0, |next, line| {
                let start = *next;
                *next += line.len();
                Some(start)
            })
            .collect();
        let count = self.lines.iter().map(Vec::len).sum();
        let mut groups = Groups::new(count);
        for (pair, start) in self.lines.windows(2).zip(starts.windows(2)) {
            let mut first = 0;
            for (i, (from, to)) in pair[1].iter().enumerate() {
                while pair[0].get(first).is_some_and(|below| below.1 <= *from) {
                    first += 1;
                }
                let over = pair[0][first..].iter().take_while(|below| below.0 < *to);
                for k in 0..over.count() {
                    groups.join(start[0] + first + k, start[1] + i);
                }
            }
        }
        Pieces { starts, groups }
    }

    /// The lines and spans that come so near to a place, mm.
    pub fn around(&self, place: Vec2, near: f64) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        for line in self.between(place.y - near, place.y + near) {
            let spans = self.lines[line].iter().enumerate();
            let touched =
                spans.filter(|(_, (from, to))| *from < place.x + near && *to > place.x - near);
            found.extend(touched.map(|(i, _)| (line, i)));
        }
        found
    }

    /// The line and the span that a place is in, or that is nearest to it on its line.
    pub fn nearest(&self, place: Vec2) -> Option<(usize, usize)> {
        let line = ((place.y - self.low) / self.step).floor().max(0.0) as usize;
        let away = |span: &(f64, f64)| (span.0 - place.x).max(place.x - span.1).max(0.0);
        let spans = self.lines.get(line)?.iter().enumerate();
        let nearest = spans.min_by(|a, b| away(a.1).total_cmp(&away(b.1)))?;
        Some((line, nearest.0))
    }
}

/// Which spans are in one piece.
pub struct Pieces {
    starts: Vec<usize>,
    groups: Groups,
}

impl Pieces {
    /// The number of the piece of a span of a line.
    pub fn of(&mut self, line: usize, span: usize) -> usize {
        self.groups.of(self.starts[line] + span)
    }
}

/// Things that are put together into groups.
pub struct Groups(Vec<usize>);

impl Groups {
    pub fn new(count: usize) -> Groups {
        Groups((0..count).collect())
    }

    /// The number of the group of a thing.
    pub fn of(&mut self, thing: usize) -> usize {
        let mut root = thing;
        while self.0[root] != root {
            self.0[root] = self.0[self.0[root]];
            root = self.0[root];
        }
        root
    }

    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        self.0[a.max(b)] = a.min(b);
    }
}

/// Points of an element after its start; chords leave an arc by 0.2 µm at most.
fn chords(element: &Element) -> Vec<Vec2> {
    let Some(turn) = element.turn else { return vec![element.end] };
    let from = element.start - turn.center;
    let step = 2.0 * (1.0 - 2e-4 / from.length().max(1e-3)).acos();
    let count = (turn.sweep.abs() / step).ceil().max(4.0) as usize;
    let point = |i: usize| {
        turn.center + Vec2::from_angle(turn.sweep * i as f64 / count as f64).rotate(from)
    };
    (1..count).map(point).chain([element.end]).collect()
}

fn merged(mut spans: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut whole: Vec<(f64, f64)> = Vec::with_capacity(spans.len());
    for (from, to) in spans {
        match whole.last_mut() {
            Some(last) if from <= last.1 => last.1 = last.1.max(to),
            _ => whole.push((from, to)),
        }
    }
    whole
}

/// What of `spans` is not in `others`; both are from left to right and apart.
fn without(spans: &[(f64, f64)], others: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut left = Vec::new();
    let mut first = 0;
    for (mut from, to) in spans.iter().copied() {
        while others.get(first).is_some_and(|other| other.1 <= from) {
            first += 1;
        }
        for other in others[first..].iter().take_while(|other| other.0 < to) {
            if from < other.0 {
                left.push((from, other.0));
            }
            from = from.max(other.1);
        }
        if from < to {
            left.push((from, to));
        }
    }
    left
}
