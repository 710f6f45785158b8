//! Where the wire goes: its lower end, and its upper end where it leans.

use crate::contour::{Contour, ContourPoint};
use program::{Diagnostic, Rule};
use sketch::{Element, SAME};

/// The path of the wire. Where it leans, each element of the lower contour has its element of the
/// upper one, and both ends run through them evenly at the same time: the cut is the ruled surface
/// between the two.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    lower: Contour,
    upper: Option<Contour>,
}

/// What the machine can lean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The greatest U and V either way, mm.
    pub uv: f64,
    /// The greatest angle of the wire from upright, radians.
    pub angle: f64,
}

impl Path {
    /// An upright wire.
    pub fn upright(contour: Contour) -> Path {
        Path { lower: contour, upper: None }
    }

    /// An upper contour with as many elements as the lower one.
    pub(crate) fn leaning(lower: Contour, upper: Contour) -> Path {
        Path { lower, upper: Some(upper) }
    }

    /// The same, to whose start this line of the source brings the wire.
    #[must_use]
    pub fn starting_by(self, line: u32) -> Path {
        Path { lower: self.lower.starting_by(line), ..self }
    }

    /// Where the lower end goes.
    pub fn lower(&self) -> &Contour {
        &self.lower
    }

    /// Where the upper end goes, if not above the lower one.
    pub fn upper(&self) -> Option<&Contour> {
        self.upper.as_ref()
    }

    /// The elements in pairs; those of an upright wire each with itself.
    pub fn elements(&self) -> impl Iterator<Item = (&Element, &Element)> {
        let upper = self.upper.as_ref().unwrap_or(&self.lower);
        self.lower.elements().iter().zip(upper.elements())
    }

    /// The elements in pairs from `from` to `to`, points of the lower contour.
    pub(crate) fn between(
        &self,
        from: &ContourPoint,
        to: &ContourPoint,
    ) -> Vec<(Element, Element)> {
        let upper = self.upper.as_ref().unwrap_or(&self.lower);
        let part = |(i, start, end): (usize, f64, f64)| {
            let (below, above) = (self.lower.elements().get(i)?, upper.elements().get(i)?);
            Some((below.part(start, end), above.part(start, end)))
        };
        from.up_to(to).filter_map(part).collect()
    }

    /// How far the faster end travels, mm: what the cutting time goes by.
    pub fn length(&self) -> f64 {
        self.elements().map(|(below, above)| below.length().max(above.length())).sum()
    }

    /// The same, travelled the other way.
    pub fn reversed(&self) -> Path {
        Path { lower: self.lower.reversed(), upper: self.upper.as_ref().map(Contour::reversed) }
    }

    /// Whether the machine can lean the wire so, over a height of `height` mm.
    ///
    /// # Errors
    /// `taper-limit` at the first element that needs more.
    pub fn within(&self, limits: &Limits, height: f64) -> Result<(), Box<Diagnostic>> {
        if self.upper.is_none() {
            return Ok(());
        }
        if height.is_nan() || height <= 0.0 {
            let message = format!("a leaning wire and a part height of {height} mm");
            return Err(Diagnostic::error(Rule::PartHeight, message)
                .help("give the height between the lower and the upper contour")
                .into());
        }
        for (below, above) in self.elements() {
            // Between lines the lean changes evenly. What arcs do between so many places is less than
            // 0.0013 of it.
            let places = if below.turn.or(above.turn).is_some() { 64 } else { 1 };
            for t in (0..=places).map(|i| f64::from(i) / f64::from(places)) {
                let lean = above.at(t) - below.at(t);
                let angle = (lean.length() / height).atan();
                let place = below.at(t);
                let message = if lean.abs().max_element() > limits.uv + SAME {
                    format!(
                        "U{:.4} V{:.4} at X{:.4} Y{:.4}, and the machine has ±{} mm",
                        lean.x, lean.y, place.x, place.y, limits.uv
                    )
                } else if angle > limits.angle + geom::ANGLE_EPSILON {
                    format!(
                        "the wire leans by {:.3}° at X{:.4} Y{:.4}, and the machine by {:.3}°",
                        angle.to_degrees(),
                        place.x,
                        place.y,
                        limits.angle.to_degrees()
                    )
                } else {
                    continue;
                };
                return Err(Diagnostic::error(Rule::TaperLimit, message)
                    .help("lean less, or take a machine that leans more")
                    .line(below.line)
                    .into());
            }
        }
        Ok(())
    }
}
