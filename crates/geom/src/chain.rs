//! Loose lines and arcs as chains, whatever their order and direction.

use crate::{Element, Vec2};
use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

/// Ends nearer to each other than this are one, mm: rounding of what files are written in.
const SAME: f64 = 1e-7;

/// How many ends are looked at for each end, and besides.
const LOOKS: (usize, usize) = (64, 1_000_000);

/// What pieces make when their ends are joined.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chains {
    /// The chains, in the order of their first pieces, which give the direction.
    pub chains: Vec<Chain>,
    /// How many pieces lay on another one and are in no chain.
    pub doubled: usize,
    /// The gaps that were bridged, each from end to end, mm.
    pub gaps: Vec<(Vec2, Vec2)>,
}

/// Pieces that follow each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chain {
    /// Index of each piece, in the order of travel, and whether it is travelled backwards.
    pub pieces: Vec<(usize, bool)>,
    /// Whether the end of the last one meets the start of the first.
    pub closed: bool,
}

/// Why there are no chains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ChainError {
    /// More than two ends meet.
    Branch {
        /// Where, mm.
        place: Vec2,
        /// Indices of two of the pieces.
        pieces: [usize; 2],
    },
    /// So many ends lie within the gap that is allowed that it takes too long to say which join.
    Tangled {
        /// Where, mm.
        place: Vec2,
        /// Index of one of the pieces.
        piece: usize,
    },
}

/// Chains `pieces`, each of which hangs together already, where their ends are no more than `gap` mm
/// apart; the nearest ends first. Pieces without length, and those that lie on an earlier one to
/// 0.1 µm, are left out.
///
/// # Errors
/// [`ChainError`]
pub fn chain<P: AsRef<[Element]>>(pieces: &[P], gap: f64) -> Result<Chains, ChainError> {
    let gap = gap.max(2.0 * SAME);
    let mut seen = HashSet::with_capacity(pieces.len());
    let (mut kept, mut doubled) = (Vec::with_capacity(pieces.len()), 0);
    for (index, piece) in pieces.iter().map(AsRef::as_ref).enumerate() {
        if piece.iter().any(|element| element.length() >= SAME) {
            match seen.insert(likeness(piece)) {
                true => kept.push(Piece::of(index, piece, gap)),
                false => doubled += 1,
            }
        }
    }
    let mut chains = Chains { chains: Vec::new(), doubled, gaps: Vec::new() };
    let mates = mated(&kept, gap, &mut chains.gaps)?;
    let mut used = vec![false; kept.len()];
    for first in 0..kept.len() {
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
        let mut chain = Chain { pieces: Vec::new(), closed: mates[enter].is_some() };
        loop {
            used[enter / 2] = true;
            chain.pieces.push((kept[enter / 2].index, enter % 2 == 1));
            match mates[enter ^ 1] {
                Some(next) if !used[next / 2] => enter = next,
                _ => break,
            }
        }
        chains.chains.push(chain);
    }
    Ok(chains)
}

/// A piece as chaining sees it.
struct Piece {
    index: usize,
    ends: [Vec2; 2],
    /// Whether it may close on itself: a short line does not.
    closes: bool,
}

impl Piece {
    fn of(index: usize, piece: &[Element], gap: f64) -> Piece {
        let arc = |element: &Element| element.turn.is_some_and(|turn| turn.sweep.abs() > PI);
        let length = || piece.iter().map(Element::length).sum::<f64>();
        let closes = piece.len() > 1 && length() > 4.0 * gap || piece.iter().any(arc);
        Piece { index, ends: outer(piece), closes }
    }
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
    let length = piece.iter().map(Element::length).sum::<f64>();
    let size = ((length * 1e3).round() as i64, piece.len() as i64);
    [start.min(end), start.max(end), cell(middle), size]
}

/// For each end (start and end of each piece in turn) the end that it joins.
type Mates = Vec<Option<usize>>;

fn mated(pieces: &[Piece], gap: f64, gaps: &mut Vec<(Vec2, Vec2)>) -> Result<Mates, ChainError> {
    let ends: Vec<Vec2> = pieces.iter().flat_map(|piece| piece.ends).collect();
    let cell = |p: Vec2| ((p.x / gap).floor() as i64, (p.y / gap).floor() as i64);
    let mut cells: HashMap<(i64, i64), Vec<usize>> = HashMap::with_capacity(ends.len());
    let closes = |i: usize| pieces[i / 2].closes;
    // What is closed by itself joins nothing, whatever touches it.
    let closed = |i: usize| ends[i].distance(ends[i ^ 1]) <= SAME && closes(i);
    let mut mates: Mates = (0..ends.len()).map(|i| closed(i).then_some(i ^ 1)).collect();
    for (i, end) in ends.iter().enumerate().filter(|(i, _)| mates[*i].is_none()) {
        cells.entry(cell(*end)).or_default().push(i);
    }
    let mut looks = 0;
    let most = ends.len().saturating_mul(LOOKS.0).saturating_add(LOOKS.1);
    let mut pairs = Vec::new();
    for (i, end) in ends.iter().enumerate().filter(|(i, _)| mates[*i].is_none()) {
        let (x, y) = cell(*end);
        let column = |x: i64, y: i64| (-1..=1).map(move |dy| (x, y.saturating_add(dy)));
        for place in (-1..=1).flat_map(|dx| column(x.saturating_add(dx), y)) {
            for &j in cells.get(&place).into_iter().flatten() {
                looks += 1;
                let apart = end.distance(ends[j]);
                if j > i && apart <= gap && (i ^ 1 != j || closes(i)) {
                    pairs.push((apart, i, j));
                }
            }
        }
        if looks > most {
            return Err(ChainError::Tangled { place: *end, piece: pieces[i / 2].index });
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    for &(apart, i, j) in &pairs {
        match (mates[i], mates[j]) {
            (None, None) => {
                (mates[i], mates[j]) = (Some(j), Some(i));
                if apart > SAME {
                    gaps.push((ends[i], ends[j]));
                }
            }
            // Ends that meet exactly and find no mate are those of a branch.
            _ if apart <= 10.0 * SAME => {
                let pieces = [i, j].map(|end| pieces[end / 2].index);
                return Err(ChainError::Branch { place: ends[i], pieces });
            }
            _ => {}
        }
    }
    Ok(mates)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(from: (f64, f64), to: (f64, f64)) -> [Element; 1] {
        [Element::line(Vec2::new(from.0, from.1), Vec2::new(to.0, to.1))]
    }

    #[test]
    fn a_triangle_whatever_the_order_and_direction() {
        let (a, b, c) = ((0.0, 0.0), (4.0, 0.0), (0.0, 3.0));
        let made = chain(&[line(a, b), line(a, c), line(c, b), line(b, a)], 0.01).unwrap();
        let triangle = Chain { pieces: vec![(0, false), (2, true), (1, true)], closed: true };
        assert_eq!(made, Chains { chains: vec![triangle], doubled: 1, gaps: Vec::new() });
    }

    #[test]
    fn a_gap_is_bridged_or_the_chain_is_open() {
        let pieces = [line((0.0, 0.0), (4.0, 0.0)), line((4.0, 0.05), (4.0, 3.0))];
        let made = chain(&pieces, 0.1).unwrap();
        assert_eq!(made.chains, [Chain { pieces: vec![(0, false), (1, false)], closed: false }]);
        assert_eq!(made.gaps, [(Vec2::new(4.0, 0.0), Vec2::new(4.0, 0.05))]);
        assert_eq!(chain(&pieces, 0.01).unwrap().chains.len(), 2);
    }

    #[test]
    fn three_ends_in_a_point_are_a_branch() {
        let from_corner = |x: f64, y: f64| line((0.0, 0.0), (x, y));
        let pieces = [from_corner(1.0, 0.0), from_corner(0.0, 1.0), from_corner(1.0, 1.0)];
        let found = chain(&pieces, 0.01).unwrap_err();
        assert!(matches!(found, ChainError::Branch { place: Vec2::ZERO, .. }), "{found:?}");
    }
}
