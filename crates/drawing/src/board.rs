//! A board from above and what a program does to it: copper by net, cuts as wide as their tools, holes,
//! rapids, places with a problem.

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

/// The most lines of the legend that name tools, and problems.
const LEGEND: (usize, usize) = (8, 10);

/// The most holes that are drawn.
const MAX_HOLES: usize = 50_000;

/// How wide the ring around a problem is, pixels.
const MARK: f64 = 9.0;

/// The board without its copper.
const BASE: &str = "#efe9d2";
const EDGE: &str = "#8d8663";
const HOLE: &str = "#4a4f55";
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
        legend(out, &self, picture, DVec2::new(left, 66.0));
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
        for problem in picture.problems.iter().take(LEGEND.1) {
            let at = view.at(problem.at.extend(0.0));
            let _ = writeln!(
                out,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{MARK}\" stroke=\"{PROBLEM}\" stroke-width=\"1.6\"/>",
                at.x, at.y
            );
        }
    }
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
        let _ = writeln!(out, "<path stroke=\"{HOLE}\" stroke-width=\"{width:.2}\" d=\"{data}\"/>");
    }
}

fn color(tool: usize) -> String {
    let [r, g, b] = COLORS[tool.saturating_sub(1) % COLORS.len()].map(|c| c as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// What is seen, with lengths.
fn legend(out: &mut String, drawn: &Drawn, picture: &BoardPicture, mut at: DVec2) {
    let mut entry = |out: &mut String, stroke: &str, text: &str, more: &str| {
        let _ = writeln!(out, "<path {stroke} d=\"M{} {}h26\"/>", at.x, at.y - 4.5);
        write_text(out, &shorten(text, 28), at + DVec2::new(36.0, 0.0), 9.0, INK);
        if !more.is_empty() {
            at.y += 17.0;
            write_text(out, &shorten(more, 28), at + DVec2::new(36.0, 0.0), 8.0, QUIET);
        }
        at.y += 25.0;
    };
    if picture.copper.is_some() {
        let text = format!("COPPER, {} NETS", drawn.nets);
        entry(out, &format!("stroke=\"{}\" stroke-width=\"8\"", NETS[0]), &text, "");
    }
    if !picture.holes.is_empty() {
        let text = format!("{} HOLES", picture.holes.len());
        entry(out, &format!("stroke=\"{HOLE}\" stroke-width=\"6\""), &text, "");
    }
    for (tool, length) in drawn.cutting.iter().take(LEGEND.0) {
        let stroke = format!("stroke=\"{}\" stroke-width=\"3\"", color(*tool));
        let name = drawn.tools.get(*tool).map_or("", String::as_str);
        entry(out, &stroke, name, &format!("{length:.0} MM CUT"));
    }
    if drawn.cutting.len() > LEGEND.0 {
        let more = format!("{} MORE TOOLS", drawn.cutting.len() - LEGEND.0);
        entry(out, "stroke=\"none\"", &more, "");
    }
    let stroke = format!("stroke=\"{RAPID}\" stroke-width=\"1\" stroke-dasharray=\"5 3.5\"");
    entry(out, &stroke, "RAPID", &format!("{:.0} MM", drawn.rapid));
    match picture.turning {
        Some(Axis::X(at)) => entry(out, TURNING, "TURNING LINE", &format!("X {at:.3}")),
        Some(Axis::Y(at)) => entry(out, TURNING, "TURNING LINE", &format!("Y {at:.3}")),
        None => {}
    }
    if !picture.problems.is_empty() {
        let text = format!("{} PLACES TO LOOK AT", picture.problems.len());
        entry(out, &format!("stroke=\"{PROBLEM}\" stroke-width=\"2\""), &text, "");
        for Problem { at, what, .. } in picture.problems.iter().take(LEGEND.1) {
            let where_ = format!("X{:.2} Y{:.2}", at.x, at.y);
            entry(out, "stroke=\"none\"", &where_, what);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::region::Fill;
    use pcb::job::{Heights, program};
    use pcb::plan::ProblemKind;
    use pcb::{Cut, Cutter, Operation, Segment, Tool};

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
        };
        let svg = board("disc", &picture);
        // The board is 20 mm high and fills 680 pixels: a tool of 1 mm is 34 of them wide, 340 tenths.
        assert!(svg.contains("stroke-width=\"340.0\""), "{svg}");
        // From the lower to the upper edge, in the middle, and 9 pixels farther.
        assert!(svg.contains("d=\"M460.0 729.0L460.0 31.0\"") && svg.contains("X 10.000"), "{svg}");
        assert!(svg.contains("1 HOLES") && svg.contains("X12.00 Y12.00"));
        assert_eq!(svg.matches("<circle").count(), 1);
        assert!(svg.contains(&format!("fill=\"{}\"", NETS[0])));
    }
}
