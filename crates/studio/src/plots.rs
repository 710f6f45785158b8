//! Axes, feed and deviation over time: the least and the most value of each pixel.

use crate::walk::Walk;
use program::Feed;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// The most pixels of a plot.
pub const MOST_PIXELS: u32 = 10_000;

/// So many moves are looked at as one where all of them are within a pixel.
const BLOCK: u32 = 256;

/// What is plotted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum What {
    /// The axis at this place.
    Axis(usize),
    /// The feed, mm/min.
    Feed,
    /// How far the tip is off the source, mm.
    Deviation,
}

impl What {
    /// Its values at the begin and at the end of a move; NaN where they are not known.
    fn ends(self, walk: &Walk, at: u32) -> [f64; 2] {
        match self {
            What::Axis(axis) => {
                let position = |at: u32| walk.positions(at).get(axis).copied().unwrap_or(f64::NAN);
                [at.checked_sub(1).map_or(f64::NAN, position), position(at)]
            }
            What::Feed => match walk.feed(at) {
                Some(Feed::PerMinute(feed)) => [feed; 2],
                Some(Feed::PerTurn(_) | Feed::InverseTime(_)) | None => [f64::NAN; 2],
            },
            What::Deviation => [f64::from(walk.deviation(at)); 2],
        }
    }
}

/// Least and most value.
type Extent = [f32; 2];

/// Widens an extent by a value; `min` and `max` leave NaN out.
fn widen(extent: &mut Extent, value: f32) {
    *extent = [extent[0].min(value), extent[1].max(value)];
}

/// The plots of a walk. What was plotted once is plotted again in a time that grows with the pixels, not with the moves.
#[derive(Debug, Default)]
pub struct Plots {
    /// The extents of blocks of moves.
    blocks: Mutex<BTreeMap<What, Arc<[Extent]>>>,
}

impl Plots {
    fn blocks(&self, walk: &Walk, what: What) -> Arc<[Extent]> {
        let mut blocks = self.blocks.lock().unwrap_or_else(PoisonError::into_inner);
        let of = |block: u32| {
            let mut extent = [f32::NAN; 2];
            let values = moves(walk, block).flat_map(|at| what.ends(walk, at));
            values.for_each(|value| widen(&mut extent, value as f32));
            extent
        };
        let made = || (0..walk.len().div_ceil(BLOCK)).map(of).collect();
        Arc::clone(blocks.entry(what).or_insert_with(made))
    }

    /// Least and most value of each of `pixels` equal parts of the time from `from` to `to`, s; NaN where nothing is known. An axis goes
    /// evenly within a move.
    pub fn plot(
        &self,
        walk: &Walk,
        what: What,
        [from, to]: [f64; 2],
        pixels: u32,
    ) -> [Vec<f32>; 2] {
        let pixels = pixels.clamp(1, MOST_PIXELS) as usize;
        let mut extents = vec![[f32::NAN; 2]; pixels];
        let width = (to - from) / pixels as f64;
        let is_good = from.is_finite() && to.is_finite() && width > 0.0;
        if let Some(first) = walk.at_time(from).filter(|_| is_good) {
            let blocks = self.blocks(walk, what);
            let pixel = |time: f64| (((time - from) / width).max(0.0) as usize).min(pixels - 1);
            for (block, extent) in (0..).zip(&*blocks).skip((first / BLOCK) as usize) {
                let moves = moves(walk, block);
                let (begin, end) = (walk.end_before(moves.start), walk.end_before(moves.end));
                if begin > to {
                    break;
                }
                if begin >= from && end <= to && pixel(begin) == pixel(end) {
                    extent.iter().for_each(|value| widen(&mut extents[pixel(begin)], *value));
                    continue;
                }
                for at in moves.filter(|at| *at >= first) {
                    let (begin, end) = (walk.end_before(at), walk.end(at));
                    if begin > to {
                        break;
                    }
                    let moving = begin + walk.waited(at);
                    let [start, last] = what.ends(walk, at);
                    let value = |time: f64| {
                        let takes = end - moving;
                        let part = if takes > 0.0 {
                            ((time - moving) / takes).clamp(0.0, 1.0)
                        } else {
                            1.0
                        };
                        if part >= 1.0 { last } else { start + (last - start) * part }
                    };
                    // The value at both ends of the move, and wherever it goes from a pixel into the next.
                    let (a, b) = (begin.max(from), end.min(to));
                    let touched = pixel(a)..=pixel(b);
                    for (touched, extent) in touched.clone().zip(&mut extents[touched]) {
                        let left = (from + touched as f64 * width).max(a);
                        let right = (from + (touched + 1) as f64 * width).min(b);
                        for time in [left, moving.clamp(left, right.max(left)), right.max(left)] {
                            widen(extent, value(time) as f32);
                        }
                    }
                }
            }
        }
        [0, 1].map(|end| extents.iter().map(|extent| extent[end]).collect())
    }
}

/// The moves of a block.
fn moves(walk: &Walk, block: u32) -> Range<u32> {
    let first = block * BLOCK;
    first..(first + BLOCK).min(walk.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tests::walk;
    use geom::Vec3;
    use proof::MotionKind;

    /// A move a second, a millimetre each, up to 1,500 and back: what X is at a time is known, whatever is looked at as one.
    #[test]
    fn each_pixel_has_the_least_and_the_most_of_its_time() {
        let x = |time: f64| if time < 1500.0 { time } else { 3000.0 - time };
        let tip = |end: i32| (MotionKind::Line, Vec3::new(x(f64::from(end)), 0.0, 0.0));
        let walk = walk((1..=3000).map(tip));
        let plots = Plots::default();
        for (from, to, pixels) in
            [(1.0, 3000.0, 1), (1.5, 2999.25, 7), (10.0, 40.0, 90), (700.0, 2900.0, 3)]
        {
            let [least, most] = plots.plot(&walk, What::Axis(0), [from, to], pixels);
            let width = (to - from) / f64::from(pixels);
            for pixel in 0..pixels {
                let begin = from + f64::from(pixel) * width;
                let ends = [x(begin), x(begin + width)];
                let top = if (begin..begin + width).contains(&1500.0) {
                    1500.0
                } else {
                    ends[0].max(ends[1])
                };
                let found = [least[pixel as usize], most[pixel as usize]].map(f64::from);
                let expected = [ends[0].min(ends[1]), top];
                let off = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
                assert!(off < 1e-3, "{from} {to} {pixel}: {found:?} {expected:?}");
            }
        }
        let [least, most] = plots.plot(&walk, What::Feed, [0.0, 9.0], 2);
        assert!(least.iter().chain(&most).all(|value| value.is_nan()));
    }
}
