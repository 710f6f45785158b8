//! Bodies as triangles: their readers, and what is wrong with them.

mod obj;
mod paint;
mod ply;
mod properties;
mod shell;
mod stl;
mod threemf;

pub use paint::Paint;
pub use ply::write as ply;
pub use shell::Depth;

use crate::curve::Curves;
use crate::list::{self, Columns};
use crate::picture::Picture;
use geom::ending::go_on;
use glam::DVec3;
use paint::WHITE;
use program::{Diagnostic, Rule, encoding};
use serde::Serialize;
use std::collections::HashMap;

/// Triangles in space, mm.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The corners.
    pub vertices: Vec<DVec3>,
    /// Three numbers of corners each, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// What each triangle is painted with; where there is none, all are white.
    pub paint: Vec<Paint>,
    /// The textures of its paint.
    pub textures: Vec<Picture>,
}

/// Reads a file that another one names, such as a library of materials or a texture; says why it cannot.
pub type Beside<'b> = &'b mut dyn FnMut(&str) -> Result<Vec<u8>, String>;

/// What a file holds.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A body.
    Mesh(Mesh),
    /// Points without faces, mm.
    Points(Vec<DVec3>),
    /// A picture, on a sheet or as a relief.
    Picture(Picture),
    /// Curves, mm.
    Curves(Curves),
}

/// The form of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// STL, either kind.
    Stl,
    /// Wavefront OBJ.
    Obj,
    /// PLY, ASCII or binary.
    Ply,
    /// 3MF.
    ThreeMf,
    /// Points, one a line, with X, Y and Z in these columns.
    List(Columns),
}

/// What is unusual about a body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Health {
    /// Triangles without area.
    pub flat: u64,
    /// Edges that only one triangle has: the body is open there.
    pub open: u64,
    /// Edges that more than two triangles have.
    pub crowded: u64,
    /// Edges whose two triangles face opposite sides: one of them is inside out.
    pub turned: u64,
    /// The middle of the first open edge, mm.
    pub first_open: Option<[f64; 3]>,
    /// The volume, mm³: less than 0 where the body is inside out.
    pub volume: f64,
}

/// The most vertices that a body may have.
const MOST: usize = u32::MAX as usize / 4;

/// The largest coordinate of a body, mm: what is larger is not engraved but a mistake, and exact sums need room.
pub(crate) const LARGEST: f64 = 1e6;

/// Reads the bytes of the file `file` as `form`.
///
/// # Errors
/// What is wrong with it, with the line where there are lines.
pub fn read(bytes: &[u8], form: Form, file: &str) -> Result<Shape, Box<Diagnostic>> {
    read_painted(bytes, form, file, None)
}

/// As [`read`]; with `beside`, colours and textures of OBJ, PLY and 3MF are read too.
///
/// # Errors
/// As [`read`]; or where a file that this one names cannot be read.
pub fn read_painted(
    bytes: &[u8],
    form: Form,
    file: &str,
    beside: Option<Beside>,
) -> Result<Shape, Box<Diagnostic>> {
    // An archive is no text, nor is the title of a binary file.
    let bytes = if form == Form::ThreeMf || (form == Form::Stl && stl::is_binary(bytes)) {
        bytes
    } else if encoding::is_utf_16(bytes) {
        return Err(encoding::utf_16().file(file).into());
    } else {
        encoding::without_mark(bytes)
    };
    let painted = beside.is_some();
    let read = match form {
        Form::Stl => stl::read(bytes).map(Shape::Mesh),
        Form::Obj => obj::read(bytes, beside).map(Shape::Mesh),
        Form::Ply => ply::read(bytes, painted),
        Form::ThreeMf => threemf::read(bytes, painted).map(Shape::Mesh),
        Form::List(columns) => list::read(bytes, columns).map(Shape::Points),
    };
    let shape = read.map_err(|fault| fault.diagnostic(file))?;
    let (places, empty) = match &shape {
        Shape::Mesh(mesh) => (&mesh.vertices, mesh.triangles.is_empty()),
        Shape::Points(points) => (points, points.is_empty()),
        // No form of this reader is one of these.
        Shape::Picture(_) | Shape::Curves(_) => return Ok(shape),
    };
    if empty {
        return Err(Fault::new(Rule::Empty, "has no triangle and no point").diagnostic(file));
    }
    if let Some(at) =
        places.iter().position(|place| !place.is_finite() || place.abs().max_element() > LARGEST)
    {
        let message = format!("point {} is {}: not a number, or beyond 1 km", at + 1, places[at]);
        return Err(Fault::new(Rule::Coordinate, message).diagnostic(file));
    }
    Ok(shape)
}

/// What is wrong with a file.
#[derive(Debug)]
pub(crate) struct Fault {
    rule: Rule,
    message: String,
    line: u32,
}

impl Fault {
    pub(crate) fn new(rule: Rule, message: impl Into<String>) -> Fault {
        Fault { rule, message: message.into(), line: 0 }
    }

    /// On this line, from 1.
    pub(crate) fn line(self, line: usize) -> Fault {
        Fault { line: u32::try_from(line).unwrap_or(u32::MAX), ..self }
    }

    pub(crate) fn diagnostic(self, file: &str) -> Box<Diagnostic> {
        let found = Diagnostic::error(self.rule, self.message).file(file).line(self.line);
        found.help("export the body again; docs/sources/glass.md says what is read").into()
    }
}

/// The triangles of a flat face, all from its first corner.
///
/// # Errors
/// Where one of them turns against the face: it would lie outside of a face that is not convex. Corners that no vertex has are
/// left to the check of their numbers.
fn fan(corners: &[u32], vertices: &[DVec3]) -> Result<Vec<[u32; 3]>, Fault> {
    let triangles: Vec<[u32; 3]> = (1..corners.len().saturating_sub(1))
        .map(|i| [corners[0], corners[i], corners[i + 1]])
        .collect();
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| vertices.get(corner as usize).copied());
        let (Some(a), Some(b), Some(c)) = (a, b, c) else { return DVec3::ZERO };
        (b - a).cross(c - a)
    };
    let face: DVec3 = triangles.iter().map(area).sum();
    // What rounding leaves of a flat triangle turns neither way.
    let least = -1e-9 * face.length_squared();
    if triangles.iter().any(|triangle| area(triangle).dot(face) < least) {
        let message = format!(
            "a face of {} corners is not convex: let the program that made the body write triangles",
            corners.len()
        );
        return Err(Fault::new(Rule::Face, message));
    }
    Ok(triangles)
}

/// The number that a word is.
pub(crate) fn number(word: Option<&str>, line: usize) -> Result<f64, Fault> {
    let word = word.unwrap_or("");
    let value = word.parse::<f64>().ok().filter(|value| value.is_finite());
    value.ok_or_else(|| {
        Fault::new(Rule::Number, format!("a number is needed, not `{word}`")).line(line)
    })
}

/// The text of a file, line by line with their numbers from 1. Bytes that are not UTF-8 are replaced: they are in no number.
pub(crate) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, std::borrow::Cow<'_, str>)> {
    let lines = bytes.split(|byte| *byte == b'\n' || *byte == b'\r');
    // Of CR LF the LF ends an empty line: numbers count LF, or CR where there is no LF.
    let feeds = bytes.contains(&b'\n');
    let mut number = 1;
    let mut at = 0;
    lines.map(move |line| {
        go_on();
        let here = number;
        at += line.len() + 1;
        if bytes.get(at - 1).is_some_and(|end| (*end == b'\n') == feeds) {
            number += 1;
        }
        (here, String::from_utf8_lossy(line))
    })
}

impl Mesh {
    /// The corners of the triangle of this number.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|corner| self.vertices[corner as usize])
    }

    /// The smallest box around all corners; `None` where there are none.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        bounds(&self.vertices)
    }

    /// Its surface, mm².
    pub fn area(&self) -> f64 {
        let area = |triangle| {
            let [a, b, c] = self.corners(triangle);
            0.5 * (b - a).cross(c - a).length()
        };
        (0..self.triangles.len() as u32).map(area).sum()
    }

    /// Takes another body in.
    pub fn join(&mut self, other: Mesh) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(other.vertices);
        if !(self.paint.is_empty() && other.paint.is_empty()) {
            let textures = self.textures.len() as u32;
            self.paint.resize(self.triangles.len(), WHITE);
            self.paint.extend(other.paint.into_iter().map(|paint| match paint {
                Paint::Corners(_) => paint,
                Paint::Texture(number, places) => Paint::Texture(number + textures, places),
            }));
            self.paint.resize(self.triangles.len() + other.triangles.len(), WHITE);
            self.textures.extend(other.textures);
        }
        self.triangles
            .extend(other.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
    }

    /// Of each corner the first one at the same place.
    pub fn same_places(&self) -> Vec<u32> {
        let mut places: HashMap<[u64; 3], u32> = HashMap::with_capacity(self.vertices.len());
        let first = |(i, place): (usize, &DVec3)| {
            go_on();
            // + 0 makes one of both zeros.
            let bits = (*place + DVec3::ZERO).to_array().map(f64::to_bits);
            *places.entry(bits).or_insert(i as u32)
        };
        self.vertices.iter().enumerate().map(first).collect()
    }

    /// What is unusual about it. Corners at the same place are one corner.
    pub fn health(&self) -> Health {
        let same = self.same_places();
        // Of each edge how many triangles have it, and how many more of them go along it upwards than downwards.
        let mut edges: HashMap<(u32, u32), (u32, i32)> = HashMap::new();
        let (mut flat, mut volume) = (0, 0.0);
        for triangle in 0..self.triangles.len() as u32 {
            go_on();
            let [a, b, c] = self.corners(triangle);
            let corners = self.triangles[triangle as usize].map(|corner| same[corner as usize]);
            volume += a.dot(b.cross(c)) / 6.0;
            if (b - a).cross(c - a) == DVec3::ZERO {
                flat += 1;
                continue;
            }
            for i in 0..3 {
                let (from, to) = (corners[i], corners[(i + 1) % 3]);
                let (count, along) = edges.entry((from.min(to), from.max(to))).or_default();
                *count += 1;
                *along += if from < to { 1 } else { -1 };
            }
        }
        let open = edges.iter().filter(|(_, (count, _))| *count == 1).map(|(edge, _)| *edge);
        let first = open.clone().min();
        let middle =
            |(a, b): (u32, u32)| 0.5 * (self.vertices[a as usize] + self.vertices[b as usize]);
        Health {
            flat,
            open: open.count() as u64,
            crowded: edges.values().filter(|(count, _)| *count > 2).count() as u64,
            turned: edges.values().filter(|edge| [(2, 2), (2, -2)].contains(*edge)).count() as u64,
            first_open: first.map(|edge| middle(edge).to_array()),
            volume,
        }
    }
}

/// The smallest box around places; `None` where there are none.
pub fn bounds(places: &[DVec3]) -> Option<(DVec3, DVec3)> {
    let first = *places.first()?;
    let grow = |(low, high): (DVec3, DVec3), &at: &DVec3| (low.min(at), high.max(at));
    Some(places.iter().fold((first, first), grow))
}
