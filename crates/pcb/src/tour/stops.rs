//! What a tour visits, and the places in which it may enter each.

use super::order::Order;
use super::tree::Tree;
use crate::Path;
use crate::path::PathPoint;
use geom::Vec2;
use geom::ending::go_on;
use std::ops::Range;

/// An element longer than this has places of entry between its ends, mm.
const STRIDE: f64 = 2.0;

/// How much shorter the travel must be for an entry that cuts an element in two, mm.
const BETTER: f64 = 0.1;

/// What is visited.
#[derive(Default)]
pub(super) struct Stops {
    stops: Vec<Stop>,
    /// The places of all, one stop after the other.
    places: Vec<Vec2>,
    /// Whether each is between the ends of an element.
    between: Vec<bool>,
}

/// What is done between two rapid moves.
pub(super) struct Stop {
    /// Its places.
    places: Range<usize>,
    pub(super) form: Form,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// Entered in any of its places, and left where it was entered.
    Round,
    /// Entered in one of its two places and left in the other.
    Open,
    /// Entered in the first of its two places and left in the other.
    Directed,
}

/// A stop in a tour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Visit {
    pub(super) stop: usize,
    /// Where a round one is entered, of all places.
    pub(super) place: usize,
    /// Whether an open one is entered where it ends.
    pub(super) turned: bool,
}

impl Stops {
    /// Lines from the first point to the second.
    pub(super) fn of_lines(lines: &[(Vec2, Vec2)]) -> Stops {
        let mut all = Stops::default();
        for (start, end) in lines {
            all.places.push(*start);
            if start != end {
                all.places.push(*end);
            }
            all.stop(if start == end { Form::Round } else { Form::Directed });
        }
        all
    }

    /// The stops, and for each place of a closed path where on it that is.
    pub(super) fn of_paths(paths: &[Path], reversible: bool) -> (Stops, Vec<Option<PathPoint>>) {
        let mut all = Stops::default();
        let mut points = Vec::new();
        for path in paths {
            let form = match (path.is_closed(), reversible) {
                (true, _) => Form::Round,
                (false, true) => Form::Open,
                (false, false) => Form::Directed,
            };
            if form == Form::Round {
                for point in path.points(STRIDE) {
                    all.places.push(path.at(point));
                    all.between.push(point.t > 0.0);
                    points.push(Some(point));
                }
            } else {
                all.places.extend([path.start(), path.end()]);
                points.extend([None; 2]);
            }
            all.stop(form);
        }
        (all, points)
    }

    /// A stop of the places that belong to none yet.
    fn stop(&mut self, form: Form) {
        let first = self.stops.last().map_or(0, |last| last.places.end);
        self.between.resize(self.places.len(), false);
        self.stops.push(Stop { places: first..self.places.len(), form });
    }

    /// All stops, always the nearest next.
    pub(super) fn nearest_next(&self, from: Vec2) -> Vec<Visit> {
        let mut stop_of = Vec::with_capacity(self.places.len());
        let mut tree = Tree::new(&self.places);
        for (i, stop) in self.stops.iter().enumerate() {
            stop_of.extend(stop.places.clone().map(|_| i));
            if stop.form == Form::Directed {
                tree.remove(stop.places.end - 1);
            }
        }
        let mut at = from;
        let mut visits = Vec::with_capacity(self.stops.len());
        while let Some(place) = tree.nearest(at) {
            go_on();
            let stop = stop_of[place];
            let Stop { places, form } = &self.stops[stop];
            let turned = *form == Form::Open && place > places.start;
            visits.push(Visit { stop, place, turned });
            at = match form {
                Form::Round => self.places[place],
                _ if turned => self.places[places.start],
                _ => self.places[places.end - 1],
            };
            let there = if *form == Form::Directed { 1 } else { places.len() };
            places.clone().take(there).for_each(|place| tree.remove(place));
        }
        visits
    }

    /// The order of `visits`, to be improved.
    pub(super) fn order(&self, from: Vec2, to: Option<Vec2>, visits: &[Visit]) -> Order {
        let mut ends = vec![[Vec2::ZERO; 2]; self.stops.len()];
        for visit in visits {
            let Stop { places, form } = &self.stops[visit.stop];
            ends[visit.stop] = match form {
                Form::Round => [self.places[visit.place]; 2],
                _ => [self.places[places.start], self.places[places.end - 1]],
            };
        }
        let one_way = self.stops.iter().map(|stop| stop.form == Form::Directed).collect();
        Order::new((from, to), ends, one_way, visits.iter().map(|visit| (visit.stop, visit.turned)))
    }

    /// The visits in this order, each round stop entered where that is best between the one
    /// before to the next.
    pub(super) fn visits(&self, order: &mut Order) -> Vec<Visit> {
        let stops: Vec<(usize, bool)> = order.stops().collect();
        let visit = |(stop, turned)| {
            let Stop { places, form } = &self.stops[stop];
            let mut place = places.start;
            if *form == Form::Round {
                let (before, after) = order.around(stop);
                let cost = |place: usize| {
                    let at = self.places[place];
                    let cut = if self.between[place] { BETTER } else { 0.0 };
                    before.distance(at) + after.map_or(0.0, |after| at.distance(after)) + cut
                };
                let best = places.clone().map(|place| (place, cost(place)));
                place = best.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(place, |(place, _)| place);
                order.enter_at(stop, self.places[place]);
            }
            Visit { stop, place, turned }
        };
        stops.into_iter().map(visit).collect()
    }
}
