//! Contours that cross themselves.

use crate::contour::Contour;
use crate::near::Near;
use cavalier_contours::static_aabb2d_index::Control;
use geom::Vec2;
use program::{Diagnostic, Rule};
use sketch::Element;

/// Elements this near to each other touch, mm: half of what counts as one point.
pub(crate) const TOUCH: f64 = 5e-8;

/// The most pairs of elements that are looked at, for each element and in all.
const PAIRS: (usize, usize) = (256, 10_000_000);

impl Contour {
    /// Refuses a contour that crosses or touches itself.
    ///
    /// # Errors
    /// `self-crossing` with the place and both lines; `too-tangled` where too many elements lie over
    /// each other to look at all of them.
    pub fn simple(&self) -> Result<(), Box<Diagnostic>> {
        let elements = self.elements();
        let near = Near::new(elements);
        let most = elements.len().saturating_mul(PAIRS.0).saturating_add(PAIRS.1);
        let mut pairs = 0;
        for (i, element) in elements.iter().enumerate() {
            let mut found = None;
            near.around(element, TOUCH, &mut |j| {
                pairs += 1;
                if j <= i {
                    return Control::Continue;
                }
                found = self.crossing(i, j).map(|place| (j, place));
                if found.is_some() || pairs > most { Control::Break(()) } else { Control::Continue }
            });
            if let Some((j, place)) = found {
                let message = format!(
                    "the contour crosses or touches itself at X{:.4} Y{:.4}: lines {} and {}",
                    place.x,
                    place.y,
                    element.line,
                    elements.get(j).map_or(0, |e| e.line)
                );
                return Err(Diagnostic::error(Rule::SelfCrossing, message)
                    .help("the wire offset needs a contour that goes round once")
                    .line(element.line)
                    .into());
            }
            if pairs > most {
                let message = format!("more than {most} pairs of elements lie over each other");
                return Err(Diagnostic::error(Rule::TooTangled, message)
                    .help("divide the drawing into contours")
                    .line(element.line)
                    .into());
            }
        }
        Ok(())
    }

    /// Where elements `i` < `j` meet other than at the end that they share.
    fn crossing(&self, i: usize, j: usize) -> Option<Vec2> {
        let elements = self.elements();
        let (a, b) = (elements.get(i)?, elements.get(j)?);
        let shared = [
            (j == i + 1).then_some(b.start),
            (self.is_closed() && i == 0 && j + 1 == elements.len()).then_some(a.start),
        ];
        // Smooth neighbours part slowly: rounding lets them meet again within √(8 R · touch).
        let radius = |element: &Element| element.radius().unwrap_or(0.0);
        let near = 2.0 * TOUCH + (8.0 * radius(a).max(radius(b)) * TOUCH).sqrt();
        a.meets(b, TOUCH)
            .find(|place| shared.iter().flatten().all(|end| end.distance(*place) > near))
    }
}
