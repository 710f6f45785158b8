//! Scanners: fields, their borders, and programs.

use crate::bodies::sphere;
use crate::common::k9;
use toolpost_glass::cloud::Point;
use toolpost_glass::control::read;
use toolpost_glass::job::{Made, Order, Settings, make};
use toolpost_glass::machine::{Machine, library};
use toolpost_glass::mesh::Shape;
use toolpost_glass::order::Shadow;
use toolpost_glass::stitch::fields;

const SHADOW: Shadow = Shadow { slope: 0.0235, radius: 67.5 };

fn machine(field: f64) -> Machine {
    let text = library("glass-galvo-1000hz").unwrap();
    let half = 0.5 * field;
    Machine::read(&text.replace("[-15, 15]", &format!("[-{half:.3}, {half:.3}]")), "").unwrap()
}

fn settings() -> Settings {
    crate::common::settings([20.0, 20.0, 20.0], 100)
}

fn made(shape: Shape, machine: &Machine) -> Made {
    make(vec![shape], &k9(), machine, &settings()).unwrap_or_else(|found| panic!("{found:?}"))
}

/// A wall of columns 0.13 mm apart: every point is above the one below it, on both sides of every border.
fn wall() -> Vec<Point> {
    (0..60).flat_map(|x| (0..60).map(move |z| [130 * x, 0, 130 * z])).collect()
}

#[test]
fn no_point_of_an_earlier_field_shadows_one_of_a_later_field() {
    let points = wall();
    let fields = fields(&points, [2_000.0, 2_000.0], SHADOW, 130.0);
    // 7.67 mm in fields of 2 mm, of which 1.5 mm advance: six columns of them at some height, in slabs of 0.5 mm over the lean.
    assert!(fields.len() > 30, "{}", fields.len());
    let mut all: Vec<u32> = fields.iter().flat_map(|field| field.points.clone()).collect();
    let mut field_of = vec![0; points.len()];
    for (number, field) in fields.iter().enumerate() {
        field.points.iter().for_each(|&i| field_of[i as usize] = number);
        for &i in &field.points {
            let [x, y, _] = points[i as usize];
            let off = [x - field.center[0], y - field.center[1]];
            assert!(off.iter().all(|off| off.abs() <= 1_000), "{off:?}");
        }
    }
    for (i, &above) in points.iter().enumerate() {
        for (j, &below) in points.iter().enumerate() {
            assert!(
                field_of[i] >= field_of[j] || !SHADOW.hides(above, below),
                "{above:?} {below:?}"
            );
        }
    }
    all.sort_unstable();
    assert_eq!(all, (0..points.len() as u32).collect::<Vec<_>>());
    // What fits into one field is one.
    assert_eq!(toolpost_glass::stitch::fields(&points, [8_000.0; 2], SHADOW, 130.0).len(), 1);
}

#[test]
fn a_body_larger_than_a_field_is_stitched_and_proven() {
    let one = made(Shape::Mesh(sphere(3.0, 40)), &machine(30.0));
    assert!(one.proven && one.report.fields == 1, "{:?}", one.findings);
    let text = String::from_utf8(one.text).unwrap();
    assert!(text.contains("\nN2 FIELD X10.00") && text.contains("\nN3 PULSE U"), "{text:.200}");
    let many = made(Shape::Mesh(sphere(3.0, 40)), &machine(4.0));
    assert!(many.proven && many.report.fields > 4, "{} {:?}", many.report.fields, many.findings);
    assert_eq!(many.report.points, one.report.points);
    assert_eq!(
        (many.report.proof.shadowed, many.report.proof.across),
        (0, many.report.proof.across.min(1e-9))
    );
    assert_eq!(Some(many.report.proof.ticks), many.report.planned_ticks);
}

#[test]
fn programs_of_a_scanner_that_cannot_be_are_refused() {
    let machine = machine(30.0);
    let good = "N1 BEGIN BLOCK X20.000 Y20.000 Z20.000 POINTS 1\nN2 FIELD X10.000 Y10.000\nN3 PULSE U0.000 V1.000 Z-5.000\nN4 END\n";
    let run = read(good.as_bytes(), &machine).unwrap();
    assert_eq!(run.pulses.get(0).unwrap().at, [10.0, 11.0, -5.0]);
    for (from, to) in [
        ("N2 FIELD X10.000 Y10.000", "N2 FIELD X10.000"),
        ("N2 FIELD X10.000 Y10.000", "N2 PULSE U0 V0 Z0"),
        ("N3 PULSE", "N3 FIELD X1 Y1\nN4 PULSE"),
        ("PULSE U", "PULSE X"),
    ] {
        assert!(read(good.replace(from, to).as_bytes(), &machine).is_err(), "{to}");
    }
    let text = library("glass-galvo-1000hz").unwrap();
    let refused = |from: &str, to: &str, what: &str| {
        let found = Machine::read(&text.replacen(from, to, 1), "").unwrap_err();
        assert!(found.message.contains(what), "{found}");
    };
    refused("kind = \"galvo\"", "kind = \"xyz\"", "[stage.x]");
    refused("speed = 0.2\n[stage.y]", "speed = -1\n[stage.y]", "stage.x.speed");
    refused("points = 10000000", "points = 10\nruns = true", "program.runs");
    let by_layers = Settings { order: Order::Layers(None), ..settings() };
    let found = make(vec![Shape::Mesh(sphere(1.0, 20))], &k9(), &machine, &by_layers).unwrap_err();
    assert_eq!(found[0].rule.name(), "glass-block");
}
