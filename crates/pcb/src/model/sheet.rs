//! What a board may say.

use crate::board::Face;
use serde::Deserialize;
use std::collections::BTreeMap;
use toml::Spanned;

/// All keys of all tables.
pub(super) const KEYS: [&str; 21] = [
    "at", "diameter", "edges", "groups", "holes", "layer", "mirrored", "name", "net", "node",
    "nodes", "pads", "plated", "rotation", "shape", "size", "tracks", "width", "front", "back",
    "both",
];

/// A group of elements, in a frame of its own; the board itself is the outermost.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Group {
    pub name: Option<String>,
    /// Where its origin goes, in the frame around it, mm.
    pub at: Option<Spanned<At>>,
    /// Counter-clockwise about its origin, degrees.
    pub rotation: Option<Spanned<f64>>,
    /// Whether it lies on the other side: left and right, front and back change places.
    #[serde(default)]
    pub mirrored: bool,
    #[serde(default)]
    pub nodes: BTreeMap<String, Spanned<[f64; 2]>>,
    #[serde(default)]
    pub tracks: Vec<Spanned<Track>>,
    #[serde(default)]
    pub pads: Vec<Spanned<Pad>>,
    #[serde(default)]
    pub holes: Vec<Spanned<Bore>>,
    #[serde(default)]
    pub edges: Vec<Spanned<Edge>>,
    #[serde(default)]
    pub groups: Vec<Spanned<Group>>,
}

/// Copper from node to node.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Track {
    pub nodes: Vec<Spanned<At>>,
    /// mm
    pub width: Spanned<f64>,
    #[serde(default)]
    pub layer: On,
    pub net: Option<Spanned<String>>,
}

/// Copper about a node.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Pad {
    pub node: Spanned<At>,
    pub shape: Form,
    /// Diameter of a circle, distance of two opposite sides of the others, mm.
    pub size: Spanned<f64>,
    /// Counter-clockwise, degrees.
    pub rotation: Option<Spanned<f64>>,
    #[serde(default)]
    pub layer: On,
    pub net: Option<Spanned<String>>,
}

/// A hole at a node.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Bore {
    pub node: Spanned<At>,
    /// mm
    pub diameter: Spanned<f64>,
    pub plated: Option<bool>,
}

/// A closed contour: the edge of the board, or of a cut-out in it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Edge {
    pub nodes: Vec<Spanned<At>>,
}

/// A node by its name, or one that has none by its position, mm.
#[derive(Deserialize)]
#[serde(untagged, expecting = "this is neither the name of a node nor a position [x, y]")]
pub(super) enum At {
    Name(String),
    Position([f64; 2]),
}

/// The form of a pad.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Form {
    Circle,
    Square,
    Octagon,
}

/// Which sides an element is on.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum On {
    #[default]
    Front,
    Back,
    Both,
}

impl On {
    /// The sides, where front and back change places or not.
    pub(super) fn faces(self, swapped: bool) -> &'static [Face] {
        match (self, swapped) {
            (On::Both, _) => &[Face::Front, Face::Back],
            (On::Front, false) | (On::Back, true) => &[Face::Front],
            (On::Front, true) | (On::Back, false) => &[Face::Back],
        }
    }
}
