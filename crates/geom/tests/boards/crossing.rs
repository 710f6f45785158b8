//! Whether the boundary of a region crosses itself.

use super::arrangement::Curve;
use toolpost_geom::region::Region;
use toolpost_geom::{Element, Vec2};

/// How deep a crossing is that counts, mm.
const DEEP: f64 = 3e-6;

/// Every element crosses no other, but where they have an end in common or touch.
pub fn never(region: &Region) {
    let elements: Vec<&Element> = region.rings().flat_map(|ring| ring.elements()).collect();
    for (i, first) in elements.iter().enumerate() {
        for second in &elements[i + 1..] {
            let (one, other) = (Curve::of_element(first), Curve::of_element(second));
            let on_both =
                |p: &Vec2| one.distance_to(*p).is_some() && other.distance_to(*p).is_some();
            let points: Vec<Vec2> = one.meets(&other).into_iter().filter(on_both).collect();
            for point in &points {
                let outwards = |curve: &Curve| curve.outwards(curve.distance_to(*point).unwrap());
                let across = outwards(&one).perp_dot(outwards(&other)).abs();
                let ends = [first.start, first.end, second.start, second.end];
                let others = points.iter().filter(|p| *p != point);
                let apart = ends.iter().chain(others).map(|end| end.distance(*point) * across);
                let deep = apart.fold(f64::INFINITY, f64::min);
                assert!(deep < DEEP, "{first:?} and {second:?} cross at {point}, {deep} mm deep");
            }
        }
    }
}
