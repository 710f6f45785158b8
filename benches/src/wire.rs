//! A contour of many arcs: read from a drawing, divided into points, and offset, compared with the floor of
//! reading the numbers of the drawing and printing them back.

use crate::{fastest, floor};
use ::wire::Path;
use ::wire::dxf::{self, Options};
use ::wire::offset::{Corners, offset};
use ::wire::points::{Step, points};
use program::Diagnostic;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Chord error of the points, mm.
const CHORD_ERROR: f64 = 0.001;

/// How far from the contour the wire runs, mm.
const OFFSET: f64 = 0.13;

/// Prints what a closed contour of `arcs` arcs takes.
///
/// # Errors
/// What the contour is refused for.
pub fn measure(arcs: usize, rounds: usize) -> Result<(), Vec<Diagnostic>> {
    let text = scallops(arcs);
    let by_hand = fastest(rounds, &mut || {
        std::hint::black_box(floor::by_hand(text.as_bytes()));
        Ok(())
    })?;
    println!(
        "a drawing of {arcs} arcs, {} MB; the floor by hand: {}",
        text.len() / 1_000_000,
        by_hand.time
    );
    let one = |found: Box<Diagnostic>| vec![*found];
    let read = || dxf::read(text.as_bytes(), &Options::default()).map_err(one);
    let mut count = 0;
    for (what, distance) in [("read, points", None), ("read, offset, points", Some(OFFSET))] {
        let taken = fastest(rounds, &mut || {
            let mut contour = read()?.contours.remove(0);
            if let Some(distance) = distance {
                contour = offset(&contour, distance, Corners::Refuse).map_err(one)?.contour;
            }
            let path = Path::upright(contour);
            let made = points(&[&path], Step::ChordError(CHORD_ERROR), None);
            count = made.map_err(|refusal| one(refusal.diagnostic))?[0].lower.len();
            Ok(())
        })?;
        println!(
            "  {what}: {}; {count} points at {CHORD_ERROR} mm\n    divided by the floor: {}",
            taken.time,
            taken.time.times(by_hand.time)
        );
    }
    Ok(())
}

/// A ring of shallow arcs that bulge outwards, 1 mm long each, as a closed polyline (DXF, R2000).
fn scallops(arcs: usize) -> String {
    let radius = arcs as f64 / TAU;
    let mut text = format!(
        "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\n0\n\
         90\n{arcs}\n70\n1\n"
    );
    for i in 0..arcs {
        let (sin, cos) = (i as f64 / arcs as f64 * TAU).sin_cos();
        // Writing to a string does not fail.
        let _ = write!(text, "10\n{:.6}\n20\n{:.6}\n42\n0.2\n", radius * cos, radius * sin);
    }
    text.push_str("0\nENDSEC\n0\nEOF\n");
    text
}
