//! Outlines: what is cut, what stays, and what holds it.

use crate::{boards, data};
use geom::region::{Cap, Fill, Region, Ring};
use geom::{Element, Vec2};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use toolpost_pcb::isolation::Direction;
use toolpost_pcb::outline::{CutOut, Outline, Tabs};
use toolpost_pcb::{Cut, Cutter, Segment, Tool};

fn outline(tabs: Option<Tabs>) -> Outline {
    Outline {
        tool: Tool {
            name: "end mill".into(),
            cutter: Cutter::Cylinder { diameter: 2.0 },
            feed: 200.0,
            plunge: 60.0,
            speed: 12_000.0,
        },
        thickness: 1.6,
        below: 0.2,
        step: 0.6,
        direction: Direction::Conventional,
        tabs,
        tabs_at: Vec::new(),
        from: Vec2::new(-10.0, -10.0),
    }
}

fn rectangle(low: (f64, f64), high: (f64, f64)) -> Ring {
    let corners = [low, (high.0, low.1), high, (low.0, high.1)].map(Vec2::from);
    Ring::polygon(&corners).unwrap()
}

fn region(rings: &[Ring]) -> Region {
    Region::inside(rings, Fill::EvenOdd).unwrap()
}

fn paths(cut: &CutOut) -> Vec<Vec<Segment>> {
    let segments = |cut: &Cut| match cut {
        Cut::Hole { .. } => panic!("a hole"),
        Cut::Path(segments) => segments.clone(),
    };
    cut.operation.cuts.iter().map(segments).collect()
}

/// What is taken away at `depth` mm.
fn swept(cut: &CutOut, depth: f64) -> Region {
    let paths = paths(cut).concat();
    let there = paths.iter().filter(|segment| segment.depth >= depth);
    let strokes: Vec<Region> =
        there.map(|segment| Region::stroke(&segment.element, 2.0, Cap::Round).unwrap()).collect();
    Region::union_of(&strokes).unwrap()
}

fn area(path: &[Segment]) -> f64 {
    path.iter().map(|segment| segment.element.area(path[0].element.start)).sum()
}

#[test]
fn cut_outs_come_first_and_the_edge_is_cut_outside() {
    let board = region(&[
        rectangle((0.0, 0.0), (40.0, 20.0)),
        rectangle((5.0, 5.0), (12.0, 10.0)),
        rectangle((25.0, 5.0), (30.0, 15.0)),
    ]);
    let cut = outline(None).cut(&board).unwrap();
    let paths = paths(&cut);
    assert_eq!(paths.len(), 3);
    // 1.8 mm in three levels. Around the outside 2·(40 + 20) and a circle of 1 mm.
    for path in &paths {
        let mut depths: Vec<f64> = path.iter().map(|segment| segment.depth).collect();
        depths.dedup();
        assert_eq!(depths, [0.6, 1.2, 1.8].map(|depth: f64| depth / 1.8 * 1.8));
        for pair in path.windows(2) {
            assert_eq!(pair[0].element.end, pair[1].element.start);
        }
    }
    let level = |i: usize| paths[i].len() / 3;
    let length = |i: usize| -> f64 {
        paths[i][..level(i)].iter().map(|segment| segment.element.length()).sum()
    };
    assert!((length(2) - 120.0 - TAU).abs() < 1e-6);
    // Within the cut-outs 2·(5 + 3) and 2·(3 + 8).
    assert!((length(0) - 16.0).abs() < 1e-6 && (length(1) - 22.0).abs() < 1e-6);
    // What stays is on the left: around the outside counter-clockwise, in cut-outs clockwise.
    assert!(area(&paths[2][..level(2)]) > 0.0 && area(&paths[0][..level(0)]) < 0.0);
    let climb = Outline { direction: Direction::Climb, ..outline(None) }.cut(&board).unwrap();
    let turned: Vec<f64> = self::paths(&climb).iter().map(|path| area(path)).collect();
    assert!(turned[2] < 0.0 && turned[0] > 0.0 && turned[1] > 0.0);
    // Four corners in each cut-out stay round.
    let corners: Vec<&str> = cut.warnings.iter().map(|warning| warning.rule.name()).collect();
    assert_eq!(corners, ["narrow-corner"; 8]);
}

#[test]
fn tabs_are_on_straight_pieces_and_keep_their_width() {
    let tabs = Tabs { count: 4, width: 3.0, height: 0.8 };
    let board = region(&[rectangle((0.0, 0.0), (40.0, 20.0))]);
    let cut = outline(Some(tabs)).cut(&board).unwrap();
    assert!(cut.warnings.is_empty(), "{:?}", cut.warnings);
    let path = &paths(&cut)[0];
    // At 0.6 mm all around; deeper than 0.8 mm not over tabs.
    let over: Vec<&Segment> = path.iter().filter(|segment| segment.depth == 0.8).collect();
    assert_eq!(over.len(), 8);
    for tab in &over {
        assert!(tab.element.turn.is_none() && (tab.element.length() - 5.0).abs() < 1e-9);
    }
    assert!(
        path.iter()
            .all(|segment| [0.6, 0.8, 1.2, 1.8].iter().any(|d| (segment.depth - d).abs() < 1e-9))
    );
    assert!(path[0].depth < 0.7);
    // Above the tabs the four sides and corners are whole.
    assert_eq!(path.iter().filter(|segment| segment.depth == 0.6).count(), 8);
    // Each tab is 5 mm by 2 mm less two half circles of the tool.
    let left = swept(&cut, 0.5).difference(&swept(&cut, 1.7)).unwrap();
    assert_eq!(left.islands().len(), 4);
    assert!((left.area() - 4.0 * (10.0 - PI)).abs() < 1e-3, "{}", left.area());
    // Evenly: a quarter of the length apart, 120 mm and a circle of 1 mm in all.
    let mut at = 0.0;
    let mut middles = Vec::new();
    for Segment { element, depth } in path.iter().filter(|segment| segment.depth != 0.6) {
        if *depth == 0.8 && middles.len() < 4 {
            middles.push(at + element.length() / 2.0);
        }
        at += element.length();
    }
    for pair in middles.windows(2) {
        assert!((pair[1] - pair[0] - (120.0 + TAU) / 4.0).abs() < 2.0, "{middles:?}");
    }
}

#[test]
fn a_round_board_has_its_tabs_on_the_arc_and_a_small_one_fewer() {
    let tabs = Tabs { count: 3, width: 3.0, height: 0.8 };
    let disc = Region::disc(Vec2::ZERO, 15.0).unwrap();
    let cut = outline(Some(tabs)).cut(&disc).unwrap();
    assert_eq!(cut.warnings[0].rule.name(), "tabs-bent");
    let left = swept(&cut, 0.5).difference(&swept(&cut, 1.7)).unwrap();
    assert_eq!(left.islands().len(), 3);
    let small = Region::disc(Vec2::ZERO, 2.5).unwrap();
    let cut = outline(Some(tabs)).cut(&small).unwrap();
    let rules: Vec<&str> = cut.warnings.iter().map(|warning| warning.rule.name()).collect();
    // 2π·3.5 = 22 mm hold two tabs of 5 mm with as much between them.
    assert_eq!(rules, ["tabs-left-out", "tabs-bent"]);
    // Of a cut-out that the tool clears nothing comes loose.
    let ring = [rectangle((0.0, 0.0), (40.0, 20.0)), rectangle((5.0, 5.0), (8.5, 15.0))];
    let cut = outline(Some(tabs)).cut(&region(&ring)).unwrap();
    assert!(paths(&cut)[0].iter().all(|segment| segment.depth != 0.8));
}

#[test]
fn too_wide_tools_are_found_with_the_place_and_what_fits() {
    let board = region(&[rectangle((0.0, 0.0), (40.0, 20.0)), rectangle((5.0, 5.0), (6.5, 15.0))]);
    let errors = outline(None).cut(&board).unwrap_err();
    assert_eq!(errors[0].rule.name(), "cutout-too-small");
    assert!(errors[0].message.contains("X 5.750 Y 10.000"), "{}", errors[0]);
    // 1.375 is the next below 1.5 of sixteenths of 2.
    assert!(errors[0].help.contains("1.375"), "{}", errors[0]);
    // A notch of 1.5 mm, open to the right.
    let notched =
        region(&[rectangle((0.0, 0.0), (40.0, 20.0)), rectangle((30.0, 9.0), (40.0, 10.5))]);
    let cut = outline(None).cut(&notched).unwrap();
    let [warning] = &*cut.warnings else { panic!("{:?}", cut.warnings) };
    assert_eq!(warning.rule.name(), "narrow-corner");
    assert!(swept(&cut, 1.0).intersection(&notched).unwrap().area() < 1e-6);
}

#[test]
fn pieces_that_the_tool_does_not_part_are_refused() {
    let panel = |gap: f64| {
        let right = rectangle((10.0 + gap, 0.0), (20.0 + gap, 10.0));
        region(&[rectangle((0.0, 0.0), (10.0, 10.0)), right])
    };
    let errors = outline(None).cut(&panel(1.5)).unwrap_err();
    let [error] = &*errors else { panic!("{errors:?}") };
    assert_eq!(error.rule.name(), "not-parted");
    assert!(error.message.contains("X 16.500 Y 5.000"), "{error}");
    assert!(error.help.contains("1.375"), "{error}");
    assert_eq!(paths(&outline(None).cut(&panel(2.1)).unwrap()).len(), 2);
    // Nor is a piece in the cut-out of a frame.
    let frame =
        [((0.0, 0.0), (40.0, 40.0)), ((5.0, 5.0), (35.0, 35.0)), ((6.5, 6.5), (33.5, 33.5))];
    let framed = region(&frame.map(|(low, high)| rectangle(low, high)));
    assert_eq!(outline(None).cut(&framed).unwrap_err()[0].rule.name(), "not-parted");
}

#[test]
fn many_tight_cut_outs_are_counted() {
    let slot =
        |i: u32| rectangle((f64::from(i) * 2.0 + 1.0, 5.0), (f64::from(i) * 2.0 + 2.0, 15.0));
    let rings: Vec<Ring> =
        [rectangle((0.0, 0.0), (140.0, 20.0))].into_iter().chain((0..60).map(slot)).collect();
    let errors = outline(None).cut(&region(&rings)).unwrap_err();
    assert_eq!(errors.len(), 50);
    assert_eq!(errors.iter().map(|error| error.count).sum::<u32>(), 60);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let board = region(&[rectangle((0.0, 0.0), (40.0, 20.0))]);
    let rule = |outline: Outline, board: &Region| outline.cut(board).unwrap_err()[0].rule.name();
    let tabs = |count, width, height| Some(Tabs { count, width, height });
    assert_eq!(rule(outline(None), &Region::default()), "no-outline");
    assert_eq!(rule(Outline { step: 0.0, ..outline(None) }, &board), "length");
    assert_eq!(rule(Outline { step: 0.001, ..outline(None) }, &board), "step");
    assert_eq!(rule(Outline { thickness: f64::NAN, ..outline(None) }, &board), "length");
    assert_eq!(rule(outline(tabs(4, 3.0, 1.6)), &board), "tab-height");
    assert_eq!(rule(outline(tabs(0, 3.0, 0.5)), &board), "tab-count");
    assert_eq!(rule(outline(tabs(4, -3.0, 0.5)), &board), "length");
}

#[test]
fn what_lies_within_is_cut_before_what_is_around_it() {
    // A board in the cut-out of a frame.
    let rings = [
        rectangle((0.0, 0.0), (60.0, 60.0)),
        rectangle((5.0, 5.0), (55.0, 55.0)),
        rectangle((10.0, 10.0), (50.0, 50.0)),
        rectangle((20.0, 20.0), (40.0, 40.0)),
    ];
    let cut = outline(None).cut(&region(&rings)).unwrap();
    let sides: Vec<f64> = paths(&cut)
        .iter()
        .map(|path| {
            let xs = path.iter().map(|segment| segment.element.start.x);
            xs.clone().fold(f64::MIN, f64::max) - xs.fold(f64::MAX, f64::min)
        })
        .map(f64::round)
        .collect();
    assert_eq!(sides, [18.0, 42.0, 48.0, 62.0]);
}

#[test]
fn real_boards_are_cut_out_whole() {
    let Some(folder) = data::folder() else { return };
    for name in ["StickHub", "ecc83-pp", "interf_u", "pic_programmer", "microwave"] {
        let board = boards::folder(&folder.join("kicad").join(name)).unwrap().board.outline;
        let Some(board) = board else { continue };
        let tabs = Tabs { count: 4, width: 2.0, height: 0.8 };
        let cut = outline(Some(tabs)).cut(&board).unwrap_or_else(|errors| panic!("{errors:#?}"));
        let swept = swept(&cut, 1.7);
        let kept = board.offset(-0.002).unwrap();
        assert!(swept.intersection(&kept).unwrap().area() < 1e-9, "{name}");
        let held = self::swept(&cut, 0.1).difference(&swept).unwrap();
        assert!(held.islands().len() >= 4, "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_board_stays_whole_and_is_cut_all_around(
        rings in prop::collection::vec((0.0..40.0, 0.0..40.0, 6.0..40.0, 6.0..40.0), 1..6),
        discs in prop::collection::vec((0.0..60.0, 0.0..60.0, 3.0..12.0), 0..3),
        count in 1usize..8,
    ) {
        let rings: Vec<Ring> = rings
            .into_iter()
            .map(|(x, y, w, h)| rectangle((x, y), (x + w, y + h)))
            .chain(discs.into_iter().map(|(x, y, radius): (f64, f64, f64)| {
                let (center, start) = (Vec2::new(x, y), Vec2::new(x + radius, y));
                Ring::new(vec![Element::arc(start, start, center, TAU)]).unwrap()
            }))
            .collect();
        let board = region(&rings);
        let tabs = Tabs { count, width: 2.0, height: 0.5 };
        let cut = match outline(Some(tabs)).cut(&board) {
            Ok(cut) => cut,
            Err(errors) => {
                let tight = |rule| matches!(rule, "cutout-too-small" | "not-parted");
                prop_assert!(errors.iter().all(|error| tight(error.rule.name())));
                return Ok(());
            }
        };
        let all = swept(&cut, 0.1);
        // Lines and arcs are exact to 1 µm.
        prop_assert!(all.intersection(&board.offset(-0.002).unwrap()).unwrap().area() < 1e-9);
        // Without tabs nothing within reach of the tool stays but what it does not reach.
        let around = board.offset(1.0).unwrap().offset(1.0).unwrap();
        let reach = around.difference(&board.offset(1.0).unwrap().offset(-1.0).unwrap()).unwrap();
        prop_assert!(reach.difference(&all).unwrap().offset(-0.003).unwrap().area() < 1e-6);
        let missing = cut.warnings.iter().any(|warning| warning.rule.name() == "tabs-left-out");
        let through = swept(&cut, 1.7);
        let left = all.difference(&through).unwrap();
        prop_assert!(missing || !left.is_empty());
        prop_assert_eq!(outline(Some(tabs)).cut(&board).unwrap(), cut);
    }
}
