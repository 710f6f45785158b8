//! The search for the best sequence of states of an operation.

use super::axis::{Axis, SLACK};
use super::{Cell, Plan, Rewind, TURN, TURNS, Target, TargetKind};
use crate::inverse::{Chain, RotaryAngles, Unreachable};
use crate::{Machine, OrientationMode};
use geom::{ANGLE_EPSILON, Vec3, angle_between, between};
use program::{Diagnostic, Rule};
use std::f64::consts::PI;

/// The most states of a target: two solutions.
const STATES: usize = 2 * TURNS;
/// Bits that name a state.
const BITS: u32 = 3;
/// Every state follows from the state of the same number.
const SAME: u32 = 0o76_543_210;

/// The farthest that the tool axis may leave its great circle in a cut, radians: 0.9°, of the 1° that a proof allows.
const SWING: f64 = PI / 200.0;
/// Turns of rotary axes of less than this in all, degrees, swing the tool axis off its great circle by less than 0.9°. Both the way
/// that the axes make and the great circle bend by no more than the square of the turn w, so that between their common ends
/// they are apart by w² / 4 at the most.
pub const NEAR: f64 = 14.0;
/// Where the control itself turns the tool along a vector: turns of less than this, degrees, within one solution stay near.
const NEAR_BY_VECTOR: f64 = 90.0;
/// What not being the preferred solution costs, in degrees of travel: it decides between sequences of the
/// same length, which differ by rounding only.
const PREFERENCE: f64 = 0.05;
/// What a degree of the turn to the operation costs, in degrees of travel within: less than preference.
const APPROACH: f64 = 1e-5;

/// What a target can be in: positions of the outer and the inner axis by the number of the state, the
/// first solution from 0 on, the second from [`TURNS`] on; infinite where there is no such state.
type States = [[f64; 2]; STATES];

/// The best sequence to each state of a target.
#[derive(Clone)]
struct Front {
    states: States,
    cost: [f64; STATES],
    axis: Vec3,
    /// Whether that is a singular pose; the outer axis may then stand in other places as well.
    singular: bool,
    /// By how many degrees, at least, each state is reached better without than by a change
    /// from any other state: a step of less than half of that changes no state.
    margin: f64,
}

/// What the axes may do in the move to a target.
#[derive(Clone, Copy, PartialEq)]
enum Freedom {
    /// It is cut.
    None,
    /// It is cut, but the free axis turns before, about the tool.
    AboutTool,
    /// It is not cut.
    All,
}

/// A search through the targets.
pub(super) struct Search<'a> {
    machine: &'a Machine,
    known: bool,
    plan: Plan,
    /// Of the last target; without states before the first that is not singular.
    front: Box<Front>,
    /// Of the target looked at; they change places from target to target.
    next: Box<Front>,
    /// Tool axis of the last target.
    last: Option<Vec3>,
    /// Whether a target was not singular yet.
    opened: bool,
    /// The target of the singular run just read at which the free axis turns best, and whether that is
    /// a rapid.
    turn_at: Option<(usize, bool)>,
    /// For each rewind the state in which the tool leaves the part, and those in which it can come in.
    turns_back: Vec<(u32, States)>,
}

impl<'a> Search<'a> {
    pub(super) fn new(
        machine: &'a Machine,
        start: Option<[f64; 3]>,
        expected: usize,
    ) -> Search<'a> {
        let degrees = start.unwrap_or_default();
        let chain = Chain::new(machine, degrees);
        let axes = Axis::of(machine, &chain, degrees);
        let [outer, inner] = axes.map(|axis| axis.turns() as usize);
        let mut turns = [[0.0; 2]; TURNS];
        for (k, turns) in turns.iter_mut().enumerate() {
            *turns = [k / inner.max(1), k % inner.max(1)].map(|turn| turn as f64);
        }
        let held = chain.gather(degrees);
        let start_pair = match start {
            Some(_) => held,
            None => [axes[0].nearest(held[0]), axes[1].nearest(held[1])],
        };
        let by_vector = machine.orientation.simultaneous == OrientationMode::Vectors;
        let plan = Plan {
            chain,
            axes,
            turns,
            in_turns: (outer * inner).min(TURNS),
            by_vector,
            near: if by_vector { NEAR_BY_VECTOR } else { NEAR },
            start: start_pair,
            cells: Vec::with_capacity(expected),
            rewinds: Vec::new(),
        };
        let mut front = Box::new(Front::empty());
        if let Some(degrees) = start {
            front.axis = machine.axis_at(degrees);
            let angles = plan.chain.rotary_angles(front.axis);
            front.singular = angles.map_or(true, |angles| angles.free());
            (front.states[0], front.cost[0]) = ([0, 1].map(|k| axes[k].base(held[k])), 0.0);
        }
        Search {
            machine,
            known: start.is_some(),
            plan,
            next: front.clone(),
            front,
            last: None,
            opened: false,
            turn_at: None,
            turns_back: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, target: &Target) -> Result<(), Box<Diagnostic>> {
        let index = self.plan.cells.len();
        if let (Some(last), Some(cell)) = (self.last, self.plan.cells.last().copied()) {
            let arc = target.kind == TargetKind::Arc;
            if arc && angle_between(last, target.axis) > ANGLE_EPSILON {
                let message = "the tool axis turns during an arc";
                return Err(Diagnostic::error(Rule::ArcOrientation, message)
                    .help("split the arc into lines, or give its end the tool axis of its start")
                    .line(target.line)
                    .into());
            }
            if arc || (last == target.axis && target.kind == TargetKind::Feed) {
                if cell.angles.free() && !arc {
                    self.may_turn(index, false);
                }
                self.plan.cells.push(Cell { link: SAME, ..cell });
                return Ok(());
            }
        }
        self.last = Some(target.axis);
        let angles =
            self.plan.chain.rotary_angles(target.axis).map_err(|e| unreachable(target, &e))?;
        let mut cell = Cell { angles, link: SAME };
        // The move to the first target is no cut, unless it follows on the operation before.
        let approach = target.kind == TargetKind::Rapid || (index == 0 && !self.known);
        if angles.free() {
            if approach || (self.front.singular && target.kind == TargetKind::Feed) {
                self.may_turn(index, approach);
            }
            self.pass(target, &angles)?;
        } else {
            cell.link = self.advance(target, &angles, approach)?;
        }
        self.plan.cells.push(cell);
        Ok(())
    }

    /// Notes that the free axis may turn on the way to the singular target `index`: on the way from
    /// another singular pose it turns about the tool, and in a rapid it does as it likes.
    fn may_turn(&mut self, index: usize, rapid: bool) {
        if rapid || !matches!(self.turn_at, Some((_, true))) {
            self.turn_at = Some((index, rapid));
        }
    }

    /// Continues the best sequences to a singular target: the outer axis holds.
    fn pass(&mut self, target: &Target, angles: &RotaryAngles) -> Result<(), Box<Diagnostic>> {
        if self.plan.inner(angles, 0.0).is_none() {
            return Err(self.out_of_travel(target, angles));
        }
        for (state, cost) in self.front.states.iter_mut().zip(&mut self.front.cost) {
            let inner = self.plan.inner(angles, state[1]).filter(|_| exists(state));
            if let Some(inner) = inner {
                *cost += self.plan.axes[1].travel(state[1], inner);
                state[1] = inner;
            }
        }
        (self.front.axis, self.front.singular, self.front.margin) = (target.axis, true, 0.0);
        Ok(())
    }

    /// Continues the best sequences to a target that is not singular; returns its links.
    fn advance(
        &mut self,
        target: &Target,
        angles: &RotaryAngles,
        approach: bool,
    ) -> Result<u32, Box<Diagnostic>> {
        self.plan.states(angles, &mut self.next.states);
        if !self.next.states.iter().any(exists) {
            return Err(self.out_of_travel(target, angles));
        }
        (self.next.axis, self.next.singular, self.next.margin) = (target.axis, false, 0.0);
        // Before a rapid the free axis turns in that rapid, at the latest.
        let mut turn_at = self.turn_at.take().filter(|(_, rapid)| *rapid || !approach);
        let loose = approach || matches!(turn_at, Some((_, true)));
        let freedom = match turn_at {
            _ if loose => Freedom::All,
            Some(_) => Freedom::AboutTool,
            None => Freedom::None,
        };
        let link = if loose && !self.opened {
            self.open();
            SAME
        } else if freedom == Freedom::None && self.plan.keep(&self.front, &mut self.next) {
            SAME
        } else if let Some(link) =
            self.plan.relax(self.machine, &self.front, &mut self.next, freedom)
        {
            link
        } else {
            turn_at = None;
            self.rewind(target)?
        };
        if let Some(cell) = turn_at.and_then(|(at, _)| self.plan.cells.get_mut(at)) {
            cell.link |= TURN;
        }
        self.opened = true;
        std::mem::swap(&mut self.front, &mut self.next);
        Ok(link)
    }

    /// The first pose decides the solution; how the axes get there counts for little.
    fn open(&mut self) {
        let Front { states, cost, .. } = &mut *self.next;
        let start = [0, 1].map(|k| self.plan.axes[k].base(self.plan.start[k]));
        for (state, cost) in states.iter().zip(cost) {
            let misses = self.machine.misses_preference(self.plan.chain.spread(*state));
            *cost =
                if misses { PREFERENCE } else { 0.0 } + APPROACH * self.plan.travel(&start, state);
        }
    }

    /// No way leads on: the tool leaves the part before `target` in the best state it can have
    /// there, and comes in again in any other.
    fn rewind(&mut self, target: &Target) -> Result<u32, Box<Diagnostic>> {
        let (front, next) = (&mut *self.front, &mut *self.next);
        let best = front.best();
        let left = front.states[best];
        if front.singular {
            // The free axis comes in where it is needed.
            front.states = next.states;
            front.states.iter_mut().for_each(|state| state[1] = left[1]);
        } else if let (false, Ok(angles)) = (self.opened, self.plan.chain.rotary_angles(front.axis))
        {
            // Of the pose before the operation only the state taken was looked at so far.
            self.plan.states(&angles, &mut front.states);
        }
        for (state, cost) in front.states.iter().zip(&mut front.cost) {
            // Of sequences of the same length the one that leaves most travel on both sides.
            let off_center: f64 = (0..2).map(|k| self.plan.axes[k].off_center(state[k])).sum();
            *cost = self.plan.travel(&left, state) + 1e-3 * off_center;
        }
        let link = self.plan.relax(self.machine, front, next, Freedom::None).ok_or_else(|| {
            let turn = angle_between(front.axis, next.axis).to_degrees();
            let message = format!(
                "the tool axis turns by {turn:.3}° in one move, and the rotary axes have no way \
                 through it that stays between its ends and within their travel"
            );
            Diagnostic::error(Rule::AxisLimit, message)
                .help("make the steps of the tool axis smaller, or turn the part on the table")
                .line(target.line)
        })?;
        let (index, line) = (self.plan.cells.len(), target.line);
        self.plan.rewinds.push(Rewind { index, line, pair: left });
        self.turns_back.push((best as u32, front.states));
        Ok(link)
    }

    /// Follows the links back from the best end.
    pub(super) fn finish(mut self) -> Plan {
        let mut state = self.front.best() as u32;
        let mut rewinds = self.plan.rewinds.iter_mut().zip(&self.turns_back).rev().peekable();
        for (index, cell) in self.plan.cells.iter_mut().enumerate().rev() {
            if cell.angles.free() {
                continue;
            }
            let before = (cell.link >> (BITS * state)) & (STATES as u32 - 1);
            cell.link = state;
            state = before;
            if let Some((rewind, (left, states))) = rewinds.next_if(|(r, _)| r.index == index) {
                rewind.pair = states[before as usize];
                state = *left;
            }
        }
        self.plan
    }

    fn out_of_travel(&self, target: &Target, angles: &RotaryAngles) -> Box<Diagnostic> {
        let needs: Vec<String> = (0..self.plan.chain.families())
            .map(|family| {
                let turns = self.plan.chain.solution(angles, family);
                let degrees = self.plan.chain.spread(turns.map(|turn| turn.degrees()));
                let axes = self.machine.rotary.iter();
                let free = angles.free().then_some(self.plan.chain.places[0]);
                axes.filter(|axis| Some(axis.index()) != free)
                    .map(|axis| format!("{} {:.3}", axis.letter, degrees[axis.index()]))
                    .collect::<Vec<_>>()
                    .join(" ")
            })
            .collect();
        let travel: Vec<String> = (self.machine.rotary.iter())
            .filter(|axis| !axis.unlimited())
            .map(|axis| format!("{} {} to {}", axis.letter, axis.min, axis.max))
            .collect();
        let v = target.axis;
        let message = format!(
            "the tool axis {:.6}, {:.6}, {:.6} needs {}, out of the travel of {}",
            v.x,
            v.y,
            v.z,
            needs.join(" or "),
            travel.join(", ")
        );
        Diagnostic::error(Rule::AxisLimit, message).line(target.line).into()
    }
}

fn unreachable(target: &Target, error: &Unreachable) -> Box<Diagnostic> {
    let v = target.axis;
    let message = format!(
        "the tool axis {:.6}, {:.6}, {:.6} is out of reach by {:.4}°",
        v.x,
        v.y,
        v.z,
        error.deviation.to_degrees()
    );
    Diagnostic::error(Rule::UnreachableOrientation, message)
        .help("the rotary axes of this machine have no position for it")
        .line(target.line)
        .into()
}

/// Whether there is such a state.
fn exists(state: &[f64; 2]) -> bool {
    state[0] + state[1] < f64::INFINITY
}

impl Front {
    /// Before the first target, with nothing known of where the axes stand.
    fn empty() -> Front {
        let states = [[f64::INFINITY; 2]; STATES];
        let cost = [f64::INFINITY; STATES];
        Front { states, cost, axis: Vec3::Z, singular: false, margin: 0.0 }
    }

    /// The state that is reached best.
    fn best(&self) -> usize {
        let costs = self.cost.iter().enumerate();
        costs.min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(state, _)| state)
    }
}

impl Plan {
    /// Writes the states that the travel leaves into `states`.
    fn states(&self, angles: &RotaryAngles, states: &mut States) {
        for (family, states) in
            states.chunks_exact_mut(TURNS).enumerate().take(self.chain.families())
        {
            let base = self.chain.solution(angles, family);
            let first = [0, 1].map(|k| self.axes[k].first(base[k].degrees()));
            for (state, turns) in states.iter_mut().zip(&self.turns).take(self.in_turns) {
                *state = [0, 1].map(|k| self.axes[k].position(first[k], turns[k]));
            }
        }
    }

    /// Goes on in every state of `front` where the way to `next` is so short that no change can be
    /// better, which follows from the triangle inequality without looking at any; whether it was.
    fn keep(&self, front: &Front, next: &mut Front) -> bool {
        let mut longest: f64 = 0.0;
        for first in [0, TURNS].into_iter().take(self.chain.families()) {
            for j in first..first + self.in_turns {
                let (from, to) = (&front.states[j], &next.states[j]);
                if exists(from) != exists(to) {
                    return false;
                }
                let travel = if exists(to) { self.travel(from, to) } else { 0.0 };
                longest = longest.max(travel);
                next.cost[j] = front.cost[j] + travel;
            }
        }
        next.margin = front.margin - 2.0 * longest;
        next.margin > 0.0 && longest <= self.near
    }

    /// By how much, at least, going on in a state of `front` is better than changing to it; nothing
    /// where there is a state that no sequence leads to yet.
    fn margin(&self, front: &Front) -> f64 {
        let mut states = front.states.iter().zip(&front.cost);
        if states.any(|(state, cost)| exists(state) && *cost == f64::INFINITY) {
            return 0.0;
        }
        let mut margin = f64::INFINITY;
        for (j, to) in front.states.iter().enumerate().filter(|(_, state)| exists(state)) {
            for (i, from) in front.states.iter().enumerate() {
                if i != j && exists(from) {
                    let change = front.cost[i] + self.travel(from, to) - front.cost[j];
                    margin = margin.min(change);
                }
            }
        }
        margin
    }

    /// The best sequence to each state of `next` from those of `front`; `None` where none can be reached.
    fn relax(
        &self,
        machine: &Machine,
        front: &Front,
        next: &mut Front,
        freedom: Freedom,
    ) -> Option<u32> {
        let (families, turns) = (self.chain.families(), self.in_turns);
        let mut link = 0;
        let mut reached = false;
        for j in (0..families).flat_map(|family| (0..turns).map(move |k| TURNS * family + k)) {
            let to = &next.states[j];
            if !exists(to) {
                next.cost[j] = f64::INFINITY;
                continue;
            }
            let (mut best, mut from) = (f64::INFINITY, 0);
            // The same solution first: it is near, and mostly settles it.
            for first in [0, TURNS].into_iter().take(families).map(|other| other ^ (j & TURNS)) {
                for i in first..first + turns {
                    if front.cost[i] >= best {
                        continue;
                    }
                    let state = &front.states[i];
                    let travel = [0, 1].map(|k| self.axes[k].travel(state[k], to[k]));
                    let cost = front.cost[i] + travel[0] + travel[1];
                    if cost < best {
                        let near = travel[0] + travel[1] <= self.near
                            && (first == (j & TURNS) || !self.by_vector);
                        let open = freedom == Freedom::All
                            || travel[0].max(travel[1]) <= 180.0 + SLACK
                                && (near
                                    || freedom == Freedom::AboutTool
                                    || self.stays_near(machine, front, i, next, j));
                        if open {
                            (best, from) = (cost, i as u32);
                        }
                    }
                }
            }
            next.cost[j] = best;
            reached |= best < f64::INFINITY;
            link |= from << (BITS * j as u32);
        }
        next.margin = self.margin(next);
        reached.then_some(link)
    }

    /// Whether the tool axis keeps to its great circle from one position to the other; where the control turns it by itself, whether
    /// in the middle it would still be between the two tool axes.
    fn stays_near(
        &self,
        machine: &Machine,
        front: &Front,
        i: usize,
        next: &Front,
        j: usize,
    ) -> bool {
        let (from, to) = (&front.states[i], &next.states[j]);
        let part = |t: f64| {
            let turned = [0, 1].map(|k| from[k] + self.axes[k].way(from[k], to[k]) * t);
            self.chain.spread(turned)
        };
        let axis = machine.axis_at(part(0.5));
        if !self.by_vector {
            // The middle shows it for most positions that leave the great circle.
            return angle_between(axis, between(front.axis, next.axis, 0.5)) <= SWING
                && machine.swing([part(0.0), part(1.0)], [front.axis, next.axis]) <= SWING;
        }
        let turn = angle_between(front.axis, next.axis);
        let swing = angle_between(axis, front.axis).max(angle_between(axis, next.axis));
        swing <= turn + SWING
    }

    /// The rotary travel between two states, degrees.
    fn travel(&self, from: &[f64; 2], to: &[f64; 2]) -> f64 {
        self.axes[0].travel(from[0], to[0]) + self.axes[1].travel(from[1], to[1])
    }
}
