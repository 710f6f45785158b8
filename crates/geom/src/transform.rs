//! Mirroring, rotation and scaling about a point: lines stay lines and arcs stay arcs.

use crate::{Element, Turn, Vec2};

/// Mirrors left to right or not, then turns and scales.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    mirrored: bool,
    /// Where the unit vector along X goes, if nothing is mirrored: direction and scale.
    along: Vec2,
}

impl Transform {
    /// Changes nothing.
    pub const NONE: Transform = Transform { mirrored: false, along: Vec2::X };

    /// Mirrors left to right (`mirrored`), then turns by `degrees` counter-clockwise and scales.
    pub fn new(mirrored: bool, degrees: f64, scale: f64) -> Transform {
        Transform { mirrored, along: direction(degrees) * scale }
    }

    /// What `inner` and then this one do.
    pub fn after(&self, inner: &Transform) -> Transform {
        let turned = if self.mirrored { inner.along * Vec2::new(1.0, -1.0) } else { inner.along };
        let mirrored = self.mirrored != inner.mirrored;
        Transform { mirrored, along: self.along.rotate(turned) }
    }

    /// Where a vector goes.
    pub fn apply(&self, vector: Vec2) -> Vec2 {
        let vector = if self.mirrored { Vec2::new(-vector.x, vector.y) } else { vector };
        self.along.rotate(vector)
    }

    /// Whether left and right are exchanged.
    pub fn mirrors(&self) -> bool {
        self.mirrored
    }

    /// By how much lengths grow.
    pub fn scale(&self) -> f64 {
        self.along.length()
    }

    /// `element` transformed about the origin, which goes to `at`.
    pub fn element(&self, element: &Element, at: Vec2) -> Element {
        let place = |point: Vec2| at + self.apply(point);
        let turn = element.turn.map(|turn| Turn {
            center: place(turn.center),
            sweep: if self.mirrored { -turn.sweep } else { turn.sweep },
        });
        Element { start: place(element.start), end: place(element.end), turn }
    }
}

/// The unit vector at `degrees`: exact where it is along an axis.
fn direction(degrees: f64) -> Vec2 {
    match degrees.rem_euclid(360.0) {
        0.0 => Vec2::X,
        90.0 => Vec2::Y,
        180.0 => Vec2::NEG_X,
        270.0 => Vec2::NEG_Y,
        degrees => Vec2::from_angle(degrees.to_radians()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_after_the_other() {
        let inner = Transform::new(true, 30.0, 2.0);
        let outer = Transform::new(true, -70.0, 0.5);
        let vector = Vec2::new(3.0, 7.0);
        let both = outer.after(&inner);
        assert!(both.apply(vector).distance(outer.apply(inner.apply(vector))) < 1e-12);
        assert!(!both.mirrors() && (both.scale() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn quarter_turns_are_exact() {
        let turned = Transform::new(false, 450.0, 1.0).apply(Vec2::new(0.1, 0.3));
        assert_eq!(turned, Vec2::new(-0.3, 0.1));
        assert_eq!(
            Transform::new(true, 180.0, 1.0).apply(Vec2::new(0.1, 0.3)),
            Vec2::new(0.1, -0.3)
        );
    }
}
