//! From a body to a proven program, and programs that are wrong and refused.

use crate::bodies::sphere;
use crate::common::k9;
use glam::DVec3;
use toolpost_glass::cloud::{Point, distances};
use toolpost_glass::control::read;
use toolpost_glass::curve::{self, Layers, read as read_curves};
use toolpost_glass::fill::{Fill, Filling};
use toolpost_glass::job::{self, Made, Order, Placing, Settings, make};
use toolpost_glass::machine::{Machine, library};
use toolpost_glass::mesh::{Mesh, Shape};
use toolpost_glass::optics::Ray;
use toolpost_glass::order::Effort;
use toolpost_glass::proof::{Proof, Task, prove};

fn machine(format: &str) -> Machine {
    let text = library("glass-xyz-100hz").unwrap();
    let fire = if format == "gcode" { "\nfire = \"M101 P0\"" } else { "" };
    Machine::read(
        &text.replace("format = \"numbered\"", &format!("format = \"{format}\"{fire}")),
        "",
    )
    .unwrap()
}

fn settings() -> Settings {
    crate::common::settings([20.0, 20.0, 30.0], 500)
}

fn made(shape: Shape, format: &str, settings: &Settings) -> Made {
    make(vec![shape], &k9(), &machine(format), settings).unwrap_or_else(|found| panic!("{found:?}"))
}

fn body() -> Shape {
    Shape::Mesh(sphere(1.5, 30))
}

fn refusals(shape: Shape, settings: &Settings) -> Vec<&'static str> {
    let found = make(vec![shape], &k9(), &machine("numbered"), settings).unwrap_err();
    assert!(found.iter().all(|finding| !finding.help.is_empty()));
    found.iter().map(|finding| finding.rule.name()).collect()
}

#[test]
fn a_body_becomes_a_proven_program_in_every_form() {
    for format in ["numbered", "points", "gcode", "binary"] {
        for ray in [Ray::Marginal, Ray::Paraxial] {
            let settings = Settings { ray, ..settings() };
            let made = made(body(), format, &settings);
            let report = &made.report;
            assert!(made.proven && made.findings.is_empty(), "{format}: {:?}", made.findings);
            let Proof {
                pulses,
                across,
                along,
                nearest,
                too_close,
                shadowed,
                ticks,
                seconds,
                used,
                ..
            } = report.proof;
            assert_eq!((pulses, shadowed, Some(ticks)), (report.points, 0, report.planned_ticks));
            // A pulse a point is the least that can be.
            let least = report.least_ticks.unwrap();
            assert!((report.points..=ticks).contains(&least), "{least} of {ticks}");
            // Rounding the drive to whole µm keeps the distance.
            assert!(too_close == 0 && nearest.unwrap().distance >= 0.13, "{format} {nearest:?}");
            assert_eq!((across, seconds), (0.0, ticks as f64 / 100.0));
            // Whole µm of drive are 0.76 µm of depth; 15 mm deep the paraxial focus lies 0.0054 mm off the marginal one.
            let most = if ray == Ray::Marginal { 0.000_77 } else { 0.007 };
            assert!(along <= most && used > 0.96, "{format} {along} {used}");
            assert_eq!(distances(&made.cloud, 130).too_close, 0);
            let pair = made.report.distances.nearest.unwrap();
            let [from, to] = pair.points.map(|i| made.cloud[i as usize].map(f64::from));
            let apart = from.iter().zip(to).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            assert!((apart / 1e3 - pair.distance).abs() < 1e-9, "{apart} µm, {pair:?}");
        }
    }
}

#[test]
fn the_first_pulse_of_a_program_lies_where_a_hand_calculation_puts_it() {
    // One point, in the middle of the block: 15 mm deep, driven 15 * 0.657873 mm (Snell's law at f = 70 mm).
    let made = made(Shape::Points(vec![glam::DVec3::ZERO]), "numbered", &settings());
    let text = String::from_utf8(made.text).unwrap();
    assert_eq!(
        text,
        "N1 BEGIN BLOCK X20.000 Y20.000 Z30.000 POINTS 1\nN2 PULSE X10.000 Y10.000 Z-9.868\nN3 END\n"
    );
}

/// Reads a program back and proves it: the rules that it breaks.
fn judged(text: &[u8], cloud: &[Point], format: &str) -> Vec<&'static str> {
    let machine = machine(format);
    let lens = machine.lens(70.0).unwrap();
    let block = [20.0, 20.0, 30.0];
    let task = Task {
        cloud,
        machine: &machine,
        lens,
        index: 1.5195,
        block,
        blocks: 1,
        spacing: 0.13,
        accept_shadowed: false,
    };
    let found = match read(text, &machine).and_then(|run| prove(&run, &task)) {
        Ok((_, found)) | Err(found) => found,
    };
    assert!(found.iter().all(|finding| !finding.help.is_empty()), "{found:?}");
    found.iter().map(|finding| finding.rule.name()).collect()
}

#[test]
fn programs_that_lose_repeat_move_or_exchange_pulses_are_refused() {
    let made = made(body(), "points", &settings());
    let cloud = &made.cloud;
    let text = String::from_utf8(made.text).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let joined = |lines: &[&str]| lines.join("\n") + "\n";
    assert!(judged(text.as_bytes(), cloud, "points").is_empty());

    let mut less = lines.clone();
    less.remove(100);
    assert_eq!(judged(joined(&less).as_bytes(), cloud, "points"), ["lost"]);
    let mut twice = lines.clone();
    twice.push(lines[100]);
    assert_eq!(judged(joined(&twice).as_bytes(), cloud, "points"), ["twice", "spacing"]);
    // Farther than the radius of a crack.
    let moved = |axis: usize, by: f64| {
        let mut lines: Vec<String> = lines.iter().map(|line| line.to_string()).collect();
        let mut values: Vec<f64> =
            lines[100].split(' ').map(|word| word.parse().unwrap()).collect();
        values[axis] += by;
        lines[100] = format!("{:.3} {:.3} {:.3}", values[0], values[1], values[2]);
        lines.join("\n") + "\n"
    };
    assert!(judged(moved(0, 5.0).as_bytes(), cloud, "points").contains(&"stray"));
    assert!(judged(moved(2, 5.0).as_bytes(), cloud, "points").contains(&"stray"));
    assert!(judged(moved(1, 200.0).as_bytes(), cloud, "points").contains(&"travel"));
    // From above: nearly every point is shadowed.
    let mut turned = lines.clone();
    turned[1..].reverse();
    assert_eq!(judged(joined(&turned).as_bytes(), cloud, "points"), ["shadowed"]);
    // An index that the block does not have: 3 % of 15 mm.
    let wrong = text.replace(" -9.", " -9.3").replace(" -10.", " -10.3");
    assert!(judged(wrong.as_bytes(), cloud, "points").contains(&"lost"));
    assert_eq!(judged(b"# nothing\n", cloud, "points"), ["lost"]);
}

#[test]
fn pulses_that_come_too_near_are_refused_and_those_that_rounding_brings_near_are_pointed_out() {
    // 10 mm deep; 0.13 mm of depth are 0.085_523 mm of drive: 0.085 mm are 0.1292 mm, 0.084 mm are 0.1277 mm.
    let cloud = [[10_000, 10_000, 20_000], [10_000, 10_000, 20_130]];
    let judge = |z: &str| {
        let text = format!("10.000 10.000 -6.579\n10.000 10.000 {z}\n");
        let machine = machine("points");
        let lens = machine.lens(70.0).unwrap();
        let block = [20.0, 20.0, 30.0];
        let task = Task {
            cloud: &cloud,
            machine: &machine,
            lens,
            index: 1.5195,
            block,
            blocks: 1,
            spacing: 0.13,
            accept_shadowed: false,
        };
        let (proof, found) = prove(&read(text.as_bytes(), &machine).unwrap(), &task).unwrap();
        let found = found.iter().map(|found| (found.rule.name(), found.is_error())).collect();
        (proof.nearest.unwrap().distance, proof.too_close, found)
    };
    let near = |found: (f64, u64, Vec<(&'static str, bool)>), distance: f64| {
        assert!((found.0 - distance).abs() < 5e-5, "{found:?}");
        (found.1, found.2)
    };
    assert_eq!(near(judge("-6.493"), 0.1307), (0, vec![]));
    assert_eq!(near(judge("-6.494"), 0.1292), (1, vec![("spacing", false)]));
    assert_eq!(near(judge("-6.495"), 0.1277), (1, vec![("spacing", true)]));
}

#[test]
fn curves_become_a_proven_program_that_keeps_the_distance_where_they_cross() {
    // Two lines that cross, in three layers: 10 mm each.
    let text = b"IN;PU0,0;PD400,0;PU200,-200;PD200,200;";
    let curves = || Shape::Curves(read_curves(text, curve::Form::Hpgl, "in.plt").unwrap());
    let layers = Layers { count: 3, distance: Some(2.0), ..Layers::default() };
    let settings = Settings { layers, ..settings() };
    let made = made(curves(), "numbered", &settings);
    assert!(made.proven && made.findings.is_empty(), "{:?}", made.findings);
    assert_eq!(distances(&made.cloud, 130).too_close, 0);
    // 133 µm by default (130, and what rounding takes): 75 chords and 76 points a line, less what is near the crossing.
    let report = &made.report;
    assert_eq!(report.points + report.welded, 6 * 76);
    assert!((3..=12).contains(&report.welded), "{}", report.welded);
    let heights = [13_000, 15_000, 17_000];
    assert!(made.cloud.iter().all(|point| heights.contains(&point[2])));
    // 26 mm of layers do not fit into 30 mm with margins of 2 mm twice and more.
    let layers = Layers { distance: Some(13.5), ..layers };
    assert_eq!(refusals(curves(), &Settings { layers, ..settings }), ["does-not-fit"]);
}

#[test]
fn a_program_that_is_edited_is_proven_against_the_body_again() {
    let settings = settings();
    let first = made(body(), "gcode", &settings);
    let text = String::from_utf8(first.text).unwrap();
    let prove = |text: &str| {
        let text = text.as_bytes().to_vec();
        job::prove(text, vec![body()], &k9(), &machine("gcode"), &settings)
    };
    let again = prove(&text).unwrap();
    assert!(
        again.proven && again.report.planned_ticks.or(again.report.least_ticks).is_none(),
        "{:?}",
        again.findings
    );
    assert_eq!(again.report.proof, first.report.proof);
    let rules = |text: &str| -> Vec<_> {
        let found = prove(text).unwrap().findings;
        found.iter().map(|found| found.rule.name()).collect()
    };
    let pulse = text.match_indices("G0 X").nth(100).unwrap().0;
    let end = pulse + text[pulse..].find("M101 P0\n").unwrap() + "M101 P0\n".len();
    let with = |piece: &str| format!("{}{piece}{}", &text[..pulse], &text[end..]);
    // A pulse that is deleted, one that is made twice, and a detour out of the travel.
    assert_eq!(rules(&with("")), ["lost"]);
    let own = &text[pulse..end];
    assert_eq!(rules(&with(&format!("{own}M101 P0\n"))), ["twice", "spacing"]);
    assert_eq!(rules(&with(&format!("G0 X171\n{own}"))), ["travel"]);
    // A detour takes time: to X0 and back, some 10 mm, 110 ms each, in whole ticks.
    let away = prove(&with(&format!("G0 X0\n{own}"))).unwrap();
    let more = away.report.proof.ticks - first.report.proof.ticks;
    assert!(away.proven && (20..=28).contains(&more), "{more}");
    // Moved by 0.1 mm: out of its crack.
    let x = own.split(['X', ' ']).nth(2).unwrap();
    let moved = format!("{:.3}", x.parse::<f64>().unwrap() + 0.1);
    assert!(rules(&with(&own.replacen(x, &moved, 1))).contains(&"lost"));
    // The numbered form states the block.
    let numbered = made(body(), "numbered", &settings);
    let text = String::from_utf8(numbered.text).unwrap().replacen("Z30.000", "Z31.000", 1);
    let found =
        job::prove(text.into(), vec![body()], &k9(), &machine("numbered"), &settings).unwrap();
    assert_eq!(found.findings[0].rule, "glass-block");
}

#[test]
fn beams_side_by_side_make_equal_blocks_at_once() {
    let four = Machine::read(library("glass-xyz-50hz").unwrap(), "").unwrap();
    let with = |blocks| make(vec![body()], &k9(), &four, &Settings { blocks, ..settings() });
    let (one, two) = (with(1).unwrap(), with(2).unwrap());
    assert!(two.proven && two.findings.is_empty(), "{:?}", two.findings);
    // The same pulses in the same time; the first line says how many beams are open.
    assert_eq!(two.report.proof, one.report.proof);
    let [one, two] = [one, two].map(|made| String::from_utf8(made.text).unwrap());
    let head = two.lines().next().unwrap();
    assert_eq!(head.strip_suffix(" BLOCKS 2"), one.lines().next());
    assert_eq!(two.split_once('\n').unwrap().1, one.split_once('\n').unwrap().1);
    // A program for another number of blocks, and blocks that do not fit.
    let found = job::prove(two.into(), vec![body()], &k9(), &four, &settings()).unwrap();
    assert_eq!(found.findings[0].rule, "glass-block");
    assert!(with(5).unwrap_err()[0].message.contains("places for 4 blocks"));
    let mut wide = Settings { blocks: 2, ..settings() };
    wide.placing.block[0] = 101.0;
    let found = make(vec![body()], &k9(), &four, &wide).unwrap_err();
    assert!(found[0].message.contains("beams 100 mm apart"), "{}", found[0]);
    let points = library("glass-xyz-50hz").unwrap().replace("\"numbered\"", "\"points\"");
    assert!(Machine::read(&points, "").unwrap_err().message.contains("laser.channels"));
}

#[test]
fn programs_that_a_controller_would_not_take_are_refused() {
    let cloud = [[10_000, 10_000, 15_000]];
    let refused = |text: &str, format| {
        assert_eq!(judged(text.as_bytes(), &cloud, format), ["glass-program"], "{text}")
    };
    let good = "N1 BEGIN BLOCK X20.000 Y20.000 Z30.000 POINTS 1\nN2 PULSE X10.000 Y10.000 Z-9.868\nN3 END\n";
    assert!(judged(good.as_bytes(), &cloud, "numbered").is_empty());
    for (from, to) in [
        ("N2", "N3"),
        ("N2 PULSE", "PULSE"),
        ("PULSE", "PULS"),
        (" Z-9.868", ""),
        ("Y10.000", "Y1e1"),
        ("Y10.000", "Y10.0.0"),
        ("Y10.000", "Y"),
        ("Z-9.868", "Z-9.868 X1"),
        ("POINTS 1", "POINTS 2"),
        ("POINTS 1", ""),
        ("N3 END\n", ""),
        ("N3 END\n", "N3 END"),
        ("N3 END\n", "N3 END\nN4 PULSE X1 Y1 Z1\n"),
        ("BEGIN", "PULSE"),
        ("N2", "N+2"),
        ("POINTS 1", "POINTS +1"),
    ] {
        refused(&good.replacen(from, to, 1), "numbered");
    }
    let good = "(one)\nG21 G90\nG0 X10.000 Y10.000 Z-9.868\nM101 P0\nM2\n";
    assert!(judged(good.as_bytes(), &cloud, "gcode").is_empty());
    for (from, to) in [
        ("G21 ", ""),
        (" G90", ""),
        (" G90", " G91"),
        ("G21", "G20"),
        (" Z-9.868", ""),
        ("M2\n", ""),
        ("M2\n", "M2\nM101 P0\n"),
        ("M101 P0", "M101 P1"),
        ("G0 X", "G2 X"),
        // G1 needs a feed, an axis stands once in a line, and what is between two comments is run.
        ("G0 X", "G1 X"),
        ("X10.000", "X9.000 X10.000"),
        ("(one)", "(one) G0 X5 (two)"),
        ("M2\n", "X5 M2\n"),
    ] {
        refused(&good.replacen(from, to, 1), "gcode");
    }
    for text in ["1 2\n", "1 2 3 4\n", "1 2 x\n", "1 2 3", "1 2 \u{b2}\n"] {
        refused(text, "points");
    }
    assert_eq!(judged(&[b'1', 0xff, b'\n'], &cloud, "points"), ["glass-program"]);
}

#[test]
fn a_binary_program_has_twelve_bytes_a_pulse_and_a_sum() {
    // The same point as in the text: 10, 10 and -9.868 mm in a block of 20 x 20 x 30 mm.
    let made = made(Shape::Points(vec![glam::DVec3::ZERO]), "binary", &settings());
    let mut expected = b"TPGLASS1".to_vec();
    for value in [20_000, 20_000, 30_000, 1, 0, 10_000, 10_000, -9_868i32] {
        expected.extend_from_slice(&value.to_le_bytes());
    }
    assert_eq!(made.text[..expected.len()], expected);
    assert_eq!(made.text.len(), expected.len() + 4);
    // The sum, bit by bit (ISO 3309).
    let bit = |sum: u32, _| if sum & 1 == 1 { 0xedb8_8320 ^ (sum >> 1) } else { sum >> 1 };
    let sum = !expected.iter().fold(!0u32, |sum, b| (0..8).fold(sum ^ u32::from(*b), bit));
    assert_eq!(made.text[expected.len()..], sum.to_le_bytes());
    let cloud = [[10_000, 10_000, 15_000]];
    assert!(judged(&made.text, &cloud, "binary").is_empty());
    for length in 0..made.text.len() {
        assert_eq!(judged(&made.text[..length], &cloud, "binary"), ["glass-program"], "{length}");
    }
    for at in 0..made.text.len() {
        let mut wrong = made.text.clone();
        wrong[at] ^= 0x10;
        assert_eq!(judged(&wrong, &cloud, "binary"), ["glass-program"], "{at}");
    }
}

#[test]
fn bodies_that_cannot_be_engraved_are_refused_with_a_way_out() {
    let large = Shape::Mesh(sphere(30.0, 10));
    let found = make(vec![large], &k9(), &machine("numbered"), &settings()).unwrap_err();
    assert_eq!(found[0].rule, "does-not-fit");
    // 60 mm into 16 mm.
    assert!(
        found[0].help.contains("--scale 0.2667") && found[0].help.contains("0.039370"),
        "{}",
        found[0].help
    );
    let with = |change: &dyn Fn(&mut Settings)| {
        let mut settings = settings();
        change(&mut settings);
        settings
    };
    assert_eq!(refusals(body(), &with(&|s| s.placing.shift = [8.0, 0.0, 0.0])), ["does-not-fit"]);
    assert_eq!(refusals(body(), &with(&|s| s.placing.margin = 10.0)), ["glass-block"]);
    assert_eq!(refusals(body(), &with(&|s| s.placing.block[2] = 101.0)), ["glass-block"]);
    assert_eq!(refusals(body(), &with(&|s| s.focal = 50.0)), ["lens"]);
    assert_eq!(refusals(body(), &with(&|s| s.spacing = Some(0.1))), ["spacing"]);
    assert_eq!(refusals(body(), &with(&|s| s.spacing = Some(0.0))), ["spacing"]);
    assert_eq!(refusals(body(), &with(&|s| s.spacing = Some(f64::NAN))), ["spacing"]);
    assert_eq!(refusals(Shape::Mesh(Mesh::default()), &settings()), ["empty"]);
    assert_eq!(
        refusals(Shape::Mesh(sphere(900.0, 4)), &with(&|s| s.placing.block = [2e6, 2e6, 90.0])),
        ["does-not-fit"]
    );
    let few = library("glass-xyz-100hz").unwrap().replace("points = 2000000", "points = 100");
    let few = Machine::read(&few, "").unwrap();
    assert_eq!(make(vec![body()], &k9(), &few, &settings()).unwrap_err()[0].rule, "points");
}

#[test]
fn small_and_open_bodies_and_cut_beams_are_pointed_out() {
    let rules = |shape, settings: &Settings| -> Vec<_> {
        made(shape, "numbered", settings).findings.iter().map(|found| found.rule.name()).collect()
    };
    assert_eq!(rules(Shape::Mesh(sphere(0.2, 10)), &settings()), ["small"]);
    let mut open = sphere(1.5, 10);
    open.triangles.truncate(200);
    assert!(rules(Shape::Mesh(open), &settings()).contains(&"mesh"));
    let mut inverted = sphere(1.5, 10);
    inverted.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    // Next to a larger body that is as it should be.
    let shapes = vec![Shape::Mesh(inverted), Shape::Mesh(sphere(2.0, 10))];
    let both = make(shapes, &k9(), &machine("numbered"), &settings()).unwrap();
    assert!(both.findings[0].message.contains("inside out"), "{:?}", both.findings);
    // A ball of 16 mm at the bottom of a block of 90 mm: 1 mm from its sides the cone has up to 2 mm.
    let mut deep = settings();
    deep.placing = Placing {
        block: [18.0, 18.0, 90.0],
        margin: 1.0,
        shift: [0.0, 0.0, -36.0],
        ..deep.placing
    };
    deep.spacing = Some(0.5);
    assert_eq!(rules(Shape::Mesh(sphere(8.0, 20)), &deep), ["beam-cut"]);
}

#[test]
fn points_of_a_list_that_are_too_close_are_left_out_and_counted() {
    let at = |x: f64| glam::DVec3::new(x, 0.0, 0.0);
    let made = made(
        Shape::Points(vec![at(0.0), at(0.1), at(0.2), at(1.0), at(1.0)]),
        "numbered",
        &settings(),
    );
    assert_eq!((made.report.points, made.report.welded), (3, 2));
    assert!(made.proven);
}

#[test]
fn the_orders_of_the_source_shadow_points_and_pass_only_where_that_is_accepted() {
    let kdz = Settings { order: Order::Kdz(0.36, 0.36), ..settings() };
    let found = made(body(), "numbered", &kdz);
    assert!(!found.proven && found.findings.iter().any(|found| found.rule == "shadowed"));
    let accepted = made(body(), "numbered", &Settings { accept_shadowed: true, ..kdz });
    assert!(accepted.proven && accepted.report.proof.shadowed > 0);
    assert_eq!(accepted.report.accepted, ["shadowed"]);
    let said = accepted.findings.iter().find(|found| found.rule == "shadowed").unwrap();
    assert!(!said.is_error() && said.help.contains("--accept shadowed"), "{said}");
}

#[test]
fn bodies_are_turned_mirrored_scaled_and_moved() {
    let corner = |x: f64, y: f64, z: f64| glam::DVec3::new(x, y, z);
    let points =
        || Shape::Points(vec![corner(0.0, 0.0, 0.0), corner(4.0, 0.0, 0.0), corner(0.0, 2.0, 0.0)]);
    let cloud = |change: &dyn Fn(&mut Placing)| {
        let mut settings = settings();
        change(&mut settings.placing);
        let mut cloud = made(points(), "numbered", &settings).cloud;
        cloud.sort_unstable();
        cloud
    };
    // Centred in 20 x 20 x 30 mm.
    assert_eq!(
        cloud(&|_| ()),
        [[8_000, 9_000, 15_000], [8_000, 11_000, 15_000], [12_000, 9_000, 15_000]]
    );
    assert_eq!(
        cloud(&|p| p.mirror[0] = true),
        [[8_000, 9_000, 15_000], [12_000, 9_000, 15_000], [12_000, 11_000, 15_000]]
    );
    // About Z by 90°: X goes to Y, Y to -X.
    assert_eq!(
        cloud(&|p| p.turn[2] = 90.0),
        [[9_000, 8_000, 15_000], [11_000, 8_000, 15_000], [11_000, 12_000, 15_000]]
    );
    assert_eq!(
        cloud(&|p| (p.scale, p.shift) = (Some(0.5), [1.0, -1.0, 2.0])),
        [[10_000, 8_500, 17_000], [10_000, 9_500, 17_000], [12_000, 8_500, 17_000]]
    );
    // 16 mm of room for 4 mm.
    assert_eq!(
        cloud(&|p| p.fit = true),
        [[2_000, 6_000, 15_000], [2_000, 14_000, 15_000], [18_000, 6_000, 15_000]]
    );
}

#[test]
fn bodies_are_placed_by_themselves() {
    let corner = |x: f64, y: f64| glam::DVec3::new(x, y, 0.0);
    let points = || Shape::Points(vec![corner(0.0, 0.0), corner(4.0, 0.0), corner(0.0, 2.0)]);
    let with = |alone: Vec<(usize, Placing)>| {
        make(
            vec![points(), points()],
            &k9(),
            &machine("numbered"),
            &Settings { alone, ..settings() },
        )
    };
    let own = settings().placing;
    let sorted = |mut cloud: Vec<Point>| {
        cloud.sort_unstable();
        cloud
    };
    // The first one stays centred in 20 x 20 x 30 mm. The second one is mirrored (its corner at the right), turned by 90 degrees about
    // Z (X goes to Y, Y to -X: the corner at the back right), half as large (1 x 2 mm), and its middle 5 mm above that of the block.
    let mut placing = Placing { scale: Some(0.5), shift: [0.0, 0.0, 5.0], ..own };
    (placing.turn[2], placing.mirror[0]) = (90.0, true);
    let made = with(vec![(1, placing)]).unwrap();
    assert!(made.proven, "{:?}", made.findings);
    assert_eq!(
        sorted(made.cloud),
        [
            [8_000, 9_000, 15_000],
            [8_000, 11_000, 15_000],
            [9_500, 11_000, 20_000],
            [10_500, 9_000, 20_000],
            [10_500, 11_000, 20_000],
            [12_000, 9_000, 15_000],
        ]
    );
    let [alone] = made.report.alone[..] else { panic!("{:?}", made.report.alone) };
    assert_eq!((alone.body, alone.scale, made.report.scale), (2, 0.5, 1.0));
    assert_eq!((alone.from, alone.to), ([9.5, 9.0, 20.0], [10.5, 11.0, 20.0]));
    // Both by themselves; in the same place they are the same points.
    let made = with(vec![(1, own), (0, own)]).unwrap();
    assert_eq!((made.report.points, made.report.welded), (3, 3));
    let refused = |alone| {
        let found = with(alone).unwrap_err();
        (found[0].rule.name(), found[0].message.clone())
    };
    let (rule, message) = refused(vec![(1, Placing { shift: [9.0, 0.0, 0.0], ..own })]);
    assert!(rule == "does-not-fit" && message.starts_with("body 2: "), "{message}");
    assert!(refused(vec![(2, own)]).1.contains("no body 3"));
    assert!(refused(vec![(1, own), (1, own)]).1.contains("placed twice"));
}

#[test]
fn the_writer_and_the_judge_share_nothing_but_the_machine() {
    let source = |file: &str| {
        std::fs::read_to_string(format!("{}/src/{file}.rs", env!("CARGO_MANIFEST_DIR"))).unwrap()
    };
    let uses = |file: &str, other: &str| source(file).contains(&format!("crate::{other}"));
    for judge in ["control", "proof"] {
        for planner in ["post", "optics", "order", "job", "sample", "weld"] {
            assert!(!uses(judge, planner), "{judge} uses {planner}");
        }
    }
    for planner in [
        "post",
        "optics",
        "order/mod",
        "order/greedy",
        "order/shadow",
        "order/window",
        "sample",
        "weld",
    ] {
        for judge in ["control", "proof"] {
            assert!(!uses(planner, judge), "{planner} uses {judge}");
        }
    }
}

#[test]
fn a_solid_keeps_the_distance_in_the_glass_too() {
    let settings =
        Settings { filling: Filling { fill: Fill::Solid, ..settings().filling }, ..settings() };
    let made = made(Shape::Mesh(sphere(2.5, 60)), "binary", &settings);
    // Whole µm of drive bring no two pulses nearer: not within, and not to those of the surface.
    let proof = made.report.proof;
    assert!(proof.too_close == 0 && proof.nearest.unwrap().distance >= 0.13, "{proof:?}");
    assert!(made.report.welded > 1000 && made.report.points > 15_000, "{:?}", made.report.points);
}

#[test]
fn open_beams_share_the_energy_of_a_pulse() {
    // 30 mJ, of which a face of K9 lets 95.75 % pass: ((1.5195 - 1) / (1.5195 + 1))² = 0.042515. Four beams have 7.18 mJ each.
    let text = library("glass-xyz-50hz").unwrap().replacen("beam = 5", "energy = 30\nbeam = 5", 1);
    let with = |least: f64| {
        let own = format!("focal = 70\nenergy = [{least}, 20]");
        Machine::read(&text.replace("focal = 70", &own), "").unwrap()
    };
    let settings = Settings { blocks: 4, ..settings() };
    let made = make(vec![body()], &k9(), &with(7.0), &settings).unwrap();
    assert!((made.report.energy.unwrap() - 30.0 * 0.957_485 / 4.0).abs() < 1e-5);
    let found = make(vec![body()], &k9(), &with(7.2), &settings).unwrap_err();
    assert!(found[0].message.contains("7.181 mJ") && found[0].help.contains("fewer"), "{found:?}");
    // One beam alone has 28.7 mJ.
    let found = make(vec![body()], &k9(), &with(7.0), &Settings { blocks: 1, ..settings });
    assert!(found.unwrap_err()[0].message.contains("28.725 mJ"));
}

#[test]
fn the_light_that_a_material_reflects_absorbs_and_lets_pass_is_one_in_all() {
    use toolpost_glass::material::find;
    let table = |parts: &str| {
        format!("[own]\ntitle = \"own\"\nindex = 1.5\nwavelength = 532\nparts = {parts}\n")
    };
    assert_eq!(find(&table("[0.08, 0.05, 0.87]"), "t", "own", 532.0).unwrap().passes(), 0.87);
    for wrong in ["[0.08, 0.05, 0.9]", "[-0.1, 0.2, 0.9]", "[nan, 0.1, 0.9]"] {
        let found = find(&table(wrong), "t.toml", "own", 532.0).unwrap_err();
        assert!(found.message.contains("1 in all") && found.file == "t.toml", "{found}");
    }
}

#[test]
fn a_program_is_the_same_on_any_number_of_threads() {
    // Several tiles, bands and stretches: some 80,000 points.
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let filling = Filling { fill: Fill::Solid, step: None, direction: DVec3::Z };
        let effort = Effort { rounds: 2, tries: 100, until: None };
        let settings = Settings { filling, effort, ..settings() };
        let body = Shape::Mesh(sphere(3.4, 30));
        pool.install(|| made(body, "binary", &settings))
    };
    let one = on(1);
    assert!(one.proven && one.report.points > 60_000, "{}", one.report.points);
    for threads in [2, 5] {
        let more = on(threads);
        assert!(more.text == one.text && more.cloud == one.cloud, "{threads} threads");
        let [more, one] = [&more.report, &one.report].map(|of| serde_json::to_string(of).unwrap());
        assert_eq!(more, one);
    }
}
