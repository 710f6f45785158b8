//! Axes and feed over time: the least and the most value of each pixel.

use crate::walk::Walk;
use program::Feed;

/// The most pixels of a plot.
pub const MOST_PIXELS: u32 = 10_000;

/// What is plotted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// The axis at this place.
    Axis(usize),
    /// The feed, mm/min.
    Feed,
}

/// Least and most value of each of `pixels` equal parts of the time from `from` to `to`, s; NaN where nothing is known. An axis goes evenly
/// within a move.
pub fn plot(walk: &Walk, what: What, [from, to]: [f64; 2], pixels: u32) -> [Vec<f32>; 2] {
    let pixels = pixels.clamp(1, MOST_PIXELS) as usize;
    let (mut least, mut most) = (vec![f32::NAN; pixels], vec![f32::NAN; pixels]);
    let width = (to - from) / pixels as f64;
    let is_good = from.is_finite() && to.is_finite() && width > 0.0;
    let Some(first) = walk.at_time(from).filter(|_| is_good) else { return [least, most] };
    let pixel = |time: f64| (((time - from) / width).max(0.0) as usize).min(pixels - 1);
    let mut widen = |pixel: usize, value: f64| {
        let value = value as f32;
        // `min` and `max` leave NaN out.
        least[pixel] = least[pixel].min(value);
        most[pixel] = most[pixel].max(value);
    };
    for at in first..walk.len() {
        let (end, begin) = (walk.end(at), walk.end_before(at));
        if begin > to {
            break;
        }
        let moving = begin + walk.waited(at);
        let (start, last) = match what {
            What::Axis(axis) => {
                let position = |at: u32| walk.positions(at).get(axis).copied().unwrap_or(f64::NAN);
                (at.checked_sub(1).map_or(f64::NAN, position), position(at))
            }
            What::Feed => match walk.feed(at) {
                Some(Feed::PerMinute(feed)) => (feed, feed),
                Some(Feed::PerTurn(_) | Feed::InverseTime(_)) | None => (f64::NAN, f64::NAN),
            },
        };
        let value = |time: f64| {
            let part =
                if end > moving { ((time - moving) / (end - moving)).clamp(0.0, 1.0) } else { 1.0 };
            if part >= 1.0 { last } else { start + (last - start) * part }
        };
        // The value at both ends of the move, and wherever it goes from a pixel into the next.
        let (a, b) = (begin.max(from), end.min(to));
        for touched in pixel(a)..=pixel(b) {
            let left = (from + touched as f64 * width).max(a);
            let right = (from + (touched + 1) as f64 * width).min(b);
            for time in [left, moving.clamp(left, right.max(left)), right.max(left)] {
                widen(touched, value(time));
            }
        }
    }
    [least, most]
}
