//! Circles by what a program says of them.

use geom::Vec3;

/// How far three points must be off a line, as a part of the longer way from the first: less may be all rounding.
const OFF_THE_LINE: f64 = 1e-6;

/// The circle from `start` through `point` to `end`, in whichever plane they span: its centre, and the unit vector about which
/// it turns counter-clockwise. `None` where they lie on a line.
pub fn through(start: Vec3, point: Vec3, end: Vec3) -> Option<(Vec3, Vec3)> {
    let (a, b) = (point - start, end - start);
    let across = a.cross(b);
    // A point that is not known spans nothing.
    if across.is_nan() || across.length() <= OFF_THE_LINE * a.length().max(b.length()) {
        return None;
    }
    let center = start
        + (b.length_squared() * across.cross(a) + a.length_squared() * b.cross(across))
            / (2.0 * across.length_squared());
    Some((center, across.normalize()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_points_span_one_circle_and_the_order_says_which_way_it_turns() {
        let [a, b, c] = [(5.0, 0.0), (3.0, 4.0), (-5.0, 0.0)].map(|(x, y)| Vec3::new(x, y, 2.0));
        let (center, normal) = through(a, b, c).unwrap();
        assert!((center - Vec3::new(0.0, 0.0, 2.0)).length() < 1e-12 && normal == Vec3::Z);
        assert_eq!(through(c, b, a).unwrap().1, -Vec3::Z);
        assert_eq!(through(a, (a + c) / 2.0, c), None);
        assert_eq!(through(a, Vec3::NAN, c), None);
        // In a plane that stands upright.
        let upright = through(Vec3::X, Vec3::Z, -Vec3::X).unwrap();
        assert_eq!(upright, (Vec3::ZERO, -Vec3::Y));
    }
}
