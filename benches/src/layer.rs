//! A copper layer of many strokes, flashes and a large region, read, compared with the floor of reading its numbers
//! and printing them back.

use crate::{fastest, floor};
use geom::Vec2;
use program::Diagnostic;
use std::fmt::Write;

/// Prints what reading a layer of `strokes` strokes takes.
///
/// # Errors
/// What the layer is refused for.
pub fn measure(strokes: usize, rounds: usize) -> Result<(), Vec<Diagnostic>> {
    let text = layer(strokes);
    let by_hand = fastest(rounds, &mut || {
        std::hint::black_box(floor::by_hand(text.as_bytes()));
        Ok(())
    })?;
    let mut objects = 0;
    let read = fastest(rounds, &mut || {
        objects = pcb::gerber::read("layer.gbr", text.as_bytes())?.image.objects.len();
        Ok(())
    })?;
    println!(
        "a copper layer of {objects} objects, {} kB; the floor by hand: {:.4}\n  \
         read: {:.4}; {} bytes an object\n    divided by the floor: {}",
        text.len() / 1000,
        by_hand.time,
        read.time,
        read.peak / objects.max(1),
        read.time.times(by_hand.time),
    );
    Ok(())
}

/// Tracks of four strokes that end in pads, as KiCad writes them, and a pour of as many corners as there
/// are strokes.
pub fn layer(strokes: usize) -> String {
    let mut text = String::from(
        "%TF.FileFunction,Copper,L1,Top*%\n%FSLAX46Y46*%\n%MOMM*%\n%LPD*%\nG01*\n\
         %ADD10C,0.254000*%\n%ADD11R,1.000000X1.500000*%\n",
    );
    let at = |point: Vec2| {
        let step = |mm: f64| (mm * 1e6).round();
        format!("X{}Y{}", step(point.x), step(point.y))
    };
    for i in 0..strokes / 4 {
        let start = Vec2::new((i % 100) as f64, (i / 100) as f64) * 2.54;
        let _ =
            writeln!(text, "%TO.N,Net-({i})*%\nD11*\n{}D03*\nD10*\n{}D02*", at(start), at(start));
        for along in [Vec2::X, Vec2::ONE, Vec2::new(1.5, 1.0), Vec2::new(2.0, 0.5)] {
            let _ = writeln!(text, "{}D01*", at(start + along));
        }
    }
    let corner = |i: usize| {
        let angle = i as f64 / strokes.max(3) as f64 * std::f64::consts::TAU;
        Vec2::new(127.0, -200.0)
            + Vec2::from_angle(angle) * if i.is_multiple_of(2) { 150.0 } else { 150.4 }
    };
    let _ = writeln!(text, "%TD*%\nG36*\n{}D02*", at(corner(0)));
    for i in 1..strokes.max(3) {
        let _ = writeln!(text, "{}D01*", at(corner(i)));
    }
    let _ = writeln!(text, "{}D01*\nG37*\nM02*", at(corner(0)));
    text
}
