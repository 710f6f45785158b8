//! Boards moved, turned over and on panels: hand calculation, and properties.

use crate::boards::{folder, read};
use crate::data;
use geom::Vec2;
use geom::region::Region;
use proptest::prelude::*;
use std::time::Instant;
use toolpost_pcb::board::{Axis, Board};
use toolpost_pcb::{Hole, HoleShape};

/// A board of 20 by 10 mm, an L of copper on its front, a pad on its back, a hole and a slot.
fn board() -> Board {
    let layer = |function: &str, commands: &str| {
        format!(
            "%TF.FileFunction,{function}*%%FSLAX36Y36*%%MOMM*%%ADD10C,2*%%TO.N,GND*%\n{commands}M02*"
        )
    };
    let front = "D10*\nX3000000Y3000000D02*\nG01X12000000D01*\nY7000000D01*\n";
    let back = "D10*\nX5000000Y6000000D03*\n";
    let edge = "D10*\nX0Y0D02*\nG01X20000000D01*\nY10000000D01*\nX0D01*\nY0D01*\n";
    let drill = "M48\nMETRIC\nT1C1.0\n%\nT1\nX3.0Y3.0\nX15.0Y2.0G85X17.0Y4.0\nM30\n";
    let files = [
        ("a", layer("Copper,L1,Top", front)),
        ("b", layer("Copper,L2,Bot", back)),
        ("c", layer("Profile,NP", edge)),
        ("d.drl", drill.into()),
    ];
    let files: Vec<(&str, &[u8])> = files.iter().map(|(n, t)| (*n, t.as_bytes())).collect();
    read(&files).unwrap().board
}

fn copper(board: &Board) -> [&Region; 2] {
    [&board.front, &board.back].map(|side| &side.copper.as_ref().unwrap().region)
}

fn round(hole: &Hole) -> Vec2 {
    match hole.shape {
        HoleShape::Round(at) => at,
        _ => panic!("{hole:?}"),
    }
}

#[test]
fn turning_over_shows_the_back() {
    let board = board();
    let turned = board.turned_over(Axis::X(10.0));
    let [front, back] = copper(&turned);
    // The pad was at 5,6 and is as far on the other side of X 10.
    let (low, high) = front.extents().unwrap();
    assert!(
        low.distance(Vec2::new(14.0, 5.0)) < 1e-9 && high.distance(Vec2::new(16.0, 7.0)) < 1e-9
    );
    assert!(back.contains(Vec2::new(17.0, 3.0)) && back.contains(Vec2::new(8.0, 7.0)));
    assert!(!back.contains(Vec2::new(17.0, 7.0)));
    assert!(back.area() > 0.0 && (back.area() - copper(&board)[0].area()).abs() < 1e-9);
    assert_eq!(round(&turned.holes[0]), Vec2::new(17.0, 3.0));
    let HoleShape::Slot(from, to) = turned.holes[1].shape else { panic!() };
    assert_eq!((from, to), (Vec2::new(5.0, 2.0), Vec2::new(3.0, 4.0)));
    let turned = board.turned_over(Axis::Y(board.middle().y));
    assert_eq!(round(&turned.holes[0]), Vec2::new(3.0, 7.0));
    assert!(copper(&turned)[1].contains(Vec2::new(12.0, 3.0)));
    assert_eq!(turned.back.copper.unwrap().nets, board.front.copper.unwrap().nets);
}

#[test]
fn pins_are_next_to_the_board_and_the_axis_between_them() {
    let board = board();
    let pins = board.pins(Axis::X(10.0), 3.0, 2.0).unwrap();
    assert_eq!(pins.each_ref().map(round), [Vec2::new(-3.5, 5.0), Vec2::new(23.5, 5.0)]);
    // Off the middle both are as far out as the farther edge needs.
    let pins = board.pins(Axis::Y(4.0), 3.0, 2.0).unwrap();
    assert_eq!(pins.each_ref().map(round), [Vec2::new(10.0, -5.5), Vec2::new(10.0, 13.5)]);
    for (diameter, distance) in [(0.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0), (1.0, -1.0)] {
        assert_eq!(board.pins(Axis::X(0.0), diameter, distance).unwrap_err().rule, "pins");
    }
    assert_eq!(Board::default().pins(Axis::X(0.0), 1.0, 1.0).unwrap_err().rule, "pins");
}

#[test]
fn moving_has_its_limits() {
    let moved = board().moved(Vec2::new(-5.0, 2.5)).unwrap();
    assert_eq!(moved.extents(), Some((Vec2::new(-5.0, 2.5), Vec2::new(15.0, 12.5))));
    for by in [Vec2::splat(1e6), Vec2::NAN, Vec2::new(0.0, f64::INFINITY)] {
        assert_eq!(board().moved(by).unwrap_err().rule, "not-a-place");
    }
}

#[test]
fn a_panel_is_copies_next_to_each_other() {
    let board = board();
    let panel = board.panel(3, 2, Vec2::new(2.0, 3.0)).unwrap();
    assert_eq!(panel.extents(), Some((Vec2::ZERO, Vec2::new(64.0, 23.0))));
    assert_eq!(panel.outline.as_ref().unwrap().islands().len(), 6);
    assert_eq!(panel.holes.len(), 12);
    assert!(copper(&panel)[0].contains(Vec2::new(44.0 + 12.0, 13.0 + 7.0)));
    let nets = &panel.front.copper.as_ref().unwrap().nets;
    let names: Vec<&str> = nets.iter().map(|net| net.as_deref().unwrap()).collect();
    let expected = ["(1,1)", "(2,1)", "(3,1)", "(1,2)", "(2,2)", "(3,2)"];
    assert_eq!(names, expected.map(|place| format!("GND {place}")));
    // As if it had been united from the copies.
    let united = Region::union_of([copper(&panel)[0]]).unwrap();
    assert!((united.area() - 6.0 * copper(&board)[0].area()).abs() < 1e-6);
    assert_eq!(united.islands().len(), 6);
}

#[test]
fn what_is_no_panel() {
    let board = board();
    let rule = |columns, rows, x, y| {
        let refused = board.panel(columns, rows, Vec2::new(x, y)).unwrap_err();
        assert!(!refused.help.is_empty());
        refused.rule
    };
    for (columns, rows, x, y) in [
        (0, 1, 2.0, 2.0),
        (2, 1, 0.0, 2.0),
        (2, 1, -5.0, 2.0),
        (2, 2, 2.0, f64::NAN),
        (usize::MAX, 2, 2.0, 2.0),
        (101, 100, 2.0, 2.0),
    ] {
        assert_eq!(rule(columns, rows, x, y), "panel");
    }
    assert_eq!(rule(9999, 1, 2.0, 2.0), "not-a-place");
    // 17 million holes are more than fit into memory together with those of the other side.
    let holes = vec![board.holes[0].clone(); 1700];
    let many = Board { holes, ..Board::default() };
    assert_eq!(many.panel(100, 100, Vec2::ONE).unwrap_err().rule, "panel");
    // Where there is no second board, the spacing does not count.
    assert_eq!(board.panel(1, 2, Vec2::new(0.0, 1.0)).unwrap().holes.len(), 4);
    assert_eq!(Board::default().panel(2, 2, Vec2::ONE).unwrap_err().rule, "panel");
}

#[test]
fn a_panel_of_sixteen_takes_no_longer_than_twenty_boards() {
    let Some(data) = data::folder() else { return };
    let begin = Instant::now();
    let board = folder(&data.join("kicad/pic_programmer")).unwrap().board;
    let one = begin.elapsed();
    let begin = Instant::now();
    let panel = board.panel(4, 4, Vec2::splat(3.0)).unwrap();
    let sixteen = begin.elapsed();
    assert!(sixteen < 4 * one, "{sixteen:?} for the panel, {one:?} for a board");
    let islands = |board: &Board| copper(board).map(|copper| copper.islands().len());
    assert_eq!(islands(&panel), islands(&board).map(|count| 16 * count));
}

proptest! {
    #[test]
    fn twice_turned_over_is_as_before(at in -1e3..1e3f64, across: bool) {
        let board = board();
        let axis = if across { Axis::Y(at) } else { Axis::X(at) };
        let back = board.turned_over(axis).turned_over(axis);
        for (a, b) in copper(&board).into_iter().zip(copper(&back)) {
            prop_assert!(a.xor(b).unwrap().area() < 1e-6);
        }
        prop_assert!(round(&back.holes[0]).distance(round(&board.holes[0])) < 1e-9);
    }

    #[test]
    fn copper_is_where_it_was_reflected_to(at in -50.0..50.0f64, x in 0.0..20.0f64, y in 0.0..10.0f64) {
        let board = board();
        let turned = board.turned_over(Axis::X(at));
        let (here, there) = (Vec2::new(x, y), Vec2::new(2.0 * at - x, y));
        let (front, back) = (copper(&board)[0], copper(&turned)[1]);
        prop_assert!((front.distance(here) - back.distance(there)).abs() < 1e-6);
        let moved = board.moved(Vec2::new(at, -at)).unwrap();
        let there = here + Vec2::new(at, -at);
        prop_assert!((front.distance(here) - copper(&moved)[0].distance(there)).abs() < 1e-6);
        // A region has its boundary's direction: what is inside is on its left.
        for region in copper(&turned) {
            prop_assert!(region.islands().iter().all(|island| island.outer().area() > 0.0));
            prop_assert!(region.islands().iter().flat_map(|i| i.holes()).all(|hole| hole.area() < 0.0));
        }
    }
}
