//! Paths in fewer elements, and fewer paths.
//!
//! ```text
//!   Path ──division──▶ the fewest elements ◀──fit── of a run of it, ◀──walk── near it all along
//! ```

mod division;
mod fit;
mod walk;

use crate::Path;
use division::{Division, sharpness};
use geom::Element;

/// How far merged paths may be from the calculated ones, mm.
pub const MERGED: f64 = 0.005;

/// Of the tolerance: shorter elements are none.
const SHORT: f64 = 0.25;

/// The greatest radius of an arc that is made of others, mm: what is flatter stays as it is.
const GREATEST: f64 = 1000.0;

/// The least radius of an arc, mm: ten steps of a machine. Of a smaller one a control sees the rounding of
/// its ends rather than the arc.
const LEAST: f64 = 0.01;

impl Path {
    /// The same path in few elements. Followed side by side from end to end, without ever turning back, the two
    /// are nowhere farther apart than `tolerance` mm: so a path that goes back along itself stays so. No element is
    /// shorter than a quarter of that, no arc has a radius of less than 10 µm. Elements stay as they are
    /// where that takes no more of them.
    /// What is closed stays closed, though it may begin elsewhere. `None` where nothing is left.
    pub fn merged(&self, tolerance: f64) -> Option<Path> {
        let mut elements = self.elements().to_vec();
        let is_near = |element: &Element| {
            let (low, high) = element.extents();
            (self.start() - low).max(high - self.start()).length() < SHORT * tolerance
        };
        if elements.iter().all(is_near) {
            return None;
        }
        if !self.is_closed() {
            let fewest = Division::of(&elements, tolerance).fewest();
            return fewest
                .map_or_else(|| self.without_short(tolerance), |(fewest, _)| Path::new(fewest));
        }
        // Where it turns most an element ends in any case.
        let corners = elements.iter().zip(elements.iter().cycle().skip(elements.len() - 1));
        let sharp = corners.map(|(next, before)| sharpness(before, next)).enumerate();
        let sharpest = sharp.reduce(|most, next| if next.1 > most.1 { next } else { most });
        elements.rotate_left(sharpest.map_or(0, |(sharpest, _)| sharpest));
        let division = Division::of(&elements, tolerance);
        if let Some(circle) = division.circle() {
            return Path::new(vec![circle]);
        }
        let Some((mut fewest, middle)) = division.fewest() else {
            return self.without_short(tolerance);
        };
        if !division.starts_sharp() {
            // What ends at the start may go on there.
            elements.rotate_left(middle);
            let around = Division::of(&elements, tolerance).fewest();
            fewest = match around {
                Some((around, _)) if around.len() < fewest.len() => around,
                _ => fewest,
            };
        }
        Path::new(fewest)
    }

    /// The same path without its short elements: the next one starts where the last one that is kept has ended.
    fn without_short(&self, tolerance: f64) -> Option<Path> {
        let short = SHORT * tolerance;
        let (mut at, end) = (self.start(), self.end());
        let mut kept: Vec<Element> = Vec::with_capacity(self.elements().len());
        for element in self.elements() {
            if element.length() >= short || at.distance(element.end) >= short {
                kept.push(if at == element.start { *element } else { fit::started(element, at) });
                at = element.end;
            }
        }
        if let Some(last) = kept.last_mut().filter(|_| at != end) {
            *last = fit::started(&last.reversed(), end).reversed();
        }
        Path::new(kept)
    }
}

/// `paths`, in their order, without lifting the tool where it need not be: it cuts straight to where the next
/// one starts where that widens a cut of `width` mm by no more than `tolerance` mm.
pub fn joined(paths: &[Path], width: f64, tolerance: f64) -> Vec<Path> {
    let reach = pitch(width, tolerance);
    let mut joined: Vec<Vec<Element>> = Vec::new();
    for path in paths {
        let end = joined.last().and_then(|before| before.last()).map(|element| element.end);
        match (joined.last_mut(), end) {
            (Some(before), Some(end)) if end.distance(path.start()) <= reach => {
                let mut next = path.elements().to_vec();
                match next.first_mut() {
                    // No machine goes so little between them.
                    Some(first) if end.distance(first.start) < SHORT * MERGED => {
                        *first = fit::started(first, end);
                    }
                    _ => before.push(Element::line(end, path.start())),
                }
                before.extend(next);
            }
            _ => joined.push(path.elements().to_vec()),
        }
    }
    joined.into_iter().filter_map(Path::new).collect()
}

/// How far apart (mm) discs of `width` mm may be that what stays between two of them and their common
/// tangent is nowhere higher than `scallop` mm.
pub(crate) fn pitch(width: f64, scallop: f64) -> f64 {
    // Half the pitch, and what is left of half the width, are at right angles.
    let scallop = scallop.clamp(0.0, width / 2.0);
    2.0 * (scallop * (width - scallop)).sqrt()
}
