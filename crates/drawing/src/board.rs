//! A board from above and what a program does to it: copper by net, cuts as wide as their tools, holes,
//! rapids, places with a problem.

mod areas;
mod sheet;

pub use areas::{Area, AreaKind, BoardAreas, MOST_AREAS, Trapezoid};
pub use sheet::{BoardSheet, BoardSide, board_sheet};

use crate::lettering;
use crate::paper::{COLORS, INK, RAPID, SIZE, begin, lines, scale_bar, shorten, triad, write_text};
use crate::trace::Trace;
use crate::view::View;
use crate::walk::walk;
use geom::region::{Region, Ring};
use geom::{Element, Vec2, Vec3};
use glam::DVec2;
use pcb::board::Axis;
use pcb::plan::Problem;
use pcb::{Copper, Hole, HoleShape};
use program::Program;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Where the board is drawn: low and high corner, pixels. The legend stands right of it.
const FIELD: [DVec2; 2] = [DVec2::new(40.0, 40.0), DVec2::new(880.0, 720.0)];

/// How far a drawn line may be from the path, pixels; doubled until the picture is small enough.
const TOLERANCE: f64 = 0.1;

/// The most points of all lines together: about four megabytes.
const MAX_POINTS: usize = 500_000;

/// The most places that are marked and described; of all others what stays is shaded.
const MOST_MARKED: usize = 10;

/// Where the legend begins and ends, and how wide it is, pixels.
const LEGEND: [f64; 3] = [66.0, 690.0, 262.0];

/// By how much the legend may be smaller, so that all of it has room.
const SMALLEST: f64 = 0.55;

/// The most holes that are drawn.
const MAX_HOLES: usize = 50_000;

/// How wide the ring around a problem is, pixels.
const MARK: f64 = 15.0;

/// The board without its copper.
const BASE: &str = "#efe9d2";
const EDGE: &str = "#8d8663";

/// Colours of holes, by their widths, the narrowest first: neighbours differ in hue, those six apart in lightness. Boards have no more
/// than sixteen widths but for rare ones.
const HOLES: [&str; 16] = [
    "#4a4f55", "#7a3b2e", "#2e4f7a", "#3f6b34", "#6b3f78", "#7a6a2a", "#16181b", "#c4684f",
    "#4f86c9", "#67a858", "#a968bd", "#b89f35", "#868c94", "#4d120a", "#0b2548", "#163a0f",
];

const TAB: &str = "#111111";
const STOCK: &str = "stroke=\"#8d8663\" stroke-width=\"1.2\" stroke-dasharray=\"7 5\"";
const PROBLEM: &str = "#d1202f";
const QUIET: &str = "#7b828a";
const TURNING: &str = "stroke=\"#5b3fa0\" stroke-width=\"1.4\" stroke-dasharray=\"14 4 3 4\"";

/// Colours of nets, light, so that cuts stand out on them.
const NETS: [&str; 8] =
    ["#e2b27a", "#9fc5a8", "#bcb7a0", "#dba6ad", "#c3b3dd", "#a5cfd0", "#d3c58f", "#c9b7a6"];

/// What is drawn.
pub struct BoardPicture<'a> {
    /// Where there is board.
    pub outline: Option<&'a Region>,
    /// The copper of the side that is looked at.
    pub copper: Option<&'a Copper>,
    /// The holes through the board.
    pub holes: &'a [Hole],
    /// What the machine does.
    pub program: &'a Program,
    /// How wide each tool cuts, mm, in the order of their calls.
    pub widths: &'a [f64],
    /// Where something is not as it should be, the worst first.
    pub problems: &'a [Problem],
    /// What stays that should not; it is shaded.
    pub rest: &'a [Region],
    /// The line about which the board is turned over, where it is.
    pub turning: Option<Axis>,
    /// Where tabs stay, as the path of the tool over them.
    pub tabs: &'a [Element],
    /// The corners of the least blank that all programs of the board need, mm.
    pub stock: Option<(Vec2, Vec2)>,
}

/// Draws a board as SVG under a title.
pub fn board(title: &str, picture: &BoardPicture) -> String {
    let view = View::plan(picture.extents(), FIELD);
    let mut tolerance = TOLERANCE;
    let drawn = loop {
        let drawn = Drawn::of(picture, &view, tolerance);
        if drawn.points() <= MAX_POINTS {
            break drawn;
        }
        tolerance *= 2.0;
    };
    let mut out = begin(&format!("Board and program of {title}"));
    drawn.write(&mut out, title, picture, &view);
    triad(&mut out, &view, DVec2::new(FIELD[0].x + 2.0, SIZE.y - 18.0));
    scale_bar(&mut out, &view, SIZE - 40.0);
    out.push_str("</svg>\n");
    out
}

impl BoardPicture<'_> {
    /// The box around everything, flat.
    fn extents(&self) -> [Vec3; 2] {
        let mut low = Vec2::INFINITY;
        let mut high = Vec2::NEG_INFINITY;
        let mut take = |a: Vec2, b: Vec2| (low, high) = (low.min(a), high.max(b));
        let regions = [self.outline, self.copper.map(|copper| &copper.region)];
        for (a, b) in regions.into_iter().flatten().filter_map(Region::extents) {
            take(a, b);
        }
        if let Some((a, b)) = self.stock {
            take(a, b);
        }
        // Coarse chords do.
        walk(self.program, 0.1, &mut |segment| {
            if segment.cuts {
                take(segment.from.truncate(), segment.from.truncate());
                take(segment.to.truncate(), segment.to.truncate());
            }
        });
        match low.is_finite() && high.is_finite() {
            true => [low.extend(0.0), high.extend(0.0)],
            false => [Vec3::ZERO, Vec3::ONE],
        }
    }
}

/// Everything that is drawn, sorted into lines of one look.
struct Drawn {
    outline: Trace,
    /// By colour.
    copper: BTreeMap<usize, Trace>,
    /// By tool.
    cuts: BTreeMap<usize, Trace>,
    rapids: Trace,
    /// What stays that should not.
    rest: Trace,
    tools: Vec<String>,
    /// Cutting length of each tool, mm.
    cutting: BTreeMap<usize, f64>,
    rapid: f64,
    nets: usize,
}

impl Drawn {
    fn of(picture: &BoardPicture, view: &View, tolerance: f64) -> Drawn {
        let pen = || Trace::new(tolerance);
        let chord = tolerance / view.scale;
        let mut drawn = Drawn {
            outline: pen(),
            copper: BTreeMap::new(),
            cuts: BTreeMap::new(),
            rapids: pen(),
            rest: pen(),
            tools: Vec::new(),
            cutting: BTreeMap::new(),
            rapid: 0.0,
            nets: 0,
        };
        for ring in picture.outline.into_iter().flat_map(Region::rings) {
            trace(&mut drawn.outline, ring, view, chord);
        }
        for ring in picture.rest.iter().flat_map(Region::rings) {
            trace(&mut drawn.rest, ring, view, chord);
        }
        if let Some(copper) = picture.copper {
            // Islands of one net have one colour; one without a net has its own.
            let mut known: BTreeMap<&str, usize> = BTreeMap::new();
            let nets = copper.nets.iter().chain(std::iter::repeat(&None));
            for (island, net) in copper.region.islands().iter().zip(nets) {
                let next = drawn.nets;
                let index = match net {
                    Some(net) => *known.entry(net).or_insert(next),
                    None => next,
                };
                drawn.nets += usize::from(index == next);
                let pen = drawn.copper.entry(index % NETS.len()).or_insert_with(pen);
                for ring in std::iter::once(island.outer()).chain(island.holes()) {
                    trace(pen, ring, view, chord);
                }
            }
        }
        drawn.tools = walk(picture.program, chord, &mut |segment| {
            let (from, to) = (view.at(flat(segment.from)), view.at(flat(segment.to)));
            if segment.cuts {
                *drawn.cutting.entry(segment.tool).or_default() += segment.length;
                drawn.cuts.entry(segment.tool).or_insert_with(pen).segment(from, to);
            } else {
                drawn.rapid += segment.length;
                drawn.rapids.segment(from, to);
            }
        });
        drawn
    }

    fn points(&self) -> usize {
        let many =
            |traces: &BTreeMap<usize, Trace>| traces.values().map(Trace::points).sum::<usize>();
        let single = [&self.outline, &self.rapids, &self.rest].map(Trace::points);
        single.into_iter().sum::<usize>() + many(&self.copper) + many(&self.cuts)
    }

    fn write(self, out: &mut String, title: &str, picture: &BoardPicture, view: &View) {
        let left = FIELD[1].x + 40.0;
        write_text(out, &shorten(title, 26), DVec2::new(left, 36.0), 11.0, INK);
        legend(out, &self, picture, left);
        if let Some((low, high)) = picture.stock {
            let (a, b) = (view.at(low.extend(0.0)), view.at(high.extend(0.0)));
            let _ = writeln!(
                out,
                "<path {STOCK} d=\"M{:.1} {:.1}H{:.1}V{:.1}H{:.1}Z\"/>",
                a.x, a.y, b.x, b.y, a.x
            );
        }
        area(out, self.outline, BASE, EDGE);
        for (color, trace) in self.copper {
            area(out, trace, NETS[color % NETS.len()], "none");
        }
        holes(out, picture.holes, view);
        for (tool, trace) in self.cuts {
            let width = picture.widths.get(tool.saturating_sub(1)).copied().unwrap_or_default();
            let band = width * view.scale;
            let data = trace.finish();
            for (width, opacity) in [(band, 0.4), (0.7, 1.0)] {
                let _ = writeln!(
                    out,
                    "<path transform=\"scale(.1)\" stroke=\"{}\" stroke-width=\"{:.1}\" \
                     stroke-opacity=\"{opacity}\" d=\"{data}\"/>",
                    color(tool),
                    width * 10.0
                );
            }
        }
        lines(out, self.rapids, RAPID, 0.7, "stroke-dasharray=\"50 35\"");
        turning(out, picture, view);
        area(out, self.rest, PROBLEM, PROBLEM);
        for tab in picture.tabs {
            let (from, to) = (view.at(tab.start.extend(0.0)), view.at(tab.end.extend(0.0)));
            let _ = writeln!(
                out,
                "<path stroke=\"{TAB}\" stroke-width=\"5\" stroke-linecap=\"butt\" d=\"M{:.1} {:.1}L{:.1} {:.1}\"/>",
                from.x, from.y, to.x, to.y
            );
        }
        let marked = picture.problems.iter().take(MOST_MARKED);
        let rings: Vec<DVec2> = marked.map(|place| view.at(place.at.extend(0.0))).collect();
        for at in &rings {
            let _ = writeln!(
                out,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{MARK}\" stroke=\"{PROBLEM}\" stroke-width=\"2.4\"/>",
                at.x, at.y
            );
        }
        for group in overlapping(&rings) {
            let numbers: Vec<String> = group.iter().map(|i| (i + 1).to_string()).collect();
            let corner = group.iter().map(|i| rings[*i]).reduce(DVec2::min).unwrap_or_default();
            // One alone has its number beside it, several have theirs above all of them.
            let label = match group.len() {
                1 => corner + DVec2::new(MARK, -MARK),
                _ => corner + DVec2::new(-MARK, -MARK - 4.0),
            };
            write_text(out, &numbers.join(", "), label, 9.0, PROBLEM);
        }
    }
}

/// Rings around places, by those that overlap each other or others between them, each group in their order.
fn overlapping(rings: &[DVec2]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, ring) in rings.iter().enumerate() {
        let touches =
            |group: &Vec<usize>| group.iter().any(|k| rings[*k].distance(*ring) < 2.0 * MARK);
        let (near, mut apart): (Vec<_>, Vec<_>) = groups.into_iter().partition(touches);
        let mut group = near.concat();
        group.sort_unstable();
        group.push(i);
        apart.push(group);
        groups = apart;
    }
    groups
}

/// The line about which the board is turned over, from end to end of it and a little farther.
fn turning(out: &mut String, picture: &BoardPicture, view: &View) {
    let Some(axis) = picture.turning else { return };
    let [low, high] = picture.extents();
    let ends = match axis {
        Axis::X(x) => [Vec3 { x, ..low }, Vec3 { x, ..high }],
        Axis::Y(y) => [Vec3 { y, ..low }, Vec3 { y, ..high }],
    };
    let [from, to] = ends.map(|end| view.at(end));
    let away = (to - from).normalize_or_zero() * MARK;
    let (from, to) = (from - away, to + away);
    let _ = writeln!(
        out,
        "<path {TURNING} d=\"M{:.1} {:.1}L{:.1} {:.1}\"/>",
        from.x, from.y, to.x, to.y
    );
}

fn flat(point: Vec3) -> Vec3 {
    Vec3 { z: 0.0, ..point }
}

/// Draws a ring, its arcs as chords that are within `chord` mm of them.
fn trace(pen: &mut Trace, ring: &Ring, view: &View, chord: f64) {
    for element in ring.elements() {
        let pieces = chords(element, chord);
        let mut from = element.start;
        for i in 1..=pieces {
            let to = element.at(f64::from(i) / f64::from(pieces));
            pen.segment(view.at(from.extend(0.0)), view.at(to.extend(0.0)));
            from = to;
        }
    }
}

/// Into how many chords an element is cut so that none is farther than `chord` mm from it.
fn chords(element: &Element, chord: f64) -> u32 {
    let Some((turn, radius)) = element.turn.zip(element.radius()) else { return 1 };
    let step = 2.0 * (1.0 - (chord / radius).min(0.5)).acos();
    (turn.sweep.abs().min(TAU) / step).ceil().clamp(1.0, 1e4) as u32
}

/// What closed lines enclose.
fn area(out: &mut String, trace: Trace, fill: &str, stroke: &str) {
    let data = trace.finish();
    if !data.is_empty() {
        let _ = writeln!(
            out,
            "<path transform=\"scale(.1)\" fill=\"{fill}\" fill-rule=\"evenodd\" stroke=\"{stroke}\" \
             stroke-width=\"8\" d=\"{data}\"/>"
        );
    }
}

/// The holes, as strokes of their width with round ends.
fn holes(out: &mut String, holes: &[Hole], view: &View) {
    let widths = widths(holes);
    for hole in holes.iter().take(MAX_HOLES) {
        let at = |point: Vec2| view.at(point.extend(0.0));
        let mut data = String::new();
        let mut go = |letter: char, point: Vec2| {
            let place = at(point);
            let _ = write!(data, "{letter}{:.1} {:.1}", place.x, place.y);
        };
        match &hole.shape {
            HoleShape::Round(center) => {
                go('M', *center);
                go('L', *center);
            }
            HoleShape::Slot(from, to) => {
                go('M', *from);
                go('L', *to);
            }
            HoleShape::Route(elements) => {
                for (i, element) in elements.iter().enumerate() {
                    if i == 0 {
                        go('M', element.start);
                    }
                    let pieces = chords(element, TOLERANCE / view.scale);
                    for k in 1..=pieces {
                        go('L', element.at(f64::from(k) / f64::from(pieces)));
                    }
                }
            }
        }
        let width = hole.diameter * view.scale;
        let color = hole_color(widths.keys().position(|key| *key == key_of(hole)));
        let _ =
            writeln!(out, "<path stroke=\"{color}\" stroke-width=\"{width:.2}\" d=\"{data}\"/>");
    }
}

/// The width of a hole in µm.
fn key_of(hole: &Hole) -> i64 {
    (hole.diameter * 1e3).round() as i64
}

/// How many holes and slots of each width there are, in µm.
fn widths<'a>(holes: impl IntoIterator<Item = &'a Hole>) -> BTreeMap<i64, [usize; 2]> {
    let mut widths = BTreeMap::<_, [usize; 2]>::new();
    for hole in holes {
        let is_slot = !matches!(hole.shape, HoleShape::Round(_));
        widths.entry(key_of(hole)).or_default()[usize::from(is_slot)] += 1;
    }
    widths
}

fn hole_color(index: Option<usize>) -> &'static str {
    HOLES[index.unwrap_or(0) % HOLES.len()]
}

fn color(tool: usize) -> String {
    let [r, g, b] = COLORS[tool.saturating_sub(1) % COLORS.len()].map(|c| c as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A line of the legend: how its sample is drawn, what it is, and more about it.
struct Entry {
    stroke: String,
    text: String,
    more: Vec<String>,
}

/// Words in lines no wider than `most` pixels for letters `height` pixels tall; a word that is wider is divided.
fn wrapped(text: &str, height: f64, most: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    for word in text.split(' ') {
        let mut rest = word.to_owned();
        loop {
            let longer = if line.is_empty() { rest.clone() } else { format!("{line} {rest}") };
            if lettering::width(&longer, height) <= most {
                line = longer;
                break;
            }
            if !line.is_empty() {
                lines.push(std::mem::take(&mut line));
                continue;
            }
            let fits = |count: &usize| {
                let part: String = rest.chars().take(*count).collect();
                lettering::width(&part, height) <= most
            };
            let count = (1..rest.chars().count()).rev().find(fits).unwrap_or(1);
            lines.push(rest.chars().take(count).collect());
            rest = rest.chars().skip(count).collect();
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// Heights of letters of the legend, pixels: of what an entry is, and of more about it.
const LETTERS: [f64; 2] = [8.0, 6.5];

/// Where the text of the legend begins behind its samples, pixels.
const INDENT: f64 = 34.0;

/// What is seen, with lengths. Where there is more than has room, the last line says how much is left out.
fn legend(out: &mut String, drawn: &Drawn, picture: &BoardPicture, left: f64) {
    let entries = entries(drawn, picture);
    let height = |entry: &Entry| 19.0 + 11.0 * entry.more.len() as f64;
    let all: f64 = entries.iter().map(height).sum();
    let k = ((LEGEND[1] - LEGEND[0]) / all).clamp(SMALLEST, 1.0);
    let mut y = LEGEND[0];
    for (i, Entry { stroke, text, more }) in entries.iter().enumerate() {
        let is_last = i + 1 == entries.len();
        let room = if is_last { LEGEND[1] } else { LEGEND[1] - 19.0 * k };
        if y + k * (height(&entries[i]) - 19.0) > room + 1e-6 {
            let rest = format!("{} LINES MORE: SEE REPORT.JSON", entries.len() - i);
            write_text(out, &rest, DVec2::new(left, y), LETTERS[0] * k, PROBLEM);
            break;
        }
        if !stroke.is_empty() {
            let _ = writeln!(out, "<path {stroke} d=\"M{left} {:.1}h24\"/>", y - 4.0 * k);
        }
        write_text(out, text, DVec2::new(left + INDENT, y), LETTERS[0] * k, INK);
        for line in more {
            y += 11.0 * k;
            write_text(out, line, DVec2::new(left + INDENT, y), LETTERS[1] * k, QUIET);
        }
        y += 19.0 * k;
    }
}

/// All that the legend says, in its order.
fn entries(drawn: &Drawn, picture: &BoardPicture) -> Vec<Entry> {
    let mut entries = Vec::new();
    let wide = LEGEND[2] - INDENT;
    let mut entry = |stroke: String, text: &str, more: &str| {
        let mut lines = wrapped(text, LETTERS[0], wide);
        let more = if more.is_empty() { Vec::new() } else { wrapped(more, LETTERS[1], wide) };
        let first = if lines.is_empty() { String::new() } else { lines.remove(0) };
        let more = lines.into_iter().chain(more).collect();
        entries.push(Entry { stroke, text: first, more });
    };
    for (tool, length) in &drawn.cutting {
        let stroke = format!("stroke=\"{}\" stroke-width=\"3\"", color(*tool));
        let name = drawn.tools.get(*tool).map_or("", String::as_str);
        entry(stroke, name, &format!("{length:.0} MM CUT"));
    }
    let stroke = format!("stroke=\"{RAPID}\" stroke-width=\"1\" stroke-dasharray=\"5 3.5\"");
    entry(stroke, "RAPID", &format!("{:.0} MM", drawn.rapid));
    if picture.copper.is_some() {
        let text = format!("COPPER, {} NETS", drawn.nets);
        entry(format!("stroke=\"{}\" stroke-width=\"8\"", NETS[0]), &text, "");
    }
    for (i, (width, counts)) in widths(picture.holes).into_iter().enumerate() {
        for (count, what) in
            counts.into_iter().zip(["HOLE", "SLOT"]).filter(|(count, _)| *count > 0)
        {
            let stroke = format!("stroke=\"{}\" stroke-width=\"6\"", hole_color(Some(i)));
            let plural = if count == 1 { "" } else { "S" };
            entry(stroke, &format!("{count} {what}{plural} OF {} MM", width as f64 / 1e3), "");
        }
    }
    if picture.holes.len() > MAX_HOLES {
        let text = format!("{} HOLES ARE NOT DRAWN", picture.holes.len() - MAX_HOLES);
        entry(String::new(), &text, "");
    }
    if !picture.tabs.is_empty() {
        let plural = if picture.tabs.len() == 1 { "" } else { "S" };
        let text = format!("{} TAB{plural}", picture.tabs.len());
        entry(format!("stroke=\"{TAB}\" stroke-width=\"5\" stroke-linecap=\"butt\""), &text, "");
    }
    if let Some((low, high)) = picture.stock {
        let size = high - low;
        let more = format!("X {:.3} TO {:.3}, Y {:.3} TO {:.3}", low.x, high.x, low.y, high.y);
        entry(STOCK.to_owned(), &format!("BLANK, {:.1} X {:.1} MM", size.x, size.y), &more);
    }
    match picture.turning {
        Some(Axis::X(at)) => entry(TURNING.to_owned(), "TURNING LINE", &format!("X {at:.3}")),
        Some(Axis::Y(at)) => entry(TURNING.to_owned(), "TURNING LINE", &format!("Y {at:.3}")),
        None => {}
    }
    let problems = picture.problems;
    if picture.rest.iter().any(|rest| !rest.is_empty()) {
        let stroke = format!("stroke=\"{PROBLEM}\" stroke-width=\"8\"");
        entry(stroke, "STAYS, AND SHOULD NOT", "");
    }
    if !problems.is_empty() {
        let stroke = format!("stroke=\"{PROBLEM}\" stroke-width=\"2.4\"");
        let more = match problems.len().saturating_sub(MOST_MARKED) {
            0 => String::new(),
            more => format!("THE {MOST_MARKED} WORST ARE MARKED, {more} OTHERS SHADED ALONE"),
        };
        entry(stroke, &format!("{} PLACES TO LOOK AT", problems.len()), &more);
    }
    for (i, Problem { at, what, .. }) in problems.iter().take(MOST_MARKED).enumerate() {
        entry(String::new(), &format!("{}: X{:.2} Y{:.2}", i + 1, at.x, at.y), what);
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::region::Fill;
    use pcb::job::{Heights, program};
    use pcb::plan::ProblemKind;
    use pcb::{Cut, Cutter, Operation, Segment, Tool};

    #[test]
    fn no_line_of_the_legend_is_cut_off() {
        let text =
            "N-00007 and N-00012 are 0.137 mm apart over 12.07 mm, left out: they stay joined here";
        let lines = wrapped(text, 6.5, 228.0);
        assert!(lines.len() > 1 && lines.join(" ") == text, "{lines:?}");
        assert!(lines.iter().all(|line| lettering::width(line, 6.5) <= 228.0));
        let long = "X".repeat(200);
        let lines = wrapped(&long, 6.5, 228.0);
        assert!(
            lines.concat() == long && lines.iter().all(|line| lettering::width(line, 6.5) <= 228.0)
        );
    }

    /// Of rings that overlap nobody can tell whose number is whose.
    #[test]
    fn rings_that_overlap_have_their_numbers_together() {
        let rings = [0.0, 100.0, 40.0, 129.0, 20.0, 200.0].map(|x| DVec2::new(x, 50.0));
        assert_eq!(overlapping(&rings), [vec![1, 3], vec![0, 2, 4], vec![5]]);
        assert!(overlapping(&[]).is_empty());
    }

    /// Six colours stood for all widths: a board of KiCad's demos with fourteen had three of each.
    #[test]
    fn each_of_sixteen_widths_of_holes_has_a_colour_of_its_own() {
        let mut colors: Vec<&str> = (0..16).map(|i| hole_color(Some(i))).collect();
        colors.sort_unstable();
        colors.dedup();
        assert_eq!(colors.len(), 16);
    }

    #[test]
    fn a_board_shows_its_copper_its_cut_as_wide_as_the_tool_and_its_problems() {
        let copper =
            Copper { region: Region::disc(Vec2::splat(10.0), 4.0).unwrap(), nets: vec![None] };
        let ring = copper.region.offset(0.5).unwrap();
        let corners = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)].map(Vec2::from);
        let outline = Region::inside(&[Ring::polygon(&corners).unwrap()], Fill::NonZero).unwrap();
        let segments = ring.rings().flat_map(|ring| ring.elements().to_vec());
        let cuts =
            vec![Cut::Path(segments.map(|element| Segment { element, depth: 0.1 }).collect())];
        let cutter = Cutter::Cylinder { diameter: 1.0 };
        let tool = Tool { name: "MILL".into(), cutter, feed: 100.0, plunge: 50.0, speed: 9000.0 };
        let operation = Operation { name: "isolation".into(), tool, cuts };
        let heights = Heights { travel: 2.0, approach: 0.5 };
        let program = program("disc", &[(1, &operation)], &heights).unwrap();
        let hole = Hole { shape: HoleShape::Round(Vec2::splat(10.0)), diameter: 1.0, plated: None };
        let picture = BoardPicture {
            outline: Some(&outline),
            copper: Some(&copper),
            holes: &[hole],
            program: &program,
            widths: &[1.0],
            problems: &[Problem {
                at: Vec2::splat(12.0),
                kind: ProblemKind::Joined,
                what: "too narrow".into(),
            }],
            rest: &[],
            turning: Some(Axis::X(10.0)),
            tabs: &[Element::line(Vec2::new(8.0, 0.0), Vec2::new(12.0, 0.0))],
            stock: None,
        };
        let svg = board("disc", &picture);
        // The board is 20 mm high and fills 680 pixels: a tool of 1 mm is 34 of them wide, 340 tenths.
        assert!(svg.contains("stroke-width=\"340.0\""), "{svg}");
        // From the lower to the upper edge, in the middle, and 15 pixels farther.
        assert!(svg.contains("d=\"M460.0 735.0L460.0 25.0\"") && svg.contains("X 10.000"), "{svg}");
        assert!(svg.contains("1 HOLE OF 1 MM") && svg.contains("1: X12.00 Y12.00"));
        // 8 to 12 mm of 20 on the lower edge.
        assert!(
            svg.contains("d=\"M392.0 720.0L528.0 720.0\"") && svg.contains("\"1 TAB\""),
            "{svg}"
        );
        assert_eq!(svg.matches("<circle").count(), 1);
        assert!(svg.contains(&format!("fill=\"{}\"", NETS[0])));
    }
}
