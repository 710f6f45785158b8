//! The heights of a surface from points of it.

use geom::Vec3;
use program::{Diagnostic, Rule, heights::HeightMap};

/// Coordinates that lie no further apart are those of one line of the grid, mm: machines answer in steps.
pub(crate) const APART: f64 = 0.05;

/// The highest and the lowest that a surface is believed to be, mm from Z 0: what lies further is no
/// surface that somebody has set to 0, but perhaps counted from the machine's home.
const FARTHEST: f64 = 10.0;

/// The map of points that lie on a grid, in any order, mm. Places that are within 0.05 mm of a line of the
/// grid are on it.
///
/// # Errors
/// Fewer than two columns or rows, a place without a point or with two heights, lines of the grid that
/// nearly coincide, a coordinate that is no number, a height more than 10 mm from 0.
pub fn height_map(points: &[Vec3]) -> Result<HeightMap, Box<Diagnostic>> {
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
            let message =
                format!("two heights at X{} Y{}: {height} and {} mm", point.x, point.y, point.z);
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

fn refused(message: String, help: &str) -> Box<Diagnostic> {
    Diagnostic::error(Rule::HeightMap, message).help(help).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec2;

    /// Two columns 10 mm apart, two rows 20 mm apart.
    fn four(heights: [f64; 4]) -> Vec<Vec3> {
        let places = [(0.0, 0.0), (10.0, 0.0), (0.0, 20.0), (10.0, 20.0)];
        places.iter().zip(heights).map(|(&(x, y), z)| Vec3::new(x, y, z)).collect()
    }

    #[test]
    fn places_in_any_order_and_off_by_a_step_are_a_grid() {
        let mut points = four([0.0, 1.0, 2.0, 5.0]);
        points.reverse();
        points[1].x += 0.004;
        // The same once more, as GRBL's `$#` says the last.
        points.push(points[0]);
        let map = height_map(&points).unwrap();
        assert_eq!(map.lines(), [&[0.002, 10.0][..], &[0.0, 20.0]]);
        assert!((map.at(Vec2::new(10.0, 20.0)) - 5.0).abs() < 1e-12);
    }

    #[track_caller]
    fn refuses(points: &[Vec3], message: &str) {
        let found = height_map(points).unwrap_err();
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
