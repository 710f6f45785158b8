//! Places where two conductors are nearer to each other than a cut is wide.

use super::field::Field;
use super::lines::{Line, TooMany, lines};
use super::middle::LinePoint;
use crate::Path;
use geom::{Element, Vec2};

/// A tool fits into what is narrower than the tool by as much, mm: some steps of a machine, and twice what
/// the boundary of a region may be off.
pub const FITS: f64 = 0.002;

/// How far a place may be from the chord that replaces it, mm.
const STRAIGHT: f64 = 0.001;

/// A place where two conductors are nearer to each other than the cut is wide.
#[derive(Clone, Debug, PartialEq)]
pub struct NarrowGap {
    /// The middle between them where they are nearest, mm.
    pub at: Vec2,
    /// The two islands of copper.
    pub islands: [usize; 2],
    /// How far apart they are there, mm; 0 where they touch.
    pub width: f64,
    /// How long the gap is narrower than the cut, mm.
    pub length: f64,
    /// The line that is as far from the one as from the other, as far as the gap is narrow; none where they
    /// touch.
    pub middle: Option<Path>,
}

impl NarrowGap {
    /// The widest cut that fits through, mm; 0 where none does.
    pub fn widest_cut(&self) -> f64 {
        (self.width - FITS).max(0.0)
    }

    /// Whether there is a middle to cut along: conductors that touch cannot be parted.
    pub fn can_be_cut(&self) -> bool {
        self.middle.is_some()
    }

    /// By how much a cut down the middle makes the copper on each side thinner, mm.
    pub fn thinned(&self, cut: f64) -> f64 {
        (cut - self.width) / 2.0
    }
}

/// The gaps between conductors that are too near each other for two cuts side by side.
pub(super) struct Gaps {
    /// Paths down the middle where the cut just fits.
    pub fitting: Vec<Path>,
    /// Where it does not; the narrowest first.
    pub narrow: Vec<NarrowGap>,
}

/// The gaps that are narrower than a cut of `width` mm, or as wide.
pub(super) fn gaps(field: &Field, width: f64) -> Result<Gaps, TooMany> {
    // Where a cut fits exactly, by rounding, the paths along the two conductors are one.
    let lines = lines(field, (width + FITS) / 2.0)?;
    let mut gaps = Gaps { fitting: Vec::new(), narrow: Vec::new() };
    for line in &lines {
        for run in runs(line, (width - FITS) / 2.0) {
            let path = path(&run.points);
            let length = path.as_ref().map_or(0.0, Path::length);
            if run.is_narrow {
                gaps.narrow.extend(narrow(field, line.pair, &run, length, path));
            } else if length > width / 2.0 {
                // A shorter one is cut from its ends.
                gaps.fitting.extend(path);
            }
        }
    }
    gaps.narrow.sort_by(|a, b| a.width.total_cmp(&b.width));
    Ok(gaps)
}

/// Places of a line that are all too narrow, or all wide enough.
struct Run {
    is_narrow: bool,
    points: Vec<LinePoint>,
}

/// The line, cut where the conductors are `least` mm away.
fn runs(line: &Line, least: f64) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for &point in &line.points {
        let is_narrow = point.away < least;
        match runs.last_mut() {
            Some(run) if run.is_narrow == is_narrow => run.points.push(point),
            Some(Run { points, .. }) => {
                let before = *points.last().unwrap_or(&point);
                let t = (least - before.away) / (point.away - before.away);
                let cut = LinePoint { at: before.at.lerp(point.at, t), away: least };
                points.push(cut);
                runs.push(Run { is_narrow, points: vec![cut, point] });
            }
            None => runs.push(Run { is_narrow, points: vec![point] }),
        }
    }
    runs
}

fn narrow(
    field: &Field,
    pair: [usize; 2],
    run: &Run,
    length: f64,
    middle: Option<Path>,
) -> Option<NarrowGap> {
    let least = run.points.iter().min_by(|a, b| a.away.total_cmp(&b.away))?;
    let mut islands = field.islands(least.at, pair, least.away)?;
    islands.sort_unstable();
    Some(NarrowGap { at: least.at, islands, width: 2.0 * least.away, length, middle })
}

/// The path through `points`, in as few chords as stay near enough.
fn path(points: &[LinePoint]) -> Option<Path> {
    let mut elements = Vec::new();
    let mut start = 0;
    while start + 1 < points.len() {
        // As far as all places between are near the chord: twice as far as long as that is so, and then
        // back.
        let from = points[start].at;
        let is_straight = |end: usize| {
            let Some(last) = points.get(end) else { return false };
            let chord = Element::line(from, last.at);
            let between = points.get(start + 1..end).unwrap_or_default();
            between.iter().all(|point| chord.nearest(point.at).1 <= STRAIGHT)
        };
        let (mut good, mut reach) = (start + 1, 2);
        while is_straight(start + reach) {
            good = start + reach;
            reach *= 2;
        }
        let mut bad = start + reach;
        while bad > good + 1 {
            let middle = good.midpoint(bad);
            if is_straight(middle) { good = middle } else { bad = middle }
        }
        elements.push(Element::line(from, points[good].at));
        start = good;
    }
    Path::new(elements)
}
