//! Where a block, or an entity that is seen from behind, lies in the drawing.

use crate::element::Element;
use geom::{Turn, Vec2};

/// Turned, scaled evenly, mirrored and shifted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    /// Where the X axis goes: its length is the scale.
    pub axis: Vec2,
    /// Whether Y is turned over first.
    pub mirrored: bool,
    /// Where the origin goes.
    pub shift: Vec2,
    /// By how much heights grow; less than 0 where they are turned over.
    pub up: f64,
    /// The height of the origin.
    pub rise: f64,
}

impl Placement {
    /// As it is, at this scale.
    pub fn scaled(scale: f64) -> Placement {
        Placement {
            axis: Vec2::X * scale,
            mirrored: false,
            shift: Vec2::ZERO,
            up: scale,
            rise: 0.0,
        }
    }

    /// Seen from behind: X goes the other way (`Arbitrary Axis Algorithm` of the DXF reference for the
    /// extrusion 0, 0, −1).
    pub fn behind() -> Placement {
        Placement { axis: Vec2::NEG_X, mirrored: true, shift: Vec2::ZERO, up: -1.0, rise: 0.0 }
    }

    /// A direction.
    pub fn direction(&self, v: Vec2) -> Vec2 {
        self.axis.rotate(if self.mirrored { Vec2::new(v.x, -v.y) } else { v })
    }

    /// A point.
    pub fn point(&self, p: Vec2) -> Vec2 {
        self.shift + self.direction(p)
    }

    /// A height.
    pub fn height(&self, z: f64) -> f64 {
        self.rise + self.up * z
    }

    /// An element.
    pub fn element(&self, element: &Element) -> Element {
        let turn = element.turn.map(|turn| Turn {
            center: self.point(turn.center),
            sweep: if self.mirrored { -turn.sweep } else { turn.sweep },
        });
        let (start, end) = (self.point(element.start), self.point(element.end));
        element.shaped(geom::Element { start, end, turn })
    }

    /// This placement of what `inner` has placed.
    pub fn of(&self, inner: &Placement) -> Placement {
        Placement {
            axis: self.direction(inner.axis),
            mirrored: self.mirrored != inner.mirrored,
            shift: self.point(inner.shift),
            up: self.up * inner.up,
            rise: self.height(inner.rise),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_placement_of_another_places_as_both_after_each_other() {
        let placed = |x, y, shift, up, rise| Placement {
            axis: Vec2::new(x, y),
            mirrored: true,
            shift,
            up,
            rise,
        };
        let a = placed(1.0, 2.0, Vec2::new(5.0, 6.0), 2.0, 7.0);
        let b = placed(-3.0, 0.5, Vec2::new(1.0, 0.0), -1.0, 3.0);
        let p = Vec2::new(0.3, -7.0);
        assert!(a.of(&b).point(p).distance(a.point(b.point(p))) < 1e-12);
        // 7 + 2 (3 - 10).
        assert_eq!(a.of(&b).height(10.0), -7.0);
        assert_eq!(Placement::behind().point(p), Vec2::new(-0.3, -7.0));
    }
}
