//! Loose elements as contours, whatever their order and direction.

use crate::contour::Contour;
use crate::element::{Element, SAME};
use geom::Vec2;
use program::Diagnostic;
use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

/// How many ends are looked at for each end, and besides.
const LOOKS: (usize, usize) = (64, 1_000_000);

/// What chaining made.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Chained {
    /// The contours, in the order of their first pieces, which give the direction.
    pub contours: Vec<Contour>,
    /// How many pieces lay on another one and fell away.
    pub doubled: usize,
    /// How many gaps were closed.
    pub gaps: usize,
    /// The widest of them, mm.
    pub widest: f64,
}

/// Chains `pieces`, each of which hangs together already, where their ends are no more than `gap` mm
/// apart; the nearest ends first.
///
/// # Errors
/// `branch` where more than two ends meet; `too-tangled` where too many ends lie within `gap`; those
/// of [`Contour::new`].
pub(crate) fn chain(mut pieces: Vec<Vec<Element>>, gap: f64) -> Result<Chained, Box<Diagnostic>> {
    let gap = gap.max(2.0 * SAME);
    pieces.retain(|piece| piece.iter().any(|element| element.length() >= SAME));
    let all = pieces.len();
    let mut seen = HashSet::with_capacity(all);
    pieces.retain(|piece| seen.insert(likeness(piece)));
    let doubled = all - pieces.len();
    let ends: Vec<Vec2> = pieces.iter().flat_map(|piece| outer(piece)).collect();
    let (mates, gaps, widest) = mated(&pieces, &ends, gap)?;
    let mut contours = Vec::new();
    let mut used = vec![false; pieces.len()];
    for first in 0..pieces.len() {
        if used[first] {
            continue;
        }
        // Back to where the chain begins, or round to this piece again.
        let mut enter = 2 * first;
        while let Some(before) = mates[enter] {
            enter = before ^ 1;
            if enter == 2 * first {
                break;
            }
        }
        let mut elements = Vec::new();
        loop {
            let piece = &pieces[enter / 2];
            used[enter / 2] = true;
            match enter % 2 {
                0 => elements.extend(piece.iter().copied()),
                _ => elements.extend(piece.iter().rev().map(Element::reversed)),
            }
            match mates[enter ^ 1] {
                Some(next) if !used[next / 2] => enter = next,
                _ => break,
            }
        }
        contours.push(Contour::new(elements, gap)?);
    }
    Ok(Chained { contours, doubled, gaps, widest })
}

/// First and last point.
fn outer(piece: &[Element]) -> [Vec2; 2] {
    let start = piece.first().map_or(Vec2::ZERO, |element| element.start);
    [start, piece.last().map_or(start, |element| element.end)]
}

/// Equal for pieces that lie on each other, also against each other, by tenths of a micrometre.
fn likeness(piece: &[Element]) -> [(i64, i64); 4] {
    let cell = |p: Vec2| ((p.x * 1e4).round() as i64, (p.y * 1e4).round() as i64);
    let [start, end] = outer(piece).map(cell);
    let middle = piece.get(piece.len() / 2).map_or(Vec2::ZERO, |element| match piece.len() % 2 {
        0 => element.start,
        _ => element.at(0.5),
    });
    let length = piece.iter().map(|element| element.length()).sum::<f64>();
    let size = ((length * 1e3).round() as i64, piece.len() as i64);
    [start.min(end), start.max(end), cell(middle), size]
}

/// For each end (start and end of each piece in turn) the end that it joins.
type Mates = Vec<Option<usize>>;

fn mated(
    pieces: &[Vec<Element>],
    ends: &[Vec2],
    gap: f64,
) -> Result<(Mates, usize, f64), Box<Diagnostic>> {
    let cell = |p: Vec2| ((p.x / gap).floor() as i64, (p.y / gap).floor() as i64);
    let mut cells: HashMap<(i64, i64), Vec<usize>> = HashMap::with_capacity(ends.len());
    // A short line does not close on itself.
    let closes = |i: usize| {
        let piece = &pieces[i / 2];
        let arc = |element: &Element| element.turn.is_some_and(|turn| turn.sweep.abs() > PI);
        piece.len() > 1 && piece.iter().map(|element| element.length()).sum::<f64>() > 4.0 * gap
            || piece.iter().any(arc)
    };
    // What is closed by itself joins nothing, whatever touches it.
    let closed = |i: usize| ends[i].distance(ends[i ^ 1]) <= SAME && closes(i);
    let mut mates: Mates = (0..ends.len()).map(|i| closed(i).then_some(i ^ 1)).collect();
    for (i, end) in ends.iter().enumerate().filter(|(i, _)| mates[*i].is_none()) {
        cells.entry(cell(*end)).or_default().push(i);
    }
    let line = |end: usize| pieces[end / 2].first().map_or(0, |element| element.line);
    let mut looks = 0;
    let most = ends.len().saturating_mul(LOOKS.0).saturating_add(LOOKS.1);
    let mut pairs = Vec::new();
    for (i, end) in ends.iter().enumerate().filter(|(i, _)| mates[*i].is_none()) {
        let (x, y) = cell(*end);
        for place in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x + dx, y + dy))) {
            for &j in cells.get(&place).into_iter().flatten() {
                looks += 1;
                let apart = end.distance(ends[j]);
                if j > i && apart <= gap && (i ^ 1 != j || closes(i)) {
                    pairs.push((apart, i, j));
                }
            }
        }
        if looks > most {
            let message =
                format!("very many ends lie within {gap} mm of X{:.4} Y{:.4}", end.x, end.y);
            return Err(Diagnostic::error("too-tangled", message)
                .help("allow smaller gaps, or choose layers")
                .line(line(i))
                .into());
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let (mut gaps, mut widest) = (0, 0.0);
    for &(apart, i, j) in &pairs {
        match (mates[i], mates[j]) {
            (None, None) => {
                (mates[i], mates[j]) = (Some(j), Some(i));
                if apart > SAME {
                    gaps += 1;
                    widest = f64::max(widest, apart);
                }
            }
            // Ends that meet exactly and find no mate are those of a branch.
            _ if apart <= 10.0 * SAME => {
                let place = ends[i];
                let message = format!(
                    "more than two ends meet at X{:.4} Y{:.4}: lines {} and {} are two of them",
                    place.x,
                    place.y,
                    line(i),
                    line(j)
                );
                return Err(Diagnostic::error("branch", message)
                    .help("a contour has no branches: choose layers, or take out what is too much")
                    .line(line(j))
                    .into());
            }
            _ => {}
        }
    }
    Ok((mates, gaps, widest))
}
