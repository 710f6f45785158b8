//! Drilling: which tool makes what, where it goes, and what it takes away.

use crate::{boards, data};
use geom::region::{Cap, Region};
use geom::{Element, Vec2};
use std::f64::consts::PI;
use toolpost_pcb::drilling::{Drilled, Drilling, Mill, Slots};
use toolpost_pcb::isolation::Direction;
use toolpost_pcb::{Cut, Cutter, Hole, HoleShape, Operation, Segment, Tool};

fn drilling() -> Drilling {
    Drilling {
        thickness: 1.6,
        below: 0.4,
        drills: None,
        tolerance: 0.0,
        peck: None,
        plunge: 60.0,
        speed: 12_000.0,
        slots: Slots::Chain { scallop: 0.05 },
        mill: None,
        from: Vec2::ZERO,
    }
}

fn mill(diameter: f64) -> Mill {
    let cutter = Cutter::Cylinder { diameter };
    let tool = Tool { name: "end mill".into(), cutter, feed: 200.0, plunge: 60.0, speed: 12_000.0 };
    Mill { tool, step: 0.5, direction: Direction::Climb, instead: f64::INFINITY }
}

fn hole(diameter: f64, shape: HoleShape) -> Hole {
    Hole { shape, diameter, plated: None }
}

fn round(x: f64, y: f64, diameter: f64) -> Hole {
    hole(diameter, HoleShape::Round(Vec2::new(x, y)))
}

fn made(drilling: &Drilling, holes: &[Hole]) -> Drilled {
    drilling.drill(holes).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn places(operation: &Operation) -> Vec<(f64, f64)> {
    let place = |cut: &Cut| match cut {
        Cut::Hole { at, depth, .. } => {
            assert_eq!(*depth, 2.0);
            (at.x, at.y)
        }
        Cut::Path(_) => panic!("a path"),
    };
    operation.cuts.iter().map(place).collect()
}

fn segments(operation: &Operation) -> Vec<Vec<Segment>> {
    let segments = |cut: &Cut| match cut {
        Cut::Hole { .. } => panic!("a hole"),
        Cut::Path(segments) => segments.clone(),
    };
    operation.cuts.iter().map(segments).collect()
}

#[test]
fn drills_come_in_rising_diameters_and_each_goes_on_where_the_last_was() {
    let holes =
        [round(5.0, 0.0, 1.0), round(1.0, 0.0, 0.8), round(9.0, 0.0, 0.8), round(7.0, 0.0, 1.0)];
    let made = made(&drilling(), &holes);
    let names: Vec<&str> = made.operations.iter().map(|operation| &*operation.name).collect();
    assert_eq!(names, ["drill 0.8 mm", "drill 1 mm"]);
    assert_eq!(places(&made.operations[0]), [(1.0, 0.0), (9.0, 0.0)]);
    assert_eq!(places(&made.operations[1]), [(7.0, 0.0), (5.0, 0.0)]);
    assert!(made.warnings.is_empty());
}

#[test]
fn holes_are_mapped_to_the_drills_at_hand_or_refused() {
    let with = |tolerance| Drilling { drills: Some(vec![1.0, 0.8]), tolerance, ..drilling() };
    let holes = [round(1.0, 2.0, 0.85), round(3.0, 0.0, 0.85), round(2.0, 0.0, 1.0)];
    let mapped = made(&with(0.05), &holes);
    let [warning] = &*mapped.warnings else { panic!("{:?}", mapped.warnings) };
    assert_eq!((warning.rule.name(), warning.count), ("drill-differs", 2));
    assert_eq!(warning.message, "a hole of 0.85 mm at X 1.000 Y 2.000 is drilled with 0.8 mm");
    assert_eq!(places(&mapped.operations[0]), [(1.0, 2.0), (3.0, 0.0)]);
    let errors = with(0.04).drill(&holes).unwrap_err();
    assert_eq!((errors.len(), errors[0].rule.name(), errors[0].count), (1, "no-drill", 2));
    assert!(errors[0].is_error() && !errors[0].help.is_empty(), "{}", errors[0]);
    // A cutter that is not too wide makes them all the same.
    let milling = Drilling { mill: Some(mill(0.8)), ..with(0.04) };
    assert_eq!(made(&milling, &holes).operations.len(), 2);
    let wide = Drilling { mill: Some(mill(0.9)), ..with(0.04) };
    assert_eq!(wide.drill(&holes).unwrap_err()[0].rule.name(), "no-drill");
}

#[test]
fn a_slot_is_drilled_ends_first() {
    let slot = hole(1.0, HoleShape::Slot(Vec2::new(1.0, 0.0), Vec2::new(4.0, 0.0)));
    // Holes 1 mm apart at first; at 0.5 mm apart 0.5 - √(0.25 - 0.0625) = 0.067 mm stays.
    let chained = Drilling { slots: Slots::Chain { scallop: 0.067 }, ..drilling() };
    let xs: Vec<f64> =
        places(&made(&chained, &[slot]).operations[0]).iter().map(|place| place.0).collect();
    assert_eq!(xs, [1.0, 2.0, 3.0, 4.0, 3.5, 2.5, 1.5]);
}

#[test]
fn a_hole_is_milled_ring_by_ring_and_level_by_level() {
    let milling = Drilling { mill: Some(mill(2.0)), drills: Some(vec![]), ..drilling() };
    // 3 mm by 2 mm: one ring of radius 0.5, four levels of 0.5 mm.
    let made_ = made(&milling, &[round(10.0, 0.0, 3.0)]);
    let path = &segments(&made_.operations[0])[0];
    let depths: Vec<f64> = path.iter().map(|segment| segment.depth).collect();
    assert_eq!(depths, [0.5, 1.0, 1.5, 2.0]);
    for Segment { element, .. } in path {
        let turn = element.turn.unwrap();
        // Counter-clockwise within a hole: the wall on the right, climb.
        assert!(turn.sweep > 0.0 && turn.center == Vec2::new(10.0, 0.0));
        assert!((element.length() - PI).abs() < 1e-9);
    }
    let against = Mill { direction: Direction::Conventional, ..mill(2.0) };
    let against =
        made(&Drilling { mill: Some(against), ..milling.clone() }, &[round(0.0, 0.0, 3.0)]);
    assert!(segments(&against.operations[0])[0][0].element.turn.unwrap().sweep < 0.0);
    // 7 mm by 2 mm: radii 0.8333, 1.6667 and 2.5, at 2π·5 mm a level, and steps in between of 0.8333.
    let wide = made(&milling, &[round(0.0, 0.0, 7.0)]);
    let path = &segments(&wide.operations[0])[0];
    let length: f64 = path.iter().map(|segment| segment.element.length()).sum();
    assert!((length - 4.0 * 10.0 * PI - (4.0 + 3.0) * 5.0 / 3.0).abs() < 1e-6, "{length}");
    for pair in path.windows(2) {
        assert_eq!(pair[0].element.end, pair[1].element.start);
    }
    // As wide as the cutter: straight down.
    let tight = made(&milling, &[round(4.0, 0.0, 2.0)]);
    let Cut::Hole { at, peck, .. } = tight.operations[0].cuts[0] else { panic!("a path") };
    assert_eq!((at, peck), (Vec2::new(4.0, 0.0), Some(0.5)));
}

/// What the milled paths of an operation take away at full depth.
fn swept(operation: &Operation, width: f64) -> Region {
    let paths = segments(operation).concat();
    let last = paths.iter().filter(|segment| segment.depth == 2.0);
    let strokes: Vec<Region> =
        last.map(|segment| Region::stroke(&segment.element, width, Cap::Round).unwrap()).collect();
    Region::union_of(&strokes).unwrap()
}

#[test]
fn what_is_milled_is_the_hole() {
    let corner = Vec2::new(8.0, 0.0);
    let route = HoleShape::Route(vec![
        Element::line(Vec2::ZERO, corner),
        Element::arc(corner, Vec2::new(8.0, 6.0), Vec2::new(8.0, 3.0), PI),
        Element::line(Vec2::new(8.0, 6.0), Vec2::new(0.0, 6.0)),
    ]);
    let loop_ = HoleShape::Route(vec![Element::arc(corner, corner, Vec2::ZERO, 2.0 * PI)]);
    let slot = HoleShape::Slot(Vec2::ZERO, corner);
    let disc = HoleShape::Round(corner);
    for shape in [route, loop_, slot, disc] {
        for diameter in [1.0, 1.5, 2.5, 3.0, 4.2] {
            for direction in [Direction::Climb, Direction::Conventional] {
                let mill = Mill { direction, ..mill(1.0) };
                let milling = Drilling {
                    mill: Some(Mill { instead: 1.1, ..mill }),
                    slots: Slots::Mill,
                    ..drilling()
                };
                if diameter == 1.0 && matches!(shape, HoleShape::Round(_)) {
                    continue;
                }
                let made = made(&milling, &[hole(diameter, shape.clone())]);
                let middles = match &shape {
                    HoleShape::Round(at) => vec![Element::line(*at, *at)],
                    HoleShape::Slot(a, b) => vec![Element::line(*a, *b)],
                    HoleShape::Route(elements) => elements.clone(),
                };
                let strokes: Vec<Region> = middles
                    .iter()
                    .map(|middle| Region::stroke(middle, diameter, Cap::Round).unwrap())
                    .collect();
                let whole = Region::union_of(&strokes).unwrap();
                let off = whole.xor(&swept(&made.operations[0], 1.0)).unwrap();
                assert!(off.area() < 1e-3 * whole.area(), "{shape:?} {diameter}: {}", off.area());
            }
        }
    }
}

#[test]
fn a_route_that_closes_frees_what_is_within() {
    let milling = Drilling { mill: Some(mill(1.0)), ..drilling() };
    let circle = |radius: f64| {
        let start = Vec2::new(4.0 + radius, 5.0);
        HoleShape::Route(vec![Element::arc(start, start, Vec2::new(4.0, 5.0), 2.0 * PI)])
    };
    let warned = |shape| {
        let made = made(&milling, &[hole(1.0, shape)]);
        made.warnings
            .iter()
            .map(|found| (found.rule.name(), found.message.clone()))
            .collect::<Vec<_>>()
    };
    let [(rule, message)] = &*warned(circle(3.0)) else { panic!() };
    assert_eq!(*rule, "piece-loose");
    assert!(message.contains("X 7.000 Y 5.000"), "{message}");
    // A circle of 0.9 mm, 1 mm wide, leaves nothing; an open route holds its piece.
    assert!(warned(circle(0.45)).is_empty());
    let corners = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0), (0.0, 2.0)].map(Vec2::from);
    let open = corners.windows(2).map(|ends| Element::line(ends[0], ends[1])).collect();
    assert!(warned(HoleShape::Route(open)).is_empty());
}

#[test]
fn what_makes_no_sense_is_refused() {
    let slot = hole(1.0, HoleShape::Slot(Vec2::ZERO, Vec2::X));
    let route = hole(1.0, HoleShape::Route(vec![Element::line(Vec2::ZERO, Vec2::X)]));
    let rule = |drilling: Drilling, hole: &Hole| {
        drilling.drill(std::slice::from_ref(hole)).unwrap_err()[0].rule.name()
    };
    assert_eq!(rule(Drilling { thickness: 0.0, ..drilling() }, &slot), "length");
    assert_eq!(rule(Drilling { peck: Some(f64::NAN), ..drilling() }, &slot), "length");
    assert_eq!(rule(Drilling { drills: Some(vec![-1.0]), ..drilling() }, &slot), "length");
    assert_eq!(
        rule(Drilling { slots: Slots::Chain { scallop: 0.0 }, ..drilling() }, &slot),
        "length"
    );
    assert_eq!(rule(drilling(), &route), "no-cutter");
    assert_eq!(rule(Drilling { mill: Some(mill(1.2)), ..drilling() }, &route), "no-cutter");
    let steps = Mill { step: 0.001, ..mill(1.0) };
    assert_eq!(rule(Drilling { mill: Some(steps), ..drilling() }, &route), "step");
    let mut vee = mill(1.0);
    vee.tool.cutter = Cutter::Vee { tip: 0.1, angle: 1.0 };
    assert_eq!(rule(Drilling { mill: Some(vee), ..drilling() }, &route), "cutter");
    let fine = Drilling { slots: Slots::Chain { scallop: 1e-12 }, ..drilling() };
    assert_eq!(rule(fine, &slot), "chain-too-long");
}

#[test]
fn every_hole_of_the_boards_is_drilled_once_with_its_diameter() {
    let Some(folder) = data::folder() else { return };
    for name in ["StickHub", "ecc83-pp", "interf_u", "pic_programmer", "microwave"] {
        let board = boards::folder(&folder.join("kicad").join(name)).unwrap().board;
        let drilling = Drilling { mill: Some(mill(0.3)), slots: Slots::Mill, ..drilling() };
        let made = made(&drilling, &board.holes);
        let mut drilled: Vec<(f64, [u64; 2])> = Vec::new();
        let mut travel = 0.0;
        let mut at = Vec2::ZERO;
        for operation in &made.operations {
            for cut in &operation.cuts {
                if let Cut::Hole { at, .. } = cut {
                    drilled
                        .push((operation.tool.cutter.width(0.0), at.to_array().map(f64::to_bits)));
                }
                travel += at.distance(cut.start());
                at = cut.end();
            }
        }
        let mut holes: Vec<(f64, [u64; 2])> = Vec::new();
        let mut unordered = 0.0;
        let mut before = Vec2::ZERO;
        for hole in &board.holes {
            if let HoleShape::Round(at) = hole.shape {
                holes.push((hole.diameter, at.to_array().map(f64::to_bits)));
                unordered += before.distance(at);
                before = at;
            }
        }
        drilled.sort_by(|a, b| a.partial_cmp(b).unwrap());
        holes.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(drilled, holes, "{name}");
        let diameters: Vec<f64> =
            made.operations.iter().map(|operation| operation.tool.cutter.width(0.0)).collect();
        let drills = diameters.len() - usize::from(drilled.len() < board.holes.len());
        assert!(diameters[..drills].is_sorted(), "{name}: {diameters:?}");
        assert!(travel <= unordered, "{name}: {travel} {unordered}");
    }
}
