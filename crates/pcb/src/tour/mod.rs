//! The order of cuts: short moves between them.
//!
//! The nearest cut comes next; then the order is improved by turning round a part of it (2-opt) and by
//! moving up to three cuts elsewhere (Or-opt), and at last shaken and improved again where that shortens
//! it. A closed path may begin at each of its corners and on its long elements: where it does is chosen
//! anew after each improvement. Time grows as n·log n.
//!
//! Crates for travelling salesmen know points alone, not contours that may begin anywhere, and most stop
//! by the clock: what they answer differs from run to run.

mod order;
mod stops;
mod tree;

use crate::Path;
use geom::Vec2;
use stops::{Stops, Visit};

/// Where a tour begins and ends, and what it may do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tour {
    /// Where the tool comes from, mm.
    pub from: Vec2,
    /// Where it goes after all cuts, mm; `None` where it may stay.
    pub to: Option<Vec2>,
    /// Whether open paths may also be cut from their end to their start.
    pub reversible: bool,
}

/// How often the order and the starts are improved in turn.
const ROUNDS: usize = 8;

/// A round that shortens the travel by less than this part of it is the last.
const WORTH: f64 = 2e-3;

impl Tour {
    /// `paths` in an order of short travel: closed ones begin where that is best, open ones may be
    /// turned round where [`reversible`](Tour::reversible) says so.
    pub fn of_paths(&self, paths: &[Path]) -> Vec<Path> {
        let (stops, points) = Stops::of_paths(paths, self.reversible);
        let visit = |visit: Visit| {
            let path = paths.get(visit.stop)?;
            Some(match points.get(visit.place)? {
                Some(point) => path.starting_at(*point),
                None if visit.turned => path.reversed(),
                None => path.clone(),
            })
        };
        self.visits(&stops).into_iter().filter_map(visit).collect()
    }

    /// The indices of `points` in an order of short travel.
    pub fn of_points(&self, points: &[Vec2]) -> Vec<usize> {
        let lines: Vec<(Vec2, Vec2)> = points.iter().map(|point| (*point, *point)).collect();
        self.of_lines(&lines)
    }

    /// The indices of `lines`, each from its first point to its second, in an order of short travel.
    pub(crate) fn of_lines(&self, lines: &[(Vec2, Vec2)]) -> Vec<usize> {
        self.visits(&Stops::of_lines(lines)).into_iter().map(|visit| visit.stop).collect()
    }

    /// How far the tool travels between `paths`, cut in this order, mm: from where it comes, and to
    /// where it goes.
    pub fn travel(&self, paths: &[Path]) -> f64 {
        let mut at = self.from;
        let mut travel = 0.0;
        for path in paths {
            travel += at.distance(path.start());
            at = path.end();
        }
        travel + self.to.map_or(0.0, |to| at.distance(to))
    }

    fn visits(&self, stops: &Stops) -> Vec<Visit> {
        let mut order = stops.order(self.from, self.to, &stops.nearest_next(self.from));
        for _ in 0..ROUNDS {
            let before = order.travel();
            order.improve();
            stops.visits(&mut order);
            if order.travel() > before * (1.0 - WORTH) {
                break;
            }
        }
        order.shake();
        stops.visits(&mut order)
    }
}
