//! A stretch of the order, improved by itself: what comes before it and after it stays where it is, so that only the rules
//! among its own points can be broken.

use super::shadow::{Bonds, Lists, Shadow};
use crate::clock::Clock;
use crate::cloud::Point;
use crate::sample::Dice;
use crate::watch::Watch;

/// After how many tries the clock on the wall is looked at.
const OFTEN: u64 = 1 << 14;

/// No number of a point.
const NONE: u32 = u32::MAX;

/// A stretch of the order.
pub(super) struct Window<'c> {
    clock: &'c Clock,
    /// Where the axes stand at each point, µm; the last two are those of the points before and after the stretch.
    axes: Vec<Point>,
    /// Whether there are points before and after it.
    ends: [bool; 2],
    /// The points within one tick of each.
    near: Lists,
    /// The points that must come before each, and after it.
    before: Lists,
    after: Lists,
    /// The order, between the points before and after.
    order: Vec<u32>,
    /// Where each point is in it.
    place: Vec<u32>,
    /// Points whose step to the next takes more than a tick, and where each is in that list.
    slow: Vec<u32>,
    in_slow: Vec<u32>,
    /// Ticks of all steps.
    ticks: i64,
}

/// A change of the order.
#[derive(Clone, Copy, Debug)]
enum Change {
    /// Two neighbouring pieces change places, `low..=middle` and `middle + 1..=high`; one of them may be turned round as well.
    Exchange { low: usize, middle: usize, high: usize, turned: Option<Piece> },
    /// The piece `low..=high` is turned round.
    Turn { low: usize, high: usize },
}

/// The longest piece that is turned round: in a longer one some point nearly always binds another.
const LONGEST_TURN: usize = 200;

/// Turns a piece round so that the point at place `q` becomes the neighbour of the one at `p`, or, not `forward`, of the one at `p + 1`.
fn turn(p: usize, q: usize, forward: bool) -> Option<Change> {
    let (low, high) = match (forward, q > p) {
        (true, true) => (p + 1, q),
        (true, false) => (q + 1, p),
        (false, true) => (p + 1, q.checked_sub(1)?),
        (false, false) => (q, p),
    };
    (low >= 1 && low < high && high - low < LONGEST_TURN).then_some(Change::Turn { low, high })
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Piece {
    First,
    Second,
}

impl<'c> Window<'c> {
    /// The stretch of `points` (µm in the glass), in their order, whose axes stand at `axes`; `ends` are those of the points
    /// before and after it.
    pub(super) fn new(
        points: &[Point],
        axes: &[Point],
        ends: [Option<Point>; 2],
        (shadow, clock): (Shadow, &'c Clock),
        watch: &dyn Watch,
    ) -> Window<'c> {
        let count = points.len() as u32;
        let Bonds { near, before, after } = Bonds::new(points, axes, shadow, clock, watch);
        let mut all = axes.to_vec();
        all.extend(ends.map(Option::unwrap_or_default));
        let order: Vec<u32> = std::iter::once(count).chain(0..count).chain([count + 1]).collect();
        let mut window = Window {
            clock,
            ends: ends.map(|end| end.is_some()),
            near,
            place: vec![0; all.len()],
            slow: Vec::new(),
            in_slow: vec![NONE; all.len()],
            axes: all,
            before,
            after,
            order,
            ticks: 0,
        };
        window.count();
        window
    }

    /// Ticks of all steps of the stretch, those from and to its ends too.
    pub(super) fn ticks(&self) -> i64 {
        self.ticks
    }

    /// The order as numbers of the points that it was made of.
    pub(super) fn order(&self) -> &[u32] {
        &self.order[1..self.order.len() - 1]
    }

    /// What the step from `a` to `b` costs.
    fn step(&self, a: u32, b: u32) -> i64 {
        let count = self.axes.len() as u32 - 2;
        if (a == count && !self.ends[0]) || (b == count + 1 && !self.ends[1]) {
            return 0;
        }
        i64::from(self.clock.step(self.axes[a as usize], self.axes[b as usize]))
    }

    /// What the step from the place `at` to the next costs.
    fn after_place(&self, at: usize) -> i64 {
        self.step(self.order[at], self.order[at + 1])
    }

    /// Notes where the points from place `from` to `to` are.
    fn place(&mut self, from: usize, to: usize) {
        for at in from..=to {
            self.place[self.order[at] as usize] = at as u32;
        }
    }

    /// Counts all anew.
    fn count(&mut self) {
        self.place(0, self.order.len() - 1);
        (0..self.order.len() - 1).for_each(|at| self.note(at));
        self.ticks = (0..self.order.len() - 1).map(|at| self.after_place(at)).sum();
    }

    /// Keeps the list of slow steps.
    fn note(&mut self, at: usize) {
        let point = self.order[at];
        let (slow, listed) = (self.after_place(at) > 1, self.in_slow[point as usize]);
        if slow && listed == NONE {
            self.in_slow[point as usize] = self.slow.len() as u32;
            self.slow.push(point);
        } else if !slow && listed != NONE {
            self.slow.swap_remove(listed as usize);
            if let Some(&moved) = self.slow.get(listed as usize) {
                self.in_slow[moved as usize] = listed;
            }
            self.in_slow[point as usize] = NONE;
        }
    }

    /// Whether a point from place `low` to `middle` must come before one from `middle + 1` to `high`.
    fn bound(&self, low: usize, middle: usize, high: usize) -> bool {
        let within = |list: &[u32], from: usize, to: usize| {
            list.iter().any(|&j| (from..=to).contains(&(self.place[j as usize] as usize)))
        };
        if middle - low < high - middle {
            let mut first = self.order[low..=middle].iter();
            first.any(|&i| within(self.after.of(i), middle + 1, high))
        } else {
            let mut second = self.order[middle + 1..=high].iter();
            second.any(|&i| within(self.before.of(i), low, middle))
        }
    }

    /// Whether a point from place `low` to `high` must come before another one there.
    fn bound_within(&self, low: usize, high: usize) -> bool {
        let inside = |&j: &u32| (low..=high).contains(&(self.place[j as usize] as usize));
        self.order[low..=high].iter().any(|&i| self.after.of(i).iter().any(inside))
    }

    /// What a change adds to the ticks.
    fn cost(&self, change: Change) -> i64 {
        let order = &self.order;
        match change {
            Change::Exchange { low, middle, high, turned } => {
                let old =
                    self.after_place(low - 1) + self.after_place(middle) + self.after_place(high);
                let mut first = (order[low], order[middle]);
                let mut second = (order[middle + 1], order[high]);
                match turned {
                    Some(Piece::First) => first = (first.1, first.0),
                    Some(Piece::Second) => second = (second.1, second.0),
                    None => {}
                }
                let new = self.step(order[low - 1], second.0)
                    + self.step(second.1, first.0)
                    + self.step(first.1, order[high + 1]);
                new - old
            }
            Change::Turn { low, high } => {
                let old = self.after_place(low - 1) + self.after_place(high);
                let new =
                    self.step(order[low - 1], order[high]) + self.step(order[low], order[high + 1]);
                new - old
            }
        }
    }

    fn is_legal(&self, change: Change) -> bool {
        match change {
            Change::Exchange { low, middle, high, turned } => {
                let bound = match turned {
                    Some(Piece::First) => self.bound_within(low, middle),
                    Some(Piece::Second) => self.bound_within(middle + 1, high),
                    None => false,
                };
                !bound && !self.bound(low, middle, high)
            }
            Change::Turn { low, high } => !self.bound_within(low, high),
        }
    }

    fn change(&mut self, change: Change) {
        match change {
            Change::Exchange { low, middle, high, turned } => {
                match turned {
                    Some(Piece::First) => self.order[low..=middle].reverse(),
                    Some(Piece::Second) => self.order[middle + 1..=high].reverse(),
                    None => {}
                }
                self.order[low..=high].rotate_left(middle + 1 - low);
                self.place(low, high);
                // Where the two pieces meet now.
                let seam = low + (high - middle) - 1;
                [low - 1, seam, high].into_iter().for_each(|at| self.note(at));
                match turned {
                    Some(Piece::Second) => (low..seam).for_each(|at| self.note(at)),
                    Some(Piece::First) => (seam + 1..high).for_each(|at| self.note(at)),
                    None => {}
                }
            }
            Change::Turn { low, high } => {
                self.order[low..=high].reverse();
                self.place(low, high);
                (low - 1..=high).for_each(|at| self.note(at));
            }
        }
    }

    /// How many steps take more than a tick.
    pub(super) fn slow(&self) -> usize {
        self.slow.len()
    }

    /// Tries changes at steps that take more than a tick, `tries` of them: those that cost nothing are kept, those that cost
    /// more by chance, the more of them the larger `heat` (ticks) is.
    pub(super) fn improve(
        &mut self,
        tries: u64,
        heat: f64,
        dice: &mut Dice,
        is_over: &dyn Fn() -> bool,
    ) {
        for done in 1..=tries {
            if done % OFTEN == 0 && is_over() {
                return;
            }
            let Some(change) = self.pick(dice) else { continue };
            let cost = self.cost(change);
            if cost > 0 && (heat <= 0.0 || dice.part() >= (-cost as f64 / heat).exp()) {
                continue;
            }
            if self.is_legal(change) {
                self.change(change);
                self.ticks += cost;
            }
        }
    }

    /// A change that gives a slow step another end within a tick.
    fn pick(&self, dice: &mut Dice) -> Option<Change> {
        if self.slow.is_empty() {
            return None;
        }
        let u = self.slow[dice.below(self.slow.len())];
        let p = self.place[u as usize] as usize;
        let v = self.order[p + 1];
        let count = self.axes.len() as u32 - 2;
        let pick = |list: &[u32], dice: &mut Dice| {
            (!list.is_empty()).then(|| list[dice.below(list.len())])
        };
        let forward = dice.below(2) == 0;
        let (here, there) = if forward { (u, v) } else { (v, u) };
        if here >= count {
            return None;
        }
        let w = pick(self.near.of(here), dice)?;
        let q = self.place[w as usize] as usize;
        if dice.below(8) == 0 {
            return turn(p, q, forward);
        }
        // A piece that has w at one end is to lie between u and v. Where its other end is:
        let x = if there < count && dice.below(2) == 0 {
            self.place[pick(self.near.of(there), dice)? as usize] as usize
        } else if dice.below(2) == 0 {
            q + self.length(dice)
        } else {
            q.saturating_sub(self.length(dice))
        };
        let (a, b) = (q.min(x), q.max(x));
        if a < 1 || b > self.order.len() - 2 || (a <= p + 1 && b >= p) {
            return None;
        }
        // Forward, w follows u, so that the piece begins with w; else it ends with w.
        let turned = a != b && if forward { q == b } else { q == a };
        Some(if a > p + 1 {
            let turned = turned.then_some(Piece::Second);
            Change::Exchange { low: p + 1, middle: a - 1, high: b, turned }
        } else {
            let turned = turned.then_some(Piece::First);
            Change::Exchange { low: a, middle: b, high: p, turned }
        })
    }

    /// How long a piece is, less one: short ones more often.
    fn length(&self, dice: &mut Dice) -> usize {
        let wide = dice.below(10);
        dice.below(1 << wide)
    }
}
