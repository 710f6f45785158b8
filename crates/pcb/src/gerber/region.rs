//! The contours of a region statement (section 4.10).

use crate::contour::Contour;
use crate::crossing::self_crossing;
use crate::report::{Outcome, fault};
use geom::Element;
use program::Rule;

/// Crossings of less than this are rounding, mm: points nearer than it may become one (section 4.14.2).
pub(super) const MARGIN: f64 = 1e-3;

/// A region statement that is open.
#[derive(Default)]
pub(super) struct Statement {
    pub(super) contours: Vec<Contour>,
    /// The contour at work.
    elements: Vec<Element>,
}

impl Statement {
    /// Adds a segment to the contour at work.
    pub(super) fn push(&mut self, element: Element) {
        self.elements.push(element);
    }

    /// Finishes the contour at work, if there is one.
    ///
    /// # Errors
    /// `region-open` where it ends elsewhere than it starts, `region-crosses-itself`.
    pub(super) fn finish(&mut self) -> Outcome {
        let mut elements = std::mem::take(&mut self.elements);
        // What has no length is not allowed, and does no harm.
        elements.retain(|element| element.turn.is_some() || element.start != element.end);
        let (Some(first), Some(last)) = (elements.first(), elements.last()) else { return Ok(()) };
        if first.start != last.end {
            let (start, end) = (first.start, last.end);
            let message = format!(
                "the contour starts at X {:.6} Y {:.6} and ends at X {:.6} Y {:.6} mm, {:.6} mm away",
                start.x,
                start.y,
                end.x,
                end.y,
                start.distance(end)
            );
            let help = "close the contour in the program that wrote it";
            return Err(fault(Rule::RegionOpen, message, help));
        }
        if let Some(place) = self_crossing(&elements, MARGIN)? {
            let message =
                format!("the contour crosses itself near X {:.4} Y {:.4} mm", place.x, place.y);
            let help =
                "the format gives it no meaning: write the layer again, with a finer resolution";
            return Err(fault(Rule::RegionCrossesItself, message, help));
        }
        self.contours.push(Contour::new(elements).counter_clockwise());
        Ok(())
    }
}
