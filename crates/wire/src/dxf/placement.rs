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
}

impl Placement {
    /// As it is, at this scale.
    pub fn scaled(scale: f64) -> Placement {
        Placement { axis: Vec2::X * scale, mirrored: false, shift: Vec2::ZERO }
    }

    /// Seen from behind: X goes the other way (`Arbitrary Axis Algorithm` of the DXF reference for the
    /// extrusion 0, 0, −1).
    pub fn behind() -> Placement {
        Placement { axis: Vec2::NEG_X, mirrored: true, shift: Vec2::ZERO }
    }

    /// A direction.
    pub fn direction(&self, v: Vec2) -> Vec2 {
        self.axis.rotate(if self.mirrored { Vec2::new(v.x, -v.y) } else { v })
    }

    /// A point.
    pub fn point(&self, p: Vec2) -> Vec2 {
        self.shift + self.direction(p)
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
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_placement_of_another_places_as_both_after_each_other() {
        let a = Placement { axis: Vec2::new(1.0, 2.0), mirrored: true, shift: Vec2::new(5.0, 6.0) };
        let b =
            Placement { axis: Vec2::new(-3.0, 0.5), mirrored: true, shift: Vec2::new(1.0, 0.0) };
        let p = Vec2::new(0.3, -7.0);
        assert!(a.of(&b).point(p).distance(a.point(b.point(p))) < 1e-12);
        assert_eq!(Placement::behind().point(p), Vec2::new(-0.3, -7.0));
    }
}
