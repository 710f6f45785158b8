//! A board as its files draw it: the copper of each side is united where that side is worked on.
//!
//! To unite copper is most of what reading a board takes, and no side needs that of the other: one side goes on
//! while the copper of the other is still being united. What must be known of both before is how large the
//! board is, since that says where it lies. So copper that may reach beyond the outline is united, and cropped, at once.

use super::copper::{Copper, Pattern};
use super::{Board, Face, check, crop};
use geom::region::{Fill, Index, Region, RegionError, Ring};
use geom::{Element, Vec2};
use program::{Diagnostic, Rule};

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
            let lines = [&front, &back].map(lines);
            let (front, back) = both(|| united(Face::Front, front), || united(Face::Back, back))?;
            let united = [(Face::Front, front), (Face::Back, back)].into_iter().zip(lines);
            for ((face, (copper, joined)), lines) in united {
                self.board.side_mut(face).copper = copper;
                self.board.side_mut(face).lines = lines;
                self.warnings.extend(joined);
            }
        }
        let found = check::layers(&self.board).map_err(|found| self.placed(found))?;
        self.warnings.extend(self.placed(found));
        self.cropped().map_err(|found| self.placed(vec![*found]))?;
        Ok(self)
    }

    /// The board with an outline where none could be taken: of a broken edge, gaps of up to `close` mm closed; of a board
    /// without an edge, with `margin`, the rectangle that reaches so far beyond its copper and holes, mm.
    ///
    /// # Errors
    /// `copper-outside` where copper and outline cannot be compared, `outline` where the rectangle cannot be.
    pub fn outlined(mut self, close: f64, margin: Option<f64>) -> Result<Artwork, Vec<Diagnostic>> {
        let board = &mut self.board;
        if let Some((region, found)) =
            board.broken_edge.as_ref().and_then(|edge| edge.mended(close))
        {
            (board.outline, board.broken_edge) = (Some(region), None);
            self.warnings.extend(found);
            self.cropped().map_err(|found| self.placed(vec![*found]))?;
        } else if board.outline.is_none()
            && board.broken_edge.is_none()
            && let (Some(margin), Some((low, high))) = (margin, board.extents())
        {
            board.outline = Some(rectangle(low - margin, high + margin)?);
            let message = format!(
                "no file has the edge of the board: it is a rectangle, {margin} mm around copper and holes"
            );
            let help = "give the layer of the outline where the board has another form";
            self.warnings.push(Diagnostic::warning(Rule::NoOutline, message).help(help));
        }
        Ok(self)
    }

    /// The board as a rectangle around its edge, or else its copper and holes, that reaches `margin` mm beyond; cut-outs stay.
    ///
    /// # Errors
    /// `outline` where the rectangle cannot be made.
    pub fn rectangular(mut self, margin: f64) -> Result<Artwork, Vec<Diagnostic>> {
        let board = &mut self.board;
        let Some((low, high)) = board.extents() else { return Ok(self) };
        let mut region = rectangle(low - margin, high + margin)?;
        if let Some(outline) = &board.outline {
            let cut = crop::filled(outline).and_then(|filled| filled.difference(outline));
            region = cut.and_then(|cut| region.difference(&cut)).map_err(no_rectangle)?;
        }
        (board.outline, board.broken_edge) = (Some(region), None);
        Ok(self)
    }

    /// Leaves out what is outside the outline, and cut-outs that are drilled.
    fn cropped(&mut self) -> Result<(), Box<Diagnostic>> {
        let Some(edge) = self.edge()? else { return Ok(()) };
        let drilled = crop::drilled(&mut self.board).map_err(|error| {
            let message = format!("the outline cannot be compared with the holes: {error}");
            Box::new(
                Diagnostic::error(Rule::Outline, message).help("draw the edge of the board anew"),
            )
        })?;
        let drilled = self.placed(drilled.into_iter().collect());
        self.warnings.extend(drilled);
        let index = Index::new(&edge);
        for face in [Face::Front, Face::Back] {
            let found = crop::copper(&mut self.board, face, &edge, &index)?;
            let found = self.placed(found.into_iter().collect());
            self.warnings.extend(found);
            crop::coats(&mut self.board, face, &edge, &index);
        }
        Ok(())
    }

    /// What the outer contours of the outline enclose, where there is one.
    fn edge(&self) -> Result<Option<Region>, Box<Diagnostic>> {
        let edge = self.board.outline.as_ref().map(crop::filled).transpose();
        edge.map_err(|error: RegionError| {
            let message = format!("the outline cannot be compared with anything: {error}");
            let help = "draw the edge of the board anew, or leave its layer out";
            Diagnostic::error(Rule::Outline, message).help(help).into()
        })
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
        let edge = self.edge().map_err(|found| self.placed(vec![*found]))?;
        let edge = edge.as_ref().map(|edge| (edge, Index::new(edge)));
        let index = self.board.outline.as_ref().map(Index::new);
        let side = |face: Face, pattern: Option<Pattern>| {
            let mut board = self.board.clone();
            let drawn = lines(&pattern);
            let (copper, joined) = united(face, pattern)?;
            let placed = |found: Box<Diagnostic>| self.placed(vec![*found]);
            let mut cropped = None;
            if copper.is_some() {
                board.side_mut(face).copper = copper;
                board.side_mut(face).lines = drawn;
                if let Some((edge, index)) = &edge {
                    cropped = crop::copper(&mut board, face, edge, index).map_err(placed)?;
                }
            }
            let outside = check::copper(&board, face, index.as_ref()).map_err(placed)?;
            let odd: Vec<Diagnostic> = cropped.into_iter().chain(outside).collect();
            Ok((go_on(face, board), joined, odd))
        };
        let (front, back) = both(|| side(Face::Front, front), || side(Face::Back, back))?;
        let holes = check::holes(&self.board, index.as_ref()).into_iter().collect();
        let odd = self.placed([front.2, back.2, holes].concat());
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

/// The board between two corners.
fn rectangle(low: Vec2, high: Vec2) -> Result<Region, Vec<Diagnostic>> {
    let corners = [low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)];
    let region = Ring::polygon(&corners).and_then(|ring| Region::inside([&ring], Fill::NonZero));
    region.map_err(no_rectangle)
}

fn no_rectangle(error: RegionError) -> Vec<Diagnostic> {
    let message = format!("no rectangle around the board can be made: {error}");
    let help = "give another --board-margin, or the layer of the outline";
    vec![Diagnostic::error(Rule::Outline, message).help(help)]
}

/// The middle of the lines that the copper of a side is drawn with.
fn lines(pattern: &Option<Pattern>) -> Vec<Element> {
    pattern.as_ref().map_or_else(Vec::new, Pattern::lines)
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
