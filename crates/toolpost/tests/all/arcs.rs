//! Every notation of an arc that a control file may choose: blocks worked out by hand, each read back by
//! the virtual control where its dialect has that notation.

use geom::Vec3;
use machine::Machine;
use program::{ArcTo, Circle, Feed, Op, Pose, Program, Spindle, Tool};
use proptest::prelude::*;

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, z)).unwrap()
}

fn arc(end: Pose, center: [f64; 2], ccw: bool) -> Op {
    let center = Vec3::new(center[0], center[1], end.point().z);
    let normal = if ccw { Vec3::Z } else { Vec3::NEG_Z };
    Op::Arc(Box::new(ArcTo { end, circle: Circle::new(center, normal, 0).unwrap() }))
}

/// From X20 Y0 on: a quarter; three quarters; a full circle; a half circle the other way.
fn ways() -> Vec<Op> {
    vec![
        Op::Rapid(at(20.0, 0.0, 5.0)),
        Op::Line(at(20.0, 0.0, -1.0)),
        arc(at(0.0, 20.0, -1.0), [0.0, 0.0], true),
        arc(at(10.0, 10.0, -1.0), [0.0, 10.0], true),
        arc(at(10.0, 10.0, -1.0), [5.0, 10.0], true),
        arc(at(30.0, 10.0, -1.0), [20.0, 10.0], false),
        Op::Line(at(40.0, 10.0, -1.0)),
        Op::Rapid(at(40.0, 10.0, 5.0)),
    ]
}

fn program(ops: Vec<Op>) -> Program {
    let start = [
        Op::Tool(Box::new(Tool { number: 1, ..Tool::default() })),
        Op::Spindle(Spindle::Clockwise(1000.0)),
        Op::Feed(Feed::PerMinute(200.0)),
    ];
    let mut program = Program::new("arcs");
    for (line, op) in (1..).zip(start.into_iter().chain(ops).chain([Op::End])) {
        program.push(line, op);
    }
    program
}

/// The machine `extends`, changed by `text`, with `arc` in both blocks of arcs, `±` in it the direction.
fn mill(extends: &str, text: &str, arc: &str) -> Machine {
    let (cw, ccw) = (arc.replace('±', "-"), arc.replace('±', "+"));
    let blocks = format!("[blocks]\narc_cw = \"{cw}\"\narc_ccw = \"{ccw}\"\n");
    let text = format!("extends = \"{extends}\"\n{}\n", text.replace("[blocks]\n", &blocks));
    machine::load_text("mill.toml", &text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

/// A number for each block, and these words with four decimals; `#` stands between what is before the
/// number and what behind it.
fn words(point: bool, names: &[(&str, &str)]) -> String {
    let word = |(name, address): &(&str, &str)| {
        let (address, suffix) = address.split_once('#').unwrap_or((address, ""));
        format!(
            "{name} = {{ address = \"{address}\", suffix = \"{suffix}\", decimals = 4, trim = true, \
             point = {point} }}\n"
        )
    };
    let all: String = names.iter().map(word).collect();
    format!("[words]\nN = {{ step = 10 }}\n{all}[blocks]\n")
}

/// The program, which is proven.
fn proven(machine: &Machine, ops: Vec<Op>) -> String {
    let source = program(ops);
    let output = post::write(&source, machine).unwrap_or_else(|found| panic!("{found:?}"));
    let text = String::from_utf8(output.text).unwrap();
    let report = proof::prove(&source, machine, "p", text.as_bytes(), &Default::default());
    assert!(report.proven, "{:?}\n{text}", report.mismatches);
    text
}

/// The blocks between the way down and the way out of the last arc, without their numbers and the points
/// of whole numbers.
fn arcs(machine: &Machine) -> Vec<String> {
    let text = proven(machine, ways());
    let lines: Vec<&str> = text.lines().collect();
    let down = lines.iter().position(|line| line.contains("Z-1")).unwrap();
    let out = lines.iter().position(|line| line.contains("X40")).unwrap();
    let bare = |line: &&str| {
        let words = line.split(' ').skip(1).map(|word| word.trim_end_matches('.'));
        words.collect::<Vec<_>>().join(" ")
    };
    lines[down + 1..out].iter().map(bare).collect()
}

const RADIUS: &str = "{{N}} {{feed_mode}} {{plane}} {{motion}} {{X}} {{Y}} {{Z}} {{R}} {{F}}";
const CENTER: &str =
    "{{N}} {{feed_mode}} {{plane}} {{motion}} {{X}} {{Y}} {{Z}} {{CX}} {{CY}} {{CZ}} {{F}}";
const MIDDLE: &str =
    "{{N}} {{feed_mode}} {{plane}} {{motion}} {{X}} {{Y}} {{Z}} {{MX}} {{MY}} {{MZ}} {{F}}";

/// `CIP` of the SINUMERIK, whose point half way is that of robots.
fn through_a_point() -> Machine {
    let codes = "motion = { codes = { rapid = \"G0\", linear = \"G1\", arc_cw = \"CIP\", arc_ccw = \
                 \"CIP\" } }\n[blocks]\n";
    let text = words(false, &[("MX", "I1="), ("MY", "J1="), ("MZ", "K1=")]);
    mill("generic-3axis-sinumerik", &text.replace("[blocks]\n", codes), MIDDLE)
}

#[test]
fn a_radius_is_negative_over_a_half_circle_and_what_it_cannot_say_is_cut() {
    // The quarter; three quarters; the circle and the half circle, a quarter at a time: by its radius a
    // circle has no centre, and that of a half circle hangs on the last digit.
    let blocks = [
        "G3 X0 Y20 R20",
        "X10 Y10 R-10",
        "X5 Y15 R5",
        "X0 Y10 R5",
        "X5 Y5 R5",
        "X10 Y10 R5",
        "G2 X20 Y20 R10",
        "X30 Y10 R10",
    ];
    for (control, point) in [
        ("generic-3axis-iso", true),
        ("generic-3axis-linuxcnc", false),
        ("generic-3axis-mach3", false),
        ("generic-3axis-haas", true),
    ] {
        let machine = mill(control, &words(point, &[("R", "R")]), RADIUS);
        assert_eq!(arcs(&machine), blocks, "{control}");
    }
    let machine = mill("generic-3axis-sinumerik", &words(false, &[("R", "CR=")]), RADIUS);
    assert_eq!(arcs(&machine), blocks.map(|block| block.replace(" R", " CR=")));
    // No G94 with G3 in Marlin, no plane in Klartext, which names the direction.
    let plus = "[words]\nR = { decimals = 4, trim = true, plus = true }\n[blocks]\n";
    let plain = plus.replace("plus = true", "modal = false");
    for (control, text, block, first) in [
        ("generic-3axis-grbl", plain.as_str(), RADIUS, "G3 X0 Y20 R20"),
        ("generic-3axis-marlin", &plain, "{{motion}} {{X}} {{Y}} {{R}} {{F}}", "G3 X0 Y20 R20"),
        (
            "generic-3axis-heidenhain",
            plus,
            "{{N}} CR {{X}} {{Y}} {{R}} DR± {{F}}",
            "CR X+0 Y+20 R+20 DR+",
        ),
    ] {
        let program = proven(&mill(control, text, block), ways());
        assert!(program.contains(first), "{program}");
    }
}

#[test]
fn a_centre_is_absolute_where_the_control_counts_it_so() {
    let text = words(false, &[("CX", "I"), ("CY", "J"), ("CZ", "K")])
        + "program_start = \"{{N}} G21 G17 G40 G49 G80 G90 G90.1 G94 G54 G61\"\n\
           program_end = \"M5\\nM9\\nG53 G0 {{SAFE_HEIGHT}}\\nG91.1\\nM2\"";
    let blocks = ["G3 X0 Y20 I0 J0", "X10 Y10 I0 J10", "X10 Y10 I5 J10", "G2 X30 I20 J10"];
    assert_eq!(arcs(&mill("generic-3axis-linuxcnc", &text, CENTER)), blocks);
    let text = words(false, &[("CX", "I=AC(#)"), ("CY", "J=AC(#)"), ("CZ", "K=AC(#)")]);
    let blocks = [
        "G3 X0 Y20 I=AC(0) J=AC(0)",
        "X10 Y10 I=AC(0) J=AC(10)",
        "X10 Y10 I=AC(5) J=AC(10)",
        "G2 X30 I=AC(20) J=AC(10)",
    ];
    assert_eq!(arcs(&mill("generic-3axis-sinumerik", &text, CENTER)), blocks);
}

#[test]
fn a_point_half_way_makes_the_circle() {
    // 20 · cos 45° = 14.1421; the three quarters pass 10 mm from 0, 10 at 225°; the circle in two halves.
    let blocks = [
        "CIP X0 Y20 I1=14.1421 J1=14.1421 K1=-1",
        "X10 Y10 I1=-7.0711 J1=2.9289 K1=-1",
        "X0 I1=5 J1=15 K1=-1",
        "X10 I1=5 J1=5 K1=-1",
        "CIP X30 I1=20 J1=20 K1=-1",
    ];
    assert_eq!(arcs(&through_a_point()), blocks);
}

/// Three points of a helix make a circle that is tilted: it goes by lines, within the tolerance.
/// Outside the plane XY the length of the tool would count along another axis (SD42940), so that the
/// SINUMERIK cuts such arcs by three points of space and stays in `G17`.
#[test]
fn a_sinumerik_cuts_an_arc_of_another_plane_through_three_points() {
    let machine = machine::load("generic-3axis-sinumerik").unwrap();
    let around = |end: Pose, center: Vec3, normal: Vec3| {
        Op::Arc(Box::new(ArcTo { end, circle: Circle::new(center, normal, 0).unwrap() }))
    };
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let leaning = Vec3::new(0.0, -half, half);
    let text = proven(
        &machine,
        vec![
            Op::Rapid(at(0.0, 0.0, 5.0)),
            Op::Line(at(0.0, 0.0, -1.0)),
            // Half a circle about Y, over X 10; a quarter in a plane that leans by 45°; a whole circle about Y; the
            // end of a circle about Y of 300 mm, 0.02 mm of it, of which three points with three decimals say no circle.
            around(at(20.0, 0.0, -1.0), Vec3::new(10.0, 0.0, -1.0), Vec3::Y),
            around(
                at(30.0, 10.0 * half, 10.0 * half - 1.0),
                Vec3::new(20.0, 10.0 * half, 10.0 * half - 1.0),
                leaning,
            ),
            around(
                at(30.0, 10.0 * half, 10.0 * half - 1.0),
                Vec3::new(25.0, 10.0 * half, 10.0 * half - 1.0),
                Vec3::Y,
            ),
            around(
                at(30.02, 10.0 * half, 10.0 * half - 1.0),
                Vec3::new(30.01, 10.0 * half, 10.0 * half - 301.0),
                Vec3::Y,
            ),
            Op::Rapid(at(30.02, 10.0 * half, 50.0)),
        ],
    );
    let through: Vec<&str> = text.lines().filter(|line| line.contains("CIP")).collect();
    // By hand: the top of the half circle is X10 Z9. The quarter begins below its centre, X20 Y0 Z-1, and its middle is
    // at 45°: X 20 + 10 sin 45°, (10 - 10 cos 45°) sin 45° along Y and Z. The circle begins at its greatest X,
    // and about Y from X lies -Z: down first, and two halves.
    let expected = [
        "CIP X20 I1=10 J1=0 K1=9",
        "CIP X30 Y7.071 Z6.071 I1=27.071 J1=2.071 K1=1.071",
        "CIP X20 I1=25 J1=7.071 K1=1.071",
        "CIP X30 I1=25 J1=7.071 K1=11.071",
    ];
    let bare: Vec<&str> = through.iter().map(|line| line.split_once(' ').unwrap().1).collect();
    assert_eq!(bare, expected, "{text}");
    assert!(text.contains(" G1 X30.02\n"), "{text}");
    assert!(!text.contains("G18"), "{text}");
}

#[test]
fn a_point_half_way_makes_no_helix() {
    let rising =
        ArcTo { end: at(0.0, 20.0, -3.0), circle: Circle::new(Vec3::ZERO, Vec3::Z, 0).unwrap() };
    let ops = vec![
        Op::Rapid(at(20.0, 0.0, 5.0)),
        Op::Line(at(20.0, 0.0, -1.0)),
        Op::Arc(Box::new(rising)),
        Op::Rapid(at(0.0, 20.0, 5.0)),
    ];
    assert!(!proven(&through_a_point(), ops).contains("CIP"));
}

/// What no control here reads so: for robots, and for those that draw.
#[test]
fn start_angles_and_radius_stand_where_a_block_places_them() {
    let names = ["START_ANGLE", "END_ANGLE", "SWEEP", "RADIUS", "SX", "SY", "SZ"];
    let text = words(false, &names.map(|name| (name, "")));
    let block = "ARC {{SX}} {{SY}} {{SZ}} {{START_ANGLE}} {{END_ANGLE}} {{SWEEP}} {{RADIUS}}";
    let machine = mill("generic-3axis-linuxcnc", &text, block);
    let text = String::from_utf8(post::write(&program(ways()), &machine).unwrap().text).unwrap();
    let blocks: Vec<&str> = text.lines().filter(|line| line.starts_with("ARC")).collect();
    let expected = [
        "ARC 20 0 -1 0 90 90 20",
        "ARC 0 20 -1 90 360 270 10",
        "ARC 10 10 -1 0 360 360 5",
        "ARC 10 10 -1 180 0 -180 10",
    ];
    assert_eq!(blocks, expected);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    /// Any arc is what it was in any notation.
    #[test]
    fn any_arc_is_proven_in_every_notation(
        radius in 0.05f64..200.0,
        from in 0.0f64..std::f64::consts::TAU,
        sweep in 0.02f64..std::f64::consts::TAU,
        ccw: bool,
    ) {
        let sweep = if ccw { sweep } else { -sweep };
        let on = |angle: f64, z| at(radius * angle.cos(), radius * angle.sin(), z);
        let ops = vec![
            Op::Rapid(on(from, 5.0)),
            Op::Line(on(from, -1.0)),
            arc(on(from + sweep, -1.0), [0.0, 0.0], ccw),
            Op::Rapid(on(from + sweep, 5.0)),
        ];
        let centers = [("CX", "I=AC(#)"), ("CY", "J=AC(#)"), ("CZ", "K=AC(#)")];
        for machine in [
            mill("generic-3axis-linuxcnc", &words(false, &[("R", "R")]), RADIUS),
            mill("generic-3axis-sinumerik", &words(false, &[("R", "CR=")]), RADIUS),
            mill("generic-3axis-sinumerik", &words(false, &centers), CENTER),
            through_a_point(),
        ] {
            proven(&machine, ops.clone());
        }
    }
}

/// A move between two long lines that is shorter than the decimals of most controls say: LinuxCNC refuses radii below 0.00127 mm
/// ("the arc starts on its own centre"), and three decimals turn a radius of 0.0005 mm into another circle.
#[test]
fn moves_below_the_resolution_are_proven_on_every_mill() {
    let mut programs = Vec::new();
    for radius in [0.0001, 0.0003, 0.0005, 0.001, 0.0013, 0.002] {
        let around = |x: f64, to: [f64; 2], down: f64, ccw| {
            let end = at(x + to[0] * radius, to[1] * radius, -1.0 - down);
            [Op::Line(at(x, 0.0, -1.0)), arc(end, [x, radius], ccw)]
        };
        let arcs = [
            around(21.0, [1.0, 1.0], 0.0, true),
            around(22.0, [0.0, 2.0], 0.0, true),
            around(23.0, [0.0, 0.0], 0.0, true),
            around(24.0, [0.0, 2.0], 0.5, false),
        ];
        programs.push((radius, arcs.concat()));
    }
    for step in [0.00001, 0.0001, 0.0003, 0.0005, 0.001] {
        // Forty of them, which together are as long as 0.04 mm: none may be lost.
        let staircase = (1..=40).map(f64::from).map(|i| {
            let across = if i % 2.0 == 0.0 { 0.0 } else { step };
            Op::Line(at(20.0 + i * step, across, -1.0))
        });
        programs.push((step, staircase.collect()));
    }
    for machine in crate::files::mills() {
        for (size, moves) in &programs {
            let mut ops = vec![Op::Rapid(at(20.0, 0.0, 5.0)), Op::Line(at(20.0, 0.0, -1.0))];
            ops.extend(moves.iter().cloned());
            ops.extend([Op::Line(at(20.0, 10.0, -1.5)), Op::Rapid(at(20.0, 10.0, 5.0))]);
            let source = program(ops);
            let text = post::write(&source, &machine)
                .unwrap_or_else(|found| panic!("{}, {size} mm: {found:?}", machine.name))
                .text;
            let report = proof::prove(&source, &machine, "p", &text, &Default::default());
            let text = String::from_utf8_lossy(&text);
            assert!(report.proven, "{}, {size} mm: {:?}\n{text}", machine.name, report.mismatches);
        }
    }
}

/// What the end of a program leaves on, the next program finds: behind an arc in another plane the program goes back to G17.
#[test]
fn a_program_that_ends_behind_an_arc_in_another_plane_is_proven_on_every_mill() {
    let upright = |end: Pose, center: Vec3, normal: Vec3| {
        Op::Arc(Box::new(ArcTo { end, circle: Circle::new(center, normal, 0).unwrap() }))
    };
    for axis in [Vec3::X, Vec3::Y] {
        let [normal, end] = [axis.cross(Vec3::Z), axis * 10.0 - Vec3::Z];
        let ops = vec![
            Op::Rapid(at(0.0, 0.0, 5.0)),
            Op::Line(at(0.0, 0.0, -1.0)),
            upright(at(end.x, end.y, -1.0), axis * 5.0 - Vec3::Z, normal),
            Op::Rapid(at(end.x, end.y, 5.0)),
        ];
        let source = program(ops);
        for machine in crate::files::mills().filter(|machine| machine.arm.is_none()) {
            let name = &machine.name;
            let text = post::write(&source, &machine)
                .unwrap_or_else(|found| panic!("{name}: {found:#?}"))
                .text;
            let report = proof::prove(&source, &machine, "p", &text, &Default::default());
            assert!(report.proven, "{name}: {:#?}", report.mismatches);
        }
    }
}
