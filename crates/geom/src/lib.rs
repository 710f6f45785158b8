//! Points, lines and arcs in space, regions of the plane, and letters made of lines.
//!
//! The crate promises geometry that keeps arcs as arcs, with bounds on its errors that are stated where a function has any
//! ([`region`]).
//!
//! Coordinates are millimetres in a right-handed frame, angles are radians, counter-clockwise is positive, and every function
//! is a pure function of its arguments: the same input gives the same bits on every machine and thread.
//!
//! ```
//! use toolpost_geom::Vec2;
//! use toolpost_geom::region::Region;
//!
//! # fn main() -> Result<(), toolpost_geom::region::RegionError> {
//! // A disc of 10 mm and the hole of 4 mm in it: where may the centre of a tool of 1 mm go?
//! let disc = Region::disc(Vec2::ZERO, 5.0)?;
//! let ring = disc.difference(&Region::disc(Vec2::ZERO, 2.0)?)?;
//! let room = ring.offset(-0.5)?;
//! // Between the radii 4.5 mm and 2.5 mm, and the arcs are still arcs.
//! assert!((room.area() - std::f64::consts::PI * (4.5 * 4.5 - 2.5 * 2.5)).abs() < 1e-6);
//! assert!(room.rings().flat_map(|ring| ring.elements()).all(|element| element.turn.is_some()));
//! # Ok(())
//! # }
//! ```
//!
//! It never reads or writes anything, and it knows nothing of a machine. Long steps may be ended from outside ([`ending`]).

mod arc;
mod chain;
mod crossing;
mod element;
pub mod ending;
pub mod lettering;
pub mod linear;
pub mod region;
mod rotation;
mod transform;

pub use arc::{Arc, ArcError};
pub use chain::{Chain, ChainError, Chains, chain};
pub use crossing::Crossing;
pub use element::{Element, Turn, turn_angle};
pub use glam::{DAffine3 as Frame, DMat3 as Mat3, DQuat as Quat, DVec2 as Vec2, DVec3 as Vec3};
pub use rotation::Euler;
pub use transform::Transform;

/// Two directions count as the same below this angle (radians): 0.2 arc seconds, far below what any
/// rotary axis resolves.
pub const ANGLE_EPSILON: f64 = 1e-6;

/// mm in an inch.
pub const INCH: f64 = 25.4;

/// The unit vector of `v`, or `None` where `v` is zero, not finite, or so short or long that its
/// direction is lost in rounding.
pub fn direction(v: Vec3) -> Option<Vec3> {
    let length = v.length();
    (length.is_finite() && length > 1e-9).then(|| v / length)
}

/// The angle between two unit vectors, in radians, exact also for nearly parallel ones.
pub fn angle_between(a: Vec3, b: Vec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// The unit vector at the fraction `t` (0 to 1) of the great circle from `a` to `b`.
pub fn between(a: Vec3, b: Vec3, t: f64) -> Vec3 {
    let angle = angle_between(a, b);
    let (from, to) = match angle > 0.1 && angle < 3.1 {
        true => (((1.0 - t) * angle).sin(), (t * angle).sin()),
        // Chord and arc are the same here, far below any tolerance of an axis within a move.
        false => (1.0 - t, t),
    };
    (a * from + b * to).normalize_or(b)
}

/// How far the unit vector `v` is from the great circle between `a` and `b`, radians.
pub fn off_great_circle(a: Vec3, b: Vec3, v: Vec3) -> f64 {
    let normal = a.cross(b);
    let ends = angle_between(v, a).min(angle_between(v, b));
    let within = normal.cross(a).dot(v) >= 0.0 && b.cross(normal).dot(v) >= 0.0;
    match normal.try_normalize() {
        Some(normal) if within => normal.dot(v).clamp(-1.0, 1.0).asin().abs().min(ends),
        _ => ends,
    }
}

/// `v` turned by `angle` (radians) about the unit vector `axis` through the origin (Rodrigues).
pub fn rotate(v: Vec3, axis: Vec3, angle: f64) -> Vec3 {
    let (sin, cos) = angle.sin_cos();
    v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos))
}

/// `angle` (radians) brought into (−π, π].
pub fn wrap(angle: f64) -> f64 {
    // Most angles are in it.
    if angle.abs() < std::f64::consts::PI {
        return angle;
    }
    let turn = std::f64::consts::TAU;
    let wrapped = angle - turn * (angle / turn).round();
    if wrapped <= -std::f64::consts::PI { wrapped + turn } else { wrapped }
}

/// How far the box from `low` to `high` reaches along the unit vector `direction`, seen from the origin.
pub fn reach_of_box(low: Vec3, high: Vec3, direction: Vec3) -> f64 {
    (low * direction).max(high * direction).element_sum()
}

/// Where `point` falls on the segment `from`..`to`: the parameter 0..=1 of the nearest point and the
/// distance to it in mm. A segment without length has parameter 1.
pub fn nearest_on_segment(from: Vec3, to: Vec3, point: Vec3) -> (f64, f64) {
    let along = to - from;
    let squared = along.length_squared();
    let t = if squared > 0.0 { ((point - from).dot(along) / squared).clamp(0.0, 1.0) } else { 1.0 };
    (t, point.distance(from + along * t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn between_two_directions_the_way_is_a_great_circle_at_even_speed() {
        for angle in [0.05f64, 1.5, 3.0] {
            let to = Vec3::new(angle.sin(), 0.0, angle.cos());
            for t in [0.0, 0.25, 0.5, 1.0] {
                let expected = Vec3::new((t * angle).sin(), 0.0, (t * angle).cos());
                assert!(between(Vec3::Z, to, t).distance(expected) < 1e-5, "{angle} {t}");
            }
        }
    }

    #[test]
    fn a_zero_or_broken_vector_has_no_direction() {
        assert_eq!(direction(Vec3::ZERO), None);
        assert_eq!(direction(Vec3::new(f64::NAN, 0.0, 1.0)), None);
        assert_eq!(direction(Vec3::splat(1e308)), None);
        assert_eq!(direction(Vec3::new(0.0, 3.0, 4.0)), Some(Vec3::new(0.0, 0.6, 0.8)));
    }

    #[test]
    fn wrapping_keeps_plus_180_and_never_gives_minus_180() {
        assert_eq!(wrap(PI), PI);
        assert_eq!(wrap(-PI), PI);
        assert!((wrap(3.0 * PI / 2.0) + PI / 2.0).abs() < 1e-12);
    }

    #[test]
    fn turning_x_about_z_by_a_quarter_gives_y() {
        assert!(rotate(Vec3::X, Vec3::Z, PI / 2.0).distance(Vec3::Y) < 1e-15);
    }

    #[test]
    fn the_angle_between_nearly_parallel_vectors_is_exact() {
        let tilted = rotate(Vec3::Z, Vec3::X, 1e-7);
        assert!((angle_between(Vec3::Z, tilted) - 1e-7).abs() < 1e-15);
    }
}
