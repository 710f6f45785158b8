//! How high a surface is, between the places where that is known; and a program as it runs over one.

use crate::{Diagnostic, Op, Pose, Program, Rule};
use geom::{Vec2, Vec3};

/// Heights on a grid of any spacing. Between its places the surface is bilinear, outside it is as high as at
/// the nearest place of the edge: the meaning of [`Op::Surface`], once its places have been probed.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    /// X of the columns, rising, mm; two at least.
    columns: Vec<f64>,
    /// Y of the rows, rising, mm; two at least.
    rows: Vec<f64>,
    /// Row after row, mm.
    heights: Vec<f64>,
}

impl HeightMap {
    /// The map of heights on columns and rows: row after row, mm.
    ///
    /// # Errors
    /// Fewer than two columns or rows, or not rising; other than one height for each place.
    pub fn on(
        columns: Vec<f64>,
        rows: Vec<f64>,
        heights: Vec<f64>,
    ) -> Result<HeightMap, Box<Diagnostic>> {
        let rise = |lines: &[f64]| lines.len() >= 2 && lines.windows(2).all(|two| two[0] < two[1]);
        let places = columns.len().saturating_mul(rows.len());
        if rise(&columns) && rise(&rows) && heights.len() == places {
            return Ok(HeightMap { columns, rows, heights });
        }
        let (columns, rows, heights) = (columns.len(), rows.len(), heights.len());
        let message = format!("{heights} heights on {columns} columns and {rows} rows");
        let help = "one at each place of two columns and two rows at least, that rise";
        Err(Diagnostic::error(Rule::HeightMap, message).help(help).into())
    }

    /// Height of the surface, mm.
    pub fn at(&self, place: Vec2) -> f64 {
        let (column, x) = within(&self.columns, place.x);
        let (row, y) = within(&self.rows, place.y);
        let [a, b, c, d] = self.corners(column, row);
        let (low, high) = (a + (b - a) * x, c + (d - c) * x);
        low + (high - low) * y
    }

    /// The highest place, mm.
    pub fn highest(&self) -> f64 {
        self.heights.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The lowest place, mm.
    pub fn lowest(&self) -> f64 {
        self.heights.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// X of the columns and Y of the rows, rising, mm.
    pub fn lines(&self) -> [&[f64]; 2] {
        [&self.columns, &self.rows]
    }

    /// The heights about the rectangle behind a column and a row, mm: at its lower left, lower right, upper left
    /// and upper right corner.
    ///
    /// # Panics
    /// Where the map has no such rectangle: [`within`] finds one that it has.
    pub fn corners(&self, column: usize, row: usize) -> [f64; 4] {
        let at = |column: usize, row: usize| self.heights[row * self.columns.len() + column];
        [at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)]
    }

    /// `program` as a control runs it that finds these heights: each pose that counts from its [`Op::Surface`] raised
    /// to them.
    ///
    /// # Errors
    /// `no-pose` where a height is not finite.
    pub fn raise(&self, program: &Program) -> Result<Program, Box<Diagnostic>> {
        let mut clear = f64::NEG_INFINITY;
        let mut program = program.clone();
        for record in &mut program.records {
            if let Op::Surface(surface) = &record.op {
                clear = surface.clear();
            }
            let Some(pose) = end(&mut record.op).filter(|pose| pose.point().z < clear) else {
                continue;
            };
            let point = pose.point();
            *pose = pose.at(point + Vec3::Z * self.at(point.truncate()))?;
        }
        Ok(program)
    }
}

/// The end of a move that a control counts from a surface.
fn end(op: &mut Op) -> Option<&mut Pose> {
    if let Op::Rapid(pose) | Op::Line(pose) | Op::Hole(pose) = op {
        Some(pose)
    } else if let Op::Arc(arc) = op {
        Some(&mut arc.end)
    } else if let Op::Thread(thread) = op {
        Some(&mut thread.end)
    } else {
        None
    }
}

/// The line before a coordinate, or the last but one, and how far it is from there to the next, from 0 to 1.
pub fn within(lines: &[f64], value: f64) -> (usize, f64) {
    let before = lines.partition_point(|&line| line <= value).saturating_sub(1);
    let before = before.min(lines.len() - 2);
    let (from, to) = (lines[before], lines[before + 1]);
    (before, ((value - from) / (to - from)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(columns: &[f64], rows: &[f64], heights: &[f64]) -> Result<HeightMap, Box<Diagnostic>> {
        HeightMap::on(columns.to_vec(), rows.to_vec(), heights.to_vec())
    }

    #[test]
    fn between_four_places_the_surface_is_bilinear() {
        let map = on(&[0.0, 10.0], &[0.0, 20.0], &[0.0, 1.0, 2.0, 5.0]).unwrap();
        // By hand: 0 + 1·x + 2·y + 2·xy with x and y from 0 to 1.
        for (x, y, height) in
            [(0.0, 0.0, 0.0), (5.0, 0.0, 0.5), (5.0, 10.0, 2.0), (10.0, 20.0, 5.0)]
        {
            assert_eq!(map.at(Vec2::new(x, y)), height, "{x} {y}");
        }
        // As high as at the edge.
        assert_eq!(map.at(Vec2::new(-3.0, 10.0)), 1.0);
        assert_eq!(map.at(Vec2::new(50.0, 50.0)), 5.0);
        assert_eq!((map.lowest(), map.highest()), (0.0, 5.0));
    }

    #[test]
    fn heights_on_lines_that_do_not_rise_are_no_map() {
        let map = on(&[0.0, 0.01], &[0.0, 20.0], &[0.0, 1.0, 2.0, 5.0]).unwrap();
        assert_eq!(map.at(Vec2::new(0.005, 10.0)), 2.0);
        for columns in [&[0.0][..], &[1.0, 1.0], &[2.0, 1.0], &[0.0, f64::NAN], &[0.0, 1.0, 2.0]] {
            assert_eq!(on(columns, &[0.0, 1.0], &[0.0; 4]).unwrap_err().rule, "height-map");
        }
    }
}
