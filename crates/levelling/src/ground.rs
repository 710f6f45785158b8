//! What a program follows: a surface whose heights are known, or one that the control finds.

use geom::Vec2;
use program::Surface;
use program::heights::{HeightMap, within};

/// A surface.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Ground<'a> {
    /// Its heights are known.
    Known(&'a HeightMap),
    /// The control raises what counts from it: here it is flat. It rises by so much a mm along X and along Y, at most.
    Found(&'a Surface, f64),
}

/// The surface about a point, as long as no line of the grid is crossed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    /// How steep it is at most, mm per mm.
    pub(crate) slope: f64,
    /// Change of the slope along X with Y: the factor of XY in the height, 1/mm.
    pub(crate) twist: f64,
}

impl Ground<'_> {
    /// By how much a pose over `place` is raised here, mm.
    pub(crate) fn at(&self, place: Vec2) -> f64 {
        match self {
            Ground::Known(map) => map.at(place),
            Ground::Found(..) => 0.0,
        }
    }

    /// The highest that it can be, mm.
    pub(crate) fn highest(&self) -> f64 {
        match self {
            Ground::Known(map) => map.highest(),
            Ground::Found(surface, _) => surface.reach()[1],
        }
    }

    /// X of the columns and Y of the rows, rising, mm.
    pub(crate) fn lines(&self) -> [&[f64]; 2] {
        match self {
            Ground::Known(map) => map.lines(),
            Ground::Found(surface, _) => [surface.columns(), surface.rows()],
        }
    }

    /// The corners of the rectangle that is probed, mm.
    pub(crate) fn extents(&self) -> (Vec2, Vec2) {
        let ends = |lines: &[f64]| {
            let end = |line: Option<&f64>| line.copied().unwrap_or(f64::NAN);
            (end(lines.first()), end(lines.last()))
        };
        let [(left, right), (bottom, top)] = self.lines().map(ends);
        (Vec2::new(left, bottom), Vec2::new(right, top))
    }

    /// The surface about `place`, which lies on no line of the grid.
    pub(crate) fn patch(&self, place: Vec2) -> Patch {
        let (from, to) = self.extents();
        // Beyond an edge nothing changes across it.
        let inside = (place.x > from.x && place.x < to.x, place.y > from.y && place.y < to.y);
        match self {
            Ground::Known(map) => known(map, place, inside),
            Ground::Found(surface, steepness) => found(surface, *steepness, place, inside),
        }
    }
}

/// The surface of a map about `place`, which is within its edges along X, and along Y, or is not.
fn known(map: &HeightMap, place: Vec2, inside: (bool, bool)) -> Patch {
    let [columns, rows] = map.lines();
    let ((column, _), (row, _)) = (within(columns, place.x), within(rows, place.y));
    let [a, b, c, d] = map.corners(column, row);
    let (width, depth) = (columns[column + 1] - columns[column], rows[row + 1] - rows[row]);
    let along_x = if inside.0 { (b - a).abs().max((d - c).abs()) / width } else { 0.0 };
    let along_y = if inside.1 { (c - a).abs().max((d - b).abs()) / depth } else { 0.0 };
    let twist = if inside == (true, true) { (a - b - c + d) / (width * depth) } else { 0.0 };
    Patch { slope: along_x.hypot(along_y), twist }
}

/// The same of a surface that rises by `steepness` at most.
fn found(surface: &Surface, steepness: f64, place: Vec2, inside: (bool, bool)) -> Patch {
    let side = |lines: &[f64], at: f64| {
        let (before, _) = within(lines, at);
        lines[before + 1] - lines[before]
    };
    let (slope, twist) = match inside {
        (true, true) => {
            // Two opposite edges of the patch differ by twice what one rises, at most.
            let longest = side(surface.columns(), place.x).max(side(surface.rows(), place.y));
            (steepness * std::f64::consts::SQRT_2, 2.0 * steepness / longest)
        }
        (false, false) => (0.0, 0.0),
        _ => (steepness, 0.0),
    };
    Patch { slope, twist }
}
