//! Which line of which file the moves of a board's programs come from.
//!
//! Nothing of this is carried along while a board is made. What the files draw is read once more, each element with its line, and what
//! runs along a place of the finished board is looked up in it:
//!
//! ```text
//!   a move ──nearest edge of the region that it is cut around──▶ a place of the board ──undo Setup──▶ a place of the files ──▶ a line
//! ```
//!
//! So boolean, offset, merging and the order of the cuts, which all make other elements of these, need not know of it, and who wants
//! no lines pays nothing. A move whose place is of no line, or of two, has none: a rapid, a link from one contour to another, a cut down
//! the middle of a gap, an edge that is drawn in no file.

use crate::board::{Face, Format, Layer, Shape, holes};
use crate::gerber::Object;
use crate::plan::{Isolate, Part, Settings, Setup};
use crate::{Hole, HoleShape, Piece, arc, excellon, gerber, kicad};
use geom::ending::go_on;
use geom::region::Index;
use geom::{Element, Vec2};
use program::{Diagnostic, Op, Program, Record};
use static_aabb2d_index::{StaticAABB2DIndex, StaticAABB2DIndexBuilder};

/// The most elements of all layers that are kept, which take some 150 bytes each: of a board that draws more, no line is known.
const MOST: usize = 4_000_000;

/// How far a place of the finished board may be from what a file draws there, mm: each boolean adds less than 1 µm.
const NEAR: f64 = 0.005;

/// Edges whose distances from a cut differ by no more are equally far from it, mm.
const ALIKE: f64 = 0.003;

/// The sine of the angle up to which a cut runs along an edge.
const ALONG: f64 = 0.05;

/// The same of an arc: where an area is drawn round by chords, as KiCad does with 0.005 mm off the arc at the most, a cut that is one arc runs
/// along them at up to half the angle between two of them.
const ALONG_CHORDS: f64 = 0.26;

/// A line of one of the files of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// The file, in the order in which they are given.
    pub file: u32,
    /// Its line, from 1.
    pub line: u32,
}

/// What the files of a board draw, each element with its line.
#[derive(Default)]
pub struct Drawn {
    layers: Vec<(Part, Elements)>,
}

/// What is drawn on one layer, in the order of its files.
#[derive(Default)]
struct Elements {
    all: Vec<Stroke>,
    /// `None` where there is nothing.
    tree: Option<StaticAABB2DIndex<f64>>,
}

/// What a round pen draws along an element, or the edge of an area: there the pen has no width.
struct Stroke {
    path: Element,
    /// Half the width of the pen, mm.
    radius: f64,
    line: Line,
}

/// A layer of a file of a board.
#[derive(Clone, Copy, Debug)]
pub struct LayerFile<'a> {
    /// Its name, for drill files: it says of some what they hold.
    pub name: &'a str,
    /// What it holds.
    pub layer: Layer,
    /// The unit of a drill file that does not say it.
    pub unit: Option<excellon::Unit>,
    /// Its bytes.
    pub text: &'a [u8],
}

impl Drawn {
    /// What Gerber and Excellon files draw; `None` stands for a file that is not part of the board.
    ///
    /// # Errors
    /// What the readers refuse.
    pub fn of_layers(files: &[Option<LayerFile>]) -> Result<Drawn, Vec<Diagnostic>> {
        let mut drawn = Drawn::default();
        for (file, layer) in (0..).zip(files) {
            let Some(LayerFile { name, layer, unit, text }) = *layer else { continue };
            let Some(part) = part(layer) else { continue };
            let elements = drawn.layer(part);
            if part == Part::Drill && Format::of(text) != Some(Format::Gerber) {
                let reading = excellon::read_in(name, text, unit)?;
                for cut in &reading.drill.cuts {
                    let tool = reading.drill.tools.get(cut.tool as usize);
                    let radius = tool.map_or(0.0, |tool| tool.diameter / 2.0);
                    elements.hole(&cut.path, radius, Line { file, line: cut.line });
                }
                continue;
            }
            let image = gerber::read(name, text)?.image;
            let line = |object: &Object| Line { file, line: object.line };
            if part == Part::Drill {
                let holes = holes::of_image(&image, None).map_err(|found| vec![*found])?;
                for (hole, object) in holes.iter().zip(&image.objects) {
                    elements.hole(&hole.shape, hole.diameter / 2.0, line(object));
                }
                continue;
            }
            for object in &image.objects {
                go_on();
                match image.stroke(object) {
                    // The edge of a board is the middle of what is drawn.
                    Some((path, _)) if part == Part::Outline => {
                        elements.push(path, 0.0, line(object));
                    }
                    Some((path, width)) => elements.push(path, width / 2.0, line(object)),
                    None => elements.pieces(&image.pieces(object), line(object)),
                }
            }
        }
        Ok(drawn.indexed())
    }

    /// What a board of KiCad draws.
    ///
    /// # Errors
    /// As of [`kicad::read`].
    pub fn of_kicad(file_name: &str, text: &[u8]) -> Result<Drawn, Vec<Diagnostic>> {
        let items = kicad::items(file_name, text)?;
        let mut drawn = Drawn::default();
        let at = |line: u32| Line { file: 0, line };
        for (part, shapes) in [(Part::Front, &items.front), (Part::Back, &items.back)] {
            let elements = drawn.layer(part);
            for (shape, line) in shapes {
                match shape {
                    Shape::Stroke(path, width) => elements.push(*path, width / 2.0, at(*line)),
                    Shape::Pieces(pieces) => elements.pieces(pieces, at(*line)),
                }
            }
        }
        for (Hole { shape, diameter, .. }, line) in &items.holes {
            drawn.layer(Part::Drill).hole(shape, diameter / 2.0, at(*line));
        }
        for (element, line) in &items.edges {
            drawn.layer(Part::Outline).push(*element, 0.0, at(*line));
        }
        Ok(drawn.indexed())
    }

    fn layer(&mut self, part: Part) -> &mut Elements {
        let place = self.layers.iter().position(|(of, _)| *of == part).unwrap_or_else(|| {
            self.layers.push((part, Elements::default()));
            self.layers.len() - 1
        });
        &mut self.layers[place].1
    }

    fn indexed(mut self) -> Drawn {
        if self.layers.iter().map(|(_, elements)| elements.all.len()).sum::<usize>() > MOST {
            return Drawn::default();
        }
        for (_, elements) in &mut self.layers {
            elements.index();
        }
        self
    }

    /// Of each record of `program`, which cuts `part` of a board that lies as `setup` says, the line that it comes from.
    pub fn lines(
        &self,
        part: Part,
        setup: &Setup,
        settings: &Settings,
        program: &Program,
    ) -> Vec<Option<Line>> {
        let none = || vec![None; program.records.len()];
        let Some((_, elements)) = self.layers.iter().find(|(of, _)| *of == part) else {
            return none();
        };
        let side = &setup.board.front;
        let region = match part {
            // Along the middle of what is drawn, and not around it.
            Part::Front | Part::Back if settings.isolation.isolate == Isolate::Lines => None,
            Part::Front | Part::Back => side.copper.as_ref().map(|copper| &copper.region),
            Part::Outline => setup.board.outline.as_ref(),
            Part::FrontMask | Part::BackMask => side.mask.as_ref(),
            Part::Drill | Part::FrontLegend | Part::BackLegend => None,
        };
        let edges = region.map(Index::new);
        let (mut at, mut ways) = (None, Vec::with_capacity(program.records.len()));
        let line = |record: &Record| {
            go_on();
            let cut = moved(&record.op, &mut at);
            ways.push(match (&record.op, &cut) {
                (_, None) => Way::None,
                (Op::Line(_), Some(cut)) if cut.start == cut.end => Way::Down,
                (_, Some(_)) => Way::Along,
            });
            let cut = cut?;
            match &edges {
                Some(edges) => elements.edge_at(setup.drawn_at(edge_along(edges, &cut)?)),
                None => elements.covering(setup.drawn_at(cut.at(0.5))),
            }
        };
        let mut lines: Vec<_> = program.records.iter().map(line).collect();
        // The way down to a cut is of the line of that, whatever else is near its start.
        let mut behind = None;
        for (line, at) in lines.iter_mut().zip(&ways).rev() {
            match at {
                Way::None => {}
                Way::Down => *line = behind,
                Way::Along => behind = *line,
            }
        }
        lines
    }
}

/// The program that cuts a layer.
fn part(layer: Layer) -> Option<Part> {
    Some(match layer {
        Layer::Copper(Face::Front) => Part::Front,
        Layer::Copper(Face::Back) => Part::Back,
        Layer::Mask(Face::Front) => Part::FrontMask,
        Layer::Mask(Face::Back) => Part::BackMask,
        Layer::Legend(Face::Front) => Part::FrontLegend,
        Layer::Legend(Face::Back) => Part::BackLegend,
        Layer::Outline => Part::Outline,
        Layer::Holes(_) => Part::Drill,
        Layer::Other => return None,
    })
}

/// How a record goes.
enum Way {
    /// It cuts nothing.
    None,
    /// Straight down, or up.
    Down,
    /// Along the board, or into it by a cycle.
    Along,
}

/// What a record cuts, as the way of the tool over the board; `at` is where the tool is before it, and then behind it.
fn moved(op: &Op, at: &mut Option<Vec2>) -> Option<Element> {
    let (from, end) = (*at, op.pose()?.point().truncate());
    *at = Some(end);
    match op {
        Op::Hole(_) => Some(Element::line(end, end)),
        Op::Line(_) => Some(Element::line(from?, end)),
        Op::Arc(arc) => {
            let (center, is_clockwise) = (arc.circle.center(), arc.circle.normal().z < 0.0);
            Some(arc::about(from?, end, center.truncate(), is_clockwise))
        }
        _ => None,
    }
}

/// The place of an edge that a cut runs along, in its middle; `None` where it runs along none, or between two.
fn edge_along(edges: &Index, cut: &Element) -> Option<Vec2> {
    let (at, along) = (cut.at(0.5), cut.tangent(0.5).normalize_or_zero());
    let nearest = edges.nearest(at, f64::INFINITY)?;
    let edge = nearest.piece.element.at(nearest.t);
    let away = edge - at;
    let most = if cut.turn.is_some() { ALONG_CHORDS } else { ALONG };
    if away.dot(along).abs() > most * away.length() + ALIKE {
        return None;
    }
    let reach = nearest.distance + ALIKE;
    let is_opposite = |element: &Element| {
        let (t, distance) = element.nearest(at);
        distance <= reach && (element.at(t) - at).dot(away) < 0.0
    };
    let mut around = edges.within(at - reach, at + reach);
    let is_between = nearest.distance > ALIKE && around.any(|piece| is_opposite(piece.element));
    (!is_between).then_some(edge)
}

impl Elements {
    /// What a pen of this radius, mm, draws.
    fn push(&mut self, path: Element, radius: f64, line: Line) {
        // More than are kept need not be drawn.
        if self.all.len() <= MOST {
            self.all.push(Stroke { path, radius, line });
        }
    }

    /// An area by its edges.
    fn pieces(&mut self, pieces: &[Piece], line: Line) {
        let contours = pieces.iter().flat_map(|piece| &piece.contours);
        for element in contours.flat_map(|contour| contour.elements()) {
            self.push(*element, 0.0, line);
        }
    }

    fn hole(&mut self, shape: &HoleShape, radius: f64, line: Line) {
        match shape {
            HoleShape::Round(at) => self.push(Element::line(*at, *at), radius, line),
            HoleShape::Slot(from, to) => self.push(Element::line(*from, *to), radius, line),
            HoleShape::Route(elements) => {
                for element in elements {
                    self.push(*element, radius, line);
                }
            }
        }
    }

    fn index(&mut self) {
        let mut tree = StaticAABB2DIndexBuilder::new(self.all.len());
        for Stroke { path, radius, .. } in &self.all {
            let (low, high) = path.extents();
            tree.add(low.x - radius, low.y - radius, high.x + radius, high.y + radius);
        }
        self.tree = tree.build().ok();
    }

    /// What may be at a place, in the order in which it is drawn.
    fn at(&self, place: Vec2) -> Vec<&Stroke> {
        let Some(tree) = &self.tree else { return Vec::new() };
        let (low, high) = (place - NEAR, place + NEAR);
        let mut found = tree.query(low.x, low.y, high.x, high.y);
        found.sort_unstable();
        found.into_iter().filter_map(|place| self.all.get(place)).collect()
    }

    /// The line of what has its edge at a place; of several the first.
    fn edge_at(&self, place: Vec2) -> Option<Line> {
        let off = |stroke: &&Stroke| (stroke.path.away(place) - stroke.radius).abs();
        let found = self.at(place).into_iter().find(|stroke| off(stroke) <= NEAR);
        found.map(|stroke| stroke.line)
    }

    /// The line of what covers a place, and has its middle the nearest to it; of several the first.
    fn covering(&self, place: Vec2) -> Option<Line> {
        let away = |stroke: &Stroke| stroke.path.away(place);
        let near = self.at(place).into_iter().map(|stroke| (away(stroke), stroke));
        let over = near.filter(|(away, stroke)| *away <= stroke.radius + NEAR);
        let found = over.min_by(|a, b| a.0.total_cmp(&b.0));
        found.map(|(_, stroke)| stroke.line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::region::{Fill, Region, Ring};
    use std::f64::consts::TAU;

    /// A pad of radius 0.3 mm by 16 chords, each 0.0058 mm off the arc: cuts of 22.5° about it at 0.1 mm from its corners, wherever they begin.
    #[test]
    fn an_arc_runs_along_the_chords_of_a_round_edge_and_a_line_across_them_does_not() {
        let corner = |k: i32| 0.3 * Vec2::from_angle(TAU * f64::from(k) / 16.0);
        let corners: Vec<Vec2> = (0..16).map(corner).collect();
        let region = Region::inside([&Ring::polygon(&corners).unwrap()], Fill::NonZero).unwrap();
        let edges = Index::new(&region);
        for k in 0..64 {
            let start = 0.4 * Vec2::from_angle(TAU * f64::from(k) / 64.0);
            let end = Vec2::from_angle(TAU / 16.0).rotate(start);
            let cut = Element::arc(start, end, Vec2::ZERO, TAU / 16.0);
            let edge = edge_along(&edges, &cut).unwrap_or_else(|| panic!("{k}"));
            assert!(edge.distance(cut.at(0.5)) < 0.11, "{k}");
            // A line at 30 degrees to it.
            let aslant = Vec2::from_angle(0.5).rotate(end - start);
            let middle = cut.at(0.5);
            let cut = Element::line(middle - aslant / 2.0, middle + aslant / 2.0);
            assert_eq!(edge_along(&edges, &cut), None, "{k}");
        }
    }
}
