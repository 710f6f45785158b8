//! Where footprints, and pads in them, are placed.

use super::tree::{Node, Outcome};
use crate::Transform;
use crate::board::Shape;
use geom::{Element, Vec2};

/// A place on the board, and how what stands there is turned. What is on the back is written as it is seen
/// through the board: nothing is mirrored.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    turned: Transform,
    at: Vec2,
}

impl Frame {
    /// That of the board.
    pub(super) const BOARD: Frame = Frame { turned: Transform::NONE, at: Vec2::ZERO };

    /// The frame that is moved and not turned.
    pub(super) fn moved(at: Vec2) -> Frame {
        Frame { turned: Transform::NONE, at }
    }

    /// The frame of an item of this one: its `(at X Y ANGLE)`. The place is relative to this frame, the
    /// angle is not.
    pub(super) fn of(&self, item: Node) -> Outcome<Frame> {
        let place = item.need("at")?;
        let angle = match place.item(2) {
            // Texts of footprints may stay upright.
            Some(angle) if angle.word() != b"unlocked" => place.number(2)?,
            _ => 0.0,
        };
        let at = self.point(place.point()?);
        Ok(Frame { turned: Transform::new(false, angle, 1.0), at })
    }

    /// Where a point of the item goes.
    pub(super) fn point(&self, point: Vec2) -> Vec2 {
        self.at + self.turned.apply(point)
    }

    /// Where a line or an arc of the item goes.
    pub(super) fn element(&self, element: &Element) -> Element {
        self.turned.element(element, self.at)
    }

    /// Where a shape of the item goes.
    pub(super) fn shape(&self, shape: &Shape) -> Shape {
        match shape {
            Shape::Stroke(path, width) => Shape::Stroke(self.element(path), *width),
            Shape::Pieces(pieces) => {
                let placed = pieces.iter().map(|piece| piece.placed(&self.turned, self.at));
                Shape::Pieces(placed.collect())
            }
        }
    }
}
