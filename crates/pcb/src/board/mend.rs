//! An outline from lines that do not meet: gaps are closed, doubled and overlapping lines and ends that stand out count once.
//!
//! Every line is drawn with a pen of [`GAP`]. What the ink encloses is a contour, the rim of the ink without half of the pen:
//! so lines on each other, and ends that stand out, are no edge. What is within an odd number of contours is board.

use super::copper::Shapes;
use super::outline::{GAP, Outlined};
use crate::SAME;
use geom::region::{Fill, Index, Island, Region, RegionError, Ring};
use geom::{Element, Vec2};
use program::{Diagnostic, Rule};

/// The most lines that are mended: each is compared with each other one.
const MOST_LINES: usize = 20_000;

/// A face between lines that is nowhere wider, mm, is one of lines that are drawn twice, not quite on each other.
const SLIM: f64 = 0.5;

/// The outline that `lines` mean, each with its line in the file, when gaps of up to `close` mm are closed; `None` where
/// nobody can know: contours that are open elsewhere, or that lines divide.
pub(super) fn mended(lines: &[(Element, u32)], close: f64) -> Option<Outlined> {
    if lines.is_empty() || lines.len() > MOST_LINES {
        return None;
    }
    let elements: Vec<Element> = lines.iter().map(|(element, _)| *element).collect();
    let bridges = bridges(&elements, close);
    let all: Vec<Element> = elements.iter().chain(&bridges).copied().collect();
    let (region, stray) = enclosed(&all).ok()??;
    let mut found: Vec<Diagnostic> = bridges.iter().map(closed).collect();
    found.extend(drawn_over(&elements, &region).ok()?);
    if let Some(at) = stray.first() {
        let message = format!(
            "{} line{} within the outline enclose nothing, the first near {}: no edge",
            stray.len(),
            if stray.len() == 1 { "" } else { "s" },
            shown(*at)
        );
        let help = "close the contour where it is a cut-out, or give --close-gaps";
        found.push(Diagnostic::warning(Rule::OutlineOpen, message).help(help));
    }
    Some((region, found))
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

/// What `lines` enclose, and a place of each group of lines within it that encloses nothing; `None` where such a group is
/// outside, or where lines divide what a contour encloses.
fn enclosed(lines: &[Element]) -> Result<Option<(Region, Vec<Vec2>)>, RegionError> {
    let mut ink = Shapes::default();
    ink.strokes.extend(lines.iter().map(|line| (*line, GAP)));
    let ink = ink.united()?;
    let (mut contours, mut open) = (Vec::<Ring>::new(), Vec::new());
    for island in ink.islands() {
        let (low, high) = island.outer().extents();
        let mut faces = 0;
        for face in island.holes() {
            faces += usize::from(!is_slim(face)?);
        }
        match faces {
            0 => open.push(low.midpoint(high)),
            1 => contours.extend(contour(island)?),
            _ => return Ok(None),
        }
    }
    let region = Region::inside(&contours, Fill::EvenOdd)?;
    if region.is_empty() {
        return Ok(None);
    }
    let index = Index::new(&region);
    match open.iter().all(|place| index.island_at(*place).is_some()) {
        true => Ok(Some((region, open))),
        false => Ok(None),
    }
}

/// What the ink around a contour encloses with its middle.
fn contour(island: &Island) -> Result<Vec<Ring>, RegionError> {
    let filled = Region::inside([island.outer()], Fill::NonZero)?.offset(-GAP / 2.0)?;
    Ok(filled.islands().iter().map(|island| island.outer().clone()).collect())
}

fn is_slim(face: &Ring) -> Result<bool, RegionError> {
    Ok(Region::inside([face], Fill::NonZero)?.offset(-SLIM / 2.0)?.is_empty())
}

/// A warning about lines that are no part of the edge, to 1 µm: doubled ones beside it, and ends that stand out.
fn drawn_over(elements: &[Element], region: &Region) -> Result<Option<Diagnostic>, RegionError> {
    let index = Index::new(region);
    let off = |element: &&Element| {
        [0.0, 0.25, 0.5, 0.75, 1.0]
            .iter()
            .any(|t| index.nearest(element.at(*t), GAP / 2.0).is_none())
    };
    let others: Vec<&Element> = elements.iter().filter(off).collect();
    Ok(others.first().map(|first| {
        let message = format!(
            "{} of {} lines of the outline stand out of the edge, run next to it, or lie within it, the first from {} to {}",
            others.len(),
            elements.len(),
            shown(first.start),
            shown(first.end)
        );
        let help = "the edge is the outermost of what the lines enclose: look at it in the picture of outline.nc";
        Diagnostic::warning(Rule::OutlineBranch, message).help(help)
    }))
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
