//! From space to paper: parallel projection.

use geom::Vec3;
use glam::DVec2;

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
        let turn = 30f64.to_radians();
        let tilt = 35f64.to_radians();
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
