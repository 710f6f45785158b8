//! How much copper a cut takes that goes down the middle of a gap which is narrower than it.

use super::Narrow;
use super::field::Field;
use crate::{Copper, SAME};
use geom::{Element, Vec2};

/// The most copper that a cut down the middle of a gap takes from either side, mm: of the middle as it is calculated.
pub const MOST_BITE: f64 = 0.03;

/// The most that it takes of the copper behind the edge, as a part.
const MOST_PART: f64 = 0.1;

/// By how much more than both a bite is at most, mm: the tool follows a path of few lines, 1 µm beside the middle, and what is
/// taken is looked at from place to place.
pub const BITE_OFF: f64 = 0.002;

/// So much of the copper behind an edge belongs to the edge itself, mm: twice what a region may be off.
const EDGE: f64 = 0.002;

/// Where a cut may go down the middle of a gap.
pub(crate) struct Bite<'a> {
    pub(super) field: Field<'a>,
    /// How wide the cut is, mm.
    pub(super) width: f64,
    narrow: Narrow,
}

impl<'a> Bite<'a> {
    pub fn new(copper: &'a Copper, width: f64, narrow: Narrow) -> Bite<'a> {
        Bite { field: Field::new(copper), width, narrow }
    }

    /// Whether it differs from place to place of a gap.
    pub fn differs(&self) -> bool {
        self.narrow == Narrow::Bite
    }

    /// Whether the cut may go through `at`, between conductors. Each is bitten where it is nearest; nowhere is the cut
    /// deeper in it.
    pub fn may_cut(&self, at: Vec2) -> bool {
        match self.narrow {
            Narrow::LeaveOut => false,
            Narrow::Middle => true,
            Narrow::Bite => self.feet(at).into_iter().all(|(_, foot)| {
                let bite = self.width / 2.0 - foot.distance(at);
                bite <= MOST_BITE && self.is_thick(at, foot, bite / MOST_PART)
            }),
        }
    }

    /// Of each conductor that the cut at `at` bites, where it is nearest.
    fn feet(&self, at: Vec2) -> Vec<(usize, Vec2)> {
        let reach = self.width / 2.0;
        let mut feet: Vec<(usize, Vec2)> = Vec::new();
        for edge in self.field.within(at - reach, at + reach) {
            let (t, away) = edge.element.nearest(at);
            if away >= reach {
                continue;
            }
            let foot = edge.element.at(t);
            match feet.iter_mut().find(|(conductor, _)| *conductor == edge.conductor) {
                Some((_, nearest)) if nearest.distance(at) > away => *nearest = foot,
                Some(_) => {}
                None => feet.push((edge.conductor, foot)),
            }
        }
        feet
    }

    /// Whether there is copper for `depth` mm behind `foot`, seen from `at`.
    fn is_thick(&self, at: Vec2, foot: Vec2, depth: f64) -> bool {
        let Some(inwards) = (foot - at).try_normalize() else { return false };
        if depth <= EDGE {
            return true;
        }
        let behind = Element::line(foot + inwards * EDGE, foot + inwards * depth);
        let (low, high) = behind.extents();
        let mut edges = self.field.within(low, high);
        edges.all(|edge| behind.meets(edge.element, SAME).next().is_none())
    }
}
