//! An order of stops, shortened by turning round and moving parts of it.

use super::tree::Tree;
use geom::Vec2;
use geom::ending::go_on;
use std::collections::VecDeque;

/// How many neighbours of each stop are tried next to it.
const NEIGHBOURS: usize = 8;

/// How many stops at most are moved elsewhere together.
const MOVED: usize = 3;

/// A move that changes the places of more stops than this is left out: its time is better spent on others.
const SPAN: usize = 50_000;

/// The same where the order is shaken.
const SHAKEN_SPAN: usize = 1000;

/// How often the order is shaken for each of its stops.
const SHAKES: usize = 3;

/// How many stops at most are swapped with as many when the order is shaken.
const SHAKEN: usize = 30;

/// What a move must save, mm: more than rounding.
const WORTH: f64 = 1e-7;

/// Stops in an order. Before the first and, where the tool goes somewhere after all, behind the last
/// stands a stop that is never moved.
pub(super) struct Order {
    /// Whether each stop cannot be turned round.
    one_way: Vec<bool>,
    turned: Vec<bool>,
    sequence: Vec<u32>,
    /// Where what stands at each place of the sequence is entered and left.
    ends: Vec<[Vec2; 2]>,
    /// Where in the sequence each stop stands.
    place: Vec<u32>,
    /// How many may be moved: those at the places from 1 on.
    movable: usize,
    /// How many stops at most may change their places in a move.
    span: usize,
    /// For both ends of each stop the stops nearest to it, and how far they are, mm.
    neighbours: Vec<[(u32, f64); NEIGHBOURS]>,
    waiting: Waiting,
    done: Vec<Step>,
}

/// A change of the order that shortens it.
#[derive(Clone, Copy)]
enum Move {
    /// What follows the place `after` up to `last` is turned round.
    Turn { after: usize, last: usize },
    /// What stands from `first` to `last` goes between `after` and the next, the other way round or not.
    Shift { first: usize, last: usize, after: usize, turned: bool },
}

/// What moves are made of, and can be undone by.
#[derive(Clone, Copy)]
enum Step {
    Reverse {
        first: usize,
        last: usize,
    },
    /// What stands from `middle` to before `high` goes before what stands from `low`.
    Rotate {
        low: usize,
        middle: usize,
        high: usize,
    },
}

/// Stops that are still to be looked at, each once.
struct Waiting {
    queue: VecDeque<u32>,
    queued: Vec<bool>,
}

impl Waiting {
    fn push(&mut self, stop: u32) {
        if !std::mem::replace(&mut self.queued[stop as usize], true) {
            self.queue.push_back(stop);
        }
    }

    fn pop(&mut self) -> Option<u32> {
        let stop = self.queue.pop_front()?;
        self.queued[stop as usize] = false;
        Some(stop)
    }
}

impl Order {
    /// Stops with these ends, of which some cannot be turned round, in the sequence of these pairs: which,
    /// and whether it is turned round.
    pub(super) fn new(
        (from, to): (Vec2, Option<Vec2>),
        ends: Vec<[Vec2; 2]>,
        mut one_way: Vec<bool>,
        sequence: impl Iterator<Item = (usize, bool)>,
    ) -> Order {
        let movable = ends.len();
        let mut order = vec![movable as u32];
        let mut in_order = vec![[from; 2]];
        let mut turned = vec![false; movable];
        for (stop, round) in sequence {
            order.push(stop as u32);
            in_order.push(facing(ends[stop], round));
            turned[stop] = round;
        }
        if let Some(to) = to {
            order.push(movable as u32 + 1);
            in_order.push([to; 2]);
        }
        one_way.resize(order.len(), true);
        turned.resize(order.len(), false);
        let mut place = vec![0; order.len()];
        for (at, stop) in order.iter().enumerate() {
            place[*stop as usize] = at as u32;
        }
        let queued = vec![false; order.len()];
        Order {
            one_way,
            turned,
            sequence: order,
            ends: in_order,
            place,
            movable,
            span: SPAN,
            neighbours: Vec::new(),
            waiting: Waiting { queue: VecDeque::new(), queued },
            done: Vec::new(),
        }
    }

    /// The stops in their order, and whether each is turned round.
    pub(super) fn stops(&self) -> impl Iterator<Item = (usize, bool)> {
        let movable = self.sequence.iter().skip(1).take(self.movable);
        movable.map(|stop| (*stop as usize, self.turned[*stop as usize]))
    }

    /// How far it is between all of them, mm.
    pub(super) fn travel(&self) -> f64 {
        (0..self.sequence.len()).map(|at| self.link(at)).sum()
    }

    /// Where the tool is before it enters `stop`, and where it goes after.
    pub(super) fn around(&self, stop: usize) -> (Vec2, Option<Vec2>) {
        let at = self.place[stop] as usize;
        let next = (at + 1 < self.sequence.len()).then(|| self.enter(at + 1));
        (self.leave(at - 1), next)
    }

    /// Enters and leaves `stop` at `point`.
    pub(super) fn enter_at(&mut self, stop: usize, point: Vec2) {
        self.ends[self.place[stop] as usize] = [point; 2];
    }

    fn enter(&self, at: usize) -> Vec2 {
        self.ends[at][0]
    }

    fn leave(&self, at: usize) -> Vec2 {
        self.ends[at][1]
    }

    /// How far it is from `point` to where the stop at `at` is entered; nothing where there is none.
    fn to_enter(&self, point: Vec2, at: usize) -> f64 {
        if at < self.sequence.len() { point.distance(self.enter(at)) } else { 0.0 }
    }

    /// How far it is from the stop at `at` to the next.
    fn link(&self, at: usize) -> f64 {
        self.to_enter(self.leave(at), at + 1)
    }

    /// Makes moves until none of those that are tried shortens the order.
    pub(super) fn improve(&mut self) {
        self.find_neighbours();
        for at in 0..self.sequence.len() {
            self.waiting.push(self.sequence[at]);
        }
        self.settle();
        self.done.clear();
    }

    /// Swaps neighbouring parts of the order here and there, and keeps what is shorter after moves have
    /// been made about them.
    pub(super) fn shake(&mut self) {
        let last = self.movable;
        if last < 3 {
            return;
        }
        self.span = SHAKEN_SPAN;
        // SplitMix64, Steele, Lea and Flood 2014: the same order whenever it is run.
        let mut state: u64 = 0;
        let mut below = |bound: usize| {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut mixed = state;
            mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((mixed ^ (mixed >> 31)) % bound.max(1) as u64) as usize
        };
        // Stop after stop: what is looked at together is near in memory too.
        for low in (0..SHAKES).flat_map(|_| 1..last) {
            go_on();
            let middle = low + 1 + below(SHAKEN.min(last - low));
            let high = middle + 1 + below(SHAKEN.min(last - middle));
            let places = [low - 1, middle - 1, high - 1];
            let links = |order: &Order, places: [usize; 3]| -> f64 {
                places.into_iter().map(|at| order.link(at)).sum()
            };
            let before = links(self, places);
            self.make(Step::Rotate { low, middle, high });
            let places = [low - 1, low + high - middle - 1, high - 1];
            let longer = links(self, places) - before;
            for at in places {
                self.wait_at(at);
                self.wait_at(at + 1);
            }
            if self.settle() < longer {
                while let Some(step) = self.done.pop() {
                    self.undo(step);
                }
            }
            self.done.clear();
        }
    }

    /// Makes moves about those that wait until there are none; what that saves, mm.
    fn settle(&mut self) -> f64 {
        let mut saved = 0.0;
        while let Some(stop) = self.waiting.pop() {
            while let Some((gain, best)) = self.best(stop) {
                go_on();
                saved += gain;
                self.perform(best);
            }
        }
        saved
    }

    fn find_neighbours(&mut self) {
        let ends = |(place, turned): (&u32, &bool)| facing(self.ends[*place as usize], *turned);
        let points: Vec<Vec2> = self.place.iter().zip(&self.turned).flat_map(ends).collect();
        let tree = Tree::new(&points);
        self.neighbours.clear();
        for (end, point) in points.iter().enumerate() {
            go_on();
            let own = end / 2;
            let mut list = [(own as u32, f64::INFINITY); NEIGHBOURS];
            let mut known = 0;
            // Both ends of the others may be at one place, and so may both of its own.
            for other in tree.nearest_of(*point, 2 * NEIGHBOURS + 2) {
                let stop = (other / 2) as u32;
                let new = stop as usize != own && !list.iter().any(|(known, _)| *known == stop);
                if new && known < NEIGHBOURS {
                    list[known] = (stop, point.distance(points[other]));
                    known += 1;
                }
            }
            self.neighbours.push(list);
        }
    }

    /// Where the stops stand that are less than `within` mm from where the one at `at` is entered, or left.
    fn near(&self, at: usize, entered: bool, within: f64) -> impl Iterator<Item = usize> {
        let stop = self.sequence[at] as usize;
        let end = 2 * stop + usize::from(self.turned[stop] == entered);
        let list = self.neighbours[end].iter().take_while(move |(_, away)| *away < within);
        list.map(|(other, _)| self.place[*other as usize] as usize)
    }

    /// The move about `stop` that saves most, and how much, mm.
    fn best(&self, stop: u32) -> Option<(f64, Move)> {
        let at = self.place[stop as usize] as usize;
        let mut best: Option<(f64, Move)> = None;
        let mut take = |gain: f64, found: Move| {
            if gain > best.map_or(WORTH, |(least, _)| least) && self.allows(found) {
                best = Some((gain, found));
            }
        };
        self.turns(at, &mut take);
        for others in 0..MOVED {
            if at >= 1 && at + others <= self.movable {
                self.shifts(at, at + others, true, &mut take);
            }
            if at > others && at <= self.movable {
                self.shifts(at - others, at, false, &mut take);
            }
        }
        best
    }

    /// Turns that bring the stop at `at` next to one that is near it.
    fn turns(&self, at: usize, take: &mut impl FnMut(f64, Move)) {
        let mut turn = |i: usize, j: usize| {
            let (after, last) = (i.min(j), i.max(j));
            if after < last && last <= self.movable {
                let joined = self.leave(after).distance(self.leave(last))
                    + self.to_enter(self.enter(after + 1), last + 1);
                let gain = self.link(after) + self.link(last) - joined;
                take(gain, Move::Turn { after, last });
            }
        };
        for other in self.near(at, false, self.link(at)) {
            turn(at, other);
        }
        if at > 0 {
            for other in self.near(at, true, self.link(at - 1)) {
                if other > 0 {
                    turn(at - 1, other - 1);
                }
            }
        }
    }

    /// Shifts of the stops from `first` to `last` that bring the first (the last, where not
    /// `by_first`) next to one that is near it.
    fn shifts(&self, first: usize, last: usize, by_first: bool, take: &mut impl FnMut(f64, Move)) {
        let (enter, leave) = (self.enter(first), self.leave(last));
        let freed =
            self.link(first - 1) + self.link(last) - self.to_enter(self.leave(first - 1), last + 1);
        if freed <= WORTH {
            return;
        }
        for other in self.near(if by_first { first } else { last }, by_first, freed) {
            // Behind the other as it is, or before it and reversed.
            for (after, turned) in [(other, !by_first), (other.wrapping_sub(1), by_first)] {
                let outside = after > last || after + 1 < first;
                if after > self.movable || !outside {
                    continue;
                }
                let (start, end) = if turned { (leave, enter) } else { (enter, leave) };
                let joined = self.leave(after).distance(start) + self.to_enter(end, after + 1);
                let gain = freed + self.link(after) - joined;
                take(gain, Move::Shift { first, last, after, turned });
            }
        }
    }

    /// Whether no stop is turned round that must not be, and not too many change their places.
    fn allows(&self, found: Move) -> bool {
        let (span, turned) = match found {
            Move::Turn { after, last } => (last - after, Some((after + 1, last))),
            Move::Shift { first, last, after, turned } => {
                (first.abs_diff(after), turned.then_some((first, last)))
            }
        };
        let one_way = |stop: &u32| self.one_way[*stop as usize];
        span <= self.span
            && turned.is_none_or(|(first, last)| !self.sequence[first..=last].iter().any(one_way))
    }

    fn perform(&mut self, found: Move) {
        match found {
            Move::Turn { after, last } => {
                self.make(Step::Reverse { first: after + 1, last });
                [after, after + 1, last, last + 1].into_iter().for_each(|at| self.wait_at(at));
            }
            Move::Shift { first, last, after, turned } => {
                if turned {
                    self.make(Step::Reverse { first, last });
                }
                let step = if after > last {
                    Step::Rotate { low: first, middle: last + 1, high: after + 1 }
                } else {
                    Step::Rotate { low: after + 1, middle: first, high: last + 1 }
                };
                let Step::Rotate { low, middle, high } = step else { return };
                self.make(step);
                let seam = low + high - middle;
                [low - 1, low, seam - 1, seam, high - 1, high]
                    .into_iter()
                    .for_each(|at| self.wait_at(at));
            }
        }
    }

    fn wait_at(&mut self, at: usize) {
        if let Some(stop) = self.sequence.get(at) {
            self.waiting.push(*stop);
        }
    }

    fn make(&mut self, step: Step) {
        self.done.push(step);
        self.change(step);
    }

    fn undo(&mut self, step: Step) {
        self.change(match step {
            Step::Reverse { .. } => step,
            Step::Rotate { low, middle, high } => {
                Step::Rotate { low, middle: low + high - middle, high }
            }
        });
    }

    fn change(&mut self, step: Step) {
        let (first, last) = match step {
            Step::Reverse { first, last } => {
                self.sequence[first..=last].reverse();
                self.ends[first..=last].reverse();
                self.ends[first..=last].iter_mut().for_each(|ends| ends.reverse());
                for stop in &self.sequence[first..=last] {
                    self.turned[*stop as usize] ^= true;
                }
                (first, last)
            }
            Step::Rotate { low, middle, high } => {
                self.sequence[low..high].rotate_left(middle - low);
                self.ends[low..high].rotate_left(middle - low);
                (low, high - 1)
            }
        };
        for at in first..=last {
            self.place[self.sequence[at] as usize] = at as u32;
        }
    }
}

/// Where a stop is entered and left that is turned round or not.
fn facing([enter, leave]: [Vec2; 2], turned: bool) -> [Vec2; 2] {
    if turned { [leave, enter] } else { [enter, leave] }
}
