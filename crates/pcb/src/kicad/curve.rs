//! Cubic Bézier curves as arcs.

use crate::arc;
use geom::{Element, Vec2};

/// How far the arcs may be from the curve, mm.
const TOLERANCE: f64 = 0.5e-3;

/// How often a curve is halved at most: of the largest curve that KiCad can hold such a part is below the
/// tolerance, also where it turns back in a point.
const MAX_HALVINGS: u32 = 12;

/// The curve with these control points.
pub(super) fn elements(points: [Vec2; 4]) -> Vec<Element> {
    let mut elements = Vec::new();
    fit(points, MAX_HALVINGS, &mut elements);
    elements
}

fn fit(points: [Vec2; 4], halvings: u32, elements: &mut Vec<Element>) {
    let [start, .., end] = points;
    let (first, second) = halves(points);
    let arc = arc::through(start, second[0], end);
    let off = |i: u32| arc.nearest(at(points, f64::from(i) / 8.0)).1;
    if halvings == 0 || (1..8).all(|i| off(i) <= TOLERANCE) {
        elements.push(arc);
    } else {
        fit(first, halvings - 1, elements);
        fit(second, halvings - 1, elements);
    }
}

/// The point at `t`, 0 to 1.
fn at([a, b, c, d]: [Vec2; 4], t: f64) -> Vec2 {
    let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
    ab.lerp(bc, t).lerp(bc.lerp(cd, t), t)
}

fn halves([a, b, c, d]: [Vec2; 4]) -> ([Vec2; 4], [Vec2; 4]) {
    let (ab, bc, cd) = (a.midpoint(b), b.midpoint(c), c.midpoint(d));
    let (abc, bcd) = (ab.midpoint(bc), bc.midpoint(cd));
    let middle = abc.midpoint(bcd);
    ([a, ab, abc, middle], [middle, bcd, cd, d])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every point of the curve is near the arcs, and every point of the arcs near the curve.
    fn assert_fits(points: [Vec2; 4]) -> usize {
        let elements = elements(points);
        let samples: Vec<Vec2> = (0..=20_000).map(|i| at(points, f64::from(i) / 2e4)).collect();
        for sample in samples.iter().step_by(10) {
            let nearest = elements.iter().map(|e| e.nearest(*sample).1);
            assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-3, "{sample}");
        }
        for point in elements.iter().flat_map(|e| [0.25, 0.5, 0.75].map(|t| e.at(t))) {
            let edges = samples.windows(2).map(|w| Element::line(w[0], w[1]).nearest(point).1);
            assert!(edges.fold(f64::INFINITY, f64::min) < 1e-3, "{point}");
        }
        assert!(elements.windows(2).all(|pair| pair[0].end == pair[1].start));
        elements.len()
    }

    #[test]
    fn within_a_micrometre_and_few() {
        let corners = |p: [(f64, f64); 4]| p.map(|(x, y)| Vec2::new(x, y));
        // The usual quarter of a circle: 2.7e-4 of its radius away from a circle.
        let quarter = [(10.0, 0.0), (10.0, 5.522_847), (5.522_847, 10.0), (0.0, 10.0)];
        assert!(assert_fits(corners(quarter)) <= 8);
        assert!(assert_fits(corners([(0.0, 0.0), (30.0, 40.0), (-10.0, 40.0), (20.0, 0.0)])) < 80);
        assert!(assert_fits(corners([(0.0, 0.0), (20.0, 20.0), (0.0, 20.0), (20.0, 0.0)])) < 80);
        assert_eq!(assert_fits(corners([(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)])), 1);
    }

    #[test]
    fn a_curve_that_is_a_point_or_comes_back() {
        let point = Vec2::new(3.0, 4.0);
        assert!(elements([point; 4]).iter().all(|e| e.length() < 1e-9));
        assert_fits([Vec2::ZERO, Vec2::X * 40.0, Vec2::Y * 40.0, Vec2::ZERO]);
    }
}
