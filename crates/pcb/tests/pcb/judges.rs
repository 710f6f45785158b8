//! Other people's readers: gerbv, pixel by pixel.

use crate::data;
use crate::raster::Raster;
use std::path::Path;
use std::process::{Command, Stdio};
use toolpost_pcb::{excellon, gerber};

/// Pixels of 2,000 to the inch, mm.
const PIXEL: f64 = 25.4 / 2000.0;

fn gerbv() -> bool {
    let found = Command::new("gerbv").arg("--version").output().is_ok();
    if !found {
        eprintln!("skipped: no gerbv (`make judges`)");
    }
    found
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
const PART: f64 = 40.0;

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
        if drill.cuts.iter().any(|cut| matches!(cut.path, excellon::Path::Route(_))) {
            continue;
        }
        if let Some(raster) = Raster::of_drill(&drill, PIXEL, PART) {
            compare(&file, &raster);
        }
    }
}
