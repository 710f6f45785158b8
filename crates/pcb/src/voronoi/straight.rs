//! Lines through places that are nearly in a line.

use crate::Path;
use geom::{Element, Vec2, turn_angle};
use std::f64::consts::PI;

/// How far a place may be from the line that is drawn past it, mm.
const FLAT: f64 = 2e-3;

/// A path by lines, each from one of `places` to a later one, to the last; `None` where they are all in one
/// place.
pub(super) fn path(places: impl IntoIterator<Item = Vec2>) -> Option<Path> {
    let mut places = places.into_iter();
    let start = places.next()?;
    let mut elements = Vec::new();
    let mut line = Line::from(start);
    let mut last = start;
    for place in places {
        if !line.takes(place) {
            elements.push(Element::line(line.start, last));
            line = Line::from(last);
            line.takes(place);
        }
        last = place;
    }
    elements.push(Element::line(line.start, last));
    elements.retain(|element| element.start != element.end);
    Path::new(elements)
}

/// A line that is being drawn.
struct Line {
    start: Vec2,
    /// A direction, and between which angles to it (radians) a line passes all places near enough.
    cone: Option<(Vec2, f64, f64)>,
    /// How far the farthest of the places is, mm.
    length: f64,
}

impl Line {
    fn from(start: Vec2) -> Line {
        Line { start, cone: None, length: 0.0 }
    }

    /// Whether a line to `place` passes all places so far; then it is one of them.
    fn takes(&mut self, place: Vec2) -> bool {
        let step = place - self.start;
        let length = step.length();
        if length <= FLAT {
            // It is passed whatever the direction, but a line from farther on does not come back to it.
            return self.length <= FLAT;
        }
        let (along, low, high) = self.cone.unwrap_or((step, -PI, PI));
        let (angle, play) = (turn_angle(along, step), (FLAT / length).asin());
        let passes = low <= angle && angle <= high && length >= self.length - FLAT;
        if passes {
            self.cone = Some((along, low.max(angle - play), high.min(angle + play)));
            self.length = self.length.max(length);
        }
        passes
    }
}
