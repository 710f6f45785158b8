//! A picture of a program: the path of the tool tip from the front left and above, in parallel
//! projection, as SVG or PNG.
//!
//! Cutting moves have one colour a tool, darker where they are deeper; rapids are thin and dashed;
//! holes have a ring; where the tool tilts, hair lines show its axis. The same program gives the same
//! bytes on every machine: there are no fonts in it. Its size is bounded, however long the program.

mod lettering;
mod trace;

use crate::walk::{Segment, walk};
use geom::Vec3;
use glam::DVec2;
use program::statistics::Statistics;
use program::{Diagnostic, Program};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use trace::Trace;

/// Size of the picture, pixels.
const SIZE: DVec2 = DVec2::new(1200.0, 760.0);

/// Where the path is drawn: low and high corner, pixels. The legend stands right of it.
const FIELD: [DVec2; 2] = [DVec2::new(40.0, 40.0), DVec2::new(880.0, 720.0)];

/// How far a drawn line may be from the path, pixels; doubled until the picture is small enough.
const TOLERANCE: f64 = 0.1;

/// The most points of all lines together: about four megabytes.
const MAX_POINTS: usize = 500_000;

/// The most lines of the legend that name tools.
const LEGEND_TOOLS: usize = 14;

/// How many shades of depth a tool's colour has.
const SHADES: usize = 6;

/// How many hair lines show the tool axis, and how long they are, pixels.
const HAIRS: (f64, f64) = (300.0, 30.0);

/// The most rings that mark holes.
const MAX_RINGS: usize = 20_000;

/// Colours of the tools (red, green, blue), told apart with any colour sight.
const COLORS: [[f64; 3]; 8] = [
    [38.0, 120.0, 190.0],
    [222.0, 122.0, 24.0],
    [34.0, 150.0, 96.0],
    [196.0, 62.0, 92.0],
    [124.0, 92.0, 196.0],
    [20.0, 160.0, 176.0],
    [150.0, 108.0, 52.0],
    [110.0, 118.0, 128.0],
];

const PAPER: &str = "#fdfdfb";
const INK: &str = "#3a3f45";
const RAPID: &str = "#a4abb3";

/// Draws `program` as SVG under a title.
pub fn svg(title: &str, program: &Program) -> String {
    let view = View::of(&Statistics::of(program));
    let mut tolerance = TOLERANCE;
    let picture = loop {
        let picture = Picture::of(program, &view, tolerance);
        if picture.points() <= MAX_POINTS {
            break picture;
        }
        tolerance *= 2.0;
    };
    picture.write(title, &view)
}

/// Paints an SVG drawing of [`svg`] as PNG, twice as large, so that it is sharp on any screen.
///
/// # Errors
/// Where the drawing is too large for the memory.
pub fn png(svg: &str) -> Result<Vec<u8>, Box<Diagnostic>> {
    use resvg::{tiny_skia, usvg};
    let failed = |why: String| Diagnostic::error("drawing", format!("no PNG can be made: {why}"));
    let tree = usvg::Tree::from_str(svg, &usvg::Options::default())
        .map_err(|error| failed(error.to_string()))?;
    let (width, height) = (SIZE.x as u32 * 2, SIZE.y as u32 * 2);
    let mut pixels = tiny_skia::Pixmap::new(width, height)
        .ok_or_else(|| failed(format!("{width} × {height} pixels do not fit into memory")))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(2.0, 2.0), &mut pixels.as_mut());
    Ok(pixels.encode_png().map_err(|error| failed(error.to_string()))?)
}

/// From space to paper: parallel projection, seen from the front left and above.
struct View {
    right: Vec3,
    up: Vec3,
    /// Pixels a mm.
    scale: f64,
    /// Pixels of the origin.
    origin: DVec2,
    /// The box around the path, mm.
    low: Vec3,
    high: Vec3,
}

impl View {
    /// The view in which the box around the path fills the field.
    fn of(statistics: &Statistics) -> View {
        let turn = 30f64.to_radians();
        let tilt = 35f64.to_radians();
        let right = Vec3::new(turn.cos(), turn.sin(), 0.0);
        let up = Vec3::new(-turn.sin() * tilt.sin(), turn.cos() * tilt.sin(), tilt.cos());
        let (low, high) = (Vec3::from(statistics.low), Vec3::from(statistics.high));
        let mut view = View { right, up, scale: 1.0, origin: DVec2::ZERO, low, high };
        let corners = (0..8).map(|i| {
            let side = |bit: u8, low: f64, high: f64| if i & bit == 0 { low } else { high };
            view.at(Vec3::new(
                side(1, low.x, high.x),
                side(2, low.y, high.y),
                side(4, low.z, high.z),
            ))
        });
        let empty = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (least, most) = corners.fold(empty, |(a, b), p| (a.min(p), b.max(p)));
        let room = (FIELD[1] - FIELD[0]) / (most - least).max(DVec2::splat(1e-6));
        view.scale = room.min_element();
        view.origin = (FIELD[0] + FIELD[1]) / 2.0 - (least + most) / 2.0 * view.scale;
        view
    }

    fn at(&self, p: Vec3) -> DVec2 {
        self.origin + DVec2::new(self.right.dot(p), -self.up.dot(p)) * self.scale
    }
}

/// Everything that is drawn, sorted into lines of one look.
struct Picture {
    tools: Vec<String>,
    /// Cutting length of each tool, mm.
    cutting: Vec<f64>,
    rapid: f64,
    rapids: Trace,
    /// By shade (deepest first: what is higher covers it), then by tool.
    cuts: BTreeMap<(usize, usize), Trace>,
    hairs: BTreeMap<usize, Trace>,
    rings: BTreeMap<usize, Trace>,
}

impl Picture {
    fn of(program: &Program, view: &View, tolerance: f64) -> Picture {
        let mut picture = Picture {
            tools: Vec::new(),
            cutting: vec![0.0],
            rapid: 0.0,
            rapids: Trace::new(tolerance),
            cuts: BTreeMap::new(),
            hairs: BTreeMap::new(),
            rings: BTreeMap::new(),
        };
        let chord = tolerance / view.scale;

        let tilts = |axis: Vec3| axis.distance_squared(Vec3::Z) > 1e-6;
        let (mut low, mut high, mut tilted) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        picture.tools = walk(program, chord, &mut |segment| {
            picture.cutting.resize(picture.cutting.len().max(segment.tool + 1), 0.0);
            if segment.cuts {
                low = low.min(segment.to.z);
                high = high.max(segment.to.z);
                picture.cutting[segment.tool] += segment.length;
                tilted += if tilts(segment.axis) { segment.length } else { 0.0 };
            } else {
                picture.rapid += segment.length;
            }
        });
        let shades = |z: f64| match (z - low) / (high - low) {
            part if part.is_finite() => ((part * SHADES as f64) as usize).min(SHADES - 1),
            _ => SHADES - 1,
        };
        let hair_every = tilted / HAIRS.0;
        let pen = || Trace::new(tolerance);
        let (mut since_hair, mut rings) = (0.0, 0);
        walk(program, chord, &mut |segment| {
            let Segment { from, to, tool, .. } = segment;
            let (start, end) = (view.at(from), view.at(to));
            if !segment.cuts {
                picture.rapids.segment(start, end);
                return;
            }
            let shade = shades((from.z + to.z) / 2.0);
            picture.cuts.entry((shade, tool)).or_insert_with(pen).segment(start, end);
            if tilts(segment.axis) {
                since_hair += segment.length;
            }
            if tilts(segment.axis) && since_hair >= hair_every {
                since_hair = 0.0;
                let tip = view.at(to + segment.axis * (HAIRS.1 / view.scale));
                picture.hairs.entry(tool).or_insert_with(pen).segment(end, tip);
            }
            if segment.hole && rings < MAX_RINGS {
                rings += 1;
                ring(picture.rings.entry(tool).or_insert_with(pen), view, from, segment.axis);
            }
        });
        picture
    }

    fn points(&self) -> usize {
        self.rapids.points() + self.cuts.values().map(Trace::points).sum::<usize>()
    }

    fn write(self, title: &str, view: &View) -> String {
        let mut out = String::new();
        let (w, h) = (SIZE.x, SIZE.y);
        let _ = write!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" \
             height=\"{h}\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n\
             <title>Tool path of {}</title>\n<rect width=\"{w}\" height=\"{h}\" fill=\"{PAPER}\"/>\n",
            escape(title)
        );
        floor(&mut out, view);
        legend(&mut out, title, &self, view);
        lines(&mut out, self.rapids, RAPID, 0.7, "stroke-dasharray=\"50 35\"");
        for ((shade, tool), trace) in self.cuts {
            lines(&mut out, trace, &color(tool, shade), 1.0, "");
        }
        for (tool, trace) in self.hairs {
            lines(&mut out, trace, &color(tool, 0), 0.6, "stroke-opacity=\".75\"");
        }
        for (tool, trace) in self.rings {
            lines(&mut out, trace, &color(tool, 0), 1.4, "");
        }
        triad(&mut out, view);
        scale_bar(&mut out, view);
        out.push_str("</svg>\n");
        out
    }
}

/// One look of lines; the data are in tenths of a pixel.
fn lines(out: &mut String, trace: Trace, color: &str, width: f64, more: &str) {
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

/// A ring around the top of a hole, 4 pixels wide.
fn ring(trace: &mut Trace, view: &View, center: Vec3, axis: Vec3) {
    let across = axis.any_orthonormal_vector() * (4.0 / view.scale);
    let at =
        |i: i32| view.at(center + geom::rotate(across, axis, f64::from(i).to_radians() * 30.0));
    for i in 0..12 {
        trace.segment(at(i), at(i + 1));
    }
}

/// The colour of a tool; shade 0 is the deepest.
fn color(tool: usize, shade: usize) -> String {
    // The tool without a call (0) and the first called share a colour: a program has one or the other.
    let [r, g, b] = COLORS[tool.saturating_sub(1) % COLORS.len()];
    let part = shade as f64 / (SHADES - 1) as f64;
    let mix = |c: f64| (c * (0.5 + 0.5 * part) + (255.0 - c) * 0.18 * part * part) as u8;
    format!("#{:02x}{:02x}{:02x}", mix(r), mix(g), mix(b))
}

/// The rectangle under the path.
fn floor(out: &mut String, view: &View) {
    let (low, high) = (view.low, view.high);
    let corners = [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)];
    let points: Vec<String> = corners
        .iter()
        .map(|&(x, y)| {
            let p = view.at(Vec3::new(x, y, low.z));
            format!("{:.1},{:.1}", p.x, p.y)
        })
        .collect();
    let _ = writeln!(
        out,
        "<polygon points=\"{}\" fill=\"#f3f4f1\" stroke=\"#d9dcd6\"/>",
        points.join(" ")
    );
}

/// Words, drawn; the label is for who cannot see them.
fn write_text(out: &mut String, text: &str, at: DVec2, height: f64, color: &str) {
    let _ = writeln!(
        out,
        "<path aria-label=\"{}\" stroke=\"{color}\" stroke-width=\"{:.1}\" d=\"{}\"/>",
        escape(text),
        (height * 0.13).max(1.0),
        lettering::strokes(text, at.x, at.y, height)
    );
}

/// What the lines mean, with lengths, and how large it all is.
fn legend(out: &mut String, title: &str, picture: &Picture, view: &View) {
    let left = FIELD[1].x + 40.0;
    let mut at = DVec2::new(left, 60.0);
    let mut entry = |out: &mut String, stroke: &str, text: &str, length: Option<f64>| {
        let text = shorten(text, 28);
        let (x, y) = (at.x, at.y - 4.5);
        let _ = writeln!(out, "<path {stroke} d=\"M{x} {y}h26\"/>");
        write_text(out, &text, at + DVec2::new(36.0, 0.0), 9.0, INK);
        if let Some(length) = length {
            at.y += 17.0;
            let length = format!("{length:.0} MM");
            write_text(out, &length, at + DVec2::new(36.0, 0.0), 8.0, "#7b828a");
        }
        at.y += 25.0;
    };
    let used = picture.cutting.iter().enumerate().filter(|(_, length)| **length > 0.0);
    let used: Vec<usize> = used.map(|(tool, _)| tool).collect();
    write_text(out, &shorten(title, 24), DVec2::new(left, 36.0), 11.0, INK);
    for &tool in used.iter().take(LEGEND_TOOLS) {
        let stroke = format!("stroke=\"{}\" stroke-width=\"3\"", color(tool, SHADES / 2));
        entry(out, &stroke, &picture.tools[tool], Some(picture.cutting[tool]));
    }
    if used.len() > LEGEND_TOOLS {
        let more = format!("{} MORE TOOLS", used.len() - LEGEND_TOOLS);
        entry(out, "stroke=\"none\"", &more, None);
    }
    let stroke = format!("stroke=\"{RAPID}\" stroke-width=\"1\" stroke-dasharray=\"5 3.5\"");
    entry(out, &stroke, "RAPID", Some(picture.rapid));
    let extents = [("X", view.low.x, view.high.x), ("Y", view.low.y, view.high.y)];
    for (letter, low, high) in extents.into_iter().chain([("Z", view.low.z, view.high.z)]) {
        let text = format!("{letter} {low:.1} ... {high:.1}");
        write_text(out, &text, at, 9.0, INK);
        at.y += 19.0;
    }
}

/// The directions of the axes, bottom left.
fn triad(out: &mut String, view: &View) {
    let origin = DVec2::new(FIELD[0].x + 32.0, SIZE.y - 48.0);
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

/// A bar of a round length, bottom right.
fn scale_bar(out: &mut String, view: &View) {
    let longest = 200.0 / view.scale;
    let power = 10f64.powf(longest.log10().floor());
    let round = [5.0, 2.0, 1.0].into_iter().find(|m| m * power <= longest).unwrap_or(1.0) * power;
    let width = round * view.scale;
    let (right, y) = (SIZE.x - 40.0, SIZE.y - 40.0);
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

/// The first `most` characters, with dots where some are left out.
fn shorten(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let mut short: String = text.chars().take(most - 3).collect();
    short.push_str("...");
    short
}

/// Text as XML; characters that XML forbids are left out.
fn escape(text: &str) -> String {
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
