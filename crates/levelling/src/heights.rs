//! How high a surface is, between the places where that is known.

use geom::{Vec2, Vec3};
use program::Diagnostic;

/// Coordinates that lie no further apart are those of one line of the grid, mm: machines answer in steps.
pub(crate) const APART: f64 = 0.05;

/// The highest and the lowest that a surface is believed to be, mm from Z 0: what lies further is no
/// surface that somebody has set to 0, but perhaps counted from the machine's home.
const FARTHEST: f64 = 10.0;

/// Heights on a grid of any spacing. Between its places the surface is bilinear, outside it is as high as at
/// the nearest place of the edge.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    /// X of the columns, rising, mm; two at least.
    columns: Vec<f64>,
    /// Y of the rows, rising, mm; two at least.
    rows: Vec<f64>,
    /// Row after row, mm.
    heights: Vec<f64>,
}

/// The surface about a point, as long as no line of the grid is crossed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    /// How steep it is at most, mm per mm.
    pub(crate) slope: f64,
    /// Change of the slope along X with Y: the factor of XY in the height, 1/mm.
    pub(crate) twist: f64,
}

impl HeightMap {
    /// The map of points that lie on a grid, in any order, mm. Places that are within 0.05 mm of a line of the
    /// grid are on it.
    ///
    /// # Errors
    /// Fewer than two columns or rows, a place without a point or with two heights, lines of the grid that
    /// nearly coincide, a coordinate that is no number, a height more than 10 mm from 0.
    pub fn of(points: &[Vec3]) -> Result<HeightMap, Box<Diagnostic>> {
        if let Some(point) = points.iter().find(|point| !point.is_finite()) {
            let message = format!("X{} Y{} Z{}: this is no place", point.x, point.y, point.z);
            return Err(refused(message, "probe the surface anew"));
        }
        if let Some(point) = points.iter().find(|point| point.z.abs() > FARTHEST) {
            let message = format!("the surface is at Z{} mm at X{} Y{}", point.z, point.x, point.y);
            let help = "heights count from the zero of the work, where the surface is about 0: these \
                        may count from the machine's";
            return Err(refused(message, help));
        }
        let columns = lines("X", points.iter().map(|point| point.x).collect())?;
        let rows = lines("Y", points.iter().map(|point| point.y).collect())?;
        let places = columns.len().saturating_mul(rows.len());
        let grid = || format!("{} columns and {} rows", columns.len(), rows.len());
        if columns.len() < 2 || rows.len() < 2 {
            let message = format!("{} points in {}", points.len(), grid());
            return Err(refused(message, "2 columns and 2 rows are needed"));
        }
        let whole = "keep the points of one probing, and all of them";
        if places > points.len() {
            let message = format!(
                "{} points lie on {}, which have {places} places: they make no grid",
                points.len(),
                grid()
            );
            return Err(refused(message, whole));
        }
        let mut heights = vec![f64::NAN; places];
        for point in points {
            let place = near(&rows, point.y) * columns.len() + near(&columns, point.x);
            let Some(height) = heights.get_mut(place) else { continue };
            if !height.is_nan() && *height != point.z {
                let message = format!(
                    "two heights at X{} Y{}: {height} and {} mm",
                    point.x, point.y, point.z
                );
                return Err(refused(message, whole));
            }
            *height = point.z;
        }
        if let Some(place) = heights.iter().position(|height| height.is_nan()) {
            let (x, y) = (columns[place % columns.len()], rows[place / columns.len()]);
            return Err(refused(format!("there is no height at X{x} Y{y}"), whole));
        }
        HeightMap::on(columns, rows, heights)
    }

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
        Err(refused(message, "one at each place of two columns and two rows at least, that rise"))
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

    /// The corners of the rectangle that was probed, mm.
    fn extents(&self) -> (Vec2, Vec2) {
        let ends = |lines: &[f64]| (lines[0], lines[lines.len() - 1]);
        let ((left, right), (bottom, top)) = (ends(&self.columns), ends(&self.rows));
        (Vec2::new(left, bottom), Vec2::new(right, top))
    }

    /// X of the columns and Y of the rows, rising, mm.
    pub(crate) fn lines(&self) -> [&[f64]; 2] {
        [&self.columns, &self.rows]
    }

    /// The surface about `place`, which lies on no line of the grid.
    pub(crate) fn patch(&self, place: Vec2) -> Patch {
        let (from, to) = self.extents();
        let (column, _) = within(&self.columns, place.x);
        let (row, _) = within(&self.rows, place.y);
        let [a, b, c, d] = self.corners(column, row);
        let width = self.columns[column + 1] - self.columns[column];
        let depth = self.rows[row + 1] - self.rows[row];
        // Beyond an edge nothing changes across it.
        let (inside_x, inside_y) =
            (place.x > from.x && place.x < to.x, place.y > from.y && place.y < to.y);
        let along_x = if inside_x { (b - a).abs().max((d - c).abs()) / width } else { 0.0 };
        let along_y = if inside_y { (c - a).abs().max((d - b).abs()) / depth } else { 0.0 };
        let twist = if inside_x && inside_y { (a - b - c + d) / (width * depth) } else { 0.0 };
        Patch { slope: along_x.hypot(along_y), twist }
    }

    /// The heights about the rectangle behind a column and a row: at its lower left, lower right, upper left
    /// and upper right corner.
    fn corners(&self, column: usize, row: usize) -> [f64; 4] {
        let at = |column: usize, row: usize| self.heights[row * self.columns.len() + column];
        [at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)]
    }
}

/// The lines of a grid, rising, on which these coordinates lie.
fn lines(axis: &str, mut values: Vec<f64>) -> Result<Vec<f64>, Box<Diagnostic>> {
    values.sort_by(f64::total_cmp);
    let mut lines: Vec<f64> = Vec::new();
    for line in values.chunk_by(|a, b| b - a <= APART) {
        let (first, last) = (line[0], line[line.len() - 1]);
        if last - first > APART {
            let message =
                format!("points lie at every distance from {axis}{first} to {axis}{last}");
            return Err(refused(message, "the places of a grid are needed, on columns and rows"));
        }
        lines.push((first + last) / 2.0);
    }
    Ok(lines)
}

/// The line that is nearest to a coordinate.
fn near(lines: &[f64], value: f64) -> usize {
    let after = lines.partition_point(|&line| line < value - APART);
    after.min(lines.len() - 1)
}

/// The line before a coordinate, or the last but one, and how far it is from there to the next, from 0 to 1.
pub(crate) fn within(lines: &[f64], value: f64) -> (usize, f64) {
    let before = lines.partition_point(|&line| line <= value).saturating_sub(1);
    let before = before.min(lines.len() - 2);
    let (from, to) = (lines[before], lines[before + 1]);
    (before, ((value - from) / (to - from)).clamp(0.0, 1.0))
}

fn refused(message: String, help: &str) -> Box<Diagnostic> {
    Diagnostic::error("height-map", message).help(help).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two columns 10 mm apart, two rows 20 mm apart.
    fn four(heights: [f64; 4]) -> Vec<Vec3> {
        let places = [(0.0, 0.0), (10.0, 0.0), (0.0, 20.0), (10.0, 20.0)];
        places.iter().zip(heights).map(|(&(x, y), z)| Vec3::new(x, y, z)).collect()
    }

    #[test]
    fn between_four_places_the_surface_is_bilinear() {
        let map = HeightMap::of(&four([0.0, 1.0, 2.0, 5.0])).unwrap();
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
    fn places_in_any_order_and_off_by_a_step_are_a_grid() {
        let mut points = four([0.0, 1.0, 2.0, 5.0]);
        points.reverse();
        points[1].x += 0.004;
        // The same once more, as GRBL's `$#` says the last.
        points.push(points[0]);
        let map = HeightMap::of(&points).unwrap();
        assert_eq!(map.lines(), [&[0.002, 10.0][..], &[0.0, 20.0]]);
        assert!((map.at(Vec2::new(10.0, 20.0)) - 5.0).abs() < 1e-12);
    }

    #[test]
    fn heights_on_lines_that_do_not_rise_are_no_map() {
        let on = |columns: &[f64], rows: &[f64], heights: &[f64]| {
            HeightMap::on(columns.to_vec(), rows.to_vec(), heights.to_vec())
        };
        let map = on(&[0.0, 0.01], &[0.0, 20.0], &[0.0, 1.0, 2.0, 5.0]).unwrap();
        assert_eq!(map.at(Vec2::new(0.005, 10.0)), 2.0);
        for columns in [&[0.0][..], &[1.0, 1.0], &[2.0, 1.0], &[0.0, f64::NAN], &[0.0, 1.0, 2.0]] {
            assert_eq!(on(columns, &[0.0, 1.0], &[0.0; 4]).unwrap_err().rule, "height-map");
        }
    }

    #[track_caller]
    fn refuses(points: &[Vec3], message: &str) {
        let found = HeightMap::of(points).unwrap_err();
        assert_eq!(found.rule, "height-map");
        assert!(found.message.contains(message), "{found}");
    }

    #[test]
    fn what_is_no_grid_is_refused() {
        refuses(&[], "0 points in 0 columns");
        refuses(&four([0.0; 4])[..2], "2 columns and 1 rows");
        refuses(&four([0.0; 4])[..3], "3 points lie on 2 columns and 2 rows, which have 4 places");
        let mut twice = four([0.0; 4]);
        twice.push(Vec3::new(10.0, 0.0, 0.3));
        refuses(&twice, "two heights at X10 Y0: 0 and 0.3 mm");
        // As many points as places, two at one of them.
        let mut missing = four([0.0; 4]);
        missing[3] = missing[0];
        refuses(&missing, "there is no height at X10 Y20");
        let mut broken = four([0.0; 4]);
        broken[2].z = f64::NAN;
        refuses(&broken, "this is no place");
        refuses(&four([-45.2, -45.1, -45.3, -45.2]), "Z-45.2");
        let smeared: Vec<Vec3> =
            (0..100).map(|n| Vec3::new(f64::from(n) * 0.03, f64::from(n), 0.0)).collect();
        refuses(&smeared, "at every distance from X0");
        // A million scattered points are no grid of 10^12 places.
        let scattered: Vec<Vec3> =
            (0..100_000).map(|n| Vec3::new(f64::from(n), f64::from(n), 0.0)).collect();
        refuses(&scattered, "make no grid");
    }
}
