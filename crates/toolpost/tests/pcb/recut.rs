//! The copper that a program leaves: its blocks are read by the virtual control, swept by the tool, and taken
//! away from a sheet of copper. What is left has to be the copper of the Gerber file, net by net.

use crate::scanlines::{Groups, Lines};
use app::Origin;
use geom::Vec2;
use pcb::board::Copper;
use pcb::gerber::{self, Image};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// From scan line to scan line, mm.
const STEP: f64 = 0.02;

/// How far a cut may be from where it was planned, mm: paths are merged within 5 µm, a cut counts as fitting in a gap that is
/// 2 µm narrower, the middle of a gap is found within 1 µm, and regions and words are exact to 1 µm each.
const TOLERANCE: f64 = 0.009;

/// What a cut down the middle of a narrow gap takes from a side at most, mm: as it is promised to the user.
const BITE: f64 = 0.03;

/// A board whose copper was cut.
struct Made {
    folder: tempfile::TempDir,
    machine: &'static str,
    /// How wide the tool is, mm.
    width: f64,
    /// How much copper it may take from a side of a gap that is narrower, mm.
    bite: f64,
    report: Value,
}

impl Made {
    /// Cuts the copper of a board by an end mill.
    fn of(board: &Path, machine: &'static str, width: f64, more: &[&str]) -> Made {
        Made::by(&["--tool", &width.to_string()], board, machine, width, more)
    }

    /// Cuts the copper of a board by a tool that cuts so wide; the board stays where its files have it.
    fn by(tool: &[&str], board: &Path, machine: &'static str, width: f64, more: &[&str]) -> Made {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().display().to_string();
        let board = board.display().to_string();
        let mut words = vec!["toolpost", "--quiet", "pcb", &board, "-m", machine, "-o", &output];
        words.extend(tool);
        words.extend(["--as-drawn", "--picture", "none"]);
        words.extend(more);
        assert_eq!(toolpost::run(words.iter().map(Into::into), None), 0, "{words:?}");
        let report = std::fs::read(folder.path().join("report.json")).unwrap();
        let bite = if more.contains(&"leave-out") { 0.0 } else { BITE };
        Made { report: serde_json::from_slice(&report).unwrap(), folder, machine, width, bite }
    }

    /// The file of the program of a side.
    fn file(&self, side: &str) -> std::path::PathBuf {
        let extension = machine::load(self.machine).unwrap().extension;
        self.folder.path().join(side).with_extension(extension)
    }

    /// What a tool that is narrower by `less` mm on either side cuts for certain in the copper of a side, in the coordinates of
    /// the Gerber file.
    fn cut(&self, side: &str, lines: &Lines, less: f64) -> Lines {
        let file = self.file(side);
        let origin = Origin { from: Some(self.machine.to_owned()), ..Origin::default() };
        let read = app::toolpath::read(
            &file.as_path().into(),
            false,
            &origin,
            None,
            program::Purpose::Program,
        )
        .unwrap();
        let x = |corner: &str| self.report["board"][corner][0].as_f64().unwrap();
        let both = x("low_mm") + x("high_mm");
        let mut cut = lines.clone();
        drawing::walk(&read.program, 1e-4, &mut |segment| {
            if !segment.cuts || segment.from.z.min(segment.to.z) >= 0.0 {
                return;
            }
            let place = |point: geom::Vec3| match side {
                "back" => Vec2::new(both - point.x, point.y),
                _ => point.truncate(),
            };
            let (from, to) = (place(segment.from), place(segment.to));
            cut.sweep(from, to, self.width / 2.0 - TOLERANCE - less);
        });
        cut.tidy();
        cut
    }

    /// Where nets are reported to stay joined, in the coordinates of the Gerber file.
    fn places(&self, side: &str) -> Vec<Vec2> {
        let x = |corner: &str| self.report["board"][corner][0].as_f64().unwrap();
        let both = x("low_mm") + x("high_mm");
        let programs = self.report["programs"].as_array().unwrap();
        let program = programs.iter().find(|program| program["name"] == side).unwrap();
        let number = |value: &Value| value.as_f64().unwrap();
        let place = |place: &Value| Vec2::new(number(&place["x"]), number(&place["y"]));
        let joined = |place: &&Value| place["kind"] == "joined";
        let seen = program["places"].as_array().unwrap().iter().filter(joined).map(place);
        seen.map(|place| if side == "back" { Vec2::new(both - place.x, place.y) } else { place })
            .collect()
    }

    /// Compares a side with the image of its copper, within the box of four lines that is the edge of the board, where it is
    /// given.
    fn check(&self, side: &str, file: &Path, edge: Option<&Path>) {
        let text = std::fs::read(file).unwrap();
        let image = gerber::read(&file.display().to_string(), &text).unwrap().image;
        let Some((low, high)) = image.extents() else {
            return assert!(!self.file(side).exists());
        };
        let (low, high) = (low - Vec2::splat(2.0), high + Vec2::splat(2.0));
        let none = Lines::none(low.y, high.y, STEP);
        let mut copper = none.clone();
        copper.paint(&image);
        if let Some(edge) = edge {
            let mut board = none.clone();
            board.paint(&inside(edge));
            copper = copper.within(&board);
        }
        let cut = self.cut(side, &none, 0.0);
        // No copper is cut that is farther than a bite from its edge.
        let thinned = copper.within(&self.cut(side, &none, self.bite));
        let (area, file) = (thinned.area(), file.display());
        assert!(area < 1e-6, "{file}: {area} mm² of copper are cut, first {:?}", thinned.first());
        self.nets(side, &image, &copper, &cut);
        assert!(cut.area() > 0.0);
    }

    /// Each piece of copper has to be in one piece of what is left; two in one piece have to be of one net,
    /// or near each other at a place that is listed.
    fn nets(&self, side: &str, image: &Image, copper: &Lines, cut: &Lines) {
        let (low, high) = image.extents().unwrap();
        let left = copper.filled(low.x - 2.0, high.x + 2.0).without(cut);
        let kept = copper.without(cut);
        let (mut conductors, mut pieces) = (copper.pieces(), left.pieces());
        let named = Copper::of_image(image).unwrap().0;
        let index = geom::region::Index::new(&named.region);
        // Of each conductor the net, and the piece that it is in.
        let mut nets: BTreeMap<usize, Option<&str>> = BTreeMap::new();
        let mut within: BTreeMap<usize, usize> = BTreeMap::new();
        let mut seen: BTreeMap<usize, Vec2> = BTreeMap::new();
        for (line, spans) in kept.lines.iter().enumerate() {
            for span in spans {
                // What is this narrow touches a line by rounding.
                if span.1 - span.0 < 2.0 * TOLERANCE {
                    continue;
                }
                let middle = Vec2::new((span.0 + span.1) / 2.0, copper.y(line));
                let Some((_, i)) = copper.nearest(middle) else { panic!("no copper") };
                let conductor = conductors.of(line, i);
                let net = index.island_at(middle).and_then(|island| named.nets[island].as_deref());
                nets.entry(conductor).or_insert(net);
                let Some((_, k)) = left.nearest(middle) else { panic!("nothing is left") };
                let piece = pieces.of(line, k);
                seen.entry(conductor).or_insert(middle);
                let first = *within.entry(conductor).or_insert(piece);
                assert_eq!(first, piece, "{side}: {middle} is parted from the rest of its net");
            }
        }
        let mut joined = Groups::new(copper.lines.iter().map(Vec::len).sum());
        let mut known: BTreeMap<&str, usize> = BTreeMap::new();
        for (conductor, net) in &nets {
            if let Some(net) = net {
                joined.join(*conductor, *known.entry(net).or_insert(*conductor));
            }
        }
        for place in self.places(side) {
            // A place that is listed is between two of them, nearer than the cut is wide.
            let around = copper.around(place, self.width / 2.0 + STEP);
            let around: BTreeSet<usize> =
                around.into_iter().map(|(line, i)| conductors.of(line, i)).collect();
            assert!(around.len() > 1, "{side}: nothing is narrow at {place}");
            around.iter().zip(around.iter().skip(1)).for_each(|(a, b)| joined.join(*a, *b));
        }
        let mut holds: BTreeMap<usize, usize> = BTreeMap::new();
        for (conductor, piece) in &within {
            let first = *holds.entry(*piece).or_insert(*conductor);
            assert_eq!(
                joined.of(first),
                joined.of(*conductor),
                "{side}: {:?} at {} and {:?} at {} are not parted",
                nets[&first],
                seen[&first],
                nets[conductor],
                seen[conductor]
            );
        }
        let conductors: Vec<usize> = within.keys().map(|conductor| joined.of(*conductor)).collect();
        assert!(!conductors.is_empty());
    }
}

/// What is inside four lines, filled.
fn inside(edge: &Path) -> Image {
    let text = std::fs::read(edge).unwrap();
    let image = gerber::read("edge", &text).unwrap().image;
    let lines: Vec<geom::Element> =
        image.objects.iter().filter_map(|object| Some(image.stroke(object)?.0)).collect();
    let is_upright =
        |line: &geom::Element| line.start.x == line.end.x || line.start.y == line.end.y;
    assert!(lines.len() == 4 && lines.iter().all(is_upright));
    let ends = || lines.iter().flat_map(|line| [line.start, line.end]);
    let (low, high) = (ends().reduce(Vec2::min).unwrap(), ends().reduce(Vec2::max).unwrap());
    let at = |x: f64, y: f64| format!("X{:.0}Y{:.0}", x * 1e6, y * 1e6);
    let filled = format!(
        "%FSLAX46Y46*%%MOMM*%G01*G36*{}D02*{}D01*{}D01*{}D01*{}D01*G37*M02*",
        at(low.x, low.y),
        at(high.x, low.y),
        at(high.x, high.y),
        at(low.x, high.y),
        at(low.x, low.y)
    );
    gerber::read("filled", filled.as_bytes()).unwrap().image
}

/// The copper files of a board of KiCad's.
fn copper(board: &Path) -> [(&'static str, PathBuf); 2] {
    let name = board.file_name().unwrap().to_string_lossy().into_owned();
    let file = |side: &str| board.join(format!("{name}-{side}_Cu.gbr"));
    [("front", file("F")), ("back", file("B"))]
}

/// The boards of KiCad, with a tool that fits between most of their nets.
const BOARDS: &[(&str, f64)] = &[
    ("StickHub", 0.2),
    ("carte_test", 0.2),
    ("ecc83-pp", 0.2),
    ("interf_u", 0.2),
    ("kit-dev-coldfire-xilinx_5213", 0.12),
    ("microwave", 0.2),
    ("pic_programmer", 0.2),
];

#[test]
fn what_a_program_for_grbl_leaves_is_the_copper_net_by_net() {
    let Some(data) = judge::data("gerber") else { return };
    for (name, width) in BOARDS {
        let board = data.join("kicad").join(name);
        let made = Made::of(&board, "grbl-3018", *width, &[]);
        for (side, file) in copper(&board) {
            made.check(side, &file, None);
        }
    }
}

#[test]
fn what_a_v_bit_leaves_is_the_copper_net_by_net() {
    let Some(data) = judge::data("gerber") else { return };
    // A tip of 0.1 mm, 0.1 mm deep: as wide as a usual gap between tracks, to 2 µm.
    let width = 0.1 + 0.2 * 15_f64.to_radians().tan();
    for name in ["StickHub", "pic_programmer"] {
        let board = data.join("kicad").join(name);
        let made = Made::by(&["--vee", "30"], &board, "grbl-3018", width, &[]);
        for (side, file) in copper(&board) {
            made.check(side, &file, None);
        }
    }
}

#[test]
fn what_a_program_for_linuxcnc_leaves_is_the_copper_net_by_net() {
    let Some(data) = judge::data("gerber") else { return };
    for (name, width) in BOARDS {
        let board = data.join("kicad").join(name);
        let more = ["--passes", "2", "--direction", "conventional", "--narrow", "leave-out"];
        let made = Made::of(&board, "linuxcnc-mill", *width, &more);
        for (side, file) in copper(&board) {
            made.check(side, &file, None);
        }
    }
}

#[test]
fn the_large_board_is_cut_right() {
    let Some(data) = judge::data("gerber") else { return };
    let board = data.join("a64");
    for (machine, narrow) in [("grbl-3018", "bite"), ("linuxcnc-mill", "leave-out")] {
        let made = Made::of(&board, machine, 0.15, &["--narrow", narrow]);
        let layer = |name: &str| board.join(format!("A64-OlinuXino_Rev_D-{name}.gbr"));
        for (side, name) in [("front", "F.Cu"), ("back", "B.Cu")] {
            // Pads of its connectors reach beyond the edge.
            made.check(side, &layer(name), Some(&layer("Edge.Cuts")));
        }
    }
}
