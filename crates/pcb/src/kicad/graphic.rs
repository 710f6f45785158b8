//! Lines, arcs, circles, rectangles, polygons and curves, on layers and in pads.

use super::curve;
use super::tree::{Node, Outcome};
use crate::Transform;
use crate::arc;
use crate::board::Shape;
use crate::contour::{Contour, Piece};
use geom::region::{Fill, Island, Region, Ring};
use geom::{Element, Vec2};
use program::Rule;
use std::f64::consts::TAU;

/// An arc of a larger radius is taken as a line, where that is within [`FLAT`], mm.
const MAX_RADIUS: f64 = 50_000.0;

/// How far a line may be from such an arc, mm.
const FLAT: f64 = 0.5e-3;

/// Something that is drawn: lines and arcs, each of which starts where the one before ends.
pub(super) struct Graphic {
    pub(super) elements: Vec<Element>,
    /// Width of the pen, mm; 0 where only the area counts.
    width: f64,
    /// Whether the area within is filled.
    filled: bool,
}

impl Graphic {
    /// What `gr_line`, `fp_line` and their like draw; `None` where it is no such item.
    pub(super) fn of(item: Node) -> Outcome<Option<Graphic>> {
        let name = item.name();
        let Some(kind) = name.strip_prefix(b"gr_").or(name.strip_prefix(b"fp_")) else {
            return Ok(None);
        };
        let elements = match kind {
            b"line" => {
                vec![Element::line(item.need("start")?.point()?, item.need("end")?.point()?)]
            }
            b"arc" => vec![arc(item)?],
            b"circle" => {
                let (center, on) = (item.need("center")?.point()?, item.need("end")?.point()?);
                vec![Element::arc(on, on, center, TAU)]
            }
            b"rect" => {
                let (a, b) = (item.need("start")?.point()?, item.need("end")?.point()?);
                Contour::rectangle(a.min(b), a.max(b)).elements().to_vec()
            }
            b"poly" => chain(item.need("pts")?)?,
            b"curve" => {
                let points: Vec<Vec2> =
                    item.need("pts")?.all("xy").map(Node::point).collect::<Outcome<_>>()?;
                let [a, b, c, d] = points[..] else {
                    let message = format!("a curve of {} points", points.len());
                    return Err(item.fault(Rule::Curve, message, "a Bézier curve has four"));
                };
                curve::elements([a, b, c, d])
            }
            _ => return Ok(None),
        };
        // Before KiCad 7 the width stood alone; in pads it still does.
        let width = match item.find("stroke").unwrap_or(item).find("width") {
            Some(width) => width.length(0)?,
            None => 0.0,
        };
        let fill = item.find("fill").and_then(|fill| fill.item(0));
        let filled = match fill.map(|fill| fill.word()) {
            // KiCad 5 had no word for it: polygons were filled, circles and rectangles without a width too.
            None => kind == b"poly" || width == 0.0,
            Some(b"no" | b"none") => false,
            Some(b"yes" | b"solid") => true,
            Some(other) => {
                let message = format!("the filling \"{}\"", String::from_utf8_lossy(other));
                return Err(item.fault(Rule::Fill, message, "shapes are filled or not: yes or no"));
            }
        };
        let area = matches!(kind, b"circle" | b"rect" | b"poly");
        Ok(Some(Graphic { elements, width, filled: filled && area }))
    }

    /// What it covers.
    pub(super) fn shapes(&self, item: Node) -> Outcome<Vec<Shape>> {
        let mut shapes: Vec<Shape> = match self.width > 0.0 {
            true => self.elements.iter().map(|path| Shape::Stroke(*path, self.width)).collect(),
            false => Vec::new(),
        };
        if self.filled && !self.elements.is_empty() {
            // Polygons may cross themselves.
            let within = Ring::new(self.elements.clone())
                .and_then(|ring| Region::inside([&ring], Fill::NonZero))
                .map_err(|e| item.fault(Rule::Shape, e.to_string(), "draw it again in KiCad"))?;
            // One shape for each piece: a shape is named by one place in it.
            shapes.extend(within.islands().iter().map(|island| Shape::Pieces(vec![piece(island)])));
        }
        Ok(shapes)
    }
}

fn piece(island: &Island) -> Piece {
    let rings = std::iter::once(island.outer()).chain(island.holes());
    let contours = rings.map(|ring| Contour::new(ring.elements().to_vec())).collect();
    Piece { solid: true, contours }
}

/// An arc: from `start` over `mid` to `end`; in boards up to 20210925 about `start` from `end` through
/// `angle`, which counts clockwise.
pub(super) fn arc(item: Node) -> Outcome<Element> {
    let (start, end) = (item.need("start")?.point()?, item.need("end")?.point()?);
    let Some(mid) = item.find("mid") else {
        let angle = -item.need("angle")?.number(0)?;
        if angle.abs() > 360.0 {
            let message = format!("an arc of {angle}°");
            return Err(item.fault(Rule::Arc, message, "arcs turn up to 360°"));
        }
        let stop = start + Transform::new(false, angle, 1.0).apply(end - start);
        let stop = if angle.abs() == 360.0 { end } else { stop };
        return Ok(Element::arc(end, stop, start, angle.to_radians()));
    };
    let mid = mid.point()?;
    let arc = arc::through(start, mid, end);
    match arc.radius() {
        Some(radius) if radius > MAX_RADIUS => {
            let line = Element::line(start, end);
            if line.nearest(mid).1 > FLAT {
                let message = format!("an arc with a radius of {radius:.0} mm");
                let help = format!("radii up to {MAX_RADIUS} mm are read: draw it with lines");
                return Err(item.fault(Rule::Arc, message, &help));
            }
            Ok(line)
        }
        _ => Ok(arc),
    }
}

/// The closed chain through the points and arcs of `(pts …)`; empty where that is a single point.
pub(super) fn chain(pts: Node) -> Outcome<Vec<Element>> {
    let part = |item: Node| match item.name() {
        b"xy" => item.point().map(|point| Element::line(point, point)),
        b"arc" => arc(item),
        other => {
            let message = format!("\"{}\" in an outline", String::from_utf8_lossy(other));
            Err(item.fault(Rule::Outline, message, "outlines have points and arcs"))
        }
    };
    Ok(joined(&pts.items().map(part).collect::<Outcome<Vec<Element>>>()?))
}

/// The closed chain of these parts, with lines from each to the next. A line without length is a point.
pub(super) fn joined(parts: &[Element]) -> Vec<Element> {
    let mut elements = Vec::with_capacity(parts.len());
    for (part, next) in parts.iter().zip(parts.iter().cycle().skip(1)) {
        let link = Element::line(part.end, next.start);
        let whole = |element: &Element| element.turn.is_some() || element.start != element.end;
        elements.extend([*part, link].into_iter().filter(whole));
    }
    elements
}

#[cfg(test)]
mod tests {
    use super::super::tree::Tree;
    use super::*;
    use crate::Copper;
    use std::f64::consts::PI;

    fn graphic(text: &str) -> Graphic {
        let tree = Tree::new(text.as_bytes()).ok().unwrap();
        Graphic::of(tree.root()).ok().flatten().unwrap()
    }

    fn area(text: &str) -> f64 {
        let tree = Tree::new(text.as_bytes()).ok().unwrap();
        let shapes = graphic(text).shapes(tree.root()).ok().unwrap();
        let shapes: Vec<_> = shapes.into_iter().map(|shape| (shape, None)).collect();
        Copper::of_shapes(&shapes).unwrap().0.region.area()
    }

    #[test]
    fn an_old_arc_turns_clockwise_about_its_start() {
        // On the screen, where Y points down, from the right over below to the left.
        let old = &graphic("(fp_arc (start 1 2) (end 4 2) (angle 180) (width 0.1))").elements[0];
        let new = &graphic("(gr_arc (start 4 2) (mid 1 5) (end -2 2) (width 0.1))").elements[0];
        let (a, b) = (old.turn.unwrap(), new.turn.unwrap());
        assert!(old.end.distance(new.end) < 1e-12 && a.center.distance(b.center) < 1e-12);
        assert!((a.sweep + PI).abs() < 1e-12 && (b.sweep + PI).abs() < 1e-12);
    }

    #[test]
    fn what_strokes_and_fillings_cover() {
        let near = |text: &str, expected: f64| {
            let area = area(text);
            assert!((area - expected).abs() < 1e-3, "{text}: {area}");
        };
        near("(gr_line (start 0 0) (end 10 0) (width 1))", 10.0 + PI / 4.0);
        near("(gr_line (start 0 0) (end 10 0) (stroke (width 1) (type solid)))", 10.0 + PI / 4.0);
        near(
            "(gr_circle (center 0 0) (end 3 0) (stroke (width 2) (type solid)) (fill yes))",
            16.0 * PI,
        );
        near("(gr_circle (center 0 0) (end 3 0) (width 2) (fill none))", 12.0 * PI);
        near("(fp_rect (start 4 3) (end 0 0) (width 0) (fill solid))", 12.0);
        near(
            "(fp_rect (start 4 3) (end 0 0) (stroke (width 1) (type default)) (fill no))",
            14.0 - (4.0 - PI) / 4.0,
        );
        // Two triangles of 1 mm² that touch in a point.
        near("(gr_poly (pts (xy 0 0) (xy 2 2) (xy 2 0) (xy 0 2)) (width 0) (fill yes))", 2.0);
        // A square of 2 mm with half a disc upon it.
        let arched = "(gr_poly (pts (xy 2 0) (xy 2 2) (xy 0 2) (arc (start 0 0) (mid 1 -1) (end 2 0))) (width 0) (fill yes))";
        near(arched, 4.0 + PI / 2.0);
        near("(gr_poly (pts (xy 0 0) (xy 2 2) (xy 2 0)) (width 0) (fill none))", 0.0);
        // As KiCad 6 and later take what KiCad 5 has written (PCB_PARSER::parsePCB_SHAPE, no "fill").
        near("(fp_poly (pts (xy 0 0) (xy 2 2) (xy 2 0)) (layer F.Cu) (width 0))", 2.0);
        near("(gr_circle (center 0 0) (end 3 0) (layer F.Cu) (width 0))", 9.0 * PI);
        near("(gr_circle (center 0 0) (end 3 0) (layer F.Cu) (width 2))", 12.0 * PI);
    }
}
