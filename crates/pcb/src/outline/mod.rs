//! Outline: the board is cut out, along the outside of its edges and the inside of its cut-outs.
//!
//! The paths are the boundary of the board grown by half the width of the tool, so all of the board stays.
//! What lies within another contour is cut before it, and the outer edge at last: until then the
//! board is held. [`Tabs`] hold it after that. Where the tool is too wide for the outline,
//! that is reported (`narrow`).

mod narrow;
mod tabs;

pub use tabs::Tabs;

use crate::isolation::Direction;
use crate::report::{Fault, Outcome, fault};
use crate::setting;
use crate::tour::Tour;
use crate::{Cut, MERGED, Operation, Path, SAME, Segment, Tool, depths};
use geom::region::{Fill, Region, RegionError, Ring};
use geom::{Element, Vec2};
use program::{Diagnostic, Rule};

/// How a board is cut out.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// With what: an end mill.
    pub tool: Tool,
    /// Thickness of the board, mm.
    pub thickness: f64,
    /// How far the tool goes below the board, mm, 0 or more.
    pub below: f64,
    /// How much deeper it goes each time around, mm.
    pub step: f64,
    /// In which direction around.
    pub direction: Direction,
    /// What holds the pieces; `None` where something else does.
    pub tabs: Option<Tabs>,
    /// Where tabs are put by hand, mm: each on the nearest contour, which has no others then.
    pub tabs_at: Vec<Vec2>,
    /// Where the tool comes from, mm.
    pub from: Vec2,
}

/// A board that is cut out, and what is to be known of it.
#[derive(Clone, Debug, PartialEq)]
pub struct CutOut {
    /// What is done.
    pub operation: Operation,
    /// Where edges are not as the board has them, and tabs not where they should be.
    pub warnings: Vec<Diagnostic>,
}

impl Outline {
    /// Cuts `board` out.
    ///
    /// # Errors
    /// `length`, `step`, `cutter`, `tab-height` and `tab-count` where a setting makes no sense; `no-outline` where
    /// there is no board; `not-parted` for each piece that the tool does not part from another one,
    /// `cutout-too-small` for each cut-out that it does not go into; `too-large` where the outline is more
    /// than can be computed.
    pub fn cut(&self, board: &Region) -> Result<CutOut, Vec<Diagnostic>> {
        let width = self.check(board).map_err(|fault| vec![*fault])?;
        let tight = || Ok([narrow::pieces(board, width)?, narrow::cutouts(board, width)?].concat());
        let tight = tight().map_err(|error| vec![*too_large(error)])?;
        if !tight.is_empty() {
            return Err(tight);
        }
        self.around(board, width).map_err(|error| vec![*too_large(error)])
    }

    /// What the settings say about `board` is possible; then the width of the tool, mm.
    fn check(&self, board: &Region) -> Outcome<f64> {
        setting::length("the thickness of the board", self.thickness)?;
        setting::length("the depth of the outline", self.depth())?;
        setting::step("a step of the outline", self.step, self.depth())?;
        if let Some(tabs) = &self.tabs {
            tabs.check(self.thickness)?;
        }
        if board.is_empty() {
            let help = "give the outline of the board";
            return Err(fault(Rule::NoOutline, "there is no board to cut out", help));
        }
        setting::diameter(&self.tool)
    }

    fn depth(&self) -> f64 {
        self.thickness + self.below.max(0.0)
    }

    fn around(&self, board: &Region, width: f64) -> Result<CutOut, RegionError> {
        let mut warnings = narrow::corners(board, width)?;
        let depths = depths(self.depth(), self.step);
        let grown = board.offset(width / 2.0)?;
        let mut cuts = Vec::new();
        let mut at = self.from;
        for contours in levels(&grown) {
            let tour = Tour { from: at, to: None, reversible: false };
            for path in tour.of_paths(&contours) {
                let Some(contour) = path.merged(MERGED) else { continue };
                let mut spans = Vec::new();
                let by_hand: Vec<Vec2> = self.by_hand(&path, &grown);
                if let Some(tabs) = self.tabs.filter(|_| !by_hand.is_empty()) {
                    spans = tabs.spans_at(&contour, width, &by_hand);
                } else if let Some(tabs) = self.tabs.filter(|_| leaves_a_piece(&contour, width)) {
                    spans = tabs.spans(&contour, width, &mut warnings);
                }
                let cut = self.contour(&tabs::parted(&contour, &spans, path.start()), &depths);
                at = cut.end();
                cuts.push(cut);
            }
        }
        let operation = Operation { name: "outline".to_owned(), tool: self.tool.clone(), cuts };
        Ok(CutOut { operation, warnings })
    }

    /// The tabs that are put on a contour by hand: those to which it is nearest.
    fn by_hand(&self, contour: &Path, grown: &Region) -> Vec<Vec2> {
        let away = |elements: &[Element], at: Vec2| {
            elements.iter().map(|element| element.away(at)).fold(f64::INFINITY, f64::min)
        };
        let all = |at: Vec2| grown.rings().map(move |ring| away(ring.elements(), at));
        let is_nearest = |at: &&Vec2| {
            let nearest = all(**at).fold(f64::INFINITY, f64::min);
            away(contour.elements(), **at) <= nearest + SAME
        };
        self.tabs_at.iter().filter(is_nearest).copied().collect()
    }

    /// Once around at each depth, over the tabs.
    fn contour(&self, parts: &[tabs::Part], depths: &[f64]) -> Cut {
        let top = self.tabs.map_or(f64::INFINITY, |tabs| self.thickness - tabs.height);
        // The boundary has the board on its left.
        let reversed: Vec<tabs::Part> = parts.iter().rev().map(tabs::Part::reversed).collect();
        let parts = match self.direction {
            Direction::Climb => &reversed,
            Direction::Conventional | Direction::Either => parts,
        };
        let whole = tabs::whole(parts);
        let level = |&depth: &f64| -> Vec<Segment> {
            // Above the tabs there are none.
            if depth <= top {
                return whole.iter().map(|element| Segment { element: *element, depth }).collect();
            }
            let depth = |part: &tabs::Part| if part.tab { top } else { depth };
            parts.iter().map(|part| Segment { element: part.element, depth: depth(part) }).collect()
        };
        Cut::Path(depths.iter().flat_map(level).collect())
    }
}

/// Whether something comes loose on the right of a contour of the grown board when it is cut: around the
/// outside always, of a cut-out what the tool leaves of it.
fn leaves_a_piece(contour: &Path, width: f64) -> bool {
    let inside = Ring::new(contour.elements().to_vec())
        .and_then(|ring| Ok((ring.area(), Region::inside([&ring], Fill::NonZero)?)));
    match inside {
        Ok((area, inside)) if area < 0.0 => {
            inside.offset(-width / 2.0).is_ok_and(|piece| !piece.is_empty())
        }
        _ => true,
    }
}

/// The contours of a region, level by level, those first that lie deepest within others.
fn levels(region: &Region) -> Vec<Vec<Path>> {
    let mut levels: Vec<Vec<Path>> = Vec::new();
    let boxes: Vec<(Vec2, Vec2)> =
        region.islands().iter().map(|island| island.outer().extents()).collect();
    for (island, (low, high)) in region.islands().iter().zip(&boxes) {
        let Some(outer) = Path::around(island.outer()) else { continue };
        let around = region.islands().iter().zip(&boxes).filter(|(other, (p, q))| {
            p.cmplt(*low).all() && q.cmpgt(*high).all() && other.outer().encloses(outer.start())
        });
        let level = 2 * around.count();
        if levels.len() < level + 2 {
            levels.resize(level + 2, Vec::new());
        }
        levels[level].push(outer);
        levels[level + 1].extend(island.holes().iter().filter_map(Path::around));
    }
    levels.reverse();
    levels
}

fn too_large(error: RegionError) -> Fault {
    fault(Rule::TooLarge, format!("the outline of the board: {error}"), "correct the outline")
}
