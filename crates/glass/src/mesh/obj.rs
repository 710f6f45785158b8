//! Wavefront OBJ: vertices and faces; where it is asked for, colours of vertices, materials and textures. Normals and groups are
//! passed over.

use super::paint::{Paint, WHITE, luminance};
use super::{Beside, Fault, MOST, Mesh, fan, lines, number};
use crate::picture;
use geom::ending::go_on;
use glam::DVec3;
use program::Rule;
use std::collections::HashMap;

/// The most libraries of materials that a body may name, and the most textures of all of them.
const MOST_FILES: usize = 64;

/// The most pixels of all textures together.
const MOST_PIXELS: usize = 128_000_000;

/// What a material paints faces with.
#[derive(Clone, Copy)]
struct Material {
    light: f32,
    texture: Option<u32>,
}

/// The paint of a body as it is read.
#[derive(Default)]
struct Paints {
    /// The light of each vertex that has a colour.
    vertices: Vec<Option<f32>>,
    /// Places in textures.
    places: Vec<[f32; 2]>,
    materials: HashMap<String, Material>,
    textures: HashMap<String, u32>,
    libraries: usize,
    pixels: usize,
    /// The material of the faces that follow.
    own: Option<Material>,
}

/// Reads a body; with the files `beside` it, its paint too.
pub(super) fn read(bytes: &[u8], mut beside: Option<Beside>) -> Result<Mesh, Fault> {
    let mut mesh = Mesh::default();
    let mut paints = Paints::default();
    for (at, line) in lines(bytes) {
        let mut words = line.split_whitespace();
        match (words.next(), &mut beside) {
            (Some("v"), painted) => {
                let mut place = DVec3::ZERO;
                for axis in 0..3 {
                    place[axis] = number(words.next(), at)?;
                }
                mesh.vertices.push(place);
                if painted.is_some() {
                    let parts: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
                    let colour: Option<[f64; 3]> = parts.try_into().ok();
                    paints.vertices.push(colour.map(luminance));
                }
            }
            (Some("f"), painted) => {
                let named: Vec<&str> = words.collect();
                let corners: Vec<u32> = named
                    .iter()
                    .inspect(|_| go_on())
                    .map(|word| corner(word, mesh.vertices.len(), at))
                    .collect::<Result<_, _>>()?;
                if corners.len() < 3 {
                    return Err(
                        Fault::new(Rule::Face, "a face needs three corners or more").line(at)
                    );
                }
                let triangles = fan(&corners, &mesh.vertices).map_err(|fault| fault.line(at))?;
                mesh.triangles.extend(triangles);
                if painted.is_some() {
                    let paint = |i| paints.of([0, i, i + 1].map(|i| (named[i], corners[i])));
                    mesh.paint.extend((1..corners.len() - 1).map(paint));
                }
            }
            (Some("vt"), Some(_)) => {
                let [u, v] = [
                    number(words.next(), at)?,
                    words.next().map_or(Ok(0.0), |word| number(Some(word), at))?,
                ];
                paints.places.push([u as f32, v as f32]);
            }
            (Some("mtllib"), Some(beside)) => {
                let name = line.trim().strip_prefix("mtllib").unwrap_or_default().trim();
                paints.library(name, beside, &mut mesh).map_err(|fault| fault.line(at))?;
            }
            (Some("usemtl"), Some(_)) => {
                let name = line.trim().strip_prefix("usemtl").unwrap_or_default().trim();
                let Some(material) = paints.materials.get(name) else {
                    let name: String = name.chars().take(40).collect();
                    let message = format!("no library before it has the material `{name}`");
                    return Err(Fault::new(Rule::Image, message).line(at));
                };
                paints.own = Some(*material);
            }
            _ => {}
        }
        if mesh.vertices.len().max(mesh.triangles.len()) > MOST {
            return Err(Fault::new(Rule::TooLarge, "has more triangles than can be counted"));
        }
    }
    Ok(mesh)
}

impl Paints {
    /// The paint of a triangle whose corners are written so and have these vertices.
    fn of(&self, corners: [(&str, u32); 3]) -> Paint {
        let place = |(word, _): (&str, u32)| {
            let named: i64 = word.split('/').nth(1)?.parse().ok()?;
            let count = self.places.len() as i64;
            let number = if named < 0 { count + named } else { named - 1 };
            self.places.get(usize::try_from(number).ok()?).copied()
        };
        let texture = self.own.and_then(|material| material.texture);
        if let (Some(texture), [Some(a), Some(b), Some(c)]) = (texture, corners.map(place)) {
            return Paint::Texture(texture, [a, b, c]);
        }
        if let [Some(a), Some(b), Some(c)] =
            corners.map(|(_, vertex)| self.vertices[vertex as usize])
        {
            return Paint::Corners([a, b, c]);
        }
        self.own.map_or(WHITE, |material| Paint::Corners([material.light; 3]))
    }

    /// Reads a library of materials.
    fn library(&mut self, name: &str, beside: &mut Beside, mesh: &mut Mesh) -> Result<(), Fault> {
        self.libraries += 1;
        if self.libraries > MOST_FILES {
            return Err(Fault::new(Rule::TooLarge, "names too many libraries of materials"));
        }
        let bytes = beside(name).map_err(|message| Fault::new(Rule::Image, message))?;
        let mut own: Option<String> = None;
        for (_, line) in lines(&bytes) {
            let mut words = line.split_whitespace();
            let rest =
                |word: &str| line.trim().strip_prefix(word).unwrap_or_default().trim().to_owned();
            match (words.next(), &own) {
                (Some("newmtl"), _) => {
                    let name = rest("newmtl");
                    self.materials.insert(name.clone(), Material { light: 1.0, texture: None });
                    own = Some(name);
                }
                (Some("Kd"), Some(name)) => {
                    let parts: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
                    let colour: Option<[f64; 3]> = parts.try_into().ok();
                    if let (Some(colour), Some(material)) = (colour, self.materials.get_mut(name)) {
                        material.light = luminance(colour);
                    }
                }
                (Some("map_Kd"), Some(name)) => {
                    // Options stand before the name of the file, which may hold blanks.
                    let mut file = rest("map_Kd");
                    if file.starts_with('-') {
                        file = words.next_back().unwrap_or_default().to_owned();
                    }
                    let texture = self.texture(&file, beside, mesh)?;
                    if let Some(material) = self.materials.get_mut(name) {
                        material.texture = Some(texture);
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The number of the texture in a file, which is read once.
    fn texture(&mut self, file: &str, beside: &mut Beside, mesh: &mut Mesh) -> Result<u32, Fault> {
        if let Some(number) = self.textures.get(file) {
            return Ok(*number);
        }
        let bytes = beside(file).map_err(|message| Fault::new(Rule::Image, message))?;
        let texture = picture::texture(&bytes)?;
        self.pixels += texture.pixels();
        if self.pixels > MOST_PIXELS || mesh.textures.len() >= MOST_FILES {
            return Err(Fault::new(Rule::TooLarge, "has more textures than are read"));
        }
        let number = mesh.textures.len() as u32;
        mesh.textures.push(texture);
        self.textures.insert(file.to_owned(), number);
        Ok(number)
    }
}

/// The vertex that a corner of a face names: from 1, or from the end where it is negative; what follows a slash is
/// texture and normal.
fn corner(word: &str, count: usize, line: usize) -> Result<u32, Fault> {
    let own = word.split('/').next().unwrap_or(word);
    let wrong = || {
        let word: String = word.chars().take(40).collect();
        Fault::new(Rule::Face, format!("`{word}` names none of the {count} vertices before it"))
            .line(line)
    };
    let named: i64 = own.parse().map_err(|_| wrong())?;
    let number = if named < 0 { count as i64 + named } else { named - 1 };
    u32::try_from(number).ok().filter(|number| (*number as usize) < count).ok_or_else(wrong)
}
