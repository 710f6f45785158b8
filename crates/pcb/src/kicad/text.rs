//! Texts on copper.

use super::graphic::chain;
use super::tree::{Node, Outcome};
use crate::board::Shape;
use crate::contour::{Contour, Piece};
use geom::{Element, Transform, Vec2, lettering};
use program::Rule;

/// From line to line, in heights of a capital. Ours: KiCad's letters are its own.
const LINE: f64 = 1.6;

/// Width of the pen where the text does not say, of the size of its letters: as KiCad has it.
const PEN: f64 = 1.0 / 8.0;

/// What is known of a text.
pub(super) enum Text {
    /// It is not shown.
    Hidden,
    /// What KiCad drew with a font of the system, where it is on the board.
    Stored(Vec<Shape>),
    /// Our letters for those of KiCad's own font, in the frame of the text.
    Lettered(Vec<Shape>),
    /// It has variables, whose values the file does not have.
    Variable,
}

impl Text {
    /// The text of `gr_text`, `fp_text` or `property`.
    pub(super) fn of(item: Node) -> Outcome<Text> {
        let effects = item.need("effects")?;
        if item.says("hide") || effects.says("hide") {
            return Ok(Text::Hidden);
        }
        if item.find("layer").is_some_and(|layer| layer.says("knockout")) {
            let message = "a text that is cut out of copper";
            let help = "in KiCad, make it a polygon, or take \"knockout\" off";
            return Err(item.fault(Rule::TextKnockout, message, help));
        }
        if let Some(stored) = item.find("render_cache") {
            return stored
                .all("polygon")
                .map(stored_glyph)
                .collect::<Outcome<_>>()
                .map(Text::Stored);
        }
        // (gr_text TEXT …), (fp_text KIND TEXT …), (property NAME TEXT …): texts are quoted, kinds are not.
        let before = usize::from(item.name() == b"property");
        let text = item.items().filter(Node::is_quoted).nth(before);
        let text = text.map(|text| text.text()).unwrap_or_default();
        if text.contains("${") {
            return Ok(Text::Variable);
        }
        lettered(&text, effects).map(Text::Lettered)
    }
}

/// The outline of a letter, and its holes.
fn stored_glyph(polygon: Node) -> Outcome<Shape> {
    let mut contours = Vec::new();
    for pts in polygon.all("pts") {
        let outline = chain(pts)?;
        if !outline.is_empty() {
            let contour = Contour::new(outline).counter_clockwise();
            contours.push(if contours.is_empty() { contour } else { contour.reversed() });
        }
    }
    Ok(Shape::Pieces(match contours.is_empty() {
        true => Vec::new(),
        false => vec![Piece { solid: true, contours }],
    }))
}

/// Our letters, about the place of the text.
fn lettered(text: &str, effects: Node) -> Outcome<Vec<Shape>> {
    let font = effects.need("font")?;
    let size = font.need("size")?;
    let (height, width) = (size.length(0)?, size.length(1)?);
    let pen = match font.find("thickness") {
        Some(thickness) => thickness.length(0)?,
        None => PEN * width.min(height),
    };
    let justify = |side: &str| effects.find("justify").is_some_and(|list| list.says(side));
    let lines: Vec<&str> = text.lines().collect();
    let depth = 1.0 + lines.len().saturating_sub(1) as f64 * LINE;
    let top = match (justify("top"), justify("bottom")) {
        (true, _) => 0.0,
        (_, true) => depth,
        _ => depth / 2.0,
    };
    let mirrored = Transform::new(justify("mirror"), 0.0, 1.0);
    let mut shapes = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let left = match (justify("left"), justify("right")) {
            (true, _) => 0.0,
            (_, true) => -lettering::width(line),
            _ => -lettering::width(line) / 2.0,
        };
        let base = Vec2::new(left, top - 1.0 - i as f64 * LINE);
        let place = |point: Vec2| mirrored.apply((base + point) * Vec2::new(width, height));
        for stroke in lettering::strokes(line) {
            shapes.extend(stroke.windows(2).filter_map(|ends| match ends {
                [a, b] if pen > 0.0 => {
                    Some(Shape::Stroke(Element::line(place(*a), place(*b)), pen))
                }
                _ => None,
            }));
        }
    }
    Ok(shapes)
}
