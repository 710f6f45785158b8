//! The primitives of aperture macros (section 4.5.1), in the unit of the file.

use super::region::MARGIN;
use crate::contour::{Contour, Piece};
use crate::crossing::self_crossing;
use crate::report::{Outcome, fault};
use crate::{SAME, Transform};
use geom::{Element, Vec2};
use program::Rule;

/// The pieces of primitive `code` with these values, for a unit of so many mm.
///
/// # Errors
/// `macro-primitive` for one that is not known, or whose values are not what it takes.
pub(super) fn pieces(code: u32, values: &[f64], unit: f64) -> Outcome<Vec<Piece>> {
    let values = Values { code, values };
    let (drawn, rotation) = match code {
        1 => {
            let (diameter, center) = (values.length(1)?, values.point(2)?);
            let rotation = if values.values.len() > 4 { values.number(4)? } else { 0.0 };
            (values.exposed(diameter, Contour::circle(center, diameter / 2.0))?, rotation)
        }
        2 | 20 => {
            let (width, start, end) = (values.length(1)?, values.point(2)?, values.point(4)?);
            let across = (end - start).perp().normalize_or_zero() * width / 2.0;
            let outline =
                Contour::polygon(&[start - across, end - across, end + across, start + across]);
            (values.exposed(width * start.distance(end), outline)?, values.number(6)?)
        }
        21 | 22 => {
            let (size, place) = (Vec2::new(values.length(1)?, values.length(2)?), values.point(3)?);
            let low = if code == 21 { place - size / 2.0 } else { place };
            let outline = Contour::rectangle(low, low + size);
            (values.exposed(size.x * size.y, outline)?, values.number(5)?)
        }
        4 => outline(&values, MARGIN / unit)?,
        5 => {
            let (corners, center) = (values.count(1, 3, 12)?, values.point(2)?);
            let diameter = values.length(4)?;
            let outline = Contour::regular(center, diameter / 2.0, corners, 0.0);
            (values.exposed(diameter, outline)?, values.number(5)?)
        }
        6 => (moire(&values)?, values.number(8)?),
        7 => (thermal(&values)?, values.number(5)?),
        _ => {
            let help = "the primitives are 1, 4, 5, 7, 20 and 21, and the old ones 2, 6 and 22";
            return Err(fault(Rule::MacroPrimitive, format!("there is no primitive {code}"), help));
        }
    };
    // The macro, not the primitive, is what it turns about (section 4.5.3).
    let turned = Transform::new(false, rotation, unit);
    Ok(drawn.iter().map(|piece| piece.placed(&turned, Vec2::ZERO)).collect())
}

/// The values behind the code of a primitive.
struct Values<'a> {
    code: u32,
    values: &'a [f64],
}

impl Values<'_> {
    fn number(&self, index: usize) -> Outcome<f64> {
        self.values
            .get(index)
            .copied()
            .ok_or_else(|| self.odd(format!("has no value {}", index + 1)))
    }

    fn length(&self, index: usize) -> Outcome<f64> {
        match self.number(index)? {
            value if value >= 0.0 => Ok(value),
            value => Err(self.odd(format!("value {} is {value}, a length below 0", index + 1))),
        }
    }

    fn point(&self, index: usize) -> Outcome<Vec2> {
        Ok(Vec2::new(self.number(index)?, self.number(index + 1)?))
    }

    fn count(&self, index: usize, least: u32, most: u32) -> Outcome<u32> {
        let value = self.number(index)?;
        if value.fract() != 0.0 || value < f64::from(least) || value > f64::from(most) {
            let message =
                format!("value {} is {value}, not a whole number {least} to {most}", index + 1);
            return Err(self.odd(message));
        }
        Ok(value as u32)
    }

    /// The piece with this outline, as the first value exposes it; none without a `size`.
    fn exposed(&self, size: f64, outline: Contour) -> Outcome<Vec<Piece>> {
        let solid = match self.number(0)? {
            0.0 => false,
            1.0 => true,
            value => return Err(self.odd(format!("has exposure {value}, neither 0 nor 1"))),
        };
        Ok((size > 0.0).then(|| Piece::new(solid, outline)).into_iter().collect())
    }

    #[cold]
    fn odd(&self, what: String) -> crate::report::Fault {
        let help = "see section 4.5.1 of the Gerber specification";
        fault(Rule::MacroPrimitive, format!("primitive {} {what}", self.code), help)
    }
}

fn outline(values: &Values, margin: f64) -> Outcome<(Vec<Piece>, f64)> {
    let corners = values.count(1, 3, u32::MAX / 4)? as usize;
    if values.values.len() < 2 * corners + 5 {
        let given = values.values.len();
        return Err(values
            .odd(format!("has {given} values, not the {} of {corners} corners", 2 * corners + 5)));
    }
    let points: Vec<Vec2> =
        (0..=corners).map(|i| values.point(2 + 2 * i)).collect::<Outcome<Vec<Vec2>>>()?;
    let rotation = values.number(2 * corners + 4)?;
    let (Some((last, points)), Some(first)) = (points.split_last(), points.first()) else {
        return Ok((Vec::new(), rotation));
    };
    // Corners that are computed may differ by rounding.
    if first.distance(*last) > SAME {
        return Err(values.odd(format!(
            "is not closed: it starts at {}, {} and ends at {}, {}",
            first.x, first.y, last.x, last.y
        )));
    }
    let contour = Contour::polygon(points);
    if let Some(place) = self_crossing(contour.elements(), margin)? {
        return Err(values.odd(format!("crosses itself near {:.4}, {:.4}", place.x, place.y)));
    }
    Ok((values.exposed(1.0, contour.counter_clockwise())?, rotation))
}

/// Rings about one centre under a cross (as in revision 2020.09, section 4.5.1.8, which deprecated it).
fn moire(values: &Values) -> Outcome<Vec<Piece>> {
    let center = values.point(0)?;
    let (mut outer, thickness, gap) =
        (values.length(2)? / 2.0, values.length(3)?, values.length(4)?);
    let rings = values.count(5, 0, 10_000)?;
    let (width, length) = (values.length(6)?, values.length(7)?);
    let mut pieces = Vec::new();
    for _ in 0..rings {
        if outer <= 0.0 || thickness <= 0.0 {
            break;
        }
        let inner = outer - thickness;
        let hole = (inner > 0.0).then(|| Contour::circle(center, inner).reversed());
        let contours = [Contour::circle(center, outer)].into_iter().chain(hole).collect();
        pieces.push(Piece { solid: true, contours });
        outer = inner - gap;
    }
    if width > 0.0 && length > 0.0 {
        for size in [Vec2::new(length, width), Vec2::new(width, length)] {
            let bar = Contour::rectangle(center - size / 2.0, center + size / 2.0);
            pieces.push(Piece::new(true, bar));
        }
    }
    Ok(pieces)
}

/// A ring in four parts (section 4.5.1.8).
fn thermal(values: &Values) -> Outcome<Vec<Piece>> {
    let center = values.point(0)?;
    let (outer, inner, gap) =
        (values.length(2)? / 2.0, values.length(3)? / 2.0, values.length(4)? / 2.0);
    if inner >= outer || gap * 2f64.sqrt() >= outer {
        let what = "needs an outer diameter above the inner one, and above the gap times √2";
        return Err(values.odd(what.into()));
    }
    let far = (outer * outer - gap * gap).sqrt();
    let (a, b) = (Vec2::new(far, gap), Vec2::new(gap, far));
    let turned = |from: Vec2, to: Vec2| from.angle_to(to);
    let mut quarter = vec![Element::arc(a, b, Vec2::ZERO, turned(a, b))];
    // A wide gap leaves nothing of the inner circle.
    if gap * 2f64.sqrt() >= inner {
        let corner = Vec2::splat(gap);
        quarter.extend([Element::line(b, corner), Element::line(corner, a)]);
    } else {
        let near = (inner * inner - gap * gap).sqrt();
        let (c, d) = (Vec2::new(gap, near), Vec2::new(near, gap));
        quarter.extend([
            Element::line(b, c),
            Element::arc(c, d, Vec2::ZERO, turned(c, d)),
            Element::line(d, a),
        ]);
    }
    let quarter = Contour::new(quarter);
    let turn = |i: u32| {
        let turned = Transform::new(false, f64::from(i) * 90.0, 1.0);
        Piece::new(true, quarter.placed(&turned, center))
    };
    Ok((0..4).map(turn).collect())
}
