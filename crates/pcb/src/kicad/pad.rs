//! Pads: the shapes of their copper, their drills, and which layers they are on.

use super::frame::Frame;
use super::graphic::{Graphic, joined};
use super::layer::Layers;
use super::tree::{Node, Outcome};
use crate::board::Shape;
use crate::contour::{Contour, Piece};
use crate::{Hole, HoleShape};
use geom::{Element, Vec2};
use program::Rule;
use std::f64::consts::FRAC_PI_2;

/// A pad in its own frame.
pub(super) struct Pad {
    /// Its copper on the front; empty where it has none there.
    pub(super) front: Vec<Shape>,
    /// The same on the back.
    pub(super) back: Vec<Shape>,
    /// Its hole.
    pub(super) hole: Option<Hole>,
}

impl Pad {
    /// The pad that `(pad NUMBER KIND SHAPE …)` describes.
    pub(super) fn of(item: Node) -> Outcome<Pad> {
        let word = |index| item.item(index).map_or(&b""[..], |word| word.word());
        let (kind, shape) = (word(1), word(2));
        let plated = match kind {
            b"thru_hole" => Some(true),
            b"np_thru_hole" => Some(false),
            b"smd" | b"connect" => None,
            other => {
                let message = format!("a pad of the kind \"{}\"", String::from_utf8_lossy(other));
                let help = "the kinds are thru_hole, np_thru_hole, smd and connect";
                return Err(item.fault(Rule::Pad, message, help));
            }
        };
        let size = item.need("size")?.size()?;
        let drill = item.find("drill");
        // The others have none, whatever stands there.
        let hole = match plated {
            Some(plated) => Some(hole(item.need("drill")?, plated)?),
            None => None,
        };
        let layers = copper(item, plated == Some(true))?;
        // The offset is that of the copper, though it stands with the drill.
        let offset = offset(drill)?;
        let bare =
            plated == Some(false) && offset == Vec2::ZERO && is_hole_only(shape, size, drill)?;
        if bare || !layers.outer() {
            return Ok(Pad { front: Vec::new(), back: Vec::new(), hole });
        }
        let front = outline(item, shape, size, offset)?;
        let back = match back_of_stack(item) {
            Some(layer) => {
                let shape = layer.need("shape")?.item(0).map_or(&b""[..], |shape| shape.word());
                outline(layer, shape, layer.need("size")?.size()?, self::offset(Some(layer))?)?
            }
            None => front.clone(),
        };
        let on = |side: bool, shapes| if side { shapes } else { Vec::new() };
        Ok(Pad { front: on(layers.front, front), back: on(layers.back, back), hole })
    }
}

/// The `(offset X Y)` of a list, if there is one.
fn offset(list: Option<Node>) -> Outcome<Vec2> {
    list.and_then(|list| list.find("offset")).map_or(Ok(Vec2::ZERO), Node::point)
}

/// What a pad or a via has on the back where that differs from the front (KiCad 9).
pub(super) fn back_of_stack(item: Node) -> Option<Node> {
    let mut layers = item.find("padstack")?.all("layer");
    layers.find(|layer| layer.item(0).is_some_and(|name| name.word() == b"B.Cu"))
}

/// The layers on which a pad or via has copper.
///
/// # Errors
/// `unused-layers` where that depends on what is connected to it.
pub(super) fn copper(item: Node, drilled: bool) -> Outcome<Layers> {
    if drilled && item.says("remove_unused_layers") && !item.says("keep_end_layers") {
        let connected = item.find("zone_layer_connections");
        let zones: Vec<&[u8]> =
            connected.into_iter().flat_map(Node::items).map(|name| name.word()).collect();
        if !(zones.contains(&&b"F.Cu"[..]) && zones.contains(&&b"B.Cu"[..])) {
            let message = "its annular rings are on connected layers only, and the file does not say which these are";
            let help = "in KiCad, set its annular rings to \"All copper layers\", or to \
                \"Start, end, and connected layers\"";
            return Err(item.fault(Rule::UnusedLayers, message, help));
        }
    }
    Ok(Layers::of(item))
}

/// The hole that `(drill [oval] WIDTH [HEIGHT] [(offset X Y)])` describes.
fn hole(drill: Node, plated: bool) -> Outcome<Hole> {
    let size = drill_size(drill)?.unwrap_or_default();
    let diameter = size.min_element();
    if diameter <= 0.0 {
        let message = format!("a drill of {} by {} mm", size.x, size.y);
        return Err(drill.fault(Rule::Drill, message, "drills have a diameter above 0"));
    }
    let half = (size - Vec2::splat(diameter)) / 2.0;
    let shape = match half == Vec2::ZERO {
        true => HoleShape::Round(Vec2::ZERO),
        false => HoleShape::Slot(-half, half),
    };
    Ok(Hole { shape, diameter, plated: Some(plated) })
}

/// Width and height of a drill; `None` where it has an offset only.
fn drill_size(drill: Node) -> Outcome<Option<Vec2>> {
    let oval = drill.item(0).is_some_and(|word| word.word() == b"oval");
    let first = usize::from(oval);
    let is_number = |index| drill.item(index).is_some_and(|item| !item.is_list());
    if !is_number(first) {
        return Ok(None);
    }
    let width = drill.length(first)?;
    let height = if oval && is_number(first + 1) { drill.length(first + 1)? } else { width };
    Ok(Some(Vec2::new(width, height)))
}

/// Whether nothing of a round pad is left around its hole: KiCad has no copper there.
fn is_hole_only(shape: &[u8], size: Vec2, drill: Option<Node>) -> Outcome<bool> {
    let Some(drill) = drill.map(drill_size).transpose()?.flatten() else { return Ok(false) };
    Ok(matches!(shape, b"circle" | b"oval") && size.cmple(drill).all())
}

/// The outline of a pad, or of one layer of it, about its hole.
fn outline(item: Node, shape: &[u8], size: Vec2, offset: Vec2) -> Outcome<Vec<Shape>> {
    if size.min_element() <= 0.0 {
        let message = format!("a pad of {} by {} mm", size.x, size.y);
        return Err(item.fault(Rule::Pad, message, "pads have a width and a height above 0"));
    }
    let half = size / 2.0;
    let one = |contour| vec![solid(contour)];
    Ok(match shape {
        b"circle" => one(Contour::circle(offset, half.x)),
        b"rect" => one(Contour::rectangle(offset - half, offset + half)),
        b"oval" => {
            let radius = half.min_element();
            let end = half - Vec2::splat(radius);
            one(Contour::stadium(offset - end, offset + end, radius))
        }
        b"trapezoid" => one(trapezoid(item, half, offset)?),
        b"roundrect" => one(rounded(item, half, offset)?),
        b"custom" => custom(item, half, offset)?,
        other => {
            let message = format!("a pad of the shape \"{}\"", String::from_utf8_lossy(other));
            let help = "the shapes are circle, rect, oval, trapezoid, roundrect and custom";
            return Err(item.fault(Rule::Pad, message, help));
        }
    })
}

/// `(rect_delta DX DY)`: DX is by how much the left side is longer than the right one, DY the lower one
/// than the upper one.
fn trapezoid(item: Node, half: Vec2, offset: Vec2) -> Outcome<Contour> {
    let delta = match item.find("rect_delta") {
        Some(delta) => Vec2::new(delta.number(0)?, delta.number(1)?) / 2.0,
        None => Vec2::ZERO,
    };
    if delta.x.abs() > half.y || delta.y.abs() > half.x {
        let message = format!("sides that differ by {} and {} mm", delta.x * 2.0, delta.y * 2.0);
        return Err(item.fault(Rule::Pad, message, "no side differs by more than its length"));
    }
    let corner =
        |x: f64, y: f64| offset + Vec2::new(x * (half.x - y * delta.y), y * (half.y - x * delta.x));
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    Ok(Contour::polygon(&corners))
}

/// A rectangle whose corners are rounded or cut off.
fn rounded(item: Node, half: Vec2, offset: Vec2) -> Outcome<Contour> {
    let ratio = |name: &str| -> Outcome<f64> {
        let Some(list) = item.find(name) else { return Ok(0.0) };
        let ratio = list.number(0)?;
        if !(0.0..=0.5).contains(&ratio) {
            let message = format!("{name} is {ratio}");
            return Err(list.fault(Rule::Pad, message, "of the shorter side it is 0 to 0.5"));
        }
        Ok(ratio)
    };
    let shorter = 2.0 * half.min_element();
    let (radius, chamfer) =
        (ratio("roundrect_rratio")? * shorter, ratio("chamfer_ratio")? * shorter);
    let chamfered = item.find("chamfer");
    let corners = [
        ("top_right", Vec2::new(1.0, 1.0), Vec2::Y),
        ("top_left", Vec2::new(-1.0, 1.0), Vec2::NEG_X),
        ("bottom_left", Vec2::new(-1.0, -1.0), Vec2::NEG_Y),
        ("bottom_right", Vec2::new(1.0, -1.0), Vec2::X),
    ];
    let parts = corners.map(|(name, side, along)| {
        let cut = chamfered.is_some_and(|list| list.says(name));
        let size = if cut { chamfer } else { radius };
        let corner = offset + half * side;
        let (enter, leave) = (corner - along * size, corner + along.perp() * size);
        match cut || size == 0.0 {
            true => Element::line(enter, leave),
            false => Element::arc(enter, leave, enter + along.perp() * size, FRAC_PI_2),
        }
    });
    Ok(Contour::new(joined(&parts)))
}

/// The anchor, and what is drawn to it.
fn custom(item: Node, half: Vec2, offset: Vec2) -> Outcome<Vec<Shape>> {
    let anchor = item.find("options").and_then(|options| options.find("anchor"));
    let anchor = match anchor.and_then(|anchor| anchor.item(0)).map(|word| word.word()) {
        Some(b"rect") => Contour::rectangle(offset - half, offset + half),
        None | Some(b"circle") => Contour::circle(offset, half.x),
        Some(other) => {
            let message = format!("an anchor of the shape \"{}\"", String::from_utf8_lossy(other));
            return Err(item.fault(Rule::Pad, message, "the anchors are circle and rect"));
        }
    };
    let frame = Frame::moved(offset);
    let mut shapes = vec![solid(anchor)];
    for primitive in item.find("primitives").into_iter().flat_map(Node::items) {
        match Graphic::of(primitive)? {
            Some(graphic) => {
                shapes.extend(graphic.shapes(primitive)?.iter().map(|shape| frame.shape(shape)));
            }
            // Where the number is shown, and where spokes go: no copper.
            None if matches!(primitive.name(), b"gr_bbox" | b"gr_vector") => {}
            None => {
                let name = String::from_utf8_lossy(primitive.name()).into_owned();
                let help =
                    "pads are drawn with lines, arcs, circles, rectangles, polygons and curves";
                return Err(primitive.fault(Rule::Pad, format!("\"{name}\" in a pad"), help));
            }
        }
    }
    Ok(shapes)
}

fn solid(contour: Contour) -> Shape {
    Shape::Pieces(vec![Piece::new(true, contour)])
}
