//! PLY: vertices and faces, as text or in binary. A file without faces is a cloud of points.

use super::paint::{Paint, WHITE, luminance};
use super::{Fault, MOST, Mesh, Shape, fan};
use crate::cloud::{Point, place};
use geom::ending::go_on;
use glam::DVec3;
use program::Rule;

/// How the numbers of a file are written.
#[derive(Clone, Copy, PartialEq)]
enum Writing {
    Text,
    Little,
    Big,
}

/// The kind of a number: its bytes, and whether it has a fraction or a sign.
#[derive(Clone, Copy)]
struct Kind {
    bytes: usize,
    real: bool,
    signed: bool,
}

impl Kind {
    /// What a colour of this kind has where it is brightest.
    fn white(self) -> f64 {
        match (self.real, self.bytes) {
            (true, _) => 1.0,
            (false, bytes) => (1u64 << (8 * bytes - usize::from(self.signed))) as f64 - 1.0,
        }
    }
}

fn kind(name: &str) -> Option<Kind> {
    let kind = |bytes, real, signed| Some(Kind { bytes, real, signed });
    match name {
        "char" | "int8" => kind(1, false, true),
        "uchar" | "uint8" => kind(1, false, false),
        "short" | "int16" => kind(2, false, true),
        "ushort" | "uint16" => kind(2, false, false),
        "int" | "int32" => kind(4, false, true),
        "uint" | "uint32" => kind(4, false, false),
        "float" | "float32" => kind(4, true, true),
        "double" | "float64" => kind(8, true, true),
        _ => None,
    }
}

/// What each item of an element holds: one number, or a list with the kind of its count.
struct Property {
    name: String,
    count: Option<Kind>,
    kind: Kind,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// The numbers of a file, one after another.
struct Numbers<'b> {
    bytes: &'b [u8],
    writing: Writing,
}

impl Numbers<'_> {
    fn next(&mut self, kind: Kind) -> Result<f64, Fault> {
        let ended =
            || Fault::new(Rule::Truncated, "ends within its numbers: not all of it is there");
        if self.writing == Writing::Text {
            self.bytes = self.bytes.trim_ascii_start();
            let length =
                self.bytes.iter().position(u8::is_ascii_whitespace).unwrap_or(self.bytes.len());
            let (word, rest) = self.bytes.split_at(length);
            self.bytes = rest;
            let word = String::from_utf8_lossy(word);
            if word.is_empty() {
                return Err(ended());
            }
            return super::number(Some(&word), 0);
        }
        let (own, rest) = self.bytes.split_at_checked(kind.bytes).ok_or_else(ended)?;
        self.bytes = rest;
        let mut bytes = [0; 8];
        match self.writing {
            Writing::Big => own.iter().rev().zip(&mut bytes).for_each(|(from, to)| *to = *from),
            Writing::Text | Writing::Little => bytes[..own.len()].copy_from_slice(own),
        }
        let whole = u64::from_le_bytes(bytes);
        let unused = 64 - 8 * kind.bytes as u32;
        Ok(match (kind.real, kind.bytes) {
            (true, 4) => f64::from(f32::from_bits(whole as u32)),
            (true, _) => f64::from_bits(whole),
            (false, _) if kind.signed => ((whole << unused) as i64 >> unused) as f64,
            (false, _) => whole as f64,
        })
    }
}

/// The most items that a list may hold: corners of a face.
const LONGEST_LIST: f64 = 1e6;

/// A cloud as binary PLY, in mm: what the programs that look at clouds open. Numbers of four bytes hold whole µm up to 4 m.
pub fn write(points: &[Point]) -> Vec<u8> {
    let head = format!(
        "ply\nformat binary_little_endian 1.0\ncomment Toolpost: points in glass, mm, in their order\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
        points.len()
    );
    let mut bytes = Vec::with_capacity(head.len() + 12 * points.len());
    bytes.extend_from_slice(head.as_bytes());
    for point in points {
        let values = place(*point).to_array().map(|value| (value as f32).to_le_bytes());
        bytes.extend(values.as_flattened());
    }
    bytes
}

/// Reads a file, with its colours where they are asked for.
pub(super) fn read(bytes: &[u8], painted: bool) -> Result<Shape, Fault> {
    let (writing, elements, body) = head(bytes)?;
    let mut numbers = Numbers { bytes: body, writing };
    let mut mesh = Mesh::default();
    let mut lights: Vec<Option<f32>> = Vec::new();
    for element in &elements {
        // Each item takes a byte at least: a count that the file cannot hold is not believed.
        let least = if element.properties.is_empty() { 0 } else { element.count };
        if least > numbers.bytes.len() {
            let Element { name, count, .. } = element;
            return Err(Fault::new(
                Rule::Truncated,
                format!("states {count} of `{name}`, more than it can hold"),
            ));
        }
        if element.properties.is_empty() {
            continue;
        }
        for _ in 0..element.count {
            go_on();
            item(element, &mut numbers, &mut mesh, &mut lights)?;
        }
    }
    let has_faces = elements.iter().any(|element| element.name == "face" && element.count > 0);
    let count = mesh.vertices.len();
    if mesh.triangles.iter().flatten().any(|&corner| corner as usize >= count) {
        return Err(Fault::new(
            Rule::Face,
            format!("a face names a vertex beyond the {count} that there are"),
        ));
    }
    if painted && has_faces && lights.iter().any(Option::is_some) {
        let light = |corner: u32| lights.get(corner as usize).copied().flatten();
        let paint = |corners: &[u32; 3]| match corners.map(light) {
            [Some(a), Some(b), Some(c)] => Paint::Corners([a, b, c]),
            _ => WHITE,
        };
        mesh.paint = mesh.triangles.iter().map(paint).collect();
    }
    Ok(if has_faces { Shape::Mesh(mesh) } else { Shape::Points(mesh.vertices) })
}

/// Reads one item of an element.
fn item(
    element: &Element,
    numbers: &mut Numbers,
    mesh: &mut Mesh,
    lights: &mut Vec<Option<f32>>,
) -> Result<(), Fault> {
    let mut place = DVec3::NAN;
    let mut colour = [f64::NAN; 3];
    for Property { name, count, kind } in &element.properties {
        let Some(count) = count else {
            let value = numbers.next(*kind)?;
            match name.as_str() {
                "x" => place.x = value,
                "y" => place.y = value,
                "z" => place.z = value,
                "red" | "r" => colour[0] = value / kind.white(),
                "green" | "g" => colour[1] = value / kind.white(),
                "blue" | "b" => colour[2] = value / kind.white(),
                _ => {}
            }
            continue;
        };
        let length = numbers.next(*count)?;
        if !(0.0..=LONGEST_LIST).contains(&length) {
            return Err(Fault::new(
                Rule::List,
                format!("a list of `{name}` has the length {length}"),
            ));
        }
        let mut corners = Vec::new();
        for _ in 0..length as usize {
            corners.push(numbers.next(*kind)?);
        }
        if element.name == "face" && (name == "vertex_indices" || name == "vertex_index") {
            if let Some(corner) = corners.iter().find(|corner| **corner < 0.0) {
                return Err(Fault::new(Rule::Face, format!("a face names the vertex {corner}")));
            }
            let corners: Vec<u32> = corners.into_iter().map(|corner| corner as u32).collect();
            mesh.triangles.extend(fan(&corners, &mesh.vertices)?);
        }
    }
    if element.name == "vertex" {
        mesh.vertices.push(place);
        let is_painted = colour.iter().all(|part| part.is_finite());
        lights.push(is_painted.then(|| luminance(colour)));
    }
    if mesh.vertices.len().max(mesh.triangles.len()) > MOST {
        return Err(Fault::new(Rule::TooLarge, "has more triangles than can be counted"));
    }
    Ok(())
}

/// The head of a file, and the bytes after it.
fn head(bytes: &[u8]) -> Result<(Writing, Vec<Element>, &[u8]), Fault> {
    let mut writing = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut rest = bytes;
    for at in 1.. {
        let Some(length) = rest.iter().position(|byte| *byte == b'\n') else {
            return Err(Fault::new(Rule::Truncated, "has no line `end_header`"));
        };
        let line = String::from_utf8_lossy(&rest[..length]);
        rest = &rest[length + 1..];
        let words: Vec<&str> = line.split_whitespace().collect();
        let wrong =
            |what: &str| Err(Fault::new(Rule::Head, format!("{what}: `{}`", line.trim())).line(at));
        match words[..] {
            ["ply"] if at == 1 => {}
            _ if at == 1 => return Err(Fault::new(Rule::Head, "does not begin with `ply`").line(1)),
            ["format", "ascii", _] => writing = Some(Writing::Text),
            ["format", "binary_little_endian", _] => writing = Some(Writing::Little),
            ["format", "binary_big_endian", _] => writing = Some(Writing::Big),
            ["comment" | "obj_info", ..] | [] => {}
            ["element", name, count] => match count.parse() {
                Ok(count) => {
                    elements.push(Element { name: name.to_owned(), count, properties: Vec::new() })
                }
                Err(_) => return wrong("an element needs a count"),
            },
            ["property", "list", count, own, name] => {
                match (kind(count), kind(own), elements.last_mut()) {
                    (Some(count), Some(kind), Some(element)) => {
                        element.properties.push(Property {
                            name: name.to_owned(),
                            count: Some(count),
                            kind,
                        });
                    }
                    _ => return wrong("an unknown kind of number, or no element before it"),
                }
            }
            ["property", own, name] => match (kind(own), elements.last_mut()) {
                (Some(kind), Some(element)) => {
                    element.properties.push(Property { name: name.to_owned(), count: None, kind });
                }
                _ => return wrong("an unknown kind of number, or no element before it"),
            },
            ["end_header"] => break,
            _ => return wrong("an unknown line"),
        }
    }
    let Some(writing) = writing else {
        return Err(Fault::new(Rule::Head, "has no line `format`"));
    };
    Ok((writing, elements, rest))
}
