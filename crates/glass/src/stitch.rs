//! Fields of a scanner: a cloud larger than a field is divided into fields that the stage visits one after the other.
//!
//! **Border rule.** Fields are made from low to high columns, and in a column from low to high rows, slab by slab from below. A border
//! leans against the fields made before it, by so much that none of their points shadows one made later: a point of an earlier field
//! lies farther from the border than the border has moved at its height. With the slope `s` of the beam, the radius `R` of a crack and the
//! smallest distance `d`, points nearer in height than `h`, where `sqrt(d² - h²) = R + s h`, shadow none anyway, so that `s + R / h`
//! is enough. Each point belongs to one field, whoever works on it.

use crate::cloud::{Point, bounds};
use crate::order::Shadow;

/// What part of a field borders may lean by within a slab.
const LEANING: f64 = 0.25;

/// Borders lean a little more than they must, for the rounding of points.
const WIDER: f64 = 1.05;

/// A field.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Where its middle lies, µm.
    pub center: [i32; 2],
    /// The points that are made in it: their numbers.
    pub points: Vec<u32>,
}

/// How much a border leans: µm to the side for each µm of height.
fn lean(shadow: Shadow, spacing: f64) -> f64 {
    let Shadow { slope, radius } = shadow;
    let root = (spacing * spacing * (1.0 + slope * slope) - radius * radius).max(1.0).sqrt();
    let height = ((root - radius * slope) / (1.0 + slope * slope)).max(1.0);
    WIDER * (slope + radius / height)
}

/// Divides `points` that are `spacing` µm apart into fields of `size` µm, in the order in which they are made.
pub fn fields(points: &[Point], size: [f64; 2], shadow: Shadow, spacing: f64) -> Vec<Field> {
    let Some((low, high)) = bounds(points) else { return Vec::new() };
    let length = |axis: usize| f64::from(high[axis] - low[axis]);
    let is_one = [0, 1].map(|axis| length(axis) <= size[axis]);
    let lean = lean(shadow, spacing);
    let leaning = [0, 1].map(|axis| if is_one[axis] { 0.0 } else { LEANING * size[axis] });
    let slab = [0, 1].map(|axis| if is_one[axis] { f64::MAX } else { leaning[axis] / lean });
    let slab = slab[0].min(slab[1]);
    // One field lies around the points; of more the first begins so low that it has the lowest point at the top of a slab.
    let number = |axis: usize, value: i32, height: f64| match is_one[axis] {
        true => 0,
        false => {
            let own = f64::from(value - low[axis]) + lean * height;
            (own / (size[axis] - leaning[axis])).floor() as u32
        }
    };
    let mut keyed: Vec<([u32; 3], u32)> = points
        .iter()
        .zip(0..)
        .map(|(point, i)| {
            let height = f64::from(point[2] - low[2]);
            let layer = (height / slab).floor();
            let above = height - layer * slab.min(1e12);
            let of = |axis: usize| number(axis, point[axis], above);
            ([layer as u32, of(0), of(1)], i)
        })
        .collect();
    keyed.sort_unstable();
    let center = |axis: usize, number: u32| match is_one[axis] {
        true => (f64::from(low[axis]) + 0.5 * length(axis)).round() as i32,
        false => {
            let pitch = size[axis] - leaning[axis];
            let begins = f64::from(low[axis]) + pitch * f64::from(number) - leaning[axis];
            (begins + 0.5 * size[axis]).round() as i32
        }
    };
    let field = |of: &[([u32; 3], u32)]| Field {
        center: [0, 1].map(|axis| center(axis, of[0].0[axis + 1])),
        points: of.iter().map(|(_, i)| *i).collect(),
    };
    keyed.chunk_by(|a, b| a.0 == b.0).map(field).collect()
}
