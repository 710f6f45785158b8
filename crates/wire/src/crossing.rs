//! Where elements meet, how far apart they are, and contours that cross themselves.

use crate::contour::Contour;
use crate::element::{Element, Turn};
use crate::near::Near;
use cavalier_contours::static_aabb2d_index::Control;
use geom::Vec2;
use program::Diagnostic;

/// Elements this near to each other touch, mm: half of what counts as one point.
const TOUCH: f64 = 5e-8;

/// The most pairs of elements that are looked at, for each element and in all.
const PAIRS: (usize, usize) = (256, 10_000_000);

impl Element {
    /// The places where `other` meets this element; where they run along each other, the ends of that.
    pub(crate) fn meets(&self, other: &Element) -> impl Iterator<Item = Vec2> {
        let [p, q] = crossings(self, other);
        let places = [self.start, self.end, other.start, other.end, p, q].into_iter();
        places.filter(|p| {
            p.is_finite() && self.nearest(*p).1 <= TOUCH && other.nearest(*p).1 <= TOUCH
        })
    }

    /// The least distance from `other`, mm.
    pub(crate) fn distance(&self, other: &Element) -> f64 {
        let ends = [
            self.nearest(other.start).1,
            self.nearest(other.end).1,
            other.nearest(self.start).1,
            other.nearest(self.end).1,
        ];
        let mut least = ends.into_iter().fold(f64::INFINITY, f64::min);
        if self.meets(other).next().is_some() {
            return 0.0;
        }
        // Else the shortest way between two inner points is at right angles to both: on an arc it
        // points at the centre.
        for (arc, rest) in [(self, other), (other, self)] {
            let Some(turn) = arc.turn else { continue };
            let toward = match rest.turn {
                None => {
                    let along = rest.end - rest.start;
                    let foot = (turn.center - rest.start).dot(along) / along.length_squared();
                    rest.start + along * foot - turn.center
                }
                Some(second) => second.center - turn.center,
            };
            let radius = arc.start.distance(turn.center);
            let out = toward.normalize_or_zero() * radius;
            // About a point of the other element, or its centre, the ends are as near as the rest.
            for point in [turn.center + out, turn.center - out] {
                if out != Vec2::ZERO && arc.parameter(turn, point).is_some() {
                    least = least.min(rest.nearest(point).1);
                }
            }
        }
        least
    }
}

/// Where the whole line or circle of `a` crosses that of `b`: two places, equal ones where they only
/// touch, not finite ones for parallels. Where they miss each other it is between them.
pub(crate) fn crossings(a: &Element, b: &Element) -> [Vec2; 2] {
    let (foot, square, along) = match (a.turn, b.turn) {
        (None, None) => {
            let (p, q) = (a.end - a.start, b.end - b.start);
            let t = (b.start - a.start).perp_dot(q) / p.perp_dot(q);
            (a.start + p * t, 0.0, Vec2::ZERO)
        }
        (None, Some(turn)) => line_and_circle(a, turn, b),
        (Some(turn), None) => line_and_circle(b, turn, a),
        (Some(p), Some(q)) => {
            let (r, s) = (a.start.distance(p.center), b.start.distance(q.center));
            let between = q.center - p.center;
            let apart = between.length();
            let foot = (apart * apart + r * r - s * s) / (2.0 * apart);
            let axis = between / apart;
            (p.center + axis * foot, r * r - foot * foot, axis.perp())
        }
    };
    let half = along * square.max(0.0).sqrt();
    [foot + half, foot - half]
}

/// The point of a line nearest to a circle's centre, the square of half the chord, its direction.
fn line_and_circle(line: &Element, turn: Turn, arc: &Element) -> (Vec2, f64, Vec2) {
    let radius = arc.start.distance(turn.center);
    let along = (line.end - line.start).normalize_or_zero();
    let foot = line.start + along * (turn.center - line.start).dot(along);
    (foot, radius * radius - foot.distance_squared(turn.center), along)
}

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
                return Err(Diagnostic::error("self-crossing", message)
                    .help("the wire offset needs a contour that goes round once")
                    .line(element.line)
                    .into());
            }
            if pairs > most {
                let message = format!("more than {most} pairs of elements lie over each other");
                return Err(Diagnostic::error("too-tangled", message)
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
        a.meets(b).find(|place| shared.iter().flatten().all(|end| end.distance(*place) > near))
    }
}
