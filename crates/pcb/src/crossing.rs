//! Where contours cross themselves, or each other.
//!
//! Found is where two pieces cross in their middle. Contours that touch, as cut-ins do, are none of
//! these, and neither are those that pass through a corner.

use crate::report::{Outcome, fault};
use geom::{Element, Vec2};
use program::Rule;

/// How far a chord may leave its arc, mm.
const CHORD: f64 = 0.0005;

/// So many chords are more than those of any layer, in addition to four for each element.
const CHORDS: usize = 2_000_000;

/// So many pairs of chords are looked at for each chord before the contour is given up.
const PAIRS: usize = 200;

/// Where two of `elements` cross each other by more than `tolerance`, if they do.
///
/// # Errors
/// `region-too-complex` where so much lies above each other that this takes too long to say.
pub(crate) fn self_crossing(elements: &[Element], tolerance: f64) -> Outcome<Option<Vec2>> {
    let mut chords: Vec<(Vec2, Vec2)> = Vec::with_capacity(elements.len());
    for element in elements {
        match element.turn {
            None => chords.push((element.start, element.end)),
            Some(turn) => {
                let from = element.start - turn.center;
                let step = 2.0 * (1.0 - CHORD / from.length().max(2.0 * CHORD)).acos();
                let count = (turn.sweep.abs() / step).ceil().clamp(1.0, 1000.0) as u32;
                let point = |i: u32| {
                    let angle = turn.sweep * f64::from(i) / f64::from(count);
                    turn.center + Vec2::from_angle(angle).rotate(from)
                };
                let inner = (1..count).map(point);
                let mut last = element.start;
                for next in inner.chain([element.end]) {
                    chords.push((last, next));
                    last = next;
                }
                if chords.len() > CHORDS + 4 * elements.len() {
                    return Err(too_complex());
                }
            }
        }
    }
    let Some(grid) = Grid::over(&chords) else { return Ok(None) };
    let cells = grid.filled(&chords)?;
    let mut pairs = PAIRS * chords.len() + 100_000;
    for run in cells.chunk_by(|a, b| a.0 == b.0) {
        for (i, (_, a)) in run.iter().enumerate() {
            for (_, b) in &run[i + 1..] {
                pairs = pairs.checked_sub(1).ok_or_else(too_complex)?;
                let (Some(a), Some(b)) = (chords.get(*a as usize), chords.get(*b as usize)) else {
                    continue;
                };
                if let Some(place) = crossing(*a, *b, tolerance) {
                    return Ok(Some(place));
                }
            }
        }
    }
    Ok(None)
}

#[cold]
fn too_complex() -> crate::report::Fault {
    let help = "divide it into several regions";
    fault(Rule::RegionTooComplex, "this contour is too tangled to be looked through", help)
}

/// Where two lines cross, each end of each being more than `tolerance` off the other.
fn crossing(a: (Vec2, Vec2), b: (Vec2, Vec2), tolerance: f64) -> Option<Vec2> {
    let (along, other) = (a.1 - a.0, b.1 - b.0);
    let apart = |p: Vec2, from: Vec2, along: Vec2| along.perp_dot(p - from) / along.length();
    let (c, d) = (apart(b.0, a.0, along), apart(b.1, a.0, along));
    let (e, f) = (apart(a.0, b.0, other), apart(a.1, b.0, other));
    let crosses = |p: f64, q: f64| p.min(q) < -tolerance && p.max(q) > tolerance;
    (crosses(c, d) && crosses(e, f)).then(|| b.0 + other * (c / (c - d)))
}

/// Squares over a contour, about as many as it has chords.
struct Grid {
    low: Vec2,
    size: f64,
    columns: f64,
}

impl Grid {
    fn over(chords: &[(Vec2, Vec2)]) -> Option<Grid> {
        let points = chords.iter().flat_map(|(a, b)| [*a, *b]);
        let (low, high) = points.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let span = (high - low).max_element().max(1e-6);
        let columns = (chords.len() as f64).sqrt().ceil().clamp(1.0, 1000.0);
        Some(Grid { low, size: span / columns * 1.000_001, columns })
    }

    /// The cells that each chord runs through, sorted by cell.
    fn filled(&self, chords: &[(Vec2, Vec2)]) -> Outcome<Vec<(u32, u32)>> {
        let mut cells = Vec::with_capacity(2 * chords.len());
        let most = 20 * chords.len() + 1_000_000;
        let cell = |value: f64| (value / self.size).floor().clamp(0.0, self.columns - 1.0);
        for (index, (a, b)) in (0u32..).zip(chords) {
            let (a, b) = (*a - self.low, *b - self.low);
            let (low, high) = (a.min(b), a.max(b));
            let mut row = cell(low.y);
            while row <= cell(high.y) {
                // The part of the chord within this row.
                let (from, to) = match (b.y - a.y).abs() > self.size {
                    true => {
                        let at = |y: f64| {
                            let t = ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
                            a.x + (b.x - a.x) * t
                        };
                        let (p, q) = (at(row * self.size), at((row + 1.0) * self.size));
                        (cell(p.min(q) - self.size * 1e-6), cell(p.max(q) + self.size * 1e-6))
                    }
                    false => (cell(low.x), cell(high.x)),
                };
                let mut column = from;
                while column <= to {
                    cells.push(((row * self.columns + column) as u32, index));
                    column += 1.0;
                }
                if cells.len() > most {
                    return Err(too_complex());
                }
                row += 1.0;
            }
        }
        cells.sort_unstable();
        Ok(cells)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Contour;

    fn crosses(corners: &[(f64, f64)]) -> bool {
        let corners: Vec<Vec2> = corners.iter().map(|(x, y)| Vec2::new(*x, *y)).collect();
        self_crossing(Contour::polygon(&corners).elements(), 1e-3).unwrap().is_some()
    }

    #[test]
    fn an_eight_crosses_itself_and_cut_ins_do_not() {
        assert!(crosses(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]));
        assert!(!crosses(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]));
        // A square hole joined to a square by two coincident lines.
        assert!(!crosses(&[
            (0.0, 0.0),
            (9.0, 0.0),
            (9.0, 9.0),
            (0.0, 9.0),
            (0.0, 3.0),
            (3.0, 3.0),
            (3.0, 6.0),
            (6.0, 6.0),
            (6.0, 3.0),
            (3.0, 3.0),
            (0.0, 3.0),
        ]));
        // Less than a micrometre is rounding.
        assert!(!crosses(&[(0.0, 0.0), (2.0, 0.0), (2.0, -0.0005), (1.0, 0.0005), (0.0, 1.0)]));
    }

    #[test]
    fn a_crossing_is_found_among_many_corners() {
        let wheel =
            |i: u32| Vec2::from_angle(f64::from(i) / 2000.0 * 6.2) * (50.0 + f64::from(i % 2));
        let mut corners: Vec<Vec2> = (0..2000).map(wheel).collect();
        assert_eq!(self_crossing(Contour::polygon(&corners).elements(), 1e-3).unwrap(), None);
        corners.swap(700, 740);
        let found = self_crossing(Contour::polygon(&corners).elements(), 1e-3).unwrap().unwrap();
        assert!(found.distance(wheel(720)) < 5.0);
    }
}
