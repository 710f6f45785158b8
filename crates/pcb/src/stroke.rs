//! What a pen covers along a line or an arc.

use crate::contour::{Contour, Piece, hull};
use crate::{SAME, Transform};
use geom::{Element, Turn, Vec2};
use std::f64::consts::TAU;

/// What can be drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pen {
    /// A disc of this diameter, mm.
    Round(f64),
    /// A rectangle of this width and height, mm.
    Rectangle(Vec2),
}

impl Pen {
    /// The pieces of the area that it covers along `path` when it is transformed so; none where the pen
    /// has no size. A rectangle is taken along the chord of an arc: readers refuse those.
    pub(crate) fn sweep(&self, transform: &Transform, path: &Element) -> Vec<Piece> {
        match *self {
            Pen::Round(diameter) => round(diameter * transform.scale() / 2.0, path),
            Pen::Rectangle(size) => {
                let corner = |x: f64, y: f64| transform.apply(Vec2::new(x, y) * size / 2.0);
                let corners =
                    [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
                let ends = [path.start, path.end].map(|end| corners.map(|corner| end + corner));
                let outline = hull(ends.concat());
                let solid = outline.len() > 2;
                solid.then(|| Piece::new(true, Contour::polygon(&outline))).into_iter().collect()
            }
        }
    }
}

/// The corners of the smallest box around what a round pen covers, mm; `None` where it has no size.
pub(crate) fn extents(path: &Element, diameter: f64) -> Option<(Vec2, Vec2)> {
    let (low, high) = path.extents();
    (diameter > 0.0).then_some((low - diameter / 2.0, high + diameter / 2.0))
}

fn round(radius: f64, path: &Element) -> Vec<Piece> {
    let disc = |center: Vec2| Piece::new(true, Contour::circle(center, radius));
    if radius <= 0.0 {
        return Vec::new();
    }
    let Some(Turn { center, sweep }) = path.turn else {
        return vec![Piece::new(true, Contour::stadium(path.start, path.end, radius))];
    };
    let (outer, inner) =
        (path.start.distance(center) + radius, path.start.distance(center) - radius);
    if sweep.abs() >= TAU {
        let hole = (inner > SAME).then(|| Contour::circle(center, inner).reversed());
        let contours = [Contour::circle(center, outer)].into_iter().chain(hole).collect();
        return vec![Piece { solid: true, contours }];
    }
    // Between the two ends the nearest point of the arc is that on the same ray from its centre; beyond
    // them it is an end.
    let (first, last, sweep) = match sweep > 0.0 {
        true => (path.start, path.end, sweep),
        false => (path.end, path.start, -sweep),
    };
    let on_ray =
        |point: Vec2, radius: f64| center + (point - center).normalize_or_zero() * radius.max(0.0);
    let (a, b) = (on_ray(first, outer), on_ray(last, outer));
    let (c, d) = match inner > SAME {
        true => (on_ray(last, inner), on_ray(first, inner)),
        false => (center, center),
    };
    let mut sector = vec![Element::arc(a, b, center, sweep), Element::line(b, c)];
    if inner > SAME {
        sector.push(Element::arc(c, d, center, -sweep));
    }
    sector.push(Element::line(d, a));
    vec![Piece::new(true, Contour::new(sector)), disc(first), disc(last)]
}
