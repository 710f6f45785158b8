//! Circular arcs and helices.

use crate::{ANGLE_EPSILON, Vec3, direction, rotate};
use std::f64::consts::{PI, TAU};

/// An arc or a helix: from `start`, `sweep` radians counter-clockwise about `normal` (a unit vector)
/// through `center`, ending at `end`. Its travel along the normal grows evenly with the angle, and so
/// does its radius where the two ends are, by rounding, not equally far from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// First point, mm.
    pub start: Vec3,
    /// Last point, mm.
    pub end: Vec3,
    /// A point of the axis, mm.
    pub center: Vec3,
    /// Unit vector of the axis; the arc turns counter-clockwise when this points at the viewer.
    pub normal: Vec3,
    /// Angle turned through, radians, greater than 0; more than 2π for several turns.
    pub sweep: f64,
}

/// Why three points and an axis do not make an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ArcError {
    /// The axis vector is zero or not finite.
    NoAxis,
    /// The start lies on the axis, so there is no radius.
    NoRadius,
    /// The end is not as far from the axis as the start (radius at the start, radius at the end; mm).
    OffTheCircle(f64, f64),
}

impl Arc {
    /// The arc from `start` to `end` counter-clockwise about `normal` through `center`, with `turns`
    /// full turns more than the shortest. Equal ends (seen along the axis) are a full circle.
    ///
    /// # Errors
    /// [`ArcError`] where the axis has no direction, the radius is zero, or the two radii differ by
    /// more than `tolerance` mm.
    pub fn new(
        start: Vec3,
        end: Vec3,
        center: Vec3,
        normal: Vec3,
        turns: u32,
        tolerance: f64,
    ) -> Result<Arc, ArcError> {
        let normal = direction(normal).ok_or(ArcError::NoAxis)?;
        let spoke = |p: Vec3| (p - center).reject_from_normalized(normal);
        let (a, b) = (spoke(start), spoke(end));
        let (ra, rb) = (a.length(), b.length());
        if ra.is_nan() || ra <= 1e-9 {
            return Err(ArcError::NoRadius);
        }
        let apart = (ra - rb).abs();
        if apart.is_nan() || apart > tolerance || rb <= 1e-9 {
            return Err(ArcError::OffTheCircle(ra, rb));
        }
        let mut sweep = normal.dot(a.cross(b)).atan2(a.dot(b));
        // Ends closer than rounding are one point: a full circle, never an arc of no length.
        if sweep.abs() * ra < 1e-7 || sweep.abs() < 1e-9 {
            sweep = 0.0;
        }
        if sweep <= 0.0 {
            sweep += TAU;
        }
        Ok(Arc { start, end, center, normal, sweep: sweep + TAU * f64::from(turns) })
    }

    /// Distance of the start from the axis, mm.
    pub fn radius(&self) -> f64 {
        (self.start - self.center).reject_from_normalized(self.normal).length()
    }

    /// Travel along the normal from start to end, mm; zero for a plane arc.
    pub fn rise(&self) -> f64 {
        (self.end - self.start).dot(self.normal)
    }

    /// The point at `t` (0 is the start, 1 the end).
    pub fn at(&self, t: f64) -> Vec3 {
        if t >= 1.0 {
            return self.end;
        }
        let from = self.start - self.center;
        let spoke = from.reject_from_normalized(self.normal);
        let grown = 1.0
            + t * ((self.end - self.center).reject_from_normalized(self.normal).length()
                / spoke.length()
                - 1.0);
        let height = from.dot(self.normal) + t * self.rise();
        self.center + rotate(spoke * grown, self.normal, self.sweep * t) + self.normal * height
    }

    /// Length of the path, mm.
    pub fn length(&self) -> f64 {
        (self.radius() * self.sweep).hypot(self.rise())
    }

    /// Unit tangent at the start, in the direction of travel.
    pub fn tangent(&self) -> Vec3 {
        let spoke = (self.start - self.center).reject_from_normalized(self.normal);
        (self.normal.cross(spoke) * self.sweep + self.normal * self.rise()).normalize_or_zero()
    }

    /// Into how many chords of equal angle the arc must be cut so that none leaves it by more than
    /// `tolerance` mm. At least one, at most ten million.
    pub fn chords(&self, tolerance: f64) -> usize {
        let radius = self.radius();
        let step = if tolerance >= radius { 1.0 } else { 2.0 * (1.0 - tolerance / radius).acos() };
        // Even a coarse tolerance keeps a full circle a recognisable polygon: no chord over 60°.
        (self.sweep / step.clamp(ANGLE_EPSILON, TAU / 6.0)).ceil().clamp(1.0, 1e7) as usize
    }

    /// The parameter 0..=1 of the point of the arc nearest to `point`, and the distance in mm. For a
    /// helix of several turns the turn is the one whose height fits best.
    pub fn nearest(&self, point: Vec3) -> (f64, f64) {
        let from = (self.start - self.center).reject_from_normalized(self.normal);
        let to = (point - self.center).reject_from_normalized(self.normal);
        let mut angle = self.normal.dot(from.cross(to)).atan2(from.dot(to));
        if angle < 0.0 {
            angle += TAU;
        }
        let mut best = if point.distance_squared(self.end) < point.distance_squared(self.start) {
            (1.0, point.distance(self.end))
        } else {
            (0.0, point.distance(self.start))
        };
        // A helix passes each angle once a turn: the turn whose height is nearest, and its neighbours.
        let rise = self.rise();
        let height = (point - self.start).dot(self.normal);
        let turn =
            if rise == 0.0 { 0.0 } else { ((height / rise * self.sweep - angle) / TAU).round() };
        for candidate in [turn - 1.0, turn, turn + 1.0, 0.0] {
            let t = (angle + candidate.max(0.0) * TAU) / self.sweep;
            if (0.0..=1.0).contains(&t) {
                let distance = point.distance(self.at(t));
                if distance < best.1 {
                    best = (t, distance);
                }
            }
        }
        best
    }

    /// The points of [`Arc::chords`] chords after the start, the end included.
    pub fn flatten(&self, tolerance: f64) -> impl Iterator<Item = Vec3> + '_ {
        let n = self.chords(tolerance);
        (1..=n).map(move |i| self.at(i as f64 / n as f64))
    }

    /// The corners of the smallest box around the arc whose sides are parallel to the axes.
    pub fn extents(&self) -> (Vec3, Vec3) {
        let spoke = (self.start - self.center).reject_from_normalized(self.normal);
        let across = self.normal.cross(spoke);
        let climb = self.normal * (self.rise() / self.sweep);
        let (mut low, mut high) = (self.start.min(self.end), self.start.max(self.end));
        for i in 0..3 {
            // A coordinate is r cos(θ − peak) + climb θ; it turns where its slope is zero.
            let (r, peak) = (spoke[i].hypot(across[i]), across[i].atan2(spoke[i]));
            let lean = climb[i] / r;
            if lean.is_nan() || lean.abs() > 1.0 {
                continue;
            }
            let shift = lean.asin();
            for angle in [peak + shift, peak + PI - shift] {
                // Of several turns the first and the last reach farthest.
                let first = angle.rem_euclid(TAU);
                let last = first + TAU * ((self.sweep - first) / TAU).floor();
                for angle in [first, last] {
                    if (0.0..=self.sweep).contains(&angle) {
                        let point = self.at(angle / self.sweep);
                        low = low.min(point);
                        high = high.max(point);
                    }
                }
            }
        }
        (low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quarter() -> Arc {
        let (start, end) = (Vec3::new(10.0, 0.0, 0.0), Vec3::new(0.0, 10.0, 0.0));
        Arc::new(start, end, Vec3::ZERO, Vec3::Z, 0, 1e-3).unwrap()
    }

    #[test]
    fn a_quarter_turn_counter_clockwise_about_z() {
        let arc = quarter();
        assert!((arc.sweep - PI / 2.0).abs() < 1e-12);
        assert!((arc.length() - 5.0 * PI).abs() < 1e-12);
        assert!(arc.at(0.5).distance(Vec3::new(50f64.sqrt(), 50f64.sqrt(), 0.0)) < 1e-12);
        assert!(arc.tangent().distance(Vec3::Y) < 1e-12);
    }

    #[test]
    fn the_other_normal_goes_the_long_way_round() {
        let arc = quarter();
        let other = Arc::new(arc.start, arc.end, Vec3::ZERO, Vec3::NEG_Z, 0, 1e-3).unwrap();
        assert!((other.sweep - 1.5 * PI).abs() < 1e-12);
    }

    #[test]
    fn equal_ends_are_a_full_circle_and_a_helix_rises_evenly() {
        let p = Vec3::new(5.0, 0.0, 0.0);
        let circle = Arc::new(p, p, Vec3::ZERO, Vec3::Z, 0, 1e-3).unwrap();
        assert_eq!(circle.sweep, TAU);
        let helix = Arc::new(p, p - Vec3::Z * 4.0, Vec3::ZERO, Vec3::Z, 1, 1e-3).unwrap();
        assert_eq!(helix.sweep, 2.0 * TAU);
        assert!((helix.at(0.25).z + 1.0).abs() < 1e-12);
        assert!((helix.length() - (10.0 * TAU).hypot(4.0)).abs() < 1e-9);
        assert_eq!(helix.nearest(helix.at(0.7)).0.mul_add(1e6, 0.5).floor(), 700_000.0);
    }

    #[test]
    fn what_is_no_arc_is_refused() {
        let (p, q) = (Vec3::new(5.0, 0.0, 0.0), Vec3::new(0.0, 6.0, 0.0));
        assert_eq!(Arc::new(p, q, Vec3::ZERO, Vec3::ZERO, 0, 0.1), Err(ArcError::NoAxis));
        assert_eq!(Arc::new(p, q, p, Vec3::Z, 0, 0.1), Err(ArcError::NoRadius));
        assert_eq!(
            Arc::new(p, q, Vec3::ZERO, Vec3::Z, 0, 0.1),
            Err(ArcError::OffTheCircle(5.0, 6.0))
        );
    }

    #[test]
    fn chords_stay_within_the_tolerance() {
        let arc = quarter();
        for tolerance in [0.5, 0.01, 1e-4] {
            let mut last = arc.start;
            for p in arc.flatten(tolerance) {
                assert!(10.0 - ((last + p) / 2.0).length() <= tolerance * 1.000_001);
                last = p;
            }
            assert_eq!(last, arc.end);
        }
    }

    #[test]
    fn the_box_around_an_arc_touches_it_exactly() {
        let (start, end) = (Vec3::new(3.0, -4.0, 1.0), Vec3::new(3.0, 4.0, 1.0));
        let arc = Arc::new(start, end, Vec3::Z, Vec3::Z, 0, 1e-3).unwrap();
        let (low, high) = arc.extents();
        assert!(low.distance(start) < 1e-12);
        assert!(high.distance(Vec3::new(5.0, 4.0, 1.0)) < 1e-12);
    }

    #[test]
    fn the_box_around_a_leaning_helix_holds_all_of_it_and_no_more() {
        for (normal, turns) in [(Vec3::new(1.0, 2.0, 3.0), 0), (Vec3::new(-1.0, 0.1, 0.0), 3)] {
            let normal = normal.normalize();
            let out = normal.any_orthonormal_vector() * 20.0;
            let end = rotate(out, normal, 2.0) + normal * 7.0;
            let arc = Arc::new(out, end, Vec3::ZERO, normal, turns, 1e-3).unwrap();
            let (low, high) = arc.extents();
            let mut seen = (out, out);
            for i in 0..=100_000 {
                let p = arc.at(f64::from(i) / 1e5);
                seen = (seen.0.min(p), seen.1.max(p));
            }
            assert!(seen.0.cmpge(low - 1e-9).all() && seen.1.cmple(high + 1e-9).all());
            assert!(seen.0.distance(low) < 1e-5 && seen.1.distance(high) < 1e-5);
        }
    }

    #[test]
    fn the_box_of_an_arc_is_that_of_its_points() {
        let tilted = Vec3::new(0.3, -0.5, 0.8).normalize();
        let start = Vec3::new(4.0, 1.0, -2.0);
        let center = start + tilted.any_orthonormal_vector() * 7.0;
        for (turns, rise) in [(0, 0.0), (0, 9.0), (2, -30.0)] {
            for angle in [0.1, 2.0, 5.5] {
                let end = center + rotate(start - center, tilted, angle) + tilted * rise;
                let arc = Arc::new(start, end, center, tilted, turns, 1e-6).unwrap();
                let points = (0..=20_000).map(|i| arc.at(f64::from(i) / 20_000.0));
                let (low, high) = points.fold((start, start), |(l, h), p| (l.min(p), h.max(p)));
                let (a, b) = arc.extents();
                assert!(a.distance(low) < 1e-5 && b.distance(high) < 1e-5, "{turns} {angle}");
            }
        }
    }
}
