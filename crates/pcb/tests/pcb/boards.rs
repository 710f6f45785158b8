//! Boards from folders of files: the real ones, and layers by hand.

use crate::data;
use geom::Vec2;
use program::Diagnostic;
use std::f64::consts::PI;
use std::path::Path;
use toolpost_pcb::board::{self, Face, File, Layer, Reading};

/// What the files of a folder give.
fn folder(folder: &Path) -> Result<Reading, Vec<Diagnostic>> {
    let paths = data::files(folder, "");
    let texts: Vec<Vec<u8>> = paths.iter().map(|path| data::bytes(path)).collect();
    let names: Vec<String> = paths.iter().map(|path| path.to_string_lossy().into()).collect();
    let files: Vec<(&str, &[u8])> =
        names.iter().zip(&texts).map(|(name, text)| (name.as_str(), text.as_slice())).collect();
    read(&files)
}

fn read(files: &[(&str, &[u8])]) -> Result<Reading, Vec<Diagnostic>> {
    let files: Vec<File> =
        files.iter().map(|(name, text)| File { name, layer: None, text }).collect();
    board::read("board", &files)
}

/// A layer in mm with three decimals: a pen of 0.2 mm, D10, and a pad of 1 mm, D11.
fn layer(function: &str, commands: &str) -> Vec<u8> {
    let says =
        if function.is_empty() { String::new() } else { format!("%TF.FileFunction,{function}*%") };
    format!("{says}%FSLAX33Y33*%%MOMM*%%ADD10C,0.2*%%ADD11C,1*%G75*\n{commands}M02*").into_bytes()
}

/// Lines through these places, mm, drawn with D10.
fn lines(places: &[(f64, f64)]) -> String {
    let units = |mm: f64| (mm * 1000.0).round() as i64;
    let mut text = String::from("D10*\n");
    for (i, (x, y)) in places.iter().enumerate() {
        text += &format!("G01X{}Y{}D0{}*\n", units(*x), units(*y), if i == 0 { 2 } else { 1 });
    }
    text
}

/// The square of 20 mm with its corner in the origin.
fn square() -> String {
    lines(&[(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0), (0.0, 0.0)])
}

/// The outline that these commands draw.
fn outline(commands: &str) -> Result<Reading, Vec<Diagnostic>> {
    read(&[("edge.gko", &layer("", commands))])
}

#[track_caller]
fn assert_area(reading: &Reading, expected: f64) {
    let area = reading.board.outline.as_ref().expect("there is an outline").area();
    assert!((area - expected).abs() < 1e-6 * expected, "{area} is not {expected}");
}

#[track_caller]
fn refused(reading: Result<Reading, Vec<Diagnostic>>, rule: &str, says: &str) -> Diagnostic {
    let errors = reading.expect_err("this is refused");
    assert_eq!(errors[0].rule, rule, "{errors:#?}");
    assert!(errors[0].message.contains(says), "{errors:#?}");
    assert!(!errors[0].help.is_empty());
    errors[0].clone()
}

fn rules(reading: &Reading) -> Vec<&str> {
    reading.warnings.iter().map(|found| found.rule).collect()
}

#[test]
fn the_folders_of_the_real_boards() {
    let Some(data) = data::folder() else { return };
    for (name, holes, size) in [
        ("StickHub", 0, (0.0, 0.0)),
        ("carte_test", 0, (0.0, 0.0)),
        ("ecc83-pp", 0, (0.0, 0.0)),
        ("interf_u", 0, (0.0, 0.0)),
        ("kit-dev-coldfire-xilinx_5213", 0, (0.0, 0.0)),
        ("microwave", 0, (0.0, 0.0)),
        ("pic_programmer", 0, (0.0, 0.0)),
    ] {
        let t = std::time::Instant::now();
        match folder(&data.join("kicad").join(name)) {
            Ok(r) => {
                eprintln!(
                    "{name} {:?} {:?} holes {} islands {:?}",
                    t.elapsed(),
                    r.board.outline.as_ref().map(|o| (
                        o.extents(),
                        o.islands().len(),
                        o.rings().count()
                    )),
                    r.board.holes.len(),
                    r.board.front.copper.as_ref().map(|c| c.region.islands().len())
                );
                for w in r.warnings {
                    eprintln!("  {w}");
                }
            }
            Err(e) => {
                for e in e {
                    eprintln!("{name} ERR {e}");
                }
            }
        }
        let _ = (holes, size);
    }
    let t = std::time::Instant::now();
    let r = folder(&data.join("a64")).unwrap();
    eprintln!("a64 {:?}", t.elapsed());
    for w in r.warnings {
        eprintln!("  {w}");
    }
    eprintln!("{:?}", r.layers);
}
