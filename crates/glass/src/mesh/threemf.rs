//! 3MF: a ZIP archive with the bodies of a print job as XML: those that are built, each at its place, in mm.
//!
//! The core specification, and parts in files of their own (production extension). What an archive unpacks to is bounded, and an
//! object whose shape is described by another extension (beams, booleans) is refused: its triangles alone are another body.

use super::paint::{Paint, WHITE};
use super::properties::{MOST_TEXTURES, Properties};
use super::{Fault, Mesh};
use crate::picture;
use geom::ending::go_on;
use glam::{DMat3, DVec3};
use program::Rule;
use roxmltree::{Document, Node, ParsingOptions};
use std::collections::HashMap;
use std::io::{Cursor, Read};
use zip::ZipArchive;

/// The most that a part of an archive may unpack to, bytes: some 4 million triangles.
const LARGEST_PART: u64 = 256 << 20;

/// The most parts that are read.
const MOST_PARTS: usize = 1000;

/// How deep components may name components.
const DEEPEST: u32 = 32;

/// The most objects that are placed: components that name components multiply them.
const MOST_PLACED: u32 = 100_000;

/// The most pixels of all textures.
const MOST_PIXELS: usize = 128_000_000;

/// The part that holds the model where `_rels/.rels` names none.
const USUAL: &str = "3D/3dmodel.model";

type Archive<'b> = ZipArchive<Cursor<&'b [u8]>>;

/// Reads what is built; `painted`, its colours and textures too.
pub(super) fn read(bytes: &[u8], painted: bool) -> Result<Mesh, Fault> {
    let mut archive = ZipArchive::new(Cursor::new(bytes))
        .map_err(|error| Fault::new(Rule::Truncated, format!("is no 3MF archive: {error}")))?;
    let root = root(&mut archive)?;
    let mut parts = Parts {
        archive,
        painted,
        known: HashMap::new(),
        textures: HashMap::new(),
        pixels: 0,
        unpacked: 0,
        placed: 0,
    };
    let items = parts.of(&root)?.items.clone();
    if items.is_empty() {
        return Err(Fault::new(Rule::Empty, "builds no object"));
    }
    let mut mesh = Mesh::default();
    for item in items {
        let path = item.path.as_deref().unwrap_or(&root).to_owned();
        parts.add(&path, &item, &Placed::default(), 0, &mut mesh)?;
    }
    Ok(mesh)
}

/// The part with the model, as the relations of the archive name it.
fn root(archive: &mut Archive) -> Result<String, Fault> {
    if archive.index_for_name("_rels/.rels").is_none() {
        return Ok(USUAL.to_owned());
    }
    let (text, _) = text(archive, "_rels/.rels", LARGEST_PART)?;
    let document = parsed(&text, "_rels/.rels")?;
    let model = document
        .descendants()
        .find(|node| node.attribute("Type").is_some_and(|kind| kind.ends_with("/3dmodel")));
    let target = model.and_then(|node| node.attribute("Target"));
    Ok(target.map_or(USUAL, |target| target.trim_start_matches('/')).to_owned())
}

fn broken(name: &str, error: &str) -> Fault {
    Fault::new(Rule::Truncated, format!("`{name}`: {error}"))
}

/// A part of at most `most` bytes.
fn unpacked(archive: &mut Archive, name: &str, most: u64) -> Result<Vec<u8>, Fault> {
    let part = archive.by_name(name).map_err(|error| broken(name, &error.to_string()))?;
    let mut bytes = Vec::new();
    let read = part.take(most + 1).read_to_end(&mut bytes);
    read.map_err(|error| broken(name, &error.to_string()))?;
    if bytes.len() as u64 > most {
        let message = format!("`{name}` unpacks to more than {} MiB", LARGEST_PART >> 20);
        return Err(Fault::new(Rule::TooLarge, message));
    }
    Ok(bytes)
}

/// The text of a part of at most `most` bytes, and how many it has.
fn text(archive: &mut Archive, name: &str, most: u64) -> Result<(String, u64), Fault> {
    let bytes = unpacked(archive, name, most)?;
    let length = bytes.len() as u64;
    let text = String::from_utf8(bytes).map_err(|_| broken(name, "is not UTF-8"))?;
    Ok((text, length))
}

fn parsed<'t>(text: &'t str, name: &str) -> Result<Document<'t>, Fault> {
    // Without a document type there are no entities that grow.
    Document::parse_with_options(text, ParsingOptions::default()).map_err(|error| {
        let line = error.pos().row as usize;
        Fault::new(Rule::Syntax, format!("`{name}`: {error}")).line(line)
    })
}

/// Moves the points of an object: the matrix of 3MF acts on rows.
#[derive(Clone, Copy, Debug)]
struct Placed {
    turn: DMat3,
    shift: DVec3,
}

impl Default for Placed {
    fn default() -> Placed {
        Placed { turn: DMat3::IDENTITY, shift: DVec3::ZERO }
    }
}

impl Placed {
    fn at(&self, place: DVec3) -> DVec3 {
        self.turn * place + self.shift
    }

    /// First `inner`, then this.
    fn after(&self, inner: &Placed) -> Placed {
        Placed { turn: self.turn * inner.turn, shift: self.at(inner.shift) }
    }

    /// Twelve numbers: three rows of the matrix, then the shift.
    fn read(node: Node) -> Result<Placed, Fault> {
        let Some(text) = node.attribute("transform") else { return Ok(Placed::default()) };
        let numbers: Option<Vec<f64>> = text.split_whitespace().map(finite).collect();
        let Some(Ok(m)) = numbers.map(<[f64; 12]>::try_from) else {
            let message = format!("a transform needs twelve numbers, not `{text}`");
            return Err(Fault::new(Rule::Number, message).line(line(node)));
        };
        let row = |i: usize| DVec3::new(m[i], m[i + 1], m[i + 2]);
        Ok(Placed { turn: DMat3::from_cols(row(0), row(3), row(6)), shift: row(9) })
    }
}

pub(super) fn finite(word: &str) -> Option<f64> {
    word.parse().ok().filter(|value: &f64| value.is_finite())
}

pub(super) fn line(node: Node) -> usize {
    node.document().text_pos_at(node.range().start).row as usize
}

/// An object named somewhere, and where it stands there.
#[derive(Clone, Debug)]
struct Named {
    object: u32,
    path: Option<String>,
    placed: Placed,
}

impl Named {
    fn read(node: Node) -> Result<Named, Fault> {
        let object = whole(node, "objectid")?;
        // `path` of the production extension, whatever its prefix.
        let path = node.attributes().find(|attribute| attribute.name() == "path");
        let path = path.map(|path| path.value().trim_start_matches('/').to_owned());
        Ok(Named { object, path, placed: Placed::read(node)? })
    }
}

pub(super) fn whole(node: Node, name: &str) -> Result<u32, Fault> {
    let text = node.attribute(name).unwrap_or("");
    text.parse().map_err(|_| {
        let message =
            format!("`{}` needs a whole number `{name}`, not `{text}`", node.tag_name().name());
        Fault::new(Rule::Number, message).line(line(node))
    })
}

/// What an object is.
#[derive(Debug)]
enum Object {
    Mesh(Mesh),
    Components(Vec<Named>),
    /// Kept out of the print, as supports are.
    Other,
}

/// A file of an archive, mm.
#[derive(Debug)]
struct Part {
    objects: HashMap<u32, Object>,
    items: Vec<Named>,
    /// The parts that the textures of its objects are.
    textures: Vec<String>,
}

impl Part {
    fn read(text: &str, name: &str, painted: bool) -> Result<Part, Fault> {
        let document = parsed(text, name)?;
        let model = document.root_element();
        if model.tag_name().name() != "model" {
            return Err(Fault::new(Rule::Syntax, format!("`{name}` holds no model")));
        }
        let unit = millimetres(model)?;
        let mut properties = painted.then(|| Properties::read(model)).transpose()?;
        let textures = properties.as_mut().map(|own| std::mem::take(&mut own.textures));
        let mut part = Part {
            objects: HashMap::new(),
            items: Vec::new(),
            textures: textures.unwrap_or_default(),
        };
        for object in children(model, "resources").flat_map(|all| children(all, "object")) {
            let id = whole(object, "id")?;
            if part.objects.insert(id, self::object(object, unit, properties.as_ref())?).is_some() {
                let message = format!("two objects have the number {id}");
                return Err(Fault::new(Rule::Syntax, message).line(line(object)));
            }
        }
        for item in children(model, "build").flat_map(|build| children(build, "item")) {
            part.items.push(in_unit(Named::read(item)?, unit));
        }
        Ok(part)
    }
}

/// The elements of this name in a node.
pub(super) fn children<'a, 'i>(
    node: Node<'a, 'i>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |child| child.tag_name().name() == name)
}

/// A named object whose shift is in `unit` mm.
fn in_unit(named: Named, unit: f64) -> Named {
    let Placed { turn, shift } = named.placed;
    Named { placed: Placed { turn, shift: shift * unit }, ..named }
}

/// How many mm the unit of a model has.
fn millimetres(model: Node) -> Result<f64, Fault> {
    match model.attribute("unit").unwrap_or("millimeter") {
        "micron" => Ok(1e-3),
        "millimeter" => Ok(1.0),
        "centimeter" => Ok(10.0),
        "inch" => Ok(25.4),
        "foot" => Ok(304.8),
        "meter" => Ok(1e3),
        other => Err(Fault::new(Rule::Number, format!("the unit `{other}` is none of 3MF"))),
    }
}

fn object(node: Node, unit: f64, properties: Option<&Properties>) -> Result<Object, Fault> {
    if node.attribute("type").is_some_and(|kind| ["support", "solidsupport"].contains(&kind)) {
        return Ok(Object::Other);
    }
    for child in node.children().filter(Node::is_element) {
        match child.tag_name().name() {
            "mesh" => {
                let mut mesh = mesh(child, unit)?;
                if let Some(properties) = properties {
                    let triangles = children(child, "triangles");
                    let triangles = triangles.flat_map(|all| children(all, "triangle"));
                    let paint = triangles.map(|triangle| properties.paint(node, triangle));
                    mesh.paint = paint.collect::<Result<_, _>>()?;
                }
                return Ok(Object::Mesh(mesh));
            }
            "components" => {
                let named = children(child, "component");
                let named = named.map(|part| Ok(in_unit(Named::read(part)?, unit)));
                return named.collect::<Result<_, _>>().map(Object::Components);
            }
            "metadatagroup" => {}
            other => {
                let message = format!("an object is made of `{other}`, not of triangles");
                return Err(Fault::new(Rule::Form, message).line(line(child)));
            }
        }
    }
    Err(Fault::new(Rule::Empty, "an object has neither triangles nor components").line(line(node)))
}

fn mesh(node: Node, unit: f64) -> Result<Mesh, Fault> {
    let mut mesh = Mesh::default();
    for child in node.children().filter(Node::is_element) {
        match child.tag_name().name() {
            "vertices" => {
                for vertex in children(child, "vertex") {
                    go_on();
                    let value = |name| vertex.attribute(name).and_then(finite);
                    let (Some(x), Some(y), Some(z)) = (value("x"), value("y"), value("z")) else {
                        let message = "a vertex needs the numbers x, y and z";
                        return Err(Fault::new(Rule::Number, message).line(line(vertex)));
                    };
                    mesh.vertices.push(DVec3::new(x, y, z) * unit);
                }
            }
            "triangles" => {
                for triangle in children(child, "triangle") {
                    go_on();
                    mesh.triangles.push([
                        whole(triangle, "v1")?,
                        whole(triangle, "v2")?,
                        whole(triangle, "v3")?,
                    ]);
                }
            }
            "trianglesets" => {}
            other => {
                let message = format!("a body has `{other}`, which triangles do not show");
                return Err(Fault::new(Rule::Form, message).line(line(child)));
            }
        }
    }
    let count = mesh.vertices.len();
    if mesh.triangles.iter().flatten().any(|&corner| corner as usize >= count) {
        let message = format!("a triangle names a vertex beyond the {count} of its body");
        return Err(Fault::new(Rule::Face, message).line(line(node)));
    }
    Ok(mesh)
}

/// The files of an archive, read where they are needed.
struct Parts<'b> {
    archive: Archive<'b>,
    painted: bool,
    known: HashMap<String, Part>,
    /// The numbers of the textures that were read.
    textures: HashMap<String, u32>,
    pixels: usize,
    unpacked: u64,
    /// How many objects were placed.
    placed: u32,
}

impl Parts<'_> {
    fn of(&mut self, name: &str) -> Result<&Part, Fault> {
        if !self.known.contains_key(name) {
            if self.known.len() >= MOST_PARTS {
                let message = format!("has more than {MOST_PARTS} parts");
                return Err(Fault::new(Rule::TooLarge, message));
            }
            let most = LARGEST_PART - self.unpacked;
            let (text, length) = text(&mut self.archive, name, most)?;
            self.unpacked += length;
            self.known.insert(name.to_owned(), Part::read(&text, name, self.painted)?);
        }
        Ok(&self.known[name])
    }

    /// The paint of a placed triangle, whose textures are those of `mesh`; one that is mirrored has its corners exchanged.
    fn placed(
        &mut self,
        paint: Paint,
        is_mirrored: bool,
        names: &[String],
        mesh: &mut Mesh,
    ) -> Result<Paint, Fault> {
        fn turned<T>([a, b, c]: [T; 3], is_mirrored: bool) -> [T; 3] {
            if is_mirrored { [a, c, b] } else { [a, b, c] }
        }
        Ok(match paint {
            Paint::Corners(lights) => Paint::Corners(turned(lights, is_mirrored)),
            Paint::Texture(number, places) => {
                let number = self.texture(&names[number as usize], mesh)?;
                Paint::Texture(number, turned(places, is_mirrored))
            }
        })
    }

    /// The number of a texture, which is read once.
    fn texture(&mut self, name: &str, mesh: &mut Mesh) -> Result<u32, Fault> {
        if let Some(number) = self.textures.get(name) {
            return Ok(*number);
        }
        let bytes = unpacked(&mut self.archive, name, LARGEST_PART - self.unpacked)?;
        self.unpacked += bytes.len() as u64;
        let texture = picture::texture(&bytes)?;
        self.pixels += texture.pixels();
        if self.pixels > MOST_PIXELS || mesh.textures.len() >= MOST_TEXTURES {
            return Err(Fault::new(Rule::TooLarge, "has more textures than are read"));
        }
        let number = mesh.textures.len() as u32;
        mesh.textures.push(texture);
        self.textures.insert(name.to_owned(), number);
        Ok(number)
    }

    /// Adds the object that `named` is, in the part `path`, to `mesh`.
    fn add(
        &mut self,
        path: &str,
        named: &Named,
        outer: &Placed,
        depth: u32,
        mesh: &mut Mesh,
    ) -> Result<(), Fault> {
        let too_large = || Fault::new(Rule::TooLarge, "has more triangles than can be counted");
        if depth > DEEPEST {
            let message = format!("components name components more than {DEEPEST} deep");
            return Err(Fault::new(Rule::TooLarge, message));
        }
        self.placed += 1;
        if self.placed > MOST_PLACED {
            let message = format!("places more than {MOST_PLACED} objects");
            return Err(Fault::new(Rule::TooLarge, message));
        }
        let placed = outer.after(&named.placed);
        let object = self.of(path)?.objects.get(&named.object).ok_or_else(|| {
            let message = format!("`{path}` has no object {}", named.object);
            Fault::new(Rule::Empty, message)
        })?;
        let components = match object {
            Object::Other => return Ok(()),
            Object::Components(components) => components.clone(),
            Object::Mesh(body) => {
                if mesh.vertices.len() + body.vertices.len() > LARGEST_BUILD {
                    return Err(too_large());
                }
                let vertices = body.vertices.iter().map(|place| placed.at(*place)).collect();
                let mut triangles = body.triangles.clone();
                if placed.turn.determinant() < 0.0 {
                    triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
                }
                let (before, paint) = (mesh.triangles.len(), body.paint.clone());
                mesh.join(Mesh { vertices, triangles, ..Mesh::default() });
                if self.painted {
                    let names = self.of(path)?.textures.clone();
                    let is_mirrored = placed.turn.determinant() < 0.0;
                    mesh.paint.resize(before, WHITE);
                    for own in paint {
                        let own = self.placed(own, is_mirrored, &names, mesh)?;
                        mesh.paint.push(own);
                    }
                }
                return Ok(());
            }
        };
        for component in components {
            let own = component.path.as_deref().unwrap_or(path).to_owned();
            self.add(&own, &component, &placed, depth + 1, mesh)?;
        }
        Ok(())
    }
}

/// The most vertices of all that is built.
const LARGEST_BUILD: usize = 50_000_000;
