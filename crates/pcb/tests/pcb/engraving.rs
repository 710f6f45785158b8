//! Legend, engraved: hand calculation.

use geom::Vec2;
use std::f64::consts::PI;
use toolpost_pcb::gerber::{Image, read};
use toolpost_pcb::{Path, engraved};

/// A file in mm with six decimals, of these commands.
fn image(commands: &str) -> Image {
    let text = format!("%FSLAX36Y36*%%MOMM*%{commands}M02*");
    read("legend.gbr", text.as_bytes()).unwrap_or_else(|errors| panic!("{errors:#?}")).image
}

fn length(paths: &[Path]) -> f64 {
    paths.iter().map(Path::length).sum()
}

#[test]
fn a_letter_drawn_by_a_narrow_pen_is_engraved_along_its_strokes() {
    // An L of 3 and 2 mm, and a dot.
    let letter = image("%ADD10C,0.15*%D10*G01X0Y3000000D02*Y0D01*X2000000D01*X4000000D02*D01*");
    let engraving = engraved(&letter, 0.2).unwrap();
    let [line, dot] = &engraving.paths[..] else { panic!("{:?}", engraving.paths) };
    assert_eq!((line.start(), line.end()), (Vec2::new(0.0, 3.0), Vec2::new(2.0, 0.0)));
    assert_eq!((line.elements().len(), line.length()), (2, 5.0));
    assert_eq!((dot.start(), dot.length()), (Vec2::new(4.0, 0.0), 0.0));
    assert!(engraving.rest.is_empty());
}

#[test]
fn wide_strokes_are_engraved_along_their_outline() {
    // A stroke of 10 mm, 1 mm wide, by a tool of 0.4: a stadium of 10 mm and radius 0.3.
    let stroke = image("%ADD10C,1*%D10*G01X0Y0D02*X10000000D01*");
    let engraving = engraved(&stroke, 0.4).unwrap();
    assert_eq!(engraving.paths.len(), 1);
    assert!((length(&engraving.paths) - (20.0 + 0.6 * PI)).abs() < 1e-6);
    assert!(engraving.rest.is_empty());
}

#[test]
fn shapes_that_the_tool_does_not_fit_into_are_reported() {
    let flash = image("%ADD10R,5X0.3*%D10*X0Y0D03*");
    let engraving = engraved(&flash, 0.4).unwrap();
    assert!(engraving.paths.is_empty() && (engraving.rest.area() - 1.5).abs() < 1e-6);
}

#[test]
fn what_is_erased_is_not_engraved() {
    // Of a stroke of 10 mm the middle 4 mm are erased.
    let text = "%ADD10C,0.2*%%ADD11R,4X4*%D10*G01X0Y0D02*X10000000D01*%LPC*%D11*X5000000Y0D03*";
    let engraving = engraved(&image(text), 0.2).unwrap();
    assert_eq!(engraving.paths.len(), 2);
    assert!((length(&engraving.paths) - 6.0).abs() < 2e-3);
}

#[test]
fn dots_stay_where_something_else_is_erased() {
    // Dots at 0 and 4 mm, the second erased.
    let text =
        "%ADD10C,0.15*%%ADD11R,1X1*%D10*G01X0Y0D02*D01*X4000000D02*D01*%LPC*%D11*X4000000Y0D03*";
    let engraving = engraved(&image(text), 0.2).unwrap();
    let [dot] = &engraving.paths[..] else { panic!("{:?}", engraving.paths) };
    assert_eq!((dot.start(), dot.end(), dot.length()), (Vec2::ZERO, Vec2::ZERO, 0.0));
}

#[test]
fn widths_that_are_none_are_refused() {
    let letter = image("%ADD10C,0.15*%D10*X0Y0D02*X2000000D01*");
    for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(engraved(&letter, width).unwrap_err().rule, "tool-width");
    }
}
