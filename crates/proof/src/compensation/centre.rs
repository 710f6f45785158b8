//! The path of the tool's centre against the contour that it has to cut.
//!
//! Nothing here knows how a control works the path out. Parallel to each element of the contour the centre has to run at the radius of
//! the tool; between two of them it may take any way that does not come nearer to either, nor farther from the corner than any
//! control goes; and what it leaves out of an element must be what the next one keeps the tool from.

use super::trail::{CompensatedMoves, Piece};
use crate::resolved_pose::Number;
use geom::{Element, Turn, Vec2, Vec3};

/// How far from an outer corner the centre may be, in radii of the tool: where the parallels cross at a turn of 100° (SINUMERIK
/// `G451`) it is 1.556, on FANUC's way around a sharper one 1.414.
const FARTHEST: f64 = 1.6;

/// Samples of a way that is held off the contour.
const SAMPLES: u32 = 32;

/// A move shorter than this goes nowhere in the plane, mm.
const NOWHERE: f64 = 1e-6;

/// Where the path is wrong, by line of the program, and how.
pub(super) type Fault = (u32, String);

/// A move in the plane.
#[derive(Clone, Copy)]
struct PlaneMove {
    line: u32,
    element: Element,
    /// Height above the plane at its end, mm.
    height: f64,
}

/// Both paths in the plane.
struct PlanePaths {
    contour: Vec<PlaneMove>,
    /// The parallel of each element of the contour at the radius of the tool.
    parallel: Vec<Element>,
    /// The path of the centre.
    ways: Vec<PlaneMove>,
    radius: f64,
    /// How near is near enough, mm.
    slack: f64,
}

/// Compares the path of the centre with the contour of `stretch`, to which it has to run parallel at `radius` mm.
///
/// # Errors
/// Where it cuts into the contour, or leaves something of it.
pub(super) fn compare(
    stretch: &CompensatedMoves,
    path: &[Piece],
    radius: f64,
    left: f64,
    slack: f64,
) -> Result<(), Fault> {
    let Some(first) = stretch.pieces.first() else { return Ok(()) };
    let axis = first.to.axis;
    let ways = |pieces: &[Piece]| -> Result<Vec<PlaneMove>, Fault> {
        let ways = pieces.iter().map(|piece| flat(piece, axis));
        let ways: Vec<PlaneMove> = ways.collect::<Result<_, _>>()?;
        Ok(ways.into_iter().filter(|way| way.element.length() > NOWHERE).collect())
    };
    let (contour, ways) = (ways(&stretch.pieces)?, ways(path)?);
    let parallel = contour.iter().map(|way| parallel_of(way, left * radius));
    let parallel = parallel.collect::<Result<_, _>>()?;
    PlanePaths { contour, parallel, ways, radius, slack }.compare()
}

impl PlanePaths {
    fn compare(&self) -> Result<(), Fault> {
        // The first move only leads to the contour.
        let mut next = 0;
        let mut last: Option<(usize, [f64; 2])> = None;
        for k in 1..self.contour.len() {
            let found = (next..self.ways.len())
                .find_map(|i| self.covered(k, &self.ways[i].element).map(|part| (i, part)));
            let Some((i, part)) = found else {
                let message = "nowhere leads the tool's centre along this block";
                return Err((self.contour[k].line, message.into()));
            };
            match last {
                None => self.way_in(i, part)?,
                Some((before, earlier)) => self.corner(k, [before, i], [earlier, part])?,
            }
            self.same_height(k, i)?;
            (last, next) = (Some((i, part)), i + 1);
        }
        last.map_or(Ok(()), |(i, part)| self.way_out(i, part))
    }

    /// Along which part of element `k` the centre runs on `way`, as lengths along the parallel, mm.
    fn covered(&self, k: usize, way: &Element) -> Option<[f64; 2]> {
        let leg = &self.parallel[k];
        let [from, to] = match (leg.turn, way.turn) {
            (None, None) => {
                let along = leg.tangent(0.0);
                let place = |point: Vec2| {
                    let from = point - leg.start;
                    (from.dot(along), from.perp_dot(along).abs())
                };
                let ((from, off), (to, other)) = (place(way.start), place(way.end));
                (off.max(other) <= self.slack).then_some([from, to])?
            }
            (Some(turn), Some(other)) => {
                let radius = leg.start.distance(turn.center);
                let off = |point: Vec2| (point.distance(turn.center) - radius).abs();
                let apart =
                    turn.center.distance(other.center).max(off(way.start)).max(off(way.end));
                if apart > self.slack || turn.sweep * other.sweep <= 0.0 {
                    return None;
                }
                let (spoke, to) = (leg.start - turn.center, way.start - turn.center);
                let angle = spoke.angle_to(to) * turn.sweep.signum();
                [angle * radius, (angle + other.sweep.abs()) * radius]
            }
            (Some(_), None) | (None, Some(_)) => return None,
        };
        let shared = to.min(leg.length()) - from.max(0.0);
        (shared > self.slack.min(leg.length() / 4.0)).then_some([from, to])
    }

    /// From way `i` along one element to way `j` along the next, `k`.
    fn corner(
        &self,
        k: usize,
        [i, j]: [usize; 2],
        [part, next]: [[f64; 2]; 2],
    ) -> Result<(), Fault> {
        let (before, after) = (&self.contour[k - 1], &self.contour[k]);
        for way in &self.ways[i..=j] {
            for element in [&before.element, &after.element] {
                let near = samples(&way.element).map(|point| element.nearest(point).1);
                self.holds_off(
                    near.fold(f64::INFINITY, f64::min),
                    self.radius,
                    way.line,
                    after.line,
                )?;
            }
        }
        let corner = after.element.start;
        let between = self.ways[i + 1..j].iter();
        let ends =
            between.flat_map(|way| [way.element.start, way.element.at(0.5), way.element.end]);
        self.not_far(corner, ends, after.line)?;
        let length = self.parallel[k - 1].length();
        if part[1] > length {
            self.not_far(corner, [self.ways[i].element.end], after.line)?;
        }
        if next[0] < 0.0 {
            self.not_far(corner, [self.ways[j].element.start], after.line)?;
        }
        self.left_out(k - 1, [part[1], length], &after.element)?;
        self.left_out(k, [0.0, next[0]], &before.element)
    }

    /// The way to the contour, up to way `i` along its first element.
    fn way_in(&self, i: usize, part: [f64; 2]) -> Result<(), Fault> {
        let (entry, first) = (&self.contour[0], &self.contour[1]);
        let start = first.element.nearest(entry.element.start).1;
        for way in &self.ways[..i] {
            let near = samples(&way.element).map(|point| first.element.nearest(point));
            // At its very start the tool comes as near as its way leads.
            let near = near.filter(|(t, _)| *t > 0.0).map(|(_, near)| near);
            let near = near.fold(f64::INFINITY, f64::min);
            self.holds_off(near, self.radius.min(start), way.line, first.line)?;
        }
        if part[0] < 0.0 {
            self.not_far(first.element.start, [self.ways[i].element.start], first.line)?;
        }
        self.left_out(1, [0.0, part[0]], &entry.element)
    }

    /// The way off the contour, after way `i` along its last element.
    fn way_out(&self, i: usize, part: [f64; 2]) -> Result<(), Fault> {
        let Some(k) = self.contour.len().checked_sub(1) else { return Ok(()) };
        let last = &self.contour[k];
        let length = self.parallel[k].length();
        if part[1] < length - self.slack {
            let left = Number(length - part[1]);
            return Err((
                last.line,
                format!("the tool leaves {left} mm before the end of the contour"),
            ));
        }
        if part[1] > length + self.slack && i + 1 < self.ways.len() {
            let past = Number(part[1] - length);
            return Err((
                last.line,
                format!("the tool goes {past} mm past the end of the contour"),
            ));
        }
        let Some(end) = self.ways.last() else { return Ok(()) };
        let end = last.element.nearest(end.element.end).1;
        for way in &self.ways[i + 1..] {
            let near = samples(&way.element).map(|point| last.element.nearest(point));
            let near = near.filter(|(t, _)| *t < 1.0).map(|(_, near)| near);
            let near = near.fold(f64::INFINITY, f64::min);
            self.holds_off(near, self.radius.min(end), way.line, last.line)?;
        }
        Ok(())
    }

    /// The centre is no nearer to an element than this.
    fn holds_off(&self, near: f64, least: f64, line: u32, of: u32) -> Result<(), Fault> {
        if near >= least - self.slack {
            return Ok(());
        }
        let deep = Number(least - near);
        Err((line, format!("the tool cuts {deep} mm into the contour of the block in line {of}")))
    }

    /// On its way around a corner the centre does not go far.
    fn not_far(
        &self,
        corner: Vec2,
        points: impl IntoIterator<Item = Vec2>,
        line: u32,
    ) -> Result<(), Fault> {
        let far = points.into_iter().map(|point| point.distance(corner)).fold(0.0, f64::max);
        if far <= FARTHEST * self.radius + self.slack {
            return Ok(());
        }
        Err((
            line,
            format!("before this block the tool's centre is {} mm off the corner", Number(far)),
        ))
    }

    /// Each point of element `k` along which the centre does not run, from and to in mm, is one from which `other` keeps the tool.
    fn left_out(&self, k: usize, [from, to]: [f64; 2], other: &Element) -> Result<(), Fault> {
        let leg = &self.parallel[k];
        let length = leg.length();
        if to - from <= self.slack || length <= 0.0 {
            return Ok(());
        }
        // Where both part, rounding moves the crossing along them.
        let reached = |i: u32| {
            let part = (f64::from(i) + 0.5) / f64::from(SAMPLES);
            let point = leg.at((from + part * (to - from)) / length);
            other.nearest(point).1 > self.radius + self.slack
        };
        match (0..SAMPLES).any(reached) {
            true => {
                let message =
                    format!("the tool leaves {} mm of the contour uncut", Number(to - from));
                Err((self.contour[k].line, message))
            }
            false => Ok(()),
        }
    }

    fn same_height(&self, k: usize, i: usize) -> Result<(), Fault> {
        let (wanted, is) = (self.contour[k].height, self.ways[i].height);
        if (wanted - is).abs() <= self.slack {
            return Ok(());
        }
        Err((self.ways[i].line, format!("the tool ends {} mm too high", Number(is - wanted))))
    }
}

/// Points of an element, both ends among them.
fn samples(element: &Element) -> impl Iterator<Item = Vec2> + '_ {
    (0..=SAMPLES).map(|i| element.at(f64::from(i) / f64::from(SAMPLES)))
}

/// A move seen along the tool.
fn flat(piece: &Piece, axis: Vec3) -> Result<PlaneMove, Fault> {
    let x = axis.any_orthonormal_vector();
    let y = axis.cross(x);
    let flat = |point: Vec3| Vec2::new(point.dot(x), point.dot(y));
    let (start, end) = (flat(piece.from.tip), flat(piece.to.tip));
    if geom::angle_between(piece.to.axis, axis) > geom::ANGLE_EPSILON {
        return Err((piece.line, "the tool turns while compensation is on".into()));
    }
    let turn = match piece.arc {
        None => None,
        Some(arc) if arc.normal.dot(axis).abs() > 1.0 - geom::ANGLE_EPSILON => {
            let sweep = arc.sweep * arc.normal.dot(axis).signum();
            Some(Turn { center: flat(arc.center), sweep })
        }
        Some(_) => {
            return Err((piece.line, "an arc in another plane than that of the tool".into()));
        }
    };
    let element = Element { start, end, turn };
    Ok(PlaneMove { line: piece.line, element, height: piece.to.tip.dot(axis) })
}

/// The parallel of an element, so many mm to its left.
fn parallel_of(way: &PlaneMove, left: f64) -> Result<Element, Fault> {
    let Element { start, end, turn } = way.element;
    let Some(Turn { center, sweep }) = turn else {
        let aside = way.element.tangent(0.0).perp() * left;
        return Ok(Element::line(start + aside, end + aside));
    };
    let radius = start.distance(center);
    let grown = radius - left * sweep.signum();
    if grown <= 0.0 {
        let message =
            format!("an arc of radius {} mm, into which the tool does not fit", Number(radius));
        return Err((way.line, message));
    }
    let out = |point: Vec2| center + (point - center) * (grown / radius);
    Ok(Element { start: out(start), end: out(end), turn })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compensation::trail::Terms;
    use crate::resolved_pose::PartialPose;
    use geom::Arc;
    use program::Compensation;

    /// Where a move ends; of an arc also the centre, and whether it turns right.
    type End = ([f64; 2], Option<([f64; 2], bool)>);

    /// Moves through these points at Z -1, each on a line of its own.
    fn pieces(start: [f64; 2], ends: &[End]) -> Vec<Piece> {
        let place = |[x, y]: [f64; 2]| PartialPose { tip: Vec3::new(x, y, -1.0), axis: Vec3::Z };
        let mut from = place(start);
        let piece = |(line, (end, turn)): (u32, &End)| {
            let to = place(*end);
            let arc = turn.map(|([x, y], right)| {
                let normal = if right { Vec3::NEG_Z } else { Vec3::Z };
                Arc::new(from.tip, to.tip, Vec3::new(x, y, -1.0), normal, 0, 0.01).unwrap()
            });
            Piece { line, from: std::mem::replace(&mut from, to), to, arc }
        };
        (1..).zip(ends).map(piece).collect()
    }

    /// In from (-20, 0), along Y 0 to (30, 0), around the outer corner down to (30, -30), around the inner one to (60, -30), and
    /// out; the tool is on the left.
    fn stretch() -> CompensatedMoves {
        let side = Compensation::Left(None);
        let terms = Terms { source_line: 1, side, radius: Some(5.0), tool_length: None };
        let ends = [[0.0, 0.0], [30.0, 0.0], [30.0, -30.0], [60.0, -30.0]];
        let pieces = pieces([-20.0, 0.0], &ends.map(|end| (end, None)));
        CompensatedMoves { terms, before: 0, pieces, exit: None }
    }

    /// What a control makes of it with a tool of radius 5: every corner by hand.
    const PATH: [End; 6] = [
        ([0.0, 5.0], None),
        ([30.0, 5.0], None),
        ([35.0, 0.0], Some(([30.0, 0.0], true))),
        ([35.0, -25.0], None),
        ([60.0, -25.0], None),
        ([80.0, -25.0], None),
    ];

    fn judged(path: &[End]) -> Result<(), Fault> {
        compare(&stretch(), &pieces([-20.0, 0.0], path), 5.0, 1.0, 0.003)
    }

    #[test]
    fn each_way_around_a_corner_that_keeps_off_it_is_taken() {
        assert_eq!(judged(&PATH), Ok(()));
        // To where the parallels cross.
        let mut crossing = PATH.to_vec();
        crossing.remove(2);
        crossing[1].0 = [35.0, 5.0];
        assert_eq!(judged(&crossing), Ok(()));
        // On, straight over, and back from behind.
        let mut polygon = PATH.to_vec();
        polygon[1].0 = [32.5, 5.0];
        polygon[2] = ([35.0, 2.5], None);
        assert_eq!(judged(&polygon), Ok(()));
    }

    #[test]
    fn a_path_that_cuts_the_contour_or_leaves_some_of_it_is_refused() {
        let damaged = |what: &str, damage: &dyn Fn(&mut Vec<End>)| {
            let mut path = PATH.to_vec();
            damage(&mut path);
            assert!(judged(&path).is_err(), "{what}");
        };
        damaged("the corner is cut straight", &|path| path[2].1 = None);
        damaged("the way is 0.01 mm too near", &|path| {
            (path[0].0, path[1].0) = ([0.0, 4.99], [30.0, 4.99]);
        });
        damaged("the way is 0.01 mm too far", &|path| {
            (path[0].0, path[1].0) = ([0.0, 5.01], [30.0, 5.01]);
        });
        damaged("the first element is left early", &|path| {
            path[1].0 = [29.9, 5.0];
            path[2] = ([35.0, 0.0], None);
        });
        damaged("the inner corner is overrun", &|path| {
            path[3].0 = [35.0, -25.1];
            path.insert(4, ([35.0, -25.0], None));
        });
        damaged("the inner corner is left out", &|path| {
            path[3].0 = [35.0, -20.0];
            path[4] = ([40.0, -25.0], None);
            path.insert(5, ([60.0, -25.0], None));
        });
        damaged("the corner is far away", &|path| {
            path[1].0 = [45.0, 5.0];
            path[2] = ([35.0, -5.0], None);
        });
        damaged("an element is missing", &|path| {
            path.remove(3);
        });
        damaged("the last element is overrun", &|path| path[4].0 = [61.0, -25.0]);
        damaged("the way in begins far behind", &|path| {
            path.insert(0, ([-15.0, 5.0], None));
            path.remove(1);
        });
        damaged("the last element ends early", &|path| path[4].0 = [59.9, -25.0]);
        damaged("the way out cuts it", &|path| path[5].0 = [50.0, -40.0]);
        // As it was written and proven before: the radius twice, and not at all.
        damaged("it is offset twice", &|path| {
            *path = vec![
                ([0.0, 10.0], None),
                ([30.0, 10.0], None),
                ([40.0, 0.0], Some(([30.0, 0.0], true))),
                ([40.0, -20.0], None),
                ([60.0, -20.0], None),
                ([80.0, -20.0], None),
            ];
        });
        damaged("it is not offset", &|path| {
            *path = [[0.0, 0.0], [30.0, 0.0], [30.0, -30.0], [60.0, -30.0], [80.0, -30.0]]
                .map(|end| (end, None))
                .to_vec();
        });
    }
}
