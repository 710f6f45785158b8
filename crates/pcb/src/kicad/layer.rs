//! Which layers an item is on.

use super::tree::Node;

/// Some layers of a board, as far as they are used here.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Layers {
    /// Copper of the front.
    pub(super) front: bool,
    /// Copper of the back.
    pub(super) back: bool,
    /// Copper within the board.
    pub(super) inner: bool,
    /// The edge.
    pub(super) edge: bool,
}

impl Layers {
    /// The layers of an item: its `(layer …)` or `(layers …)`.
    pub(super) fn of(item: Node) -> Layers {
        let lists = item.items().filter(|list| matches!(list.name(), b"layer" | b"layers"));
        let mut layers = Layers::default();
        for name in lists.flat_map(Node::items) {
            layers.add(name.word());
        }
        layers
    }

    /// Adds a layer or a set of layers by its name, which is always the English one.
    fn add(&mut self, name: &[u8]) {
        match name {
            b"F.Cu" => self.front = true,
            b"B.Cu" => self.back = true,
            b"F&B.Cu" => (self.front, self.back) = (true, true),
            b"*.Cu" => (self.front, self.back, self.inner) = (true, true, true),
            b"Edge.Cuts" => self.edge = true,
            name if name.starts_with(b"In") && name.ends_with(b".Cu") => self.inner = true,
            _ => {}
        }
    }

    /// Whether there is copper among them.
    pub(super) fn copper(&self) -> bool {
        self.outer() || self.inner
    }

    /// Whether copper of one of the two sides is among them.
    pub(super) fn outer(&self) -> bool {
        self.front || self.back
    }
}
