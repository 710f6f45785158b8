//! From a line to the moves that it makes.

/// After so many moves the caller is asked whether to go on.
const STRETCH: usize = 1 << 16;

/// How many bits of a line are ordered at a time.
const BITS: u32 = 11;

/// The moves of a column of lines, ordered by their lines and, within one, by themselves.
#[derive(Debug, Default)]
pub struct Index {
    /// The moves in that order, without those of line 0; none where the column is in that order itself, but for those of line 0 at its end.
    order: Option<Vec<u32>>,
    /// How many moves the column has up to the last one that is not of line 0.
    count: usize,
}

impl Index {
    /// Of a column, for as long as `goes_on` says so.
    pub fn of(lines: &[u32], goes_on: &dyn Fn() -> bool) -> Option<Index> {
        // The program goes home behind the last record.
        let count = lines.iter().rposition(|line| *line != 0).map_or(0, |last| last + 1);
        let lines = &lines[..count];
        let mut order = Vec::new();
        let (mut before, mut is_ascending, mut most) = (0, true, 0);
        for stretch in lines.chunks(STRETCH) {
            if !goes_on() {
                return None;
            }
            is_ascending = is_ascending
                && stretch.first().is_none_or(|first| before <= *first)
                && stretch.is_sorted();
            before = stretch.last().copied().unwrap_or(before);
            most = stretch.iter().fold(most, |most, line| most.max(*line));
        }
        if is_ascending {
            return Some(Index { order: None, count });
        }
        order.extend((0..lines.len() as u32).filter(|at| lines[*at as usize] != 0));
        // Bits by bits from the lowest on: each pass keeps the order of the one before (radix sort).
        let mut shift = 0;
        while shift < u32::BITS && most >> shift > 0 {
            order = ordered(lines, &order, shift, goes_on)?;
            shift += BITS;
        }
        Some(Index { order: Some(order), count })
    }

    /// The lines from `line` on that make moves, in their order, each with the move: a line that makes several, several times.
    pub fn from<'a>(
        &'a self,
        lines: &'a [u32],
        line: u32,
    ) -> impl Iterator<Item = (u32, u32)> + 'a {
        let order = self.order.as_deref();
        let lines = &lines[..self.count];
        let first = match order {
            Some(order) => order.partition_point(|at| lines[*at as usize] < line),
            None => lines.partition_point(|own| *own < line),
        };
        let count = order.map_or(self.count, <[u32]>::len);
        (first..count).map(move |place| {
            let at = order.map_or(place as u32, |order| order[place]);
            (lines[at as usize], at)
        })
    }

    /// How much memory it takes, bytes.
    pub fn bytes(&self) -> usize {
        self.order.as_ref().map_or(0, |order| order.len() * size_of::<u32>())
    }
}

/// Moves ordered by some bits of their lines.
fn ordered(
    lines: &[u32],
    moves: &[u32],
    shift: u32,
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<u32>> {
    let digit = |at: u32| (lines[at as usize] >> shift) as usize & ((1 << BITS) - 1);
    let mut places = [0; 1 << BITS];
    for stretch in moves.chunks(STRETCH) {
        if !goes_on() {
            return None;
        }
        stretch.iter().for_each(|at| places[digit(*at)] += 1);
    }
    let mut sum = 0;
    for place in &mut places {
        (*place, sum) = (sum, sum + *place);
    }
    let mut ordered = vec![0; moves.len()];
    for stretch in moves.chunks(STRETCH) {
        if !goes_on() {
            return None;
        }
        for at in stretch {
            let place = &mut places[digit(*at)];
            ordered[*place] = *at;
            *place += 1;
        }
    }
    Some(ordered)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    fn of(lines: &[u32]) -> Index {
        Index::of(lines, &|| true).unwrap()
    }

    #[test]
    fn moves_are_ordered_by_their_lines_and_then_by_themselves() {
        // Far apart, so that each pass has something to order.
        let lines = [7, 0, 5_000_000, 7, 3000, 1, 0, 3000, u32::MAX, 7];
        let index = of(&lines);
        let all: Vec<_> = index.from(&lines, 1).collect();
        let expected =
            [(1, 5), (7, 0), (7, 3), (7, 9), (3000, 4), (3000, 7), (5_000_000, 2), (u32::MAX, 8)];
        assert_eq!(all, expected);
        assert_eq!(index.from(&lines, 8).next(), Some((3000, 4)));
        assert_eq!(index.bytes(), 8 * 4);
    }

    #[test]
    fn a_column_that_goes_up_takes_no_memory() {
        let lines = [0, 0, 2, 2, 9, 0, 0];
        let index = of(&lines);
        assert_eq!(index.bytes(), 0);
        assert_eq!(index.from(&lines, 1).count(), 3);
        assert_eq!(index.from(&lines, 2).collect::<Vec<_>>(), [(2, 2), (2, 3), (9, 4)]);
        assert_eq!(index.from(&lines, 10).next(), None);
        assert_eq!(of(&[]).from(&[], 1).next(), None);
    }

    #[test]
    fn it_ends_within_each_step_when_it_shall() {
        let lines: Vec<u32> = (0..300_000).rev().collect();
        let asked = Cell::new(0);
        let count = |most: u32| {
            asked.set(0);
            Index::of(&lines, &|| {
                asked.set(asked.get() + 1);
                asked.get() <= most
            })
        };
        assert!(count(u32::MAX).is_some());
        // Looked through once, and counted and ordered for each of two groups of bits, in five stretches.
        assert_eq!(asked.get(), 25);
        for most in 0..25 {
            assert!(count(most).is_none(), "{most}");
        }
    }
}
