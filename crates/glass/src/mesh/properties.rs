//! What the triangles of a 3MF file are painted with: base materials of the core specification; groups of colours and textures of
//! the materials extension. How a colour lets light through is passed over.

use super::Fault;
use super::paint::{Paint, WHITE, luminance};
use super::threemf::{children, finite, line, whole};
use program::Rule;
use roxmltree::Node;
use std::collections::HashMap;

/// The most textures of a part.
pub(super) const MOST_TEXTURES: usize = 64;

/// The properties of a part of an archive.
#[derive(Debug, Default)]
pub(super) struct Properties {
    groups: HashMap<u32, Group>,
    /// The parts of the archive that its textures are, by their numbers in [`Paint::Texture`].
    pub textures: Vec<String>,
}

/// Properties that corners name by their number in the group.
#[derive(Debug)]
enum Group {
    /// The light of each colour.
    Colors(Vec<f32>),
    /// A texture, and places in it.
    Places(u32, Vec<[f32; 2]>),
}

impl Properties {
    /// Those of the resources of a model.
    pub(super) fn read(model: Node) -> Result<Properties, Fault> {
        let mut all = Properties::default();
        let mut numbers: HashMap<u32, u32> = HashMap::new();
        for node in children(model, "resources").flat_map(|resources| resources.children()) {
            let colors = |name, attribute| -> Result<Group, Fault> {
                children(node, name)
                    .map(|own| color(own, attribute))
                    .collect::<Result<_, _>>()
                    .map(Group::Colors)
            };
            let group = match node.tag_name().name() {
                "basematerials" => colors("base", "displaycolor")?,
                "colorgroup" => colors("color", "color")?,
                "texture2d" => {
                    let repeats = |name| node.attribute(name).is_none_or(|style| style == "wrap");
                    if !repeats("tilestyleu") || !repeats("tilestylev") {
                        return Err(wrong(node, "a texture that is not repeated is not read"));
                    }
                    if all.textures.len() >= MOST_TEXTURES {
                        let message = format!("has more than {MOST_TEXTURES} textures");
                        return Err(Fault::new(Rule::TooLarge, message));
                    }
                    let path = node.attribute("path").unwrap_or_default();
                    numbers.insert(whole(node, "id")?, all.textures.len() as u32);
                    all.textures.push(path.trim_start_matches('/').to_owned());
                    continue;
                }
                "texture2dgroup" => {
                    let Some(texture) = numbers.get(&whole(node, "texid")?) else {
                        return Err(wrong(node, "no texture before it has this `texid`"));
                    };
                    let place = |own: Node| {
                        let part =
                            |name| own.attribute(name).and_then(finite).map(|part| part as f32);
                        let both = part("u").zip(part("v")).map(|(u, v)| [u, v]);
                        both.ok_or_else(|| {
                            wrong(own, "a place in a texture needs the numbers u and v")
                        })
                    };
                    let places = children(node, "tex2coord").map(place);
                    Group::Places(*texture, places.collect::<Result<_, _>>()?)
                }
                _ => continue,
            };
            all.groups.insert(whole(node, "id")?, group);
        }
        Ok(all)
    }

    /// The paint of a triangle of `object`: its own, or that of the object, or none, which is white.
    pub(super) fn paint(&self, object: Node, triangle: Node) -> Result<Paint, Fault> {
        let number = |node: Node, name| -> Result<Option<u32>, Fault> {
            node.has_attribute(name).then(|| whole(node, name)).transpose()
        };
        let of_object = number(object, "pid")?;
        let Some(group) = number(triangle, "pid")?.or(of_object) else { return Ok(WHITE) };
        let Some(first) = number(triangle, "p1")?.or(number(object, "pindex")?) else {
            return Ok(WHITE);
        };
        let second = number(triangle, "p2")?.unwrap_or(first);
        let corners = [first, second, number(triangle, "p3")?.unwrap_or(first)];
        fn of<T: Copy>(all: &[T], corners: [u32; 3]) -> Option<[T; 3]> {
            let [a, b, c] = corners.map(|corner| all.get(corner as usize).copied());
            Some([a?, b?, c?])
        }
        let found = match self.groups.get(&group) {
            Some(Group::Colors(lights)) => of(lights, corners).map(Paint::Corners),
            Some(Group::Places(texture, places)) => {
                of(places, corners).map(|places| Paint::Texture(*texture, places))
            }
            None => None,
        };
        found.ok_or_else(|| {
            let message = format!(
                "group {group} is none of colours or places in a texture, or has no {}",
                corners.iter().max().unwrap_or(&0)
            );
            wrong(triangle, &message)
        })
    }
}

/// The light of a colour, `#RRGGBB` or `#RRGGBBAA` of sRGB; where a base has none, white.
fn color(node: Node, attribute: &str) -> Result<f32, Fault> {
    let Some(text) = node.attribute(attribute) else { return Ok(1.0) };
    let digits = text.strip_prefix('#').filter(|digits| [6, 8].contains(&digits.len()));
    let value = digits.filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
    let part = |at: usize| {
        let part = value.and_then(|digits| u8::from_str_radix(&digits[at..at + 2], 16).ok());
        part.map(|part| f64::from(part) / 255.0)
    };
    match [part(0), part(2), part(4)] {
        [Some(red), Some(green), Some(blue)] => Ok(luminance([red, green, blue])),
        _ => Err(wrong(node, &format!("`{text:.40}` is no colour such as #FF8000"))),
    }
}

fn wrong(node: Node, message: &str) -> Fault {
    Fault::new(Rule::Image, message).line(line(node))
}
