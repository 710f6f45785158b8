//! Drawings: entities, layers, units, blocks, gaps, garbage.

use geom::Vec2;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use toolpost_wire::dxf::{Drawing, Options, read};
use toolpost_wire::{Contour, Element};

/// A file with these entities, in mm: codes and values parted by blanks.
fn file(entities: &str) -> Vec<u8> {
    sections("9 $INSUNITS 70 4", "", entities)
}

fn sections(header: &str, blocks: &str, entities: &str) -> Vec<u8> {
    let text = format!(
        "0 SECTION 2 HEADER {header} 0 ENDSEC 0 SECTION 2 BLOCKS {blocks} 0 ENDSEC \
         0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF"
    );
    text.split_whitespace().flat_map(|word| [word.as_bytes(), b"\r\n"].concat()).collect()
}

fn drawing(entities: &str) -> Drawing {
    read(&file(entities), &Options::default()).unwrap()
}

fn refused(entities: &str) -> program::Diagnostic {
    *read(&file(entities), &Options::default()).unwrap_err()
}

fn line(from: (f64, f64), to: (f64, f64)) -> String {
    format!("0 LINE 8 0 10 {} 20 {} 11 {} 21 {}", from.0, from.1, to.0, to.1)
}

fn p(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

/// A rectangle with a half circle for its right side, its elements in no order and direction.
#[test]
fn lines_and_arcs_are_chained_whatever_their_order_and_direction() {
    let text = [
        line((0.0, 0.0), (0.0, 10.0)),
        line((20.0, 0.0), (0.0, 0.0)),
        "0 ARC 8 0 10 20 20 5 40 5 50 270 51 90".into(),
        line((20.0, 10.0), (0.0, 10.0)),
    ];
    let drawing = drawing(&text.join(" "));
    let [contour] = drawing.contours.as_slice() else { panic!("{drawing:?}") };
    assert!(contour.is_closed());
    // The first line goes up on the left: clockwise.
    assert!((contour.area() + 200.0 + PI * 12.5).abs() < 1e-9, "{}", contour.area());
    assert_eq!(contour.start(), p(0.0, 0.0));
    // Each `LINE` begins on the line of the file where its name stands.
    let lines: Vec<u32> = contour.elements().iter().map(|e| e.line).collect();
    let at = |i: usize| lines[i];
    assert!(at(0) < at(3) && at(3) > 0 && lines.len() == 4, "{lines:?}");
    assert!(drawing.warnings.is_empty());
}

#[test]
fn circles_and_polylines_with_bulges() {
    let drawing = drawing(
        "0 CIRCLE 8 0 10 5 20 6 40 2 \
         0 LWPOLYLINE 8 0 90 2 70 1 10 20 20 0 42 1 10 30 20 0 42 1 \
         0 POLYLINE 8 0 66 1 70 1 0 VERTEX 8 0 10 50 20 0 0 VERTEX 8 0 10 60 20 0 42 1 \
         0 VERTEX 8 0 10 60 20 10 0 VERTEX 8 0 10 50 20 10 0 SEQEND",
    );
    let areas: Vec<f64> = drawing.contours.iter().map(|contour| contour.area()).collect();
    let expected = [PI * 4.0, PI * 25.0, 100.0 + PI * 12.5];
    assert!(areas.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{areas:?}");
}

#[test]
fn what_is_seen_from_behind_is_mirrored() {
    let drawing = drawing(
        "0 ARC 8 0 10 20 20 5 40 5 50 270 51 90 230 -1 \
         0 LWPOLYLINE 8 0 90 2 70 1 10 20 20 0 42 1 10 30 20 0 42 1 230 -1",
    );
    let arc = drawing.contours[0].elements()[0];
    assert!(arc.start.distance(p(-20.0, 0.0)) < 1e-9 && arc.end.distance(p(-20.0, 10.0)) < 1e-9);
    assert!(arc.at(0.5).distance(p(-25.0, 5.0)) < 1e-9);
    assert!((drawing.contours[1].area() + PI * 25.0).abs() < 1e-9);
}

#[test]
fn ellipses_and_splines_become_arcs_within_the_tolerance() {
    let drawing = drawing(
        "0 ELLIPSE 8 0 10 0 20 0 11 20 21 0 40 0.4 41 0 42 6.283185307179586 \
         0 SPLINE 8 0 70 8 71 2 72 6 73 3 40 0 40 0 40 0 40 1 40 1 40 1 \
         10 100 20 0 10 100 20 10 10 110 20 10",
    );
    let ellipse = &drawing.contours[0];
    assert!(ellipse.is_closed());
    assert!((ellipse.area() - PI * 160.0).abs() < 0.1, "{}", ellipse.area());
    // The parabola from (100, 0) by (100, 10) to (110, 10) at 1/2: a quarter, a half, a quarter.
    let spline = &drawing.contours[1];
    assert!(spline.nearest(p(102.5, 7.5)).point.distance(p(102.5, 7.5)) < 1e-3);
    assert_eq!((spline.start(), spline.end()), (p(100.0, 0.0), p(110.0, 10.0)));
}

#[test]
fn the_unit_is_that_of_the_file_or_the_one_that_is_named() {
    let circle = "0 CIRCLE 8 0 10 0 20 0 40 1";
    let read_in = |header: &str, unit: Option<f64>| {
        let text = sections(header, "", circle);
        read(&text, &Options { unit, ..Options::default() })
    };
    let radius = |drawing: &Drawing| drawing.contours[0].elements()[0].radius().unwrap();
    assert!((radius(&read_in("9 $INSUNITS 70 1", None).unwrap()) - 25.4).abs() < 1e-12);
    assert!((radius(&read_in("9 $INSUNITS 70 1", Some(1.0)).unwrap()) - 1.0).abs() < 1e-12);
    let unnamed = read_in("9 $ACADVER 1 AC1009", None).unwrap();
    assert_eq!(unnamed.warnings[0].rule.name(), "dxf-unit");
    assert_eq!(read_in("9 $INSUNITS 70 3", None).unwrap_err().rule.name(), "dxf-unit");
    assert_eq!(read_in("", Some(f64::NAN)).unwrap_err().rule.name(), "dxf-options");
}

#[test]
fn layers_are_chosen_and_what_is_not_read_is_counted() {
    let text = "0 CIRCLE 8 Cut 10 0 20 0 40 1 0 CIRCLE 8 Notes 10 9 20 0 40 1 \
                0 HATCH 8 Cut 0 HATCH 8 Cut 0 TEXT 8 Cut 1 hello";
    let all = drawing(text);
    assert_eq!(all.contours.len(), 2);
    let counted: Vec<(&str, u32)> =
        all.warnings.iter().map(|w| (w.message.as_str(), w.count)).collect();
    assert_eq!(counted, [("HATCH: not read", 2), ("TEXT: not read", 1)]);
    let options = Options { layers: vec!["CUT".into()], ..Options::default() };
    assert_eq!(read(&file(text), &options).unwrap().contours.len(), 1);
    let options = Options { layers: vec!["wire".into()], ..Options::default() };
    let refused = read(&file(text), &options).unwrap_err();
    assert_eq!(refused.rule.name(), "dxf-layer");
    assert!(refused.help.contains("CUT, NOTES"), "{refused}");
}

/// Scale −2 in X, 2 in Y, turned by 90°, twice next to each other: (1, 0) goes to (0, −2).
#[test]
fn blocks_are_placed_turned_mirrored_and_repeated() {
    let block = "0 BLOCK 8 0 2 b 10 1 20 0 0 LINE 8 0 10 1 20 0 11 2 21 0 0 ENDBLK";
    let insert = "0 INSERT 8 0 2 b 10 10 20 20 41 -2 42 2 50 90 70 2 44 100";
    let text = sections("9 $INSUNITS 70 4", block, insert);
    let drawing = read(&text, &Options::default()).unwrap();
    let lines: Vec<(Vec2, Vec2)> =
        drawing.contours.iter().map(|contour| (contour.start(), contour.end())).collect();
    for (line, y) in lines.iter().zip([20.0, 120.0]) {
        assert!(line.0.distance(p(10.0, y)) < 1e-9 && line.1.distance(p(10.0, y - 2.0)) < 1e-9);
    }
    let uneven = sections("", block, "0 INSERT 2 b 10 0 20 0 41 1 42 2");
    assert_eq!(read(&uneven, &Options::default()).unwrap_err().rule.name(), "dxf-insert");
    let itself = "0 BLOCK 2 b 10 0 20 0 0 INSERT 2 b 10 0 20 0 70 9 71 9 0 ENDBLK";
    let endless = sections("", itself, "0 INSERT 2 b 10 0 20 0");
    assert_eq!(read(&endless, &Options::default()).unwrap_err().rule.name(), "dxf-insert");
}

#[test]
fn small_gaps_are_closed_and_wide_ones_stay_open() {
    let square = |gap: f64| {
        [
            line((0.0, 0.0), (10.0, 0.0)),
            line((10.0 + gap, 0.0), (10.0, 10.0)),
            line((10.0, 10.0), (0.0, 10.0)),
            line((0.0, 10.0), (0.0, 0.0)),
        ]
        .join(" ")
    };
    let closed = drawing(&square(0.009));
    assert!(closed.contours[0].is_closed());
    assert_eq!(closed.warnings[0].rule.name(), "dxf-gap");
    let open = drawing(&square(0.011));
    assert!(!open.contours[0].is_closed());
    assert_eq!(open.contours.len(), 1);
}

/// An arc of nearly a full circle closes to a full one; a small one does not shrink to nothing.
#[test]
fn arcs_keep_their_shape_where_gaps_are_closed() {
    let circle = drawing("0 ARC 10 5 20 1 40 1 50 0.5 51 0");
    let [arc] = circle.contours[0].elements() else { panic!("{circle:?}") };
    assert!(circle.contours[0].is_closed());
    assert!((arc.turn.unwrap().sweep - TAU).abs() < 1e-12);
    assert!(
        (arc.radius().unwrap() - 1.0).abs() < 0.005 && arc.at(0.5).distance(p(4.0, 1.0)) < 0.01
    );
    let far = p(10.004, 0.004);
    let fillet = vec![
        Element::line(p(0.0, 0.0), far),
        Element::arc(p(10.0, 0.0), far, p(10.0, 0.004), PI / 2.0),
        Element::line(far, p(20.0, 10.0)),
    ];
    let contour = Contour::new(fillet, 0.01).unwrap();
    assert!(contour.elements().iter().all(|e| e.at(0.5).is_finite()));
}

#[test]
fn doubled_entities_fall_away_and_branches_are_refused() {
    let square = "0 LWPOLYLINE 70 1 10 0 20 0 10 10 20 0 10 10 20 10 10 0 20 10";
    let doubled = drawing(&format!("{square} {square}"));
    assert_eq!((doubled.contours.len(), doubled.warnings[0].rule.name()), (1, "dxf-doubled"));
    let star = [
        line((0.0, 0.0), (10.0, 0.0)),
        line((0.0, 0.0), (0.0, 10.0)),
        line((0.0, 0.0), (-5.0, 0.0)),
    ];
    let refused = refused(&star.join(" "));
    assert_eq!(refused.rule.name(), "branch");
    assert!(refused.message.contains("X0.0000 Y0.0000"), "{refused}");
}

#[test]
fn what_is_not_whole_or_not_flat_is_refused_with_its_line() {
    let cases = [
        ("0 LINE 8 0 10 0 20 0 11 5", "dxf-entity"),
        ("0 LINE 10 0 20 0 30 0 11 5 21 5 31 1", "dxf-slanted"),
        ("0 LINE 10 0 20 NaN 11 5 21 5", "dxf-number"),
        ("0 LINE 10 0 20 1e999 11 5 21 5", "dxf-number"),
        ("0 LINE 10 0 20 1e9 11 5 21 5", "not-a-place"),
        ("0 CIRCLE 10 0 20 0 40 -1", "dxf-entity"),
        ("0 CIRCLE 10 0 20 0 40 1 210 1 230 0", "dxf-slanted"),
        ("0 ELLIPSE 10 0 20 0 11 5 21 0 40 0", "dxf-entity"),
        ("0 SPLINE 71 3 40 0 10 0 20 0", "dxf-spline"),
        ("0 SPLINE 71 3 11 0 21 0 11 5 21 5", "dxf-spline"),
        ("0 INSERT 2 none 10 0 20 0", "dxf-insert"),
        ("0 TEXT 1 nothing", "empty-contour"),
        ("0 LINE 10 1 20 1 11 1 21 1", "empty-contour"),
    ];
    for (text, rule) in cases {
        let refused = refused(text);
        assert_eq!(refused.rule.name(), rule, "{text}: {refused}");
        assert!(refused.line > 0 || rule == "empty-contour", "{refused}");
    }
}

#[test]
fn what_is_no_dxf_is_refused() {
    let rule = |text: &[u8]| read(text, &Options::default()).unwrap_err().rule.name();
    assert_eq!(rule(b"AutoCAD Binary DXF\r\n\x1a\0"), "dxf-binary");
    assert_eq!(rule(b"G1 X10\nG1 Y10\n"), "dxf-code");
    assert_eq!(rule(b""), "dxf-code");
    assert_eq!(rule(b"0\n"), "dxf-code");
    assert_eq!(rule(b"0\nSECTION\n"), "dxf-code");
    assert_eq!(rule(&vec![b'9'; 10_000_000]), "dxf-code");
    assert_eq!(rule(&file("")), "empty-contour");
    let options = Options { gap: f64::NAN, ..Options::default() };
    assert_eq!(read(&file(""), &options).unwrap_err().rule.name(), "dxf-options");
}

/// A hundred thousand ends at one place, and as many blocks as a file can ask for.
#[test]
fn crowds_are_refused_in_time() {
    let fan: String =
        (0..100_000).map(|i| line((0.0, 0.0), (f64::from(i) / 100.0, 10.0)) + " ").collect();
    let rule = refused(&fan).rule.name();
    assert!(matches!(rule, "branch" | "too-tangled"), "{rule}");
    let insert = "0 INSERT 2 a 10 0 20 0 70 30000 71 30000";
    let block = format!("0 BLOCK 2 a 10 0 20 0 0 TEXT 1 x {insert} 0 ENDBLK");
    let text = sections("", &block, insert);
    assert!(matches!(
        read(&text, &Options::default()).unwrap_err().rule.name(),
        "dxf-size" | "dxf-insert"
    ));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// A polygon with rounded sides, its pieces shuffled and turned round, comes back whole.
    #[test]
    fn shuffled_contours_come_back_whole(
        radii in prop::collection::vec(5.0f64..20.0, 3..30),
        order in prop::collection::vec((0usize..1000, any::<bool>()), 30),
    ) {
        let n = radii.len();
        let corner = |i: usize| Vec2::from_angle(TAU * (i % n) as f64 / n as f64) * radii[i % n];
        let mut pieces: Vec<usize> = (0..n).collect();
        pieces.sort_by_key(|i| order[*i].0);
        let text: Vec<String> = pieces.iter().map(|&i| {
            let (a, b) = (corner(i), corner(i + 1));
            let (a, b) = if order[i].1 { (a, b) } else { (b, a) };
            line((a.x, a.y), (b.x, b.y))
        }).collect();
        let drawing = drawing(&text.join(" "));
        prop_assert_eq!(drawing.contours.len(), 1);
        let area: f64 = (0..n).map(|i| corner(i).perp_dot(corner(i + 1)) / 2.0).sum();
        prop_assert!((drawing.contours[0].area().abs() - area).abs() < 1e-6);
        prop_assert!(drawing.contours[0].is_closed());
    }

    #[test]
    fn no_bytes_make_it_panic(words in prop::collection::vec(
        prop::sample::select(vec![
            "0", "LINE", "ARC", "SPLINE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "VERTEX", "INSERT",
            "SECTION", "ENTITIES", "BLOCKS", "BLOCK", "ENDBLK", "ENDSEC", "EOF", "2", "b", "10",
            "20", "11", "21", "40", "41", "42", "70", "71", "1", "-1", "0.5", "3", "1e5", "230",
        ]), 0..200))
    {
        let text = file(&words.join(" "));
        let _ = read(&text, &Options::default());
        let raw: Vec<u8> = words.join("\n").into_bytes();
        let _ = read(&raw, &Options::default());
    }
}
