//! Which point of the upper contour belongs to which of the lower one.

use crate::contour::Contour;
use crate::path::Path;
use geom::{Vec2, turn_angle};
use program::{Diagnostic, Rule};
use sketch::{Element, SAME, finite};
use std::f64::consts::PI;

/// How far a given point may lie off its contour, mm.
const ON: f64 = 0.01;

/// Points closer than this are one, mm: a corner that both contours have is not cut twice, though each
/// is rounded by itself.
const SAME_POINT: f64 = 1e-3;

impl Path {
    /// Move by move, as blocks with `X Y U V` and pairs of programs written block for block are. A
    /// move without length is the end of the wire that stands still.
    ///
    /// # Errors
    /// `sync-blocks` where one end has more moves than the other; `wires-cross`; those of
    /// [`Contour::new`].
    pub fn by_block(lower: Vec<Element>, upper: Vec<Element>) -> Result<Path, Box<Diagnostic>> {
        let (n, m) = (lower.len(), upper.len());
        if n != m {
            let side = if n > m { &lower } else { &upper };
            let line = side.get(n.min(m)).map_or(0, |element| element.line);
            let message = format!("the lower contour has {n} moves and the upper {m}");
            return Err(Diagnostic::error(Rule::SyncBlocks, message)
                .help("synchronise them by arc length (--sync length) or by given points (--pair)")
                .line(line)
                .into());
        }
        for element in lower.iter().chain(&upper) {
            finite(&[element.start, element.end]).map_err(|d| d.line(element.line))?;
        }
        let moves = lower.into_iter().zip(upper);
        let (lower, upper) = moves.filter(|(p, q)| p.length() + q.length() >= SAME).unzip();
        let path = Path::leaning(Contour::joined(lower, SAME)?, Contour::joined(upper, SAME)?);
        uncrossed(&path)?;
        Ok(path)
    }

    /// By arc length: at every time both ends have covered the same part of their contours. Elements
    /// are divided where the other contour has a corner.
    ///
    /// # Errors
    /// `wires-cross`; `sync-closed` where one contour is closed and the other open.
    pub fn by_length(lower: &Contour, upper: &Contour) -> Result<Path, Box<Diagnostic>> {
        Path::by_points(lower, upper, &[])
    }

    /// By given points, in the order of travel: at each pair (lower, upper) the wire stands in both;
    /// between them, by arc length.
    ///
    /// # Errors
    /// `sync-point` where a point is not on its contour or not after the one before; and those of
    /// [`Path::by_length`].
    pub fn by_points(
        lower: &Contour,
        upper: &Contour,
        points: &[(Vec2, Vec2)],
    ) -> Result<Path, Box<Diagnostic>> {
        if lower.is_closed() != upper.is_closed() {
            let message = "of the lower and the upper contour one is closed and the other open";
            return Err(Diagnostic::error(Rule::SyncClosed, message).help("close both").into());
        }
        let (below, above) = (ArcLength::new(lower), ArcLength::new(upper));
        let mut held = vec![(0.0, 0.0)];
        for &(p, q) in points {
            let (s, t) = held.last().copied().unwrap_or_default();
            held.push((below.find(p, s, "lower")?, above.find(q, t, "upper")?));
        }
        held.push((below.total(), above.total()));
        let mut pairs = vec![(0.0, 0.0)];
        for span in held.windows(2) {
            between(&below, &above, span[0], span[1], &mut pairs);
        }
        let (mut low, mut high) = (Vec::new(), Vec::new());
        for pair in pairs.windows(2) {
            low.push(below.part(pair[0].0, pair[1].0));
            high.push(above.part(pair[0].1, pair[1].1));
        }
        // Points fall on corners by rounding only.
        let gap = 10.0 * SAME_POINT;
        let path = Path::leaning(Contour::joined(low, gap)?, Contour::joined(high, gap)?);
        uncrossed(&path)?;
        Ok(path)
    }
}

/// Positions on a contour by the length along it.
struct ArcLength<'a> {
    contour: &'a Contour,
    /// Length from the start to the end of each element, mm.
    ends: Vec<f64>,
}

impl<'a> ArcLength<'a> {
    fn new(contour: &'a Contour) -> ArcLength<'a> {
        let ends = contour.elements().iter().scan(0.0, |sum, element| {
            *sum += element.length();
            Some(*sum)
        });
        ArcLength { contour, ends: ends.collect() }
    }

    fn total(&self) -> f64 {
        self.ends.last().copied().unwrap_or(0.0)
    }

    /// How far along the contour `point` lies, not before `from`.
    fn find(&self, point: Vec2, from: f64, side: &str) -> Result<f64, Box<Diagnostic>> {
        let mut best: Option<(f64, f64)> = None;
        for (element, end) in self.contour.elements().iter().zip(&self.ends) {
            let (t, distance) = element.nearest(point);
            let along = end - element.length() * (1.0 - t);
            let nearer = best.is_none_or(|(_, least)| distance < least - SAME);
            if distance <= ON && along >= from - ON && nearer {
                best = Some((along.max(from), distance));
            }
        }
        best.map(|(along, _)| along).ok_or_else(|| {
            let message = format!(
                "X{:.4} Y{:.4} is not on the {side} contour after the point before it",
                point.x, point.y
            );
            Diagnostic::error(Rule::SyncPoint, message)
                .help(format!("give points of the contour, within {ON} mm, in the order of travel"))
                .into()
        })
    }

    /// The corners between `from` and `to`, as fractions of the length between them.
    fn corners(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + '_ {
        let first = self.ends.partition_point(|end| *end <= from + SAME_POINT);
        let inner = self.ends.iter().skip(first).take_while(move |end| **end < to - SAME_POINT);
        inner.map(move |end| (end - from) / (to - from))
    }

    /// The elements from `from` to `to`, between which there is no corner.
    fn part(&self, from: f64, to: f64) -> Element {
        let middle = f64::midpoint(from, to);
        let i = self.ends.partition_point(|end| *end < middle).min(self.ends.len() - 1);
        let element = &self.contour.elements()[i];
        let length = element.length();
        let start = self.ends[i] - length;
        let parameter = |along: f64| {
            if along - start < 2.0 * SAME_POINT {
                0.0
            } else if self.ends[i] - along < 2.0 * SAME_POINT {
                1.0
            } else {
                (along - start) / length
            }
        };
        let (first, last) = (parameter(from), parameter(to));
        if to - from < SAME || first >= last {
            let point = element.at(parameter(middle));
            return Element::line(point, point).from_line(element.line);
        }
        element.part(first, last)
    }
}

/// Adds the pairs of points of one span, as lengths along both contours: the corners of both contours, each once, and the end of the span.
fn between(
    below: &ArcLength,
    above: &ArcLength,
    from: (f64, f64),
    to: (f64, f64),
    pairs: &mut Vec<(f64, f64)>,
) {
    let (low, high) = (to.0 - from.0, to.1 - from.1);
    let mut parts: Vec<f64> =
        below.corners(from.0, to.0).chain(above.corners(from.1, to.1)).collect();
    parts.sort_by(f64::total_cmp);
    let longer = low.max(high);
    let mut last = 0.0;
    for part in parts {
        if (part - last) * longer > SAME_POINT && (1.0 - part) * longer > SAME_POINT {
            pairs.push((from.0 + part * low, from.1 + part * high));
            last = part;
        }
    }
    if longer >= SAME {
        pairs.push(to);
    }
}

/// Refuses wires that cross. Two neighbouring wires meet where the ends move straight against each
/// other, for then the wire stands still at some height between them. So the angle from the travel of
/// the lower end to that of the upper, followed along the path and round its corners, must stay below
/// half a turn.
fn uncrossed(path: &Path) -> Result<(), Box<Diagnostic>> {
    let mut travel = (Vec2::ZERO, Vec2::ZERO);
    let mut apart = 0.0;
    for (below, above) in path.elements() {
        let headings = [0.0, 1.0].map(|t| (heading(below, t), heading(above, t)));
        let [start, end] = headings.map(|(p, q)| (known(p, travel.0), known(q, travel.1)));
        // Both ends go round a corner at the same time, each by the smaller angle.
        apart += match travel {
            (Vec2::ZERO, _) | (_, Vec2::ZERO) => turn_angle(start.0, start.1),
            (p, q) => turn_angle(q, start.1) - turn_angle(p, start.0),
        };
        let sweep = |element: &Element| element.turn.map_or(0.0, |turn| turn.sweep);
        for (turned, t) in [(0.0, 0.0), (sweep(above) - sweep(below), 1.0)] {
            apart += turned;
            if f64::abs(apart) > PI - 1e-6 {
                let (p, q) = (below.at(t), above.at(t));
                let message = format!(
                    "the wires cross: at X{:.4} Y{:.4} below and X{:.4} Y{:.4} above the ends move \
                     against each other",
                    p.x, p.y, q.x, q.y
                );
                let way_out = "let both contours run the same way round from the same side, or give \
                               points that belong together";
                return Err(Diagnostic::error(Rule::WiresCross, message)
                    .help(way_out)
                    .line(below.line)
                    .into());
            }
        }
        travel = end;
    }
    Ok(())
}

/// Travel at `t`; none where the end stands still.
fn heading(element: &Element, t: f64) -> Vec2 {
    if element.length() < SAME { Vec2::ZERO } else { element.tangent(t) }
}

fn known(now: Vec2, before: Vec2) -> Vec2 {
    if now == Vec2::ZERO { before } else { now }
}
