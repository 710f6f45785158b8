//! The rotary positions of a whole operation.
//!
//! Every tool axis has up to two solutions, and on a limited axis each of them may stand in several
//! turns: those are the states of a target. The sequence of states is chosen for the whole
//! operation at once (dynamic programming), in this order:
//!
//! 1. no rotary axis leaves its travel;
//! 2. in a cut the tool axis keeps within 0.9° of the great circle of its turn, and no axis turns by more
//!    than half a turn: where the travel allows no such turn, the tool must leave the part, turn back
//!    and come in again, as late and therefore as seldom as possible;
//! 3. the rotary travel within the operation is the shortest;
//! 4. the preferred solution at its start; 5. the shortest turn from the positions of the axes to it.
//!
//! Unlimited axes wind on and never jump by a turn. In a singular pose, where one axis may stand
//! anywhere, it holds its position, and turns to where it is needed next in the last rapid before that,
//! else in the last move from one singular pose to another, else in the move that leaves the pose.
//!
//! A target takes 16 bytes until its operation is written, and no more is kept.

mod axis;
mod search;

pub use search::NEAR;

use crate::Machine;
use crate::inverse::{Chain, RotaryAngles};
use axis::Axis;
use geom::Vec3;
use program::{Diagnostic, Rule};
use search::Search;

/// A pose to be reached, as far as the rotary axes are concerned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Unit vector from the tool tip towards the spindle, work frame.
    pub axis: Vec3,
    /// Line of the source, from 1.
    pub line: u32,
    /// How it is reached.
    pub kind: TargetKind,
}

/// How a pose is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetKind {
    /// By rapid: the rotary axes may turn as they like.
    Rapid,
    /// In the cut.
    Feed,
    /// In the cut along an arc, during which the orientation holds.
    Arc,
}

/// The rotary positions for the targets of one operation.
#[derive(Clone, Debug)]
pub struct Plan {
    chain: Chain,
    axes: [Axis; 2],
    /// For each of the `in_turns` states of a solution the turn of the outer and of the inner axis.
    turns: [[f64; 2]; TURNS],
    in_turns: usize,
    /// Whether the control turns the tool along a vector by itself, and not the axes evenly.
    by_vector: bool,
    /// Turns of less than this, degrees, need no look at where the tool is between.
    near: f64,
    start: [f64; 2],
    cells: Vec<Cell>,
    /// Where the travel allows no further turn, in order.
    pub rewinds: Vec<Rewind>,
}

/// A place in a cut at which the tool must be drawn back, turned and brought in again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rewind {
    /// The target before which that happens, at the tip of the one before it.
    pub index: usize,
    /// Line of the source of that target.
    pub line: u32,
    /// Positions in which the tool comes in again.
    pair: [f64; 2],
}

/// What the rotary axes do for one target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Degrees of A, B, C at the target.
    pub degrees: [f64; 3],
    /// Where the travel allows no further turn: the degrees of A, B, C to which the axes turn first, at the
    /// tip of the target before, with the tool drawn back along its axis and brought in again.
    pub rewind: Option<[f64; 3]>,
}

/// The most turns in which a solution may stand, those of the two axes multiplied.
const TURNS: usize = 4;
/// Of a singular target: here the free axis turns to where it is needed next.
const TURN: u32 = 1 << 31;

/// A target while its operation is planned: its rotary angles, and for each state the state of the target
/// before from which it is reached best; once that is settled, its own state.
#[derive(Clone, Copy, Debug)]
struct Cell {
    angles: RotaryAngles,
    link: u32,
}

/// Chooses the rotary positions for `targets`, from where the axes stand at `start` (degrees of A, B,
/// C; `None` where that is not known).
///
/// # Errors
/// `unreachable-orientation` where no position gives a tool axis, `axis-limit` where the travel has
/// none that does, or none that the move can end in; `arc-orientation` where the tool axis turns during
/// an arc. Each with the line of the source.
pub fn plan(
    machine: &Machine,
    start: Option<[f64; 3]>,
    targets: impl IntoIterator<Item = Target>,
) -> Result<Plan, Box<Diagnostic>> {
    let targets = targets.into_iter();
    let mut search = Search::new(machine, start, targets.size_hint().0);
    for target in targets {
        search.add(&target)?;
    }
    Ok(search.finish())
}

impl Rewind {
    /// What the report says about it.
    pub fn warning(&self) -> Diagnostic {
        let message = "the travel of the rotary axes ends in this cut: the tool is drawn back, \
                       turned and brought in again";
        Diagnostic::warning(Rule::Rewind, message).line(self.line)
    }
}

impl Plan {
    /// How many targets there are.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there are no targets.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The positions for each target, in order.
    pub fn iter(&self) -> Steps<'_> {
        Steps { plan: self, index: 0, rewinds: &self.rewinds, last: self.start }
    }

    /// The positions settled for a target that is not singular.
    fn settled(&self, cell: &Cell) -> [f64; 2] {
        let (family, turn) = (cell.link as usize / TURNS, cell.link as usize % TURNS);
        let base = self.chain.solution(&cell.angles, family);
        [0, 1].map(|k| {
            let first = self.axes[k].first(base[k].degrees());
            self.axes[k].position(first, self.turns[turn][k])
        })
    }

    /// The position of the inner axis in a singular pose, where both solutions have the same, in the
    /// turn nearest to `from`; `None` where its travel has none.
    fn inner(&self, angles: &RotaryAngles, from: f64) -> Option<f64> {
        let first = self.axes[1].first(self.chain.solution(angles, 0)[1].degrees());
        let far = |position: f64| self.axes[1].way(from, position).abs();
        let positions = (0..TURNS).map(|turn| self.axes[1].position(first, turn as f64));
        let within = positions.filter(|position| position.is_finite());
        within.min_by(|a, b| far(*a).total_cmp(&far(*b)))
    }
}

/// The positions for the targets of a [`Plan`], in order.
#[derive(Clone, Debug)]
pub struct Steps<'a> {
    plan: &'a Plan,
    index: usize,
    rewinds: &'a [Rewind],
    last: [f64; 2],
}

impl Steps<'_> {
    /// `pair` in the turns of unlimited axes that are nearest to where they stand.
    fn wound(&self, pair: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| self.last[k] + self.plan.axes[k].way(self.last[k], pair[k]))
    }

    /// What a singular pose takes: the free axis where it stands, or where it is needed next.
    fn singular(&self, cell: &Cell) -> [f64; 2] {
        let mut outer = self.last[0];
        if cell.link & TURN != 0 {
            let next = self.plan.cells[self.index..].iter().find(|cell| !cell.angles.free());
            outer = next.map_or(outer, |cell| self.plan.settled(cell)[0]);
        }
        [outer, self.plan.inner(&cell.angles, self.last[1]).unwrap_or(self.last[1])]
    }
}

impl Iterator for Steps<'_> {
    type Item = Step;

    fn next(&mut self) -> Option<Step> {
        let cell = self.plan.cells.get(self.index)?;
        let mut rewind = None;
        if let [first, rest @ ..] = self.rewinds
            && first.index == self.index
        {
            self.rewinds = rest;
            self.last = self.wound(first.pair);
            rewind = Some(self.plan.chain.spread(self.last));
        }
        let pair = if cell.angles.free() { self.singular(cell) } else { self.plan.settled(cell) };
        self.last = self.wound(pair);
        self.index += 1;
        Some(Step { degrees: self.plan.chain.spread(self.last), rewind })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.plan.cells.len() - self.index;
        (left, Some(left))
    }
}

impl ExactSizeIterator for Steps<'_> {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_target_takes_16_bytes() {
        assert_eq!(size_of::<Cell>(), 16);
    }
}
