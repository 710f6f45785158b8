//! Long steps of a board end in their middle where the work was ended: each of these asks, or it would be done all the same.

use geom::ending::Ended;
use geom::region::{Region, Ring};
use geom::{Element, Vec2};
use toolpost_pcb::isolation::Narrow;
use toolpost_pcb::tour::Tour;
use toolpost_pcb::{Copper, Path, divided, excellon, gerber};

/// Asserts that a step is done where nobody ends it, and not where the work was ended.
fn asks<T: Send>(step: &str, work: impl Fn() -> T + Send + Sync) {
    assert!(Ended::default().run(&work).is_some(), "{step}");
    let ended = Ended::default();
    ended.end();
    assert!(ended.run(&work).is_none(), "{step} does not ask");
}

const HEAD: &str = "%FSLAX46Y46*%%MOMM*%%ADD10C,1*%D10*";

#[test]
fn reading_asks_whether_it_goes_on() {
    let repeated = format!("{HEAD}%SRX3Y3I2J2*%X0Y0D03*%SR*%M02*");
    for text in [format!("{HEAD}X0Y0D03*M02*"), repeated] {
        asks("Gerber", || gerber::read("x.gbr", text.as_bytes()).is_ok());
    }
    let holes = b"M48\nMETRIC\nT1C0.8\n%\nT1\nX8.0Y2.0\nM30\n";
    asks("Excellon", || excellon::read("x.drl", holes).is_ok());
}

#[test]
fn uniting_asks_whether_it_goes_on() {
    let text = format!("{HEAD}X0Y0D02*X9000000Y0D01*X9000000Y9000000D03*M02*");
    let image = gerber::read("x.gbr", text.as_bytes()).unwrap().image;
    asks("strokes and pads", || Copper::of_image(&image).is_ok());
    let square = Ring::polygon(&[Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]).unwrap();
    let square = Region::inside([&square], geom::region::Fill::Positive).unwrap();
    asks("offset", || square.offset(0.1).is_ok());
    asks("difference", || square.difference(&square).is_ok());
}

#[test]
fn planning_asks_whether_it_goes_on() {
    let discs = [0.0, 3.0].map(|x| Region::disc(Vec2::new(x, 0.0), 1.0).unwrap());
    let region = Region::union_of(&discs).unwrap();
    let copper = Copper { nets: vec![None; 2], region };
    let board = Region::disc(Vec2::ZERO, 9.0).unwrap();
    asks("division", || divided(&copper, &board, 0.3, Narrow::LeaveOut).is_ok());
    let paths = [0.0, 1.0, 2.0].map(|x| {
        let line = Element::line(Vec2::new(x, 0.0), Vec2::new(x, 1.0));
        Path::new(vec![line]).unwrap()
    });
    let tour = Tour { from: Vec2::ZERO, to: None, reversible: true };
    asks("tour", || tour.of_paths(&paths).len());
    asks("merge", || paths[0].merged(0.01).is_some());
}
