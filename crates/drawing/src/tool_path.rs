//! The path of the tool tip of a program, from the front left and above.
//!
//! Cutting moves have one colour a tool, darker where they are deeper; rapids are thin and dashed;
//! holes have a ring; where the tool tilts, hair lines show its axis.

use crate::paper::{COLORS, INK, RAPID, SIZE, begin, lines, scale_bar, shorten, triad, write_text};
use crate::trace::Trace;
use crate::view::View;
use crate::walk::{Segment, walk};
use geom::Vec3;
use glam::DVec2;
use program::Program;
use program::statistics::Statistics;
use std::collections::BTreeMap;
use std::fmt::Write as _;

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

/// Draws `program` as SVG under a title.
pub fn tool_path(title: &str, program: &Program) -> String {
    let statistics = Statistics::of(program);
    let view = View::from_above([statistics.low.into(), statistics.high.into()], FIELD);
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
        let mut out = begin(&format!("Tool path of {title}"));
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
        triad(&mut out, view, DVec2::new(FIELD[0].x + 32.0, SIZE.y - 48.0));
        scale_bar(&mut out, view, SIZE - 40.0);
        out.push_str("</svg>\n");
        out
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
