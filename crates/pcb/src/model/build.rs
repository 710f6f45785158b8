//! A board from groups of elements.

use super::Findings;
use super::net::Nets;
use super::scope::{Scopes, no_angle};
use super::sheet::{Bore, Edge, Form, Group, Pad, Track};
use crate::board::{Artwork, Board, Face, Pattern, Shape};
use crate::{Contour, Hole, HoleShape, Piece, Transform};
use geom::{Element, Vec2};
use program::{Diagnostic, Rule};
use std::f64::consts::PI;
use toml::Spanned;

/// The narrowest and the widest track, pad and hole, mm. What is thinner than 1 µm vanishes.
const WIDTHS: std::ops::RangeInclusive<f64> = 0.01..=1e4;

/// Shapes of copper, each with its element.
type Shapes = Vec<(Shape, usize)>;

/// The board that `root`, of a file, describes; part of it where errors were reported.
pub(super) fn artwork(root: &Spanned<Group>, file_name: &str, findings: &mut Findings) -> Artwork {
    let mut maker = Maker {
        scopes: Scopes::of(root, findings),
        nets: Nets::default(),
        sides: Default::default(),
        holes: Vec::new(),
        edge: Vec::new(),
        findings,
    };
    for scope in 0..maker.scopes.all.len() {
        maker.group(scope);
    }
    maker.artwork(file_name)
}

/// A board at work.
struct Maker<'a, 'f, 't> {
    scopes: Scopes<'a>,
    nets: Nets<'a>,
    /// The copper of front and back.
    sides: [Shapes; 2],
    holes: Vec<Hole>,
    /// Lines of the outline, each with its line in the text.
    edge: Vec<(Element, u32)>,
    findings: &'f mut Findings<'t>,
}

impl<'a> Maker<'a, '_, '_> {
    fn group(&mut self, scope: usize) {
        let Some(group) = self.scopes.all.get(scope).map(|scope| scope.group) else { return };
        group.tracks.iter().for_each(|track| self.track(scope, track));
        group.pads.iter().for_each(|pad| self.pad(scope, pad));
        group.holes.iter().for_each(|hole| self.hole(scope, hole));
        group.edges.iter().for_each(|edge| self.edge(scope, edge));
    }

    /// How a group lies on the board.
    fn transform(&self, scope: usize) -> Transform {
        self.scopes.all.get(scope).map_or(Transform::NONE, |scope| scope.transform)
    }

    fn track(&mut self, scope: usize, track: &'a Spanned<Track>) {
        let Track { nodes, width, layer, net } = track.get_ref();
        let width = self.width("a track", width);
        let nodes: Option<Vec<usize>> =
            nodes.iter().map(|at| self.scopes.node(Some(scope), at, self.findings)).collect();
        let (Some(width), Some(nodes)) = (width, nodes) else { return };
        if nodes.len() < 2 {
            return self.refuse(track, "a track from no node to another", "give two nodes or more");
        }
        let faces = layer.faces(self.transform(scope).mirrors());
        let element = self.nets.add(&nodes, faces, net.as_ref());
        for (from, to) in nodes.iter().zip(nodes.iter().skip(1)) {
            let (from, to) = (self.scopes.position(*from), self.scopes.position(*to));
            if from == to {
                let what = format!("a track without length at X {} Y {}", from.x, from.y);
                return self.refuse(track, &what, "give two nodes at different places");
            }
            self.paint(faces, &Shape::Stroke(Element::line(from, to), width), element);
        }
    }

    fn pad(&mut self, scope: usize, pad: &'a Spanned<Pad>) {
        let Pad { node, shape, size, rotation, layer, net } = pad.get_ref();
        let size = self.width("a pad", size);
        let node = self.scopes.node(Some(scope), node, self.findings);
        let degrees = rotation.as_ref().map_or(0.0, |degrees| *degrees.get_ref());
        if let Some(rotation) = rotation.as_ref().filter(|_| !degrees.is_finite()) {
            return self.findings.error(rotation.span(), no_angle(degrees));
        }
        let (Some(size), Some(node)) = (size, node) else { return };
        let around = self.transform(scope);
        let faces = layer.faces(around.mirrors());
        let turned = around.after(&Transform::new(false, degrees, 1.0));
        let contour = shape.contour(size).placed(&turned, self.scopes.position(node));
        let element = self.nets.add(&[node], faces, net.as_ref());
        self.paint(faces, &Shape::Pieces(vec![Piece::new(true, contour)]), element);
    }

    fn hole(&mut self, scope: usize, hole: &'a Spanned<Bore>) {
        let Bore { node, diameter, plated } = hole.get_ref();
        let diameter = self.width("a hole", diameter);
        let node = self.scopes.node(Some(scope), node, self.findings);
        let (Some(diameter), Some(node)) = (diameter, node) else { return };
        let shape = HoleShape::Round(self.scopes.position(node));
        self.holes.push(Hole { shape, diameter, plated: *plated });
    }

    fn edge(&mut self, scope: usize, edge: &'a Spanned<Edge>) {
        let nodes = edge.get_ref().nodes.iter();
        let places: Option<Vec<Vec2>> = nodes
            .map(|at| {
                let node = self.scopes.node(Some(scope), at, self.findings)?;
                Some(self.scopes.position(node))
            })
            .collect();
        let Some(places) = places else { return };
        if places.len() < 3 {
            return self.refuse(edge, "an edge that encloses nothing", "give three nodes or more");
        }
        let line = self.findings.line(&edge.span());
        let ends = places.iter().cycle().skip(1);
        self.edge.extend(places.iter().zip(ends).map(|(a, b)| (Element::line(*a, *b), line)));
    }

    fn paint(&mut self, faces: &[Face], shape: &Shape, element: usize) {
        let [front, back] = &mut self.sides;
        for face in faces {
            let side = if *face == Face::Front { &mut *front } else { &mut *back };
            side.push((shape.clone(), element));
        }
    }

    /// The width of something.
    fn width(&mut self, of: &str, mm: &Spanned<f64>) -> Option<f64> {
        let value = *mm.get_ref();
        let good = WIDTHS.contains(&value);
        if !good {
            let message = format!("{of} of {value} mm");
            let help = format!("give {} to {} mm", WIDTHS.start(), WIDTHS.end());
            self.findings.error(mm.span(), Diagnostic::error(Rule::Width, message).help(help));
        }
        good.then_some(value)
    }

    #[cold]
    fn refuse<T>(&mut self, element: &Spanned<T>, what: &str, help: &str) {
        self.findings.error(element.span(), Diagnostic::error(Rule::Node, what).help(help));
    }

    fn artwork(self, file_name: &str) -> Artwork {
        let Maker { nets, sides, holes, edge, findings, .. } = self;
        let nothing = holes.is_empty() && edge.is_empty() && sides.iter().all(Vec::is_empty);
        if nothing && findings.report.errors.is_empty() {
            let help = "give tracks, pads, holes or edges: docs/sources/board.md shows how";
            let found =
                Diagnostic::error(Rule::NoBoard, "there is nothing on this board").help(help);
            findings.report.errors.push(found);
        }
        let nets = nets.named(findings);
        if !findings.report.errors.is_empty() {
            return Artwork::default();
        }
        let [front, back] = sides.map(|shapes| {
            let net = |element: usize| nets.get(element).cloned().flatten();
            let named = shapes.into_iter().map(|(shape, element)| (shape, net(element)));
            Pattern::of_shapes(file_name, named.collect())
        });
        let mut board = Board { holes, ..Board::default() };
        if !edge.is_empty() {
            findings.report.warnings.extend(board.take_edge(&edge));
            board.broken_edge = board.broken_edge.map(|edge| edge.file(file_name));
        }
        Artwork { board, front, back, ..Artwork::default() }
    }
}

impl Form {
    /// Its contour about the origin; squares and octagons stand on a side.
    fn contour(self, size: f64) -> Contour {
        let half = Vec2::splat(size / 2.0);
        match self {
            Form::Circle => Contour::circle(Vec2::ZERO, size / 2.0),
            Form::Square => Contour::rectangle(-half, half),
            Form::Octagon => {
                let eighth = PI / 8.0;
                Contour::regular(Vec2::ZERO, size / 2.0 / eighth.cos(), 8, eighth)
            }
        }
    }
}
