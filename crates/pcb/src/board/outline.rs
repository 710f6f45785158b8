//! The outline of a board from what its edge layer draws.
//!
//! The edge is the middle of what is drawn, however wide. Lines and arcs may come in any order and
//! direction; what is drawn twice counts once. They make closed loops, which neither branch nor
//! cross: within an odd number of them there is board. Areas that the layer fills are the board
//! themselves.

use super::copper::covered;
use super::mend;
use crate::SAME;
use crate::contour::around;
use crate::crossing::self_crossing;
use crate::gerber::{Image, Object, Shape};
use geom::region::{Fill, Region, Ring};
use geom::{Chain, ChainError, Element, Vec2, chain};
use program::{Diagnostic, Rule};

/// The widest gap between ends that is closed, mm: below the width of any cutter of an outline.
pub const GAP: f64 = 0.05;

/// The widest gap that is closed without a word, mm: rounding. Crossings of less are none.
const ROUNDING: f64 = 1e-3;

/// The widest pen whose ink closes gaps, mm: wider ones draw something else than an edge.
const WIDEST_PEN: f64 = 1.0;

/// The ink of two ends is one where they are no farther apart than this part of the width of the pen.
const INKED: f64 = 0.9;

/// The most open ends that are reported.
const MOST_ENDS: usize = 20;

/// An outline, and what had to be mended.
pub type Outlined = (Region, Vec<Diagnostic>);

/// An edge that says where the board is, and not where it ends: no program that needs the outline can be made, all others can.
#[derive(Clone, Debug, PartialEq)]
pub struct BrokenEdge {
    /// Why no outline comes of it.
    pub findings: Vec<Diagnostic>,
    /// The corners of the box around what it draws, mm; `None` where it draws nothing.
    pub extents: Option<(Vec2, Vec2)>,
    /// The lines that it draws, each with its line in the file.
    lines: Vec<(Element, u32)>,
    /// The width of the widest pen that draws them, mm: ends that its ink joins are one.
    pen: f64,
    /// The file.
    file: String,
}

impl BrokenEdge {
    /// An edge on a layer of which [`of_image`] makes no outline: it is the middle of lines, or the rim of all that is drawn where
    /// there are none.
    pub(crate) fn of_image(findings: Vec<Diagnostic>, image: &Image) -> BrokenEdge {
        let strokes = image.objects.iter().filter_map(|object| match object.shape {
            Shape::Stroke { path, .. } => Some((path, object.line)),
            Shape::Region { .. } | Shape::Flash { .. } => None,
        });
        let pens = image.objects.iter().filter_map(|object| Some(image.stroke(object)?.1));
        let edge = BrokenEdge::of_lines(findings, &strokes.collect::<Vec<_>>());
        let extents = edge.extents.or_else(|| image.extents());
        BrokenEdge { extents, pen: pens.fold(0.0, f64::max), ..edge }
    }

    /// An edge of `lines` of which [`of_lines`] makes no outline.
    pub(crate) fn of_lines(findings: Vec<Diagnostic>, lines: &[(Element, u32)]) -> BrokenEdge {
        let extents = lines.iter().map(|(element, _)| element.extents()).reduce(around);
        BrokenEdge { findings, extents, lines: lines.to_vec(), pen: 0.0, file: String::new() }
    }

    /// The outline that its lines mean when gaps of up to `close` mm are closed, and those that the ink of its pen closes;
    /// `None` where nobody can know.
    pub(super) fn mended(&self, close: f64) -> Option<Outlined> {
        // What else is on the layer, or how its contours cross, no line that is added mends.
        let is_about_ends = |found: &Diagnostic| {
            matches!(found.rule, Rule::OutlineOpen | Rule::OutlineBranch | Rule::OutlineTangled)
        };
        if !self.findings.iter().all(is_about_ends) {
            return None;
        }
        let (region, found) =
            mend::mended(&self.lines, close.max(INKED * self.pen.min(WIDEST_PEN)))?;
        let found = found.into_iter().map(|found| match self.file.as_str() {
            "" => found,
            file => found.file(file),
        });
        Some((region, found.collect()))
    }

    /// The same, with the file of which its findings are.
    pub(crate) fn file(self, name: &str) -> BrokenEdge {
        let findings = self.findings.into_iter().map(|found| found.file(name)).collect();
        BrokenEdge { findings, file: name.to_owned(), ..self }
    }
}

/// The outline that an edge layer describes.
///
/// # Errors
/// `outline-mixed` where lines, areas, or what erases them come together, and what [`of_lines`] refuses.
/// Findings have lines, but no file.
pub fn of_image(image: &Image) -> Result<Outlined, Vec<Diagnostic>> {
    let (mut lines, mut areas, mut flashes) = (Vec::new(), None, None);
    for object in &image.objects {
        match object.shape {
            _ if !object.dark => return Err(vec![mixed(object, "something is erased")]),
            Shape::Stroke { path, .. } => lines.push((path, object.line)),
            Shape::Region { .. } => areas = areas.or(Some(object)),
            Shape::Flash { .. } => flashes = flashes.or(Some(object)),
        }
    }
    match (areas, lines.is_empty()) {
        (Some(area), false) => Err(vec![mixed(area, "an area is filled next to lines")]),
        (Some(area), true) => {
            let region = covered(image).map_err(|error| vec![refused(area.line, &error)])?;
            Ok((region, Vec::new()))
        }
        (None, _) => {
            let (region, mut warnings) = of_lines(&lines)?;
            if let Some(flash) = flashes {
                let message = "what is flashed on the layer of the outline is no edge";
                let help = "it is left out";
                let found = Diagnostic::warning(Rule::OutlineFlash, message).help(help);
                warnings.push(found.line(flash.line));
            }
            Ok((region, warnings))
        }
    }
}

/// The outline whose edge is made of `lines`, each with its line in the file. Gaps of up to [`GAP`] are
/// closed, with a warning where one is above 1 µm.
///
/// # Errors
/// `outline-open` with the place and size of each gap, `outline-branch` where more than two ends meet,
/// or one ends on the middle of another, `outline-crosses`, `outline-empty`. Findings have lines, but
/// no file.
pub fn of_lines(lines: &[(Element, u32)]) -> Result<Outlined, Vec<Diagnostic>> {
    let pieces: Vec<[Element; 1]> = lines.iter().map(|(element, _)| [*element]).collect();
    let line = |piece: usize| lines.get(piece).map_or(0, |(_, line)| *line);
    let chains = chain(&pieces, GAP).map_err(|error| vec![no_chain(error, &line)])?;
    let open: Vec<&Chain> = chains.chains.iter().filter(|chain| !chain.closed).collect();
    if !open.is_empty() {
        return Err(open_ends(&open, lines));
    }
    let mut rings = Vec::with_capacity(chains.chains.len());
    let mut all = Vec::with_capacity(lines.len());
    for chain in &chains.chains {
        let elements = joined(chain, lines);
        all.extend_from_slice(&elements);
        let first = chain.pieces.first().map_or(0, |(piece, _)| line(*piece));
        rings.push(Ring::new(elements).map_err(|error| vec![refused(first, &error)])?);
    }
    let crossing = self_crossing(&all, ROUNDING).map_err(|fault| vec![*fault])?;
    if let Some(place) = crossing {
        let message = format!("the outline crosses itself near {}", shown(place));
        let help = "draw contours that do not cross: the edge of the board, and its cut-outs in it";
        return Err(vec![Diagnostic::error(Rule::OutlineCrosses, message).help(help)]);
    }
    let region = Region::inside(&rings, Fill::EvenOdd).map_err(|e| vec![refused(0, &e)])?;
    if region.is_empty() {
        let found = Diagnostic::error(Rule::OutlineEmpty, "the outline encloses nothing");
        return Err(vec![found.help("draw the edge of the board, or leave the layer out")]);
    }
    let wide = |(from, to): &&(Vec2, Vec2)| from.distance(*to) > ROUNDING;
    let warnings = chains.gaps.iter().filter(wide).map(|(from, to)| {
        let message = format!(
            "the outline has a gap of {:.4} mm at {}, which is closed",
            from.distance(*to),
            shown(*from)
        );
        Diagnostic::warning(Rule::OutlineGap, message).help("let the lines end in one point")
    });
    Ok((region, warnings.collect()))
}

/// The elements of a closed chain, with lines over its gaps.
fn joined(chain: &Chain, lines: &[(Element, u32)]) -> Vec<Element> {
    let mut elements: Vec<Element> = Vec::with_capacity(chain.pieces.len());
    for (piece, backwards) in &chain.pieces {
        let Some((element, _)) = lines.get(*piece) else { continue };
        let next = if *backwards { element.reversed() } else { *element };
        if let Some(last) = elements.last().filter(|last| last.end.distance(next.start) > SAME) {
            elements.push(Element::line(last.end, next.start));
        }
        elements.push(next);
    }
    if let (Some(first), Some(last)) = (elements.first(), elements.last())
        && last.end.distance(first.start) > SAME
    {
        elements.push(Element::line(last.end, first.start));
    }
    elements
}

/// What is wrong at the ends of open chains.
fn open_ends(open: &[&Chain], lines: &[(Element, u32)]) -> Vec<Diagnostic> {
    let mut ends: Vec<(Vec2, usize)> = Vec::new();
    for chain in open {
        let piece = |(piece, backwards): (usize, bool)| {
            lines.get(piece).map(|(element, _)| {
                let ends = [element.start, element.end];
                (piece, if backwards { [ends[1], ends[0]] } else { ends })
            })
        };
        let first = chain.pieces.first().copied().and_then(piece);
        let last = chain.pieces.last().copied().and_then(piece);
        if let (Some((first, [start, _])), Some((last, [_, end]))) = (first, last) {
            ends.push((start, first));
            ends.push((end, last));
        }
    }
    let mut found = Vec::new();
    for (i, (end, piece)) in ends.iter().enumerate().take(MOST_ENDS) {
        let line = lines.get(*piece).map_or(0, |(_, line)| *line);
        let others = || lines.iter().enumerate().filter(|(other, _)| other != piece);
        let on = others().find(|(_, (element, _))| element.nearest(*end).1 <= GAP);
        // An end on the middle of another line touches that line: it is a branch, not a gap.
        if let Some((_, (_, other))) = on {
            let message = format!(
                "a line of the outline ends on another one, of line {other}, at {}",
                shown(*end)
            );
            let help = "an outline has no branches: take out what is no edge";
            found.push(Diagnostic::error(Rule::OutlineBranch, message).help(help).line(line));
            continue;
        }
        let rest = ends.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, (other, _))| *other);
        let nearest = rest.min_by(|a, b| a.distance(*end).total_cmp(&b.distance(*end)));
        // Each gap is reported at its first end.
        let reported = |place: Vec2| ends.iter().take(i).any(|(earlier, _)| *earlier == place);
        if let Some(nearest) = nearest.filter(|nearest| !reported(*nearest)) {
            let message = format!(
                "the outline is not closed: from {} to the nearest end, {}, there is a gap of \
                 {:.4} mm",
                shown(*end),
                shown(nearest),
                end.distance(nearest)
            );
            let help = format!(
                "close it, or give --close-gaps; gaps of up to {GAP} mm are closed automatically"
            );
            found.push(Diagnostic::error(Rule::OutlineOpen, message).help(help).line(line));
        }
    }
    found
}

fn no_chain(error: ChainError, line: &dyn Fn(usize) -> u32) -> Diagnostic {
    match error {
        ChainError::Branch { place, pieces: [one, other] } => {
            let message = format!(
                "more than two ends of the outline meet at {}: lines {} and {} are two of them",
                shown(place),
                line(one),
                line(other)
            );
            let help = "an outline has no branches: take out what is no edge";
            Diagnostic::error(Rule::OutlineBranch, message).help(help).line(line(other))
        }
        ChainError::Tangled { place, piece } => {
            let message =
                format!("very many ends of the outline lie within {GAP} mm of {}", shown(place));
            let help = "take out what is no edge of the board";
            Diagnostic::error(Rule::OutlineTangled, message).help(help).line(line(piece))
        }
    }
}

#[cold]
fn mixed(object: &Object, what: &str) -> Diagnostic {
    let message = format!("on the layer of the outline {what}");
    Diagnostic::error(Rule::OutlineMixed, message)
        .help("draw the edge with lines alone, or fill the board and nothing else")
        .line(object.line)
}

#[cold]
fn refused(line: u32, error: &geom::region::RegionError) -> Diagnostic {
    let message = format!("the outline cannot be taken: {error}");
    Diagnostic::error(Rule::Outline, message).help("look at the unit and the arcs").line(line)
}

fn shown(place: Vec2) -> String {
    format!("X {:.4} Y {:.4}", place.x, place.y)
}
