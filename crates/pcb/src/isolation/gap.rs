//! Places where two conductors are nearer to each other than a cut is wide.

use super::bite::Bite;
use super::field::Field;
use super::lines::{Line, TooMany, lines};
use super::middle::LinePoint;
use super::swept::Swept;
use crate::Path;
use geom::{Element, Vec2};

/// A tool fits into what is narrower than the tool by as much, mm: some steps of a machine, and twice what
/// the boundary of a region may be off.
pub const FITS: f64 = 0.002;

/// How far a place may be from the chord that replaces it, mm.
const STRAIGHT: f64 = 0.001;

/// The longest piece of a gap of which its ends decide whether it is cut, mm.
const PIECE: f64 = 0.05;

/// What becomes of a gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It is cut down its middle.
    Cut,
    /// The cuts at its ends part the two, since it is shorter than the cut is wide.
    Parted,
    /// The two stay joined.
    Joined,
}

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
    /// What becomes of it.
    pub fate: Fate,
}

impl NarrowGap {
    /// The widest cut that fits through, mm; 0 where none does.
    pub fn widest_cut(&self) -> f64 {
        (self.width - FITS).max(0.0)
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
    /// Those which are so short that cuts at their ends may do.
    pub short: Vec<Path>,
    /// Where it does not; the narrowest first.
    pub narrow: Vec<NarrowGap>,
}

/// The gaps that are narrower than a cut of `width` mm, or as wide. Those that may be cut have that fate; whether the others
/// are parted by other cuts is not known yet.
pub(super) fn gaps(bite: &Bite, width: f64) -> Result<Gaps, TooMany> {
    let field = &bite.field;
    // Where a cut fits exactly, by rounding, the paths along the two conductors are one.
    let lines = lines(field, (width + FITS) / 2.0)?;
    let mut gaps = Gaps { fitting: Vec::new(), short: Vec::new(), narrow: Vec::new() };
    for line in &lines {
        for run in runs(line, (width - FITS) / 2.0, bite) {
            let path = path(&run.points);
            let length = path.as_ref().map_or(0.0, Path::length);
            match run.fits {
                Fits::Well if length > width / 2.0 => gaps.fitting.extend(path),
                Fits::Well => gaps.short.extend(path),
                _ => gaps.narrow.extend(narrow(field, line.pair, &run, length, path)),
            }
        }
    }
    gaps.narrow.sort_by(|a, b| a.width.total_cmp(&b.width));
    Ok(gaps)
}

/// Decides the fate of each gap: `others` are the paths of a cut of `width` mm that are made in any case. The answer is which
/// of the `short` paths down the middle of gaps where it just fits are to be cut. What is left uncut of a middle is either a gap
/// that is joined, or taken away by a cut that is made: so the next one is left out only where those that are certain take it.
pub(crate) fn decide(
    gaps: &mut [NarrowGap],
    short: Vec<Path>,
    others: &[Path],
    width: f64,
) -> Vec<Path> {
    if gaps.is_empty() && short.is_empty() {
        return short;
    }
    part(&mut *gaps, &Swept::new(others.iter(), width));
    let cut: Vec<Path> = cuts(gaps).cloned().collect();
    let swept = Swept::new(others.iter().chain(&cut), width);
    let needed: Vec<Path> = short.into_iter().filter(|path| !swept.covers(path)).collect();
    let joined = gaps.iter_mut().filter(|gap| gap.fate == Fate::Joined);
    match needed.is_empty() {
        true => part(joined, &swept),
        false => part(joined, &Swept::new(others.iter().chain(&cut).chain(&needed), width)),
    }
    needed
}

/// The gaps whose middle is taken away in any case are parted.
fn part<'g>(gaps: impl IntoIterator<Item = &'g mut NarrowGap>, swept: &Swept) {
    for gap in gaps {
        if gap.middle.as_ref().is_some_and(|middle| swept.covers(middle)) {
            gap.fate = Fate::Parted;
        }
    }
}

/// The paths down the middle of the gaps that are cut.
pub(crate) fn cuts(gaps: &[NarrowGap]) -> impl Iterator<Item = &Path> {
    gaps.iter().filter(|gap| gap.fate == Fate::Cut).filter_map(|gap| gap.middle.as_ref())
}

/// How a cut goes through a gap.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fits {
    /// Without touching copper.
    Well,
    /// It takes no more copper than it may.
    Tightly,
    Not,
}

/// Places of a line through which a cut goes alike.
struct Run {
    fits: Fits,
    points: Vec<LinePoint>,
}

/// The line, cut where the conductors are `least` mm away, and where as much copper is taken as may be.
fn runs(line: &Line, least: f64, bite: &Bite) -> Vec<Run> {
    let points = divided(&line.points, least, if bite.differs() { PIECE } else { f64::INFINITY });
    let may_cut: Vec<bool> =
        points.iter().map(|point| point.away < least && bite.may_cut(point.at)).collect();
    let mut runs: Vec<Run> = Vec::new();
    for (ends, may_cut) in points.windows(2).zip(may_cut.windows(2)) {
        let is_narrow = |point: &LinePoint| point.away < least;
        let fits = match ends.iter().any(is_narrow) {
            false => Fits::Well,
            // At the place where it begins to be narrow nothing is taken.
            true if ends.iter().zip(may_cut).all(|(end, may)| *may || !is_narrow(end)) => {
                Fits::Tightly
            }
            true => Fits::Not,
        };
        match runs.last_mut() {
            Some(run) if run.fits == fits => run.points.extend(ends.last()),
            _ => runs.push(Run { fits, points: ends.to_vec() }),
        }
    }
    match &points[..] {
        // Where the two touch there is no line.
        [touch] => vec![Run { fits: Fits::Not, points: vec![*touch] }],
        _ => worthwhile(runs, bite.width),
    }
}

/// The runs without cuts that only make the end of a place longer where two conductors stay joined: those that are shorter
/// than the cut is wide.
fn worthwhile(mut runs: Vec<Run>, width: f64) -> Vec<Run> {
    let fits: Vec<Fits> = runs.iter().map(|run| run.fits).collect();
    for (i, run) in runs.iter_mut().enumerate() {
        let length: f64 = run.points.windows(2).map(|ends| ends[0].at.distance(ends[1].at)).sum();
        let next = [i.checked_sub(1), i.checked_add(1)].into_iter().flatten();
        let is_next_to_joined = next.filter_map(|i| fits.get(i)).any(|fits| *fits == Fits::Not);
        if run.fits == Fits::Tightly && length < width && is_next_to_joined {
            run.fits = Fits::Not;
        }
    }
    let mut merged: Vec<Run> = Vec::with_capacity(runs.len());
    for run in runs {
        match merged.last_mut() {
            Some(last) if last.fits == run.fits => last.points.extend(run.points.iter().skip(1)),
            _ => merged.push(run),
        }
    }
    merged
}

/// The points of a line and those between them where the conductors are `least` mm away, and no farther than `most` mm from
/// each other where they are nearer.
fn divided(points: &[LinePoint], least: f64, most: f64) -> Vec<LinePoint> {
    let mut divided: Vec<LinePoint> = Vec::with_capacity(points.len());
    let between = |a: LinePoint, b: LinePoint, t: f64| LinePoint {
        at: a.at.lerp(b.at, t),
        away: a.away + (b.away - a.away) * t,
    };
    let mut add = |to: LinePoint| {
        if let Some(from) = divided.last().copied().filter(|from| from.away.min(to.away) < least) {
            let pieces = (from.at.distance(to.at) / most).ceil().max(1.0);
            divided.extend((1..pieces as usize).map(|i| between(from, to, i as f64 / pieces)));
        }
        divided.push(to);
    };
    let mut before: Option<LinePoint> = None;
    for &point in points {
        if let Some(before) = before.filter(|before| (before.away < least) != (point.away < least))
        {
            let t = (least - before.away) / (point.away - before.away);
            add(LinePoint { away: least, ..between(before, point, t) });
        }
        add(point);
        before = Some(point);
    }
    divided
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
    let is_cut = run.fits == Fits::Tightly && middle.is_some();
    let fate = if is_cut { Fate::Cut } else { Fate::Joined };
    Some(NarrowGap { at: least.at, islands, width: 2.0 * least.away, length, middle, fate })
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
