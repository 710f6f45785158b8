//! How a board lies on the machine with one of its sides up.

use super::empty;
use super::{Settings, Turn};
use crate::board::{Axis, Face};
use crate::{Board, Hole};
use geom::Vec2;
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
}

impl Setup {
    /// The board put where `settings` say, with this side up.
    ///
    /// # Errors
    /// Where it cannot be put there.
    pub fn of(face: Face, board: Board, settings: &Settings) -> Result<Setup, Box<Diagnostic>> {
        let placing = &settings.placing;
        let board = if placing.rotate == 0.0 { board } else { board.rotated(placing.rotate) };
        let board = match placing.panel {
            Some([columns, rows]) => {
                board.panel(columns as usize, rows as usize, Vec2::splat(placing.spacing))?
            }
            None => board,
        };
        let (low, _) = board.extents().ok_or_else(empty)?;
        let corner = placing.corner.unwrap_or_default();
        let front = if placing.as_drawn { board } else { board.moved(corner - low)? };
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
        Ok(Setup { board, axis, pins })
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
