//! The lines that moves come from, of a board that is drawn by hand and of real ones.

use crate::data;
use geom::Vec2;
use program::{Op, Program};
use toolpost_pcb::board::{Face, File, artwork};
use toolpost_pcb::job::{Heights, program};
use toolpost_pcb::kicad;
use toolpost_pcb::plan::{self, Part, Settings, Setup, Work};
use toolpost_pcb::{Drawn, LayerFile, Line};

/// A stroke of 1 mm on line 8 and a pad of 2 by 1 mm on line 10.
fn copper(side: &str) -> String {
    format!(
        "%TF.FileFunction,Copper,{side}*%\n%FSLAX46Y46*%\n%MOMM*%\n%ADD10C,1.0*%\n%ADD11R,2X1*%\nD10*\n\
         X2000000Y2000000D02*\nX8000000Y2000000D01*\nD11*\nX15000000Y3000000D03*\nM02*\n"
    )
}

/// A board of 20 by 6 mm: its lower side on line 7, and then around.
const EDGE: &str = "%TF.FileFunction,Profile,NP*%\n%FSLAX46Y46*%\n%MOMM*%\n%ADD10C,0.1*%\nD10*\nX0Y0D02*\n\
    X20000000Y0D01*\nX20000000Y6000000D01*\nX0Y6000000D01*\nX0Y0D01*\nM02*\n";

/// Two holes on lines 6 and 7, and a slot on line 8.
const HOLES: &str =
    "M48\nMETRIC,TZ\nT1C0.800\n%\nT1\nX2.0Y2.0\nX15.0Y3.0\nX8.0Y4.0G85X9.0Y4.0\nM30\n";

/// A cut: where its middle is, and the line that it comes from.
type Cuts = Vec<(Vec2, Option<Line>)>;

/// The cuts of a program, whose first feed behind a rapid goes straight down.
fn cuts(program: &Program, lines: &[Option<Line>]) -> Cuts {
    let (mut at, mut cuts) = (Vec2::ZERO, Vec::new());
    for (record, line) in program.records.iter().zip(lines) {
        let Some(pose) = record.op.pose() else {
            assert_eq!(*line, None, "{record:?}");
            continue;
        };
        let (from, end) = (at, pose.point().truncate());
        at = end;
        match &record.op {
            Op::Line(_) | Op::Hole(_) => {
                let middle =
                    if matches!(record.op, Op::Hole(_)) { end } else { from.midpoint(end) };
                cuts.push((middle, *line));
            }
            // Its middle is as far from its centre as its end.
            Op::Arc(arc) => {
                let center = arc.circle.center().truncate();
                let half = (from - center).angle_to(end - center);
                let turns_left = arc.circle.normal().z > 0.0;
                let half = match (half > 0.0) == turns_left {
                    true => half / 2.0,
                    false => half / 2.0 + std::f64::consts::PI,
                };
                cuts.push((center + Vec2::from_angle(half).rotate(from - center), *line));
            }
            _ => assert_eq!(*line, None, "{record:?}"),
        }
    }
    cuts
}

fn made(settings: &Settings, part: Part, files: &[(&str, &str)]) -> Cuts {
    let named: Vec<File> = files
        .iter()
        .map(|(name, text)| File { name, layer: None, unit: None, text: text.as_bytes() })
        .collect();
    let (artwork, layers) = artwork("board", &named, |_| true).unwrap();
    let layers = files.iter().map(|(name, text)| {
        let (_, layer) = layers.iter().find(|(of, _)| of == name)?;
        Some(LayerFile { name, layer: *layer, unit: None, text: text.as_bytes() })
    });
    let drawn = Drawn::of_layers(&layers.collect::<Vec<_>>()).unwrap();
    cut(settings, part, artwork, &drawn)
}

fn cut(settings: &Settings, part: Part, artwork: toolpost_pcb::Artwork, drawn: &Drawn) -> Cuts {
    let face = plan::face(part, settings);
    let setup = |of: Face, board| (of == face).then(|| Setup::of(of, board, settings).unwrap());
    let (setups, _) = artwork.each_side(setup).unwrap();
    let setup = setups.into_iter().flatten().next().unwrap();
    let work = Work::of(part, &setup, settings, 1e4, &|_| true).unwrap();
    let operations: Vec<_> = work.operations.iter().map(|operation| (1, operation)).collect();
    let program = program("a", &operations, &Heights { travel: 2.0, approach: 0.5 }).unwrap();
    let lines = drawn.lines(part, &setup, settings, &program);
    assert_eq!(lines.len(), program.records.len());
    cuts(&program, &lines)
}

fn settings() -> Settings {
    let mut settings = Settings::default();
    settings.isolation.tool = Some(0.3);
    settings
}

fn from_segment(place: Vec2, a: Vec2, b: Vec2) -> f64 {
    let t = ((place - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    place.distance(a + (b - a) * t)
}

/// How far the middle of the tool is from the copper of a line.
fn from_copper(place: Vec2, line: u32) -> f64 {
    match line {
        8 => from_segment(place, Vec2::new(2.0, 2.0), Vec2::new(8.0, 2.0)) - 0.5,
        10 => {
            let beyond = (place - Vec2::new(15.0, 3.0)).abs() - Vec2::new(1.0, 0.5);
            beyond.max(Vec2::ZERO).length()
        }
        _ => panic!("nothing is drawn on line {line}"),
    }
}

/// Around copper each cut is half the width of the tool from what its line draws, however the board lies.
#[test]
fn a_cut_has_the_line_of_the_copper_that_it_runs_along() {
    let files = |side: &'static str| [("top.gbr", copper(side)), ("edge.gbr", EDGE.to_owned())];
    let straight = |place: Vec2| place;
    // Turned to the left, two next to each other 3 mm apart, with the corner in the zero.
    let on_panel = |place: Vec2| {
        let x = if place.x > 7.5 { place.x - 9.0 } else { place.x };
        Vec2::new(place.y, 6.0 - x)
    };
    let turned_over = |place: Vec2| on_panel(Vec2::new(15.0 - place.x, place.y));
    let plain = settings();
    let mut panel = settings();
    (panel.placing.rotate, panel.placing.panel, panel.placing.spacing) = (90.0, Some([2, 1]), 3.0);
    type Drawing<'a> = &'a dyn Fn(Vec2) -> Vec2;
    let cases: [(&Settings, Part, &'static str, Drawing, usize); 3] = [
        (&plain, Part::Front, "L1,Top", &straight, 1),
        (&panel, Part::Front, "L1,Top", &on_panel, 2),
        (&panel, Part::Back, "L2,Bot", &turned_over, 2),
    ];
    for (settings, part, side, drawn_at, boards) in cases {
        let files = files(side);
        let files = files.each_ref().map(|(name, text)| (*name, &**text));
        let cuts = made(settings, part, &files);
        let mut counts = [0, 0];
        for (place, line) in &cuts {
            let line = line.unwrap_or_else(|| panic!("{part:?}: no line at {place}"));
            assert_eq!(line.file, 0);
            let away = from_copper(drawn_at(*place), line.line);
            assert!((away - 0.15).abs() < 0.01, "{part:?}: {away} at {place}, {line:?}");
            counts[usize::from(line.line == 10)] += 1;
        }
        // Two sides and two ends; four sides and four corners; and a way down for each.
        assert!(counts[0] >= 5 * boards && counts[1] >= 9 * boards, "{part:?}: {counts:?}");
    }
}

#[test]
fn holes_slots_and_edges_have_their_lines() {
    let copper = copper("L1,Top");
    let files = [("top.gbr", &*copper), ("holes.drl", HOLES), ("edge.gbr", EDGE)];
    let cuts = made(&settings(), Part::Drill, &files);
    for (place, line) in &cuts {
        let expected = match (place.x, place.y) {
            (2.0, 2.0) => 6,
            (15.0, 3.0) => 7,
            // The slot is a chain of holes.
            (x, 4.0) if (8.0..=9.0).contains(&x) => 8,
            _ => panic!("no hole is at {place}"),
        };
        assert_eq!(*line, Some(Line { file: 1, line: expected }), "{place}");
    }
    assert!(cuts.len() > 4);
    let mut settings = settings();
    (settings.outline.outline_tool, settings.outline.tabs) = (2.0, 0);
    let cuts = made(&settings, Part::Outline, &files);
    let mut seen = [false; 4];
    for (place, line) in &cuts {
        let line = line.unwrap_or_else(|| panic!("no line at {place}"));
        let away = match line.line {
            7 => -place.y,
            8 => place.x - 20.0,
            9 => place.y - 6.0,
            10 => -place.x,
            _ => panic!("{line:?} at {place}"),
        };
        // At a corner, in the direction of either side.
        assert!(line.file == 2 && (0.7..1.001).contains(&away), "{away} at {place}: {line:?}");
        seen[line.line as usize - 7] = true;
    }
    assert_eq!(seen, [true; 4]);
}

/// Half way between two pads, cut down the middle: of no line.
#[test]
fn a_cut_between_two_has_no_line() {
    let pads = "%FSLAX46Y46*%\n%MOMM*%\n%ADD10R,2X2*%\nD10*\nX2000000Y2000000D03*\nX4200000Y2000000D03*\nM02*\n";
    let mut settings = settings();
    settings.isolation.narrow = toolpost_pcb::isolation::Narrow::Middle;
    let cuts = made(&settings, Part::Front, &[("board.gtl", pads), ("edge.gbr", EDGE)]);
    let middle = cuts
        .iter()
        .filter(|(place, _)| (place.x - 3.1).abs() < 0.01 && (place.y - 2.0).abs() < 0.5);
    let lines: Vec<_> = middle.map(|(_, line)| *line).collect();
    assert!(!lines.is_empty() && lines.iter().all(Option::is_none), "{lines:?}");
    assert!(cuts.iter().any(|(_, line)| *line == Some(Line { file: 0, line: 5 })));
    assert!(cuts.iter().any(|(_, line)| *line == Some(Line { file: 0, line: 6 })));
}

/// On a real board of 19066 cuts along copper those without a line are links and cuts in the middle of gaps, which the tool just fills; all
/// lines are such as draw: a draw, a flash or the end of a region.
#[test]
fn the_lines_of_real_boards_draw() {
    let Some(folder) = data::folder() else { return };
    let paths = data::files(&folder.join("a64"), "");
    let texts: Vec<String> =
        paths.iter().map(|path| String::from_utf8_lossy(&data::bytes(path)).into_owned()).collect();
    let names: Vec<String> = paths.iter().map(|path| path.to_string_lossy().into()).collect();
    let files: Vec<(&str, &str)> =
        names.iter().zip(&texts).map(|(name, text)| (name.as_str(), text.as_str())).collect();
    for part in [Part::Front, Part::Drill, Part::Outline] {
        let cuts = made(&settings(), part, &files);
        let known: Vec<Line> = cuts.iter().filter_map(|(_, line)| *line).collect();
        let least = if part == Part::Front { 85 } else { 100 };
        assert!(
            known.len() * 100 >= cuts.len() * least,
            "{part:?}: {} of {}",
            known.len(),
            cuts.len()
        );
        for Line { file, line } in known {
            let text = texts[file as usize].lines().nth(line as usize - 1).unwrap();
            let draws = match part {
                Part::Drill => text.starts_with(['X', 'Y']),
                _ => ["D01*", "D03*", "G37*"].iter().any(|end| text.ends_with(end)),
            };
            assert!(draws, "{}:{line}: {text}", names[file as usize]);
        }
    }
}

#[test]
fn the_lines_of_a_board_of_kicad_are_those_of_its_items() {
    let text = "(kicad_pcb (version 20240108) (generator \"hand\")\n\
        (net 0 \"\") (net 1 \"A\")\n\
        (gr_rect (start 0 0) (end 20 10) (stroke (width 0.1) (type solid)) (fill none) (layer \"Edge.Cuts\"))\n\
        (segment (start 3 3) (end 9 3) (width 1) (layer \"F.Cu\") (net 1))\n\
        (via (at 15 5) (size 2) (drill 1) (layers \"F.Cu\" \"B.Cu\") (net 1))\n\
        (footprint \"x\" (layer \"F.Cu\") (at 10 8)\n\
        (pad \"1\" thru_hole circle (at 1 0) (size 1.6 1.6) (drill 0.8) (layers \"*.Cu\" \"*.Mask\")))\n)\n";
    let read = || kicad::artwork("hand.kicad_pcb", text.as_bytes()).unwrap();
    let drawn = Drawn::of_kicad("hand.kicad_pcb", text.as_bytes()).unwrap();
    let of = |part| -> Vec<u32> {
        let mut settings = settings();
        settings.placing.as_drawn = true;
        let cuts = cut(&settings, part, read(), &drawn);
        let mut lines: Vec<u32> = cuts
            .iter()
            .map(|(place, line)| line.unwrap_or_else(|| panic!("{part:?} {place}")).line)
            .collect();
        lines.sort_unstable();
        lines.dedup();
        lines
    };
    assert_eq!(of(Part::Front), [4, 5, 7]);
    assert_eq!(of(Part::Back), [5, 7]);
    assert_eq!(of(Part::Drill), [5, 7]);
    assert_eq!(of(Part::Outline), [3]);
}

/// Nothing of a file that is no board.
#[test]
fn what_the_readers_refuse_is_refused() {
    assert!(Drawn::of_kicad("a.kicad_pcb", b"(sheet)").is_err());
    let layer = toolpost_pcb::board::Layer::Outline;
    let text = b"%FSLAX46Y46*%\n%MOMM*%\nX0Y0D01*\nM02*\n";
    let file = LayerFile { name: "a.gbr", layer, unit: None, text };
    assert!(Drawn::of_layers(&[None, Some(file)]).is_err());
}
