//! Apertures (sections 4.3 and 4.4): what is flashed, and what strokes are drawn with.

use crate::contour::{Contour, Piece};
use crate::decimal::{decimal, whole};
use crate::report::{Outcome, fault};
use crate::stroke::Pen;
use crate::{FAR, Transform};
use geom::Vec2;
use program::Rule;

/// What can be flashed.
#[derive(Clone, Debug, PartialEq)]
pub struct Aperture {
    /// Its number: 10 for `D10`.
    pub number: u32,
    /// What it covers when it is flashed at the origin, mm; nothing where it has no size.
    pub pieces: Vec<Piece>,
    /// What it is as a pen; `None` where it cannot draw strokes.
    pub pen: Option<Pen>,
    /// What it is for (`.AperFunction`), such as `SMDPad,CuDef`.
    pub function: Option<String>,
}

/// An aperture's definition, `%AD`, without the letters: `D10C,0.5X0.2`.
#[derive(Debug, PartialEq)]
pub(super) struct Definition<'a> {
    pub(super) number: u32,
    /// `C`, `R`, `O`, `P`, or the name of a macro.
    pub(super) template: &'a [u8],
    pub(super) values: Vec<f64>,
}

impl<'a> Definition<'a> {
    /// # Errors
    /// `aperture` where it is malformed, or its number is below 10.
    pub(super) fn of(text: &'a [u8]) -> Outcome<Definition<'a>> {
        let odd = || {
            let help = "an aperture is defined by %ADD10C,0.5*%, with numbers from 10 on";
            fault(Rule::Aperture, "not the definition of an aperture", help)
        };
        let rest = text.strip_prefix(b"D").ok_or_else(odd)?;
        let digits = rest.iter().position(|c| !c.is_ascii_digit()).unwrap_or(rest.len());
        let (number, rest) = rest.split_at(digits);
        let number = whole(number).filter(|number| *number >= 10).ok_or_else(odd)?;
        let comma = rest.iter().position(|c| *c == b',').unwrap_or(rest.len());
        let (template, values) = rest.split_at(comma);
        let template = template.trim_ascii();
        if template.is_empty() {
            return Err(odd());
        }
        let values = values.strip_prefix(b",").unwrap_or_default().trim_ascii();
        let values = match values {
            b"" => Vec::new(),
            values => {
                let value = |value: &[u8]| decimal(value.trim_ascii()).ok_or_else(odd);
                values.split(|c| *c == b'X').map(value).collect::<Outcome<Vec<f64>>>()?
            }
        };
        Ok(Definition { number, template, values })
    }

    /// The pieces and the pen of a standard aperture, for a unit of so many mm; `None` where the template
    /// is a macro.
    ///
    /// # Errors
    /// `aperture` where the values are not those of the template.
    pub(super) fn standard(&self, unit: f64) -> Outcome<Option<(Vec<Piece>, Option<Pen>)>> {
        let (sizes, most) = match self.template {
            b"C" => (1, 3),
            b"R" | b"O" => (2, 4),
            b"P" => (1, 5),
            _ => return Ok(None),
        };
        let name = String::from_utf8_lossy(self.template);
        let count = self.values.len();
        if count < sizes || count > most || (self.template == b"P" && count < 2) {
            let help = "see section 4.4 of the Gerber specification";
            return Err(fault(
                Rule::Aperture,
                format!("{name} does not take {count} values"),
                help,
            ));
        }
        let value = |index: usize| self.values.get(index).copied();
        let size = Vec2::new(value(0).unwrap_or(0.0), value(sizes - 1).unwrap_or(0.0)) * unit;
        // Only a circle may have no size (section 4.3.2).
        let least = size.min_element();
        if least < 0.0 || size.max_element() > FAR || (least == 0.0 && self.template != b"C") {
            let message = format!("{name} of {:.4} by {:.4} mm", size.x, size.y);
            let help = "sizes are greater than 0; only a circle may be 0";
            return Err(fault(Rule::Aperture, message, help));
        }
        let (outline, first_hole) = match self.template {
            b"C" => (Contour::circle(Vec2::ZERO, size.x / 2.0), 1),
            b"R" => (Contour::rectangle(-size / 2.0, size / 2.0), 2),
            b"O" => {
                let straight = (size - Vec2::splat(least)) / 2.0;
                (Contour::stadium(-straight, straight, least / 2.0), 2)
            }
            _ => {
                let corners = value(1).filter(|n| n.fract() == 0.0 && (3.0..=12.0).contains(n));
                let corners = corners.ok_or_else(|| {
                    let message = format!("a polygon of {} corners", value(1).unwrap_or(0.0));
                    fault(Rule::Aperture, message, "it has 3 to 12")
                })?;
                let turned = Transform::new(false, value(2).unwrap_or(0.0), 1.0);
                let polygon = Contour::regular(Vec2::ZERO, size.x / 2.0, corners as u32, 0.0);
                (polygon.placed(&turned, Vec2::ZERO), 3)
            }
        };
        let mut pieces = Vec::new();
        if least > 0.0 {
            pieces.push(Piece::new(true, outline));
        }
        if let Some(x) = value(first_hole) {
            let y = value(first_hole + 1);
            let hole = Vec2::new(x, y.unwrap_or(x)) * unit;
            if hole.min_element() < 0.0 || hole.max_element() > FAR {
                let message = format!("a hole of {:.4} by {:.4} mm", hole.x, hole.y);
                return Err(fault(Rule::Aperture, message, "sizes of holes are 0 or greater"));
            }
            // A rectangular hole is deprecated (section 8.2.2), a round one of no size is none.
            if hole.min_element() > 0.0 && least > 0.0 {
                let hole = match y {
                    Some(_) => Contour::rectangle(-hole / 2.0, hole / 2.0),
                    None => Contour::circle(Vec2::ZERO, hole.x / 2.0),
                };
                pieces.push(Piece::new(false, hole));
            }
        }
        let pen = match self.template {
            _ if pieces.len() > 1 => None,
            b"C" => Some(Pen::Round(size.x)),
            b"R" => Some(Pen::Rectangle(size)),
            _ => None,
        };
        Ok(Some((pieces, pen)))
    }
}
