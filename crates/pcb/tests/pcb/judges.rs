//! Other people's readers: gerbv, pixel by pixel.

use crate::data;
use crate::raster::Raster;
use std::path::Path;
use std::process::{Command, Stdio};
use toolpost_pcb::{excellon, gerber};

/// Pixels of 2,000 to the inch, mm.
const PIXEL: f64 = 25.4 / 2000.0;

fn gerbv() -> bool {
    judge::program("gerbv", "Debian package gerbv")
}

/// Which pixels of `raster` gerbv makes dark.
fn judged(file: &Path, raster: &Raster) -> Vec<bool> {
    let picture = std::env::temp_dir().join(format!(
        "toolpost-gerbv-{}-{}.png",
        std::process::id(),
        file.file_name().unwrap().to_string_lossy()
    ));
    let inches = |mm: f64| mm / 25.4;
    let run = Command::new("gerbv")
        .args(["-x", "png", "-D", "2000", "--border=0", "-b", "#000000", "-f", "#ffffffff"])
        .arg(format!("--origin={:.6}x{:.6}", inches(raster.origin.x), inches(raster.origin.y)))
        .arg(format!(
            "--window_inch={:.6}x{:.6}",
            (raster.width as f64 + 0.25) / 2000.0,
            (raster.height as f64 + 0.25) / 2000.0
        ))
        .arg("-o")
        .args([picture.as_path(), file])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    assert!(run.unwrap().success(), "gerbv refuses {}", file.display());
    let file = std::io::BufReader::new(std::fs::File::open(&picture).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    assert_eq!((width, height), (raster.width, raster.height));
    let colours = reader.info().color_type.samples();
    let mut dark = Vec::with_capacity(width * height);
    while let Some(row) = reader.next_row().unwrap() {
        dark.extend(row.data().chunks_exact(colours).map(|pixel| pixel[0] > 127));
    }
    std::fs::remove_file(&picture).unwrap();
    dark
}

/// The parts of large boards that are compared, mm: the whole takes minutes.
const PART: f64 = 25.0;

fn compare(file: &Path, raster: &Raster) {
    let (wrong, all) = raster.differences(&judged(file, raster));
    assert_eq!(
        wrong,
        0,
        "{}: of {all} pixels that differ so many are away from edges",
        file.display()
    );
}

/// Files in which gerbv 2.9.6 is wrong; `layers` has what is right.
const GERBV_IS_WRONG: [(&str, &str); 8] = [
    ("single-quadrant-I-to-II.gbr", "G74 across the axes"),
    ("single-quadrant-II-to-III.gbr", "G74 across the axes"),
    ("single-quadrant-III-to-IV.gbr", "G74 across the axes"),
    ("single-quadrant-IV-to-I.gbr", "G74 across the axes"),
    ("zero-length.gbr", "an arc without length under G74 is left out"),
    ("clear-with-moire.gbr", "macros in clear polarity"),
    ("clear-with-multiple-exposures.gbr", "macros in clear polarity"),
    ("multi-polarity-over-self.gbr", "each object is repeated by itself, not the block"),
];

#[test]
fn every_layer_looks_as_gerbv_draws_it() {
    let Some(folder) = data::folder() else { return };
    if !gerbv() {
        return;
    }
    for file in data::files(&folder, ".gbr") {
        let name = file.to_string_lossy();
        if GERBV_IS_WRONG.iter().any(|(wrong, _)| name.ends_with(wrong)) {
            continue;
        }
        let Ok(reading) = gerber::read(&name, &data::bytes(&file)) else { continue };
        if let Some(raster) = Raster::of_image(&reading.image, PIXEL, PART) {
            compare(&file, &raster);
        }
    }
}

#[test]
fn every_drill_file_looks_as_gerbv_draws_it() {
    let Some(folder) = data::folder() else { return };
    if !gerbv() {
        return;
    }
    for file in data::files(&folder, ".drl") {
        let reading = excellon::read(&file.to_string_lossy(), &data::bytes(&file)).unwrap();
        // gerbv 2.9.6 does not read routes.
        let drill = reading.drill;
        if drill.cuts.iter().any(|cut| matches!(cut.path, toolpost_pcb::HoleShape::Route(_))) {
            continue;
        }
        if let Some(raster) = Raster::of_drill(&drill, PIXEL, PART) {
            compare(&file, &raster);
        }
    }
}

/// Prints what gerbonara finds in a file, in mm: a line for each flash, line, arc and region.
const GERBONARA: &str = r#"
import sys, warnings
warnings.simplefilter("ignore")
from gerbonara import GerberFile, ExcellonFile
from gerbonara.graphic_objects import Arc, Flash, Line, Region
name = sys.argv[1]
for o in (ExcellonFile if name.endswith(".drl") else GerberFile).open(name).objects:
    mm = lambda *values: " ".join(f"{o.unit.convert_to('mm', v):.6f}" for v in values)
    if isinstance(o, Flash):
        print("flash", mm(o.x, o.y))
    elif isinstance(o, Line):
        print("line", mm(o.x1, o.y1, o.x2, o.y2, o.aperture.equivalent_width(o.unit)))
    elif isinstance(o, Arc):
        print("arc", mm(o.x1, o.y1, o.x2, o.y2, o.x1 + o.cx, o.y1 + o.cy))
    elif isinstance(o, Region):
        (a, b), (c, d) = o.bounding_box("mm")
        print("region", f"{a:.6f} {b:.6f} {c:.6f} {d:.6f}")
"#;

/// A kind of object and its numbers.
type Seen = (String, Vec<f64>);

fn gerbonara(python: &Path, file: &Path) -> Vec<Seen> {
    let run = Command::new(python).args(["-c", GERBONARA]).arg(file).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = String::from_utf8(run.stdout).unwrap();
    let seen = |line: &str| {
        let (kind, numbers) = line.split_once(' ').unwrap();
        (kind.into(), numbers.split(' ').map(|n| n.parse().unwrap()).collect())
    };
    text.lines().map(seen).collect()
}

fn path(element: &geom::Element, width: f64) -> Seen {
    let (a, b) = (element.start, element.end);
    match element.turn {
        None => ("line".into(), vec![a.x, a.y, b.x, b.y, width]),
        Some(turn) => ("arc".into(), vec![a.x, a.y, b.x, b.y, turn.center.x, turn.center.y]),
    }
}

#[track_caller]
fn assert_same(file: &Path, ours: &[Seen], theirs: &[Seen]) {
    assert_eq!(ours.len(), theirs.len(), "{}", file.display());
    for (ours, theirs) in ours.iter().zip(theirs) {
        let near = |(a, b): (&f64, &f64)| (a - b).abs() < 2e-6;
        let same = ours.0 == theirs.0 && ours.1.len() == theirs.1.len();
        assert!(
            same && ours.1.iter().zip(&theirs.1).all(near),
            "{}: {ours:?} {theirs:?}",
            file.display()
        );
    }
}

#[test]
fn every_object_of_a_layer_is_where_gerbonara_sees_it() {
    let (Some(folder), Some(python)) = (data::folder(), judge::python("gerbonara")) else { return };
    let boards =
        ["kicad/StickHub", "kicad/microwave", "kicad/pic_programmer", "features/arc-strokes"];
    for file in boards.iter().flat_map(|board| data::files(&folder.join(board), ".gbr")) {
        let reading = gerber::read("layer.gbr", &data::bytes(&file)).unwrap();
        // It leaves out an arc without length.
        if file.ends_with("zero-length.gbr") {
            continue;
        }
        let mut ours = Vec::new();
        for object in &reading.image.objects {
            match &object.shape {
                gerber::Shape::Flash { at, .. } => ours.push(("flash".into(), vec![at.x, at.y])),
                gerber::Shape::Stroke { aperture, path: element, .. } => {
                    let aperture = &reading.image.apertures[*aperture as usize];
                    let Some(gerber::Pen::Round(width)) = aperture.pen else { panic!("no disc") };
                    ours.push(path(element, width));
                }
                gerber::Shape::Region { region, .. } => {
                    let region = &reading.image.regions[*region as usize];
                    for (low, high) in region.contours.iter().map(|contour| contour.extents()) {
                        ours.push(("region".into(), vec![low.x, low.y, high.x, high.y]));
                    }
                }
            }
        }
        assert_same(&file, &ours, &gerbonara(&python, &file));
    }
}

#[test]
fn every_hole_and_route_is_where_gerbonara_sees_it() {
    let (Some(folder), Some(python)) = (data::folder(), judge::python("gerbonara")) else { return };
    for file in data::files(&folder.join("kicad"), ".drl") {
        let drill = excellon::read("board.drl", &data::bytes(&file)).unwrap().drill;
        let mut ours = Vec::new();
        for cut in &drill.cuts {
            let diameter = drill.tools[cut.tool as usize].diameter;
            match &cut.path {
                toolpost_pcb::HoleShape::Round(at) => ours.push(("flash".into(), vec![at.x, at.y])),
                toolpost_pcb::HoleShape::Slot(from, to) => {
                    ours.push(path(&geom::Element::line(*from, *to), diameter));
                }
                toolpost_pcb::HoleShape::Route(elements) => {
                    ours.extend(elements.iter().map(|element| path(element, diameter)));
                }
            }
        }
        assert_same(&file, &ours, &gerbonara(&python, &file));
    }
}
