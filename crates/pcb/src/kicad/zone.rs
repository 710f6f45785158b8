//! Zones: their stored fill.

use super::graphic::chain;
use super::layer::Layers;
use super::tree::{Node, Outcome};
use crate::board::Shape;
use crate::contour::{Contour, Piece};
use program::Rule;

/// A zone.
pub(super) struct Zone {
    /// What its fill covers, and on which layers.
    pub(super) fills: Vec<(Layers, Shape)>,
    /// Whether it is to be filled on a layer that is used here, and is not.
    pub(super) hollow: bool,
}

impl Zone {
    /// The zone that `(zone …)` describes.
    pub(super) fn of(item: Node) -> Outcome<Zone> {
        let mut zone = Zone { fills: Vec::new(), hollow: false };
        if item.find("keepout").is_some() || item.find("placement").is_some() {
            return Ok(zone);
        }
        let layers = Layers::of(item);
        if let Some(old) = item.find("fill_segments") {
            let message = "this zone is filled with segments, as KiCad 5 did";
            return Err(old.fault(
                Rule::ZoneFill,
                message,
                "fill all zones (key B) in KiCad, and save",
            ));
        }
        // Up to KiCad 9 a fill is the path of a pen of the least thickness, and what is within, unless the
        // zone says otherwise.
        let solid = item.find("filled_areas_thickness").and_then(|list| list.item(0));
        let solid = solid.is_some_and(|word| word.word() == b"no");
        let width = match item.find("min_thickness") {
            Some(width) if !solid => width.length(0)?,
            _ => 0.0,
        };
        for filled in item.all("filled_polygon") {
            let on = Layers::of(filled);
            let on = if filled.find("layer").is_some() { on } else { layers };
            let outline = chain(filled.need("pts")?)?;
            if outline.is_empty() {
                continue;
            }
            if width > 0.0 {
                let edge = outline.iter().map(|path| (on, Shape::Stroke(*path, width)));
                zone.fills.extend(edge);
            }
            let area = Piece::new(true, Contour::new(outline).counter_clockwise());
            zone.fills.push((on, Shape::Pieces(vec![area])));
        }
        let filled = |on: fn(&Layers) -> bool| zone.fills.iter().any(|(layers, _)| on(layers));
        zone.hollow =
            (layers.front && !filled(|on| on.front)) || (layers.back && !filled(|on| on.back));
        Ok(zone)
    }
}
