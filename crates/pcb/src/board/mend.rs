//! An outline from lines that do not meet: gaps are closed, doubled and overlapping lines and ends that stand out count once.
//!
//! Every line is drawn with a pen of [`GAP`]. What the ink encloses is a contour, the rim of the ink without half of the pen:
//! so lines on each other, and ends that stand out, are no edge. What is within an odd number of contours is board.

use super::copper::Shapes;
use super::outline::{GAP, Outlined};
use crate::SAME;
use geom::ending::go_on;
use geom::region::{Fill, Index, Island, Region, RegionError, Ring};
use geom::{Element, Vec2};
use program::{Diagnostic, Rule};

/// The most lines that are mended: each is compared with each other one.
const MOST_LINES: usize = 20_000;

/// A face between lines that is nowhere wider, mm, is one of lines that are drawn twice, not quite on each other.
const SLIM: f64 = 0.5;

/// What is next to the board is text where it is no longer than this part of the board, and encloses less than this part of
/// its area.
const TEXT: f64 = 0.2;
const TEXT_AREA: f64 = 0.01;

/// The outline that `lines` mean, each with its line in the file, when gaps of up to `close` mm are closed; `None` where
/// nobody can know: contours that are open elsewhere, or that lines divide.
pub(super) fn mended(lines: &[(Element, u32)], close: f64) -> Option<Outlined> {
    if lines.is_empty() || lines.len() > MOST_LINES {
        return None;
    }
    let elements: Vec<Element> = lines.iter().map(|(element, _)| *element).collect();
    let bridges = bridges(&elements, close);
    let all: Vec<Element> = elements.iter().chain(&bridges).copied().collect();
    let Enclosed { region, open, text } = enclosed(&all).ok()??;
    // In text no gap is closed that is worth a word.
    let index = Index::new(&region);
    let is_edge = |bridge: &&Element| index.nearest(bridge.at(0.5), close).is_some();
    let mut found: Vec<Diagnostic> = bridges.iter().filter(is_edge).map(closed).collect();
    let is_text = |element: &Element| {
        index.island_at(element.start).is_none() && index.nearest(element.at(0.5), SLIM).is_none()
    };
    let edge: Vec<Element> =
        elements.iter().filter(|line| text.is_empty() || !is_text(line)).copied().collect();
    found.extend(drawn_over(&edge, &index));
    found.extend(counted(
        &open,
        "what is within the outline encloses nothing",
        "close the contour where it is a cut-out, or give --close-gaps",
    ));
    found.extend(counted(
        &text,
        "what is next to the board is text",
        "leave them out of the layer of the outline",
    ));
    Some((region, found))
}

/// A warning about what is drawn in these places and is no edge.
fn counted(places: &[Vec2], what: &str, help: &str) -> Option<Diagnostic> {
    let first = places.first()?;
    let message = format!(
        "no edge, since {what}: {} drawing{} on the layer of the outline, the first near {}",
        places.len(),
        if places.len() == 1 { "" } else { "s" },
        shown(*first)
    );
    Some(Diagnostic::warning(Rule::OutlineOpen, message).help(help))
}

/// Lines over the gaps between ends that meet nothing, and from such ends to lines that they nearly reach.
fn bridges(elements: &[Element], close: f64) -> Vec<Element> {
    let boxes: Vec<(Vec2, Vec2)> = elements.iter().map(Element::extents).collect();
    let near = |i: usize, place: Vec2, reach: f64| {
        let (low, high) = boxes[i];
        let is_near = (low - reach).cmple(place).all() && (high + reach).cmpge(place).all();
        is_near && elements[i].nearest(place).1 <= reach
    };
    let mut loose: Vec<(usize, Vec2)> = Vec::new();
    for (i, element) in elements.iter().enumerate() {
        go_on();
        if element.start.distance(element.end) <= SAME {
            continue;
        }
        for end in [element.start, element.end] {
            if !(0..elements.len()).any(|j| j != i && near(j, end, GAP)) {
                loose.push((i, end));
            }
        }
    }
    let mut pairs = Vec::new();
    for (a, (i, from)) in loose.iter().enumerate() {
        for (b, (j, to)) in loose.iter().enumerate().skip(a + 1) {
            // The two ends of an arc are joined where it nearly closes, not those of a short line.
            let is_other = i != j || elements[*i].length() > 4.0 * close;
            if is_other && from.distance(*to) <= close {
                pairs.push((from.distance(*to), a, b));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut is_joined = vec![false; loose.len()];
    let mut bridges = Vec::new();
    for (_, a, b) in pairs {
        if !is_joined[a] && !is_joined[b] {
            (is_joined[a], is_joined[b]) = (true, true);
            bridges.push(Element::line(loose[a].1, loose[b].1));
        }
    }
    for ((i, end), _) in loose.iter().zip(&is_joined).filter(|(_, joined)| !**joined) {
        // Lines that this one touches already are not what it should reach.
        let touches = |j: usize| {
            let ends = [elements[j].start, elements[j].end, elements[*i].start, elements[*i].end];
            ends[..2].iter().any(|end| near(*i, *end, GAP))
                || ends[2..].iter().any(|end| near(j, *end, GAP))
        };
        let others =
            (0..elements.len()).filter(|j| j != i && near(*j, *end, close) && !touches(*j));
        let nearest = others.map(|j| {
            let (t, away) = elements[j].nearest(*end);
            (away, elements[j].at(t))
        });
        if let Some((_, to)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)) {
            bridges.push(Element::line(*end, to));
        }
    }
    bridges
}

/// What is drawn in one piece.
struct Drawing {
    /// The corners of its box, mm.
    low: Vec2,
    high: Vec2,
    /// How many faces it encloses, without slim ones.
    faces: usize,
    /// What it encloses.
    contour: Region,
}

impl Drawing {
    fn of(island: &Island) -> Result<Drawing, RegionError> {
        let (low, high) = island.outer().extents();
        let mut faces = 0;
        for face in island.holes() {
            faces += usize::from(!is_slim(face)?);
        }
        let contour = if faces > 0 { contour(island)? } else { Region::default() };
        Ok(Drawing { low, high, faces, contour })
    }

    fn size(&self) -> f64 {
        (self.high - self.low).max_element()
    }

    fn middle(&self) -> Vec2 {
        self.low.midpoint(self.high)
    }
}

/// What lines enclose.
struct Enclosed {
    region: Region,
    /// Where lines within it enclose nothing.
    open: Vec<Vec2>,
    /// Where something small is drawn next to it: text, a dimension.
    text: Vec<Vec2>,
}

/// What `lines` enclose; `None` where what is open or divided by lines may be an edge.
fn enclosed(lines: &[Element]) -> Result<Option<Enclosed>, RegionError> {
    let mut ink = Shapes::default();
    ink.strokes.extend(lines.iter().map(|line| (*line, GAP)));
    let drawings: Vec<Drawing> =
        ink.united()?.islands().iter().map(Drawing::of).collect::<Result<_, _>>()?;
    let area = |drawing: &Drawing| drawing.contour.area();
    let largest = drawings.iter().max_by(|a, b| area(a).total_cmp(&area(b)));
    let Some(board) = largest.filter(|board| board.faces == 1) else { return Ok(None) };
    let index = Index::new(&board.contour);
    let (mut rings, mut open, mut text) = (Vec::<&Ring>::new(), Vec::new(), Vec::new());
    for drawing in &drawings {
        let is_within = index.island_at(drawing.middle()).is_some();
        let is_small = drawing.size() <= TEXT * board.size();
        match drawing.faces {
            _ if !is_within && is_small && area(drawing) < TEXT_AREA * area(board) => {
                text.push(drawing.middle());
            }
            0 if is_within && drawing.size() < board.size() => open.push(drawing.middle()),
            1 => rings.extend(drawing.contour.islands().iter().map(Island::outer)),
            _ => return Ok(None),
        }
    }
    Ok(Some(Enclosed { region: Region::inside(rings, Fill::EvenOdd)?, open, text }))
}

/// What the ink around a contour encloses with its middle.
fn contour(island: &Island) -> Result<Region, RegionError> {
    Region::inside([island.outer()], Fill::NonZero)?.offset(-GAP / 2.0)
}

fn is_slim(face: &Ring) -> Result<bool, RegionError> {
    Ok(Region::inside([face], Fill::NonZero)?.offset(-SLIM / 2.0)?.is_empty())
}

/// A warning about lines that are no part of the edge, to 1 µm: doubled ones next to it, and ends that stand out.
fn drawn_over(elements: &[Element], index: &Index) -> Option<Diagnostic> {
    let off = |element: &&Element| {
        [0.0, 0.25, 0.5, 0.75, 1.0]
            .iter()
            .any(|t| index.nearest(element.at(*t), GAP / 2.0).is_none())
    };
    let others: Vec<&Element> = elements.iter().filter(off).collect();
    others.first().map(|first| {
        let message = format!(
            "{} of {} lines of the outline stand out of the edge, run next to it, or lie within it, the first from {} to {}",
            others.len(),
            elements.len(),
            shown(first.start),
            shown(first.end)
        );
        let help = "the edge is the outermost of what the lines enclose: look at it in the picture of outline.nc";
        Diagnostic::warning(Rule::OutlineBranch, message).help(help)
    })
}

fn closed(bridge: &Element) -> Diagnostic {
    let message = format!(
        "the outline has a gap of {:.4} mm at {}, which is closed",
        bridge.length(),
        shown(bridge.start)
    );
    Diagnostic::warning(Rule::OutlineGap, message)
        .help("let the lines end in one point; --close-gaps says how wide a gap may be")
}

fn shown(place: Vec2) -> String {
    format!("X {:.4} Y {:.4}", place.x, place.y)
}
