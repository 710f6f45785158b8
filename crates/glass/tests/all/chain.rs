//! Machines by declared axes: every combination of what moves block and beam.

use crate::bodies::sphere;
use crate::common::k9;
use glam::DVec2;
use toolpost_glass::chain::{Chain, Joint, Moves};
use toolpost_glass::job::{Made, make, prove};
use toolpost_glass::machine::{Machine, library};
use toolpost_glass::mesh::Shape;
use toolpost_glass::polar::{Branch, Polar};

fn straight(moves: Moves, along: [f64; 2]) -> Joint {
    Joint { moves, along: Some(along), about: None }
}

fn turning(moves: Moves, about: [f64; 2]) -> Joint {
    Joint { moves, along: None, about: Some(about) }
}

const WIDE: [[f64; 2]; 2] = [[-360.0, 360.0]; 2];

/// An arm of 135 mm about (0, 200), and a table about the origin, on which a block of 50 mm lies from 70 mm on.
fn polar() -> Chain {
    Chain {
        a: turning(Moves::Beam, [0.0, 200.0]),
        b: turning(Moves::Block, [0.0, 0.0]),
        spot: [0.0, 65.0],
        corner: [-25.0, 70.0],
        near: [-20.0, 20.0],
    }
}

#[test]
fn axes_that_move_block_and_beam_hit_where_a_hand_calculation_says() {
    let chain = |a, b| Chain { a, b, spot: [0.0; 2], corner: [0.0; 2], near: [0.0; 2] };
    let [x, y] = [[1.0, 0.0], [0.0, 2.0]];
    // (none, Cartesian), (Cartesian, none), and one axis on each: what moves the block moves the place the other way.
    for (first, second, expected) in [
        (Moves::Beam, Moves::Beam, [3.0, 4.0]),
        (Moves::Block, Moves::Block, [-3.0, -4.0]),
        (Moves::Block, Moves::Beam, [-3.0, 4.0]),
    ] {
        let chain = chain(straight(first, x), straight(second, y));
        assert!((chain.forward([3.0, 4.0]) - DVec2::from_array(expected)).length() < 1e-12);
    }
    // (polar, Cartesian): a quarter of a turn of the table brings what was at (0, -5) under a beam that went to (5, 0).
    let turned = chain(turning(Moves::Block, [0.0; 2]), straight(Moves::Beam, x));
    assert!((turned.forward([90.0, 5.0]) - DVec2::new(0.0, -5.0)).length() < 1e-12);
    // (none, polar): an arm on an arm, 3 and 4 mm long; the first one carries the second.
    let arms = Chain {
        spot: [7.0, 0.0],
        ..chain(turning(Moves::Beam, [0.0; 2]), turning(Moves::Beam, [3.0, 0.0]))
    };
    assert!((arms.forward([90.0, -90.0]) - DVec2::new(4.0, 3.0)).length() < 1e-12);
}

#[test]
fn every_combination_comes_back_to_the_place_it_was_sent_to() {
    let kinds: [fn(Moves, usize) -> Joint; 2] = [
        |moves, axis| straight(moves, [[1.0, 0.2], [-0.1, 1.0]][axis]),
        |moves, axis| turning(moves, [[25.0, -90.0], [-90.0, 25.0]][axis]),
    ];
    let both = [Moves::Beam, Moves::Block];
    let mut combinations = 0;
    for a in kinds.iter().flat_map(|kind| both.map(|moves| kind(moves, 0))) {
        for b in kinds.iter().flat_map(|kind| both.map(|moves| kind(moves, 1))) {
            let chain = Chain { a, b, spot: [25.0, 25.0], corner: [0.0; 2], near: [0.0; 2] };
            chain.check().unwrap();
            for i in 0..11 {
                for j in 0..11 {
                    let place = DVec2::new(15.0 + 2.0 * f64::from(i), 15.0 + 2.0 * f64::from(j));
                    let at =
                        chain.inverse(place, WIDE).unwrap_or_else(|| panic!("{chain:?} {place}"));
                    assert!((chain.forward(at) - place).length() < 1e-8, "{chain:?} {place}");
                }
            }
            combinations += 1;
        }
    }
    assert_eq!(combinations, 16);
}

#[test]
fn the_polar_machine_of_the_source_is_one_of_them() {
    let own = Polar { side: 50.0, distance: 200.0, offset: 70.0, arm: 135.0 };
    for (branch, near) in [(Branch::Left, [-20.0, 20.0]), (Branch::Right, [20.0, -20.0])] {
        let chain = Chain { near, ..polar() };
        for place in [[30.0, 30.0], [24.0, 30.0], [3.0, 41.0], [47.0, 8.0]].map(DVec2::from_array) {
            let pose = own.inverse(place, branch).unwrap();
            let arm = (pose.arm.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
            let at = chain.inverse(place, WIDE).unwrap();
            assert!((at[0] - arm).abs() < 1e-6, "{place} {branch:?}: {at:?} {pose:?}");
            let table = at[1] - pose.table.to_degrees();
            assert!(
                (table - 360.0 * (table / 360.0).round()).abs() < 1e-6,
                "{place}: {at:?} {pose:?}"
            );
        }
    }
}

/// A machine of the library with declared axes: an arm over a turning table.
fn machine(format: &str) -> String {
    let text = library("glass-xyz-100hz").unwrap();
    let fire = if format == "gcode" { "\nfire = \"M101 P0\"" } else { "" };
    let axes = text.find("[axes.x]").unwrap();
    let lenses = text.find("[[lenses]]").unwrap();
    let own = "[axes.a]\ntravel = [-90, 90]\nacceleration = 3320\nspeed = 180\n[axes.b]\ntravel = [-170, 170]\nacceleration = 4000\nspeed = 180\n[axes.z]\ntravel = [-100, 10]\nacceleration = 7.5\nspeed = 0.1\n[chain]\na = { moves = \"beam\", about = [0, 200] }\nb = { moves = \"block\", about = [0, 0] }\nspot = [0, 65]\ncorner = [-10, 70]\nnear = [-20, 20]\n";
    format!("{}{own}{}", &text[..axes], &text[lenses..])
        .replace("kind = \"xyz\"", "kind = \"chain\"")
        .replace("format = \"numbered\"", &format!("format = \"{format}\"{fire}"))
}

#[test]
fn a_machine_by_declared_axes_makes_proven_programs_in_every_form() {
    let settings = crate::common::settings([20.0, 20.0, 30.0], 100);
    let body = || vec![Shape::Mesh(sphere(1.5, 30))];
    for format in ["numbered", "points", "gcode", "binary"] {
        let machine = Machine::read(&machine(format), "").unwrap();
        let Made { report, proven, findings, text, .. } =
            make(body(), &k9(), &machine, &settings).unwrap_or_else(|found| panic!("{found:?}"));
        assert!(proven && findings.is_empty(), "{format}: {findings:?}");
        // Whole steps of 0.0001 degrees: 0.24 µm at 135 mm, 0.17 µm at 100 mm.
        assert!(report.proof.across < 0.000_3 && report.proof.shadowed == 0, "{:?}", report.proof);
        if format == "gcode" {
            let text = String::from_utf8(text).unwrap();
            let line = text.lines().find(|line| line.starts_with("G0 ")).unwrap();
            assert!(
                line.starts_with("G0 A-") && line.contains(" C") && line.contains(" Z-"),
                "{line}"
            );
            // A turn of the table of 0.1 degrees is 0.17 mm: farther than a crack, perhaps where another point is. One of 3 degrees is
            // 5 mm, beyond the body.
            let table: f64 =
                line.split(" C").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
            for (turn, rule) in [(0.1, "lost"), (3.0, "lost"), (3.0, "stray")] {
                let turned = format!(" C{:.4}", table + turn);
                let moved = text.replacen(&format!(" C{table:.4}"), &turned, 1);
                let wrong = prove(moved.into_bytes(), body(), &k9(), &machine, &settings).unwrap();
                let rules: Vec<_> = wrong.findings.iter().map(|found| found.rule.name()).collect();
                assert!(!wrong.proven && rules.contains(&rule), "{turn}: {rules:?}");
            }
        }
    }
}

#[test]
fn what_declared_axes_do_not_reach_and_what_they_cannot_be_is_refused() {
    let settings = crate::common::settings([20.0, 20.0, 30.0], 100);
    let short = machine("numbered").replace("spot = [0, 65]", "spot = [0, 81]");
    let found = make(
        vec![Shape::Mesh(sphere(1.5, 30))],
        &k9(),
        &Machine::read(&short, "").unwrap(),
        &settings,
    );
    assert_eq!(found.unwrap_err()[0].rule.name(), "travel");
    for (from, to, word) in [
        ("about = [0, 0]", "about = [0, 200], along = [1, 0]", "not both"),
        ("about = [0, 0]", "along = [0, 0]", "needs `along`"),
        ("moves = \"block\", about = [0, 0]", "moves = \"beam\", about = [0, 200]", "but a line"),
        ("spot = [0, 65]", "spot = [0, nan]", "chain.spot"),
        ("kind = \"chain\"", "kind = \"xyz\"", "for kind = \"chain\" only"),
    ] {
        let wrong = machine("numbered").replacen(from, to, 1);
        let found = Machine::read(&wrong, "own.toml").unwrap_err();
        assert!(found.message.contains(word), "{from}: {}", found.message);
    }
}
