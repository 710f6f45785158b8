//! Bodies as triangles: their readers, and what is wrong with them.

use glam::DVec3;

/// Triangles in space, mm.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The corners.
    pub vertices: Vec<DVec3>,
    /// Three numbers of corners each, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// The corners of the triangle of this number.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|corner| self.vertices[corner as usize])
    }

    /// The smallest box around all corners; `None` where there are none.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let first = *self.vertices.first()?;
        let grow = |(low, high): (DVec3, DVec3), &at: &DVec3| (low.min(at), high.max(at));
        Some(self.vertices.iter().fold((first, first), grow))
    }

    /// Its surface, mm².
    pub fn area(&self) -> f64 {
        let area = |triangle| {
            let [a, b, c] = self.corners(triangle);
            0.5 * (b - a).cross(c - a).length()
        };
        (0..self.triangles.len() as u32).map(area).sum()
    }
}
