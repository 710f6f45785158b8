//! A turning table and an arm: where a beam hits the work piece, and the angles that bring it to a point (spec 2.16).
//!
//! Frame: the table's axis is the origin, the arm's axis at (0, `distance`). The work piece is a square of side `side`,
//! its near edge `offset` from the table's axis, its middle on the line of the two axes; its own x and y count from its
//! near left corner. Angles are radians; the table turns counter-clockwise, the arm counts from the direction towards the
//! table's axis, positive towards +x.

use glam::DVec2 as Vec2;
use std::f64::consts::TAU;

/// The lengths of a polar machine with one work piece on it, mm.
#[derive(Clone, Copy, Debug)]
pub struct Polar {
    /// Side of the work piece.
    pub side: f64,
    /// From the table's axis to the arm's.
    pub distance: f64,
    /// From the table's axis to the near edge of the work piece.
    pub offset: f64,
    /// Length of the arm.
    pub arm: f64,
}

/// Which way the elbow bends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Branch {
    /// The beam on the left of the line of the axes: arm angles from 180° to 360°.
    Left,
    /// The beam on the right of it: arm angles up to 180°.
    Right,
}

/// Where arm and table stand, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The arm, from 0 to a full turn.
    pub arm: f64,
    /// The table.
    pub table: f64,
}

impl Polar {
    /// Distance of a point of the work piece from the table's axis, and the direction in which it is seen from there, from
    /// +y positive towards +x.
    fn seen(&self, point: Vec2) -> (f64, f64) {
        let from = Vec2::new(point.x - 0.5 * self.side, point.y + self.offset);
        (from.length(), from.x.atan2(from.y))
    }

    /// The angles at the table's axis and at the arm's in the triangle of both axes and the beam; `None` where the arm does
    /// not reach.
    fn triangle(&self, radius: f64) -> Option<(f64, f64)> {
        let Polar { distance: d, arm: a, .. } = *self;
        let r = radius;
        let at_table = (d * d + r * r - a * a) / (2.0 * d * r);
        let at_arm = (d * d + a * a - r * r) / (2.0 * d * a);
        let angle = |cos: f64| (cos.abs() <= 1.0).then(|| cos.acos());
        Some((angle(at_table)?, angle(at_arm)?))
    }

    /// The pose that brings the beam to `point` (mm on the work piece), or `None` where the arm does not reach it.
    pub fn inverse(&self, point: Vec2, branch: Branch) -> Option<Pose> {
        let (radius, seen) = self.seen(point);
        let (at_table, at_arm) = self.triangle(radius)?;
        Some(match branch {
            Branch::Left => Pose { arm: TAU - at_arm, table: at_table + seen },
            Branch::Right => Pose { arm: at_arm, table: seen - at_table },
        })
    }

    /// The pose that table 6 of the source prints: its sign of the table's angle is wrong left of the middle, where it
    /// leads to the mirror image of the point.
    pub fn as_printed(&self, point: Vec2) -> Option<Pose> {
        let (radius, seen) = self.seen(point);
        let (at_table, at_arm) = self.triangle(radius)?;
        Some(match point.x >= 0.5 * self.side {
            true => Pose { arm: TAU - at_arm, table: at_table + seen.abs() },
            false => Pose { arm: at_arm, table: -(at_table - seen.abs()) },
        })
    }

    /// Where the beam of a pose hits the work piece, mm.
    pub fn forward(&self, pose: Pose) -> Vec2 {
        let (sin, cos) = pose.arm.sin_cos();
        let beam = Vec2::new(self.arm * sin, self.distance - self.arm * cos);
        let on_table = Vec2::from_angle(-pose.table).rotate(beam);
        Vec2::new(on_table.x + 0.5 * self.side, on_table.y - self.offset)
    }

    /// The part of the work piece that the arm does not reach, from 0 to 1, on a grid of `cells` by `cells`.
    pub fn unreachable(&self, cells: u32) -> f64 {
        let step = self.side / f64::from(cells);
        let middle = |i: u32| (f64::from(i) + 0.5) * step;
        let row = |i| (0..cells).map(move |j| Vec2::new(middle(i), middle(j)));
        let missed = |point: &Vec2| self.triangle(self.seen(*point).0).is_none();
        let missed = (0..cells).flat_map(row).filter(missed).count();
        missed as f64 / (f64::from(cells) * f64::from(cells))
    }

    /// The radius of the table that carries the corners of the work piece, mm.
    pub fn table_radius(&self) -> f64 {
        (0.5 * self.side).hypot(self.offset + self.side)
    }

    /// Distance of neighbouring arcs of the arm for each radian that the table turns, at the arm angle `arm`, mm.
    pub fn arc_pitch(&self, arm: f64) -> f64 {
        self.distance * arm.sin()
    }

    /// How far the beam moves from the table's axis for each radian of the arm at the arm angle `arm`, mm.
    pub fn track_pitch(&self, arm: f64) -> f64 {
        let Polar { distance: d, arm: a, .. } = *self;
        let radius = (d * d + a * a - 2.0 * d * a * arm.cos()).sqrt();
        d * a * arm.sin() / radius
    }
}

/// The speed of a table on which points `spacing` mm apart pass at `rate` (Hz) at `radius` mm: rad/s.
pub fn track_speed(spacing: f64, rate: f64, radius: f64) -> f64 {
    spacing * rate / radius
}
