//! The two orders of the source (spec 4.7, 4.8).

use crate::cloud::{Grid, Point, bounds, squared};

/// `Sort Kdz`: from the lowest point always to the open one of least `max(|dx|, |dy|) + K dz`, with one K for points above
/// (`up`) and one for points below (`down`), both more than 0: half angles of the sorting cone have the tangent K.
///
/// The source looks at all open points; here those of the smallest box around the point that has any, in which nearly always the
/// one of least cost is.
pub fn kdz(points: &[Point], up: f64, down: f64) -> Vec<u32> {
    let Some((low, high)) = bounds(points) else { return Vec::new() };
    let mut open = Open::new(points);
    let mut order = Vec::with_capacity(points.len());
    let lowest = (0..points.len() as u32).min_by_key(|&i| (points[i as usize][2], i));
    let widest = (0..3).map(|axis| i64::from(high[axis]) - i64::from(low[axis])).max().unwrap_or(0);
    let mut next = lowest;
    while let Some(at) = next {
        open.close(at);
        order.push(at);
        let here = points[at as usize];
        let cost = |i: u32| {
            let way = |axis: usize| f64::from(points[i as usize][axis]) - f64::from(here[axis]);
            let (flat, height) = (way(0).abs().max(way(1).abs()), way(2));
            flat + height * if height > 0.0 { up } else { down }
        };
        next = open.best(here, widest, cost);
    }
    order
}

/// `Sort by layers`: layers of the height `layer` (µm, 1 at least) from below; in each of them from the end of the one before always to the
/// nearest open point.
pub fn layers(points: &[Point], layer: u32) -> Vec<u32> {
    let Some((low, high)) = bounds(points) else { return Vec::new() };
    let widest = (0..3).map(|axis| i64::from(high[axis]) - i64::from(low[axis])).max().unwrap_or(0);
    let number =
        |i: &u32| (i64::from(points[*i as usize][2]) - i64::from(low[2])) / i64::from(layer.max(1));
    let mut by_layer: Vec<u32> = (0..points.len() as u32).collect();
    by_layer.sort_by_key(number);
    let mut order: Vec<u32> = Vec::with_capacity(points.len());
    let mut here = low;
    for of_layer in by_layer.chunk_by(|a, b| number(a) == number(b)) {
        let flat = |i: u32| [points[i as usize][0], points[i as usize][1], 0];
        let own: Vec<Point> = of_layer.iter().map(|&i| flat(i)).collect();
        let mut open = Open::new(&own);
        while let Some(i) = open.best([here[0], here[1], 0], widest, |i| {
            squared(own[i as usize], [here[0], here[1], 0]) as f64
        }) {
            open.close(i);
            here = own[i as usize];
            order.push(of_layer[i as usize]);
        }
    }
    order
}

/// Points that are not yet ordered, in cubes.
struct Open<'p> {
    points: &'p [Point],
    /// Grids of cubes, each with a side twice that of the one before.
    grids: Vec<(i64, Grid)>,
    open: Vec<bool>,
    left: usize,
}

/// The side of the smallest cubes, µm.
const SMALLEST: i64 = 250;

impl<'p> Open<'p> {
    fn new(points: &'p [Point]) -> Open<'p> {
        Open { points, grids: Vec::new(), open: vec![true; points.len()], left: points.len() }
    }

    fn close(&mut self, i: u32) {
        self.left -= usize::from(std::mem::take(&mut self.open[i as usize]));
    }

    /// The open point of least cost within the smallest box around `here` that has one.
    fn best(&mut self, here: Point, widest: i64, cost: impl Fn(u32) -> f64) -> Option<u32> {
        let mut side = SMALLEST;
        while self.left > 0 {
            if side > 2 * widest + SMALLEST {
                let all = (0..self.points.len() as u32).filter(|&i| self.open[i as usize]);
                return all.min_by(|&a, &b| cost(a).total_cmp(&cost(b)).then(a.cmp(&b)));
            }
            let level = (side / SMALLEST).ilog2() as usize;
            if level == self.grids.len() {
                self.grids.push((side, Grid::new(self.points, side)));
            }
            let near = self.grids[level].1.near(here).filter(|&i| self.open[i as usize]);
            let best = near.min_by(|&a, &b| cost(a).total_cmp(&cost(b)).then(a.cmp(&b)));
            if best.is_some() {
                return best;
            }
            side *= 2;
        }
        None
    }
}
