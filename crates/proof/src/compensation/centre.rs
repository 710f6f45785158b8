//! The path of the tool's centre against the contour that it has to cut.
//!
//! Nothing here knows how a control works the path out. Parallel to each element of the contour the centre has to run at the radius of
//! the tool; between two of them it may take any way that does not come nearer to either, nor farther from the corner than any
//! control goes; and what it leaves out of an element must be what the next one keeps the tool from. And nowhere does it come nearer
//! than that radius to any other element of the contour (a neck, elements apart), unless that one lies higher, or is one that the contour
//! itself comes to from the side of the material (a way in, a pass with stock).

use super::trail::{CompensatedMoves, Piece};
use crate::resolved_pose::Number;
use geom::{Element, Turn, Vec2, Vec3};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// How far from an outer corner the centre may be, in radii of the tool: where the parallels cross at a turn of 100° (SINUMERIK
/// `G451`) it is 1.556, on FANUC's way around a sharper one 1.414.
const FARTHEST: f64 = 1.6;

/// Samples of a way that is held off the contour.
const SAMPLES: u32 = 32;

/// A move shorter than this goes nowhere in the plane, mm.
pub(crate) const NOWHERE: f64 = 1e-6;

/// The most pairs of ways and elements near each other that are compared.
const MOST_PAIRS: usize = 30_000_000;

/// Moves whose coordinates in the plane differ by less are one, in steps of so many mm.
const ONE: f64 = 1e-4;

/// Where the path is wrong, and how.
#[derive(Debug, PartialEq)]
pub(crate) struct Fault {
    /// Line of the block of the path.
    pub block: Option<u32>,
    /// Line of the element of the contour: of the program where it offsets, of the source where the control does not.
    pub element: Option<u32>,
    pub how: String,
}

impl Fault {
    pub(crate) fn at_block(line: u32, how: impl Into<String>) -> Fault {
        Fault { block: Some(line), element: None, how: how.into() }
    }

    fn at_element(line: u32, how: impl Into<String>) -> Fault {
        Fault { block: None, element: Some(line), how: how.into() }
    }

    /// With the element of the contour as well.
    fn of(self, element: u32) -> Fault {
        Fault { element: Some(element), ..self }
    }
}

/// A move in the plane.
#[derive(Clone, Copy)]
struct PlaneMove {
    line: u32,
    element: Element,
    /// Height above the plane at its start and its end, mm.
    heights: [f64; 2],
    /// Its number among the pieces that it is one of.
    piece: usize,
}

/// By how much a path may be off, mm.
#[derive(Clone, Copy)]
pub(crate) struct Slack {
    /// Along lines and arcs.
    pub along: f64,
    /// Along arcs that are written as chords, beyond that.
    pub chord: f64,
    /// How far behind the start of the contour the centre may begin; none: as far as the way in, an element to some controls, keeps it off.
    pub start: Option<f64>,
}

/// Both paths in the plane.
struct PlanePaths {
    contour: Vec<PlaneMove>,
    /// The parallel of each element of the contour at the radius of the tool.
    parallel: Vec<Element>,
    /// The path of the centre.
    ways: Vec<PlaneMove>,
    /// The way out as the program says it.
    exit: Option<Element>,
    radius: f64,
    /// 1 where the tool is on the left, -1 where it is on the right.
    left: f64,
    /// How near is near enough, mm.
    slack: f64,
    /// How far chords of arcs may leave them, beyond that, mm.
    chord: f64,
    start: Option<f64>,
    /// By which ways, from and to, the centre runs along each element of the contour behind the first.
    along: Vec<[usize; 2]>,
}

/// Compares the path of the centre with the contour of `stretch`, to which it has to run parallel at `radius` mm; answers of each piece of
/// the path to which piece of the stretch it belongs, the way out being one more.
///
/// # Errors
/// Where it cuts into the contour, or leaves something of it.
pub(crate) fn compare(
    stretch: &CompensatedMoves,
    path: &[Piece],
    radius: f64,
    left: f64,
    slack: Slack,
) -> Result<Vec<usize>, Fault> {
    let Some(first) = stretch.pieces.first() else { return Ok(vec![0; path.len()]) };
    let axis = first.to.axis;
    let ways = |pieces: &[Piece], at: fn(u32, String) -> Fault| -> Result<Vec<PlaneMove>, Fault> {
        let ways = pieces
            .iter()
            .enumerate()
            .map(|(i, piece)| flat(piece, axis, i).map_err(|how| at(piece.line, how.to_owned())));
        ways.collect::<Result<_, _>>()
    };
    let in_plane = |way: &PlaneMove| way.element.length() > NOWHERE;
    let contour = ways(&stretch.pieces, Fault::at_element)?;
    let (contour, parallel) = long_enough(contour, left * radius, slack.along)?;
    let path = ways(path, Fault::at_block)?;
    let ways: Vec<PlaneMove> = path.iter().copied().filter(in_plane).collect();
    let exit = stretch.exit.and_then(|piece| flat(&piece, axis, 0).ok()).map(|way| way.element);
    let Slack { along: slack, chord, start } = slack;
    let along = Vec::new();
    let mut paths =
        PlanePaths { contour, parallel, ways, exit, radius, left, slack, chord, start, along };
    paths.compare()?;
    paths.keeps_off()?;
    paths.pieces(&path, stretch.pieces.len())
}

impl PlanePaths {
    fn compare(&mut self) -> Result<(), Fault> {
        // The first move only leads to the contour.
        let mut next = 0;
        let mut last: Option<(usize, [f64; 2])> = None;
        for k in 1..self.contour.len() {
            let found = (next..self.ways.len())
                .find_map(|i| self.covered(k, &self.ways[i].element, 0.0).map(|part| (i, part)));
            let Some((i, mut part)) = found else {
                let message = "nowhere leads the tool's centre along this element";
                let block = self.ways.get(next).map(|way| way.line);
                return Err(Fault { block, ..Fault::at_element(self.contour[k].line, message) });
            };
            // An arc may be written in parts.
            let mut j = i;
            let length = self.parallel[k].length();
            while self.contour[k].element.turn.is_some()
                && let Some([from, to]) =
                    self.ways.get(j + 1).and_then(|way| self.covered(k, &way.element, part[1]))
                && (from - part[1]).abs() <= self.slack
                && to <= length + self.slack
            {
                (j, part[1]) = (j + 1, to);
            }
            let before = match last {
                None => {
                    self.way_in(i, part)?;
                    0
                }
                Some((before, earlier)) => {
                    self.corner(k, [before, i], [earlier, part])?;
                    before + 1
                }
            };
            self.between_heights(before..i, [k - 1, k])?;
            self.same_height(k, [i, j])?;
            self.along.push([i, j]);
            (last, next) = (Some((j, part)), j + 1);
        }
        last.map_or(Ok(()), |(i, part)| self.way_out(i, part))
    }

    /// To which piece of the stretch each piece of the path belongs: a way around a corner to the element behind it, a move along the tool
    /// to that of the stretch which is there.
    fn pieces(&self, path: &[PlaneMove], count: usize) -> Result<Vec<usize>, Fault> {
        let mut at = vec![count; path.len()];
        let mut from = 0;
        for (way, element) in self.along.iter().zip(&self.contour[1..]) {
            let [first, last] = way.map(|i| self.ways[i].piece);
            at[from..=last].fill(element.piece);
            if from == 0 {
                at[..first].fill(0);
            }
            from = last + 1;
        }
        // Moves along the tool, in their order.
        let mut free = 0;
        for (i, way) in path.iter().enumerate() {
            if way.element.length() > NOWHERE {
                free = at[i] + 1;
                continue;
            }
            let is_next = at.get(i + 1).is_none_or(|next| free < *next) && free < count;
            if !is_next || self.contour.iter().any(|element| element.piece == free) {
                let message = "the program moves along the tool where the contour does not";
                return Err(Fault::at_block(way.line, message));
            }
            at[i] = free;
            free += 1;
        }
        Ok(at)
    }

    /// Along which part of element `k` the centre runs on `way`, as lengths along the parallel, mm; on an arc, of all turns, that which
    /// begins nearest to `before`.
    fn covered(&self, k: usize, way: &Element, before: f64) -> Option<[f64; 2]> {
        let parallel = &self.parallel[k];
        let [from, to] = match (parallel.turn, way.turn) {
            (None, None) => {
                let along = parallel.tangent(0.0);
                let place = |point: Vec2| {
                    let from = point - parallel.start;
                    (from.dot(along), from.perp_dot(along).abs())
                };
                let ((from, off), (to, other)) = (place(way.start), place(way.end));
                (off.max(other) <= self.slack).then_some([from, to])?
            }
            (Some(turn), other) => {
                let radius = parallel.start.distance(turn.center);
                let off = |t: f64| way.at(t).distance(turn.center) - radius;
                // Of a flat arc rounding moves the centre far, and no point of it.
                let is_on = match other {
                    Some(_) => {
                        [0.0, 0.25, 0.5, 0.75, 1.0].iter().all(|t| off(*t).abs() <= self.slack)
                    }
                    // A chord.
                    None => {
                        off(0.0).abs().max(off(1.0).abs()) <= self.slack
                            && -off(0.5) <= self.slack + self.chord
                    }
                };
                if !is_on || other.is_some_and(|other| turn.sweep * other.sweep <= 0.0) {
                    return None;
                }
                let angle = |from: Vec2, to: Vec2| {
                    (from - turn.center).angle_to(to - turn.center) * turn.sweep.signum()
                };
                let near = |angle: f64, to: f64| angle + TAU * ((to - angle) / TAU).round();
                let from = near(angle(parallel.start, way.start), before / radius);
                let step = angle(way.start, way.end);
                let step = other.map_or(step, |other| near(step, other.sweep.abs()));
                if step <= 0.0 {
                    return None;
                }
                [from * radius, (from + step) * radius]
            }
            (None, Some(_)) => return None,
        };
        let shared = to.min(parallel.length()) - from.max(0.0);
        (shared > self.slack.min(parallel.length() / 4.0)).then_some([from, to])
    }

    /// From way `i` along one element to way `j` along the next, `k`.
    fn corner(
        &self,
        k: usize,
        [i, j]: [usize; 2],
        [part, next]: [[f64; 2]; 2],
    ) -> Result<(), Fault> {
        let (before, after) = (&self.contour[k - 1], &self.contour[k]);
        for way in &self.ways[i..=j] {
            for of in [before, after] {
                let near = samples(&way.element).map(|point| of.element.nearest(point).1);
                let near = near.fold(f64::INFINITY, f64::min);
                self.holds_off(near, self.radius, way, of.line)?;
            }
        }
        for way in &self.ways[i + 1..j] {
            self.not_far(after, &[0.0, 0.5, 1.0].map(|t| way.element.at(t)), way)?;
        }
        let length = self.parallel[k - 1].length();
        let (last, first) = (&self.ways[i], &self.ways[j]);
        if part[1] > length {
            self.not_far(after, &[last.element.end], last)?;
        }
        if next[0] < 0.0 {
            self.not_far(after, &[first.element.start], first)?;
        }
        self.left_out(k - 1, [part[1], length], &after.element)?;
        self.left_out(k, [0.0, next[0]], &before.element)
    }

    /// The way to the contour, up to way `i` along its first element.
    fn way_in(&self, i: usize, part: [f64; 2]) -> Result<(), Fault> {
        let (entry, first) = (&self.contour[0], &self.contour[1]);
        let start = first.element.nearest(entry.element.start).1;
        for way in &self.ways[..i] {
            let near = samples(&way.element).map(|point| first.element.nearest(point));
            // At its very start the tool comes as near as its way leads.
            let near = near.filter(|(t, _)| *t > 0.0).map(|(_, near)| near);
            let near = near.fold(f64::INFINITY, f64::min);
            self.holds_off(near, self.radius.min(start), way, first.line)?;
        }
        let way = &self.ways[i];
        if part[0] < 0.0 {
            self.not_far(first, &[way.element.start], way)?;
        }
        let Some(farthest) = self.start else {
            return self.left_out(1, [0.0, part[0]], &entry.element);
        };
        if part[0] > farthest {
            let behind = Number(part[0]);
            let how = format!("the tool begins {behind} mm behind the start of the contour");
            return Err(Fault::at_block(way.line, how).of(first.line));
        }
        Ok(())
    }

    /// The way off the contour, after way `i` along its last element.
    fn way_out(&self, i: usize, part: [f64; 2]) -> Result<(), Fault> {
        let Some(k) = self.contour.len().checked_sub(1) else { return Ok(()) };
        let last = &self.contour[k];
        let length = self.parallel[k].length();
        if part[1] < length - self.slack {
            let left = Number(length - part[1]);
            let how = format!("the tool leaves {left} mm before the end of the contour");
            return Err(Fault::at_block(self.ways[i].line, how).of(last.line));
        }
        if part[1] > length + self.slack && i + 1 < self.ways.len() {
            let past = Number(part[1] - length);
            let how = format!("the tool goes {past} mm past the end of the contour");
            return Err(Fault::at_block(self.ways[i].line, how).of(last.line));
        }
        let Some(end) = self.ways.last() else { return Ok(()) };
        let end = last.element.nearest(end.element.end).1;
        for way in &self.ways[i + 1..] {
            let near = samples(&way.element).map(|point| last.element.nearest(point));
            let near = near.filter(|(t, _)| *t < 1.0).map(|(_, near)| near);
            let near = near.fold(f64::INFINITY, f64::min);
            self.holds_off(near, self.radius.min(end), way, last.line)?;
        }
        Ok(())
    }

    /// The centre is no nearer to an element than this.
    fn holds_off(&self, near: f64, least: f64, way: &PlaneMove, of: u32) -> Result<(), Fault> {
        if near >= least - self.slack_of(way) {
            return Ok(());
        }
        let how = format!("the tool cuts {} mm into the contour", Number(least - near));
        Err(Fault::at_block(way.line, how).of(of))
    }

    /// How near to the contour is near enough on a way, mm.
    fn slack_of(&self, way: &PlaneMove) -> f64 {
        match way.element.turn {
            None => self.slack + self.chord,
            Some(_) => self.slack,
        }
    }

    /// Between which elements way `i` runs, or along which it does: 0 is the way in, and the one behind the last the way out.
    fn between(&self, i: usize) -> [usize; 2] {
        let begun = self.along.partition_point(|[first, _]| *first <= i);
        let ended = self.along.partition_point(|[_, last]| *last < i);
        [begun, ended + 1]
    }

    /// Every way against every element but its own and their neighbours.
    fn keeps_off(&self) -> Result<(), Fault> {
        let (Some(last), Some(start), Some(end)) =
            (self.along.last(), self.ways.first(), self.ways.last())
        else {
            return Ok(());
        };
        let (first, last) = (self.along[0][0], last[1]);
        let (start, end) = (start.element.start, end.element.end);
        // Passes at several depths are one: of an element the highest counts, of a way the lowest.
        let (elements, number) = unique(&self.contour[1..], |a, b| high(a) > high(b));
        let (ways, _) = unique(&self.ways, |a, b| low(a) < low(b));
        let boxes = Boxes::of(&elements);
        let (mut near, mut pairs) = (Vec::new(), 0);
        for (i, way) in ways {
            let [from, to] = self.between(i);
            let count = self.contour.len() - 1;
            let own = from.max(1)..=to.min(count);
            let neighbours = (from.max(2) - 1)..=(to + 1).min(count);
            let neighbours: Vec<usize> = neighbours.map(|k| number[k - 1]).collect();
            let lead = match i {
                i if i < first => Some((start, Some(self.contour[0].element))),
                i if i > last => Some((end, self.exit)),
                _ => None,
            };
            boxes.near(&way.element, self.radius, &mut near);
            pairs += near.len();
            if pairs > MOST_PAIRS {
                let message = "the contour lies over itself so often that it cannot be compared";
                return Err(Fault::at_block(way.line, message));
            }
            for other in near.iter().filter(|other| !neighbours.contains(other)) {
                self.apart(&way, &elements[*other].1, &self.contour[own.clone()], lead)?;
            }
        }
        Ok(())
    }

    /// A way against an element that is none of its `own`; a way in or out may come as near as its outer end is, or as the program says.
    fn apart(
        &self,
        way: &PlaneMove,
        other: &PlaneMove,
        own: &[PlaneMove],
        lead: Option<(Vec2, Option<Element>)>,
    ) -> Result<(), Fault> {
        let least = lead.map_or(self.radius, |(end, said)| {
            let said = said.map_or(f64::INFINITY, |said| said.distance(&other.element, self.slack));
            other.element.nearest(end).1.min(said).min(self.radius)
        });
        let enough = least - self.slack_of(way);
        let is_above = low(way) > high(other) + self.slack;
        if is_above || way.element.distance(&other.element, self.slack) >= enough {
            return Ok(());
        }
        // Where they are nearest or cross, and how far on both sides of that the way is too near.
        let nearest = way.element.closest(&other.element).0;
        let meets = way.element.meets(&other.element, self.slack).chain([nearest]);
        let reach = |point: Vec2| {
            let t = way.element.nearest(point).0;
            [0.0, 1.0]
                .map(|end| edge(t, end, |t| other.element.nearest(way.element.at(t)).1 < enough))
        };
        let ends: Vec<f64> = meets
            .flat_map(|point| reach(point).into_iter().chain([way.element.nearest(point).0]))
            .collect();
        let points = samples(&way.element).chain(ends.into_iter().map(|t| way.element.at(t)));
        let crosses =
            |way: &&PlaneMove| way.element.meets(&other.element, self.slack).next().is_some();
        let crossing: Vec<&PlaneMove> = own.iter().filter(crosses).collect();
        let near = points.filter_map(|point| {
            let (t, near) = other.element.nearest(point);
            let is_cut_away = self.is_cut_away(other.element.at(t), &crossing);
            let counts = self.faces(other, t, own, point) && !is_cut_away;
            (near < enough && counts).then_some(near)
        });
        self.holds_off(near.fold(f64::INFINITY, f64::min), least, way, other.line)
    }

    /// Whether a place of an element is on that side of one `crossing` it on which the tool goes along that one: what runs on there past
    /// the crossing (a way in or out beyond a corner) bounds nothing.
    fn is_cut_away(&self, at: Vec2, crossing: &[&PlaneMove]) -> bool {
        crossing.iter().any(|way| {
            let (t, _) = way.element.nearest(at);
            let aside = way.element.tangent(t).perp_dot(at - way.element.at(t));
            aside * self.left > self.slack
        })
    }

    /// Whether the contour, where the tool at `point` touches it, is on that side of an element on which the tool goes along it.
    fn faces(&self, other: &PlaneMove, t: f64, own: &[PlaneMove], point: Vec2) -> bool {
        let touched = own.iter().map(|way| {
            let (t, distance) = way.element.nearest(point);
            (distance, way.element.at(t))
        });
        let touched = touched.min_by(|a, b| a.0.total_cmp(&b.0));
        let along = other.element.tangent(t);
        touched.is_some_and(|(_, touched)| {
            along.perp_dot(touched - other.element.at(t)) * self.left > NOWHERE
        })
    }

    /// On its way around the corner before `after` the centre does not go far: these points of a way.
    fn not_far(&self, after: &PlaneMove, points: &[Vec2], way: &PlaneMove) -> Result<(), Fault> {
        let far = points.iter().map(|point| point.distance(after.element.start));
        let far = far.fold(0.0, f64::max);
        if far <= FARTHEST * self.radius + self.slack {
            return Ok(());
        }
        let how = format!("the tool's centre is {} mm off the corner before it", Number(far));
        Err(Fault::at_block(way.line, how).of(after.line))
    }

    /// Each point of element `k` along which the centre does not run, from and to in mm, is one from which `other` keeps the tool.
    fn left_out(&self, k: usize, [from, to]: [f64; 2], other: &Element) -> Result<(), Fault> {
        let parallel = &self.parallel[k];
        let length = parallel.length();
        if to - from <= self.slack || length <= 0.0 {
            return Ok(());
        }
        // Where both part, rounding moves the crossing along them.
        let reached = |i: u32| {
            let part = (f64::from(i) + 0.5) / f64::from(SAMPLES);
            let point = parallel.at((from + part * (to - from)) / length);
            other.nearest(point).1 > self.radius + self.slack
        };
        match (0..SAMPLES).any(reached) {
            true => {
                let message =
                    format!("the tool leaves {} mm of the contour uncut", Number(to - from));
                Err(Fault::at_element(self.contour[k].line, message))
            }
            false => Ok(()),
        }
    }

    /// Along element `k`, on the ways from `i` to `j`, the tool goes evenly from its one height to the other: over the length that is
    /// left of it at its corners, as controls do.
    fn same_height(&self, k: usize, [i, j]: [usize; 2]) -> Result<(), Fault> {
        let [from, to] = self.contour[k].heights;
        let ways = &self.ways[i..=j];
        let whole: f64 = ways.iter().map(|way| way.element.length()).sum();
        let mut done = 0.0;
        for way in ways {
            let wanted = |done: f64| from + (to - from) * done / whole;
            let begins = wanted(done);
            done += way.element.length();
            for (wanted, is) in [begins, wanted(done)].into_iter().zip(way.heights) {
                self.at_height(way, [wanted; 2], is)?;
            }
        }
        Ok(())
    }

    /// Between two elements the tool is no higher and no lower than where the one ends and the other begins; on the way in, than where
    /// that begins.
    fn between_heights(
        &self,
        ways: std::ops::Range<usize>,
        [before, after]: [usize; 2],
    ) -> Result<(), Fault> {
        let ([start, end], begins) = (self.contour[before].heights, self.contour[after].heights[0]);
        let start = if before == 0 { start } else { end };
        let range = [start.min(end).min(begins), start.max(end).max(begins)];
        for way in &self.ways[ways] {
            way.heights.into_iter().try_for_each(|is| self.at_height(way, range, is))?;
        }
        Ok(())
    }

    fn at_height(&self, way: &PlaneMove, [low, high]: [f64; 2], is: f64) -> Result<(), Fault> {
        let off = if is > high { is - high } else { is - low };
        if (low..=high).contains(&is) || off.abs() <= self.slack {
            return Ok(());
        }
        let (by, how) = (Number(off.abs()), if off > 0.0 { "high" } else { "low" });
        Err(Fault::at_block(way.line, format!("the tool goes {by} mm too {how}")))
    }
}

/// The lower end of a move.
fn low(way: &PlaneMove) -> f64 {
    way.heights[0].min(way.heights[1])
}

/// Its higher end.
fn high(way: &PlaneMove) -> f64 {
    way.heights[0].max(way.heights[1])
}

/// Moves, of those that are one in the plane only that which `counts` before the others, each with its number; and where each of `ways` is
/// among them.
fn unique(
    ways: &[PlaneMove],
    counts: impl Fn(&PlaneMove, &PlaneMove) -> bool,
) -> (Vec<(usize, PlaneMove)>, Vec<usize>) {
    let mut found: Vec<(usize, PlaneMove)> = Vec::new();
    let mut known: HashMap<[i64; 6], usize> = HashMap::new();
    let number = ways.iter().enumerate().map(|(i, way)| {
        let Element { start, end, turn } = way.element;
        let middle = way.element.at(0.5);
        let step = |mm: f64| (mm / ONE).round() as i64;
        let key = [start.x, start.y, end.x, end.y, middle.x, middle.y].map(step);
        // An arc of more than a turn is another one than the rest of it.
        let many = turn.is_some_and(|turn| turn.sweep.abs() > TAU);
        let at = match known.get(&key).filter(|_| !many) {
            Some(&at) => {
                if counts(way, &found[at].1) {
                    found[at] = (i, *way);
                }
                at
            }
            None => {
                found.push((i, *way));
                found.len() - 1
            }
        };
        known.insert(key, at);
        at
    });
    let number = number.collect();
    (found, number)
}

/// Boxes around elements, and around those, in their order.
struct Boxes {
    nodes: Vec<Node>,
}

struct Node {
    low: Vec2,
    high: Vec2,
    /// The element that it is around, or where its two halves are.
    holds: Result<usize, [usize; 2]>,
}

impl Boxes {
    fn of(elements: &[(usize, PlaneMove)]) -> Boxes {
        let node = |(i, (_, way)): (usize, &(usize, PlaneMove))| {
            let (low, high) = way.element.extents();
            Node { low, high, holds: Ok(i) }
        };
        let mut nodes: Vec<Node> = elements.iter().enumerate().map(node).collect();
        // Pairs of neighbours, again and again, up to one.
        let mut row = 0..nodes.len();
        while row.len() > 1 {
            let next = nodes.len();
            for a in row.clone().step_by(2) {
                let b = (a + 1).min(row.end - 1);
                let (low, high) =
                    (nodes[a].low.min(nodes[b].low), nodes[a].high.max(nodes[b].high));
                nodes.push(Node { low, high, holds: Err([a, b]) });
            }
            row = next..nodes.len();
        }
        Boxes { nodes }
    }

    /// The numbers of the elements whose boxes are within `reach` mm of that of `element`.
    fn near(&self, element: &Element, reach: f64, found: &mut Vec<usize>) {
        found.clear();
        let (low, high) = element.extents();
        let (low, high) = (low - Vec2::splat(reach), high + Vec2::splat(reach));
        let mut open: Vec<usize> = self.nodes.len().checked_sub(1).into_iter().collect();
        while let Some(at) = open.pop() {
            let node = &self.nodes[at];
            if node.low.cmpgt(high).any() || node.high.cmplt(low).any() {
                continue;
            }
            match node.holds {
                Ok(i) => found.push(i),
                Err([a, b]) if a == b => open.push(a),
                Err([a, b]) => open.extend([b, a]),
            }
        }
    }
}

/// The last place from `t` towards `end` where `holds` does, which does at `t`.
fn edge(t: f64, end: f64, holds: impl Fn(f64) -> bool) -> f64 {
    if holds(end) {
        return end;
    }
    let (mut yes, mut no) = (t, end);
    while (no - yes).abs() > 1e-9 {
        let middle = (yes + no) / 2.0;
        if holds(middle) { yes = middle } else { no = middle }
    }
    yes
}

/// Points of an element, both ends among them.
fn samples(element: &Element) -> impl Iterator<Item = Vec2> + '_ {
    (0..=SAMPLES).map(|i| element.at(f64::from(i) / f64::from(SAMPLES)))
}

/// The contour without what is shorter than what counts as near, itself or its parallel, of neighbouring ones both together: what is cut of
/// them, those before and behind them show. The first move leads to the contour, wherever it ends.
///
/// # Errors
/// An arc that is too small for the tool.
fn long_enough(
    contour: Vec<PlaneMove>,
    left: f64,
    slack: f64,
) -> Result<(Vec<PlaneMove>, Vec<Element>), Fault> {
    let (mut kept, mut parallel) = (Vec::new(), Vec::new());
    let mut skipped = 0.0;
    for way in contour {
        if way.piece > 0 && way.element.length() <= NOWHERE {
            continue;
        }
        let own = parallel_of(&way, left)?;
        skipped += way.element.length().min(own.length());
        if way.piece == 0 || skipped > slack {
            kept.push(way);
            parallel.push(own);
            skipped = 0.0;
        }
    }
    Ok((kept, parallel))
}

/// A move seen along the tool.
///
/// # Errors
/// It is no move across the tool, and why.
fn flat(piece: &Piece, axis: Vec3, number: usize) -> Result<PlaneMove, &'static str> {
    let x = axis.any_orthonormal_vector();
    let y = axis.cross(x);
    let flat = |point: Vec3| Vec2::new(point.dot(x), point.dot(y));
    let (start, end) = (flat(piece.from.tip), flat(piece.to.tip));
    if geom::angle_between(piece.to.axis, axis) > geom::ANGLE_EPSILON {
        return Err("the tool turns while compensation is on");
    }
    let turn = match piece.arc {
        None => None,
        Some(arc) if arc.normal.dot(axis).abs() > 1.0 - geom::ANGLE_EPSILON => {
            let sweep = arc.sweep * arc.normal.dot(axis).signum();
            Some(Turn { center: flat(arc.center), sweep })
        }
        Some(_) => {
            return Err("an arc in another plane than that of the tool");
        }
    };
    let element = Element { start, end, turn };
    let heights = [piece.from, piece.to].map(|place| place.tip.dot(axis));
    Ok(PlaneMove { line: piece.line, element, heights, piece: number })
}

/// The parallel of an element, so many mm to its left.
fn parallel_of(way: &PlaneMove, left: f64) -> Result<Element, Fault> {
    let Element { start, end, turn } = way.element;
    let Some(Turn { center, sweep }) = turn else {
        let aside = way.element.tangent(0.0).perp() * left;
        return Ok(Element::line(start + aside, end + aside));
    };
    let radius = start.distance(center);
    let grown = radius - left * sweep.signum();
    if grown <= 0.0 {
        let message =
            format!("an arc of radius {} mm, into which the tool does not fit", Number(radius));
        return Err(Fault::at_element(way.line, message));
    }
    let out = |point: Vec2| center + (point - center) * (grown / radius);
    Ok(Element { start: out(start), end: out(end), turn })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compensation::trail::Terms;
    use crate::resolved_pose::PartialPose;
    use geom::Arc;
    use program::Compensation;

    /// Where a move ends; of an arc also the centre, and whether it turns right.
    type End = ([f64; 2], Option<([f64; 2], bool)>);

    /// Moves through these points at Z -1, each on a line of its own.
    fn pieces(start: [f64; 2], ends: &[End]) -> Vec<Piece> {
        let place = |[x, y]: [f64; 2]| PartialPose { tip: Vec3::new(x, y, -1.0), axis: Vec3::Z };
        let mut from = place(start);
        let piece = |(line, (end, turn)): (u32, &End)| {
            let to = place(*end);
            let arc = turn.map(|([x, y], right)| {
                let normal = if right { Vec3::NEG_Z } else { Vec3::Z };
                Arc::new(from.tip, to.tip, Vec3::new(x, y, -1.0), normal, 0, 0.01).unwrap()
            });
            Piece { line, from: std::mem::replace(&mut from, to), to, arc }
        };
        (1..).zip(ends).map(piece).collect()
    }

    /// In from (-20, 0), along Y 0 to (30, 0), around the outer corner down to (30, -30), around the inner one to (60, -30), and
    /// out; the tool is on the left.
    fn stretch() -> CompensatedMoves {
        let side = Compensation::Left(None);
        let terms = Terms { source_line: 1, side, radius: Some(5.0), tool_length: None };
        let ends = [[0.0, 0.0], [30.0, 0.0], [30.0, -30.0], [60.0, -30.0]];
        let pieces = pieces([-20.0, 0.0], &ends.map(|end| (end, None)));
        CompensatedMoves { terms, before: 0, pieces, exit: None }
    }

    /// What a control makes of it with a tool of radius 5: every corner by hand.
    const PATH: [End; 6] = [
        ([0.0, 5.0], None),
        ([30.0, 5.0], None),
        ([35.0, 0.0], Some(([30.0, 0.0], true))),
        ([35.0, -25.0], None),
        ([60.0, -25.0], None),
        ([80.0, -25.0], None),
    ];

    fn judged(path: &[End]) -> Result<(), Fault> {
        let slack = Slack { along: 0.003, chord: 0.0, start: Some(0.003) };
        compare(&stretch(), &pieces([-20.0, 0.0], path), 5.0, 1.0, slack).map(drop)
    }

    #[test]
    fn each_way_around_a_corner_that_keeps_off_it_is_taken() {
        assert_eq!(judged(&PATH), Ok(()));
        // To where the parallels cross.
        let mut crossing = PATH.to_vec();
        crossing.remove(2);
        crossing[1].0 = [35.0, 5.0];
        assert_eq!(judged(&crossing), Ok(()));
        // On, straight over, and back from behind.
        let mut polygon = PATH.to_vec();
        polygon[1].0 = [32.5, 5.0];
        polygon[2] = ([35.0, 2.5], None);
        assert_eq!(judged(&polygon), Ok(()));
    }

    /// Each point on its own lower or higher than the contour is there: where it begins, around a corner, at its end.
    #[test]
    fn a_path_at_another_height_is_refused() {
        let slack = Slack { along: 0.003, chord: 0.0, start: Some(0.003) };
        let good = pieces([-20.0, 0.0], &PATH);
        for at in 0..5 {
            for height in [-8.0, 0.01] {
                let mut path = good.clone();
                path[at].to.tip.z += height;
                path[at + 1].from.tip.z += height;
                let Fault { block, how, .. } =
                    compare(&stretch(), &path, 5.0, 1.0, slack).unwrap_err();
                assert!(how.contains("mm too"), "{at}: {how}");
                let lines = [path[at].line, path[at + 1].line];
                assert!(lines.contains(&block.unwrap()), "{at}: {block:?}");
            }
        }
    }

    /// Around a square from outside, beginning and ending past the corner at (0, 0): the usual way to leave no mark there.
    #[test]
    fn a_contour_that_begins_and_ends_past_its_corner_is_taken() {
        let side = Compensation::Left(None);
        let terms = Terms { source_line: 1, side, radius: Some(5.0), tool_length: None };
        let ends = [[0.0, -8.0], [0.0, 50.0], [50.0, 50.0], [50.0, 0.0], [-8.0, 0.0]];
        let contour = pieces([-30.0, -8.0], &ends.map(|end| (end, None)));
        let stretch = CompensatedMoves { terms, before: 0, pieces: contour, exit: None };
        let path: [End; 9] = [
            ([-5.0, -8.0], None),
            ([-5.0, 50.0], None),
            ([0.0, 55.0], Some(([0.0, 50.0], true))),
            ([50.0, 55.0], None),
            ([55.0, 50.0], Some(([50.0, 50.0], true))),
            ([55.0, 0.0], None),
            ([50.0, -5.0], Some(([50.0, 0.0], true))),
            ([-8.0, -5.0], None),
            ([-30.0, -8.0], None),
        ];
        let slack = Slack { along: 0.003, chord: 0.0, start: Some(0.003) };
        let judged =
            |path: &[End]| compare(&stretch, &pieces([-30.0, -8.0], path), 5.0, 1.0, slack);
        assert!(judged(&path).is_ok(), "{:?}", judged(&path));
    }

    #[test]
    fn a_path_that_cuts_the_contour_or_leaves_some_of_it_is_refused() {
        let damaged = |what: &str, damage: &dyn Fn(&mut Vec<End>)| {
            let mut path = PATH.to_vec();
            damage(&mut path);
            assert!(judged(&path).is_err(), "{what}");
        };
        damaged("the corner is cut straight", &|path| path[2].1 = None);
        damaged("the way is 0.01 mm too near", &|path| {
            (path[0].0, path[1].0) = ([0.0, 4.99], [30.0, 4.99]);
        });
        damaged("the way is 0.01 mm too far", &|path| {
            (path[0].0, path[1].0) = ([0.0, 5.01], [30.0, 5.01]);
        });
        damaged("the first element is left early", &|path| {
            path[1].0 = [29.9, 5.0];
            path[2] = ([35.0, 0.0], None);
        });
        damaged("the inner corner is overrun", &|path| {
            path[3].0 = [35.0, -25.1];
            path.insert(4, ([35.0, -25.0], None));
        });
        damaged("the inner corner is left out", &|path| {
            path[3].0 = [35.0, -20.0];
            path[4] = ([40.0, -25.0], None);
            path.insert(5, ([60.0, -25.0], None));
        });
        damaged("the corner is far away", &|path| {
            path[1].0 = [45.0, 5.0];
            path[2] = ([35.0, -5.0], None);
        });
        damaged("an element is missing", &|path| {
            path.remove(3);
        });
        damaged("the first element is begun late", &|path| path[0].0 = [2.0, 5.0]);
        damaged("the last element is overrun", &|path| path[4].0 = [61.0, -25.0]);
        damaged("the way in begins far behind", &|path| {
            path.insert(0, ([-15.0, 5.0], None));
            path.remove(1);
        });
        damaged("the last element ends early", &|path| path[4].0 = [59.9, -25.0]);
        damaged("the way out cuts it", &|path| path[5].0 = [50.0, -40.0]);
        // As it was written and proven before: the radius twice, and not at all.
        damaged("it is offset twice", &|path| {
            *path = vec![
                ([0.0, 10.0], None),
                ([30.0, 10.0], None),
                ([40.0, 0.0], Some(([30.0, 0.0], true))),
                ([40.0, -20.0], None),
                ([60.0, -20.0], None),
                ([80.0, -20.0], None),
            ];
        });
        damaged("it is not offset", &|path| {
            *path = [[0.0, 0.0], [30.0, 0.0], [30.0, -30.0], [60.0, -30.0], [80.0, -30.0]]
                .map(|end| (end, None))
                .to_vec();
        });
    }

    /// A slot of two walls, open to the left, that the contour enters along the lower one and leaves along the upper one: 40 mm long, and
    /// in the middle as wide as is said, behind a bulge that is no neighbour of the lower wall.
    fn neck(width: f64) -> ([f64; 2], Vec<End>) {
        let bulge = 20.0 - width;
        let ends = [
            ([0.0, 0.0], None),
            ([40.0, 0.0], None),
            ([40.0, 20.0], None),
            ([25.0, 20.0], None),
            ([25.0, 20.0 - bulge], None),
            ([15.0, 20.0 - bulge], None),
            ([15.0, 20.0], None),
            ([0.0, 20.0], None),
        ];
        ([-20.0, 0.0], ends.to_vec())
    }

    /// The centre of a tool of radius 3 along it, by hand: arcs about the two corners of the bulge.
    fn through_the_neck(width: f64) -> Vec<End> {
        let floor = width - 3.0;
        vec![
            ([0.0, 3.0], None),
            ([37.0, 3.0], None),
            ([37.0, 17.0], None),
            ([28.0, 17.0], None),
            ([28.0, width], None),
            ([25.0, floor], Some(([25.0, width], true))),
            ([15.0, floor], None),
            ([12.0, width], Some(([15.0, width], true))),
            ([12.0, 17.0], None),
            ([0.0, 17.0], None),
            ([-20.0, 17.0], None),
        ]
    }

    fn judged_neck(width: f64) -> Result<(), Fault> {
        let (start, ends) = neck(width);
        let side = Compensation::Left(None);
        let terms = Terms { source_line: 1, side, radius: Some(3.0), tool_length: None };
        let stretch =
            CompensatedMoves { terms, before: 0, pieces: pieces(start, &ends), exit: None };
        let slack = Slack { along: 0.003, chord: 0.0, start: Some(0.003) };
        let path = pieces(start, &through_the_neck(width));
        compare(&stretch, &path, 3.0, 1.0, slack).map(drop)
    }

    #[test]
    fn a_neck_between_elements_that_are_no_neighbours_is_as_wide_as_the_tool() {
        assert_eq!(judged_neck(8.0), Ok(()));
        assert_eq!(judged_neck(6.0), Ok(()));
        // 0.1 mm too narrow: along the lower wall the tool cuts into the bulge.
        let Fault { block, element, how } = judged_neck(5.9).unwrap_err();
        assert!(how.contains("mm into the contour"), "{how}");
        // The bulge, or the side of it that ends there.
        assert!(block == Some(2) && [Some(5), Some(6)].contains(&element), "{block:?} {element:?}");
    }

    /// A pocket with the corners (0, 0) and (40, 30), the tool inside: the first pass along its floor leaves 1 mm of stock, the last one, in
    /// the same stretch, does not.
    #[test]
    fn a_pass_that_takes_the_stock_of_an_earlier_one_is_no_neck() {
        let ends = [[20.0, 1.0], [40.0, 1.0], [40.0, 30.0], [0.0, 30.0], [0.0, 0.0], [30.0, 0.0]];
        let path = [
            [20.0, 4.0],
            [37.0, 4.0],
            [37.0, 27.0],
            [3.0, 27.0],
            [3.0, 3.0],
            [30.0, 3.0],
            [30.0, 15.0],
        ];
        let side = Compensation::Left(None);
        let terms = Terms { source_line: 1, side, radius: Some(3.0), tool_length: None };
        let pieces_of = |ends: &[[f64; 2]]| {
            let ends: Vec<End> = ends.iter().map(|end| (*end, None)).collect();
            pieces([20.0, 15.0], &ends)
        };
        let stretch = CompensatedMoves { terms, before: 0, pieces: pieces_of(&ends), exit: None };
        let slack = Slack { along: 0.003, chord: 0.0, start: Some(0.003) };
        let judged = |path: &[[f64; 2]]| compare(&stretch, &pieces_of(path), 3.0, 1.0, slack);
        // The way out is one more than the pieces.
        assert_eq!(judged(&path), Ok(vec![0, 1, 2, 3, 4, 5, 6]));
        // Out through the wall.
        let mut damaged = path;
        damaged[6] = [60.0, 15.0];
        assert!(judged(&damaged).is_err());
    }
}
