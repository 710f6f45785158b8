//! From space to paper: parallel projection.

use geom::Vec3;
use glam::DVec2;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

/// A parallel projection that fills a field of the paper.
pub struct View {
    pub right: Vec3,
    pub up: Vec3,
    /// Pixels a mm.
    pub scale: f64,
    /// Pixels of the origin.
    origin: DVec2,
    /// The box around the path, mm.
    pub low: Vec3,
    pub high: Vec3,
}

impl View {
    /// From the front left and above; the box between two corners fills the field.
    pub fn from_above(corners: [Vec3; 2], field: [DVec2; 2]) -> View {
        View::turned(30f64.to_radians(), 35f64.to_radians(), corners, field)
    }

    /// From where X, Y and Z are equally foreshortened.
    pub fn isometric(corners: [Vec3; 2], field: [DVec2; 2]) -> View {
        View::turned(FRAC_PI_4, FRAC_1_SQRT_2.atan(), corners, field)
    }

    /// From `turn` left of the front and `tilt` above, radians.
    fn turned(turn: f64, tilt: f64, corners: [Vec3; 2], field: [DVec2; 2]) -> View {
        let right = Vec3::new(turn.cos(), turn.sin(), 0.0);
        let up = Vec3::new(-turn.sin() * tilt.sin(), turn.cos() * tilt.sin(), tilt.cos());
        View::along(right, up, corners, field)
    }

    /// From straight above.
    pub fn plan(corners: [Vec3; 2], field: [DVec2; 2]) -> View {
        View::along(Vec3::X, Vec3::Y, corners, field)
    }

    fn along(right: Vec3, up: Vec3, [low, high]: [Vec3; 2], field: [DVec2; 2]) -> View {
        let mut view = View { right, up, scale: 1.0, origin: DVec2::ZERO, low, high };
        let corners = (0..8).map(|i| {
            let side = |bit: u8, low: f64, high: f64| if i & bit == 0 { low } else { high };
            view.at(Vec3::new(
                side(1, low.x, high.x),
                side(2, low.y, high.y),
                side(4, low.z, high.z),
            ))
        });
        let empty = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (least, most) = corners.fold(empty, |(a, b), p| (a.min(p), b.max(p)));
        let room = (field[1] - field[0]) / (most - least).max(DVec2::splat(1e-6));
        view.scale = room.min_element();
        view.origin = (field[0] + field[1]) / 2.0 - (least + most) / 2.0 * view.scale;
        view
    }

    /// Where a point is on the paper, pixels.
    pub fn at(&self, p: Vec3) -> DVec2 {
        self.origin + DVec2::new(self.right.dot(p), -self.up.dot(p)) * self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ISO 5456-3, "Isometric axonometry": the axes stand at 120° and are shortened alike, by √(2/3).
    #[test]
    fn an_isometric_view_shortens_the_axes_alike_and_parts_them_by_120_degrees() {
        let view = View::isometric([Vec3::ZERO, Vec3::ONE], [DVec2::ZERO, DVec2::ONE]);
        let seen = Vec3::AXES.map(|axis| (view.at(axis) - view.at(Vec3::ZERO)) / view.scale);
        for axis in seen {
            assert!((axis.length() - (2.0f64 / 3.0).sqrt()).abs() < 1e-12);
        }
        assert!(seen[0].x > 0.0 && seen[0].y > 0.0 && seen[1].x > 0.0 && seen[2].x.abs() < 1e-12);
        assert!((seen[0].dot(seen[2]) * 1.5 + 0.5).abs() < 1e-12);
        assert!((seen[1].dot(seen[2]) * 1.5 - 0.5).abs() < 1e-12);
    }
}
