//! What a program follows: a surface whose heights are known, or one that the control finds.

use crate::heights::{HeightMap, Patch, within};
use geom::Vec2;
use program::Surface;

/// A surface.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Ground<'a> {
    /// Its heights are known.
    Known(&'a HeightMap),
    /// The control raises what counts from it: here it is flat. It rises by so much a mm along X and along Y, at most.
    Found(&'a Surface, f64),
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
        let (surface, steepness) = match self {
            Ground::Known(map) => return map.patch(place),
            Ground::Found(surface, steepness) => (surface, *steepness),
        };
        let (from, to) = self.extents();
        let side = |lines: &[f64], at: f64| {
            let (before, _) = within(lines, at);
            lines[before + 1] - lines[before]
        };
        // Beyond an edge nothing changes across it.
        let inside = (place.x > from.x && place.x < to.x, place.y > from.y && place.y < to.y);
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
}
