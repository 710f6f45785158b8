//! The paper: its size and colours, words, lines and axes on it, and SVG as PNG.

use crate::lettering;
use crate::trace::Trace;
use crate::view::View;
use geom::Vec3;
use glam::DVec2;
use program::{Diagnostic, Rule};
use std::fmt::Write as _;

/// Size of the picture, pixels.
pub const SIZE: DVec2 = DVec2::new(1200.0, 760.0);

pub const PAPER: &str = "#fdfdfb";
pub const INK: &str = "#3a3f45";

/// Colour of rapid moves.
pub const RAPID: &str = "#a4abb3";

/// Colours of the tools (red, green, blue), which can be distinguished with any colour vision.
pub const COLORS: [[f64; 3]; 8] = [
    [38.0, 120.0, 190.0],
    [222.0, 122.0, 24.0],
    [34.0, 150.0, 96.0],
    [196.0, 62.0, 92.0],
    [124.0, 92.0, 196.0],
    [20.0, 160.0, 176.0],
    [150.0, 108.0, 52.0],
    [110.0, 118.0, 128.0],
];

/// The head of a drawing: what it is for who cannot see it, and the paper.
pub fn begin(what: &str) -> String {
    let (w, h) = (SIZE.x, SIZE.y);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" \
         height=\"{h}\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n\
         <title>{}</title>\n<rect width=\"{w}\" height=\"{h}\" fill=\"{PAPER}\"/>\n",
        escape(what)
    )
}

/// Paints an SVG drawing as PNG, twice as large, so that it is sharp on any screen.
///
/// # Errors
/// Where the drawing is too large for the memory.
pub fn png(svg: &str) -> Result<Vec<u8>, Box<Diagnostic>> {
    use resvg::{tiny_skia, usvg};
    let failed =
        |why: String| Diagnostic::error(Rule::Drawing, format!("no PNG can be made: {why}"));
    let tree = usvg::Tree::from_str(svg, &usvg::Options::default())
        .map_err(|error| failed(error.to_string()))?;
    let [width, height] =
        [tree.size().width(), tree.size().height()].map(|side| (side * 2.0) as u32);
    let mut pixels = tiny_skia::Pixmap::new(width, height)
        .ok_or_else(|| failed(format!("{width} × {height} pixels do not fit into memory")))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(2.0, 2.0), &mut pixels.as_mut());
    Ok(pixels.encode_png().map_err(|error| failed(error.to_string()))?)
}

/// One look of lines; the data are in tenths of a pixel.
pub fn lines(out: &mut String, trace: Trace, color: &str, width: f64, more: &str) {
    let data = trace.finish();
    if !data.is_empty() {
        let width = width * 10.0;
        let _ = writeln!(
            out,
            "<path transform=\"scale(.1)\" stroke=\"{color}\" stroke-width=\"{width}\" {more} \
             d=\"{data}\"/>"
        );
    }
}

/// Words, drawn; the label is for who cannot see them.
pub fn write_text(out: &mut String, text: &str, at: DVec2, height: f64, color: &str) {
    let _ = writeln!(
        out,
        "<path aria-label=\"{}\" stroke=\"{color}\" stroke-width=\"{:.1}\" d=\"{}\"/>",
        escape(text),
        (height * 0.13).max(1.0),
        lettering::strokes(text, at.x, at.y, height)
    );
}

/// The first `most` characters, with dots where some are left out.
pub fn shorten(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let mut short: String = text.chars().take(most - 3).collect();
    short.push_str("...");
    short
}

/// The directions of the axes.
pub fn triad(out: &mut String, view: &View, origin: DVec2) {
    let axes = [(Vec3::X, "X", "#c0392b"), (Vec3::Y, "Y", "#2e8b57"), (Vec3::Z, "Z", "#2867b2")];
    for (axis, letter, color) in axes {
        let along = DVec2::new(view.right.dot(axis), -view.up.dot(axis));
        let tip = origin + along * 40.0;
        let _ = writeln!(
            out,
            "<path stroke=\"{color}\" stroke-width=\"1.8\" d=\"M{:.1} {:.1}L{:.1} {:.1}\"/>",
            origin.x, origin.y, tip.x, tip.y
        );
        let at = origin + along * 52.0 + DVec2::new(-3.0, 4.5);
        write_text(out, letter, at, 9.0, color);
    }
}

/// A bar of a round length that ends at `end`.
pub fn scale_bar(out: &mut String, view: &View, end: DVec2) {
    let longest = 200.0 / view.scale;
    let power = 10f64.powf(longest.log10().floor());
    let round = [5.0, 2.0, 1.0].into_iter().find(|m| m * power <= longest).unwrap_or(1.0) * power;
    let width = round * view.scale;
    let (right, y) = (end.x, end.y);
    let left = right - width;
    let _ = writeln!(
        out,
        "<path stroke=\"{INK}\" stroke-width=\"1.5\" \
         d=\"M{left:.1} {:.1}v8M{left:.1} {y}H{right}M{right} {:.1}v8\"/>",
        y - 4.0,
        y - 4.0
    );
    let text = format!("{round} MM");
    let start = left + (width - lettering::width(&text, 9.0)) / 2.0;
    write_text(out, &text, DVec2::new(start, y - 10.0), 9.0, INK);
}

/// Text as XML; characters that XML forbids are left out.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars().filter(|c| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}')) {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
    }
    out
}
