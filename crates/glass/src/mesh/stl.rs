//! STL: triangles one by one, as text or in binary.

use super::{Fault, MOST, Mesh, lines, number};
use geom::ending::go_on;
use glam::DVec3;
use program::Rule;
use std::collections::HashMap;

/// Bytes before the triangles: a title of 80 and a count.
const HEAD: usize = 84;

/// Bytes of a triangle: twelve numbers of 4, and 2 more.
const TRIANGLE: usize = 50;

/// Collects triangles whose corners at the same place are one vertex.
#[derive(Default)]
struct Corners {
    mesh: Mesh,
    known: HashMap<[u32; 3], u32>,
}

impl Corners {
    fn add(&mut self, triangle: [[f32; 3]; 3]) -> Result<(), Fault> {
        go_on();
        let vertices = &mut self.mesh.vertices;
        let corners = triangle.map(|corner| {
            // + 0 makes one of both zeros.
            let bits = corner.map(|value| (value + 0.0).to_bits());
            *self.known.entry(bits).or_insert_with(|| {
                vertices.push(DVec3::from_array(corner.map(f64::from)));
                vertices.len() as u32 - 1
            })
        });
        self.mesh.triangles.push(corners);
        if self.mesh.triangles.len() > MOST {
            return Err(Fault::new(Rule::TooLarge, "has more triangles than can be counted"));
        }
        Ok(())
    }
}

/// How many triangles the head of a binary file states.
fn stated(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(80..HEAD)?;
    Some(u32::from_le_bytes(count.try_into().ok()?))
}

/// Whether a file is as long as a binary file with its count of triangles: their titles may begin with the word solid as well.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    let length = |count| HEAD as u64 + u64::from(count) * TRIANGLE as u64;
    stated(bytes).is_some_and(|count| bytes.len() as u64 == length(count))
}

pub(super) fn read(bytes: &[u8]) -> Result<Mesh, Fault> {
    let word = bytes.trim_ascii_start().get(..5);
    let is_text = word.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    match stated(bytes) {
        _ if is_binary(bytes) => binary(bytes),
        _ if is_text => text(bytes),
        Some(count) => {
            let held = bytes.len().saturating_sub(HEAD) / TRIANGLE;
            let message =
                format!("states {count} triangles and holds {held}: not all of it is there");
            Err(Fault::new(Rule::Truncated, message))
        }
        None => Err(Fault::new(Rule::Truncated, "is too short for an STL file")),
    }
}

fn binary(bytes: &[u8]) -> Result<Mesh, Fault> {
    let mut corners = Corners::default();
    for triangle in bytes[HEAD..].chunks_exact(TRIANGLE) {
        let value = |i: usize| {
            let at = 12 + 4 * i;
            f32::from_le_bytes([triangle[at], triangle[at + 1], triangle[at + 2], triangle[at + 3]])
        };
        corners.add([0, 1, 2].map(|corner| [0, 1, 2].map(|axis| value(3 * corner + axis))))?;
    }
    Ok(corners.mesh)
}

fn text(bytes: &[u8]) -> Result<Mesh, Fault> {
    let mut corners = Corners::default();
    let mut open: Vec<[f32; 3]> = Vec::new();
    let mut ended = false;
    for (at, line) in lines(bytes) {
        let mut words = line.split_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("vertex") => {
                let mut corner = [0.0; 3];
                for value in &mut corner {
                    *value = number(words.next(), at)? as f32;
                }
                open.push(corner);
            }
            Some("endfacet") => {
                let Ok(triangle) = <[[f32; 3]; 3]>::try_from(std::mem::take(&mut open)) else {
                    return Err(Fault::new(Rule::Facet, "a facet needs three vertices").line(at));
                };
                corners.add(triangle)?;
            }
            Some("endsolid") => ended = true,
            Some("solid" | "facet" | "outer" | "endloop") | None => {}
            Some(word) => {
                let word: String = word.chars().take(40).collect();
                return Err(Fault::new(
                    Rule::DataWord,
                    format!("`{word}` is no word of an STL file"),
                )
                .line(at));
            }
        }
    }
    if !ended || !open.is_empty() {
        return Err(Fault::new(Rule::Truncated, "ends without `endsolid`: not all of it is there"));
    }
    Ok(corners.mesh)
}
