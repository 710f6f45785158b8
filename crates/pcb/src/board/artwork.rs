//! A board as its files draw it: the copper of each side is united where that side is worked on.
//!
//! To unite copper is most of what reading a board takes, and no side needs that of the other: one side goes on
//! while the copper of the other is still being united. What must be known of both before is how large the
//! board is, since that says where it lies. So copper that may reach beyond the outline is united at once.

use super::copper::{Copper, Pattern};
use super::{Board, Face, check};
use geom::region::{Index, Region};
use program::Diagnostic;

/// Copper that is drawn so far within the box around the outline stays within it, mm, whatever uniting adds to
/// its edges.
const WITHIN: f64 = 0.1;

/// A board of which copper may still have to be united.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Artwork {
    /// The board, without the copper that is still to be united.
    pub(crate) board: Board,
    /// Copper of the front that is still to be united.
    pub(crate) front: Option<Pattern>,
    /// The same of the back.
    pub(crate) back: Option<Pattern>,
    /// The file that has all of the board, if one has.
    pub(crate) file: Option<String>,
    /// What had to be assumed, and what is odd about it so far.
    pub(crate) warnings: Vec<Diagnostic>,
}

impl Artwork {
    /// Takes in another layer of the board.
    pub(super) fn take(&mut self, other: Artwork) {
        self.board.take(other.board);
        self.front = self.front.take().or(other.front);
        self.back = self.back.take().or(other.back);
        self.warnings.extend(other.warnings);
    }

    /// The same when all of it is there: its layers fit together, and what is still to be united is within its
    /// outline.
    ///
    /// # Errors
    /// `layers-apart` where a layer lies wholly outside the board; `layer` where copper cannot be united that
    /// reaches beyond the outline.
    pub(crate) fn whole(mut self) -> Result<Artwork, Vec<Diagnostic>> {
        if !(self.is_within(&self.front) && self.is_within(&self.back)) {
            let (front, back) = (self.front.take(), self.back.take());
            let (front, back) = both(|| united(Face::Front, front), || united(Face::Back, back))?;
            for (face, (copper, joined)) in [(Face::Front, front), (Face::Back, back)] {
                self.board.side_mut(face).copper = copper;
                self.warnings.extend(joined);
            }
        }
        let found = check::layers(&self.board).map_err(|found| self.placed(found))?;
        self.warnings.extend(self.placed(found));
        Ok(self)
    }

    /// The board without the copper that is still to be united, which is within its
    /// [extents](Board::extents).
    pub fn board(&self) -> &Board {
        &self.board
    }

    /// Whether there is copper on a side.
    pub fn has_copper(&self, face: Face) -> bool {
        let waits = match face {
            Face::Front => self.front.is_some(),
            Face::Back => self.back.is_some(),
        };
        waits || self.board.side(face).copper.is_some()
    }

    /// The board with all of its copper, and what is odd about it.
    ///
    /// # Errors
    /// `layer` where copper cannot be united, `copper-outside` where copper and outline cannot be compared, and what is wrong
    /// with a [broken edge](Board::broken_edge).
    pub fn united(self) -> Result<(Board, Vec<Diagnostic>), Vec<Diagnostic>> {
        let ([mut board, back], warnings) = self.each_side(|_, board| board)?;
        board.back = back.back;
        match board.broken_edge {
            Some(edge) => Err(edge.findings),
            None => Ok((board, warnings)),
        }
    }

    /// What `go_on` makes of the front and of the back, each by itself and both at the same time, and what is odd
    /// about the board. It is given the board with the copper of that side.
    ///
    /// # Errors
    /// `layer` where copper cannot be united, `copper-outside` where copper and outline cannot be compared.
    pub fn each_side<T: Send>(
        mut self,
        go_on: impl Fn(Face, Board) -> T + Sync,
    ) -> Result<([T; 2], Vec<Diagnostic>), Vec<Diagnostic>> {
        let (front, back) = (self.front.take(), self.back.take());
        let index = self.board.outline.as_ref().map(Index::new);
        let index = index.as_ref();
        let side = |face: Face, pattern: Option<Pattern>| {
            let mut board = self.board.clone();
            let (copper, joined) = united(face, pattern)?;
            if copper.is_some() {
                board.side_mut(face).copper = copper;
            }
            let outside = check::copper(&board, face, index);
            let outside = outside.map_err(|found| self.placed(vec![*found]))?;
            Ok((go_on(face, board), joined, outside))
        };
        let (front, back) = both(|| side(Face::Front, front), || side(Face::Back, back))?;
        let odd = [front.2, back.2, check::holes(&self.board, index)];
        let odd = self.placed(odd.into_iter().flatten().collect());
        let mut warnings = self.warnings;
        warnings.extend([front.1, back.1, odd].into_iter().flatten());
        Ok(([front.0, back.0], warnings))
    }

    /// Whether copper is certainly within the box around the outline.
    fn is_within(&self, pattern: &Option<Pattern>) -> bool {
        let Some((low, high)) = pattern.as_ref().and_then(Pattern::extents) else { return true };
        let outline = self.board.outline.as_ref().and_then(Region::extents);
        outline.is_some_and(|outline| {
            (low - WITHIN).cmpge(outline.0).all() && (high + WITHIN).cmple(outline.1).all()
        })
    }

    /// Findings with the file that has all of the board.
    fn placed(&self, found: Vec<Diagnostic>) -> Vec<Diagnostic> {
        match &self.file {
            Some(file) => found.into_iter().map(|found| found.file(file)).collect(),
            None => found,
        }
    }
}

/// What the pattern of a side covers, if there is one.
fn united(
    face: Face,
    pattern: Option<Pattern>,
) -> Result<(Option<Copper>, Vec<Diagnostic>), Vec<Diagnostic>> {
    let Some(pattern) = pattern else { return Ok((None, Vec::new())) };
    let (copper, found) = pattern.united(face).map_err(|found| vec![*found])?;
    Ok((Some(copper), found))
}

/// What is done with both sides at the same time, or the errors of both.
fn both<T: Send>(
    front: impl FnOnce() -> Result<T, Vec<Diagnostic>> + Send,
    back: impl FnOnce() -> Result<T, Vec<Diagnostic>> + Send,
) -> Result<(T, T), Vec<Diagnostic>> {
    match rayon::join(front, back) {
        (Ok(front), Ok(back)) => Ok((front, back)),
        (front, back) => Err([front.err(), back.err()].into_iter().flatten().flatten().collect()),
    }
}
