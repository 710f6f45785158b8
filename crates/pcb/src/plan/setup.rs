//! How a board lies on the machine with one of its sides up.

use super::empty;
use super::{Settings, Turn};
use crate::board::{Axis, Face};
use crate::{Board, Hole};
use geom::{Transform, Vec2};
use program::Diagnostic;

/// How much is left between the pins that align a board and the cut around it, mm.
const PINS_AWAY: f64 = 1.0;

/// A board on the machine.
pub struct Setup {
    /// The board as it lies there: its front is up, whichever side that is.
    pub board: Board,
    /// The line about which it is turned over.
    pub axis: Axis,
    /// Holes next to the board by which it is aligned when it is turned over.
    pins: Vec<Hole>,
    placed: Placed,
}

/// What was done to a board for it to lie so, in this order.
struct Placed {
    /// It was turned about the zero, by degrees.
    rotated: f64,
    panel: Option<Panel>,
    /// It was moved, mm.
    moved: Vec2,
    /// It was turned over.
    turned: Option<Axis>,
}

/// Copies of a board next to each other.
struct Panel {
    /// The lower left corner of the first, mm.
    low: Vec2,
    /// From one to the next, mm.
    step: Vec2,
    /// Half the gap between two, mm.
    half_gap: Vec2,
    /// How many in a row and in a column.
    count: Vec2,
}

impl Setup {
    /// The board put where `settings` say, with this side up.
    ///
    /// # Errors
    /// Where it cannot be put there.
    pub fn of(face: Face, board: Board, settings: &Settings) -> Result<Setup, Box<Diagnostic>> {
        let placing = &settings.placing;
        let board = if placing.rotate == 0.0 { board } else { board.rotated(placing.rotate) };
        let mut panel = None;
        let board = match placing.panel {
            Some([columns, rows]) => {
                let spacing = Vec2::splat(placing.spacing);
                let (low, high) = board.extents().unwrap_or_default();
                let count = Vec2::new(f64::from(columns), f64::from(rows));
                let (step, half_gap) = (high - low + spacing, spacing / 2.0);
                panel = Some(Panel { low, step, half_gap, count });
                board.panel(columns as usize, rows as usize, spacing)?
            }
            None => board,
        };
        let (low, _) = board.extents().ok_or_else(empty)?;
        let corner = placing.corner.unwrap_or_default();
        let moved = if placing.as_drawn { Vec2::ZERO } else { corner - low };
        let front = if placing.as_drawn { board } else { board.moved(moved)? };
        let axis = match placing.turn {
            Turn::Y => Axis::X(front.middle().x),
            Turn::X => Axis::Y(front.middle().y),
        };
        let pins = match placing.alignment {
            Some(diameter) => {
                let away = settings.outline.outline_tool + PINS_AWAY;
                front.pins(axis, diameter, away)?.to_vec()
            }
            None => Vec::new(),
        };
        let board = match face {
            Face::Front => front,
            Face::Back => front.turned_over(axis),
        };
        let turned = (face == Face::Back).then_some(axis);
        let placed = Placed { rotated: placing.rotate, panel, moved, turned };
        Ok(Setup { board, axis, pins, placed })
    }

    /// Where a place of the board is in the files that draw it; of a panel all copies are the first.
    pub(crate) fn drawn_at(&self, place: Vec2) -> Vec2 {
        let Placed { rotated, panel, moved, turned } = &self.placed;
        // What mirrors does so again on the way back.
        let place = turned.map_or(place, |axis| {
            let (mirror, at) = axis.reflection();
            at + mirror.apply(place)
        });
        let place = place - *moved;
        let place = panel.as_ref().map_or(place, |Panel { low, step, half_gap, count }| {
            let cell = ((place - *low + *half_gap) / *step).floor();
            place - cell.clamp(Vec2::ZERO, *count - 1.0) * *step
        });
        Transform::new(false, -rotated, 1.0).apply(place)
    }

    /// The corners of the least blank: the board, the cut around it and the pins next to it, mm.
    pub fn stock(&self, settings: &Settings) -> (Vec2, Vec2) {
        let (low, high) = self.board.extents().unwrap_or_default();
        let cut = Vec2::splat(settings.outline.outline_tool);
        let pins = self.pins.iter().map(Hole::extents);
        pins.fold((low - cut, high + cut), |(a, b), (low, high)| (a.min(low), b.max(high)))
    }

    /// The holes that are drilled: those of the board, and those of the pins. The line about which a board is turned
    /// over is in the middle between these, so that they stay where they are.
    pub fn drilled(&self) -> impl Iterator<Item = &Hole> {
        self.board.holes.iter().chain(&self.pins)
    }
}
