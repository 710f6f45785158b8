//! Where an arm stands on its rail: one place for as many cuts as it reaches well from there. Between two of these places the rail goes
//! with a rapid, beyond all cuts; in a cut it never moves.

use ::arm::{Arm, Frame};
use armpath::{Cell as Frames, Point, stand};
use machine::{Cell, Rail};
use std::ops::Range;

/// Places that are looked at: as many at the most, and no nearer to each other than so many mm.
const MOST: f64 = 33.0;
const NEAREST: f64 = 50.0;

/// Points of a cut at which the arm is looked at, and turns about the tool.
const LOOKS: usize = 12;
const TURNS: u16 = 12;

/// How easily the arm has to stand at a place, as [`armpath::Worst::ease`]: with half of what is ample, or with what the choice of joints asks for, or
/// anyhow. What no place gives is looked for in the next.
const EASES: [f64; 3] = [0.5, 1.0 / 6.0, 0.0];

/// Points that are cut from one place of the rail.
pub(super) struct Group {
    pub(super) points: Range<usize>,
    /// The places from which the arm reaches all of them, mm, the best first.
    pub(super) places: Vec<f64>,
    /// How easily it stands at the first of them; `None` where it reaches the points from none.
    pub(super) ease: Option<f64>,
}

/// What is needed to look for places.
pub(super) struct Stand<'a> {
    pub(super) arm: &'a Arm,
    pub(super) cell: &'a Cell,
    pub(super) tool: Frame,
}

/// The points of a path by the places from which they are cut, in order. Without a rail they are one group at 0.
pub(super) fn groups(stand: &Stand, points: &[Point]) -> Vec<Group> {
    let Some(rail) = stand.cell.rail else {
        return vec![Group { points: 0..points.len(), places: vec![0.0], ease: None }];
    };
    let grid = grid(&rail);
    let mut groups = Vec::new();
    let mut open: Option<Open> = None;
    for cut in cuts(points) {
        let looks = looks(&points[cut.clone()]);
        if let Some(group) = &mut open
            && group.takes(stand, &grid, &looks)
        {
            group.points.end = cut.end;
            continue;
        }
        groups.extend(open.replace(Open::new(stand, &grid, cut, &looks)));
    }
    groups.extend(open);
    let mut before = rail.home;
    let closed = groups.into_iter().map(|group| {
        let group = group.close(stand, &grid, (before, points));
        before = group.places[0];
        group
    });
    closed.collect()
}

/// A group to which cuts are still added.
struct Open {
    points: Range<usize>,
    /// How easily the arm stands at each place of the grid.
    eases: Vec<Option<f64>>,
    /// How easily it has to.
    least: f64,
}

impl Open {
    fn new(stand: &Stand, grid: &[f64], points: Range<usize>, looks: &[Point]) -> Open {
        let eases: Vec<_> = grid.iter().map(|place| stand.ease(*place, looks)).collect();
        let best = eases.iter().flatten().copied().fold(0.0, f64::max);
        let least = EASES.into_iter().find(|least| best >= *least).unwrap_or_default();
        Open { points, eases, least }
    }

    /// Whether one place reaches a further cut as well, which is added then.
    fn takes(&mut self, stand: &Stand, grid: &[f64], looks: &[Point]) -> bool {
        let both = self.eases.iter().zip(grid).map(|(ease, place)| {
            let before = ease.filter(|ease| *ease >= self.least)?;
            Some(before.min(stand.ease(*place, looks)?))
        });
        let both: Vec<_> = both.collect();
        let reaches = both.iter().flatten().any(|ease| *ease >= self.least);
        if reaches {
            self.eases = both;
        }
        reaches
    }

    fn close(self, stand: &Stand, grid: &[f64], (before, points): (f64, &[Point])) -> Group {
        let mut found: Vec<(f64, f64)> = self
            .eases
            .iter()
            .zip(grid)
            .filter_map(|(ease, place)| Some(((*ease)?, *place)))
            .collect();
        // What is more than ample is no better.
        let order = |(ease, place): &(f64, f64)| (-ease.min(1.0), (place - before).abs());
        found.sort_by(|a, b| {
            let (a, b) = (order(a), order(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        let ease = found.first().map(|(ease, _)| *ease);
        let mut places: Vec<f64> = found.into_iter().map(|(_, place)| place).collect();
        if places.is_empty() {
            places.push(stand.nearest(&points[self.points.start]));
        }
        Group { points: self.points, places, ease }
    }
}

impl Stand<'_> {
    fn ease(&self, place: f64, looks: &[Point]) -> Option<f64> {
        let frames = Frames { tool: self.tool, part: self.cell.part_from(place) };
        stand(self.arm, &frames, looks, TURNS)
    }

    /// Whether the arm, which is on a rail, reaches a point from anywhere on it.
    pub(super) fn reaches(&self, point: &Point) -> bool {
        let places = self.cell.rail.as_ref().map(grid).unwrap_or_default();
        places.into_iter().any(|place| self.ease(place, &[*point]).is_some())
    }

    /// The place from which a point is straight across the rail, mm.
    fn nearest(&self, point: &Point) -> f64 {
        let Some(rail) = &self.cell.rail else { return 0.0 };
        let tip = self.cell.part.transform_point3(point.tip);
        (tip - rail.origin.translation).dot(rail.direction).clamp(rail.min, rail.max)
    }
}

/// The places that are looked at.
fn grid(rail: &Rail) -> Vec<f64> {
    let length = rail.max - rail.min;
    let count = (length / NEAREST).floor().clamp(1.0, MOST - 1.0);
    (0..=count as usize).map(|i| rail.min + length * i as f64 / count).collect()
}

/// The points between whose ends the rail may not move: a cut with the rapid to its start and the one away from its end.
fn cuts(points: &[Point]) -> Vec<Range<usize>> {
    let is_rapid = |at: usize| points.get(at).is_none_or(|point| !point.cut);
    let begins = |at: &usize| {
        *at == 0
            || is_rapid(*at) && (is_rapid(at - 1) || at + 1 < points.len() && !is_rapid(at + 1))
    };
    let starts: Vec<usize> = (0..points.len()).filter(begins).collect();
    let ends = starts.iter().skip(1).copied().chain([points.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

/// Some of the points, with the first and the last.
fn looks(points: &[Point]) -> Vec<Point> {
    let last = points.len() - 1;
    let count = points.len().min(LOOKS);
    (0..count).map(|i| points[if count > 1 { i * last / (count - 1) } else { 0 }]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;

    /// A path of rapids (r) and cuts (c).
    fn path(kinds: &str) -> Vec<Point> {
        let point = |kind: char| Point {
            tip: Vec3::ZERO,
            axis: Vec3::Z,
            side: None,
            cut: kind == 'c',
            feed: 600.0,
            inside: false,
        };
        kinds.chars().map(point).collect()
    }

    #[test]
    fn the_rail_may_move_at_rapids_alone_and_a_cut_keeps_the_rapid_that_leaves_it() {
        assert_eq!(cuts(&path("rccr")), vec![0..4]);
        // Over the part, down to the cut, up from it, over the next, down to that.
        assert_eq!(cuts(&path("rrccrrrcc")), [0..1, 1..5, 5..6, 6..9]);
        // One rapid from cut to cut.
        assert_eq!(cuts(&path("rccrcc")), [0..3, 3..6]);
        assert_eq!(cuts(&path("rcrcr")), [0..2, 2..5]);
        assert_eq!(cuts(&path("")), []);
    }

    #[test]
    fn places_lie_on_the_rail_from_end_to_end() {
        let rail = |min: f64, max: f64| Rail {
            direction: Vec3::X,
            origin: Frame::IDENTITY,
            min,
            max,
            speed: 1e5,
            home: min,
        };
        assert_eq!(grid(&rail(-100.0, 100.0)), [-100.0, -50.0, 0.0, 50.0, 100.0]);
        assert_eq!(grid(&rail(0.0, 30.0)), [0.0, 30.0]);
        let long = grid(&rail(0.0, 6400.0));
        assert_eq!((long.len(), long[1], long[32]), (33, 200.0, 6400.0));
    }
}
