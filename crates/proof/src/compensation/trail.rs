//! The stretches in which a program compensates, as it says them: what the control is then to make of them.

use crate::resolved_pose::PartialPose;
use geom::Arc;
use program::Compensation;

/// A move of the program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// Line of the program.
    pub line: u32,
    pub from: PartialPose,
    pub to: PartialPose,
    pub arc: Option<Arc>,
}

/// What holds in a stretch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    /// Line of the source.
    pub source_line: u32,
    /// On which side of the way the tool is.
    pub side: Compensation,
    /// Radius of the source's tool, mm, where it is known.
    pub radius: Option<f64>,
    /// Its length, mm, where it is known.
    pub tool_length: Option<f64>,
}

/// The moves from the one that switches compensation on to the one that switches it off.
#[derive(Clone, Debug)]
pub(crate) struct CompensatedMoves {
    pub terms: Terms,
    /// How many moves the program makes between the stretch before and this one.
    pub before: usize,
    /// The way in, and the contour.
    pub pieces: Vec<Piece>,
    /// The way out; none where the tool goes home, or another way that no contour has.
    pub exit: Option<Piece>,
}

/// The stretches so far.
#[derive(Default)]
pub(crate) struct Trail {
    stretches: Vec<CompensatedMoves>,
    /// Moves since the last one.
    moves: usize,
    open: Option<CompensatedMoves>,
}

impl Trail {
    /// The program makes a move.
    pub fn moved(&mut self, terms: Terms, piece: Piece) {
        match (&mut self.open, terms.side) {
            (None, Compensation::Off) => self.moves += 1,
            (Some(stretch), Compensation::Off) => {
                stretch.exit = Some(piece);
                self.close();
            }
            (Some(stretch), Compensation::Left(_) | Compensation::Right(_)) => {
                stretch.pieces.push(piece);
            }
            (None, Compensation::Left(_) | Compensation::Right(_)) => {
                let before = std::mem::take(&mut self.moves);
                self.open =
                    Some(CompensatedMoves { terms, before, pieces: vec![piece], exit: None });
            }
        }
    }

    /// The program does what ends a way: it goes home, changes the tool, makes a hole.
    pub fn close(&mut self) {
        self.stretches.extend(self.open.take());
    }

    /// All stretches of the program.
    pub fn finish(mut self) -> Vec<CompensatedMoves> {
        self.close();
        self.stretches
    }
}
