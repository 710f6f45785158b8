//! Entities as elements, in the units of the drawing.

use super::Options;
use super::entity::Entity;
use super::groups::Group;
use super::placement::Placement;
use crate::element::{Element, SAME};
use crate::fit::{Curve, Ellipse, Spline, fit};
use geom::Vec2;
use program::{Diagnostic, Rule};
use std::f64::consts::TAU;

/// The most elements that a curve may come to.
const MOST: usize = 1_000_000;

/// Turns entities into elements.
pub(super) struct Shapes<'a> {
    /// How far ends and heights may differ, and arcs leave curves.
    pub options: &'a Options,
    /// mm in a unit of the drawing.
    pub unit: f64,
}

/// What an entity is.
pub(super) enum Shape {
    /// Elements that hang together.
    Elements(Vec<Element>),
    /// Nothing: it belongs to another entity.
    Nothing,
    /// What is not read.
    Other(String),
}

impl Shapes<'_> {
    /// What an entity is; of a polyline these are the vertices.
    pub fn shape(&self, entity: &Entity, vertices: &[Entity]) -> Result<Shape, Box<Diagnostic>> {
        let flat = |piece: Vec<Element>| -> Result<Shape, Box<Diagnostic>> {
            Ok(Shape::Elements(match entity.behind()? {
                true => piece.iter().map(|e| Placement::behind().element(e)).collect(),
                false => piece,
            }))
        };
        match entity.kind() {
            b"LINE" => {
                entity.level(&[30, 31], self.unit)?;
                Ok(Shape::Elements(vec![Element::line(entity.needed(10)?, entity.needed(11)?)]))
            }
            b"CIRCLE" => {
                let (center, radius) = (entity.needed(10)?, entity.radius()?);
                let start = center + Vec2::X * radius;
                flat(vec![Element::arc(start, start, center, TAU)])
            }
            b"ARC" => {
                let (center, radius) = (entity.needed(10)?, entity.radius()?);
                let from = entity.number(50)?.unwrap_or(0.0).to_radians();
                let to = entity.number(51)?.unwrap_or(0.0).to_radians();
                let sweep = (to - from).rem_euclid(TAU);
                let sweep = if sweep < 1e-9 { TAU } else { sweep };
                let start = center + Vec2::from_angle(from) * radius;
                let end = if sweep == TAU { start } else { center + Vec2::from_angle(to) * radius };
                flat(vec![Element::arc(start, end, center, sweep)])
            }
            b"LWPOLYLINE" => {
                let mut corners: Vec<(Vec2, f64)> = Vec::new();
                for group in entity.groups {
                    match (group.code, corners.last_mut()) {
                        (10, _) => corners.push((Vec2::new(group.number()?, 0.0), 0.0)),
                        (20, Some(corner)) => corner.0.y = group.number()?,
                        (42, Some(corner)) => corner.1 = group.number()?,
                        _ => {}
                    }
                }
                let closed = entity.whole(70)?.is_some_and(|flags| flags & 1 != 0);
                flat(polyline(&corners, closed))
            }
            b"POLYLINE" => match self.old_polyline(entity, vertices)? {
                Some(piece) => flat(piece),
                None => Ok(Shape::Other("POLYLINE that is a mesh".into())),
            },
            b"ELLIPSE" => self.ellipse(entity).map(Shape::Elements),
            b"SPLINE" => self.spline(entity).map(Shape::Elements),
            // The end of a block or a section, and what belongs to an insertion or polyline.
            b"SEQEND" | b"ATTRIB" | b"ENDBLK" | b"ENDSEC" => Ok(Shape::Nothing),
            kind => Ok(Shape::Other(String::from_utf8_lossy(kind).into())),
        }
    }

    /// A polyline with its vertices; none of a mesh.
    fn old_polyline(
        &self,
        entity: &Entity,
        vertices: &[Entity],
    ) -> Result<Option<Vec<Element>>, Box<Diagnostic>> {
        let flags = entity.whole(70)?.unwrap_or(0);
        if flags & (16 | 64) != 0 {
            return Ok(None);
        }
        let mut corners = Vec::with_capacity(vertices.len());
        let mut height = None;
        for vertex in vertices {
            // Of a polyline with a spline the frame is kept as well.
            if vertex.whole(70)?.is_some_and(|flags| flags & 16 != 0) {
                continue;
            }
            let z = vertex.number(30)?.unwrap_or(0.0);
            if (z - *height.get_or_insert(z)).abs() * self.unit > self.options.gap {
                return Err(vertex.slanted());
            }
            corners.push((vertex.needed(10)?, vertex.number(42)?.unwrap_or(0.0)));
        }
        Ok(Some(polyline(&corners, flags & 1 != 0)))
    }

    fn ellipse(&self, entity: &Entity) -> Result<Vec<Element>, Box<Diagnostic>> {
        entity.level(&[31], self.unit)?;
        let (center, major) = (entity.needed(10)?, entity.needed(11)?);
        let ratio = entity.number(40)?.unwrap_or(1.0);
        let radius = major.length() * ratio.abs().min(1.0);
        if !(1e-6..=1.0).contains(&ratio.abs()) || radius * self.unit < SAME {
            let message = format!("an ellipse with axes at a ratio of {ratio}");
            return Err(entity.refused(Rule::DxfEntity, message, "draw a line"));
        }
        let side = if entity.behind()? { -1.0 } else { 1.0 };
        let minor = major.perp() * (side * ratio);
        let from = entity.number(41)?.unwrap_or(0.0);
        let to = entity.number(42)?.unwrap_or(TAU);
        let sweep = (to - from).rem_euclid(TAU);
        let sweep = if sweep < 1e-9 { TAU } else { sweep };
        let curve = Ellipse { center, major, minor };
        let mut piece = Vec::new();
        self.fitted(entity, &curve, from, from + sweep, &mut piece)?;
        close(&mut piece, sweep == TAU);
        Ok(piece)
    }

    fn spline(&self, entity: &Entity) -> Result<Vec<Element>, Box<Diagnostic>> {
        let all = |code| entity.all(code).map(Group::number).collect::<Result<Vec<f64>, _>>();
        let (xs, ys) = (all(10)?, all(20)?);
        entity.level(&[30], self.unit)?;
        let degree = entity.whole(71)?.unwrap_or(3).clamp(0, 1000) as usize;
        if xs.is_empty() && entity.first(11).is_some() {
            let message = "a spline by fit points, without control points";
            return Err(entity.refused(
                Rule::DxfSpline,
                message.into(),
                "save it with control points",
            ));
        }
        if xs.len() != ys.len() {
            let message = "a spline with control points that are not whole";
            return Err(entity.refused(Rule::DxfSpline, message.into(), "save the drawing again"));
        }
        let poles: Vec<Vec2> = xs.into_iter().zip(ys).map(|(x, y)| Vec2::new(x, y)).collect();
        let spline = Spline::new(degree, all(40)?, &poles, &all(41)?)
            .map_err(|what| entity.refused(Rule::DxfSpline, what, "save the drawing again"))?;
        let mut piece = Vec::new();
        for (from, to) in spline.spans() {
            self.fitted(entity, &spline, from, to, &mut piece)?;
        }
        let ends = piece.first().zip(piece.last());
        let closed = ends.is_some_and(|(p, q)| p.start.distance(q.end) * self.unit < 10.0 * SAME);
        for i in 1..piece.len() {
            let end = piece[i - 1].end;
            piece[i] = piece[i].spanning(end, piece[i].end);
        }
        close(&mut piece, closed);
        Ok(piece)
    }

    fn fitted(
        &self,
        entity: &Entity,
        curve: &impl Curve,
        from: f64,
        to: f64,
        piece: &mut Vec<Element>,
    ) -> Result<(), Box<Diagnostic>> {
        let tolerance = self.options.tolerance / self.unit;
        fit(curve, from, to, tolerance, MOST, piece).ok_or_else(|| {
            let message =
                format!("arcs do not follow the curve within {} mm", self.options.tolerance);
            entity.refused(Rule::CurveFit, message, "allow more, or draw it anew")
        })
    }
}

/// Ends a closed piece exactly where it starts.
fn close(piece: &mut [Element], closed: bool) {
    if closed
        && let Some(start) = piece.first().map(|element| element.start)
        && let Some(last) = piece.last_mut()
    {
        *last = last.spanning(last.start, start);
    }
}

/// Lines and arcs between corners, each with the bulge to the next: the tangent of a
/// quarter of the sweep.
fn polyline(corners: &[(Vec2, f64)], closed: bool) -> Vec<Element> {
    let next = corners.iter().cycle().skip(1);
    let count = if closed { corners.len() } else { corners.len().saturating_sub(1) };
    let sides = corners.iter().zip(next).take(count);
    let side = |(&(p, bulge), &(q, _)): (&(Vec2, f64), &(Vec2, f64))| {
        let sweep = 4.0 * bulge.atan();
        let chord = q - p;
        if chord.length() < 1e-12 || chord.length() * sweep.abs() < 1e-9 {
            return Element::line(p, q);
        }
        let center = (p + q) / 2.0 + chord.perp() / (2.0 * (sweep / 2.0).tan());
        Element::arc(p, q, center, sweep)
    };
    sides.map(side).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_bulge_of_one_is_half_a_circle_that_turns_left() {
        let piece = polyline(&[(Vec2::ZERO, 1.0), (Vec2::X * 10.0, 0.0)], false);
        let turn = piece[0].turn.unwrap();
        assert!((turn.sweep - PI).abs() < 1e-12 && turn.center.distance(Vec2::X * 5.0) < 1e-12);
    }
}
