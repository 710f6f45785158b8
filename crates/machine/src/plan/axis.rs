//! The travel of a rotary axis, and the positions in it.

use super::TURNS;
use crate::Machine;
use crate::inverse::{Chain, REACH_EPSILON};
use std::f64::consts::PI;

/// Travel is compared to within this, degrees: what the tool axis may be out of reach by rounding.
pub(super) const SLACK: f64 = REACH_EPSILON * 180.0 / PI;

/// The travel of a rotary axis; an axis that the machine lacks never moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    min: f64,
    max: f64,
    unlimited: bool,
}

impl Axis {
    /// The travel in which the operation is planned. Where an axis turns so often that its states
    /// would be too many, it is planned in the turns around where it stands.
    pub(super) fn of(machine: &Machine, chain: &Chain, start: [f64; 3]) -> [Axis; 2] {
        let mut axes = [Axis { min: 0.0, max: 0.0, unlimited: false }; 2];
        for (axis, &place) in axes.iter_mut().zip(&chain.places).take(chain.links) {
            if let Some(rotary) = machine.rotary.iter().find(|r| r.index() == place) {
                let unlimited = rotary.unlimited();
                *axis = Axis { min: rotary.min, max: rotary.max, unlimited };
            }
        }
        let start = chain.gather(start);
        let most = TURNS as f64;
        if axes[0].turns() * axes[1].turns() > most {
            let other = if axes[1].turns() < most { axes[1].turns() } else { 2.0 };
            axes[0] = axes[0].around(start[0], (most / other).floor());
            axes[1] = axes[1].around(start[1], (most / axes[0].turns()).floor());
        }
        axes
    }

    /// In how many turns a position may stand, at the most.
    pub(super) fn turns(&self) -> f64 {
        if self.unlimited { 1.0 } else { ((self.max - self.min + SLACK) / 360.0).floor() + 1.0 }
    }

    fn around(self, position: f64, turns: f64) -> Axis {
        if self.turns() <= turns {
            return self;
        }
        let width = 360.0 * turns - 1e-3;
        let min = (position - width / 2.0).min(self.max - width).max(self.min);
        Axis { min, max: min + width, ..self }
    }

    /// The first position from the lower end of the travel on that is `base` but for whole turns.
    pub(super) fn first(&self, base: f64) -> f64 {
        if self.unlimited {
            return base;
        }
        base + 360.0 * up((self.min - base - SLACK) * (1.0 / 360.0))
    }

    /// The position `turn` turns behind the first; infinite where the travel ends before.
    pub(super) fn position(&self, first: f64, turn: f64) -> f64 {
        if self.unlimited {
            return first;
        }
        let position = first + 360.0 * turn;
        if position > self.max + SLACK { f64::INFINITY } else { self.nearest(position) }
    }

    /// The position within the travel nearest to `position`.
    pub(super) fn nearest(&self, position: f64) -> f64 {
        position.max(self.min).min(self.max)
    }

    /// The turn from one position to the other, degrees: the shorter one where the axis turns for
    /// ever.
    pub(super) fn way(&self, from: f64, to: f64) -> f64 {
        let way = to - from;
        // Half a turn is taken upwards, also where rounding makes it a little more.
        if self.unlimited { way - 360.0 * up(way / 360.0 - 0.5 - 1e-9) } else { way }
    }

    /// How far it is from one state to the other, degrees.
    pub(super) fn travel(&self, from: f64, to: f64) -> f64 {
        let travel = (to - from).abs();
        if self.unlimited { travel.min((360.0 - travel).abs()) } else { travel }
    }

    /// `position` as a state has it: without its whole turns where the axis turns for ever.
    pub(super) fn base(&self, position: f64) -> f64 {
        if self.unlimited { self.way(0.0, position) } else { position }
    }

    pub(super) fn off_center(&self, position: f64) -> f64 {
        if self.unlimited { 0.0 } else { (position - (self.min + self.max) / 2.0).abs() }
    }
}

/// The least whole number that is not below `x`: `ceil` for numbers of turns, without its call.
fn up(x: f64) -> f64 {
    let whole = x as i64 as f64;
    if whole < x { whole + 1.0 } else { whole }
}
