//! The path of a wire: the contour from above with its points, the chord error along it, and the
//! surface between the two ends of the wire.

use crate::lettering;
use crate::paper::{INK, PAPER, SIZE, begin, lines, scale_bar, shorten, triad, write_text};
use crate::trace::Trace;
use crate::view::View;
use geom::{Vec2, Vec3};
use glam::DVec2;
use std::fmt::Write as _;
use wire::points::Points;
use wire::{Element, Path};

/// The field of the contour from above: low and high corner, pixels.
const PLAN: [DVec2; 2] = [DVec2::new(60.0, 110.0), DVec2::new(580.0, 430.0)];

/// That of the chord error.
const ERROR: [DVec2; 2] = [DVec2::new(60.0, 570.0), DVec2::new(580.0, 700.0)];

/// That of the surface.
const SURFACE: [DVec2; 2] = [DVec2::new(660.0, 110.0), DVec2::new(1150.0, 660.0)];

/// How far a drawn line may be from the path, pixels; doubled until the picture is small enough.
const TOLERANCE: f64 = 0.1;

/// The most points of a line.
const MAX_POINTS: usize = 100_000;

/// Dots are at least so far apart, pixels.
const APART: f64 = 6.0;

/// The most strips that make the surface.
const STRIPS: usize = 1500;

/// How far an arc turns in one strip, radians.
const STRIP: f64 = 0.1;

/// Where the light comes from: nearer to X, so that walls across X and across Y differ.
const LIGHT: Vec3 = Vec3::new(0.866, 0.5, 0.0);

const LOWER: &str = "#2678be";
const UPPER: &str = "#de7a18";
const START: &str = "#c43e5c";
const SELECTED: &str = "#22965f";
const QUIET: &str = "#7b828a";

/// What is drawn.
pub struct WirePicture<'a> {
    /// The segments of the wire path.
    pub segments: Vec<WireSegment<'a>>,
    /// Height of the upper contour, mm.
    pub height: Option<f64>,
    /// The line of the source whose part is marked.
    pub selected: Option<u32>,
}

/// A segment of the wire path, cut without a break.
#[derive(Clone, Copy)]
pub struct WireSegment<'a> {
    /// The contours that its two ends follow.
    pub path: &'a Path,
    /// Its points, where it is written as such.
    pub points: Option<&'a Points>,
    /// Whether the wire is threaded at its start; otherwise it goes on from the segment before.
    pub threaded: bool,
}

/// Draws the path of a wire as SVG under a title.
pub fn wire_path(title: &str, picture: &WirePicture) -> String {
    let mut out = begin(&format!("Way of the wire of {title}"));
    write_text(&mut out, &shorten(title, 60), DVec2::new(40.0, 40.0), 12.0, INK);
    plan(&mut out, picture);
    chord_error(&mut out, picture);
    surface(&mut out, picture);
    out.push_str("</svg>\n");
    out
}

impl WirePicture<'_> {
    /// The box around both ends, from the lower plane to `height`.
    fn corners(&self, height: f64) -> [Vec3; 2] {
        let ends = self.segments.iter().flat_map(|segment| {
            let lower = segment.path.lower();
            [lower.extents(), segment.path.upper().unwrap_or(lower).extents()]
        });
        let (low, high) =
            ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((Vec2::ZERO, Vec2::ONE));
        [low.extend(0.0), high.extend(height)]
    }

    fn leans(&self) -> bool {
        self.segments.iter().any(|segment| segment.path.upper().is_some())
    }
}

/// The contour from above: both ends, points, start, selection.
fn plan(out: &mut String, picture: &WirePicture) {
    let view = View::plan(picture.corners(0.0), PLAN);
    let lower = || picture.segments.iter().flat_map(|segment| segment.path.lower().elements());
    let upper = picture.segments.iter().filter_map(|segment| segment.path.upper());
    drawn(out, &view, 0.0, upper.flat_map(|contour| contour.elements()), (UPPER, 1.2));
    drawn(out, &view, 0.0, lower(), (LOWER, 1.2));
    let chosen = lower().filter(|element| Some(element.line) == picture.selected);
    drawn(out, &view, 0.0, chosen, (SELECTED, 4.0));
    let points = || picture.segments.iter().filter_map(|segment| segment.points);
    dots(out, &view, points().map(|points| &points.upper[..]), UPPER);
    let all = picture
        .segments
        .iter()
        .filter_map(|segment| Some(segment.points?.lower.len() - usize::from(!segment.threaded)));
    let all: usize = all.sum();
    let shown = dots(out, &view, points().map(|points| &points.lower[..]), LOWER);
    picture
        .segments
        .iter()
        .filter(|segment| segment.threaded)
        .for_each(|segment| start(out, segment, &view));
    let points = match all {
        0 => String::new(),
        _ if all == shown => format!(", {all} POINTS"),
        _ => format!(", {shown} OF {all} POINTS"),
    };
    let ends = if picture.leans() { "LOWER AND UPPER CONTOUR" } else { "CONTOUR" };
    caption(out, &format!("{ends}{points}"), PLAN);
    let mut at = DVec2::new(PLAN[0].x - 20.0, PLAN[1].y + 40.0);
    let mut key = |text: &str, color: &str| {
        write_text(out, text, at, 8.0, color);
        at.x += lettering::width(text, 8.0) + 24.0;
    };
    key("START", START);
    if let Some(line) = picture.selected {
        key(&format!("LINE {line}"), SELECTED);
    }
    if picture.leans() {
        key("LOWER", LOWER);
        key("UPPER", UPPER);
    }
    scale_bar(out, &view, DVec2::new(PLAN[1].x, PLAN[1].y + 40.0));
}

/// Elements at a height, mm, as a line of one look.
fn drawn<'e>(
    out: &mut String,
    view: &View,
    height: f64,
    elements: impl Iterator<Item = &'e Element> + Clone,
    (color, width): (&str, f64),
) {
    let mut tolerance = TOLERANCE;
    let trace = loop {
        let mut trace = Trace::new(tolerance);
        for element in elements.clone() {
            let parts = parts(element, view.scale, tolerance);
            let mut from = element.start;
            for i in 1..=parts {
                let to = element.at(i as f64 / parts as f64);
                trace.segment(view.at(from.extend(height)), view.at(to.extend(height)));
                from = to;
            }
        }
        if trace.points() <= MAX_POINTS {
            break trace;
        }
        tolerance *= 2.0;
    };
    lines(out, trace, color, width, "");
}

/// Into how many chords an element is drawn.
fn parts(element: &Element, scale: f64, tolerance: f64) -> usize {
    let (Some(radius), Some(turn)) = (element.radius(), element.turn) else { return 1 };
    let angle = 4.0 * (tolerance / (2.0 * radius * scale)).min(1.0).sqrt().asin();
    (turn.sweep.abs() / angle).ceil().clamp(1.0, 720.0) as usize
}

/// A dot for each point that is not too near to the last; how many there are.
fn dots<'p>(
    out: &mut String,
    view: &View,
    points: impl Iterator<Item = &'p [Vec2]>,
    color: &str,
) -> usize {
    let mut data = String::new();
    let (mut last, mut count) = (DVec2::INFINITY, 0);
    for place in points.flatten().map(|point| view.at(point.extend(0.0))) {
        let near = last.is_finite() && last.distance(place) < APART;
        if near || count == MAX_POINTS {
            continue;
        }
        let _ = write!(data, "M{:.1} {:.1}h0", place.x, place.y);
        (last, count) = (place, count + 1);
    }
    if count > 0 {
        for (color, width) in [(PAPER, 4.4), (color, 3.4)] {
            let _ =
                writeln!(out, "<path stroke=\"{color}\" stroke-width=\"{width}\" d=\"{data}\"/>");
        }
    }
    count
}

/// A ring where the wire is threaded, and an arrow in the direction of the cut.
fn start(out: &mut String, segment: &WireSegment, view: &View) {
    let contour = segment.path.lower();
    let Some(first) = contour.elements().first() else { return };
    let at = view.at(contour.start().extend(0.0));
    let along = first.tangent(0.0);
    let (along, side) = (DVec2::new(along.x, -along.y), DVec2::new(along.y, along.x));
    let tip = at + along * 30.0;
    let (left, right) = (tip - along * 8.0 + side * 4.0, tip - along * 8.0 - side * 4.0);
    let foot = at + along * 6.0;
    let _ = writeln!(
        out,
        "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"6\" stroke=\"{START}\" stroke-width=\"1.8\"/>\n\
         <path stroke=\"{START}\" stroke-width=\"1.8\" d=\"M{:.1} {:.1}L{:.1} {:.1}M{:.1} {:.1}L{:.1} \
         {:.1}L{:.1} {:.1}\"/>",
        at.x, at.y, foot.x, foot.y, tip.x, tip.y, left.x, left.y, tip.x, tip.y, right.x, right.y
    );
}

/// A chord between two points: where it is along the path of the lower end, and how far either end of the
/// wire leaves its arc, mm.
struct Chord {
    from: f64,
    to: f64,
    errors: [f64; 2],
}

fn chords(picture: &WirePicture) -> Vec<Chord> {
    let mut chords: Vec<Chord> = Vec::new();
    for segment in &picture.segments {
        let Some(points) = segment.points else { continue };
        for (i, (below, above)) in segment.path.elements().enumerate() {
            for point in points.of_element(i) {
                let length = |places: &[Vec2]| match places.get(point.wrapping_sub(1)..=point) {
                    Some(ends) => ends[0].distance(ends[1]),
                    None => 0.0,
                };
                let (lower, upper) = (length(&points.lower), length(&points.upper));
                let from = chords.last().map_or(0.0, |chord| chord.to);
                let errors = [sagitta(below, lower), sagitta(above, upper)];
                chords.push(Chord { from, to: from + lower, errors });
            }
        }
    }
    chords
}

/// How far the chords between the points leave their arcs, along the path of the lower end.
fn chord_error(out: &mut String, picture: &WirePicture) {
    let chords = chords(picture);
    let length = chords.last().map_or(0.0, |chord| chord.to);
    let most = chords.iter().flat_map(|chord| chord.errors).fold(0.0, f64::max);
    let [low, high] = ERROR;
    if most == 0.0 {
        let text = if chords.is_empty() { "ARCS ARE CUT AS ARCS" } else { "NO ARCS" };
        caption(out, &format!("CHORD ERROR: {text}"), ERROR);
        return;
    }
    caption(out, &format!("CHORD ERROR ALONG THE WAY, {most:.3e} MM AT MOST"), ERROR);
    let _ = writeln!(
        out,
        "<path stroke=\"{QUIET}\" d=\"M{} {}V{}H{}\"/>",
        low.x, low.y, high.y, high.x
    );
    let room = high - low;
    let at = |along: f64, error: f64| {
        DVec2::new(low.x + room.x * along / length, high.y - room.y * error / most)
    };
    let ends = if picture.leans() { &[(1, UPPER), (0, LOWER)][..] } else { &[(0, LOWER)] };
    for &(end, color) in ends {
        let mut trace = Trace::new(TOLERANCE);
        let mut last = at(0.0, 0.0);
        let corners = chords.iter().flat_map(|chord| {
            let error = chord.errors[end];
            [at(chord.from, error), at(chord.to, error)]
        });
        for point in corners.chain([at(length, 0.0)]) {
            trace.segment(last, point);
            last = point;
        }
        lines(out, trace, color, 1.4, "");
    }
    let below = high.y + 18.0;
    write_text(out, "0", DVec2::new(low.x, below), 8.0, QUIET);
    let text = format!("{length:.1} MM");
    let left = high.x - lettering::width(&text, 8.0);
    write_text(out, &text, DVec2::new(left, below), 8.0, QUIET);
}

/// How far a chord of a length leaves its arc, mm.
fn sagitta(element: &Element, chord: f64) -> f64 {
    element.radius().map_or(0.0, |radius| {
        let quarter = chord * chord / 4.0;
        // r − √(r² − c²/4) without the loss of its digits.
        quarter / (radius + (radius * radius - quarter).max(0.0).sqrt())
    })
}

/// The surface that the wire cuts, isometric.
fn surface(out: &mut String, picture: &WirePicture) {
    let flat = picture.corners(0.0);
    let size = (flat[1] - flat[0]).max_element();
    let height = picture.height.unwrap_or(0.3 * size);
    let view = View::isometric(picture.corners(height), SURFACE);
    let text = match picture.height {
        Some(height) => format!("CUT SURFACE, HEIGHT {height} MM"),
        None => String::from("CUT SURFACE, HEIGHT NOT GIVEN"),
    };
    caption(out, &text, SURFACE);
    let mut strips: Vec<[Vec3; 4]> = Vec::new();
    let every =
        picture.segments.iter().map(|segment| rulings(segment).count()).sum::<usize>() / STRIPS + 1;
    for segment in &picture.segments {
        let count = rulings(segment).count();
        let some = rulings(segment).enumerate().filter(|(i, _)| i % every == 0 || i + 1 == count);
        let stand = |(below, above): (Vec2, Vec2)| (below.extend(0.0), above.extend(height));
        let some: Vec<(Vec3, Vec3)> = some.map(|(_, ruling)| stand(ruling)).collect();
        strips.extend(some.windows(2).map(|s| [s[0].0, s[1].0, s[1].1, s[0].1]));
    }
    // What is farther away is painted first.
    let towards = view.right.cross(view.up);
    let near = |strip: &[Vec3; 4]| strip.iter().map(|p| p.dot(towards)).sum::<f64>();
    strips.sort_by(|a, b| near(a).total_cmp(&near(b)));
    for strip in strips {
        let normal = (strip[1] - strip[0]).cross(strip[3] - strip[0]).normalize_or_zero();
        let bright = 0.45 + 0.5 * normal.dot(LIGHT).abs();
        let shade = |c: f64| (255.0 - (255.0 - c) * (1.15 - bright)) as u8;
        let (r, g, b) = (shade(60.0), shade(120.0), shade(180.0));
        let corners = strip.map(|p| {
            let p = view.at(p);
            format!("{:.1},{:.1}", p.x, p.y)
        });
        let _ = writeln!(
            out,
            "<polygon points=\"{}\" fill=\"#{r:02x}{g:02x}{b:02x}\" fill-opacity=\".82\" \
             stroke=\"#5b8db8\" stroke-opacity=\".35\" stroke-width=\".5\"/>",
            corners.join(" ")
        );
    }
    for segment in &picture.segments {
        let lower = segment.path.lower();
        let upper = segment.path.upper().unwrap_or(lower);
        let above = if segment.path.upper().is_some() { UPPER } else { LOWER };
        drawn(out, &view, 0.0, lower.elements().iter(), (LOWER, 1.6));
        drawn(out, &view, height, upper.elements().iter(), (above, 1.6));
        let pairs = segment.path.elements();
        let chosen = pairs.filter(|(below, _)| Some(below.line) == picture.selected);
        for (below, above) in chosen {
            drawn(out, &view, 0.0, std::iter::once(below), (SELECTED, 3.0));
            drawn(out, &view, height, std::iter::once(above), (SELECTED, 3.0));
        }
        if segment.threaded {
            let mut wire = Trace::new(TOLERANCE);
            let (below, above) = (lower.start().extend(0.0), upper.start().extend(height));
            wire.segment(view.at(below), view.at(above));
            lines(out, wire, START, 2.2, "");
        }
    }
    triad(out, &view, DVec2::new(SURFACE[0].x + 10.0, SIZE.y - 40.0));
    scale_bar(out, &view, DVec2::new(SURFACE[1].x, SIZE.y - 30.0));
}

/// The ends of the wire along a segment: below and above.
fn rulings(segment: &WireSegment) -> impl Iterator<Item = (Vec2, Vec2)> {
    let turned = |element: &Element| element.turn.map_or(0.0, |turn| turn.sweep.abs());
    let starts = segment.path.elements().take(1).map(|(below, above)| (below.start, above.start));
    let along = segment.path.elements().flat_map(move |(below, above)| {
        let parts = (turned(below).max(turned(above)) / STRIP).ceil().max(4.0) as usize;
        (1..=parts).map(move |i| i as f64 / parts as f64).map(|t| (below.at(t), above.at(t)))
    });
    starts.chain(along)
}

fn caption(out: &mut String, text: &str, field: [DVec2; 2]) {
    write_text(out, text, DVec2::new(field[0].x - 20.0, field[0].y - 30.0), 10.0, INK);
}
