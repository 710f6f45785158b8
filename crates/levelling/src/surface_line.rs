//! The height of the surface along a line or arc, in as few straight pieces as a tolerance allows.

use crate::ground::Ground;
use geom::{Arc, Vec2, Vec3};
use std::f64::consts::TAU;

/// The most points of one line at which the height is sampled.
const MOST: usize = 100_000;

/// A line or arc over the surface, from 0 at its start to 1 at its end.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SurfaceLine<'a> {
    /// Straight.
    Line(Vec3, Vec3),
    /// About the vertical.
    Arc(&'a Arc),
}

impl SurfaceLine<'_> {
    /// The point at `t`.
    pub(crate) fn at(&self, t: f64) -> Vec3 {
        match self {
            SurfaceLine::Line(from, to) if t < 1.0 => from.lerp(*to, t),
            SurfaceLine::Line(_, to) => *to,
            SurfaceLine::Arc(arc) => arc.at(t),
        }
    }

    /// How many turns it has; a line counts as half.
    fn turns(&self) -> f64 {
        match self {
            SurfaceLine::Line(..) => 0.5,
            SurfaceLine::Arc(arc) => arc.sweep / TAU,
        }
    }

    /// Where it crosses a line of the grid, in no order. An arc of several turns crosses it in each.
    fn crossings(&self, axis: usize, line: f64, crossings: &mut Vec<f64>) {
        match self {
            SurfaceLine::Line(from, to) => {
                let t = (line - from[axis]) / (to[axis] - from[axis]);
                crossings.extend(Some(t).filter(|t| *t > 0.0 && *t < 1.0));
            }
            SurfaceLine::Arc(arc) => {
                let from = arc.start - arc.center;
                let side = arc.normal.cross(from);
                // from · cos + side · sin reaches the line.
                let (radius, zero) = (from[axis].hypot(side[axis]), side[axis].atan2(from[axis]));
                let reach = ((line - arc.center[axis]) / radius).clamp(-2.0, 2.0);
                if reach.abs() > 1.0 {
                    return;
                }
                for angle in [zero + reach.acos(), zero - reach.acos()] {
                    let mut angle = angle.rem_euclid(TAU);
                    while angle < arc.sweep {
                        crossings.push(angle / arc.sweep);
                        angle += TAU;
                    }
                }
            }
        }
    }

    /// How many pieces the part from `from` to `to`, within one patch, needs so that the surface leaves no chord
    /// by more than `tolerance`: a part of length d (of 1) whose height has the second derivative f'' bulges by
    /// at most f'' d² / 8.
    fn parts(&self, ground: &Ground, from: f64, to: f64, tolerance: f64) -> usize {
        let middle = self.at((from + to) / 2.0);
        let patch = ground.patch(Vec2::new(middle.x, middle.y));
        let second = match self {
            SurfaceLine::Line(from, to) => {
                2.0 * (patch.twist * (to.x - from.x) * (to.y - from.y)).abs()
            }
            SurfaceLine::Arc(arc) => {
                let radius = arc.radius().max((arc.end - arc.center).truncate().length());
                let bend = radius * patch.slope + radius * radius * patch.twist.abs();
                bend * arc.sweep * arc.sweep
            }
        };
        ((to - from) * (second / (8.0 * tolerance)).sqrt()).ceil().max(1.0) as usize
    }
}

/// The points that divide a line into pieces, each with the height of the tool: between two of them a
/// height that changes evenly is within `tolerance` mm of the height over the surface. The last is the end.
/// `None` where the height would have to be sampled at too many points.
pub(crate) fn heights_along(
    along: SurfaceLine,
    ground: &Ground,
    tolerance: f64,
) -> Option<Vec<(f64, f64)>> {
    let [columns, rows] = ground.lines();
    // A line of the grid is crossed twice in a turn.
    let crossings = 2.0 * along.turns().ceil() * (columns.len() + rows.len()) as f64;
    if crossings > MOST as f64 {
        return None;
    }
    let mut seams = vec![0.0, 1.0];
    for (axis, lines) in [columns, rows].into_iter().enumerate() {
        lines.iter().for_each(|&line| along.crossings(axis, line, &mut seams));
    }
    seams.sort_by(f64::total_cmp);
    let height = |t: f64| {
        let point = along.at(t);
        point.z + ground.at(Vec2::new(point.x, point.y))
    };
    // Half of the tolerance for what lies between two samples, half for the samples: these are passed over where
    // their heights are known.
    let is_known = matches!(ground, Ground::Known(_));
    let half = if is_known { tolerance / 2.0 } else { tolerance };
    let mut samples = vec![(0.0, height(0.0))];
    for seam in seams.windows(2).filter(|seam| seam[1] > seam[0]) {
        let parts = along.parts(ground, seam[0], seam[1], half);
        if samples.len().saturating_add(parts) > MOST {
            return None;
        }
        samples.extend((1..=parts).map(|part| {
            let t = match part == parts {
                true => seam[1],
                false => seam[0] + (seam[1] - seam[0]) * part as f64 / parts as f64,
            };
            (t, height(t))
        }));
    }
    match is_known {
        true => Some(chords(&samples, half)),
        false => Some(samples.split_off(1)),
    }
}

/// The ends of chords from sample to sample that leave none of those between by more than `tolerance`: each
/// goes on for as long as some slope from its start would do for all of them.
fn chords(samples: &[(f64, f64)], tolerance: f64) -> Vec<(f64, f64)> {
    let mut ends = Vec::new();
    let Some(&(mut start)) = samples.first() else { return ends };
    let (mut least, mut most) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut last = start;
    for &(t, height) in &samples[1..] {
        let slope = |height: f64, start: (f64, f64)| (height - start.1) / (t - start.0);
        if !(least..=most).contains(&slope(height, start)) {
            ends.push(last);
            start = last;
            (least, most) = (f64::NEG_INFINITY, f64::INFINITY);
        }
        least = least.max(slope(height - tolerance, start));
        most = most.min(slope(height + tolerance, start));
        last = (t, height);
    }
    ends.push(last);
    ends
}
