//! Curves: what is read of DXF and HP-GL, and points along them. Expected values are counted by hand.

use glam::DVec3;
use std::f64::consts::{PI, TAU};
use toolpost_glass::cloud::place;
use toolpost_glass::curve::{Curves, Form, Layers, read};

fn hpgl(text: &str) -> Curves {
    read(text.as_bytes(), Form::Hpgl, "in.plt").unwrap_or_else(|found| panic!("{found:?}"))
}

fn dxf(entities: &str) -> Vec<u8> {
    let text = format!(
        "0 SECTION 2 HEADER 9 $INSUNITS 70 4 0 ENDSEC 0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF"
    );
    text.split_whitespace().flat_map(|word| [word.as_bytes(), b"\n"].concat()).collect()
}

fn length(corners: &[DVec3]) -> f64 {
    corners.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// The corners of each curve, as x,y in mm.
fn shown(curves: &Curves) -> Vec<String> {
    let corner = |at: &DVec3| format!("{},{}", at.x, at.y);
    let curve = |corners: &[DVec3]| corners.iter().map(corner).collect::<Vec<_>>().join(" ");
    curves.curves.iter().map(|curve_of| curve(&curve_of.corners)).collect()
}

#[test]
fn a_plotter_draws_where_its_pen_is_down() {
    // A unit is 0.025 mm: 400 are 10 mm. One square, one line relative to its end, and a dot.
    let text = "IN;SP1;PU0,0;PD400,0,400,400,0,400,0,0;PU;PR400,400;PD40,0;PU;PA800,0;PD;PU;SP0;";
    let curves = hpgl(text);
    assert_eq!(shown(&curves), ["0,0 10,0 10,10 0,10 0,0", "10,10 11,10", "20,0"]);
    assert!(curves.curves[0].is_closed() && !curves.curves[1].is_closed());
    // Blanks and line feeds in place of commas and semicolons, small letters, and the escape sequences around the language.
    let loose = "\x1b%-1B\x1b.@;0:in sp1\npu 0 0\npd 400 0 400 400 0 400 0 0\npu\x1b%0A";
    assert_eq!(shown(&hpgl(loose)), ["0,0 10,0 10,10 0,10 0,0"]);
}

#[test]
fn arcs_circles_and_beziers_of_a_plotter_are_as_long_as_they_are() {
    let long = |text: &str| {
        let curves = hpgl(text);
        let last = curves.curves.last().unwrap().corners.clone();
        (length(&last), *last.last().unwrap())
    };
    let near = |(length, end): (f64, DVec3), wanted: f64, x: f64, y: f64| {
        assert!((length - wanted).abs() < 2e-3, "{length} {wanted}");
        assert!(end.distance(DVec3::new(x, y, 0.0)) < 1e-9, "{end}");
    };
    // Around 400, 0 from the origin by half a turn to the left: to 800, 0.
    near(long("IN;PD;AA400,0,180;"), 10.0 * PI, 20.0, 0.0);
    near(long("IN;PD;AR400,0,-90;"), 5.0 * PI, 10.0, 10.0);
    near(long("IN;PU400,400;CI200;"), 10.0 * PI, 15.0, 10.0);
    // Through the top of a half circle.
    near(long("IN;PD;AT400,400,800,0;"), 10.0 * PI, 20.0, 0.0);
    near(long("IN;PD;RT400,-400,800,0;"), 10.0 * PI, 20.0, 0.0);
    near(long("IN;EA400,200;"), 30.0, 0.0, 0.0);
    near(long("IN;EW400,0,90;"), 20.0 + 5.0 * PI, 0.0, 0.0);
    // Control points on a line: 30 mm.
    near(long("IN;PD;BZ400,0,800,0,1200,0;"), 30.0, 30.0, 0.0);
    near(long("IN;PU400,0;PD;BR0,400,0,800,0,1200;"), 30.0, 10.0, 30.0);
    // A circle that is drawn on the way does not break the line's begin.
    let curves = hpgl("IN;PD400,0;CI40;PD800,0;");
    assert_eq!(shown(&curves)[0], "0,0 10,0");
    assert_eq!(shown(&curves)[2], "10,0 20,0");
}

#[test]
fn what_a_plotter_fills_or_writes_is_left_out_and_said() {
    let curves = hpgl("IN;PD400,0;LBTool; PD900,900\x03PU;RA9,9;\nWG1,2,3;LBmore\x03");
    assert_eq!(shown(&curves), ["0,0 10,0"]);
    let said: Vec<_> = curves.warnings.iter().map(|w| (w.rule.name(), w.line, w.count)).collect();
    assert_eq!(said, [("hpgl", 1, 2), ("hpgl", 1, 1), ("hpgl", 2, 1)]);
    // Another end of texts.
    assert_eq!(shown(&hpgl("IN;DT*;LBa;PD9,9*PD400,0;")), ["0,0 10,0"]);
}

#[test]
fn bad_drawings_are_refused_with_their_line() {
    let refused = |text: &str, line: u32, rule: &str| {
        let found = read(text.as_bytes(), Form::Hpgl, "in.plt").unwrap_err();
        assert_eq!((found.rule.name(), found.line), (rule, line), "{text}: {found}");
        assert!(found.file == "in.plt" && !found.help.is_empty(), "{found}");
    };
    refused("IN;\nSC0,100,0,100;PD5,5;", 2, "hpgl");
    refused("IN;PE<=,;", 1, "hpgl");
    refused("IN;\nPD5;", 2, "hpgl");
    refused("IN;AA5,5;", 1, "hpgl");
    refused("IN;BZ1,2,3,4;", 1, "hpgl");
    refused("IN;XX1;", 1, "hpgl");
    refused("IN;#", 1, "hpgl");
    refused("I", 1, "hpgl");
    refused("IN;PD1.2.3,4;", 1, "number");
    refused("IN;PD99999999999,4;", 1, "number");
    refused("IN;PD999999999,4;", 0, "coordinate");
    refused("IN;PU5,5;", 0, "empty");
    refused("", 0, "empty");
    // 300 whole turns are one; a million circles of a large radius are too many corners.
    assert!(hpgl("IN;PD;AA400,0,108000;").curves[0].corners.len() < 1000);
    refused(&"CI9999999;".repeat(20_000), 1, "points");
    let found = read(b"no drawing", Form::Dxf, "in.dxf").unwrap_err();
    assert_eq!((found.rule.name(), found.file.as_str()), ("dxf-code", "in.dxf"));
    let found = read(&dxf("0 TEXT 10 0 20 0 1 x"), Form::Dxf, "in.dxf").unwrap_err();
    assert_eq!(found.rule.name(), "empty");
}

#[test]
fn entities_of_a_drawing_are_curves_at_their_heights() {
    let bytes = dxf("0 LINE 10 0 20 0 30 2 11 3 21 4 31 2 \
         0 CIRCLE 10 5 20 5 30 -1 40 2 \
         0 LWPOLYLINE 70 1 10 0 20 0 42 1 10 10 20 0 42 1 \
         0 SPLINE 71 3 40 0 40 0 40 0 40 0 40 1 40 1 40 1 40 1 10 0 20 0 10 10 20 0 10 20 20 0 10 30 20 0 \
         0 TEXT 10 0 20 0 1 x");
    let Curves { curves, warnings } = read(&bytes, Form::Dxf, "in.dxf").unwrap();
    let lengths: Vec<f64> = curves.iter().map(|curve| length(&curve.corners)).collect();
    // A line of 5 mm, a circle of radius 2, two half circles of radius 5, and 30 mm.
    for (length, wanted) in lengths.iter().zip([5.0, 2.0 * TAU, 10.0 * PI, 30.0]) {
        assert!((length - wanted).abs() < 2e-3, "{lengths:?}");
    }
    assert_eq!(curves.len(), 4);
    let closed: Vec<bool> = curves.iter().map(|curve| curve.is_closed()).collect();
    assert_eq!(closed, [false, true, true, false]);
    assert!(curves[0].corners.iter().all(|at| at.z == 2.0));
    assert!(curves[1].corners.iter().all(|at| at.z == -1.0));
    // Chords leave the circle by less than a part of 100,000 of the drawing of 30 mm.
    let sagged = curves[1]
        .corners
        .windows(2)
        .map(|pair| (0.5 * (pair[0] + pair[1])).truncate().distance(glam::DVec2::splat(5.0)));
    assert!(sagged.into_iter().all(|radius| radius > 2.0 - 3e-4));
    let said: Vec<_> = warnings.iter().map(|w| (w.rule.name(), w.file.as_str())).collect();
    assert_eq!(said, [("dxf-left-out", "in.dxf")]);
}

fn along(corners: &[DVec3], layers: Layers, step: f64) -> Vec<DVec3> {
    let points = layers.points(std::iter::once(corners), step, 1.0, DVec3::Z);
    points.into_iter().map(place).collect()
}

#[test]
fn points_follow_one_another_at_equal_chords_no_shorter_than_the_step() {
    let plain = Layers::default();
    // 10 mm in steps of 0.13 mm: 76 fit, and come out even at 10 / 76 mm; with both ends 77 points.
    let line = [DVec3::ZERO, DVec3::X * 10.0];
    let points = along(&line, plain, 0.13);
    assert_eq!((points.len(), points[0].x, points[76].x), (77, 0.0, 10.0));
    assert!(points.windows(2).all(|p| (p[1].x - p[0].x - 10.0 / 76.0).abs() < 1.5e-3));
    // Without a point on the end they are exactly the step apart.
    let open = along(&line, Layers { ends: false, ..plain }, 0.13);
    assert_eq!((open.len(), open[76].x), (77, 9.88));
    // A circle of 1 mm: chords of 0.5 mm are 2 asin 0.25 of angle, 12.43 of them a turn: 12, evenly.
    let circle: Vec<DVec3> = (0..=1000)
        .map(|i| if i == 1000 { 0.0 } else { f64::from(i) / 1000.0 * TAU })
        .map(|a: f64| DVec3::new(a.cos(), a.sin(), 0.0))
        .collect();
    let points = along(&circle, plain, 0.5);
    assert_eq!(points.len(), 12);
    let even = 2.0 * (PI / 12.0).sin();
    for i in 0..12 {
        let chord = points[i].distance(points[(i + 1) % 12]);
        assert!((chord - even).abs() < 2e-3, "{chord} {even}");
    }
    // A zigzag of needles: never nearer than the step to the one before.
    let needles: Vec<DVec3> =
        (0..40).map(|i| DVec3::new(0.05 * f64::from(i), f64::from(i % 2), 0.0)).collect();
    let points = along(&needles, plain, 0.13);
    assert!(points.windows(2).all(|pair| pair[0].distance(pair[1]) >= 0.13 - 1e-3));
    // A curve shorter than the step, and a dot.
    assert_eq!(
        along(&[DVec3::ZERO, DVec3::X * 0.1], Layers { ends: false, ..plain }, 0.13).len(),
        1
    );
    assert_eq!(along(&[DVec3::X], plain, 0.13), [DVec3::X]);
}

#[test]
fn layers_lie_around_the_drawing_and_a_twist_moves_their_points() {
    let layers = Layers { count: 3, distance: Some(1.0), twist: 0.5, ends: false };
    let points = along(&[DVec3::ZERO, DVec3::X * 2.0], layers, 1.0);
    let shown: Vec<[f64; 2]> = points.iter().map(|at| [at.x, at.z]).collect();
    // The middle one at the height of the drawing, its points half a step on.
    assert_eq!(
        shown,
        [
            [0.0, -1.0],
            [1.0, -1.0],
            [2.0, -1.0],
            [0.5, 0.0],
            [1.5, 0.0],
            [0.0, 1.0],
            [1.0, 1.0],
            [2.0, 1.0]
        ]
    );
    // A square of 1 mm, every 0.5 mm: 8 points from a corner; from 0.25 mm on 7, since a chord around a corner, from 0.75 mm to
    // sqrt(0.5^2 - 0.25^2) = 0.433 mm, is 0.683 mm of the edge.
    let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y, DVec3::ZERO];
    let points = along(&square, Layers { count: 2, ends: true, ..layers }, 0.5);
    assert_eq!(points.len(), 8 + 7, "{points:?}");
    assert_eq!((points[0].x, points[8].x, points[8].y), (0.0, 0.25, 0.0));
}
